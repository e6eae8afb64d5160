# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenarios run, and recordings as arrays."""

from __future__ import annotations

import difflib
import json
import os
import tempfile
import warnings
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls, is_number
from .errors import ArgumentError, ScenarioWarning
from .explorer import ExplorerPage, view
from .shapes import Floats, Obstacles, Polygon, ShapeLike, obstacles
from .vo import HalfPlane

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.animation
    import pandas

__all__ = [
    "METHODS",
    "JointPlan",
    "OwnHalfPlane",
    "RecordedHalfPlane",
    "RecordedOwnHalfPlane",
    "Recording",
    "RobotsNow",
    "Scenario",
    "ScenarioRobot",
    "read_recording",
    "simulate",
]

#: What `simulate(method=...)` takes: the textbook's baseline, the paper's, with merged enclosures, and the default.
METHODS: tuple[str, ...] = tuple(_exactvo.method_names())

#: Where `sweep` collects what its runs warn of, which are not the caller's; None: warnings of Python.
_collected: ContextVar[list[str] | None] = ContextVar("_collected", default=None)

_SOURCES = ("enclosure", "obstacle edge", "robot", "moving obstacle")
_STATUSES = ("optimal", "relaxed", "infeasible", "no-interior")


@dataclass(frozen=True, eq=False)
class ScenarioRobot:
    """A robot of a scenario as it starts."""

    id: str
    position: tuple[float, float]  #: m
    goals: Floats  #: n x 2, m; none in a formation
    radius: float  #: m
    max_speed: float  #: m/s


class Scenario:
    """Robots, obstacles and how they move, from a JSON file (datasets/schema/scenario.schema.json), its text, a dict of the
    same form, or `Scenario.build`. Raises `DataError`, `MissingFileError`, `ArgumentError`; ``where`` of wrong data is a JSON
    pointer."""

    __slots__ = ("_native",)

    def __init__(self, source: str | os.PathLike[str] | dict[str, Any]) -> None:
        if isinstance(source, dict):
            self._native = _exactvo.Scenario.parse(json.dumps(source, default=_plain), "<dict>", os.getcwd())
        elif isinstance(source, str) and source.lstrip().startswith("{"):
            self._native = _exactvo.Scenario.parse(source, "<text>", os.getcwd())
        else:
            try:
                path = os.fspath(source)
            except TypeError:
                raise ArgumentError("scenario", repr(source)[:60], "a path, JSON text, a dict or a Scenario") from None
            self._native = _exactvo.Scenario.load(path)

    @staticmethod
    def build(
        starts: npt.ArrayLike,
        goals: npt.ArrayLike,
        *,
        obstacles: Obstacles | ShapeLike | Sequence[Any] = (),
        radius: float = 0.5,
        max_speed: float = 3.0,
        name: str = "unnamed",
        **fields: Any,
    ) -> Scenario:
        """n robots from n x 2 starts to n x 2 goals (m) among obstacles. Further fields are those of a scenario file:
        time_step=0.05 (s), time_limit=120 (s), ... Raises `ArgumentError`, `DataError`."""
        for word in fields:  # one meant for this function would be refused later, as a field that no scenario has
            near = difflib.get_close_matches(word, ("obstacles", "radius", "max_speed", "name"), n=1, cutoff=0.85)
            if near:
                raise TypeError(f"Scenario.build() got an unexpected keyword argument {word!r}; did you mean {near[0]!r}?")
        return Scenario(_scenario_dict(starts, goals, obstacles, radius, max_speed, name, fields))

    @property
    def name(self) -> str:
        """As the file gives it."""
        return self._native.name

    @property
    def robots(self) -> tuple[ScenarioRobot, ...]:
        """In the order of a recording's columns."""
        return tuple(ScenarioRobot(*fields) for fields in self._native.robots())

    @property
    def obstacles(self) -> Obstacles:
        """Those that stand still."""
        return Obstacles._of(self._native.obstacles())

    @property
    def notes(self) -> list[str]:
        """What reading its obstacle files had to decide."""
        return self._native.notes

    @property
    def warnings(self) -> list[str]:
        """Warnings known before a run: goals out of reach, and what encloses them."""
        return self._native.warnings()

    def to_json(self) -> str:
        """Every field, obstacles inline, numbers that read back to the same doubles."""
        return self._native.to_json()

    def __reduce__(self) -> tuple[Any, ...]:
        return Scenario, (self.to_json(),)

    def __repr__(self) -> str:
        return f"Scenario({self.name!r}, {len(self.robots)} robots, {len(self.obstacles)} obstacles)"


