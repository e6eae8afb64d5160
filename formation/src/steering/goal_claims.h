// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where ways end, at last goals (last_places.h) or as near to them as robots can get: places too near to each other
/// for all who have them. Who is there first keeps its own for good, the others stay beside it.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "liveness/cells.h"
#include "steering/goals.h"
#include "steering/last_places.h"

namespace exactvo::formation::detail {

class GoalClaims {
 public:
  /// `scenario` must outlive it. REQUIRES: robots with goals.
  explicit GoalClaims(const Scenario& scenario)
      : scenario_(scenario),
        largest_(detail::largest_radius(scenario)),
        places_(scenario.robots.size()),
        claimed_(4.0 * largest_) {}

  double largest_radius() const { return largest_; }  ///< m, of all robots

  /// Whether any two of these places are too near to each other; a place a robot.
  bool are_needed(const std::vector<Vec2>& places) const {
    Cells<std::size_t> before(4.0 * largest_);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (nearest_in(before, places, i, places[i])) return true;
      before.add(places[i], i);
    }
    return false;
  }

  /// Robot `i` is where its way ends, a place that nobody has taken.
  void claim(std::size_t i, Vec2 place) {
    places_[i] = place;
    claimed_.add(place, i);
  }
  /// REQUIRES: robot `i` has claimed it.
  Vec2 place_of(std::size_t i) const { return places_[i]; }

  /// Who was first at a place too near to that where the way of robot `i` ends; of several the nearest.
  std::optional<std::size_t> taken_by(std::size_t i, Vec2 place) const {
    return nearest_in(claimed_, places_, i, place);
  }

 private:
  std::optional<std::size_t> nearest_in(const Cells<std::size_t>& others, const std::vector<Vec2>& places,
                                        std::size_t i, Vec2 place) const {
    std::optional<std::size_t> nearest;
    const auto distance_of = [&](std::size_t j) { return norm(places[j] - place); };
    const double reach = scenario_.robots[i].radius + largest_ + scenario_.margins.robot;
    others.for_each_about(place, reach, [&](std::size_t j) {
      if (j != i && leave_no_room(scenario_, i, j, distance_of(j)) &&
          (!nearest || distance_of(j) < distance_of(*nearest)))
        nearest = j;
    });
    return nearest;
  }

  const Scenario& scenario_;
  double largest_;            ///< m
  std::vector<Vec2> places_;  ///< by robot; of those that have claimed one
  Cells<std::size_t> claimed_;
};

}  // namespace exactvo::formation::detail
