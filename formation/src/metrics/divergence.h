// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far a formation is from its slots, and when it has diverged.

#include <algorithm>
#include <vector>

#include "exactvo/formation/recording.h"

namespace exactvo::formation::detail {

/// m and m/s: beyond this nothing is worth computing (an explicit Euler step past its limit gets here in seconds).
inline constexpr double kOutOfBounds = 1e6;

inline bool is_out_of_bounds(Vec2 position, Vec2 velocity) {
  return !(geometry::norm(position) < kOutOfBounds && geometry::norm(velocity) < kOutOfBounds);
}

/// m: how far a robot is from its slot.
inline double slot_error(const Step& row, const std::vector<Vec2>& offsets, std::size_t robot) {
  return geometry::norm(row.robots[robot].position - row.leader_position - offsets[robot]);
}

/// m: the largest distance of a robot from its slot.
inline double formation_error(const Step& row, const std::vector<Vec2>& offsets) {
  double worst = 0.0;
  for (std::size_t i = 0; i < row.robots.size(); ++i) worst = std::max(worst, slot_error(row, offsets, i));
  return worst;
}

/// m: what moves less in a time step rests.
inline constexpr double kRestsWithin = 2e-4;

/// m: the error of the robots that a formation can still lose. A robot that rests while the leader rests stays where it
/// is: beside a slot that cannot be filled, in a trap or in a deadlock.
/// `time_step`: s, of the run.
inline double error_of_moving(const Step& row, const std::vector<Vec2>& offsets, double time_step) {
  const auto rests = [time_step](Vec2 velocity) { return time_step * geometry::norm(velocity) < kRestsWithin; };
  const bool leader_rests = rests(row.leader_velocity);
  double worst = 0.0;
  for (std::size_t i = 0; i < row.robots.size(); ++i)
    if (!leader_rests || !rests(row.robots[i].velocity)) worst = std::max(worst, slot_error(row, offsets, i));
  return worst;
}

/// Judged by the end alone: a formation that moves and is farther from its slots than it began does not form.
/// `first_error`: m, of the first row. `last_error`: m, `error_of_moving` of the last one.
inline bool has_diverged(double first_error, double last_error) {
  constexpr double kArrivedOnce = 1.0;  // m: an error this small is no divergence even when the start was exact
  return last_error > std::max(first_error, kArrivedOnce);
}

}  // namespace exactvo::formation::detail
