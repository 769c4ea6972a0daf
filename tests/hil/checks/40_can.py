#!/usr/bin/env python3
"""A virtual CAN interface carries FD frames and error frames, and reports when it is down."""
import errno
import os
import socket
import struct
import subprocess

ERROR_FRAME, BUS_OFF, RAW_ERR_FILTER = 0x20000000, 0x40, 2  # linux/can.h, can/error.h, can/raw.h


def ip(*words):
    subprocess.run(["ip", *words], check=True, timeout=30)


def raw_socket():
    s = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
    s.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FD_FRAMES, 1)
    s.setsockopt(socket.SOL_CAN_RAW, RAW_ERR_FILTER, 0x1FFFFFFF)
    s.settimeout(30)
    s.bind(("vcan0",))
    return s


ip("link", "add", "vcan0", "type", "vcan")
ip("link", "set", "vcan0", "mtu", "72", "up")
a, b = raw_socket(), raw_socket()
BIT_RATE_SWITCH, FD_FORMAT = 1, 4  # the kernel adds the second by itself
sent = struct.pack("=IBB2x64s", 0x200, 64, BIT_RATE_SWITCH | FD_FORMAT, os.urandom(64))
assert a.send(sent) == 72 and b.recv(72) == sent
a.send(struct.pack("=IB3x8s", ERROR_FRAME | BUS_OFF, 8, bytes(8)))
assert struct.unpack_from("=I", b.recv(72))[0] == ERROR_FRAME | BUS_OFF
ip("link", "set", "vcan0", "down")
for s in (a, b):  # each socket reports it once, at its next call, even if the interface is up again by then
    try:
        s.recv(72)
        raise SystemExit("a read succeeded while the interface was down")
    except OSError as e:
        assert e.errno == errno.ENETDOWN, e
ip("link", "set", "vcan0", "up")
a.send(sent)
assert b.recv(72) == sent
print("64 bytes of CAN FD, an error frame, ENETDOWN while down, and up again")
