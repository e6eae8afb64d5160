# SPDX-License-Identifier: GPL-3.0-or-later
import dataclasses
import json
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import exactvo

# A room with a door of 1 m.
DOOR = [exactvo.Wall([(0, 4), (0, 0), (-9, 0), (-9, 9), (0, 9), (0, 5)])]
RING = [np.array([(-2, -2), (2, -2), (2, -1), (-1, -1), (-1, 1), (2, 1), (2, 2), (-2, 2)], dtype=float)]


def test_a_gap_of_exactly_two_radii_is_passed_and_the_next_double_is_not():
    routes = exactvo.RouteMap(DOOR)
    assert routes.widest_radius((-2, 2), (2, 2)) == 0.5
    answer = routes.plan(0.5).route((-2, 2), (2, 2))
    assert answer and isinstance(answer, exactvo.Route) and answer.check() == ""
    assert answer.lower_bound <= answer.length and np.array_equal(answer.points[0], (-2, 2))
    closed = routes.plan(np.nextafter(0.5, 1)).route((-2, 2), (2, 2))
    assert isinstance(closed, exactvo.Unreachable) and not closed and closed.check() == ""
    assert [gap[2] for gap in closed.gaps] == [1.0]


def test_a_map_with_a_radius_answers_by_itself():
    routes = exactvo.RouteMap(DOOR, 0.5)
    answer = routes.route((-2, 2), (2, 2))
    assert answer and answer.check() == "" and answer.certificate.radius == routes.radius == 0.5
    assert np.array_equal(answer.points, exactvo.RouteMap(DOOR).plan(0.5).route((-2, 2), (2, 2)).points)
    assert exactvo.RouteMap(DOOR, 100).radius == 100  # beyond what a map of these obstacles allows by itself
    with pytest.raises(exactvo.ArgumentError, match=r"^radius: found None, expected RouteMap\(obstacles, radius\)"):
        exactvo.RouteMap(DOOR).route((-2, 2), (2, 2))
    for radius in (-1, np.inf, np.nan):
        with pytest.raises(exactvo.ArgumentError, match="^radius: "):
            exactvo.RouteMap(DOOR, radius)


def test_maps_and_plans_can_be_pickled():
    for routes in (exactvo.RouteMap(DOOR), exactvo.RouteMap(DOOR, 0.4)):
        again = pickle.loads(pickle.dumps(routes))
        assert again.radius == routes.radius and again.vertex_count == routes.vertex_count
    plan = pickle.loads(pickle.dumps(routes.plan(0.3)))
    assert plan.radius == 0.3 and plan.route((-2, 2), (2, 2)).check() == ""


def test_what_separates_is_named_and_proven():
    closed = [np.array([(-2, -2), (2, -2), (2, -1.8), (-2, -1.8)]), exactvo.Wall([(-2, -2), (-2, 2), (2, 2), (2, -1)])]
    answer = exactvo.RouteMap(closed).plan(0.5).route((0, 0), (9, 0))
    assert not answer and answer.reason == "separated" and answer.check() == ""
    assert set(answer.obstacles) == {0, 1} and len(answer.gaps) >= 1
    assert all(width < 1.0 for _, _, width in answer.gaps)


def test_a_blocked_end_is_named():
    plan = exactvo.RouteMap(RING).plan(0.5)
    answer = plan.route((-1.5, 0), (9, 0))
    assert answer.reason == "start blocked" and answer.obstacle == 0 and answer.inside and answer.check() == ""
    assert plan.route((9, 0), (-1.5, 0)).reason == "goal blocked"
    assert not plan.is_reachable((9, 0), (-1.5, 0)) and plan.is_reachable((9, 0), (0, 0))


def test_a_changed_answer_is_not_proven():
    routes = exactvo.RouteMap(DOOR)
    certificate = routes.plan(0.5).route((-2, 2), (2, 2)).certificate
    assert dataclasses.replace(certificate, radius=0.6).check() != ""
    kind, points, length, bound = certificate.answer
    straight = (kind, (points[0], points[-1]), length, bound)
    assert dataclasses.replace(certificate, answer=straight).check() != ""


def test_the_program_gives_the_same_numbers(program, source):
    floor = source / "datasets/data/office/floor.geojson"
    plan = exactvo.RouteMap(exactvo.datasets.read(floor).obstacles).plan(0.3)
    rng = np.random.default_rng(3)
    low_x, low_y, high_x, high_y = plan._map.obstacles.bounds
    kinds = set()
    for _ in range(12):
        a, b = (rng.uniform((low_x, low_y), (high_x, high_y)).round(3).tolist() for _ in range(2))
        printed = json.loads(program("route", floor, "--from", "{},{}".format(*a), "--to", "{},{}".format(*b), "--radius", 0.3, "--json"))
        answer = plan.route(a, b)
        assert answer.check() == ""
        kinds.add(printed["status"])
        if printed["status"] == "route":
            assert answer.length == printed["length"] and answer.lower_bound == printed["lower_bound"]
            assert answer.points.tolist() == printed["points"]
        else:
            assert not answer
    assert "route" in kinds and len(kinds) > 1


