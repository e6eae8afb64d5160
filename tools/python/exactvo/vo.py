# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocity obstacles: which velocities collide, and half-planes that provably do not.

>>> import exactvo
>>> wall = exactvo.vo.VelocityObstacle(exactvo.Segment((4, -3), (4, 3)), position=(0, 0), radius=0.5, time_horizon=2)
>>> wall.contains((3, 0)), wall.contains((1, 0))
(True, False)
>>> wall.half_plane((3, 0)).certificate.check()
'valid'

docs/guide/velocity-obstacles.md has the theory. Positions in m, velocities in m/s, times in s.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls
from .errors import ArgumentError
from .shapes import ConvexShape, Floats, Point, Polygon, ShapeLike, _native_shape, _shape_of, obstacles

__all__ = [
    "Certificate",
    "Comparison",
    "ExactFree",
    "FreeVelocities",
    "HalfPlane",
    "Leg",
    "Legs",
    "LostPiece",
    "NearestBoundary",
    "Piece",
    "VelocityObstacle",
    "free_velocities",
    "reciprocal_half_planes",
    "velocity_obstacles",
]


@dataclass(frozen=True)
class Certificate:
    """The proof of a half-plane as a line of text with hexadecimal floats: it survives files and networks bit for bit."""

    text: str

    def check(self) -> str:
        """"valid", "malformed", "altered" or "wrong margin". Exact: in rationals, with none of the code that made it."""
        return _exactvo.check_certificate(self.text)

    @cached_property
    def claim(self) -> dict[str, Any]:
        """What is claimed: shape, position (m), radius (m), time_horizon (s), obstacle_velocity (m/s), half_plane, and the
        margin (m) by which it holds. Raises `ArgumentError` where the text is no certificate."""
        fields = _exactvo.read_certificate(self.text)
        if fields is None:
            raise ArgumentError("text", repr(self.text[:40]), "a certificate")
        fields["shape"] = _shape_of(fields["shape"])
        fields["half_plane"] = HalfPlane(*fields["half_plane"])
        return fields

    def __repr__(self) -> str:
        return f"Certificate({self.check()}, {self.text[:40]}...)"


@dataclass(frozen=True)
class HalfPlane:
    """{ v : normal . v >= offset }: the allowed side; about, not exactly, of unit normal: do not normalise it again."""

    normal: tuple[float, float]
    offset: float  #: m/s
    certificate: Certificate | None = field(default=None, compare=False)

    def violation(self, velocity: Point) -> float:
        """m/s; how far the velocity lies outside, negative inside. Rounded. Raises `ArgumentError`."""
        return self.offset - self.normal[0] * velocity[0] - self.normal[1] * velocity[1]


@dataclass(frozen=True)
class Leg:
    """One side of the cone."""

    normal: tuple[float, float]  #: outward; certified: { v : normal . v >= 0 } is safe
    normal_outside: tuple[float, float]  #: certified: the true leg's normal lies between the two
    direction: tuple[float, float]  #: of the ray away from the robot, |direction| = 1; rounded
    touch: tuple[float, float]  #: m, the tangent point; rounded


@dataclass(frozen=True)
class Legs:
    """Both sides of the cone, as the robot sees them."""

    left: Leg
    right: Leg


@dataclass(frozen=True)
class NearestBoundary:
    """The point of the velocity obstacle's boundary nearest to a velocity. Rounded."""

    normal: tuple[float, float]  #: outward there
    signed_distance: float  #: m/s; negative inside
    u: tuple[float, float]  #: m/s: the least change of velocity that reaches the boundary (equation (10))
    part: str  #: "left leg", "right leg", "cut-off" or "apex"


