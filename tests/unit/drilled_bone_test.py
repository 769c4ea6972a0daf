#!/usr/bin/env python3
"""Drilled bone outlives the controller: drill, kill -9, resume, and the bone is the same to the bit.

usage: drilled_bone_test.py BIN_DIR. Also: a run that is resumed continues the file; its recording replays bit-exactly and is refused when the
file changed; what cannot be kept or resumed is refused with the reason.
"""
import glob
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SLEEPS = ("35", "219", "230")  # nanosleep, restart_syscall, clock_nanosleep of x86-64
PATIENCE_S = 240
HAND = ["--hand", "surgeon", "--hand2", "suction-tube", "--hand-at-mm", "-6,-1.5"]


class Runs:
    def __init__(self, programs):
        self.programs = programs
        self.dir = tempfile.mkdtemp(prefix="tact_drilled_")
        self.env = dict(os.environ, TACT_RUNTIME_DIR=self.dir, XDG_CACHE_HOME=self.path("cache"), XDG_STATE_HOME=self.path("state"))
        self.bad = 0

    def path(self, name):
        return os.path.join(self.dir, name)

    def run(self, program, *words):
        done = subprocess.run([os.path.join(self.programs, program), *map(str, words)], env=self.env, text=True, capture_output=True,
                              timeout=PATIENCE_S)
        return done.returncode, done.stdout, done.stderr

    def must(self, program, *words):
        code, out, err = self.run(program, *words)
        if code != 0:
            sys.exit("%s %s: exit code %d\n%s%s" % (program, " ".join(map(str, words)), code, out, err))
        return out

    def claim(self, what, good, more=""):
        self.bad += not good
        print("%s %s%s" % ("ok  " if good else "FAIL", what, "" if good else ": " + str(more)))

    def start(self, *words):
        return subprocess.Popen([os.path.join(self.programs, "tact"), "run", self.path("bone.tact"), "--no-gui", *words], env=self.env, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def drilled(self, run):
        """Waits until the surgeon has taken bone for a while; returns the controller's process id."""
        end = time.monotonic() + PATIENCE_S
        for line in run.stdout:
            words = line.split()
            if words[-1:] == ["mm3"] and float(words[-2]) > 1.0:
                break
            if time.monotonic() > end:
                sys.exit("the surgeon takes no bone")
        children = subprocess.run(["pgrep", "-P", str(run.pid), "tact-rt"], text=True, capture_output=True).stdout.split()
        return int(children[0])

    def forget_socket(self, session):
        """Of a controller that was killed: a new one has the same."""
        if os.path.exists(self.path("tact-%s.sock" % session)):
            os.remove(self.path("tact-%s.sock" % session))

    def close(self):
        shutil.rmtree(self.dir)


def stop_between_steps(pid):
    """Stops a controller while its servo thread sleeps: within a step bone may be taken that is not counted yet."""
    tasks = "/proc/%d/task/" % pid
    servo = next(t for t in os.listdir(tasks) if open(tasks + t + "/comm").read().strip() == "servo")
    for _ in range(500):
        os.kill(pid, signal.SIGSTOP)
        time.sleep(0.01)
        with open(tasks + servo + "/syscall") as file:
            if file.read().split()[0] in SLEEPS or os.uname().machine != "x86_64":
                return
        os.kill(pid, signal.SIGCONT)
        time.sleep(0.003)
    sys.exit("the servo thread of process %d never sleeps" % pid)


def densities(pid):
    """Of the bone in the shared memory of a process."""
    for link in glob.glob("/proc/%d/fd/*" % pid):
        try:
            if "tact.bone" in os.readlink(link):
                with open(link, "rb") as file:
                    return file.read()
        except OSError:
            pass
    sys.exit("process %d has no bone" % pid)


def bone_of(runs, *words):
    """Starts a controller that rests, and returns its bone."""
    session = "looked-at"
    runs.forget_socket(session)
    controller = subprocess.Popen([os.path.join(runs.programs, "tact-rt"), runs.path("bone.tact"), "--session", session, *words], env=runs.env,
                                  text=True, stderr=subprocess.PIPE)
    try:
        end = time.monotonic() + PATIENCE_S
        while not os.path.exists(runs.path("tact-%s.sock" % session)):
            if controller.poll() is not None or time.monotonic() > end:
                sys.exit("the controller did not start: " + controller.stderr.read())
            time.sleep(0.05)
        return densities(controller.pid)
    finally:
        controller.terminate()
        controller.wait(timeout=PATIENCE_S)


def main():
    runs = Runs(os.path.abspath(sys.argv[1]))
    try:
        runs.must("tact-prep", "drill", "--synthetic", "--voxels", 64, "-o", runs.path("bone.tact"))
        whole = bone_of(runs)
        size = 64 ** 3
        start = len(whole) - size  # densities are the end of the region

        # Killed while it drills: it is stopped first, so that its bone can be read as it is left.
        run = runs.start("--keep", runs.path("a.bone"), *HAND)
        pid = runs.drilled(run)
        stop_between_steps(pid)
        left = densities(pid)
        os.kill(pid, signal.SIGKILL)
        run.communicate(timeout=PATIENCE_S)
        runs.claim("the run reports that its controller was killed", run.returncode == 1, run.returncode)
        runs.claim("bone was taken", left[start:] != whole[start:])
        runs.claim("resumed after kill -9, the bone is the same to the bit",
                   bone_of(runs, "--resume", runs.path("a.bone"))[start:] == left[start:])
        runs.claim("a torn end does no harm", torn(runs, left, start))

        # A resumed run continues the file of the first, in the state folder, and is recorded and replayed.
        out = runs.must("tact", "run", runs.path("bone.tact"), "--no-gui", "--quiet", "--seconds", 8, "--resume", runs.path("a.bone"), "--record",
                        runs.path("b.h5"), "--json", runs.path("b.json"), *HAND)
        with open(runs.path("b.json")) as file:
            kept = json.load(file)["drilling"]["kept_in"]
        runs.claim("the report says where the bone is kept", kept and os.path.dirname(kept) == runs.path("state/tact/drilled") and kept in out, kept)
        more = bone_of(runs, "--resume", kept)
        runs.claim("the resumed run took more bone", sum(more[start:]) < sum(left[start:]))
        runs.claim("of its file, the first part is that of the file before", part_of(runs.path("a.bone"), kept))
        runs.claim("--resume last finds it", bone_of_last(runs, start) == more[start:])
        code, out, err = runs.run("tact", "replay", runs.path("b.h5"))
        runs.claim("the recording of a resumed run replays bit-exactly", code == 0 and "bit-exact" in out, (code, out, err))
        shutil.copy(runs.path("a.bone"), runs.path("as-it-was"))
        os.remove(runs.path("a.bone"))
        code, _, err = runs.run("tact", "replay", runs.path("b.h5"))
        runs.claim("without the file, a replay asks for it", code == 1 and "no such file" in err and "--bone" in err, (code, err))
        code, out, err = runs.run("tact", "replay", runs.path("b.h5"), "--bone", runs.path("as-it-was"))
        runs.claim("with --bone it is replayed", code == 0 and "bit-exact" in out, (code, out, err))
        shutil.copy(kept, runs.path("a.bone"))
        code, _, err = runs.run("tact", "replay", runs.path("b.h5"))
        runs.claim("a replay says that the file changed", code == 1 and "changed since this run was recorded" in err, (code, err))

        code, _, err = runs.run("tact", "run", runs.path("bone.tact"), "--no-gui", "--seconds", 1, "--keep", runs.path("a.bone"))
        runs.claim("a file is not overwritten", code == 1 and "exists already" in err, (code, err))
        runs.must("tact-prep", "drill", "--synthetic", "--voxels", 32, "-o", runs.path("other.tact"))
        code, _, err = runs.run("tact-rt", runs.path("other.tact"), "--resume", runs.path("a.bone"))
        runs.claim("bone of another scene is refused", code == 1 and "another scene" in err, (code, err))
        runs.must("tact-prep", "demo", "touch", "--parts", 60, "-o", runs.path("ground.tact"))
        code, _, err = runs.run("tact-rt", runs.path("ground.tact"), "--resume", runs.path("a.bone"))
        runs.claim("a scene without bone is refused", code == 1 and "no bone" in err, (code, err))
        code, _, err = runs.run("tact", "run", runs.path("ground.tact"), "--no-gui", "--seconds", 1, "--keep", runs.path("c.bone"))
        runs.claim("a scene without bone keeps none", code == 1 and "has no bone" in err, (code, err))
    finally:
        runs.close()
    sys.exit(1 if runs.bad else 0)


def torn(runs, left, start):
    with open(runs.path("a.bone"), "rb") as file:
        content = file.read()
    with open(runs.path("torn.bone"), "wb") as file:
        file.write(content + content[128:128 + 200])
    return bone_of(runs, "--resume", runs.path("torn.bone"))[start:] == left[start:]


def part_of(first, second):
    with open(first, "rb") as a, open(second, "rb") as b:
        content = a.read()
        return b.read(len(content)) == content


def bone_of_last(runs, start):
    runs.forget_socket("default")
    run = runs.start("--quiet", "--resume", "last", "--seconds", "60")
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        children = subprocess.run(["pgrep", "-P", str(run.pid), "tact-rt"], text=True, capture_output=True).stdout.split()
        if children and os.path.exists(runs.path("tact-default.sock")):
            break
        time.sleep(0.05)
    try:
        return densities(int(children[0]))[start:] if children else b""
    finally:
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=PATIENCE_S)


if __name__ == "__main__":
    main()
