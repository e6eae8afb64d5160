#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The site as plain files: guide, reference, gallery, tutorials, a live page of the explorer. Links are relative, so that it can be
read from a disk.

    make_site.py OUT --program BUILD/bin/exactvo [--python BUILD/python] [--no-gallery]

--python is the folder that `exactvo` is imported from; without it there is no reference of the Python package. The gallery's
commands are run; --no-gallery leaves them out. Needs pandoc and doxygen (Debian). Exit status 77 where one is missing.
"""
import argparse
import html
import importlib
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SITE = ROOT / "docs/site"
TITLE = re.compile(r"^# (.+)$", re.M)
SINGLES = ("HACKING.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/building.md", "docs/claims.md", "docs/stability.md")


def page_of(source):
    """Where a file of the repository stands in the site as a page; nothing for one that is no page."""
    name = source.as_posix()
    if name == "README.md":
        return pathlib.Path("index.html")
    for folder in ("docs/guide", "docs/adr", "docs/design", "docs/measurements"):
        if name == folder:
            return pathlib.Path(source.name, "index.html")
        if name.startswith(folder + "/") and name.endswith(".md"):
            stem = "index" if source.stem == "README" else source.stem
            return pathlib.Path(folder.removeprefix("docs/"), stem + ".html")
    if name in SINGLES:
        return pathlib.Path(source.stem.lower() + ".html")
    if name == "examples/python":
        return pathlib.Path("tutorials/index.html")
    if name.startswith("examples/python/") and name.endswith(".py"):
        return pathlib.Path("tutorials", source.stem + ".html")
    return None


class Site:
    def __init__(self, out):
        self.out = out
        self.template = (SITE / "page.html").read_text(encoding="utf-8")

    def write(self, place, title, body):
        root = "../" * (len(place.parts) - 1)
        text = self.template
        for name, value in (("title", html.escape(title)), ("root", root), ("body", body)):
            text = text.replace(f"${name}$", value)
        (self.out / place).parent.mkdir(parents=True, exist_ok=True)
        (self.out / place).write_text(text, encoding="utf-8")

    def target(self, source):
        """What of the site a link to a file or folder of the repository leads to; what is no page is copied."""
        page = page_of(source)
        if page:
            return page
        if source.as_posix().startswith("docs/images/"):
            copy = pathlib.Path("images", source.name)
        else:
            copy = pathlib.Path("files", source)
        if (ROOT / source).is_dir():
            return self.listing(source, copy)
        if not (self.out / copy).exists():
            (self.out / copy).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / source, self.out / copy)
        return copy

    def listing(self, source, copy):
        """A page that lists a folder."""
        place = copy / "index.html"
        if (self.out / place).exists():
            return place
        self.write(place, source.as_posix(), "")
        rows = []
        for child in sorted((ROOT / source).iterdir()):
            if child.name.startswith((".", "__")):
                continue
            link = os.path.relpath(self.target(child.relative_to(ROOT)), copy)
            rows.append(f'<li><a href="{html.escape(link)}">{html.escape(child.name)}</a></li>')
        self.write(place, source.as_posix(), f"<h1>{html.escape(source.as_posix())}</h1>\n<ul>\n" + "\n".join(rows) + "\n</ul>")
        return place

    def relinked(self, body, source, place):
        """HTML that was made of `source`, its links to files of the repository turned to the site's."""

        def turned(match):
            attribute, address = match[1], html.unescape(match[2])
            path, _, anchor = address.partition("#")
            if not path or re.match(r"[a-z]+:", path):
                return match[0]
            wanted = pathlib.Path(os.path.normpath((ROOT / source).parent / path))
            if not wanted.exists():
                sys.exit(f"make_site: {source}: no file {path}")
            link = os.path.relpath(self.target(wanted.relative_to(ROOT)), place.parent)
            return f'{attribute}="{html.escape(link + ("#" + anchor if anchor else ""))}"'

        return re.sub(r'\b(href|src)="([^"]*)"', turned, body)

    def page(self, source):
        text = (ROOT / source).read_text(encoding="utf-8")
        place = page_of(source)
        title = TITLE.search(text)
        self.write(place, title[1] if title else source.stem, self.relinked(to_html(text), source, place))


