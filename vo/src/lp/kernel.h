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

/// The most lines that `copy_unit_lines` takes.
inline constexpr std::size_t kMostCopied = 64;

/// Where it writes them; each with room for kMostCopied.
struct CopiedLines {
  double *x, *y, *offset;
};

/// Copies the half-planes in registers, which are read as registers next. False, with anything written, unless their
/// normals are of unit length (kUnitLength), offsets finite and hard ones first, of which `hard` is the number.
bool copy_unit_lines(const Constraint* constraints, std::size_t count, CopiedLines to, std::size_t& hard);

/// Whether the solution's own multipliers prove it (lanes/single_proof.h). Sets the violation of a relaxed answer.
bool prove_in_arrays(const SingleProblem& problem, Solution& answer);

}  // namespace exactvo::lp
