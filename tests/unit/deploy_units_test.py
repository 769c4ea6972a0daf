#!/usr/bin/env python3
"""The systemd units: findings of systemd-analyze, effects of their command lines, and the watchdog of a real tact-rt.

usage: deploy_units_test.py ROOT_OF_THE_PROJECT BIN_DIR WRITE_SMALL_SCENE
"""
import ctypes
import os
import re
import shutil
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

ROOT, BIN, WRITER = sys.argv[1:4]
UNITS = os.path.join(ROOT, "deploy/units")
NAMES = ("tact-rt@.service", "tact-metrics.service", "tact-station.service")
PATIENCE_S = 120  # tolerates a busy machine
ANALYZE = shutil.which("systemd-analyze")
PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_DETACH = 0x4206, 0x4207, 17


def end_group(process):
    """Kills what a failed test left behind: strace ignores SIGTERM, and ctest waits for every process that holds its pipe."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


def unit(name):
    """Returns [(key, value)] of all sections."""
    with open(os.path.join(UNITS, name), encoding="utf-8") as f:
        return [tuple(line.strip().split("=", 1)) for line in f if "=" in line and not line.startswith("#")]


def value(name, key):
    return [v for k, v in unit(name) if k == key][-1]


def system_calls(*groups):
    """Returns the system calls of these systemd groups."""
    calls, left = set(), list(groups)
    while left:
        done = subprocess.run([ANALYZE, "syscall-filter", left.pop()], capture_output=True, text=True, check=True)
        for line in done.stdout.splitlines()[1:]:
            name = line.strip()
            left += [name] if name.startswith("@") else []
            calls |= set() if name.startswith(("@", "#")) else {name}
    return calls


class Files(unittest.TestCase):
    def setUp(self):
        self.dir = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.dir)

    def test_the_command_line_of_the_controller_arms_nothing_and_takes_no_free_options(self):
        text_wanted = value("tact-rt@.service", "ExecStart").split()
        self.assertEqual(text_wanted, ["/usr/bin/tact-rt", "/var/lib/tact/scenes/%i.tact", "--config", "/etc/tact/tact.toml",
                                 "$TACT_RT_CORE"])
        self.assertIn(("Environment", "TACT_RT_CORE="), unit("tact-rt@.service"))
        self.assertFalse([v for k, v in unit("tact-rt@.service") if k in ("EnvironmentFile", "PassEnvironment", "ExecStartPost")])
        with open(os.path.join(ROOT, "deploy/tact.toml"), encoding="utf-8") as f:
            self.assertFalse([line for line in f if re.match(r"arm\w*\s*=", line)], "a key that arms")

    def test_the_service_has_a_watchdog_and_its_user_and_rights(self):
        for key, wanted in (("Type", "notify"), ("Restart", "on-failure"), ("User", "tact"), ("Group", "tact"),
                            ("SupplementaryGroups", "realtime"), ("LimitRTPRIO", "95"), ("LimitMEMLOCK", "infinity"),
                            ("RestrictRealtime", "no"), ("CapabilityBoundingSet", "")):
            self.assertEqual(value("tact-rt@.service", key), wanted)
        self.assertLessEqual(int(value("tact-rt@.service", "WatchdogSec")), 5)
        with open(os.path.join(ROOT, "deploy/limits.conf"), encoding="utf-8") as f:
            self.assertIn(value("tact-rt@.service", "LimitRTPRIO"), f.read())

    @unittest.skipUnless(ANALYZE, "no systemd-analyze here: apt-get install systemd")
    def test_systemd_accepts_the_units(self):
        for folder in ("usr/bin", "etc/systemd/system"):
            os.makedirs(os.path.join(self.dir, folder))
        for name in NAMES:
            shutil.copy(os.path.join(UNITS, name), os.path.join(self.dir, "etc/systemd/system"))
        # Uses paths without blanks; the checkout's path may have some.
        os.symlink(BIN, os.path.join(self.dir, "programs"))
        os.symlink(os.path.join(ROOT, "deploy"), os.path.join(self.dir, "deploy"))
        paths = []
        for name in NAMES:
            with open(os.path.join(UNITS, name), encoding="utf-8") as f:
                text = f.read().replace("/usr/bin/tact", f"{self.dir}/programs/tact").replace("/usr/local/lib/tact", f"{self.dir}/deploy")
            paths.append(os.path.join(self.dir, name.replace("@", "@skull")))
            with open(paths[-1], "w", encoding="utf-8") as f:
                f.write(text)
        done = subprocess.run([ANALYZE, "verify", "--man=no", *paths], capture_output=True, text=True, check=False)
        printed = [line for line in (done.stdout + done.stderr).splitlines() if "tact" in line]
        self.assertEqual((done.returncode, printed), (0, []), done.stderr)

    @unittest.skipUnless(ANALYZE, "no systemd-analyze here: apt-get install systemd")
    def test_systemd_rates_the_exposure_as_ok(self):
        for name, most in (("tact-rt@.service", 20), ("tact-metrics.service", 15), ("tact-station.service", 20)):
            done = subprocess.run([ANALYZE, "security", "--offline=true", f"--threshold={most}", "--no-pager",
                                   os.path.join(UNITS, name)], capture_output=True, text=True, check=False)
            if "nrecognized option" in done.stderr:
                self.skipTest("this systemd-analyze has no --offline")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("OK", done.stdout.splitlines()[-1])

    @unittest.skipUnless(shutil.which("systemd-sysusers"), "no systemd-sysusers here: apt-get install systemd")
    def test_the_sysusers_file_creates_the_user_and_the_groups(self):
        os.makedirs(os.path.join(self.dir, "etc"))
        os.makedirs(os.path.join(self.dir, "usr/lib/sysusers.d"))
        shutil.copy(os.path.join(UNITS, "tact.sysusers"), os.path.join(self.dir, "usr/lib/sysusers.d/tact.conf"))
        subprocess.run(["systemd-sysusers", f"--root={self.dir}"], check=True, capture_output=True)
        with open(os.path.join(self.dir, "etc/group"), encoding="utf-8") as f:
            groups = {line.split(":")[0]: line.strip().split(":")[3] for line in f}
        self.assertEqual(groups, {"tact": "", "realtime": "tact"})
        with open(os.path.join(self.dir, "etc/passwd"), encoding="utf-8") as f:
            users = [line for line in f if line.startswith("tact:")]
        self.assertTrue(users and users[0].strip().endswith("nologin"), users)


class Service(unittest.TestCase):
    """tact-rt with the command line of the unit, and a socket in place of systemd's."""

    def setUp(self):
        self.dir = tempfile.mkdtemp(prefix="tact_units_")
        self.addCleanup(shutil.rmtree, self.dir)
        subprocess.run([WRITER, f"{self.dir}/small.tact"], check=True)
        self.manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.manager.close)
        self.manager.bind(f"{self.dir}/notify")
        self.child = None
        self.addCleanup(self.kill)

    def kill(self):
        if self.child is not None and self.child.poll() is None:
            self.child.kill()
            self.child.wait()

    def command(self):
        text_wanted = value("tact-rt@.service", "ExecStart").replace("$TACT_RT_CORE", "").split()
        place = {"/usr/bin/tact-rt": f"{BIN}/tact-rt", "/var/lib/tact/scenes/%i.tact": f"{self.dir}/small.tact",
                 "/etc/tact/tact.toml": os.path.join(ROOT, "deploy/tact.toml")}
        return [place.get(w, w) for w in text_wanted]

    def start(self, before=(), **environment):
        env = dict(os.environ, TACT_RUNTIME_DIR=self.dir, NOTIFY_SOCKET=f"{self.dir}/notify", WATCHDOG_USEC="400000")
        env.update(environment)
        self.child = subprocess.Popen([*before, *self.command()], env=env, stderr=subprocess.DEVNULL)
        return self.child

    def messages(self, seconds):
        end, text = time.monotonic() + seconds, ""
        while (left := end - time.monotonic()) > 0:
            self.manager.settimeout(left)
            try:
                text += self.manager.recv(4096).decode()
            except TimeoutError:
                break
        return text

    def until(self, text_wanted):
        end, text = time.monotonic() + PATIENCE_S, ""
        while text_wanted not in text:
            self.assertLess(time.monotonic(), end, f"{text_wanted!r} was not received: {text}")
            text += self.messages(0.1)
        return text

    def servo(self):
        for tid in os.listdir(f"/proc/{self.child.pid}/task"):
            with open(f"/proc/{self.child.pid}/task/{tid}/comm", encoding="utf-8") as f:
                if f.read().strip() == "servo":
                    return int(tid)
        raise AssertionError("no servo thread")

    def test_the_watchdog_is_fed_only_while_the_servo_runs(self):
        self.start()
        self.assertNotIn("WATCHDOG=1\nREADY", self.until("READY=1"))
        fed = self.until("WATCHDOG=1")
        self.assertIn("STATUS=ready", fed + self.until("STATUS="))
        libc, tid = ctypes.CDLL(None, use_errno=True), self.servo()
        libc.ptrace.argtypes = [ctypes.c_long] * 4
        libc.ptrace.restype = ctypes.c_long
        if libc.ptrace(PTRACE_SEIZE, tid, 0, 0) != 0:
            self.skipTest(f"ptrace: {os.strerror(ctypes.get_errno())}")
        self.assertEqual(libc.ptrace(PTRACE_INTERRUPT, tid, 0, 0), 0)  # only this thread
        os.waitpid(tid, 0x40000000)  # __WALL
        try:
            self.messages(0.5)  # messages already sent
            quiet = self.messages(2.0)  # five times the limit of systemd
            self.assertIsNone(self.child.poll())  # only the servo is stopped, not the process
        finally:
            self.assertEqual(libc.ptrace(PTRACE_DETACH, tid, 0, 0), 0)  # a traced thread would outlive SIGKILL
        self.assertNotIn("WATCHDOG", quiet)
        self.until("WATCHDOG=1")
        self.child.send_signal(signal.SIGTERM)
        self.until("STOPPING=1")
        self.assertEqual(self.child.wait(PATIENCE_S), 0)

    def test_after_a_kill_and_restart_it_is_ready_and_not_armed(self):
        for _ in range(2):
            self.start()
            printed = self.until("READY=1") + self.messages(1.5)
            self.assertIn("STATUS=ready", printed)
            self.assertNotRegex(printed, "STATUS=(armed|active)")
            done = subprocess.run([f"{BIN}/tact", "status", "--json"], env=dict(os.environ, TACT_RUNTIME_DIR=self.dir),
                                  capture_output=True, text=True, check=True)
            self.assertIn('"state": "ready"', done.stdout)
            self.child.kill()
            self.child.wait(PATIENCE_S)

    @unittest.skipUnless(ANALYZE and shutil.which("strace"), "no systemd-analyze or strace here")
    def test_it_makes_no_system_call_and_no_mapping_that_the_unit_forbids(self):
        allowed, trace = system_calls("@system-service"), f"{self.dir}/trace"
        self.start(before=("strace", "-f", "-qq", "-o", trace))
        self.until("READY=1")
        self.messages(1.0)
        with open(f"/proc/{self.child.pid}/task/{self.child.pid}/children", encoding="utf-8") as f:
            os.kill(int(f.read().split()[0]), signal.SIGTERM)
        self.until("STOPPING=1")
        self.child.wait(PATIENCE_S)
        with open(trace, encoding="utf-8", errors="replace") as f:
            calls = re.findall(r"^\d+ +(\w+)\((.*)", f.read(), re.M)
        self.assertGreater(len(calls), 1000)
        self.assertFalse({name for name, _ in calls} - allowed)
        self.assertFalse([c for c in calls if "PROT_WRITE|PROT_EXEC" in c[1]])
        families = {m[1] for name, rest in calls if name == "socket" and (m := re.match(r"(AF_\w+)", rest))}
        self.assertLessEqual(families, set(value("tact-rt@.service", "RestrictAddressFamilies").split()))

    @unittest.skipUnless(ANALYZE and shutil.which("strace"), "no systemd-analyze or strace here")
    def test_the_metrics_make_no_system_call_that_their_unit_forbids(self):
        allowed, trace = system_calls("@system-service") - system_calls("@privileged", "@resources"), f"{self.dir}/trace"
        filters = [v for k, v in unit("tact-metrics.service") if k == "SystemCallFilter"]
        self.assertEqual(filters, ["@system-service", "~@privileged @resources"])
        self.start()
        self.until("READY=1")
        metrics = subprocess.Popen(["strace", "-f", "-qq", "-o", trace, f"{BIN}/tact", "metrics", "--port", "0"], text=True,
                                   env=dict(os.environ, TACT_RUNTIME_DIR=self.dir), stderr=subprocess.PIPE, start_new_session=True)
        self.addCleanup(end_group, metrics)
        address = re.match(r"http://\S+/metrics", metrics.stderr.readline())[0]
        end, page = time.monotonic() + PATIENCE_S, b""
        while b"tact_up{session=\"default\"} 1" not in page:
            self.assertLess(time.monotonic(), end, page)
            with urllib.request.urlopen(address, timeout=PATIENCE_S) as answer:
                page = answer.read()
        with open(f"/proc/{metrics.pid}/task/{metrics.pid}/children", encoding="utf-8") as f:
            os.kill(int(f.read().split()[0]), signal.SIGTERM)
        metrics.communicate(timeout=PATIENCE_S)
        with open(trace, encoding="utf-8", errors="replace") as f:
            calls = set(re.findall(r"^\d+ +(\w+)\(", f.read(), re.M))
        self.assertIn("recvmsg", calls)
        self.assertFalse(calls - allowed)

    def test_the_first_request_after_the_address_gets_a_page(self):
        for _ in range(10):
            metrics = subprocess.Popen([f"{BIN}/tact", "metrics", "--port", "0"], text=True, stderr=subprocess.PIPE,
                                       env=dict(os.environ, TACT_RUNTIME_DIR=self.dir), start_new_session=True)
            try:
                address = re.match(r"http://\S+/metrics", metrics.stderr.readline())[0]
                with urllib.request.urlopen(address, timeout=PATIENCE_S) as answer:
                    self.assertIn(b"tact_up", answer.read())
            finally:
                end_group(metrics)
                metrics.stderr.close()

    def test_journal_lines_have_a_level_and_no_time(self):
        read, write = os.pipe()
        what = os.fstat(write)
        env = dict(os.environ, TACT_RUNTIME_DIR=self.dir, JOURNAL_STREAM=f"{what.st_dev}:{what.st_ino}")
        subprocess.run([*self.command(), "--seconds", "0.2"], env=env, stderr=write, check=True)
        broken = subprocess.run([f"{BIN}/tact-rt", f"{self.dir}/absent.tact"], env=env, stderr=write, check=False)
        os.close(write)
        with os.fdopen(read, encoding="utf-8") as f:
            lines = f.read().splitlines()
        self.assertEqual(broken.returncode, 1)
        self.assertGreater(len(lines), 3)
        self.assertFalse([line for line in lines if not re.match(r"<[2-7]>(?!\d\d:\d\d)", line)], lines)
        self.assertTrue([line for line in lines if line.startswith("<3>") and "absent.tact" in line], lines)


@unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "not root, or no setpriv")
class OtherUsers(unittest.TestCase):
    """A controller of user 61001, group 61000, as at a station, and the users that may watch it."""

    def setUp(self):
        self.dir = tempfile.mkdtemp(prefix="tact_group_", dir="/run")  # a folder created by root, like /run/tact
        self.addCleanup(shutil.rmtree, self.dir)
        self.run_dir = f"{self.dir}/tact"
        os.chmod(self.dir, 0o755)
        os.mkdir(self.run_dir)
        os.chmod(self.run_dir, 0o750)
        os.chown(self.run_dir, 61001, 61000)
        subprocess.run([WRITER, f"{self.dir}/small.tact"], check=True)
        os.chmod(f"{self.dir}/small.tact", 0o644)
        os.mkdir(f"{self.dir}/bin")
        for program in ("tact-rt", "tact"):  # readable and executable for all users
            shutil.copy(f"{BIN}/{program}", f"{self.dir}/bin")

    def start(self, **environment):
        child = subprocess.Popen(["setpriv", "--reuid=61001", "--regid=61000", "--clear-groups", f"{self.dir}/bin/tact-rt",
                                  f"{self.dir}/small.tact"], stderr=subprocess.PIPE, text=True, cwd="/",
                                 env=dict(os.environ, TACT_RUNTIME_DIR=self.run_dir, **environment))
        self.addCleanup(lambda: (child.kill(), child.communicate()))
        for line in child.stderr:
            if "session default" in line:
                break
        return child

    def status(self, user, groups, **environment):
        done = subprocess.run(["setpriv", f"--reuid={user}", "--regid=65534", groups, f"{self.dir}/bin/tact", "status"],
                              capture_output=True, text=True, cwd="/", check=False,
                              env=dict(os.environ, TACT_RUNTIME_DIR=self.run_dir, **environment))
        return done.returncode, done.stdout + done.stderr

    def test_only_members_of_the_group_can_attach(self):
        self.start(TACT_RUNTIME_GROUP="61000")
        socket_mode = os.stat(f"{self.run_dir}/tact-default.sock")
        self.assertEqual((stat.S_IMODE(socket_mode.st_mode), socket_mode.st_gid), (0o660, 61000))
        code, text = self.status(61002, "--groups=61000", TACT_RUNTIME_GROUP="61000")
        self.assertEqual(code, 0, text)
        self.assertIn("state ready", text)
        for user, groups, environment in ((61002, "--clear-groups", {"TACT_RUNTIME_GROUP": "61000"}),
                                          (61002, "--groups=61003", {"TACT_RUNTIME_GROUP": "61003"}),
                                          (61002, "--groups=61000", {})):  # must be requested
            code, text = self.status(user, groups, **environment)
            self.assertEqual(code, 1, (groups, environment, text))

    def test_without_the_variable_the_controller_serves_its_own_user_alone(self):
        self.start()
        self.assertEqual(stat.S_IMODE(os.stat(f"{self.run_dir}/tact-default.sock").st_mode), 0o600)
        code, text = self.status(61002, "--groups=61000", TACT_RUNTIME_GROUP="61000")
        self.assertEqual(code, 1, text)

    def test_the_kernels_peer_credentials_decide_even_with_an_open_socket(self):
        self.start(TACT_RUNTIME_GROUP="61000")
        os.chmod(f"{self.run_dir}/tact-default.sock", 0o666)
        os.chmod(self.run_dir, 0o755)
        code, text = self.status(61002, "--clear-groups", TACT_RUNTIME_GROUP="61000")
        self.assertEqual(code, 1, text)
        self.assertNotIn("state ready", text)

    def test_a_folder_that_a_user_could_have_placed_is_not_trusted(self):
        self.start(TACT_RUNTIME_GROUP="61000")
        os.chmod(self.dir, 0o777)
        code, text = self.status(61002, "--groups=61000", TACT_RUNTIME_GROUP="61000")
        self.assertEqual(code, 1, text)
        self.assertIn("belongs to user 61001", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
