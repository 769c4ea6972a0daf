"""Shared parts of checks: tact-emu as a child, a client of an arm's board, and tact-rt as a child."""
import ctypes
import errno
import fcntl
import json
import os
import queue
import signal
import struct
import subprocess
import threading
import time
import zlib

PATIENCE_S = 100
CLAIM, BULK, CLEAR_HALT = 0x8004550F, 0xC0185502, 0x80045515  # USBDEVFS_*; BULK also does interrupt endpoints
ACCEL = os.environ.get("TACT_HIL_ACCEL", "kvm")
# Emulated, computation costs host time: no spinning, and 250 Hz unless the check is about the rate.
EMULATED = "[servo]\nspin_us = 0.0\nperiod_us = 4000.0\n"
# A busy host makes KVM's guests late and trips watchdogs; under KVM neither is an error.
TIMING_LATCHES = "real" if ACCEL == "tcg" else "never"
DEVICE_PRIORITY = 70  # of emulated hardware, above all programs
STATE, COMMAND, QUERY, INFO = 1, 2, 3, 4                      # packet kinds of hal/phantom/PROTOCOL.md


def soon(condition, patience_s, look_s=0.05):
    """Returns the first true value of condition(), or its value after patience_s."""
    end = time.monotonic() + patience_s
    while not (value := condition()) and time.monotonic() < end:
        time.sleep(look_s)
    return value


def wait_for(condition, what):
    """Returns the first true value of condition(); fails after PATIENCE_S."""
    value = soon(condition, PATIENCE_S)
    assert value, f"{what}: timed out after {PATIENCE_S} s"
    return value


def real_time(priority):
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))


