#!/usr/bin/env python3
"""Checks in the machine code that the servo path calls only arithmetic, copies and the clock.

usage: hot_symbols.py BUILD [--self-test]

Disassembles the objects of the servo path's libraries (x86-64, objdump), takes every call and jump between functions,
and follows them from the entry points of a cycle: Servo::cycle() and the virtual functions it calls on devices, force models
and clocks. A call that leaves these objects must be in ALLOWED, so there is no allocation, lock, throw, file or log, not
even on a branch that no test takes. Calls through other pointers are not followed; the guard that counts allocations at
run time covers them.
"""
import os
import re
import subprocess
import sys
import tempfile

FOLDERS = ["rt/servo", "rt/force", "rt/govern", "rt/safety", "hal/sim", "hal/arm", "hal/io", "hal/tracker", "ipc/scene", "ipc/shm"]
ENTRIES = re.compile(
    r"^tact::Servo::cycle\(\)$"
    r"|::step\(tact::ToolState const&, tact::Budget const&\)$|::reset\(tact::ToolState const&\)$|::bodies\(\) const$|::publish\(tact::ModelCycle const&\)$|::drive\(tact::ToolDrive const&\)$"
    r"|::order\(tact::ModelOrder const&\)$|::adopt\(tact::ForceModel const&\)$|::(stale|knob|give_up|stiffness_n_m)\(\)( const)?$|::items\(float\) const$"
    r"|::read\((unsigned int, tact::TrackerSample|tact::DeviceSample|tact::LinesSample)&, .*\)( const)?$|::write\(tact::(Device|Lines)Command const&, .*\)$|::relax\(\)$"
    r"|^tact::\w*Clock::(now|wait_until)\("
    r"|^tact::density_sum_\w+\(|^tact::query_(generic|avx2|avx512)\(|^tact::brick_(sum|erode|cut)_\w+\(")
ALLOWED = re.compile(
    r"^(mem(cpy|set|move|cmp)(@.*)?|__mem(cpy|set|move)_chk|str(len|nlen|cmp|ncmp)"
    r"|(sin|cos|sincos|tan|asin|acos|atan|atan2|sqrt|exp|exp2|expm1|log|log2|log1p|pow|hypot|cbrt|floor|ceil|round|rint|nearbyint"
    r"|trunc|fmod|fma|fmin|fmax|lround|llround|ldexp|frexp|modf)f?"
    r"|clock_gettime|clock_nanosleep|getrusage|__errno_location|__stack_chk_fail|__tls_get_addr"
    r"|tact::rt_guard::counts\(\)"  # reads counters; its object is left out because it defines malloc itself
    r"|std::terminate\(\)|_Unwind_Resume|__clang_call_terminate|abort)$")
FUNCTION = re.compile(r"^([0-9a-f]+) <(.*)>:$")
BRANCH = re.compile(r"^\s+[0-9a-f]+:\s+(?:bnd |notrack |rep )*(call|j\w+)\s+(.*)$")
RELOCATION = re.compile(r"^\s+[0-9a-f]+: (R_X86_64_\w+)\s+(.*?)([-+]0x[0-9a-f]+)?$")


def disassemble(path, unresolved):
    """Returns {function: set of callees}, without jumps inside a function; adds unresolved calls to unresolved[0]."""
    text = subprocess.run(["objdump", "-drC", "--no-show-raw-insn", path], capture_output=True, text=True, check=True).stdout
    starts, section, calls, now = {}, "", {}, None
    pending = None
    rows = []  # (caller, callee text or (section, offset))
    for line in text.splitlines():
        if line.startswith("Disassembly of section "):
            section = line[len("Disassembly of section "):-1]
            continue
        function = FUNCTION.match(line)
        if function:
            now = function.group(2)
            starts.setdefault(section, []).append((int(function.group(1), 16), now))
            calls.setdefault(now, set())
            pending = None
            continue
        relocation = RELOCATION.match(line)
        if relocation:
            if pending is not None:
                kind, name, addend = relocation.groups()
                if name.startswith(".text"):
                    rows[pending] = (now, (name, int(addend or "0", 16) + 4))
                else:
                    rows[pending] = (now, name)
                pending = None
            continue
        pending = None
        branch = BRANCH.match(line)
        if branch:
            named = re.search(r"<(.*?)(\+0x[0-9a-f]+)?>$", branch.group(2))
            rows.append((now, named.group(1) if named else None))
            pending = len(rows) - 1
    for caller, callee in rows:
        if isinstance(callee, tuple):
            inside = [name for start, name in sorted(starts.get(callee[0], [])) if start <= callee[1]]
            callee = inside[-1] if inside else None
        if callee is None:
            unresolved[0] += 1  # through a pointer
        elif callee != caller:
            calls[caller].add(callee)
    return calls


