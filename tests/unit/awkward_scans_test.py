#!/usr/bin/env python3
"""Awkward scans go in with the right geometry, or are refused with the right reason.

usage: awkward_scans_test.py TACT_PREP [--keep DIR]. Writes a phantom with three marks, whose places in the patient are known, as NRRD, NIfTI,
MetaImage, DICOM and images, in each of the ways that scans come in. Each is baked, written out again as NRRD by tact-prep export-bone, and the
marks are looked for by this file's own arithmetic: each within a tenth of a voxel of its place, so left is left.
"""
import argparse
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

MARKS_LPS = ((14.0, -22.0, 131.0), (27.5, -12.0, 139.5), (17.0, -9.0, 149.0))  # mm; no symmetry maps them to each other
WIDTH_MM = 1.7  # of the marks
CT = "1.2.840.10008.5.1.4.1.1.2"


def value_at(p):
    """Hounsfield units: air, and three soft marks."""
    return -1000.0 + 2600.0 * sum(math.exp(-sum((a - b) ** 2 for a, b in zip(p, m)) / (2.0 * WIDTH_MM ** 2)) for m in MARKS_LPS)


class Grid:
    """Voxels of a scan in the patient: LPS of voxel (i, j, k) is origin + i * steps[0] + j * steps[1] + k * steps[2]."""

    def __init__(self, steps, size, middle=(20.0, -15.0, 140.0), shift=(0.0, 0.0, 0.0)):
        self.steps, self.size = steps, size
        half = [sum(steps[a][r] * (size[a] - 1) / 2.0 for a in range(3)) for r in range(3)]
        self.origin = [m + s - h for m, s, h in zip(middle, shift, half)]

    def lps(self, i, j, k):
        return [self.origin[r] + i * self.steps[0][r] + j * self.steps[1][r] + k * self.steps[2][r] for r in range(3)]

    def values(self, convert=lambda v: int(round(v))):
        n = self.size
        return [convert(value_at(self.lps(i, j, k))) for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]


def turned(angle_deg, steps_mm):
    """Columns, rows and slices turned about (1, 2, -3)."""
    n = [x / math.sqrt(14.0) for x in (1.0, 2.0, -3.0)]
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]]
    m = [[c * (i == j) + (1 - c) * n[i] * n[j] + s * cross[i][j] for j in range(3)] for i in range(3)]
    return [[m[r][a] * steps_mm[a] for r in range(3)] for a in range(3)]


STRAIGHT = Grid(turned(0.0, (0.9, 0.9, 0.9)), (34, 32, 36))
OBLIQUE = Grid(turned(24.0, (0.8, 0.9, 1.0)), (42, 40, 36))


def vector(v):
    return "(%.12g,%.12g,%.12g)" % tuple(v)


def nrrd(grid, space="left-posterior-superior", kind="short", encoding="raw", endian="little", data=None, flip=(1, 1, 1)):
    to = [flip[r] for r in range(3)]
    axes = " ".join(vector([s * t for s, t in zip(step, to)]) for step in grid.steps)
    lines = ["NRRD0004", "type: " + kind, "dimension: 3", "space: " + space, "sizes: %d %d %d" % tuple(grid.size), "space directions: " + axes,
             "kinds: domain domain domain", "endian: " + endian, "encoding: " + encoding,
             "space origin: " + vector([o * t for o, t in zip(grid.origin, to)])]
    if data:
        lines.append("data file: " + data)
    return ("\n".join(lines) + "\n").encode()


def packed(values, code="<%dh"):
    return struct.pack(code % len(values), *values)


