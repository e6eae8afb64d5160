# SPDX-License-Identifier: GPL-3.0-or-later
"""One call that succeeds of every public function and method of the package: what tests of arguments start from.

A call is (name, function, arguments by name); the function of a method makes its object anew where the call changes it."""
import numpy as np

import exactvo
from exactvo import collisions, datasets, explorer, lp, routes, rvo2, shapes, simulation, sweeps, vo

ONE = {"name": "one", "time_limit": 1, "robots": [{"id": "R1", "position": [0, 0], "goal": [1, 0]}]}
SQUARE = "POLYGON((10 0, 12 0, 12 2, 10 2, 10 0))\n"
WALL = exactvo.Segment((4, -3), (4, 3))
DOOR = [exactvo.Wall([(0, 0), (0, 4)]), exactvo.Wall([(0, 5), (0, 9)])]
RING = exactvo.Wall([(4, -1), (6, -1), (6, 1), (4, 1), (4, -1)])

PLAN = simulation.JointPlan(0, 0, (1, 3), np.zeros((2, 2)), (1, 3, 1), np.eye(3, 2))

#: What no argument should be.
JUNK = [
    None, object(), "x", "", b"y", 1.5, -1, 0, True, 10**30, float("nan"), float("inf"), np.float32(1.5), np.int64(1),
    [], {}, [None], [[1, 2], [3]], np.zeros((2, 2)), np.zeros(0), np.array(["a"]), lambda: None,
]  # fmt: skip


def two_robots():
    crowd = exactvo.Crowd()
    crowd.add_robots([(0, 0), (5, 0)])
    crowd.add_obstacles([exactvo.Wall([(0, 9), (9, 9)])])
    return crowd


def on_crowd(method):
    return lambda **given: getattr(two_robots(), method)(**given)


def on_simulator(method):
    def call(**given):
        sim = rvo2.PyRVOSimulator(0.25, 15, 10, 5, 5, 0.5, 2)
        sim.addAgent((0, 0))
        sim.addAgent((3, 0.2))
        sim.addObstacle([(0, 1), (3, 1)])
        sim.processObstacles()
        sim.setAgentPrefVelocity(0, (1, 0))
        sim.doStep()
        return getattr(sim, method)(**given)

    return call


