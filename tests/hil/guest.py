#!/usr/bin/env python3
"""Runs the checks in the machine, one after the other. guest.py BIN SECONDS CHECK...

Per check: /out/NAME.log with its output, and a line in /out/results.tsv: passed, failed or skipped, name, seconds,
last output line. A check is any program; exit code 0 passed, 77 skipped, otherwise failed, also after SECONDS.
"""
import os
import re
import subprocess
import sys
import time

# Messages of the kernel that indicate a real defect. Late wake-ups of an emulated processor do not.
BROKEN = re.compile(r"BUG: (?!.*lockup)|Oops|general protection|scheduling while atomic|refcount_t:|kernel NULL pointer")
ODD = re.compile(r"WARNING:|\bstall|lockup|throttling")


def run_check(path, bin_dir, limit_s):
    name = os.path.basename(path).rsplit(".", 1)[0]
    log = f"/out/{name}.log"
    begun = time.monotonic()
    with open(log, "w", encoding="utf-8") as out:
        try:
            code = subprocess.run([path, bin_dir], stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT,
                                  timeout=limit_s, start_new_session=True, env=dict(os.environ, PYTHONUNBUFFERED="1")
                                  ).returncode
        except subprocess.TimeoutExpired:
            code = -1
            out.write(f"timed out after {limit_s} s\n")
        except OSError as e:
            code = -1
            out.write(f"cannot be run: {e}\n")
    with open(log, encoding="utf-8", errors="replace") as f:
        said = f.read().strip().splitlines() or [f"exit code {code}"]
    return {0: "passed", 77: "skipped"}.get(code, "failed"), name, time.monotonic() - begun, said[-1]


def kernel_log():
    text = subprocess.run(["dmesg"], capture_output=True, text=True, check=False).stdout
    with open("/out/dmesg.log", "w", encoding="utf-8") as f:
        f.write(text)
    lines = text.splitlines()
    bad = [line for line in lines if BROKEN.search(line)]
    odd = [line for line in lines if ODD.search(line)]
    words = (bad + odd + ["no kernel error"])[0]
    return ("failed" if bad else "passed"), "kernel_log", 0.0, words


def main():
    bin_dir, limit_s, checks = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
    os.makedirs(os.environ["TACT_RUNTIME_DIR"], exist_ok=True)
    failed = 0
    with open("/out/results.tsv", "w", encoding="utf-8") as results:
        for one in [lambda c=c: run_check(c, bin_dir, limit_s) for c in checks] + [kernel_log]:
            status, name, seconds, words = one()
            failed += status == "failed"
            results.write(f"{status}\t{name}\t{seconds:.1f}\t{words}\n")
            results.flush()
            print(f"hil: {status} {name} ({seconds:.1f} s)", flush=True)
    return min(failed, 100)


if __name__ == "__main__":
    sys.exit(main())