def nifti(grid, values, sform=True, qform=False, qfac=1.0, unit=2, scale=1.0):
    """RAS; by its quaternion, which with qfac -1 turns the third axis."""
    ras = [[-s[0], -s[1], s[2]] for s in grid.steps]
    origin = [-grid.origin[0], -grid.origin[1], grid.origin[2]]
    lengths = [math.sqrt(sum(c * c for c in s)) for s in ras]
    h = bytearray(352)
    struct.pack_into("<i", h, 0, 348)
    struct.pack_into("<8h", h, 40, 3, *grid.size, 1, 1, 1, 1)
    struct.pack_into("<2h", h, 70, 4, 16)
    struct.pack_into("<8f", h, 76, qfac, *[scale * x for x in lengths], 0, 0, 0, 0)
    struct.pack_into("<f", h, 108, 352.0)
    h[123] = unit
    struct.pack_into("<2h", h, 252, 1 if qform else 0, 1 if sform else 0)
    m = [[ras[a][r] / lengths[a] * (qfac if a == 2 else 1.0) for a in range(3)] for r in range(3)]
    # The quaternion of a proper rotation, by its largest part.
    parts = [1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2]]
    k = max(range(4), key=lambda i: parts[i])
    q = 0.5 * math.sqrt(parts[k])
    a, b, c, d = {0: (q, (m[2][1] - m[1][2]) / (4 * q), (m[0][2] - m[2][0]) / (4 * q), (m[1][0] - m[0][1]) / (4 * q)),
                  1: ((m[2][1] - m[1][2]) / (4 * q), q, (m[0][1] + m[1][0]) / (4 * q), (m[0][2] + m[2][0]) / (4 * q)),
                  2: ((m[0][2] - m[2][0]) / (4 * q), (m[0][1] + m[1][0]) / (4 * q), q, (m[1][2] + m[2][1]) / (4 * q)),
                  3: ((m[1][0] - m[0][1]) / (4 * q), (m[0][2] + m[2][0]) / (4 * q), (m[1][2] + m[2][1]) / (4 * q), q)}[k]
    sign = -1.0 if a < 0 else 1.0
    struct.pack_into("<6f", h, 256, sign * b, sign * c, sign * d, *[scale * x for x in origin])
    for r in range(3):
        struct.pack_into("<4f", h, 280 + 16 * r, *[scale * ras[x][r] for x in range(3)], scale * origin[r])
    h[344:348] = b"n+1\0"
    return bytes(h) + packed(values)


def meta(grid, data, compressed=False):
    lengths = [math.sqrt(sum(c * c for c in s)) for s in grid.steps]
    matrix = " ".join("%.12g" % (c / lengths[a]) for a in range(3) for c in grid.steps[a])
    return ("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = %s\n"
            "TransformMatrix = %s\nOffset = %.12g %.12g %.12g\nElementSpacing = %.12g %.12g %.12g\nDimSize = %d %d %d\n"
            "ElementType = MET_SHORT\nElementDataFile = %s\n" % (compressed, matrix, *grid.origin, *lengths, *grid.size, data)).encode()


def element(group, number, kind, value):
    if isinstance(value, str):
        value = value.encode()
    if len(value) % 2:
        value += b"\0" if kind in ("UI", "OB", "OW") else b" "
    head = struct.pack("<HH", group, number) + kind.encode()
    return head + (struct.pack("<HI", 0, len(value)) if kind in ("OB", "OW") else struct.pack("<H", len(value))) + value


def dicom(path, position, row, column, spacing, size, values, series="1.2.3.4", number=1, instance=1, maker="ACME"):
    us = lambda v: struct.pack("<H", v)
    uid = "%s.%d" % (series, instance)
    text = lambda xs: "\\".join("%.9g" % x for x in xs)
    meta_part = element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", CT) + element(2, 3, "UI", uid) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1") + \
        element(2, 0x12, "UI", "1.2.3")
    body = element(8, 0x16, "UI", CT) + element(8, 0x18, "UI", uid) + element(8, 0x60, "CS", "CT") + element(8, 0x70, "LO", maker) + \
        element(0x20, 0xD, "UI", "1.2.3") + element(0x20, 0xE, "UI", series) + element(0x20, 0x11, "IS", str(number)) + \
        element(0x20, 0x13, "IS", str(instance)) + element(0x20, 0x32, "DS", text(position)) + element(0x20, 0x37, "DS", text(list(row) + list(column))) + \
        element(0x28, 2, "US", us(1)) + element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 0x10, "US", us(size[1])) + \
        element(0x28, 0x11, "US", us(size[0])) + element(0x28, 0x30, "DS", text(spacing)) + element(0x28, 0x100, "US", us(16)) + \
        element(0x28, 0x101, "US", us(16)) + element(0x28, 0x102, "US", us(15)) + element(0x28, 0x103, "US", us(0)) + \
        element(0x28, 0x1052, "DS", "-1024") + element(0x28, 0x1053, "DS", "1") + \
        element(0x7FE0, 0x10, "OW", packed([v + 1024 for v in values], "<%dH"))
    with open(path, "wb") as file:
        file.write(b"\0" * 128 + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta_part))) + meta_part + body)


