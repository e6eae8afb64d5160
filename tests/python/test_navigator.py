# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

import exactvo

TWO = {
    "name": "two",
    "time_limit": 20,
    "guidance": "none",
    "liveness": "off",
    "robots": [
        {"id": "R1", "position": [0, 0], "goal": [6, 0]},
        {"id": "R2", "position": [6, 0.5], "goal": [0, 0.5]},
    ],
    "obstacles": [{"id": "wall", "polyline": [[3, -3], [3, -1]]}],
}


@pytest.mark.parametrize("method", [m for m in exactvo.METHODS if m not in ("rvo", "hrvo")])
def test_navigators_drive_what_simulate_drives(method):
    scenario = exactvo.Scenario(TWO)
    run = exactvo.simulate(scenario, method=method)
    navigators = [exactvo.Navigator.of_scenario(scenario, k, method=method) for k in range(2)]
    rows = len(run) - 1
    for row in range(rows):
        for k, navigator in enumerate(navigators):
            other = 1 - k
            decision = navigator.decide(
                run.time[row], run.position[row, k], run.velocity[row, k], positions=run.position[row, [other]],
                velocities=run.velocity[row, [other]], ids=[other],
            )  # fmt: skip
            assert decision.chosen.tobytes() == run.chosen[row, k].tobytes(), (row, k)
            assert decision.preferred.tobytes() == run.preferred[row, k].tobytes()
            assert decision.mode == run.mode[row, k] and decision.status == "optimal" and decision.uncertified == 0
    assert rows >= 40


def test_a_control_loop_arrives():
    navigator = exactvo.Navigator(
        [(6, 0)], obstacles=[exactvo.Wall([(3, -2), (3, 1)])], radius=0.3, max_speed=1.5, margins={"robot": 0.1}, horizons={"robots": 3}
    )
    position, velocity, other = np.zeros(2), np.zeros(2), np.array([[6.0, 2.5]])
    time, nearest = 0.0, np.inf
    while not navigator.has_arrived and time < 30:
        decision = navigator.decide(time, position, velocity, positions=other, velocities=[(-0.8, 0)], radii=0.3, max_speeds=1, cooperate=False)
        assert decision.status == "optimal" and decision.uncertified == 0
        for p in decision.half_planes:
            assert p.certified and p.half_plane.violation(decision.chosen) <= 1e-9
        velocity = decision.chosen
        position = position + 0.05 * velocity
        other = other + 0.05 * np.array([-0.8, 0])
        time += 0.05
        nearest = min(nearest, np.linalg.norm(other[0] - position) - 0.6)
    assert navigator.has_arrived and nearest > 0


def test_moving_bodies_are_avoided_and_goals_can_be_changed():
    navigator = exactvo.Navigator([(5, 0), (5, 5)], time_step=0.1)
    assert navigator.goal == 0 and repr(navigator) == "Navigator(goal 0)"
    ball = (exactvo.Disc((2, 0), 0.5), (-1, 0))
    alone, met = navigator.decide(0, (0, 0), (1, 0)), navigator.decide(0.1, (0, 0), (1, 0), bodies=[ball])
    assert alone.chosen.tolist() == [3, 0] and met.chosen.tolist() != [3, 0]
    assert [p.source for p in met.half_planes] == ["moving obstacle"]
    navigator.set_goals([(-5, 0)])
    assert navigator.decide(0.2, (0, 0), (0, 0)).preferred[0] < 0


@pytest.mark.parametrize(
    "given, where",
    [
        (dict(time=np.nan), "time"),
        (dict(position=(np.inf, 0)), "position"),
        (dict(velocity="fast"), "velocity"),
        (dict(positions=[(1, 2, 3)]), "positions"),
        (dict(positions=[(5, 5)], velocities=[(1, 1), (2, 2)]), "velocities"),
        (dict(positions=[(5, 5)], radii=[0.5, 0.5]), "radii"),
        (dict(positions=[(5, 5)], radii=-1), "neighbour 0 radius"),
        (dict(positions=[(5, 5)], ids=[1, 2]), "ids"),
        (dict(positions=[(5, 5)], ids=[-1]), "ids"),
        (dict(positions=[(0, 0)]), "neighbour 0 position"),
        (dict(bodies=[1]), "bodies"),
        (dict(bodies=[("disc", (1, 0))]), "bodies"),
        (dict(time=-1), "time"),
        (dict(position=(3.5, 0.5)), "position"),
    ],
)
def test_what_is_wrong_is_named_and_changes_nothing(given, where):
    navigator = exactvo.Navigator([(6, 0)], obstacles=[[(3, 0), (4, 0), (4, 1), (3, 1)]])
    before = navigator.decide(0, (0, 0), (0, 0))
    with pytest.raises(exactvo.ArgumentError) as caught:
        navigator.decide(**{"time": 0.05, "position": (0, 0), "velocity": (0, 0), **given})
    assert caught.value.where == where, str(caught.value)
    assert navigator.decide(0, (0, 0), (0, 0)).chosen.tobytes() == before.chosen.tobytes()


@pytest.mark.parametrize(
    "given, where",
    [
        (dict(goals=[]), "goals"),
        (dict(goals=[(np.nan, 0)]), "goals"),
        (dict(radius=0), "radius"),
        (dict(method="fastest"), "method"),
        (dict(speed_bound="ring"), "speed_bound"),
        (dict(horizons={"robot": 2}), "horizons"),
        (dict(margins={"robot": -1}), "margins/robot"),
        (dict(margins=0.3), "margins"),
        (dict(id=-1), "id"),
        (dict(time_step=1.0), "time_step"),
    ],
)
def test_a_wrong_setup_is_named(given, where):
    with pytest.raises(exactvo.ArgumentError) as caught:
        exactvo.Navigator(**{"goals": [(6, 0)], **given})
    assert caught.value.where == where, str(caught.value)


