// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The sets Cm and Bm: problems recorded from two scenarios simulated here with this project's own half-planes. The
/// same on every machine whose C library rounds sine and cosine alike.
///
/// Circle: 250 robots on a circle of radius 200 m with antipodal goals, r = 1.5, v_max = 2, tau = 10, dt = 0.25.
/// Blocks: four groups of 25 robots, r = 1.5, at the corners of a square with four blocks of 30 m between which they
/// cross to the opposite corner; the lines of the blocks are hard and come first.
/// Robots see at most m neighbours, nearest first, within 15, 15, 22, 34, 48 m for m = 5, 10, 20, 50, 100.

#include <string>
#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::bench {

/// Whether `name` is C<m> or B<m> with an m from the list above.
bool is_recorded_set(const std::string& name);

/// Every decision with exactly m lines, in order of time, evenly thinned to at most `most`. REQUIRES: is_recorded_set.
std::vector<lp::Problem> record(const std::string& name, std::size_t most);

}  // namespace exactvo::bench