def slices(folder, places, row=(1, 0, 0), column=(0, 1, 0), size=(40, 38), spacing=0.8, order=1, **more):
    """Slices whose middles are at these LPS positions; their names are in no order."""
    os.makedirs(folder, exist_ok=True)
    for n, place in enumerate(places):
        corner = [p - 0.5 * spacing * ((size[0] - 1) * r + (size[1] - 1) * c) for p, r, c in zip(place, row, column)]
        at = lambda i, j: [o + spacing * (i * r + j * c) for o, r, c in zip(corner, row, column)]
        values = [int(round(value_at(at(i, j)))) for j in range(size[1]) for i in range(size[0])]
        name = "IM%03d-%s.dcm" % ((n * 11) % len(places) if order else n, more.get("series", "1")[-1])
        dicom(os.path.join(folder, name), corner, row, column, (spacing, spacing), size, values, instance=n + 1, **more)


def axial(from_mm, spacings, shift=lambda z: (0.0, 0.0)):
    z, places = from_mm, []
    for s in [0.0] + list(spacings):
        z += s
        places.append((20.0 + shift(z)[0], -15.0 + shift(z)[1], z))
    return places


class Work:
    def __init__(self, prep, keep):
        self.prep = os.path.abspath(prep)
        self.dir = keep or tempfile.mkdtemp(prefix="tact_awkward_")
        os.makedirs(self.dir, exist_ok=True)
        self.bad = self.good = 0

    def path(self, name):
        return os.path.join(self.dir, name)

    def write(self, name, *parts):
        with open(self.path(name), "wb") as file:
            for part in parts:
                file.write(part)
        return self.path(name)

    def claim(self, what, good, more=""):
        self.bad += not good
        self.good += good
        print("%s %s%s" % ("ok  " if good else "FAIL", what, "" if good else ": " + str(more)))

    def run(self, *words):
        done = subprocess.run([self.prep, *map(str, words)], text=True, capture_output=True, timeout=120)
        return done.returncode, done.stdout, done.stderr

    def goes_in(self, what, scan, *options, says=(), marks=MARKS_LPS):
        """Bakes the scan and looks for the marks in what is written out again."""
        scene, volume = self.path("out.tact"), self.path("out.nrrd")
        code, out, err = self.run("drill", scan, "-o", scene, *options)
        if code != 0:
            return self.claim(what, False, err)
        missing = [text for text in says if text not in out + err]
        code, out, err = self.run("export-bone", scene, "--volume", volume)
        if code != 0 or missing:
            return self.claim(what, False, (missing, err))
        found = marks_in(volume, marks)
        worst = max(math.dist(f, m) for f, m in zip(found, marks))
        return self.claim("%s: marks within %.3f mm" % (what, worst), worst < 0.08, (found, marks))

    def refused(self, what, reasons, scan, *options):
        scene = self.path("refused.tact")
        code, out, err = self.run("drill", scan, "-o", scene, *options)
        self.claim(what, code == 1 and all(r in err for r in reasons) and "fix:" in err and not os.path.exists(scene), (code, err))


def marks_in(path, marks):
    with open(path, "rb") as file:
        header, data = file.read().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in header.decode().splitlines()[1:] if ": " in line and line[0] != "#")
    size = [int(n) for n in fields["sizes"].split()]
    numbers = lambda text: [float(x) for x in text.strip("()").split(",")]
    steps, origin = [numbers(v) for v in fields["space directions"].split()], numbers(fields["space origin"])
    values = struct.unpack("<%dh" % (size[0] * size[1] * size[2]), gzip.decompress(data))
    least = min(values)
    sums = [[0.0, 0.0, 0.0, 0.0] for _ in marks]
    for n, v in enumerate(values):
        if v == least:
            continue
        at = (n % size[0], n // size[0] % size[1], n // (size[0] * size[1]))
        p = [origin[r] + sum(at[a] * steps[a][r] for a in range(3)) for r in range(3)]
        for s, m in zip(sums, marks):
            if math.dist(p, m) < 4.5:
                for r in range(3):
                    s[r] += (v - least) * p[r]
                s[3] += v - least
    return [[s[r] / s[3] if s[3] > 0 else 1e9 for r in range(3)] for s in sums]


def png(width, height, rows):
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(b"".join(b"\0" + r for r in rows))) + chunk(b"IEND", b""))


