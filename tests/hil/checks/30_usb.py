#!/usr/bin/env python3
"""A program emulates a USB device (FunctionFS on dummy_hcd), and another uses it through usbfs, as libusb does."""
import ctypes
import errno
import fcntl
import os
import struct
import sys
import threading
import time

GADGET, FFS = "/sys/kernel/config/usb_gadget/check", "/run/ffs"
VENDOR_CLASS, INTERRUPT, EP_IN = 0xFF, 3, 0x80
PATIENCE_S = 30
CLAIM, BULK = 0x8004550F, 0xC0185502  # USBDEVFS_CLAIMINTERFACE, USBDEVFS_BULK (also does interrupt endpoints)


def put(path, text):
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)


def of_sysfs(folder, name):
    try:
        with open(f"/sys/bus/usb/devices/{folder}/{name}", encoding="utf-8") as f:
            return f.read().strip()
    except OSError:
        return ""


def descriptors():
    """One vendor interface, 64 bytes in on endpoint 1 and out on endpoint 2, for full and high speed."""
    speeds = b""
    for interval in (1, 4):  # 1 ms at either speed
        speeds += struct.pack("<BBBBBBBBB", 9, 4, 0, 0, 2, VENDOR_CLASS, 0, 0, 1)
        for address in (1 | EP_IN, 2):
            speeds += struct.pack("<BBBBHB", 7, 5, address, INTERRUPT, 64, interval)
    return struct.pack("<IIIII", 3, 20 + len(speeds), 1 | 2, 3, 3) + speeds  # version 2; has full and high speed


def transfer(device, endpoint, data):
    """One transfer; returns the number of bytes moved and the buffer."""
    buffer = ctypes.create_string_buffer(data, 64)
    request = struct.pack("@IIIP", endpoint, 64, PATIENCE_S * 1000, ctypes.addressof(buffer))
    return fcntl.ioctl(device, BULK, bytearray(request)), buffer.raw


def main():
    for folder in (GADGET, f"{GADGET}/strings/0x409", f"{GADGET}/configs/c.1", f"{GADGET}/functions/ffs.check", FFS):
        os.mkdir(folder)
    put(f"{GADGET}/idVendor", "0x1209")  # pid.codes, for tests
    put(f"{GADGET}/idProduct", "0x0001")
    put(f"{GADGET}/strings/0x409/product", "check")
    os.symlink(f"{GADGET}/functions/ffs.check", f"{GADGET}/configs/c.1/ffs.check")
    assert ctypes.CDLL(None, use_errno=True).mount(b"check", FFS.encode(), b"functionfs", 0, None) == 0
    ep0 = os.open(f"{FFS}/ep0", os.O_RDWR)
    os.write(ep0, descriptors())
    os.write(ep0, struct.pack("<IIII", 2, 16 + 2 + 6, 1, 1) + struct.pack("<H", 0x409) + b"check\0")
    to_host, from_host = os.open(f"{FFS}/ep1", os.O_RDWR), os.open(f"{FFS}/ep2", os.O_RDWR)
    put(f"{GADGET}/UDC", os.listdir("/sys/class/udc")[0])  # plug

    end, found = time.monotonic() + PATIENCE_S, []
    while not found and time.monotonic() < end:
        time.sleep(0.1)
        found = [d for d in os.listdir("/sys/bus/usb/devices") if of_sysfs(d, "product") == "check"
                 and of_sysfs(d, "bConfigurationValue") == "1"]
    assert found, os.listdir("/sys/bus/usb/devices")
    node = f"/dev/bus/usb/{int(of_sysfs(found[0], 'busnum')):03}/{int(of_sysfs(found[0], 'devnum')):03}"
    print(node, *(of_sysfs(found[0], n) for n in ("idVendor", "idProduct", "product", "speed")))

    def echo():  # the device: answers each packet with its bytes reversed
        for _ in range(20):
            os.write(to_host, os.read(from_host, 64)[::-1])

    device = os.open(node, os.O_RDWR)
    fcntl.ioctl(device, CLAIM, bytearray(struct.pack("@I", 0)))
    threading.Thread(target=echo, daemon=True).start()
    for i in range(20):
        sent = bytes([i]) + os.urandom(63)
        assert transfer(device, 2, sent)[0] == 64
        assert transfer(device, 1 | EP_IN, b"") == (64, sent[::-1])

    put(f"{GADGET}/UDC", "\n")  # unplug
    said = []  # the first transfer may coincide with the unplug
    end = time.monotonic() + PATIENCE_S
    while "ENODEV" not in said:
        assert time.monotonic() < end, said
        try:
            transfer(device, 1 | EP_IN, b"")
            sys.exit("a transfer succeeded after the unplug")
        except OSError as e:
            said.append(errno.errorcode[e.errno])
    print(f"20 packets of 64 bytes each way, then unplugged: {', '.join(sorted(set(said)))}")


if __name__ == "__main__":
    main()