class Child:
    """A child process whose output lines are collected; ends with this object."""

    def __init__(self, *command, lines_of="stdout", quiet=False, leave_out=(), priority=0):
        self.quiet, self.leave_out = quiet, leave_out  # not printed; lines with these words are dropped
        self.lines, self.seen, self.gone_by = queue.Queue(), [], []  # unread; parsed lines of the emulator; all
        pipes = {"stdout": None, "stderr": None, lines_of: subprocess.PIPE}
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, text=True, bufsize=1, **pipes,
                                        preexec_fn=(lambda: real_time(priority)) if priority else None)
        self.reader = threading.Thread(target=self._read, args=(getattr(self.process, lines_of),), daemon=True)
        self.reader.start()

    def _read(self, stream):
        for line in stream:
            if any(words in line for words in self.leave_out):
                continue
            if not self.quiet:
                print(line, end="", flush=True)
            self.gone_by.append(line)
            self.lines.put(line)
        self.lines.put(None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def said(self):
        """All output lines so far."""
        return list(self.gone_by)

    def end(self):
        """Ends the process with SIGTERM and returns its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise

    def send(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def next_line(self, what):
        try:
            line = self.lines.get(timeout=PATIENCE_S)
        except queue.Empty:
            raise AssertionError(f"{what}: no output within {PATIENCE_S} s") from None
        assert line is not None, f"{what}: the process ended with {self.process.wait(timeout=PATIENCE_S)}"
        return line


class Emulator(Child):
    """tact-emu with --json --orders; its lines are dictionaries."""

    def __init__(self, bin_dir, *words):
        super().__init__(f"{bin_dir}/tact-emu", *words, "--json", "--orders", priority=DEVICE_PRIORITY)
        self.until("state", "ready")

    def order(self, text):
        self.send(text)

    def until(self, what, detail=None, name=None):
        """Returns the next matching line; earlier lines are kept in self.seen."""
        while True:
            line = json.loads(self.next_line(f"tact-emu: {what} {detail}"))
            self.seen.append(line)
            if line["what"] == what and detail in (None, line["detail"]) and name in (None, line["name"]):
                return line

    def newest(self, what, name):
        """Returns (index, line) of the newest matching line; (-1, empty line) if there is none."""
        lines = self.said()
        for i in range(len(lines) - 1, -1, -1):
            if f'"{what}"' in lines[i]:
                line = json.loads(lines[i])
                if line["what"] == what and line["name"] == name:
                    return i, line
        return -1, {"detail": "", "states": 0, "commands": 0, "t_ns": 0}

    def status(self, name):
        self.order("status")
        return self.until("status", name=name)


def of_sysfs(folder, name):
    try:
        with open(f"/sys/bus/usb/devices/{folder}/{name}", encoding="utf-8") as f:
            return f.read().strip()
    except OSError:
        return ""


def find_board(serial):
    """Device node of the configured board with this serial, or None."""
    for d in os.listdir("/sys/bus/usb/devices"):
        if of_sysfs(d, "serial") != serial or of_sysfs(d, "bConfigurationValue") != "1":
            continue
        kind = [of_sysfs(f"{d}:1.0", n) for n in ("bInterfaceClass", "bInterfaceSubClass", "bInterfaceProtocol")]
        if kind == ["ff", "54", "01"] and of_sysfs(d, "speed") == "480":
            return f"/dev/bus/usb/{int(of_sysfs(d, 'busnum')):03}/{int(of_sysfs(d, 'devnum')):03}"
    return None


def sealed(head):
    return head + struct.pack("<I", zlib.crc32(head))


class Board:
    """A client of one emulated board, through usbfs like libusb."""

    def __init__(self, serial):
        self.node = wait_for(lambda: find_board(serial), f"board {serial}")
        self.fd = wait_for(self._open, f"opening {self.node}")
        self.sequence = 0

    def _open(self):
        try:
            fd = os.open(self.node, os.O_RDWR | os.O_CLOEXEC)
        except OSError:
            return None
        fcntl.ioctl(fd, CLAIM, bytearray(struct.pack("@I", 0)))
        return fd

    def close(self):
        os.close(self.fd)

    def transfer(self, endpoint, data, timeout_s=PATIENCE_S):
        buffer = ctypes.create_string_buffer(data, 64)
        request = struct.pack("@IIIP", endpoint, len(data) if data else 64, int(timeout_s * 1000),
                              ctypes.addressof(buffer))
        moved = fcntl.ioctl(self.fd, BULK, bytearray(request))
        return buffer.raw[:moved]

    def query(self):
        """Returns the Info packet: versions, boot, rate, watchdog, serial and model."""
        self.transfer(2, sealed(struct.pack("<HBBBB6x", 0x4154, 0, QUERY, 1, 1)))
        for _ in range(100):
            packet = self.transfer(0x81, b"")
            if packet[3] == INFO:
                break
        assert packet[3] == INFO and packet[60:] == struct.pack("<I", zlib.crc32(packet[:60])), packet
        low, high, boot, rate_hz, watchdog_ms, serial, model = struct.unpack_from("<BBHHH16s16s", packet, 4)
        self.boot = boot
        return {"versions": (low, high), "boot": boot, "rate_hz": rate_hz, "watchdog_ms": watchdog_ms,
                "serial": serial.rstrip(b"\0").decode(), "model": model.rstrip(b"\0").decode()}

    def state(self):
        """Returns the next state, valid or not."""
        packet = self.transfer(0x81, b"")
        magic, _, kind, sequence, time_us, seen = struct.unpack_from("<HBBIII", packet)
        counts = struct.unpack_from("<6i", packet, 16)
        bits, inputs, boot = struct.unpack_from("<HHH", packet, 52)
        good = (len(packet) == 64 and magic == 0x4154 and kind == STATE
                and packet[60:] == struct.pack("<I", zlib.crc32(packet[:60])))
        return {"good": good, "sequence": sequence, "time_us": time_us, "command_seen": seen, "counts": counts,
                "status": bits, "inputs": inputs, "boot": boot}

    def command(self, currents_ma, enable):
        self.sequence += 1
        self.transfer(2, sealed(struct.pack("<HBBII6hHH", 0x4154, 1, COMMAND, self.sequence, self.sequence,
                                            *currents_ma, 1 if enable else 0, self.boot)))

    def clear_halt(self):
        fcntl.ioctl(self.fd, CLEAR_HALT, bytearray(struct.pack("@I", 0x81)))


def said(call):
    """Returns the name of the OSError of call(), or ''."""
    try:
        call()
        return ""
    except OSError as e:
        return errno.errorcode[e.errno]


def text_of(path):
    with open(path, encoding="utf-8", errors="replace") as f:
        return f.read()


class Person(Child):
    """A person at the screen: send("arm"), send("reset"), send("disarm")."""

    def __init__(self, bin_dir):
        super().__init__(f"{bin_dir}/../tests/stand_in_person")
        while "attached" not in self.next_line("a person at the screen"):
            pass


class Controller(Child):
    """tact-rt as shipped, with hil.toml and the additional text `config`; prints its log."""

    def __init__(self, bin_dir, config, *words):
        path = "/run/check.toml"
        with open(path, "w", encoding="utf-8") as f:
            f.write(with_sections(text_of(os.path.join(os.path.dirname(os.path.abspath(__file__)), "hil.toml")),
                                  EMULATED if ACCEL == "tcg" else "", config))
        super().__init__(f"{bin_dir}/tact-rt", "/out/small.tact", "--config", path, *words, lines_of="stderr",
                         leave_out=("overrun", "force limited", "torque limited"))
        self.tact = f"{bin_dir}/tact"

    def status(self):
        """Returns the JSON of tact status; {} before the controller is up."""
        assert self.process.poll() is None, f"tact-rt ended with {self.process.returncode}"
        done = subprocess.run([self.tact, "status", "--json"], capture_output=True, text=True, timeout=PATIENCE_S)
        return json.loads(done.stdout) if done.returncode == 0 else {}

    def wait_for(self, condition, what):
        """Returns the first status that fulfils the condition."""
        end = time.monotonic() + PATIENCE_S
        while not condition(now := self.status()):
            assert time.monotonic() < end, f"{what}: timed out after {PATIENCE_S} s: {now}"
            time.sleep(0.1)
        return now

    def until(self, words):
        """Returns the next line of its log that contains `words`."""
        while words not in (line := self.next_line(f"tact-rt: {words}")):
            pass
        return line

    def state(self):
        """The newest state in its log; the initial state ready is not logged."""
        changes = [line.rsplit(" to ", 1)[1].strip() for line in self.said() if "state changed:" in line]
        return changes[-1] if changes else "ready"

    def servo(self):
        """The /proc folder of the servo thread."""
        for tid in os.listdir(f"/proc/{self.process.pid}/task"):
            if text_of(f"/proc/{self.process.pid}/task/{tid}/comm").strip() == "servo":
                return f"/proc/{self.process.pid}/task/{tid}"
        raise AssertionError("no servo thread")

    def watch_servo(self, looks=100):
        """Asserts that the servo thread runs on its core and only sleeps and computes: no read, write or ioctl."""
        folder = self.servo()
        io = [line for line in text_of(f"{folder}/io").splitlines() if line.startswith(("syscr", "syscw"))]
        calls = {text_of(f"{folder}/syscall").split()[0] for _ in range(looks)}
        assert calls <= {"running", "230"}, f"system calls of the servo thread: {calls}"  # 230: clock_nanosleep
        after = [line for line in text_of(f"{folder}/io").splitlines() if line.startswith(("syscr", "syscw"))]
        assert io == after, (io, after)
        assert text_of(f"{folder}/stat").rsplit(")", 1)[1].split()[36] == "1", "the servo thread is not on core 1"
        assert os.sched_getscheduler(int(folder.rsplit("/", 1)[1])) == os.SCHED_FIFO


def with_sections(*texts):
    """Merges TOML texts; keys of later texts overwrite those of earlier ones."""
    sections = {}
    for text in texts:
        name = ""
        for line in text.splitlines():
            if line.startswith("["):
                name = line.split("]")[0] + "]"
            elif "=" in line:
                sections.setdefault(name, {})[line.split("=")[0].strip()] = line
    return "\n".join("\n".join([name, *keys.values()]) for name, keys in sections.items()) + "\n"


def unhurt(status):
    """Asserts that the servo had no allocations, locks or page faults."""
    servo = status["servo"]
    assert servo["allocations"] == 0 and servo["locks"] == 0 and servo["page_faults"] == 0, servo
