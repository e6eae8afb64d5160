#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rooms of formation/src as formation/README.md lists them, from the data up: a file includes its own room and those before it."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ROOT / "formation" / "src"
INCLUDE = re.compile(r'^\s*#\s*include\s+"([a-z_0-9]+)/', re.MULTILINE)


def listed_rooms(text):
    """The rooms in the table, in its order."""
    return re.findall(r"^\| `src/([a-z_0-9]+)/` \|", text, re.MULTILINE)


def upward(rooms, files):
    """Of files {"room/name": text}: each include of a later room, and how many includes of rooms were looked at."""
    looked_at, found = 0, []
    for name, text in sorted(files.items()):
        room = name.split("/")[0] if "/" in name else None  # a file beside the rooms includes none of them
        for included in INCLUDE.findall(text):
            if included not in rooms:
                continue
            looked_at += 1
            if room is None or rooms.index(included) > rooms.index(room):
                found.append(f"{name} includes {included}/")
    return looked_at, found


class Rooms(unittest.TestCase):
    def setUp(self):
        self.rooms = listed_rooms((ROOT / "formation" / "README.md").read_text(encoding="utf-8"))

    def test_table_lists_the_folders(self):
        folders = {p.name for p in SOURCES.iterdir() if p.is_dir()}
        self.assertEqual(sorted(self.rooms), sorted(folders))

    def test_includes_lead_down(self):
        files = {str(p.relative_to(SOURCES)): p.read_text(encoding="utf-8")
                 for p in SOURCES.rglob("*") if p.suffix in (".h", ".cpp")}
        looked_at, found = upward(self.rooms, files)
        self.assertEqual(found, [])
        self.assertGreater(looked_at, 200)

    def test_upward_include_is_found(self):
        rooms = ["motion", "scene", "runs"]
        good = {"scene/a.h": '#include "motion/b.h"\n#include "scene/c.h"\n#include "exactvo/formation/d.h"\n',
                "runs/a.cpp": '#include "runs/a.h"\n  #  include "scene/a.h"\n'}
        self.assertEqual(upward(rooms, good), (4, []))
        for name, room in (("scene/e.h", "runs"), ("motion/e.cpp", "scene"), ("tasks.h", "motion")):
            files = {**good, name: f'#include <vector>\n#include "{room}/f.h"\n'}
            self.assertEqual(upward(rooms, files), (5, [f"{name} includes {room}/"]))


if __name__ == "__main__":
    unittest.main()
