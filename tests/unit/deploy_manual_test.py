#!/usr/bin/env python3
"""Man pages and bash completion of all programs have the same content as --help.

deploy_manual_test.py BIN: generates both with the programs in BIN, reads --help of every program and command, and presses TAB in
bash. Pages are set by groff, where it is installed, without a warning.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAMS = ["tact", "tact-bench", "tact-certify", "tact-gui", "tact-prep", "tact-record", "tact-refine", "tact-replay", "tact-reproduce",
            "tact-rt", "tact-search"]
# Programs started by a command of tact, which print their own --help.
OWN_PROGRAMS = {"tact-bench", "tact-certify", "tact-record", "tact-refine", "tact-reproduce", "tact-search"}
BIN = pathlib.Path(".")
HELPERS = pathlib.Path("/usr/share/bash-completion/bash_completion")

PRESS = r"""
while IFS= read -r line; do
    eval "COMP_WORDS=($line)"
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    COMPREPLY=()
    _tact_complete
    printf '%s\t' "${COMPREPLY[@]}"
    printf '\n'
done
"""


def generate(folder, **environment):
    subprocess.run([ROOT / "deploy/manual/generate.sh", BIN, folder], check=True, env={**os.environ, **environment})


def read_help(words):
    """Returns the options and commands printed by --help."""
    text = subprocess.run([BIN / words[0], *words[1:], "--help"], check=True, capture_output=True, text=True).stdout
    options = set()
    for names in re.findall(r"^ {2,6}(-[^\s{]+)", text, re.M):
        options |= set(names.split(","))
    commands = []
    if "\nSubcommands:\n" in text:
        listed = text.split("\nSubcommands:\n")[1].split("\n\n")[0]
        commands = re.findall(r"^ {2}(\S+)", listed, re.M)
    return options, commands


def all_commands():
    """Returns (words, options, commands) of every program and command, except commands executed by another program."""
    todo = [[p] for p in PROGRAMS]
    while todo:
        words = todo.pop()
        options, commands = read_help(words)
        yield words, options, commands
        todo += [words + [c] for c in commands if "-".join(words + [c]) not in OWN_PROGRAMS]


# Beginnings of help texts that are not self-contained.
FRAGMENTS = ("of ", "its ", "what ", "who ", "where ", "which ", "their ", "so many ")
# Programs with their own tests of help texts.
NOT_READ = {"tact-gui"}


def help_texts(words):
    """Returns the texts of options, commands and the program from --help, each on one line."""
    text = subprocess.run([BIN / words[0], *words[1:], "--help"], check=True, capture_output=True, text=True).stdout
    lines = re.sub(r"\n {20,}", " ", re.sub(r"(?m)^( {2,6}\S.*)\n {20,}", r"\1  ", text)).splitlines()
    rows = [re.split(r" {2,}", line.strip(), maxsplit=1) for line in lines if line.startswith("  ")]
    return [lines[0]] + [row[-1] for row in rows if len(row) == 2]


def section_of(folder, words):
    """Returns the part of a man page that describes a command, with unescaped '-'."""
    name = "-".join(words)
    if len(words) > 1 and name in PROGRAMS:
        text = (folder / "man1" / f"{words[0]}.1").read_text()
        return re.search(rf'^\.SH "{words[-1].upper()}"\n.*?(?=^\.SH)', text, re.M | re.S).group().replace("\\-", "-")
    text = (folder / "man1" / f"{name}.1").read_text().replace("\\-", "-")
    return re.sub(r'^\.SH "REPLAY"\n.*?(?=^\.SH)', "", text, flags=re.M | re.S)


def press_tab(completion, lines, folder, before=""):
    """Returns bash's completions for the last word of each line."""
    done = subprocess.run(["bash", "--norc", "--noprofile", "-c", f"{before}\n. {completion} || exit\n{PRESS}"], check=True,
                          input="\n".join(lines) + "\n", capture_output=True, text=True, cwd=folder)
    if done.stderr:
        raise AssertionError(done.stderr)
    return [set(line.split("\t")) - {""} for line in done.stdout.splitlines()]


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        generate(cls.folder)
        cls.pages = sorted((cls.folder / "man1").glob("*.1"))
        cls.completion = cls.folder / "completions/tact"
        cls.commands = list(all_commands())

    def test_pages_have_exactly_the_options_of_help(self):
        self.assertGreater(len(self.commands), 30)
        for words, options, _ in self.commands:
            heads = re.findall(r"^\.TP\n(\\fB-.*)$", section_of(self.folder, words), re.M)
            shown = {name for head in heads for name in re.findall(r"\\fB(--?\w[\w-]*)\\fR", head)}
            self.assertEqual(shown, options, words)

    def test_pages_have_the_commands_of_help(self):
        for words, _, commands in self.commands:
            section = section_of(self.folder, words).partition("\n.SH COMMANDS\n")[2].partition("\n.SH ")[0]
            self.assertEqual(re.findall(r"\.TP\n\\fB([\w-]+)\\fR\n", section), commands, words)

    def test_every_command_has_a_page_and_every_page_a_command(self):
        wanted = {"-".join(words) for words, _, _ in self.commands} | OWN_PROGRAMS
        self.assertEqual({p.stem for p in self.pages}, wanted)

    def test_completion_has_exactly_the_options_and_commands_of_help(self):
        lines = [" ".join(words) + " -" for words, _, _ in self.commands]
        for (words, options, _), offered in zip(self.commands, press_tab(self.completion, lines, self.folder)):
            self.assertEqual(offered, options, words)
        parents = [(words, commands) for words, _, commands in self.commands if commands]
        lines = [" ".join(words) + " ''" for words, _ in parents]
        for (words, commands), offered in zip(parents, press_tab(self.completion, lines, self.folder)):
            self.assertEqual(offered, set(commands), words)

    def test_help_does_not_print_the_hidden_requests(self):
        for words, options, _ in self.commands:
            self.assertTrue(options.isdisjoint({"--manual", "--completion"}), words)

    def test_every_help_text_stands_alone(self):
        read = 0
        for words, _, _ in self.commands:
            if words[0] in NOT_READ:
                continue
            for text in help_texts(words):
                read += 1
                self.assertFalse(text.lower().startswith(FRAGMENTS), (words, text))
        self.assertGreater(read, 300)

    def test_help_shows_nothing_of_the_parser(self):
        for words, _, _ in self.commands:
            text = subprocess.run([BIN / words[0], *words[1:], "--help"], check=True, capture_output=True, text=True).stdout
            for internal in ("} OR {", "->", "TEXT:", "FLOAT", "UINT", " in [", "REQUIRED", "Excludes:", "Needs:"):
                self.assertNotIn(internal, text, words)

    def test_groff_sets_every_page_without_a_warning(self):
        if shutil.which("groff") is None:
            self.skipTest("no groff here")
        for page in self.pages:
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", page], check=True, capture_output=True)
            self.assertEqual(done.stderr, b"", page)
            self.assertGreater(len(done.stdout), 500, page)

    def test_pages_are_plain_ascii_and_show_nothing_of_the_parser(self):
        for page in self.pages:
            text = page.read_bytes().decode("ascii")
            self.assertNotIn("\t", text, page)
            for internal in ("} OR {", "->", "TEXT:", "FLOAT", "UINT", " in ["):
                self.assertNotIn(internal, text.replace("\\-", "-"), page)

    def test_pages_are_dated_by_source_date_epoch_alone(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            generate(folder)
            for page in self.pages:
                self.assertEqual((folder / "man1" / page.name).read_bytes(), page.read_bytes())
            generate(folder, SOURCE_DATE_EPOCH="86400")
            self.assertIn('.TH TACT 1 "1970-01-02" "Tact ', (folder / "man1/tact.1").read_text())

    def test_tab_completes_commands_options_choices_and_files(self):
        with tempfile.TemporaryDirectory() as name:
            for f in ("a.mrc", "b.map.gz", "c.pdb", "d.CIF", "e f.tact", "g.stl", "h.h5", "i.txt", "j.toml", "k.csv"):
                (pathlib.Path(name) / f).touch()
            (pathlib.Path(name) / "folder").mkdir()
            cases = {
                "tact do": {"dock", "doctor"},
                "/usr/bin/tact do": {"dock", "doctor"},
                "tact run --he": {"--headless", "--help"},
                "tact demo ''": {"dock", "drill", "field", "touch", "train"},
                "tact record --fl": {"--flight"},
                "tact demo touch --shape ''": {"terrain", "sphere", "smooth-sphere"},
                "tact demo touch --shape = s": {"sphere", "smooth-sphere"},
                "tact demo touch --shape =": {"terrain", "sphere", "smooth-sphere"},
                "tact demo touch --shape=te": {"--shape=terrain"},
                "tact run --law el": {"elastic"},
                "tact run --law elastic --he": {"--headless", "--help"},
                "tact-gui --molecule t": {"trace", "tube"},
                "tact-rt --mode ''": {"off-brute", "off-tree", "chr"},
                "tact bench s": {"servo", "surface"},
                "tact run ''": {"e f.tact", "folder"},
                "tact run --seconds 5 ''": {"e f.tact", "folder"},
                "tact run --seconds ''": set(),
                "tact dock ''": {"a.mrc", "b.map.gz", "folder"},
                "tact dock a.mrc ''": {"c.pdb", "d.CIF", "folder"},
                "tact dock a.mrc c.pdb ''": {"c.pdb", "d.CIF", "folder"},
                "tact-prep dock a.mrc c.pdb -o ''": {"e f.tact", "folder"},
                "tact touch ''": {"g.stl", "folder"},
                "tact replay ''": {"h.h5", "folder"},
                "tact-replay ''": {"h.h5", "folder"},
                "tact-rt e.tact --config ''": {"j.toml", "folder"},
                "tact run --out ''": {"folder"},
                "tact drill i": {"i.txt"},
            }
            before = [""] + ([f". {HELPERS}"] if HELPERS.exists() else [])
            for helpers in before:
                for line, offered in zip(cases, press_tab(self.completion, cases, name, helpers)):
                    self.assertEqual(offered, cases[line], (line, helpers))


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
