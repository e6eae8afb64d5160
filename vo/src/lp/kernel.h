// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A problem of any kind in the form that the kernel takes (lanes/single.cpp): unit normals, a disc, hard lines first,
/// the sides of the box among them. Heuristic: what the kernel finds is proven elsewhere.

#include <optional>

#include "exactvo/vo/lp/solve.h"

namespace exactvo::lp {

/// A candidate for the answer, not proven; false where the kernel does not settle the problem.
/// REQUIRES: a well-formed problem.
bool find_candidate(const Problem& problem, SolveMemory& memory, Solution& answer);

/// Memory of the calling thread, for calls that have none of their own.
SolveMemory& memory_of_thread();

/// The optimum with the constraints moved inward by `slack_units` times the slack of region.h; nothing where the kernel
/// finds none. REQUIRES: a well-formed problem.
std::optional<Vec2> optimum_inside(const Problem& problem, double slack_units);

/// False where the kernel cannot settle the problem; `solve` of solve.h says what it takes.
bool run_kernel(const SingleProblem& problem, Solution& answer);

}  // namespace exactvo::lp
