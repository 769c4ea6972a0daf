#!/usr/bin/python3
"""Operates a real run as a person does, with keys, window buttons and the emergency stop, and checks the controller's reports, the recorded
force and the final pose of the body.

usage: operate_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import csv
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

PATIENCE_S = 60.0

# Colour of an enabled button, with and without the mouse on it; no letter or lamp is as large.
BUTTONS = {
    "Arm": lambda r, g, b: g - r > 20 and g < 160,
    "Disarm": lambda r, g, b: r - g < 50 and g - b > 15 and r - b > 25 and r < 160,
    "Reset": lambda r, g, b: r - g > 25 and r - b > 25 and abs(g - b) < 20 and r < 160,
}
BUTTONS_WITHIN = (310, 360)  # pixels of the window, around the controller's card
SOLID = (12, 14)
RAMPED_OUT_S = 0.1  # twice safety.ramp_out_ms


class Operator:
    """A private X screen with at most one run on it."""

    def __init__(self, bin_dir, folder):
        self.bin, self.folder = bin_dir, folder
        read, write = os.pipe()
        self.x = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1300x760x24", "-fbdir", folder], pass_fds=[write],
                                  stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as f:
            self.env = dict(os.environ, DISPLAY=":" + f.readline().strip(), LIBGL_ALWAYS_SOFTWARE="1", TACT_RUNTIME_DIR=folder)
        self.run = None

    def program(self, name):
        return os.path.join(self.bin, name)

    def start(self, *options, hand="passive"):
        self.report = os.path.join(self.folder, "run.json")
        if os.path.exists(self.report):
            os.remove(self.report)
        self.log = open(os.path.join(self.folder, "run.log"), "wb")
        self.run = subprocess.Popen(
            [self.program("tact"), "run", os.path.join(self.folder, "scene.tact"), "--size", "1280x720", "--hand", hand, "--quiet",
             "--session", "keys", "--json", self.report, *options], env=self.env, stdout=self.log, stderr=self.log)
        self.wait("the window draws", lambda s: s["gui"]["attached"] and s["gui"]["frames"] and s["gui"]["frames"]["count"] > 20)
        subprocess.run(["xdotool", "mousemove", "800", "300"], env=self.env, check=True)

    def status(self):
        said = subprocess.run([self.program("tact"), "status", "--session", "keys", "--json"], env=self.env, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL)
        return json.loads(said.stdout) if said.returncode == 0 else None

    def wait(self, what, true):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            now = self.status()
            if now is not None and true(now):
                return now
            time.sleep(0.1)
        sys.exit("FAILED %s: timed out after %.0f s; the log:\n%s" % (what, PATIENCE_S, self.said()[-3000:]))

    def said(self):
        with open(self.log.name, errors="replace") as f:
            return f.read()

    def key(self, key):
        subprocess.run(["xdotool", "key", key], env=self.env, check=True)

    # The screen's pixels as a function (x, y) -> (red, green, blue), from the file in xwd format that Xvfb writes.
    def picture(self):
        with open(os.path.join(self.folder, "Xvfb_screen0"), "rb") as f:
            data = f.read()
        head = struct.unpack(">25I", data[:100])
        begin, line = head[0] + 12 * head[19], head[12]

        def pixel(x, y):
            at = begin + line * y + 4 * x
            return data[at + 2], data[at + 1], data[at]
        return pixel

    # Finds the enabled button in the window; None: not visible.
    def button(self, name):
        pixel, like = self.picture(), BUTTONS[name]
        wide, high = SOLID
        for y in range(0, BUTTONS_WITHIN[1] - high, 4):
            for x in range(0, BUTTONS_WITHIN[0] - wide, 4):
                if all(like(*pixel(x + dx, y + dy)) for dx in range(0, wide, 2) for dy in range(0, high, 2)):
                    return x + wide // 2, y + high // 2
        return None

    # Clicks the button until the condition holds: in a slow window the button may have moved since the last frame.
    def press(self, name, what, true):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            if (at := self.button(name)) is not None:
                subprocess.run(["xdotool", "mousemove", str(at[0]), str(at[1]), "click", "1"], env=self.env, check=True)
            again = time.monotonic() + (3.0 if at is not None else 0.0)
            while True:
                if (now := self.status()) is not None and true(now):
                    return now
                if time.monotonic() > again:
                    break
                time.sleep(0.1)
        sys.exit("FAILED %s: timed out after %.0f s; the window shows %s enabled button %s; the log:\n%s" %
                 (what, PATIENCE_S, "an" if at else "no", name, self.said()[-3000:]))

    # The process id of the controller.
    def controller(self):
        with open("/proc/%d/task/%d/children" % (self.run.pid, self.run.pid)) as f:
            for pid in map(int, f.read().split()):
                with open("/proc/%d/comm" % pid) as name:
                    if name.read().strip() == "tact-rt":
                        return pid
        sys.exit("FAILED: the run has no controller")

    # Presses keys that place a body, each after the controller has executed the last one.
    def place(self, *keys):
        for done, key in enumerate(keys, 1):
            self.key(key)
            self.wait("%s places the body" % key, lambda s: self.said().count("command place a body: done") >= done)

    def end(self):
        self.run.send_signal(signal.SIGINT)
        self.run.wait(60)
        self.run = None
        with open(self.report) as f:
            return json.load(f)

    def close(self):
        if self.run is not None:
            self.run.kill()
        self.x.kill()
        self.x.wait()


def expect(what, true):
    print("%s %s" % ("ok  " if true else "FAIL", what), flush=True)
    return 0 if true else 1


def arming(operator):
    operator.start()
    operator.wait("the run is armed", lambda s: s["state"] in ("armed", "active"))
    operator.key("space")
    operator.wait("Space disarms", lambda s: s["state"] == "ready")
    operator.key("ctrl+Return")
    operator.wait("Ctrl+Enter arms", lambda s: s["state"] in ("armed", "active"))
    operator.end()
    return expect("Space disarms and Ctrl+Enter arms the controller", True)


# Per recorded cycle: time, state of the controller, norm of the force sent to the device in newtons.
def forces(operator, recording):
    table = os.path.join(operator.folder, "cycles.csv")
    subprocess.run([operator.program("tact"), "record", "--csv", recording, "-o", table], env=operator.env, check=True, stdout=subprocess.DEVNULL)
    with open(table, newline="") as f:
        return [(float(r["time_s"]), r["state"], math.hypot(*(float(r["hand0_f%s_n" % axis]) for axis in "xyz"))) for r in csv.DictReader(f)]


def buttons(operator):
    config, recording = os.path.join(operator.folder, "lines.toml"), os.path.join(operator.folder, "run.h5")
    with open(config, "w") as f:
        f.write('[lines]\ndriver = "sim"\n')
    off, on = lambda s: s["state"] == "ready", lambda s: s["state"] == "active"
    operator.start("--config", config, "--record", recording, "--start-offset-a", "6", "--seed", "3", hand="wander")
    # A run that arms while the contacts settle is refused; then a person must arm.
    operator.wait("the run is armed", lambda s: "command arm: " in operator.said())
    operator.key("space")
    operator.wait("Space disarms", off)
    operator.press("Arm", "the button arms", on)
    operator.press("Disarm", "the button disarms", off)
    cycles = operator.press("Arm", "the button arms again", on)["servo"]["cycles"]
    bad = expect("the buttons Disarm and Arm disarm and arm", True)
    operator.wait("the force has ramped in", lambda s: s["servo"]["cycles"] > cycles + 1500)

    os.kill(operator.controller(), signal.SIGUSR1)
    stopped = operator.wait("the emergency stop trips", lambda s: s["state"] == "fault")
    bad += expect("the controller reports the emergency stop: %s, lines %s" % (stopped["reason"], stopped["lines"]["state"]),
                  stopped["reason"] == stopped["lines"]["reason"] == "the emergency stop is pressed" and stopped["lines"]["state"] == "stop")
    refused = operator.press("Reset", "a reset is refused while the stop is pressed", lambda s: "command reset fault: refused" in operator.said())
    bad += expect("Reset keeps the fault while the stop is pressed", refused["state"] == "fault")
    os.kill(operator.controller(), signal.SIGUSR2)
    released = operator.wait("the stop is released", lambda s: s["lines"]["state"] == "waiting for re-arming")
    bad += expect("releasing the stop keeps the fault", released["state"] == "fault")
    operator.press("Reset", "the button resets", off)
    operator.press("Arm", "the button arms after a stop", on)
    disarmed = operator.press("Disarm", "the button disarms after a stop", off)["servo"]["cycles"]
    operator.wait("some time passes without force", lambda s: s["servo"]["cycles"] > disarmed + 500)
    bad += expect("after Reset the button Arm arms again", True)
    operator.end()

    rows = forces(operator, recording)
    states = [state for _, state, _ in rows]
    stop = states.index("fault")
    least_force_n = max(n for _, state, n in rows[max(stop - 1000, 0):stop] if state == "active")
    at_stop = [n for _, state, n in rows if state == "fault"]
    none, since, before = [], 0.0, None
    for t, state, n in rows:
        since, before = (since, before) if state == before else (t, state)
        if state == "ready" and t - since > RAMPED_OUT_S:
            none.append(n)
    return bad + expect("the force reaches %.2f N in the second before the stop" % least_force_n, least_force_n > 0.02) + \
        expect("the force is 0 N in all %d cycles from the stop on" % len(at_stop), max(at_stop) == 0.0) + \
        expect("the force is 0 N in all %d disarmed cycles" % len(none), len(none) > 100 and max(none) == 0.0)


def gestures(operator):
    # Almost without force, so that the body keeps its pose and the hand makes no gesture; R finds the best pose near it.
    places, moved_a = [], []
    for keys in (("r",), ("r", "ctrl+z"), ("r", "ctrl+z", "ctrl+y")):
        operator.start("--force-scale", "0.001", "--start-offset-a", "6", "--seed", "3")
        operator.key("space")
        operator.wait("Space disarms", lambda s: s["state"] == "ready")
        operator.place(*keys)
        places.append(operator.end()["fit"]["offset_a"])
        moved_a.append(float(re.search(r"refined body 1: ([0-9.]+) ", operator.said()).group(1)))
    refined, undone, redone = places
    return expect("R refines: moved %.2f A, ends %.2f A from the pose in the file" % (moved_a[0], refined), moved_a[0] > 1.0 and refined < 0.5) + \
        expect("Ctrl+Z undoes %.2f A: ends %.2f A away" % (moved_a[1], undone), moved_a[1] > 1.0 and undone > 0.5 * moved_a[1]) + \
        expect("Ctrl+Y redoes it: ends %.2f A away" % redone, abs(redone - refined) < 0.1)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    missing = [p for p in ("Xvfb", "xdotool") if shutil.which(p) is None]
    if missing:
        print("skipped: %s is not installed" % ", ".join(missing))
        return 77
    with tempfile.TemporaryDirectory(prefix="tact-keys-") as folder:
        subprocess.run([os.path.join(sys.argv[1], "tact-prep"), "demo", "dock", "-o", os.path.join(folder, "scene.tact")], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        operator = Operator(sys.argv[1], folder)
        try:
            return 1 if arming(operator) + buttons(operator) + gestures(operator) > 0 else 0
        finally:
            operator.close()


if __name__ == "__main__":
    sys.exit(main())
