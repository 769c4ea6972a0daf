#!/usr/bin/python3
"""Operates a real run as a person does, with keys, window buttons and the emergency stop, and checks the controller's reports, the recorded
force and the final pose of the body.

usage: operate_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import csv
import math
import os
import re
import signal
import subprocess
import sys
import tempfile

from operator_of_window import Operator, arguments, bake_demo, expect

RAMPED_OUT_S = 0.1  # twice safety.ramp_out_ms


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
    bin_dir = arguments(__doc__, 1)[0]
    with tempfile.TemporaryDirectory(prefix="tact-keys-") as folder:
        bake_demo(bin_dir, "dock", os.path.join(folder, "scene.tact"))
        operator = Operator(bin_dir, folder)
        try:
            return 1 if arming(operator) + buttons(operator) + gestures(operator) > 0 else 0
        finally:
            operator.close()


if __name__ == "__main__":
    sys.exit(main())
