#!/usr/bin/env bash
# End to end: the drilling demo without a display, with the programs of one build. deploy_drill_e2e_test.sh BIN
# The emulated surgeon removes bone, and window and controller agree on the volume; as a training task with its report.
# Exit code 77: cannot run here.
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
for seconds in 10 30 120; do
    rm -rf "$scratch/training"
    "$bin/tact" demo train --trainee "A, B" --training-folder "$scratch/training" --voxels 80 --headless --seconds "$seconds" --session e2e --size 960x600 \
        --out "$scratch/out" --quiet >"$scratch/said" 2>&1
    code=$?
    [ "$code" -eq 0 ] && ! grep -q '"cutting_s": [1-9]' "$scratch/out/run.json" || break
done
python3 - "$scratch/out" "$code" "$scratch/said" <<'PY' || { cat "$scratch/said"; exit 1; }
import json, os, struct, sys
folder, code, said = sys.argv[1], int(sys.argv[2]), open(sys.argv[3]).read()
assert code == 0, f"exit code {code}"
report = json.load(open(os.path.join(folder, "run.json")))
assert report["ended"]["ok"], report["ended"]
assert report["servo"]["allocations"] == 0 and report["servo"]["locks"] == 0, report["servo"]
drilling = report["drilling"]
assert abs(drilling["burr"]["diameter_mm"] - 6) < 1e-3 and abs(drilling["suction_tube"]["diameter_mm"] - 2) < 1e-3, drilling
trainee = drilling["trainee"]
assert trainee["drilling_s"] >= trainee["cutting_s"] >= 1, trainee
assert trainee["strokes"]["count"] >= 1 and trainee["force"]["max_n"] > 0.1, trainee
# Volume lost by the bricks and volume counted by the controller; the window ends a little earlier.
assert drilling["removed_mm3"] > 5, drilling
assert 0.8 * drilling["removed_mm3"] < trainee["removed_mm3"] <= drilling["removed_mm3"] + 1e-9, (drilling, trainee)
by_structure = trainee["removed_bone_mm3"] + sum(s["removed_mm3"] for s in trainee["structures"])
assert abs(by_structure - trainee["removed_mm3"]) < 1e-6, trainee
names = [s["name"] for s in trainee["structures"]]
assert "facial nerve" in names and "sigmoid sinus" in names, names
assert all(s["nearest_mm"] is not None for s in trainee["structures"] if s["critical"]), trainee
assert "bone removed:" in said and "strokes:" in said and "near critical structures:" in said, said
assert "training: " in said and " of 100 points" in said, said
page = trainee["training"]["report"]
session = json.load(open(os.path.join(os.path.dirname(page), "report.json")))
assert session["trainee"] == "A, B" and abs(session["points"] - trainee["training"]["points"]) < 1e-9, session
# A part of the goal went, and no more bone than was removed is told of.
assert 0 < session["work_share"] <= 1 and 0 < session["parts"]["goal"]["points"] <= 40, session
assert session["performance"]["removed_mm3"] == trainee["removed_mm3"], session
html = open(page, encoding="utf-8").read()
pictures = [p.split('"')[0] for p in html.split("data:image/png;base64,")[1:]]
assert len(pictures) == 4 and len(set(pictures)) == 4, [len(p) for p in pictures]  # two views, before and after
import base64, csv
assert all(base64.b64decode(p)[:8] == b"\x89PNG\r\n\x1a\n" for p in pictures)
rows = list(csv.DictReader(open(os.path.join(os.path.dirname(os.path.dirname(page)), "training.csv"))))
assert len(rows) == 1 and rows[0]["trainee"] == "A, B" and abs(float(rows[0]["points"]) - session["points"]) < 0.06, rows
png = open(os.path.join(folder, "run.png"), "rb").read()
assert png[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", png[16:24]) == (960, 600), png[:24]
print("%.1f mm3 in %.1f s of drilling, %d strokes" %
      (drilling["removed_mm3"], trainee["drilling_s"], trainee["strokes"]["count"]))
PY
