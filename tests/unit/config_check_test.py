#!/usr/bin/env python3
"""tact config check and tact probe --config on the command line: exit codes, all problems of a file, JSON; the controller refuses the same files.

usage: config_check_test.py BIN_DIR   (from the root of the project)
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

BIN = os.path.abspath(sys.argv.pop(1))
BAD = '[servo]\nperiod_uss = 3\n[device]\ndriver = "magic"\n[lines]\ndriver = 3\n[safety]\nforce_n_max = 1000\n'


def run(name, *words, cwd=None):
    return subprocess.run([os.path.join(BIN, name), *words], cwd=cwd, capture_output=True, text=True, check=False, timeout=60)


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, text, name="tact.toml"):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return path


class Check(Folder):
    def test_a_valid_file_exits_with_0_and_a_bad_one_with_1_and_every_problem(self):
        done = run("tact", "config", "check", "deploy/tact.toml")
        self.assertEqual((done.returncode, done.stdout), (0, "deploy/tact.toml: no problems\n"), done.stderr)
        done = run("tact", "config", "check", self.file(BAD))
        self.assertEqual(done.returncode, 1)
        for part in (":2: servo.period_uss: there is no such key", "did you mean servo.period_us?", ":4: device.driver: \"magic\"", "phantom-usb",
                     ":6: lines.driver: this is not text", ":8: safety.force_n_max: 1000 is outside 0 to 100", "4 problems"):
            self.assertIn(part, done.stdout)

    def test_a_missing_core_is_a_problem(self):
        done = run("tact", "config", "check", self.file("[servo]\ncore = 4000\n"))
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("servo.core: this machine has no core 4000", done.stdout)

    def test_json_has_the_problems_and_the_values(self):
        done = run("tact", "config", "check", self.file(BAD), "--json")
        answer = json.loads(done.stdout)
        self.assertEqual((done.returncode, answer["ok"], len(answer["problems"])), (1, False, 4))
        self.assertEqual(answer["problems"][1]["key"], "device.driver")
        answer = json.loads(run("tact", "config", "check", "deploy/tact.toml", "--json").stdout)
        self.assertTrue(answer["ok"])
        self.assertEqual(answer["values"]["servo.core"], -1)

    def test_wrong_usage_exits_with_2_and_a_missing_or_odd_file_with_1(self):
        for words in (("config",), ("config", "check"), ("config", "check", "a", "b"), ("config", "chek", "a")):
            self.assertEqual(run("tact", *words).returncode, 2, words)
        self.assertEqual(run("tact", "config", "check", os.path.join(self.folder, "none.toml")).returncode, 1)
        self.assertEqual(run("tact", "config", "check", self.folder).returncode, 1)
        self.file("[servo]\n", "-x.toml")  # a name like an option
        self.assertEqual(run("tact", "config", "check", "--", "-x.toml", cwd=self.folder).returncode, 0)

    def test_the_controller_refuses_the_first_of_these_problems(self):
        done = run("tact-rt", "none.tact", "--config", self.file(BAD))
        self.assertEqual(done.returncode, 1)
        self.assertIn("servo.period_uss: there is no such key", done.stderr)
        self.assertEqual(run("tact-rt").returncode, 2)  # no scene
        self.assertEqual(run("tact-rt", "a.tact", "--check-config", "b").returncode, 2)


class Probe(Folder):
    def test_probe_fails_on_a_file_that_the_controller_refuses(self):
        root = os.path.join(self.folder, "root")
        os.makedirs(root)

        def probe(text):
            done = run("tact", "probe", "--config", self.file(text), "--root", root, "--json")
            rows = {}
            for row in json.loads(done.stdout)["findings"]:
                rows.setdefault(row["name"], []).append((row["level"], row["says"]))
            return done.returncode, rows

        code, rows = probe("[servo]\nperiod_us = 500\n")
        self.assertEqual(code, 0, rows)
        self.assertNotIn("configuration", rows)
        self.assertNotIn("device2", rows)
        code, rows = probe("[servo]\nperiod_uss = 500\n[safety]\nforce_n_max = -1\n")
        self.assertEqual((code, len(rows["configuration"])), (1, 2))
        self.assertIn("servo.period_uss: there is no such key", rows["configuration"][0][1])
        code, rows = probe('[device2]\ndriver = "phantom-usb"\nserial = "R"\n')
        self.assertEqual((code, rows["device2"][0][0]), (1, "fail"))
        done = run("tact", "probe", "--config", os.path.join(self.folder, "none.toml"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("none.toml", done.stderr)


unittest.main()
