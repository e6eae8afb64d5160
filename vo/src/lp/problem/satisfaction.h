// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which constraints a velocity satisfies, and which an answer has to.

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// Whether an answer of that status must satisfy the constraint: all (optimal), the hard ones (relaxed), none
/// (infeasible).
bool must_hold(const Constraint& c, Status status);

/// Whether v satisfies the speed bound and all that `must_hold`. Exact.
bool holds(const Problem& problem, Status status, Vec2 v);

/// The largest violation of the constraints that may give: soft (relaxed), hard (infeasible), all (no_interior).
/// Rounded.
double violation_that_counts(const Problem& problem, Status status, Vec2 v);

}  // namespace exactvo::lp
