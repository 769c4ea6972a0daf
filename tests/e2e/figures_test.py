#!/usr/bin/python3
"""Compares the figures on the window with what the controller publishes, at twenty random instants of a run in each of three modes, while law, rate and
armed state change. The controller is asked before and after the texts are read, so a figure must lie between both answers.

usage: figures_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import os
import random
import re
import sys
import tempfile
import time

from operator_of_window import Operator, arguments, bake_demo, expect

INSTANTS, SEED = 20, 20261128
SHOWN_LATE_S = 0.35  # the window draws its texts twelve times a second, the controller publishes ten times


class Figures:
    def __init__(self, operator, name):
        self.operator, self.name, self.compared, self.faults = operator, name, 0, []

    # The first text that matches, on the row of a label of the controller's card.
    def row(self, texts, label, pattern):
        for t in texts:
            if t["owner"] != "Controller" or not t["text"].startswith(label):
                continue
            line = " ".join(o["text"] for o in sorted((o for o in texts if o["owner"] == "Controller" and abs(o["y"] - t["y"]) < 6), key=lambda o: o["x"]))
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


def main():
    bin_dir = arguments(__doc__, 1)[0]
    rng, bad = random.Random(SEED), 0
    with tempfile.TemporaryDirectory(prefix="tact-figures-", ignore_cleanup_errors=True) as folder:
        operator = Operator(bin_dir, folder)
        try:
            for scene, hand in (("dock", "wander"), ("touch", "stroke"), ("drill", "drill")):
                bake_demo(bin_dir, scene, os.path.join(folder, scene + ".tact"))
                figures = mode(operator, scene, hand, rng)
                for fault in figures.faults:
                    print("FAIL " + fault)
                bad += expect("%s: %d figures at %d instants (seed %d) are those of the controller" % (scene, figures.compared, INSTANTS, SEED),
                              not figures.faults and figures.compared >= 5 * INSTANTS)
        finally:
            operator.close()
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
