// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The exact solver: the optimum as an algebraic point, rounded inward.

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::lp {

/// The exact answer, rounded, with its certificate.
Proven solve_exactly(const Problem& problem);

}  // namespace exactvo::lp
