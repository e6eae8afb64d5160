// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The neighbours of robots that stand next to each other in the sorted order, up to sixteen at once: they share the
/// candidates of one window, which is widened until no nearer robot can be missing.

#include "crowd/kinds.h"
#include "crowd/layout.h"
#include "crowd/robots.h"

namespace exactvo::formation::crowd {

/// How much farther than the last neighbour of the step before a search goes at first; how much farther after that.
inline constexpr double kFirstReach = 1.04, kWiderReach = 1.35;

/// Cutting the number's bits lowers a squared distance by 2^-15 of it at most.
inline constexpr double kWholeKey = 1.0 - 0x1p-13;

/// Robots that are searched for together, and what was found.
struct Pack {
  static constexpr std::int64_t kKeptStretches = 8;

  std::size_t begin = 0, end = 0;
  Window box;
  double reach;  ///< lattice steps, how far it looks
  Cells cells;
  Stretch stretches[kKeptStretches];  ///< of the first rows of cells
  std::size_t candidates;
  int ranks = 0;               ///< the last at which a lane has somebody
  std::uint32_t alone = 0;     ///< lanes that are decided alone
  std::uint32_t touching = 0;  ///< lanes that touch another robot
  std::int32_t neighbours[kPack];

  std::size_t size() const { return end - begin; }
  /// Bit `lane`: holds a robot.
  std::uint32_t lanes() const { return (1U << size()) - 1U; }
  /// False: one robot with too many candidates.
  bool is_searched() const { return candidates <= kMostCandidates; }
  void clear() { ranks = 0, alone = touching = 0; }
};

/// One per thread.
struct PackBuffers {
  Candidates others;
  Ranked ranked;
  LaneLimits limits;
  LaneFinds finds;
  alignas(64) std::int32_t self[2 * kPack];  ///< by lane: its own number among the others
};

/// Into `pack` the robots from `begin` on, before `last`, and into `out` their neighbours. Writes the hints of these
/// robots.
void find_pack(Robots& robots, const ReachTable& table, std::size_t begin, std::size_t last, Pack& pack,
               PackBuffers& out);

}  // namespace exactvo::formation::crowd
