# SPDX-License-Identifier: GPL-3.0-or-later
"""Many robots, one step at a time: reciprocal collision avoidance, every step certified (docs/guide/crowd.md).

>>> import numpy as np, exactvo
>>> crowd = exactvo.Crowd(time_step=0.25)
>>> ids = crowd.add_robots([(0, 0), (10, 0)], radius=0.5, max_speed=1.5)
>>> crowd.head_for([(10, 0), (0, 0)])
>>> crowd.step(40).relaxed
0
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from operator import index
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls, is_number, is_whole
from .errors import ArgumentError, CrowdError
from .shapes import Floats, Obstacles, Point, ShapeLike, obstacles
from .vo import HalfPlane

__all__ = ["Crowd", "EdgeHalfPlane", "Explanation", "NeighbourHalfPlane", "RobotKind", "StepReport"]


@dataclass(frozen=True)
class RobotKind:
    """What robots of a kind have in common. Raises `ArgumentError`; `Crowd.add_kind` refuses numbers out of range."""

    radius: float = 0.5  #: m, above 0
    max_speed: float = 1.5  #: m/s
    time_horizon: float = 5.0  #: s, at least the time step
    neighbour_distance: float = 15.0  #: m
    neighbours: int = 10  #: 1 to 15: the nearest within the distance, and all that could be met within a step

    def __post_init__(self) -> None:
        for name in ("radius", "max_speed", "time_horizon", "neighbour_distance"):
            if not is_number(getattr(self, name)):
                raise ArgumentError(name, repr(getattr(self, name))[:60], "a number")
        if not is_whole(self.neighbours):
            raise ArgumentError("neighbours", repr(self.neighbours)[:60], "a whole number")


class StepReport(NamedTuple):
    """What happened; counts are added up over the steps of one call."""

    robots: int
    neighbours: int  #: half-planes made between robots
    relaxed: int  #: robots whose wish violates half-planes, since these contradict each other
    cut_short: int  #: robots that do not get their wish, since they would meet another within the step
    overlapping: int  #: robots that overlapped another at the beginning of the step: 0 after a legal start
    touching: int  #: robots that touched another at the beginning of the step
    widened: int  #: robots that took more neighbours than their kind has
    edges: int  #: half-planes made against edges of obstacles
    stopped: int  #: robots that stay, since nothing else was found that leads onto no edge
    nudged: int  #: kept robots whose velocity was rounded to another place of the lattice


@dataclass(frozen=True)
class NeighbourHalfPlane:
    """What one neighbour asks of a robot."""

    robot: int
    half_plane: HalfPlane
    touching: bool  #: they touch


@dataclass(frozen=True)
class EdgeHalfPlane:
    """What one edge of an obstacle asks of a robot."""

    a: tuple[float, float]  #: m
    b: tuple[float, float]
    half_plane: HalfPlane
    touching: bool


@dataclass(frozen=True)
class Explanation:
    """One robot's next decision."""

    robot: int
    position: tuple[float, float]  #: m, exact
    velocity: tuple[float, float]  #: m/s, now
    preferred: tuple[float, float]  #: m/s
    wish: tuple[float, float]  #: m/s: the answer to the half-planes below
    chosen: tuple[float, float]  #: m/s: what `step` will choose: the wish, unless another would be met within the step
    kept: bool
    widened: bool
    neighbours: tuple[NeighbourHalfPlane, ...]  #: nearest first
    edges: tuple[EdgeHalfPlane, ...]


