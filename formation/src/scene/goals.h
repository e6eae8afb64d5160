// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/infinity.h"
#include "scene/number_text.h"

namespace exactvo::formation::detail {

/// m, of all robots.
inline double largest_radius(const std::vector<Robot>& robots) {
  double largest = 0.0;
  for (const Robot& r : robots) largest = std::max(largest, r.radius);
  return largest;
}
/// m, of the robots in `who`.
inline double largest_radius(const std::vector<Robot>& robots, const std::vector<std::size_t>& who) {
  double largest = 0.0;
  for (const std::size_t i : who) largest = std::max(largest, robots[i].radius);
  return largest;
}

/// How near to its goal number `goal` a robot has reached it, m: a goal on the way counts within the robot's own
/// radius. `tolerance`: m, of arrival.
inline double reach_of(const Robot& robot, std::size_t goal, double tolerance) {
  return goal + 1 == robot.goals.size() ? tolerance : std::max(tolerance, robot.radius);
}

/// m/s^2, of a robot's velocity, or of its wheels; infinite where the velocity may jump.
inline double acceleration_of(const Scenario& scenario, std::size_t robot) {
  const std::optional<DifferentialDrive>& drive = scenario.robots[robot].drive;
  if (drive) return drive->max_wheel_acceleration;
  return scenario.acceleration ? scenario.acceleration->max : geometry::kInfinity;
}

/// m/s: from which a robot comes to rest after `way` (m) where its speed falls by `acceleration * time_step` a step.
inline double speed_to_stop_within(double way, double time_step, double acceleration) {
  // A speed u that ends in k steps goes T (k u - A T k (k - 1) / 2) in them.
  const double change = acceleration * time_step;
  const double steps = std::max(1.0, std::ceil(0.5 * (std::sqrt(1.0 + 8.0 * way / (change * time_step)) - 1.0)));
  return way / (steps * time_step) + 0.5 * change * (steps - 1.0);
}

/// m/s: straight for a place, to be there after a step or as soon as the speed allows, and at rest there where the
/// acceleration (m/s^2) is bounded.
inline Vec2 straight_for(Vec2 here, double max_speed, Vec2 place, double time_step, double acceleration) {
  const Vec2 way = place - here;
  const double most = acceleration < geometry::kInfinity ? speed_to_stop_within(norm(way), time_step, acceleration)
                                                         : norm(way) / time_step;
  return std::min(max_speed, most) * geometry::normalized(way);
}

/// Whether two robots cannot both be at their last goals: they would overlap. `tolerance`: m, of arrival.
inline bool are_too_near(const Robot& a, const Robot& b, double tolerance) {
  return norm(a.goals.back() - b.goals.back()) + 2.0 * tolerance < a.radius + b.radius;
}

/// "R1 was first at its goal, 0.3 m from that of R2".
inline std::string first_at_goal_words(const Robot& first, const Robot& other) {
  if (first.goals.back() == other.goals.back()) return first.id + " was first at the goal that both have";
  return first.id + " was first at its goal, " + metres(norm(first.goals.back() - other.goals.back())) +
         " from that of " + other.id;
}

/// "2 of 60 robots did not arrive within the time limit": how a run ended, for its outcome.
inline std::string arrival_words(std::size_t arrived, std::size_t all, bool is_out_of_time) {
  if (arrived == all) return all == 1 ? "the robot arrived" : "all robots arrived";
  const std::string until = is_out_of_time ? " within the time limit" : "";
  if (all == 1) return "the robot did not arrive" + until;
  return (arrived == 0 ? "none of " + std::to_string(all) + " robots arrived"
                       : std::to_string(all - arrived) + " of " + std::to_string(all) + " robots did not arrive") +
         until;
}

}  // namespace exactvo::formation::detail
