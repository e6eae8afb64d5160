# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes: what obstacles are made of. Metres throughout.

A convex shape, for a velocity obstacle, is a `Disc`, a `Segment`, an `Ellipse`, an n x 2 array of a convex polygon's
vertices, or anything with ``__geo_interface__`` (shapely). Obstacles, for routes, crowds and files, are an `Obstacles`,
or a sequence of arrays (n x 2: a polygon; `Wall(points)`: an open chain), of ``__geo_interface__`` objects, or of both.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, Union, runtime_checkable

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls
from .errors import ArgumentError

__all__ = ["ConvexShape", "Disc", "Ellipse", "Obstacles", "Point", "Polygon", "Segment", "ShapeLike", "Wall", "hull", "obstacles"]

Floats = npt.NDArray[np.float64]
#: Two numbers: (x, y) in m, or a velocity in m/s.
Point = Union[tuple[float, float], Sequence[float], Floats]


@runtime_checkable
class GeoInterface(Protocol):
    """Anything with ``__geo_interface__``: shapely, geopandas rows, fiona."""

    @property
    def __geo_interface__(self) -> dict[str, Any]: ...


@dataclass(frozen=True)
class Disc:
    """{ x : |x - center| <= radius }; radius in m, 0 or more."""

    center: tuple[float, float]
    radius: float


@dataclass(frozen=True)
class Segment:
    """The segment from `a` to `b`: a wall, seen from both sides. `a == b` is a point."""

    a: tuple[float, float]
    b: tuple[float, float]

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        return {"type": "LineString", "coordinates": (tuple(self.a), tuple(self.b))}


@dataclass(frozen=True)
class Ellipse:
    """{ center + L w : |w| <= 1 } with L = [[l11, 0], [l21, l22]], exactly as given; m."""

    center: tuple[float, float]
    l11: float
    l21: float
    l22: float

    @staticmethod
    def from_axes(center: Point, *, a: float, b: float, angle: float = 0.0) -> Ellipse:
        """From semi-axes a >= b >= 0 (m) and the angle of the first (rad). Rounded to some ulps. Raises `ArgumentError`."""
        _, c, l = _exactvo.ellipse_from_axes(center, a, b, angle)
        return Ellipse(c, *l)

    @property
    def axes(self) -> tuple[float, float, float]:
        """Semi-axes a >= b (m) and the angle of the first (rad, in (-pi/2, pi/2]). Rounded. Raises `ArgumentError` where the
        fields are no finite numbers."""
        return _exactvo.axes_of(_native_shape(self))


@dataclass(frozen=True, eq=False, init=False)
class Polygon:
    """A polygon with holes: rings as n x 2 arrays (m), the outer one counter-clockwise, first points not repeated. Raises
    `ArgumentError` where they are no arrays of numbers."""

    outer: Floats
    holes: tuple[Floats, ...]

    def __init__(self, outer: npt.ArrayLike, holes: Sequence[npt.ArrayLike] = ()) -> None:
        object.__setattr__(self, "outer", np.asarray(outer, dtype=np.float64))
        try:
            object.__setattr__(self, "holes", tuple(np.asarray(hole, dtype=np.float64) for hole in holes))
        except (TypeError, ValueError):
            raise ArgumentError("holes", repr(holes)[:60], "a sequence of n x 2 arrays") from None

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        return {"type": "Polygon", "coordinates": tuple(_closed(ring) for ring in (self.outer, *self.holes))}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Polygon):
            return NotImplemented
        return len(self.holes) == len(other.holes) and all(np.array_equal(a, b) for a, b in zip((self.outer, *self.holes), (other.outer, *other.holes)))

    def __repr__(self) -> str:
        holes = f", {len(self.holes)} holes" if self.holes else ""
        return f"Polygon({len(self.outer)} vertices{holes})"


@dataclass(frozen=True, eq=False, init=False)
class Wall:
    """An open chain of segments, seen from both sides; n x 2 points (m), at least two. Raises `ArgumentError` where they are
    no array of numbers."""

    points: Floats

    def __init__(self, points: npt.ArrayLike) -> None:
        object.__setattr__(self, "points", np.asarray(points, dtype=np.float64))

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        return {"type": "LineString", "coordinates": tuple(map(tuple, self.points.tolist()))}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Wall):
            return NotImplemented
        return np.array_equal(self.points, other.points)

    def __repr__(self) -> str:
        return f"Wall({len(self.points)} points)"


ConvexShape = Union[Disc, Segment, Ellipse, Polygon]
#: What is taken for a shape.
ShapeLike = Union[ConvexShape, Wall, npt.ArrayLike, GeoInterface]


def _closed(ring: Floats) -> tuple[tuple[float, ...], ...]:
    points = [tuple(p) for p in ring.tolist()]
    return tuple(points + points[:1])


def _geo(shape: object) -> dict[str, Any] | None:
    geo = getattr(shape, "__geo_interface__", None)
    if geo is None:
        return None
    if geo.get("type") == "Feature":
        geo = geo["geometry"]
    return dict(geo)


