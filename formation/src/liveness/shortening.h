// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Joint plans that take less time (liveness, rule R3): one robot after the other gets another path among the moves of
/// all others. A change that takes longer is undone.
///
/// Large neighbourhood search (Li, Chen, Harabor, Stuckey and Koenig, "Anytime Multi-Agent Path Finding via Large
/// Neighborhood Search", IJCAI 2021). Heuristic: how long a sequence takes is what its timetable says.

#include <cstdint>
#include <vector>

#include "liveness/joint_search.h"

namespace exactvo::formation::detail {

/// A sequence of moves of the same robots with properties (1) to (3) of joint_search.h, if that given has them; (1) is
/// checked, else the sequence given comes back, as it does where it has more than 20,000 moves. Deterministic: what is
/// tried is counted, about two seconds of one core at most. Where `problem.is_stopped` says so, what was found until
/// then.
std::vector<JointMove> shortened(const JointProblem& problem, const std::vector<JointMove>& moves, std::uint64_t seed);

}  // namespace exactvo::formation::detail
