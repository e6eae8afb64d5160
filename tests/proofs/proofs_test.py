#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The proven checkers (docs/guide/proofs.md). As ctest runs it:

    proofs_test.py PART --program exactvo --cases proof_cases --claims certificate_cases --build BUILD --source SOURCE [--count 10000] [--seed 1]

axioms        the theorems of Theorems.v rest on the axioms that the guide lists, and on no others
coqchk        Coq's own checker accepts every compiled theory
certificates  what the program writes is verified; each number of it changed is refused
recordings    of runs and crowds likewise; of random crowds the verdict on pairs of robots is that of `audit`
numbers       10 COUNT decimal numbers, many of them half-way between doubles or next to that, are read as the nearest double
command       files, folders, options and exit statuses of exactvo-verify
scenes        recordings of scenes in datasets/data and edited copies: what one of both refutes the other does. From
              `--count 100000` on of all scenes
page          COUNT claims, half of them forged: one verdict from C++, the checker of `view`'s page and the proven one
differential  COUNT / 4 certificates of each of seven kinds, half of them forged: one verdict from the checkers in C++ and the proven one, and
              of 400 routes from the one in Python; of all routes from `--count 100000` on. 10^5 real and 10^5 forged
              ones of each kind are `--count 800000 --seed S`
"""
import argparse
import atexit
import json
import math
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path

SKIPPED = 77
MOST_IN_PYTHON = 400


def run(*command, **options):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)


def require(holds, *what):
    if not holds:
        sys.exit("failed: " + " ".join(str(w) for w in what))


class Tools:
    def __init__(self, flags):
        self.program, self.cases, self.flags = flags.program, flags.cases, flags
        build, self.source = Path(flags.build).resolve(), Path(flags.source)
        self.theories, self.verify = build / "proofs", build / "bin" / "exactvo-verify"
        self.folder = Path(tempfile.mkdtemp(prefix="exactvo-proofs-"))
        atexit.register(shutil.rmtree, self.folder, ignore_errors=True)
        if not self.verify.exists():
            print("skipped: no exactvo-verify; Coq, OCaml or zarith is missing, or the target exactvo_verify is not built")
            sys.exit(SKIPPED)

    def file(self, name, content):
        path = self.folder / name
        path.write_bytes(content) if isinstance(content, bytes) else path.write_text(content)
        return path

    def make(self, *arguments):
        made = run(self.program, *arguments)
        require(made.returncode in (0, 1), arguments, made.stderr)
        return made.stdout

    def verified(self, name, content, *options):
        """(exit status, verdicts, output) of exactvo-verify."""
        done = run(self.verify, self.file(name, content), *options)
        return done.returncode, re.findall(r"^\d+: (.*)$", done.stdout, re.M), done.stdout + done.stderr


# --- Theorems ---


def axioms(tools):
    theorems = re.findall(r"Parameter (\w+_sound)", (tools.source / "proofs/Theorems.v").read_text())
    require(len(theorems) >= 20, "theorems found:", theorems)
    guide = (tools.source / "docs/guide/proofs.md").read_text()
    listed = set(re.findall(r"^\| `([\w.]+)` \|", guide[guide.index("## Axioms"):], re.M))
    require(listed, "the guide lists no axioms")
    asked = tools.file("Asked.v", "From ExactVO Require Import Checker.\n" + "".join(f"Print Assumptions Checked.{t}.\n" for t in theorems))
    done = run("coqc", "-q", "-Q", tools.theories, "ExactVO", asked)
    printed = done.stdout.split("Axioms:\n")[1:]  # real numbers rest on some, so that every theorem prints this
    require(done.returncode == 0 and len(printed) == len(theorems), done.stdout, done.stderr)
    used = set()
    for theorem, words in zip(theorems, printed):
        require(f"`{theorem}`" in guide, "the guide does not explain", theorem)
        found = set(re.findall(r"^([\w.]+)\s*:(?!=)", words, re.M))
        require(found and found <= listed, theorem, "rests on", found - listed, words)
        used |= found
    require(used == listed, "listed and not used:", listed - used)
    for source in sorted((tools.source / "proofs").glob("*.v")):
        require(not re.search(r"\b(Admitted|admit|Axiom|Conjecture|Hypothesis)\b", source.read_text()), source, "assumes something")
    theorems_page = (tools.source / "proofs/Theorems.v").read_text()
    require(len(theorems_page.split()) <= 4100, "Theorems.v is longer than 4,100 words")
    require(not re.search(r"\. +(Definition|Parameter|Record|Fixpoint)\b", theorems_page), "Theorems.v has two statements in a line")
    print(len(theorems), "theorems,", len(used), "axioms")


def coqchk(tools):
    # Our theories alone: the guide has the command that checks the standard library too.
    ours = [f"ExactVO.{path.stem}" for path in sorted(tools.theories.glob("*.vo"))]
    require(len(ours) == 15, ours)
    checked = run("coqchk", "-silent", "-o", "-Q", tools.theories, "ExactVO", *[word for name in ours for word in ("-norec", name)])
    words = checked.stdout + checked.stderr
    require(checked.returncode == 0 and "CONTEXT SUMMARY" in words, words)
    require("ExactVO" not in words[words.index("CONTEXT SUMMARY"):], "an assumption of our own:", words)
    for kind in ("type-in-type", "unsafe (co)fixpoints", "positivity is assumed"):
        require(re.search(re.escape(kind) + ": <none>", words), kind, words)
    print("coqchk accepts", len(ours), "theories")


# --- Certificates ---


def canonical(x):
    """As the program writes doubles: no zeros at the end of the mantissa."""
    sign, rest = ("-", x.hex()[1:]) if x.hex()[0] == "-" else ("", x.hex())
    mantissa, exponent = rest.split("p")
    whole, _, digits = mantissa.partition(".")
    digits = digits.rstrip("0")
    return sign + whole + ("." + digits if digits else "") + "p" + exponent


def every_number_changed(line):
    words = line.split(" ")
    for at, word in enumerate(words):
        if re.match(r"-?0x", word):
            for to in (-math.inf, math.inf):
                changed = canonical(math.nextafter(float.fromhex(word), to))
                yield " ".join(words[:at] + [changed] + words[at + 1:])


def numbers_in(tree, path=()):
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from numbers_in(value, path + (key,))
    elif isinstance(tree, list):
        for at, value in enumerate(tree):
            yield from numbers_in(value, path + (at,))
    elif type(tree) in (int, float):
        yield path


def with_number(tree, path, change):
    copy = json.loads(json.dumps(tree))
    place = copy
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = change(place[path[-1]])
    return copy


def compared(tools, changed, kind):
    """How many changed certificates were judged: alike by `audit` and exactvo-verify, and not all alike."""
    path = tools.file("changed.jsonl", "\n".join(changed) + "\n")
    audited = json.loads(run(tools.program, "audit", "--certificate", path, "--json").stdout)["verdicts"]
    status, verdicts, words = tools.verified("changed.jsonl", "\n".join(changed) + "\n")
    require(len(verdicts) == len(audited) == len(changed), len(verdicts), len(audited), len(changed))
    require("valid" in audited and any(v != "valid" for v in audited), kind, "forgeries of one verdict only")
    for line, ours, theirs in zip(changed, verdicts, audited):
        require((ours == "valid") == (theirs == "valid"), kind, ours, theirs, line)
    return len(changed)


def certificates(tools):
    square = "POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))"
    lines = []
    for obstacle, more in (("DISC(4 0, 1)", ()), ("LINESTRING(3 -1, 3 2)", ()), (square, ()), (square, ("--enclose", "ellipse")),
                           ("ELLIPSE(4 1, 1 0.25 0.5)", ()), ("DISC(4 0, 1)", ("--obstacle-velocity=-0.5,0.1",))):
        out = tools.make("vo", "--obstacle", obstacle, "--position", "0,0", "--velocity", "1,0.2", "--radius", "0.5", "--time-horizon", "2", "--json", *more)
        status, verdicts, words = tools.verified("vo.json", out)
        require(status == 0 and verdicts and set(verdicts) == {"valid"}, obstacle, words)
        lines += re.findall(r'"((?:half-plane|containment)-certificate [^"]*)"', out)
    require(len(lines) == 7, "lines:", lines)
    status, verdicts, words = tools.verified("lines.txt", "\n".join(lines) + "\n")
    require(status == 0 and verdicts == ["valid"] * 7, words)
    forged = [f for line in lines for f in every_number_changed(line)]
    status, verdicts, words = tools.verified("forged.txt", "\n".join(forged) + "\n")
    require(status == 1 and len(verdicts) == len(forged) and "valid" not in verdicts, "a changed number was overlooked:", words)
    count = len(forged)

    floor = tools.source / "datasets/data/office/floor.geojson"
    for goal, radius, kind in (("18,7", "0.4", "route"), ("18,7", "0.65", "separated"), ("7.15,3", "0.4", "blocked")):
        answer = json.loads(tools.make("route", floor, "--from", "2,3", "--to", goal, "--radius", radius, "--json"))
        certificate = answer["certificate"]
        require(certificate["kind"] == kind, kind, certificate["kind"])
        status, verdicts, words = tools.verified("route.jsonl", json.dumps(answer))
        require(status == 0 and verdicts == ["valid"], kind, words)
        # Some of these are true all the same, such as a corner moved away from walls: the audit says which.
        changed = [json.dumps(with_number(certificate, path, change)) for path in numbers_in(certificate)
                   for change in (lambda x: x + 1 if isinstance(x, int) else x + 0.35, lambda x: x - 1 if isinstance(x, int) else 0.5 * x)]
        require(len(changed) > 100, kind, len(changed))
        count += compared(tools, changed, kind)

    # Fractions beside doubles: what is none is refused, and so is one that is not next to its double.
    route = {"kind": "route", "radius": 0.5, "start": [1, 0], "goal": [3, 0], "length": 2, "lower_bound": 2, "obstacles": [{"id": "w", "polyline": [[0, -1], [0, 1]]}]}
    for x, y, holds in (("2", "0", True), ("2/1", "0/7", True), ("4/2", "-0", True), ("2", "/1", False), ("2", "-", False), ("2", "-/1", False), ("2/", "0", False),
                        ("2/0", "0", False), ("2/-1", "0", False), ("+2", "0", False), ("0x2", "0", False), ("2 ", "0", False), ("2/1/1", "0", False), ("3", "0", False)):
        fractions = dict(route, points=[[1, 0], [2, 0, x, y], [3, 0]])
        _, verdicts, words = tools.verified("fractions.json", json.dumps(fractions))
        audited = json.loads(run(tools.program, "audit", "--certificate", tools.folder / "fractions.json", "--json").stdout)["verdicts"]
        require((verdicts == ["valid"]) == (audited == ["valid"]) == holds, x, y, verdicts, audited)
        count += 1

    tracks = tools.file("tracks.csv", "t,id,x,y\n0,A,0,0\n0,B,3.5,-1.25\n2,A,3,0.5\n2,B,1,-1.5\n")
    square = tools.file("square.wkt", "POLYGON((1 1, 2 1, 2 2, 1 2, 1 1))\n")
    proofs = tools.folder / "proofs.jsonl"
    footprint = ("--footprint", "POLYGON((-0.2 -0.2, 0.2 -0.2, 0.2 0.2, -0.2 0.2, -0.2 -0.2))")
    for body in (("--radius", "0.25"), footprint, ("--radius", "0.25", "--between", "cubic"), (*footprint, "--between", "cubic")):
        tools.make("check", tracks, *body, "--map", square, "--near", "5", "--certificates", proofs)
        text = proofs.read_text()
        status, verdicts, words = tools.verified("proofs.jsonl", text)
        require(status == 0 and verdicts == ["valid"] * 3, words)
        for certificate in [json.loads(line)["certificate"] for line in text.splitlines() if '"kind"' in line]:
            changed = [json.dumps(with_number(certificate, path, change)) for path in numbers_in(certificate)
                       for change in (lambda x: x + 1 if isinstance(x, int) else x + 0.35, lambda x: x - 1 if isinstance(x, int) else 0.5 * x - 0.1)]
            count += compared(tools, changed, "clear")
        certificate = json.loads(text.splitlines()[0])["certificate"]
        for other, words in ((dict(certificate, kind="curved"), 'not covered: a certificate of kind "curved"'),
                             (dict(certificate, a=dict(certificate["a"], twist=0.1)), 'not covered: a motion with "twist"')):
            status, verdicts, _ = tools.verified("other.jsonl", json.dumps({"certificate": other}))
            require(status == 1 and verdicts == [words], verdicts)

    post = tools.file("post.wkt", "POLYGON((0.8 0.75, 1.5 0.75, 1.5 1.5, 0.8 1.5, 0.8 0.75))\n")
    poses = tools.file("poses.jsonl", '{"pose": [0, 0, 0.5], "velocity": [1, 0], "turn": -0.75}\n{"pose": [0.2, 0.3, 0], "velocity": [0.5, 0.1]}\n')
    for body in (("--radius", "0.25"), ("--footprint", "POLYGON((-0.2 -0.2, 0.3 -0.2, 0.3 0.2, -0.2 0.2, -0.2 -0.2))")):
        tools.make("monitor", poses, *body, "--period", "1", "--map", post, "--certificates", proofs)
        text = proofs.read_text()
        status, verdicts, words = tools.verified("turning.jsonl", text)
        require(status == 0 and len(verdicts) >= 2 and set(verdicts) == {"valid"}, words)
        found = [json.loads(line)["certificate"] for line in text.splitlines() if '"kind"' in line]
        require(any(c["a"]["turn"] != 0 for c in found) and any(c["a"]["turn"] == 0 for c in found), text)
        for certificate in found:
            changed = [json.dumps(with_number(certificate, path, change)) for path in numbers_in(certificate)
                       for change in (lambda x: x + 1 if isinstance(x, int) else x + 0.35, lambda x: x - 1 if isinstance(x, int) else 0.5 * x - 0.1)]
            count += compared(tools, changed, "turning")

    problems = ('{"bound":{"disc":3},"preferred":[3,0],"constraints":[{"normal":[-1,0],"offset":-1.75}]}\n'
                '{"bound":{"disc":2},"preferred":[1,0],"constraints":[{"normal":[1,0],"offset":1,"priority":"soft"},{"normal":[-1,0],"offset":1,"priority":"soft"}]}\n'
                '{"bound":{"disc":2},"preferred":[1,0],"constraints":[{"normal":[1,0],"offset":1},{"normal":[-1,0],"offset":1}]}\n'
                '{"bound":{"box":[1,1]},"preferred":[3,2],"constraints":[]}\n'
                '{"bound":{"disc":2},"preferred":[1,0],"constraints":[{"normal":[3,0],"offset":1},{"normal":[-3,0],"offset":-1}]}\n'
                '{"bound":{"disc":2},"preferred":[0,1],"objective":"farthest","constraints":[{"normal":[0,-1],"offset":-0.5}]}\n')
    path = tools.file("problems.jsonl", problems)
    answers = tools.make("lp", path, "--json").splitlines()[:-1]
    require([json.loads(a)["status"] for a in answers] == ["optimal", "relaxed", "infeasible", "optimal", "no-interior", "optimal"], answers)
    status, verdicts, words = tools.verified("answers.jsonl", "\n".join(answers), "--problems", path)
    require(status == 0 and verdicts == ["valid"] * 6, words)
    slower = lambda x: x - 0.25
    worse = [json.dumps(with_number(with_number(json.loads(a), ("velocity", 0), slower), ("velocity", 1), slower)) for a in answers]
    status, verdicts, words = tools.verified("worse.jsonl", "\n".join(worse), "--problems", path)
    require(status == 1 and len(verdicts) == 6 and "valid" not in verdicts, words)
    count += 6
    # What `lp` refuses in a problem is not read as if it were not there.
    for was, odd in (('"disc":3', '"disc":null'), ('"disc":3', '"disc":-3'), ('"disc":3', '"disc":3,"box":1'), ('"disc":3', '"disc":3,"box":[null]'),
                     ('"disc":3', '"disc":3,"polygon":[]'), ('"bound":{"disc":3}', '"bound":7'), ('"offset":-1.75', '"offset":-1.75,"priority":"weak"'),
                     ('"preferred"', '"objective":"quickest","preferred"'), ('"preferred"', '"also":1,"preferred"')):
        changed = tools.file("odd.jsonl", problems.splitlines()[0].replace(was, odd, 1) + "\n")
        status, verdicts, words = tools.verified("first.jsonl", answers[0], "--problems", changed)
        require(run(tools.program, "lp", changed).returncode == 2 and status == 1 and verdicts == ["malformed"], odd, words)
        count += 1

    for name, content, code in (("none.txt", "nothing\n", "E_FORMAT_UNKNOWN"), ("empty.txt", "", "E_FORMAT_UNKNOWN")):
        status, verdicts, words = tools.verified(name, content)
        require(status == 2 and code in words, words)
    missing = run(tools.verify, tools.folder / "missing")
    require(missing.returncode == 2 and "E_FILE_MISSING" in missing.stderr, missing.stderr)
    print(count, "forgeries judged")


def command(tools):
    """Files, folders, options, exit statuses."""
    asked = lambda *arguments, **options: run(tools.verify, *arguments, **options)
    version, told = asked("--version"), asked("--help")
    require(version.returncode == 0 and re.match(r"exactvo-verify \d+\.\d+\.\d+\nproven with Coq 8\.", version.stdout), version.stdout)
    require(told.returncode == 0 and re.search(r"^Exit status:\n  0 .*\n  1 .*\n  2 ", told.stdout, re.M), told.stdout)
    runs = tools.folder / "runs"
    (runs / "b").mkdir(parents=True)
    run(tools.program, "simulate", tools.source / "datasets/data/paper/A7.json", "--no-figures", "--out", runs / "a", check=True)
    text = (runs / "a/recording.jsonl").read_text()
    (runs / "b/recording.jsonl").write_text(text)
    (runs / "b/crowd.evr").write_bytes(crowd([[(0, 0), (2000, 0)]] * 2, [0.5, 0.5]))
    (runs / "notes.txt").write_text("none of them\n")
    done = asked(runs)
    require(done.returncode == 0 and done.stdout.endswith("3 files: 3 verified, 0 not, 0 wrong\n"), done.stdout, done.stderr)
    require([line for line in done.stdout.splitlines() if line.startswith(str(runs))] == [str(runs / name) for name in ("a/recording.jsonl", "b/crowd.evr", "b/recording.jsonl")], done.stdout)
    meeting = tools.file("meeting.evr", crowd([[(0, 0), (1000, 0)]] * 2, [0.5, 0.5]))
    done = asked(runs, meeting)
    require(done.returncode == 1 and done.stdout.endswith("4 files: 3 verified, 1 not, 0 wrong\n"), done.stdout)
    done = asked(meeting, tools.folder / "missing", runs / "b/crowd.evr")
    require(done.returncode == 2 and done.stdout.endswith("3 files: 1 verified, 1 not, 1 wrong\n") and "E_FILE_MISSING" in done.stderr, done.stdout, done.stderr)
    done = asked("-", input=text)
    require(done.returncode == 0 and "opposite half-planes" in done.stdout, done.stdout)
    empty = tools.folder / "empty"
    empty.mkdir()
    for arguments, words in (((), "found no file"), (("--nope",), "found '--nope'"), ((empty,), "a folder without recordings"), (("--problems",), "nothing behind it"),
                             ((meeting, meeting, "--problems", meeting), "found 2 files of answers"), (("--", "--version"), "E_FILE_MISSING"), (("",), "found ''")):
        done = asked(*arguments)
        require(done.returncode == 2 and words in done.stderr and done.stderr.startswith("exactvo-verify: error: "), arguments, done.stderr)
    print("files, folders and options")


# --- Recordings ---


def fnv(data):
    h = 14695981039346656037
    for byte in data:
        h = (h ^ byte) * 1099511628211 % 2**64
    return h


def difference(x):
    left, out = (x << 1) ^ (x >> 63), b""
    while left >= 0x80:
        out, left = out + bytes([left & 0x7F | 0x80]), left >> 7
    return out + bytes([left])


def block(data):
    return struct.pack("<QQ", len(data), fnv(data)) + data


def crowd(rows, radii, edges=(), step=2.0**-10, speed=1000.0):
    """A recording of robots at lattice places, a row a step: rows[k] = [(x, y), ...]."""
    head = struct.pack("<I", 0) + struct.pack("<ddII", 1.0, step, 1, len(radii))
    head += b"".join(struct.pack("<dd", r, speed) for r in radii)
    head += struct.pack("<I", len(radii)) + b"".join(struct.pack("<H", i) for i in range(len(radii)))
    head += struct.pack("<I", len(edges)) + b"".join(struct.pack("<4d", *e) for e in edges)
    out, total = b"EXACTVR1" + block(head), fnv(head)
    before = [(0, 0)] * len(radii)
    for k, row in enumerate(rows):
        data = struct.pack("<I", k)
        for axis in (0, 1):
            data += b"".join(difference(p[axis] - b[axis]) for p, b in zip(row, before))
        data += b"\0" * ((len(radii) + 7) // 8)
        out, total, before = out + b"R" + block(data), fnv(struct.pack("<QQ", total, fnv(data))), row
    return out + b"E" + block(struct.pack("<QQ", len(rows), total))


def random_crowd(rng):
    """Few robots in little room, on a coarse lattice, so that contact and near misses are common."""
    count, grain, room = rng.randint(2, 14), 2 ** rng.randint(5, 10), rng.randint(3, 8)
    place = lambda: (rng.randint(-room * 1024 // grain, room * 1024 // grain) * grain, rng.randint(-room * 1024 // grain, room * 1024 // grain) * grain)
    rows = [[place() for _ in range(count)]]
    rows.append([place() if rng.random() < 0.3 else (x + rng.randint(-2, 2) * grain, y + rng.randint(-2, 2) * grain) for x, y in rows[0]])
    return crowd(rows, [rng.choice((0.25, 0.5, 0.3, 0.125)) for _ in range(count)])


def pairs_proven(words):
    asked, apart = re.search(r"(\d+) asked, in (\d+) no two", words).groups()
    return asked == apart


def recordings(tools):
    out = tools.folder / "room"
    run(tools.program, "simulate", tools.source / "datasets/data/room/room.json", "--no-figures", "--out", out, check=True)
    text = (out / "recording.jsonl").read_text()
    status, _, words = tools.verified("recording.jsonl", text)
    require(status == 0 and re.search(r"^(\d+) rows of 2 robots, .*: \1 asked, in \1 no two robots overlap, in \1 also", words, re.M), words)
    half_planes, choices = (int(re.search(f"{what}.*: (\\d+) asked, \\1 proven", words)[1]) for what in ("at rest", "choices with"))
    require(half_planes > 100 and choices > 100, words)
    lines = text.splitlines(True)
    rows = [k for k, line in enumerate(lines) if line.startswith('{"row"')]
    require(len(rows) > 100, len(rows))
    forged = json.loads(lines[rows[50]])
    robots = forged["row"]["robots"]
    robots_at_start = json.loads(lines[rows[0]])["row"]["robots"]
    bodies = [line for line in lines[:rows[0]] if line.startswith('{"body"')]
    for change, expected in ((lambda: robots.__setitem__(0, dict(robots[0], position=robots[1]["position"])), "two robots are not proven apart"),
                             (lambda: robots.__setitem__(0, dict(robots[0], position=[0.2, 1.0])), "a robot is not proven clear of an obstacle")):
        change()
        status, _, words = tools.verified("forged.jsonl", "".join(lines[:rows[50]] + [json.dumps(forged) + "\n"] + lines[rows[51]:]))
        require(status == 1 and expected in words, words)
    for place, by, expected in ((("offset",), -0.5, "at rest: %d asked, %d proven" % (half_planes, half_planes - 1)),
                                (("multiplier",), 1e-3, "multipliers: %d asked, %d proven" % (choices, choices - 1)),
                                (("normal", 1), -0.5, "at rest: %d asked, %d proven" % (half_planes, half_planes - 1))):
        forged = json.loads(lines[rows[20]])
        constraint = next(c for c in forged["row"]["robots"][0]["constraints"] if c["active"])
        for key in place[:-1]:
            constraint = constraint[key]
        constraint[place[-1]] += by
        status, _, words = tools.verified("forged.jsonl", "".join(lines[:rows[20]] + [json.dumps(forged) + "\n"] + lines[rows[21]:]))
        require(status == 1 and expected in words, place, words)
    held = [int(n) for n in re.search(r"each goal: (\d+) asked, (\d+) proven to lie in the bodies", words).groups()]
    require(held[0] == held[1] > 5, words)
    first = json.loads(bodies[0])
    require(list(first["body"]["shape"]) == ["segment"], bodies[0])
    first["body"]["shape"]["segment"][1] = [0.9 * x for x in first["body"]["shape"]["segment"][1]]
    status, _, words = tools.verified("shorter.jsonl", "".join(json.dumps(first) + "\n" if line == bodies[0] else line for line in lines))
    require(status == 1 and f"each goal: {held[0]} asked, {held[0] - 2} proven" in words, words)  # of both robots
    header = json.loads(lines[0])
    header["header"]["scenario"]["obstacles"] = [{"id": "all round", "polygon": [[-9, -9], [19, -9], [19, 19], [-9, 19]]}]
    status, _, words = tools.verified("inside.jsonl", json.dumps(header, separators=(",", ":")) + "\n" + "".join(lines[1:]))
    require(status == 1 and "row 0: a robot is not proven clear of an obstacle" in words, words)  # clear of all edges, but inside
    # A disc at its very distance from where the robot stands, and one larger by 2^-20 m; and another that overlaps it.
    (x, y), radius = robots_at_start[0]["position"], json.loads(lines[0])["header"]["scenario"]["robots"][0]["radius"]
    still = [lines[rows[0]], '{"end":{"rows":1}}\n']
    for more, holds in ((0.0, True), (2.0**-20, False)):
        discs = [{"id": "post", "disc": {"centre": [x, y + 2 * radius], "radius": radius + more}},
                 {"id": "beside", "disc": {"centre": [x, y + 3 * radius], "radius": radius}}]
        header["header"]["scenario"]["obstacles"] = discs
        status, _, words = tools.verified("discs.jsonl", "".join([json.dumps(header, separators=(",", ":")) + "\n", *bodies] + still))
        require((status == 0) == holds and "one of 0 obstacles with 0 edges and of 2 discs" in words, more, words)
    # A tracking error below 0 would make discs smaller; a footprint that the robot cannot have would take obstacles away.
    for change in (lambda s: s.update(uncertainty={"tracking": -0.1}), lambda s: s["robots"][1].update(footprint=None),
                   lambda s: s["robots"][1].update(footprint={"polygon": [[-1, -1], [1, -1], [0, 1]]})):
        odd = json.loads(lines[0])
        change(odd["header"]["scenario"])
        status, _, words = tools.verified("odd.jsonl", json.dumps(odd, separators=(",", ":")) + "\n" + "".join(lines[1:]))
        require(status == 2 and "E_FORMAT_SYNTAX" in words, status, words)
    # A speed bound below 0 allows nothing, though its square is the same.
    backward = json.loads(lines[0])
    for robot in backward["header"]["scenario"]["robots"]:
        robot["max_speed"] *= -1
    status, _, words = tools.verified("backward.jsonl", json.dumps(backward, separators=(",", ":")) + "\n" + "".join(lines[1:]))
    require(status == 1 and re.search(r"choices with multipliers: [1-9]\d* asked, 0 proven", words), words)
    # Robots inside a polygon whose edges they never meet are in no row clear of it, nor could they brake.
    brakes = tools.folder / "brakes"
    run(tools.program, "simulate", tools.file("brakes.json", json.dumps(dict(ACCELERATING, obstacles=[]))), "--no-figures", "--out", brakes, check=True)
    accelerated = (brakes / "recording.jsonl").read_text()
    asked = r"could brake, .*: (\d+) asked, (\d+) proven"
    status, _, words = tools.verified("brakes.jsonl", accelerated)
    made = re.search(asked, words)
    require(status == 0 and made[1] == made[2] and int(made[1]) > 50, words)
    head, rest = accelerated.split("\n", 1)
    head = json.loads(head)
    for change, expected in ((lambda s: s.update(obstacles=[{"id": "all round", "polygon": [[-50, -50], [50, -50], [50, 50], [-50, 50]]}]), "0"),
                             (lambda s: s.update(acceleration={"max": 1.0}, braking_time=0.9 * s["robots"][0]["max_speed"]), "0")):
        edited = json.loads(json.dumps(head))
        change(edited["header"]["scenario"])
        status, _, words = tools.verified("edited.jsonl", json.dumps(edited, separators=(",", ":")) + "\n" + rest)
        found = re.search(asked, words)
        require(status == 1 and (found[1], found[2]) == (made[1], expected), words)
        if "all round" in json.dumps(edited):
            require("in 0 also no robot overlaps" in words, words)
    status, _, words = tools.verified("cut.jsonl", "".join(lines[:rows[9]]))
    require(status == 2 and "E_CUT_OFF" in words, words)
    status, _, words = tools.verified("no.jsonl", "".join(lines[:rows[9]]) + "{\n")
    require(status == 2 and "E_FORMAT_SYNTAX" in words, words)

    posts = {"name": "posts", "time_limit": 20, "robots": [{"id": "R1", "position": [-4, 0.1], "radius": 0.4, "max_speed": 1, "goals": [[4, 0]]}],
             "obstacles": [{"id": "post", "disc": {"centre": [0, 0], "radius": 1}}]}
    out = tools.folder / "posts"
    run(tools.program, "simulate", tools.file("posts.json", json.dumps(posts)), "--no-figures", "--out", out, check=True)
    text = (out / "recording.jsonl").read_text()
    require('"disc":{"centre"' in text.splitlines()[0], "no disc in the recording")
    status, _, words = tools.verified("posts.jsonl", text)
    require(status == 0 and re.search(r"^(\d+) rows of 1 robot, .*: \1 asked, .* in \1 also no robot overlaps .* and of 1 disc$", words, re.M), words)
    status, _, words = tools.verified("larger.jsonl", text.replace('"centre":[0,0],"radius":1}', '"centre":[0,0],"radius":1.25}', 1))
    require(status == 1 and "a robot is not proven clear of an obstacle" in words, words)

    out = tools.folder / "A7"
    run(tools.program, "simulate", tools.source / "datasets/data/paper/A7.json", "--no-figures", "--out", out, check=True)
    lines = (out / "recording.jsonl").read_text().splitlines(True)
    status, _, words = tools.verified("A7.jsonl", "".join(lines))
    pairs = re.search(r"opposite half-planes: (\d+) asked, \1 proven", words)
    require(status == 0 and pairs and int(pairs[1]) > 20, words)
    robots = {b["number"] for b in (json.loads(line).get("body", {"kind": ""}) for line in lines) if b["kind"] == "robot"}
    tampered = 0
    for k, line in enumerate(lines):
        if not line.startswith('{"row"'):
            continue
        forged = json.loads(line)
        for robot in forged["row"]["robots"]:
            for constraint in robot.get("constraints", []):
                if constraint["body"] in robots:
                    constraint["offset"] -= 4.0  # more than any velocity has
                    tampered += 1
        lines[k] = json.dumps(forged) + "\n"
    status, _, words = tools.verified("A7_forged.jsonl", "".join(lines))
    require(status == 1 and tampered > 40 and f"opposite half-planes: {pairs[1]} asked, 0 proven" in words, words)

    scene = {"name": "crossing", "time_step": 0.25, "time_limit": 20, "horizons": {"least": 0.5, "orca": 5},
             "obstacles": [{"id": "w", "polygon": [[20, -3], [24, -3], [24, 3], [20, 3]]}],
             "robots": [{"circle": {"count": 60}}, {"grid": {"columns": 10, "rows": 10, "spacing": 2, "corner": [60, -10], "goal": [-110, 0]}}]}
    evr = tools.folder / "crossing.evr"
    run(tools.program, "simulate", tools.file("crossing.json", json.dumps(scene)), "--decisions", "none", "--record", evr, check=True)
    data = evr.read_bytes()
    status, _, words = tools.verified("crowd.evr", data)
    require(status == 0 and re.search(r"^(\d+) rows of 160 robots, .*: \1 asked, in \1 no two robots overlap, in \1 also no robot overlaps one of 4 edges", words, re.M), words)
    status, _, words = tools.verified("cut.evr", data[:-30])
    require(status == 1 and "cut off" in words, words)
    for at in range(8, len(data), len(data) // 40):
        status, _, words = tools.verified("changed.evr", data[:at] + bytes([data[at] ^ 4]) + data[at + 1:])
        require(status in (1, 2), "a changed byte was overlooked:", at, words)

    # On wheels and with a tracking error: discs hold bodies, and no longer do where either is larger than it was.
    wheels = {"type": "differential", "wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1}
    scene = {"name": "wheels", "time_step": 0.25, "time_limit": 10, "horizons": {"least": 0.5}, "uncertainty": {"tracking": 0.02},
             "obstacles": [{"id": "post", "disc": {"centre": [0.1, 0.2], "radius": 0.3}}],
             "robots": [{"circle": {"count": 8, "radius": 2}, "radius": 0.105, "kinematics": wheels},
                        {"id": "other", "position": [5, 0], "goal": [-5, 0.5], "radius": 0.15, "max_speed": 0.3}]}
    run(tools.program, "simulate", tools.file("wheels.json", json.dumps(scene)), "--decisions", "none", "--record", evr, check=True)
    data = evr.read_bytes()
    (size,) = struct.unpack_from("<Q", data, 8)
    for was, larger, held in ((0.02, 0.02, 2), (0.02, 0.02 + 1e-9, 0), (0.105, 0.105 + 1e-9, 1), (0.15, 0.15 + 1e-9, 1)):
        head = data[24:24 + size].replace(struct.pack("<d", was), struct.pack("<d", larger), 1)
        status, _, words = tools.verified("wheels.evr", data[:8] + block(head) + data[24 + size:])
        require(status == (held != 2) and f"and the tracking error: 2 asked, {held} proven" in words, was, larger, words)
        require("within the tracking error" in words and "of robots on wheels more than discs" in words, words)

    # Robots that just touch, and that come nearer than that by one lattice step, at an end or on the way.
    half = [0.5, 0.5]
    for rows, holds in (([[(0, 0), (1024, 0)]] * 2, True), ([[(0, 0), (1023, 0)]] * 2, False),
                        ([[(0, 0), (-2000, 1024)], [(0, 0), (2000, 1024)]], True), ([[(0, 0), (-2000, 1023)], [(0, 0), (2000, 1023)]], False),
                        ([[(0, 0), (2000, 0)], [(2000, 0), (0, 0)]], False)):
        status, _, words = tools.verified("two.evr", crowd(rows, half))
        require((status == 0) == holds, rows, words)
    for y, holds in ((512, True), (511, False)):
        status, _, words = tools.verified("edge.evr", crowd([[(-3000, y)], [(3000, y)]], [0.5], [(0.0, 0.0, 1.0, 0.0)]))
        require((status == 0) == holds, y, words)

    rng, verdicts = random.Random(tools.flags.seed), {True: 0, False: 0}
    for k in range(max(100, tools.flags.count // 50)):
        data = random_crowd(rng)
        status, _, words = tools.verified("random.evr", data)
        audited = json.loads(run(tools.program, "audit", tools.folder / "random.evr", "--json").stdout)
        clear = audited["collisions"] == 0
        require(pairs_proven(words) == clear, "seed", tools.flags.seed, "crowd", k, words, audited, data.hex())
        verdicts[clear] += 1
    require(min(verdicts.values()) > 10, "one verdict only:", verdicts)
    print("random crowds:", verdicts[True], "clear,", verdicts[False], "not; seed", tools.flags.seed)


# --- Scenes and edited copies ---

SLICE = ("paper/A1", "paper/A7", "paper/B0", "robots/burgers4", "room/room")  # of ctest; a campaign takes all


KINDS = ("position", "onto", "offset", "chosen", "normal", "preferred", "multiplier", "velocity", "body")

ACCELERATING = {"name": "accelerating", "time_limit": 12, "acceleration": {"max": 2}, "robots": [{"circle": {"count": 6, "radius": 4}}],
                "obstacles": [{"id": "post", "disc": {"centre": [0.4, 0], "radius": 0.5}}, {"id": "wall", "polyline": [[-6, 5], [6, 5]]},
                              {"id": "box", "polygon": [[5, -4], [6, -4], [6, -3], [5, -3]]}]}


def changed_body(rng, lines):
    """A number of the shape of a body at rest, changed; None where there are none."""
    at_rest = [k for k, line in enumerate(lines) if line.startswith('{"body"') and '"enclosure"' in line and '"owners":[]' not in line]
    if not at_rest:
        return None
    k, by = rng.choice(at_rest), rng.choice((1e-12, 1e-6, 1e-3, 0.3)) * rng.choice((-1, 1))
    body = json.loads(lines[k])
    body["body"]["shape"] = with_number(body["body"]["shape"], rng.choice(list(numbers_in(body["body"]["shape"]))), lambda x: x + by)
    return lines[:k] + [json.dumps(body, separators=(",", ":")) + "\n"] + lines[k + 1:], f"body in line {k + 1} by {by}"


def changed_row(rng, lines, rows, kind):
    """A number or the place of that kind of a row, changed; what it is of."""
    if kind == "body":
        changed = changed_body(rng, lines)
        if changed:
            return changed
        kind = "position"
    for _ in range(100):
        k = rng.choice(rows[:-1])
        row = json.loads(lines[k])
        robot = rng.choice(row["row"]["robots"])
        bound = [c for c in robot.get("constraints", []) if c.get("certified")]
        if bound:
            break
    else:
        kind = "position"
    by = rng.choice((1e-12, 1e-6, 1e-3, 0.3, 3.0)) * rng.choice((-1, 1))
    obstacles = json.loads(lines[0])["header"]["scenario"]["obstacles"]
    if kind == "onto" and not obstacles:
        kind = "position"
    if kind == "onto":
        obstacle = rng.choice(obstacles)
        robot["position"] = obstacle["disc"]["centre"] if "disc" in obstacle else obstacle.get("polygon", obstacle.get("polyline"))[0]
    elif kind in ("position", "chosen", "preferred", "velocity"):
        robot[kind][rng.randrange(2)] += by
    else:
        constraint = rng.choice(bound)
        if kind == "normal":
            constraint["normal"][rng.randrange(2)] += by
        else:
            constraint[kind] = constraint.get(kind, 0.0) + by
    return lines[:k] + [json.dumps(row) + "\n"] + lines[k + 1:], f"{kind} of row {k - rows[0]} by {by}"


def judged(tools, name, lines):
    """By exactvo-verify and by `audit`: bodies, half-planes, choices, motions, braking; and of which of these the audit asks more."""
    path = tools.file("scene.jsonl", "".join(lines))
    proven, audited = run(tools.verify, path), run(tools.program, "audit", path, "--json")
    require(proven.returncode in (0, 1) and audited.returncode in (0, 1), name, proven.stderr, audited.stderr)
    report, words = json.loads(audited.stdout), proven.stdout
    counts = lambda pattern: [int(x) for x in re.search(pattern, words).groups()]
    all_rows, apart, clear = counts(r"(\d+) asked, in (\d+) no two robots overlap, in (\d+) also")
    planes, pairs, choices, held = (counts(what + r": (\d+) asked, (\d+) proven") for what in ("at rest", "opposite half-planes", "choices with multipliers", "to each goal"))
    ours = {"bodies": held[0] == held[1], "half_planes": planes[0] == planes[1] and pairs[0] == pairs[1], "choices": choices[0] == choices[1], "motions": all_rows == clear}
    braking = re.search(r"rows but the last in which all could brake, .*: (\d+) asked, (\d+) proven", words)
    scenario = json.loads(lines[0])["header"]["scenario"]
    brakes = "acceleration" in scenario or any("kinematics" in robot for robot in scenario["robots"])
    require(bool(braking) == brakes, name, words)
    if braking:
        ours["braking"] = braking[1] == braking[2]
    theirs = {point: report["points"][point]["refuted"] == 0 for point in ours}
    # The audit first compares what a row says of its choice: which half-planes bind, and the violation. No theorem does.
    if ours["choices"]:
        theirs["choices"] = not re.search("breaks a half-plane or the speed bound|is not proven the best|has too many or invalid multipliers", json.dumps(report["findings"]))
    # Of bodies it also asks that they are convex and stand for what they name. A shape that is none has no half-planes either.
    if ours["bodies"]:
        theirs["bodies"] = "leave out a part of obstacle" not in json.dumps(report["findings"])
    theirs["motions"] = theirs["motions"] and report["collisions"] == 0
    more = {"half_planes"}  # of half-planes against what moves, of bodies round discs, of motions that are curves or where obstacles move or meet footprints
    if "the motions: robots do not move straight" in words or "moving obstacles" in words:
        more.add("motions")
    if any("disc" in obstacle for obstacle in scenario["obstacles"]):
        more.add("bodies")
    if "some have footprints" in words:
        more |= {"motions", "braking"}
    if "measured each other" in words or any("max_speed" in mover for mover in scenario.get("moving_obstacles", [])):
        more.add("braking")
    return ours, theirs, more


def scenes(tools):
    """Of every scene of datasets/data (in ctest: of a few) and of edited copies: what one checker refutes the other does."""
    campaign = tools.flags.count >= 100000
    data, rng = tools.source / "datasets/data", random.Random(tools.flags.seed)
    all_scenes = sorted(path for path in data.glob("*/*.json") if '"robots"' in path.read_text() or '"formation"' in path.read_text())
    chosen = [path for path in all_scenes if campaign or str(path.relative_to(data).with_suffix("")) in SLICE]
    require(len(chosen) >= len(SLICE), chosen)
    chosen.append(tools.file("accelerating.json", json.dumps(ACCELERATING)))
    copies = max(len(KINDS), tools.flags.count // 20000)
    tally, judged_copies = {}, 0
    for scene in chosen:
        out = tools.folder / scene.stem
        made = run(tools.program, "simulate", scene, "--no-figures", "--decisions", "binding", "--out", out)
        require(made.returncode in (0, 1), scene, made.stderr)
        lines = (out / "recording.jsonl").read_text().splitlines(True)
        rows = [k for k, line in enumerate(lines) if line.startswith('{"row"')]
        for copy in range(copies + 1):
            edited, what = changed_row(rng, lines, rows, KINDS[copy % len(KINDS)]) if copy else (lines, "as it was made")
            ours, theirs, more = judged(tools, scene, edited)
            for point in ours:
                agrees = (ours[point] or not theirs[point]) if point in more else ours[point] == theirs[point]
                require(agrees, "seed", tools.flags.seed, scene, what, point, "proven:", ours, "audit:", theirs)
                tally[point, ours[point], theirs[point]] = tally.get((point, ours[point], theirs[point]), 0) + 1
            judged_copies += copy > 0
    for point in ("bodies", "half_planes", "choices", "motions", "braking"):
        require(tally.get((point, False, False), 0) > 0, point, "was never refuted:", tally)
    print(len(chosen), "scenes,", judged_copies, "edited copies;", *(f"{point}: proven {ours}, audit {theirs}: {n};" for (point, ours, theirs), n in sorted(tally.items())), "seed", tools.flags.seed)


# --- One verdict ---


def is_far_off(problems, answer):
    """Whether the velocity of a no-interior answer breaks what must hold by more than rounding explains, in fractions."""
    problem = json.loads(problems[answer["index"]])
    x, y = map(Fraction, answer["velocity"])
    gives = bool(answer["certificate"]["contradiction"])
    box = problem["bound"].get("box") or [None, None]
    disc = problem["bound"].get("disc")
    broken = [abs(v) / Fraction(b) - 1 for v, b in zip((x, y), box) if b] + ([(x * x + y * y) / Fraction(disc) ** 2 - 1] if disc else [])
    for c in problem["constraints"]:
        (n, m), offset = map(Fraction, c["normal"]), Fraction(c["offset"])
        size = abs(n * x) + abs(m * y) + abs(offset)
        if size and not (gives and c.get("priority") == "soft"):
            broken.append((offset - n * x - m * y) / size)
    return answer["status"] == "no-interior" and max(broken, default=0) > Fraction(1, 2**40)


def differential(tools):
    each = tools.flags.count // 4
    made = run(tools.cases, each, tools.flags.seed, tools.folder)
    require(made.returncode == 0, made.stderr)
    problems = (tools.folder / "problems.jsonl").read_text().splitlines()
    for file in ("half-planes.txt", "containments.txt", "routes.jsonl", "clear.jsonl", "curved.jsonl", "turning.jsonl", "answers.jsonl"):
        name = file.split(".")[0]
        expected = [line == "1" for line in (tools.folder / f"{name}.valid").read_text().split()]
        done = run(tools.verify, tools.folder / file, *(("--problems", tools.folder / "problems.jsonl") if name == "answers" else ()))
        verdicts = re.findall(r"^\d+: (.*)$", done.stdout, re.M)
        require(len(verdicts) == len(expected) == each, name, len(verdicts), len(expected), done.stderr)
        for line, ours, theirs in zip((tools.folder / file).read_text().splitlines(), verdicts, expected):
            # The certificate of a no-interior answer says nothing of its velocity, for which exactvo-verify asks too.
            stricter = name == "answers" and ours == "not proven" and theirs and is_far_off(problems, json.loads(line))
            require((ours == "valid") == theirs or stricter, name, "seed", tools.flags.seed, "proven:", ours, "C++:", theirs, line)
        require(0.2 < sum(expected) / len(expected) < 0.9, name, "hardly anything is forged, or real:", sum(expected), len(expected))
        if name == "routes":  # and the one in Python, which is slow
            some = (tools.folder / file).read_text().splitlines(True)[:each if tools.flags.count >= 100000 else MOST_IN_PYTHON]
            done = run(sys.executable, tools.source / "examples/check_route.py", tools.file("some.jsonl", "".join(some)))
            refused = {int(k) for k in re.findall(r"^(\d+): not proven", done.stdout, re.M)}
            require(f"{len(some)} certificates" in done.stdout, done.stdout, done.stderr)
            for k, (line, theirs) in enumerate(zip(some, expected), 1):
                require((k not in refused) == theirs, "seed", tools.flags.seed, "Python:", k not in refused, "C++:", theirs, line)
        print(f"{name}: {len(expected)} certificates, {sum(expected)} valid, one verdict; seed {tools.flags.seed}")


def decimals(rng):
    """A number as JSON has it: of random digits, of a double, or (nearly) half-way between two doubles."""
    kind = rng.randrange(5)
    if kind == 0:
        digits = str(rng.randrange(10 ** rng.randint(1, 20)))
        behind = rng.randint(0, 25)
        text = digits if behind == 0 else digits[:-behind].lstrip("0").rjust(1, "0") + "." + digits.rjust(behind, "0")[-behind:]
        return text + rng.choice(["", "", "", f"e{rng.randint(-30, 30)}", f"E+{rng.randint(0, 9)}"])
    if kind == 1:
        return repr(rng.uniform(-10, 10) * 10.0 ** rng.randint(-12, 12)) if rng.randrange(2) else repr(rng.uniform(-10, 10))
    if kind == 2:  # in whole ulps, exactly between two doubles, or beside that by the last digit
        twice = rng.randrange(2**53, 2**54) | 1
        return f"{twice // 2}.{rng.choice(['5', '5', '49', '51', '499', '501'])}"
    if kind == 3:
        return f"{rng.choice(['', '-'])}{rng.randrange(2**53, 10**18)}"
    x = rng.uniform(0.001, 100)
    half = (Fraction(x) + Fraction(math.nextafter(x, 1e9))) / 2
    behind = rng.randint(14, 18)
    number = round(half * 10**behind) + rng.randint(-1, 1)
    return f"{rng.choice(['', '-'])}{number // 10**behind}.{number % 10**behind:0{behind}d}"


def numbers(tools):
    claims = tools.theories / "claims"
    if not claims.exists():
        print("skipped: the target exactvo_claims is not built")
        sys.exit(SKIPPED)
    rng = random.Random(tools.flags.seed)
    texts = [decimals(rng) for _ in range(10 * tools.flags.count)]
    done = run(claims, input="\n".join(texts) + "\n")
    read = done.stdout.split()
    require(done.returncode == 0 and len(read) == len(texts), len(read), "of", len(texts), "numbers read:", done.stderr)
    for text, x in zip(texts, read):
        require(float.fromhex(x).hex() == float(text).hex(), "seed", tools.flags.seed, text, "read as", x, "expected", float(text).hex())
    print(len(texts), "numbers, seed", tools.flags.seed)


def page(tools):
    node, claims = shutil.which("node") or shutil.which("nodejs"), tools.theories / "claims"
    if not node or not claims.exists():
        print("skipped: no node" if not node else "skipped: the target exactvo_claims is not built")
        sys.exit(SKIPPED)
    modules = tools.folder / "page"
    modules.mkdir()
    (modules / "package.json").write_text('{"type": "module"}')
    for name in ("exact.js", "proof.js"):
        shutil.copy(tools.source / "tools/explorer/page" / name, modules)
    text = run(tools.flags.claims, tools.flags.count, tools.flags.seed).stdout
    lines = text.splitlines()
    require(len(lines) == tools.flags.count, len(lines), "claims")
    verdicts = {}
    for name, command in (("proven", [claims]), ("page", [node, tools.source / "tests/proofs/page_claims.mjs", modules])):
        done = run(*command, input=text)
        verdicts[name] = [line == "1" for line in done.stdout.split()]
        require(done.returncode == 0 and len(verdicts[name]) == len(lines), name, len(verdicts[name]), done.stderr)
    tally = {}
    for line, proven, shown in zip(lines, verdicts["proven"], verdicts["page"]):
        case = json.loads(line)
        require(case["holds"] == proven == shown, "seed", tools.flags.seed, "C++:", case["holds"], "proven:", proven, "page:", shown, line)
        kind = ("half-plane" if "claim" in case else case["answer"]["status"], proven)
        tally[kind] = tally.get(kind, 0) + 1
    for kind in ("half-plane", "optimal", "relaxed", "infeasible"):
        for proven in (True, False):
            require(tally.get((kind, proven), 0) * 400 > len(lines), kind, proven, "hardly occurs:", tally)
    print("one verdict of C++, the page and the proven checkers:", *(f"{kind} {'true' if proven else 'false'} {n}" for (kind, proven), n in sorted(tally.items())),
          "seed", tools.flags.seed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=["axioms", "coqchk", "numbers", "certificates", "command", "recordings", "scenes", "page", "differential"])
    for name in ("program", "cases", "claims", "build", "source"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--count", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    flags = parser.parse_args()
    globals()[flags.part](Tools(flags))


main()
