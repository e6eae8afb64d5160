# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of recordings with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .shapes import Floats, Polygon

if TYPE_CHECKING:
    import matplotlib.animation
    import matplotlib.axes

    from .simulation import Recording

_OBSTACLE, _EDGE = "0.82", "0.35"


def _draw_obstacles(recording: Recording, ax: Any) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    for shape in recording.scenario.obstacles:
        if isinstance(shape, Polygon):
            rings = [Path(np.vstack([ring, ring[:1]]), closed=True) for ring in (shape.outer, *shape.holes)]
            ax.add_patch(PathPatch(Path.make_compound_path(*rings), facecolor=_OBSTACLE, edgecolor=_EDGE, linewidth=0.8))
        else:
            ax.plot(*shape.points.T, color=_EDGE, linewidth=1.5)


def _axes(recording: Recording, ax: Any) -> Any:
    import matplotlib.pyplot as plt

    if ax is None:
        _, ax = plt.subplots()
    _draw_obstacles(recording, ax)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(f"{recording.scenario.name}, {recording.method}")
    return ax


def plot(recording: Recording, ax: matplotlib.axes.Axes | None) -> matplotlib.axes.Axes:
    from matplotlib.patches import Circle

    drawn = _axes(recording, ax)
    for k, robot in enumerate(recording.scenario.robots):
        path: Floats = recording.position[:, k]
        (line,) = drawn.plot(*path.T, linewidth=1.2, label=robot.id)
        drawn.plot(*path[0], marker="o", markersize=3, color=line.get_color())
        drawn.add_patch(Circle(tuple(path[-1]), robot.radius, facecolor=line.get_color(), alpha=0.4))
        if len(robot.goals):
            drawn.plot(*robot.goals[-1], marker="x", markersize=5, color=line.get_color())
    if 1 < len(recording.scenario.robots) <= 10:
        drawn.legend(loc="best", fontsize="small")
    drawn.autoscale_view()
    return drawn


def animate(recording: Recording, speed: float, frames_per_second: float) -> matplotlib.animation.FuncAnimation:
    from matplotlib.animation import FuncAnimation
    from matplotlib.patches import Circle

    drawn = plot(recording, None)
    for patch in [p for p in drawn.patches if isinstance(p, Circle)]:
        patch.remove()
    discs = []
    for k, robot in enumerate(recording.scenario.robots):
        discs.append(drawn.add_patch(Circle(tuple(recording.position[0, k]), robot.radius, facecolor=f"C{k % 10}", alpha=0.6)))
    end = float(recording.time[-1])
    times = np.arange(0.0, end + speed / frames_per_second, speed / frames_per_second)
    rows = np.minimum(np.searchsorted(recording.time, times), len(recording) - 1)

    def show(row: int) -> list[Any]:
        for disc, place in zip(discs, recording.position[row]):
            disc.center = tuple(place)
        return discs

    return FuncAnimation(drawn.figure, show, frames=[int(r) for r in rows], interval=1000.0 / frames_per_second, blit=True)
