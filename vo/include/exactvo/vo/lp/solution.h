// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a solver returns: a value, never an exception.

#include <array>
#include <cstddef>

#include "exactvo/geometry/vec2.h"

namespace exactvo::lp {

enum class Status {
  optimal,    ///< every constraint holds
  relaxed,    ///< the soft ones had to give: the largest violation is the least possible
  infeasible  ///< the hard ones contradict each other or the speed bound
};

/// Index of a constraint of the problem, or the speed bound.
inline constexpr std::size_t kSpeedBound = static_cast<std::size_t>(-1);

struct Solution {
  geometry::Vec2 velocity;  ///< m/s
  Status status = Status::optimal;
  std::array<std::size_t, 2> active{};  ///< what binds: constraint indices or kSpeedBound
  std::size_t active_count = 0;         ///< 0, 1 or 2
  double violation = 0.0;               ///< m/s, the largest of a soft constraint; 0 where optimal
};

}  // namespace exactvo::lp
