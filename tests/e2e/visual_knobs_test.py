#!/usr/bin/python3
"""Each visual path draws what its level asks for: in a docking scene that moves, and in a drilling scene whose view is turned, with all
levels set by hand to different values, the window's own count of what it drew is compared with level and full detail. Then with
other levels.

usage: visual_knobs_test.py BIN_DIR

Exit code 77: Xvfb or xdotool is missing.
"""
import subprocess
import sys
import tempfile

from operator_of_window import Operator, arguments, bake_demo, expect

# Of each path: its level in two runs, and the shares of it that may be drawn. Structures and rays through bone have a few steps of
# detail, and bone does not fill the view. Of particles there are at most as many as the level permits, and soon more than the other
# level permits.
SCENES = {
    ("dock", "wander", "1280x720"): {"gui.mesh": (0.5, 0.9, 0.99, 1.01), "gui.molecules": (0.9, 0.4, 0.6, 1.01),
                                     "gui.resolution": (0.36, 0.64, 0.97, 1.03)},
    # So few rays are never too many for a slow machine.
    ("drill", "surgeon", "400x300"): {"gui.volume": (0.03, 0.06, 0.4, 1.01), "gui.particles": (0.12, 0.1, 0.9, 1.01)},
}
PATIENCE_S = 30.0


class Turned:
    """The view is dragged to and fro."""

    def __init__(self, operator):
        x, y = (int(n) // 2 for n in operator.size.split("x"))
        words = ["mousemove", str(x), str(y), "mousedown", "1"]
        for i in range(int(PATIENCE_S / 0.03)):
            words += ["mousemove", str(x + 3 * abs(i % 20 - 10)), str(y), "sleep", "0.03"]
        self.drag = subprocess.Popen(["xdotool", *words, "mouseup", "1"], env=operator.env)

    def end(self):
        self.drag.terminate()
        self.drag.wait()


def shares(operator):
    status = operator.status()
    paths = status["governor"]["paths"] if status is not None else {}
    return {name: path["drawn"] / path["items_max"] for name, path in paths.items() if path["drawn"] and path["items_max"]}


def as_asked(paths, turn, drawn):
    return all(path in drawn and row[2] * row[turn] <= drawn[path] <= row[3] * row[turn] for path, row in paths.items())


def main():
    bin_dir, = arguments(__doc__, 1)
    failed = 0
    for (kind, hand, size), paths in SCENES.items():
        with tempfile.TemporaryDirectory() as folder:
            operator = Operator(bin_dir, folder, size)
            try:
                bake_demo(bin_dir, kind, operator.scene(kind + ".tact"))
                for turn in range(2):
                    levels = [word for path, row in paths.items() for word in ("--level", "%s=%g" % (path, row[turn]))]
                    operator.start(*levels, hand=hand, scene=kind + ".tact")
                    turned = Turned(operator)
                    seen = operator.holds_within(lambda: (now := shares(operator)) and as_asked(paths, turn, now) and now, PATIENCE_S)
                    now = seen or shares(operator)
                    turned.end()
                    failed += expect("%s, levels %s: drawn of full detail %s" % (
                        kind, ", ".join("%s %g" % (p, row[turn]) for p, row in paths.items()),
                        ", ".join("%s %.3f" % (p, share) for p, share in now.items())), seen)
                    operator.end()
            finally:
                operator.close()
    return failed


if __name__ == "__main__":
    sys.exit(main())
