// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "scene/number_text.h"

namespace exactvo::formation::detail {

/// m, of all robots.
inline double largest_radius(const Scenario& scenario) {
  double largest = 0.0;
  for (const Robot& r : scenario.robots) largest = std::max(largest, r.radius);
  return largest;
}
/// m, of the robots in `who`.
inline double largest_radius(const Scenario& scenario, const std::vector<std::size_t>& who) {
  double largest = 0.0;
  for (const std::size_t i : who) largest = std::max(largest, scenario.robots[i].radius);
  return largest;
}

/// How near to its goal number `goal` a robot has reached it, m: a goal on the way counts within the robot's own
/// radius.
inline double reach_of(const Scenario& scenario, const Robot& robot, std::size_t goal) {
  return goal + 1 == robot.goals.size() ? scenario.arrival_tolerance
                                        : std::max(scenario.arrival_tolerance, robot.radius);
}

/// m/s: straight for a place, to be there after a step or as soon as the speed allows.
inline Vec2 straight_for(Vec2 here, double max_speed, Vec2 place, double time_step) {
  const Vec2 way = place - here;
  return std::min(max_speed, norm(way) / time_step) * geometry::normalized(way);
}

/// Whether two robots cannot both be at their last goals: they would overlap.
inline bool are_too_near(const Scenario& scenario, std::size_t i, std::size_t j) {
  const Robot &a = scenario.robots[i], &b = scenario.robots[j];
  return norm(a.goals.back() - b.goals.back()) + 2.0 * scenario.arrival_tolerance < a.radius + b.radius;
}

/// "R1 was first at its goal, 0.3 m from that of R2".
inline std::string first_at_goal_words(const Scenario& scenario, std::size_t first, std::size_t other) {
  const Robot &a = scenario.robots[first], &b = scenario.robots[other];
  if (a.goals.back() == b.goals.back()) return a.id + " was first at the goal that both have";
  return a.id + " was first at its goal, " + metres(norm(a.goals.back() - b.goals.back())) + " from that of " + b.id;
}

}  // namespace exactvo::formation::detail
