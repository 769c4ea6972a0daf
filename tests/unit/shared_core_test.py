#!/usr/bin/env python3
"""Two controllers pinned to one core: the second warns in its log, the first does not, and tact doctor reports both.

usage: shared_core_test.py BIN_DIR WRITE_SMALL_SCENE

Exit code 77: this system hides the threads of processes.
"""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PATIENCE_S = 60.0
BIN, WRITER = map(os.path.abspath, sys.argv[1:3])
WARNING = "is also the core of session"


def wait(what, true):
    end = time.monotonic() + PATIENCE_S
    while not (now := true()):
        if time.monotonic() > end:
            sys.exit("FAILED %s: timed out" % what)
        time.sleep(0.1)
    return now


def main():
    folder = tempfile.mkdtemp(prefix="tact_shared_core_")
    env, running = dict(os.environ, TACT_RUNTIME_DIR=folder), []
    core = str(max(os.sched_getaffinity(0)))

    def log(session):
        with open(os.path.join(folder, session + ".log"), errors="replace", encoding="utf-8") as f:
            return f.read()

    def controller(session, *words):
        with open(os.path.join(folder, session + ".log"), "wb") as f:
            running.append(subprocess.Popen([os.path.join(BIN, "tact-rt"), scene, "--session", session, "--priority", "0", *words], env=env,
                                            stdout=f, stderr=f))
        wait(session + " runs", lambda: "; session " + session in log(session))
        return running[-1]

    def finding():
        done = subprocess.run([os.path.join(BIN, "tact"), "doctor", "--session", "none", "--json"], env=env, capture_output=True, text=True, check=False)
        return next(f for f in json.loads(done.stdout)["findings"] if f["name"] == "servo_cores")

    try:
        scene = os.path.join(folder, "small.tact")
        subprocess.run([WRITER, scene], check=True)
        one = controller("one", "--core", core)
        if not os.path.isdir("/proc/%d/task" % one.pid):
            print("skipped: no /proc/PID/task here")
            sys.exit(77)
        config = os.path.join(folder, "tact.toml")
        with open(config, "w", encoding="utf-8") as f:
            f.write("[servo]\ncore = %s\n" % core)
        two = controller("two", "--config", config)
        text = wait("the second warns", lambda: WARNING in log("two") and log("two"))
        # The warning may also name other controllers of this machine.
        if "core %s %s" % (core, WARNING) not in text or "session one (process %d)" % one.pid not in text:
            sys.exit("FAILED: unexpected warning:\n" + text)
        if "session two" in log("one"):
            sys.exit("FAILED: the first controller warned although it started alone:\n" + log("one"))
        row = finding()
        if row["level"] != "warn" or "(process %d)" % one.pid not in row["says"] or "(process %d)" % two.pid not in row["says"] or not row["fix"]:
            sys.exit("FAILED: unexpected finding of tact doctor: %s" % row)
        two.send_signal(signal.SIGTERM)
        two.wait(PATIENCE_S)
        controller("three", "--core", "-2")
        if WARNING in log("three"):
            sys.exit("FAILED: a controller that is not pinned warned:\n" + log("three"))
        if "(process %d)" % two.pid in finding()["says"]:
            sys.exit("FAILED: unexpected finding with one pinned controller: %s" % finding())
    finally:
        for child in running:
            child.kill()
            child.wait()
        shutil.rmtree(folder, ignore_errors=True)
    print("passed")


main()