def to_html(markdown):
    done = subprocess.run(["pandoc", "--from", "gfm", "--to", "html5", "--no-highlight", "--wrap=preserve"], input=markdown,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"make_site: pandoc: {done.stderr}")
    return done.stdout


def index_of(site, folder, title, sources, words=""):
    rows = []
    for source in sources:
        heading = TITLE.search((ROOT / source).read_text(encoding="utf-8"))
        rows.append(f'<li><a href="{page_of(source).name}">{html.escape(heading[1] if heading else source.stem)}</a></li>')
    site.write(pathlib.Path(folder, "index.html"), title, f"<h1>{title}</h1>\n{words}<ul>\n" + "\n".join(rows) + "\n</ul>")


def make_guide(site):
    pages = [p.relative_to(ROOT) for folder in ("guide", "adr", "design", "measurements") for p in sorted((ROOT / "docs" / folder).glob("*.md"))]
    for source in [*map(pathlib.Path, ("README.md", *SINGLES)), *pages]:
        site.page(source)
    more = ('<p>Also: <a href="../adr/index.html">decisions and their reasons</a>, <a href="../claims.html">claims to check</a>, '
            '<a href="../stability.html">what stays the same from version to version</a>, '
            '<a href="../hacking.html">how the repository is laid out</a>, <a href="../contributing.html">how to contribute</a>, '
            '<a href="../changelog.html">what changed</a>.</p>\n')
    index_of(site, "guide", "Guide", [p for p in pages if p.parent.name == "guide"], more)


