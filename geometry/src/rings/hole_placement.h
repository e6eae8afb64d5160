// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether simple rings form a polygon with holes: rings[0] outside, the others inside it and outside each other.
/// Exact.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// Ring `ring` crosses another ring at `where`, or lies on its wrong side (then `vertex` says which point showed it).
struct Misplacement {
  std::size_t ring = 0;
  std::size_t vertex = 0;
  Vec2 where;
};

/// One misplacement at most a hole, in order. REQUIRES: every ring simple, rings[0] counter-clockwise, others
/// clockwise. Throws TooManyContacts beyond the limits below.
std::vector<Misplacement> misplaced_holes(const std::vector<const Ring*>& rings);

/// Pairs of edges whose boxes meet, and tests of a vertex against an edge: two to five seconds each.
inline constexpr std::size_t kMostContactPairs = std::size_t{1} << 26;
inline constexpr std::size_t kMostEdgeTests = std::size_t{1} << 29;

}  // namespace exactvo::geometry::detail
