// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Doubles inside the region of a problem. Exact in what is inside; heuristic in which double is found.

#include <optional>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// A double that `holds`, as near `target` as was found: itself, a neighbour, or the optimum with slack.
std::optional<Vec2> nearest_double_inside(const Problem& problem, Status status, Vec2 target);

/// `s` as an answer in float: the float nearest its velocity, among it and its neighbours, that keeps what must hold;
/// `no_interior` where none does.
Solution in_float(const Problem& problem, Solution s);

/// v with its coordinates cut off at the sides of the box.
Vec2 into_box(Vec2 v, const SpeedBound& bound);

}  // namespace exactvo::lp
