// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a solver returns: a value, never an exception.

#include <array>
#include <cstddef>

#include "exactvo/geometry/vec2.h"
#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

enum class Status {
  optimal,     ///< every constraint and the speed bound hold, exactly, for the doubles returned
  relaxed,     ///< the soft ones had to give: the largest violation is the least possible; the hard ones hold exactly
  infeasible,  ///< the hard ones contradict each other or the speed bound; velocity violates them least
  pinched      ///< what must hold can be held, but by no double that was found: it leaves no room to round inward
};

/// "optimal", "relaxed", "infeasible", "pinched".
const char* name(Status status);

struct Solution {
  geometry::Vec2 velocity;  ///< m/s
  Status status = Status::optimal;
  std::array<std::size_t, 3> active{};  ///< what binds: constraint indices, kSpeedBound or a side of the box
  std::size_t active_count = 0;         ///< at most 2 where optimal, at most 3 elsewhere
  /// m/s. relaxed: the largest of a soft constraint; infeasible: the largest of a hard one; pinched: the largest of
  /// any, about a rounding error; 0 where optimal. In units of the constraint's own |normal|, rounded.
  double violation = 0.0;
};

}  // namespace exactvo::lp