def _xy(coordinates: Any) -> Floats:
    array = np.asarray([tuple(p)[:2] for p in coordinates], dtype=np.float64)
    return array.reshape(-1, 2)


def _native_shape(shape: object, name: str = "obstacle") -> tuple[Any, ...]:
    """The tuple that the extension takes for a convex shape."""
    if isinstance(shape, Disc):
        return ("disc", shape.center, shape.radius)
    if isinstance(shape, Segment):
        return ("segment", shape.a, shape.b)
    if isinstance(shape, Ellipse):
        return ("ellipse", shape.center, (shape.l11, shape.l21, shape.l22))
    if isinstance(shape, str):
        raise ArgumentError(name, repr(shape), "a Disc, Segment, Ellipse, n x 2 array or an object with __geo_interface__")
    geo = _geo(shape)
    if geo is None:
        return ("polygon", shape)
    kind, coordinates = geo["type"], geo.get("coordinates", ())
    if kind == "Point":
        return ("segment", tuple(coordinates)[:2], tuple(coordinates)[:2])
    if kind in ("LineString", "LinearRing") and len(coordinates) == 2:
        return ("segment", tuple(coordinates[0])[:2], tuple(coordinates[1])[:2])
    if kind == "Polygon" and len(coordinates) == 1:
        return ("polygon", _xy(coordinates[0]))
    what = f"a {kind}" + (" with holes" if kind == "Polygon" and len(coordinates) > 1 else "")
    if kind == "LineString":
        what = f"a LineString of {len(coordinates)} points"
    raise ArgumentError(
        name, what, "a convex shape; velocity_obstacles() takes any obstacle, decomposing it exactly, and hull() encloses it"
    )


def _shape_of(native: tuple[Any, ...]) -> ConvexShape:
    kind = native[0]
    if kind == "disc":
        return Disc(native[1], native[2])
    if kind == "segment":
        return Segment(native[1], native[2])
    if kind == "ellipse":
        return Ellipse(native[1], *native[2])
    return Polygon(native[1])


def hull(points: npt.ArrayLike) -> ConvexShape:
    """The convex hull of n x 2 points (m): a `Polygon`, counter-clockwise, or where it is flat a `Segment`. Exact. Raises
    `ArgumentError`."""
    return _shape_of(_exactvo.hull(points))


@dataclass(frozen=True)
class _Rings:
    rings: tuple[Floats, ...]
    is_polygon: bool


def _rings(shape: object, name: str) -> list[_Rings]:
    """One obstacle as given, or several: Multi... and GeometryCollection."""
    if isinstance(shape, Segment):
        return [_Rings((np.array([shape.a, shape.b], dtype=np.float64),), False)]
    if isinstance(shape, (Disc, Ellipse)):
        raise ArgumentError(name, type(shape).__name__, "a polygon or a wall: curved obstacles are for velocity obstacles alone")
    geo = _geo(shape)
    if geo is None:
        try:
            array = np.asarray(shape, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.empty(0)
        if array.ndim != 2 or array.shape[1] != 2 or isinstance(shape, str):
            raise ArgumentError(name, repr(shape)[:60], "an n x 2 array of a polygon's vertices, Wall(points), or an object with __geo_interface__")
        return [_Rings((array,), True)]
    return _geo_rings(geo, name)


def _geo_rings(geo: dict[str, Any], name: str) -> list[_Rings]:
    kind, coordinates = geo["type"], geo.get("coordinates", ())
    if kind == "Polygon":
        return [_Rings(tuple(_xy(ring) for ring in coordinates), True)]
    if kind in ("LineString", "LinearRing"):
        return [_Rings((_xy(coordinates),), False)]
    if kind == "MultiPolygon":
        return [_Rings(tuple(_xy(ring) for ring in rings), True) for rings in coordinates]
    if kind == "MultiLineString":
        return [_Rings((_xy(line),), False) for line in coordinates]
    if kind == "GeometryCollection":
        return [rings for member in geo["geometries"] for rings in _geo_rings(member, name)]
    raise ArgumentError(name, f"a {kind}", "polygons or lines: a point is no obstacle")


def _offsets(counts: Sequence[int]) -> npt.NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]).astype(np.int64)


