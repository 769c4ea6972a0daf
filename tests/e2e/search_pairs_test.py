#!/usr/bin/env python3
"""Search and refinement on real pairs of a map and a structure: the right place comes first, from any start.

search_pairs_test.py BIN [PAIR...]     BIN holds tact-search and tact-refine; exit code 77: the folder of real data is absent

The structures are moved by a random rotation and shift before the search, so that nothing can be had from the file's place.
"""
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("TACT_SHARED", ROOT.parent / "shared")) / "data" / "em"
# name: map, resolution, structures searched alone
PAIRS = {
    "1ake": ("sim_1akeA_10A.mrc", 10, ["sim_1akeA.pdb"]),
    "2dqj": ("sim_2dqj_10A.mrc", 10, ["sim_2dqj.pdb"]),
    "1gte": ("sim_1gte_A_20A.mrc", 20, [f"sim_1gte_d{i}.pdb" for i in range(1, 6)]),
    "5925": ("emd_5925_monomer.situs.gz", 4, ["emd_5925_native.pdb"]),
    "5778": ("emd_5778_monomer.situs.gz", 3.3, ["emd_5778_native.pdb"]),
}
RIGHT_A = 3.0


def rotation(axis, angle):
    x, y, z = (v / math.sqrt(sum(a * a for a in axis)) for v in axis)
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    return [[c + x * x * d, x * y * d - z * s, x * z * d + y * s],
            [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
            [z * x * d - y * s, z * y * d + x * s, c + z * z * d]]


def times(m, p):
    return [sum(m[r][k] * p[k] for k in range(3)) for r in range(3)]


def atoms(path):
    return [[float(line[30 + 8 * k:38 + 8 * k]) for k in range(3)]
            for line in path.read_text().splitlines() if line.startswith(("ATOM", "HETATM"))]


def moved_copy(path, folder, turn, shift):
    """The structure turned about its middle and shifted."""
    places = atoms(path)
    middle = [sum(p[k] for p in places) / len(places) for k in range(3)]
    lines = []
    for line in path.read_text().splitlines():
        if not line.startswith(("ATOM", "HETATM")):
            continue
        p = [float(line[30 + 8 * k:38 + 8 * k]) - middle[k] for k in range(3)]
        q = [v + middle[k] + shift[k] for k, v in enumerate(times(turn, p))]
        lines.append(line[:30] + "".join(f"{v:8.3f}" for v in q) + line[54:])
    out = folder / path.name
    out.write_text("\n".join(lines) + "\nEND\n")
    return out


def rmsd(matrix, of, right):
    total = 0.0
    for p, r in zip(of, right):
        q = [sum(matrix[4 * i + k] * p[k] for k in range(3)) + matrix[4 * i + 3] for i in range(3)]
        total += sum((a - b) ** 2 for a, b in zip(q, r))
    return math.sqrt(total / len(of))


def run(program, *arguments):
    return json.loads(subprocess.run([program, *map(str, arguments), "--json", "-"], check=True,
                                     capture_output=True, text=True).stdout)


def main():
    programs = pathlib.Path(sys.argv[1])
    if not DATA.is_dir():
        print("skipped: the folder of real data is absent (set TACT_SHARED)")
        return 77
    random.seed(20261126)
    wrong = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for name in sys.argv[2:] or PAIRS:
            map_name, resolution, models = PAIRS[name]
            for model in models:
                turn = rotation([random.gauss(0, 1) for _ in range(3)], random.uniform(0.5, math.pi))
                start = moved_copy(DATA / model, folder, turn, [random.uniform(-40, 40) for _ in range(3)])
                found = run(programs / "tact-search", DATA / map_name, start, "--resolution-a", resolution)
                hits = found["hits"]
                far = rmsd(hits[0]["matrix"], atoms(start), atoms(DATA / model))
                print(f"search {model}: {far:.2f} A, score {hits[0]['score']:.3f}, second {hits[1]['score']:.3f}, "
                      f"z {hits[0]['z']:.1f}, {found['searches'][0]['seconds']:.0f} s")
                wrong += far > RIGHT_A or [h["rank"] for h in hits] != list(range(1, len(hits) + 1))
                near = moved_copy(DATA / model, folder, rotation([1, 2, 3], math.radians(20)), [6, -5, 6])
                body = run(programs / "tact-refine", DATA / map_name, near, "--resolution-a", resolution)["bodies"][0]
                back = rmsd(body["matrix"], atoms(near), atoms(DATA / model))
                print(f"refine {model}: {back:.2f} A, score {body['score_before']:.3f} to {body['score_after']:.3f}")
                wrong += back > RIGHT_A or body["score_after"] < body["score_before"]
    return 1 if wrong else 0


sys.exit(main())
