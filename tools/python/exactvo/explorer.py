# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings as a page to explore: the world, any robot's velocity space, charts, and the proofs checked in the page.

>>> import exactvo
>>> run = exactvo.simulate({"name": "one", "time_limit": 1, "robots": [{"id": "R1", "position": [0, 0], "goal": [1, 0]}]})
>>> page = run.view()                    # the last line of a notebook's cell shows it there
>>> page.html.startswith("<!DOCTYPE html>")
True

The same page as `exactvo view` writes: one piece of HTML that needs neither a network nor a server (docs/guide/explorer.md).
"""

from __future__ import annotations

import html
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from . import _exactvo
from ._calls import explain_calls, is_whole
from .errors import ArgumentError

if TYPE_CHECKING:
    from .simulation import Recording

__all__ = ["ExplorerPage", "view"]


class ExplorerPage:
    """A page of recordings, as `view` makes it. Shows itself in a notebook; `write` and `open` are for elsewhere."""

    __slots__ = ("_height", "_title", "html")

    def __init__(self, html: str, *, title: str = "exactvo", height: int = 720) -> None:
        #: The whole page.
        self.html = html
        self._title = title
        self._height = height

    def write(self, path: str | os.PathLike[str]) -> Path:
        """Into a file, whole or not at all; its path. Raises `DataError` where it cannot be written, `ArgumentError`."""
        _exactvo.write_text(os.fspath(path), self.html)
        return Path(path)

    def open(self) -> Path:
        """In the browser, from a temporary file that stays until the system clears it; its path."""
        handle, name = tempfile.mkstemp(prefix="exactvo-", suffix=".html")
        os.close(handle)
        file = self.write(name)
        webbrowser.open(file.as_uri())
        return file

    def _repr_html_(self) -> str:
        """In a frame of its own, so that the page's style and scripts do not meet the notebook's. Without `allow-same-origin`
        the page cannot reach the notebook either."""
        return (
            f'<iframe sandbox="allow-scripts allow-downloads" title="{html.escape(self._title)}" '
            f'style="width: 100%; height: {self._height}px; border: 1px solid #ccc" srcdoc="{html.escape(self.html)}"></iframe>'
        )

    def __repr__(self) -> str:
        return f"ExplorerPage({self._title!r}, {1e-6 * len(self.html):.1f} MB)"


def view(*recordings: Recording, height: int = 720) -> ExplorerPage:
    """Recordings on one page, to switch between; `height` of its frame in a notebook, in pixels. Long runs are thinned as
    `exactvo view` does. Releases the interpreter's lock. Raises `ArgumentError`."""
    from .simulation import Recording

    for recording in recordings:
        if not isinstance(recording, Recording):
            raise ArgumentError("recordings", repr(recording)[:60], "Recording objects: simulate() and read_recording() give them")
    if not is_whole(height) or not 100 <= height <= 10000:
        raise ArgumentError("height", repr(height)[:60], "100 to 10000 pixels")
    if not recordings:
        raise ArgumentError("recordings", "none", "at least one")
    names = ", ".join(f"{recording.scenario.name} ({recording.method})" for recording in recordings)
    return ExplorerPage(_exactvo.explorer_page([recording._native for recording in recordings]), title=names, height=height)


explain_calls(__name__)
