#!/usr/bin/env python3
"""`tact bench governor` bakes scenes of a part of the work, keeps them, uses them again, and measures a row on one.

bench_governor_scenes_test.py BIN
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROW = ("scene", "atoms", "rate_hz", "level", "fault", "deadline_miss_share", "level_settled_s", "force_error_n_p50", "force_step_n_max",
       "best_fixed_level", "on_time", "settled", "accurate", "smooth", "passed", "adaptive_runs", "core_speed_spread", "core_quiet")


def main(bin_dir):
    with tempfile.TemporaryDirectory(prefix="tact-bench-test-") as name:
        folder = pathlib.Path(name)
        env = {**os.environ, "TACT_RUNTIME_DIR": name, "XDG_STATE_HOME": str(folder / "state"), "XDG_CACHE_HOME": str(folder / "cache")}

        def bench(*words):
            return subprocess.run([os.path.join(bin_dir, "tact"), "bench", "governor", "--json", *map(str, words)], capture_output=True,
                                  text=True, env=env)

        def baked(work):
            done = bench("--bake-only", "--work", work, "--scene", "drilling", "--folder", folder / "scenes")
            assert done.returncode == 0, done.stderr
            (scene,) = json.loads(done.stdout)["governor_scenes"]
            assert pathlib.Path(scene).parent == folder / "scenes", scene
            said = subprocess.run([os.path.join(bin_dir, "tact-prep"), "info", "--json", scene], capture_output=True, text=True, env=env)
            return pathlib.Path(scene), json.loads(said.stdout)["bone"]

        # The ball's surface meets a part of the voxels: edges go with the root of the work, and the bone stays as large.
        scene, bone = baked(0.01)
        twice, finer = baked(0.04)
        assert twice != scene
        for size, smaller in zip(finer["size"], bone["size"]):
            assert abs(size - 2 * smaller) <= 2, (finer, bone)
        assert math.isclose(bone["voxel_m"], 2 * finer["voxel_m"], rel_tol=1e-3), (finer, bone)

        # A scene that is there is used as it is.
        before = scene.stat()
        assert baked(0.01)[0] == scene and scene.stat().st_mtime_ns == before.st_mtime_ns and scene.stat().st_ino == before.st_ino
        assert sorted(scene.parent.iterdir()) == sorted([scene, twice])

        for words, names in ((("--work", 0), "--work"), (("--work", 2), "--work"), (("--bake-only",), "--folder")):
            done = bench(*words)
            assert done.returncode == 2 and names in done.stderr, (words, done.returncode, done.stderr)

        done = bench("--work", 0.01, "--scene", "drilling", "--folder", scene.parent, "--rate", 500, "--seconds", 1)
        assert done.returncode in (0, 1), done.stderr
        said = json.loads(done.stdout)
        (row,) = said["governor"]
        assert not [key for key in ROW if key not in row], row
        assert row["scene"] == "drilling" and row["rate_hz"] == 500 and row["adaptive_runs"] >= 1, row
        assert said["governor_passed"] == row["passed"] == all(row[key] for key in ("on_time", "settled", "accurate", "smooth")), said
        assert scene.stat().st_mtime_ns == before.st_mtime_ns
        print("a row:", json.dumps(row))


main(sys.argv[1])
