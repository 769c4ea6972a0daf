#!/usr/bin/python3
"""Draws every state of the window with the real programs and checks the texts that it shows: none cut, none on another. Keeps a picture of each and
a contact sheet.

usage: window_states_test.py BIN_DIR OUT_DIR [SIZE...]     default: 1280x720 1920x1080; 3840x2160 takes minutes in software rendering

Exit code 77: Xvfb or xdotool is missing.
"""
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "unit"))
from deploy_add_structure_test import Bench  # noqa: E402
from operator_of_window import Operator, arguments, bake_demo, expect  # noqa: E402

THUMBNAIL_PX = 480


def png_bytes(width, rows):
    """rows: RGB, from the top."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    body = b"".join(b"\0" + row for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(body, 6)) + chunk(b"IEND", b"")


class States:
    def __init__(self, operator, out):
        self.operator, self.out, self.faults, self.thumbnails = operator, out, [], []
        self.wide, self.high = map(int, operator.size.split("x"))

    # The screen from the file in xwd format that Xvfb writes, as rows of RGB.
    def rows(self):
        with open(os.path.join(self.operator.folder, "Xvfb_screen0"), "rb") as f:
            data = f.read()
        head = struct.unpack(">25I", data[:100])
        begin, line = head[0] + 12 * head[19], head[12]
        rows = []
        for y in range(self.high):
            pixels = data[begin + line * y:begin + line * y + 4 * self.wide]
            row = bytearray(3 * self.wide)
            row[0::3], row[1::3], row[2::3] = pixels[2::4], pixels[1::4], pixels[0::4]
            rows.append(bytes(row))
        return rows

    def keep(self, name):
        time.sleep(1.2)  # plots and texts follow twelve times a second
        self.faults += ["%s: %s" % (name, fault) for fault in sorted(self.operator.layout_faults())]
        texts = self.operator.texts()
        if len(texts) < 20:
            self.faults.append("%s: only %d texts" % (name, len(texts)))
        rows = self.rows()
        with open(os.path.join(self.out, "%s_%s.png" % (self.operator.size, name)), "wb") as f:
            f.write(png_bytes(self.wide, rows))
        step = max(self.wide // THUMBNAIL_PX, 1)
        self.thumbnails.append([b"".join(row[3 * x:3 * x + 3] for x in range(0, step * (self.wide // step), step)) for row in rows[::step]])
        print("ok   %s %s: %d texts" % (self.operator.size, name, len(texts)), flush=True)

    def sheet(self):
        columns = 4
        rows, empty = [], [bytes(len(self.thumbnails[0][0]))] * len(self.thumbnails[0])
        for i in range(0, len(self.thumbnails), columns):
            line = (self.thumbnails[i:i + columns] + [empty] * columns)[:columns]
            rows += [b"".join(t[y] for t in line) for y in range(len(empty))]
        with open(os.path.join(self.out, "%s_all.png" % self.operator.size), "wb") as f:
            f.write(png_bytes(len(rows[0]) // 3, rows))


def draw(states):
    o = states.operator
    # Without a controller.
    o.log = open(os.path.join(o.folder, "run.log"), "wb")
    o.run = subprocess.Popen([o.program("tact-gui"), "--session", "nobody", "--size", o.size, "--texts", o.texts_file], env=o.env, stdout=o.log, stderr=o.log)
    o.see("No scene yet")
    states.keep("waiting")
    o.report = ""
    o.end()
    o.launch()
    o.see("Scenes used before")
    o.until("the computer was examined", lambda: o.find("examining ...") is None)
    states.keep("start_page")
    o.end()

    o.start("--config", o.scene("lines.toml"), "--disarmed", "--start-offset-a", "4", "--seed", "3", scene="dock.tact")
    o.see("Disarmed. Press Arm.")
    states.keep("ready")
    o.press("Arm", "the button arms", lambda s: s["state"] in ("armed", "active"))
    states.keep("docking_bodies")
    for tab in ("Search", "Contours", "View"):
        o.click(tab, "Scene")
        states.keep("docking_" + tab.lower())
    o.click("Picture (")
    o.see("Depth cue")
    o.click("Cut", "Picture")
    o.click("residues", "Picture")
    states.keep("picture")
    o.key("d")
    o.see("SpaceMouse and gamepad")
    states.keep("devices")
    o.key("d")
    o.click("Traces", "Over time")
    states.keep("traces")
    o.key("o")
    o.see("Recently used")
    states.keep("scenes")
    o.key("Escape")
    o.key("question")
    o.see("this table")
    states.keep("keys")
    o.key("Escape")
    os.kill(o.controller(), signal.SIGUSR1)
    o.wait("the emergency stop trips", lambda s: s["state"] == "fault")
    states.keep("fault")
    o.end()

    o.start("--record", o.scene("run.h5"), scene="touch.tact", hand="stroke")
    o.wait("the run is armed", lambda s: s["state"] == "active")
    states.keep("surface")
    o.end()
    o.start(scene="drill.tact", hand="drill")
    o.wait("the run is armed", lambda s: s["state"] == "active")
    time.sleep(2)
    states.keep("drilling")
    o.click("Burr ...", "Drilling")
    o.see("Burr, diameter in mm")
    states.keep("burrs")
    o.end()
    o.start(scene="field.tact", hand="wander")
    states.keep("field")
    o.end()

    draw_lists_and_hands(states)

    o.report = ""
    o.launch("replay", o.scene("run.h5"), "--show", "--scene", o.scene("touch.tact"))
    o.see("REPLAY", "Replay")
    states.keep("replay")
    o.end()
    states.sheet()


# Raw data in the list of scenes, a session that is saved, and the mouse as a hand.
def draw_lists_and_hands(states):
    o = states.operator
    o.start("--disarmed", scene="two.tact")
    o.click("Scenes (")
    o.see("Recently used")
    o.click("Save session", "Scenes")
    o.see("saved the session as", "Events")
    states.keep("session_saved")
    o.click("Folder", "Scenes")
    o.click("b.pdb", "Scenes")
    o.see("Add b.pdb to this scene", "Scenes")
    states.keep("add_structure")
    o.click("density.mrc", "Scenes")
    o.see("Dock b.pdb into density.mrc", "Scenes")
    o.click("Import", "Scenes")
    o.see("Resolution of the map", "Scenes")
    states.keep("import_form")
    o.end()

    o.start("--start-offset-a", "6", scene="two.tact", hand="mouse")
    o.wait("the run is armed", lambda s: s["state"] in ("armed", "active"))
    o.see("drag to lead")
    states.keep("mouse_ring")
    o.key("l")
    o.see("The mouse leads the tool.")
    states.keep("mouse_leads")
    o.key("Escape")
    o.end()


def main():
    bin_dir, out, *sizes = arguments(__doc__, 2)
    os.makedirs(out, exist_ok=True)
    bad = 0
    for size in sizes or ["1280x720", "1920x1080"]:
        with tempfile.TemporaryDirectory(prefix="tact-states-", ignore_cleanup_errors=True) as folder:
            for kind in ("dock", "touch", "drill", "field"):
                bake_demo(bin_dir, kind, os.path.join(folder, kind + ".tact"))
            Bench(os.path.abspath(bin_dir), pathlib.Path(folder))  # raw data of a map and structures
            subprocess.run([os.path.abspath(os.path.join(bin_dir, "tact-prep")), "dock", "map.mrc", "a.pdb", "--resolution-a", "9", "-o", "two.tact"],
                           cwd=folder, check=True, capture_output=True)
            os.rename(os.path.join(folder, "map.mrc"), os.path.join(folder, "density.mrc"))
            with open(os.path.join(folder, "lines.toml"), "w") as f:
                f.write('[lines]\ndriver = "sim"\n')
            operator = Operator(bin_dir, folder, size)
            states = States(operator, out)
            try:
                draw(states)
            finally:
                operator.close()
            for fault in states.faults:
                print("FAIL %s %s" % (size, fault))
            bad += expect("%s: %d states, no text cut, none on another; %s" %
                          (size, len(states.thumbnails), os.path.join(out, size + "_all.png")), not states.faults)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
