# SPDX-License-Identifier: GPL-3.0-or-later
"""What a docstring says is raised is raised, and nothing else is: docstrings against the table of `raising_calls.py`, and
against what wrong arguments raise."""
import builtins
import functools
import importlib
import inspect
import pkgutil
import re
import sys
from pathlib import Path

import pytest

import exactvo
from exactvo import _exactvo, errors

sys.path.insert(0, str(Path(__file__).parent))
from good_calls import JUNK, good_calls  # noqa: E402
from raising_calls import raising_calls  # noqa: E402

NEEDS_MATPLOTLIB = {"simulation.Recording.plot", "simulation.Recording.animate"}
#: Shapes that check nothing by themselves: whoever takes them does. And what takes recordings, which have no name.
NOT_ASKED = {"shapes.Disc", "shapes.Segment", "shapes.Ellipse", "explorer.view"}


def described():
    """(name, docstring) of every public function, class and member."""
    for module_name in sorted(m.name for m in pkgutil.iter_modules([str(Path(exactvo.__file__).parent)])):
        if module_name.startswith("_") or module_name == "errors":
            continue
        module = importlib.import_module(f"exactvo.{module_name}")
        for name in module.__all__:
            value = getattr(module, name)
            if inspect.isfunction(value) or inspect.isclass(value):
                yield f"{module_name}.{name}", value.__doc__ or ""
            if inspect.isclass(value):
                for member, of in vars(value).items():
                    of = of.__func__ if isinstance(of, staticmethod) else of
                    if not member.startswith("_") and (inspect.isfunction(of) or isinstance(of, (property, functools.cached_property))):
                        yield f"{module_name}.{name}.{member}", of.__doc__ or ""


def documented():
    """{name: the exceptions that its docstring names in sentences with "raises"}."""
    found = {}
    for name, text in described():
        sentences = re.findall(r"\b[Rr]aises\b.*?(?:\.(?:\s|$)|$)", text, flags=re.DOTALL)
        found[name] = {word for s in sentences for word in re.findall(r"`(?:exactvo\.)?(\w+Error)`", s)}
    return found


def class_of(name):
    return getattr(errors, name, None) or getattr(builtins, name)


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    return raising_calls(tmp_path_factory.mktemp("cases"))


def test_every_documented_exception_has_a_case_and_every_case_is_documented(cases):
    pairs = {(name, exception) for name, names in documented().items() for exception in names}
    in_table = {(name, exception) for name, exception, _ in cases}
    assert sorted(pairs - in_table) == []  # documented, without a case
    assert sorted(in_table - pairs) == []  # with a case, not documented
    assert len(pairs) > 150


def test_every_case_raises_what_is_documented(cases):
    missing_matplotlib = importlib.util.find_spec("matplotlib") is None
    for name, exception, call in cases:
        if missing_matplotlib and name in NEEDS_MATPLOTLIB:
            continue
        with pytest.raises(class_of(exception)) as caught:
            call()
        assert caught.type is class_of(exception), (name, caught.value)


def test_wrong_arguments_raise_nothing_that_is_not_documented(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some junk is a path to write to
    known, unnamed = documented(), set()
    for name, function, given in good_calls(tmp_path):
        for argument in given if name not in NOT_ASKED else ():
            for junk in JUNK:
                if callable(junk) and argument in ("steering", "half_planes"):
                    continue  # what a user's function raises is passed on
                try:
                    function(**dict(given, **{argument: junk}))
                except Exception as error:
                    if type(error).__name__ not in known[name]:
                        unnamed.add((name, type(error).__name__, argument, repr(junk)[:30]))
    assert sorted(unnamed) == []


def test_a_requirement_of_the_library_becomes_an_argument_error():
    """No input is known for which one is not asked for before; the translation is seen by a hook."""
    with pytest.raises(exactvo.ArgumentError) as caught:
        _exactvo.throw_requirement()
    assert caught.value.where == "radius" and "must not be negative" in str(caught.value)


def test_a_route_that_is_not_proven_has_an_error_of_its_own():
    with pytest.raises(exactvo.RouteNotProvenError) as caught:
        _exactvo.throw_route_not_proven()
    assert caught.value.code == "E_ROUTE_NOT_PROVEN"