def test_queries_come_from_many_threads():
    plan = exactvo.RouteMap(DOOR).plan(0.4)
    starts = [(-2.0, 1 + y / 8) for y in range(56)]
    with ThreadPoolExecutor(4) as pool:
        lengths = list(pool.map(lambda start: plan.route(start, (2, 2)).length, starts))
    assert lengths == [plan.route(start, (2, 2)).length for start in starts]


@pytest.mark.parametrize(
    "call, where",
    [
        (lambda: exactvo.RouteMap(DOOR).plan(-1), "radius"),
        (lambda: exactvo.RouteMap(DOOR).plan(1e9), "radius"),
        (lambda: exactvo.RouteMap(DOOR).plan("0.5 m"), "radius"),
        (lambda: exactvo.RouteMap(DOOR, largest_radius=-1), "largest_radius"),
        (lambda: exactvo.RouteMap(DOOR).plan(0.5).route((0, 0, 0), (1, 1)), "start"),
        (lambda: exactvo.RouteMap(DOOR).plan(0.5).route((-2, 2), (1e9, 1)), "goal"),
        (lambda: exactvo.RouteMap(DOOR).widest_radius((1e9, 2), (0, 1)), "start"),
        (lambda: exactvo.RouteMap("floor.geojson"), "obstacles"),
        (lambda: exactvo.RouteMap(3), "obstacles"),
        (lambda: exactvo.RouteMap([np.zeros((3, 3))]), "obstacle 0"),
        (lambda: exactvo.RouteMap([RING[0], [(0, 0), (2, 2), (2, 0), (0, 2)]]), "obstacle 1"),
        (lambda: exactvo.RouteMap([exactvo.Disc((0, 0), 1)]), "obstacle 0"),
        (lambda: exactvo.RouteMap([exactvo.Wall([(0, 0), (0, 0)])]), "obstacle 0"),
    ],
)
def test_a_wrong_argument_is_named(call, where):
    with pytest.raises(exactvo.ArgumentError) as caught:
        call()
    assert caught.value.where == where


def test_answers_and_maps_are_pickled():
    routes = exactvo.RouteMap(DOOR, largest_radius=100.0)
    again = pickle.loads(pickle.dumps(routes))
    assert again.largest_radius == routes.largest_radius
    route = pickle.loads(pickle.dumps(routes.plan(0.5).route((-2, 2), (2, 2))))
    assert route.check() == ""


def test_obstacles_are_ragged_arrays():
    shapes = exactvo.obstacles([RING[0], exactvo.Wall([(5, 5), (6, 6)])], ids=["ring", "wall"])
    assert shapes.ids == ("ring", "wall") and shapes.coordinates.shape == (10, 2)
    assert shapes.ring_offsets.tolist() == [0, 8, 10] and shapes.obstacle_offsets.tolist() == [0, 1, 2]
    assert shapes.is_polygon.tolist() == [True, False] and shapes[1] == exactvo.Wall([(5, 5), (6, 6)])
    again = exactvo.Obstacles(shapes.coordinates, shapes.ring_offsets, shapes.obstacle_offsets, shapes.is_polygon, shapes.ids)
    assert again == shapes and pickle.loads(pickle.dumps(shapes)) == shapes
    assert shapes[-1] == shapes[1] and len(list(shapes)) == 2
    with pytest.raises(IndexError):
        shapes[2]
    with pytest.raises(exactvo.ArgumentError, match="ring_offsets"):
        exactvo.Obstacles(shapes.coordinates, [0, 11], shapes.obstacle_offsets, shapes.is_polygon)
    with pytest.raises(exactvo.ArgumentError, match="is_polygon"):
        exactvo.Obstacles(shapes.coordinates, shapes.ring_offsets, shapes.obstacle_offsets, [True])


def test_obstacles_of_shapely_are_taken_and_given():
    geometry = pytest.importorskip("shapely.geometry")
    donut = geometry.box(0, 0, 4, 4).difference(geometry.box(1, 1, 2, 2))
    shapes = exactvo.obstacles(geometry.GeometryCollection([geometry.MultiPolygon([donut]), geometry.LineString([(9, 9), (8, 8)])]))
    assert len(shapes) == 2 and len(shapes[0].holes) == 1
    assert geometry.shape(shapes[0]).equals(donut)
    with pytest.raises(exactvo.ArgumentError, match="a Point"):
        exactvo.obstacles(geometry.Point(1, 2))


def test_a_list_of_points_is_one_polygon_and_a_list_of_lists_several():
    triangle = [(0, 0), (2, 0), (1, 1)]
    assert len(exactvo.obstacles(triangle)) == len(exactvo.obstacles([triangle])) == 1
    assert len(exactvo.obstacles([triangle, [(5, 5), (6, 5), (6, 6)]])) == 2
    assert len(exactvo.obstacles([])) == 0 and exactvo.RouteMap([]).plan(0.5).route((0, 0), (1, 1))
