// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// RVO and HRVO (van den Berg, Lin and Manocha 2008; Snape et al. 2011) as methods: a robot takes the velocity nearest
/// to its preferred one outside the cones of the others (vo/family.h). What cones leave is not convex. A search chooses
/// beside which side of each cone to go; then a half-plane stands for each cone, as in the other methods.
///
/// Heuristic: the side. The half-plane excludes the inside of its cone, but no pair of robots is promised anything:
/// each cone assumes that the other robot takes the other half of the change.

#include <cstddef>
#include <vector>

#include "decision/decision.h"

namespace exactvo::formation::detail {

/// Replaces the half-planes of robot i against robots that cooperate. Pairs in contact keep those of orca. Others are
/// left as they are: the robot takes the whole change. REQUIRES: a method without promises between robots.
void take_sides(const RobotsAt& now, std::size_t i, Vec2 preferred, std::vector<Constraint>& others);

}  // namespace exactvo::formation::detail
