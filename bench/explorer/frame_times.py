#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame of the page of `exactvo view` costs, and how large its files are: a table in Markdown.

frame_times.py --program EXACTVO [--data datasets/data] [--profile RUN]. Needs Chromium, its driver and Selenium. Of each
run the page is opened, stepped through (each step computes cones, words and proofs anew) and played. Times are those of
the script: medians as the page's clock has them, and the mean of the thread's processor time, which other programs do not
lengthen. `--profile` prints where the script of one run spends its time instead.
"""
import argparse
import collections
import json
import pathlib
import shutil
import statistics
import subprocess
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

STEP = """
const done = arguments[arguments.length - 1], run = exactvo.page.run, times = [];
const rows = Math.min(arguments[0], run.decisionTime.length || run.rows);
const next = (k) => {
  if (k === rows) return done(times);
  exactvo.seek(run.decisionTime.length ? run.decisionTime[k] : run.time[k]);
  exactvo.page.frames.length = 0;
  const wait = () => (exactvo.page.frames.length ? (times.push(exactvo.page.frames[0]), next(k + 1)) : requestAnimationFrame(wait));
  requestAnimationFrame(wait);
};
next(0);
"""
PLAY = """
const done = arguments[arguments.length - 1];
exactvo.seek(0);
exactvo.page.frames.length = 0;
document.getElementById('play').click();
const end = performance.now() + 1000 * arguments[0];
const wait = () => {
  if (performance.now() < end && exactvo.page.isPlaying) return requestAnimationFrame(wait);
  if (exactvo.page.isPlaying) document.getElementById('play').click();
  done([...exactvo.page.frames]);
};
wait();
"""


def scenes(place, data):
    """(name, arguments of view)."""
    def scenario(name, **entries):
        (place / f"{name}.json").write_text(json.dumps({"name": name, **entries}))
        return f"{name}.json"

    block = [{"id": f"R{k}", "position": [1.5 * (k % 8), 1.5 * (k // 8)], "goal": [30 + 1.5 * (k % 8), 1.5 * (k // 8)]} for k in range(51)]
    fifty = scenario("fifty", guidance="none", liveness="off", time_limit=3, robots=block)
    hundred = scenario("hundred", time_limit=6, robots=[{"circle": {"count": 100, "radius": 30}}])
    crowd = scenario("crowd", time_limit=12, robots=[{"grid": {"columns": 100, "rows": 100, "spacing": 2, "corner": [0, 0], "goal": [20, 0]}}])
    return [("A7, ivo", [data / "paper/A7.json"]), ("51 robots, 50 half-planes each", [fifty, "--method", "orca"]),
            ("100 robots on a circle", [hundred]), ("a crowd of 10,000", ["CROWD", crowd])]


def start_browser(profile):
    options = Options()
    options.binary_location = shutil.which("chromium")
    for flag in ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,900",
                 f"--user-data-dir={profile}"]:
        options.add_argument(flag)
    browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    browser.set_script_timeout(300)
    return browser


def processor(browser):
    metrics = browser.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return {m["name"]: m["value"] for m in metrics}["ScriptDuration"]


def row(browser, page):
    browser.get("about:blank")
    browser.get(f"file://{page}")
    browser.execute_async_script("exactvo.ready.then(arguments[0])")
    run = browser.execute_script("const r = exactvo.page.run; return [r.n, r.rows, r.decisionTime.length ? r.decision(0, 0).halfPlanes.length : 0]")
    cells = [f"{run[0]} x {run[1]}", str(run[2]), f"{1e-6 * page.stat().st_size:.2f} MB"]
    for script, argument in [(STEP, 60), (PLAY, 5)]:
        before = processor(browser)
        frames = browser.execute_async_script(script, argument)
        spent = processor(browser) - before
        frames.sort()
        cells.append(f"{statistics.median(frames):.1f} / {frames[int(0.95 * len(frames))]:.1f} / {1e3 * spent / len(frames):.1f} ms")
    return cells


def profile(browser, page):
    browser.get(f"file://{page}")
    browser.execute_async_script("exactvo.ready.then(arguments[0])")
    browser.execute_cdp_cmd("Profiler.enable", {})
    browser.execute_cdp_cmd("Profiler.setSamplingInterval", {"interval": 200})
    browser.execute_cdp_cmd("Profiler.start", {})
    browser.execute_async_script(STEP, 60)
    found = browser.execute_cdp_cmd("Profiler.stop", {})["profile"]
    names = {n["id"]: n["callFrame"]["functionName"] or "(anonymous)" for n in found["nodes"]}
    spent = collections.Counter()
    for node, delta in zip(found["samples"], found["timeDeltas"]):
        spent[names[node]] += delta
    for name, microseconds in spent.most_common(25):
        print(f"{microseconds / 60e3:8.2f} ms a frame  {name}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--data", default="datasets/data", type=pathlib.Path)
    parser.add_argument("--profile", help="the name of a run, or how it begins")
    args = parser.parse_args()
    program = args.program.resolve()
    with tempfile.TemporaryDirectory(prefix="exactvo_frames_", ignore_cleanup_errors=True) as folder:
        place = pathlib.Path(folder)
        browser = start_browser(place / "profile")
        try:
            browser.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
            if not args.profile:
                print("| run | robots x rows | half-planes | file | a step: median / 95th percentile / processor | playing: the same |")
                print("| --- | --- | --- | --- | --- | --- |", flush=True)
            for name, arguments in scenes(place, args.data.resolve()):
                if args.profile and not name.startswith(args.profile):
                    continue
                if arguments[0] == "CROWD":
                    subprocess.run([program, "-q", "simulate", arguments[1], "--decisions", "none", "--record", "crowd.evr", "--every", "4"], cwd=place,
                                   check=True, capture_output=True)
                    arguments = ["crowd.evr"]
                subprocess.run([program, "-q", "view", *arguments, "--out", "page.html"], cwd=place, check=True, capture_output=True)
                if args.profile:
                    profile(browser, place / "page.html")
                else:
                    print("|", " | ".join([name, *row(browser, place / "page.html")]), "|", flush=True)
        finally:
            browser.quit()


if __name__ == "__main__":
    main()
