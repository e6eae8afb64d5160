#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many robot steps a second of CPU time does the command `exactvo simulate` make, in two builds?

    commands.py OLD NEW [--old-data FOLDER] [--rounds 11] [--scenes 'A1|office'] [--first-step]

OLD and NEW are programs `exactvo`. Each scene of datasets/data is run with --out and --no-figures, so that recording,
table of rows and metrics are written. CPU time is user and system time of the whole process; nothing is subtracted. In a
round every program runs the scene as often as fills --seconds; the programs take turns. Medians of the rounds, and the
quartiles of the ratio. With --first-step the scenes end after their first step: what is left is the start, in ms.

NEW runs twice: with `--guidance none --liveness off`, as OLD where it has neither, and as a scenario is run that says
nothing of them (`--guidance route --liveness plan`; formations have neither).
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

DATA = pathlib.Path(__file__).resolve().parents[2] / "datasets/data"
SCENES = ([f"paper/A{k}" for k in range(1, 16)] + [f"paper/B{k}" for k in range(4)] +
          ["office/office", "formation/hundred"])
NONE = ["--guidance", "none", "--liveness", "off"]
DEFAULT = ["--guidance", "route", "--liveness", "plan"]


def cpu_name():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


class Case:
    """One program on one scene."""

    def __init__(self, program, scene, options, folder):
        self.command = [program, "simulate", scene, "--no-figures", *options]
        self.folder = folder / "out"

    def run(self):
        """Seconds of CPU time."""
        shutil.rmtree(self.folder, ignore_errors=True)
        child = subprocess.Popen([*self.command, "--out", str(self.folder)], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            raise SystemExit(f"{' '.join(self.command)} ended with {child.returncode}")
        return used.ru_utime + used.ru_stime

    def robot_steps(self):
        self.run()
        metrics = json.loads((self.folder / "metrics.json").read_text())
        return metrics["steps"] * len(metrics["robots"])


def first_step(scene, folder):
    """The scene that ends after its first step, beside the files it names."""
    scenario = json.loads(scene.read_text())
    scenario["time_limit"] = scenario.get("time_step", 0.05)
    place = folder / "scene"
    shutil.copytree(scene.parent, place)
    (place / scene.name).write_text(json.dumps(scenario))
    return place / scene.name


class Column:
    """A program with its options, on one scene."""

    def __init__(self, program, scene, options, folder, args):
        folder.mkdir()
        self.case = Case(program, str(first_step(scene, folder) if args.first_step else scene), options, folder)
        self.steps = self.case.robot_steps()
        self.times = max(1, round(args.seconds / max(1e-3, self.case.run())))
        self.seconds = []

    def take_turn(self):
        self.seconds.append(statistics.fmean(self.case.run() for _ in range(self.times)))


def shown(column, as_start):
    seconds = statistics.median(column.seconds)
    return f"{seconds * 1e3:.1f} ms" if as_start else f"{column.steps / seconds:.0f}"


def ratio(old, new):
    """'2.31 (2.28 to 2.35)'"""
    ratios = [x / y * new.steps / old.steps for x, y in zip(old.seconds, new.seconds)]
    low, middle, high = statistics.quantiles(ratios, n=4, method="inclusive")
    return f"{middle:.3g} ({low:.3g} to {high:.3g})"


def measure(scene, args, folder):
    old_scene, new_scene = args.old_data / f"{scene}.json", DATA / f"{scene}.json"
    is_formation = "formation" in json.loads(new_scene.read_text())
    old = Column(args.old, old_scene, args.old_options.split(), folder / "old", args)
    new = Column(args.new, new_scene, NONE, folder / "new", args)
    other = None if is_formation else Column(args.new, new_scene, DEFAULT, folder / "default", args)
    for _ in range(args.rounds):
        for column in (old, new, other):
            if column:
                column.take_turn()
    cells = [scene.split("/")[1], shown(old, args.first_step), shown(new, args.first_step), ratio(old, new)]
    cells += [shown(other, args.first_step), ratio(old, other)] if other else ["-", "-"]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--old-data", type=pathlib.Path, default=DATA, help="datasets/data as OLD reads it")
    parser.add_argument("--old-options", default="", help="for OLD, e.g. '--guidance none --liveness off'")
    parser.add_argument("--rounds", type=int, default=11)
    parser.add_argument("--seconds", type=float, default=0.3, help="CPU time of each measurement in a round, at least")
    parser.add_argument("--first-step", action="store_true", help="the start alone")
    parser.add_argument("--scenes", default=".*", help="regular expression of the scenes' names")
    args = parser.parse_args()
    print(f"CPU: {cpu_name()}\n")
    print("| scene | before | now | ratio | by default | ratio |\n| --- | --- | --- | --- | --- | --- |")
    for scene in SCENES:
        if re.fullmatch(args.scenes, scene.split("/")[1]):
            with tempfile.TemporaryDirectory() as folder:
                print(measure(scene, args, pathlib.Path(folder)), flush=True)


if __name__ == "__main__":
    main()
