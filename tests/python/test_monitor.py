# SPDX-License-Identifier: GPL-3.0-or-later
"""The monitor of a control loop from Python: shares against formulas, and what the program answers to the same lines."""
import json
import math
import os
import subprocess

import exactvo
import numpy as np
import pytest

WALL = exactvo.Wall([(1, -2), (1, 2)])


def test_a_command_towards_a_wall_is_cut_to_what_stops_before_it():
    verdict = exactvo.Monitor([WALL], radius=0.3).judge((0, 0, 0), (1.5, 0))
    share = (-0.3 + math.sqrt(0.09 + 4 * 1.125 * 0.7)) / 2.25
    assert share - 1e-7 < verdict.share < share < verdict.not_above < share + 1e-6
    assert verdict.witness.obstacle == 0 and verdict.witness.mover is None
    np.testing.assert_allclose(verdict.witness.place, (0.85, 0), atol=1e-6)
    assert exactvo.Monitor([WALL], radius=0.3).judge((0, 0, math.pi), (1.5, 0)).share == 1


def test_movers_and_trajectories_are_judged():
    monitor = exactvo.Monitor(radius=0.3)
    met = monitor.judge((0, 0, 0), (1, 0), positions=[(9, 9), (3, 0)], radii=0.3, max_speeds=[1.5, 1.5])
    assert met.share < 1 and met.witness.mover == 1 and met.witness.obstacle is None
    assert monitor.judge((0, 0, 0), (1, 0), positions=[(3, 0)], max_speeds=0).share == 1
    on = exactvo.Monitor([WALL], radius=0.3).judge_trajectory([(0, -2, 0, 0), (3, 1, 0, 0)])
    assert abs(on.share - (2.7 - 0.6) / 3) < 1e-6 and on.proven


def test_the_program_answers_the_same():
    program = os.environ.get("EXACTVO_PROGRAM")
    if not program:
        pytest.skip("the program is not there")
    footprint = [(-0.3, -0.2), (0.5, -0.2), (0.5, 0.2), (-0.3, 0.2)]
    monitor = exactvo.Monitor(footprint=footprint)
    random = np.random.default_rng(5)
    questions, shares = [], []
    for _ in range(50):
        pose, velocity = random.uniform(-1, 1, 3), random.uniform(-1.5, 1.5, 2)
        turn, mover = random.uniform(-2, 2), random.uniform(-2, 2, 2)
        questions.append(
            {"pose": pose.tolist(), "velocity": velocity.tolist(), "turn": turn,
             "movers": [{"position": mover.tolist(), "radius": 0.2, "max_speed": 0.5, "position_error": 0.1}]}
        )  # fmt: skip
        shares.append(monitor.judge(pose, velocity, turn, positions=[mover], radii=0.2, max_speeds=0.5, position_errors=0.1).share)
    wkt = "POLYGON ((" + ", ".join(f"{x} {y}" for x, y in [*footprint, footprint[0]]) + "))"
    text = "".join(json.dumps(q) + "\n" for q in questions)
    done = subprocess.run([program, "monitor", "--footprint", wkt], input=text, capture_output=True, text=True, check=True)
    assert [json.loads(line)["share"] for line in done.stdout.splitlines()] == shares
    assert min(shares) < 1 and len(set(shares)) > 5


@pytest.mark.parametrize(
    "given",
    [{"radius": -1}, {"radius": "x"}, {}, {"radius": 0.3, "max_deceleration": 0}, {"radius": 0.3, "latency": math.nan},
     {"footprint": [(0, 0), (1, 1), (1, 0), (0, 1)]}, {"footprint": [(0, 0)]}],
)  # fmt: skip
def test_setups_that_do_not_fit_are_refused(given):
    with pytest.raises(exactvo.ArgumentError):
        exactvo.Monitor(**given)


@pytest.mark.parametrize(
    "given",
    [{"pose": (0, 0)}, {"pose": (0, 0, math.inf)}, {"velocity": (math.nan, 0)}, {"frame": "map"}, {"frame": "world", "turn": 1},
     {"positions": [(1, 2)], "radii": -1}, {"positions": [(1, 2)], "max_speeds": [1, 2]}],
)  # fmt: skip
def test_commands_that_do_not_fit_are_refused_and_the_monitor_goes_on(given):
    monitor = exactvo.Monitor([WALL], radius=0.3)
    before = monitor.judge((0, 0, 0), (1.5, 0)).share
    with pytest.raises(exactvo.ArgumentError):
        monitor.judge(**{"pose": (0, 0, 0), "velocity": (1, 0), **given})
    assert monitor.judge((0, 0, 0), (1.5, 0)).share == before


def test_errors_name_the_argument_in_the_words_of_python():
    monitor = exactvo.Monitor([WALL], radius=0.3)
    places = []
    for call in (
        lambda: monitor.judge((0, 0, 0), (1, 0), positions=[(1, 2), (3, 4)], radii=[1, -1]),
        lambda: monitor.judge((0, 0, 0), (1, 0), positions=[(1, 2)], max_speeds=-1),
        lambda: monitor.judge((0, 0, 0), (1, 0), positions=[(1, 2)], position_errors=-1),
        lambda: monitor.judge((0, 0, 1e300), (1, 0)),
        lambda: monitor.judge_trajectory([(0, 0, 0, 0), (1, 1, 0, 0), (1, 2, 0, 0)]),
    ):
        with pytest.raises(exactvo.ArgumentError) as caught:
            call()
        places.append(caught.value.where)
    assert places == ["radii[1]", "max_speeds[0]", "position_errors[0]", "pose", "poses[2]"]
