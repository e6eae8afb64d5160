// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The sets Cm: problems recorded from the circle scenario, by this project's own reciprocal half-planes.

#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::bench {

/// 250 robots on a circle of radius 200 m with antipodal goals, r = 1.5, v_max = 2, tau = 10, dt = 0.25, at most m
/// neighbours, nearest first: every decision with exactly m lines, evenly thinned to at most `most`.
/// REQUIRES: m is one of 5, 10, 20, 50, 100.
std::vector<lp::Problem> record_circle(int m, std::size_t most);

}  // namespace exactvo::bench
