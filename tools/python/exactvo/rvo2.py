# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of Python-RVO2 on the certified engine: a program written for it runs unchanged.

    python3 -m exactvo.rvo2 example.py            # runs a script whose `import rvo2` finds this module

or, in a program of your own, before it imports what needs `rvo2`:

>>> import exactvo.rvo2
>>> exactvo.rvo2.install()
>>> import rvo2
>>> sim = rvo2.PyRVOSimulator(1 / 60.0, 1.5, 5, 1.5, 2, 0.4, 2)
>>> agent = sim.addAgent((0, 0))
>>> sim.setAgentPrefVelocity(agent, (1, 1))
>>> sim.doStep()
>>> "%.4f %.4f" % sim.getAgentPosition(agent)
'0.0167 0.0167'

Semantics are RVO2's; docs/guide/rvo2.md lists what differs (velocities by some 1e-5 m/s, positions on a lattice of 2^-18 m,
1 to 15 neighbours, obstacles seen from both sides). Motions are certified as in `exactvo.Crowd`. Metres, seconds. What RVO2
leaves undefined raises: `IndexError` for numbers of no agent, `exactvo.ArgumentError`, `exactvo.CrowdError`.
"""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterable
from typing import Any, Union

from . import _exactvo
from ._calls import explain_calls
from .shapes import Point

__all__ = ["PyRVOSimulator", "install"]

Number = Union[int, float]
Pair = tuple[float, float]


class PyRVOSimulator:
    """Agents that avoid each other and obstacles. Agents and vertices of obstacles are numbered from 0 as they are added.
    Raises `ArgumentError`."""

    __slots__ = ("_native",)

    def __init__(
        self,
        timeStep: Number,
        neighborDist: Number,
        maxNeighbors: int,
        timeHorizon: Number,
        timeHorizonObst: Number,
        radius: Number,
        maxSpeed: Number,
        velocity: Point = (0, 0),
    ) -> None:
        self._native = _exactvo.RvoSimulator(
            timeStep, neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed, velocity
        )

    def addAgent(
        self,
        pos: Point,
        neighborDist: Number | None = None,
        maxNeighbors: int | None = None,
        timeHorizon: Number | None = None,
        timeHorizonObst: Number | None = None,
        radius: Number | None = None,
        maxSpeed: Number | None = None,
        velocity: Point | None = None,
    ) -> int:
        """The number of a new agent at `pos`, with the defaults or with all parameters given. Raises `ValueError` for some,
        `ArgumentError`."""
        rest = (neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed, velocity)
        if neighborDist is not None and any(value is None for value in rest):
            raise ValueError("Either pass only 'pos', or pass all parameters.")
        return self._native.addAgent(pos, *rest)

    def addObstacle(self, vertices: Iterable[Point]) -> int:
        """A closed polygon, or with two vertices a wall; the number of its first vertex. Raises `RuntimeError` for fewer,
        `ArgumentError`."""
        return self._native.addObstacle(list(vertices))

    def processObstacles(self) -> None:
        """From now on the obstacles added so far are in the way."""
        self._native.processObstacles()

    def doStep(self) -> None:
        """Decides for all agents and moves them. Releases the interpreter's lock. Raises `CrowdError` where two agents are in one
        place."""
        self._native.doStep()

    def getAgentAgentNeighbor(self, agent_no: int, neighbor_no: int) -> int:
        """The agent that was its neighbour number `neighbor_no`, nearest first. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentAgentNeighbor(agent_no, neighbor_no)

    def getAgentMaxNeighbors(self, agent_no: int) -> int:
        """How many neighbours it looks at. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentMaxNeighbors(agent_no)

    def getAgentMaxSpeed(self, agent_no: int) -> float:
        """m/s. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentMaxSpeed(agent_no)

    def getAgentNeighborDist(self, agent_no: int) -> float:
        """m. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentNeighborDist(agent_no)

    def getAgentNumAgentNeighbors(self, agent_no: int) -> int:
        """In the last step. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentNumAgentNeighbors(agent_no)

    def getAgentNumObstacleNeighbors(self, agent_no: int) -> int:
        """In the last step. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentNumObstacleNeighbors(agent_no)

    def getAgentNumORCALines(self, agent_no: int) -> int:
        """In the last step. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentNumORCALines(agent_no)

    def getAgentObstacleNeighbor(self, agent_no: int, obstacle_no: int) -> int:
        """The vertex that begins the edge, nearest first. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentObstacleNeighbor(agent_no, obstacle_no)

    def getAgentORCALine(self, agent_no: int, line_no: int) -> tuple[float, float, float, float]:
        """point x, y, direction x, y (m/s): velocities to the left are allowed. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentORCALine(agent_no, line_no)

    def getAgentPosition(self, agent_no: int) -> Pair:
        """m. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentPosition(agent_no)

    def getAgentPrefVelocity(self, agent_no: int) -> Pair:
        """m/s. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentPrefVelocity(agent_no)

    def getAgentRadius(self, agent_no: int) -> float:
        """m. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentRadius(agent_no)

    def getAgentTimeHorizon(self, agent_no: int) -> float:
        """s, towards other agents. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentTimeHorizon(agent_no)

    def getAgentTimeHorizonObst(self, agent_no: int) -> float:
        """s, towards obstacles. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentTimeHorizonObst(agent_no)

    def getAgentVelocity(self, agent_no: int) -> Pair:
        """m/s. Raises `IndexError`, `ArgumentError`."""
        return self._native.getAgentVelocity(agent_no)

    def getGlobalTime(self) -> float:
        """s."""
        return self._native.getGlobalTime()

    def getNumAgents(self) -> int:
        """How many there are."""
        return self._native.getNumAgents()

    def getNumObstacleVertices(self) -> int:
        """Of all obstacles."""
        return self._native.getNumObstacleVertices()

    def getObstacleVertex(self, vertex_no: int) -> Pair:
        """m. Raises `IndexError`, `ArgumentError`."""
        return self._native.getObstacleVertex(vertex_no)

    def getNextObstacleVertexNo(self, vertex_no: int) -> int:
        """Along its obstacle. Raises `IndexError`, `ArgumentError`."""
        return self._native.getNextObstacleVertexNo(vertex_no)

    def getPrevObstacleVertexNo(self, vertex_no: int) -> int:
        """Along its obstacle. Raises `IndexError`, `ArgumentError`."""
        return self._native.getPrevObstacleVertexNo(vertex_no)

    def getTimeStep(self) -> float:
        """s."""
        return self._native.getTimeStep()

    def queryVisibility(self, point1: Point, point2: Point, radius: Number = 0.0) -> bool:
        """Whether a disc gets straight from one point to the other past the obstacles; m. Raises `ArgumentError`,
        `CrowdError`."""
        return self._native.queryVisibility(point1, point2, radius)

    def setAgentDefaults(
        self,
        neighbor_dist: Number,
        max_neighbors: int,
        time_horizon: Number,
        time_horizon_obst: Number,
        radius: Number,
        max_speed: Number,
        velocity: Point = (0, 0),
    ) -> None:
        """For agents that are added by their position alone. Raises `ArgumentError`."""
        self._native.setAgentDefaults(
            neighbor_dist, max_neighbors, time_horizon, time_horizon_obst, radius, max_speed, velocity
        )

    def setAgentMaxNeighbors(self, agent_no: int, max_neighbors: int) -> None:
        """At least 1 and at most 15 are looked at, and all that could be met within a step.
        Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentMaxNeighbors(agent_no, max_neighbors)

    def setAgentMaxSpeed(self, agent_no: int, max_speed: Number) -> None:
        """m/s. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentMaxSpeed(agent_no, max_speed)

    def setAgentNeighborDist(self, agent_no: int, neighbor_dist: Number) -> None:
        """m. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentNeighborDist(agent_no, neighbor_dist)

    def setAgentPosition(self, agent_no: int, position: Point) -> None:
        """m. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentPosition(agent_no, position)

    def setAgentPrefVelocity(self, agent_no: int, velocity: Point) -> None:
        """m/s. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentPrefVelocity(agent_no, velocity)

    def setAgentRadius(self, agent_no: int, radius: Number) -> None:
        """m. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentRadius(agent_no, radius)

    def setAgentTimeHorizon(self, agent_no: int, time_horizon: Number) -> None:
        """s, towards other agents. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentTimeHorizon(agent_no, time_horizon)

    def setAgentTimeHorizonObst(self, agent_no: int, timeHorizonObst: Number) -> None:
        """s, towards obstacles. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentTimeHorizonObst(agent_no, timeHorizonObst)

    def setAgentVelocity(self, agent_no: int, velocity: Point) -> None:
        """m/s. Raises `IndexError`, `ArgumentError`."""
        self._native.setAgentVelocity(agent_no, velocity)

    def setTimeStep(self, time_step: Number) -> None:
        """s. Raises `ArgumentError`."""
        self._native.setTimeStep(time_step)

    # What Python-RVO2 has not.

    def relaxedInLastStep(self) -> int:
        """Agents of which nothing is promised for the last step: their half-planes contradicted each other."""
        return self._native.relaxedInLastStep()

    def setThreads(self, threads: int) -> None:
        """0: as many as there are. The same bits with any number. Raises `ArgumentError`."""
        self._native.setThreads(threads)


def install() -> None:
    """From now on `import rvo2` finds this module, whatever is installed."""
    sys.modules["rvo2"] = sys.modules["exactvo.rvo2"]


def _main(arguments: list[str]) -> Any:
    if not arguments:
        sys.exit("usage: python3 -m exactvo.rvo2 SCRIPT.py [ARGUMENT ...]")
    import exactvo.rvo2  # under its own name, not __main__

    exactvo.rvo2.install()
    sys.argv = arguments
    sys.path[0] = arguments[0].rpartition("/")[0] or "."
    return runpy.run_path(arguments[0], run_name="__main__")


if __name__ != "__main__":
    explain_calls(__name__)
else:
    _main(sys.argv[1:])
