#!/usr/bin/python3
"""A person starts tact without arguments, and works from its start page: a demo, a scene used before, a file, an error, and the end.

usage: start_page_test.py BIN_DIR [FOLDER]

FOLDER keeps a picture of the page at three sizes. Exit code 77: Xvfb or xdotool is missing.
"""
import os
import signal
import subprocess
import sys
import tempfile

from operator_of_window import Operator, arguments, expect


def new_person(operator):
    """Nothing baked, nothing used before."""
    operator.env["XDG_CACHE_HOME"] = os.path.join(operator.folder, "cache")
    operator.env["HOME"] = operator.folder


def page(operator):
    operator.launch()
    operator.see("Scenes used before")
    operator.until("the computer was examined", lambda: operator.find("examining ...") is None)


def running(operator, title):
    operator.wait("the run arms", lambda s: s["state"] in ("armed", "active"))
    operator.see(title)
    return operator.find("Scenes used before") is None


def a_demo(operator):
    page(operator)
    bad = expect("nothing was used before", operator.find("None yet.") is not None)
    bad += expect("the page says that there is no device, and what tact doctor found",
                  operator.find("device.driver") is not None and operator.find("tact doctor") is not None)
    faults = operator.layout_faults()
    bad += expect("no text of the page is cut or covered %s" % (faults or ""), not faults)
    operator.click("Surface")
    bad += expect("a click on the demo's card bakes and runs it", running(operator, "rough terrain"))
    operator.end_page(0)
    return bad


def a_scene_used_before(operator):
    page(operator)
    operator.see("surface")
    operator.click("rough terrain")
    bad = expect("a scene used before runs after one click", running(operator, "rough terrain"))
    operator.end_page(0)
    return bad


def a_file_and_an_error(operator):
    broken = os.path.join(operator.folder, "out", "broken.tact")
    os.makedirs(os.path.dirname(broken), exist_ok=True)
    with open(broken, "wb") as f:
        f.write(b"TACTSCN1" + bytes(500))
    page(operator)
    operator.click("Open file ...")
    bad = expect("Open file shows a folder", bool(operator.see("Folder", "Scenes")))
    operator.key("Escape")
    operator.see_no_more("Folder", "Scenes")
    with open(os.path.join(operator.folder, "state", "tact", "recent.json"), "w") as f:
        f.write('{"scenes": [{"path": "%s", "used_unix_s": 1793000000}]}' % operator.damaged)
    operator.end_page(0)
    page(operator)
    operator.click("rough terrain")
    bad += expect("a scene that cannot run leads back to the page, which says why",
                  bool(operator.see("The run ended with an error")) and bool(operator.see("checksum")))
    operator.end_page(0)
    return bad


class Person(Operator):
    def end_page(self, code):
        """Ends the window, which ends as if it was closed, and with it everything else."""
        os.kill(self.descendant(self.run.pid, "tact-gui"), signal.SIGTERM)
        ended = self.run.wait(60)
        self.run = None
        if ended != code:
            self.fail("tact ended with exit code %d" % ended)

    def descendant(self, pid, name):
        with open("/proc/%d/task/%d/children" % (pid, pid)) as f:
            for child in map(int, f.read().split()):
                with open("/proc/%d/comm" % child) as comm:
                    if comm.read().strip() == name:
                        return child
                found = self.descendant(child, name)
                if found is not None:
                    return found
        return None


def pictures(operator, folder):
    for size in ("1280x720", "1920x1080", "3840x2160"):
        subprocess.run([operator.program("tact-gui"), "--start-page", "--scene-switch", operator.folder, "--seconds", "4", "--size", size,
                        "--screenshot", os.path.join(folder, "start_page_%s.png" % size)], env=operator.env, check=True)


def main():
    words = arguments(__doc__, 1)
    with tempfile.TemporaryDirectory() as folder:
        operator = Person(words[0], folder)
        new_person(operator)
        try:
            bad = a_demo(operator) + a_scene_used_before(operator)
            operator.damaged = damaged_copy(operator)
            bad += a_file_and_an_error(operator)
            if len(words) > 1:
                pictures(operator, words[1])
        finally:
            operator.close()
    sys.exit(1 if bad else 0)


def damaged_copy(operator):
    """A scene whose description is readable and whose content is not."""
    cache = os.path.join(operator.folder, "cache", "tact")
    (scene,) = [os.path.join(cache, name) for name in os.listdir(cache) if name.endswith(".tact")]
    damaged = os.path.join(operator.folder, "damaged.tact")
    with open(scene, "rb") as f, open(damaged, "wb") as to:
        content = bytearray(f.read())
        content[len(content) // 2] ^= 255
        to.write(content)
    return damaged


if __name__ == "__main__":
    main()
