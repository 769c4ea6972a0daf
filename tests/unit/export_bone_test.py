#!/usr/bin/env python3
"""Drilled bone for other programs: exported volumes and surfaces lie where the scan lies, and cavities are compared.

usage: export_bone_test.py TACT_PREP. Everything is checked by this file's own arithmetic: it writes the scan (oblique axes), the files of
drilled bone, and reads NRRD, NIfTI, STL and PLY by itself.
"""
import gzip
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

EDGE, STEP_MM = 40, 0.5
BALL = ((17.0, 21.0, 15.0), 9.0)  # of bone, in voxels of the scan; its middle is off the middle of the scan
ORIGIN_LPS = (12.0, -30.5, 101.25)


class Work:
    def __init__(self, prep):
        self.prep = os.path.abspath(prep)
        self.dir = tempfile.mkdtemp(prefix="tact_export_bone_")
        self.bad = 0

    def path(self, name):
        return os.path.join(self.dir, name)

    def run(self, *words):
        done = subprocess.run([self.prep, *map(str, words)], text=True, capture_output=True, timeout=120)
        return done.returncode, done.stdout, done.stderr

    def must(self, *words):
        code, out, err = self.run(*words)
        if code != 0:
            sys.exit("tact-prep %s: exit code %d\n%s%s" % (" ".join(map(str, words)), code, out, err))
        return out

    def claim(self, what, good, more=""):
        self.bad += not good
        print("%s %s%s" % ("ok  " if good else "FAIL", what, "" if good else ": " + str(more)))


def axes():
    """Columns, rows and slices of an oblique scan, in LPS: a rotation about (1, 2, 3) by 25 degrees."""
    n = [x / math.sqrt(14.0) for x in (1.0, 2.0, 3.0)]
    c, s = math.cos(math.radians(25.0)), math.sin(math.radians(25.0))
    rotation = [[c * (i == j) + (1 - c) * n[i] * n[j] + s * sum(e * n[k] for k, e in ((0, eps(i, j, 0)), (1, eps(i, j, 1)), (2, eps(i, j, 2))))
                 for j in range(3)] for i in range(3)]
    return [[rotation[row][a] for row in range(3)] for a in range(3)]


def eps(i, j, k):
    return -(i - j) * (j - k) * (k - i) / 2.0


def lps(voxel, steps, origin=ORIGIN_LPS):
    return [origin[r] + sum(voxel[a] * steps[a][r] for a in range(3)) for r in range(3)]


def distance(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)))


def write_scan(path):
    centre, radius = BALL
    values = bytearray()
    for z in range(EDGE):
        for y in range(EDGE):
            for x in range(EDGE):
                d = distance((x, y, z), centre)
                hu = max(-1000.0, min(1800.0, 1050.0 + 1500.0 * (radius - d)))
                values += struct.pack("<h", int(hu))
    steps = [[STEP_MM * c for c in axis] for axis in axes()]
    vectors = " ".join("(%.12g,%.12g,%.12g)" % tuple(s) for s in steps)
    header = ("NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: %d %d %d\nspace directions: %s\n"
              "kinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: (%.12g,%.12g,%.12g)\n\n") % (
                  EDGE, EDGE, EDGE, vectors, *ORIGIN_LPS)
    with open(path, "wb") as file:
        file.write(header.encode() + values)
    return lps(centre, steps)


def read_nrrd(path):
    with open(path, "rb") as file:
        header, data = file.read().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in header.decode().splitlines()[1:] if ": " in line and line[0] != "#")
    size = [int(n) for n in fields["sizes"].split()]
    vector = lambda text: [float(x) for x in text.strip("()").split(",")]
    steps = [vector(v) for v in fields["space directions"].split()]
    values = struct.unpack("<%dh" % (size[0] * size[1] * size[2]), gzip.decompress(data))
    return fields.get("space"), size, steps, vector(fields["space origin"]), values


def read_nifti(path):
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        data = file.read()
    dims = struct.unpack_from("<8h", data, 40)
    pixdim = struct.unpack_from("<8f", data, 76)
    qform, sform = struct.unpack_from("<2h", data, 252)
    b, c, d, x, y, z = struct.unpack_from("<6f", data, 256)
    rows = [struct.unpack_from("<4f", data, 280 + 16 * r) for r in range(3)]
    a = math.sqrt(max(0.0, 1.0 - b * b - c * c - d * d))
    turn = [[a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c]]
    scale = [pixdim[1], pixdim[2], pixdim[3] * (pixdim[0] or 1.0)]
    by_q = [[turn[r][k] * scale[k] for k in range(3)] + [(x, y, z)[r]] for r in range(3)]
    size = dims[1:4]
    values = struct.unpack_from("<%dh" % (size[0] * size[1] * size[2]), data, 352)
    return qform, sform, size, rows, by_q, values


