#!/usr/bin/env python3
"""Checks that includes point downward and are covered by USES.

Reads every CMakeLists.txt and *.cmake for tact_library, tact_program, tact_plugin, tact_test, tact_tests, tact_bench and
tact_fuzz, finds the target of each source (for a header: the target of its .cpp, else the library of its folder), and
reports
  1. an include of another folder's header that the target's USES do not reach,
  2. an include of a folder that ARCHITECTURE's table puts above or beside the including one,
  3. a third-party header outside the folder that wraps it,
  4. an include that does not start at the root or does not exist, and a source that no target lists,
  5. a system that is named outside its program's table of systems.
Prints file:line and the problem, and exits 1 if there is any. --self-test proves on a small tree that it finds each kind.
"""
import os
import re
import tempfile

import tree_check

# Parts of the launcher that its systems may use.
LAUNCHER = ["deploy/tact/baked_run", "deploy/tact/child", "deploy/tact/exec", "deploy/tact/files", "deploy/tact/observer",
            "deploy/tact/run", "deploy/tact/scene_cache", "deploy/tact/signals", "deploy/tact/system_run"]
# Folder -> folders that it may include; the longest matching prefix decides. The folder itself is always allowed.
BELOW = {
    "ipc/base": [],
    "ipc/igtl": ["ipc/base"],
    "ipc/spacenav": ["ipc/base"],
    "ipc/image": ["ipc/base"],
    "ipc/version": [],
    "ipc/manual": ["ipc/base"],
    "ipc/shm": ["ipc/base"],
    "ipc/topics": ["ipc/base", "ipc/shm"],
    "ipc/scene/file": ["ipc/base"],
    "ipc/scene/mesh": ["ipc/base", "ipc/scene/file"],
    "ipc/scene/density": ["ipc/base", "ipc/scene/file", "ipc/scene/mesh"],
    "ipc/scene/bone": ["ipc/base", "ipc/scene/file"],
    "ipc/scene/fit": ["ipc/base", "ipc/scene/file", "ipc/scene/density"],
    "ipc/scene/field": ["ipc/base", "ipc/scene/file"],
    "ipc/scene/session": ["ipc/base", "ipc/scene/file", "ipc/scene/density"],
    "ipc/record": ["ipc/base", "ipc/shm", "ipc/topics"],
    "ipc/recorder": ["ipc/base", "ipc/version", "ipc/manual", "ipc/shm", "ipc/topics", "ipc/record", "ipc/scene/bone", "ipc/scene/file"],
    "ipc/station": ["ipc/base"],
    "hal": ["ipc/base", "ipc/igtl", "ipc/spacenav", "ipc/shm", "ipc/version"],  # shm: mailboxes between a bus pump and the servo
    "rt/force": ["ipc/base", "ipc/scene"],
    # Force models do not include each other. Each includes the topic that it publishes and the commands that it accepts.
    "rt/force/docking": ["ipc/base", "ipc/scene", "ipc/shm/latest", "ipc/topics/bodies", "ipc/topics/command", "ipc/topics/shapes",
                         "rt/force/force_model", "rt/force/force_fade"],
    "rt/force/drilling": ["ipc/base", "ipc/scene", "ipc/shm/latest", "ipc/topics/command", "ipc/topics/drill", "ipc/topics/event",
                          "ipc/topics/touch", "rt/force/force_model", "rt/force/force_fade"],
    "rt/force/field": ["ipc/base", "ipc/scene", "rt/force/force_model", "rt/force/force_fade"],
    "rt/force/surface": ["ipc/base", "ipc/scene", "ipc/shm/latest", "ipc/topics/command", "ipc/topics/touch", "rt/force/force_model",
                         "rt/force/force_fade"],
    "rt/govern": ["ipc/base"],
    "rt/safety": ["ipc/base"],
    # The cycle includes the contract of force models, but no model.
    "rt/servo": ["ipc/base", "ipc/shm", "ipc/topics", "hal/api", "rt/force/force_model", "rt/govern", "rt/safety"],
    "rt/threads": ["ipc/base", "ipc/shm", "ipc/topics", "hal", "rt/force/force_model", "rt/govern", "rt/servo"],
    "rt/config": ["ipc/base", "ipc/shm", "ipc/topics", "hal", "rt/force", "rt/govern", "rt/safety", "rt/servo", "rt/threads"],
    "rt/start": ["ipc", "hal", "rt/force", "rt/servo", "rt/threads", "rt/config"],
    "rt/replay": ["ipc", "hal", "rt/force", "rt/servo", "rt/threads", "rt/config", "rt/start"],
    "rt": ["ipc", "hal"],
    "gui/base": ["ipc/base"],
    "gui/link": ["ipc/base", "ipc/shm", "ipc/topics", "ipc/scene/file"],
    "gui/render": ["ipc/base", "ipc/topics", "ipc/scene"],
    "gui/dashboard": ["ipc/base", "ipc/topics", "gui/base"],
    "gui/input": ["ipc/base", "ipc/spacenav", "gui/dashboard"],
    # The interface between systems and window; systems do not include each other.
    "gui/system": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard"],
    "gui/docking": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard", "gui/system"],
    "gui/surface": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard", "gui/system"],
    "gui/field": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard", "gui/system"],
    "gui/drilling": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard", "gui/system"],
    "gui/stereo": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard"],
    "gui/window": ["ipc", "gui/base", "gui/link", "gui/render", "gui/dashboard", "gui/system", "gui/docking", "gui/surface", "gui/drilling", "gui/field",
                   "gui/stereo", "gui/input"],
    "prep": ["ipc/base", "ipc/image", "ipc/version", "ipc/scene", "ipc/manual"],
    # Systems do not include each other; they share readers, meshes and the console.
    "prep/console": ["ipc/base", "ipc/scene"],
    "prep/docking": ["ipc/base", "ipc/version", "ipc/scene", "prep/codebook", "prep/console", "prep/input", "prep/map", "prep/mesh",
                     "prep/modes", "prep/structure", "prep/synthetic"],
    "prep/search": ["ipc/base", "ipc/manual", "ipc/version", "ipc/scene", "prep/console", "prep/export", "prep/input", "prep/map",
                    "prep/structure"],
    "prep/surface": ["ipc/base", "ipc/version", "ipc/scene", "prep/console", "prep/mesh", "prep/mesh_file", "prep/synthetic"],
    "prep/field": ["ipc/base", "ipc/version", "ipc/scene", "prep/console", "prep/input", "prep/mesh", "prep/volume"],
    "prep/drilling": ["ipc/base", "ipc/version", "ipc/scene", "prep/console", "prep/input", "prep/mesh_file", "prep/synthetic", "prep/volume"],
    "deploy": ["ipc", "rt/force", "hal/probe"],
    "deploy/tact/docking": ["ipc", "rt/force/docking", "rt/force/force_model"] + LAUNCHER,
    "deploy/tact/surface": ["ipc", "rt/force/surface"] + LAUNCHER,
    "deploy/tact/field": ["ipc"] + LAUNCHER,
    "deploy/tact/drilling": ["ipc", "rt/force/drilling"] + LAUNCHER,
    "tests": ["ipc", "hal", "rt", "gui", "prep", "deploy"],
}
# Third-party header -> folders that wrap it.
WRAPPED = [
    (r"libusb", ["hal/usb"]),
    (r"gpiod", ["hal/io"]),
    (r"spnav", ["gui/input/space_mouse", "tests"]),
    (r"igtl[A-Z_]", ["ipc/igtl", "tests"]),
    (r"gemmi/", ["prep", "tests"]),
    (r"fftw3", ["prep/map", "tests"]),
    (r"gdcm", ["prep/volume/dicom_files", "tests/unit/prep_dicom_packed_test"]),
    (r"(imgui|imgui_.*|implot.*|GLFW/.*|epoxy/.*|GL/.*|EGL/.*)(\.h)?$", ["gui", "tests", "deploy/tact/doctor"]),
    (r"png\.h|pngconf", ["ipc/image"]),
    (r"nifti", ["prep/volume/nifti"]),
    (r"hdf5", ["ipc/record/hdf5_file"]),
    (r"zlib\.h", ["ipc/scene/file", "prep", "tests"]),
    (r"CLI/", ["ipc/manual", "ipc/recorder/main", "rt/main", "rt/start/start_options", "rt/replay", "gui", "prep", "deploy", "tests"]),
    (r"toml\+\+|spdlog/", ["rt/main", "rt/start", "rt/replay", "rt/threads", "rt/config", "gui", "prep", "deploy", "hal/sim", "tests"]),
    (r"httplib\.h", ["deploy/tact/metrics_server", "tests"]),
    (r"nlohmann/", ["hal/haply/inverse_messages", "deploy", "prep", "gui", "rt/config/check_config", "rt/start/start_bodies", "rt/replay",
                    "ipc/topics/frames_json", "ipc/recorder/main", "ipc/scene/session", "ipc/station/station_report", "tests"]),
]
# Names that only these files of a folder may use: the tables of its systems.
NAMED = [("gui/", re.compile(r"\bSceneKind::"), ["gui/window/systems.cpp"]),
         ("rt/", re.compile(r"\bSceneKind::"), ["rt/start/systems.cpp"])]
