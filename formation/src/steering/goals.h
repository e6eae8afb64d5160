// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// How near to its goal number `goal` a robot has reached it, m: a goal on the way counts within the robot's own
/// radius.
inline double reach_of(const Scenario& scenario, const Robot& robot, std::size_t goal) {
  return goal + 1 == robot.goals.size() ? scenario.arrival_tolerance
                                        : std::max(scenario.arrival_tolerance, robot.radius);
}

/// Whether two robots cannot both be at their last goals: they would overlap.
inline bool are_too_near(const Scenario& scenario, std::size_t i, std::size_t j) {
  const Robot &a = scenario.robots[i], &b = scenario.robots[j];
  return norm(a.goals.back() - b.goals.back()) + 2.0 * scenario.arrival_tolerance < a.radius + b.radius;
}

}  // namespace exactvo::formation::detail
