#!/usr/bin/env python3
"""tact-rt with a head tracker of four sensors on vcan: classic and FD, and all faults of the bus.

usage: 45_tracker.py BIN_DIR. The head is frozen, lost and found again; the force is unaffected.
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import parts

BIN = sys.argv[1]
IFACE = "vcan1"
RATE_HZ = 240
CONFIG = """
[tracker]
driver = "can"
interface = "{iface}"
format = "{format}"
sensors = 4
head_sensor = 2
rate_hz = {rate}
"""


def ip(*words):
    subprocess.run(["ip", *words], check=True, timeout=30)


def make_interface():
    ip("link", "add", IFACE, "type", "vcan")
    ip("link", "set", IFACE, "mtu", "72", "up")


def head_is(state, link=None):
    return lambda s: s.get("head") and s["head"]["state"] == state and link in (None, s["head"]["link"])


def works(rt, after=0):
    """Returns the sequence number of a sample newer than `after`; asserts that the head is in front of the screen and the force is on."""
    now = rt.wait_for(lambda s: s.get("head") and s["head"]["sequence"] > after and s["head"]["link"] == "up"
                      and s["head"]["state"] == "fresh", "a moving head")
    x, y, z = now["head"]["pos_screen_m"]
    assert abs(x) < 0.6 and abs(y) < 0.6 and 0.2 < z < 1.2, now["head"]
    assert now["state"] == "active", (now["state"], now["reason"])
    return now["head"]["sequence"]


def session(form, faults):
    config = CONFIG.format(iface=IFACE, format=form, rate=float(RATE_HZ))
    with parts.Emulator(BIN, "--tracker", f"{IFACE}:{form}:{RATE_HZ}:4") as emulator, \
            parts.Controller(BIN, config, "--arm") as rt:
        rt.wait_for(lambda s: s.get("state") == "active", "active")
        seen = works(rt)
        seen = works(rt, seen)
        faults(emulator, rt, seen)
        rt.watch_servo()
        now = rt.status()
        assert now["state"] == "active" and now["servo"]["cycles"] > 0, now
        parts.unhurt(now)
        assert not [line for line in rt.said() if "tact-rt error" in line], "tact-rt logged an error"
        assert rt.end() == 0
        return now["servo"]["cycles"]


def everything(emulator, rt, seen):
    def well_again(order="tracker well"):
        emulator.order(order)
        return works(rt, rt.status()["head"]["sequence"])

    for fault in ("tracker silent", "tracker nan", "tracker corrupt", "tracker out-of-range"):
        emulator.order(fault)
        rt.wait_for(head_is("lost", "up"), f"{fault}: lost")
        seen = well_again()
    emulator.order("tracker flood")  # the newest frame is repeated; head tracking continues
    before = rt.status()
    works(rt, before["head"]["sequence"] + 10)
    rt.wait_for(lambda s: s["servo"]["cycles"] > before["servo"]["cycles"] + 20, "cycles in the flood")
    seen = well_again()
    emulator.order("can bus-off")
    rt.wait_for(head_is("lost", "bus off"), "bus off")
    seen = well_again()
    emulator.order("can down")
    rt.wait_for(head_is("lost", "down"), "down")
    seen = well_again("can up")
    ip("link", "del", IFACE)  # the adapter is unplugged
    rt.wait_for(head_is("lost", "gone"), "gone")
    make_interface()
    emulator.until("link", "found again")
    works(rt, seen)


def a_moment(emulator, rt, seen):
    emulator.order("tracker silent")
    rt.wait_for(head_is("lost"), "silent: lost")
    emulator.order("tracker well")
    works(rt, seen)


make_interface()
cycles = session("fd", everything) + session("classic", a_moment)
ip("link", "del", IFACE)
print(f"four sensors, {RATE_HZ} Hz, FD and classic; after silence, NaN, corrupt, out of range, flood, bus off, down, gone the "
      f"head was found again; {cycles} servo cycles, always active")
