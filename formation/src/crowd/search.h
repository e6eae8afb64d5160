// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The nearest of a table of candidates to each of up to sixteen robots, one per SIMD lane.

#include "crowd/layout.h"

namespace exactvo::formation::crowd {

/// Ranks for which there is code: the least of these that is at least `wanted`.
int ranks_sought(int wanted);

/// Robots side by side, as of Robots; arrays are read to a multiple of kPack.
struct RobotColumns {
  const std::int32_t *x = nullptr, *y = nullptr, *mx = nullptr, *my = nullptr;
};

/// Adds those of `count` robots with low <= y <= high, in their order, as candidates but for their kinds.
void add_between(const RobotColumns& robots, std::size_t count, std::int32_t low, std::int32_t high, Candidates& to);

/// The `ranks` nearest candidates of each lane, by squared distance in float cut to 16 bits below its leading one, then
/// by number. A lane's own robot is among them. Distances from none[lane] on do not count. `x` and `y` are read to
/// kPack. REQUIRES: ranks as of ranks_sought.
void find_nearest(const Candidates& among, const std::int32_t* x, const std::int32_t* y, const float* none, int ranks,
                  Ranked& out);

/// Bit `lane`: not its own robot, candidate self[lane], is the first of its list.
std::uint32_t lanes_behind_others(const Ranked& ranked, const std::int32_t* self);

/// Who has how many. The first of each list is the lane's own robot. `seen`: squared lattice steps within which all are
/// candidates. Of more than one kind (`mixed`), lists are cut off after as many neighbours as their lanes want.
void count_neighbours(const LaneLimits& limits, float seen, int ranks, bool mixed, Ranked& ranked, LaneFinds& out);

}  // namespace exactvo::formation::crowd
