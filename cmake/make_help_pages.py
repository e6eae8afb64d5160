# SPDX-License-Identifier: GPL-3.0-or-later
"""Man pages and shell completion from what the program itself prints, so that they cannot differ from it.

    make_help_pages.py PROGRAM OUT

writes OUT/man/exactvo.1, OUT/man/exactvo-VERB.1, OUT/completions/exactvo.bash and OUT/completions/_exactvo (zsh).

    make_help_pages.py PROGRAM OUT VERSION

writes OUT/man/NAME.1 of a program without verbs, such as exactvo-verify.
"""
import re
import subprocess
import sys
from pathlib import Path



class Help:
    """A help text in parts: what it is for, how it is called, titled sections, the lines at its end."""

    def __init__(self, text):
        lines = text.rstrip("\n").split("\n")
        self.purpose, self.usage = lines[0], lines[1].removeprefix("Usage: ")
        self.sections, self.end = [], []
        title = None
        for line in lines[2:]:
            if re.fullmatch(r"[A-Z][^:]*:", line):
                title = line[:-1]
                self.sections.append((title, []))
            elif line and not line.startswith(" "):
                self.end.append(line)
                title = None
            elif title is not None:
                self.sections[-1][1].append(line)

    def section(self, title):
        return next((lines for name, lines in self.sections if name == title), [])

    def entries(self, title):
        """(name, words) of a section of options or subcommands; a long name has its words on the next line."""
        found = []
        for line in self.section(title):
            entry = re.match(r"  (\S.*?)(?:\s{2,}(.*))?$", line) if re.match(r"  \S", line) else None
            if entry:
                found.append([entry[1], entry[2] or ""])
            elif line.strip() and found:
                found[-1][1] = (found[-1][1] + " " + line.strip()).strip()
        return [tuple(entry) for entry in found]

    def options(self):
        """(names, words): the names as they are typed."""
        return [(re.findall(r"(?<![\w-])--?[\w-]+", name.split(" ")[0]), words) for name, words in self.entries("Options")]


def asked(program, *arguments):
    return Help(subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout)


# --- Man pages ---


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga").replace("^", "\\(ha").replace("~", "\\(ti")
    return re.sub(r"^\.", r"\\&.", text)


def man_page(name, page, version, see_also):
    title = name.upper()
    out = [f'.TH "{title}" "1" "" "exactvo {version}" "ExactVO"', ".SH NAME", f"{roff(name)} \\- {roff(page.purpose.rstrip('.'))}"]
    out += [".SH SYNOPSIS", roff(page.usage)]
    for section, lines in page.sections:
        out.append(f'.SH "{section.upper()}"')
        if section in ("Positionals", "Options", "Subcommands", "Exit status"):
            for entry, words in page.entries(section):
                out += [".TP", f".B {roff(entry)}", roff(words) if words else "\\&"]
        else:
            out += [".nf", *(roff(line) if line else ".sp" for line in lines if line or lines.index(line)), ".fi"]
    if page.end:
        out += [".SH NOTES", *map(roff, page.end)]
    out += [".SH SEE ALSO", ", ".join(map(roff, see_also))]
    return "\n".join(out) + "\n"


# --- Completion ---


def bash_completion(verbs):
    cases = "\n".join(f"    {verb}) options='{' '.join(n for names, _ in page.options() for n in names)}' ;;" for verb, page in verbs.items())
    return f"""# bash completion of exactvo, made from its help texts
_exactvo() {{
  local verbs='{" ".join(verbs)} help' current=${{COMP_WORDS[COMP_CWORD]}} verb= options= word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    if [[ $word != -* ]]; then verb=$word; break; fi
  done
  if [[ -z $verb || $verb == help ]]; then
    COMPREPLY=($(compgen -W "$verbs --help --quiet --version" -- "$current"))
    return
  fi
  case $verb in
{cases}
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}}
complete -o filenames -F _exactvo exactvo
"""


def zsh_words(text):
    return re.sub(r"[\[\]:]", lambda m: "\\" + m[0], text).replace("'", "'\\''")


def zsh_completion(verbs):
    listed = "\n".join(f"    '{verb}:{zsh_words(page.purpose)}'" for verb, page in verbs.items())
    cases = []
    for verb, page in verbs.items():
        takes_value = {name: " " in name or "=" in name for name, _ in page.entries("Options")}
        lines = []
        for (names, words), entry in zip(page.options(), takes_value):
            value = ":value:_files" if takes_value[entry] else ""
            lines += [f"        '{name}[{zsh_words(words)}]{value}'" for name in names]
        cases.append(f"    {verb})\n      _arguments \\\n" + " \\\n".join([*lines, "        '*:file:_files'"]) + "\n      ;;")
    return f"""#compdef exactvo
# zsh completion of exactvo, made from its help texts
_exactvo() {{
  local -a verbs
  verbs=(
{listed}
    'help:Print the help of a verb'
  )
  if (( CURRENT == 2 )) || [[ $words[2] == help ]]; then
    _describe verb verbs
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
{chr(10).join(cases)}
  esac
}}
_exactvo "$@"
"""


def main(program, out):
    version = subprocess.run([program, "-V"], check=True, capture_output=True, text=True).stdout.split()[1]
    whole = asked(program, "help")
    verbs = {verb: asked(program, "help", verb) for verb, _ in whole.entries("Subcommands")}
    (out / "man").mkdir(parents=True, exist_ok=True)
    (out / "completions").mkdir(exist_ok=True)
    pages = [f"exactvo-{verb}(1)" for verb in verbs]
    (out / "man/exactvo.1").write_text(man_page("exactvo", whole, version, pages))
    for verb, page in verbs.items():
        others = [p for p in ["exactvo(1)", *pages] if p != f"exactvo-{verb}(1)"]
        (out / f"man/exactvo-{verb}.1").write_text(man_page(f"exactvo-{verb}", page, version, others))
    (out / "completions/exactvo.bash").write_text(bash_completion(verbs))
    (out / "completions/_exactvo").write_text(zsh_completion(verbs))


def single_page(program, out, version):
    (out / "man").mkdir(parents=True, exist_ok=True)
    name = Path(program).name
    (out / f"man/{name}.1").write_text(man_page(name, asked(program, "--help"), version, ["exactvo(1)", "exactvo-audit(1)"]))


if len(sys.argv) == 4:
    single_page(sys.argv[1], Path(sys.argv[2]), sys.argv[3])
else:
    main(sys.argv[1], Path(sys.argv[2]))
