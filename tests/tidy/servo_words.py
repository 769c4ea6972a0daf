#!/usr/bin/env python3
"""The servo core depends on no system: no system-specific word is in rt/servo, neither in code nor in comments.

usage: servo_words.py [--self-test]
Prints file:line, the word and a fix for each, and exits 1 if there is any.
"""
import os
import re
import tempfile

import tree_check

FOLDER = "rt/servo"
# Also parts of words: kBoneKnob, gui_particles_max.
WORDS = ["bone", "burr", "drill", "suction", "irrigat", "pedal", "mesh", "triangle", "surface", "particle", "docking", "clash", "density",
         "voxel"]
FOUND = re.compile("|".join(WORDS), re.IGNORECASE)
FIX = "fix: use a system-neutral word, or move this to the model in rt/force or to its row in rt/start/systems.cpp"


def check(root):
    found = []
    for name in sorted(os.listdir(os.path.join(root, FOLDER))):
        with open(os.path.join(root, FOLDER, name), encoding="utf-8") as f:
            for number, line in enumerate(f, 1):
                for word in re.findall(r"\w+", line):
                    if (m := FOUND.search(word)) is not None:
                        found.append(f'{FOLDER}/{name}:{number}: "{word}" contains the system-specific word "{m.group(0).lower()}"; {FIX}')
    return found


def self_test():
    bad = 0
    for text, wanted in [("void step_models();\n", []), ("// turns the burr\n", ['a.hpp:1: "burr"']),
                         ("int kMeshIndex;\nint gui_particles_max;\n", ['a.hpp:1: "kMeshIndex"', 'a.hpp:2: "gui_particles_max"'])]:
        with tempfile.TemporaryDirectory() as root:
            os.makedirs(os.path.join(root, FOLDER))
            with open(os.path.join(root, FOLDER, "a.hpp"), "w", encoding="utf-8") as f:
                f.write(text)
            found = check(root)
            right = len(found) == len(wanted) and all(f"{FOLDER}/{w}" in line and "fix:" in line for w, line in zip(wanted, found))
        bad += not right
        print(f"{'ok  ' if right else 'FAIL'} {text!r}: {found}")
    return bad


if __name__ == "__main__":
    tree_check.run(check, self_test, "rt/servo names no system")
