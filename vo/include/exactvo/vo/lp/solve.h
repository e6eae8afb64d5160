// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The deterministic incremental solver: double precision, order as given, bounded work on any input.

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// The velocity nearest `problem.preferred` that satisfies every constraint; if none does, the one that satisfies the
/// hard constraints and violates the soft ones least (smallest largest violation), and among those the nearest.
/// REQUIRES: finite numbers, normals not zero, a speed bound that is not empty (std::logic_error otherwise).
Solution solve(const Problem& problem);

}  // namespace exactvo::lp
