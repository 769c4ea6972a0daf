#!/usr/bin/env python3
"""Saves six copies of each published structure in its map, opens them again in a fresh scene, and compares.

save_pairs_test.py BIN [--runs] [PAIR...]: BIN: folder of tact-prep; PAIR: part of a map's name; default: all pairs.
With --runs, whole runs of tact place the pair's own structures, save them, and run again with the saved files. Exit code 77: no data
(TACT_SHARED/data/em, or ../shared beside the repository).
"""
import csv, gzip, json, math, os, random, subprocess, sys, tempfile

PAIRS = [
    ("emd_1080_groel_11.5A.mrc", ["1kp8A_fitted_in_emd_1080.pdb"], 11.5),
    ("emd_5168_factin.map", ["3MFP.pdb"], 6.6),
    ("emd_5168_factin.map", ["1J6Z_fitted_in_emd_5168.pdb"], 6.6),
    ("emd_5778_monomer.situs.gz", ["emd_5778_native.pdb"], 3.3),
    ("emd_5925_monomer.situs.gz", ["emd_5925_native.pdb"], 4.0),
    ("sim_1oel_10A.mrc", ["1oel.pdb.gz"], 10.0),
    ("sim_1z5s_20A.mrc", ["sim_1z5s.pdb"], 20.0),
    ("sim_1gte_A_20A.mrc", ["sim_1gte_d%d.pdb" % d for d in range(1, 6)], 20.0),
    ("sim_2dqj_10A.mrc", ["sim_2dqj.pdb"], 10.0),
    ("sim_1akeA_10A.mrc", ["sim_1akeA.pdb"], 10.0),
]


