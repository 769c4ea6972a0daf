#!/usr/bin/python3
"""Operates the window by its visible labels, as a person does: some sixty actions in a docking run, its replay, and a run that continues from it. After
each action that changes a text, the controller or a file, that must be seen; and no text may be cut or lie on another.

usage: labels_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import glob
import os
import re
import struct
import sys
import tempfile
import time

from operator_of_window import Operator, arguments, bake_demo, expect


class Script:
    def __init__(self, operator):
        self.operator, self.actions, self.faults = operator, 0, set()

    def act(self, what, do, seen):
        """seen: polled until it holds. A busy window may miss a click, so it is done again after a while."""
        for _ in range(3):
            do()
            if self.operator.holds_within(seen, 20.0):
                break
        else:
            self.operator.fail(what)
        self.actions += 1
        self.look(what)
        print("ok   %2d %s" % (self.actions, what), flush=True)

    def look(self, what):
        self.faults |= {"%s: %s" % (what, fault) for fault in self.operator.layout_faults()}

    # Presses a label; then another label is shown.
    def click(self, label, then, within=None, gone=False):
        o = self.operator
        self.act("%s: %s '%s'" % (label, "no longer" if gone else "then", then), lambda: o.click(label, within),
                 lambda: (o.find(then) is None) if gone else o.find(then))

    def key(self, key, what, seen):
        self.act("key %s: %s" % (key, what), lambda: self.operator.key(key), seen)


def docking(script):
    o = script.operator
    o.start("--flight", os.path.join(o.folder, "flight"), "--start-offset-a", "4", "--seed", "3")
    state = lambda wanted: lambda: (o.status() or {}).get("state") in wanted
    done = lambda text, times=1: lambda: o.said().count(text) >= times
    script.act("the run is armed", lambda: None, state(("armed", "active")))
    script.act("Disarm", lambda: o.click("Disarm", "Controller"), state(("ready",)))
    script.act("READY and its fix are shown", lambda: None, lambda: o.find("READY") and o.find("Press Arm"))
    script.act("Arm", lambda: o.click("Arm", "Controller"), state(("armed", "active")))
    script.key("space", "disarmed", state(("ready",)))
    script.key("ctrl+Return", "armed", state(("armed", "active")))

    script.act("Record", lambda: o.click("Record", "Controller"), lambda: o.find("recorded", "Controller") or o.find("Stop", "Controller"))
    script.key("m", "a flight recording is written", lambda: glob.glob(os.path.join(o.folder, "flight", "*mark*.h5")))

    script.click("Search", "symmetry", "Scene")
    script.click("Contours", "Add a contour", "Scene")
    script.click("Add a contour", "remove", "Scene")
    script.click("remove", "remove", "Scene", gone=True)
    script.click("View", "Bodies as", "Scene")
    for style in ("trace", "tube", "sticks", "spheres", "cartoon", "surface"):
        script.act("bodies as %s" % style, lambda: o.click(style, "Scene"), lambda: True)
    for colour in ("element", "body", "fit", "chain"):
        script.act("coloured by %s" % colour, lambda: o.click(colour, "Scene"),
                   lambda: o.reveal("0.4", "Scene") if colour == "fit" else True)
    for style in ("solid", "wire", "glass"):
        script.act("surface as %s" % style, lambda: o.click(style, "Scene"), lambda: True)
    script.click("Frame times", "structures")
    script.click("Frame times", "structures", gone=True, within="Scene")
    script.click("Force", "model force", within="Scene", gone=True)
    script.click("Force", "model force", within="Scene")

    script.click("Picture", "Depth cue")
    script.click("Cut", "cut: what is nearer", within="Picture")
    script.click("Cut", "cut: what is nearer", within="Picture", gone=True)
    numbered = lambda: any(re.fullmatch(r"\w* ?\d+", t["text"]) for t in o.texts() if t["owner"] == "##Background")
    script.act("residues are named", lambda: o.click("residues", "Picture"), numbered)
    script.act("chains are named", lambda: o.click("chains", "Picture"), lambda: not numbered())
    script.click("none", "Depth cue", within="Picture")
    script.click("White background", "Depth cue", within="Picture")
    script.click("White background", "Depth cue", within="Picture")
    script.click("1x", "Depth cue", within="Picture")
    script.click("No background", "Depth cue", within="Picture")
    script.act("Save picture", lambda: o.click("Save picture", "Picture"), lambda: pictures(o))
    with open(pictures(o)[0], "rb") as f:
        head = f.read(26)
    script.act("the picture is transparent and as large as the view", lambda: None,
               lambda: head[25] == 6 and 900 < struct.unpack(">I", head[16:20])[0] < 1000)
    script.click("Picture (", "Depth cue", gone=True)

    script.click("Bodies", "Snapshot", "Scene")
    script.act("release the body", lambda: o.click("(held)", "Scene"), lambda: o.find("(held)") is None)
    script.key("1", "it is held again", lambda: held(o, 1))
    script.act("Snapshot", lambda: o.click("Snapshot", "Scene"), lambda: o.find("return to", "Scene"))
    script.act("Refine", lambda: o.click("Refine", "Scene"), done("command place a body: done"))
    # A hand that holds it moves it meanwhile, which is a gesture of its own: then there is nothing to redo.
    script.act("release it", lambda: o.click("(held)", "Scene"), lambda: o.find("(held)") is None)
    script.act("Undo", lambda: o.click("Undo", "Scene"), done("command place a body: done", 2))
    script.act("Redo", lambda: o.click("Redo", "Scene"), done("command place a body: done", 3))
    script.act("Accept", lambda: o.click("Accept", "Scene"), lambda: True)
    script.key("1", "it is held", lambda: held(o, 1))
    script.act("Copy", lambda: o.click("Copy", "Scene"), done("bodies changed: 2 now"))
    script.key("2", "the copy is held", lambda: held(o, 2))
    script.act("Remove", lambda: o.click("Remove", "Scene"), lambda: o.said().rfind("bodies changed: 1 now") > o.said().rfind("bodies changed: 2 now"))
    script.key("1", "the first is held", lambda: held(o, 1))
    # A synthetic structure has no file to be written anew; the poses are saved, and the reason is shown.
    script.act("Save", lambda: o.click("Save", "Scene"), lambda: o.find("fix:", "##Background") and glob.glob(os.path.join(o.folder, "out", "*", "poses.json")))

    script.click("10 min", "-10 min", "Over time")
    script.click("1 min", "-60 s", "Over time")
    script.click("whole run", "whole run", "Over time")
    script.click("Traces", "Pause", "Over time")
    script.click("Load and detail", "Force rate", "Over time")
    listed = lambda: len([t for t in o.texts() if t["owner"] == "Events"])
    script.act("faults alone", lambda: o.click("faults", "Events"), lambda: listed() <= 5)
    script.act("all events", lambda: o.click("all", "Events"), lambda: listed() > 8)
    script.key("question", "the table of keys", lambda: o.find("this table"))
    script.key("Escape", "the table is closed", lambda: o.find("this table") is None)
    script.click("Scenes (", "Recent")
    script.key("Escape", "the list is closed", lambda: o.find("Recent") is None)
    script.act("the recording ends", lambda: o.key("ctrl+r"), lambda: recordings(o))
    script.recording = recordings(o)[0]
    o.end()


# Whether the line of the list that begins with this number ends with "(held)".
def held(o, number):
    texts = [t for t in o.texts() if t["owner"] == "Scene"]
    return any(abs(a["y"] - b["y"]) < 6 and "(held)" in b["text"] for a in texts if a["text"] == str(number) for b in texts)


def pictures(o):
    return glob.glob(os.path.join(o.folder, "out", "*picture*.png"))


def recordings(o):
    return glob.glob(os.path.join(o.folder, "out", "*.h5")) if o.find("recorded", "Events") else []


def replay(script):
    o = script.operator
    o.report = ""
    o.launch("replay", script.recording, "--show", "--scene", o.scene())
    script.act("a replay says so", lambda: None, lambda: o.find("REPLAY", "Replay") and o.find("no device, no force"))
    at = lambda: next((t["text"] for t in o.texts() if " s of " in t["text"]), "")
    script.key("period", "paused, one step on", lambda: "paused" in at())
    before = at()
    script.key("period", "one step on", lambda: at() != before)
    here = at()
    script.key("comma", "one step back", lambda: at() == before)
    script.key("space", "it plays", lambda: "playing" in at())
    script.key("space", "it is paused", lambda: "paused" in at())
    place = o.see(" s of ", "Timeline")
    script.act("seek by mouse", lambda: seek(o, place), lambda: "paused" in at() and at() not in (before, here))
    script.click("Run from here", "READY")
    o.run.send_signal(2)
    o.run.wait(60)
    o.run = None


# Clicks into the middle of the line of time, which lies between play and the speed on one side and the edge on the other.
def seek(o, place):
    t = next(t for t in o.texts() if t["owner"].startswith("Timeline") and " s of " in t["text"])
    y = t["y"] + 2.2 * t["h"]
    o.xdotool("mousemove", "800", str(round(y)))
    time.sleep(0.2)
    o.xdotool("mousedown", "1")
    time.sleep(0.2)
    o.xdotool("mouseup", "1")


def main():
    bin_dir = arguments(__doc__, 1)[0]
    with tempfile.TemporaryDirectory(prefix="tact-labels-", ignore_cleanup_errors=True) as folder:
        bake_demo(bin_dir, "dock", os.path.join(folder, "scene.tact"))
        operator = Operator(bin_dir, folder)
        script = Script(operator)
        try:
            docking(script)
            replay(script)
        finally:
            operator.close()
        for fault in sorted(script.faults):
            print("FAIL " + fault)
        return expect("%d actions by label, no text cut, none on another" % script.actions, script.actions >= 60 and not script.faults)


if __name__ == "__main__":
    sys.exit(main())
