#!/usr/bin/env python3
"""tact-rt docks with an arm on USB: found by its serial, calibrated by a person, armed, then subjected to every fault.

usage: 60_phantom_usb.py BIN_DIR. First at 1 kHz with corrupted packets until it is killed; then, slower if emulated,
each fault of board and cable and ten unplugs in one run. After each fault the motors have no current, and only the
person arms them again.
"""
import os
import signal
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import person_at_arms as at_station
import parts

BIN = sys.argv[1]
TCG = parts.ACCEL == "tcg"
SPOILT = ["corrupt 2", "repeat 3", "reorder 3", "drop 2", "stall"]
FAULTS = ["deaf", "safety open", "hot", "over-current", "brown-out", "count lost", "restart", "silence 60000 ms",
          "encoder jump 1 1000000"]
UNPLUGS = 10
SEEN = []
GROWTH_KB_MAX = 512  # from the second unplug to the last


def session(rate_hz, arms, story):
    """Runs tact-rt with a board of that rate. The board's watchdog is a number of states; with KVM it is longer, because the host may be busy."""
    watchdog_ms = 20_000 // rate_hz if TCG else 1000
    config = f"""
[servo]
period_us = {1e6 / rate_hz}
[device]
driver = "phantom-usb"
serial = "LEFT"
pump_priority = 85
watchdog_us = {watchdog_ms * 1000.0}
[safety]
timing_latches = "{parts.TIMING_LATCHES}"
"""
    words = [word for arm in arms for word in ("--arm", arm)]
    with parts.Emulator(BIN, *words, "--rate-hz", str(rate_hz), "--watchdog-ms", str(watchdog_ms), "--hand", "wander",
                        "--slow", "0.6") as emulator:
        at_station.names_of_the_kernel(*arms)
        with parts.Controller(BIN, config) as rt, parts.Person(BIN) as person:
            person_at_arms = at_station.PersonAtArms(emulator, rt, person)
            person_at_arms.arm()
            story(person_at_arms)
            parts.unhurt(rt.status())
            cycles = rt.status()["servo"]["cycles"]
            os.kill(rt.process.pid, signal.SIGKILL)  # now only the board's own watchdog can stop the current
            parts.wait_for(lambda: not person_at_arms.flowing(), "zero after SIGKILL")
            assert emulator.status("LEFT")["flowing"] == 0
            return cycles


def rates(person_at_arms):
    def look():
        return person_at_arms.rt.status()["servo"]["cycles"], person_at_arms.emulator.status("LEFT")["states"], time.monotonic()

    before = look()
    time.sleep(0.5)
    after = look()
    seconds = after[2] - before[2]
    print(f"-- docked: about {(after[0] - before[0]) / seconds:.0f} cycles and {(after[1] - before[1]) / seconds:.0f} states "
          "per second", flush=True)


def docked(person_at_arms):
    rates(person_at_arms)
    for order in SPOILT:  # a few bad packets have no effect
        person_at_arms.emulator.order(order + " LEFT")
        person_at_arms.new_states(order)
        print(f"-- {order}: {person_at_arms.rt.state()}", flush=True)
    person_at_arms.arm()
    person_at_arms.rt.watch_servo()


def holds(rt):
    """Kernel resources of tact-rt: descriptors, threads, and kB of data."""
    folder = f"/proc/{rt.process.pid}"
    data = next(line for line in parts.text_of(f"{folder}/status").splitlines() if line.startswith("VmData"))
    return len(os.listdir(f"{folder}/fd")), len(os.listdir(f"{folder}/task")), int(data.split()[1])


def faults(person_at_arms):
    for order in FAULTS:
        person_at_arms.fault(order)
        SEEN.append(order)
    # Detected only while a motor pushes against it and the others move: one encoder after the other.
    if any(person_at_arms.fault(f"encoder stuck {i}", patience_s=3.0) for i in (0, 1, 2, 0, 1, 2)):
        SEEN.append("encoder stuck")
    else:
        print("-- skipped: encoder stuck: no motor pushed for long enough", flush=True)
    held = []
    for _ in range(UNPLUGS):
        person_at_arms.fault("unplug")
        person_at_arms.arm()
        held.append(holds(person_at_arms.rt))
    print(f"-- descriptors, threads, kB of data after the second and the last of {UNPLUGS} unplugs: {held[1]}, {held[-1]}",
          flush=True)
    assert held[1][:2] == held[-1][:2] and held[-1][2] - held[1][2] <= GROWTH_KB_MAX, held
    person_at_arms.rt.watch_servo()


def main():
    cycles = session(1000, ("LEFT", "OTHER"), docked) + session(250 if TCG else 1000, ("LEFT",), faults)
    print(f"an arm on USB docked, found by its serial beside another; zero current and latched after: {', '.join(SEEN)}, "
          f"{UNPLUGS} unplugs without a leak; {cycles} cycles without an allocation, lock, page fault or system call but "
          "sleep; killed: zero by the board's watchdog")
    return 0


if __name__ == "__main__":
    sys.exit(main())