def blocks(work):
    """Scans in one file, or in a header and data."""
    straight, oblique = packed(STRAIGHT.values()), packed(OBLIQUE.values())
    work.goes_in("NRRD", work.write("plain.nrrd", nrrd(STRAIGHT), b"\n", straight))
    work.goes_in("NRRD, oblique", work.write("oblique.nrrd", nrrd(OBLIQUE), b"\n", oblique))
    work.goes_in("NRRD, oblique, RAS", work.write("ras.nrrd", nrrd(OBLIQUE, "right-anterior-superior", flip=(-1, -1, 1)), b"\n", oblique))
    work.write("beside.raw", oblique)
    work.goes_in("NRRD, data file: ./beside.raw", work.write("beside.nhdr", nrrd(OBLIQUE, data="./beside.raw")))
    big = packed(OBLIQUE.values(), ">%dh")
    work.goes_in("NRRD, gzip, big endian", work.write("big.nrrd", nrrd(OBLIQUE, encoding="gzip", endian="big"), b"\n", gzip.compress(big)))
    mirrored = Grid([[-c for c in OBLIQUE.steps[0]], OBLIQUE.steps[1], OBLIQUE.steps[2]], OBLIQUE.size)
    work.goes_in("NRRD, columns from left to right: voxels in a left-handed order", work.write("left.nrrd", nrrd(mirrored), b"\n",
                                                                                          packed(mirrored.values())))
    work.refused("NRRD, cut short", ["bytes"], work.write("short.nrrd", nrrd(OBLIQUE), b"\n", oblique[:-500]))
    work.goes_in("NIfTI, by its matrix", work.write("s.nii", nifti(OBLIQUE, OBLIQUE.values())))
    work.goes_in("NIfTI, by its quaternion", work.write("q.nii", nifti(OBLIQUE, OBLIQUE.values(), sform=False, qform=True, qfac=1.0)))
    reverse = Grid([OBLIQUE.steps[0], OBLIQUE.steps[1], [-c for c in OBLIQUE.steps[2]]], OBLIQUE.size)
    work.goes_in("NIfTI, by its quaternion, qfac -1: a mirrored order of voxels",
                 work.write("m.nii", nifti(reverse, reverse.values(), sform=False, qform=True, qfac=-1.0)))
    work.goes_in("NIfTI, packed, micrometres", work.write("um.nii.gz", gzip.compress(nifti(OBLIQUE, OBLIQUE.values(), unit=3, scale=1000.0))))
    work.write("beside2.raw", oblique)
    work.goes_in("MetaImage, oblique, header and data", work.write("oblique.mhd", meta(OBLIQUE, "beside2.raw")))
    work.goes_in("MetaImage, packed", work.write("packed.mha", meta(STRAIGHT, "LOCAL", True), zlib.compress(straight)))


def units(work):
    """Values without a unit."""
    grey = STRAIGHT.values(lambda v: max(0, min(255, int(round(255.0 * (v + 1000.0) / 2800.0)))))
    work.goes_in("8 bits: a threshold is proposed, and said", work.write("grey.nrrd", nrrd(STRAIGHT, kind="uchar"), b"\n", bytes(grey)),
                 says=["8-bit values have no unit", "--threshold-hu"])
    unknown = packed(STRAIGHT.values(lambda v: int(round(20.0 + (v + 1000.0) / 10.0))))
    path = work.write("unknown.nrrd", nrrd(STRAIGHT), b"\n", unknown)
    work.refused("values of an unknown unit", ["unit of the values is unknown", "--threshold-hu"], path)
    work.goes_in("the same with thresholds", path, "--threshold-hu", 150, "--solid-hu", 300)
    folder = work.path("images")
    os.makedirs(folder, exist_ok=True)
    n = STRAIGHT.size
    for k in range(n[2]):
        rows = [bytes(grey[(k * n[1] + j) * n[0]:(k * n[1] + j + 1) * n[0]]) for j in range(n[1])]
        with open(os.path.join(folder, "slice%d.png" % k), "wb") as file:
            file.write(png(n[0], n[1], rows))
    work.refused("images without a spacing", ["no pixel spacing", "--spacing-mm"], folder)
    code, out, err = work.run("drill", folder, "-o", work.path("images.tact"), "--spacing-mm", "0.9,0.9,0.9")
    work.claim("images with a spacing: said that left may be right", code == 0 and "may be mirrored" in err, (code, err))