def good_calls(folder):
    """`folder` is where files are read and written."""
    (folder / "map.wkt").write_text(SQUARE)
    cone = exactvo.VelocityObstacle(WALL, position=(0, 0), radius=0.5, time_horizon=2)
    half_plane = cone.half_plane((3, 0))
    free = exactvo.free_velocities([cone], max_speed=2)
    normals, offsets, preferred = lp.batch_arrays(2, 2)
    batch = dict(normals=normals, offsets=offsets, preferred=preferred, max_speed=1.0, hard=None)
    answer = lp.solve([(-1, 0)], [-0.5], (2, 0), max_speed=2)
    route_map = exactvo.RouteMap(DOOR)
    plan = route_map.plan(0.4)
    run = exactvo.simulate(ONE)
    run.write(folder / "recording.jsonl")
    ends = dict(start=(-2, 2), goal=(2, 2))
    numbers = dict(radius=0.5, max_speed=1.0, time_horizon=3.0, neighbour_distance=3.0, neighbours=3)
    certificate = lp.solve_batch(**batch, certificates=True).certificates
    calls = [
        ("vo.VelocityObstacle", vo.VelocityObstacle, dict(obstacle=WALL, position=(0, 0), radius=0.5, time_horizon=2, obstacle_velocity=(0, 0))),
        ("vo.VelocityObstacle.contains", cone.contains, dict(velocity=(1, 0))),
        ("vo.VelocityObstacle.contains_many", cone.contains_many, dict(velocities=[(1, 0)])),
        ("vo.VelocityObstacle.nearest_boundary", cone.nearest_boundary, dict(velocity=(1, 0))),
        ("vo.VelocityObstacle.half_plane", cone.half_plane, dict(velocity=(1, 0), responsibility=1.0, certify=True)),
        ("vo.VelocityObstacle.contact_half_plane", cone.contact_half_plane, {}),
        ("vo.velocity_obstacles", vo.velocity_obstacles, dict(obstacle=DOOR, position=(-1, 0), radius=0.5, time_horizon=2, obstacle_velocity=(0, 0))),
        ("vo.reciprocal_half_planes", vo.reciprocal_half_planes, dict(position_a=(0, 0), velocity_a=(1, 0), radius_a=0.5, position_b=(4, 0), velocity_b=(0, 0), radius_b=0.5, time_horizon=2, responsibility_of_a=0.5)),
        ("vo.FreeVelocities", vo.FreeVelocities, dict(cones=[cone], max_speed=2, relative_tolerance=1e-4)),
        ("vo.free_velocities", vo.free_velocities, dict(cones=[cone], max_speed=2, relative_tolerance=1e-4)),
        ("vo.FreeVelocities.contains", free.contains, dict(velocity=(1, 0))),
        ("vo.FreeVelocities.compare", free.compare, dict(half_planes=[half_plane])),
        ("vo.FreeVelocities.exact", free.exact, {}),
        ("vo.Certificate.check", vo.Certificate("x").check, {}),
        ("vo.HalfPlane.violation", half_plane.violation, dict(velocity=(1, 0))),
        ("shapes.hull", shapes.hull, dict(points=[(0, 0), (1, 0), (0, 1)])),
        ("shapes.obstacles", shapes.obstacles, dict(shapes=DOOR, ids=["a", "b"])),
        ("shapes.Disc", lambda **d: cone_of(exactvo.Disc(**d)), dict(center=(9, 9), radius=1)),
        ("shapes.Segment", lambda **s: cone_of(exactvo.Segment(**s)), dict(a=(9, 9), b=(9, 10))),
        ("shapes.Ellipse", lambda **e: cone_of(exactvo.Ellipse(**e)), dict(center=(9, 9), l11=1, l21=0, l22=1)),
        ("shapes.Ellipse.from_axes", shapes.Ellipse.from_axes, dict(center=(0, 0), a=2, b=1, angle=0)),
        ("shapes.Polygon", shapes.Polygon, dict(outer=[(0, 0), (1, 0), (0, 1)], holes=())),
        ("shapes.Wall", shapes.Wall, dict(points=[(0, 0), (1, 1)])),
        ("shapes.Obstacles", shapes.Obstacles, dict(coordinates=np.array([(0.0, 0), (1, 0), (0, 1)]), ring_offsets=[0, 3], obstacle_offsets=[0, 1], is_polygon=[True], ids=("a",))),
        ("lp.solve", lp.solve, dict(normals=[(-1, 0)], offsets=[-0.5], preferred=(2, 0), max_speed=2, max_speed_x=2, max_speed_y=2, soft=None, objective="nearest", solver="certified")),
        ("lp.Solution.check", answer.check, {}),
        ("lp.check", lp.check, dict(problem=answer.problem, certificate=answer.certificate)),
        ("lp.solve_batch", lp.solve_batch, dict(batch, prove=False, certificates=False, copy=True, parallel=False)),
        ("lp.check_batch", lp.check_batch, dict(batch, certificates=certificate)),
        ("lp.batch_arrays", lp.batch_arrays, dict(problems=2, lines=2)),
        ("routes.RouteMap", routes.RouteMap, dict(obstacles_=DOOR, radius=0.4, largest_radius=1, largest_distance=1)),
        ("routes.RouteMap.route", exactvo.RouteMap(DOOR, 0.4).route, ends),
        ("routes.RouteMap.plan", route_map.plan, dict(radius=0.4)),
        ("routes.RouteMap.widest_radius", route_map.widest_radius, ends),
        ("routes.RouteMap.covers", route_map.covers, dict(point=(0, 0))),
        ("routes.RoutePlan.route", plan.route, ends),
        ("routes.RoutePlan.is_reachable", plan.is_reachable, ends),
        ("routes.Route.check", plan.route(**ends).check, {}),
        ("routes.Certificate.check", plan.route(**ends).certificate.check, {}),
        ("routes.Unreachable.check", exactvo.RouteMap(RING).plan(0.2).route((0, 0), (5, 0)).check, {}),
        ("collisions.check", collisions.check, dict(trajectories={"A": [(0, 0, 0), (1, 4, 0)]}, map=DOOR, radius=0.2, footprint=[(-1, -1), (1, -1), (0, 1)], time=None, between="straight", near=0.5, max_speed=9.0, max_gap=9.0, format=None, frame_rate=None, scale=1.0, page=None, certificates=None)),
        ("collisions.trajectory_formats", collisions.trajectory_formats, {}),
        ("crowd.Crowd", exactvo.Crowd, dict(time_step=0.25, precision="float", position_step=2.0**-18, certified=True, threads=1)),
        ("crowd.RobotKind", exactvo.RobotKind, numbers),
        ("crowd.Crowd.add_robot", on_crowd("add_robot"), dict(numbers, position=(9, 9), kind=None)),
        ("crowd.Crowd.add_robots", on_crowd("add_robots"), dict(numbers, positions=[(9, 9)], kind=None)),
        ("crowd.Crowd.add_kind", on_crowd("add_kind"), dict(kind=exactvo.RobotKind())),
        ("crowd.Crowd.kind_of", on_crowd("kind_of"), dict(robot=0)),
        ("crowd.Crowd.remove_robot", on_crowd("remove_robot"), dict(robot=0)),
        ("crowd.Crowd.add_obstacles", on_crowd("add_obstacles"), dict(shapes=DOOR)),
        ("crowd.Crowd.remove_obstacle", on_crowd("remove_obstacle"), dict(obstacle=0)),
        ("crowd.Crowd.head_for", on_crowd("head_for"), dict(goals=[(0, 0), (1, 1)], speed=1.0)),
        ("crowd.Crowd.follow_preferred", on_crowd("follow_preferred"), {}),
        ("crowd.Crowd.step", on_crowd("step"), dict(count=1)),
        ("crowd.Crowd.explain", on_crowd("explain"), dict(robot=0)),
        ("crowd.Crowd.snapshot", on_crowd("snapshot"), {}),
        ("crowd.Crowd.restored", exactvo.Crowd.restored, dict(snapshot=two_robots().snapshot(), threads=1)),
        ("simulation.Scenario", simulation.Scenario, dict(source=ONE)),
        ("simulation.Scenario.build", simulation.Scenario.build, dict(starts=[(-5, 0)], goals=[(-1, 1)], obstacles=DOOR, radius=0.1, max_speed=1.0, name="x")),
        ("simulation.Scenario.to_json", run.scenario.to_json, {}),
        ("simulation.simulate", simulation.simulate, dict(scenario=run.scenario, method="ivo", guidance=None, liveness=None, controller="default", integrator="exact", record_all=False, threads=2, progress=None, steering=None, half_planes=None)),
        ("simulation.read_recording", simulation.read_recording, dict(path=str(folder / "recording.jsonl"))),
        ("simulation.Recording.half_planes", run.half_planes, dict(step=0, robot=0)),
        ("simulation.Recording.own_half_planes", run.own_half_planes, dict(step=0, robot=0)),
        ("simulation.Recording.own_stage", run.own_stage, dict(step=0, robot=0)),
        ("simulation.Recording.audit", run.audit, {}),
        ("simulation.JointPlan.path", PLAN.path, dict(robot=1)),
        ("sweeps.sweep", sweeps.sweep, dict(scenario=ONE, vary={"/time_limit": [1]}, table=str(folder / "sweep.csv"), jobs=1, method="ivo", guidance=None, liveness=None, controller="default", integrator="exact")),
        ("simulation.Recording.write", run.write, dict(path=str(folder / "again.jsonl"))),
        ("simulation.Recording.view", run.view, dict(height=720)),
        ("explorer.view", explorer.view, dict(height=720)),
        ("explorer.ExplorerPage", explorer.ExplorerPage, dict(html="<p>", title="t", height=720)),
        ("explorer.ExplorerPage.write", run.view().write, dict(path=str(folder / "page.html"))),
        ("monitor.Monitor", exactvo.Monitor, dict(obstacles=DOOR, radius=0.1, footprint=[(-0.2, -0.2), (0.4, -0.2), (0.4, 0.2), (-0.2, 0.2)], max_deceleration=1.0, max_turn_deceleration=2.0, latency=0.1, period=0.1, margin=0.0)),
        ("monitor.Monitor.judge", exactvo.Monitor(radius=0.3).judge, dict(pose=(0, 0, 0), velocity=(1, 0), turn=0.1, frame="body", positions=[(3, 3)], radii=0.3, max_speeds=1.5, position_errors=0.0)),
        ("monitor.Monitor.judge_trajectory", exactvo.Monitor(radius=0.3).judge_trajectory, dict(poses=[(0, 0, 0, 0), (1, 1, 0, 0)], positions=[(3, 3)], radii=0.3, max_speeds=1.5, position_errors=0.0)),
        ("navigator.Navigator", exactvo.Navigator, dict(goals=[(6, 0)], obstacles=DOOR, radius=0.3, max_speed=1.5, cooperates=True, id=0, method="ivo", speed_bound="disc", horizons={"robots": 2.0}, margins={"robot": 0.04}, time_step=0.05, arrival_tolerance=0.1, neighbour_distance=15.0, acceleration=1.0, braking_time=1.7, kinematics=None)),
        ("navigator.Navigator.of_scenario", exactvo.Navigator.of_scenario, dict(scenario=exactvo.Scenario(ONE), robot=0, method="ivo")),
        ("navigator.Navigator.set_goals", exactvo.Navigator([(6, 0)]).set_goals, dict(goals=[(6, 0)])),
        ("navigator.neighbours_on_wheels", exactvo.neighbours_on_wheels, dict(positions=[(3, 3)], headings=[0.5], wheels=[(0.1, 0.1)], kinematics={"wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1.0}, radius=0.105, time_step=0.05)),
        ("navigator.Navigator.decide", exactvo.Navigator([(6, 0)]).decide, dict(time=0.0, position=(0, 0), velocity=(0, 0), heading=0.0, wheels=(0, 0), positions=[(3, 3)], velocities=[(0, 0)], radii=0.5, max_speeds=3.0, cooperate=True, ids=[1], bodies=[])),
        ("datasets.read", datasets.read, dict(path=str(folder / "map.wkt"), format=None, units="automatic", unknown="blocked", cell_size=0.0, skip_invalid=False, repair=False)),
        ("datasets.parse_wkt", datasets.parse_wkt, dict(text=SQUARE, repair=False)),
        ("datasets.write", datasets.write, dict(path=str(folder / "out.wkt"), obstacles_=DOOR, format=None, metres=False)),
        ("datasets.convert", datasets.convert, dict(source=str(folder / "map.wkt"), target=str(folder / "out.csv"), format=None, units="automatic", unknown="free", target_format=None, skip_invalid=False, repair=False, metres=False)),
        ("datasets.repair", datasets.repair, dict(polygon=[(0, 0), (1, 0), (0, 1)])),
        ("datasets.batch", datasets.batch, dict(paths=str(folder / "map.wkt"), out=str(folder / "batch"), write=["measurements"], jobs=1, resume=True, repair=False, metres=False, progress=None)),
        ("datasets.generate", datasets.generate, dict(kind="star", count=1, seed=0)),
        ("datasets.readable_formats", datasets.readable_formats, {}),
        ("datasets.writable_formats", datasets.writable_formats, {}),
        ("rvo2.PyRVOSimulator", rvo2.PyRVOSimulator, dict(timeStep=0.1, neighborDist=1, maxNeighbors=3, timeHorizon=1, timeHorizonObst=1, radius=0.3, maxSpeed=1, velocity=(0, 0))),
        ("rvo2.install", lambda: None, {}),  # it would change this process
    ]  # fmt: skip
    agent, pair, number = dict(agent_no=0), (3, 3), 1.0
    simulator = {
        "addAgent": dict(pos=(9, 9)),
        "addObstacle": dict(vertices=[(0, 5), (1, 5)]),
        "processObstacles": {},
        "doStep": {},
        "queryVisibility": dict(point1=(0, 0), point2=(1, 1), radius=0.1),
        "setAgentDefaults": dict(neighbor_dist=1, max_neighbors=3, time_horizon=1, time_horizon_obst=1, radius=0.3, max_speed=1, velocity=(0, 0)),
        "setTimeStep": dict(time_step=0.1),
        "setThreads": dict(threads=1),
        "relaxedInLastStep": {},
        "getAgentAgentNeighbor": dict(agent, neighbor_no=0),
        "getAgentObstacleNeighbor": dict(agent, obstacle_no=0),
        "getAgentORCALine": dict(agent, line_no=0),
        "setAgentMaxNeighbors": dict(agent, max_neighbors=3),
        "setAgentMaxSpeed": dict(agent, max_speed=number),
        "setAgentNeighborDist": dict(agent, neighbor_dist=number),
        "setAgentPosition": dict(agent, position=pair),
        "setAgentPrefVelocity": dict(agent, velocity=pair),
        "setAgentRadius": dict(agent, radius=number),
        "setAgentTimeHorizon": dict(agent, time_horizon=number),
        "setAgentTimeHorizonObst": dict(agent, timeHorizonObst=number),
        "setAgentVelocity": dict(agent, velocity=pair),
    }
    for name in ("ObstacleVertex", "NextObstacleVertexNo", "PrevObstacleVertexNo"):
        simulator["get" + name] = dict(vertex_no=0)
    for name in ("GlobalTime", "NumAgents", "NumObstacleVertices", "TimeStep"):
        simulator["get" + name] = {}
    for name in vars(rvo2.PyRVOSimulator):
        if name.startswith("getAgent") and name not in simulator:
            simulator[name] = agent
    calls += [(f"rvo2.PyRVOSimulator.{name}", on_simulator(name), given) for name, given in simulator.items()]
    try:
        import matplotlib  # noqa: F401
        import pandas  # noqa: F401
    except ImportError:
        pass
    else:
        calls += [
            ("simulation.Recording.plot", run.plot, dict(ax=None)),
            ("simulation.Recording.animate", run.animate, dict(speed=1.0, frames_per_second=20.0)),
            ("simulation.Recording.to_dataframe", run.to_dataframe, {}),
            ("collisions.CheckResult.to_dataframe", collisions.check({"A": [(0, 0, 0)]}, radius=0.2).to_dataframe, {}),
        ]
    return calls


def cone_of(shape):
    return exactvo.VelocityObstacle(shape, position=(0, 0), radius=0.5, time_horizon=2)
