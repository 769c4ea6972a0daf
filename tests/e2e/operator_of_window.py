"""Operates the window of a run by the labels that it shows. Used by operate_test.py and labels_test.py."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time

PATIENCE_S = 60.0


class Operator:
    """A private X screen with at most one run on it."""

    def __init__(self, bin_dir, folder, size="1280x720"):
        self.bin, self.folder, self.size = bin_dir, folder, size
        wide, high = map(int, size.split("x"))
        read, write = os.pipe()
        self.x = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "%dx%dx24" % (wide + 20, high + 40), "-fbdir", folder],
                                  pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as f:
            display = ":" + f.readline().strip()
        self.env = dict(os.environ, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1", TACT_RUNTIME_DIR=folder, TACT_OUTPUT=os.path.join(folder, "out"),
                        XDG_STATE_HOME=os.path.join(folder, "state"), XDG_CONFIG_HOME=os.path.join(folder, "config"),
                        ASAN_OPTIONS="detect_leaks=0")
        self.run = None
        self.clicked = None  # label and window of the last click, unless a key came after it
        self.texts_file = os.path.join(folder, "texts.json")

    def program(self, name):
        return os.path.join(self.bin, name)

    def scene(self, name="scene.tact"):
        return os.path.join(self.folder, name)

    def start(self, *options, hand="passive", scene="scene.tact"):
        self.report = os.path.join(self.folder, "run.json")
        if os.path.exists(self.report):
            os.remove(self.report)
        self.launch("run", self.scene(scene), "--hand", hand, "--quiet", "--json", self.report, *options)
        self.wait("the window draws", lambda s: s["gui"]["attached"] and s["gui"]["frames"] and s["gui"]["frames"]["count"] > 20)
        self.xdotool("mousemove", "800", "300")

    def launch(self, *arguments):
        self.log = open(os.path.join(self.folder, "run.log"), "wb")
        if os.path.exists(self.texts_file):
            os.remove(self.texts_file)
        self.run = subprocess.Popen([self.program("tact"), *arguments, "--size", self.size, "--session", "keys", "--texts", self.texts_file],
                                    env=self.env, stdout=self.log, stderr=self.log)

    def status(self):
        said = subprocess.run([self.program("tact"), "status", "--session", "keys", "--json"], env=self.env, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL)
        return json.loads(said.stdout) if said.returncode == 0 else None

    def fail(self, what):
        sys.exit("FAILED %s; the window shows:\n%s\nthe log:\n%s" %
                 (what, "\n".join(t["text"] for t in self.texts()), self.said()[-3000:]))

    @staticmethod
    def holds_within(found, patience_s):
        """The first result of found() that is not None or False; None: there was none."""
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            result = found()
            if result:
                return result
            time.sleep(0.1)
        return None

    def until(self, what, found):
        return self.holds_within(found, PATIENCE_S) or self.fail("%s: timed out after %.0f s" % (what, PATIENCE_S))

    def wait(self, what, true):
        def now():
            status = self.status()
            return status if status is not None and true(status) else None
        return self.until(what, now)

    def said(self):
        with open(self.log.name, errors="replace") as f:
            return f.read()

    def xdotool(self, *words):
        subprocess.run(["xdotool", *words], env=self.env, check=True)

    def key(self, key):
        self.clicked = None
        self.xdotool("key", key)

    def layout(self):
        try:
            with open(self.texts_file) as f:
                return json.load(f)
        except (OSError, ValueError):
            return {"texts": [], "overlaps": []}

    def texts(self):
        return self.layout()["texts"]

    def layout_faults(self):
        """Texts that are cut or lie on another, and stay so: a window that grows is cut for one frame."""
        def now():
            layout = self.layout()
            texts = layout["texts"]
            return {"'%s' is cut in %s" % (t["text"], t["owner"]) for t in texts if t["cut"]} | \
                {"'%s' and '%s' lie on each other" % (texts[a]["text"], texts[b]["text"]) for a, b in layout["overlaps"]}
        faults = now()
        for _ in range(3):
            if faults:
                time.sleep(0.2)
                faults &= now()
        return faults

    def find(self, label, within=None):
        """The middle of a text, or of a part of it; None: it is not shown. within: begin of the name of its window."""
        for exact in (True, False):
            for t in self.texts():
                if within is not None and not t["owner"].startswith(within):
                    continue
                at = 0 if exact and t["text"] == label else -1 if exact else t["text"].find(label)
                if at >= 0:
                    share = (at + 0.5 * len(label)) / max(len(t["text"]), 1)
                    return t["x"] + share * t["w"], t["y"] + 0.5 * t["h"]
        return None

    def reveal(self, label, within=None):
        """Turns the wheel over a card whose list goes on below."""
        rows = sorted((t["y"], t["x"]) for t in self.texts() if within is not None and t["owner"].startswith(within))
        if rows and self.find(label, within) is None:
            y, x = rows[len(rows) // 2]  # in its list, not on its title
            self.xdotool("mousemove", str(round(x + 2)), str(round(y + 4)))
            for button in ["5"] * 6 + ["4"] * 12:
                if self.find(label, within) is not None:
                    break
                self.xdotool("click", button)
                time.sleep(0.3)
        return self.find(label, within)

    def see(self, label, within=None):
        """Waits until it is shown. The click before is made again after a while, as a person would: a busy window may miss one."""
        self.reveal(label, within)
        for _ in range(4):
            found = self.holds_within(lambda: self.find(label, within), PATIENCE_S / 4)
            if found:
                return found
            if self.clicked is not None and (place := self.find(*self.clicked)) is not None:
                self.click_at(place)
        return self.fail("'%s' is not shown after %.0f s" % (label, PATIENCE_S))

    def see_no_more(self, label, within=None):
        self.until("'%s' is no longer shown" % label, lambda: self.find(label, within) is None)

    def point(self, label, within=None):
        self.move_to(self.see(label, within))

    def move_to(self, place):
        self.xdotool("mousemove", str(round(place[0])), str(round(place[1])))

    def click(self, label, within=None):
        place = self.see(label, within)
        self.clicked = label, within
        self.click_at(place)

    def click_at(self, place):
        self.move_to(place)
        time.sleep(0.15)  # a window in software rendering sees where the mouse is, then the click
        self.xdotool("mousedown", "1")
        time.sleep(0.15)
        self.xdotool("mouseup", "1")
        time.sleep(0.15)

    def press(self, name, what, true):
        """Clicks a button of the controller's card until the condition holds: in a slow window a click may be lost."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            self.click(name, "Controller")
            again = time.monotonic() + 3.0
            while time.monotonic() < again:
                if (now := self.status()) is not None and true(now):
                    return now
                time.sleep(0.1)
        self.fail("%s: timed out after %.0f s" % (what, PATIENCE_S))

    def controller(self):
        """The process id of the controller."""
        with open("/proc/%d/task/%d/children" % (self.run.pid, self.run.pid)) as f:
            for pid in map(int, f.read().split()):
                with open("/proc/%d/comm" % pid) as name:
                    if name.read().strip() == "tact-rt":
                        return pid
        sys.exit("FAILED: the run has no controller")

    def place(self, *keys):
        """Presses keys that place a body, each after the controller has executed the last one."""
        for done, key in enumerate(keys, 1):
            self.key(key)
            self.until("%s places the body" % key, lambda: self.said().count("command place a body: done") >= done)

    def end(self):
        self.run.send_signal(signal.SIGINT)
        self.run.wait(60)
        self.run = None
        if not os.path.exists(self.report):
            return None
        with open(self.report) as f:
            return json.load(f)

    def close(self):  # ends what still runs
        if self.run is not None:
            self.run.terminate()
            try:
                self.run.wait(20)
            except subprocess.TimeoutExpired:
                self.run.kill()
        self.x.kill()
        self.x.wait()


def arguments(doc, least):
    """Of the command line; ends the test where it cannot run."""
    if len(sys.argv) <= least:
        sys.exit(doc)
    missing = [p for p in ("Xvfb", "xdotool") if shutil.which(p) is None]
    if missing:
        print("skipped: %s is not installed" % ", ".join(missing))
        sys.exit(77)
    return sys.argv[1:]


def bake_demo(bin_dir, kind, path):
    subprocess.run([os.path.join(bin_dir, "tact-prep"), "demo", kind, "-o", path], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def expect(what, true):
    print("%s %s" % ("ok  " if true else "FAIL", what), flush=True)
    return 0 if true else 1
