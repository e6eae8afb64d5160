#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Benchmark the linear program: a batch of problems on arrays in place, first checked against the exact solver."""
import time

import numpy as np

import exactvo
from exactvo import lp

PROBLEMS, LINES = 20_000, 10
rng = np.random.default_rng(1)

# `batch_arrays` gives arrays in the order of the SIMD lanes; solve_batch then copies nothing.
normals, offsets, preferred = lp.batch_arrays(PROBLEMS, LINES)
angle = rng.uniform(0, 2 * np.pi, (PROBLEMS, LINES))
normals[..., 0], normals[..., 1] = np.cos(angle), np.sin(angle)
offsets[:] = -rng.uniform(0, 1.5, (PROBLEMS, LINES))  # v = 0 keeps every line
preferred[:] = rng.uniform(-2, 2, (PROBLEMS, 2))

# Equality first, then time.
proven = lp.solve_batch(normals, offsets, preferred, max_speed=2.0, prove=True, copy=False)
assert proven.proven is not None and proven.proven.all()
for k in range(0, PROBLEMS, PROBLEMS // 50):
    exact = lp.solve(normals[k], offsets[k], preferred[k], max_speed=2.0, solver="exact")
    assert np.allclose(proven.velocity[k], exact.velocity, atol=1e-9)

for words, prove in (("", False), (", every answer proven", True)):
    best = float("inf")
    for _ in range(5):
        before = time.perf_counter()
        lp.solve_batch(normals, offsets, preferred, max_speed=2.0, copy=False, prove=prove)
        best = min(best, time.perf_counter() - before)
    print(f"{1e9 * best / PROBLEMS:.0f} ns a problem of {LINES} lines{words}")

# What a call costs by itself: a batch of one problem.
one = lp.batch_arrays(1, 4)
before = time.perf_counter()
for _ in range(10_000):
    lp.solve_batch(*one, max_speed=2.0)
print(f"{1e6 * (time.perf_counter() - before) / 10_000:.2f} us a call for one problem of 4 lines")

# Certificates as arrays: stored beside the answers, checked later in rationals by code that knows no solver.
few = (normals[:1000], offsets[:1000], preferred[:1000])
batch = lp.solve_batch(*few, max_speed=2.0, certificates=True)
assert batch.certificates is not None
assert lp.check_batch(*few, batch.certificates, max_speed=2.0).all()
print(batch, "with", batch.certificates)
print("exactvo", exactvo.__version__)
