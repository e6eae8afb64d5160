#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What does a call from Python cost by itself? Smallest inputs, the least of 20 rounds of processor time, microseconds.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python_calls/call_overhead.py
"""
import time
import timeit

import numpy as np

import exactvo
from exactvo import lp

CALLS, ROUNDS = 1000, 20

one = lp.batch_arrays(1, 4)
zero = np.zeros((1, 2))
crowd = exactvo.Crowd()
crowd.add_robots([(0, 0), (5, 0)])
wall = exactvo.VelocityObstacle(exactvo.Segment((4, -3), (4, 3)), position=(0, 0), radius=0.5, time_horizon=2)

# Equality first.
answer = lp.solve_batch(*one, max_speed=2.0)
assert answer.velocity.tolist() == [[0.0, 0.0]] and not answer.copied
assert wall.contains_many([(3, 0), (1, 0)]).tolist() == [wall.contains((3, 0)), wall.contains((1, 0))] == [True, False]

questions = {
    "np.add of two 1 x 2 arrays, for comparison": lambda: np.add(zero, zero),
    "lp.solve_batch, one problem of 4 lines": lambda: lp.solve_batch(*one, max_speed=2.0),
    "BatchSolution.velocity": lambda: answer.velocity,
    "VelocityObstacle.contains_many, one velocity": lambda: wall.contains_many(zero),
    "VelocityObstacle.contains": lambda: wall.contains((1, 0)),
    "VelocityObstacle.half_plane, not certified": lambda: wall.half_plane((1, 0), certify=False),
    "Crowd.positions": lambda: crowd.positions,
    "Crowd.step(0), two robots": lambda: crowd.step(0),
}
for words, call in questions.items():
    least = min(timeit.repeat(call, number=CALLS, repeat=ROUNDS, timer=time.thread_time))
    print(f"{1e6 * least / CALLS:6.2f} us  {words}")
