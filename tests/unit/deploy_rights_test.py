#!/usr/bin/env python3
"""The udev rules cover the devices in the code; files installed by --rights; can-up brings a bus up.

usage: deploy_rights_test.py ROOT_OF_THE_PROJECT
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = sys.argv.pop(1)
RULES = os.path.join(ROOT, "deploy/60-tact.rules")
TOKEN = re.compile(r'([A-Z_]+(?:\{[A-Za-z_]+\})?)(==|!=|\+=|-=|:=|=)"([^"]*)"(?:,\s*|$)')
MATCHES = {"ACTION", "SUBSYSTEM", "SUBSYSTEMS", "KERNEL", "ATTR", "ATTRS", "ENV"}
SETS = {"GROUP": "=", "MODE": "=", "TAG": "+=", "ENV": "+=", "GOTO": "=", "LABEL": "="}


def text(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as f:
        return f.read()


def rules():
    """Returns [{key: [(operator, value)]}] of each line; a line that does not parse is an error."""
    out = []
    for line in text("deploy/60-tact.rules").splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        rest, rule = line, {}
        while rest:
            m = TOKEN.match(rest)
            assert m, f"cannot read {rest!r}"
            rule.setdefault(m[1], []).append((m[2], m[3]))
            rest = rest[m.end():]
        out.append(rule)
    return out


def value(rule, *keys):
    for key in keys:
        if key in rule:
            return rule[key][0][1]
    return None


class Rules(unittest.TestCase):
    def test_every_line_has_only_keys_and_operators_of_udev(self):
        labels = {value(r, "LABEL") for r in rules()}
        for rule in rules():
            for key, uses in rule.items():
                base = key.split("{")[0]
                for operator, _ in uses:
                    if operator in ("==", "!="):
                        self.assertIn(base, MATCHES, rule)
                    else:
                        self.assertEqual(SETS.get(base), operator, rule)
            if "GOTO" in rule:
                self.assertIn(value(rule, "GOTO"), labels)

    def test_only_the_two_groups_get_access(self):
        granting = [r for r in rules() if "MODE" in r or "GROUP" in r]
        self.assertGreater(len(granting), 5)
        for rule in granting:
            self.assertEqual(value(rule, "MODE"), "0660", rule)
            self.assertIn(value(rule, "GROUP"), ("tact", "realtime"), rule)
            self.assertIn("SUBSYSTEM", rule)  # no rule without a subsystem

    def test_the_devices_are_those_of_the_code(self):
        table = re.findall(r'KnownDevice\{Use::(\w+), "[^"]*", "[^"]*", (\w+), (\w+)', text("hal/probe/known_devices.hpp"))
        # A row for any product is a rule without a product.
        named = dict(re.findall(r"constexpr std::uint16_t (k\w+) = (\w+);", text("hal/probe/known_devices.hpp")))
        table = [(use, v, named.get(p, p)) for use, v, p in table]
        arms = {(v[2:], p[2:] if p != "0" else None) for use, v, p in table if use == "arm" and v != "0"}
        self.assertIn(("1451", None), arms)
        adapters = {(v[2:], p[2:]) for use, v, p in table if use == "lines"}
        self.assertTrue(arms and adapters)
        seen = {}
        for rule in rules():
            ids = (value(rule, "ATTR{idVendor}", "ATTRS{idVendor}"), value(rule, "ATTR{idProduct}", "ATTRS{idProduct}"))
            if ids[0]:
                seen.setdefault(value(rule, "SUBSYSTEM"), set()).add(ids)
        self.assertEqual(seen["usb"], arms)
        self.assertEqual(seen["gpio"], adapters)
        self.assertLessEqual(seen["hidraw"] | seen["tty"], arms)

    def test_a_board_is_matched_by_the_interface_of_its_protocol(self):
        row = re.search(r"class 0x(\w\w), subclass 0x(\w\w), protocol 0x(\w\w)", text("hal/phantom/PROTOCOL.md"))
        triple = "".join(row.groups()).lower()
        self.assertIn(f"kPhantomInterface = 0x{triple.upper()};", text("hal/probe/known_devices.hpp"))
        self.assertIn(f"*:{triple}:*", [value(r, "ENV{ID_USB_INTERFACES}") for r in rules()])

    def test_udevadm_verify_accepts_the_rules(self):
        udevadm = shutil.which("udevadm")
        if not udevadm or subprocess.run([udevadm, "verify", "--help"], capture_output=True, check=False).returncode:
            self.skipTest("udevadm verify is missing")
        # A group missing on this machine is not an error of the rules.
        done = subprocess.run([udevadm, "verify", "--resolve-names=never", RULES], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Install(unittest.TestCase):
    def setUp(self):
        self.into = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.into)

    def test_the_files_are_installed_where_they_are_read(self):
        subprocess.run([os.path.join(ROOT, "deploy/install.sh"), "--rights", "--into", self.into], check=True)
        for source, target in (("60-tact.rules", "etc/udev/rules.d/60-tact.rules"),
                               ("limits.conf", "etc/security/limits.d/tact.conf"),
                               ("tact-can@.service", "etc/systemd/system/tact-can@.service"),
                               ("can-up", "usr/local/lib/tact/can-up")):
            with open(os.path.join(self.into, target), encoding="utf-8") as f:
                self.assertEqual(f.read(), text("deploy/" + source))
        unit = text("deploy/tact-can@.service")
        program = re.search(r"^ExecStart=(\S+) %i$", unit, re.M)[1]
        self.assertTrue(os.access(self.into + program, os.X_OK))
        self.assertIn("tact-can@$name.service", text("deploy/60-tact.rules"))

    def test_wrong_usage_is_refused_and_sourcing_it_installs_nothing(self):
        script = os.path.join(ROOT, "deploy/install.sh")
        self.assertEqual(subprocess.run([script, "--wrong"], capture_output=True, check=False).returncode, 1)
        self.assertEqual(subprocess.run([script, "--help"], capture_output=True, check=False).returncode, 0)
        done = subprocess.run(["bash", "-c", f". '{script}' && type tact_install_rights >/dev/null"], capture_output=True,
                              text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (0, ""))


class CanUp(unittest.TestCase):
    """can-up with a stub of `ip` that records its arguments, and fails for those in FAILS."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        for name, kind in (("can0", 280), ("eth0", 1)):
            os.makedirs(f"{self.folder}/net/{name}")
            with open(f"{self.folder}/net/{name}/type", "w", encoding="utf-8") as f:
                f.write(f"{kind}\n")
        os.mkdir(f"{self.folder}/bin")
        with open(f"{self.folder}/bin/ip", "w", encoding="utf-8") as f:
            f.write(f'#!/bin/sh\necho "$*" >>{self.folder}/asked\n'
                    'case "$*" in *details*) echo "$KIND"; exit ;; *"${FAILS:-nothing at all}"*) exit 2 ;; esac\n')
        os.chmod(f"{self.folder}/bin/ip", 0o755)

    def run_it(self, *words, fails="", kind="can state STOPPED"):
        env = dict(os.environ, PATH=f"{self.folder}/bin:{os.environ['PATH']}", TACT_SYS_NET=f"{self.folder}/net",
                   FAILS=fails, KIND=kind)
        done = subprocess.run([os.path.join(ROOT, "deploy/can-up"), *words], env=env, capture_output=True, text=True,
                              check=False)
        try:
            with open(f"{self.folder}/asked", encoding="utf-8") as f:
                asked = f.read()
        except FileNotFoundError:
            asked = ""
        return done, asked

    def test_the_rates_are_those_of_the_tracker_and_bus_off_ends_by_itself(self):
        done, asked = self.run_it("can0")
        self.assertEqual((done.returncode, done.stdout), (0, "can0: up, 1 Mbit/s, CAN FD at 5 Mbit/s\n"))
        self.assertIn("type can bitrate 1000000 dbitrate 5000000 fd on restart-ms 100", asked)
        self.assertTrue(asked.startswith("link set can0 down\n") and asked.endswith("link set can0 up\n"))

    def test_without_fd_or_on_request_the_bus_runs_classic(self):
        for words, fails in ((("can0",), "fd on"), (("can0", "--classic"), "")):
            done, asked = self.run_it(*words, fails=fails)
            self.assertEqual((done.returncode, done.stdout), (0, "can0: up, 1 Mbit/s, classic\n"))
            self.assertIn("type can bitrate 1000000 restart-ms 100\n", asked)

    def test_a_virtual_bus_gets_room_for_long_frames_and_no_rate(self):
        done, asked = self.run_it("can0", kind="vcan")
        self.assertEqual((done.returncode, done.stdout), (0, "can0: up, virtual\n"))
        self.assertIn("mtu 72", asked)
        self.assertNotIn("bitrate", asked)

    def test_failures_and_wrong_names_are_reported(self):
        self.assertEqual(self.run_it("can0", fails="up")[0].returncode, 2)
        self.assertEqual(self.run_it("can0", fails="bitrate")[0].returncode, 1)
        done, _ = self.run_it("eth0")
        self.assertEqual(done.returncode, 1)
        self.assertIn("name one of: can0", done.stderr)
        for words in ((), ("--classic",), ("../can0",), ("can0", "--fast"), ("can0 up",), ("a", "b", "c")):
            self.assertEqual(self.run_it(*words)[0].returncode, 2, words)


unittest.main()