class VelocityObstacle:
    """The velocities with which a disc collides with a convex obstacle within a time horizon.

    obstacle            Disc, Segment, Ellipse, n x 2 vertices of a convex polygon, or an object with __geo_interface__
    position            m, of the robot
    radius              m, 0 or more, of the robot
    time_horizon        s, above 0; math.inf for the whole cone
    obstacle_velocity   m/s

    Exact: `overlaps`, `contains`. Certified: `half_plane`, `legs` (a bracket). Rounded: `nearest_boundary`, `distance`.
    Raises `ArgumentError`, also for an obstacle that is not convex (`velocity_obstacles` takes any).
    """

    __slots__ = ("_native", "_arguments")

    def __init__(
        self, obstacle: ShapeLike, *, position: Point, radius: float, time_horizon: float, obstacle_velocity: Point = (0.0, 0.0)
    ) -> None:
        shape = _native_shape(obstacle)
        self._native = _exactvo.Cone(shape, position, radius, time_horizon, obstacle_velocity)
        self._arguments = (
            _shape_of(_exactvo.normalised_shape(shape, "obstacle")),
            (float(position[0]), float(position[1])),
            float(radius),
            float(time_horizon),
            (float(obstacle_velocity[0]), float(obstacle_velocity[1])),
        )

    @property
    def obstacle(self) -> ConvexShape:
        """As it was understood."""
        return self._arguments[0]

    @property
    def position(self) -> tuple[float, float]:
        """m, of the robot."""
        return self._arguments[1]

    @property
    def radius(self) -> float:
        """m, of the robot."""
        return self._arguments[2]

    @property
    def time_horizon(self) -> float:
        """s."""
        return self._arguments[3]

    @property
    def obstacle_velocity(self) -> tuple[float, float]:
        """m/s."""
        return self._arguments[4]

    @property
    def overlaps(self) -> bool:
        """Whether the robot touches or overlaps the obstacle: then there is no velocity obstacle. Exact."""
        return self._native.overlaps()

    @property
    def distance(self) -> float:
        """m, from the robot's rim to the obstacle; negative is the depth of an overlap. Rounded."""
        return self._native.nearest()[1]

    @property
    def legs(self) -> Legs | None:
        """Both sides of the cone; None where the robot overlaps, or is within a few ulps of it."""
        legs = self._native.legs()
        return None if legs is None else Legs(Leg(*legs[0]), Leg(*legs[1]))

    def contains(self, velocity: Point) -> bool:
        """Whether the velocity (m/s) collides within the horizon, boundary included. Exact. Raises `ArgumentError` where the
        robot overlaps the obstacle."""
        return self._native.contains(velocity)

    def contains_many(self, velocities: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """The same for n x 2 velocities. Raises `ArgumentError`."""
        return self._native.contains_many(velocities)

    def nearest_boundary(self, velocity: Point) -> NearestBoundary:
        """The boundary point nearest to the velocity. Raises `ArgumentError` where the robot overlaps the obstacle."""
        return NearestBoundary(*self._native.nearest_boundary(velocity))

    def half_plane(self, velocity: Point, *, responsibility: float = 1.0, certify: bool = True) -> HalfPlane | None:
        """The half-plane of velocities nearest to `velocity` that is disjoint from the velocity obstacle (equation (10)).

        With responsibility 1 it is certified, and carries its certificate (`certify=False` saves the microseconds). Less
        leaves the rest of the change to somebody else and proves nothing alone. None where nothing can be proven: the
        robot overlaps, or is a few ulps from it; see `contact_half_plane`. Raises `ArgumentError`.
        """
        native = self._native.half_plane(velocity, responsibility)
        if native is None:
            return None
        normal, offset = native
        text = self._native.certificate(normal, offset) if certify and responsibility == 1.0 else None
        return HalfPlane(normal, offset, None if text is None else Certificate(text))

    def contact_half_plane(self) -> HalfPlane | None:
        """The half-plane away from the nearest point, for a robot in bare contact; None where it overlaps beyond proof."""
        native = self._native.contact_half_plane()
        return None if native is None else HalfPlane(*native)

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuilt, self._arguments

    def __repr__(self) -> str:
        shape, position, radius, horizon, velocity = self._arguments
        moving = f", obstacle_velocity={velocity}" if velocity != (0.0, 0.0) else ""
        return f"VelocityObstacle({shape!r}, position={position}, radius={radius:g}, time_horizon={horizon:g}{moving})"


def _rebuilt(shape: ConvexShape, position: Point, radius: float, horizon: float, velocity: Point) -> VelocityObstacle:
    given: Any = shape.outer if isinstance(shape, Polygon) else shape
    return VelocityObstacle(given, position=position, radius=radius, time_horizon=horizon, obstacle_velocity=velocity)


def velocity_obstacles(
    obstacle: Any, *, position: Point, radius: float, time_horizon: float, obstacle_velocity: Point = (0.0, 0.0)
) -> list[VelocityObstacle]:
    """The velocity obstacles of any polygon or wall, convex or not, or of several (as `exactvo.obstacles` takes them): one
    for each convex piece of an exact decomposition. A velocity collides with the obstacle iff it lies in one of them.
    Raises `ArgumentError`."""
    pieces = obstacles(obstacle)._native.convex_cover()
    made = []
    for piece in pieces:
        shape = _shape_of(piece)
        given: Any = shape.outer if isinstance(shape, Polygon) else shape
        made.append(
            VelocityObstacle(given, position=position, radius=radius, time_horizon=time_horizon, obstacle_velocity=obstacle_velocity)
        )
    return made


def reciprocal_half_planes(
    position_a: Point,
    velocity_a: Point,
    radius_a: float,
    position_b: Point,
    velocity_b: Point,
    radius_b: float,
    *,
    time_horizon: float = 2.0,
    responsibility_of_a: float = 0.5,
) -> tuple[HalfPlane, HalfPlane, bool]:
    """Robot against robot (ORCA, van den Berg et al. 2011): the half-planes of a and of b, and whether they are certified
    as a pair: two velocities that each satisfy their half do not collide within the horizon (s).
    `responsibility_of_a`: how much of the change a takes, 0 to 1; b takes the rest. m, m/s. Raises `ArgumentError`."""
    a, b, certified = _exactvo.reciprocal_half_planes(
        position_a, velocity_a, radius_a, position_b, velocity_b, radius_b, time_horizon, responsibility_of_a
    )
    return HalfPlane(*a), HalfPlane(*b), certified


@dataclass(frozen=True, eq=False)
class Piece:
    """A connected piece of a region of velocities: rings of n x 2 velocities (m/s), rounded, and a bracket of its area."""

    rings: tuple[Floats, ...]
    area: tuple[float, float]  #: (m/s)^2; certified: low <= area <= high

    def __repr__(self) -> str:
        return f"Piece({sum(map(len, self.rings))} vertices, area={self.area})"


@dataclass(frozen=True, eq=False)
class LostPiece(Piece):
    """Free velocities that half-planes give away."""

    farthest: tuple[float, float] = (math.nan, math.nan)  #: m/s, the corner excluded by most
    half_plane: int = 0  #: which excludes most of it


@dataclass(frozen=True, eq=False)
class Comparison:
    """How an intersection of half-planes compares with the free velocities."""

    inside: str  #: "yes" and "no" are proven; "undecided"
    area: tuple[float, float]  #: (m/s)^2, of the intersection within the speed bound
    given_away: tuple[float, float]  #: (m/s)^2: free velocities that it excludes
    lost: tuple[LostPiece, ...]

    def __repr__(self) -> str:
        return f"Comparison(inside={self.inside!r}, area={self.area}, given_away={self.given_away})"


@dataclass(frozen=True)
class ExactFree:
    """The free velocities in exact arithmetic: how many components they have, and a bracket of their area as narrow as
    doubles allow."""

    components: int
    area: tuple[float, float]  #: (m/s)^2


class FreeVelocities:
    """{ v : |v| <= max_speed } minus the velocity obstacles, held between two regions `inner` and `outer`. See
    `free_velocities`. Raises `ArgumentError`."""

    __slots__ = ("_arguments", "_native")

    def __init__(self, cones: Sequence[VelocityObstacle], *, max_speed: float, relative_tolerance: float = 1e-4) -> None:
        self._arguments = (list(cones), max_speed, relative_tolerance)
        for cone in cones:
            if not isinstance(cone, VelocityObstacle):
                raise ArgumentError("cones", repr(cone)[:60], "VelocityObstacle objects")
        self._native = _exactvo.FreeVelocities([cone._native for cone in cones], max_speed, relative_tolerance)

    def contains(self, velocity: Point) -> bool:
        """Whether the velocity is free. Exact. Raises `ArgumentError`."""
        return self._native.contains(velocity)

    @property
    def area(self) -> tuple[float, float]:
        """(m/s)^2; certified: low <= area <= high."""
        return self._native.area()

    @property
    def least_components(self) -> int:
        """There are at least so many components. Certified."""
        return self._native.least_components()

    @property
    def inner(self) -> tuple[Piece, ...]:
        """Pieces that are free throughout, largest first. Certified but for the rounding of the vertices shown."""
        return tuple(Piece(tuple(rings), area) for rings, area in self._native.inner())

    @property
    def outer(self) -> tuple[Piece, ...]:
        """Pieces beyond which nothing is free."""
        return tuple(Piece(tuple(rings), area) for rings, area in self._native.outer())

    def compare(self, half_planes: Iterable[HalfPlane]) -> Comparison:
        """What half-planes (equation (13)) make of the free velocities: whether all that they allow is free, and what of the
        free ones they give away. Raises `ArgumentError`."""
        listed = list(half_planes)
        for k, half_plane in enumerate(listed):
            if not isinstance(half_plane, HalfPlane):
                raise ArgumentError("half_planes", f"{half_plane!r:.60} at {k}", "HalfPlane objects")
        normals = np.array([h.normal for h in listed], dtype=np.float64).reshape(-1, 2)
        inside, area, given_away, lost = self._native.compare(normals, np.array([h.offset for h in listed], dtype=np.float64))
        pieces = tuple(LostPiece(tuple(rings), bracket, farthest, index) for rings, bracket, farthest, index in lost)
        return Comparison(inside, area, given_away, pieces)

    def exact(self) -> ExactFree:
        """In exact algebraic arithmetic: milliseconds for a few obstacles. Discs, segments and polygons only; raises
        `ArgumentError` with the reason where it cannot be had."""
        answer = _exactvo.exact_free([cone._native for cone in self._arguments[0]], self._arguments[1])
        if isinstance(answer, str):
            raise ArgumentError("cones", f"a scene refused for its {answer}", "what vo/free_arrangement.h takes")
        return ExactFree(*answer)

    def __reduce__(self) -> tuple[Any, ...]:
        return _free_again, self._arguments

    def __repr__(self) -> str:
        low, high = self.area
        return f"FreeVelocities({len(self._arguments[0])} cones, area in [{low:.6g}, {high:.6g}] (m/s)^2)"


def _free_again(cones: list[VelocityObstacle], max_speed: float, relative_tolerance: float) -> FreeVelocities:
    return FreeVelocities(cones, max_speed=max_speed, relative_tolerance=relative_tolerance)


def free_velocities(cones: Sequence[VelocityObstacle], *, max_speed: float, relative_tolerance: float = 1e-4) -> FreeVelocities:
    """What several velocity obstacles leave of the disc of `max_speed` (m/s), between two certified regions that differ by
    at most `relative_tolerance` of it. Raises `ArgumentError`."""
    return FreeVelocities(cones, max_speed=max_speed, relative_tolerance=relative_tolerance)


explain_calls(__name__)
