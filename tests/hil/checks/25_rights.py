#!/usr/bin/env python3
"""The findings of tact doctor, and the scheduling of tact-rt for an ordinary user with and without the rights of deploy/limits.conf.

usage: 25_rights.py BIN_DIR
"""
import json
import os
import resource
import shutil
import subprocess
import sys

BIN = sys.argv[1]
HERE = os.path.dirname(os.path.abspath(__file__))
NOBODY = 65534
MINE = "/run/rights"  # owned by nobody, who may have no access to the build folder


def doctor():
    """Checks the findings that must be ok on a machine set up according to the README."""
    done = subprocess.run([f"{BIN}/tact", "doctor", "--json"], capture_output=True, text=True, timeout=100)
    found = {f["name"]: f for f in json.loads(done.stdout)["findings"]}
    for name in ("kernel", "isolation", "rtprio", "memlock", "dma_latency"):
        print(f"doctor: {name}: {found[name]['says']}")
        assert found[name]["level"] == "ok", found[name]
    assert "PREEMPT_RT" in found["kernel"]["says"]


def deployed_limits():
    """(rtprio, memlock) of deploy/limits.conf for @realtime"""
    with open(os.path.join(HERE, "../../../deploy/limits.conf"), encoding="utf-8") as f:
        rows = [line.split() for line in f if line.startswith("@realtime")]
    value = {row[2]: row[3] for row in rows}
    return int(value["rtprio"]), resource.RLIM_INFINITY if value["memlock"] == "unlimited" else int(value["memlock"])


def said_as_nobody(rtprio, memlock):
    def become():
        resource.setrlimit(resource.RLIMIT_RTPRIO, (rtprio, rtprio))
        resource.setrlimit(resource.RLIMIT_MEMLOCK, (memlock, memlock))
        os.setgroups([])
        os.setgid(NOBODY)
        os.setuid(NOBODY)

    done = subprocess.run([f"{MINE}/tact-rt", f"{MINE}/small.tact", "--seconds", "0.3"], preexec_fn=become, cwd=MINE,
                          env=dict(os.environ, TACT_RUNTIME_DIR=MINE), capture_output=True, text=True, timeout=100)
    print(f"with rtprio {rtprio}, memlock {memlock}:\n{done.stderr}")
    assert done.returncode == 0, done.returncode
    return done.stderr


doctor()
os.mkdir(MINE)
for path in (f"{BIN}/tact-rt", "/out/small.tact"):
    shutil.copy(path, MINE)
    os.chmod(os.path.join(MINE, os.path.basename(path)), 0o755)
os.chown(MINE, NOBODY, NOBODY)
granted = said_as_nobody(*deployed_limits())
assert "FIFO, pinned, isolated core, memory locked" in granted
refused = said_as_nobody(0, 65536)
for words in ("cannot use SCHED_FIFO", "cannot lock memory", "fix:", "ordinary scheduling"):
    assert words in refused, words
print("doctor reports ok; an ordinary user gets FIFO and locked memory with deploy/limits.conf, and runs without them otherwise")
