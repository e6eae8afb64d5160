# SPDX-License-Identifier: GPL-3.0-or-later
"""Did they collide? Bodies on trajectories, in continuous time (docs/guide/check.md).

>>> import exactvo, numpy as np
>>> east = np.array([(0, 0, 0), (1, 10, 0)])                     # t, x, y
>>> north = np.array([(0, 5, -5), (1, 5, 5)])
>>> answer = exactvo.check({"east": east, "north": north}, radius=0.25)
>>> answer.clear, answer.events[0].body, answer.events[0].other, round(answer.events[0].depth, 6)
(False, 'east', 'north', 0.5)
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from . import _exactvo, datasets
from ._calls import explain_calls
from .errors import ArgumentError, DataError, with_arguments
from .explorer import ExplorerPage
from .shapes import Obstacles, ShapeLike, obstacles
from .simulation import Recording

if TYPE_CHECKING:
    import pandas

__all__ = ["Approach", "BodySummary", "CheckResult", "Extreme", "Finding", "MotionEvent", "check", "trajectory_formats"]

PathLike = Union[str, "os.PathLike[str]"]
Bounds = tuple[float, float]


@dataclass(frozen=True)
class MotionEvent:
    """Two bodies, or a body and an obstacle, that touch or overlap for a while. Bounds are certified."""

    kind: str  #: "overlap", "contact", or "close": footprints that turn, and it is open whether they overlap
    body: str
    with_obstacle: bool
    other: Union[str, int]  #: id of the other body, or number of the obstacle
    first: Bounds  #: s, bounds of the first moment
    last: Bounds  #: s, bounds of the last moment
    clearance: Bounds  #: m, bounds of the least clearance; its negative is the greatest depth
    time: float  #: s, rounded: when it is deepest
    place: tuple[float, float]  #: m, rounded: where, at that time

    @property
    def depth(self) -> float:
        """m, an upper bound of the greatest depth; 0 for contact."""
        return max(0.0, -self.clearance[0])


@dataclass(frozen=True)
class Approach:
    """A pair that comes nearer than `near`, over all time."""

    body: str
    with_obstacle: bool
    other: Union[str, int]
    clearance: Bounds  #: m, bounds of the least clearance; below 0 where they overlap
    time: float  #: s, rounded
    place: tuple[float, float]  #: m, rounded


@dataclass(frozen=True)
class Finding:
    """What is odd in the data: a jump, or a gap."""

    kind: str  #: "jump" or "gap"
    body: str
    row: int  #: line of the file, or row of the arrays, from 1, at the end
    start: float  #: s
    end: float  #: s
    length: float  #: m
    speed: float  #: m/s, rounded


@dataclass(frozen=True)
class Extreme:
    """A greatest value and where it was."""

    value: float
    time: float  #: s
    row: int  #: line or row at the end of the move; 0: none


@dataclass(frozen=True)
class BodySummary:
    """One body, over all its rows. Speeds and accelerations are rounded."""

    id: str
    rows: int
    start: float  #: s
    end: float  #: s
    speed: Extreme  #: m/s
    acceleration: Extreme  #: m/s^2


@dataclass(frozen=True)
class CheckResult:
    """The answer of `check`."""

    file: str
    format: str
    between: str  #: what was assumed between rows
    overlaps: int
    contacts: int
    open: int  #: of footprints that turn: pairs so near to touching that it is not known whether they overlap
    rows: int
    repeated_rows: int  #: left out, since they repeat the row before
    pieces: int  #: of motion that were looked at
    pairs: int  #: of pieces that come near each other
    near: float  #: m
    jump_speed: float  #: m/s: a faster move is a jump
    events: tuple[MotionEvent, ...] = field(repr=False)
    approaches: tuple[Approach, ...] = field(repr=False)
    findings: tuple[Finding, ...] = field(repr=False)
    bodies: tuple[BodySummary, ...] = field(repr=False)
    notes: tuple[str, ...] = ()

    @property
    def clear(self) -> bool:
        """Whether nothing overlaps at any moment. Exact; contact is clear. False where it is not known (`open`)."""
        return self.overlaps == 0 and self.open == 0

    @property
    def speeds(self) -> dict[str, float]:
        """m/s, the greatest speed of each body."""
        return {body.id: body.speed.value for body in self.bodies}

    @property
    def gaps(self) -> tuple[Finding, ...]:
        """Pauses between two rows of a body that are longer than 1.5 times its usual interval."""
        return tuple(f for f in self.findings if f.kind == "gap")

    @property
    def jumps(self) -> tuple[Finding, ...]:
        """Moves that are faster than `jump_speed`."""
        return tuple(f for f in self.findings if f.kind == "jump")

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each event: kind, body, with_obstacle, other, first_low, first_high, last_low, last_high (s),
        clearance_low, clearance_high (m), time (s), x, y (m). Needs pandas."""
        import pandas

        columns = ["kind", "body", "with_obstacle", "other", "first_low", "first_high", "last_low", "last_high"]
        columns += ["clearance_low", "clearance_high", "time", "x", "y"]
        rows = [(e.kind, e.body, e.with_obstacle, e.other, *e.first, *e.last, *e.clearance, e.time, *e.place) for e in self.events]
        return pandas.DataFrame(rows, columns=columns)


