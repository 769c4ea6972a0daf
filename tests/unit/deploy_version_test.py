#!/usr/bin/env python3
"""--version of every program prints the same build, and the version of the source is derived from git.

usage: deploy_version_test.py ROOT_OF_THE_PROJECT FOLDER_OF_THE_PROGRAMS VERSION_OF_THE_PROJECT
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT, BIN, PROJECT = sys.argv[1:4]
del sys.argv[1:]
PROGRAMS = ["tact", "tact-bench", "tact-certify", "tact-prep", "tact-rt", "tact-gui", "tact-record", "tact-refine", "tact-replay", "tact-reproduce",
            "tact-search", "tact-emu"]
SCRIPT = os.path.join(ROOT, "ipc/version/version.cmake")


def version_of(source, build_version=""):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "v.hpp")
        made = subprocess.run(["cmake", f"-DSOURCE={source}", "-DPROJECT_VERSION=0.1.0", f"-DBUILD_VERSION={build_version}",
                               f"-DOUTPUT={out}", "-P", SCRIPT], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            return made.stderr
        with open(out, encoding="utf-8") as f:
            return re.search(r'"(.*)"', f.read())[1]


class Version(unittest.TestCase):
    def test_every_program_prints_its_name_and_one_version(self):
        programs = [p for p in PROGRAMS if os.path.exists(os.path.join(BIN, p))]
        self.assertGreaterEqual(len(programs), 5, "too few programs are built")
        seen = {}
        for program in programs:
            run = subprocess.run([os.path.join(BIN, program), "--version"], capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, program)
            self.assertEqual(run.stderr, "", program)
            name, version = run.stdout.rstrip("\n").split(" ")
            self.assertEqual(name, program)
            seen[program] = version
        self.assertEqual(len(set(seen.values())), 1, seen)
        version = next(iter(seen.values()))
        self.assertRegex(version, re.escape(PROJECT) + r"($|[-+~])")
        if os.path.exists(os.path.join(ROOT, ".git")):
            self.assertEqual(version.split(".dirty")[0], version_of(ROOT).split(".dirty")[0])

    def test_wrong_usage_exits_with_2_in_all_programs(self):
        for program in PROGRAMS:
            path = os.path.join(BIN, program)
            if os.path.exists(path):
                run = subprocess.run([path, "--no-such-option"], capture_output=True, text=True, check=False)
                self.assertEqual((run.returncode, run.stdout), (2, ""), program)
                self.assertNotEqual(run.stderr, "", program)

    def test_the_version_has_the_commit_count_the_last_commit_and_a_mark_for_changes(self):
        with tempfile.TemporaryDirectory() as folder:
            def git(*words):
                return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", "-C", folder, *words],
                                      check=True, capture_output=True, text=True).stdout.strip()
            self.assertEqual(version_of(folder), "0.1.0")  # no history
            git("init", "--quiet")
            file = os.path.join(folder, "a")
            for content in "12":
                with open(file, "w", encoding="utf-8") as f:
                    f.write(content)
                git("add", "a")
                git("commit", "--quiet", "-m", content)
            git("tag", "v9")  # hides nothing
            commit = git("rev-parse", "--short=7", "HEAD")
            self.assertEqual(version_of(folder), f"0.1.0+2.g{commit}")
            with open(file, "w", encoding="utf-8") as f:
                f.write("3")
            self.assertEqual(version_of(folder), f"0.1.0+2.g{commit}.dirty")
            self.assertEqual(version_of(folder, "0.1.0+deb12"), "0.1.0+deb12")
            self.assertIn("only letters", version_of(folder, '1"; evil'))


unittest.main(verbosity=0)
