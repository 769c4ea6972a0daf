#!/usr/bin/env python3
"""Counts the results of deploy/test and prints one line: N passed, N failed, N skipped.

usage: summary.py RESULTS. RESULTS contains checks.tsv (status, name), and a folder per preset with ctest.junit and one
GoogleTest XML file per test program. A GoogleTest program counts with its cases, every other test as one. A
program that failed in CTest counts as failed even if its cases passed (it crashed, leaked, or ran too long).
Prints first the last output lines of each failed program, which are far above in the log.
"""
import collections
import os
import sys
import xml.etree.ElementTree as ElementTree

LAST_LINES = 60


def cases_of(path):
    """Returns (status, name) of each case, or None if the program ended before it wrote the file."""
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError):
        return None
    found = []
    for case in root.iter("testcase"):
        name = f'{case.get("classname")}.{case.get("name")}'
        if case.find("failure") is not None:
            found.append(("failed", name))
        elif case.get("result") in ("skipped", "suppressed") or case.get("status") == "notrun":
            found.append(("skipped", name))
        else:
            found.append(("passed", name))
    return found


def preset_results(folder):
    for test in ElementTree.parse(os.path.join(folder, "ctest.junit")).getroot().iter("testcase"):
        name, status = test.get("name"), test.get("status")
        seen = {"run": "passed", "disabled": "skipped", "notrun": "skipped"}.get(status, "failed")
        if status == "notrun" and test.find("skipped") is not None and "Unable to find" in (test.find("skipped").get("message") or ""):
            seen = "failed"
        cases = cases_of(os.path.join(folder, name + ".xml"))
        if not cases:
            yield seen, name
            continue
        for case_status, case in cases:
            yield case_status, f"{name}: {case}"
        if seen == "failed" and not any(s == "failed" for s, _ in cases):
            yield "failed", f"{name}: the program failed, though its cases passed"


def print_failed(preset, folder):
    for test in ElementTree.parse(os.path.join(folder, "ctest.junit")).getroot().iter("testcase"):
        if test.get("status") != "fail":
            continue
        print(f'\n-- {preset}: {test.get("name")} failed after {test.get("time")} s. Its last lines:')
        print("\n".join((test.findtext("system-out") or "no output").rstrip().splitlines()[-LAST_LINES:]))


def main():
    results = sys.argv[1]
    all_of = []
    checks = os.path.join(results, "checks.tsv")
    if os.path.exists(checks):
        with open(checks, encoding="utf-8") as f:
            all_of += [tuple(line.rstrip("\n").split("\t", 1)) for line in f]
    for preset in sorted(os.listdir(results)):
        if os.path.isfile(os.path.join(results, preset, "ctest.junit")):
            all_of += [(status, f"{preset}: {what}") for status, what in preset_results(os.path.join(results, preset))]
            print_failed(preset, os.path.join(results, preset))
    for wanted in ("skipped", "failed"):
        for status, what in all_of:
            if status == wanted:
                print(f"{status}: {what}")
    count = collections.Counter(status for status, _ in all_of)
    print(f'{count["passed"]} passed, {count["failed"]} failed, {count["skipped"]} skipped')
    return 1 if count["failed"] or not count["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