def check(
    trajectories: PathLike | Sequence[PathLike] | Mapping[Any, Any] | npt.ArrayLike | Recording | Any,
    *,
    map: PathLike | Obstacles | ShapeLike | Sequence[Any] | None = None,
    unknown: str | None = None,
    radius: float | Mapping[Any, float] | npt.ArrayLike | None = None,
    footprint: npt.ArrayLike | ShapeLike | None = None,
    time: npt.ArrayLike | None = None,
    between: str = "straight",
    near: float | None = None,
    max_speed: float | None = None,
    max_gap: float | None = None,
    format: str | None = None,
    frame_rate: float | None = None,
    scale: float = 1.0,
    page: PathLike | None = None,
    certificates: PathLike | None = None,
) -> CheckResult:
    """Whether bodies on trajectories touch each other or a map at any time. Exact; of footprints that turn certified.

    trajectories  a path (any format of `trajectory_formats()`, or the folder of a run; several paths of polynomials, or a
                  folder of them, are one fleet); a dict of ids to
                  n x 3 arrays (t, x, y) or n x 4 arrays (t, x, y, theta); a table with the columns t, id, x, y and, where
                  wanted, theta, vx, vy (a DataFrame, or a dict of columns), named and in units as in CSV; an n x 4 array (t, id, x, y); a steps x robots
                  x 2 array of positions with `time`, in which NaN is "not there"; a `Recording`
    map           a path, or obstacles as `exactvo.obstacles` takes them; of a run by default its own
    unknown       what unknown cells of a ROS map are, "free" (the default, which `notes` says) or "blocked"
    radius        m: of all, or of each: by id, or in the order of the robots of an array. Grows a footprint. Of a run by
                  default its own
    footprint     a polygon round the place, or a wall of half width `radius`; turned by theta, evenly from row to row. Of
                  recorded robots on wheels the place is the axle's centre, also for `radius`; without both their discs are
                  about the reference points, and a run whose scenario gives footprints is refused
    time          s, for an array of positions: one time a step
    between       what lies between rows: "straight", "hold", "cubic" (with the rows' velocities, else Catmull-Rom), "none"
    near          m: list pairs that come nearer; by default the radius, or the reach of the footprint
    max_speed     m/s: a faster move is a jump; by default three times what 95 of 100 moves do not exceed
    max_gap       s: a body without a row for longer counts as absent; by default it goes on to its next row
    format        of the file; by default found by content
    frame_rate    frames a second, of files that count frames
    scale         m: of the trajectories' unit of length
    page          a file to write, .html: a page for a browser that plays the trajectories and leads to each overlap
    certificates  a file to write: a proof for each pair of motions that come near and stay clear, for
                  `exactvo audit --certificate`; `notes` says how many there are

    Raises `ArgumentError`, `DataError` with the line or row, `MissingFileError`.
    """
    if isinstance(trajectories, Recording) and scale != 1.0:
        raise ArgumentError("scale", repr(scale)[:60], "1.0 for a run, whose places, radii and obstacles are in m")
    written = _written(trajectories, map, page=page, certificates=certificates)
    if isinstance(trajectories, Recording) and _is_on_wheels(trajectories):
        _no_time(time)
        options = {"between": between, "near": near, "max_speed": max_speed, "max_gap": max_gap, "scale": scale, **written}
        return _check_on_wheels(trajectories, radius, map=map, unknown=unknown, footprint=footprint, **options)
    source, ids, notes = _source(trajectories, time, scale)
    if isinstance(trajectories, Recording):
        scenario = trajectories.scenario
        if radius is None and footprint is None:
            radius = {robot.id: robot.radius for robot in scenario.robots}
        if map is None:
            map = scenario.obstacles
        if moving := json.loads(scenario.to_json()).get("moving_obstacles"):
            notes.append(f"{len(moving)} moving obstacle{'s' * (len(moving) > 1)} left out")
    shapes = None
    if isinstance(map, (str, os.PathLike)):
        content = datasets.read(map, unknown=unknown or "free")
        shapes = content.obstacles
        notes += [f"{content.file}: {note}" for note in content.notes]
    elif unknown is not None:
        raise ArgumentError("unknown", repr(unknown)[:60], "none: only the file of a map has unknown cells")
    elif map is not None:
        shapes = _shapes(map, "map")
    outline = None if footprint is None else _shapes(footprint, "footprint")
    native = _exactvo.check_trajectories(
        source,
        format,
        frame_rate,
        scale,
        None if shapes is None else shapes._native,
        _radius(radius, ids),
        None if outline is None else outline._native,
        between,
        near,
        max_speed,
        max_gap,
        page is not None,
        written["certificates"] or "",
    )
    if written["page"]:
        ExplorerPage(native["page"]).write(written["page"])
    if native["proofs"]:
        notes.append(f"{written['certificates']}: {native['proofs']}")
    return CheckResult(
        **{k: native[k] for k in ("file", "format", "between", "overlaps", "contacts", "open", "rows", "repeated_rows", "pieces", "pairs", "near", "jump_speed")},
        events=tuple(MotionEvent(*e) for e in native["events"]),
        approaches=tuple(Approach(*a) for a in native["approaches"]),
        findings=tuple(Finding(*f) for f in native["findings"]),
        bodies=tuple(BodySummary(b[0], b[1], b[2], b[3], Extreme(*b[4]), Extreme(*b[5])) for b in native["bodies"]),
        notes=(*(with_arguments(note) for note in native["notes"]), *notes),
    )


