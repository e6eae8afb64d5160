# SPDX-License-Identifier: GPL-3.0-or-later
"""A call for each exception that a docstring documents.

(name, exception, call): `name` is "module.function", "module.Class" for its construction, or "module.Class.member"; `exception`
is a name of exactvo.errors or of Python. `test_raises.py` compares the table with the docstrings."""
from types import SimpleNamespace

import numpy as np
from good_calls import DOOR, ONE, PLAN, SQUARE, WALL, good_calls, two_robots

import exactvo
from exactvo import _exactvo, collisions, datasets, explorer, lp, routes, rvo2, shapes, simulation, sweeps, vo


def overlapping():
    return exactvo.VelocityObstacle(WALL, position=(4, 0), radius=0.5, time_horizon=2)


def with_a_broken_library():
    """No input is known for which the library throws this."""
    native = SimpleNamespace(radius=0.4, query=lambda *_: _exactvo.throw_route_not_proven())
    route_map = exactvo.RouteMap(DOOR, 0.4)
    route_map._plan = routes.RoutePlan(route_map, native)
    return route_map


def simulator():
    sim = rvo2.PyRVOSimulator(0.25, 15, 10, 5, 5, 0.5, 2)
    sim.addAgent((0, 0))
    sim.addAgent((3, 0.2))
    sim.addObstacle([(0, 1), (3, 1)])
    return sim


def simulator_in_one_place():
    sim = simulator()
    sim.addAgent((0, 0))
    return sim


def in_one_place():
    crowd = exactvo.Crowd()
    crowd.add_robot((0, 0))
    crowd.add_robot((0, 0))
    return crowd


def assign_preferred():
    two_robots().preferred = "x"




