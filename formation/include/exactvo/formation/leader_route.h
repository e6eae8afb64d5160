// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The virtual leader's path as a proven route (geometry/routes.h): for a disc about the leader that holds the whole
/// formation, or where that does not fit for the largest of its robots, with the margin that robots keep, as far as the
/// way has room for it.
///
/// That such a disc has a route, and that it has none, is exact; the points of the path are rounded. The path does not
/// promise that robots in their slots keep clear; their half-planes do.

#include <optional>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// From where and to where.
struct LeaderGoal {
  Vec2 to;                   ///< m
  std::optional<Vec2> from;  ///< m; none: where the robots are nearest to their slots, the mean of start less offset
};

/// Puts the path of the scenario's leader in place, with `why_short` and `note`; its speed or profile stays. Where
/// `goal.to` is out of reach the path is its start alone, or leads as near as can be (`Scenario::unreachable`).
/// REQUIRES: a formation with an offset for each robot, valid obstacles, finite numbers.
void plan_leader(Scenario& scenario, const LeaderGoal& goal);

}  // namespace exactvo::formation