def test_of_scenario_asks_for_a_robot_with_goals(source):
    with pytest.raises(exactvo.ArgumentError):
        exactvo.Navigator.of_scenario(exactvo.Scenario(TWO), 2)
    with pytest.raises(exactvo.ArgumentError):
        exactvo.Navigator.of_scenario(exactvo.Scenario(source / "datasets/data/paper/B1.json"), 0)


BURGER = {"wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1.0}


def test_robots_on_wheels_change_places_by_poses_and_twists():
    """The loop of docs/guide/wheels.md, of two."""
    step = 0.05
    axle, heading, wheels = np.array([[0.0, 0.0], [2.0, 0.1]]), np.array([0.0, np.pi]), np.zeros((2, 2))
    navigators = [
        exactvo.Navigator([goal], id=k, radius=0.105, kinematics=BURGER, time_step=step, arrival_tolerance=0.02)
        for k, goal in enumerate([(2, 0), (0, 0.1)])
    ]
    time, nearest, turned = 0.0, np.inf, 0.0
    while time < 40 and not all(n.has_arrived for n in navigators):
        decisions = [
            n.decide(
                time, axle[k], heading=heading[k], wheels=wheels[k],
                **exactvo.neighbours_on_wheels(axle[[1 - k]], heading[[1 - k]], wheels[[1 - k]], kinematics=BURGER, radius=0.105, time_step=step),
            )
            for k, n in enumerate(navigators)
        ]  # fmt: skip
        for k, decision in enumerate(decisions):
            assert decision.status == "optimal" and decision.uncertified == 0
            linear, angular = decision.twist
            assert np.abs(np.array(decision.wheels) - wheels[k]).max() <= 1.0 * step and np.abs(decision.wheels).max() <= 0.22
            half = 0.5 * angular * step
            axle[k] += linear * step * np.sinc(half / np.pi) * np.array([np.cos(heading[k] + half), np.sin(heading[k] + half)])
            heading[k] += 2 * half
            wheels[k] = decision.wheels
            turned = max(turned, abs(angular))
        time += step
        nearest = min(nearest, np.linalg.norm(axle[0] - axle[1]) - 0.21)
    assert all(n.has_arrived for n in navigators) and nearest > 0 and turned > 0.1


def test_robots_on_wheels_that_only_measure_each_other_pass():
    """Places and velocities of reference points, off by as much as the bounds allow."""
    step, bounds, rng = 0.05, {"position": 0.02, "velocity": 0.05, "age": 0.0}, np.random.default_rng(5)
    axle, heading, wheels = np.array([[0.0, 0.0], [2.0, 0.1]]), np.array([0.0, np.pi]), np.zeros((2, 2))
    navigators = [
        exactvo.Navigator([goal], id=k, radius=0.105, kinematics=BURGER, time_step=step, arrival_tolerance=0.02, acceleration=0.45, braking_time=0.5)
        for k, goal in enumerate([(2, 0), (0, 0.1)])
    ]  # fmt: skip
    time, nearest = 0.0, np.inf

    def error(size):
        angle = rng.uniform(0, 2 * np.pi)
        return 0.999 * size * np.array([[np.cos(angle), np.sin(angle)]])

    while time < 60 and not all(n.has_arrived for n in navigators):
        decisions = []
        for k, n in enumerate(navigators):
            seen = exactvo.neighbours_on_wheels(axle[[1 - k]], heading[[1 - k]], wheels[[1 - k]], kinematics=BURGER, radius=0.105, time_step=step)
            seen["positions"] = seen["positions"] + error(bounds["position"])
            seen["velocities"] = seen["velocities"] + error(bounds["velocity"])
            decisions.append(n.decide(time, axle[k], heading=heading[k], wheels=wheels[k], measured=bounds, **seen))
        for k, decision in enumerate(decisions):
            assert decision.status == "optimal"
            linear, angular = decision.twist
            half = 0.5 * angular * step
            axle[k] += linear * step * np.sinc(half / np.pi) * np.array([np.cos(heading[k] + half), np.sin(heading[k] + half)])
            heading[k] += 2 * half
            wheels[k] = decision.wheels
        time += step
        nearest = min(nearest, np.linalg.norm(axle[0] - axle[1]) - 0.21)
    assert all(n.has_arrived for n in navigators) and nearest > 0
    for wrong in ({**bounds, "position": -1}, {"position": 0.02, "age": 0.1}):
        with pytest.raises(exactvo.ArgumentError, match="measured"):
            navigators[0].decide(time, axle[0], positions=[(9, 9)], max_speeds=0.2, measured=wrong)


def test_wheels_without_a_number_are_refused():
    for change in ({"wheel_separation": 0}, {"wheel_axis": 0.16}, {"max_wheel_speed": 4.0}, {"type": "bicycle"}, {"reference": -1}):
        with pytest.raises(exactvo.ArgumentError):
            exactvo.Navigator([(1, 0)], radius=0.105, kinematics={**BURGER, **change})
    navigator = exactvo.Navigator([(1, 0)], radius=0.105, kinematics={"type": "differential", **BURGER})
    for bad in ({"heading": np.nan}, {"wheels": (0.5, 0)}):
        with pytest.raises(exactvo.ArgumentError):
            navigator.decide(0.0, (0, 0), **bad)
    with pytest.raises(exactvo.ArgumentError, match="headings"):
        exactvo.neighbours_on_wheels([(1, 0)], [], [(0, 0)], kinematics=BURGER, radius=0.1)
