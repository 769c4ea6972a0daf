#!/usr/bin/env python3
"""A program emulates a CP2112 USB adapter (uhid), for which the kernel's driver makes a gpiochip; one line is written, one read."""
import fcntl
import os
import select
import struct
import threading
import time

CREATE2, DESTROY, GET_REPORT, GET_REPLY, SET_REPORT, SET_REPLY = 11, 1, 9, 10, 13, 14  # linux/uhid.h
GET_HANDLE, GET_VALUES, SET_VALUES, INFO = 0xC16CB403, 0xC040B408, 0xC040B409, 0x8044B401  # linux/gpio.h, first API
INPUT, OUTPUT = 1, 2
REPORTS = bytes((0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08)) + b"".join(
    bytes((0x85, number, 0x95, size, 0x09, 1, kind, 2)) for number, size, kind in (
        (2, 4, 0xB1), (3, 1, 0xB1), (4, 2, 0xB1), (5, 2, 0xB1), (6, 13, 0xB1), (0x20, 1, 0xB1),  # features
        (0x13, 63, 0x81), (0x10, 63, 0x91))) + b"\xc0"


class Adapter:
    """Eight lines; output line 4 is connected to input line 0 with inversion."""

    def __init__(self):
        self.out = self.direction = 0
        self.fd = os.open("/dev/uhid", os.O_RDWR)
        os.write(self.fd, struct.pack("=I128s64s64sHHIIII4096s", CREATE2, b"check CP2112", b"", b"", len(REPORTS), 3,
                                      0x10C4, 0xEA90, 0, 0, REPORTS))
        threading.Thread(target=self.serve, daemon=True).start()

    def answer(self, number):
        lines = (self.out & self.direction) | (0 if self.out & 0x10 else 1)
        return {2: bytes((2, self.direction, 0xFF, 0, 0)), 3: bytes((3, lines)), 5: bytes((5, 0x0C, 2)),
                6: bytes((6, 0, 0, 0, 0x64)) + bytes(9)}.get(number, bytes((number, 0)))

    def serve(self):
        while True:
            select.select([self.fd], [], [])
            event = os.read(self.fd, 4380)
            kind, identity, number = struct.unpack_from("=IIB", event)
            if kind == GET_REPORT:
                data = self.answer(number)
                os.write(self.fd, struct.pack("=IIHH4096s", GET_REPLY, identity, 0, len(data), data))
            elif kind == SET_REPORT:
                data = event[12:]
                if number == 2:
                    self.direction = data[1]
                elif number == 4:
                    self.out = (self.out & ~data[2]) | (data[1] & data[2])
                os.write(self.fd, struct.pack("=IIH", SET_REPLY, identity, 0))


def chip_of(label):
    for name in os.listdir("/dev"):
        if name.startswith("gpiochip"):
            fd = os.open("/dev/" + name, os.O_RDWR)
            _, own, lines = struct.unpack("32s32sI", fcntl.ioctl(fd, INFO, bytes(68)))
            if own.rstrip(b"\0").decode() == label:
                return fd, name, lines
            os.close(fd)
    return None


def line(chip, offset, flags):
    request = struct.pack("I252xI64s32sIi", offset, flags, bytes(64), b"check", 1, 0)
    return struct.unpack_from("i", fcntl.ioctl(chip, GET_HANDLE, request), 360)[0]


adapter = Adapter()
end = time.monotonic() + 60
while (found := chip_of("cp2112_gpio")) is None:
    assert time.monotonic() < end, "no gpiochip appeared"
    time.sleep(0.1)
chip_fd, chip_name, count = found
drive, sense = line(chip_fd, 4, OUTPUT), line(chip_fd, 0, INPUT)
for i in range(20):
    fcntl.ioctl(drive, SET_VALUES, bytes((i & 1,)) + bytes(63))
    assert fcntl.ioctl(sense, GET_VALUES, bytes(64))[0] == 1 - (i & 1), f"round {i}"
os.write(adapter.fd, struct.pack("=I", DESTROY))
print(f"{chip_name} of {count} lines by the kernel's hid-cp2112; 20 times written and read back")