def prep(*arguments):
    done = subprocess.run([os.path.join(sys.argv[1], "tact-prep"), *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit("tact-prep %s: exit code %d\n%s" % (arguments[0], done.returncode, done.stderr))
    return done.stdout


def bake(map_path, models, resolution_a, scene):
    prep("dock", map_path, *models, "-o", scene, "--resolution-a", resolution_a, "--vertices-max", 2000)
    return json.loads(prep("info", scene, "--json"))


def atoms(path):
    opener = gzip.open if path.endswith(".gz") else open
    with opener(path, "rt") as lines:
        return [(l[:30], [float(l[30:38]), float(l[38:46]), float(l[46:54])], l[54:66])
                for l in lines if l.startswith(("ATOM  ", "HETATM"))]


def random_quaternion(rng):
    q = [rng.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(v * v for v in q))
    return [v / n for v in q]


def turned(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]]


def check(em, map_name, models, resolution_a, scratch):
    rng = random.Random(map_name + models[0])
    paths = [os.path.join(em, m) for m in models]
    before = [open(p, "rb").read() for p in paths]
    info = bake(os.path.join(em, map_name), paths, resolution_a, os.path.join(scratch, "first.tact"))
    homes = [[c * 1e10 for c in b["home_com_model_m"]] for b in info["bodies"]]
    grid = info["grid"]
    middle = [1e10 * (o + 0.5 * n * s) for o, n, s in zip(grid["origin_m"], grid["size"], grid["spacing_m"])]
    bodies = []
    for i in range(max(6, len(models))):
        structure = i % len(models)
        place = homes[structure] if i < len(models) else [m + rng.uniform(-20, 20) for m in middle]
        q = [0, 0, 0, 1] if i < len(models) else random_quaternion(rng)
        bodies.append({"id": i + 1, "structure": structure, "name": models[structure], "pos_model_a": place,
                       "quat_model_body_xyzw": q})
    json.dump({"bodies": bodies}, open(os.path.join(scratch, "poses.json"), "w"))
    folder = os.path.join(scratch, "saved")
    prep("export", os.path.join(scratch, "first.tact"), "--poses", os.path.join(scratch, "poses.json"), "-o", folder,
         "--combined")
    rows = list(csv.DictReader(open(os.path.join(folder, "bodies.csv"))))
    worst = count = 0
    for body, row in zip(bodies, rows):
        saved, original = atoms(os.path.join(folder, row["file"])), atoms(paths[body["structure"]])
        assert len(saved) == len(original)
        for (head, at, tail), (head0, at0, tail0) in zip(saved, original):
            assert head == head0 and tail == tail0, (head, head0)
            there = turned(body["quat_model_body_xyzw"], [a - h for a, h in zip(at0, homes[body["structure"]])])
            worst = max(worst, *(abs(a - t - p) for a, t, p in zip(at, there, body["pos_model_a"])))
            count += 1
        matrix = [[float(row["m%d%d" % (r, c)]) for c in (1, 2, 3)] + [float(row["m%d4_a" % r])] for r in (1, 2, 3)]
        at0, at = original[-1][1], saved[-1][1]
        for r in range(3):
            assert abs(sum(matrix[r][c] * at0[c] for c in range(3)) + matrix[r][3] - at[r]) < 0.001
    assert worst <= 0.001, worst
    # A fresh scene of the saved files has the bodies, unrotated, at their saved positions, with the same fit.
    fresh = bake(os.path.join(em, map_name), [os.path.join(folder, r["file"]) for r in rows], resolution_a,
                 os.path.join(scratch, "second.tact"))
    drift = max(abs(1e10 * c - p) for b, f in zip(bodies, fresh["bodies"])
                for c, p in zip(f["home_com_model_m"], b["pos_model_a"]))
    assert drift <= 0.001, drift
    homes2 = [[c * 1e10 for c in b["home_com_model_m"]] for b in fresh["bodies"]]
    again = [{"id": i + 1, "structure": i, "pos_model_a": h, "quat_model_body_xyzw": [0, 0, 0, 1]} for i, h in enumerate(homes2)]
    json.dump({"bodies": again}, open(os.path.join(scratch, "again.json"), "w"))
    prep("export", os.path.join(scratch, "second.tact"), "--poses", os.path.join(scratch, "again.json"), "-o", folder + "2")
    fits = list(csv.DictReader(open(os.path.join(folder + "2", "bodies.csv"))))
    apart = max(abs(float(a[k]) - float(b[k])) for a, b in zip(rows, fits) for k in ("cc_zero", "cc_mean", "fraction_inside"))
    assert apart < 0.002, apart
    assert before == [open(p, "rb").read() for p in paths], "an input was changed"
    print("%-26s %d bodies, %6d atoms; worst atom %.5f A, centre %.5f A, fit %.6f; first cc about mean %s"
          % (map_name, len(bodies), count, worst, drift, apart, rows[0]["cc_mean"]), flush=True)


def run(out, arguments):
    """One run without a window; retried with more time if the machine was too busy to read the controller's state."""
    for seconds in (1, 10, 60):
        done = subprocess.run([os.path.join(sys.argv[1], "tact"), "dock", *map(str, arguments), "--no-gui", "--quiet",
                               "--seconds", str(seconds), "--json", out], capture_output=True, text=True)
        if done.returncode == 0 and json.load(open(out)).get("fit"):
            return json.load(open(out))
        if "never said where" not in done.stderr and done.returncode != 0:
            sys.exit("tact dock: exit code %d\n%s" % (done.returncode, done.stderr))
    sys.exit("the controller's state was never read")


def check_runs(em, map_name, models, resolution_a, scratch):
    os.environ["TACT_RUNTIME_DIR"] = scratch
    os.environ["XDG_CACHE_HOME"] = os.path.join(scratch, "cache")
    folder = os.path.join(scratch, "saved")
    common = ["--resolution-a", resolution_a, "--vertices-max", 2000]
    first = run(os.path.join(scratch, "first.json"),
                [os.path.join(em, map_name), *[os.path.join(em, m) for m in models], *common, "--save", folder,
                 "--start-offset-a", 3, "--start-rotation-deg", 10])
    poses = json.load(open(os.path.join(folder, "poses.json")))["bodies"]
    rows = list(csv.DictReader(open(os.path.join(folder, "bodies.csv"))))
    assert len(rows) == len(models)
    for body, row in zip(poses, rows):
        assert all(abs(p - float(row[k])) < 0.001 for p, k in zip(body["pos_model_a"], ("com_x_a", "com_y_a", "com_z_a")))
    second = run(os.path.join(scratch, "second.json"),
                 [os.path.join(em, map_name), *[os.path.join(folder, r["file"]) for r in rows], *common])
    saved, again = first["fit"], second["fit"]["at_file_place"]
    apart = max(abs(saved[k] - again[k]) for k in ("cc_zero", "cc_mean", "fraction_inside"))
    assert apart < 0.002, apart
    print("%-26s %d bodies; a run ends with the first %.2f A, %.2f deg from the pose in its file; cc about mean %.5f, in a fresh run %.5f"
          % (map_name, len(rows), saved["offset_a"], saved["angle_deg"], saved["cc_mean"], again["cc_mean"]), flush=True)


shared = os.environ.get("TACT_SHARED", os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "shared"))
em = os.path.join(shared, "data", "em")
if not os.path.isdir(em):
    print("the folder of real data is absent (set TACT_SHARED)")
    sys.exit(77)
wanted = [a for a in sys.argv[2:] if not a.startswith("--")]
for name, models, resolution in PAIRS:
    if not wanted or any(part in name for part in wanted):
        with tempfile.TemporaryDirectory() as scratch:
            (check_runs if "--runs" in sys.argv else check)(em, name, models, resolution, scratch)
