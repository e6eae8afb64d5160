#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the links of a folder of HTML pages: every file and every anchor is there, no link is absolute, nothing that a page shows
comes from a network. Addresses of the web are not asked for.

    check_links.py FOLDER

Prints each broken link; exit status 1 if there is one.
"""
import html.parser
import pathlib
import re
import sys
import urllib.parse

SHOWN = {("img", "src"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src")}


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.anchors, self.links = set(), []

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value)
            if name in ("href", "src") and value:
                self.links.append((tag, name, value))


def read(page):
    links = Links()
    text = page.read_text(encoding="utf-8", errors="replace")
    links.feed(re.sub(r"<script\b.*?</script>", lambda m: m[0][: m[0].index(">") + 1], text, flags=re.S))
    return links


def broken(folder):
    pages = {page.resolve(): read(page) for page in folder.rglob("*.html")}
    for page, links in sorted(pages.items()):
        for tag, name, address in links.links:
            where = f"{page.relative_to(folder.resolve())}: {address}"
            parts = urllib.parse.urlsplit(address)
            if parts.scheme in ("http", "https", "mailto"):
                if (tag, name) in SHOWN:
                    yield f"{where}: shown from a network"
                continue
            if parts.scheme in ("data", "javascript", "blob"):
                continue
            if parts.scheme or address.startswith("/"):
                yield f"{where}: not relative"
                continue
            target = (page.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else page
            if not target.is_file():
                yield f"{where}: no such file"
            elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                yield f"{where}: no such anchor"


def main():
    folder = pathlib.Path(sys.argv[1])
    found = list(broken(folder))
    for line in found:
        print(line, file=sys.stderr)
    count = sum(1 for _ in folder.rglob("*.html"))
    if found or count == 0:
        sys.exit(f"check_links: {len(found)} broken links in {count} pages")
    print(f"check_links: {count} pages, no broken link")


if __name__ == "__main__":
    main()
