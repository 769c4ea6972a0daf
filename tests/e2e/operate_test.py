#!/usr/bin/python3
"""What an operator's keys do: pressed in the window of a real run, and seen in what the controller says and in where the body ends.

usage: operate_test.py BIN_DIR

Exit code 77: no window can be opened or no key pressed here.
"""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PATIENCE_S = 30.0


class Desk:
    """A screen of its own, and one run at a time on it."""

    def __init__(self, bin_dir, folder):
        self.bin, self.folder = bin_dir, folder
        read, write = os.pipe()
        self.x = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1300x760x24"], pass_fds=[write],
                                  stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as f:
            self.env = dict(os.environ, DISPLAY=":" + f.readline().strip(), LIBGL_ALWAYS_SOFTWARE="1", TACT_RUNTIME_DIR=folder)
        self.run = None

    def program(self, name):
        return os.path.join(self.bin, name)

    def start(self, *options):
        self.report = os.path.join(self.folder, "run.json")
        if os.path.exists(self.report):
            os.remove(self.report)
        self.log = open(os.path.join(self.folder, "run.log"), "wb")
        self.run = subprocess.Popen(
            [self.program("tact"), "run", os.path.join(self.folder, "scene.tact"), "--size", "1280x720", "--hand", "passive", "--quiet",
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
        sys.exit("FAILED %s: not so after %.0f s; the log:\n%s" % (what, PATIENCE_S, self.said()[-3000:]))

    def said(self):
        with open(self.log.name, errors="replace") as f:
            return f.read()

    def key(self, key):
        subprocess.run(["xdotool", "key", key], env=self.env, check=True)

    # Keys that place a body, each after the controller has done what the one before asked for.
    def place(self, *keys):
        for done, key in enumerate(keys, 1):
            self.key(key)
            self.wait("%s places the body" % key, lambda s: self.said().count("command place a body: done") >= done)

    def end(self):
        time.sleep(2.5)  # the launcher looks at bodies from time to time
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


def arming(desk):
    desk.start()
    desk.wait("the run is armed", lambda s: s["state"] in ("armed", "active"))
    desk.key("space")
    desk.wait("Space disarms", lambda s: s["state"] == "ready")
    desk.key("ctrl+Return")
    desk.wait("Ctrl+Enter arms", lambda s: s["state"] in ("armed", "active"))
    desk.end()
    return expect("Space disarms and Ctrl+Enter arms the controller", True)


def gestures(desk):
    # Without force, so that the body stays where it is put and the hand makes no gesture of its own; R looks for the best
    # place from there.
    places, moved_a = [], []
    for keys in (("r",), ("r", "ctrl+z"), ("r", "ctrl+z", "ctrl+y")):
        desk.start("--force-scale", "0.001", "--start-offset-a", "6", "--seed", "3")
        desk.key("space")
        desk.wait("Space disarms", lambda s: s["state"] == "ready")
        desk.place(*keys)
        places.append(desk.end()["fit"]["offset_a"])
        moved_a.append(float(re.search(r"refined body 1: moved ([0-9.]+) A", desk.said()).group(1)))
    refined, undone, redone = places
    return expect("R refines: moved %.2f A, %.2f A from its place" % (moved_a[0], refined), moved_a[0] > 1.0 and refined < 0.5) + \
        expect("Ctrl+Z takes %.2f A back: %.2f A" % (moved_a[1], undone), moved_a[1] > 1.0 and undone > 0.5 * moved_a[1]) + \
        expect("Ctrl+Y does it again: %.2f A" % redone, abs(redone - refined) < 0.1)


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
        desk = Desk(sys.argv[1], folder)
        try:
            return 1 if arming(desk) + gestures(desk) > 0 else 0
        finally:
            desk.close()


if __name__ == "__main__":
    sys.exit(main())
