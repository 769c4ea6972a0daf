#!/usr/bin/env bash
# deploy/run: the command that it makes from its arguments, with and without a display. Needs no build.
set -u
cd "$(dirname "$0")/../.." || exit 1
failures=0
unset DISPLAY WAYLAND_DISPLAY
expect() {  # expect "COMMAND" ARGUMENT...
    local wanted=$1 got
    shift
    got=$(./deploy/run --dry-run "$@")
    if [ "${got% }" != "$wanted" ]; then
        echo "deploy/run $*: expected '$wanted', got '$got'"
        failures=$((failures + 1))
    fi
}

bash -n deploy/run || failures=$((failures + 1))
headless="--headless --screenshot out/dock.png --seconds 20 --json out/dock.json"

# Without a display.
expect "tact demo dock $headless"
expect "tact demo dock --law fixed $headless" --law fixed
expect "tact demo touch ${headless//dock/touch}" demo touch
expect "tact run scene.tact ${headless//dock/run}" run scene.tact
expect "tact dock a.mrc b.pdb $headless" dock a.mrc b.pdb
expect "tact dock a\\ b.mrc c.pdb $headless" dock "a b.mrc" c.pdb
expect "tact demo dock --seconds=5 --headless --screenshot out/dock.png --json out/dock.json" --seconds=5
expect "tact demo dock --no-gui --seconds 20 --json out/dock.json" --no-gui
expect "tact demo dock --out d --headless --seconds 20" --out d
expect "tact doctor --json" doctor --json
expect "tact --version" --version

# With a display.
export DISPLAY=elsewhere:0
expect "tact demo dock"
expect "tact demo dock --law fixed" --law fixed
expect "tact dock a.mrc b.pdb" dock a.mrc b.pdb
number=4242  # set, but without a server; a killed server leaves its socket
while [ -e "/tmp/.X11-unix/X$number" ]; do number=$((number + 1)); done
export DISPLAY=:$number
expect "tact demo dock $headless"

[ "$failures" -eq 0 ] && echo "all arguments give the expected commands"
exit "$failures"
