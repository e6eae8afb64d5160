// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The search for a joint plan (liveness, rule R3): searches with other seeds, one after the other, until a counted
/// budget is spent. It returns the shortest of the plans found.
///
/// Restarted with growing limits, since the lengths of such searches are heavy-tailed (Luby, Sinclair and Zuckerman,
/// "Optimal speedup of Las Vegas algorithms", Information Processing Letters 47, 1993).

#include <cstdint>
#include <vector>

#include "liveness/plan.h"

namespace exactvo::formation::detail {

/// Why a search for a plan ended.
enum class PlanEnd {
  planned,
  none_on_map,    ///< every joint place that can be reached was tried
  out_of_budget,  ///< or stopped
  too_large,      ///< not tried: the map would be too large
  no_use,         ///< not tried: the robots it is for would come no nearer to their goals, since others stand in them
  in_vain         ///< not tried: the same robots went by plan again and again, and wait as before
};

struct PlanFound {
  PlanEnd end = PlanEnd::out_of_budget;
  std::vector<PlannedMove> plan;  ///< where it is `planned`
  std::size_t nodes = 0;          ///< of all searches
};

/// Each search goes on with the seeds where the last ended.
class PlanSearch {
 public:
  /// `calls`: of the generator for a robot, at most, until there is a plan. `lanes`: whether every other search is
  /// guided by lanes.
  PlanFound best_plan(const JointProblem& problem, std::size_t calls, bool lanes);

 private:
  std::uint64_t seed_ = 0;
};

}  // namespace exactvo::formation::detail
