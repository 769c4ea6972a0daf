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
