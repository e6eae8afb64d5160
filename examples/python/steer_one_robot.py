#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A control loop: a robot round a wall, past another one that comes towards it and gives no way.

Where sensors would tell, two lines move both; a node of ROS has them in its callbacks."""
import numpy as np

import exactvo

STEP = 0.05  # s

navigator = exactvo.Navigator([(6, 0)], obstacles=[exactvo.Wall([(3, -2), (3, 1)])], radius=0.3, max_speed=1.5, time_step=STEP)
position, velocity = np.zeros(2), np.zeros(2)
other, its_velocity = np.array([6.0, 2.5]), np.array([-0.8, 0.0])
time, nearest = 0.0, np.inf

while not navigator.has_arrived and time < 30:
    decision = navigator.decide(
        time, position, velocity, positions=[other], velocities=[its_velocity], radii=0.3, max_speeds=1.0, cooperate=False
    )
    assert decision.status == "optimal" and decision.uncertified == 0, "nothing is promised: brake"
    assert all(p.half_plane.violation(decision.chosen) < 1e-9 for p in decision.half_planes)
    velocity = decision.chosen  # what the wheels get
    position = position + STEP * velocity
    other = other + STEP * its_velocity
    time += STEP
    nearest = min(nearest, float(np.linalg.norm(position - other)) - 0.6)

assert navigator.has_arrived and nearest > 0
print(f"arrived after {time:.2f} s, never nearer than {nearest:.3f} m to the other robot")
