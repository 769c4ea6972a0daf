#!/usr/bin/env python3
"""tact-rt as a process: system calls of its servo thread, ends of a run, refusals.

usage: process_test.py BIN_DIR WRITE_SMALL_SCENE. Exit code 77 (skipped): no test can run here.
"""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BIN, WRITER = None, None
# System calls of the servo thread between its first planned cycle and its last: only sleep. Before and after: its own
# preparation, and one getrusage each.
ALLOWED = {"clock_nanosleep"}
PATIENCE_S = 120  # a busy machine is slow, not wrong


class Process(unittest.TestCase):
    def setUp(self):
        self.dir = tempfile.mkdtemp(prefix="tact_rt_")
        self.scene = os.path.join(self.dir, "small.tact")
        subprocess.run([WRITER, self.scene], check=True)
        self.env = dict(os.environ, TACT_RUNTIME_DIR=self.dir)
        self.children = []

    def tearDown(self):
        for child in self.children:
            if child.poll() is None:
                child.kill()
            child.communicate()
        shutil.rmtree(self.dir)

    def start(self, *options, before=()):
        child = subprocess.Popen([*before, os.path.join(BIN, "tact-rt"), self.scene, *options], env=self.env,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.children.append(child)
        return child

    def lines_until(self, child, *words):
        seen = ""
        for line in child.stdout:
            seen += line
            if any(word in line for word in words):
                return seen
        self.fail(f"no output line contains any of {words}:\n{seen}")

    def test_signals_end_the_run_in_order(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            child = self.start("--arm")
            self.lines_until(child, "armed to active")
            child.send_signal(number)
            out, _ = child.communicate(timeout=PATIENCE_S)
            self.assertEqual(child.returncode, 0, out)
            self.assertIn("active to ready", out)
            self.assertIn("ready to off", out)
            self.assertIn("updates a second", out)

    def state(self):
        said = subprocess.run([os.path.join(BIN, "tact"), "status", "--json"], env=self.env, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True)
        return json.loads(said.stdout)["state"] if said.returncode == 0 else None

    def test_an_unread_log_blocks_nothing_and_reports_lost_lines_later(self):
        read, write = os.pipe()
        filler = os.open(f"/proc/self/fd/{write}", os.O_WRONLY | os.O_NONBLOCK)
        try:
            while True:
                os.write(filler, b"." * 4096)
        except BlockingIOError:
            pass
        os.close(filler)
        child = subprocess.Popen([os.path.join(BIN, "tact-rt"), self.scene, "--arm"], env=self.env, stderr=write)
        self.children.append(child)
        os.close(write)
        end = time.monotonic() + PATIENCE_S
        while (state := self.state()) != "active":
            self.assertLess(time.monotonic(), end, f"the controller is {state}")
            time.sleep(0.05)
        with os.fdopen(read, errors="replace") as log:
            for line in log:
                if "log lines were dropped" in line:
                    break
            else:
                self.fail("the log ended without the number of lost lines")
            child.send_signal(signal.SIGTERM)
            self.assertIn("updates a second", log.read())
        self.assertEqual(child.wait(PATIENCE_S), 0)

    def test_a_signal_during_startup_ends_it_at_once_or_in_order(self):
        for step in range(12):
            child = self.start("--arm")
            time.sleep(0.005 * step)
            child.send_signal(signal.SIGTERM)
            out, _ = child.communicate(timeout=PATIENCE_S)
            self.assertIn(child.returncode, (0, -signal.SIGTERM), out)

    def test_a_second_controller_is_refused_and_the_first_continues(self):
        first = self.start("--arm")
        self.lines_until(first, "armed to active")
        second = self.start("--arm")
        out, _ = second.communicate(timeout=PATIENCE_S)
        self.assertEqual(second.returncode, 1, out)
        self.assertIn(str(first.pid), out)
        self.assertIn("fix:", out)
        other = self.start("--session", "other", "--seconds", "0.2")
        other.communicate(timeout=PATIENCE_S)
        self.assertEqual(other.returncode, 0)
        self.assertIsNone(first.poll())

    def test_after_sigkill_the_device_goes_to_zero_force_and_a_new_controller_stays_disarmed(self):
        config, log = os.path.join(self.dir, "process.toml"), os.path.join(self.dir, "device.log")
        with open(config, "w", encoding="utf-8") as f:
            f.write(f'[device]\ndriver = "sim-process"\nwatchdog_us = 10000\nprocess_log = "{log}"\n'
                    '[safety]\nsample_age_us_max = 50000\n')

        def states():
            with open(log, encoding="utf-8") as f:
                return [line.split() for line in f.read().splitlines()]

        def wait_for(condition, limit_s=PATIENCE_S):
            end = time.monotonic() + limit_s
            while time.monotonic() < end and not condition():
                time.sleep(0.01)
            return condition()

        tripped = 0
        for _ in range(30):
            child = self.start("--arm", "--config", config)
            said = self.lines_until(child, "armed to active", "ready to fault", "armed to fault")
            wait_for(lambda: any(state[1] == "powered" for state in states()) or "fault" in said, 5)
            child.send_signal(signal.SIGKILL)
            child.wait(timeout=PATIENCE_S)
            self.assertTrue(wait_for(lambda: states()[-1][1] in ("watchdog_tripped", "ready")), states()[-1])
            last = states()[-1]
            self.assertEqual(float(last[2]), 0.0)
            # The session is free again, and nothing arms itself.
            again = self.start("--config", config, "--seconds", "0.1")
            out, _ = again.communicate(timeout=PATIENCE_S)
            self.assertEqual(again.returncode, 0, out)
            self.assertNotIn("armed", out)
            # If the machine paused, the controller has found a fault and removed the force before.
            if last[1] == "watchdog_tripped":
                self.assertGreaterEqual(float(last[5]), 10.0)
                tripped += 1
            if tripped == 2:
                return
        self.fail("the device was never powered when its controller was killed")

    def test_bad_input_is_refused_with_a_message(self):
        config = os.path.join(self.dir, "bad.toml")
        with open(config, "w", encoding="utf-8") as f:
            f.write("[servo]\nperiod_ms = 1\n")
        with open(self.scene, "rb") as f:
            data = bytearray(f.read())
        data[-100] ^= 0xFF
        broken = os.path.join(self.dir, "broken.tact")
        with open(broken, "wb") as f:
            f.write(data)
        for options, words in (
            ([self.scene, "--config", config], ["bad.toml:2", "servo.period_ms", "fix:"]),
            ([broken], ["broken.tact", "fix:"]),
            ([os.path.join(self.dir, "none.tact")], ["none.tact", "fix:"]),
            ([self.scene, "--level", "docking.force=3"], ["docking.force=3", "fix:"]),
            ([self.scene, "--law", "mine"], ["governor.law", "mine", "fix:"]),
        ):
            done = subprocess.run([os.path.join(BIN, "tact-rt"), *options], env=self.env, capture_output=True, text=True,
                                  timeout=PATIENCE_S)
            self.assertEqual(done.returncode, 1, options)
            for word in words:
                self.assertIn(word, done.stderr)
        good = subprocess.run([os.path.join(BIN, "tact-rt"), self.scene, "--check"], env=self.env, capture_output=True,
                              text=True, timeout=PATIENCE_S)
        self.assertEqual(good.returncode, 0, good.stderr)

    def test_the_floor_of_a_level_is_accepted_as_it_is_printed_and_nothing_below_it(self):
        for level, code in (("0.17", 0), ("0.16", 1)):
            child = self.start("--level", f"gui.molecules={level}", "--seconds", "0.2")
            out, _ = child.communicate(timeout=PATIENCE_S)
            self.assertEqual(child.returncode, code, out)
            self.assertEqual("the level is outside" in out, code == 1, out)

    def test_the_servo_thread_makes_no_system_call_but_sleep(self):
        if not shutil.which("strace"):
            self.skipTest("strace is not installed")
        log = os.path.join(self.dir, "strace.log")
        probe = subprocess.run(["strace", "-o", os.devnull, "true"], capture_output=True)
        if probe.returncode != 0:
            self.skipTest("ptrace is not permitted here")
        for seconds in ("2", "20", "60"):  # a longer run if a busy machine makes few cycles
            # Ordinary scheduling: under strace every sleep costs two stops, too much for a FIFO loop beside other processes.
            child = self.start("--arm", "--seconds", seconds, "--rate", "200", "--priority", "0",
                               before=["strace", "-f", "-o", log])
            out, _ = child.communicate(timeout=PATIENCE_S)
            if "LeakSanitizer has encountered a fatal error" in out:
                self.skipTest("the sanitizer does not work under ptrace")
            self.assertEqual(child.returncode, 0, out)
            with open(log, encoding="utf-8", errors="replace") as f:
                lines = f.read().splitlines()
            named = [line for line in lines if re.search(r'PR_SET_NAME, "servo"|comm", O_RDWR', line)]
            self.assertTrue(named, "the servo thread was not found")
            thread = named[0].split()[0]
            calls = [m.group(1) for line in lines if (m := re.match(rf"{thread} +(?:<\.\.\. )?(\w+)", line))
                     and "resumed" not in line]
            usage = [i for i, name in enumerate(calls) if name == "getrusage"]
            self.assertEqual(len(usage), 2, calls[-50:])
            cycle_calls = calls[usage[0] + 1:usage[1]]
            if "clock_nanosleep" not in cycle_calls:
                continue
            # Before the first sleep, the thread signals main that it is ready.
            cycle_calls = cycle_calls[cycle_calls.index("clock_nanosleep"):]
            self.assertEqual(set(cycle_calls) - ALLOWED, set())
            if len(cycle_calls) > 100:
                return
        self.fail("no run of more than 100 cycles")


if __name__ == "__main__":
    BIN, WRITER = sys.argv[1], sys.argv[2]
    unittest.main(argv=sys.argv[:1], verbosity=2)
