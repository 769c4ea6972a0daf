"""What several checks share: tact-emu as a child, an arm's board as a client meets it, and tact-rt as a child."""
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
CLAIM, BULK, CLEAR_HALT = 0x8004550F, 0xC0185502, 0x80045515  # USBDEVFS_*; BULK does interrupt endpoints too
STATE, COMMAND, QUERY, INFO = 1, 2, 3, 4                      # kinds of hal/phantom/PROTOCOL.md


def wait_for(condition, what):
    """The first true value of condition()."""
    end = time.monotonic() + PATIENCE_S
    while not (value := condition()):
        assert time.monotonic() < end, f"{what}: not within {PATIENCE_S} s"
        time.sleep(0.05)
    return value


class Child:
    """A program whose lines are gathered, and that ends with this object."""

    def __init__(self, *command, lines_of="stdout"):
        self.lines, self.seen = queue.Queue(), []
        pipes = {"stdout": None, "stderr": None, lines_of: subprocess.PIPE}
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, text=True, bufsize=1, **pipes)
        self.reader = threading.Thread(target=self._read, args=(getattr(self.process, lines_of),), daemon=True)
        self.reader.start()

    def _read(self, stream):
        for line in stream:
            print(line, end="", flush=True)
            self.lines.put(line)
        self.lines.put(None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self):
        """Its exit code after SIGTERM."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise

    def next_line(self, what):
        try:
            line = self.lines.get(timeout=PATIENCE_S)
        except queue.Empty:
            raise AssertionError(f"{what}: nothing more said within {PATIENCE_S} s") from None
        assert line is not None, f"{what}: it ended with {self.process.wait(timeout=PATIENCE_S)}"
        return line


class Emulator(Child):
    """tact-emu with --json --orders; its lines are dictionaries."""

    def __init__(self, bin_dir, *words):
        super().__init__(f"{bin_dir}/tact-emu", *words, "--json", "--orders")
        self.until("state", "ready")

    def order(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def until(self, what, detail=None, name=None):
        """The next line that says so; the ones before it are kept in self.seen."""
        while True:
            line = json.loads(self.next_line(f"tact-emu: {what} {detail}"))
            self.seen.append(line)
            if line["what"] == what and detail in (None, line["detail"]) and name in (None, line["name"]):
                return line

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
    """Device node of the configured board of that serial, or None."""
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
    """A client of one emulated board, through usbfs as libusb does it."""

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
        """Info: the versions, boot, rate, watchdog, serial and model."""
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
        """The next state, good or not."""
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
    """The name of the error that call() meets, or ''."""
    try:
        call()
        return ""
    except OSError as e:
        return errno.errorcode[e.errno]
