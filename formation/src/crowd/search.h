// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The nearest of a table of candidates to each of up to sixteen robots, one per SIMD lane.

#include "crowd/layout.h"

namespace exactvo::formation::crowd {

/// Ranks for which there is code: the least of these that is at least `wanted`.
int ranks_sought(int wanted);

/// The `ranks` nearest candidates of each lane, by squared distance in float cut to 16 bits below its leading one, then
/// by number. A lane's own robot is among them. Distances from none[lane] on do not count. `x` and `y` are read to
/// kPack. REQUIRES: ranks as of ranks_sought.
void find_nearest(const Candidates& among, const std::int32_t* x, const std::int32_t* y, const float* none, int ranks,
                  Ranked& out);

}  // namespace exactvo::formation::crowd