def raising_calls(folder):
    """`folder` is where files are read and written."""
    (folder / "map.wkt").write_text(SQUARE)
    (folder / "bad.wkt").write_text("POLYGON((0 0, 1 0\n")
    (folder / "bad.json").write_text("{}")
    good = {name: (function, given) for name, function, given in good_calls(folder)}
    missing, elsewhere = str(folder / "missing"), str(folder / "map.wkt" / "below a file")
    cone = exactvo.VelocityObstacle(WALL, position=(0, 0), radius=0.5, time_horizon=2)
    ellipse = exactvo.VelocityObstacle(exactvo.Ellipse((4, 0), 1, 0, 2), position=(0, 0), radius=0.5, time_horizon=2)
    free = exactvo.free_velocities([cone], max_speed=2)
    uncertified = lp.solve([(-1, 0)], [-0.5], (2, 0), max_speed=2, solver="batch")
    plan = exactvo.RouteMap(DOOR, 0.4).plan(0.4)
    far = (1e9, 0)
    run = exactvo.simulate(ONE)

    def wrong(name, **given):
        """The call that succeeds, but for these arguments."""
        function, arguments = good[name]
        return lambda: function(**dict(arguments, **given))

    calls = [
        ("vo.Certificate.claim", "ArgumentError", lambda: vo.Certificate("x").claim),
        ("vo.HalfPlane.violation", "ArgumentError", wrong("vo.HalfPlane.violation", velocity="x")),
        ("vo.VelocityObstacle", "ArgumentError", wrong("vo.VelocityObstacle", radius=-1)),
        ("vo.VelocityObstacle.contains", "ArgumentError", lambda: overlapping().contains((0, 0))),
        ("vo.VelocityObstacle.contains_many", "ArgumentError", lambda: cone.contains_many([(0, 0, 0)])),
        ("vo.VelocityObstacle.nearest_boundary", "ArgumentError", lambda: overlapping().nearest_boundary((0, 0))),
        ("vo.VelocityObstacle.half_plane", "ArgumentError", lambda: cone.half_plane((np.nan, 0))),
        ("vo.velocity_obstacles", "ArgumentError", wrong("vo.velocity_obstacles", time_horizon=0)),
        ("vo.reciprocal_half_planes", "ArgumentError", wrong("vo.reciprocal_half_planes", radius_b=-1)),
        ("vo.FreeVelocities", "ArgumentError", wrong("vo.FreeVelocities", max_speed=-1)),
        ("vo.free_velocities", "ArgumentError", wrong("vo.free_velocities", cones=[WALL])),
        ("vo.FreeVelocities.contains", "ArgumentError", lambda: free.contains("x")),
        ("vo.FreeVelocities.compare", "ArgumentError", lambda: free.compare([None])),
        ("vo.FreeVelocities.exact", "ArgumentError", lambda: exactvo.free_velocities([ellipse], max_speed=2).exact()),
        ("shapes.hull", "ArgumentError", lambda: shapes.hull([])),
        ("shapes.obstacles", "ArgumentError", lambda: shapes.obstacles([exactvo.Disc((0, 0), 1)])),
        ("shapes.Ellipse.from_axes", "ArgumentError", lambda: exactvo.Ellipse.from_axes((0, 0), a=1, b=2)),
        ("shapes.Ellipse.axes", "ArgumentError", lambda: exactvo.Ellipse((0, 0), "x", 0, 1).axes),
        ("shapes.Polygon", "ArgumentError", lambda: exactvo.Polygon("x")),
        ("shapes.Wall", "ArgumentError", lambda: exactvo.Wall("x")),
        ("shapes.Obstacles", "ArgumentError", wrong("shapes.Obstacles", ring_offsets=[0, 9])),
        ("lp.solve", "ArgumentError", wrong("lp.solve", solver="x")),
        ("lp.Solution.check", "ArgumentError", uncertified.check),
        ("lp.check", "ArgumentError", wrong("lp.check", problem=None)),
        ("lp.solve_batch", "ArgumentError", lambda: lp.solve_batch([[(1.0, 0)]], [[0.0]], [(0, 0)], max_speed=1, copy=False)),
        ("lp.check_batch", "ArgumentError", wrong("lp.check_batch", offsets=[1.0])),
        ("lp.batch_arrays", "ArgumentError", lambda: lp.batch_arrays(-1, 0)),
        ("routes.RouteMap", "ArgumentError", lambda: exactvo.RouteMap(DOOR, -1)),
        ("routes.RouteMap.plan", "ArgumentError", lambda: exactvo.RouteMap(DOOR).plan(1e9)),
        ("routes.RouteMap.widest_radius", "ArgumentError", wrong("routes.RouteMap.widest_radius", start=far)),
        ("routes.RouteMap.covers", "ArgumentError", wrong("routes.RouteMap.covers", point="x")),
        ("routes.RouteMap.route", "ArgumentError", lambda: exactvo.RouteMap(DOOR).route((-2, 2), (2, 2))),
        ("routes.RouteMap.route", "RouteNotProvenError", lambda: with_a_broken_library().route((-2, 2), (2, 2))),
        ("routes.RoutePlan.route", "ArgumentError", lambda: plan.route(far, (2, 2))),
        ("routes.RoutePlan.route", "RouteNotProvenError", lambda: with_a_broken_library()._plan.route((-2, 2), (2, 2))),
        ("routes.RoutePlan.is_reachable", "ArgumentError", lambda: plan.is_reachable((2, 2), far)),
        ("routes.Certificate.check", "ArgumentError", routes.Certificate(shapes.obstacles(DOOR), 0.4, (0, 1), (1, 0), ("route",)).check),
        ("monitor.Monitor", "ArgumentError", wrong("monitor.Monitor", latency=-1)),
        ("monitor.Monitor.judge", "ArgumentError", wrong("monitor.Monitor.judge", frame="x")),
        ("monitor.Monitor.judge_trajectory", "ArgumentError", wrong("monitor.Monitor.judge_trajectory", poses=[])),
        ("navigator.Navigator", "ArgumentError", wrong("navigator.Navigator", method="x")),
        ("navigator.Navigator.of_scenario", "ArgumentError", wrong("navigator.Navigator.of_scenario", robot=9)),
        ("navigator.Navigator.set_goals", "ArgumentError", wrong("navigator.Navigator.set_goals", goals=[])),
        ("navigator.neighbours_on_wheels", "ArgumentError", wrong("navigator.neighbours_on_wheels", headings=[])),
        ("navigator.Navigator.decide", "ArgumentError", wrong("navigator.Navigator.decide", positions=[(0, 0)])),
        ("collisions.check", "ArgumentError", lambda: collisions.check({"A": [(0, 0, 0)]}, radius=-1)),
        ("collisions.check", "DataError", lambda: collisions.check({"A": [(0, 0, 0), (0, 1, 0)]}, radius=1)),
        ("collisions.check", "MissingFileError", lambda: collisions.check(missing, radius=1)),
        ("crowd.RobotKind", "ArgumentError", lambda: exactvo.RobotKind(radius="x")),
        ("crowd.Crowd", "ArgumentError", lambda: exactvo.Crowd(precision="x")),
        ("crowd.Crowd", "CrowdError", lambda: exactvo.Crowd(time_step=-1)),
        ("crowd.Crowd.add_kind", "ArgumentError", lambda: two_robots().add_kind(None)),
        ("crowd.Crowd.add_kind", "CrowdError", lambda: two_robots().add_kind(exactvo.RobotKind(radius=-1))),
        ("crowd.Crowd.kind_of", "ArgumentError", lambda: two_robots().kind_of("x")),
        ("crowd.Crowd.kind_of", "CrowdError", lambda: two_robots().kind_of(9)),
        ("crowd.Crowd.add_robot", "ArgumentError", lambda: two_robots().add_robot("x")),
        ("crowd.Crowd.add_robot", "CrowdError", lambda: two_robots().add_robot((9, 9), kind=7)),
        ("crowd.Crowd.add_robots", "ArgumentError", lambda: two_robots().add_robots([(np.nan, 0)])),
        ("crowd.Crowd.add_robots", "CrowdError", lambda: two_robots().add_robots([(1e30, 0)])),
        ("crowd.Crowd.remove_robot", "ArgumentError", lambda: two_robots().remove_robot("x")),
        ("crowd.Crowd.remove_robot", "CrowdError", lambda: two_robots().remove_robot(9)),
        ("crowd.Crowd.add_obstacles", "ArgumentError", lambda: two_robots().add_obstacles("x")),
        ("crowd.Crowd.add_obstacles", "CrowdError", lambda: two_robots().add_obstacles([exactvo.Wall([(0, 0), (1e30, 0)])])),
        ("crowd.Crowd.remove_obstacle", "ArgumentError", lambda: two_robots().remove_obstacle("x")),
        ("crowd.Crowd.remove_obstacle", "CrowdError", lambda: two_robots().remove_obstacle(9)),
        ("crowd.Crowd.head_for", "ArgumentError", lambda: two_robots().head_for([(0, 0)])),
        ("crowd.Crowd.preferred", "ArgumentError", assign_preferred),
        ("crowd.Crowd.step", "ArgumentError", lambda: two_robots().step(0.5)),
        ("crowd.Crowd.step", "CrowdError", lambda: in_one_place().step()),
        ("crowd.Crowd.explain", "ArgumentError", lambda: two_robots().explain("x")),
        ("crowd.Crowd.explain", "CrowdError", lambda: two_robots().explain(9)),
        ("crowd.Crowd.restored", "ArgumentError", lambda: exactvo.Crowd.restored("x")),
        ("crowd.Crowd.restored", "CrowdError", lambda: exactvo.Crowd.restored(b"x")),
        ("simulation.Scenario", "ArgumentError", lambda: exactvo.Scenario(None)),
        ("simulation.Scenario", "DataError", lambda: exactvo.Scenario("{}")),
        ("simulation.Scenario", "MissingFileError", lambda: exactvo.Scenario(missing)),
        ("simulation.Scenario.build", "ArgumentError", lambda: exactvo.Scenario.build([(0, 0)], [])),
        ("simulation.Scenario.build", "DataError", lambda: exactvo.Scenario.build([(0, 0)], [(1, 0)], radius=-1)),
        ("simulation.simulate", "ArgumentError", lambda: exactvo.simulate(ONE, method="x")),
        ("simulation.simulate", "DataError", lambda: exactvo.simulate("{}")),
        ("simulation.simulate", "MissingFileError", lambda: exactvo.simulate(missing)),
        ("simulation.read_recording", "ArgumentError", lambda: simulation.read_recording(None)),
        ("simulation.read_recording", "DataError", lambda: simulation.read_recording(folder / "bad.json")),
        ("simulation.read_recording", "MissingFileError", lambda: simulation.read_recording(missing)),
        ("simulation.Recording.half_planes", "ArgumentError", lambda: run.half_planes("x", 0)),
        ("simulation.Recording.half_planes", "IndexError", lambda: run.half_planes(0, 9)),
        ("simulation.Recording.own_half_planes", "ArgumentError", lambda: run.own_half_planes("x", 0)),
        ("simulation.Recording.own_half_planes", "IndexError", lambda: run.own_half_planes(0, 9)),
        ("simulation.Recording.own_stage", "ArgumentError", lambda: run.own_stage("x", 0)),
        ("simulation.Recording.own_stage", "IndexError", lambda: run.own_stage(0, 9)),
        ("simulation.JointPlan.path", "ArgumentError", lambda: PLAN.path(2)),
        ("sweeps.sweep", "ArgumentError", lambda: sweeps.sweep(ONE, {"metod": ["orca"]})),
        ("sweeps.sweep", "DataError", lambda: sweeps.sweep(ONE, {"/time_step": [-1]})),
        ("sweeps.sweep", "MissingFileError", lambda: sweeps.sweep(missing, {})),
        ("simulation.Recording.write", "ArgumentError", lambda: run.write(None)),
        ("simulation.Recording.write", "DataError", lambda: run.write(elsewhere)),
        ("simulation.Recording.view", "ArgumentError", lambda: run.view(height=0)),
        ("simulation.Recording.plot", "ArgumentError", lambda: run.plot(ax="x")),
        ("simulation.Recording.animate", "ArgumentError", lambda: run.animate(speed=0)),
        ("explorer.view", "ArgumentError", lambda: explorer.view()),
        ("explorer.ExplorerPage.write", "ArgumentError", lambda: explorer.ExplorerPage("<p>").write(None)),
        ("explorer.ExplorerPage.write", "DataError", lambda: explorer.ExplorerPage("<p>").write(elsewhere)),
        ("datasets.read", "ArgumentError", wrong("datasets.read", units="x")),
        ("datasets.read", "DataError", wrong("datasets.read", path=folder / "bad.wkt")),
        ("datasets.read", "MissingFileError", wrong("datasets.read", path=missing)),
        ("datasets.parse_wkt", "ArgumentError", lambda: datasets.parse_wkt(None)),
        ("datasets.parse_wkt", "DataError", lambda: datasets.parse_wkt("POLYGON((0 0")),
        ("datasets.write", "ArgumentError", wrong("datasets.write", obstacles_=None)),
        ("datasets.write", "DataError", wrong("datasets.write", path=elsewhere + ".wkt")),
        ("datasets.convert", "ArgumentError", wrong("datasets.convert", format="x")),
        ("datasets.convert", "DataError", wrong("datasets.convert", source=folder / "bad.wkt")),
        ("datasets.convert", "MissingFileError", wrong("datasets.convert", source=missing)),
        ("datasets.repair", "ArgumentError", lambda: datasets.repair("x")),
        ("datasets.batch", "ArgumentError", wrong("datasets.batch", write=["x"])),
        ("datasets.batch", "MissingFileError", wrong("datasets.batch", paths=missing)),
        ("datasets.batch", "DataError", wrong("datasets.batch", paths=folder / "map.wkt", out=folder / "map.wkt")),
        ("datasets.generate", "ArgumentError", lambda: datasets.generate("x")),
        ("rvo2.PyRVOSimulator", "ArgumentError", wrong("rvo2.PyRVOSimulator", maxNeighbors=-1)),
        ("rvo2.PyRVOSimulator.addAgent", "ArgumentError", lambda: simulator().addAgent("x")),
        ("rvo2.PyRVOSimulator.addAgent", "ValueError", lambda: simulator().addAgent((9, 9), 1)),
        ("rvo2.PyRVOSimulator.addObstacle", "ArgumentError", lambda: simulator().addObstacle([None])),
        ("rvo2.PyRVOSimulator.addObstacle", "RuntimeError", lambda: simulator().addObstacle([(0, 0)])),
        ("rvo2.PyRVOSimulator.doStep", "CrowdError", lambda: simulator_in_one_place().doStep()),
        ("rvo2.PyRVOSimulator.queryVisibility", "ArgumentError", lambda: simulator().queryVisibility("x", (0, 0))),
        ("rvo2.PyRVOSimulator.queryVisibility", "CrowdError", lambda: simulator().queryVisibility((0, 0), (1, 1), np.nan)),
        ("rvo2.PyRVOSimulator.setAgentDefaults", "ArgumentError", lambda: simulator().setAgentDefaults(1, 3, 1, 1, 0.3, 1, "x")),
        ("rvo2.PyRVOSimulator.setTimeStep", "ArgumentError", lambda: simulator().setTimeStep("x")),
        ("rvo2.PyRVOSimulator.setThreads", "ArgumentError", lambda: simulator().setThreads("x")),
    ]  # fmt: skip

    def of_number(name, number):
        """An agent or a vertex by a number that is none, and by what is no number."""
        _, given = good[f"rvo2.PyRVOSimulator.{name}"]
        first = next(iter(given))
        return lambda: getattr(simulator(), name)(**dict(given, **{first: number}))

    for name in vars(rvo2.PyRVOSimulator):
        if name.startswith(("getAgent", "setAgent", "getObstacle", "getNextObstacle", "getPrevObstacle")) and name != "setAgentDefaults":
            calls.append((f"rvo2.PyRVOSimulator.{name}", "IndexError", of_number(name, 99)))
            calls.append((f"rvo2.PyRVOSimulator.{name}", "ArgumentError", of_number(name, "x")))
    return calls
