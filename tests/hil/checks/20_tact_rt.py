#!/usr/bin/env python3
"""tact and tact-rt as shipped: the servo thread has the isolated core and its priority, and never allocates.

usage: 20_tact_rt.py BIN_DIR. Lateness is printed but not checked: it is meaningful only on a real processor.
"""
import json
import os
import signal
import subprocess
import sys
import time

BIN = sys.argv[1]
HERE = os.path.dirname(os.path.abspath(__file__))
ACCEL = os.environ.get("TACT_HIL_ACCEL", "kvm")
CYCLES = 5000 if ACCEL == "kvm" else 2000
PATIENCE_S = 100
FIFO, PINNED, ISOLATED, LOCKED, NO_DEEP_SLEEP = (1 << i for i in range(5))  # ipc/topics/health.hpp


def text_of(path):
    with open(path, encoding="utf-8", errors="replace") as f:
        return f.read()


def threads(pid):
    """name -> (thread id, policy, priority, last core, allowed cores)"""
    found = {}
    for tid in map(int, os.listdir(f"/proc/{pid}/task")):
        stat = text_of(f"/proc/{pid}/task/{tid}/stat").rsplit(")", 1)[1].split()
        found[text_of(f"/proc/{pid}/task/{tid}/comm").strip()] = (
            tid, os.sched_getscheduler(tid), os.sched_getparam(tid).sched_priority, int(stat[36]),
            os.sched_getaffinity(tid))
    return found


def controller_of(launcher):
    """Process id of the tact-rt started by this tact, or None."""
    children = text_of(f"/proc/{launcher}/task/{launcher}/children").split()
    return next((int(c) for c in children if text_of(f"/proc/{c}/comm").strip() == "tact-rt"), None)


def status():
    done = subprocess.run([f"{BIN}/tact", "status", "--json"], capture_output=True, text=True, timeout=PATIENCE_S)
    return json.loads(done.stdout) if done.returncode == 0 else {}


def main():
    run = subprocess.Popen([f"{BIN}/tact", "run", "/out/small.tact", "--no-gui", "--quiet",
                            "--json", "/out/tact_run.json", "--config", os.path.join(HERE, "../hil.toml")])
    try:
        end = time.monotonic() + PATIENCE_S
        now = status()
        while now.get("state") != "active" or now["servo"]["cycles"] < CYCLES:
            assert run.poll() is None, f"tact run ended with {run.returncode}"
            assert time.monotonic() < end, f"not active for {CYCLES} cycles in {PATIENCE_S} s: {now}"
            time.sleep(0.5)
            now = status()
        rt = controller_of(run.pid)
        by_name = threads(rt)
        for name, (tid, policy, priority, core, may) in sorted(by_name.items()):
            print(f"thread {name:8} {tid}: {'FIFO' if policy == os.SCHED_FIFO else 'other'} {priority}, "
                  f"on core {core} of {sorted(may)}")
        locked = [line for line in text_of(f"/proc/{rt}/status").splitlines() if line.startswith(("VmLck", "VmRSS"))]
        print(os.uname().release, *locked, sep="\n")
        _, policy, priority, core, may = by_name["servo"]
        assert (policy, priority) == (os.SCHED_FIFO, 80), (policy, priority)
        assert core == 1 and may == {1}, (core, may)
        for name, thread in by_name.items():
            assert name == "servo" or 1 not in thread[4], f"{name} may run on the servo's core"
        assert int(locked[0].split()[1]) > 1000, locked

        run.send_signal(signal.SIGINT)
        assert run.wait(timeout=PATIENCE_S) in (0, 130), run.returncode
    finally:
        if run.poll() is None:
            run.terminate()  # tact also ends its controller
            run.wait(timeout=PATIENCE_S)
    report = json.loads(text_of("/out/tact_run.json"))
    servo = report["servo"]
    print(json.dumps(servo))
    wanted = FIFO | PINNED | ISOLATED | LOCKED | NO_DEEP_SLEEP
    assert servo["schedule_flags"] == wanted, servo["schedule"]
    assert servo["period_us"] == 1000.0
    assert servo["allocations"] == 0 and servo["locks"] == 0 and servo["page_faults"] == 0, servo
    late = servo["lateness_us"]
    print(f"{servo['cycles']} cycles, active, on core 1, FIFO 80; no allocation, lock or page fault; {ACCEL}: "
          f"{report['force_rate_hz']:.0f} Hz, lateness p50 {late['p50']:.0f} us, max {late['max']:.0f} us")


if __name__ == "__main__":
    main()
