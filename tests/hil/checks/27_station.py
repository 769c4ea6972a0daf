#!/usr/bin/env python3
"""tact station on the real-time kernel: setup and undo on a tree, verify, and the service's watchdog while the servo is stopped.

usage: 27_station.py BIN_DIR. Lateness is printed but not checked: it is meaningful only on a real processor.
"""
import ctypes
import json
import os
import shutil
import socket
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import parts

BIN = sys.argv[1]
TREE, REPORT, CONFIG = "/run/station_tree", "/out/station-report.json", "/run/station.toml"
PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_DETACH, WALL = 0x4206, 0x4207, 17, 0x40000000
LIMIT_S = 0.8  # watchdog limit


def tact(*arguments):
    done = subprocess.run([f"{BIN}/tact", "station", *arguments], capture_output=True, text=True, timeout=parts.PATIENCE_S)
    print(done.stdout + done.stderr)
    return done.returncode, done.stdout


def files_of(tree):
    found = {}
    for folder, _, names in os.walk(tree):
        for path in (os.path.join(folder, n) for n in names):
            if os.path.islink(path):
                found[path] = os.readlink(path)
                continue
            with open(path, "rb") as f:
                found[path] = (os.lstat(path).st_mode, f.read())
    return found


def setup_and_undo():
    """Setup and undo on a tree with this machine's processors."""
    os.makedirs(f"{TREE}/sys/devices/system/cpu")
    os.makedirs(f"{TREE}/etc/default")
    shutil.copy("/sys/devices/system/cpu/online", f"{TREE}/sys/devices/system/cpu/online")
    with open(f"{TREE}/etc/default/grub", "w", encoding="utf-8") as f:
        f.write('GRUB_CMDLINE_LINUX_DEFAULT="quiet"\n')
    before = files_of(TREE)
    assert tact("setup", "--root", TREE)[0] == 0
    wanted = parts.text_of(f"{TREE}/etc/default/grub.d/tact.cfg")
    in_force = parts.text_of("/proc/cmdline").split()
    for item in ("isolcpus=managed_irq,domain,1", "nohz_full=1", "rcu_nocbs=1", "irqaffinity=0"):
        assert item in wanted and item in in_force, (item, wanted)  # this machine boots with the arguments that setup writes
    assert tact("undo", "--root", TREE)[0] == 0
    assert files_of(TREE) == before


def setup_for_real():
    """Setup and undo of this machine's files and groups; its root is an overlay in memory. systemd and udev do not run here."""
    places = ("/etc/udev/rules.d", "/etc/security", "/etc/systemd", "/usr/local/lib")
    groups = ("/etc/group", "/etc/gshadow")

    def now():
        return [files_of(p) for p in places], [parts.text_of(g) for g in groups]

    before = now()
    code, received = tact("setup", "--skip", "kernel", "--skip", "kernel-arguments", "--user", "nobody")
    assert code == 0 and "groupadd --system tact" in received
    assert [line for line in parts.text_of("/etc/group").splitlines() if line.startswith("realtime:") and "nobody" in line]
    assert os.stat("/var/lib/tact/station.json").st_mode & 0o777 == 0o600
    env = dict(os.environ, TACT_CORES="1")
    for item in ("start", "stop"):
        subprocess.run(["/usr/local/lib/tact/station-tune", item], check=True, env=env, timeout=parts.PATIENCE_S)
    assert tact("setup", "--skip", "kernel", "--skip", "kernel-arguments", "--user", "nobody")[1].endswith("changed\n")
    assert tact("undo")[0] == 0
    assert now() == before
    assert not os.path.exists("/var/lib/tact/station.json")


def verify():
    code, _ = tact("verify", "--minutes", "0.04", "--scene", "/out/small.tact", "--config", CONFIG, "--out", REPORT)
    report = json.loads(parts.text_of(REPORT))
    assert code == (1 if report["status"] == "fail" else 0), code
    checks = {c["name"]: c for c in report["checks"]}
    for name in ("kernel", "scheduling", "servo_calls", "cycles"):
        assert checks[name]["status"] == "pass", checks[name]
    assert report["core"] == 1 and "on core 1, after the controller" in report["cyclictest"]["text"], report
    assert report["cyclictest"]["max_us"] > 0
    assert "count" in report["smi"] or report["smi"]["text"].startswith("not readable"), report["smi"]
    return report


def servo_of(process):
    for tid in os.listdir(f"/proc/{process}/task"):
        if parts.text_of(f"/proc/{process}/task/{tid}/comm").strip() == "servo":
            return int(tid)
    raise AssertionError("no servo thread")


def watchdog():
    """Counts the watchdog datagrams of a real tact-rt, then stops only its servo thread."""
    manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    manager.bind("/run/notify")

    def came(seconds):
        text = ""
        manager.settimeout(seconds)
        try:
            while True:
                text += manager.recv(4096).decode()
        except TimeoutError:
            return text

    def until(message):
        manager.settimeout(parts.PATIENCE_S)
        text = ""
        while message not in text:
            text += manager.recv(4096).decode()
        return text

    env = dict(os.environ, NOTIFY_SOCKET="/run/notify", WATCHDOG_USEC=str(int(LIMIT_S * 1e6)))
    env.pop("WATCHDOG_PID", None)
    rt = subprocess.Popen([f"{BIN}/tact-rt", "/out/small.tact", "--config", CONFIG], env=env)
    try:
        received = until("READY=1")
        assert "WATCHDOG" not in received.split("READY=1")[0], received
        for _ in range(3):
            received += until("WATCHDOG=1")
        assert "STATUS=ready" in received and "STATUS=a" not in received, received
        libc, tid = ctypes.CDLL(None, use_errno=True), servo_of(rt.pid)
        libc.ptrace.argtypes, libc.ptrace.restype = [ctypes.c_long] * 4, ctypes.c_long
        assert libc.ptrace(PTRACE_SEIZE, tid, 0, 0) == 0, os.strerror(ctypes.get_errno())
        assert libc.ptrace(PTRACE_INTERRUPT, tid, 0, 0) == 0
        os.waitpid(tid, WALL)
        try:
            came(LIMIT_S / 2)  # datagrams for earlier cycles
            quiet = came(3 * LIMIT_S)
            assert rt.poll() is None
        finally:
            assert libc.ptrace(PTRACE_DETACH, tid, 0, 0) == 0  # a traced thread would outlive SIGKILL
        assert "WATCHDOG" not in quiet, quiet
        until("WATCHDOG=1")
        rt.terminate()
        until("STOPPING=1")
        assert rt.wait(parts.PATIENCE_S) == 0
    finally:
        if rt.poll() is None:
            rt.kill()
            rt.wait()


def main():
    with open(CONFIG, "w", encoding="utf-8") as f:
        f.write(parts.with_sections(parts.text_of(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../hil.toml")),
                                    parts.EMULATED if parts.ACCEL == "tcg" else ""))
    setup_and_undo()
    setup_for_real()
    report = verify()
    watchdog()
    late, smi = report["lateness_us"], report["smi"]
    print(f"setup undone byte for byte; verify: {report['status']}, {report['cycles']} cycles on core 1, lateness p99.9 "
          f"{late['p999']:.0f} us, cyclictest {report['cyclictest']['max_us']:.0f} us, SMI {smi.get('count', smi['text'])}; "
          "no watchdog datagram while the servo was stopped")


if __name__ == "__main__":
    main()
