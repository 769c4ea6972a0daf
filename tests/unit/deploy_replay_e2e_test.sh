#!/usr/bin/env bash
# End to end: records a run with a window, and replays it in one. deploy_replay_e2e_test.sh BIN
# Exit code 77: cannot run here.
set -u
bin=$1
command -v Xvfb >/dev/null || { echo "skipped: Xvfb is missing"; exit 77; }
[ -x "$bin/tact-gui" ] || { echo "skipped: this build has no tact-gui"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
export TACT_RUNTIME_DIR=$scratch XDG_CACHE_HOME=$scratch/cache
unset DISPLAY WAYLAND_DISPLAY
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
fail() { echo "$1"; cat "$scratch/said"; exit 1; }

"$bin/tact" demo dock --headless --seconds 8 --size 960x600 --session e2e --quiet --record "$scratch/run.h5" \
    --flight "$scratch/flights" >"$scratch/said" 2>&1 || fail "the run failed"
grep -q "from the controller's start; 0 records lost" "$scratch/said" || fail "the recording is incomplete"
"$bin/tact" replay "$scratch/run.h5" >"$scratch/said" 2>&1 || fail "the replay is not bit-exact"
cat "$scratch/said"
"$bin/tact" replay "$scratch/run.h5" --show --headless --speed 2 --size 960x600 --seconds 6 \
    --screenshot "$scratch/shown.png" >"$scratch/said" 2>&1
code=$?
[ "$code" -eq 0 ] || fail "the replay in the window failed: exit code $code"
grep -q "every force is bit-exact" "$scratch/said" || fail "the displayed replay is not bit-exact"
[ -s "$scratch/shown.png" ] || fail "the screenshot is missing"
cat "$scratch/said"
[ -z "${TACT_KEEP_PICTURE:-}" ] || cp "$scratch/shown.png" "$TACT_KEEP_PICTURE"

# A person pauses the replay, and goes on live from that moment.
command -v xdotool >/dev/null || { echo "xdotool is missing: not tried by hand"; exit 0; }
export XDG_STATE_HOME=$scratch/state LIBGL_ALWAYS_SOFTWARE=1
mkfifo "$scratch/display"
Xvfb -displayfd 3 -screen 0 1280x800x24 3>"$scratch/display" 2>/dev/null &
x=$!
read -r number <"$scratch/display" || fail "Xvfb did not start"
export DISPLAY=:$number
"$bin/tact" replay "$scratch/run.h5" --show --session byhand --size 1280x800 >"$scratch/said" 2>&1 &
replay=$!
trap 'kill -INT $replay 2>/dev/null; wait $replay; kill $x; rm -rf "$scratch"' EXIT
for _ in $(seq 300); do xdotool search --name "replay of run.h5" >/dev/null 2>&1 && break; sleep 0.1; done
sleep 3
xdotool mousemove 800 300 key space
sleep 1
xdotool mousemove 1230 558 click 1  # "Run from here"
for _ in $(seq 300); do "$bin/tact" status 2>/dev/null | grep -q ready && break; sleep 0.1; done
"$bin/tact" status 2>/dev/null | grep -q ready || fail "no live run, or it is armed: $("$bin/tact" status 2>&1)"
grep -q "live from this moment of the recording: tact run .*/run-[0-9.]*s[.]tact-session --disarmed" "$scratch/said" || fail "the live run was not named"
grep -o "live from .*" "$scratch/said"
