// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The motion nearest to a wish where one row binds or two, by KKT: a row a SIMD lane, without branches that depend on
/// rows, which processors do not foresee. Whether rows allow a motion is exact: all numbers are whole, and products
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

struct FewRows {
  static constexpr std::size_t kMost = 16;

  Motion wish;
  double squared_disc = 0.0;  ///< squared lattice steps: no farther from 0 before it is rounded
  double squared_way = 0.0;   ///< and no farther after
  std::size_t count = 0;
  alignas(64) double x[kMost], y[kMost], least[kMost];

  bool has_room() const { return count < kMost; }
  /// (side normal).m >= its_least
  void add(double side, double normal_x, double normal_y, double its_least) {
    x[count] = side * normal_x;
    y[count] = side * normal_y;
    least[count++] = its_least;
  }
};

/// not_allowed: `m` is the rounded motion, which a row does not allow or which is too far. not_found: more than two
/// rows bind, or the linear program decides.
enum class Few { allowed, not_allowed, not_found };

/// Exact where it is `allowed`.
Few nearest_of_few(FewRows& rows, Motion& m);

}  // namespace exactvo::formation::crowd
