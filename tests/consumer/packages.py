#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges Debian packages.

    packages.py --program exactvo --source SOURCE (--pack BUILD | DEB...)

No file is in two packages, and each package has its licence and its changes. exactvo-verify has its own files and no others, depends on the
libraries of C and GMP alone, and, in a folder with nothing but itself and these, verifies a certificate and refuses a forged one. With
--pack the package exactvo-verify of a build is made and judged. Status 77: there is nothing to judge, or changing the root is not allowed.
"""
import argparse
import gzip
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
VERIFY = {"usr/bin/exactvo-verify", "usr/share/man/man1/exactvo-verify.1.gz",
          "usr/share/doc/exactvo-verify/copyright", "usr/share/doc/exactvo-verify/changelog.gz"}


def run(*command, **options):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)


def must(*command):
    done = run(*command)
    require(done.returncode == 0, *command, done.stdout, done.stderr)
    return done.stdout


def require(holds, *what):
    if not holds:
        sys.exit("failed: " + " ".join(str(w) for w in what))


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


def field(deb, name):
    return must("dpkg-deb", "--field", deb, name).strip()


def names(relations):
    """The packages of a field such as Depends, without versions."""
    return {re.split(r"[ (:]", word.strip())[0] for word in relations.split(",") if word.strip()}


def files_of(deb, folder):
    must("dpkg-deb", "--extract", deb, folder)
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_symlink() or not path.is_dir()}


def bring_libraries(packages, root):
    """Copies the shared libraries of installed packages."""
    count = 0
    for line in must("dpkg", "--listfiles", *sorted(packages)).splitlines():
        path = Path(line)
        if re.search(r"/lib[^ ]*/[^/]+\.so[.0-9]*$", line) and path.is_file() and "gconv" not in line:
            target = root / line.lstrip("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
            target.chmod(0o755)
            count += 1
    return count


def judge_verify(deb, root, program, source):
    found = files_of(deb, root)
    require(found == VERIFY, "files of exactvo-verify:", sorted(found ^ VERIFY))
    page = gzip.decompress((root / "usr/share/man/man1/exactvo-verify.1.gz").read_bytes()).decode()
    require(page.startswith('.TH "EXACTVO-VERIFY" "1"'), page[:80])
    require(b".symtab" not in (root / "usr/bin/exactvo-verify").read_bytes(), "exactvo-verify is not stripped")
    needed = names(field(deb, "Depends"))
    require(needed == {"libc6", "libgmp10"}, "exactvo-verify depends on", sorted(needed))
    require(not field(deb, "Pre-Depends"), "exactvo-verify pre-depends on", field(deb, "Pre-Depends"))

    enter = ["chroot"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "chroot"]
    alone = lambda *arguments: run(*enter, root, "/usr/bin/exactvo-verify", *arguments)
    if run(*enter, "/", "true").returncode != 0:
        skip("changing the root is not allowed")
    require(alone("--version").returncode != 0, "exactvo-verify runs without libraries: it was not alone")
    libraries = bring_libraries(needed, root)
    version = alone("--version")
    require(version.returncode == 0 and version.stdout.startswith(f"exactvo-verify {field(deb, 'Version')}\n"), version.stdout, version.stderr)
    require("Usage: exactvo-verify" in alone("--help").stdout, "--help")
    # Start and goal are apart, of which the program's exit status is 1.
    answer = run(program, "route", source / "datasets/data/office/floor.geojson", "--from", "2,3", "--to", "18,7", "--radius", "0.65", "--json").stdout
    forged = answer.replace('"radius":0.65', '"radius":0.5')  # the gap is 1.2 m wide
    require(forged != answer, "there is no radius to forge in", answer[:200])
    for text, status, words in ((answer, 0, "1 certificate, 1 valid"), (forged, 1, "1 certificate, 0 valid")):
        (root / "answer.jsonl").write_text(text)
        done = alone("/answer.jsonl")
        require(done.returncode == status and words in done.stdout, done.returncode, done.stdout, done.stderr)
    print(f"exactvo-verify: with {libraries} libraries of {', '.join(sorted(needed))} and nothing else 1 certificate is verified, 1 forged one refused")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--pack", type=Path)
    parser.add_argument("debs", nargs="*", type=Path)
    flags = parser.parse_args()
    for tool in ("dpkg", "dpkg-deb", "dpkg-shlibdeps", "cpack"):
        if not shutil.which(tool):
            skip(f"{tool} is missing")
    with tempfile.TemporaryDirectory(prefix="exactvo-packages-") as folder:
        work, debs = Path(folder), flags.debs
        if flags.pack:
            if not (flags.pack / "bin/exactvo-verify").exists():
                skip("no exactvo-verify: Coq, OCaml or zarith is missing, or the target exactvo_verify is not built")
            must("cpack", "--config", flags.pack / "CPackConfig.cmake", "-G", "DEB", "-D", "CPACK_COMPONENTS_ALL=verify", "-B", work / "packed")
            debs = sorted((work / "packed").glob("*.deb"))
        require(debs, "no package to judge")
        owner = {}
        by_name = {field(deb, "Package"): deb for deb in debs}
        require(len(by_name) == len(debs), "two packages of one name:", *debs)
        for name, deb in by_name.items():
            for file in sorted(files_of(deb, work / name)):
                require(file not in owner, file, "is in", owner.get(file), "and in", name)
                owner[file] = name
            for file in ("copyright", "changelog.gz"):
                require(f"usr/share/doc/{name}/{file}" in owner, name, "has no", file)
        print(f"{len(owner)} files of {len(debs)} packages, none in two")
        if "exactvo-verify" in by_name:
            judge_verify(by_name["exactvo-verify"], work / "alone", flags.program, flags.source)
        if "exactvo" in by_name:
            recommended = names(field(by_name["exactvo"], "Recommends"))
            require(("exactvo-verify" in recommended) == ("exactvo-verify" in by_name), "exactvo recommends", sorted(recommended))


main()
