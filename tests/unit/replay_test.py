#!/usr/bin/env python3
"""Records sessions of docking, surface and drilling and replays them: every force is bit-exact.

usage: replay_test.py BIN_DIR [--seconds S]. Also: what is changed in a recording is found; another scene is refused; a recording that begins
in the middle says that it cannot be exact.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

PATIENCE_S = 240


class Sessions:
    def __init__(self, programs, seconds):
        self.programs, self.seconds = programs, seconds
        self.dir = tempfile.mkdtemp(prefix="tact_replay_")
        self.env = dict(os.environ, TACT_RUNTIME_DIR=self.dir, XDG_CACHE_HOME=os.path.join(self.dir, "cache"))
        self.bad = 0

    def path(self, name):
        return os.path.join(self.dir, name)

    def run(self, program, *words):
        done = subprocess.run([os.path.join(self.programs, program), *map(str, words)], env=self.env, text=True,
                              capture_output=True, timeout=PATIENCE_S)
        return done.returncode, done.stdout, done.stderr

    def must(self, program, *words):
        code, out, err = self.run(program, *words)
        if code != 0:
            sys.exit("%s %s: exit code %d\n%s%s" % (program, " ".join(map(str, words)), code, out, err))
        return out

    def claim(self, what, good, more=""):
        self.bad += not good
        print("%s %s%s" % ("ok  " if good else "FAIL", what, "" if good else ": " + str(more)))

    def session(self, name, scene, *options, least_force_n=0.05):
        recording = self.path(name + ".h5")
        # On a busy machine the recorder may lose steps of a loop that runs freely, and says so: then once more.
        for _ in range(3):
            if os.path.exists(recording):
                os.remove(recording)
            self.must("tact", "run", scene, "--no-gui", "--quiet", "--seconds", self.seconds, "--record", recording, *options)
            code, out, err = self.run("tact", "replay", recording, "--json")
            if code not in (0, 3):
                self.claim(name, False, err)
                return recording, {}
            said = json.loads(out)
            if said["lost"] == 0:
                break
        version = self.must("tact-rt", "--version").strip()
        self.claim("%s names the build that recorded it" % name, said["recorded_by"] == version != "", (said["recorded_by"], version))
        self.claim("%s: %d steps, up to %.2f N, bit-exact" % (name, said["steps"], said["force_n_most"]),
                   code == 0 and said["different"] == 0 and said["obstacle"] == "" and said["lost"] == 0 and
                   said["force_n_most"] > least_force_n and said["steps"] > 300 * self.seconds, said)
        return recording, said

    def late(self, scene):
        """A recorder that attaches after the rings have wrapped; on a busy machine the controller needs longer for that."""
        for rest_s in (3.7, 15.0, 60.0):
            controller = subprocess.Popen([os.path.join(self.programs, "tact-rt"), scene, "--rate", "20000", "--priority", "0", "--arm"],
                                          env=self.env, stderr=subprocess.DEVNULL)
            try:
                time.sleep(rest_s)
                recording = self.path("late-%g.h5" % rest_s)
                self.must("tact", "record", recording, "--seconds", "0.5", "--wait", "60", "--quiet")
            finally:
                controller.terminate()
                controller.wait(timeout=PATIENCE_S)
            code, out, _ = self.run("tact", "replay", recording, "--json")
            said = json.loads(out) if code == 3 else {}
            if code == 3:
                break
        self.claim("a recording from the middle of a run is reported as such", "middle of a run" in said.get("obstacle", ""), (code, out))

    def close(self):
        shutil.rmtree(self.dir)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs")
    parser.add_argument("--seconds", type=float, default=3.0)
    request = parser.parse_args()
    s = Sessions(os.path.abspath(request.programs), request.seconds)
    try:
        s.must("tact-prep", "demo", "dock", "-o", s.path("dock.tact"))
        recording, _ = s.session("docking", s.path("dock.tact"), "--start-offset-a", 3, "--hand", "wander", "--copies", 2)
        s.session("docking, freely running", s.path("dock.tact"), "--free-run", "--goal", 2000, "--law", "fixed", "--level", "docking.force=1",
                  "--hand", "wander", "--start-offset-a", 2, least_force_n=0.02)  # how far the hand gets depends on the machine
        s.must("tact-prep", "demo", "touch", "--parts", 60, "-o", s.path("ground.tact"))
        s.session("surface", s.path("ground.tact"), "--hand", "stroke", "--tool-radius-mm", 1)
        s.session("surface, adaptive", s.path("ground.tact"), "--hand", "stroke", "--tool-radius-mm", 1, "--mode", "chr")
        s.must("tact-prep", "drill", "--synthetic", "--voxels", 64, "-o", s.path("bone.tact"))
        s.seconds = max(s.seconds, 8.0)  # the surgeon needs time to reach the bone
        _, said = s.session("drilling", s.path("bone.tact"), "--hand", "surgeon", "--hand2", "suction-tube", "--hand-at-mm", "-6,-1.5")
        s.claim("bone was removed in it", said.get("removed_levels", 0) > 255, said)
        with open(recording, "rb") as file:
            s.claim("no folder of the run is in it", s.dir.encode() not in file.read())
        elsewhere = tempfile.mkdtemp(prefix="tact_elsewhere_", dir=s.dir)
        moved = shutil.copy(recording, elsewhere)
        code, _, err = s.run("tact", "replay", moved)
        s.claim("without its scene nearby, a replay asks for --scene", code == 1 and "--scene" in err and "dock.tact" in err, (code, err))
        code, _, err = s.run("tact", "replay", moved, "--scene", s.path("dock.tact"), "--json")
        s.claim("with --scene it is replayed", code == 0, (code, err))
        code, _, err = s.run("tact", "replay", recording, "--scene", s.path("ground.tact"))
        s.claim("another scene is refused", code == 1 and "differs from the recorded one" in err, (code, err))
        code, _, err = s.run("tact", "replay", s.path("dock.tact"))
        s.claim("a file that is not a recording is refused", code == 1 and "not an HDF5 file" in err, (code, err))
        code, _, err = s.run("tact", "run", s.path("dock.tact"), "--no-gui", "--seconds", 1, "--record", recording)
        s.claim("a recording is not overwritten", code == 1 and "exists already" in err, (code, err))
        s.late(s.path("dock.tact"))
    finally:
        s.close()
    sys.exit(1 if s.bad else 0)


if __name__ == "__main__":
    main()
