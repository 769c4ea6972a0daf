#!/usr/bin/env bash
# End to end: the docking demo without a display, with the programs of one build. deploy_e2e_test.sh BIN
# The force moves the hand from 15 A and 30 degrees away towards the pose of the file; exit code 77: cannot run here.
set -u
bin=$1
command -v Xvfb >/dev/null || { echo "skipped: Xvfb is missing"; exit 77; }
[ -x "$bin/tact-gui" ] || { echo "skipped: this build has no tact-gui"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
export TACT_RUNTIME_DIR=$scratch XDG_CACHE_HOME=$scratch/cache
unset DISPLAY WAYLAND_DISPLAY
# The software renderer leaks memory, and is unloaded before the leak checker resolves symbols.
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0

# The controller arms after the first frame, which takes longer on a busy machine or with sanitizers.
for seconds in 4 15 60 150; do
    "$bin/tact" demo dock --headless --seconds "$seconds" --session e2e --size 960x600 --out "$scratch/out" \
        >"$scratch/said" 2>&1
    code=$?
    [ "$code" -eq 0 ] && [ "$(grep -c ',active,' "$scratch/out/run.csv")" -lt 15 ] || break
done
python3 - "$scratch/out" "$code" <<'PY' || { cat "$scratch/said"; exit 1; }
import csv, json, os, struct, sys
folder, code = sys.argv[1], int(sys.argv[2])
assert code == 0, f"exit code {code}"
report = json.load(open(os.path.join(folder, "run.json")))
assert report["ended"]["ok"], report["ended"]
assert report["force_rate_hz"] > 0 and report["servo"]["lateness_us"]["count"] > 0
assert report["servo"]["allocations"] == 0 and report["servo"]["locks"] == 0, report["servo"]
assert report["gui"]["ran"] and report["gui"]["vertices"] > 0, report["gui"]
assert report["governor"]["law"] == "elastic", report["governor"]
fit = report["fit"]
assert abs(fit["at_start"]["offset_a"] - 15) < 0.01 and abs(fit["at_start"]["angle_deg"] - 30) < 0.01, fit["at_start"]
assert fit["offset_a"] < fit["at_start"]["offset_a"], fit
assert fit["cc_zero"] > fit["at_start"]["cc_zero"] and fit["cc_mean"] > fit["at_start"]["cc_mean"], fit
png = open(os.path.join(folder, "run.png"), "rb").read()
assert png[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", png[16:24]) == (960, 600), png[:24]
rows = list(csv.DictReader(open(os.path.join(folder, "run.csv"))))
# The first row may be active already: the controller arms with the first frame.
assert len(rows) > 10 and any(r["state"] == "active" for r in rows), (len(rows), rows[:1], rows[-1:])
print("from %.1f A to %.2f A, cc about zero %.3f" % (fit["at_start"]["offset_a"], fit["offset_a"], fit["cc_zero"]))
PY
# No process is left.
for name in tact-rt tact-gui Xvfb; do
    for pid in $(pgrep -x "$name"); do
        if tr '\0' '\n' <"/proc/$pid/environ" 2>/dev/null | grep -qx "TACT_RUNTIME_DIR=$scratch"; then
            echo "$name $pid is still running"
            exit 1
        fi
    done
done