@dataclass(frozen=True, eq=False)
class Obstacles(Sequence[Union[Polygon, Wall]]):
    """Obstacles as ragged arrays, as shapely 2 and GeoArrow hold them. Immutable; a sequence of `Polygon` and `Wall`.

    Ring r consists of ``coordinates[ring_offsets[r]:ring_offsets[r + 1]]`` (n x 2, m), obstacle k of the rings
    ``obstacle_offsets[k]`` to ``obstacle_offsets[k + 1]``, the outer one first. Outer rings run counter-clockwise, holes
    clockwise, no first point is repeated. Raises `ArgumentError` for a ring that crosses itself, naming the obstacle.
    """

    coordinates: Floats
    ring_offsets: npt.NDArray[np.int64]
    obstacle_offsets: npt.NDArray[np.int64]
    is_polygon: npt.NDArray[np.bool_]
    ids: tuple[str, ...] = ()
    _native: _exactvo.Obstacles = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        count = len(self.obstacle_offsets) - 1
        ids = list(self.ids) if self.ids else [str(k) for k in range(count)]
        self._take(_exactvo.Obstacles(self.coordinates, self.ring_offsets, self.obstacle_offsets, self.is_polygon, ids))

    def _take(self, native: _exactvo.Obstacles) -> None:
        ragged = native.ragged()
        for name in ("coordinates", "ring_offsets", "obstacle_offsets", "is_polygon"):
            array = ragged[name]
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        object.__setattr__(self, "ids", tuple(ragged["ids"]))
        object.__setattr__(self, "_native", native)

    @staticmethod
    def _of(native: _exactvo.Obstacles) -> Obstacles:
        made = object.__new__(Obstacles)
        made._take(native)
        return made

    def __len__(self) -> int:
        return len(self.obstacle_offsets) - 1

    def __getitem__(self, k: Any) -> Any:
        if isinstance(k, slice):
            return [self[i] for i in range(*k.indices(len(self)))]
        k = range(len(self))[k]
        first, last = int(self.obstacle_offsets[k]), int(self.obstacle_offsets[k + 1])
        rings = [self.coordinates[self.ring_offsets[r] : self.ring_offsets[r + 1]] for r in range(first, last)]
        return Polygon(rings[0], tuple(rings[1:])) if self.is_polygon[k] else Wall(rings[0])

    def __iter__(self) -> Iterator[Polygon | Wall]:
        return (self[k] for k in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Obstacles):
            return NotImplemented
        names = ("coordinates", "ring_offsets", "obstacle_offsets", "is_polygon")
        return self.ids == other.ids and all(np.array_equal(getattr(self, n), getattr(other, n)) for n in names)

    def __repr__(self) -> str:
        walls = len(self) - int(np.count_nonzero(self.is_polygon))
        return f"Obstacles({len(self) - walls} polygons, {walls} walls, {len(self.coordinates)} vertices)"

    def __reduce__(self) -> tuple[Any, ...]:
        return Obstacles, (self.coordinates, self.ring_offsets, self.obstacle_offsets, self.is_polygon, self.ids)

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        return {"type": "GeometryCollection", "geometries": [shape.__geo_interface__ for shape in self]}

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """min x, min y, max x, max y in m; NaN where there is no obstacle."""
        if len(self.coordinates) == 0:
            return (math.nan,) * 4
        low, high = self.coordinates.min(axis=0), self.coordinates.max(axis=0)
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _is_list_of_points(shapes: Any) -> bool:
    """Whether they are pairs of numbers: one polygon's vertices rather than several obstacles."""
    try:
        x, y = shapes[0]
        return not np.ndim(x) and not np.ndim(y) and not isinstance(x, str) and float(x) == x
    except (TypeError, ValueError, IndexError, KeyError):
        return False


def obstacles(shapes: Obstacles | ShapeLike | Sequence[Any], *, ids: Sequence[str] | None = None) -> Obstacles:
    """`Obstacles` of one shape or a sequence of shapes (module docstring). Several polygons of one Multi... become several
    obstacles. Winding, closing points and repeated vertices are repaired, exactly; what crosses itself is refused
    (`exactvo.datasets.repair` cuts it). Raises `ArgumentError` naming the obstacle."""
    if isinstance(shapes, Obstacles):
        return shapes if ids is None else Obstacles(
            shapes.coordinates, shapes.ring_offsets, shapes.obstacle_offsets, shapes.is_polygon, tuple(ids)
        )
    is_one = isinstance(shapes, (Segment, Wall, Polygon, Disc, Ellipse)) or _geo(shapes) is not None
    is_one = is_one or _is_list_of_points(shapes)
    if isinstance(shapes, str):
        raise ArgumentError("obstacles", repr(shapes), "shapes; exactvo.datasets.read(path) reads a file")
    try:
        members: list[Any] = [shapes] if is_one else list(shapes)  # type: ignore[arg-type]
    except TypeError:
        raise ArgumentError("obstacles", repr(shapes)[:60], "a shape or a sequence of shapes") from None
    all_rings = [rings for k, shape in enumerate(members) for rings in _rings(shape, f"obstacle {k}")]
    flat = [ring for rings in all_rings for ring in rings.rings]
    return Obstacles(
        np.concatenate(flat) if flat else np.empty((0, 2)),
        _offsets([len(ring) for ring in flat]),
        _offsets([len(rings.rings) for rings in all_rings]),
        np.array([rings.is_polygon for rings in all_rings], dtype=np.bool_),
        tuple(ids) if ids is not None else (),
    )


explain_calls(__name__)
