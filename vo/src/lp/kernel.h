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

/// The optimum with the constraints moved inward by `slack_units` times the slack of lanes/layout.h; nothing where the
/// kernel finds none. REQUIRES: a well-formed problem.
std::optional<Vec2> optimum_inside(const Problem& problem, double slack_units);

/// False where the kernel cannot settle the problem; `solve` of solve.h says what it takes.
bool run_kernel(const SingleProblem& problem, Solution& answer);

/// Copies the constraints in registers, which are read as registers next, and solves; true where the solution's own
/// multipliers prove it (lanes/single_proof.h). An optimum is that of `set_vertex`. False unless there are at most 64
/// with normals of unit length (kUnitLength) and finite offsets, hard ones first.
/// REQUIRES: a disc, no box, the nearest velocity to a finite one.
bool run_plain(const Problem& problem, Solution& answer);

/// Makes the velocity of an optimum the vertex of what binds, and sets its multipliers. It depends on nothing else.
/// False where these do not meet.
bool set_vertex(const SingleProblem& problem, Solution& answer);

}  // namespace exactvo::lp