CALL = re.compile(r"\b(tact_library|tact_program|tact_tests|tact_test|tact_bench|tact_fuzz|tact_plugin)\s*\(([^()]*)\)", re.S)
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
KEYWORDS = {"SOURCES", "USES", "SYSTEM", "LABELS", "EXTRA", "TIMEOUT"}
SKIP = {"build", "out", ".git", ".cache"}


def files_under(root):
    for folder, names, files in os.walk(root):
        names[:] = sorted(n for n in names if n not in SKIP)
        for f in sorted(files):
            yield os.path.relpath(os.path.join(folder, f), root)


class Target:
    def __init__(self, name, folder, sources, uses, library):
        self.name, self.folder, self.sources, self.uses, self.library = name, folder, sources, uses, library


FUNCTION = re.compile(r"function\s*\(.*?endfunction\s*\(\s*\)", re.S)


def shared_sources(root, cmake_files):
    """Returns the sources that helper functions add to every target they make."""
    shared = set()
    for path in cmake_files:
        with open(os.path.join(root, path), encoding="utf-8") as f:
            for body in FUNCTION.findall(f.read()):
                shared |= {os.path.join(path.split("/")[0], s) for s in re.findall(r"[\w/]+\.cpp", body)}
    return shared


def read_targets(root, cmake_files):
    targets = []
    for path in cmake_files:
        with open(os.path.join(root, path), encoding="utf-8") as f:
            text = re.sub(r"#.*", "", f.read())
        text = FUNCTION.sub("", text)
        folder = os.path.dirname(path)
        if folder.startswith("tests/") and path.endswith(".cmake"):
            folder = "tests"  # tests/*/*.cmake are included by tests/CMakeLists.txt
        for kind, body in CALL.findall(text):
            lists, now = {"first": []}, "first"
            for word in body.split():
                if word in KEYWORDS:
                    now = word
                    lists[now] = []
                else:
                    lists[now].append(word.strip('"'))
            if not lists["first"]:
                continue
            sources = lists.get("SOURCES", []) + lists.get("EXTRA", [])
            name = lists["first"][0]
            if kind in ("tact_test", "tact_bench"):
                sources = [name] + sources
            sources = [os.path.normpath(os.path.join(folder, s.replace("${CMAKE_SOURCE_DIR}/", "../" * len(folder.split("/")) if folder else "")))
                       for s in sources]
            targets.append(Target(name, folder, sources, set(lists.get("USES", [])), kind == "tact_library"))
    return targets


