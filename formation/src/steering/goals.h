// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>

#include "control/consensus.h"
#include "steering/remedies.h"

namespace exactvo::formation::detail {

/// How near to its goal number `goal` a robot has reached it, m: a goal on the way counts within the robot's own
/// radius.
inline double reach_of(const Scenario& scenario, const Robot& robot, std::size_t goal) {
  return goal + 1 == robot.goals.size() ? scenario.arrival_tolerance
                                        : std::max(scenario.arrival_tolerance, robot.radius);
}

/// What the enclosures of a robot are fitted for at the start: its first goal, or its slot at the leader's end.
inline Vec2 first_goal(const Scenario& scenario, const SimulationOptions& options, std::size_t robot) {
  if (!scenario.formation) return scenario.robots[robot].goals.front();
  return scenario.formation->leader.path.back() +
         offsets_in_use(*scenario.formation, remedies_in_use(scenario, options))[robot];
}

}  // namespace exactvo::formation::detail
