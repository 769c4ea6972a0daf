#!/usr/bin/python3
"""Saves a session, and goes on with it in another run: bodies, snapshots, contours, view and drilled bone are as they were.

usage: session_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from operator_of_window import Operator, arguments, bake_demo, expect


def saved(o):
    (file,) = o.until("a session is saved", lambda: glob.glob(os.path.join(o.folder, "out", "*.tact-session")))
    with open(file) as f:
        return file, json.load(f)


def save(o):
    o.click("Scenes (")
    o.see("Recently used")
    o.click("Save session", "Scenes")
    file, content = saved(o)
    o.see("saved the session")
    o.key("Escape")
    return file, content


def apart_a(a, b):
    return max(abs(x - y) for x, y in zip(a["pos_model_a"], b["pos_model_a"]))


def docking(o):
    o.start("--start-offset-a", "4", "--seed", "3")
    o.wait("the run is armed", lambda s: s["state"] in ("armed", "active"))
    o.xdotool("mousemove", "700", "250", "mousedown", "1")
    for x in range(700, 800, 10):
        o.xdotool("mousemove", str(x), "270")
    o.xdotool("mouseup", "1")
    o.click("Contours", "Scene")
    o.click("Add a contour", "Scene")
    o.see("remove", "Scene")
    o.click("Bodies", "Scene")
    o.click("Snapshot", "Scene")
    o.see("return to", "Scene")
    o.key("space")
    o.wait("disarmed", lambda s: s["state"] == "ready")
    time.sleep(0.5)
    file, session = save(o)
    last = o.end()["bodies"]
    bad = expect("the session has the bodies where they were left", len(session["bodies"]) == len(last) and
                 all(apart_a(a, b) < 1e-3 for a, b in zip(session["bodies"], last)))
    bad += expect("and two contours, a snapshot and the view", len(session["contours"]) == 2 and len(session["places"]) == 1 and
                  "target_a" in session["window"])

    # Scene and session move together.
    moved = os.path.join(o.folder, "moved")
    os.makedirs(os.path.join(moved, "out"))
    shutil.move(os.path.join(o.folder, "scene.tact"), moved)
    file = shutil.move(file, os.path.join(moved, "out"))
    settings = os.path.join(o.folder, "window.toml")
    o.start("--disarmed", "--window-state", settings, scene=file)
    o.see("return to", "Scene")
    o.click("Contours", "Scene")
    bad += expect("both contours and the snapshot are there again", bool(o.see("remove", "Scene")))
    now = o.end()["bodies"]
    bad += expect("the bodies are where they were left", all(apart_a(a, b) < 1e-3 for a, b in zip(session["bodies"], now)))
    with open(settings) as f:
        view = [line for line in f.read().split("\n") if line.startswith(("target_a", "quat_eye", "distance_a"))]
    was = [line for line in session["window"].split("\n") if line.startswith(("target_a", "quat_eye", "distance_a"))]
    numbers = lambda lines: [float(n) for line in lines for n in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", line.split("=")[1])]
    bad += expect("the view is the same: %s" % view[1], len(numbers(view)) == 8 and
                  all(abs(a - b) < 1e-4 * max(1.0, abs(a)) for a, b in zip(numbers(view), numbers(was))))

    # Another scene in its place is refused; the same one is found where tact bakes.
    cache = os.path.join(o.folder, "cache", "tact")
    os.makedirs(cache)
    shutil.move(os.path.join(moved, "scene.tact"), os.path.join(cache, "another-name.tact"))
    o.env["XDG_CACHE_HOME"] = os.path.join(o.folder, "cache")
    run = [o.program("tact"), "run", file, "--no-gui", "--seconds", "0.5", "--quiet", "--session", "keys"]
    found = subprocess.run(run, env=o.env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    bad += expect("the scene is found by its checksum", found.returncode == 0)
    bake_demo(o.bin, "field", os.path.join(moved, "scene.tact"))
    os.remove(os.path.join(cache, "another-name.tact"))
    refused = subprocess.run(run, env=o.env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    bad += expect("another scene in its place is refused: %s" % refused.stdout.strip().split("\n")[0],
                  refused.returncode == 1 and "another scene" in refused.stdout and "fix:" in refused.stdout)
    os.remove(file)
    return bad


def drilling(o):
    bake_demo(o.bin, "drill", o.scene("ear.tact"))
    o.start("--hand2", "suction-tube", "--hand-at-mm=-4.5,0", hand="surgeon", scene="ear.tact")
    o.wait("the run drills", lambda s: s["servo"]["cycles"] > 9000)
    o.key("space")
    o.wait("disarmed", lambda s: s["state"] == "ready")
    time.sleep(0.5)
    file, session = save(o)
    before = o.end()["drilling"]["removed_mm3"]
    bad = expect("the session has a file of bone beside it", os.path.exists(os.path.join(os.path.dirname(file), session["bone"])))
    report = os.path.join(o.folder, "again.json")
    subprocess.run([o.program("tact"), "run", file, "--no-gui", "--disarmed", "--seconds", "1", "--quiet", "--session", "keys", "--json", report],
                   env=o.env, check=True, stdout=subprocess.DEVNULL)
    with open(report) as f:
        again = json.load(f)["drilling"]["removed_mm3"]
    return bad + expect("the bone is as it was drilled: %.1f and %.1f mm3 removed" % (before, again), before > 1.0 and abs(again - before) < 1e-6)


def main():
    bin_dir = arguments(__doc__, 1)[0]
    with tempfile.TemporaryDirectory(prefix="tact-session-", ignore_cleanup_errors=True) as folder:
        bake_demo(bin_dir, "dock", os.path.join(folder, "scene.tact"))
        operator = Operator(bin_dir, folder)
        try:
            bad = docking(operator) + drilling(operator)
        finally:
            operator.close()
        return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
