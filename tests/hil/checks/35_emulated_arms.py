#!/usr/bin/env python3
"""The two arms of tact-emu on the USB bus, through usbfs: identity, states, commands, watchdog, faults, unplug."""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import parts

ON, TRIPPED, BROWN_OUT = 2, 16, 8
CURRENTS = (300, 0, 0, 0, 0, 0)


def good_states(board, count):
    states = [board.state() for _ in range(count)]
    assert all(s["good"] for s in states), states
    for a, b in zip(states, states[1:]):
        assert b["sequence"] > a["sequence"] and b["time_us"] != a["time_us"], (a, b)
    return states


def powered(board, emulator, serial):
    """Sends an enable edge and a current; returns when the board reports that current flows."""
    board.command((0,) * 6, False)
    board.command(CURRENTS, True)
    emulator.until("amplifier", "on", serial)
    emulator.until("currents", "flowing", serial)


def main():
    with parts.Emulator(sys.argv[1], "--arm", "LEFT", "--arm", "RIGHT:premium-1.5", "--rate-hz", "200", "--watchdog-ms", "500",
                        "--hand", "passive", "--no-ritual") as emulator:
        left, right = parts.Board("LEFT"), parts.Board("RIGHT")
        assert left.node != right.node
        infos = [b.query() for b in (left, right)]
        print(*infos, sep="\n")
        assert [i["serial"] for i in infos] == ["LEFT", "RIGHT"] and infos[0]["boot"] != infos[1]["boot"]
        assert all(i["versions"] == (1, 1) and i["rate_hz"] == 200 and i["watchdog_ms"] == 500 for i in infos)
        good_states(right, 20)
        still = good_states(left, 20)[-1]

        powered(left, emulator, "LEFT")
        for _ in range(40):
            left.command(CURRENTS, True)
            moved = left.state()
        assert moved["status"] & ON and moved["command_seen"] > 0, moved
        assert moved["counts"][0] != still["counts"][0], (still, moved)
        tripped = emulator.until("amplifier", "tripped", "LEFT")  # no more commands
        zero = emulator.until("currents", "zero", "LEFT")
        assert zero["t_ns"] >= tripped["t_ns"]
        left.command(CURRENTS, True)
        good_states(left, 5)
        assert emulator.status("LEFT")["detail"] == "tripped", "an enable that stayed high armed the board again"

        powered(left, emulator, "LEFT")
        emulator.order("brown-out LEFT")
        emulator.until("amplifier", "fault", "LEFT")
        emulator.until("currents", "zero", "LEFT")
        while not left.state()["status"] & BROWN_OUT:
            pass
        emulator.order("well LEFT")
        emulator.until("fault", "well", "LEFT")
        while emulator.newest("amplifier", "LEFT")[1]["detail"] != "off":  # the board's next step clears it
            left.command((0,) * 6, False)
            left.state()

        # A board drops the oldest states that are not fetched in time, so many states are corrupted to observe one.
        for fault, seen in (("corrupt", lambda a, b: not b["good"]),
                            ("repeat", lambda a, b: a["sequence"] == b["sequence"]),
                            ("reorder", lambda a, b: b["sequence"] < a["sequence"])):
            emulator.order(f"{fault} 100 LEFT")
            emulator.until("fault", fault, "LEFT")
            states = [left.state()]
            while not any(seen(a, b) for a, b in zip(states, states[1:])):
                states.append(left.state())
                assert len(states) < 200, (fault, states[-3:])
            emulator.order("well LEFT")
            emulator.until("fault", "well", "LEFT")
            [left.state() for _ in range(20)]  # states queued in the board
            good_states(left, 20)

        emulator.order("stall LEFT")
        errors = []
        while "EPIPE" not in errors:
            errors.append(parts.said(left.state))
            assert len(errors) < 200, errors[-3:]
        left.clear_halt()
        good_states(left, 5)

        for _ in range(2):
            emulator.order("unplug LEFT")
            emulator.until("usb", "unplugged", "LEFT")
            errors = []
            while "ENODEV" not in errors:
                errors.append(parts.said(left.state))
                assert len(errors) < 200, errors[-3:]
            left.close()
            emulator.order("plug LEFT")
            emulator.until("usb", "configured", "LEFT")
            left = parts.Board("LEFT")
            assert left.query()["boot"] == infos[0]["boot"], "the board lost its power at the unplug"
            good_states(left, 5)
        good_states(right, 5)  # unaffected

        emulator.order("nonsense")
        assert "unknown order" in emulator.until("refused")["detail"]
        code = emulator.end()
        assert code == 0, code
    assert parts.find_board("LEFT") is None and parts.find_board("RIGHT") is None
    left_over = os.listdir("/sys/kernel/config/usb_gadget")
    assert not [g for g in left_over if g.startswith("tact-emu")], left_over
    print("two boards found by class and serial; states, commands, watchdog, brown-out, corrupt, repeated and reordered "
          "packets, stall, unplugged twice; nothing left behind")


if __name__ == "__main__":
    main()
