// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One problem whose lines are arrays of the caller's: nothing is copied or allocated, and its lines are looked at a
/// register at a time (Highway picks the target at run time). For who has one problem now; for many see batch.h, for
/// boxes, linear objectives and lines of any length solve.h.

#include <cstddef>

#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// The arrays must be readable up to a multiple of `kSinglePadding` lines; what stands beyond `count` is not used.
inline constexpr std::size_t kSinglePadding = 8;

struct SingleProblem {
  const double* normal_x = nullptr;
  const double* normal_y = nullptr;  ///< | |normal| - 1 | <= 2^-10
  const double* offset = nullptr;    ///< m/s
  std::size_t count = 0;             ///< lines
  std::size_t hard = 0;              ///< the first so many are hard
  geometry::Vec2 preferred;          ///< m/s
  double disc = 0.0;                 ///< m/s, finite, > 0
};

/// The slack and the promises of a lane of `solve_batch`, by a shorter way; what the way cannot settle goes to `solve`,
/// which allocates. Deterministic: the same bits on every target. REQUIRES: finite numbers as described.
Solution solve_single(const SingleProblem& problem);

/// The same into a place of the caller's, which saves copying what has just been written.
void solve_single(const SingleProblem& problem, Solution& answer);

/// The same with what `solve_certified` promises: `optimal` and `relaxed` hold exactly, and no velocity is better by more
/// than kWidestGap of certificate.h. Certified: the multipliers are proven in doubles with their rounding errors, and
/// what these cannot show goes to `solve_certified`, which allocates. False where there is no proof either.
bool solve_single_certified(const SingleProblem& problem, Solution& answer);

/// Whether v keeps every line, hard or soft, and the disc. Exact. With certified half-planes of velocity obstacles this
/// is the proof that v lies in the interior of none. REQUIRES: finite numbers.
bool keeps(const SingleProblem& problem, geometry::Vec2 v);

/// For who wants an answer that keeps everything or none: true where `velocity` is one that `keeps`, the nearest to the
/// preferred one up to rounding inward as `solve_single` does. False, and no more is said, where no velocity keeps
/// everything or so few do that there is no room to round inward (of a disc below 2^-200 m/s, none do). Up to 16 lines
/// nothing is relaxed or allocated on the way; of more, it is as `solve_single`. A robot among obstacles that stand
/// still can then stop: v = 0 keeps all their half-planes. REQUIRES: as `solve_single`.
bool solve_keeping(const SingleProblem& problem, geometry::Vec2& velocity);

}  // namespace exactvo::lp
