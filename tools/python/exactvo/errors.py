# SPDX-License-Identifier: GPL-3.0-or-later
"""What is raised, and what it carries.

Every error of the package is an `ExactVOError` with

- ``code``: a word to compare with; for data one of docs/guide/codes.md ("E_SELF_INTERSECTION"),
- ``file``: the file it is about, or "",
- ``where``: the place: an argument's name, a JSON pointer, "feature 2, ring 0, vertex 17", a line and column,
- ``found`` and ``expected``: in words.

An answer is never raised: "infeasible", "unreachable", "overlaps" are values.
"""

from __future__ import annotations

import difflib
import re
import sys
from pathlib import Path
from typing import Any

__all__ = [
    "ArgumentError",
    "CrowdError",
    "DataError",
    "ExactVOError",
    "MissingFileError",
    "RouteNotProvenError",
    "ScenarioWarning",
]


class ScenarioWarning(UserWarning):
    """A warning about a scenario before it is run (`simulate`, `sweep`). `warnings.simplefilter("ignore",
    exactvo.ScenarioWarning)` silences it, "error" raises it instead of running the scenario."""


class ExactVOError(Exception):
    """Base of all errors of this package."""

    code: str
    file: str
    where: str
    found: str
    expected: str

    def __init__(self, message: str, *, code: str, file: str = "", where: str = "", found: str = "", expected: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.file = file
        self.where = where
        self.found = found
        self.expected = expected

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self.args, self.__dict__)


def _restore(kind: type[ExactVOError], args: tuple[Any, ...], state: dict[str, Any]) -> ExactVOError:
    error = kind.__new__(kind, *args)
    error.args = args
    error.__dict__.update(state)
    return error


def _extension_missing() -> ImportError:
    """What to say where the extension is not there, or is another Python's."""
    folder = Path(__file__).parent
    built = ", ".join(sorted(p.name.split(".")[1] for p in folder.glob("_exactvo.*.so"))) or "none"
    return ImportError(
        f"exactvo: {folder} has no extension for this Python, {sys.executable} ({sys.implementation.cache_tag}); built there: {built}. "
        "Run the Python that it was built for, or build it for this one with -DPython3_EXECUTABLE (docs/guide/python.md)",
        name="exactvo._exactvo",
    )


#: Options of the program in texts of the library, unless they name one of its commands; the arguments have the same names.
_OPTION = re.compile(r"(?<!simulate )(?<!MAP )--(format|frame-rate|scale|map|footprint|out|resume)\b( \(convert: --from; check, monitor: --map-format\))?")


def with_arguments(text: str) -> str:
    """The text of an error or a note with the names of arguments instead of the program's options: "`frame_rate`"."""
    return _OPTION.sub(lambda option: f"`{option[1].replace('-', '_')}`", text)


def _suggestion(found: str, expected: str) -> str:
    word = found.strip('"')
    near = difflib.get_close_matches(word.lower(), re.findall(r'"([^"]+)"', expected), n=1, cutoff=0.5) if found[:1] == '"' else []
    return f'; did you mean "{near[0]}"?' if near and near[0] != word else ""


class ArgumentError(ExactVOError, ValueError):
    """An argument that does not fit: ``where`` is its name. ``code`` is "E_ARGUMENT"."""

    def __init__(self, where: str, found: str, expected: str) -> None:
        message = f"{where}: found {found}, expected {expected}{_suggestion(found, expected)}"
        super().__init__(message, code="E_ARGUMENT", where=where, found=found, expected=expected)


class DataError(ExactVOError, ValueError):
    """Wrong data in a file: which file, where in it, what stands there and what should. ``code`` as in docs/guide/codes.md."""

    def __init__(self, code: str, file: str, where: str, found: str, expected: str) -> None:
        expected = with_arguments(expected)
        place = "".join(f"{part}: " for part in (file, where) if part)
        super().__init__(
            f"{place}found {found}, expected {expected} [{code}]", code=code, file=file, where=where, found=found, expected=expected
        )


class MissingFileError(DataError, FileNotFoundError):
    """There is no such file. A `FileNotFoundError` too. ``code`` is "E_FILE_MISSING"."""


class CrowdError(ExactVOError, ValueError):
    """A call that a crowd refuses; the crowd is as it was before. ``code`` is one of "not-finite", "out-of-range",
    "beyond-lattice", "coincident", "too-many", "unknown-robot", "unknown-kind", "unknown-obstacle", "bad-snapshot"."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message, code=code, where="crowd", found=message)


class RouteNotProvenError(ExactVOError, RuntimeError):
    """A way exists and no route along it could be proven: a defect of the library, never "unreachable"."""

    def __init__(self, message: str) -> None:
        super().__init__(message, code="E_ROUTE_NOT_PROVEN")