def middle_of(size, values, least, to_mm):
    """Of the voxels of at least this value, weighted by their value above air."""
    sums, mass = [0.0, 0.0, 0.0], 0.0
    for i, v in enumerate(values):
        if v >= least:
            at = to_mm((i % size[0], i // size[0] % size[1], i // (size[0] * size[1])))
            sums = [s + p for s, p in zip(sums, at)]
            mass += 1.0
    return [s / mass for s in sums]


def read_stl(path):
    with open(path, "rb") as file:
        data = file.read()
    count = struct.unpack_from("<I", data, 80)[0]
    triangles = [[struct.unpack_from("<3f", data, 84 + 50 * t + 12 * (1 + k)) for k in range(3)] for t in range(count)]
    return data[:80].decode("ascii"), triangles, len(data) == 84 + 50 * count


def volume_and_middle(triangles):
    volume, moment = 0.0, [0.0, 0.0, 0.0]
    about = triangles[0][0]
    for a, b, c in triangles:
        a, b, c = ([p - q for p, q in zip(v, about)] for v in (a, b, c))
        v = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
        volume += v
        moment = [m + v * (p + q + r) / 4.0 for m, p, q, r in zip(moment, a, b, c)]
    return volume, [about[k] + moment[k] / volume for k in range(3)]


def closed(triangles):
    edges = {}
    for t in triangles:
        for k in range(3):
            key = (t[k], t[(k + 1) % 3])
            edges[key] = edges.get(key, 0) + 1
    return all(n == edges.get((b, a), 0) for (a, b), n in edges.items())


class Bone:
    """A baked scene as this file knows it: densities in the order of x, y, z, and the layout of its bricks."""

    def __init__(self, work, scene):
        info = json.loads(work.must("info", scene, "--json"))
        self.checksum, self.size, self.voxel_m = int(info["checksum"], 16), info["bone"]["size"], info["bone"]["voxel_m"]
        self.scene = scene
        work.must("export-bone", scene, "--volume", work.path("baked.nrrd"))
        self.space, size, self.steps, self.origin, values = read_nrrd(work.path("baked.nrrd"))
        assert size == self.size
        low, high = 300.0, 1800.0
        self.density = [max(0, min(255, round(255.0 * (v - low) / (high - low)))) for v in values]

    def at(self, x, y, z):
        return (z * self.size[1] + y) * self.size[0] + x

    def bricks(self, density):
        n = [(s + 7) // 8 for s in self.size]
        for b in range(n[0] * n[1] * n[2]):
            bx, by, bz = 8 * (b % n[0]), 8 * (b // n[0] % n[1]), 8 * (b // (n[0] * n[1]))
            yield bytes(density[self.at(bx + i % 8, by + i // 8 % 8, bz + i // 64)]
                        if bx + i % 8 < self.size[0] and by + i // 8 % 8 < self.size[1] and bz + i // 64 < self.size[2] else 0
                        for i in range(512))

    def write(self, path, density):
        """A file of drilled bone, as described beside its reader."""
        count = 1
        for s in self.size:
            count *= (s + 7) // 8
        head = b"TACTBON1" + struct.pack("<Q3IId", self.checksum, *self.size, count, self.voxel_m) + bytes(84)
        head += struct.pack("<I", zlib.crc32(head))
        frames = b""
        baked = list(self.bricks(self.density))
        changed = [(i, now) for i, now in enumerate(self.bricks(density)) if now != baked[i]]
        if changed:
            data = zlib.compress(b"".join(struct.pack("<I", i) for i, _ in changed) + b"".join(now for _, now in changed))
            frame = b"BRIK" + struct.pack("<IIIQI", 1, len(changed), zlib.crc32(data), len(data), 0)
            frames = frame + struct.pack("<I", zlib.crc32(frame)) + data
        with open(path, "wb") as file:
            file.write(head + frames)

    def drilled(self, centre, radius):
        out = list(self.density)
        for z in range(self.size[2]):
            for y in range(self.size[1]):
                for x in range(self.size[0]):
                    if distance((x, y, z), centre) < radius:
                        out[self.at(x, y, z)] = 0
        return out

    def taken(self, now):
        return {i for i, d in enumerate(self.density) if d >= 26 and 2 * now[i] <= d}

    def border(self, taken):
        w, wh = self.size[0], self.size[0] * self.size[1]
        return [i for i in taken if not all(i + s in taken for s in (1, -1, w, -w, wh, -wh))]

    def place(self, i):
        return (i % self.size[0], i // self.size[0] % self.size[1], i // (self.size[0] * self.size[1]))


def main():
    work = Work(sys.argv[1])
    try:
        middle = write_scan(work.path("scan.nrrd"))
        scene = work.path("ball.tact")
        work.must("drill", work.path("scan.nrrd"), "-o", scene)
        bone = Bone(work, scene)
        volumes(work, bone, middle)
        surfaces(work, bone, middle)
        compared(work, bone)
        refused(work, bone)
    finally:
        shutil.rmtree(work.dir)
    sys.exit(1 if work.bad else 0)


def volumes(work, bone, middle):
    work.claim("the NRRD volume is in LPS", bone.space == "left-posterior-superior", bone.space)
    _, size, steps, origin, values = read_nrrd(work.path("baked.nrrd"))
    found = middle_of(size, values, 1050, lambda v: lps(v, steps, origin))
    work.claim("NRRD: the ball is where the scan has it", distance(found, middle) < 0.1 * STEP_MM, (found, middle))
    work.claim("NRRD: values are Hounsfield units", min(values) == 300 and max(values) == 1800, (min(values), max(values)))
    handed = sum(steps[0][i] * (steps[1][(i + 1) % 3] * steps[2][(i + 2) % 3] - steps[1][(i + 2) % 3] * steps[2][(i + 1) % 3]) for i in range(3))
    work.claim("NRRD: not mirrored", handed > 0.0, handed)
    ras = [-middle[0], -middle[1], middle[2]]
    for name in ("baked.nii", "baked.nii.gz"):
        work.must("export-bone", bone.scene, "--volume", work.path(name))
        qform, sform, size, rows, by_q, values = read_nifti(work.path(name))
        for what, matrix in (("sform", rows), ("quaternion", by_q)):
            found = middle_of(size, values, 1050, lambda v: [sum(m * p for m, p in zip(r, (*v, 1.0))) for r in matrix])
            work.claim("%s: by its %s the ball is where the scan has it" % (name, what), distance(found, ras) < 0.1 * STEP_MM, (found, ras))
        work.claim("%s: both are of the scanner" % name, (qform, sform) == (1, 1), (qform, sform))
    # The file goes in again as it came out.
    work.must("drill", work.path("baked.nrrd"), "-o", work.path("again.tact"), "--threshold-hu", 300, "--solid-hu", 1800)
    work.must("export-bone", work.path("again.tact"), "--volume", work.path("again.nrrd"))
    _, size, steps, origin, values = read_nrrd(work.path("again.nrrd"))
    found = middle_of(size, values, 128, lambda v: lps(v, steps, origin))
    work.claim("imported again, the ball is in the same place", distance(found, middle) < 0.1 * STEP_MM, (found, middle))


def surfaces(work, bone, middle):
    work.must("export-bone", bone.scene, "--stl", work.path("bone.stl"))
    header, triangles, whole = read_stl(work.path("bone.stl"))
    work.claim("STL: a whole file that names its space", whole and "SPACE=LPS" in header and not header.startswith("solid"), header)
    work.claim("STL: closed, with one surface", closed(triangles), len(triangles))
    volume, found = volume_and_middle(triangles)
    # The surface is at 77 of 255: 753 HU, where the ball's radius is 9 + 297 / 1500 voxels.
    expected = 4.0 / 3.0 * math.pi * ((9.0 + (1050.0 - (300.0 + 1500.0 * 77.0 / 255.0)) / 1500.0) * STEP_MM) ** 3
    work.claim("STL: the ball's volume, with normals outwards", abs(volume / expected - 1.0) < 0.02, (volume, expected))
    work.claim("STL: the ball is where the scan has it", distance(found, middle) < 0.1 * STEP_MM, (found, middle))
    hole = (15.0, 18.0, 19.0)
    bone.write(work.path("hole.bone"), bone.drilled(hole, 4.2))
    out = json.loads(work.must("export-bone", bone.scene, "--bone", work.path("hole.bone"), "--cavity", work.path("hole.stl"), "--volume",
                               work.path("hole.nrrd"), "--json"))
    now = bone.drilled(hole, 4.2)
    levels = sum(b - n for b, n in zip(bone.density, now))
    work.claim("the removed volume is that of the voxels", abs(out["removed_mm3"] - levels / 255.0 * STEP_MM ** 3) < 1e-6, out)
    work.claim("and so is the cavity", abs(out["cavity_mm3"] - len(bone.taken(now)) * STEP_MM ** 3) < 1e-6, out)
    _, size, steps, origin, values = read_nrrd(work.path("hole.nrrd"))
    gone = {i for i, (v, d) in enumerate(zip(values, bone.density)) if d > 0 and v == 300}
    work.claim("in the exported volume exactly these voxels are empty", gone == {i for i, n in enumerate(now) if n == 0 and bone.density[i] > 0},
               len(gone))
    _, triangles, _ = read_stl(work.path("hole.stl"))
    volume, found = volume_and_middle(triangles)
    voxels = [lps(bone.place(i), steps, origin) for i in bone.taken(now)]
    expected = [sum(v[k] for v in voxels) / len(voxels) for k in range(3)]
    work.claim("the cavity's surface is closed and lies where it was drilled",
               closed(triangles) and distance(found, expected) < 0.1 * STEP_MM and abs(volume / out["cavity_mm3"] - 1.0) < 0.05,
               (found, expected, volume, out))


def compared(work, bone):
    a, b = bone.drilled((15.0, 18.0, 19.0), 4.2), bone.drilled((16.0, 19.5, 19.0), 3.4)
    bone.write(work.path("a.bone"), a)
    bone.write(work.path("b.bone"), b)
    out = json.loads(work.must("compare-bone", bone.scene, work.path("a.bone"), work.path("b.bone"), "--json", "--ply", work.path("a.ply")))
    taken_a, taken_b = bone.taken(a), bone.taken(b)
    dice = 2.0 * len(taken_a & taken_b) / (len(taken_a) + len(taken_b))
    work.claim("Dice", abs(out["dice"] - dice) < 1e-9 and 0.3 < dice < 0.9, (out["dice"], dice))
    work.claim("volumes", abs(out["cavity_mm3"] - len(taken_a) * STEP_MM ** 3) < 1e-6 and
               abs(out["expert_mm3"] - len(taken_b) * STEP_MM ** 3) < 1e-6 and
               abs(out["both_mm3"] - len(taken_a & taken_b) * STEP_MM ** 3) < 1e-6, out)
    border_a, border_b = [list(map(bone.place, bone.border(t))) for t in (taken_a, taken_b)]
    all_mm = sorted(STEP_MM * min(distance(p, q) for q in to) for of, to in ((border_a, border_b), (border_b, border_a)) for p in of)
    work.claim("distances of the surfaces", abs(out["distance_mean_mm"] - sum(all_mm) / len(all_mm)) < 1e-5 and
               abs(out["distance_max_mm"] - all_mm[-1]) < 1e-5 and abs(out["distance_p95_mm"] - all_mm[int(0.95 * (len(all_mm) - 1))]) < 1e-5,
               (out, all_mm[-1]))
    with open(work.path("a.ply"), "rb") as file:
        header, data = file.read().split(b"end_header\n", 1)
    count = int(header.split(b"element vertex ")[1].split()[0])
    worst = wrong = 0.0
    for v in range(count):
        x, y, z, red, _, blue, quality = struct.unpack_from("<3f3Bf", data, 19 * v)
        # Back into voxels, by the transposed axes, which are at right angles.
        away = [p - o for p, o in zip((x, y, z), bone.origin)]
        voxel = [sum(s * d for s, d in zip(step, away)) / STEP_MM ** 2 for step in bone.steps]
        nearest = STEP_MM * min(distance(voxel, q) for q in border_b)
        worst = max(worst, abs(abs(quality) - nearest))
        wrong += (quality > 0.2 and red < blue) or (quality < -0.2 and red > blue)
    work.claim("PLY: distances of its vertices, within a voxel", count > 200 and worst < 0.9 * STEP_MM, (count, worst))
    work.claim("PLY: red outside of the expert's cavity, blue inside", wrong == 0, wrong)
    same = json.loads(work.must("compare-bone", bone.scene, work.path("a.bone"), work.path("a.bone"), "--json"))
    work.claim("a cavity is equal to itself", same["dice"] == 1.0 and same["distance_max_mm"] == 0.0, same)
    bone.write(work.path("none.bone"), bone.density)
    none = json.loads(work.must("compare-bone", bone.scene, work.path("a.bone"), work.path("none.bone"), "--json"))
    work.claim("an empty cavity has no distance", none["dice"] == 0.0 and none["distance_mean_mm"] is None, none)


def refused(work, bone):
    for words, reason in (
            (["export-bone", bone.scene], "no file to write is given"),
            (["export-bone", bone.scene, "--cavity", work.path("x.stl")], "no drilled bone is given"),
            (["export-bone", bone.scene, "--volume", work.path("x.dcm")], "names no format of volumes"),
            (["export-bone", bone.scene, "--bone", work.path("none.bone"), "--cavity", work.path("x.stl")], "nothing was drilled"),
            (["export-bone", bone.scene, "--volume", os.path.join(work.dir, "absent", "x.nrrd")], "absent"),
            (["compare-bone", bone.scene, work.path("a.bone"), work.path("scan.nrrd")], "not a file of drilled bone")):
        code, _, err = work.run(*words)
        work.claim("refused: " + reason, code == 1 and reason in err and "fix:" in err and not os.path.exists(work.path("x.stl")), (code, err))


if __name__ == "__main__":
    main()
