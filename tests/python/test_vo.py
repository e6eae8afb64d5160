# SPDX-License-Identifier: GPL-3.0-or-later
import json
import math
import pickle
from fractions import Fraction

import numpy as np
import pytest

import exactvo
from exactvo import vo

WALL = exactvo.Segment((4, -3), (4, 3))
SQUARE = np.array([(2, -1), (4, -1), (4, 1), (2, 1)], dtype=float)
SHAPES = {
    "POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))": SQUARE,
    "LINESTRING(4 -3, 4 3)": WALL,
    "DISC(4 0.5, 1)": exactvo.Disc((4, 0.5), 1.0),
    "ELLIPSE(4 1, 1.5 0.25 0.5)": exactvo.Ellipse((4, 1), 1.5, 0.25, 0.5),
}


def cone(shape=WALL, **options):
    return exactvo.VelocityObstacle(shape, **(dict(position=(0, 0), radius=0.5, time_horizon=2) | options))


@pytest.mark.parametrize("text", SHAPES)
@pytest.mark.parametrize("velocity", [(1.5, 0.2), (0.0, 1.0), (-1.0, -0.25)])
def test_the_program_gives_the_same_numbers(program, text, velocity):
    printed = json.loads(
        program("vo", "--obstacle", text, "--position", "0,0", "--velocity", "{},{}".format(*velocity), "--radius", 0.5,
                "--time-horizon", 2, "--json")
    )  # fmt: skip
    made = cone(SHAPES[text])
    assert made.contains(velocity) == printed["contains_velocity"]
    half_plane = made.half_plane(velocity)
    assert list(half_plane.normal) == printed["half_plane"]["normal"]
    assert half_plane.offset == printed["half_plane"]["offset"]
    assert half_plane.certificate.text == printed["certificate"]["text"]
    legs = printed["legs"]
    assert [list(made.legs.left.direction), list(made.legs.right.direction)] == [leg["direction"] for leg in legs]
    boundary = made.nearest_boundary(velocity)
    assert boundary.signed_distance == printed["nearest_boundary"]["signed_distance"]
    assert boundary.part == printed["nearest_boundary"]["part"]


def test_membership_is_exact_at_the_cut_off():
    made = cone(exactvo.Disc((3, 0), 1.0), radius=1.0, time_horizon=1.0)  # S / tau begins at v_x = 1
    assert made.contains((1.0, 0.0)) and not made.contains((math.nextafter(1.0, 0.0), 0.0))


def test_contains_many_agrees_with_contains():
    velocities = np.random.default_rng(7).uniform(-3, 3, (500, 2))
    made = cone(SQUARE)
    many = made.contains_many(velocities)
    assert many.dtype == np.bool_ and many.any() and not many.all()
    assert [made.contains(v) for v in velocities] == many.tolist()


def test_no_velocity_that_a_half_plane_allows_collides():
    rng = np.random.default_rng(8)
    made = cone(SQUARE)
    for v in rng.uniform(-3, 3, (20, 2)):
        half_plane = made.half_plane(v)
        for w in rng.uniform(-3, 3, (50, 2)):
            strictly = Fraction(half_plane.normal[0]) * Fraction(w[0]) + Fraction(half_plane.normal[1]) * Fraction(w[1])
            if strictly > Fraction(half_plane.offset):
                assert not made.contains(w)


def test_a_moving_obstacle_shifts_the_cone_and_its_half_plane_is_certified():
    moving = cone(SQUARE, obstacle_velocity=(-0.7, 0.1))
    still = cone(SQUARE)
    rng = np.random.default_rng(9)
    for _ in range(100):
        w = np.round(rng.uniform(-3, 3, 2) * 1024) / 1024  # so that w + u is exact
        u = (-0.7109375, 0.125)
        shifted = cone(SQUARE, obstacle_velocity=u)
        assert still.contains(w) == shifted.contains((w[0] + u[0], w[1] + u[1]))
        half_plane = moving.half_plane(w)
        assert half_plane.certificate is not None and half_plane.certificate.check() == "valid"
        assert half_plane.certificate.claim["obstacle_velocity"] == (-0.7, 0.1)