def make_tutorials(site, environment):
    """The scripts with what they print."""
    rows = []
    for script in sorted((ROOT / "examples/python").glob("*.py")):
        text = script.read_text(encoding="utf-8")
        words = re.search(r'"""(.*?)"""', text, re.S)
        title = script.stem.replace("_", " ").capitalize()
        body = f"<h1>{title}</h1>\n<pre class=\"words\">{html.escape(words[1].strip() if words else '')}</pre>\n"
        body += f"<pre><code>{html.escape(text)}</code></pre>\n"
        if environment:
            with tempfile.TemporaryDirectory(prefix="exactvo_tutorial_") as folder:
                done = subprocess.run([sys.executable, script], cwd=folder, env=environment, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(f"make_site: {script.name}: {done.stderr}")
            body += f"<h2>What it prints</h2>\n<pre>{html.escape(done.stdout)}</pre>\n"
        place = pathlib.Path("tutorials", script.stem + ".html")
        site.write(place, title, body)
        rows.append(f'<li><a href="{place.name}">{title}</a></li>')
    site.write(pathlib.Path("tutorials/index.html"), "Tutorials",
               "<h1>Tutorials</h1>\n<p>Python scripts; the tests run them.</p>\n<ul>\n" + "\n".join(rows) + "\n</ul>")


def words_of(text):
    """A documentation string in a folder of the site: names as code, pages of the guide as links, nothing that only doctest reads."""
    words = re.sub(r"``?([^`\n]+)``?", r"<code>\1</code>", html.escape(re.sub(r" *# doctest: .*", "", text)))
    return re.sub(r"\bdocs/guide/([a-z-]+)\.md", r'<a href="../guide/\1.html">\g<0></a>', words)


def documentation_of(value):
    return f'<pre class="words">{words_of(inspect.getdoc(value) or "")}</pre>\n'


def signature_of(value):
    try:
        return str(inspect.signature(value)).replace("'", "")
    except (TypeError, ValueError):
        return ""


def make_python_reference(site, folder):
    """A page a module of the Python package, from its documentation strings."""
    sys.path.insert(0, str(folder))
    package = importlib.import_module("exactvo")
    rows = []
    for name in ("vo", "lp", "routes", "simulation", "crowd", "datasets", "shapes", "rvo2", "errors"):
        module = importlib.import_module(f"exactvo.{name}")
        body = f"<h1>exactvo.{name}</h1>\n{documentation_of(module)}"
        for public in getattr(module, "__all__", []):
            value = getattr(module, public)
            if not callable(value):
                continue
            body += f'<h2 id="{public}">{public}</h2>\n<pre><code>{html.escape(public + signature_of(value))}</code></pre>\n'
            body += documentation_of(value)
            for member, descriptor in vars(value).items() if inspect.isclass(value) else ():
                if member.startswith("_") or not (inspect.isfunction(descriptor) or isinstance(descriptor, (property, staticmethod))):
                    continue
                call = "" if isinstance(descriptor, property) else signature_of(getattr(value, member))
                body += f'<h3 id="{public}.{member}"><code>{html.escape(public + "." + member + call)}</code></h3>\n'
                body += documentation_of(getattr(value, member))
        site.write(pathlib.Path("python", name + ".html"), f"exactvo.{name}", body)
        rows.append(f'<li><a href="{name}.html">exactvo.{name}</a>: {words_of((module.__doc__ or "").strip().splitlines()[0])}</li>')
    site.write(pathlib.Path("python/index.html"), "The Python package",
               f"<h1>The Python package</h1>\n{documentation_of(package)}<ul>\n" + "\n".join(rows) + "\n</ul>")


def make_gallery(site, program):
    """Runs the commands of docs/site/gallery.md in an empty folder; its pictures are what they leave there."""
    text = (SITE / "gallery.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory(prefix="exactvo_gallery_") as folder:
        folder = pathlib.Path(folder)
        (folder / "datasets").symlink_to(ROOT / "datasets")
        (folder / "docs").symlink_to(ROOT / "docs")
        environment = dict(os.environ, PATH=f"{program.parent}:{os.environ['PATH']}")
        for commands in re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S):
            done = subprocess.run(["bash", "-euc", commands], cwd=folder, env=environment, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(f"make_site: gallery: {commands}{done.stderr}")
        body = to_html(text)
        for picture in re.findall(r'src="([^"]+)"', body):
            if not (folder / picture).is_file():
                sys.exit(f"make_site: gallery: its commands made no {picture}")
            copy = pathlib.Path("gallery", picture.replace("/", "-"))
            (site.out / copy).parent.mkdir(exist_ok=True)
            shutil.copyfile(folder / picture, site.out / copy)
            body = body.replace(f'src="{picture}"', f'src="{copy}"')
    site.write(pathlib.Path("gallery.html"), "Gallery", body)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--python", type=pathlib.Path)
    parser.add_argument("--no-gallery", action="store_true")
    flags = parser.parse_args()
    for tool in ("pandoc", "doxygen"):
        if shutil.which(tool) is None:
            print(f"skipped: {tool} is missing (Debian: {tool})")
            sys.exit(77)
    out, program = flags.out.resolve(), flags.program.resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    site = Site(out)
    shutil.copyfile(SITE / "style.css", out / "style.css")
    make_guide(site)
    environment = dict(os.environ, PYTHONPATH=str(flags.python.resolve()), MPLBACKEND="Agg") if flags.python else None
    make_tutorials(site, environment)
    if flags.python:
        make_python_reference(site, flags.python.resolve())
    else:
        site.write(pathlib.Path("python/index.html"), "The Python package", "<p>This build has no Python package.</p>")
    if flags.no_gallery:
        site.write(pathlib.Path("gallery.html"), "Gallery", "<p>Its commands were not run.</p>")
    else:
        make_gallery(site, program)
    subprocess.run([program, "--quiet", "view", "--out", out / "explorer.html"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([sys.executable, ROOT / "scripts/make_reference.py", out / "reference"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([sys.executable, ROOT / "scripts/check_links.py", out], check=True)
    print(f"make_site: {out}/index.html")


if __name__ == "__main__":
    main()