def plain(name):
    return re.sub(r"( \[clone [^\]]*\])+$|\.(cold|part|isra|constprop)(\.\d+)?$", "", name)


def walk(calls):
    """Returns (entries, reached functions, call paths to functions that are not allowed)."""
    entries = sorted(f for f in calls if ENTRIES.search(plain(f)) and "[clone" not in f)
    came_from = {e: None for e in entries}
    todo, bad = list(entries), []
    while todo:
        f = todo.pop()
        for callee in sorted(calls[f]):
            if callee in calls:
                if callee not in came_from:
                    came_from[callee] = f
                    todo.append(callee)
            elif not ALLOWED.match(callee):
                path, at = [callee], f
                while at is not None:
                    path.append(at)
                    at = came_from[at]
                bad.append(" <- ".join(path))
    return entries, set(came_from), bad


def objects_of(build):
    for folder in FOLDERS:
        for where, _, names in os.walk(os.path.join(build, folder)):
            for name in sorted(names):
                if name.endswith(".o") and "rt_guard.cpp" not in name:
                    yield os.path.join(where, name)
    hal = os.path.join(build, "hal", "CMakeFiles")
    for where, _, names in os.walk(hal):
        if os.path.basename(where) == "sim":
            yield from (os.path.join(where, n) for n in sorted(names) if n.endswith(".o"))


def check(objects):
    calls, unresolved = {}, [0]
    for path in objects:
        for f, callees in disassemble(path, unresolved).items():
            calls.setdefault(f, set()).update(callees)
    entries, reached, bad = walk(calls)
    return entries, reached, bad, unresolved[0]


def self_test():
    source = """
    #include <cmath>
    #include <mutex>
    #include <string>
    #include <vector>
    namespace tact {
    struct Servo { void cycle(); double x; std::vector<double>* v; std::mutex* m; };
    #ifdef BAD
    __attribute__((noinline)) static void deep(Servo& s) { if (s.x > 3.0) { BAD; } }
    #else
    __attribute__((noinline)) static void deep(Servo& s) { s.x += 1.0; }
    #endif
    void Servo::cycle() { x = std::sin(x); deep(*this); }
    void unrelated(std::string& s) { s += "grows"; }
    }"""
    wanted = {"": None, "s.v->push_back(1.0)": "operator new", "throw 1": "__cxa_", "s.m->lock()": "pthread_mutex_lock",
              "std::puts(\"hi\")": "puts", "(void)s.v->at(5)": "__throw_out_of_range"}
    failures = 0
    for bad, word in wanted.items():
        with tempfile.TemporaryDirectory() as folder:
            cpp, obj = os.path.join(folder, "a.cpp"), os.path.join(folder, "a.o")
            with open(cpp, "w", encoding="utf-8") as f:
                f.write("#include <cstdio>\n" + source)
            subprocess.run(["c++", "-std=c++20", "-O2", "-c", cpp, "-o", obj] + ([f"-DBAD={bad}"] if bad else []), check=True)
            entries, _, found, _ = check([obj])
        right = entries == ["tact::Servo::cycle()"] and (any(word in b for b in found) if word else not found)
        failures += not right
        print(f"{'ok  ' if right else 'FAIL'} {bad or 'clean'}: {found}")
    return failures


def main():
    if "--self-test" in sys.argv:
        return 1 if self_test() else 0
    entries, reached, bad, pointers = check(list(objects_of(sys.argv[1])))
    for wanted in ("tact::Servo::cycle()", "::step(", "::read(", "::write("):
        if not any(wanted in e for e in entries):
            bad.append(f"no entry point matches {wanted}; fix ENTRIES or build first")
    print("\n".join(sorted(set(bad))))
    print(f"{len(entries)} entry points, {len(reached)} functions reached, {pointers} calls through pointers, {len(set(bad))} wrong")
    if "--entries" in sys.argv:
        print("\n".join(entries))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
