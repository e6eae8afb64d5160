# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_all.sh on small tables of checks: results, resuming, failures, refusals; and every check of scripts/checks.txt names programs that exist."""
import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class CheckAll(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name) / "out"
        self.table = pathlib.Path(self.folder.name) / "checks.txt"

    def run_script(self, table, *options):
        self.table.write_text(table)
        return subprocess.run(
            [ROOT / "scripts/check_all.sh", "--table", self.table, "--out", self.out, *options],
            capture_output=True, text=True, timeout=60,
        )

    def test_passed_checks_are_not_repeated(self):
        count = self.out.parent / "count"
        table = f"once | 1 | echo run >> {count}; echo all 7 right\n"
        for _ in range(2):
            answer = self.run_script(table)
            self.assertEqual(answer.returncode, 0, answer.stderr)
            self.assertIn("| once | passed | 0 (1) | all 7 right |", answer.stdout)
        self.assertEqual(count.read_text(), "run\n")
        self.assertEqual(self.run_script(table, "--again").returncode, 0)
        self.assertEqual(count.read_text(), "run\nrun\n")

    def test_a_failure_is_shown_repeated_and_does_not_stop_the_rest(self):
        table = "bad | 2 | echo 3 wrong; exit 5\ngood | 3 | true\n"
        for _ in range(2):
            answer = self.run_script(table)
            self.assertEqual(answer.returncode, 1)
            self.assertIn("| bad | FAILED (5) | 0 (2) | 3 wrong |", answer.stdout)
            self.assertIn("| good | passed |", answer.stdout)
        self.assertIn("about 2 minutes left", answer.stdout)
        self.assertEqual((self.out / "table.md").read_text().count("\n"), 4)

    def test_a_failure_inside_a_command_counts(self):
        self.assertEqual(self.run_script("pipe | 1 | false | tail -n 1\n").returncode, 1)
        self.assertEqual(self.run_script("first | 1 | false; true\n").returncode, 1)

    def test_only_and_list(self):
        table = "one | 1 | touch " + str(self.out.parent / "one") + "\ntwo | 20 | exit 1\n"
        answer = self.run_script(table, "--list")
        self.assertIn("| one | not run |", answer.stdout)
        self.assertIn("left: about 21 minutes", answer.stdout)
        self.assertFalse((self.out.parent / "one").exists())
        self.assertEqual(self.run_script(table, "--only", "^one$").returncode, 0)
        self.assertTrue((self.out.parent / "one").exists())

    def test_wrong_options_are_refused(self):
        for options, words in [
            (["--liszt"], "found '--liszt', expected --list"),
            (["--only"], "--only needs a value"),
            (["--only", "nothing"], "no check of"),
            (["--only", "("], "'(' is not a regular expression"),
        ]:
            answer = self.run_script("one | 1 | true\n", *options)
            self.assertEqual(answer.returncode, 2, answer.stderr)
            self.assertIn(words, answer.stderr)
        answer = self.run_script("one | soon | true\n")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("expected NAME | MINUTES | COMMAND", answer.stderr)

    def test_the_table_names_what_exists(self):
        text = (ROOT / "scripts/checks.txt").read_text()
        cmake = "".join(p.read_text() for p in ROOT.glob("**/CMakeLists.txt") if "build" not in p.parts)
        targets = re.findall(r"build/(?:dev|release)/bin/([a-z_]+)", text)
        self.assertGreater(len(targets), 15)
        for target in targets:
            self.assertTrue(re.search(rf"add_executable\({target}\s", cmake), target)
        for target in re.findall(r"\b((?:lp|datasets|formation)_[a-z_]+_test)\b", text):
            self.assertTrue(re.search(rf"exactvo_add_test\({target}\s", cmake), target)
        for path in re.findall(r"\b((?:scripts|tests)/[\w/]+\.(?:sh|py))", text):
            self.assertTrue((ROOT / path).exists(), path)
        names = re.findall(r"^([a-z.-]+) *\|", text, re.MULTILINE)
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    unittest.main()
