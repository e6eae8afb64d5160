// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The right answer by brute force: every crossing of two lines is tried, verdicts in rationals, values in 100 digits.
/// O(m^3) and slow on purpose; shares no idea and no code with the solvers.

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp::oracle {

/// Exact: whether some velocity keeps the speed bound and every constraint (only the hard ones where `hard_only`).
bool is_feasible(const Problem& problem, bool hard_only);

/// optimal, relaxed or infeasible. Exact.
Status verdict(const Problem& problem);

/// min |v - preferred|^2 over the feasible region, to double. REQUIRES: feasible, Objective::nearest.
double least_squared_distance(const Problem& problem);

/// max preferred . v over the feasible region, to double. REQUIRES: feasible.
double farthest(const Problem& problem);

/// The least largest violation: of the soft constraints with the hard ones kept, or of the hard ones. To double.
/// REQUIRES: a verdict of `relaxed` or `infeasible`.
double least_violation(const Problem& problem);

}  // namespace exactvo::lp::oracle
