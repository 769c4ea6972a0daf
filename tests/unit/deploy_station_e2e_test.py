#!/usr/bin/env python3
"""tact station as a program: setup and undo on a tree, station-tune, verify, and the readers of its report.

usage: deploy_station_e2e_test.py ROOT_OF_THE_PROJECT BIN_DIR WRITE_SMALL_SCENE
"""
import json
import os
import resource
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

ROOT, BIN, WRITER = sys.argv[1:4]
PATIENCE_S = 200


def snapshot(root):
    """Returns path -> (mode, content or target) of everything below root."""
    found = {}
    for folder, names, files in os.walk(root):
        for path in (os.path.join(folder, n) for n in names + files):
            mode = os.lstat(path).st_mode
            content = os.readlink(path) if stat.S_ISLNK(mode) else None
            if stat.S_ISREG(mode):
                with open(path, "rb") as f:
                    content = f.read()
            found[os.path.relpath(path, root)] = (mode, content)
    return found


def put(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)


def text_of(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = tempfile.mkdtemp(prefix="tact_station_")
        self.addCleanup(shutil.rmtree, self.dir)

    def tact(self, *arguments, code=0, **environment):
        env = dict(os.environ, TACT_RUNTIME_DIR=self.dir, **environment)
        done = subprocess.run([f"{BIN}/tact", *arguments], capture_output=True, text=True, env=env, timeout=PATIENCE_S, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout, done.stderr


class Setup(Case):
    def setUp(self):
        super().setUp()
        self.tree = f"{self.dir}/tree"
        put(f"{self.tree}/sys/devices/system/cpu/online", "0-3\n")
        put(f"{self.tree}/etc/default/grub", 'GRUB_CMDLINE_LINUX_DEFAULT="quiet"\n')
        put(f"{self.tree}/etc/group", "root:x:0:\n")
        self.before = snapshot(self.tree)

    def test_a_dry_run_prints_all_and_changes_nothing(self):
        out, _ = self.tact("station", "setup", "--root", self.tree, "--dry-run", "--user", "ann")
        for text in ("core 3 for the servo, cores 0-2 for all other work", "write: /etc/default/grub.d/tact.cfg", "run: update-grub",
                      "apt-get install", "usermod -aG tact ann"):
            self.assertIn(text, out)
        self.assertEqual(snapshot(self.tree), self.before)

    def test_setup_and_undo_with_no_command_run(self):
        report = json.loads(self.tact("station", "setup", "--root", self.tree, "--core", "1", "--json")[0])
        self.assertEqual((report["result"], report["core"]), ("done", 1))
        self.assertIn("update-grub", report["commands"])
        self.assertIn("isolcpus=managed_irq,domain,1 nohz_full=1 rcu_nocbs=1 irqaffinity=0,2-3",
                      text_of(f"{self.tree}/etc/default/grub.d/tact.cfg"))
        self.assertIn("nothing was changed", self.tact("station", "setup", "--root", self.tree, "--core", "1")[0])
        with open(f"{self.tree}/etc/default/grub.d/tact.cfg", "a", encoding="utf-8") as f:
            f.write("# mine\n")
        _, err = self.tact("station", "undo", "--root", self.tree, code=1)
        self.assertIn("tact.cfg was edited", err)
        self.tact("station", "undo", "--root", self.tree, "--force")
        self.assertEqual(snapshot(self.tree), self.before)
        self.assertIn("nothing to undo", self.tact("station", "undo", "--root", self.tree)[0])

    def test_wrong_usage_has_its_own_exit_code(self):
        self.tact("station", code=2)
        self.tact("station", "setup", "--root", f"{self.dir}/absent", code=2)
        self.assertIn("choose one of kernel", self.tact("station", "setup", "--root", self.tree, "--skip", "x", code=1)[1])
        self.assertIn("--dry-run", self.tact("station", "setup", "--help")[0])


class Tune(Case):
    def run_script(self, action, cores="1", code=0):
        done = subprocess.run([os.path.join(ROOT, "deploy/station-tune"), action], capture_output=True, text=True, check=False,
                              env=dict(os.environ, TACT_ROOT=self.dir, TACT_CORES=cores))
        self.assertEqual(done.returncode, code, done.stderr)

    def test_start_tunes_and_stop_restores_everything(self):
        cpu = f"{self.dir}/sys/devices/system/cpu"
        put(f"{cpu}/online", "0-2\n")
        for core in range(3):
            put(f"{cpu}/cpu{core}/cpufreq/scaling_governor", "powersave\n")
            put(f"{cpu}/cpu{core}/cpufreq/scaling_available_governors", "performance powersave\n")
            for state, latency in ((0, 0), (1, 2), (2, 33)):
                put(f"{cpu}/cpu{core}/cpuidle/state{state}/latency", f"{latency}\n")
                put(f"{cpu}/cpu{core}/cpuidle/state{state}/disable", "0\n")
        for irq, cores in ((9, "0-2"), (16, "0"), (17, "1")):
            put(f"{self.dir}/proc/irq/{irq}/smp_affinity_list", cores + "\n")
        before = snapshot(f"{self.dir}/sys"), snapshot(f"{self.dir}/proc")
        for _ in range(2):  # repeatable
            self.run_script("start")
        self.assertEqual(text_of(f"{cpu}/cpu0/cpufreq/scaling_governor"), "performance\n")
        self.assertEqual([text_of(f"{cpu}/cpu{c}/cpuidle/state{s}/disable").strip() for c in (0, 1) for s in (0, 1, 2)],
                         ["0", "0", "0", "0", "0", "1"])
        self.assertEqual([text_of(f"{self.dir}/proc/irq/{i}/smp_affinity_list").strip() for i in (9, 16, 17)],
                         ["0,2", "0", "0,2"])
        self.run_script("stop")
        self.assertEqual((snapshot(f"{self.dir}/sys"), snapshot(f"{self.dir}/proc")), before)
        self.run_script("stop")

    def test_wrong_usage(self):
        self.run_script("start", cores="1;reboot", code=2)
        self.run_script("start", cores="", code=2)
        self.run_script("restart", code=2)


def may_be_real_time():
    return os.geteuid() == 0 or resource.getrlimit(resource.RLIMIT_RTPRIO)[0] > 0


class Verify(Case):
    def test_the_report_of_a_short_run_is_complete_and_read_by_controller_and_metrics(self):
        scene, out = f"{self.dir}/small.tact", f"{self.dir}/report.json"
        subprocess.run([WRITER, scene], check=True)
        done = subprocess.run([f"{BIN}/tact", "station", "verify", "--minutes", "0.03", "--scene", scene, "--out", out],
                              env=dict(os.environ, TACT_RUNTIME_DIR=self.dir), capture_output=True, text=True,
                              timeout=PATIENCE_S, check=False)
        report = json.loads(text_of(out))
        self.assertEqual(done.returncode, 1 if report["status"] == "fail" else 0, done.stdout + done.stderr)
        self.assertIn(report["status"], ("pass", "warn", "fail"))
        worst = [s for s in ("fail", "warn", "pass") if s in [c["status"] for c in report["checks"]]][0]
        self.assertEqual(report["status"], worst)
        self.assertGreater(report["cycles"], 100)
        late = report["lateness_us"]
        self.assertTrue(0 <= late["p50"] <= late["p99"] <= late["p999"] <= late["max"])
        self.assertIn("lateness_p999", report["thresholds_us"])
        cyclictest = report["cyclictest"]
        if shutil.which("cyclictest") and may_be_real_time():
            self.assertRegex(cyclictest["text"], "after the controller|beside")
            self.assertGreater(cyclictest["max_us"], 0)
        else:  # missing or refused: reported, without a made-up value
            self.assertRegex(cyclictest["text"], "cyclictest")
            self.assertNotIn("max_us", cyclictest)
        self.assertTrue("count" in report["smi"] or report["smi"]["text"].startswith("not readable"))
        self.assertEqual(report["kernel"], f"{os.uname().release} {os.uname().version}")

        def log():
            return subprocess.run([f"{BIN}/tact-rt", scene, "--seconds", "0.1"], capture_output=True, text=True, check=True,
                                  env=dict(os.environ, TACT_RUNTIME_DIR=self.dir, TACT_STATION_REPORT=out)).stderr

        self.assertIn(f"station report: {report['status']}, 0 minutes old", log())
        self.assertIn("same machine and kernel", log())
        page, _ = self.tact("metrics", "--once", code=1, TACT_STATION_REPORT=out)  # without a running controller
        self.assertIn(f'tact_station_status{{session="default",status="{report["status"]}"}} 1', page)
        self.assertIn('tact_station_applies{session="default"} 1', page)
        put(out, "{}")
        self.assertRegex(log(), r"station report: .*report\.json: ")
        os.unlink(out)
        self.assertIn("station report: none", log())

    def test_a_controller_that_does_not_start_is_reported_with_its_own_message(self):
        config = f"{self.dir}/bad.toml"
        put(config, "[servo]\nnonsense = 1\n")
        scene = f"{self.dir}/small.tact"
        subprocess.run([WRITER, scene], check=True)
        _, err = self.tact("station", "verify", "--scene", scene, "--config", config, "--out", f"{self.dir}/r.json", code=1)
        self.assertIn("nonsense", err)
        # verify arms by itself, so it refuses a real arm that a person may hold.
        for text in ('[device]\ndriver = "phantom"\n', '[device]\ndriver = 3\n', 'device = {driver = "falcon"}\n',
                     '[device2]\ndriver = "openhaptics"\n'):
            put(config, text)
            _, err = self.tact("station", "verify", "--scene", scene, "--config", config, "--out", f"{self.dir}/r.json", code=1)
            self.assertIn("arms without a person", err)
        self.assertFalse(os.path.exists(f"{self.dir}/r.json"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