def series(work):
    """Folders of DICOM files."""
    even = axial(122.0, [1.0] * 36)
    slices(work.path("even"), even)
    work.goes_in("DICOM, names in no order", work.path("even"))
    slices(work.path("two"), axial(121.0, [0.8] * 18 + [1.4] * 18))
    work.goes_in("DICOM, two spacings", work.path("two"), says=["several spacings"])
    tilt = math.tan(math.radians(15.0))
    slices(work.path("tilt"), axial(122.0, [1.0] * 36, lambda z: (0.0, tilt * (z - 140.0))), size=(40, 46))
    work.goes_in("DICOM, tilted gantry", work.path("tilt"), says=["tilt"])
    slices(work.path("sagittal"), [(6.0 + 0.9 * n, -15.0, 140.0) for n in range(32)], row=(0, 1, 0), column=(0, 0, -1), size=(36, 46))
    work.goes_in("DICOM, sagittal", work.path("sagittal"))
    c, s = math.cos(math.radians(20.0)), math.sin(math.radians(20.0))
    slices(work.path("oblique"), [(20.0, -15.0 - s * (n - 18), 140.0 + c * (n - 18)) for n in range(37)], row=(1, 0, 0), column=(0, c, s), size=(40, 40))
    work.goes_in("DICOM, oblique", work.path("oblique"))
    slices(work.path("missing"), even[:20] + even[22:])
    work.refused("DICOM, two slices are missing", ["2 slices are missing", "spacing is 1 mm"], work.path("missing"))
    slices(work.path("other"), even[:20] + even[21:])
    slices(work.path("other"), [even[20]], size=(20, 20), order=0, number=9)
    work.refused("DICOM, one slice has another size", ["1 slice is missing", "20 x 20 pixels"], work.path("other"))
    slices(work.path("several"), even)
    slices(work.path("several"), axial(122.0, [1.5] * 24), series="1.2.3.5", number=2)
    work.refused("DICOM, two series", ["2 series", "series number 1, 37 slices", "series number 2, 25 slices", "--series"], work.path("several"))
    work.goes_in("the same with --series", work.path("several"), "--series", 2)
    slices(work.path("cone"), even, maker="NewTom")
    work.goes_in("DICOM of a cone-beam scanner: warned", work.path("cone"), says=["cone-beam"])


def labels(work):
    """A segmentation of 3D Slicer beside the scan."""
    scan = work.write("scan.nrrd", nrrd(OBLIQUE), b"\n", packed(OBLIQUE.values()))
    n = STRAIGHT.size
    label = bytes(2 if math.dist(STRAIGHT.lps(i, j, k), MARKS_LPS[1]) < 2.5 else 5 if math.dist(STRAIGHT.lps(i, j, k), MARKS_LPS[2]) < 2.0 else 0
                  for k in range(n[2]) for j in range(n[1]) for i in range(n[0]))
    text = nrrd(STRAIGHT, kind="uchar") + (b"Segment0_Name:=Facial nerve\nSegment0_LabelValue:=2\nSegment0_Layer:=0\nSegment0_Color:=1 0.9 0.2\n"
                                           b"Segment1_Name:=Tympanic membrane\nSegment1_LabelValue:=5\nSegment1_Layer:=0\nSegment1_Color:=0.2 0.9 1\n")
    seg = work.write("labels.seg.nrrd", text, b"\n", label)
    work.goes_in("labels on other axes than the scan's", scan, "--labels", seg)
    code, out, err = work.run("info", work.path("out.tact"), "--json")
    found = {s["name"]: s for s in json.loads(out)["bone"].get("structures", json.loads(out).get("structures", []))} if code == 0 else {}
    work.claim("segments keep their names, and the nerve is critical", found.get("Facial nerve", {}).get("critical") is True and
               found.get("Tympanic membrane", {}).get("critical") is False, (code, out[:600], err))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("prep")
    parser.add_argument("--keep", help="folder for the scans, which then stay")
    request = parser.parse_args()
    work = Work(request.prep, request.keep)
    try:
        blocks(work)
        units(work)
        series(work)
        labels(work)
    finally:
        if not request.keep:
            shutil.rmtree(work.dir)
    print("%d scans as they should be, %d not" % (work.good, work.bad))
    sys.exit(1 if work.bad else 0)


if __name__ == "__main__":
    main()
