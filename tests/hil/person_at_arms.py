"""A person with emulated arms: arms until the motors have current, injects faults, and checks that each ends with zero current."""
import re
import time

import parts

ARM_S = 60
TOLD = ("safety open", "hot", "over-current", "brown-out", "count lost", "encoder jump")  # reported in the board's next state
TOLD_COMMANDS_MAX = 8  # of the controller, from such a fault to zero current


class PersonAtArms:
    """The emulator, the controller and the person; faults concern the arm LEFT by default."""

    def __init__(self, emulator, rt, person, arms=("LEFT",)):
        self.emulator, self.rt, self.person, self.arms = emulator, rt, person, arms

    def newest(self, what, arm="LEFT"):
        """Index and line of the newest report; read from the collected output, because each query takes time."""
        return self.emulator.newest(what, arm)

    def flowing(self, arm="LEFT"):
        return self.newest("currents", arm)[1]["detail"] == "flowing"

    def new_states(self, what, arm="LEFT"):
        """Waits until the controller has fetched new states."""
        sent = self.emulator.status(arm)["states"]
        parts.wait_for(lambda: self.emulator.status(arm)["states"] > sent + 10, f"new states after {what}")

    def arm(self):
        """Arms until the motors have current, following the instructions on the screen."""
        end = time.monotonic() + ARM_S
        while True:
            state = self.rt.state()
            if state == "active" and parts.soon(self.flowing, 2.0):
                return
            assert time.monotonic() < end, f"not armed in {ARM_S} s; {state}, {self.notice()}"
            if state == "active":  # the board's watchdog has tripped
                self.person.send("disarm")
            elif state == "fault":
                self.person.send("reset")
            elif "reset pose" in self.notice():
                for arm in self.arms:
                    self.emulator.order(f"calibrate {arm}")
                for arm in self.arms:
                    parts.wait_for(lambda a=arm: self.newest("hand", a)[1]["detail"] == "free", f"{arm} calibrated")
            elif state == "ready":
                self.person.send("arm")
            parts.soon(lambda s=state: self.rt.state() != s, 0.5)

    def stopped(self, arm):
        """True if the controller has latched a fault, or, under KVM (timing does not latch), the board's watchdog has tripped."""
        return self.rt.state() == "fault" or (
            parts.ACCEL == "kvm" and self.newest("amplifier", arm)[1]["detail"] == "tripped")

    def notice(self):
        """The instruction on the screen for each hand."""
        return "".join(next((line for line in reversed(self.rt.said()) if words in line), "")
                       for words in (": device: ", ": device of the second hand: "))

    def fault(self, order, arm="LEFT", patience_s=parts.PATIENCE_S):
        """Injects the fault and asserts zero current, also after the fault is cleared. False: the fault had no effect in time."""
        self.arm()
        self.emulator.order(f"{order} {arm}")
        what, name = ("usb", "unplugged") if order == "unplug" else ("fault", re.sub(r" -?\d.*", "", order))
        self.emulator.until(what, name, arm)
        at, line = self.newest(what, arm)
        if not parts.soon(lambda: not self.flowing() and self.stopped(arm), patience_s):
            assert patience_s < parts.PATIENCE_S, f"zero and fault after {order}"
            self.emulator.order(f"well {arm}")
            return False
        zero_at, zero = self.newest("currents")
        latched = re.findall(r"cycle (\d+): state changed: ", "".join(self.rt.said()))[-1]
        commands = zero["commands"] - line["commands"]
        if arm == "LEFT":
            told = re.findall(r"cycle (\d+): device: (.*)", "".join(self.rt.said()))[-1]
            print(f"-- {order}: no current{' already' if zero_at < at else ''} after {commands} commands and "
                  f"{(zero['t_ns'] - line['t_ns']) / 1e6:.1f} ms; reported in cycle {told[0]} ({told[1]}), latched in "
                  f"{latched}", flush=True)
            assert name not in TOLD or commands <= TOLD_COMMANDS_MAX, f"{commands} commands from {order} to zero"
        else:
            print(f"-- {order} {arm}: no current in LEFT after {(zero['t_ns'] - line['t_ns']) / 1e6:.1f} ms; latched in cycle "
                  f"{latched}", flush=True)
        if order == "unplug":
            self.emulator.order(f"plug {arm}")
        self.emulator.order(f"well {arm}")
        self.new_states(order, arm)
        assert self.stopped(arm) and not self.flowing(), f"armed by itself after {order}: {self.rt.state()}"
        return True


def names_of_the_kernel(*serials):
    """Prints the device node of each board once the host has configured it."""
    for serial in serials:
        node = parts.wait_for(lambda s=serial: parts.find_board(s), f"{serial} configured")
        print(f"{serial}: {node}", flush=True)
