#!/usr/bin/env python3
"""The kernel is real-time, core 1 is isolated, and a FIFO thread with locked memory runs on it."""
import ctypes
import os
import sys


def first_line(path):
    with open(path, encoding="utf-8") as f:
        return f.readline().strip()


print(first_line("/proc/version"))
print(first_line("/proc/cmdline"))
print("clock:", first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource"))
assert first_line("/sys/kernel/realtime") == "1", "this kernel is not PREEMPT_RT"
assert first_line("/sys/devices/system/cpu/online") == "0-1"
assert first_line("/sys/devices/system/cpu/isolated") == "1", "core 1 is not isolated"
assert first_line("/sys/devices/system/cpu/nohz_full") == "1", "the tick of core 1 is not stopped"
assert os.sched_getaffinity(0) == {0}, "an ordinary process may run on the isolated core"

MCL_CURRENT, MCL_FUTURE = 1, 2
libc = ctypes.CDLL(None, use_errno=True)
assert libc.mlockall(MCL_CURRENT | MCL_FUTURE) == 0, os.strerror(ctypes.get_errno())
os.sched_setaffinity(0, {1})
os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(80))
assert os.sched_getscheduler(0) == os.SCHED_FIFO and os.sched_getparam(0).sched_priority == 80
with open("/proc/self/stat", encoding="utf-8") as f:
    assert f.read().rsplit(")", 1)[1].split()[36] == "1", "the thread does not run on core 1"
with open("/dev/cpu_dma_latency", "wb", buffering=0) as f:
    assert f.write(b"\0\0\0\0") == 4
print(f"{os.uname().release}: real-time, core 1 isolated, FIFO 80 with locked memory on it")
sys.exit(0)
