# SPDX-License-Identifier: GPL-3.0-or-later
"""`view()`: the page of `exactvo view`, in a file and in a notebook."""
import html
import pickle
import re
import sys
from pathlib import Path

import pytest

import exactvo

sys.path.insert(0, str(Path(__file__).parent))
from good_calls import ONE  # noqa: E402


def test_the_page_is_the_program_s(program, source, tmp_path):
    run = exactvo.simulate(source / "datasets/data/paper/A2.json")
    run.write(tmp_path / "recording.jsonl")
    program("view", tmp_path / "recording.jsonl", "--out", tmp_path / "theirs.html")
    page = exactvo.read_recording(tmp_path).view()
    assert page.html == (tmp_path / "theirs.html").read_text()
    assert page.write(tmp_path / "ours.html") == tmp_path / "ours.html"
    assert (tmp_path / "ours.html").read_bytes() == (tmp_path / "theirs.html").read_bytes()


def test_a_notebook_shows_the_page_in_a_frame_of_its_own():
    page = exactvo.simulate(dict(ONE, name='<b>&"quoted"')).view(height=500)
    shown = page._repr_html_()
    frame = re.fullmatch(r'<iframe sandbox="allow-scripts allow-downloads" title="([^"]*)" style="([^"]*)" srcdoc="([^"]*)"></iframe>', shown)
    assert frame and html.unescape(frame[3]) == page.html and "height: 500px" in frame[2]
    assert html.unescape(frame[1]) == '<b>&"quoted" (ivo)'
    assert not re.search(r'(src|href)="?(https?:)?//', page.html) and repr(page).startswith("ExplorerPage(")


def test_runs_of_one_name_are_told_apart(program, tmp_path):
    run = exactvo.simulate(ONE)
    for name in ("a", "b"):
        run.write(tmp_path / f"{name}.jsonl")
    program("view", tmp_path / "a.jsonl", tmp_path / "b.jsonl", "--out", tmp_path / "two.html")
    again = exactvo.read_recording(tmp_path / "a.jsonl")
    assert exactvo.view(again, again).html == (tmp_path / "two.html").read_text()


def test_open_gives_the_page_to_the_browser(monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    page = exactvo.simulate(ONE).view()
    file = page.open()
    assert opened == [file.as_uri()] and file.read_text() == page.html
    file.unlink()


def test_pages_that_cannot_be_are_refused(tmp_path):
    run = exactvo.simulate(ONE)
    with pytest.raises(exactvo.ArgumentError, match="recordings: found 'x', expected Recording objects"):
        exactvo.view(run, "x")
    with pytest.raises(exactvo.ArgumentError, match="height: found 5, expected 100 to 10000 pixels"):
        run.view(height=5)
    (tmp_path / "file").write_text("")
    with pytest.raises(exactvo.DataError) as caught:
        run.view().write(tmp_path / "file" / "page.html")
    assert caught.value.code == "E_FILE_UNWRITABLE"


def test_recordings_are_pickled_whole():
    run = exactvo.simulate(ONE, record_all=True)
    again = pickle.loads(pickle.dumps(run))
    assert again.position.tobytes() == run.position.tobytes() and again.metrics == run.metrics
    assert again.half_planes(0, 0) == run.half_planes(0, 0) and again.scenario.to_json() == run.scenario.to_json()