def test_a_changed_certificate_is_not_valid():
    text = cone().half_plane((3, 0)).certificate.text
    assert vo.Certificate(text).check() == "valid"
    assert vo.Certificate(text.replace("0x1p+2", "0x1.8p+1")).check() != "valid"
    assert vo.Certificate("nonsense").check() == "malformed"
    with pytest.raises(exactvo.ArgumentError):
        vo.Certificate("nonsense").claim


def test_responsibility_below_one_is_not_certified_alone():
    half = cone().half_plane((3, 0), responsibility=0.5)
    assert half.certificate is None and half.offset < cone().half_plane((3, 0)).offset * 0.5


def test_overlap_is_an_answer_and_the_cone_is_refused():
    inside = cone(position=(4, 0))
    assert inside.overlaps and inside.legs is None and inside.half_plane((1, 0)) is None and inside.distance < 0
    for call in (inside.contains, inside.nearest_boundary):
        with pytest.raises(exactvo.ArgumentError, match="overlaps"):
            call((1, 0))
    with pytest.raises(exactvo.ArgumentError, match="overlaps"):
        inside.contains_many([(1, 0)])


def test_shapely_shapes_and_geo_interfaces_are_taken():
    shapely = pytest.importorskip("shapely", minversion="1.8")
    from shapely import geometry

    box = geometry.box(2, -1, 4, 1)
    assert cone(box).half_plane((1.5, 0.2)) == cone(SQUARE).half_plane((1.5, 0.2))
    assert cone(geometry.LineString([(4, -3), (4, 3)])).half_plane((3, 0)) == cone().half_plane((3, 0))
    assert cone(geometry.Point(4, 0)).contains((2, 0))
    assert cone({"ignored": 0} and box).obstacle == exactvo.Polygon(np.array([(4, -1), (4, 1), (2, 1), (2, -1)]))
    with pytest.raises(exactvo.ArgumentError, match="with holes"):
        cone(geometry.Polygon(SQUARE, [[(2.5, -0.5), (3, -0.5), (3, 0)]]))
    with pytest.raises(exactvo.ArgumentError, match="MultiPolygon"):
        cone(geometry.MultiPolygon([box]))
    with pytest.raises(exactvo.ArgumentError, match="velocity_obstacles"):
        cone(geometry.LineString([(0, 1), (1, 1), (1, 2)]))
    assert shapely.geometry.shape(exactvo.Polygon(SQUARE)).area == 4.0


def test_clockwise_vertices_are_turned():
    assert cone(SQUARE[::-1]).half_plane((1.5, 0.2)) == cone(SQUARE).half_plane((1.5, 0.2))


def test_any_polygon_is_decomposed_exactly():
    ell = np.array([(2, -2), (5, -2), (5, 2), (4, 2), (4, -1), (2, -1)], dtype=float)
    with pytest.raises(exactvo.ArgumentError, match="not convex.*velocity_obstacles"):
        cone(ell)
    cones = exactvo.velocity_obstacles(ell, position=(0, 1), radius=0.25, time_horizon=4)
    assert len(cones) >= 2
    triangles = [np.array(t) for t in ([ell[0], ell[1], ell[4]], [ell[0], ell[4], ell[5]], [ell[1], ell[2], ell[4]], [ell[2], ell[3], ell[4]])]
    oracle = [exactvo.VelocityObstacle(t, position=(0, 1), radius=0.25, time_horizon=4) for t in triangles]
    velocities = np.random.default_rng(10).uniform(-2, 2, (2000, 2))
    ours = np.logical_or.reduce([c.contains_many(velocities) for c in cones])
    theirs = np.logical_or.reduce([c.contains_many(velocities) for c in oracle])
    assert ours.any() and (ours == theirs).all()


def test_free_velocities_are_bracketed_and_compared(program):
    cones = [cone(np.array([(2, -1), (3, -1), (3, 1), (2, 1)], dtype=float)), cone(exactvo.Segment((-1, 2), (0, 2)))]
    free = exactvo.free_velocities(cones, max_speed=1.5)
    low, high = free.area
    exact = free.exact()
    assert low <= exact.area[0] <= exact.area[1] <= high and high - low < 0.01
    assert exact.components >= free.least_components >= 1
    for v in np.random.default_rng(11).uniform(-1.5, 1.5, (200, 2)):
        assert free.contains(v) == (math.hypot(*v) <= 1.5 and not any(c.contains(v) for c in cones))
    report = free.compare([c.half_plane((1, 0.2)) for c in cones])
    assert report.inside == "yes" and report.given_away[0] > 0 and report.lost
    printed = json.loads(
        program("vo", "--obstacle", "POLYGON((2 -1, 3 -1, 3 1, 2 1, 2 -1))", "--obstacle", "LINESTRING(-1 2, 0 2)", "--free",
                "--max-speed", 1.5, "--position", "0,0", "--velocity", "1,0.2", "--radius", 0.5, "--time-horizon", 2, "--json")
    )  # fmt: skip
    assert [low, high] == printed["area"]


