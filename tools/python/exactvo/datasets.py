# SPDX-License-Identifier: GPL-3.0-or-later
"""Obstacles from files of many formats, repaired, converted, generated, processed in batches (docs/guide/obstacle-formats.md).

>>> import exactvo
>>> floor = exactvo.datasets.read("floor.geojson")        # doctest: +SKIP
>>> plan = exactvo.RouteMap(floor.obstacles).plan(0.4)    # doctest: +SKIP
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls, is_whole
from .errors import ArgumentError, DataError
from .shapes import Obstacles, Polygon, ShapeLike, _geo, _geo_rings, obstacles

__all__ = [
    "BatchSummary",
    "Finding",
    "ObstacleFile",
    "Repair",
    "Tally",
    "batch",
    "convert",
    "generate",
    "parse_wkt",
    "read",
    "readable_formats",
    "repair",
    "writable_formats",
    "write",
]

PathLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Finding:
    """A problem of a ring, repaired or not; `code` as in docs/guide/codes.md."""

    code: str
    place: str  #: "feature 3, ring 0, vertex 17"
    where: tuple[float, float]  #: m
    ring: int
    vertex: int
    repaired: bool
    words: str
    in_file: tuple[tuple[float, float], bool] | None = None  #: as the file writes it, and whether that is in degrees

    def __str__(self) -> str:
        return f"{self.place}: {self.words} [{self.code}]"


@dataclass(frozen=True, eq=False)
class ObstacleFile:
    """What a file holds. `len`, iteration and indices are those of its obstacles."""

    file: str
    format: str
    obstacles: Obstacles
    properties: tuple[dict[str, Any], ...]  #: one per obstacle; none where no feature has any
    notes: tuple[str, ...]  #: how units were decided, what was skipped
    findings: tuple[Finding, ...]
    rejected: tuple[DataError, ...]  #: with skip_invalid
    counts: dict[str, int]
    origin: tuple[float, float] | None  #: longitude and latitude that became (0, 0), degrees
    _context: Any = field(repr=False, default=None)

    def __len__(self) -> int:
        return len(self.obstacles)

    def __iter__(self) -> Any:
        return iter(self.obstacles)

    def __getitem__(self, k: Any) -> Any:
        return self.obstacles[k]

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        return self.obstacles.__geo_interface__

    def __repr__(self) -> str:
        rejected = f", {len(self.rejected)} rejected" if self.rejected else ""
        return f"ObstacleFile({self.file!r}, {self.format}, {self.obstacles!r}{rejected})"

    def __reduce__(self) -> tuple[Any, ...]:
        fields = (self.file, self.format, self.obstacles, self.properties, self.notes, self.findings, self.rejected)
        return ObstacleFile, (*fields, self.counts, self.origin)


def _file(native: dict[str, Any]) -> ObstacleFile:
    return ObstacleFile(
        native["file"],
        native["format"],
        Obstacles._of(native["obstacles"]),
        tuple(json.loads(text) if text else {} for text in native["properties"]),
        tuple(native["notes"]),
        tuple(Finding(*fields) for fields in native["findings"]),
        tuple(DataError(*fields) for fields in native["rejected"]),
        native["counts"],
        native["origin"],
        native["context"],
    )


def read(
    path: PathLike,
    *,
    format: str | None = None,
    units: str = "automatic",
    unknown: str = "free",
    cell_size: float = 0.0,
    skip_invalid: bool = False,
    repair: bool = False,
) -> ObstacleFile:
    """The obstacles of a file, in metres, every ring simple: WKT, GeoJSON, Shapefile, ROS maps, SUMO, Menge, JuPedSim, ...

    format         one of `readable_formats()`; else by content and extension
    units          "automatic" (as the file says), "metres" or "degrees"
    unknown        what unknown cells of ROS maps are: "free" or "blocked"
    cell_size      m: side of a grid's cell where the file does not say; 0: 1 m, scans 0.05 m
    skip_invalid   put what cannot be used into `rejected` instead of raising at the first
    repair         cut what crosses itself, exactly (docs/guide/codes.md)

    Raises `DataError` with the feature, ring and vertex, `MissingFileError`, `ArgumentError`.
    """
    return _file(_exactvo.read_obstacles(os.fspath(path), format, units, unknown, cell_size, skip_invalid, repair))


def parse_wkt(text: str, *, repair: bool = False) -> ObstacleFile:
    """The same for WKT text: one geometry per line, m. Raises `DataError`, `ArgumentError`."""
    return _file(_exactvo.parse_wkt(text, repair))


def write(
    path: PathLike,
    obstacles_: ObstacleFile | Obstacles | ShapeLike | Sequence[Any],
    *,
    format: str | None = None,
    metres: bool = False,
) -> list[str]:
    """Writes obstacles, whole or not at all; returns what the format could not hold, in words.

    format    one of `writable_formats()`; else by the extension
    metres    GeoJSON in metres, for this project alone; else longitude and latitude

    What `read` gave keeps its properties and its place on earth. Raises `DataError`, `ArgumentError`.
    """
    is_file = isinstance(obstacles_, ObstacleFile)
    listed = obstacles_.obstacles if isinstance(obstacles_, ObstacleFile) else obstacles(obstacles_)
    context = obstacles_._context if is_file and isinstance(obstacles_, ObstacleFile) else None
    return _exactvo.write_obstacles(os.fspath(path), listed._native, context, format, metres)


def convert(
    source: PathLike,
    target: PathLike,
    *,
    format: str | None = None,
    units: str = "automatic",
    unknown: str = "free",
    target_format: str | None = None,
    skip_invalid: bool = False,
    repair: bool = False,
    metres: bool = False,
) -> list[str]:
    """Reads `source` and writes `target`, as `exactvo convert`: `read` and `write` have the options. Returns what is lost.
    Raises `DataError`, `MissingFileError`, `ArgumentError`."""
    content = read(source, format=format, units=units, unknown=unknown, skip_invalid=skip_invalid, repair=repair)
    return write(target, content, format=target_format, metres=metres)


@dataclass(frozen=True)
class Repair:
    """What became of a polygon. `refused` is "" or the code of why nothing could be made of it."""

    polygons: tuple[Polygon, ...]
    problems: tuple[Finding, ...]  #: of the rings as given
    refused: str
    recombined: bool  #: by the even-odd rule
    moved: float  #: m: how far rounding moved a crossing, at most
    before: dict[str, float]  #: polygons, rings, vertices, area (m^2)
    after: dict[str, float]

    def __bool__(self) -> bool:
        return not self.refused


def repair(polygon: npt.ArrayLike | Polygon | Sequence[Any] | Any) -> Repair:
    """Repairs one polygon: an n x 2 array, a list of rings (the outer one first), or an object with __geo_interface__. What
    crosses itself becomes what an odd number of its rings enclose, cut exactly, each new vertex rounded. Raises `ArgumentError`."""
    geo = _geo(polygon)
    if geo is not None:
        members = _geo_rings(geo, "polygon")
        if len(members) != 1 or not members[0].is_polygon:
            raise ArgumentError("polygon", f"a {geo['type']}", "one polygon")
        rings: list[Any] = list(members[0].rings)
    else:
        given: Any = polygon
        rings = list(given) if _is_list_of_rings(given) else [given]
    polygons, problems, refused, recombined, moved, before, after = _exactvo.repair_rings(rings)
    return Repair(
        tuple(Polygon(p[0], tuple(p[1:])) for p in polygons),
        tuple(Finding(code, f"ring {r}, vertex {v}", where, r, v, done, code) for code, r, v, where, done in problems),
        refused or "",
        recombined,
        moved,
        before,
        after,
    )


def _is_list_of_rings(polygon: Any) -> bool:
    try:
        first = polygon[0][0]
        return len(first) == 2
    except (TypeError, IndexError, KeyError):
        return False


@dataclass(frozen=True)
class Tally:
    """How many, by how they ended."""

    read: int
    done: int
    repaired: int
    rejected: dict[str, int]  #: by code


@dataclass(frozen=True)
class BatchSummary:
    """What a batch made of its inputs."""

    complete: bool
    files: Tally
    obstacles: Tally
    obstacles_out: int
    certified: int
    uncertified: int
    seconds: float = field(compare=False)


def batch(
    paths: PathLike | Sequence[PathLike],
    out: PathLike,
    *,
    write: Sequence[str] = ("measurements", "pictures"),
    jobs: int = 0,
    resume: bool = False,
    repair: bool = False,
    metres: bool = False,
    progress: Callable[[float], Union[bool, None]] | None = None,
) -> BatchSummary:
    """Every obstacle of every file decomposed and certified into the folder `out`, as `exactvo batch` (docs/guide/batch.md).

    write      outputs: "measurements" (always), "pictures", "geopackage", "geojson"
    jobs       worker threads; 0: as many as there are processors
    resume     go on with what is in `out`
    repair     repair what is invalid
    metres     GeoJSON in metres, for this project alone; else longitude and latitude
    progress   called with the share that is done; False stops it (`resume` goes on)

    A bad file or obstacle never stops the rest. Raises `DataError` where nothing can be done at all,
    `MissingFileError`, `ArgumentError`.
    """
    listed = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    for name, words in (("paths", listed), ("write", write)):
        for word in words:
            if not isinstance(word, (str, os.PathLike) if name == "paths" else str):
                raise ArgumentError(name, repr(word)[:60], "a path" if name == "paths" else "names of outputs")
    complete, files, shapes, out_count, certified, uncertified, seconds = _exactvo.batch(
        [os.fspath(p) for p in listed], os.fspath(out), list(write), jobs, resume, repair, metres, progress
    )
    return BatchSummary(complete, Tally(**files), Tally(**shapes), out_count, certified, uncertified, seconds)


def generate(kind: str, count: int = 1, *, seed: int = 0) -> Obstacles:
    """Obstacles from a seed, the same on every machine: "polygon", "star", "wall", ... as `exactvo generate`. Raises
    `ArgumentError` listing the kinds."""
    for name, value in (("count", count), ("seed", seed)):
        if is_whole(value) and not 0 <= value < 2**64:
            raise ArgumentError(name, str(value), "a whole number from 0 to 2^64 - 1")
    return Obstacles._of(_exactvo.generate(kind, count, seed))


def readable_formats() -> list[str]:
    """What `read(format=...)` takes."""
    return _exactvo.readable_formats()


def writable_formats() -> list[str]:
    """What `write(format=...)` takes."""
    return _exactvo.writable_formats()


explain_calls(__name__)
