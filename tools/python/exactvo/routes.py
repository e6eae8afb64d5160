# SPDX-License-Identifier: GPL-3.0-or-later
"""From A to B with proof: a route for a disc among obstacles, or what separates it from its goal.

>>> import exactvo
>>> walls = [exactvo.Wall([(0, 0), (0, 4)]), exactvo.Wall([(0, 5), (0, 9)])]        # a door, 1 m wide
>>> route = exactvo.RouteMap(walls, 0.5).route((-2, 2), (2, 2))                     # a gap of two radii is passed
>>> bool(route), route.check()
(True, '')

docs/guide/routes.md has the theory. Everything is in metres.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np

from . import _exactvo
from ._calls import explain_calls
from .errors import ArgumentError
from .shapes import Floats, Obstacles, Point, ShapeLike, obstacles

__all__ = ["Answer", "Certificate", "ChainPoint", "Route", "RouteMap", "RoutePlan", "Unreachable"]

_ExactPoint = tuple[float, float, str, str]


@dataclass(frozen=True)
class Certificate:
    """An answer with its question: all that is needed to check it."""

    obstacles: Obstacles = field(repr=False)
    radius: float  #: m
    start: tuple[float, float]  #: m
    goal: tuple[float, float]  #: m
    answer: tuple[Any, ...] = field(repr=False)

    def check(self) -> str:
        """"" where the answer is proven, else what is wrong with it. Exact: in rationals, by code that shares nothing with
        what found it. Raises `ArgumentError` where a field is not what a certificate has."""
        return _exactvo.check_route(self.obstacles._native, self.radius, self.start, self.goal, self.answer)


@dataclass(frozen=True, eq=False)
class Route:
    """A proven route. `bool(route)` is True."""

    points: Floats  #: n x 2, m, start and goal included; rounded (the certificate holds the exact ones)
    length: float  #: m, rounded
    lower_bound: float  #: m; no route is shorter
    certificate: Certificate

    def check(self) -> str:
        """As `certificate.check()`."""
        return self.certificate.check()

    def __bool__(self) -> bool:
        return True

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        return {"type": "LineString", "coordinates": tuple(map(tuple, self.points.tolist()))}

    def __repr__(self) -> str:
        return f"Route({len(self.points)} points, {self.length:.6g} m, none is shorter than {self.lower_bound:.6g} m)"


@dataclass(frozen=True)
class ChainPoint:
    """A point of the closed chain that separates start from goal, and how it goes on."""

    point: tuple[float, float]  #: m, rounded
    obstacle: int
    edge: int
    gap_follows: bool  #: straight across a gap narrower than two radii; else along the edge


@dataclass(frozen=True)
class Unreachable:
    """No route, proven. `bool(unreachable)` is False."""

    reason: str  #: "separated", "start blocked" or "goal blocked"
    chain: tuple[ChainPoint, ...]  #: separated: the closed chain of edges and gaps between start and goal
    obstacle: int | None  #: blocked: which obstacle is too near
    inside: bool  #: blocked: the end lies inside that polygon
    certificate: Certificate = field(repr=False)

    def check(self) -> str:
        """As `certificate.check()`."""
        return self.certificate.check()

    def __bool__(self) -> bool:
        return False

    @property
    def obstacles(self) -> tuple[int, ...]:
        """Which obstacles take part, ascending."""
        return tuple(sorted({p.obstacle for p in self.chain})) if self.chain else () if self.obstacle is None else (self.obstacle,)

    @property
    def gaps(self) -> tuple[tuple[tuple[float, float], tuple[float, float], float], ...]:
        """The gaps that are too narrow: from, to, and the width in m (rounded)."""
        ends = zip(self.chain, self.chain[1:] + self.chain[:1])
        return tuple(
            (a.point, b.point, float(np.hypot(a.point[0] - b.point[0], a.point[1] - b.point[1]))) for a, b in ends if a.gap_follows
        )


Answer = Union[Route, Unreachable]


class RoutePlan:
    """A map seen by a disc of one radius. Queries may come from many threads."""

    __slots__ = ("_map", "_native")

    def __init__(self, route_map: RouteMap, native: _exactvo.RoutePlan) -> None:
        self._map = route_map
        self._native = native

    @property
    def radius(self) -> float:
        """m."""
        return self._native.radius

    def route(self, start: Point, goal: Point) -> Answer:
        """A `Route` from start to goal (m), or an `Unreachable`; which of the two is exact. Raises `ArgumentError` for a
        point farther out than the map covers, `RouteNotProvenError` for a defect of the library."""
        answer = self._native.query(start, goal)
        certificate = Certificate(
            self._map.obstacles, self.radius, (float(start[0]), float(start[1])), (float(goal[0]), float(goal[1])), answer
        )
        if answer[0] == "route":
            points = np.array([p[:2] for p in answer[1]], dtype=np.float64)
            return Route(points, answer[2], answer[3], certificate)
        if answer[0] == "separated":
            chain = tuple(ChainPoint(p[:2], obstacle, edge, gap) for p, obstacle, edge, gap in answer[1])
            return Unreachable("separated", chain, None, False, certificate)
        _, end, inside, obstacle, _ = answer
        return Unreachable(f"{end} blocked", (), obstacle, inside, certificate)

    def is_reachable(self, start: Point, goal: Point) -> bool:
        """Whether there is a route, without finding one. Exact. Raises `ArgumentError` as `route`."""
        return self._native.is_reachable(start, goal)

    def __reduce__(self) -> tuple[Any, ...]:
        return _planned, (self._map, self.radius)

    def __repr__(self) -> str:
        return f"RoutePlan(radius={self.radius:g}, {self._map!r})"


class RouteMap:
    """Obstacles prepared for every radius. Immutable.

    obstacles         polygons and walls, as `exactvo.obstacles` takes them; they may cross and overlap
    radius            m, of the disc that `route` is for; `plan` takes any other one
    largest_radius    m: radii up to this can be planned for; twice the extent of the obstacles and `radius` always
    largest_distance  m: how far outside of the obstacles starts and goals may lie; four times the extent always

    Raises `ArgumentError`.
    """

    __slots__ = ("_native", "_options", "_plan", "obstacles")

    def __init__(
        self,
        obstacles_: Obstacles | ShapeLike | Sequence[Any],
        radius: float | None = None,
        *,
        largest_radius: float = 0.0,
        largest_distance: float = 0.0,
    ) -> None:
        self.obstacles: Obstacles = obstacles(obstacles_)
        self._options = (radius, largest_radius, largest_distance)
        reach = largest_radius if radius is None or not radius < math.inf else max(largest_radius, radius)
        self._native = _exactvo.RouteMap(self.obstacles._native, reach, largest_distance)
        self._plan = None if radius is None else self.plan(radius)

    @property
    def radius(self) -> float | None:
        """m, of the disc that `route` is for; None where none was given."""
        return None if self._plan is None else self._plan.radius

    def route(self, start: Point, goal: Point) -> Answer:
        """`RoutePlan.route` for the map's radius. Raises `ArgumentError`, also where the map was made without a radius,
        `RouteNotProvenError`."""
        if self._plan is None:
            raise ArgumentError("radius", "None", "RouteMap(obstacles, radius), or plan(radius).route(start, goal)")
        return self._plan.route(start, goal)

    def plan(self, radius: float) -> RoutePlan:
        """The map for a disc of `radius` (m; 0: a point; its ends may touch obstacles). Raises `ArgumentError`."""
        return RoutePlan(self, self._native.plan(radius))

    def widest_radius(self, start: Point, goal: Point) -> float:
        """m: the largest radius for which there is a route, exactly; 0 if there is none for any. Raises `ArgumentError` for a
        point farther out than the map covers."""
        return self._native.widest_radius(start, goal)

    def covers(self, point: Point) -> bool:
        """Whether a start or goal may lie there. Raises `ArgumentError`."""
        return self._native.covers(point)

    @property
    def largest_radius(self) -> float:
        """m."""
        return self._native.largest_radius

    @property
    def vertex_count(self) -> int:
        """Vertices after all crossings have been cut."""
        return self._native.vertex_count

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuilt, (self.obstacles, *self._options)

    def __repr__(self) -> str:
        radius = "" if self._plan is None else f", radius={self._plan.radius:g}"
        return f"RouteMap({self.obstacles!r}{radius})"


def _rebuilt(shapes: Obstacles, radius: float | None, largest_radius: float, largest_distance: float) -> RouteMap:
    return RouteMap(shapes, radius, largest_radius=largest_radius, largest_distance=largest_distance)


def _planned(route_map: RouteMap, radius: float) -> RoutePlan:
    return route_map.plan(radius)


explain_calls(__name__)
