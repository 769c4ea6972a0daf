#!/usr/bin/env python3
"""Finds banned words, each with its replacement and the reason.

Reads all tracked text files (code, comments, configuration, documentation) and prints file:line, word, replacement and reason; exits 1 if there
is any. A line that needs a banned word (an old name in existing files, a word of a foreign interface) ends with the
comment "former name", or is listed in ALLOWED. --self-test proves that it finds each.
"""
import os
import re
import subprocess
import tempfile

import tree_check

# pattern (whole words, any case) -> replacement, reason
BANNED = {
    r"wish(es|ed)?": ("request", "a program requests, it does not wish"),
    r"mend(s|ed|ing)?": ("fix, repair", "known from every issue tracker"),
    r"felt_\w*": ("force map, summed", "only a person feels; a map that makes the force is the force map"),
    r"desk": ("controller (logic of a panel), window state (the file)", "a metaphor that nobody knows"),
    r"verdicts?": ("status, grade", "programs do not judge"),
    r"house": ("housekeeping thread", "known from real-time code"),
    r"(?<!e-)mails?": ("mailbox", "known from real-time code"),
    r"obey(s|ed|ing)?|heed(s|ed|ing)?": ("apply, handle", "machines do not obey"),
    r"tend(s|ed|ing)?": ("slow update, adaptive", "a half of a model is updated slowly"),
    r"posture": ("configuration", "robotics says configuration"),
    r"deeds?": ("action", "every toolkit says action"),
    r"suckers?": ("suction tube", "the surgical term is suction tube or suction irrigator"),
    r"metronome": ("tick source", "it is a source of timer ticks"),
    r"(hil_)?giv(e|es|ing)[ _-]way": ("yield, limit", "machines do not give way"),
    r"picture_(goal|low|high|rate)\w*|--picture-goal": ("display goal, frame rate", "a rate is that of the display"),
    r"hand-over|handed over": ("scene switch, passed on", "scenes are switched"),
    r"seeds?'s? (figures?|table|equations?|experiments?)|the (docking|surface|drilling) seed": ("the paper by its authors", "readers know the authors"),
}
ALLOWED = [
    (r"tests/tidy/words\.py", r".*"),
    (r"tests/STYLE\.md", r".*"),
    (r".*", r"former name"),
    (r".*", r"tends? to (zero|infinity)"),
]
ENDINGS = (".cpp", ".hpp", ".in", ".py", ".sh", ".md", ".toml", ".txt", ".cmake", ".json", ".yml", ".service", ".bash")
WORD = re.compile("|".join(rf"(?P<w{i}>(?<![\w/-])(?:{p})(?![\w-]))" for i, p in enumerate(BANNED)), re.I)


def tracked(root):
    if os.path.isdir(os.path.join(root, ".git")) or os.path.isfile(os.path.join(root, ".git")):
        return subprocess.run(["git", "-C", root, "ls-files"], check=True, capture_output=True, text=True).stdout.split("\n")[:-1]
    found = []
    for folder, names, files in os.walk(root):
        names[:] = [n for n in names if n not in ("build", "out", ".git")]
        found += [os.path.relpath(os.path.join(folder, f), root) for f in files]
    return found


def check(root):
    found = []
    for path in sorted(tracked(root)):
        if not path.endswith(ENDINGS) or not os.path.isfile(os.path.join(root, path)):
            continue
        with open(os.path.join(root, path), encoding="utf-8") as f:
            for number, line in enumerate(f, 1):
                for match in WORD.finditer(line):
                    if any(re.fullmatch(p, path) and re.search(t, line) for p, t in ALLOWED):
                        continue
                    replacement, reason = list(BANNED.values())[int(match.lastgroup[1:])]
                    found.append(f"{path}:{number}: {match.group(0)}: write {replacement} ({reason})")
    return found


def self_test():
    bad = 0
    samples = ["a wish", "mended", "felt_grid", "felt_", "the desk file", "verdict", "house thread", "mail", "obeyed", "heeds", "tended", "posture", "deed",
               "sucker", "metronome", "gives way", "picture_goal_hz", "hand-over", "the docking seed"]
    with tempfile.TemporaryDirectory() as root:
        for sample, wanted in [(s, 1) for s in samples] + [("a suction tube; e-mail is kept: former name", 0), ("random seed", 0)]:
            with open(os.path.join(root, "a.md"), "w", encoding="utf-8") as f:
                f.write(sample + "\n")
            right = len(check(root)) == wanted
            bad += not right
            print(f"{'ok  ' if right else 'FAIL'} {sample}")
    return bad


if __name__ == "__main__":
    tree_check.run(check, self_test, "no banned words")
