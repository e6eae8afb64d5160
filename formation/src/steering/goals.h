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

}  // namespace exactvo::formation::detail