def _plain(value: Any) -> Any:
    """numpy's numbers and arrays as JSON has them."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise ArgumentError("scenario", repr(value)[:60], "numbers, text, lists and dicts")


def _scenario_dict(
    starts: npt.ArrayLike, goals: npt.ArrayLike, given: Any, radius: float, max_speed: float, name: str, fields: dict[str, Any]
) -> dict[str, Any]:
    a, b = np.asarray(starts, dtype=np.float64), np.asarray(goals, dtype=np.float64)
    if a.ndim != 2 or a.shape[1:] != (2,):
        raise ArgumentError("starts", f"an array of shape {a.shape}", "an array of shape (n, 2)")
    if b.shape != a.shape:
        raise ArgumentError("goals", f"an array of shape {b.shape}", f"an array of shape {a.shape}, as starts have")
    robots = [
        {"id": f"R{k + 1}", "position": s, "goal": g, "radius": radius, "max_speed": max_speed}
        for k, (s, g) in enumerate(zip(a.tolist(), b.tolist()))
    ]
    listed = obstacles(given)
    items: list[dict[str, Any]] = []
    for ident, shape in zip(listed.ids, listed):
        if isinstance(shape, Polygon):
            item: dict[str, Any] = {"id": ident, "polygon": shape.outer.tolist()}
            if shape.holes:
                item["holes"] = [hole.tolist() for hole in shape.holes]
        else:
            item = {"id": ident, "polyline": shape.points.tolist()}
        items.append(item)
    return {"name": name, "robots": robots, "obstacles": items, **fields}


@dataclass(frozen=True)
class RecordedHalfPlane:
    """A half-plane behind a decision."""

    half_plane: HalfPlane
    source: str  #: "enclosure", "obstacle edge", "robot" or "moving obstacle"
    index: int  #: which of them
    certified: bool
    hard: bool
    active: bool  #: binds the chosen velocity
    multiplier: float  #: m/s, of its normal in chosen - preferred
    clearance: float  #: m, rim to body; negative in overlap


def _half_plane_of(fields: tuple[Any, ...]) -> RecordedHalfPlane:
    half_plane, source, *others = fields
    return RecordedHalfPlane(HalfPlane(*half_plane), _SOURCES[source], *others)


@dataclass(frozen=True, eq=False)
class RobotsNow:
    """The robots of a run before a step, in the order of the scenario: what `simulate` hands to `steering` and `half_planes`.
    The arrays are copies."""

    time: float  #: s
    position: Floats  #: n x 2, m
    velocity: Floats  #: n x 2, m/s
    preferred: Floats  #: n x 2, m/s: what the run would prefer; for `half_planes` what `steering` has made of it


@dataclass(frozen=True)
class OwnHalfPlane:
    """A half-plane of velocities that a user requires of a robot in one step (docs/guide/own-rules.md). Hard ones hold wherever those
    against obstacles and robots allow it; soft ones give before them."""

    robot: int  #: in the order of the scenario
    half_plane: HalfPlane
    hard: bool = True


@dataclass(frozen=True)
class RecordedOwnHalfPlane:
    """A half-plane that `simulate(half_planes=...)` asked for in a decision."""

    half_plane: HalfPlane
    hard: bool
    active: bool  #: binds the chosen velocity
    multiplier: float  #: m/s, of its normal in chosen - preferred


def _steered(steering: Callable[[RobotsNow], Any]) -> Callable[..., Floats]:
    """Asks for preferred velocities. Raises `ArgumentError` for an answer of another shape."""

    def ask(*fields: Any) -> Floats:
        now = RobotsNow(*fields)
        answer = steering(now)
        wanted: Floats = np.ascontiguousarray(now.preferred if answer is None else answer, dtype=np.float64)
        if wanted.shape != now.preferred.shape:
            raise ArgumentError("steering", f"an array of shape {wanted.shape}", f"one of shape {now.preferred.shape}, or None")
        if not np.isfinite(wanted).all():
            robot = int(np.flatnonzero(~np.isfinite(wanted).all(axis=1))[0])
            raise ArgumentError("steering", f"{wanted[robot].tolist()} for robot {robot}", "finite velocities, m/s")
        return wanted

    return ask


def _asked(half_planes: Callable[[RobotsNow], Any]) -> Callable[..., list[tuple[Any, ...]]]:
    """Asks for half-planes. Raises `ArgumentError` for what is none."""

    def ask(*fields: Any) -> list[tuple[Any, ...]]:
        now = RobotsNow(*fields)
        result: list[tuple[Any, ...]] = []
        for own in half_planes(now) or ():
            if not isinstance(own, OwnHalfPlane):
                raise ArgumentError("half_planes", repr(own)[:60], "an OwnHalfPlane")
            (x, y), offset = own.half_plane.normal, own.half_plane.offset
            if not 0 <= own.robot < len(now.position):
                raise ArgumentError("half_planes", f"robot {own.robot}", f"0 to {len(now.position) - 1}")
            if not (np.isfinite([x, y, offset]).all() and (x, y) != (0, 0)):
                raise ArgumentError("half_planes", repr(own)[:120], "finite numbers, and a normal other than 0")
            result.append((int(own.robot), float(x), float(y), float(offset), bool(own.hard)))
        return result

    return ask


@dataclass(frozen=True, eq=False)
class JointPlan:
    """The plan of robots that waited for each other (docs/guide/liveness.md): moves one after the other."""

    row: int  #: of the recording: where it was made
    from_row: int  #: where it begins; its robots go back there first where it is earlier
    robots: tuple[int, ...]  #: columns of the recording, ascending
    starts: Floats  #: n x 2, m: of each of them, where it was in `from_row`
    movers: tuple[int, ...]  #: of each move, whose it is: a column
    places: Floats  #: m x 2, m: of each move, where it leads

    def path(self, robot: int) -> Floats:
        """k x 2, m: where the robot (a column) goes, its start included. Raises `ArgumentError` for one that is not of the
        plan."""
        if robot not in self.robots:
            raise ArgumentError("robot", repr(robot)[:60], f"one of {', '.join(map(str, self.robots))}")
        path: Floats = np.vstack([self.starts[self.robots.index(robot)][None], self.places[np.array(self.movers, dtype=int) == robot]])
        return path

    def __repr__(self) -> str:
        return f"JointPlan({len(self.robots)} robots, {len(self.movers)} moves, row {self.row})"


class Recording:
    """What happened in a run. The arrays are read-only views: one row per step, one column per robot; the last row is the final
    state, whose decisions are empty."""

    __slots__ = ("_metrics", "_native")

    def __init__(self, native: _exactvo.Run) -> None:
        self._native = native
        self._metrics: dict[str, Any] | None = None

    @property
    def time(self) -> Floats:
        """steps, s."""
        return self._native.time

    @property
    def position(self) -> Floats:
        """steps x robots x 2, m."""
        return self._native.position

    @property
    def velocity(self) -> Floats:
        """steps x robots x 2, m/s."""
        return self._native.velocity

    @property
    def preferred(self) -> Floats:
        """steps x robots x 2, m/s: what each robot would have liked."""
        return self._native.preferred

    @property
    def chosen(self) -> Floats:
        """steps x robots x 2, m/s: what was decided."""
        return self._native.chosen

    @property
    def status(self) -> npt.NDArray[np.uint8]:
        """steps x robots, numbers into `exactvo.lp.STATUSES`."""
        return self._native.status

    @property
    def mode(self) -> npt.NDArray[np.str_]:
        """steps x robots: "direct", "guided", "by-plan", "going-back", "staying", "boost", "following", "pushing-out",
        "steered", "arrived"."""
        return np.asarray(_exactvo.mode_names)[self._native.mode]

    @property
    def metrics(self) -> dict[str, Any]:
        """The run in numbers, as metrics.json has them (docs/guide/outputs.md)."""
        if self._metrics is None:
            self._metrics = json.loads(self._native.metrics_json())
        return self._metrics

    @property
    def outcome(self) -> str:
        """How it ended, in words."""
        return self._native.outcome

    @property
    def warnings(self) -> list[str]:
        """The warnings given before the run."""
        return self._native.warnings

    @property
    def method(self) -> str:
        """One of `METHODS`."""
        return self._native.method

    @property
    def scenario(self) -> Scenario:
        """What was run."""
        scenario = object.__new__(Scenario)
        scenario._native = self._native.scenario()
        return scenario

    def half_planes(self, step: int, robot: int) -> tuple[RecordedHalfPlane, ...]:
        """The recorded half-planes of a decision: those that bind, or all with `simulate(..., record_all=True)`. Raises
        `IndexError`, `ArgumentError`."""
        step = range(len(self))[step]
        robot = range(self.position.shape[1])[robot]
        return tuple(_half_plane_of(fields) for fields in self._native.half_planes(step, robot))

    def own_half_planes(self, step: int, robot: int) -> tuple[RecordedOwnHalfPlane, ...]:
        """Those that `simulate(half_planes=...)` asked of a decision. Raises `IndexError`, `ArgumentError`."""
        step = range(len(self))[step]
        robot = range(self.position.shape[1])[robot]
        _, own = self._native.own_half_planes(step, robot)
        return tuple(
            RecordedOwnHalfPlane(HalfPlane(*half_plane), hard, active, multiplier) for half_plane, hard, active, multiplier in own
        )

    def own_stage(self, step: int, robot: int) -> str:
        """How far a decision held what `simulate(half_planes=...)` asked for: "held", but perhaps for soft ones; "gave", by the
        least that obstacles and robots allow; "left-out", as these alone leave no room; "none" where the user gave none. Raises
        `IndexError`, `ArgumentError`."""
        step = range(len(self))[step]
        robot = range(self.position.shape[1])[robot]
        stage: str = self._native.own_half_planes(step, robot)[0]
        return stage

    @property
    def plans(self) -> tuple[JointPlan, ...]:
        """The joint plans, in order of time; none where no robots waited for each other."""
        return tuple(
            JointPlan(row, from_row, tuple(robots), starts, tuple(movers), places)
            for row, from_row, robots, starts, movers, places in self._native.plans()
        )

    def audit(self) -> dict[str, Any]:
        """Verifies the recording in exact rational arithmetic, as `exactvo audit` does; "points" has the counts."""
        report: dict[str, Any] = json.loads(self._native.audit())
        return report

    def write(self, path: str | os.PathLike[str]) -> None:
        """recording.jsonl, which every verb of the program reads. Raises `DataError`, `ArgumentError`."""
        self._native.write(os.fspath(path))

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each robot and step: time (s), robot, x, y (m), vx, vy, preferred_x, preferred_y, chosen_x, chosen_y
        (m/s), status, mode. Needs pandas."""
        import pandas

        steps, robots = len(self), self.position.shape[1]
        ids = [robot.id for robot in self.scenario.robots]
        columns: dict[str, Any] = {"time": np.repeat(self.time, robots), "robot": np.tile(np.array(ids, dtype=object), steps)}
        for names, array in (
            (("x", "y"), self.position),
            (("vx", "vy"), self.velocity),
            (("preferred_x", "preferred_y"), self.preferred),
            (("chosen_x", "chosen_y"), self.chosen),
        ):
            for k, name in enumerate(names):
                columns[name] = array[..., k].ravel()
        columns["status"] = np.array(_STATUSES, dtype=object)[self.status].ravel()
        columns["mode"] = self.mode.ravel()
        return pandas.DataFrame(columns)

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Obstacles, paths, and where the robots end, drawn to scale in m. Needs matplotlib. Raises
        `ArgumentError`."""
        from ._drawing import plot

        if ax is not None and not hasattr(ax, "set_aspect"):
            raise ArgumentError("ax", repr(ax)[:60], "axes of matplotlib, or None for new ones")
        return plot(self, ax)

    def animate(self, *, speed: float = 1.0, frames_per_second: float = 20.0) -> matplotlib.animation.FuncAnimation:
        """The run as a moving picture, `speed` times as fast as it was. In a notebook: HTML(run.animate().to_jshtml()).
        Needs matplotlib. Raises `ArgumentError`."""
        from ._drawing import animate

        for name, value in (("speed", speed), ("frames_per_second", frames_per_second)):
            if not (is_number(value) and 0 < value < 1e6):
                raise ArgumentError(name, repr(value)[:60], "a number above 0, below 10^6")
        return animate(self, speed, frames_per_second)

    def view(self, *, height: int = 720) -> ExplorerPage:
        """The run as a page to explore, which a notebook shows in place, `height` pixels high; `.write(path)` and `.open()`
        elsewhere. Raises `ArgumentError`. `exactvo.view` puts several runs on one page."""
        return view(self, height=height)

    def __reduce__(self) -> tuple[Any, ...]:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "recording.jsonl"
            self.write(file)
            return _unpickled, (file.read_text(encoding="utf-8"), self.metrics)

    def __len__(self) -> int:
        return len(self._native.time)

    def __repr__(self) -> str:
        return f"Recording({self.scenario.name!r}, method {self.method}, {len(self)} steps: {self.outcome})"


def _unpickled(text: str, metrics: dict[str, Any]) -> Recording:
    recording = Recording(_exactvo.Run.parse(text))
    recording._metrics = metrics  # what planning cost stands in no recording
    return recording


def simulate(
    scenario: Scenario | str | os.PathLike[str] | dict[str, Any],
    *,
    method: str = "ivo",
    guidance: str | None = None,
    liveness: str | None = None,
    controller: str = "default",
    integrator: str = "exact",
    record_all: bool = False,
    threads: int = 1,
    progress: Callable[[float], Union[bool, None]] | None = None,
    steering: Callable[[RobotsNow], Any] | None = None,
    half_planes: Callable[[RobotsNow], Any] | None = None,
) -> Recording:
    """Runs a scenario: a `Scenario`, a path, JSON text or a dict. The same scenario and options give the same numbers as
    `exactvo simulate --decisions binding`, bit for bit. Each warning known before the run is a `ScenarioWarning`: goals out of reach, robots
    that have arrived before they move, by how much `recentre` moves the slots of a formation.

    method       "orca" (the textbook's baseline), "rvo" and "hrvo" (which promise nothing between robots), "ivo-edge" (the paper), "ivo-cluster", "ivo"
    guidance     "route" or "none" instead of the scenario's
    liveness     "plan", "bias" or "off" instead of the scenario's
    controller   of formations: "paper-literal", "paper-signs", "corrected", "default"
    integrator   of formations: "exact", "euler", "rk4"
    record_all   keep every half-plane of every decision, not only those that bind
    threads      0 to 1024; accepted, and without effect: one thread decides
    progress     called with the simulated time (s) about ten times a second; False ends the run there
    steering     called with a `RobotsNow` before every step; returns preferred velocities, n x 2, m/s, or changes
                 `preferred` in place. Robots with goals only, as the next
    half_planes  called likewise; returns a list of `OwnHalfPlane`, half-planes of velocities for this step
                 (docs/guide/own-rules.md). With either there are no joint plans

    Raises `ArgumentError`, `DataError`, `MissingFileError`. Ctrl-C ends it. Releases the interpreter's lock.
    """

    def warn(text: str) -> None:
        collected = _collected.get()
        if collected is None:
            warnings.warn(text, ScenarioWarning, stacklevel=4)  # this, `simulate`, its wrapper, the caller
        else:
            collected.append(text)

    given = scenario if isinstance(scenario, Scenario) else Scenario(scenario)
    if isinstance(threads, int) and not 0 <= threads <= 1024:
        raise ArgumentError("threads", repr(threads)[:60], "0 to 1024")
    return Recording(
        _exactvo.simulate(
            given._native, method, guidance, liveness, controller, integrator, record_all, threads, progress,
            None if steering is None else _steered(steering), None if half_planes is None else _asked(half_planes), warn,
        )
    )


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """A recording.jsonl, or the folder of a run that has one. Raises `DataError`, `MissingFileError`,
    `ArgumentError`."""
    given = Path(path)
    return Recording(_exactvo.Run.read(os.fspath(given / "recording.jsonl" if given.is_dir() else given)))


explain_calls(__name__)
