#!/usr/bin/python3
"""Leads the emulated hand by a SpaceMouse, as a person with spacenavd does, and moves the view with it. The daemon is a fake on a real socket, which
sends what a device would; and the real spacenavd without a device, which is stopped and started again.

usage: space_mouse_test.py BIN_DIR [hand|camera|daemon...]

Exit code 77: Xvfb or xdotool is missing.
"""
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

from fake_spacenavd import FakeSpacenavd
from mouse_hand_test import Mouse, less, norm
from operator_of_window import arguments, bake_demo, expect

FULL = 350
SPEED_M_S = 0.06  # of the hand at full deflection (gui/input/rate_control.hpp)


class SpaceMouse(Mouse):
    daemon = None

    def __init__(self, bin_dir, folder):
        super().__init__(bin_dir, folder)
        self.socket = os.path.join(folder, "spnav.sock")
        self.env["SPNAV_SOCKET"] = self.socket
        self.session_state = os.path.join(folder, "window.toml")

    def plug(self, device=0x20A):
        self.daemon = FakeSpacenavd(self.socket, device)

    def connected(self):
        self.until("the window is connected to the daemon", lambda: self.daemon.clients)

    def begin_touch(self, hand):
        if not os.path.exists(self.scene()):
            bake_demo(self.bin, "touch", self.scene())
        self.recording = os.path.join(self.folder, "touch%d.h5" % len(os.listdir(self.folder)))
        self.start("--record", self.recording, "--window-state", self.session_state, hand=hand)
        self.wait("the run is armed", lambda s: s["state"] == "active")