class Crowd:
    """Robots that avoid each other and obstacles.

    time_step       s
    precision       "float" or "double": the arithmetic of half-planes; both are certified
    position_step   m, a power of two: positions are whole multiples of it
    certified       False rounds to nearest and promises nothing; for comparison
    threads         0: as many as there are; the same bits with any number

    `positions`, `velocities` and `kept` are read-only views of arrays that the crowd owns and `step` fills in place: nothing
    is copied, and a view shows every later step (take a `.copy()` to keep one). They have a row for each id from 0 on;
    rows of ids that name nobody are NaN. Adding robots may move the arrays: take the views again then.

    Two robots that are kept in a step and did not touch before it are apart at every moment of it. A call that is refused
    leaves the crowd as it was. One thread at a time may use a crowd (`ArgumentError` else). Raises `ArgumentError`,
    `CrowdError`.
    """

    __slots__ = ("_kinds", "_native", "_threads")

    def __init__(
        self,
        *,
        time_step: float = 0.25,
        precision: str = "float",
        position_step: float = 2.0**-18,
        certified: bool = True,
        threads: int = 1,
    ) -> None:
        self._native = _exactvo.Crowd(time_step, position_step, precision, certified, threads)
        self._threads = threads
        self._kinds: dict[RobotKind, int] = {}

    def add_kind(self, kind: RobotKind) -> int:
        """The number of the kind, for `add_robots(kind=...)`; the same kind has one number. Raises `ArgumentError`,
        `CrowdError`."""
        if kind not in self._kinds:
            neighbours = min(index(kind.neighbours), 2**31 - 1)
            self._kinds[kind] = self._native.add_kind(
                kind.radius, kind.max_speed, kind.time_horizon, kind.neighbour_distance, max(neighbours, -1)
            )
        return self._kinds[kind]

    def kind_of(self, robot: int) -> RobotKind:
        """The kind of a robot. Raises `ArgumentError`, `CrowdError`."""
        return RobotKind(*self._native.kind(self._native.kind_of(index(robot))))

    def _kind(self, kind: int | RobotKind | None, options: dict[str, Any]) -> int:
        if isinstance(kind, (int, np.integer)):
            if options:
                raise ArgumentError("kind", f"the number of a kind beside {', '.join(options)}", "one or the other")
            return index(kind)
        return self.add_kind(RobotKind(**options) if kind is None else kind)

    def add_robot(self, position: Point, *, kind: int | RobotKind | None = None, **options: Any) -> int:
        """A robot at rest at `position` (m); its id. `kind`, or the fields of `RobotKind` as options: radius=0.3, ... Raises
        `ArgumentError`, `CrowdError`."""
        return self._native.add_robot(position, self._kind(kind, options))

    def add_robots(self, positions: npt.ArrayLike, *, kind: int | RobotKind | None = None, **options: Any) -> npt.NDArray[np.uint32]:
        """Robots at rest at n x 2 positions (m); their ids. All or none. Raises `ArgumentError`, `CrowdError`."""
        return self._native.add_robots(positions, self._kind(kind, options))

    def remove_robot(self, robot: int) -> None:
        """Its id may be given to another robot later. Raises `ArgumentError`, `CrowdError`."""
        self._native.remove_robot(index(robot))

    def add_obstacles(self, shapes: Obstacles | ShapeLike | Sequence[Any]) -> list[int]:
        """Polygons and walls, as `exactvo.obstacles` takes them; their edges are walls seen from both sides. Their ids.
        Raises `ArgumentError`, `CrowdError`."""
        return self._native.add_obstacles(obstacles(shapes)._native)

    def remove_obstacle(self, obstacle: int) -> None:
        """Removes an obstacle by its id. Raises `ArgumentError`, `CrowdError`."""
        if not 0 <= index(obstacle) < 2**32:
            raise CrowdError("unknown-obstacle", f"no obstacle has the id {obstacle}")
        self._native.remove_obstacle(index(obstacle))

    def head_for(self, goals: npt.ArrayLike, *, speed: float = math.inf) -> None:
        """From now on each robot prefers to go straight for its goal: an n x 2 array (m) by id, a NaN row stands. `speed` in
        m/s, at most the kind's. `preferred` is not read any more; `follow_preferred` goes back to it. Raises `ArgumentError`."""
        self._native.head_for(goals, speed)

    def follow_preferred(self) -> None:
        """From now on robots prefer what `preferred` says: the default."""
        self._native.follow_preferred()

    @property
    def preferred(self) -> Floats:
        """n x 2, m/s, by id, to be written: crowd.preferred[:] = ... Assigning raises `ArgumentError` for another shape."""
        return self._native.preferred

    @preferred.setter
    def preferred(self, velocities: npt.ArrayLike) -> None:
        try:
            self._native.preferred[:] = velocities
        except (TypeError, ValueError):
            expected = f"an array of numbers of shape {self._native.preferred.shape}, or one velocity for all"
            raise ArgumentError("preferred", repr(velocities)[:60], expected) from None

    @property
    def positions(self) -> Floats:
        """n x 2, m, by id; exact. A read-only view."""
        return self._native.positions

    @property
    def velocities(self) -> Floats:
        """n x 2, m/s, by id. A read-only view."""
        return self._native.velocities

    @property
    def kept(self) -> npt.NDArray[np.bool_]:
        """n, by id: whether the robot was kept in the last step. A read-only view."""
        return self._native.kept

    def step(self, count: int = 1) -> StepReport:
        """Decides for all robots and moves them, `count` times. Releases the interpreter's lock. Raises `CrowdError` where two
        robots are in one place, one leaves the lattice or a preferred velocity is not finite, `ArgumentError`."""
        if count < 0:
            raise CrowdError("out-of-range", f"a crowd cannot make {count} steps")
        return StepReport(*self._native.step(count))

    @property
    def time(self) -> float:
        """s since the beginning."""
        return self._native.steps * self._native.time_step

    @property
    def time_step(self) -> float:
        """s."""
        return self._native.time_step

    def explain(self, robot: int) -> Explanation:
        """What the robot will choose in the next step, and each half-plane behind it. Call `step` or `step(0)` first where
        `preferred` has been written. Raises `ArgumentError`, `CrowdError`."""
        told = self._native.explain(index(robot))
        told["neighbours"] = tuple(NeighbourHalfPlane(r, HalfPlane(*h), t) for r, h, t in told["neighbours"])
        told["edges"] = tuple(EdgeHalfPlane(a, b, HalfPlane(*h), t) for a, b, h, t in told["edges"])
        return Explanation(**told)

    @property
    def digest(self) -> int:
        """Of positions, motions and kinds by id, to compare runs."""
        return self._native.digest

    def snapshot(self) -> bytes:
        """All but goals; a crowd that was restored from it goes on with the same bits."""
        return self._native.snapshot()

    @staticmethod
    def restored(snapshot: bytes, *, threads: int = 1) -> Crowd:
        """From `snapshot`. Raises `CrowdError` ("bad-snapshot"), `ArgumentError`."""
        crowd = object.__new__(Crowd)
        crowd._native = _exactvo.Crowd.restored(snapshot, threads)
        crowd._threads = threads
        crowd._kinds = {}
        return crowd

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.snapshot(), self._threads, self._native.steps, self._kinds, self.preferred.copy())

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self) -> str:
        return f"Crowd({len(self)} robots, {self.time:g} s)"


def _restored(snapshot: bytes, threads: int, steps: int, kinds: dict[RobotKind, int], preferred: Floats) -> Crowd:
    crowd = Crowd.restored(snapshot, threads=threads)
    crowd._native.set_steps(steps)
    crowd._kinds = dict(kinds)
    crowd.preferred[:] = preferred
    return crowd


explain_calls(__name__)
