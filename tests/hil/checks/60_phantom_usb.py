#!/usr/bin/env python3
"""tact-rt docks with an arm behind USB: found by its serial, calibrated by a person, armed, and then everything goes wrong.

usage: 60_phantom_usb.py BIN_DIR. After each fault the motors have no current, and nothing but the person arms them again.
How long that took is printed and not judged. An emulated processor loses states and arms by itself now and then; the
person then begins again, and when the time is over the faults that are left are named.
"""
import os
import re
import signal
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import parts

BIN = sys.argv[1]
TCG = parts.ACCEL == "tcg"
BEGUN = time.monotonic()
TIME_S = 75 if TCG else 100  # after them no fault more is begun
ARM_S = 90 if TCG else parts.PATIENCE_S
UNPLUGS = 2 if TCG else 10
RATE_HZ, SLOW, WATCHDOG_MS = (100, 4, 5000) if TCG else (1000, 1, 1000)
CONFIG = f"""
[device]
driver = "phantom-usb"
serial = "LEFT"
pump_priority = 85
watchdog_us = {WATCHDOG_MS * 1000.0}
[safety]
timing_latches = "never"
""" + ("[servo]\nperiod_us = 20000.0\n" if TCG else "")
# Each lasts until it is mended, so that nobody can miss it who stood still. After the first six the arm must be calibrated.
FAULTS = ["unplug", "restart", "silence 60000 ms", "encoder jump 1 1000000", "brown-out", "count lost",
          "deaf", "safety open", "hot", "over-current"]
FAULTS = FAULTS[:1] + FAULTS[6:] + FAULTS[1:6] + ["unplug"] * (UNPLUGS - 1)
SPOILT = ["corrupt 2", "repeat 3", "reorder 3", "drop 2", "stall"]


class TooSlow(Exception):
    """An emulated processor stands still so often that the arm cannot be held."""


class Desk:
    """The emulator, the controller and the person."""

    def __init__(self, emulator, rt, person):
        self.emulator, self.rt, self.person = emulator, rt, person

    def newest(self, what):
        """Index and line; asked of what the emulator said, since each question costs the processor that the arm needs."""
        return self.emulator.newest(what, "LEFT")

    def flowing(self):
        return self.newest("currents")[1]["detail"] == "flowing"

    def new_states(self, what):
        """Waits for states that the controller fetches."""
        sent = self.emulator.status("LEFT")["states"]
        assert parts.soon(lambda: self.emulator.status("LEFT")["states"] > sent + 10, parts.PATIENCE_S, 0.5), (
            f"no states after {what}")

    def left(self, state):
        return parts.soon(lambda: self.rt.state() != state, 4.0)

    def arm(self):
        """Until the motors pull: what a person does whom the screen tells what is wrong."""
        end = time.monotonic() + ARM_S
        while True:
            state = self.rt.state()
            if state == "active" and parts.soon(self.flowing, 8.0):
                return
            if time.monotonic() > end:
                assert TCG and [line for line in self.rt.said() if "sent nothing good" in line], f"not armed in {ARM_S} s"
                raise TooSlow
            if state == "active":  # the board's watchdog had enough of a processor that stood still
                self.person.send("disarm")
            elif state == "fault":
                self.person.send("reset")
            elif state == "ready":
                self.person.send("arm")
            if state in ("ready", "armed") and "reset pose" in self.notice():
                self.emulator.order("calibrate LEFT")
                self.emulator.until("hand", "free", "LEFT")
            self.left(state)

    def notice(self):
        """What the screen asks the person to do."""
        return next((line for line in reversed(self.rt.said()) if ": device: " in line), "")

    def fault(self, order):
        """Gives the order and asserts that it ends in zero, and stays there once it is mended."""
        self.arm()
        self.emulator.order(order + " LEFT")
        what = "usb" if order == "unplug" else "fault"
        self.emulator.until(what, "unplugged" if order == "unplug" else re.sub(r" -?\d.*", "", order), "LEFT")
        at, line = self.newest(what)
        parts.wait_for(lambda: not self.flowing(), f"zero after {order}")
        zero_at, zero = self.newest("currents")
        already = zero_at < at  # it fell by itself
        # The board's watchdog alone latches nothing in the controller here: timing_latches.
        parts.wait_for(lambda: self.rt.state() == "fault" or self.newest("amplifier")[1]["detail"] == "tripped",
                       f"the controller's fault after {order}")
        latched = self.rt.state() == "fault"
        cycles = re.findall(r"cycle (\d+): device: ", "".join(self.rt.said()))[-1:]
        cycles += re.findall(r"cycle (\d+): state changed: ", "".join(self.rt.said()))[-1:]
        print(f"-- {order}: no current{' already' if already else ''}; commands from the fault to zero: "
              f"{zero['commands'] - line['commands']}, states {zero['states'] - line['states']}, "
              f"{(zero['t_ns'] - line['t_ns']) / 1e6:.1f} ms; told and latched in cycles {' and '.join(cycles)}", flush=True)
        parts.wait_for(lambda: not latched or not self.flowing(), f"zero in the fault after {order}")
        if order == "unplug":
            self.emulator.order("plug LEFT")
        self.emulator.order("well LEFT")
        self.new_states(order)
        assert not latched or not self.flowing(), f"armed by itself after {order}: {self.rt.state()}"

    def spoilt(self, order):
        """A few bad packets: nobody feels them, unless the processor stands still just then."""
        self.emulator.order(order + " LEFT")
        self.new_states(order)
        print(f"-- {order}: {self.rt.state()}", flush=True)


def main():
    with parts.Emulator(BIN, "--arm", "LEFT", "--arm", "OTHER", "--rate-hz", str(RATE_HZ), "--watchdog-ms",
                        str(WATCHDOG_MS), "--slow", str(SLOW)) as emulator:
        for name in ("LEFT", "OTHER"):
            parts.wait_for(lambda n=name: emulator.newest("usb", n)[1]["detail"] == "configured", f"{name} configured")
        done, cycles = session(emulator)
    if not done:
        print(f"an emulated processor too slow to hold an arm; {cycles} cycles without an allocation, lock or page fault")
        return 77
    print(f"an arm on USB docked, found by its serial beside another; zero and latched: {', '.join(done)}; no time for "
          f"{len(FAULTS) - len(done)} of {len(FAULTS)}; {cycles} cycles without an allocation, lock, page fault or system "
          "call but sleep; killed: zero by the board's watchdog")
    return 0


def session(emulator):
    done = []
    with parts.Controller(BIN, CONFIG) as rt, parts.Person(BIN) as person:
        desk = Desk(emulator, rt, person)
        begun = rt.status()
        try:
            desk.arm()
            for order in SPOILT:
                desk.spoilt(order)
            for order in FAULTS:
                if done and time.monotonic() - BEGUN > TIME_S:
                    break
                desk.fault(order)
                done.append(order)
            desk.arm()
        except TooSlow:
            print("-- the processor stands still so often that the arm cannot be held", flush=True)
        rt.watch_servo()
        now = rt.status()
        parts.unhurt(now)
        cycles = now["servo"]["cycles"] - begun["servo"]["cycles"]
        os.kill(rt.process.pid, signal.SIGKILL)  # the board's own watchdog is what is left
        parts.wait_for(lambda: not desk.flowing(), "zero after SIGKILL")
        assert emulator.status("LEFT")["flowing"] == 0
    return done, cycles


if __name__ == "__main__":
    sys.exit(main())