def hand(m):
    m.begin_touch("spacemouse")
    m.see("SpaceMouse: not found. Install and start spacenavd.")
    m.plug()
    m.see("Move the SpaceMouse to lead the tool.")
    at = m.rest()
    m.daemon.push((0, FULL, 0, 0, 0, 0), 0.5)
    m.wait("the SpaceMouse leads the hand", lambda s: s["mouse"]["hands"][0] == "leads" and s["mouse"]["devices"][0] == "spacemouse")
    moved = less(m.rest(), at)
    bad = expect("the cap pushed up for 0.5 s moves the tool by %.1f mm" % (1e3 * norm(moved)), 0.4 < norm(moved) / (0.5 * SPEED_M_S) < 1.6)
    rests = m.position()
    time.sleep(1.0)
    bad += expect("released, it stays there", norm(less(m.position(), rests)) < 5e-4)
    m.see("The SpaceMouse leads the tool.")
    m.daemon.push((20, 20, -20, 20, 20, 20), 0.5)  # within the dead zone
    bad += expect("within the dead zone nothing moves", norm(less(m.rest(), rests)) < 5e-4)
    m.daemon.button(1, True)
    m.wait("its second button is the stylus's", lambda s: s["tools"][0]["buttons"] == 2)
    m.daemon.motion(0, 0, -FULL // 2, 0, 0, 0)  # held over while the daemon dies
    m.daemon.stop(keeps_file=True)
    m.wait("the button opens", lambda s: s["tools"][0]["buttons"] == 0)
    m.see("The SpaceMouse is gone: the tool's target stays.")
    gone = m.rest()
    time.sleep(1.0)
    bad += expect("without the daemon the tool stays where it was led", norm(less(m.position(), gone)) < 5e-4)
    bad += expect("and is still held", m.status()["mouse"]["hands"][0] == "leads")
    m.plug()
    m.see("The SpaceMouse leads the tool.")
    bad += expect("a daemon that comes back moves nothing by itself", norm(less(m.rest(), gone)) < 5e-4)
    # Down onto the terrain, until the force holds the tool back.
    felt = 0.0
    for _ in range(60):
        m.daemon.push((0, -FULL, 0, 0, 0, 0), 0.2)
        felt = m.force_n()
        if felt > 1.5:
            break
    bad += expect("the surface holds the tool back: %.1f N" % felt, felt > 1.5)
    m.daemon.push((0, FULL, 0, 0, 0, 0), 1.0)
    frames = m.status()["gui"]["frames"]["count"]
    m.daemon.flood(2.0)
    drawn = m.status()["gui"]["frames"]["count"] - frames
    bad += expect("a flood does not hold up the window: %d frames in 2 s" % drawn, drawn > 10)
    m.key("Escape")
    m.wait("Esc lets go", lambda s: s["mouse"]["hands"][0] == "may")
    m.connected()
    m.daemon.push((0, FULL, 0, 0, 0, 0), 0.2)
    m.wait("new motion takes it again", lambda s: s["mouse"]["hands"][0] == "leads")
    m.key("Escape")
    m.wait("Esc lets go again", lambda s: s["mouse"]["hands"][0] == "may")
    report = m.end()
    bad += expect("no record was refused: %s" % report["mouse"], report["mouse"]["refused"] == 0 and report["mouse"]["accepted"] > 50)
    bad += expect("the choice of this run is not kept", 'spacemouse = "camera"' in open(m.session_state).read())
    bad += m.smooth(m.cycles(m.recording))
    return bad + m.repeats(m.recording)


def orientation(m):
    return [float(x) for x in re.search(r"quat_eye_scene_xyzw = \[(.*)\]", open(m.session_state).read()).group(1).split(",")]


def camera(m):
    """As a camera it turns the view, and the tool is left alone; chosen in the window, and kept."""
    m.plug()
    m.begin_touch("mouse")
    m.connected()
    m.end()
    before = orientation(m)
    m.begin_touch("mouse")
    m.connected()
    at = m.rest()
    m.daemon.push((0, 0, 0, 0, FULL, 0), 0.5)
    bad = expect("the tool is left alone", norm(less(m.rest(), at)) < 5e-4 and m.status()["mouse"]["hands"][0] == "may")
    m.key("d")
    m.see("SpaceMouse Pro")
    m.click("hand", "Devices")
    m.until("the choice is taken", lambda: (m.daemon.push((0, FULL, 0, 0, 0, 0), 0.2), m.status()["mouse"]["hands"][0] == "leads")[1])
    m.key("Escape")
    m.end()
    turned = sum(a * b for a, b in zip(before, orientation(m)))
    bad += expect("the view was turned (cosine of half the angle %.3f)" % abs(turned), 0.2 < abs(turned) < 0.98)
    return bad + expect("the choice is kept", 'spacemouse = "hand"' in open(m.session_state).read())


def daemon(m):
    """The real spacenavd, without a device: connected, ended, connected again."""
    run = os.path.join(m.folder, "run")
    os.mkdir(run)
    # Debian's spacenavd makes run/spnav.sock below the folder where it was started.
    words = ["unshare", "-m", "sh", "-c", 'mount --bind "$0" /run && exec spacenavd -d -l "$0/log"', run]
    private = shutil.which("spacenavd") and subprocess.run(["unshare", "-m", "mount", "--bind", run, "/run"], stderr=subprocess.DEVNULL).returncode == 0
    if not private:
        print("skip daemon: spacenavd is missing, or this user may not give it a /run of its own")
        return 0
    m.env["SPNAV_SOCKET"] = os.path.join(run, "spnav.sock")
    bad = 0
    m.begin_touch("spacemouse")
    m.see("SpaceMouse: not found. Install and start spacenavd.")
    for _ in range(2):
        real = subprocess.Popen(words, cwd="/", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            m.see("SpaceMouse: spacenavd runs, but no SpaceMouse is plugged in.")
        finally:
            real.kill()
            real.wait()
        m.see("SpaceMouse: spacenavd")  # ended, or does not answer
        m.until("the end is noticed", lambda: not m.find("no SpaceMouse is plugged in"))
        bad += expect("the end of spacenavd is noticed", True)
    m.end()
    return bad


RUNS = {"hand": hand, "camera": camera, "daemon": daemon}


def system_daemon():
    """Whether a spacenavd of this machine runs, to which libspnav falls back."""
    with socket.socket(socket.AF_UNIX) as s:
        return s.connect_ex("/var/run/spnav.sock") == 0


def main():
    bin_dir, *names = arguments(__doc__, 1)
    names = names or list(RUNS)
    if system_daemon() and names != ["camera"]:
        print("skipped, except camera: a spacenavd of this machine runs")
        names = ["camera"]
    sys.exit(1 if sum(all(run(bin_dir, name) for _ in range(2)) for name in names) else 0)


def run(bin_dir, name):
    """Whether it failed."""
    with tempfile.TemporaryDirectory(prefix="tact-space-mouse-", ignore_cleanup_errors=True) as folder:
        m = SpaceMouse(bin_dir, folder)
        try:
            return RUNS[name](m) != 0
        except SystemExit as why:
            print("FAIL %s: %s" % (name, why), flush=True)
            return True
        finally:
            m.close()


if __name__ == "__main__":
    main()
