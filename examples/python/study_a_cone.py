#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Study a cone: one velocity obstacle, what it excludes, what several leave, and proofs that anybody can check."""
import math

import numpy as np

import exactvo

# A cupboard in front of a robot at the origin, and a wall to its left. The robot looks 3 s ahead.
cupboard = np.array([(2.0, -1.0), (3.0, -1.0), (3.0, 0.5), (2.0, 0.5)])
wall = exactvo.Segment((-1.0, 1.5), (4.0, 1.5))
robot = (0.0, 0.0)
shapes: list[exactvo.shapes.ShapeLike] = [cupboard, wall]
cones = [exactvo.VelocityObstacle(shape, position=robot, radius=0.4, time_horizon=3.0) for shape in shapes]

preferred = (1.2, 0.1)  # m/s
for cone in cones:
    legs = cone.legs
    assert legs is not None
    left, right = (math.degrees(math.atan2(*leg.direction[::-1])) for leg in (legs.left, legs.right))
    print(f"{type(cone.obstacle).__name__}: {cone.distance:.3f} m away, between {right:.1f} and {left:.1f} degrees")
    print(f"  {preferred} m/s collides within {cone.time_horizon:g} s: {cone.contains(preferred)}")

# Half-planes of velocities that provably do not collide, each with its certificate: a line of text.
half_planes = []
for cone in cones:
    half_plane = cone.half_plane(preferred)
    assert half_plane is not None and half_plane.certificate is not None
    assert half_plane.certificate.check() == "valid"
    half_planes.append(half_plane)
print("a certificate:", half_planes[0].certificate)

# The velocity nearest to the preferred one that keeps both.
best = exactvo.lp.solve(
    [h.normal for h in half_planes], [h.offset for h in half_planes], preferred, max_speed=1.5
)  # fmt: skip
assert best.check() == "none" and not any(cone.contains(best.velocity) for cone in cones)
print(f"the best velocity: ({best.velocity[0]:.4f}, {best.velocity[1]:.4f}) m/s, {best.status}, proven")

# What the half-planes give away of all that would be free.
free = exactvo.free_velocities(cones, max_speed=1.5)
report = free.compare(half_planes)
assert report.inside == "yes"
low, high = free.area
print(f"free: between {low:.4f} and {high:.4f} (m/s)^2; the half-planes give away {report.given_away[0] / high:.0%} of it")
