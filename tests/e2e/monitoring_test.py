#!/usr/bin/env python3
"""Runs a real Prometheus with the shipped rules: the first fault of a real controller fires TactFault, SIGKILL fires TactControllerDown.

usage: monitoring_test.py BIN_DIR WRITE_SMALL_SCENE   (from the root of the project)

Exit code 77 (skipped): Prometheus is not available. Takes about half a minute; uses only the loopback interface.
"""
import ctypes
import glob
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

RULES = os.path.abspath("deploy/monitoring/tact_rules.yml")
PATIENCE_S = 25.0
LIMIT_S = 85.0
BEGAN = time.monotonic()


def find_prometheus():
    """Finds Prometheus in PATH, or unpacks it with deploy/shell/packages.sh, because installing the package would start a server."""
    if (found := shutil.which("prometheus")):
        return found
    if (found := glob.glob("build/tools/prometheus/**/bin/prometheus", recursive=True)):
        return os.path.abspath(found[0])
    done = subprocess.run(["bash", "-c", ". deploy/shell/packages.sh; tact_unpack_tool prometheus prometheus"], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return os.path.join(done.stdout.strip(), "prometheus")
    print("skipped: prometheus is not in PATH and cannot be unpacked:", done.stderr.strip() or "TACT_NO_INSTALL=1")
    sys.exit(77)


def die_with_parent():
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def get(url):
    # Ignores the proxies of the environment.
    with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(url, timeout=5) as answer:
        return answer.read().decode()


class Station:
    def __init__(self, bin_dir, writer, folder):
        self.bin, self.folder = bin_dir, folder
        self.env = dict(os.environ, TACT_RUNTIME_DIR=folder)
        self.scene, self.config = os.path.join(folder, "small.tact"), os.path.join(folder, "tact.toml")
        subprocess.run([writer, self.scene], check=True)
        with open(self.config, "w", encoding="utf-8") as f:
            f.write('[lines]\ndriver = "sim"\n')  # SIGUSR1 presses the emergency stop
        self.running = []
        self.exporter_port, self.prometheus_port = free_port(), free_port()

    def start(self, name, *words):
        log = open(os.path.join(self.folder, name + ".log"), "ab")
        child = subprocess.Popen(words, env=self.env, stdout=log, stderr=log, cwd=self.folder, preexec_fn=die_with_parent)
        self.running.append(child)
        return child

    def controller(self):
        return self.start("controller", os.path.join(self.bin, "tact-rt"), self.scene, "--config", self.config, "--priority", "0", "--arm")

    def exporter(self):
        return self.start("exporter", os.path.join(self.bin, "tact"), "metrics", "--port", str(self.exporter_port))

    def prometheus(self, program):
        config = os.path.join(self.folder, "prometheus.yml")
        with open(config, "w", encoding="utf-8") as f:
            json.dump({"global": {"scrape_interval": "1s", "evaluation_interval": "1s"}, "rule_files": [RULES],
                       "scrape_configs": [{"job_name": "tact", "static_configs": [{"targets": ["127.0.0.1:%d" % self.exporter_port]}]}]}, f)
        return self.start("prometheus", program, "--config.file=" + config, "--storage.tsdb.path=" + os.path.join(self.folder, "data"),
                          "--web.listen-address=127.0.0.1:%d" % self.prometheus_port)

    def page(self):
        return get("http://127.0.0.1:%d/metrics" % self.exporter_port)

    def ask(self, path):
        return json.loads(get("http://127.0.0.1:%d/api/v1/%s" % (self.prometheus_port, path)))["data"]

    def samples(self, series):
        """Number of samples of the series in Prometheus."""
        result = self.ask("query?query=" + urllib.request.quote("count_over_time(%s[5m])" % series))["result"]
        return max([int(r["value"][1]) for r in result], default=0)

    def alert(self, name):
        """State and labels of the alert; None: neither pending nor firing."""
        return next(((a["state"], a["labels"]) for a in self.ask("alerts")["alerts"] if a["labels"]["alertname"] == name), None)

    def wait(self, what, true):
        end = min(time.monotonic() + PATIENCE_S, BEGAN + LIMIT_S)
        while True:
            try:
                if (now := true()):
                    print("%5.1f s  %s" % (time.monotonic() - BEGAN, what), flush=True)
                    return now
            except (urllib.error.URLError, ConnectionError, TimeoutError):
                pass
            if time.monotonic() > end:
                self.fail(what + ": timed out")
            time.sleep(0.2)

    def fail(self, what):
        print("FAILED", what)
        for name in ("controller", "exporter", "prometheus"):
            path = os.path.join(self.folder, name + ".log")
            if os.path.exists(path):
                with open(path, errors="replace", encoding="utf-8") as f:
                    print("--- %s\n%s" % (name, f.read()[-2000:]))
        try:
            print("--- page\n" + "".join(line + "\n" for line in self.page().splitlines() if "faults" in line or "tact_up" in line))
            print("--- alerts\n", self.ask("alerts")["alerts"])
        except OSError:
            pass
        sys.exit(1)

    def end(self):
        for child in self.running:
            child.kill()
            child.wait()


def story(s, program):
    # The least favourable order: nothing was scraped before the controller runs.
    controller = s.controller()
    s.exporter()
    s.wait("the exporter reports the controller", lambda: 'tact_up{session="default"} 1\n' in s.page())
    s.prometheus(program)
    s.wait("Prometheus has scraped twice", lambda: s.samples("tact_up") >= 2)
    if s.alert("TactFault") or s.alert("TactControllerDown"):
        s.fail("an alert fired before the first fault")

    controller.send_signal(signal.SIGUSR1)
    s.wait("the exporter counts the fault", lambda: 'cause="emergency_stop"} 1\n' in s.page())
    state, labels = s.wait("TactFault fires", lambda: (a := s.alert("TactFault")) and a[0] == "firing" and a)
    if labels["cause"] != "emergency_stop" or labels["severity"] != "critical" or labels["session"] != "default":
        s.fail("TactFault has unexpected labels: %s" % labels)
    if s.alert("TactControllerDown"):
        s.fail("TactControllerDown fired while the controller runs")

    controller.kill()
    s.wait("TactControllerDown is pending", lambda: s.alert("TactControllerDown"))
    s.wait("TactControllerDown fires", lambda: (a := s.alert("TactControllerDown")) and a[0] == "firing")

    second = s.controller()
    s.wait("a new controller ends the alert", lambda: not s.alert("TactControllerDown"))
    if 'cause="emergency_stop"} 1\n' not in s.page():
        s.fail("the new controller did not continue the fault count")
    second.send_signal(signal.SIGTERM)
    if second.wait(PATIENCE_S) != 0:
        s.fail("the controller's exit code is not 0")
    s.wait("the exporter reports the orderly end", lambda: 'tact_controller_ended_in_order{session="default"} 1\n' in s.page())
    # Longer than the time for which the rule stays inactive.
    s.wait("Prometheus has five samples of the orderly end",
           lambda: s.ask("query?query=" + urllib.request.quote("sum_over_time(tact_controller_ended_in_order[5m]) >= 5"))["result"])
    if s.alert("TactControllerDown"):
        s.fail("TactControllerDown fired after an orderly end")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program = find_prometheus()
    folder = tempfile.mkdtemp(prefix="tact_monitoring_")
    station = Station(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), folder)
    try:
        story(station, program)
    finally:
        station.end()
        shutil.rmtree(folder, ignore_errors=True)
    print("passed")


main()
