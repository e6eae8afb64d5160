// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The scalar solver in double precision: an active-set method, in which the constraint that is violated most enters
/// and, of equal ones, the first. (Not Seidel's incremental method of 1991, which takes constraints in random order.)
/// The same input gives the same bits; work is bounded on any input.

#include <cstddef>
#include <memory>
#include <vector>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

namespace detail {
struct ScalarRegions;
}

/// The velocity nearest `problem.preferred` that satisfies every constraint; if none does, the one that satisfies the
/// hard constraints and violates the soft ones least (smallest largest violation), and among those the nearest.
///
/// Rounded inward: the constraints are solved with a slack of 16 u V (u = 2^-53, V the largest speed in play), so that
/// the velocity returned satisfies them exactly wherever the region is wider than that. The verdict is heuristic where
/// the region is thinner: a feasible problem may come back `relaxed` with a violation of a few u V.
/// REQUIRES: see `require_well_formed`.
Solution solve(const Problem& problem);

/// Where the solver looked for the constraint that is violated most.
struct Pricing {
  std::vector<Vec2> at;  ///< m/s, the answer last
  bool is_all = false;   ///< the answer rests on these alone; false where constraints were relaxed
};

/// What one call of `solve` leaves to the next, so that it allocates nothing. For one thread at a time.
class SolveMemory {
 public:
  /// Without room.
  SolveMemory();
  ~SolveMemory();
  /// Moves; what is left behind can only be assigned to or destroyed.
  SolveMemory(SolveMemory&&) noexcept;
  /// Moves; what is left behind can only be assigned to or destroyed.
  SolveMemory& operator=(SolveMemory&&) noexcept;

  /// Room for problems of so many constraints.
  void reserve(std::size_t constraints);

 private:
  friend Solution solve(const Problem& problem, Pricing& pricing, SolveMemory& memory);
  std::unique_ptr<detail::ScalarRegions> regions_;
};

/// The same answer. Where `pricing.is_all`, a constraint with a normal of about unit length that at each of
/// `pricing.at` either holds with room to spare or is violated clearly less than some other could be added to the
/// problem or left out: velocity, status and what binds stay the same bits. With room, clearly: beyond 1024 u V and the
/// rounding of the constraint's own excess. Allocates nothing in a problem with no more constraints than one before, or
/// than were reserved, whose normals have lengths within 2^+-100; but signs that doubles do not decide are computed
/// exactly, and such numbers allocate where they are long.
Solution solve(const Problem& problem, Pricing& pricing, SolveMemory& memory);

}  // namespace exactvo::lp
