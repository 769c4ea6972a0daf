#!/usr/bin/env bash
# End to end: a run is recorded with a window, and shown again in one. deploy_replay_e2e_test.sh BIN
# Exit code 77: cannot be tried here.
set -u
bin=$1
command -v Xvfb >/dev/null || { echo "there is no Xvfb"; exit 77; }
[ -x "$bin/tact-gui" ] || { echo "there is no tact-gui in this build"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
export TACT_RUNTIME_DIR=$scratch XDG_CACHE_HOME=$scratch/cache
unset DISPLAY WAYLAND_DISPLAY
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
fail() { echo "$1"; cat "$scratch/said"; exit 1; }

"$bin/tact" demo dock --headless --seconds 8 --size 960x600 --session e2e --quiet --record "$scratch/run.h5" \
    --flight "$scratch/flights" >"$scratch/said" 2>&1 || fail "the run failed"
grep -q "from the controller's start; 0 records lost" "$scratch/said" || fail "the recording is not whole"
"$bin/tact" replay "$scratch/run.h5" >"$scratch/said" 2>&1 || fail "the replay is not the same"
cat "$scratch/said"
"$bin/tact" replay "$scratch/run.h5" --show --headless --speed 2 --size 960x600 --seconds 6 \
    --screenshot "$scratch/shown.png" >"$scratch/said" 2>&1
code=$?
[ "$code" -eq 0 ] || fail "showing it failed: exit code $code"
grep -q "the same to the bit" "$scratch/said" || fail "shown, it was not the same"
[ -s "$scratch/shown.png" ] || fail "there is no picture of it"
cat "$scratch/said"
[ -z "${TACT_KEEP_PICTURE:-}" ] || cp "$scratch/shown.png" "$TACT_KEEP_PICTURE"
