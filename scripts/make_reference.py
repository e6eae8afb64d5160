#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of the C++ library by Doxygen, strictly.

    make_reference.py OUT

writes OUT/index.html. Exit status 1 where Doxygen warns of anything or a public name has no documentation, each on a line;
77 where Doxygen is missing.
"""
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run_doxygen(out):
    settings = (ROOT / "docs/site/Doxyfile").read_text(encoding="utf-8") + f'\nOUTPUT_DIRECTORY = "{out}"\n'
    done = subprocess.run(["doxygen", "-"], cwd=ROOT, input=settings, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"make_reference: doxygen: {done.stderr}")
    return [line for line in done.stderr.splitlines() if line.strip()]


def has_words(element):
    parts = (element.find(part) for part in ("briefdescription", "detaileddescription", "inbodydescription"))
    return any(part is not None and "".join(part.itertext()).strip() for part in parts)


def says_all_by_itself(member):
    """Special members: destructors, deleted and defaulted ones."""
    arguments = member.findtext("argsstring") or ""
    return (member.findtext("name") or "").startswith("~") or arguments.endswith(("=delete", "=default"))


def names_in(folder):
    """(name, whether it is documented) of every public name, enumerators and macros among them. Doxygen 1.9.4 warns of neither
    enumerators nor undocumented constructors."""
    for file in sorted(folder.glob("*.xml")):
        for compound in xml.parse(file).getroot().findall("compounddef"):
            kind, scope = compound.get("kind"), compound.findtext("compoundname")
            if kind not in ("class", "struct", "namespace", "file") or compound.get("prot", "public") != "public":
                continue
            if kind in ("class", "struct"):
                yield scope, has_words(compound)
            for member in compound.iter("memberdef"):
                if member.get("prot") != "public" or (kind == "file" and member.get("kind") != "define"):
                    continue
                name = f"{scope}::{member.findtext('name')}"
                if not says_all_by_itself(member):
                    yield name, has_words(member)
                for value in member.findall("enumvalue"):
                    yield f"{name}::{value.findtext('name')}", has_words(value)


def main():
    if shutil.which("doxygen") is None:
        print("skipped: doxygen is missing (Debian: doxygen)")
        sys.exit(77)
    out = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    wrong = run_doxygen(out)
    names = list(names_in(out / "xml"))
    wrong += [f"{name}: no documentation" for name, documented in names if not documented]
    shutil.rmtree(out / "xml")
    for line in wrong:
        print(line, file=sys.stderr)
    if wrong or len(names) < 1000:
        sys.exit(f"make_reference: {len(wrong)} complaints about {len(names)} public names")
    print(f"make_reference: {len(names)} public names, all documented, in {out}/index.html")


if __name__ == "__main__":
    main()
