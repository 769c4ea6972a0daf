#!/usr/bin/env python3
"""Both arms in one tact-rt: identified by their serials, calibrated and armed together; a fault of either stops both.

usage: 65_two_arms.py BIN_DIR
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import person_at_arms as at_station
import parts

BIN = sys.argv[1]
RATE_HZ = 250
WATCHDOG_MS = 80 if parts.ACCEL == "tcg" else 1000
CONFIG = f"""
[servo]
period_us = {1e6 / RATE_HZ}
[device]
driver = "phantom-usb"
serial = "LEFT"
pump_priority = 85
watchdog_us = {WATCHDOG_MS * 1000.0}
[device2]
driver = "phantom-usb"
serial = "RIGHT"
[safety]
timing_latches = "{parts.TIMING_LATCHES}"
"""


def main():
    with parts.Emulator(BIN, "--arm", "LEFT", "--arm", "RIGHT", "--rate-hz", str(RATE_HZ), "--watchdog-ms", str(WATCHDOG_MS),
                        "--hand", "wander", "--slow", "0.6") as emulator:
        at_station.names_of_the_kernel("LEFT", "RIGHT")
        with parts.Controller(BIN, CONFIG) as rt, parts.Person(BIN) as person:
            person_at_arms = at_station.PersonAtArms(emulator, rt, person, ("LEFT", "RIGHT"))
            person_at_arms.arm()
            person_at_arms.fault("unplug", "RIGHT")
            person_at_arms.fault("safety open", "RIGHT")
            person_at_arms.fault("unplug", "LEFT")
            person_at_arms.arm()
            rt.watch_servo()
            now = rt.status()
            parts.unhurt(now)
            assert rt.end() == 0
    print(f"one servo with two arms: a fault of either stops both (unplugs, open safety chain); "
          f"{now['servo']['cycles']} cycles without an allocation, lock or page fault")


if __name__ == "__main__":
    main()