def owners(path, targets, by_source):
    """Returns the possible targets of a file."""
    if path in by_source:
        return by_source[path]
    stem = os.path.splitext(path)[0]
    if stem + ".cpp" in by_source:
        return by_source[stem + ".cpp"]
    folder = os.path.dirname(path)
    while True:
        here = [t for t in targets if t.folder == folder and folder != "tests"]
        if here or not folder:
            return [t for t in here if t.library]  # empty if the folder belongs to a program: then only the folders are checked
        folder = os.path.dirname(folder)


def reach(target, targets):
    """Returns the names of the libraries that a target reaches through USES, transitively as in CMake."""
    libraries = {t.name: t for t in targets if t.library}
    seen, todo = set(), list(target.uses)
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += libraries[name].uses if name in libraries else []
    return seen


def longest(prefixes, path):
    fits = [p for p in prefixes if path == p or path.startswith(p + "/") or (path.startswith(p) and path[len(p)] in "._")]
    return max(fits, key=len) if fits else None


def check(root):
    found = []
    everything = list(files_under(root))
    known = set(everything)
    cmake_files = [p for p in everything if p.endswith("CMakeLists.txt") or p.endswith(".cmake")]
    targets = read_targets(root, cmake_files)
    shared = shared_sources(root, cmake_files)
    by_source = {}
    for t in targets:
        for s in t.sources:
            by_source.setdefault(s, []).append(t)
    for path in everything:
        if not path.endswith((".hpp", ".cpp")):
            continue
        mine = owners(path, targets, by_source)
        if path.endswith(".cpp") and path not in by_source and path not in shared:
            found.append(f"{path}:1: no target lists this source")
        home = longest(BELOW, path)
        with open(os.path.join(root, path), encoding="utf-8") as f:
            lines = f.readlines()
        for number, line in enumerate(lines, 1):
            for folder, pattern, tables in NAMED:
                if path.startswith(folder) and path not in tables and pattern.search(line):
                    found.append(f"{path}:{number}: only {' and '.join(tables)} may name a kind of scene")
            match = INCLUDE.match(line)
            if not match:
                continue
            quote, target_path = match.groups()
            at = f"{path}:{number}: "
            for pattern, folders in WRAPPED:
                if re.match(pattern, target_path) and longest(folders, path) is None:
                    found.append(f"{at}<{target_path}> belongs to {' or '.join(folders)}")
            if quote == "<":
                continue
            if target_path not in known:
                found.append(f'{at}"{target_path}" is not a path from the root')
                continue
            if home is not None:
                other = longest(BELOW, target_path)
                if other != home and longest(BELOW[home], target_path) is None:
                    if not (target_path.startswith(home + "/")):
                        found.append(f'{at}{home} may not include "{target_path}" (it may: {", ".join(BELOW[home]) or "nothing"})')
                        continue
            theirs = owners(target_path, targets, by_source)
            neighbours = os.path.dirname(path) == os.path.dirname(target_path)
            if not theirs or not mine or set(theirs) & set(mine) or neighbours:
                continue
            # A source listed by several targets needs the library in each of them; a header in a folder of several
            # libraries belongs to an unknown one of them.
            lacking = [t for t in mine if not any(o.name in reach(t, targets) for o in theirs)]
            for t in lacking:
                if path in by_source or len(lacking) == len(mine):
                    found.append(f'{at}"{target_path}" needs USES {theirs[0].name} in target {t.name}')
                    break
    return found


