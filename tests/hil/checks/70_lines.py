#!/usr/bin/env python3
"""tact-rt with safety inputs on an emulated CP2112: stops, broken wires, unplugged adapter, starved servo. 70_lines.py BIN

First checks the adapter of tact-emu once, then runs hil_lines_story.
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import parts

CONFIG = """[lines]
driver = "gpio"
emergency_stop_a = "0"
emergency_stop_b = "1"
enable = "4"
"""


def emulators_adapter(bin_dir):
    with open("/out/lines.toml", "w", encoding="utf-8") as f:
        f.write(CONFIG)

    def checked():
        done = subprocess.run([f"{bin_dir}/tact-rt", "/out/small.tact", "--check", "--config", "/out/lines.toml"],
                              capture_output=True, text=True, timeout=parts.PATIENCE_S)
        return done.stdout if done.returncode == 0 else ""

    with parts.Emulator(bin_dir, "--lines") as emulator:
        print(parts.wait_for(checked, "tact-rt opens the adapter of tact-emu"), end="")
        emulator.order("lines unplug")
        emulator.order("lines stop")
        emulator.until("order", "lines stop")
        emulator.order("lines plug")
        parts.wait_for(checked, "tact-rt opens the replugged adapter")


def main():
    story = os.path.join(sys.argv[1], "../tests/hil_lines_story")
    if not os.access(story, os.X_OK):
        print("hil_lines_story is not built")
        return 77
    emulators_adapter(sys.argv[1])
    counted = ["counted"] if parts.ACCEL == "tcg" else []
    return subprocess.run([story, "80", "1", *counted], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
