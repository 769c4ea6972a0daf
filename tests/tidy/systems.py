#!/usr/bin/env python3
"""Checks that a system is defined by its own folders and one row in each table: no other source names a SceneKind.

Lists every SceneKind::NAME outside the tables, the system's own folders and the tests, as file:line, and
exits 1 if there is one. --self-test proves on a small tree that it finds each kind.
"""
import os
import re
import tempfile

import tree_check

# One row per system.
TABLES = {
    "ipc/scene/file/scene_kinds.hpp",
    "ipc/scene/file/scene_kinds.cpp",
    "prep/cli/systems.cpp",
    "deploy/tact/systems.cpp",
    "rt/start/systems.cpp",
    "gui/window/systems.cpp",
}
# Folders of one system each: PROGRAM/SYSTEM.
SYSTEM_FOLDERS = ["prep", "deploy/tact", "rt/force", "gui"]
EXEMPT = []
NAMES = re.compile(r"\bSceneKind::(\w+)")
ENUM = re.compile(r"enum class SceneKind[^{]*\{([^}]*)\}")
SKIP = {"build", "out", ".git", ".cache"}


def sources(root):
    for folder, names, files in os.walk(root):
        names[:] = sorted(n for n in names if n not in SKIP)
        for f in sorted(files):
            if f.endswith((".cpp", ".hpp")):
                yield os.path.relpath(os.path.join(folder, f), root)


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as f:
        return f.read()


def check(root, exempt):
    kinds = re.findall(r"(\w+)\s*=", ENUM.search(read(root, "ipc/scene/file/scene_kinds.hpp")).group(1))
    found = []
    for path in sources(root):
        if path in TABLES or path.startswith("tests/") or path.split("/")[0] in exempt:
            continue
        for number, line in enumerate(read(root, path).splitlines(), 1):
            for kind in NAMES.findall(line):
                if not any(path.startswith(f"{folder}/{kind}/") for folder in SYSTEM_FOLDERS):
                    found.append(f"{path}:{number}: names SceneKind::{kind}; use the row of a table of systems instead")
    for path in sorted(TABLES):
        if not path.endswith(".cpp") or not os.path.exists(os.path.join(root, path)):
            continue
        rows = set(NAMES.findall(read(root, path)))
        found += [f"{path}:1: has no row for SceneKind::{kind}" for kind in kinds if kind not in rows]
    return found


def self_test():
    tree = {
        "ipc/scene/file/scene_kinds.hpp": "enum class SceneKind : unsigned { docking = 1, surface = 2 };\n",
        "ipc/scene/file/scene_kinds.cpp": "SceneKind::docking SceneKind::surface\n",
        "prep/cli/systems.cpp": "SceneKind::docking SceneKind::surface\n",
        "prep/docking/bake.cpp": "kind = SceneKind::docking;\n",
        "tests/unit/x_test.cpp": "SceneKind::surface\n",
        "rt/main.cpp": "\n",
    }
    changes = {
        "clean": (None, "", None),
        "outside of the tables": ("deploy/tact/run.cpp", "if (kind == SceneKind::docking) {}\n", "deploy/tact/run.cpp:1"),
        "another system's folder": ("prep/docking/bake.cpp", "SceneKind::surface\n", "prep/docking/bake.cpp:1"),
        "a program that is not exempt": ("rt/main.cpp", "SceneKind::surface\n", "rt/main.cpp:1"),
        "a table without a row": ("prep/cli/systems.cpp", "SceneKind::docking\n", "no row for SceneKind::surface"),
    }
    bad = 0
    for name, (path, text, wanted) in changes.items():
        with tempfile.TemporaryDirectory() as root:
            files = dict(tree)
            if path:
                files[path] = text
            for p, content in files.items():
                os.makedirs(os.path.dirname(os.path.join(root, p)), exist_ok=True)
                with open(os.path.join(root, p), "w", encoding="utf-8") as f:
                    f.write(content)
            found = check(root, [])
        right = found == [] if wanted is None else len(found) == 1 and wanted in found[0]
        bad += not right
        print(f"{'ok  ' if right else 'FAIL'} {name}: {found}")
    return bad


if __name__ == "__main__":
    tree_check.run(lambda root: check(root, EXEMPT), self_test, "only tables and their own folders name systems")
