// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One problem: the constraint that is violated most enters, and the optimum on its boundary follows. (Not Seidel's
/// incremental method of 1991, which takes constraints in random order.) Lines are read a register at a time (Highway
/// picks the target at run time), and the same input gives the same bits on every target. batch.h solves many problems
/// at once; certificate.h writes proofs out.

#include <cstddef>
#include <memory>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// The velocity nearest `problem.preferred` that satisfies every constraint; if none does, the one that satisfies the
/// hard constraints and violates the soft ones least (smallest largest violation), and among those the nearest.
/// Certified: multipliers in doubles prove the answer, or it is that of `solve_exact`.
/// REQUIRES: see `require_well_formed`.
Solution solve(const Problem& problem);

namespace detail {
struct SolveArrays;
}

/// What one call of `solve` leaves to the next, so that it allocates nothing. For one thread at a time.
class SolveMemory {
 public:
  /// Nothing is reserved.
  SolveMemory();
  ~SolveMemory();
  /// Moves; the object moved from can only be assigned to or destroyed.
  SolveMemory(SolveMemory&&) noexcept;
  /// Moves; the object moved from can only be assigned to or destroyed.
  SolveMemory& operator=(SolveMemory&&) noexcept;

  /// Room for problems with this many constraints.
  void reserve(std::size_t constraints);

 private:
  friend bool find_candidate(const Problem& problem, SolveMemory& memory, Solution& answer);
  std::unique_ptr<detail::SolveArrays> arrays_;
};

/// The same without the exact stage: true where the multipliers of `answer` prove it (`claim_of`), and then it is the
/// answer above; false where `solve_exact` has to find it. With a disc or a full box an optimal answer depends only on
/// what binds: without the constraints that hold there with room to spare its velocity has the same bits, unless three
/// lines meet there up to rounding. Allocates nothing in a problem with no more constraints than one before, or than
/// were reserved; but signs that doubles do not decide are computed exactly, and such numbers allocate where they are
/// long. REQUIRES: see `require_well_formed`.
bool solve(const Problem& problem, SolveMemory& memory, Solution& answer);

/// The arrays must be readable up to a multiple of this many lines; what stands beyond `count` is not used.
inline constexpr std::size_t kSinglePadding = 8;

/// A problem with a disc, whose lines are arrays of the caller's: nothing is copied.
struct SingleProblem {
  const double* normal_x = nullptr;  ///< with normal_y
  const double* normal_y = nullptr;  ///< | |normal| - 1 | <= 2^-10
  const double* offset = nullptr;    ///< m/s
  std::size_t count = 0;             ///< lines
  std::size_t hard = 0;              ///< the first `hard` lines are hard
  geometry::Vec2 preferred;          ///< m/s
  double disc = 0.0;                 ///< m/s, finite, > 0
};

/// Solves as a lane of `solve_batch` does, with the same slack and guarantees: rounded inward, and heuristic where the
/// region is thinner than the slack. What this method cannot settle goes to `solve` of a Problem, which copies.
/// REQUIRES: finite numbers as described.
void solve(const SingleProblem& problem, Solution& answer);

/// The same with what `solve_certified` of a Problem promises: `optimal` and `relaxed` hold exactly, and no velocity is
/// better by more than kWidestGap of certificate.h. Certified: the multipliers are proven in doubles with their
/// rounding errors, and what these cannot show goes to `solve_certified` of a Problem, which copies. False where there
/// is no proof either.
bool solve_certified(const SingleProblem& problem, Solution& answer);

}  // namespace exactvo::lp
