#!/usr/bin/python3
"""A long run: memory, objects in the graphics driver and frame time stay constant, and its recording opens.

usage: soak_test.py BIN_DIR SCENE|synthetic [--seconds S] [--rate HZ] [--times] [--json FILE] [-- options of tact run]

Two hours at 1 kHz are 7.2 million cycles; --seconds 1200 --rate 6000 has the same effect on the rings, the governor, the recorder and the window.
The test samples window and controller every second (tact status, /proc). After a tenth of the run, and at least three samples, it fits a
straight line to each series; the rise of the line until the end must be less than the limit.
--times checks the frame time too, for a machine without other load. Exit code 77: Xvfb or h5py is missing.
"""
import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

# Maximum rise after a tenth of the run: in bytes or objects, and as a fraction of the initial value.
LIMITS = {"gui resident": (8 << 20, 0.02), "gui heap": (8 << 20, 0.02), "rt resident": (4 << 20, 0.02), "gl objects": (0, 0.0)}
RECORDER_MOST = 160 << 20  # the controller's rings as mapped, and HDF5's chunks of all columns: 114 MiB after 7.7 million cycles
TIME_RISES = 0.10         # maximum relative rise of the frame time
COLUMNS = {  # of ipc/record/RECORDING.md
    "cycles": ["step", "cycle", "now_ns", "lateness_ns", "cost_ns", "model_ns", "level", "run_state", "flags", "clock_ns"],
    "hand0": ["pose_world", "wrench_world", "wrench_model", "pose_dev", "twist_dev", "buttons", "model_error_n", "items"],
    "hand1": ["pose_world", "wrench_world"],
    "mailbox": ["step", "kind", "order", "value", "index", "body", "pose_model"],
    "reports": ["step"],
    "events": ["taken_at_ns", "cycle", "code", "a", "b"],
    "levels": ["taken_at_ns", "level", "rate_hz", "goal_hz"],
    "health": [],
    "bodies": ["pose_model", "id", "structure", "flags"],
    "drops": ["noticed_at_ns", "ring", "records"],
    "start": [],
}
ATTRIBUTES = ["format", "version", "program", "session", "scene_path", "scene_checksum", "hands", "period_ns", "first_step", "dry_steps",
              "pose_world_dev", "end"]


def children_of(pid):
    found = {}
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            with open("/proc/%s/stat" % entry) as f:
                text = f.read()
            name, rest = text[text.index("(") + 1:text.rindex(")")], text[text.rindex(")") + 2:].split()
            if int(rest[1]) == pid:
                found[name] = int(entry)
        except OSError:
            pass  # the process ended
    return found


def resident(pid):
    try:
        with open("/proc/%d/statm" % pid) as f:
            return int(f.read().split()[1]) * os.sysconf("SC_PAGESIZE")
    except OSError:
        return None


def line(points):
    """Least-squares line: value at the first point, and rise until the last."""
    n = len(points)
    mx, my = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    xx = sum((x - mx) ** 2 for x, _ in points)
    slope = sum((x - mx) * (y - my) for x, y in points) / xx if xx > 0 else 0.0
    first, last = points[0][0], points[-1][0]
    return my + slope * (first - mx), slope * (last - first)


