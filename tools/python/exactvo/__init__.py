# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact velocity obstacles, certified steering, and answers that can be checked.

>>> import exactvo
>>> run = exactvo.simulate("datasets/data/paper/A2.json")      # doctest: +SKIP
>>> run.plot()                                                 # doctest: +SKIP

`exactvo.vo` velocity obstacles and free velocities, `exactvo.lp` the best velocity, `exactvo.routes` from A to B with proof,
`exactvo.Crowd` many robots, `exactvo.Navigator` one robot in a control loop, `exactvo.Monitor` how much of a command is clear, `exactvo.rvo2` the names of Python-RVO2, `exactvo.simulate` scenarios (`exactvo.sweep` many at once), `exactvo.datasets` obstacle files, `exactvo.check` whether recorded or planned bodies collided.
SI units: metres, seconds, radians. Options are keywords. Every error is an `exactvo.ExactVOError` with ``code``, ``file`` and
``where``. The guide: docs/guide/python.md.
"""

import typing as _typing

try:
    from ._exactvo import version as __version__
except ModuleNotFoundError as _error:
    # Else the first module that uses it would speak of a circular import.
    if _error.name != "exactvo._exactvo":
        raise
    from .errors import _extension_missing

    raise _extension_missing() from None
from . import datasets, lp, routes, shapes, vo
from .collisions import CheckResult, MotionEvent, check
from .crowd import Crowd, RobotKind, StepReport
from .errors import ArgumentError, CrowdError, DataError, ExactVOError, MissingFileError, RouteNotProvenError, ScenarioWarning
from .explorer import ExplorerPage, view
from .monitor import Monitor, MonitorVerdict, MonitorWitness
from .navigator import Navigator, NavigatorDecision, neighbours_on_wheels
from .routes import Route, RouteMap, RoutePlan, Unreachable
from .shapes import Disc, Ellipse, Obstacles, Polygon, Segment, Wall, hull, obstacles
from .simulation import METHODS, OwnHalfPlane, Recording, RobotsNow, Scenario, read_recording, simulate
from .sweeps import sweep
from .vo import VelocityObstacle, free_velocities, velocity_obstacles

__all__ = [
    "METHODS",
    "ArgumentError",
    "CheckResult",
    "Crowd",
    "CrowdError",
    "DataError",
    "Disc",
    "Ellipse",
    "ExactVOError",
    "ExplorerPage",
    "MissingFileError",
    "Monitor",
    "MonitorVerdict",
    "MonitorWitness",
    "MotionEvent",
    "Navigator",
    "NavigatorDecision",
    "Obstacles",
    "OwnHalfPlane",
    "Polygon",
    "Recording",
    "RobotKind",
    "RobotsNow",
    "Route",
    "RouteMap",
    "RouteNotProvenError",
    "RoutePlan",
    "Scenario",
    "ScenarioWarning",
    "Segment",
    "StepReport",
    "Unreachable",
    "VelocityObstacle",
    "Wall",
    "__version__",
    "check",
    "datasets",
    "free_velocities",
    "hull",
    "lp",
    "neighbours_on_wheels",
    "obstacles",
    "read_recording",
    "routes",
    "shapes",
    "simulate",
    "sweep",
    "velocity_obstacles",
    "view",
    "vo",
]

if _typing.TYPE_CHECKING:
    from . import rvo2 as rvo2


def __getattr__(name: str) -> _typing.Any:
    """`exactvo.rvo2` when it is first asked for (it is run as a program too), and a suggestion for a mistyped name."""
    import difflib
    import importlib

    if name == "rvo2":
        return importlib.import_module("exactvo.rvo2")
    near = {known.lower(): known for known in __all__}
    found = difflib.get_close_matches(name.lower(), near, n=1, cutoff=0.6)
    error = AttributeError(f"module 'exactvo' has no attribute {name!r}" + (f"; did you mean {near[found[0]]!r}?" if found else ""))
    error.name = name  # or the interpreter adds a suggestion of its own
    raise error
