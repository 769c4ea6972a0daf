#!/usr/bin/env python3
"""Programs of several test files: called by the name of a file, each runs the tests of that file and no others.

usage: test_files_test.py FOLDER_OF_THE_TESTS ROOT_OF_THE_PROJECT
"""
import glob
import os
import re
import subprocess
import sys
import unittest

TESTS, ROOT = sys.argv[1:3]
del sys.argv[1:]
CASE = re.compile(r"^(?:TEST|TEST_F|TEST_P|TYPED_TEST|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\(\s*(\w+),\s*(\w+)", re.M)


def cases(program, *options):
    """(suite, name) without prefixes and numbers of parameters"""
    run = subprocess.run([program, "--gtest_list_tests", *options], capture_output=True, text=True, check=True)
    suite, found = "", []
    for line in run.stdout.splitlines():
        word = line.split("#")[0].strip()
        if line.startswith("  "):
            found.append((suite, word.split("/")[0]))
        elif word.endswith("."):
            parts = word[:-1].split("/")
            suite = parts[1] if len(parts) > 1 and not parts[1].isdigit() else parts[0]
    return found


def cases_of_source(name):
    path = next(p for folder in ("unit", "scenario") if os.path.exists(p := f"{ROOT}/tests/{folder}/{name}.cpp"))
    with open(path, encoding="utf-8") as f:
        return CASE.findall(f.read())


class TestFiles(unittest.TestCase):
    def test_each_name_runs_its_file_and_together_they_run_all(self):
        links = [p for p in glob.glob(f"{TESTS}/*_test") if os.path.islink(p)]
        self.assertGreater(len(links), 100)
        by_program = {}
        for link in links:
            name, own = os.path.basename(link), cases(link)
            self.assertEqual(set(own), set(cases_of_source(name)), name)
            by_program.setdefault(os.path.realpath(link), []).extend(own)
        for program, of_files in by_program.items():
            self.assertEqual(sorted(of_files), sorted(cases(program)), program)

    def test_a_filter_of_the_command_line_still_selects(self):
        link = f"{TESTS}/base_error_test"
        self.assertEqual(len(cases(link, "--gtest_filter=StartupError.states_problem*")), 1)
        self.assertEqual(cases(link, "--gtest_filter=*:-*"), [])


if __name__ == "__main__":
    unittest.main()
