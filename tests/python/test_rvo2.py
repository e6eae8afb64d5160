# SPDX-License-Identifier: GPL-3.0-or-later
import math
import subprocess
import sys

import numpy as np
import pytest

import exactvo
from exactvo.rvo2 import PyRVOSimulator

SCRIPT = """
import sys
import rvo2
assert sys.argv[1:] == ["argument"] and __name__ == "__main__"
sim = rvo2.PyRVOSimulator(0.25, 15, 10, 5, 5, 0.5, 1.5)
agents = [sim.addAgent((0, 0)), sim.addAgent((10, 0.5), 15, 10, 5, 5, 0.5, 1.5, (0, 0))]
for _ in range(40):
    for agent, goal in zip(agents, (10, 0)):
        x, y = sim.getAgentPosition(agent)
        sim.setAgentPrefVelocity(agent, (max(-1.5, min(1.5, (goal - x) / 0.25)), 0))
    sim.doStep()
print("%.3f %.3f" % (sim.getAgentPosition(0)[0], sim.getAgentPosition(1)[0]))
"""


def simulator(**options):
    given = dict(timeStep=0.25, neighborDist=15, maxNeighbors=10, timeHorizon=5, timeHorizonObst=5, radius=0.5, maxSpeed=1.5)
    return PyRVOSimulator(**(given | options))


def test_a_script_for_rvo2_runs_unchanged(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT)
    done = subprocess.run(
        [sys.executable, "-m", "exactvo.rvo2", tmp_path / "script.py", "argument"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    x, y = map(float, done.stdout.split())
    assert abs(x - 10) < 0.01 and abs(y) < 0.01


def test_two_agents_share_the_change_as_orca_has_it():
    sim = simulator()
    a, b = sim.addAgent((0, 0)), sim.addAgent((6, 0.5))
    for agent, v in ((a, (1.0, 0.0)), (b, (-1.0, 0.0))):
        sim.setAgentVelocity(agent, v)
        sim.setAgentPrefVelocity(agent, v)
    expected = exactvo.vo.reciprocal_half_planes((0, 0), (1, 0), 0.5, (6, 0.5), (-1, 0), 0.5, time_horizon=5)
    sim.doStep()
    for agent, half_plane in ((a, expected[0]), (b, expected[1])):
        assert abs(half_plane.violation(sim.getAgentVelocity(agent))) < 1e-4  # it binds
    assert sim.getAgentNumAgentNeighbors(a) == 1 and sim.getAgentAgentNeighbor(a, 0) == b
    assert sim.getAgentNumORCALines(a) == 1 and sim.relaxedInLastStep() == 0
    px, py, dx, dy = sim.getAgentORCALine(a, 0)
    assert math.isclose(math.hypot(dx, dy), 1.0, rel_tol=1e-6)


def test_positions_and_velocities_are_set_as_crowdnav_does():
    sim = simulator(timeStep=0.25)
    sim.addAgent((0.0, -4.0), 10, 10, 5, 5, 0.31, 1, (0.0, 0.0))
    for k in range(5):
        sim.addAgent((4 * math.cos(k), 4 * math.sin(k)), 10, 10, 5, 5, 0.31, 1, (0.0, 0.0))
    position = np.array([0.0, -4.0])
    for _ in range(40):
        sim.setAgentPosition(0, tuple(position))
        velocity = np.array([0.0, 4.0]) - position
        speed = np.linalg.norm(velocity)
        sim.setAgentPrefVelocity(0, tuple(velocity / speed if speed > 1 else velocity))
        sim.doStep()
        chosen = np.array(sim.getAgentVelocity(0))
        sim.setAgentVelocity(0, tuple(chosen))
        position = position + 0.25 * chosen
    assert np.linalg.norm(position - (0, 4)) < 0.5


def test_obstacles_stop_agents_and_sight():
    sim = simulator()
    agent = sim.addAgent((0, 2))
    first = sim.addObstacle([(5.0, 0.0), (-5.0, 0.0), (-5.0, -1.0), (5.0, -1.0)])
    sim.processObstacles()
    assert first == 0 and sim.getNumObstacleVertices() == 4 and sim.getObstacleVertex(1) == (-5.0, 0.0)
    assert sim.getNextObstacleVertexNo(3) == 0 and sim.getPrevObstacleVertexNo(0) == 3
    for _ in range(120):  # the distance falls by a factor e in each time horizon
        sim.setAgentPrefVelocity(agent, (0, -1.5))
        sim.doStep()
    assert 0.5 - 1e-4 <= sim.getAgentPosition(agent)[1] < 0.51
    assert not sim.queryVisibility((0, 2), (0, -3)) and sim.queryVisibility((0, 2), (3, 2), 0.5)


def test_parameters_are_got_as_they_were_set():
    sim = simulator()
    agent = sim.addAgent((1, 2))
    for name, value in (
        ("MaxNeighbors", 7), ("MaxSpeed", 2.5), ("NeighborDist", 9.0), ("Radius", 0.25), ("TimeHorizon", 3.0),
        ("TimeHorizonObst", 1.5), ("Velocity", (0.5, 0.25)), ("PrefVelocity", (0.25, 0.5)), ("Position", (3.0, 4.0)),
    ):  # fmt: skip
        getattr(sim, f"setAgent{name}")(agent, value)
        assert getattr(sim, f"getAgent{name}")(agent) == value
    sim.setTimeStep(0.5)
    sim.setAgentDefaults(10, 5, 4, 3, 0.125, 2)
    other = sim.addAgent((0, 0))
    assert sim.getTimeStep() == 0.5 and sim.getAgentRadius(other) == 0.125 and sim.getNumAgents() == 2
    sim.setThreads(2)
    sim.doStep()
    assert sim.getGlobalTime() == 0.5


def test_what_rvo2_leaves_undefined_is_refused():
    sim = simulator()
    sim.addAgent((0, 0))
    with pytest.raises(IndexError):
        sim.getAgentPosition(1)
    with pytest.raises(IndexError):
        sim.getAgentORCALine(0, 99)
    with pytest.raises(IndexError):
        sim.getObstacleVertex(0)
    with pytest.raises(exactvo.ArgumentError, match="position"):
        sim.setAgentPosition(0, "here")
    with pytest.raises(exactvo.ArgumentError, match="max_neighbors"):
        sim.setAgentMaxNeighbors(0, -1)
    with pytest.raises(ValueError, match="all parameters"):
        sim.addAgent((1, 1), 15)
    with pytest.raises(RuntimeError, match="obstacle"):
        sim.addObstacle([(0, 0)])
    sim.addAgent((0, 0))
    with pytest.raises(exactvo.CrowdError) as caught:
        sim.doStep()
    assert caught.value.code == "coincident"
