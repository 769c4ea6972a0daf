#!/usr/bin/env python3
"""`tact dock SCENE MODEL` bakes a scene again with one more structure, and goes on with its bodies where they were.

deploy_add_structure_test.py BIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from deploy_dock_cache_test import ball, map_file


def rod(x_a):
    return "".join("ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n" % (i, i, x_a + i, 24 + i % 3, 24)
                   for i in range(1, 13))


class Bench:
    def __init__(self, bin_dir, folder):
        self.tact, self.folder = os.path.join(bin_dir, "tact"), folder
        self.env = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache"), "TACT_RUNTIME_DIR": str(folder)}
        (folder / "map.mrc").write_bytes(map_file(ball))
        (folder / "mask.mrc").write_bytes(map_file(lambda x, y, z: 1.0 if x < 16 else 0.0))
        (folder / "a.pdb").write_text(rod(18))
        (folder / "b.pdb").write_text(rod(14))
        (folder / "far.pdb").write_text(rod(400))

    def run(self, *words):
        return subprocess.run([self.tact, *map(str, words)], cwd=self.folder, capture_output=True, text=True, env=self.env)

    def bake(self, *words):
        done = self.run("dock", *words, "--bake-only")
        assert done.returncode == 0, done.stderr
        return done.stdout.strip().splitlines()[-1]

    def refused(self, *words):
        done = self.run("dock", *words, "--bake-only")
        assert done.returncode != 0 and "fix:" in done.stderr, (words, done.stdout, done.stderr)
        return done.stderr

    def bodies(self, *words):
        report = self.folder / "run.json"
        done = self.run(*words, "--no-gui", "--disarmed", "--seconds", "0.5", "--quiet", "--session", "add", "--json", report)
        assert done.returncode == 0, done.stderr + done.stdout
        return json.loads(report.read_text())["bodies"]

    def note(self, scene):
        return json.loads(self.run("info", scene, "--json").stdout)


def apart_a(a, b):
    return max(abs(x - y) for x, y in zip(a["pos_model_a"], b["pos_model_a"]))


def adds_with_the_same_map_and_options(bench):
    scene = bench.bake("map.mrc", "a.pdb", "--resolution-a", "9.3", "--mask", "mask.mrc", "--contour", "20.5", "--modes", "3")
    first, second = bench.note(scene), bench.note(bench.bake(scene, "b.pdb"))
    assert [s["name"] for s in second["bodies"]] == ["a.pdb", "b.pdb"], second
    for key in ("map", "centre_model_m", "world_per_model"):
        assert first.get(key) == second.get(key), (key, first.get(key), second.get(key))
    again = bench.note(bench.bake(bench.bake(scene, "b.pdb"), "far.pdb", "b.pdb"))
    assert [s["name"] for s in again["bodies"]] == ["a.pdb", "b.pdb", "far.pdb", "b.pdb"], again
    return scene


def keeps_poses_and_places_the_new_body(bench, scene):
    placed = [dict(b, pos_model_a=[30.0, 20.0, 26.0], fixed=True) for b in bench.bodies("run", scene)]
    checksum = bench.note(scene)["checksum"]
    session = bench.folder / "s.tact-session"
    session.write_text(json.dumps({
        "tact_session": 1, "scene": {"path": scene, "checksum": checksum}, "bodies": placed,
        "places": [{"name": "here", "bodies": [{"id": 1, "pos_model_a": [30.0, 20.0, 26.0], "quat_model_body_xyzw": [0, 0, 0, 1]}]}]}))
    for model, beside in (("b.pdb", False), ("far.pdb", True)):
        old, new = bench.bodies("dock", session, model)
        assert apart_a(old, placed[0]) < 1e-3 and old["fixed"] and not old["in_hand"], old
        assert new["name"] == model and new["in_hand"] and not new["fixed"], new
        assert (new["offset_a"] > 100.0) == beside and (beside or new["offset_a"] < 1e-3), new
        assert not beside or 46.0 < new["pos_model_a"][0] < 100.0, new
    # Without a session: the structures as in their files, and a body that is far away beside the map.
    extended = bench.bake(scene, "far.pdb")
    first, beside = bench.bodies("run", extended)
    assert first["offset_a"] < 1e-3 and 46.0 < beside["pos_model_a"][0] < 100.0, (first, beside)


def refuses(bench, scene):
    assert "is an option of its map" in bench.refused(scene, "b.pdb", "--resolution-a", "7")
    assert "more than 16" in bench.refused(scene, *["b.pdb"] * 16)
    assert "far.pdb lies" in bench.refused("map.mrc", "far.pdb", "--resolution-a", "9")
    demo = bench.folder / "demo.tact"
    subprocess.run([bench.tact + "-prep", "demo", "dock", "-o", demo], check=True, capture_output=True, env=bench.env)
    assert "does not record the files" in bench.refused(demo, "b.pdb")
    field = bench.folder / "field.tact"
    subprocess.run([bench.tact + "-prep", "demo", "field", "-o", field], check=True, capture_output=True, env=bench.env)
    assert "field scene" in bench.refused(field, "b.pdb")
    for name, role in (("mask.mrc", "mask"), ("map.mrc", "map"), ("a.pdb", "structure")):
        kept = (bench.folder / name).read_bytes()
        with open(bench.folder / name, "ab") as f:
            f.write(b"\n")
        said = bench.refused(scene, "b.pdb")
        assert "its %s, the file" % role in said and "has changed" in said, said
        os.remove(bench.folder / name)
        said = bench.refused(scene, "b.pdb")
        assert name in said and "no longer there" in said, said
        (bench.folder / name).write_bytes(kept)


def main():
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(sys.argv[1], pathlib.Path(name))
        scene = adds_with_the_same_map_and_options(bench)
        keeps_poses_and_places_the_new_body(bench, scene)
        refuses(bench, scene)
    print("passed")


if __name__ == "__main__":
    main()
