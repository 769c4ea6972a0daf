#!/usr/bin/python3
"""Leads the emulated hand by the mouse in the window, as a person without a device does, in every system of scenes; checks the tool, the force, the
result, and that the recorded run repeats to the bit.

usage: mouse_hand_test.py BIN_DIR [dock|touch|drill|two|demo...]

Exit code 77: Xvfb or xdotool is missing.
"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time

from operator_of_window import Operator, arguments, bake_demo, expect

WHEEL_M = 1.5e-3  # of the hand, for a step of the wheel
RING_PX = 30  # from the label "drag to lead" up to the middle of the ring


def less(a, b):
    return [x - y for x, y in zip(a, b)]


def norm(v):
    return math.sqrt(sum(x * x for x in v))


def solved(columns, wanted):
    """x with sum x[i] columns[i] = wanted, by Cramer's rule."""
    def det(a, b, c):
        return sum(a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]) for i in range(3))
    a, b, c = columns
    return [det(wanted, b, c) / det(a, b, c), det(a, wanted, c) / det(a, b, c), det(a, b, wanted) / det(a, b, c)]


class Mouse(Operator):
    """Leads the tool; distances in pixels right, pixels down, and steps of the wheel away from the viewer."""
    hand = 0  # which one the mouse leads
    at = (0, 0)
    per_step = None  # metres of the world, for each of them
    before = None  # where the tool was as it was taken

    def tool(self):
        return self.status()["tools"][self.hand]

    def position(self):
        return self.tool()["pos_world_m"]

    def force_n(self):
        return norm(self.tool()["force_world_n"])

    def take(self):
        """Points at the tool and presses; where the tool or the view moved meanwhile, points again, as a person would."""
        for _ in range(4):
            x, y = self.see("drag to lead")
            self.at = (round(x), round(y) - RING_PX)
            self.xdotool("mousemove", *map(str, self.at))
            if self.holds_within(lambda: self.find("Drag to lead the tool, or press L."), 5.0):
                break
        else:
            self.fail("the pointer at %d, %d does not find the tool" % self.at)
        self.before = self.position()
        self.xdotool("mousedown", "1")
        self.wait("the mouse leads the hand", lambda s: s["mouse"]["hands"][self.hand] == "leads")

    def let_go(self):
        self.xdotool("mouseup", "1")
        self.wait("the mouse lets the hand go", lambda s: s["mouse"]["hands"][self.hand] == "may")

    def move(self, right, down, away=0, steps=20, pause_s=0.016):
        """In equal steps, as a pointer of 60 Hz."""
        x, y = self.at
        for i in range(1, steps + 1):
            to = (round(x + right * i / steps), round(y + down * i / steps))
            if to != self.at:
                self.xdotool("mousemove", *map(str, to))
                self.at = to
            time.sleep(pause_s)
        whole = math.trunc(away)
        self.wheel(whole)
        if (fifths := round(5 * (away - whole))) != 0:
            self.xdotool("keydown", "shift")
            time.sleep(0.1)
            self.wheel(fifths)
            time.sleep(0.1)
            self.xdotool("keyup", "shift")

    def wheel(self, steps):
        for _ in range(abs(steps)):
            self.xdotool("click", "4" if steps > 0 else "5")
            time.sleep(0.05)

    def rest(self):
        """The tool, once it has come to rest."""
        time.sleep(0.5)  # a busy window sends the motion later
        before = self.position()
        for _ in range(40):
            time.sleep(0.15)
            now = self.position()
            if norm(less(now, before)) < 1e-4:
                return now
            before = now
        return now

    def learn(self):
        """How far the tool moves for a pixel and for a step of the wheel, in free space."""
        for _ in range(4):
            self.learn_once()
            right, down, away = map(norm, self.per_step)
            if abs(away / WHEEL_M - 1.0) < 0.15 and abs(right / down - 1.0) < 0.15:
                return
        self.fail("learning how the mouse moves the tool: %s" % self.per_step)

    def learn_once(self):
        self.per_step = []
        for right, down, away in ((40, 0, 0), (0, 40, 0), (0, 0, 4)):
            before = self.rest()
            self.move(right, down, away)
            after = self.rest()
            self.per_step.append([x / (right + down + away) for x in less(after, before)])
            self.move(-right, -down, -away)

    def to(self, world_m, steps=30):
        """Brings the tool to a place in free space."""
        for _ in range(4):
            off = less(world_m, self.rest())
            if norm(off) < 8e-4:
                return
            right, down, away = solved(self.per_step, off)
            self.move(right, down, away, steps)

    def text(self, pattern):
        for t in self.texts():
            if (m := re.search(pattern, t["text"])) is not None:
                return float(m.group(1))
        return None

    def cycles(self, recording):
        table = os.path.join(self.folder, "cycles.csv")
        subprocess.run([self.program("tact"), "record", "--csv", recording, "-o", table], env=self.env, check=True, stdout=subprocess.DEVNULL)
        with open(table, newline="") as f:
            return list(csv.DictReader(f))

    def repeats(self, recording):
        said = subprocess.run([self.program("tact"), "replay", recording, "--scene", self.scene()], env=self.env, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        return expect("the recorded run repeats to the bit" if said.returncode == 0 else "the replay: " + said.stdout, said.returncode == 0)

    def begin(self, kind, *options, hand="mouse"):
        if not os.path.exists(self.scene()):
            bake_demo(self.bin, kind, self.scene())
        self.recording = os.path.join(self.folder, kind + ".h5")
        if os.path.exists(self.recording):
            os.remove(self.recording)
        self.start("--seed", "3", "--record", self.recording, *options, hand=hand)
        self.wait("the run is armed", lambda s: s["state"] == "active")

    def smooth(self, rows):
        """The hand moved at the rate of the servo: no jump between two cycles, and no rest of a frame while it moved."""
        places = [[float(r["hand0_%s_m" % a]) for a in "xyz"] for r in rows]
        most = max(norm(less(b, a)) for a, b in zip(places, places[1:]))
        return expect("the hand moved smoothly: at most %.2f mm in a cycle" % (1e3 * most), 0.0 < most < 0.75e-3)


def dock(m):
    m.begin("dock", "--start-offset-a", "15")
    told = subprocess.run([m.program("tact"), "info", m.scene(), "--json"], env=m.env, stdout=subprocess.PIPE, check=True)
    a_per_world_m = 1e10 / json.loads(told.stdout)["world_per_model"]
    m.take()
    bad = expect("taking the tool does not move it", norm(less(m.position(), m.before)) < 5e-3)  # the force may
    distance = lambda: m.text(r"^([0-9.]+) Å, ")
    m.move(70, 40, -3)  # away from where the force drew it
    m.learn()
    m.rest()
    time.sleep(0.5)
    bad += expect("the mouse holds it away: %.1f Å" % distance(), distance() > 10.0)
    for _ in range(8):
        m.rest()
        time.sleep(0.4)  # texts follow twelve times a second
        d0 = distance()
        print("     %.2f Å" % d0, flush=True)
        if d0 < 0.6:
            break
        # The distances on both sides along each direction tell how far the place is in it, as a person finds by trying.
        ahead = []
        for i, probe in enumerate(((24, 0, 0), (0, 24, 0), (0, 0, 3)) if d0 > 5.0 else ((8, 0, 0), (0, 8, 0), (0, 0, 1))):
            squares = []
            for side in (1, -1):
                m.move(*(side * p for p in probe), steps=6)
                m.rest()
                time.sleep(0.4)
                squares.append(distance() ** 2)
                m.move(*(-side * p for p in probe), steps=6)
            step_a = norm(m.per_step[i]) * a_per_world_m
            ahead.append((squares[1] - squares[0]) / (4.0 * sum(probe) * step_a * step_a))
        m.move(*ahead, steps=30)
    m.rest()
    time.sleep(0.5)
    held = distance()
    bad += expect("by the mouse alone the structure is %.2f Å from its place" % held, held < 1.0)
    m.xdotool("keydown", "ctrl")
    before = m.tool()["quat_world_tool_xyzw"]
    m.move(60, 0)
    m.xdotool("keyup", "ctrl")
    m.rest()
    turned = 2.0 * math.degrees(math.acos(min(1.0, abs(sum(a * b for a, b in zip(before, m.tool()["quat_world_tool_xyzw"]))))))
    bad += expect("Ctrl turns it: by %.0f degrees" % turned, 10.0 < turned < 40.0)
    m.xdotool("keydown", "ctrl")
    m.move(-60, 0)
    m.xdotool("keyup", "ctrl")
    m.rest()
    m.let_go()
    camera = m.find("drag to lead")
    bad += expect("the label is gone once the tool was taken", camera is None)
    report = m.end()
    fit = report["bodies"][0]
    bad += expect("it is docked: %.2f Å, %.1f degrees" % (fit["offset_a"], fit["angle_deg"]), fit["offset_a"] < 1.0 and fit["angle_deg"] < 10.0)
    bad += expect("no record of the mouse was refused: %s" % report["mouse"], report["mouse"]["refused"] == 0 and report["mouse"]["accepted"] > 100)
    bad += m.smooth(m.cycles(m.recording))
    return bad + m.repeats(m.recording)


def touch(m):
    m.begin("touch")
    m.take()
    m.move(-120, 0, steps=40)
    m.rest()
    # Down onto the terrain, and along it: the pointer goes below the surface as far as the force is to be.
    begun, reached = None, 0
    for _ in range(400):
        force = m.force_n()
        step = max(-6.0, min(6.0, (2.0 - force) * 8.0))
        if force > 1.7 and begun is None:
            begun = m.status()["servo"]["cycles"]
        right = 2 if begun is not None else 0
        reached += right
        if reached > 200:
            break
        m.move(right, step, steps=2)
    ended = m.status()["servo"]["cycles"]
    lag = m.force_n()
    m.let_go()
    report = m.end()
    rows = m.cycles(m.recording)
    forces = [norm([float(r["hand0_f%s_n" % a]) for a in "xyz"]) for r in rows]
    part = forces[begun:ended]
    inside = sum(1 for f in part if 1.5 <= f <= 2.5) / max(len(part), 1)
    mean = sum(part) / max(len(part), 1)
    bad = expect("a contour of %.1f s was followed at %.2f N, %.0f %% of it within 2 N +- 0.5" % (len(part) / 1000.0, mean, 100.0 * inside),
                 len(part) > 2000 and abs(mean - 2.0) < 0.25 and inside > 0.8)
    bad += expect("the force was felt to the end (%.1f N) and stayed within the arm's (%.1f N)" % (lag, max(forces)), lag > 1.0 and max(forces) <= 8.5)
    bad += expect("no record of the mouse was refused", report["mouse"]["refused"] == 0)
    bad += m.smooth(rows)
    return bad + m.repeats(m.recording)


def drill(m):
    m.begin("drill")
    m.take()
    m.learn()
    m.to([-0.0045, 0.0, m.position()[2]])
    # Away from the viewer until the burr touches.
    for _ in range(120):
        if m.force_n() > 0.3:
            break
        right, down, away = solved(m.per_step, [0.0, 0.0, -1.5e-3])
        m.move(right, down, away, steps=4)
        time.sleep(0.15)
    bad = expect("the burr meets the bone: %.2f N" % m.force_n(), m.force_n() > 0.3)
    removed = lambda: m.text(r"^([0-9.]+) mm³") or 0.0
    untouched = removed()
    m.xdotool("mousedown", "3")
    m.wait("the burr's button is pressed", lambda s: s["tools"][0]["buttons"] == 2)
    m.see("The burr runs.")
    # Strokes in a circle, slowly deeper, with a light hand.
    for turn in range(60):
        angle, radius = 0.5 * turn, 1.2e-3
        across = [radius * 0.5 * -math.sin(angle), radius * 0.5 * math.cos(angle), -4e-4 if m.force_n() < 0.9 else 3e-4]
        m.move(*solved(m.per_step, across), steps=4)
        if removed() > 60.0:
            break
    m.xdotool("mouseup", "3")
    m.wait("the burr's button is released", lambda s: s["tools"][0]["buttons"] == 0)
    m.let_go()
    report = m.end()
    trainee = report["drilling"]["trainee"]
    bad += expect("a cavity was drilled: %.1f mm³ (%.1f before the burr ran)" % (report["drilling"]["removed_mm3"], untouched),
                  report["drilling"]["removed_mm3"] > 20.0 and untouched == 0.0)
    bad += expect("without an injury, at most %.1f N" % trainee["force"]["max_n"], trainee["injuries"] == 0 and trainee["force"]["max_n"] < 5.0)
    bad += expect("no record of the mouse was refused", report["mouse"]["refused"] == 0)
    return bad + m.repeats(m.recording)


def two(m):
    """The mouse leads one of two hands in bone, and the other moves by its own script: the suction tube beside a surgeon, then the burr."""
    bad = 0
    for hand, hands in ((1, ("surgeon", "mouse")), (0, ("mouse", "suction-tube"))):
        name, other = ("suction tube", "burr")[:: 1 if hand == 1 else -1]
        m.hand = hand
        m.begin("drill", "--hand2", hands[1], hand=hands[0])
        ways = m.status()["mouse"]["hands"]
        bad += expect("the mouse may lead the %s alone: %s" % (name, ways), ways[hand] == "may" and ways[1 - hand] == "none")
        m.take()
        others, buttons = [], []
        at = m.rest()
        m.move(0, -60, steps=20)
        reached = m.rest()
        bad += expect("the %s follows the mouse: by %.1f mm" % (name, 1e3 * norm(less(reached, at))), norm(less(reached, at)) > 4e-3)
        m.xdotool("mousedown", "3")
        m.wait("the button of the %s is pressed" % name, lambda s: s["tools"][hand]["buttons"] & 2)
        for _ in range(20):
            tools = m.status()["tools"]
            others.append(tools[1 - hand]["pos_world_m"])
            time.sleep(0.1)
        moved = max(norm(less(p, others[0])) for p in others)
        bad += expect("the %s moves by its script meanwhile: by %.2f mm" % (other, 1e3 * moved), moved > 2e-4)
        rested = norm(less(m.position(), reached))
        bad += expect("and the %s stays where the mouse is: within %.2f mm" % (name, 1e3 * rested), rested < 3e-3)
        m.xdotool("mouseup", "3")
        m.wait("the button of the %s is released" % name, lambda s: not s["tools"][hand]["buttons"] & 2)
        m.let_go()
        report = m.end()
        bad += expect("no record of the mouse was refused: %s" % report["mouse"], report["mouse"]["refused"] == 0 and report["mouse"]["accepted"] > 50)
        bad += m.repeats(m.recording)
    return bad


def demo(m):
    """A demo moves by itself until a person takes the tool; Esc and L take and let go; a window that ends lets go."""
    if not os.path.exists(m.scene()):
        bake_demo(m.bin, "touch", m.scene())
    m.report = os.path.join(m.folder, "run.json")
    m.launch("demo", "touch", "--json", m.report)
    m.wait("the demo moves", lambda s: s["gui"]["attached"] and s["mouse"] and s["mouse"]["hands"][0] == "may" and norm(s["tools"][0]["pos_world_m"]) > 5e-3)
    m.see("drag to lead")
    m.xdotool("mousemove", "800", "300")
    m.key("l")
    m.wait("L leads", lambda s: s["mouse"]["hands"][0] == "leads")
    at = m.rest()
    time.sleep(1.0)
    bad = expect("the hand is the person's: it rests while the mouse does (%.2f mm)" % (1e3 * norm(less(m.position(), at))), norm(less(m.position(), at)) < 1e-3)
    m.at = (800, 300)
    m.move(0, -60)
    bad += expect("and follows the mouse without a button", norm(less(m.rest(), at)) > 5e-3)
    m.key("Escape")
    m.wait("Esc lets go", lambda s: s["mouse"]["hands"][0] == "may")
    m.key("l")
    m.wait("L leads again", lambda s: s["mouse"]["hands"][0] == "leads")
    m.end()
    return bad


TRIES = 3  # a scripted pointer loses its way where another program takes the processor for a second
RUNS = {"dock": dock, "touch": touch, "drill": drill, "two": two, "demo": demo}


def main():
    bin_dir, *names = arguments(__doc__, 1)
    bad = 0
    for name in names or RUNS:
        bad += 1 if all(run(bin_dir, name) for _ in range(TRIES)) else 0
    sys.exit(1 if bad else 0)


def run(bin_dir, name):
    """Whether it failed."""
    with tempfile.TemporaryDirectory(prefix="tact-mouse-", ignore_cleanup_errors=True) as folder:
        mouse = Mouse(bin_dir, folder)
        try:
            return RUNS[name](mouse) != 0
        except SystemExit as why:
            print("FAIL %s: %s" % (name, why), flush=True)
            return True
        finally:
            mouse.close()


if __name__ == "__main__":
    main()