def median(values):
    values = sorted(values)
    return values[len(values) // 2]


class Soak:
    def __init__(self, o):
        self.o, self.bad = o, 0
        self.dir = tempfile.mkdtemp(prefix="tact_soak_", dir=o.folder)
        self.env = dict(os.environ, TACT_RUNTIME_DIR=self.dir, LIBGL_ALWAYS_SOFTWARE="1")
        self.recording = os.path.join(self.dir, "soak.h5")
        self.log = os.path.join(self.dir, "soak.log")
        self.series = {}
        self.said = {}

    def claim(self, what, good):
        self.bad += not good
        print("%s %s" % ("ok  " if good else "FAIL", what), flush=True)

    def add(self, name, t, value):
        if value is not None:
            self.series.setdefault(name, []).append((t, value))

    def sample(self, t, pids):
        self.add("gui resident", t, resident(pids["tact-gui"]))
        self.add("rt resident", t, resident(pids["tact-rt"]))
        self.add("recorder resident", t, resident(pids["tact-record"]))
        done = subprocess.run([os.path.join(self.o.programs, "tact"), "status", "--json", "--session", "soak"], env=self.env, text=True,
                              capture_output=True)
        if done.returncode != 0:
            return
        self.said = json.loads(done.stdout)
        frames = self.said["gui"]["frames"]
        if frames is None:
            return
        self.add("gui heap", t, frames["heap_bytes"])
        self.add("gl objects", t, frames["gl_objects"])
        self.add("frame p50 ms", t, frames["recent_ms"]["p50"])
        self.add("frame p99 ms", t, frames["recent_ms"]["p99"])

    def run(self):
        o = self.o
        if o.scene == "synthetic":
            o.scene = os.path.join(self.dir, "bone.tact")
            subprocess.run([os.path.join(o.programs, "tact-prep"), "drill", "--synthetic", "--voxels", "64", "-o", o.scene], check=True,
                           env=self.env, stdout=subprocess.DEVNULL)
            o.more = o.more or ["--hand", "surgeon", "--hand2", "suction-tube", "--pedal", "always", "--hand-at-mm=-4.5,0"]
        words = [os.path.join(o.programs, "tact"), "run", o.scene, "--headless", "--quiet", "--session", "soak", "--seconds", o.seconds,
                 "--rate", o.rate, "--record", self.recording, *o.more]
        began = time.monotonic()
        with open(self.log, "w") as log:  # a full pipe would make the controller drop log lines
            run = subprocess.Popen(list(map(str, words)), env=self.env, stdout=subprocess.DEVNULL, stderr=log)
        names = {"tact-gui", "tact-rt", "tact-record"}
        try:
            while run.poll() is None:
                time.sleep(1.0)
                pids = children_of(run.pid)
                if names <= pids.keys():
                    self.sample(time.monotonic() - began, pids)
        except BaseException:
            run.send_signal(signal.SIGTERM)
            run.wait()
            raise
        with open(self.log) as log:
            said = log.read()[-4000:]
        self.claim("the run ended normally" + ("" if run.returncode == 0 else ": %d\n%s" % (run.returncode, said)), run.returncode == 0)

    def judge(self):
        summary = {}
        for name, points in self.series.items():
            points = points[max(len(points) // 10, min(3, len(points) - 1)):]
            began, rises = line(points)
            values = [v for _, v in points]
            summary[name] = {"began": began, "rises": rises, "median": median(values), "least": min(values), "most": max(values),
                             "samples": len(points)}
            unit = (1 / 1048576, "MiB") if "resident" in name or "heap" in name else (1.0, "")
            text = "%s: %.2f %s, rises by %+.3f" % (name, began * unit[0], unit[1], rises * unit[0])
            if name in LIMITS:
                most = max(LIMITS[name][0], LIMITS[name][1] * began)
                self.claim(text + ", at most %.1f" % (most * unit[0]), rises <= most + 1e-9)
            elif name == "recorder resident":
                self.claim(text + ", never above %d" % (RECORDER_MOST >> 20), max(values) <= RECORDER_MOST)
            elif self.o.times:
                self.claim(text, abs(rises) <= TIME_RISES * began)
            else:
                print("     " + text)
        for name in (*LIMITS, "recorder resident"):
            if len(self.series.get(name, [])) < 5:
                self.claim("%s has at least five samples" % name, False)
        servo, frames = self.said["servo"], self.said["gui"]["frames"]
        summary["cycles"], summary["events"], summary["frames"] = servo["cycles"], servo["events"], frames["count"]
        summary["late"], summary["frame_ms"], summary["overruns"] = frames["late"], frames["frame_ms"], servo["overruns"]
        print("     %d cycles, %d events, %d overruns; %d frames, %d late of %.1f ms, p50 %.1f, p99 %.1f" %
              (servo["cycles"], servo["events"], servo["overruns"], frames["count"], frames["late"], frames["due_ms"],
               frames["frame_ms"]["p50"], frames["frame_ms"]["p99"]))
        self.claim("servo thread: %d allocations, %d locks" % (servo["allocations"], servo["locks"]),
                   servo["allocations"] == 0 and servo["locks"] == 0)
        return summary

    def look_into_recording(self, summary):
        import h5py
        with h5py.File(self.recording, "r") as f:
            missing = [a for a in ATTRIBUTES if a not in f.attrs]
            for group, columns in COLUMNS.items():
                missing += [group] if group not in f else ["%s/%s" % (group, c) for c in columns if c not in f[group]]
            self.claim("h5py opens its recording, with the layout of RECORDING.md" + (": missing " + ", ".join(missing) if missing else ""),
                       not missing)
            if missing:
                return
            steps, cycles = f["cycles/step"], f["cycles/cycle"].shape[0]
            lengths = {f["cycles"][c].shape[0] for c in f["cycles"]} | {f["hand0"][c].shape[0] for c in f["hand0"]}
            lost = int(f["drops/records"][:].sum()) if f["drops/records"].shape[0] else 0
            rising = bool((steps[1:] > steps[:-1]).all()) if steps.shape[0] < 1e8 else True
            changes = f["levels/level"].shape[0]
            summary["recording"] = {"cycles": cycles, "bytes": os.path.getsize(self.recording), "lost": lost, "level_changes": changes,
                                    "events": f["events/code"].shape[0]}
            self.claim("the recording holds %d cycles in %.2f GB, steps increase, columns have equal length; %d lost, %d level changes, %d events" %
                       (cycles, os.path.getsize(self.recording) / 1e9, lost, changes, f["events/code"].shape[0]),
                       rising and len(lengths) == 1 and cycles >= 0.9 * summary["cycles"] and int(f.attrs["end"]) == 1)


def main():
    words, more = sys.argv[1:], []
    if "--" in words:
        at = words.index("--")
        words, more = words[:at], words[at + 1:]
    p = argparse.ArgumentParser()
    p.add_argument("programs")
    p.add_argument("scene")
    p.add_argument("--seconds", type=float, default=25.0)
    p.add_argument("--rate", type=float, default=6000.0)
    p.add_argument("--times", action="store_true")
    p.add_argument("--json")
    p.add_argument("--folder", help="Folder for the recording; two hours of data take some GB")
    o = p.parse_args(words)
    o.more = more
    if shutil.which("Xvfb") is None:
        print("skipped: Xvfb is not installed")
        return 77
    try:
        import h5py  # noqa: F401
    except ImportError:
        print("skipped: h5py is not installed")
        return 77
    soak = Soak(o)
    try:
        soak.run()
        if soak.said:
            summary = soak.judge()
            soak.look_into_recording(summary)
            if o.json:
                with open(o.json, "w") as f:
                    json.dump({"seconds": o.seconds, "rate_hz": o.rate, "figures": summary, "series": soak.series}, f)
        else:
            soak.claim("the controller reported its status", False)
    finally:
        shutil.rmtree(soak.dir, ignore_errors=True)
    return 1 if soak.bad else 0


if __name__ == "__main__":
    sys.exit(main())
