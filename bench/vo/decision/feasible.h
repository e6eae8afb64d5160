// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A velocity that keeps every line of a problem, and an exact look at it: what a proven decision needs of the linear
/// program, without a proof that the velocity is the best one.

#include "exactvo/vo/lp/solve.h"

namespace exactvo::bench {

/// Whether v keeps every line, hard or soft, and the disc. Exact. With certified half-planes of velocity obstacles this
/// is the proof that v lies in the interior of none. REQUIRES: finite numbers.
bool keeps(const lp::SingleProblem& problem, geometry::Vec2 v);

/// Finds a velocity that keeps every constraint, or none. True: `velocity` satisfies `keeps`, and is the nearest to the
/// preferred one up to the inward rounding of `solve`. False: no velocity keeps everything, or too few do to
/// round inward (for a disc below 2^-200 m/s always); `velocity` then means nothing. A robot among static obstacles can
/// stop in this case, since v = 0 keeps all their half-planes. With at most 16 lines nothing is relaxed or allocated;
/// with more it works as `solve` does. REQUIRES: as `solve`.
bool solve_feasible(const lp::SingleProblem& problem, geometry::Vec2& velocity);

}  // namespace exactvo::bench
