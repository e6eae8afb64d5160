# SPDX-License-Identifier: GPL-3.0-or-later
"""One scenario, run with many values of its fields and of the options, as one table."""

from __future__ import annotations

import csv
import io
import itertools
import json
import os
import tempfile
import warnings
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from ._calls import explain_calls, is_whole
from .errors import ArgumentError, DataError, ScenarioWarning
from .simulation import Scenario, _collected, _plain, simulate

__all__ = ["sweep"]

#: Options of `simulate` that can be varied.
_OPTIONS = ("method", "guidance", "liveness", "controller", "integrator")

#: Of a run's metrics: what a table can hold, and what is the same in no two runs.
_LEFT_OUT = ("scenario", "wall_time", *_OPTIONS)


def sweep(
    scenario: Scenario | str | os.PathLike[str] | dict[str, Any],
    vary: dict[str, Any],
    *,
    table: str | os.PathLike[str] | None = None,
    jobs: int = 1,
    method: str = "ivo",
    guidance: str | None = None,
    liveness: str | None = None,
    controller: str = "default",
    integrator: str = "exact",
) -> list[dict[str, Any]]:
    """Runs a scenario once for every combination of values, and returns a row of each: what was varied, then the run in numbers
    (docs/guide/outputs.md; collisions and robots that got stuck as counts), in the order of the values, the last one fastest.

    >>> rows = exactvo.sweep("crowd.json", {"method": ["orca", "ivo"], "/robots/0/random/seed": range(20)},
    ...                      table="sweep.csv")                                        # doctest: +SKIP

    vary         values by name: an option of `simulate` (method, guidance, liveness, controller, integrator), or a field of the
                 scenario as a JSON pointer, which may be one that the scenario leaves out: "/margins/robot"
    table        FILE.csv to write the rows to as well, whole or not at all
    jobs         runs at a time, 1 to 1024; the rows are the same
    method and so on: options of `simulate`, the same in all runs in which they are not varied

    Each warning of the runs is given once, after the last run, as a `ScenarioWarning`.
    Raises `ArgumentError`, `DataError`, `MissingFileError`; of a run that fails the first one's.
    """
    if not isinstance(vary, dict) or not all(isinstance(name, str) for name in vary):
        raise ArgumentError("vary", repr(vary)[:60], "a dict of values by name")
    if not is_whole(jobs) or isinstance(jobs, bool) or not 1 <= jobs <= 1024:
        raise ArgumentError("jobs", repr(jobs)[:60], "1 to 1024")
    target = None if table is None else _csv_name(table)
    values = [_values(name, given) for name, given in vary.items()]
    base = _as_dict(scenario)
    said: list[str] = []

    def run(chosen: tuple[Any, ...]) -> dict[str, Any]:
        fields = json.loads(base)
        given: dict[str, Any] = dict(zip(_OPTIONS, (method, guidance, liveness, controller, integrator)))
        for name, value in zip(vary, chosen):
            if name.startswith("/"):
                _set(fields, name, value)
            else:
                given[name] = value
        _collected.set(said)
        metrics = dict(simulate(fields, **given).metrics)
        row = dict(zip(vary, chosen))
        for name, count in metrics.pop("decisions").items():
            row[f"decisions_{name}"] = count
        for key, value in metrics.items():
            if key not in _LEFT_OUT and not isinstance(value, dict):
                row[key] = len(value) if isinstance(value, list) else value
        return row

    with ThreadPoolExecutor(jobs) as pool:
        rows = list(pool.map(run, itertools.product(*values)))
    for text in sorted(set(said)):
        warnings.warn(text, ScenarioWarning, stacklevel=3)  # this, its wrapper, the caller
    if target is not None:
        _write(target, rows)
    return rows


def _csv_name(table: Any) -> Path:
    try:
        path = Path(os.fspath(table))
    except TypeError:
        raise ArgumentError("table", repr(table)[:60], "a path, FILE.csv") from None
    if path.suffix != ".csv":
        raise ArgumentError("table", repr(table)[:60], "a name that ends in .csv")
    return path


def _values(name: str, given: Any) -> list[Any]:
    if not name.startswith("/") and name not in _OPTIONS:
        raise ArgumentError("vary", repr(name)[:60], f"{', '.join(_OPTIONS)}, or a JSON pointer such as /time_step")
    if isinstance(given, (str, bytes, dict)) or not isinstance(given, Iterable):
        raise ArgumentError("vary", f"{name}: {given!r}"[:60], "values in a list, a range or an array")
    return [value.item() if hasattr(value, "item") else value for value in given]


def _as_dict(scenario: Any) -> str:
    """JSON text of the scenario, with files where they can be found from anywhere."""
    if isinstance(scenario, Scenario):
        return scenario.to_json()
    folder = Path.cwd()
    if isinstance(scenario, dict):
        fields = json.loads(json.dumps(scenario, default=_plain))
    else:
        Scenario(scenario)  # raises what is wrong with it
        text = os.fspath(scenario)
        if not text.lstrip().startswith("{"):
            folder = Path(text).absolute().parent
            text = Path(text).read_text(encoding="utf-8")
        fields = json.loads(text)
    for part in ("robots", "obstacles"):
        entries = fields.get(part, [])
        for entry in entries if isinstance(entries, list) else [entries]:
            if isinstance(entry, dict) and isinstance(entry.get("file"), str):
                entry["file"] = str(folder / entry["file"])
    return json.dumps(fields)


def _set(fields: Any, pointer: str, value: Any) -> None:
    """Puts the value where the pointer leads; objects on the way are made."""
    at = fields
    keys = [key.replace("~1", "/").replace("~0", "~") for key in pointer[1:].split("/")]
    for place, key in enumerate(keys):
        is_last = place + 1 == len(keys)
        if isinstance(at, list):
            if not key.isdecimal() or int(key) >= len(at):
                raise ArgumentError("vary", repr(pointer)[:60], f"an entry from 0 to {len(at) - 1} in place of {key!r}")
            index: Any = int(key)
        elif isinstance(at, dict):
            index = key
            if not is_last:
                at.setdefault(key, {})
        else:
            raise ArgumentError("vary", repr(pointer)[:60], f"a pointer to a field: {key!r} is within {at!r}"[:200])
        if is_last:
            at[index] = value
        else:
            at = at[index]


def _write(target: Path, rows: list[dict[str, Any]]) -> None:
    text = io.StringIO()
    if rows:
        writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    temporary = ""
    try:
        target.absolute().parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=target.absolute().parent, delete=False) as file:
            temporary = file.name
            file.write(text.getvalue())
        os.chmod(temporary, 0o644)
        os.replace(temporary, target)
    except OSError as error:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
        raise DataError("E_FILE_UNWRITABLE", str(target), "", error.strerror or str(error), "a place to write to") from None


explain_calls(__name__)
