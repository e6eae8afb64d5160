# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of a command is proven clear, for a control loop (docs/guide/monitor.md).

>>> import exactvo
>>> monitor = exactvo.Monitor([exactvo.Wall([(1, -2), (1, 2)])], radius=0.3, latency=0.1, period=0.1)
>>> verdict = monitor.judge((0, 0, 0), (1.5, 0))
>>> round(verdict.share, 4), verdict.witness.obstacle
(0.6667, 0)
>>> monitor.judge((0, 0, 0), (0.9, 0)).share
1.0
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls
from .errors import ArgumentError
from .shapes import Floats, Obstacles, Point, ShapeLike, obstacles as _obstacles

__all__ = ["Monitor", "MonitorVerdict", "MonitorWitness"]


@dataclass(frozen=True, eq=False)
class MonitorWitness:
    """What ends the clear share."""

    obstacle: int | None  #: its number among the obstacles
    mover: int | None  #: its number among the movers, where it is one
    time: float  #: s, from the effect of the command: when it gets too near, at full share; by a mover at the share tried
    place: Floats  #: 2, m, rounded


@dataclass(frozen=True, eq=False)
class MonitorVerdict:
    """How much of a command or a trajectory is clear."""

    share: float  #: 0 to 1, certified, if `proven`: so much of it, then braking to rest, is clear
    not_above: float  #: certified for obstacles alone: a larger share is not clear; 1 if unknown
    proven: bool  #: False only where not even braking along a trajectory at once is proven clear
    in_contact: bool  #: at the start something touches or overlaps, or may do so
    witness: MonitorWitness | None  #: where share < 1


class Monitor:
    """Says of each command how much of it is proven clear, if the robot keeps it until the next one takes effect and then
    brakes to rest.

    obstacles               what stands still
    radius                  m: of a robot that is a disc; with a footprint, by which that is grown
    footprint               n x 2, m: a simple polygon in the body's axes (x ahead, y left) about the point of its poses
    max_deceleration        m/s^2: deceleration that the robot always reaches
    max_turn_deceleration   rad/s^2: angular deceleration that it always reaches
    latency, period         s: from a decision to its effect, and to the next decision
    margin                  m: largest total error of localisation, map and drive

    Raises `ArgumentError`.
    """

    __slots__ = ("_native",)

    def __init__(
        self,
        obstacles: Obstacles | ShapeLike | Sequence[Any] = (),
        *,
        radius: float = 0.0,
        footprint: npt.ArrayLike | None = None,
        max_deceleration: float = 1.0,
        max_turn_deceleration: float = 2.0,
        latency: float = 0.1,
        period: float = 0.1,
        margin: float = 0.0,
    ) -> None:
        self._native = _exactvo.monitor(
            _obstacles(obstacles)._native, radius, footprint, max_deceleration, max_turn_deceleration, latency, period, margin
        )

    def judge(
        self,
        pose: npt.ArrayLike,
        velocity: Point,
        turn: float = 0.0,
        *,
        frame: str = "body",
        positions: npt.ArrayLike = (),
        radii: npt.ArrayLike = 0.3,
        max_speeds: npt.ArrayLike = 1.5,
        position_errors: npt.ArrayLike = 0.0,
    ) -> MonitorVerdict:
        """Of a command, from the pose (x, y, heading; m and rad) on at which it takes effect. Releases the interpreter's
        lock.

        velocity, turn   m/s and rad/s
        frame            "body": the velocity is (ahead, left); "world": it is (x, y), and the heading stays (turn 0)
        positions        n x 2, m, of movers, which are discs; none by default
        radii            m, one for all movers or one for each; so `max_speeds` (m/s) and `position_errors` (m)

        Raises `ArgumentError`; the monitor is then as it was.
        """
        if frame not in ("body", "world"):
            raise ArgumentError("frame", repr(frame)[:60], "body or world")
        movers = _movers(positions, radii, max_speeds, position_errors)
        return _verdict(self._native.judge(pose, velocity, turn, frame == "world", *movers))

    def judge_trajectory(
        self,
        poses: npt.ArrayLike,
        *,
        positions: npt.ArrayLike = (),
        radii: npt.ArrayLike = 0.3,
        max_speeds: npt.ArrayLike = 1.5,
        position_errors: npt.ArrayLike = 0.0,
    ) -> MonitorVerdict:
        """Of a trajectory, n x 4: time (s, rising), x, y (m), heading (rad). The robot is at its first pose; between two
        poses it drives and turns evenly. `share` of its duration may be followed before the robot brakes along the rest.

        The movers are those of `judge`. Raises `ArgumentError`.
        """
        return _verdict(self._native.judge_trajectory(poses, *_movers(positions, radii, max_speeds, position_errors)))


def _movers(positions: npt.ArrayLike, *others: npt.ArrayLike) -> tuple[Any, ...]:
    at = np.asarray(positions, dtype=np.float64).reshape(-1, 2) if np.size(positions) == 0 else positions
    count = len(np.atleast_1d(np.asarray(at)))
    names = ("radii", "max_speeds", "position_errors")
    return (at, *(_one_each(value, count, name) for value, name in zip(others, names)))


def _one_each(value: Any, count: int, name: str) -> Any:
    if np.ndim(value) > 0:
        return value
    try:
        return np.full(count, value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(name, repr(value)[:60], "one for all movers, or one for each") from None


def _verdict(fields: tuple[Any, ...]) -> MonitorVerdict:
    share, not_above, proven, in_contact, found = fields
    witness = None
    if found is not None:
        is_mover, index, time, place = found
        witness = MonitorWitness(None if is_mover else index, index if is_mover else None, time, np.array(place))
    return MonitorVerdict(share, not_above, proven, in_contact, witness)


explain_calls(__name__)
