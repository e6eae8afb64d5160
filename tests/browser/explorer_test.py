#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of `exactvo view` in a headless Chromium.

explorer_test.py --program EXACTVO --cases CERTIFICATE_CASES --data datasets/data PART, PART one of runs, page, proofs, live.
Exit status 77 where Chromium, its driver or Selenium is missing.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as xml
import zlib
from base64 import b64decode, b64encode

try:
    from selenium import webdriver
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
ARGS = None
ROBOTS_AT_A_TIME = 2.0**-13  # m: what positions are rounded to in a page


def start_browser(profile):
    options = Options()
    options.binary_location = CHROMIUM
    for flag in ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--disable-dev-shm-usage", "--window-size=1280,900", f"--user-data-dir={profile}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service(DRIVER), options=options)
    driver.set_script_timeout(120)
    return driver


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="exactvo_browser_")
        cls.place = pathlib.Path(cls.folder.name)
        cls.browser = start_browser(cls.place / "profile")

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        time.sleep(0.2)
        shutil.rmtree(cls.place, ignore_errors=True)

    def tearDown(self):
        errors = [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(errors, [], "the console has errors")

    def run_program(self, *arguments, status=0):
        done = subprocess.run([ARGS.program, *map(str, arguments)], cwd=self.place, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def open(self, name, address=""):
        self.browser.get("about:blank")
        self.browser.get(f"file://{self.place / name}{address}")
        self.browser.execute_async_script(
            "const done = arguments[0]; exactvo.ready.then(() => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def settle(self):
        """Waits until what changed is painted."""
        self.browser.execute_async_script("const d = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => d()))")

    def run_script(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def await_script(self, script, *arguments):
        """A script that gives a promise."""
        result = self.browser.execute_async_script(
            "const done = arguments[arguments.length - 1];"
            f"(async function() {{ {script} }}).apply(null, arguments).then((value) => done({{value}}), (error) => done({{error: String(error)}}))",
            *arguments)
        self.assertNotIn("error", result)
        return result.get("value")

    def text(self, selector):
        return self.run_script("const e = document.querySelector(arguments[0]); return e ? e.textContent : null", selector)

    def requests(self):
        """Addresses asked for over a network since the log was last read."""
        found = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                address = message["params"]["request"]["url"]
                if not address.startswith(("file:", "data:", "blob:", "about:")):
                    found.append(address)
        return found

    def press(self, key):
        self.browser.switch_to.active_element.send_keys(key)
        self.settle()


class Runs(Page):
    """Every scenario of the paper: what the page says is what the run wrote."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.names = sorted(path.stem for path in (ARGS.data / "paper").glob("*.json"))
        for name in cls.names:
            subprocess.run([ARGS.program, "--quiet", "simulate", ARGS.data / "paper" / f"{name}.json", "--no-figures", "--out", name],
                           cwd=cls.place, check=True, capture_output=True)
        subprocess.run([ARGS.program, "view", *cls.names, "--out", "paper.html"], cwd=cls.place, check=True, capture_output=True)

    def test_numbers_in_the_page_are_those_of_metrics_json(self):
        self.browser.get_log("performance")
        self.open("paper.html")
        keys = self.run_script("return exactvo.page.list.map((r) => r.key)")
        self.assertEqual(len(keys), len(self.names))
        for name, key in zip(self.names, keys):
            with self.subTest(name):
                self.await_script("await exactvo.openRun(arguments[0])", key)
                self.settle()
                self.compare(name, json.loads((self.place / name / "metrics.json").read_text()))
        self.assertEqual(self.requests(), [], "the page asked a network for something")

    def compare(self, name, metrics):
        shown = self.run_script(
            "return Object.fromEntries([...document.querySelectorAll('td[data-metric]')].map((td) => [td.dataset.metric, td.textContent]))")
        for key in ["jitter", "min_obstacle_clearance", "min_robot_clearance", "steps", "decisions.relaxed"]:
            metrics.setdefault("decisions.relaxed", metrics["decisions"]["relaxed"])
            if metrics[key] is not None:
                self.assertAlmostEqual(float(shown[key].split()[0]), metrics[key], delta=1e-4 * (1 + abs(metrics[key])))
        step = json.loads((ARGS.data / "paper" / f"{name}.json").read_text())["time_step"]
        for i, robot in enumerate(metrics["robots"]):
            self.run_script("exactvo.chooseRobot(arguments[0])", i)
            self.settle()
            shown = self.run_script(
                "return Object.fromEntries([...document.querySelectorAll('tr.robot td[data-metric]')].map((td) => [td.dataset.metric, parseFloat(td.textContent)]))")
            # Chords of curves are shorter; rounded positions wander by a quantum a row.
            rounding = 2 * ROBOTS_AT_A_TIME * metrics["steps"] + 0.001
            self.assertLess(abs(shown["page.path_length"] - robot["path_length"]), 0.002 * robot["path_length"] + rounding)
            if robot["min_obstacle_clearance"] is not None:
                # At rows, so no less than over the whole motion, and by no more than a step's way.
                over = shown["page.obstacle_clearance"] - robot["min_obstacle_clearance"]
                self.assertGreater(over, -0.002)
                self.assertLess(over, step * 6 * 1.5 + 0.002)

    def test_the_clearance_that_the_page_computes_is_the_runs(self):
        self.open("paper.html")
        key = [k for k in self.run_script("return exactvo.page.list.map((r) => r.key)") if k.startswith("A1-")][0]
        self.await_script("await exactvo.openRun(arguments[0])", key)
        self.settle()
        metrics = json.loads((self.place / "A1" / "metrics.json").read_text())
        least = self.run_script("return Math.min(...[0, 1].map((i) => { exactvo.chooseRobot(i); let least = Infinity; const run = exactvo.page.run;"
                                "for (let row = 0; row < run.rows; ++row) least = Math.min(least, exactvo.obstacleClearance(run, row, i)); return least; }))")
        self.assertAlmostEqual(least, metrics["min_obstacle_clearance"], delta=0.02)

    def test_decisions_are_the_recordings_bit_for_bit(self):
        self.open("paper.html")
        key = [k for k in self.run_script("return exactvo.page.list.map((r) => r.key)") if k.startswith("A7-")][0]
        self.await_script("await exactvo.openRun(arguments[0])", key)
        rows = []
        for line in (self.place / "A7" / "recording.jsonl").read_text().splitlines():
            value = json.loads(line)
            if "row" in value:
                rows.append(value["row"])
        for k in [0, 33, 66, len(rows) - 2]:
            for i, robot in enumerate(rows[k]["robots"]):
                d = self.run_script("const d = exactvo.page.run.decision(arguments[0], arguments[1]); return [d.time, d.position, d.velocity, "
                                    "d.preferred, d.chosen, d.status, d.halfPlanes.map((h) => [h.body, h.nx, h.ny, h.c, h.multiplier, h.timeHorizon])]", k, i)
                self.assertEqual(d[:6], [rows[k]["time"], robot["position"], robot["velocity"], robot["preferred"], robot["chosen"], robot["status"]])
                expected = [[c["body"], *c["normal"], c["offset"], c.get("multiplier", 0), c["time_horizon"]] for c in robot.get("constraints", [])]
                self.assertEqual(d[6], expected)

    def test_plays_scrubs_steps_and_selects(self):
        self.open("paper.html")
        self.assertEqual(self.text("#time"), "0.00 s")
        self.run_script("document.getElementById('play').click()")
        self.await_script("await new Promise((r) => setTimeout(r, 500))")
        self.run_script("document.getElementById('play').click()")
        self.settle()
        played = self.run_script("return exactvo.ui.t")
        self.assertGreater(played, 0.05)
        self.run_script("const s = document.getElementById('scrub'); s.value = 2.0; s.dispatchEvent(new Event('input'))")
        self.settle()
        self.assertEqual(self.text("#time"), "2.00 s")
        self.assertEqual(self.text("[data-fact=time]"), "2.00 s")
        self.run_script("document.getElementById('step').click()")
        self.settle()
        self.assertEqual(self.text("[data-fact=time]"), "2.05 s")
        self.run_script("document.getElementById('back').click(); document.getElementById('back').click()")
        self.settle()
        self.assertEqual(self.text("[data-fact=time]"), "1.95 s")
        robots = self.run_script("return [...document.querySelectorAll('#robot option')].map((o) => o.textContent)")
        self.run_script("const s = document.getElementById('robot'); s.value = '1'; s.dispatchEvent(new Event('change'))")
        self.settle()
        self.assertEqual(self.text("#space-robot"), robots[1])

    def test_a_long_run_is_thinned_and_the_page_says_so(self):
        self.run_program("view", "A7", "--most-states", "100", "--most-numbers", "2000", "--out", "thin.html")
        self.open("thin.html")
        rows, decisions, end = self.run_script("const r = exactvo.page.run; return [r.rows, r.decisionTime.length, r.end]")
        whole = self.run_script("return exactvo.page.run.head.rows.of")
        self.assertLessEqual(rows * 4, 100 + 4)
        self.assertGreater(rows, 8)
        self.assertLess(decisions * 4 * 14, 2000)
        self.assertAlmostEqual(end, 0.05 * (whole - 1), places=6, msg="the last row is kept")
        self.assertRegex(self.text("#partial"), r"One row in \d+ has its decisions.*One row in \d+ is in")

    def test_a_crowd_of_ten_thousand_plays(self):
        side, rows = 100, 4
        lines = (self.place / "A7" / "recording.jsonl").read_text().splitlines()
        header, end = json.loads(lines[0]), json.loads(lines[-1])
        scenario = header["header"]["scenario"]
        starts = [(4 * (i % side), 4 * (i // side)) for i in range(side * side)]
        robot = scenario["robots"][0]
        scenario["obstacles"] = []
        scenario["robots"] = [{**robot, "id": f"r{i}", "position": at, "goals": [[at[0] + 30, at[1]]]} for i, at in enumerate(starts)]
        end["end"].update(rows=rows, stuck=[], collisions=[])
        step = header["header"]["time_step"]
        crowd = [{"row": {"time": k * step, "robots": [{"position": [x + k * step, y], "velocity": [1, 0], "preferred": [1, 0], "chosen": [1, 0],
                                                        "status": "optimal", "mode": "direct"} for x, y in starts]}} for k in range(rows)]
        (self.place / "crowd").mkdir()
        (self.place / "crowd" / "recording.jsonl").write_text("\n".join(json.dumps(value) for value in [header, *crowd, end]) + "\n")
        (self.place / "crowd" / "metrics.json").write_text("{}")
        self.run_program("view", "crowd", "--out", "crowd.html")
        self.open("crowd.html")
        self.run_script("document.getElementById('speed').selectedIndex = 0; document.getElementById('speed').dispatchEvent(new Event('change'));"
                        "document.getElementById('play').click()")
        self.await_script("await new Promise((r) => setTimeout(r, 500))")
        self.run_script("exactvo.page.isPlaying && document.getElementById('play').click()")
        self.settle()
        now, x = self.run_script("return [exactvo.ui.t, exactvo.page.positions.x[5050]]")
        self.assertGreater(now, 0.01)
        self.assertAlmostEqual(x, starts[5050][0] + now, delta=0.01)
        self.run_script("const v = exactvo.page.world; v.scale = 40; [v.cx, v.cy] = arguments[0]; exactvo.page.dirty = true", starts[5050])
        self.settle()
        at = self.run_script("const b = document.getElementById('world').getBoundingClientRect(), v = exactvo.page.world;"
                             "return [b.left + v.px(exactvo.page.positions.x[5050]), b.top + v.py(exactvo.page.positions.y[5050])]")
        for kind in ["mousePressed", "mouseReleased"]:
            self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": at[0], "y": at[1], "button": "left", "clickCount": 1})
        self.settle()
        self.assertEqual(self.text("#space-robot"), "r5050")
        self.assertEqual(self.run_script("return document.getElementById('problem').hidden"), True)

    def test_a_click_on_a_robot_selects_it(self):
        self.open("paper.html")
        at = self.run_script("const p = exactvo.page, b = document.getElementById('world').getBoundingClientRect();"
                             "return [b.left + p.world.px(p.positions.x[1]), b.top + p.world.py(p.positions.y[1])]")
        for kind in ["mousePressed", "mouseReleased"]:
            self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": at[0], "y": at[1], "button": "left", "clickCount": 1})
        self.settle()
        self.assertEqual(self.run_script("return exactvo.ui.robot"), 1)

    def test_a_scenario_can_be_viewed_without_a_run(self):
        self.run_program("view", ARGS.data / "paper" / "A1.json", "--method", "orca", "--out", "a1.html")
        self.open("a1.html", "#t=10&robot=R1")
        explained = self.run_program("explain", ARGS.data / "paper" / "A1.json", "--method", "orca", "--time", "10", "--robot", "R1").stdout
        for fact, line in [("preferred", "preferred"), ("position", "position")]:
            self.assertIn(self.text(f"[data-fact={fact}]"), explained)
        self.assertIn("held by an edge of obstacle wall", self.text("#why"))
        self.assertEqual(len(self.run_script("return exactvo.page.space.decision.halfPlanes.map((h) => h.body)")), explained.count("\n  ["))


class PageItself(Page):
    """What the page does with any run: keys, the address, names, damage, files that it saves."""

    HOSTILE = ["</script><script>window.broken = 1</script>", "\"'`&<>${1}", "n" * 200, "\u202e\u05e9\u05dc\u05d5\u05dd\u202c", "__RUNS__ <!-- ]]>"]

    def test_without_a_run_three_scenes_are_shown(self):
        self.browser.get_log("performance")
        self.run_program("view", "--out", "start.html")
        self.open("start.html")
        titles = self.run_script("return [...document.querySelectorAll('#guide button')].map((b) => b.textContent)")
        self.assertEqual(len(titles), 3)
        for k in range(3):
            self.run_script("document.querySelectorAll('#guide button')[arguments[0]].click()", k)
            self.await_script("await new Promise((r) => setTimeout(r, 200))")
            self.settle()
            self.assertEqual(self.text("#name"), titles[k])
            self.assertEqual(self.text("#guide p").count(". ") + 1, 2, "two sentences each")
            self.assertEqual(self.text("#verdict"), "\u2713 proven")
        self.assertEqual(self.requests(), [])
        self.assertLess((self.place / "start.html").stat().st_size - self.size_of_data("start.html"), 1_000_000)

    def size_of_data(self, name):
        text = (self.place / name).read_text()
        return sum(len(part.split("</script>")[0]) for part in text.split('<script type="text/plain"')[1:])

    def test_keys(self):
        self.run_program("view", "--out", "start.html")
        self.open("start.html", "#run=circle&t=3")
        body = "document.body.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], bubbles: true, cancelable: true, shiftKey: !!arguments[1]}))"

        def press(key, shift=False):
            self.run_script(body, key, shift)
            self.settle()

        press("ArrowRight")
        self.assertAlmostEqual(self.run_script("return exactvo.ui.t"), 3.05, places=9)
        press("ArrowLeft", True)
        self.assertAlmostEqual(self.run_script("return exactvo.ui.t"), 2.05, places=9)
        press("]")
        self.assertEqual(self.run_script("return exactvo.ui.robot"), 1)
        press("ArrowDown")
        self.assertEqual(self.run_script("return exactvo.ui.pinned"), 0)
        self.assertEqual(self.run_script("return document.querySelectorAll('#half-planes li.chosen').length"), 1)
        press("Escape")
        self.assertIsNone(self.run_script("return exactvo.ui.pinned"))
        press("n")
        self.assertEqual(self.text("#event").split(": ")[1], "arrived")
        press("f")
        self.assertTrue(self.run_script("return exactvo.page.follow"))
        theme = self.run_script("return document.documentElement.dataset.theme")
        press("t")
        self.assertNotEqual(self.run_script("return document.documentElement.dataset.theme"), theme)
        press("Home")
        press(" ")
        self.assertTrue(self.run_script("return exactvo.page.isPlaying"))

    def test_the_address_holds_what_is_seen(self):
        self.run_program("view", "--out", "start.html")
        self.open("start.html", "#run=circle&t=3.3&robot=west")
        self.assertEqual([self.text("#time"), self.text("#space-robot")], ["3.30 s", "west"])
        self.run_script("exactvo.seek(4.25); exactvo.chooseRobot(3)")
        self.await_script("await new Promise((r) => setTimeout(r, 400))")
        self.assertEqual(self.run_script("return location.hash"), "#run=circle&t=4.25&robot=south")
        for strange in ["#t=NaN&robot=nobody", "#%%%&t=1e999", "#run=nothing", "#t=-5&robot=%00"]:
            self.open("start.html", strange)
            self.assertTrue(self.run_script("return document.getElementById('problem').hidden"), strange)

    def test_hostile_names_change_nothing(self):
        scenario = {"name": self.HOSTILE[0], "description": self.HOSTILE[1] * 1000, "time_limit": 3, "guidance": "none",
                    "robots": [{"id": name, "position": [0, 2 * k], "goal": [6, 2 * k]} for k, name in enumerate(self.HOSTILE)],
                    "obstacles": [{"id": name, "polyline": [[9 + k, 0], [9 + k, 1]]} for k, name in enumerate(self.HOSTILE)]}
        (self.place / "hostile.json").write_text(json.dumps(scenario))
        self.run_program("view", "hostile.json", "--out", "hostile.html")
        self.assertNotIn("window.broken = 1", (self.place / "hostile.html").read_text())
        self.open("hostile.html")
        for k in range(len(self.HOSTILE)):
            self.run_script("exactvo.chooseRobot(arguments[0])", k)
            self.settle()
            self.assertTrue(self.run_script("return document.getElementById('problem').hidden"))
            for svg in ["svgOfMoment", "svgOfRun"]:
                xml.fromstring(self.run_script(f"return exactvo.{svg}()"))
        self.assertIsNone(self.run_script("return window.broken || null"))
        self.assertEqual(self.run_script("return document.querySelectorAll('script').length"), 3)
        self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), 1280)

    def damaged(self, name, change):
        """The page with its run's data changed: `change` takes and gives base64."""
        text = (self.place / "start.html").read_text()
        head, rest = text.split('<script type="text/plain" class="run">', 1)
        data, tail = rest.split("</script>", 1)
        (self.place / name).write_text(head + '<script type="text/plain" class="run">' + change(data) + "</script>" + tail)
        self.open(name)
        self.assertFalse(self.run_script("return document.getElementById('problem').hidden"), name)
        return self.text("#problem")

    def test_damaged_data_is_reported(self):
        self.run_program("view", "--out", "start.html")
        self.assertIn("cut short", self.damaged("cut.html", lambda data: data[:len(data) // 2 // 4 * 4]))
        self.assertIn("not base64", self.damaged("letters.html", lambda data: data[:99] + "\u00e4" + data[100:]))

        def changed(at):
            return lambda data: data[:at] + ("A" if data[at] != "A" else "B") + data[at + 1:]

        self.assertIn("damaged", self.damaged("bit.html", changed(5000)))

        def repacked(change):
            return lambda data: b64encode(zlib.compress(change(zlib.decompress(b64decode(data))))).decode()

        self.assertIn("another version", self.damaged("version.html", repacked(lambda b: b"EXVIEW99" + b[8:])))
        self.assertIn("not a packed run", self.damaged("other.html", repacked(lambda b: b"something else" * 10)))
        self.assertIn("cut short in column", self.damaged("column.html", repacked(lambda b: b[:len(b) * 3 // 4])))
        self.assertIn("cut short", self.damaged("head.html", repacked(lambda b: b[:400])))

    def test_a_page_that_is_cut_short_says_so(self):
        self.run_program("view", "--out", "start.html")
        text = (self.place / "start.html").read_text()
        head, rest = text.split('<script type="text/plain" class="run">', 1)
        script = rest[rest.rindex("<script>"):]
        (self.place / "none.html").write_text(head + script)
        self.open("none.html")
        self.assertIn("a run is missing", self.text("#problem"))

    def test_a_long_wall_fills_the_view_behind_its_cut_off(self):
        """Its legs open by nearly 180 degrees; a ring that ended on them left velocities beyond unpainted."""
        scenario = {"name": "long wall", "time_limit": 1, "guidance": "none", "robots": [{"id": "R1", "position": [0, 0], "goal": [0, -9]}],
                    "obstacles": [{"id": "wall", "polyline": [[-60, -0.7], [60, -0.7]]}]}
        (self.place / "wall.json").write_text(json.dumps(scenario))
        self.run_program("view", "wall.json", "--method", "orca", "--out", "wall.html")
        self.open("wall.html", "#t=0.5&theme=light")
        painted = self.run_script("""const c = document.getElementById('space'), p = exactvo.page.plane, ctx = c.getContext('2d');
            return [[0.4, -1], [-0.4, -2.5], [1.1, -3.4], [-1.7, -3.3]].map(([x, y]) => ctx.getImageData(Math.round(p.px(x)), Math.round(p.py(y)), 1, 1).data.join())""")
        self.assertNotIn("255,255,255,255", painted)

    def test_pointing_names_a_thing_and_a_click_keeps_it(self):
        self.run_program("view", "--out", "start.html")
        self.open("start.html", "#run=wall&t=5")

        def mouse(kind, at):
            self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": at[0], "y": at[1], "button": "left" if kind != "mouseMoved" else "none",
                                                                      "clickCount": 1 if kind != "mouseMoved" else 0})
            self.settle()

        def place(canvas, view, x, y):
            return self.run_script("const b = document.getElementById(arguments[0]).getBoundingClientRect(), v = exactvo.page[arguments[1]];"
                                   "return [b.left + v.px(arguments[2]), b.top + v.py(arguments[3])]", canvas, view, x, y)

        line = place("space", "plane", self.run_script("return -exactvo.page.space.decision.halfPlanes[0].c"), 1.0)
        mouse("mouseMoved", line)
        tip = self.text("#tip")
        for words in ["[1] an edge of obstacle wall, binding", "m from the robot's rim", "horizon 2.00 s", "m/s; hard", "multiplier"]:
            self.assertIn(words, tip)
        mouse("mousePressed", line)
        mouse("mouseReleased", line)
        self.assertEqual(self.run_script("return exactvo.ui.pinned"), 0)
        mouse("mouseMoved", place("world", "world", 6.0, 2.0))
        self.assertIn("obstacle wall", self.text("#tip"))
        self.assertRegex(self.text("#tip"), r"\d m from the rim of R1")
        mouse("mouseMoved", place("world", "world", *self.run_script("return [exactvo.page.positions.x[0], exactvo.page.positions.y[0]]")))
        self.assertIn("of 2 m/s", self.text("#tip"))
        self.assertEqual(self.run_script("return exactvo.ui.pinned"), 0, "kept")

    def test_a_robot_that_stands_beside_movers_is_labelled_so(self):
        self.run_program("view", ARGS.data / "robots" / "burger_movers.json", "--out", "movers.html")
        self.open("movers.html", "#t=8&robot=R1")
        self.assertEqual(self.text("[data-fact=stands]"), "nothing is promised to it against moving obstacles")
        self.assertIn("It stands, since a moving obstacle could reach it while it moves", self.text("#why"))
        self.assertNotIn("proven route", self.text("#why"))
        self.assertRegex(self.text("#collisions"), r"R1: stood and was hit by moving obstacle \w+, .* deep at")
        self.assertIn("it stood and was hit", self.text("#world-legend"))
        self.open("movers.html", "#t=2&robot=R1")
        explained = self.run_program("explain", ARGS.data / "robots" / "burger_movers.json", "--robot", "R1", "--time", "2").stdout
        stands = self.text("[data-fact=stands]")
        self.assertRegex(stands, "after .* s if it brakes: proven to touch no moving obstacle before")
        self.assertIn(stands, explained)
        judged = self.run_script('''  // of each half-plane against a mover, as it is and with edits
            const run = exactvo.page.run, edits = [(h) => 0, (h) => h.c -= 1e-3, (h) => h.steps += 1, (h) => h.mostSpeed *= 1.1, (h) => h.nx *= -1];
            const judged = edits.map(() => [0, 0]);
            for (let row = 0; row < run.decisionTime.length; ++row)
              for (const k of run.decision(row, 0).halfPlanes.keys())
                edits.forEach((edit, e) => {
                  const d = run.decision(row, 0), h = d.halfPlanes[k];
                  if (h.kind !== 'moving' || !h.active) return;
                  edit(h);
                  ++judged[e][exactvo.checkConstraint(run, d, h).ok ? 0 : 1];
                });
            return judged''')
        self.assertGreater(judged[0][0], 5)
        self.assertEqual(judged[0][1], 0, "a half-plane of the run is not proven")
        for proven, refuted in judged[1:]:
            self.assertEqual((proven, refuted), (0, judged[0][0]))

    def test_robots_that_wait_and_those_they_wait_for(self):
        scenario = {"name": "narrow", "time_limit": 12, "guidance": "none",
                    "robots": [{"id": "left", "position": [-4, 0], "goal": [4, 0]}, {"id": "right", "position": [4, 0], "goal": [-4, 0]}],
                    "obstacles": [{"id": f"wall {y}", "polyline": [[-6, y], [6, y]]} for y in (-0.7, 0.7)]}
        (self.place / "narrow.json").write_text(json.dumps(scenario))
        self.run_program("view", "narrow.json", "--out", "narrow.html")
        self.open("narrow.html", "#t=9&robot=left")
        self.assertEqual(self.text("[data-fact=waiting]"), "waits for right, which waits for left: a deadlock")

    def test_what_is_violated_by_less_than_the_most_is_violated(self):
        at = [[1.2 * (k % 4), 1.2 * (k // 4)] for k in range(16)]
        scenario = {"name": "lattice", "time_limit": 3, "liveness": "off", "guidance": "none",
                    "robots": [{"id": f"R{k}", "position": at[k], "goal": at[(5 * k + 3) % 16]} for k in range(16)]}
        (self.place / "lattice.json").write_text(json.dumps(scenario))
        self.run_program("view", "lattice.json", "--method", "orca", "--out", "lattice.html")
        self.open("lattice.html")
        time, robot, number = self.run_script("""
            const run = exactvo.page.run;
            for (let row = 0; row < run.decisionTime.length; ++row)
              for (let i = 0; i < run.n; ++i) {
                const d = run.decision(row, i);
                if (d.status !== 'relaxed') continue;
                const k = d.halfPlanes.findIndex((h) => !h.active && h.c - h.nx * d.chosen[0] - h.ny * d.chosen[1] > 1e-4);
                if (k >= 0) return [d.time, i, k];
              }
            return [-1, -1, -1];""")
        self.assertGreaterEqual(number, 0, "no such decision: another scene is needed")
        self.run_script("exactvo.chooseRobot(arguments[0]); exactvo.seek(arguments[1])", robot, time)
        self.settle()
        self.assertEqual(self.run_script("return exactvo.page.space.effects[arguments[0]]", number), "violated")
        self.assertIn("violated", self.run_script("return document.querySelector(`#half-planes [data-half-plane='${arguments[0]}']`).className", number))
        explained = self.run_program("explain", "lattice.json", "--method", "orca", "--time", time, "--robot", robot).stdout
        self.assertRegex(explained, rf"\[{number + 1}\] robot R\d+, violated by ")
        self.assertIn(re.search(r"Why: no (.*)", explained)[1].strip(), self.text("#why"))

    def test_joint_plans_are_those_of_the_recording(self):
        wall = [[-12, 0], [12, 0], [12, 1.5], [5.7, 1.5], [5.7, 2.9], [4.3, 2.9], [4.3, 1.5], [-12, 1.5], [-12, 0]]
        scenario = {"name": "siding", "time_limit": 25, "obstacles": [{"id": "corridor", "polyline": wall}],
                    "robots": [{"id": "east", "position": [-10, 0.75], "goal": [10, 0.75], "max_speed": 1.5},
                               {"id": "west", "position": [10, 0.75], "goal": [-10, 0.75], "max_speed": 1.5}]}
        (self.place / "siding.json").write_text(json.dumps(scenario))
        self.run_program("simulate", "siding.json", "--out", "siding")
        lines = [json.loads(line) for line in (self.place / "siding/recording.jsonl").read_text().splitlines()]
        plans = [line["plan"] for line in lines if "plan" in line]
        self.assertTrue(plans)
        for page in ("siding/explorer.html", "viewed.html"):  # as the run made it, and made of its recording
            self.run_program("view", "siding", "--out", "viewed.html")
            self.open(page)
            shown = self.run_script("return exactvo.page.run.head.plans")
            self.assertEqual([p["robots"] for p in shown], [[r["robot"] for r in p["robots"]] for p in plans])
            for mine, plan in zip(shown, plans):
                self.assertAlmostEqual(mine["time"], 0.05 * plan["row"])
                self.assertEqual(mine["starts"], [x for r in plan["robots"] for x in r["start"]])
                self.assertEqual(mine["movers"], [move["robot"] for move in plan["moves"]])
                self.assertEqual(mine["places"], [x for move in plan["moves"] for x in move["to"]])
            moves, own = len(plans[0]["moves"]), sum(move["robot"] == 1 for move in plans[0]["moves"])
            self.open(page, f"#t={shown[0]['time']}&robot=west")
            self.assertRegex(self.text("[data-fact=plan]"), rf"^made at [\d.]+ s for 2 robots: {moves} moves, {own} of its own")
            with_plan = self.run_script("return exactvo.svgOfMoment()")
            without = self.run_script("exactvo.page.run.head.plans = []; return exactvo.svgOfMoment()")
            self.assertGreater(len(with_plan), len(without), "the plan is drawn")
            self.open(page, "#t=0&robot=west")
            self.assertEqual(self.run_script("return document.querySelectorAll('[data-fact=plan]').length"), 0)

    def test_an_address_that_asks_for_what_is_not_here_says_so(self):
        self.run_program("view", "--out", "start.html")
        for words, expected in [("#run=other", "no run 'other'"), ("#run=circle&robot=nobody", "no robot 'nobody'"), ("#run=wall&t=soon", "'soon' is no time"),
                                ("#run=wall&t=999", "there is no 999 s"), ("#run=%3Cb%3E", "no run '<b>'")]:
            self.open("start.html", words)
            self.assertIn(expected, self.text("#notice"), words)
            self.assertFalse(self.run_script("return document.getElementById('notice').hidden"))
        self.open("start.html", "#run=circle&robot=west&t=2")
        self.assertTrue(self.run_script("return document.getElementById('notice').hidden"))

    def test_routes_and_a_goal_out_of_reach_with_its_reason(self):
        scenario = {"name": "room", "time_limit": 10, "robots": [{"id": "barred", "position": [-6, 0], "goal": [0, 0]},
                                                               {"id": "free", "position": [-6, 3], "goal": [6, 3]}],
                    "obstacles": [{"id": "room", "polyline": [[-2, -2], [2, -2], [2, 2], [-2, 2], [-2, -2]]}]}
        (self.place / "room.json").write_text(json.dumps(scenario))
        self.run_program("view", "room.json", "--out", "room.html")
        self.open("room.html")
        barred, routes = self.run_script("return [exactvo.page.run.unreachable, exactvo.page.run.head.routes]")
        self.assertEqual([(u["robot"], u["goal"]) for u in barred], [(0, 0)])
        self.assertIn("obstacle 'room' encloses", barred[0]["why"])
        self.assertEqual(routes[1]["points"][:2] + routes[1]["points"][-2:], [-6, 3, 6, 3])
        at = self.run_script("const b = document.getElementById('world').getBoundingClientRect(), v = exactvo.page.world; return [b.left + v.px(0), b.top + v.py(0)]")
        self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": at[0], "y": at[1], "button": "none"})
        self.settle()
        self.assertIn("out of reach: obstacle 'room'", self.text("#tip"))

    def test_a_recording_of_a_crowd_plays(self):
        crowd = {"name": "crowd", "time_step": 0.25, "time_limit": 5, "horizons": {"least": 0.5, "orca": 5}, "guidance": "none",
                 "robots": [{"grid": {"columns": 20, "rows": 10, "spacing": 3, "corner": [0, 0], "goal": [50, 0]}, "radius": 0.5, "max_speed": 2}],
                 "obstacles": [{"id": "wall", "polyline": [[90, 0], [90, 9], [95, 9]]}]}
        (self.place / "crowd.json").write_text(json.dumps(crowd))
        self.run_program("simulate", "crowd.json", "--decisions", "none", "--record", "crowd.evr", "--every", "1")
        self.run_program("view", "crowd.evr", "--most-states", "2000", "--out", "evr.html")
        self.run_program("convert", "crowd.evr", "crowd.csv")
        last = (self.place / "crowd.csv").read_text().splitlines()[-1].split(",")
        self.open("evr.html", "#t=5")
        rows, robots, x, walls = self.run_script("const r = exactvo.page.run; return [r.rows, r.n, r.x(r.rows - 1, r.n - 1), r.obstacles.length]")
        self.assertEqual((robots, walls), (200, 1))
        self.assertLessEqual(rows, 11)
        self.assertAlmostEqual(x, float(last[3]), delta=ROBOTS_AT_A_TIME)
        self.assertIn("positions only", self.text("#why"))
        self.assertIn("exactvo-verify, whose checkers are proven in Coq, covers of a recording: that on straight motions", self.text("#covered"))

    def test_trajectories_of_a_check_play_and_lead_to_their_overlaps(self):
        rows = [(0, "A", 0, 0), (0, "B", 5, -5), (1, "A", 10, 0), (1, "B", 5, 5), (2, "C", 9, 1), (4, "C", 9, -3)]
        (self.place / "t.csv").write_text("t,id,x,y\n" + "".join(f"{t},{i},{x},{y}\n" for t, i, x, y in rows))
        (self.place / "map.wkt").write_text("POLYGON ((8 -2, 10 -2, 10 -1, 8 -1, 8 -2))\n")
        box = "POLYGON ((-0.4 -0.2, 0.4 -0.2, 0.4 0.2, -0.4 0.2, -0.4 -0.2))"
        self.run_program("check", "t.csv", "--footprint", box, "--map", "map.wkt", "--page", "pages/check.html", status=1)
        self.open("pages/check.html", "#t=0")
        self.assertEqual(self.text("#outcome"), "2 overlaps, 0 contacts")
        listed = self.run_script("return [...document.querySelectorAll('#collisions button')].map((b) => b.textContent)")
        self.assertEqual(len(listed), 2)
        self.assertIn("A: collision with B", listed[0])
        self.assertIn("C: collision with the polygon 1 of the map", listed[1])
        self.assertEqual(self.text("#moment"), "Moment")
        self.assertIn("covers of certificates of exactvo check --certificates: that", self.text("#covered"))
        there = self.run_script("const r = exactvo.page.run; return [0, 0.5, 1.5, 3].map((t) => [0, 1, 2].map((i) => r.isThere(i, t)))")
        self.assertEqual(there, [[True, True, False], [True, True, False], [False, False, False], [False, False, True]])
        self.run_script("document.querySelectorAll('#collisions button')[0].click()")
        self.settle()
        time, robot, x, y, corners = self.run_script(
            "const p = exactvo.page, r = p.run; p.positions.at(exactvo.ui.t);"
            "return [exactvo.ui.t, exactvo.ui.robot, p.positions.x[0], p.positions.y[1], r.robots[0].outline[0].length / 2]")
        self.assertAlmostEqual(time, 0.5, delta=0.05)
        self.assertEqual(robot, 0)
        self.assertAlmostEqual(x, 10 * time, delta=2 * ROBOTS_AT_A_TIME)
        self.assertAlmostEqual(y, 10 * time - 5, delta=2 * ROBOTS_AT_A_TIME)
        self.assertGreaterEqual(corners, 4)
        self.assertIn("exactvo check", self.text("#why"))
        jitter, speed = self.run_script("const s = exactvo.page.series; return [s.jitter, s.speed].map((v) => v.some(Number.isFinite))")
        self.assertEqual((jitter, speed), (False, True))

    def test_the_moment_as_svg(self):
        self.run_program("view", "--out", "start.html")
        self.open("start.html", "#run=gap&t=3&robot=R3")
        svg = xml.fromstring(self.run_script("return exactvo.svgOfMoment()"))
        texts = [e.text for e in svg.iter("{http://www.w3.org/2000/svg}text")]
        self.assertTrue(any("R3 at 3.00 s" in text for text in texts))
        self.assertNotIn("half-planes not recorded", texts)
        self.assertGreater(len(list(svg.iter("{http://www.w3.org/2000/svg}path"))), 20)

    def test_the_picture_says_where_half_planes_were_not_recorded(self):
        self.run_program("simulate", ARGS.data / "paper" / "A7.json", "--no-figures", "--out", "partly")
        self.run_program("view", "partly", "--out", "partly.html")
        self.open("partly.html", "#t=3&robot=R1")
        svg = xml.fromstring(self.run_script("return exactvo.svgOfMoment()"))
        self.assertIn("half-planes not recorded", [e.text for e in svg.iter("{http://www.w3.org/2000/svg}text")])

    def test_the_run_as_an_animation(self):
        self.run_program("view", "--out", "start.html")
        self.open("start.html", "#run=circle")
        svg = xml.fromstring(self.run_script("return exactvo.svgOfRun()"))
        animated = list(svg.iter("{http://www.w3.org/2000/svg}animate"))
        self.assertEqual(len(animated), 2 * 4)
        for a in animated:
            self.assertEqual(len(a.get("values").split(";")), len(a.get("keyTimes").split(";")))

    def test_the_run_as_a_film(self):
        self.run_program("view", "--out", "start.html")
        self.open("start.html", "#run=circle&t=7.6")
        size = self.await_script("document.getElementById('film').click(); for (let k = 0; k < 100; ++k) {"
                                 "await new Promise((r) => setTimeout(r, 100)); if (exactvo.page.film !== undefined) break; }"
                                 "return exactvo.page.film ? exactvo.page.film.size : 0")
        self.assertGreater(size, 1000)

    def test_nothing_is_wider_than_a_narrow_screen(self):
        self.run_program("view", "--out", "start.html")
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 390, "height": 800, "deviceScaleFactor": 2, "mobile": True})
        try:
            self.open("start.html", "#run=gap&t=3")
            self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), 390)
            small = self.run_script("return [...document.querySelectorAll('button, select')].filter((e) => e.offsetParent && "
                                    "e.getBoundingClientRect().height < 24).map((e) => e.id)")
            self.assertEqual(small, [])
        finally:
            self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


class Live(Page):
    """The page of `exactvo serve`: what is dragged is computed, and the numbers are those of the other verbs."""

    SCENARIO = {"name": "two", "guidance": "none", "liveness": "off", "time_limit": 8, "robots": [
        {"id": "R1", "position": [0, 0], "velocity": [1, 0], "goal": [12, 0], "max_speed": 2},
        {"id": "R2", "position": [0, 5], "goal": [12, 5], "max_speed": 2}], "obstacles": [{"id": "wall", "polyline": [[6, -3], [6, 3]]}]}

    def setUp(self):
        (self.place / "s.json").write_text(json.dumps(self.SCENARIO))
        self.serve("s.json", "--method", "orca")

    def serve(self, *arguments):
        self.server = subprocess.Popen([ARGS.program, "serve", *arguments], cwd=self.place, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.server.stdout.readline().strip()

    def serve_instead(self, scenario):
        self.server.send_signal(signal.SIGINT)
        self.server.communicate(timeout=60)
        (self.place / "other.json").write_text(json.dumps(scenario))
        self.serve("other.json", "--method", "orca")

    def tearDown(self):
        self.browser.get("about:blank")  # which asks for nothing more
        super().tearDown()
        self.server.send_signal(signal.SIGINT)
        self.server.communicate(timeout=60)

    def show(self, words="t=0"):
        self.browser.get("about:blank")
        self.browser.get(f"{self.address}#{words}")
        self.await_script("await exactvo.ready")
        self.settle()

    def answered(self):
        """Waits until what was changed is computed and shown."""
        self.await_script("for (let k = 0; k < 600; ++k) { await new Promise((r) => setTimeout(r, 50)); if (!exactvo.live.isAsking && !exactvo.live.isAgain) break; }")
        self.settle()

    def place_of(self, canvas, view, x, y):
        return self.run_script("const b = document.getElementById(arguments[0]).getBoundingClientRect(), v = exactvo.page[arguments[1]];"
                               "return [b.left + v.px(arguments[2]), b.top + v.py(arguments[3])]", canvas, view, x, y)

    def drag(self, canvas, view, begin, end):
        a, b = self.place_of(canvas, view, *begin), self.place_of(canvas, view, *end)

        def mouse(kind, share):
            self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
                "type": kind, "x": a[0] + share * (b[0] - a[0]), "y": a[1] + share * (b[1] - a[1]), "button": "left",
                "buttons": 0 if kind == "mouseReleased" else 1, "clickCount": 1})

        mouse("mousePressed", 0)
        for k in range(1, 9):
            mouse("mouseMoved", k / 8)
        mouse("mouseReleased", 1)
        self.answered()
        self.assertEqual(self.run_script("return document.getElementById('live-message').className"), "", self.text("#live-message"))

    def shown(self):
        """What the page says: the chosen velocity, and of each half-plane its words and its line."""
        cards = self.run_script("return [...document.querySelectorAll('#half-planes li')].map((li) => [li.children[1].textContent, "
                                "li.querySelector('.more').textContent, li.querySelector('.mark').textContent])")
        self.assertEqual([mark for *_, mark in cards if "refuted" in mark], [])
        lines = sorted([words, re.search(r".* m/s;", more).group()] for words, more, _ in cards)
        return re.match(r"\(.*?\)", self.text("[data-fact=chosen]")).group(), lines

    def explained(self):
        """The same by `exactvo explain`, and the scenario as it was changed."""
        scenario = self.run_script("return JSON.stringify(exactvo.live.edit.scenario)")
        (self.place / "changed.json").write_text(scenario)
        text = self.run_program("explain", "changed.json", "--method", "orca", "--time", "0", "--robot", "R1").stdout
        lines = sorted([f"{effect}: {words}", line] for effect, words, line in
                       re.findall(r"\[\d+\] .*, (binding|slack): (.*)\n +(.* m/s;)", text))
        return re.search(r"chosen +(\(.*?\))", text).group(1), lines, json.loads(scenario)

    def vo_line(self, scenario):
        """The half-plane of the wall by `exactvo vo`."""
        robot, wall = scenario["robots"][0], scenario["obstacles"][0]["polyline"]
        (a, b), p, v = wall, robot["position"], robot["velocity"]
        out = self.run_program("vo", f"--obstacle=LINESTRING({a[0]} {a[1]}, {b[0]} {b[1]})", f"--position={p[0]},{p[1]}", f"--velocity={v[0]},{v[1]}",
                               f"--radius={robot['radius']}", f"--time-horizon={scenario['horizons']['orca']}", "--json").stdout
        return json.loads(out)

    def test_a_dragged_wall_gives_the_numbers_of_explain(self):
        self.show()
        before, _ = self.shown()
        self.drag("world", "world", (6, 0), (2.5, 0))
        chosen, lines = self.shown()
        self.assertNotEqual(chosen, before)
        expected, expected_lines, scenario = self.explained()
        self.assertAlmostEqual(scenario["obstacles"][0]["polyline"][0][0], 2.5, delta=0.2)
        self.assertEqual(chosen, expected)
        self.assertEqual(len(expected_lines), 2)
        self.assertEqual(lines, expected_lines)
        self.assertEqual(self.text("#verdict"), "\u2713 proven")
        self.assertIn("changed", self.text("#space-time"))

    def test_a_dragged_corner_gives_the_cone_of_vo(self):
        self.show()
        self.drag("world", "world", (6, 3), (3, 2.5))
        self.drag("world", "world", (6, -3), (3.5, -2))
        *_, scenario = self.explained()
        answer = self.vo_line(scenario)
        seen = self.run_script("const h = exactvo.page.space.decision.halfPlanes.find((h) => h.kind === 'edge'); return [h.nx, h.ny, h.c, h.timeHorizon, h.clearance]")
        half_plane = answer["half_plane"]
        self.assertAlmostEqual(seen[0] * half_plane["normal"][0] + seen[1] * half_plane["normal"][1], 1, places=9)
        skin = 1e-6  # m: a simulation keeps this beside the radius
        self.assertAlmostEqual(seen[2], half_plane["offset"], delta=1.01 * skin / seen[3])

    def test_goal_velocity_radius_horizon_and_method(self):
        self.show()
        self.drag("world", "world", (12, 0), (0, -5))
        preferred = self.run_script("return exactvo.page.space.decision.preferred")
        self.assertLess(preferred[1], -1.9)
        self.drag("space", "plane", preferred, (0.5, 1.0))
        preferred = self.run_script("return exactvo.page.space.decision.preferred")
        self.assertAlmostEqual(preferred[0], 0.5, delta=0.1)
        self.assertAlmostEqual(preferred[1], 1.0, delta=0.1)
        self.assertEqual(self.text("#verdict"), "\u2713 proven")
        self.drag("space", "plane", (1, 0), (-0.5, -1.0))
        self.assertAlmostEqual(self.run_script("return exactvo.page.space.decision.velocity[0]"), -0.5, delta=0.1)
        clearance = "return exactvo.page.space.decision.halfPlanes.find((h) => h.kind === 'edge').clearance"
        before = self.run_script(clearance)
        self.fill("live-radius-number", "1.5")
        self.assertAlmostEqual(before - self.run_script(clearance), 1.0, places=6)
        self.fill("live-horizon-number", "7")
        self.assertEqual(self.run_script("return exactvo.page.space.decision.halfPlanes.find((h) => h.kind === 'edge').timeHorizon"), 7)
        self.run_script("const e = document.getElementById('live-method'); e.value = 'ivo'; e.dispatchEvent(new Event('change'))")
        self.answered()
        self.assertEqual(self.run_script("return exactvo.page.live.run.about.method"), "ivo")

    def fill(self, id, value):
        self.run_script("const e = document.getElementById(arguments[0]); e.value = arguments[1]; e.dispatchEvent(new Event('input'))", id, value)
        self.answered()

    def test_everything_moves_by_numbers_too(self):
        self.show()
        options = self.run_script("return [...document.querySelectorAll('#live-handle option')].map((o) => o.textContent)")
        for label in ["robot R1", "goal of R2", "obstacle wall, corner 2", "velocity of R1", "preferred velocity of R1"]:
            self.run_script("const e = document.getElementById('live-handle'); e.value = String(arguments[0]); e.dispatchEvent(new Event('change'))", options.index(label))
            x = float(self.run_script("return document.getElementById('live-x').value"))
            self.fill("live-x", str(x + 0.25))
            self.assertAlmostEqual(float(self.run_script("return document.getElementById('live-x').value")), x + 0.25, places=3, msg=label)
        self.assertEqual(self.run_script("return exactvo.page.live.run.obstacles[0].rings[0][2]"), 6.25)

    def test_an_impossible_change_is_reported_and_the_last_answer_stays(self):
        self.show()
        self.fill("live-x", "6")  # the robot into the wall
        self.assertEqual(self.text("#live-message"), "Not computed: robot 'R1', position: found [6, 0], overlapping obstacle 'wall' by 0.5 m, "
                         "expected a start that is clear of every obstacle")
        self.fill("live-x", "2")
        self.assertIn("Computed in", self.text("#live-message"))
        self.assertEqual(self.run_script("return exactvo.page.space.decision.position[0]"), 2)
        self.browser.get_log("browser")  # Chromium logs the refusal

    def test_refusals_name_things_and_no_places_in_a_file(self):
        self.show()
        self.fill("live-horizon-number", "0.01")
        message = self.text("#live-message")
        self.assertRegex(message, r"^Not computed: horizons, least: found 0\.01, expected at least twice time step, ")
        self.fill("live-radius-number", "-1")
        self.assertRegex(self.text("#live-message"), r"^Not computed: robot 'R1', radius: found ")
        self.browser.get_log("browser")  # Chromium logs the refusals

    def test_another_robot_is_asked_about_when_it_is_chosen_in_a_change(self):
        robots = [{"id": f"R{k}", "position": [0, 3 * k], "goal": [12, 3 * k]} for k in range(3)]
        self.serve_instead({**self.SCENARIO, "robots": robots, "obstacles": []})
        self.show()
        self.fill("live-x", "0.5")

        def half_planes():
            return self.run_script("return [0, 1, 2].map((i) => exactvo.page.live.run.decision(0, i).halfPlanes.length)")
        self.assertEqual(half_planes(), [2, 1, 1], "of the others their halves of pairs with it, for its proofs")
        self.run_script("exactvo.chooseRobot(1)")
        self.answered()
        self.assertEqual(half_planes(), [1, 2, 1])
        marks = self.run_script("return [...document.querySelectorAll('#half-planes .mark')].map((m) => m.textContent)")
        self.assertEqual(marks, ["\u2713 proven"] * 2)

    def test_another_robot_has_all_its_half_planes_while_a_preferred_velocity_is_changed(self):
        """They were those of the robot whose preferred velocity had been dragged, and of the one shown only what held it."""
        robots = [{"id": f"R{k}", "position": [0, 3 * k], "goal": [12, 3 * k]} for k in range(3)]
        self.serve_instead({**self.SCENARIO, "robots": robots, "obstacles": []})
        self.show()
        self.drag("space", "plane", self.run_script("return exactvo.page.space.decision.preferred"), (0.5, -1.0))
        counts = "return [0, 1, 2].map((i) => exactvo.page.live.run.decision(0, i).halfPlanes.length)"
        self.assertEqual(self.run_script(counts), [2, 1, 1])
        self.run_script("exactvo.chooseRobot(1)")
        self.answered()
        self.assertEqual(self.run_script(counts), [1, 2, 1])
        preferred = self.run_script("return exactvo.page.live.run.decision(0, 0).preferred")
        self.assertAlmostEqual(preferred[0], 0.5, delta=0.1)
        self.assertAlmostEqual(preferred[1], -1.0, delta=0.1)

    def test_a_coordinate_by_number_leaves_the_other_as_it_is(self):
        self.show()
        self.fill("live-y", "-0.123456789")
        self.fill("live-y", "")  # while it is typed anew
        self.fill("live-x", "0.5")
        self.assertEqual(self.run_script("return exactvo.live.edit.scenario.robots[0].position"), [0.5, -0.123456789])

    def test_a_robot_is_dragged_by_its_centre_and_not_a_goal_beside_it(self):
        robots = [{"id": "R1", "position": [0, 0], "goal": [12, 0]}, {"id": "R2", "position": [12, 0], "goal": [0, 0.3]},
                  {"id": "R3", "position": [5, 5], "goal": [5, 5]}]
        self.serve_instead({**self.SCENARIO, "robots": robots, "obstacles": []})
        self.show()
        self.assertLess(self.run_script("return 0.3 * exactvo.page.world.scale"), 10, "the goal is within reach of the pointer")
        self.drag("world", "world", (0, 0), (-2, 2))
        self.drag("world", "world", (5, 5), (7, 4))
        scenario = self.run_script("return exactvo.live.edit.scenario")
        self.assertAlmostEqual(scenario["robots"][0]["position"][0], -2, delta=0.2)
        self.assertEqual(scenario["robots"][1]["goals"], [[0, 0.3]])
        self.assertEqual(scenario["robots"][2]["position"], [5, 5], "the goal that it stands on is taken first")
        self.assertAlmostEqual(scenario["robots"][2]["goals"][0][0], 7, delta=0.2)

    def test_run_from_here_without_a_change(self):
        self.show()
        self.run_script("document.getElementById('live-run').click()")
        self.await_script("for (let k = 0; k < 600 && exactvo.page.key !== 'changed-1'; ++k) await new Promise((r) => setTimeout(r, 50))")
        self.settle()
        self.assertEqual(self.text("#live-message"), "", "it no longer simulates")

    def test_run_from_here_and_back(self):
        self.show("t=2")
        self.drag("world", "world", (6, 0), (6, 6))
        self.run_script("document.getElementById('live-back').click()")
        self.settle()
        self.assertEqual(self.run_script("return [exactvo.page.live, exactvo.ui.t]"), [None, 2])
        self.assertEqual(self.run_script("return exactvo.page.run.obstacles[0].rings[0][1]"), -3)
        at = self.run_script("return exactvo.page.run.decision(exactvo.page.run.decisionRowAt(2), 0).position")
        self.drag("world", "world", (6, 0), (6, 8))
        self.run_script("document.getElementById('live-run').click()")
        self.await_script("for (let k = 0; k < 600 && exactvo.page.key !== 'changed-1'; ++k) await new Promise((r) => setTimeout(r, 50))")
        self.assertEqual(self.run_script("return exactvo.page.key"), "changed-1")
        first, end = self.run_script("const r = exactvo.page.run, s = r.decision(0, 0); return [s.position, [r.x(r.rows - 1, 0), r.y(r.rows - 1, 0)]]")
        self.assertEqual(first, at, "it begins where the other stood, bit for bit")
        self.assertGreater(end[0], 11, "with the wall away it arrives")
        counts = self.await_script("return await exactvo.checkAll()")
        self.assertEqual([counts["choices"][1], counts["halfPlanes"][1]], [0, 0])

    def test_the_page_asks_its_server_alone(self):
        self.browser.get_log("performance")
        self.show()
        self.drag("world", "world", (6, 0), (5, 0))
        self.assertEqual({address.split("#")[0][:len(self.address)] for address in self.requests()}, {self.address})
        blocked = self.await_script("return await fetch('http://127.0.0.1:9/').then(() => 'sent', () => 'blocked')")
        self.assertEqual(blocked, "blocked")
        violations = [entry["message"] for entry in self.browser.get_log("browser")]
        self.assertTrue(any("Content Security Policy" in message for message in violations), violations)

    def test_free_velocities_are_shown_when_a_change_rests(self):
        self.show()
        self.drag("world", "world", (6, 0), (2.5, 0))
        self.await_script("for (let k = 0; k < 300 && !document.getElementById('live-free').textContent; ++k) await new Promise((r) => setTimeout(r, 100))")
        kept, given = [float(x) for x in re.findall(r"(?:away|keep) (\d+\.\d+)", self.text("#live-free"))][::-1]
        total = float(re.search(r"velocities: (\d+\.\d+)", self.text("#live-free")).group(1))
        self.assertAlmostEqual(total, kept + given, delta=0.03)

    def test_fifty_half_planes(self):
        """Reported, not asserted."""
        robots = [{"id": f"R{k}", "position": [1.5 * (k % 8), 1.5 * (k // 8)], "goal": [30 + 1.5 * (k % 8), 1.5 * (k // 8)]} for k in range(51)]
        self.serve_instead({**self.SCENARIO, "robots": robots, "obstacles": [], "time_limit": 0.2})
        self.show()
        times = []
        for k in range(20):
            self.fill("live-x", str(-0.1 * k))
            times.append([float(x) for x in re.findall(r"\d+\.\d", self.text("#live-message"))])
        self.assertEqual(self.run_script("return exactvo.page.space.decision.halfPlanes.length"), 50)
        times.sort(key=lambda t: t[1])
        print(f"51 robots, 50 half-planes each: median {times[10][0]} ms, of the processor {times[10][1]} ms")


class Proofs(Page):
    """The page's own checker: the verdicts of C++, and what it says of a recording that was altered."""

    def test_verdicts_are_those_of_the_library(self):
        count, seed = 20000, int(os.environ.get("EXACTVO_TEST_SEED", "18"))
        print(f"seed {seed}")
        lines = subprocess.run([ARGS.cases, str(count), str(seed)], capture_output=True, text=True, check=True).stdout.splitlines()
        self.assertEqual(len(lines), count)
        self.run_program("view", "--out", "start.html")
        self.open("start.html")
        tally, wrong = {}, []
        for begin in range(0, count, 2000):
            cases = "[" + ",".join(lines[begin:begin + 2000]) + "]"
            verdicts = self.run_script("return JSON.parse(arguments[0]).map((c) => c.claim ? exactvo.checkHalfPlane(c.claim).ok "
                                       ": exactvo.checkDecision(c.problem, c.answer).ok)", cases)
            for line, verdict in zip(lines[begin:begin + 2000], verdicts):
                case = json.loads(line)
                kind = "half-plane" if "claim" in case else case["answer"]["status"]
                tally[kind, case["holds"]] = tally.get((kind, case["holds"]), 0) + 1
                if verdict is not case["holds"]:
                    wrong.append(line)
        self.assertEqual(wrong[:3], [], f"{len(wrong)} verdicts differ")
        print(tally)
        for kind in ["half-plane", "optimal", "relaxed", "infeasible"]:
            for holds in [True, False]:
                self.assertGreater(tally.get((kind, holds), 0), 50, f"{kind} {holds}")

    def record(self):
        if not (self.place / "A7").exists():
            self.run_program("simulate", ARGS.data / "paper" / "A7.json", "--decisions", "all", "--no-figures", "--out", "A7")
        return (self.place / "A7" / "recording.jsonl").read_text().splitlines()

    def altered(self, change):
        """The counts of the page for the recording with one robot of one row changed."""
        lines = self.record()
        for k, line in enumerate(lines):
            value = json.loads(line)
            if "row" in value and any(len([c for c in r.get("constraints", []) if c.get("multiplier")]) > 0 for r in value["row"]["robots"]):
                robot = next(r for r in value["row"]["robots"] if any(c.get("multiplier") for c in r.get("constraints", [])))
                change(robot, next(c for c in robot["constraints"] if c.get("multiplier")))
                lines[k] = json.dumps(value)
                break
        (self.place / "altered.jsonl").write_text("\n".join(lines) + "\n")
        self.run_program("view", "altered.jsonl", "--out", "altered.html")
        self.open("altered.html")
        return self.await_script("return await exactvo.checkAll()")

    def test_every_proof_of_a_run_holds(self):
        self.record()
        self.run_program("view", "A7", "--out", "a7.html")
        self.open("a7.html")
        self.assertIn("exactvo-verify, whose checkers are proven in Coq, covers of a recording: half-planes", self.text("#covered"))
        counts = self.await_script("return await exactvo.checkAll()")
        audit = json.loads(self.run_program("audit", "A7", "--json").stdout)
        text = json.dumps(audit)
        self.assertEqual(counts["choices"][1:], [0, 0])
        self.assertEqual(counts["halfPlanes"][1:], [0, 0])
        self.assertIn(f'"asked": {counts["choices"][0]}', text)
        self.assertIn(f'"asked": {counts["halfPlanes"][0]}', text)

    def test_a_multiplier_that_was_altered_is_refuted(self):
        def change(robot, c):
            c["multiplier"] *= 1.01

        counts = self.altered(change)
        self.assertEqual(counts["choices"][1], 1)
        self.settle()
        self.assertEqual(self.text("#verdict"), "\u2717 refuted")
        self.assertIn("do not prove", self.text("#why"))

    def test_a_velocity_beyond_its_half_plane_is_refuted(self):
        def change(robot, c):
            robot["chosen"] = [robot["chosen"][k] - 1e-6 * c["normal"][k] for k in range(2)]

        counts = self.altered(change)
        self.assertEqual(counts["choices"][1], 1)
        self.settle()
        self.assertIn("breaks half-plane", self.text("#why"))

    def test_a_half_plane_that_allows_too_much_is_refuted(self):
        def change(robot, c):
            c["offset"] -= 0.5  # beyond the margin, which would cover less

        counts = self.altered(change)
        self.assertGreaterEqual(counts["halfPlanes"][1], 1)
        self.settle()
        self.assertGreaterEqual(self.run_script("return document.querySelectorAll('#half-planes .bad').length"), 1)


def main():
    global ARGS
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--cases", required=True)
    parser.add_argument("--data", required=True, type=pathlib.Path)
    parser.add_argument("part", choices=["runs", "page", "proofs", "live"])
    parser.add_argument("names", nargs="*")
    ARGS = parser.parse_args()
    missing = [name for name, there in [("chromium", CHROMIUM), ("chromedriver (chromium-driver)", DRIVER), ("python3-selenium", webdriver)] if not there]
    if missing:
        print(f"skipped: {', '.join(missing)} not found")
        sys.exit(77)
    if ARGS.part == "live" and "E_NOT_BUILT" in subprocess.run([ARGS.program, "serve", "no-such-file"], capture_output=True, text=True).stderr:
        print("skipped: built without cpp-httplib")
        sys.exit(77)
    case = {"runs": Runs, "page": PageItself, "proofs": Proofs, "live": Live}[ARGS.part]
    suite = unittest.TestLoader().loadTestsFromTestCase(case)
    if ARGS.names:
        suite = unittest.TestSuite(case(name) for name in ARGS.names)
    sys.exit(0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() else 1)


if __name__ == "__main__":
    main()
