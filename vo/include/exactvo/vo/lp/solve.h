// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The deterministic incremental solver: double precision, order as given, bounded work on any input.

#include <vector>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// The velocity nearest `problem.preferred` that satisfies every constraint; if none does, the one that satisfies the
/// hard constraints and violates the soft ones least (smallest largest violation), and among those the nearest.
///
/// Rounded inward: the constraints are solved with a slack of 16 u V (u = 2^-53, V the largest speed in play), so that
/// the velocity returned satisfies them exactly wherever the region is wider than that. The verdict is heuristic where
/// the region is thinner: a feasible problem may come back `relaxed` with a violation of a few u V.
/// REQUIRES: see `require_well_formed`.
Solution solve(const Problem& problem);

/// Where the solver looked for the constraint that is violated most.
struct Pricing {
  std::vector<Vec2> at;  ///< m/s, the answer last
  bool is_all = false;   ///< the answer rests on these alone; false where constraints were relaxed
};

/// The same answer. Where `pricing.is_all`, a constraint with a normal of about unit length that at each of these
/// velocities either holds with room to spare or is violated clearly less than some other could be added to the problem
/// or left out: velocity, status and what binds stay the same bits. With room, clearly: beyond 1024 u V and the
/// rounding of the constraint's own excess.
Solution solve(const Problem& problem, Pricing& pricing);

}  // namespace exactvo::lp
