#!/usr/bin/env python3
"""tact certify on scenes that tact-prep makes: exit codes, table and JSON, and its answer to a scene without a reference.

usage: certify_cli_test.py FOLDER_OF_PROGRAMS
"""
import json
import pathlib
import subprocess
import sys
import tempfile

BIN = pathlib.Path(sys.argv[1])


def run(program, *arguments):
    return subprocess.run([BIN / program, *map(str, arguments)], capture_output=True, text=True, timeout=300, check=False)


def expect(condition, what, result):
    if not condition:
        sys.exit(f"{what}: exit {result.returncode}\n{result.stdout}\n{result.stderr}")


with tempfile.TemporaryDirectory() as folder:
    surface, field = pathlib.Path(folder) / "surface.tact", pathlib.Path(folder) / "field.tact"
    for name, options in (("touch", ["--parts", 20, "--no-forest", "--no-picture", "-o", surface]), ("field", ["-o", field])):
        made = run("tact-prep", "demo", name, *options)
        expect(made.returncode == 0, f"baking demo {name}", made)

    kept = run("tact", "certify", surface, "--poses", 20000, "--json")
    expect(kept.returncode == 0, "a scene whose promises are kept", kept)
    promises = json.loads(kept.stdout)["promises"]
    expect({p["name"] for p in promises} >= {"surface.settled", "surface.energy"}, "its promises", kept)
    for promise in promises:
        expect(promise["steps"] > 0 and promise["violations"] == 0 and 0 <= promise["worst_ratio"] <= 1, promise["name"], kept)

    table = run("tact", "certify", surface, "--poses", 2000)
    expect(table.returncode == 0 and "worst ratio" in table.stdout and "surface.settled" in table.stdout, "the table", table)
    expect(table.stderr == "", "no progress without a terminal", table)

    unknown = run("tact", "certify", field)
    expect(unknown.returncode == 1 and "no reference" in unknown.stderr and "fix:" in unknown.stderr, "a scene without a reference", unknown)
    expect(run("tact", "certify").returncode == 2, "without a scene", unknown)
    expect(run("tact", "certify", surface, "--poses", "few").returncode == 2, "with a wrong number", unknown)
