#!/usr/bin/python3
"""Compares the figures on the window with what the controller publishes, at twenty random instants of a run in each of three modes, while law, rate and
armed state change. The controller is asked before and after the texts are read, so a figure must lie between both answers. Then the figures of a replay at
twenty places sought by mouse, with the recording; and those of a contour that is moved, with the map's mean and standard deviation.

usage: figures_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import time

from operator_of_window import Operator, arguments, bake_demo, expect

INSTANTS, SEED = 20, 20261128
SHOWN_LATE_S = 0.35  # the window draws its texts twelve times a second, the controller publishes ten times


class Figures:
    def __init__(self, operator, name):
        self.operator, self.name, self.compared, self.faults = operator, name, 0, []

    # The first text that matches, on the row of a label of a card.
    def row(self, texts, label, pattern, card="Controller"):
        for t in texts:
            if t["owner"] != card or not t["text"].startswith(label):
                continue
            line = " ".join(o["text"] for o in sorted((o for o in texts if o["owner"] == card and abs(o["y"] - t["y"]) < 6), key=lambda o: o["x"]))
            if m := re.search(pattern, line[len(label):]):
                return m
        return None

    def check(self, what, shown, low, high):
        self.compared += 1
        if shown is None or not min(low, high) <= shown <= max(low, high):
            self.faults.append("%s: %s shows %s, published %s to %s" % (self.name, what, shown, low, high))

    # The texts of the window, between two answers of the controller.
    def reading(self):
        o = self.operator
        before = o.status()
        time.sleep(SHOWN_LATE_S)
        texts = o.texts()
        time.sleep(SHOWN_LATE_S)
        return before, texts, o.status()

    def instant(self):
        before, texts, after = self.reading()
        if before is None or after is None:
            self.faults.append(self.name + ": no status")
            return
        number = lambda m: float(m.group(1).replace(" ", "")) if m else None
        both = lambda key: (key(before), key(after))
        self.check("overruns", number(self.row(texts, "Overruns", r"([\d ]*\d)")), *both(lambda s: s["servo"]["overruns"]))
        self.check("deadline misses", number(self.row(texts, "Deadlines", r"([\d ]*\d) missed")), *both(lambda s: s["deadline_misses"]))
        states = {s["state"].upper() for s in (before, after)}
        shown = {t["text"] for t in texts if t["owner"] == "Controller"}
        self.compared += 1
        if before["state"] == after["state"] and not states & shown:
            self.faults.append("%s: the state %s is not shown" % (self.name, states))
        law = {s["governor"]["law"] for s in (before, after)}
        self.compared += 1
        if not law & shown:
            self.faults.append("%s: the law %s is not shown" % (self.name, law))
        rates = [float(m.group(1)) * (1000 if m.group(2) == "kHz" else 1) for t in shown if (m := re.fullmatch(r"([\d.]+) (k?Hz)", t))]
        low, high = sorted(both(lambda s: s["servo"]["rate_window_hz"]))
        self.compared += 1
        if not any(low - 8 <= r <= high + 8 for r in rates):
            self.faults.append("%s: rate shown %s, published %.1f to %.1f Hz" % (self.name, rates, low, high))
        for path, name in (("gui.mesh", "mesh"), ("docking.force", "force"), ("surface.force", "force"), ("drilling.force", "force")):
            if path in before["governor"]["paths"] and path in after["governor"]["paths"]:
                self.level(path, name, before, texts, after)

    # The level of a path. It may fall and rise again between two equal answers, which one pair of answers does not show: only a figure that is none of
    # the controller's in three readings is a fault.
    def level(self, path, name, before, texts, after):
        for attempt in range(3):
            if attempt:
                before, texts, after = self.reading()
            levels = [s["governor"]["paths"][path]["level"] for s in (before, after)]
            if abs(levels[0] - levels[1]) > 0.005:
                return  # it moves
            seen = [m.group(1) for t in texts if t["owner"] == "Over time" and (m := re.match(name + r" (\d\.\d\d)", t["text"]))]
            shown = float(seen[0]) if seen else None
            if shown is not None and min(levels) - 0.0051 <= shown <= max(levels) + 0.0051:
                break
        self.check("level of " + path, shown, min(levels) - 0.0051, max(levels) + 0.0051)


def judge(figures, of, least):
    for fault in figures.faults:
        print("FAIL " + fault)
    return expect("%s: %d figures at %d instants (seed %d) are %s" % (figures.name, figures.compared, INSTANTS, SEED, of),
                  not figures.faults and figures.compared >= least)


def mode(operator, scene, hand, rng):
    operator.start(scene=scene + ".tact", hand=hand)
    operator.wait("the run is armed", lambda s: s["state"] == "active")
    figures = Figures(operator, scene)
    for i in range(INSTANTS):
        time.sleep(rng.uniform(0.0, 0.5))
        if i % 5 == 4:  # changes between the instants
            operator.key("space" if i % 10 == 4 else "ctrl+Return")
            time.sleep(0.5)
        figures.instant()
    operator.end()
    return figures


# A contour that is moved by keys: in the map's unit and in standard deviations above its mean.
def contoured(operator, rng):
    said = subprocess.run([operator.program("tact"), "info", operator.scene("dock.tact"), "--json"], env=operator.env, stdout=subprocess.PIPE, check=True)
    density = json.loads(said.stdout)["map"]
    figures, levels = Figures(operator, "contour"), set()
    operator.start(scene="dock.tact")
    operator.click("View", "Scene")
    for _ in range(INSTANTS):
        for _ in range(rng.randint(1, 3)):
            operator.key(rng.choice(["plus", "minus"]))
        time.sleep(SHOWN_LATE_S)
        m = figures.row(operator.texts(), "Contour", r"(-?[\d.]+) *map units, *(-?[\d.]+) σ", "Scene")
        level, sigmas = (float(m.group(1)), float(m.group(2))) if m else (None, None)
        levels.add(level)
        exact = (level - density["mean"]) / density["sigma"] if m else 0.0
        figures.check("standard deviations of %s" % level, sigmas, exact - 0.0056, exact + 0.0056)
    operator.end()
    if len(levels) < 5:
        figures.faults.append("contour: the keys moved it to %s only" % levels)
    return figures


# A recording in a paused replay: step, time, state and force of the step that is shown, as h5py reads them.
def replayed(operator, rng):
    import h5py

    recording = operator.scene("run.h5")
    operator.start("--record", recording, scene="touch.tact", hand="stroke")
    operator.wait("the run is armed", lambda s: s["state"] == "active")
    time.sleep(4.0)
    operator.end()
    with h5py.File(recording, "r") as f:
        now_ns, state, dry = f["cycles/now_ns"][:], f["cycles/run_state"][:], f["cycles/flags"][:] & 1
        force_n = [sum(x * x for x in w[:3]) ** 0.5 for w in f["hand0/wrench_model"][:]]
    figures = Figures(operator, "replay")
    operator.report = ""
    operator.launch("replay", recording, "--show", "--scene", operator.scene("touch.tact"))
    operator.see("REPLAY", "Replay")
    operator.key("space")
    operator.see("paused", "Timeline")
    steps = set()
    for _ in range(INSTANTS):
        title = next(t for t in operator.texts() if t["owner"].startswith("Timeline") and " s of " in t["text"])
        operator.xdotool("mousemove", str(rng.randint(600, 1230)), str(round(title["y"] + 2.2 * title["h"])))
        for button in ("mousedown", "mouseup"):
            time.sleep(0.2)
            operator.xdotool(button, "1")
        texts = operator.holds_within(lambda: found(operator), 20.0) or operator.texts()
        words = [t["text"] for t in texts]
        first = lambda pattern: next((m for w in words if (m := re.search(pattern, w))), None)
        number = lambda m: float(m.group(1).replace(" ", "")) if m else None
        step = int(number(first(r"step ([\d ]+) of ")) or 0)
        if not 0 < step <= len(now_ns):
            figures.check("step", None, 1, len(now_ns))
            continue
        steps.add(step)
        at_s = 1e-9 * (now_ns[step - 1] - now_ns[0])
        figures.check("steps", number(first(r"step [\d ]+ of ([\d ]+)")), len(now_ns), len(now_ns))
        figures.check("time of step %d" % step, number(first(r"([\d.]+) s of ")), at_s - 0.0006, at_s + 0.0006)
        figures.check("force of step %d" % step, number(first(r"model force ([\d.]+) N")), force_n[step - 1] - 0.0051, force_n[step - 1] + 0.0051)
        figures.compared += 1
        shown = figures.row(texts, "Then", "^ *(%s)" % "|".join(STATES), "Replay")  # the device has a state "ready", too
        # Before the start no state is published.
        if not dry[step - 1] and (shown is None or shown.group(1) != STATES[state[step - 1]]):
            figures.faults.append("replay: the state of step %d is shown as %s, it was %s" % (step, shown and shown.group(1), STATES[state[step - 1]]))
    operator.end()
    if len(steps) < INSTANTS // 2:
        figures.faults.append("replay: only %d places were reached" % len(steps))
    return figures


STATES = ["off", "ready", "armed", "active", "fault"]  # of RunState


# The texts, once two readings say that the replay is paused at the same step.
def found(operator):
    def read():
        texts = operator.texts()
        return next((t["text"] for t in texts if t["text"].startswith("step ")), None), any("paused" in t["text"] for t in texts), texts
    before, _, _ = read()
    time.sleep(0.5)
    after, paused, texts = read()
    return texts if paused and before is not None and before == after else None


def main():
    bin_dir = arguments(__doc__, 1)[0]
    rng, bad = random.Random(SEED), 0
    with tempfile.TemporaryDirectory(prefix="tact-figures-", ignore_cleanup_errors=True) as folder:
        operator = Operator(bin_dir, folder)
        try:
            for scene, hand in (("dock", "wander"), ("touch", "stroke"), ("drill", "drill")):
                bake_demo(bin_dir, scene, os.path.join(folder, scene + ".tact"))
                figures = mode(operator, scene, hand, rng)
                bad += judge(figures, "those of the controller", 5 * INSTANTS)
            bad += judge(contoured(operator, rng), "those of the map", INSTANTS)
            bad += judge(replayed(operator, rng), "those of the recording", 4 * INSTANTS)
        finally:
            operator.close()
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
