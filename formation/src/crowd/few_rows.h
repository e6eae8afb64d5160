// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The motion nearest to a wish where one row binds or two, by KKT: one robot in each SIMD lane. A robot alone takes
/// branches that processors do not foresee. Whether rows allow a motion is exact: all numbers are whole, and products
/// stay below 2^44. The way that is rounded is heuristic in the last digits, like the linear program; every target
/// gives the same bits.

#include <cstddef>

#include "crowd/pair_row.h"

namespace exactvo::formation::crowd {

/// std::nearbyint, which is a call on targets before SSE4.1. |value| < 2^51.
inline double nearest_whole(double value) {
  constexpr double kWholeOnly = 0x1.8p52;
  return (value + kWholeOnly) - kWholeOnly;
}

inline Motion whole(double x, double y) {
  return {static_cast<std::int32_t>(nearest_whole(x)), static_cast<std::int32_t>(nearest_whole(y))};
}

/// The rows of up to kLanes robots. Each lane holds one robot.
struct FewRows {
  static constexpr std::size_t kMost = 16, kLanes = 8;

  std::size_t robots = 0;
  std::size_t count[kLanes] = {};  ///< rows of each
  alignas(64) double wish_x[kLanes], wish_y[kLanes];
  alignas(64) double squared_disc[kLanes];  ///< squared lattice steps: no farther from 0 before it is rounded
  alignas(64) double squared_way[kLanes];   ///< and no farther after
  alignas(64) double x[kMost][kLanes], y[kMost][kLanes], least[kMost][kLanes];

  /// Adds to the next robot the row (side normal).m >= its_least. False where there is no room. REQUIRES: robots <
  /// kLanes.
  bool add(double side, double normal_x, double normal_y, double its_least) {
    const std::size_t k = count[robots];
    if (k == kMost) return false;
    x[k][robots] = side * normal_x;
    y[k][robots] = side * normal_y;
    least[k][robots] = its_least;
    ++count[robots];
    return true;
  }
  /// The next robot has all its rows.
  void finish(Motion wish, double its_squared_disc, double its_squared_way) {
    wish_x[robots] = wish.x, wish_y[robots] = wish.y;
    squared_disc[robots] = its_squared_disc, squared_way[robots] = its_squared_way;
    ++robots;
  }
  /// The next robot has too many rows.
  void drop() { count[robots] = 0; }
};

/// not_allowed: `m` is the rounded motion, which a row does not allow or which is too far. not_found: more than two
/// rows bind, or the linear program decides.
enum class Few { allowed, not_allowed, not_found };

/// Writes the answer for each robot into arrays of kLanes, `m` only where one was found. An answer `allowed` is exact.
/// Leaves no robot in `rows`.
void nearest_of_few(FewRows& rows, Few* found, Motion* m);

}  // namespace exactvo::formation::crowd