def _written(trajectories: Any, map: Any, **files: PathLike | None) -> dict[str, str | None]:
    """What is written, none of it over another or over what is read: of a folder its recordings and its CSV."""
    written = {name: None if file is None else os.fspath(file) for name, file in files.items()}
    read = [*(trajectories if isinstance(trajectories, (list, tuple)) else [trajectories]), map]
    names = [os.fspath(file) for file in read if isinstance(file, (str, os.PathLike))]
    in_folders = [os.path.join(folder, name) for folder in names if os.path.isdir(folder) for name in os.listdir(folder)]
    names += [file for file in in_folders if file.endswith((os.sep + "recording.jsonl", ".evr", ".csv"))]
    taken = {os.path.realpath(file) for file in names}
    for name, file in written.items():
        if file is None:
            continue
        if not file or (name == "page" and not file.endswith(".html")):
            raise ArgumentError(name, repr(file), "a name for a file" + (" that ends in .html" if name == "page" else ""))
        if os.path.realpath(file) in taken:
            raise ArgumentError(name, repr(file), "another file than those that are read or written besides")
        taken.add(os.path.realpath(file))
    return written


def _is_on_wheels(run: Recording) -> bool:
    return any(robot.get("kinematics", {}).get("type") == "differential" for robot in json.loads(run.scenario.to_json())["robots"])


