// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The exact solver: the optimum as an algebraic point, rounded inward.

#include <vector>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::lp {

/// The exact answer, rounded, with its certificate; `guess` names constraints that may bind (changes the cost only).
Proven solve_exactly(const Problem& problem, const std::vector<Binding>& guess);

}  // namespace exactvo::lp
