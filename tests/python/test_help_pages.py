# SPDX-License-Identifier: GPL-3.0-or-later
"""Man pages and completion name every verb and option that the program's help has."""
import re
import shutil
import subprocess
import sys

import pytest


@pytest.fixture
def pages(source, program, tmp_path):
    import os

    subprocess.run([sys.executable, source / "cmake/make_help_pages.py", os.environ["EXACTVO_PROGRAM"], tmp_path], check=True)
    return tmp_path


def verbs(program):
    return re.findall(r"^  ([a-z]+) {2,}", program("help").split("Subcommands:")[1].split("Examples:")[0], re.M)


def options(program, verb):
    text = program("help", verb).split("\nOptions:\n")[1].split("\nExamples:")[0]
    return {name for line in re.findall(r"^  (-\S+)", text, re.M) for name in line.split(",")}


def test_every_option_of_every_verb_is_there(pages, program):
    zsh = (pages / "completions/_exactvo").read_text()
    names = verbs(program)
    assert len(names) >= 15
    for verb in names:
        man = (pages / f"man/exactvo-{verb}.1").read_text().replace("\\-", "-")
        for option in options(program, verb):
            assert option in man and f"'{option}[" in zsh, (verb, option)


def test_bash_completes_verbs_and_options(pages, program):
    bash = shutil.which("bash")
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _exactvo; printf "%s\\n" "${COMPREPLY[@]}"'

    def complete(*words):
        return set(subprocess.run(
            [bash, "-c", script, "bash", pages / "completions/exactvo.bash", *words], capture_output=True, text=True, check=True
        ).stdout.split())  # fmt: skip

    assert {*verbs(program), "help"} <= complete("exactvo", "")
    assert complete("exactvo", "sim") == {"simulate"}
    for verb in verbs(program):
        assert complete("exactvo", verb, "--") == {o for o in options(program, verb) if o.startswith("--")}


def test_man_and_zsh_read_them_without_a_warning(pages):
    if shutil.which("groff"):
        for page in (pages / "man").glob("*.1"):
            done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-K", "utf8", page], capture_output=True, text=True, check=True)
            assert done.stderr == "" and page.stem.upper() in done.stdout
    if shutil.which("zsh"):
        subprocess.run(["zsh", "-n", pages / "completions/_exactvo"], check=True)
