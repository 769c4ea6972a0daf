#!/usr/bin/python3
"""Kills a recorder at random instants: each file must open in h5py and lose at most one second.

usage: record_kill_test.py BIN_DIR WRITE_SMALL_SCENE [--runs N] [--seed S]. Exit code 77 (skipped) without h5py.
"""
import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

try:
    import h5py
    import numpy
except ImportError:
    print("skipped: python3-h5py is not installed")
    sys.exit(77)

LOST_NS_MAX = 1_000_000_000
PATIENCE_S = 120


def look_at(path, killed_ns, again):
    """Opens a recording like a user. Returns the number of cycles, the lost time (ns) and the defects."""
    wrong = []
    with h5py.File(path, "r") as f:
        step = f["cycles/step"][:]
        lengths = {name: len(f[group][name]) for group in ("cycles", "hand0") for name in f[group]}
        if set(lengths.values()) != {len(step)}:
            wrong.append("columns of different lengths: %s" % lengths)
        for group in f:
            if group != "start" and len({len(f[group][name]) for name in f[group]}) != 1:
                wrong.append("columns of /%s of different lengths" % group)
        lost = sum(f["drops/records"][:])
        if len(step) and not lost and not numpy.array_equal(step, numpy.arange(step[0], step[0] + len(step), dtype=step.dtype)):
            wrong.append("steps are missing without a reported drop")
        if not numpy.array_equal(step, f["hand0/step"][:]):
            wrong.append("the steps of the hand differ from those of the cycles")
        if f["hand0/pose_world"].shape[1:] != (7,) or f["hand0/wrench_world"].shape[1:] != (6,):
            wrong.append("poses or wrenches have the wrong shape")
        if not numpy.isfinite(f["hand0/wrench_world"][:]).all():
            wrong.append("a wrench is not finite")
        if f.attrs["end"] != (2 if again["damaged"] else 1):
            wrong.append("the file has a wrong end mark")
        lost_ns = killed_ns - int(f["cycles/now_ns"][-1]) if len(step) else None
        return len(step), lost_ns, wrong


