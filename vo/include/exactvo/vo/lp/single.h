// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One problem whose lines are arrays of the caller's: nothing is copied or allocated, and its lines are read a
/// register at a time (Highway picks the target at run time). See also: batch.h for many problems at once; solve.h
/// for boxes, linear objectives and normals of any length.

#include <cstddef>

#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// The arrays must be readable up to a multiple of `kSinglePadding` lines; what stands beyond `count` is not used.
inline constexpr std::size_t kSinglePadding = 8;

/// One problem in the caller's arrays.
struct SingleProblem {
  const double* normal_x = nullptr;  ///< with normal_y
  const double* normal_y = nullptr;  ///< | |normal| - 1 | <= 2^-10
  const double* offset = nullptr;    ///< m/s
  std::size_t count = 0;             ///< lines
  std::size_t hard = 0;              ///< the first so many are hard
  geometry::Vec2 preferred;          ///< m/s
  double disc = 0.0;                 ///< m/s, finite, > 0
};

/// Solves as a lane of `solve_batch` does, with the same slack and guarantees, but faster for one problem. What this
/// method cannot settle goes to `solve`, which allocates. Deterministic: the same bits on every target.
/// REQUIRES: finite numbers as described.
void solve_single(const SingleProblem& problem, Solution& answer);

/// The same with what `solve_certified` promises: `optimal` and `relaxed` hold exactly, and no velocity is better by
/// more than kWidestGap of certificate.h. Certified: the multipliers are proven in doubles with their rounding errors,
/// and what these cannot show goes to `solve_certified`, which allocates. False where there is no proof either.
bool solve_single_certified(const SingleProblem& problem, Solution& answer);

}  // namespace exactvo::lp