def test_free_velocities_refuse_what_they_cannot_hold():
    with pytest.raises(exactvo.ArgumentError) as caught:
        exactvo.free_velocities([cone()], max_speed=0)
    assert caught.value.where == "max_speed"
    with pytest.raises(exactvo.ArgumentError):
        exactvo.free_velocities([cone()], max_speed=1, relative_tolerance=0.5)
    with pytest.raises(exactvo.ArgumentError, match="VelocityObstacle"):
        exactvo.free_velocities([WALL], max_speed=1)
    with pytest.raises(exactvo.ArgumentError, match="ellipse"):
        exactvo.free_velocities([cone(exactvo.Ellipse((4, 1), 1.5, 0.25, 0.5))], max_speed=1).exact()


def test_reciprocal_halves_add_up():
    a, b, certified = vo.reciprocal_half_planes((0, 0), (1, 0), 0.5, (4, 0.25), (-1, 0), 0.5)
    assert certified and a.normal == (-b.normal[0], -b.normal[1])
    with pytest.raises(exactvo.ArgumentError) as caught:
        vo.reciprocal_half_planes((0, 0), (1, 0), 0.5, (4, 0.25), (-1, 0), -0.5)
    assert caught.value.where == "radius_b"


@pytest.mark.parametrize(
    "change, where",
    [
        (dict(shape=np.zeros((3, 3))), "obstacle"),
        (dict(shape="POINT(1 2)"), "obstacle"),
        (dict(shape=np.empty((0, 2))), "obstacle"),
        (dict(shape=[(0, 0), (math.nan, 1), (2, 2)]), "obstacle"),
        (dict(shape=[(0, 0), (1e40, 1), (2, 2)]), "obstacle"),
        (dict(shape=exactvo.Disc((0, 0), -1)), "radius"),
        (dict(position=(0, 0, 0)), "position"),
        (dict(radius=-1), "radius"),
        (dict(radius=math.inf), "radius"),
        (dict(time_horizon=0), "time_horizon"),
        (dict(time_horizon=math.nan), "time_horizon"),
        (dict(obstacle_velocity="x"), "obstacle_velocity"),
    ],
)
def test_a_wrong_argument_is_named(change, where):
    with pytest.raises(exactvo.ArgumentError) as caught:
        cone(**change)
    assert caught.value.where == where


@pytest.mark.parametrize("responsibility", [0, -1, 1.5, math.nan])
def test_responsibility_is_above_0_and_at_most_1(responsibility):
    with pytest.raises(exactvo.ArgumentError) as caught:
        cone().half_plane((1, 0), responsibility=responsibility)
    assert caught.value.where == "responsibility"


@pytest.mark.parametrize("shape", SHAPES.values(), ids=["polygon", "segment", "disc", "ellipse"])
def test_velocity_obstacles_and_half_planes_are_pickled(shape):
    made = cone(shape)
    again = pickle.loads(pickle.dumps(made))
    assert again.half_plane((1.5, 0.2)) == made.half_plane((1.5, 0.2)) and repr(again) == repr(made)
    half_plane = pickle.loads(pickle.dumps(made.half_plane((1.5, 0.2))))
    assert half_plane.certificate.check() == "valid"


def test_ellipses_have_axes_and_hulls_are_exact():
    ellipse = exactvo.Ellipse.from_axes((1, 2), a=3, b=1, angle=0.5)
    assert ellipse.axes == pytest.approx((3, 1, 0.5))
    with pytest.raises(exactvo.ArgumentError):
        exactvo.Ellipse.from_axes((1, 2), a=1, b=3)
    assert exactvo.hull([(0, 0), (2, 0), (1, 0.5), (0, 2)]) == exactvo.Polygon(np.array([(0.0, 0), (2, 0), (0, 2)]))
    assert isinstance(exactvo.hull([(0, 0), (1, 1), (2, 2)]), exactvo.Segment)
