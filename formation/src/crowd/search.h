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
  const std::uint16_t* tag = nullptr;
};

/// Which robots become candidates of those from `begin` to `end`.
struct CandidateRule {
  std::size_t begin, end;
  std::int32_t low, high;  ///< y of robots of outer strips
  bool mixed;              ///< their kinds are asked for
};

/// Robots of the sorted order, side by side.
struct CandidateStretch {
  std::size_t from, to;
  bool outer;  ///< only those with low <= y <= high, unless robots of the rule are among them
};

/// Adds robots to `to`, in their order. self[i - begin]: which candidate robot i is; written to 2 kPack.
void add_candidates(const RobotColumns& robots, const CandidateRule& rule, const CandidateStretch* stretches,
                    std::size_t count, Candidates& to, std::int32_t* self);

/// What is asked for each of up to kPack robots.
struct LaneQuery {
  const std::int32_t *x = nullptr, *y = nullptr;  ///< read to kPack
  const std::int32_t* self = nullptr;             ///< by lane: its own number among the candidates
  std::uint32_t lanes = 0;                        ///< bit `lane`: holds a robot
  int ranks = 0;                                  ///< REQUIRES: as of ranks_sought
  float seen = 0;                                 ///< squared lattice steps within which all are candidates
  bool mixed = false;  ///< more than one kind: lists are cut off after as many neighbours as their lanes want
};

/// The nearest candidates of each lane, by squared distance in float cut to 16 bits below its leading one, then by
/// number. A lane's own robot is among them. Distances from none[lane] on do not count. If each lane's own robot is the
/// first of its list, counts neighbours and returns 0. If not, bit `lane`: another is.
std::uint32_t find_nearest(const Candidates& among, const LaneQuery& query, const LaneLimits& limits, Ranked& ranked,
                           LaneFinds& out);

/// The lengths of the lists. The first of each list is the lane's own robot.
void count_neighbours(const LaneQuery& query, const LaneLimits& limits, Ranked& ranked, LaneFinds& out);

}  // namespace exactvo::formation::crowd
