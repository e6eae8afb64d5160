# SPDX-License-Identifier: GPL-3.0-or-later
"""One robot's decisions for a control loop, without a simulator (docs/guide/navigator.md).

>>> import numpy as np, exactvo
>>> navigator = exactvo.Navigator([(6, 0)], obstacles=[exactvo.Wall([(3, -2), (3, 1)])], radius=0.3, max_speed=1.5)
>>> decision = navigator.decide(0.0, (0, 0), (0, 0), positions=[(6, 2.5)], velocities=[(-0.8, 0)], radii=0.3)
>>> decision.status, decision.uncertified
('optimal', 0)
>>> bool(np.linalg.norm(decision.chosen) <= 1.5)
True
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls, is_whole
from .errors import ArgumentError
from .shapes import Floats, Obstacles, Point, ShapeLike, _native_shape, obstacles as _obstacles
from .simulation import RecordedHalfPlane, Scenario, _half_plane_of, _STATUSES

__all__ = ["Navigator", "NavigatorDecision", "neighbours_on_wheels"]


@dataclass(frozen=True, eq=False)
class NavigatorDecision:
    """What to do until the next decision: drive `chosen`."""

    chosen: Floats  #: 2, m/s: the velocity to drive
    preferred: Floats  #: 2, m/s: what the robot would have liked
    status: str  #: "optimal": all half-planes hold; "relaxed", "infeasible" or "no-interior": docs/guide/navigator.md
    violation: float  #: m/s, by which half-planes are violated where the status is "relaxed" or "infeasible"
    uncertified: int  #: half-planes that promise nothing, as the robot overlaps what they are for
    mode: str  #: how `preferred` was formed, as in `Recording.mode`
    side: int  #: 1 left, -1 right, 0 none: the side kept while blocked
    note: str  #: why a mode began or ended; empty otherwise
    half_planes: tuple[RecordedHalfPlane, ...]  #: those that bind, and those against what could be met within a step
    twist: tuple[float, float]  #: of a robot on wheels: m/s forward and rad/s to the left, to hold until the next decision
    wheels: tuple[float, float]  #: the same as speeds of the left and right wheel, m/s


class Navigator:
    """Decides for one robot, again and again: its state and its neighbours go in, the velocity to drive comes out. The same
    decisions as `simulate` makes for a robot with ``guidance="none", liveness="off"``.

    goals               n x 2, m, visited in order
    obstacles           what stands still
    radius, max_speed   m and m/s, of the robot
    cooperates          False: it ignores its neighbours
    id                  its number among robots; settles ties
    method              one of `METHODS`
    speed_bound         "disc": |v| <= max_speed; "box": |v_x| and |v_y|
    horizons, margins   numbers by name, as in a scenario: {"robots": 2.0}, {"obstacle": 0.08, "robot": 0.04}
    time_step           s: the longest time from a decision to the next
    arrival_tolerance   m: within this of the last goal it has arrived
    neighbour_distance  m: a robot farther away, which cannot be met within a time step, is ignored
    acceleration        m/s^2: how fast the velocity may change; None: it jumps. Robots that meet all have the same
    braking_time        s, the same for all robots that meet. None: 1.1 max_speed / acceleration, or 1.1 max_wheel_speed /
                        max_wheel_acceleration, the longer of both where both are given, and with an acceleration neighbours
                        of another max_speed are refused.
                        Horizons that are not given are at least this long
    kinematics          two wheels on one axle, by the names of a scenario (docs/guide/wheels.md): {"wheel_separation": 0.16,
                        "max_wheel_speed": 0.22, "max_wheel_acceleration": 1}. `radius` is then that of the body about the
                        centre of the axle, `max_speed` is not used, and goals are of the reference point

    Raises `ArgumentError`.
    """

    __slots__ = ("_native",)

    def __init__(
        self,
        goals: npt.ArrayLike,
        *,
        obstacles: Obstacles | ShapeLike | Sequence[Any] = (),
        radius: float = 0.5,
        max_speed: float = 3.0,
        cooperates: bool = True,
        id: int = 0,
        method: str = "ivo",
        speed_bound: str = "disc",
        horizons: Mapping[str, float] | None = None,
        margins: Mapping[str, float] | None = None,
        time_step: float = 0.05,
        arrival_tolerance: float = 0.1,
        neighbour_distance: float = 15.0,
        acceleration: float | None = None,
        braking_time: float | None = None,
        kinematics: Mapping[str, Any] | None = None,
    ) -> None:
        self._native = _exactvo.navigator(
            goals,
            _obstacles(obstacles)._native,
            radius,
            max_speed,
            cooperates,
            _whole(id, "id"),
            method,
            speed_bound,
            _mapping(horizons, "horizons"),
            _mapping(margins, "margins"),
            time_step,
            arrival_tolerance,
            neighbour_distance,
            acceleration,
            braking_time,
            None if kinematics is None else _mapping(kinematics, "kinematics"),
        )

    @staticmethod
    def of_scenario(scenario: Scenario, robot: int = 0, *, method: str = "ivo") -> Navigator:
        """That of a robot of a scenario with goals: the other robots and what moves come with every decision. Raises
        `ArgumentError`."""
        if not isinstance(scenario, Scenario):
            raise ArgumentError("scenario", repr(scenario)[:60], "a Scenario")
        made = object.__new__(Navigator)
        made._native = _exactvo.navigator_of(scenario._native, _whole(robot, "robot"), method)
        return made

    def set_goals(self, goals: npt.ArrayLike) -> None:
        """Other goals, n x 2, m, from the next decision on. Raises `ArgumentError`."""
        self._native.set_goals(goals)

    def decide(
        self,
        time: float,
        position: Point,
        velocity: Point = (0.0, 0.0),
        *,
        heading: float = 0.0,
        wheels: Point = (0.0, 0.0),
        positions: npt.ArrayLike = (),
        velocities: npt.ArrayLike | None = None,
        radii: npt.ArrayLike = 0.5,
        max_speeds: npt.ArrayLike = 3.0,
        cooperate: npt.ArrayLike = True,
        ids: Sequence[int] | None = None,
        bodies: Sequence[tuple[Any, Point]] = (),
        measured: Mapping[str, Any] | None = None,
    ) -> NavigatorDecision:
        """What to do from `time` (s) on, at `position` (m) with `velocity` (m/s). Releases the interpreter's lock.

        heading, wheels  of a robot with `kinematics`: radians, and the speeds of its left and right wheel since the last
                         decision, m/s. `position` is then the centre of its axle, and `velocity` is not used
        positions   n x 2, m, of the neighbours; none by default
        velocities  n x 2, m/s; at rest by default
        radii       m, one for all neighbours or one for each; so `max_speeds` (m/s) and `cooperate` (False: it does not give
                    way, and this robot takes the whole responsibility)
        ids         their numbers among robots; 1 to n by default
        bodies      pairs of a convex shape (m) and its velocity (m/s): what moves and is not expected to give way
        measured    {"position": m, "velocity": m/s, "age": s}: neighbours have not told where they are but were measured,
                    exactly `age` ago and within these bounds; the robot keeps to its own side of lines, and they to theirs
                    (docs/guide/uncertainty.md). It takes an `acceleration`, of a robot with `kinematics` too

        Raises `ArgumentError` for numbers that are not finite or out of range, a time before the last one, a centre inside an
        obstacle, a neighbour in the robot's very place; the navigator is then as it was.
        """
        at = np.asarray(positions, dtype=np.float64).reshape(-1, 2) if np.size(positions) == 0 else positions
        count = len(np.atleast_1d(np.asarray(at)))
        listed = list(range(1, count + 1)) if ids is None else _wholes(ids)
        fields = self._native.decide(
            time,
            position,
            velocity,
            heading,
            wheels,
            listed,
            at,
            np.zeros((count, 2)) if velocities is None else velocities,
            _one_each(radii, count, "radii"),
            _one_each(max_speeds, count, "max_speeds"),
            _one_each(cooperate, count, "cooperate"),
            [(_native_shape(shape, "bodies"), moves) for shape, moves in _pairs(bodies)],
            None if measured is None else _mapping(measured, "measured"),
        )
        chosen, preferred, status, violation, uncertified, mode, side, note, half_planes, twist, speeds = fields
        return NavigatorDecision(
            np.array(chosen),
            np.array(preferred),
            _STATUSES[status],
            violation,
            uncertified,
            mode,
            side,
            note,
            tuple(_half_plane_of(h) for h in half_planes),
            twist,
            speeds,
        )

    @property
    def goal(self) -> int:
        """Which of its goals it heads for, from 0, as of the last decision."""
        return self._native.goal()

    @property
    def has_arrived(self) -> bool:
        """Whether it was within reach of the last goal at the last decision."""
        return self._native.has_arrived()

    def __repr__(self) -> str:
        return f"Navigator(goal {self.goal}{', arrived' if self.has_arrived else ''})"


def neighbours_on_wheels(
    positions: npt.ArrayLike,
    headings: npt.ArrayLike,
    wheels: npt.ArrayLike,
    *,
    kinematics: Mapping[str, Any],
    radius: float,
    time_step: float = 0.05,
) -> dict[str, Any]:
    """Other robots on wheels, all of one kind, as arguments of `Navigator.decide`:
    ``decide(..., **neighbours_on_wheels(...))``. Their reference points keep clear, each with a disc that holds the body.

    positions   n x 2, m, of the centres of their axles
    headings    n, radians
    wheels      n x 2, m/s: the left and right wheel of each since the last decision
    kinematics, radius, time_step  as of a `Navigator`

    Raises `ArgumentError`."""
    at, towards, speeds = _numbers(positions, "positions", 2), _numbers(headings, "headings", 1), _numbers(wheels, "wheels", 2)
    if not len(at) == len(towards) == len(speeds):
        raise ArgumentError("headings", f"{len(towards)} and wheels {len(speeds)}", f"one for each of {len(at)} positions")
    drive = _mapping(kinematics, "kinematics")
    seen = [_exactvo.neighbour_on_wheels(p, h, w, drive, radius, time_step) for p, h, w in zip(at, towards, speeds)]
    return {
        "positions": np.array([s[0] for s in seen]).reshape(-1, 2),
        "velocities": np.array([s[1] for s in seen]).reshape(-1, 2),
        "radii": np.array([s[2] for s in seen]),
        "max_speeds": np.array([s[3] for s in seen]),
    }


def _numbers(value: Any, name: str, width: int) -> Floats:
    """A list of rows of numbers, or of single ones where `width` is 1."""
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.empty(())
    shape = array.shape[1:] if array.size or array.ndim != 1 else (width,) * (width > 1)
    if array.ndim == 0 or shape != (width,) * (width > 1):
        raise ArgumentError(name, repr(value)[:60], f"rows of {width} numbers" if width > 1 else "numbers")
    return array.reshape((-1, width) if width > 1 else -1)


def _whole(value: Any, name: str) -> int:
    if not is_whole(value) or isinstance(value, bool) or not 0 <= int(value) < 2**62:
        raise ArgumentError(name, repr(value)[:60], "a whole number, at least 0")
    return int(value)


def _wholes(ids: Any) -> list[int]:
    try:
        listed = list(ids)
    except TypeError:
        raise ArgumentError("ids", repr(ids)[:60], "whole numbers, one for each neighbour") from None
    return [_whole(k, "ids") for k in listed]


def _mapping(value: Any, name: str) -> dict[str, Any]:
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ArgumentError(name, repr(value)[:60], "numbers by name, in a dict")
    return dict(value)


def _one_each(value: Any, count: int, name: str) -> Any:
    """One for all becomes one for each."""
    if np.ndim(value) > 0:
        return value
    try:
        return np.full(count, value)
    except (TypeError, ValueError):
        raise ArgumentError(name, repr(value)[:60], "one for all neighbours, or one for each") from None


def _pairs(bodies: Any) -> list[tuple[Any, Any]]:
    try:
        return [(shape, velocity) for shape, velocity in bodies]
    except (TypeError, ValueError):
        raise ArgumentError("bodies", repr(bodies)[:60], "pairs of a shape and its velocity") from None


explain_calls(__name__)
