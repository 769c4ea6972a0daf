#!/usr/bin/env python3
"""The servo core knows no system: no word of one stands in rt/servo, neither in code nor in comments.

usage: servo_words.py [--self-test]
Prints file:line: word, and exits 1 if there was any.
"""
import os
import re
import tempfile

import tree_check

FOLDER = "rt/servo"
# Parts of words too: kBoneKnob, gui_particles_max.
WORDS = ["bone", "burr", "drill", "suction", "irrigat", "pedal", "mesh", "triangle", "surface", "particle", "docking", "clash", "density",
         "voxel"]
FOUND = re.compile("|".join(WORDS), re.IGNORECASE)


def check(root):
    found = []
    for name in sorted(os.listdir(os.path.join(root, FOLDER))):
        with open(os.path.join(root, FOLDER, name), encoding="utf-8") as f:
            for number, line in enumerate(f, 1):
                found += [f"{FOLDER}/{name}:{number}: {m.group(0)}" for m in FOUND.finditer(line)]
    return found


def self_test():
    bad = 0
    for text, count in [("void step_models();\n", 0), ("// turns the burr\n", 1), ("int kMeshIndex;\nint gui_particles_max;\n", 2)]:
        with tempfile.TemporaryDirectory() as root:
            os.makedirs(os.path.join(root, FOLDER))
            with open(os.path.join(root, FOLDER, "a.hpp"), "w", encoding="utf-8") as f:
                f.write(text)
            right = len(check(root)) == count
        bad += not right
        print(f"{'ok  ' if right else 'FAIL'} {text!r}")
    return bad


if __name__ == "__main__":
    tree_check.run(check, self_test, "rt/servo names no system")
