// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// By how much a velocity breaks half-planes and the disc, in exact arithmetic: what doubles say of an answer that lies
/// on a line is their own rounding (5.6e-17 m/s and the like), and would hide whether a solver keeps what it says it
/// keeps.

#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::bench {

/// The largest c - n.v of the constraints, 0 where all hold, m/s times |n|. Exact in sign, truncated to double; the
/// largest double for a velocity that is not finite.
double worst_violation(const std::vector<lp::Constraint>& constraints, lp::Vec2 velocity);

/// The same for the constraints and the disc, |v| - disc, m/s. REQUIRES: a finite disc.
double worst_breach(const lp::Problem& problem, lp::Vec2 velocity);

}  // namespace exactvo::bench
