#!/usr/bin/env python3
"""`tact dock` bakes again when a file that an option names has changed, and refuses a map without a resolution.

deploy_dock_cache_test.py BIN
"""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

SIDE = 24


def map_file(value):
    header = bytearray(1024)
    struct.pack_into("<10i", header, 0, SIDE, SIDE, SIDE, 2, 0, 0, 0, SIDE, SIDE, SIDE)
    struct.pack_into("<6f3i", header, 40, 2.0 * SIDE, 2.0 * SIDE, 2.0 * SIDE, 90, 90, 90, 1, 2, 3)
    header[208:216] = b"MAP \x44\x41\0\0"
    values = [value(x, y, z) for z in range(SIDE) for y in range(SIDE) for x in range(SIDE)]
    return bytes(header) + struct.pack("<%df" % len(values), *values)


def ball(x, y, z):
    return max(0.0, 60.0 - (x - 12) ** 2 - (y - 12) ** 2 - (z - 12) ** 2)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "map.mrc").write_bytes(map_file(ball))
        (folder / "a.pdb").write_text("".join(
            "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n" % (i, i, 18 + i, 24 + i % 3, 24)
            for i in range(1, 13)))
        mask = folder / "mask.mrc"

        def dock(*options):
            return subprocess.run([os.path.join(sys.argv[1], "tact"), "dock", "map.mrc", "a.pdb", *options, "--bake-only"],
                                  cwd=folder, capture_output=True, text=True, env={**os.environ, "XDG_CACHE_HOME": name})

        def scene(*options):
            done = dock(*options)
            assert done.returncode == 0, done.stderr
            return done.stdout.strip().splitlines()[-1]

        refused = dock()
        assert refused.returncode != 0 and "resolution is unknown" in refused.stderr, refused
        mask.write_bytes(map_file(lambda x, y, z: 1.0 if x < 14 else 0.0))
        plain, masked = scene("--resolution-a", "9"), scene("--resolution-a", "9", "--mask", "mask.mrc")
        assert plain != masked
        assert masked == scene("--resolution-a", "9", "--mask", "mask.mrc"), "the same files give the same scene"
        mask.write_bytes(map_file(lambda x, y, z: 1.0 if x < 16 else 0.0))
        assert masked != scene("--resolution-a", "9", "--mask", "mask.mrc"), "the old mask's scene was used"
        missing = dock("--mask", "none.mrc", "--resolution-a", "9")
        assert missing.returncode != 0 and "none.mrc" in missing.stderr, missing
    print("passed")


if __name__ == "__main__":
    main()
