#!/usr/bin/python3
"""Adds a structure to the scene of a running window: the run goes on with it, and what was there stays as it was.

usage: add_structure_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import glob
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "unit"))
from deploy_add_structure_test import Bench, apart_a  # noqa: E402
from operator_of_window import Operator, arguments, expect  # noqa: E402


def view(settings):
    """What the camera looks at, in the frame of the map, and from what distance (angstrom)."""
    numbers = {line.split(" = ")[0]: [float(n) for n in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", line.split("=")[1])]
               for line in settings.split("\n") if line.startswith(("origin_a", "target_a", "distance_a"))}
    return [a + b for a, b in zip(numbers["origin_a"], numbers["target_a"])] + numbers["distance_a"]


def mark(o, name):
    o.click("Scenes (")
    o.see("Recently used")
    o.click("Folder", "Scenes")
    o.click(name, "Scenes")
    o.see("Add %s to this scene" % name, "Scenes")


def picture(o, name):
    """For people: with TACT_PICTURES=FOLDER what the screen shows is kept there (XWD)."""
    if os.environ.get("TACT_PICTURES"):
        time.sleep(0.5)
        shutil.copy(os.path.join(o.folder, "Xvfb_screen0"), os.path.join(os.environ["TACT_PICTURES"], name + ".xwd"))


def place(o):
    """Lets the force draw the held body, takes a snapshot, adds a contour, and fixes the body; returns it."""
    o.wait("the run is armed", lambda s: s["state"] in ("armed", "active"))
    o.key("space")
    o.wait("disarmed", lambda s: s["state"] == "ready")
    o.click("Contours", "Scene")
    o.click("Add a contour", "Scene")
    o.see("remove", "Scene")
    o.click("Bodies", "Scene")
    o.click("Snapshot", "Scene")
    o.see("return to", "Scene")
    o.click("fixed", "Scene")
    time.sleep(0.5)
    o.click("Scenes (")
    o.see("Recently used")
    o.click("Save session", "Scenes")
    (file,) = o.until("a session is saved", lambda: glob.glob(os.path.join(o.folder, "out", "*.tact-session")))
    o.key("Escape")
    with open(file) as f:
        session = json.load(f)
    (body,) = session["bodies"]
    return body, view(session["window"])


def shown(o):
    return o.said().count("showing ")


def add(o, name):
    before = shown(o)
    mark(o, name)
    picture(o, "add_" + name)
    o.click("Add", "Scenes")
    o.until("the window shows the scene with %s" % name, lambda: shown(o) > before)
    o.wait("the controller runs again", lambda s: s["gui"]["attached"] and s["gui"]["frames"] and s["gui"]["frames"]["count"] > 20)


def remembers_answers(o):
    """Imports a map twice: the second time, the answer of the first is proposed, and waits."""
    def ask():
        if o.find("Recently used") is None:
            o.click("Scenes (")
        o.click("Folder", "Scenes")
        for name in ("map.mrc", "b.pdb"):
            o.click(name, "Scenes")
        o.see("Dock b.pdb into map.mrc", "Scenes")
        o.click("Import", "Scenes")
        o.see("Resolution of the map", "Scenes")
        o.until("the dialog takes keys", lambda: o.said().count("asking about") > ask.asked)
        ask.asked += 1
    ask.asked = 0
    ask()
    bad = expect("the first time, nothing is remembered", o.find("As answered for this file before") is None)
    o.xdotool("type", "8.5")
    o.key("Return")
    o.see("this run writes files", "Scenes")  # the run keeps its scene, because of --json
    ask()
    o.see("As answered for this file before", "Scenes")
    picture(o, "remembered")
    time.sleep(1.0)
    bad += expect("nothing is imported without a person", o.find("Resolution of the map") is not None)
    faults = o.layout_faults()
    bad += expect("no text of the dialog is cut: %s" % sorted(faults), not faults)
    o.click("Cancel", "Scenes")
    o.see_no_more("Resolution of the map", "Scenes")
    o.click("Close", "Scenes")
    return bad


def main():
    bin_dir = arguments(__doc__, 1)[0]
    bad = 0
    with tempfile.TemporaryDirectory(prefix="tact-add-", ignore_cleanup_errors=True) as folder:
        o = Operator(bin_dir, folder)
        bench = Bench(bin_dir, pathlib.Path(folder))
        o.env["XDG_CACHE_HOME"] = bench.env["XDG_CACHE_HOME"]
        subprocess.run([o.program("tact-prep"), "dock", "map.mrc", "a.pdb", "--resolution-a", "9", "-o", "scene.tact"], cwd=folder, check=True,
                       capture_output=True)
        try:
            settings = os.path.join(folder, "window.toml")
            o.start("--start-offset-a", "6", "--seed", "3", "--window-state", settings)
            o.xdotool("mousemove", "700", "250", "mousedown", "3", "mousemove", "760", "270", "mousemove", "790", "280", "mouseup", "3")
            left, looked_at = place(o)
            add(o, "b.pdb")
            o.see("return to", "Scene")
            state = o.status()["state"]
            bad += expect("nothing is armed: %s" % state, state == "ready")
            bad += expect("the snapshot is there", o.find("return to", "Scene") is not None)
            o.click("Contours", "Scene")
            bad += expect("and the second contour", bool(o.see("remove", "Scene")))
            o.click("Bodies", "Scene")
            picture(o, "added")
            def seen(bodies):
                o.wait("%d bodies" % bodies, lambda s: s["gui"]["attached"] and s["gui"]["frames"] and s["gui"]["frames"]["count"] > 20)
                o.see("return to", "Scene")
                return o.find("b.pdb", "Scene") is not None
            for key, bodies in (("ctrl+z", 1), ("ctrl+y", 2)):
                before = shown(o)
                o.key(key)
                o.until("%s continues another session" % key, lambda: shown(o) > before)
                there = seen(bodies)
                bad += expect("%s: %d bodies" % (key, bodies), there == (bodies == 2))
                bad += expect("the snapshot is still there", o.find("return to", "Scene") is not None)
            add(o, "far.pdb")
            picture(o, "added_beside")
            faults = o.layout_faults()
            bad += expect("no text is cut: %s" % sorted(faults), not faults)
            bad += remembers_answers(o)
            # A map that has changed is refused; the run goes on.
            with open(os.path.join(folder, "map.mrc"), "ab") as f:
                f.write(b"changed")
            mark(o, "b.pdb")
            o.click("Add", "Scenes")
            o.see("has changed since the scene was baked", "Scenes")
            picture(o, "refused")
            last = o.end()["bodies"]
        finally:
            o.close()
        with open(settings) as f:
            now = view(f.read())
        bad += expect("the view is the same: %s and %s" % (looked_at, now), all(abs(a - b) < 0.01 for a, b in zip(looked_at, now)))
        bad += expect("there are three bodies", [b["name"] for b in last] == ["a.pdb", "b.pdb", "far.pdb"])
        bad += expect("the first is where it was left, and fixed", apart_a(last[0], left) < 1e-3 and left["fixed"] and last[0]["fixed"])
        bad += expect("it is not where its file has it: %.2f A off" % last[0]["offset_a"], last[0]["offset_a"] > 0.5)
        bad += expect("the second is where its file has it", last[1]["offset_a"] < 1e-3 and not last[1]["fixed"])
        bad += expect("the third, far off in its file, is beside the map and in the hand",
                      46.0 < last[2]["pos_model_a"][0] < 100.0 and last[2]["in_hand"] and not last[1]["in_hand"])
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