class Campaign:
    def __init__(self, programs, writer):
        self.programs = programs
        self.dir = tempfile.mkdtemp(prefix="tact_record_")
        self.env = dict(os.environ, TACT_RUNTIME_DIR=self.dir)
        self.scene = os.path.join(self.dir, "small.tact")
        subprocess.run([writer, self.scene], check=True)
        with open(os.path.join(self.dir, "tact.toml"), "w", encoding="utf-8") as config:
            config.write('[device]\nhand = "wander"\nwatchdog_us = 1e6\n')
        self.controller = subprocess.Popen([self.program("tact-rt"), self.scene, "--config", os.path.join(self.dir, "tact.toml"),
                                            "--priority", "0", "--arm"], env=self.env, stderr=subprocess.DEVNULL)

    def program(self, name):
        return os.path.join(self.programs, name)

    def recorder(self, *words):
        return subprocess.Popen([self.program("tact-record"), *words], env=self.env, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def to_end(self, *words):
        child = self.recorder(*words)
        out, err = child.communicate(timeout=PATIENCE_S)
        return child.returncode, out, err

    def wait_for(self, path, child):
        """Returns False if the recorder ended first."""
        end = time.monotonic() + PATIENCE_S
        while not os.path.exists(path):
            if child.poll() is not None or time.monotonic() > end:
                return False
            time.sleep(0.001)
        return True

    def kill_once(self, number, after_s):
        path = os.path.join(self.dir, "run%d.h5" % number)
        child = self.recorder(path)
        if not self.wait_for(path, child):
            return ["the recorder created no file: " + child.communicate()[1]], 0, 0
        time.sleep(after_s)
        wrong = []
        code, _, err = self.to_end("--repair", path)
        if code != 1 or "still writing" not in err:
            wrong.append("the file of a running recorder was repaired: %d %s" % (code, err))
        # Stopped first, so that the time of its end is known.
        child.send_signal(signal.SIGSTOP)
        killed_ns = time.monotonic_ns()
        child.kill()
        child.communicate()
        code, out, err = self.to_end("--repair", path, "--json")
        if code != 0:
            return wrong + ["not repaired: " + err], 0, 0
        said = json.loads(out)
        if not said["damaged"]:
            wrong.append("the damage is not reported")
        cycles, lost_ns, more = look_at(path, killed_ns, said)
        wrong += more
        if cycles != said["cycles"]:
            wrong.append("a wrong number of cycles was reported")
        if lost_ns is None or lost_ns > LOST_NS_MAX:
            wrong.append("%s ns were lost" % lost_ns)
        code, out, _ = self.to_end("--repair", path, "--json")
        if code != 0 or json.loads(out)["damaged"]:
            wrong.append("a repaired file is reported as damaged")
        os.remove(path)
        return wrong, lost_ns or 0, cycles

    def in_order(self):
        """SIGINT ends a recording without damage."""
        path = os.path.join(self.dir, "whole.h5")
        child = self.recorder(path, "--json")
        if not self.wait_for(path, child):
            return ["no file: " + child.communicate()[1]]
        time.sleep(0.6)
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=PATIENCE_S)
        if child.returncode != 0:
            return ["SIGINT: exit code %d %s" % (child.returncode, err)]
        cycles, _, wrong = look_at(path, 0, {"damaged": False})
        said = json.loads(out)
        if said["end"] != "stopped" or said["cycles"] != cycles or said["lost"] != 0:
            wrong.append("the reported outcome differs: " + out)
        code, _, err = self.to_end(path)
        if code != 1 or "exists already" not in err:
            wrong.append("an older recording was overwritten")
        return wrong

    def disk_full(self):
        """A full disk is reported, and the file opens."""
        path = os.path.join(self.dir, "full.h5")
        command = 'ulimit -f 1500; exec "$0" "$1"'  # blocks of 512 or 1024 bytes
        child = subprocess.Popen(["sh", "-c", command, self.program("tact-record"), path], env=self.env,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        _, err = child.communicate(timeout=PATIENCE_S)
        if child.returncode != 1 or "fix: free disk space" not in err:
            return ["a full disk: exit code %d %s" % (child.returncode, err)]
        code, out, err = self.to_end("--repair", path, "--json")
        if code != 0:
            return ["after a full disk: " + err]
        return look_at(path, 0, json.loads(out))[2]

    def flight(self):
        """Flight recordings on request: bounded length and number, exported as a table."""
        folder = os.path.join(self.dir, "flights")
        child = self.recorder("--flight", folder, "--length", "1", "--keep", "1", "--json", "--wait", str(PATIENCE_S))
        files = lambda: sorted(os.listdir(folder)) if os.path.isdir(folder) else []
        end, asked = time.monotonic() + PATIENCE_S, 0
        said = []
        while len(said) < 2 and child.poll() is None and time.monotonic() < end:
            child.send_signal(signal.SIGUSR1) if os.path.isdir(folder) else None
            asked += 1
            time.sleep(0.5)
            said = sorted(set(said) | {f for f in files() if f.endswith(".h5")})
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=PATIENCE_S)
        if child.returncode != 0 or len(said) < 2:
            return ["%d flights after %d requests: %s %s" % (len(said), asked, out, err)]
        left = files()
        if len(left) != 1 or left[0] != said[-1] and left[0] < said[-1]:
            return ["the newest recording was not kept: %s of %s" % (left, said)]
        path = os.path.join(folder, left[0])
        cycles, _, wrong = look_at(path, 0, {"damaged": False})
        with h5py.File(path, "r") as f:
            length_s = (int(f["cycles/now_ns"][-1]) - int(f["cycles/now_ns"][0])) * 1e-9
            if not f.attrs["cause"] or not 0.1 < length_s < 2.0:
                wrong.append("cause %r, %.1f s" % (f.attrs["cause"], length_s))
        return wrong + self.table(path, cycles)

    def table(self, path, cycles):
        table = path + ".csv"
        code, out, err = self.to_end("--csv", path, "-o", table, "--json")
        if code != 0:
            return ["no table: " + err]
        with open(table, encoding="utf-8") as lines:
            names = lines.readline().rstrip().split(",")
            rows = [line.rstrip().split(",") for line in lines]
        with h5py.File(path, "r") as f:
            dry = int((f["cycles/flags"][:] & 1).sum())
            force = f["hand0/wrench_world"][dry:, 0]
            pose = f["hand0/pose_world"][dry:, 6]
        wrong = []
        if len(rows) != cycles - dry or json.loads(out)["rows"] != len(rows) or {len(r) for r in rows} != {len(names)}:
            wrong.append("the table has %d rows of %d cycles" % (len(rows), cycles))
        elif any(float(r[names.index("hand0_fx_n")]) != x or float(r[names.index("hand0_qw")]) != q for r, x, q in zip(rows, force, pose)):
            wrong.append("a number in the table differs from the recording")
        code, _, err = self.to_end("--csv", path, "-o", table)
        if code != 1 or "exists already" not in err:
            wrong.append("a table was overwritten")
        return wrong

    def close(self):
        self.controller.terminate()
        self.controller.wait(timeout=PATIENCE_S)
        shutil.rmtree(self.dir)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs")
    parser.add_argument("writer")
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--seed", type=int, default=20261123)
    request = parser.parse_args()
    chance = random.Random(request.seed)
    campaign = Campaign(request.programs, request.writer)
    failed = False
    try:
        for name, test in (("ended in order", campaign.in_order), ("disk full", campaign.disk_full), ("flight and table", campaign.flight)):
            wrong = test()
            failed = failed or bool(wrong)
            print("%s: %s" % (name, "; ".join(wrong) or "ok"))
        losses = []
        for number in range(request.runs):
            wrong, lost_ns, cycles = campaign.kill_once(number, chance.uniform(0.0, 1.5))
            failed = failed or bool(wrong)
            losses.append(lost_ns)
            print("kill %d: %d cycles, %.3f s lost%s" % (number, cycles, lost_ns * 1e-9, "; " + "; ".join(wrong) if wrong else ""))
        if losses:
            print("%d kills: at most %.3f s lost" % (len(losses), max(losses) * 1e-9))
    finally:
        campaign.close()
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
