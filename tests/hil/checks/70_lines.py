#!/usr/bin/env python3
"""tact-rt with safety lines on an emulated CP2112: stops, broken wires, unplugged adapter, starved servo. 70_lines.py BIN"""
import os
import subprocess
import sys

story = os.path.join(sys.argv[1], "../tests/hil_lines_story")
if not os.access(story, os.X_OK):
    print("hil_lines_story is not built")
    sys.exit(77)
sys.exit(subprocess.run([story, "80", "1"], check=False).returncode)
