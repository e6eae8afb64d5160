#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""HACKING.md and the README of each room are short, every path that they name exists, and so do the files and names of a coupling.

A coupling is a line under "Change together" in the README of a room (- `a.h` (`Name`) with `b.cpp`, `c.md`: why.) or a comment in a source file
(CHANGE WITH path: why). Paths start at the folder of the text or at any folder above it; exactvo/MODULE/NAME.h is a public header.
"""
import fnmatch
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = ("geometry", "vo", "formation", "datasets")
HACKING_LINES, ROOM_LINES, LINE_LENGTH = 150, 30, 160
SOURCES = (".h", ".cpp", ".py", ".js", ".md", ".txt", ".cmake", ".sh", ".gp", ".in", ".pyi", ".html", ".css")
OUTPUTS = {"build", "out", "figures", "explorer.html"}  # first folders of what programs write
FENCE = re.compile(r"^```.*?^```", re.M | re.S)
PLACEHOLDER = re.compile(r"^_?[A-Z]{2,}[A-Z_]*(\.[a-z]+)?$")
NAMES_IN_CAPITALS = {"README.md", "HACKING.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "CITATION.cff"}
COMMENT = re.compile(r"^\s*(?://|#)\s*CHANGE WITH ([^\s:]+)(?::\s*(.*))?", re.M)


def rooms():
    """The folders that have a README of their own."""
    listed = [ROOT / module for module in MODULES]
    for module in ("geometry", "vo", "formation"):
        listed += sorted(p for p in (ROOT / module / "src").iterdir() if p.is_dir())
    listed += [ROOT / "cmake", ROOT / "scripts", *(p.parent for p in ROOT.glob("*/CMakeLists.txt"))]
    listed += sorted(p for p in (ROOT / "tools").iterdir() if p.is_dir())
    listed += sorted(p.parent for p in ROOT.glob("*/src/*/README.md"))
    return sorted(set(listed))


def texts():
    """Every text that is held to its paths."""
    return [ROOT / "HACKING.md", ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(room / "README.md" for room in rooms())]


def path_of(word):
    """The path that a word in backticks names, up to its first placeholder; None for other words."""
    if not re.fullmatch(r"[\w.+*-]+(/[\w.+*-]+)*/?", word) or word.split("/")[0] in OUTPUTS:
        return None
    if "/" not in word and not (word.endswith(SOURCES) and len(word) > 5):
        return None
    kept = []
    for part in word.rstrip("/").split("/"):
        if PLACEHOLDER.match(part) and part not in NAMES_IN_CAPITALS:
            break
        kept.append(part)
    return "/".join(kept) or None


def file_at(path, folder):
    """Where `path`, which may have wildcards, leads from `folder` or the nearest folder above it up to the root; None for nowhere."""
    bases = [folder, *(base for base in folder.parents if base.is_relative_to(ROOT))]
    if path.startswith("exactvo/"):
        bases += [ROOT / module / "include" for module in MODULES]
    return next((found for base in bases for found in base.glob(path)), None)


def exists(path, folder):
    return file_at(path, folder) is not None


def missing_paths(text, folder):
    """How many paths `text` names in backticks, and those that do not exist."""
    named = [path for path in map(path_of, re.findall(r"`([^`\n]+)`", FENCE.sub("", text))) if path]
    return len(named), [path for path in named if not exists(path, folder)]


def couplings(text):
    """The lines under "Change together", each with its continuation."""
    _, _, section = text.partition("\n## Change together\n")
    section = section.partition("\n## ")[0]
    return [re.sub(r"\s+", " ", line).strip() for line in re.split(r"^- ", section, flags=re.M)[1:]]


def fault_of(coupling, folder):
    """What is wrong with a coupling; None for a good one."""
    left, word, right = coupling.partition(" with ")
    first = re.findall(r"`([^`]+)`", left)
    others = [path for path in re.findall(r"`([^`]+)`", right.partition(": ")[0]) if "/" in path or path.endswith(SOURCES)]
    if not word or not first or not others:
        return f"not of the form `a` with `b`: why.: {coupling}"
    if not right.partition(": ")[2].endswith("."):
        return f"no reason: {coupling}"
    absent = [path for path in (first[0], *others) if not exists(path, folder)]
    if absent:
        return f"no file {', '.join(absent)}: {coupling}"
    for path, names in re.findall(r"`([^`]+)` \(((?:`[^`]+`(?:, )?)+)", coupling):
        text = file_at(path, folder).read_text(encoding="utf-8")
        gone = [name for name in re.findall(r"`([^`]+)`", names) if not re.search(rf"\b{name.split('::')[-1]}\b", text)]
        if gone:
            return f"no {', '.join(gone)} in {path}: {coupling}"
    return None


def comment_faults(text):
    """Of comments CHANGE WITH: how many there are, and which name no file or no reason."""
    found = COMMENT.findall(text)
    return len(found), [path for path, why in found if not why or not exists(path, ROOT)]


class Texts(unittest.TestCase):
    def test_hacking_is_short(self):
        lines = (ROOT / "HACKING.md").read_text(encoding="utf-8").splitlines()
        self.assertLessEqual(len(lines), HACKING_LINES)
        self.assertEqual([n for n, line in enumerate(lines, 1) if len(line) > LINE_LENGTH], [])

    def test_each_room_has_a_short_readme(self):
        found = rooms()
        self.assertGreater(len(found), 45)
        for room in found:
            with self.subTest(room=room.relative_to(ROOT).as_posix()):
                self.assertTrue((room / "README.md").is_file(), "no README.md")
                lines = (room / "README.md").read_text(encoding="utf-8").splitlines()
                self.assertLessEqual(len(lines), ROOM_LINES)
                self.assertEqual([n for n, line in enumerate(lines, 1) if len(line) > LINE_LENGTH], [])
                self.assertTrue(any(line.startswith("# ") for line in lines), "no title")

    def test_folders_of_datasets_are_described(self):
        text = (ROOT / "datasets/README.md").read_text(encoding="utf-8")
        folders = [p.name for p in sorted((ROOT / "datasets/src").iterdir()) if p.is_dir()]
        self.assertGreater(len(folders), 8)
        self.assertEqual([name for name in folders if f"`src/{name}/`" not in text], [])

    def test_paths_exist(self):
        count = 0
        for source in texts():
            with self.subTest(text=source.relative_to(ROOT).as_posix()):
                named, missing = missing_paths(source.read_text(encoding="utf-8"), source.parent)
                count += named
                self.assertEqual(missing, [])
        self.assertGreater(count, 500)

    def test_couplings_name_files(self):
        count = 0
        for room in rooms():
            for coupling in couplings((room / "README.md").read_text(encoding="utf-8")):
                count += 1
                with self.subTest(room=room.relative_to(ROOT).as_posix()):
                    self.assertIsNone(fault_of(coupling, room))
        self.assertGreater(count, 100)

    def test_comments_name_files(self):
        for folder in (*MODULES, "tools", "bench", "tests", "cmake"):
            for source in sorted((ROOT / folder).rglob("*")):
                if not fnmatch.fnmatch(source.name, "*.[ch]*") and source.suffix not in (".py", ".js", ".txt"):
                    continue
                if source.is_file() and source != pathlib.Path(__file__).resolve():
                    _, faults = comment_faults(source.read_text(encoding="utf-8", errors="replace"))
                    self.assertEqual(faults, [], source.relative_to(ROOT).as_posix())


class Checks(unittest.TestCase):
    """The checks above find what they look for."""

    def test_words_and_paths_are_told_apart(self):
        for word in ("lp::solve", "kGap", "--out FILE", "metrics.json", "build/release/bin", "n.v", "EXACTVO_REQUIRE", "A/B test"):
            self.assertIsNone(path_of(word), word)
        self.assertEqual(path_of("geometry/src/"), "geometry/src")
        self.assertEqual(path_of("tests/corpus/readers/FORMAT/"), "tests/corpus/readers")
        self.assertEqual(path_of("tools/verbs/ROOM/NAME.cpp"), "tools/verbs")
        self.assertEqual(path_of("datasets/data/README.md"), "datasets/data/README.md")

    def test_missing_path_is_found(self):
        text = "`geometry/src/` and `src/shapes/nothing.cpp`, in\n```\n`geometry/none.h`\n```\n"
        self.assertEqual(missing_paths(text, ROOT / "geometry"), (2, ["src/shapes/nothing.cpp"]))
        self.assertEqual(missing_paths("`exactvo/geometry/shapes.h` `random_*.h`", ROOT / "tests/geometry"), (2, []))

    def test_bad_couplings_are_found(self):
        room = ROOT / "geometry/src/shapes"
        text = ("x\n## Change together\n\n- `support.cpp` (`grown`) with `box_grid.cpp`,\n  `vo/src/cone/separation.cpp`: both bound\n  it.\n"
                "- `support.cpp` (`kSupportError`) with `none.cpp`: why.\n- `support.cpp` and `box_grid.cpp`: why.\n- `support.cpp` with `box_grid.cpp`\n- `support.cpp` (`no_such_name`) with `box_grid.cpp`: why.\n\n## Next\n- `a`\n")
        found = couplings(text)
        self.assertEqual(len(found), 5)
        self.assertIsNone(fault_of(found[0], room))
        self.assertIn("no file none.cpp", fault_of(found[1], room))
        self.assertIn("not of the form", fault_of(found[2], room))
        self.assertIn("no reason", fault_of(found[3], room))
        self.assertIn("no no_such_name in support.cpp", fault_of(found[4], room))

    def test_bad_comments_are_found(self):
        mark = "CHANGE " + "WITH"
        text = f"// {mark} geometry/src/shapes/support.cpp: same bound.\n  # {mark} geometry/none.h: why\n// {mark} README.md\n"
        self.assertEqual(comment_faults(text), (3, ["geometry/none.h", "README.md"]))


if __name__ == "__main__":
    unittest.main()
