// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Last goals that are too near to each other for all who have them: who is there first keeps its own for good, the
/// others stay beside it.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "liveness/cells.h"
#include "steering/goals.h"

namespace exactvo::formation::detail {

class GoalClaims {
 public:
  /// `scenario` must outlive it. REQUIRES: robots with goals.
  explicit GoalClaims(const Scenario& scenario)
      : scenario_(scenario), largest_(detail::largest_radius(scenario)), by_goal_(4.0 * largest_) {}

  double largest_radius() const { return largest_; }  ///< m, of all robots

  /// Whether any two last goals are too near to each other.
  bool are_needed() const {
    Cells<std::size_t> goals(4.0 * largest_);
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      if (nearest_in(goals, i)) return true;
      goals.add(scenario_.robots[i].goals.back(), i);
    }
    return false;
  }

  /// Robot `i` is at its last goal, which nobody has taken.
  void claim(std::size_t i) { by_goal_.add(scenario_.robots[i].goals.back(), i); }

  /// Who was first at a last goal too near to that of robot `i`; of several the nearest.
  std::optional<std::size_t> taken_by(std::size_t i) const { return nearest_in(by_goal_, i); }

 private:
  std::optional<std::size_t> nearest_in(const Cells<std::size_t>& goals, std::size_t i) const {
    const Vec2 goal = scenario_.robots[i].goals.back();
    std::optional<std::size_t> nearest;
    const auto distance_of = [&](std::size_t j) { return norm(scenario_.robots[j].goals.back() - goal); };
    goals.for_each_about(goal, scenario_.robots[i].radius + largest_, [&](std::size_t j) {
      if (j != i && are_too_near(scenario_, i, j) && (!nearest || distance_of(j) < distance_of(*nearest))) nearest = j;
    });
    return nearest;
  }

  const Scenario& scenario_;
  double largest_;  ///< m
  Cells<std::size_t> by_goal_;
};

}  // namespace exactvo::formation::detail