def _check_on_wheels(run: Recording, radius: Any, **options: Any) -> CheckResult:
    """As a file, which has the headings."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "recording.jsonl")
        run.write(path)
        try:
            answer = check(path, radius=_radius(radius, [robot.id for robot in run.scenario.robots]), **options)
        except DataError as error:
            if error.file == path:
                error.args, error.file = (str(error).replace(path, "trajectories"),), "trajectories"
            raise
    return replace(answer, file="trajectories")


def trajectory_formats() -> list[str]:
    """What `check(format=...)` takes."""
    return _exactvo.trajectory_formats()


def _shapes(given: Any, name: str) -> Obstacles:
    try:
        return obstacles(given)
    except ArgumentError as error:
        raise ArgumentError(name if error.where == "obstacles" else f"{name}, {error.where}", error.found, error.expected) from None


def _radius(radius: Any, ids: list[str] | None) -> Any:
    if isinstance(radius, Mapping):
        return {_name(key): value for key, value in radius.items()}
    if radius is None or (_is_regular(radius) and np.ndim(radius) == 0):
        return radius
    values = _floats(radius, "radius", 1)
    if ids is None or len(values) != len(ids):
        expected = "a number, or a dict of ids" if ids is None else f"a radius for each of the {len(ids)} robots"
        raise ArgumentError("radius", f"{len(values)} numbers", expected)
    return dict(zip(ids, values.tolist()))


def _floats(given: Any, name: str, dimensions: int) -> npt.NDArray[np.float64]:
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(name, repr(given)[:60], "an array of numbers") from None
    if array.ndim != dimensions:
        raise ArgumentError(name, f"an array of shape {array.shape}", f"an array of {dimensions} dimension" + "s" * (dimensions > 1))
    return array


Columns = tuple[list[str], Any, Any, Any, Any, Any, Any, Any, bool]


def _source(given: Any, time: Any, scale: Any) -> tuple[Union[list[str], Columns], list[str] | None, list[str]]:
    """Paths, or columns as the extension takes them; the ids, where their order is known; and notes."""
    if isinstance(given, Recording):
        _no_time(time)
        ids = [robot.id for robot in given.scenario.robots]
        return (ids, *_of_array(given.position, given.time)[1:]), ids, []
    if isinstance(given, (str, os.PathLike)):
        _no_time(time)
        return [os.fspath(given)], None, []
    if isinstance(given, (list, tuple)) and given and all(isinstance(path, (str, os.PathLike)) for path in given):
        _no_time(time)
        return [os.fspath(path) for path in given], None, []
    notes: list[str] = []
    if isinstance(given, Mapping):
        _no_time(time)
        is_table = {"x", "y"} <= {str(key).lower() for key in given} or all(_is_regular(column) and np.ndim(column) == 1 for column in given.values())
        columns, notes = _table(given, list(given), scale) if is_table and given else (_by_id(given), notes)
    elif hasattr(given, "columns") and hasattr(given, "__getitem__"):
        _no_time(time)
        columns, notes = _table(given, list(given.columns), scale)
    else:
        columns = _of_array(given, time)
    return columns, columns[0], notes


def _no_time(time: Any) -> None:
    if time is not None:
        raise ArgumentError("time", repr(time)[:60], "none: only an array of positions has its times apart")


def _numbered(ids: Any) -> tuple[list[str], npt.NDArray[np.int64]]:
    """Ids in the order in which they come up, and the number of each row."""
    numbers: dict[str, int] = {}
    rows = [numbers.setdefault(_name(one), len(numbers)) for one in ids]
    return list(numbers), np.asarray(rows, dtype=np.int64)


def _name(one: Any) -> str:
    if not isinstance(one, str) and str(one) in ("None", "nan", "NaT", "<NA>"):
        raise ArgumentError("trajectories", f"the id {one}", "an id in every row")
    return str(int(one)) if isinstance(one, (float, np.floating)) and float(one).is_integer() else str(one)


def _table(table: Any, names: list[Any], scale: Any) -> tuple[Columns, list[str]]:
    """Columns by their names and in the units that these state, as the header of CSV does; and notes."""
    shown = f"columns {', '.join(str(n) for n in names)[:60]}"
    found, notes = _exactvo.trajectory_header([str(name) for name in names], scale)
    when = "t" if "t" in found else "frame"
    if not {when, "x", "y"} <= set(found):
        raise ArgumentError("trajectories", shown, "columns t, id, x, y, in s and in m, or in another unit with scale")

    def column_of(column: str) -> Any:
        if column not in found:
            return None
        at, in_si = found[column]
        return _floats(table[names[at]], column, 1) / in_si

    t, x, y, theta = (column_of(column) for column in (when, "x", "y", "theta"))
    if theta is None and {"qx", "qy", "qz", "qw"} <= set(found):
        qx, qy, qz, qw = (column_of(column) for column in ("qx", "qy", "qz", "qw"))
        is_none = (qx == 0) & (qy == 0) & (qz == 0) & (qw == 0)
        theta = np.where(is_none, np.nan, np.arctan2(2 * (qw * qz + qx * qy), qw * qw + qx * qx - qy * qy - qz * qz))
    if "id" not in found and not (np.diff(t) > 0).all():
        raise ArgumentError("trajectories", f"{shown}, and times that do not rise", "a column id: whose row it is")
    ids, rows = _numbered(table[names[found["id"][0]]]) if "id" in found else (["agent"], np.zeros(len(t), dtype=np.int64))
    velocities = (column_of("vx"), column_of("vy")) if {"vx", "vy"} <= set(found) else (None, None)
    return (ids, rows, t, x, y, theta, *velocities, when == "frame"), notes


def _by_id(given: Mapping[Any, Any]) -> Columns:
    if not given:
        raise ArgumentError("trajectories", "none", "at least one trajectory")
    arrays = [_floats(array, f"trajectories[{key!r}]", 2) for key, array in given.items()]
    width = arrays[0].shape[1]
    for key, array in zip(given, arrays):
        if array.shape[1] != width or width not in (3, 4):
            raise ArgumentError(f"trajectories[{key!r}]", f"an array of shape {array.shape}", "n x 3 (t, x, y) or n x 4 (t, x, y, theta), all alike")
    rows = np.repeat(np.arange(len(arrays)), [len(array) for array in arrays])
    all_rows = np.concatenate(arrays)
    heading = all_rows[:, 3] if width == 4 else None
    return [_name(key) for key in given], rows, all_rows[:, 0], all_rows[:, 1], all_rows[:, 2], heading, None, None, False


def _of_array(given: Any, time: Any) -> Columns:
    array = _floats(given, "trajectories", np.ndim(given) if _is_regular(given) and np.ndim(given) in (2, 3) else 2)
    if array.ndim == 2 and array.shape[1] == 4 and time is None:
        ids, rows = _numbered(array[:, 1])
        return ids, rows, array[:, 0], array[:, 2], array[:, 3], None, None, None, False
    if array.ndim == 3 and array.shape[2] == 2 and time is not None:
        times = _floats(time, "time", 1)
        if len(times) != len(array):
            raise ArgumentError("time", f"{len(times)} times", f"a time for each of the {len(array)} steps")
        steps, robots = array.shape[:2]
        rows, t = np.tile(np.arange(robots), steps), np.repeat(times, robots)
        x, y = array[..., 0].ravel(), array[..., 1].ravel()
        there = ~(np.isnan(x) & np.isnan(y))
        return [str(k) for k in range(robots)], rows[there], t[there], x[there], y[there], None, None, None, False
    raise ArgumentError(
        "trajectories", f"an array of shape {array.shape}" + ("" if time is None else " and times"),
        "n x 4 (t, id, x, y), or steps x robots x 2 with time",
    )  # fmt: skip


def _is_regular(given: Any) -> bool:
    try:
        np.ndim(given)
    except ValueError:
        return False
    return True


explain_calls(__name__)
