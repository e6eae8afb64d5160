#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Process a folder: read maps of any format, see what is wrong with them, repair, convert, plan on the result.

    process_a_folder.py [FOLDER]      # without a folder it makes one
"""
import sys
import tempfile
from pathlib import Path

import exactvo
from exactvo import datasets


def made_for_show(folder: Path) -> Path:
    datasets.write(folder / "stars.geojson", datasets.generate("star", 20, seed=4), metres=True)
    (folder / "bowtie.wkt").write_text("POLYGON((0 0, 4 4, 4 0, 0 4, 0 0))\nLINESTRING(6 -2, 6 6)\n")
    (folder / "notes.txt").write_text("no map\n")
    return folder


def process(folder: Path, out: Path) -> None:
    for path in sorted(folder.iterdir()):
        try:
            file = datasets.read(path, skip_invalid=True)
        except exactvo.DataError as error:
            print(f"{path.name}: not read [{error.code}]")
            continue
        for finding in file.findings:
            if not finding.repaired:
                print(f"{path.name}: {finding}")
        repaired = datasets.read(path, repair=True)
        lost = datasets.write(out / f"{path.stem}.wkt", repaired)
        print(f"{path.name}: {len(file)} obstacles as they are, {len(repaired)} after the repair; lost in WKT: {lost or 'nothing'}")

        low_x, low_y, high_x, high_y = repaired.obstacles.bounds
        routes = exactvo.RouteMap(repaired.obstacles)
        start, goal = (low_x - 2, low_y - 2), (high_x + 2, high_y + 2)
        widest = routes.widest_radius(start, goal)
        answer = routes.plan(min(widest, 0.3)).route(start, goal)
        assert answer.check() == ""
        print(f"  the widest disc that gets across has a radius of {widest:.4g} m: {answer}")

    # Every obstacle of every file decomposed and certified, over all processors, resumable.
    summary = datasets.batch(folder, out / "batch", repair=True, write=["geojson"])
    print(f"batch: {summary.obstacles_out} obstacles, {summary.certified} certified; {summary.files.rejected or 'no'} files rejected")
    assert summary.complete and summary.uncertified == 0


with tempfile.TemporaryDirectory() as scratch:
    (Path(scratch) / "maps").mkdir()
    (Path(scratch) / "out").mkdir()
    process(Path(sys.argv[1]) if len(sys.argv) > 1 else made_for_show(Path(scratch) / "maps"), Path(scratch) / "out")
