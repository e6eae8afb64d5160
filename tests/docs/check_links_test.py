#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_links.py finds every kind of broken link, and nothing else."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_links  # noqa: E402


class CheckLinks(unittest.TestCase):
    def found(self, **pages):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in pages.items():
                (pathlib.Path(folder) / f"{name}.html").write_text(text)
            return [line.partition(": ")[2] for line in check_links.broken(pathlib.Path(folder))]

    def test_good_links_pass(self):
        self.assertEqual(self.found(a='<a href="b.html#there">x</a><a href="https://example.org/none">y</a><a href="#here" id="here">z</a>',
                                    b='<h2 id="there">t</h2><script src="data:,">document.write(\'<a href="nowhere">\')</script>'), [])

    def test_each_kind_of_broken_link_is_found(self):
        for text, words in [('<a href="b.html">x</a>', "b.html: no such file"),
                            ('<img src="picture.png">', "picture.png: no such file"),
                            ('<a href="a.html#there">x</a>', "a.html#there: no such anchor"),
                            ('<a href="#there">x</a>', "#there: no such anchor"),
                            ('<a href="/a.html">x</a>', "/a.html: not relative"),
                            ('<a href="file:///a.html">x</a>', "file:///a.html: not relative"),
                            ('<script src="https://example.org/a.js"></script>', "https://example.org/a.js: shown from a network")]:
            self.assertEqual(self.found(a=text), [words])


if __name__ == "__main__":
    unittest.main()
