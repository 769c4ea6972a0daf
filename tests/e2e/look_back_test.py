#!/usr/bin/python3
"""Looks back from a live run on its timeline: a replay of the last seconds opens beside the run, which goes on; then the run continues from a past
moment.

usage: look_back_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import glob
import json
import os
import sys
import tempfile
import time

from operator_of_window import Operator, arguments, bake_demo, expect


def click_past(o, ago_s):
    """A place on the line between "-30 s" and "live"."""
    left = next(t for t in o.texts() if t["text"] == "-30 s")
    right = next(t for t in o.texts() if t["text"] == "live" and t["owner"] == "Timeline")
    begin, end = left["x"] + left["w"] + 10, right["x"] - 12
    o.xdotool("mousemove", str(round(end - (end - begin) * ago_s / 30.0)), str(round(left["y"] + 0.5 * left["h"])))
    time.sleep(0.3)
    o.xdotool("mousedown", "1")
    time.sleep(0.2)
    o.xdotool("mouseup", "1")


def seconds(o):
    """The place of the replay, and its length."""
    text = next((t["text"] for t in o.texts() if " s of " in t["text"]), "")
    words = text.replace(",", "").split()
    return (float(words[words.index("of") - 2]), float(words[words.index("of") + 1])) if "of" in words else None


def look_back(o):
    o.report = ""  # a run that writes a report at its end keeps its scene
    o.launch("run", o.scene(), "--hand", "passive", "--quiet", "--start-offset-a", "8", "--seed", "3")
    o.wait("the run is armed", lambda s: s["state"] == "active")
    o.wait("it runs for a while", lambda s: s["servo"]["cycles"] > 9000)
    bad = expect("a run in a window can look back without an option", o.find("-30 s", "Timeline") is not None)
    main, past = o.texts_file, o.texts_file + ".past"
    for _ in range(3):
        click_past(o, 4.0)
        if o.holds_within(lambda: os.path.exists(past), 25.0):
            break
    o.texts_file = past
    o.see("REPLAY", "Replay")
    cycles = o.status()["servo"]["cycles"]
    o.key("space")
    o.until("the replay is paused", lambda: any("paused" in t["text"] for t in o.texts()))
    at_s, length_s = o.until("the replay says where it is", lambda: seconds(o))
    bad += expect("the replay began some seconds before its end: at %.1f s of %.1f s" % (at_s, length_s), length_s - 9.0 < at_s < length_s)
    now = o.wait("the run goes on meanwhile", lambda s: s["servo"]["cycles"] > cycles + 500)
    bad += expect("the run stays active meanwhile", now["state"] == "active")
    o.click("Run from here")
    o.texts_file = main
    o.wait("the run continues from there, disarmed", lambda s: s["state"] == "ready" and s["servo"]["cycles"] < cycles)
    o.see("READY")
    (moment,) = glob.glob(os.path.join(o.folder, "state", "tact", "from-replay", "*.tact-session"))
    with open(moment) as f:
        bodies = json.load(f)["bodies"]
    o.wait("the window draws", lambda s: s["gui"]["attached"])
    o.key("ctrl+shift+s")
    (saved,) = o.until("a session is saved", lambda: glob.glob(os.path.join(o.folder, "out", "*.tact-session")))
    with open(saved) as f:
        (now,) = json.load(f)["bodies"]
    apart_a = max(abs(a - b) for a, b in zip(now["pos_model_a"], bodies[0]["pos_model_a"]))
    return bad + expect("the body is where it was at that moment: %.4f A apart" % apart_a, len(bodies) == 1 and apart_a < 1e-3)


def main():
    bin_dir = arguments(__doc__, 1)[0]
    with tempfile.TemporaryDirectory(prefix="tact-past-", ignore_cleanup_errors=True) as folder:
        bake_demo(bin_dir, "dock", os.path.join(folder, "scene.tact"))
        operator = Operator(bin_dir, folder)
        try:
            bad = look_back(operator)
            operator.end()
        finally:
            operator.close()
        return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
