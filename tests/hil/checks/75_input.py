#!/usr/bin/env python3
"""A SpaceMouse and a gamepad, made by uinput: the real spacenavd and GLFW see them, and the window's readers see their motion.

usage: 75_input.py BIN_DIR. Both are plugged in, moved, pressed and unplugged; spacenavd is killed and started again.
"""
import fcntl
import os
import shutil
import struct
import subprocess
import sys
import threading
import time

STORY = os.path.join(sys.argv[1], "..", "tests", "hil_input_story")
EV_SYN, EV_KEY, EV_REL, EV_ABS = 0, 1, 2, 3
SET = {EV_KEY: 0x40045565, EV_REL: 0x40045566, EV_ABS: 0x40045567}
PATIENCE_S = 60


class Uinput:
    """An input device: codes of keys, relative axes, and absolute axes with their range."""

    def __init__(self, name, vendor, product, keys, rel=(), absolute=()):
        self.fd = os.open("/dev/uinput", os.O_WRONLY | os.O_NONBLOCK)
        for kind, codes in ((EV_KEY, keys), (EV_REL, rel), (EV_ABS, [code for code, _, _ in absolute])):
            if codes:
                fcntl.ioctl(self.fd, 0x40045564, kind)
            for code in codes:
                fcntl.ioctl(self.fd, SET[kind], code)
        for code, low, high in absolute:
            fcntl.ioctl(self.fd, 0x401C5504, struct.pack("=HHiiiiii", code, 0, low if low == 0 else 0, low, high, 0, 0, 0))
        fcntl.ioctl(self.fd, 0x405C5503, struct.pack("=HHHH80sI", 3, vendor, product, 0x110, name.encode(), 0))
        fcntl.ioctl(self.fd, 0x5501)

    def send(self, *events):
        for kind, code, value in (*events, (EV_SYN, 0, 0)):
            os.write(self.fd, struct.pack("=qqHHi", 0, 0, kind, code, value))

    def unplug(self):
        fcntl.ioctl(self.fd, 0x5502)
        os.close(self.fd)


class Story:
    """The reader of the window, and the newest line that it printed."""

    def __init__(self, what, **env):
        self.lines = []
        self.run = subprocess.Popen([STORY, what, "600"], env=dict(os.environ, **env), stdout=subprocess.PIPE, text=True)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.run.stdout:
            present, axes, buttons, text = line.rstrip("\n").split("|", 3)
            self.lines.append((present == "1", [float(a) for a in axes.split()], int(buttons), text))

    def see(self, what, true, again=lambda: None):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            again()
            if self.lines and true(*self.lines[-1]):
                print("ok  %s: %s" % (what, self.lines[-1][3]), flush=True)
                return
            time.sleep(0.05)
        sys.exit("FAILED %s; the last lines: %s" % (what, self.lines[-5:]))

    def end(self):
        self.run.kill()
        self.run.wait()


def daemon():
    return subprocess.Popen(["spacenavd", "-d", "-v", "-v", "-l", "/out/spnavd.log"], cwd="/", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def space_mouse():
    cap = lambda: Uinput("3Dconnexion SpaceNavigator", 0x046D, 0xC626, (0x100, 0x101), rel=range(6))
    story = Story("spacemouse")
    story.see("without spacenavd", lambda p, a, b, t: not p and "Install and start spacenavd" in t)
    service = daemon()
    story.see("without a device", lambda p, a, b, t: not p and "no SpaceMouse is plugged in" in t)
    for _ in range(2):
        mouse = cap()
        story.see("plugged in", lambda p, a, b, t: p and t == "SpaceNavigator")
        story.see("pushed to the right", lambda p, a, b, t: a[0] > 0.3 and not any(a[1:]), lambda: mouse.send((EV_REL, 0, 350)))
        story.see("its second button", lambda p, a, b, t: b == 2, lambda: mouse.send((EV_KEY, 0x101, 1)))
        mouse.unplug()  # while it is pushed and pressed
        story.see("unplugged", lambda p, a, b, t: not p and not any(a) and b == 0 and "no SpaceMouse" in t)
    mouse = cap()
    story.see("plugged in again", lambda p, a, b, t: p)
    service.kill()
    service.wait()
    story.see("spacenavd is killed", lambda p, a, b, t: not p and not any(a) and "spacenavd" in t)
    service = daemon()
    story.see("spacenavd is back, and its device", lambda p, a, b, t: p and t == "SpaceNavigator")
    story.see("twisted", lambda p, a, b, t: any(a[3:]) and not any(a[:3]), lambda: mouse.send((EV_REL, 3, 350)))
    story.end()
    service.kill()
    service.wait()
    mouse.unplug()


def gamepad():
    sticks = [(code, -32768, 32767) for code in (0, 1, 3, 4)]
    pad = lambda: Uinput("Microsoft X-Box 360 pad", 0x045E, 0x028E,
                         (0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x13A, 0x13B, 0x13C, 0x13D, 0x13E),
                         absolute=(*sticks, (2, 0, 255), (5, 0, 255), (16, -1, 1), (17, -1, 1)))
    screen = subprocess.Popen(["Xvfb", ":75", "-screen", "0", "320x240x24", "-nolisten", "tcp"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + PATIENCE_S
    while not os.path.exists("/tmp/.X11-unix/X75"):
        assert time.monotonic() < end, "Xvfb does not start"
        time.sleep(0.1)
    story = Story("gamepad", DISPLAY=":75")
    story.see("without a gamepad", lambda p, a, b, t: not p and "Plug one in" in t)
    for _ in range(2):
        stick = pad()
        story.see("plugged in", lambda p, a, b, t: p and not any(a))
        stick.send((EV_ABS, 0, 32767), (EV_ABS, 1, -32768))
        story.see("left stick to the right and up", lambda p, a, b, t: a[0] > 0.9 and a[1] > 0.9 and a[2] == 0)
        stick.send((EV_ABS, 0, 0), (EV_ABS, 1, 0), (EV_ABS, 5, 255), (EV_KEY, 0x131, 1))
        story.see("right trigger and B", lambda p, a, b, t: a[2] < -0.9 and a[0] == 0 and b == 2)
        stick.unplug()
        story.see("unplugged", lambda p, a, b, t: not p and not any(a) and b == 0)
    story.end()
    screen.kill()
    screen.wait()


if not os.path.exists("/dev/uinput") or not shutil.which("spacenavd") or not os.path.exists(STORY):
    print("skipped: no /dev/uinput, spacenavd or hil_input_story")
    sys.exit(77)
space_mouse()
gamepad()
print("SpaceMouse through spacenavd, and gamepad through GLFW: plugged in, moved, pressed, unplugged, daemon killed")
