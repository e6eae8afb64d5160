#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Steer a crowd: a thousand robots cross a circle, then some of them by velocities of your own; a scenario of six at the end.

    steer_a_crowd.py [PICTURE.png]
"""
import sys

import numpy as np

import exactvo

# A thousand robots on two circles, each to the opposite side. Positions are a view: nothing is copied from step to step.
count = 1000
angle = 2 * np.pi * np.arange(count) / count
circle = np.stack([np.cos(angle), np.sin(angle)], axis=1) * (180.0 + 3.0 * (np.arange(count) % 2))[:, None]
crowd = exactvo.Crowd(time_step=0.25, threads=0)
crowd.add_robots(circle, radius=0.5, max_speed=1.5)
crowd.add_obstacles([exactvo.Wall([(-5, -5), (5, 5)])])
positions = crowd.positions
crowd.head_for(-circle)
relaxed = sum(crowd.step(20).relaxed for _ in range(5))
print(f"{crowd}: {relaxed} of {100 * count} decisions had to give way")
print(f"on average {np.linalg.norm(positions - circle, axis=1).mean():.1f} m from where they began")

# Velocities of your own: write them into `preferred`.
crowd.follow_preferred()
crowd.preferred[:] = 0.8 * np.stack([-np.sin(angle), np.cos(angle)], axis=1)
crowd.step(10)
print(f"kept in the last step: {np.count_nonzero(crowd.kept)} robots")
told = crowd.explain(0)
print(f"robot 0 will choose {told.chosen} m/s; its nearest neighbours: {[n.robot for n in told.neighbours[:3]]}")

# A few robots with goals among obstacles: proven routes, every decision recorded and audited.
six = np.array([(np.cos(a), np.sin(a)) for a in np.linspace(0, 2 * np.pi, 6, endpoint=False)]) * 6.0
pillar = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
run = exactvo.simulate(exactvo.Scenario.build(six, -six, obstacles=[pillar], radius=0.4, max_speed=1.5, name="six"), record_all=True)
assert run.metrics["all_arrived"] and run.audit()["collisions"] == 0
print(run, "- audited: no collision")
if len(sys.argv) > 1:
    run.plot().figure.savefig(sys.argv[1], dpi=120)