def self_test():
    tree = {
        "ipc/base/CMakeLists.txt": "tact_library(base)",
        "ipc/base/a.hpp": "#pragma once\n",
        "ipc/shm/CMakeLists.txt": "tact_library(shm SOURCES s.cpp USES base)",
        "ipc/shm/s.hpp": '#include "ipc/base/a.hpp"\n',
        "ipc/shm/s.cpp": '#include "ipc/shm/s.hpp"\n',
        "rt/force/CMakeLists.txt": "tact_library(force SOURCES f.cpp surface/t.cpp USES base)",
        "rt/force/docking/d.hpp": "#pragma once\n",
        "rt/force/surface/t.hpp": "#pragma once\n",
        "rt/force/surface/t.cpp": '#include "ipc/base/a.hpp"\n',
        "rt/force/f.hpp": '#include "ipc/base/a.hpp"\n',
        "rt/force/f.cpp": '#include "rt/force/f.hpp"\n',
        "rt/servo/CMakeLists.txt": "tact_library(servo SOURCES l.cpp USES force base)",
        "rt/servo/l.hpp": '#include "ipc/base/a.hpp"\n',
        "rt/servo/l.cpp": '#include "rt/servo/l.hpp"\n',
        "gui/docking/CMakeLists.txt": "tact_library(gui_docking SOURCES g.cpp USES base)",
        "gui/docking/g.cpp": '#include "ipc/base/a.hpp"\n',
        "gui/drilling/h.hpp": "#pragma once\n",
        "tests/unit/x.cmake": "tact_test(unit/x_test.cpp USES shm)",
        "tests/unit/x_test.cpp": '#include "ipc/shm/s.hpp"\n',
    }
    violations = {
        "include above": ("rt/force/f.cpp", '#include "rt/servo/l.hpp"\n', "rt/force may not include"),
        "include beside": ("rt/force/f.cpp", '#include "ipc/shm/s.hpp"\n', "rt/force may not include"),
        "another force model": ("rt/force/surface/t.cpp", '#include "rt/force/docking/d.hpp"\n', "surface may not include"),
        "USES missing": ("tests/unit/x_test.cpp", '#include "rt/force/f.hpp"\n', "needs USES force"),
        "USES missing, allowed folder": ("rt/servo/l.cpp", '#include "ipc/shm/s.hpp"\n', "needs USES shm"),
        "servo and a model": ("rt/servo/l.cpp", '#include "rt/force/surface/t.hpp"\n', "rt/servo may not include"),
        "another system of the window": ("gui/docking/g.cpp", '#include "gui/drilling/h.hpp"\n', "gui/docking may not include"),
        "a kind of scene": ("gui/docking/g.cpp", "auto k = SceneKind::docking;\n", "may name a kind of scene"),
        "third party": ("rt/force/f.cpp", "#include <gemmi/ccp4.hpp>\n", "belongs to prep"),
        "third party, dotted": ("ipc/shm/s.cpp", "#include <imgui.h>\n", "belongs to gui"),
        "relative": ("ipc/shm/s.cpp", '#include "s.hpp"\n', "not a path from the root"),
        "unlisted": ("ipc/shm/new.cpp", "\n", "no target lists"),
    }
    bad = 0
    for name, (path, text, wanted) in [("clean", ("", "", ""))] + list(violations.items()):
        with tempfile.TemporaryDirectory() as root:
            files = dict(tree)
            if path:
                files[path] = files.get(path, "") + text
            for p, content in files.items():
                os.makedirs(os.path.dirname(os.path.join(root, p)), exist_ok=True)
                with open(os.path.join(root, p), "w", encoding="utf-8") as f:
                    f.write(content)
            found = check(root)
        right = found == [] if name == "clean" else len(found) == 1 and wanted in found[0]
        bad += not right
        print(f"{'ok  ' if right else 'FAIL'} {name}: {found}")
    return bad


if __name__ == "__main__":
    tree_check.run(check, self_test, "includes follow USES")
