// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The region that rings of any kind enclose: every point that lies inside an odd number of them (the even-odd rule).
/// Rings may cross, touch and overlap themselves and each other; a spike and an edge that is walked twice enclose
/// nothing; a ring in a ring is a hole, and one in that hole an island.
///
/// The rings are cut at their crossings exactly (CGAL's arrangements, which its Boolean operations are built on).
/// Crossings are then rounded to doubles, and what the rounding made meet is cut again, until nothing changes; where
/// that takes long, all vertices go to a grid by snap rounding (Hobby, 1999), which makes no new crossings.
///
/// See also: validity.h says whether rings need this; datasets/repair.h does it for obstacles and reports.
///
/// Properties (tests quote the numbers):
///  (1) every polygon of the answer is valid (`normalize` repairs nothing but closure), and their insides are disjoint;
///  (2) the answer to an answer's rings is that answer;
///  (3) a point farther than `moved` from every ring lies in the answer exactly if an odd number of rings enclose it;
///  (4) the order, the winding and the start of the rings do not matter.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// How the construction ended.
enum class EvenOddStatus {
  done,  ///< the polygons are there
  /// A coordinate beyond kLargestCutCoordinate: nothing was cut.
  too_large,
  /// More than `most_crossings` contacts between edges, or so long edges so close together that looking for contacts
  /// would take seconds (2^26 pairs of their boxes meet): nothing was cut.
  too_many_crossings,
  /// After kMostRounds roundings new crossings were still being made: not known to happen.
  not_roundable,
  /// CGAL gave up: not known to happen.
  refused
};

/// The region as valid polygons.
struct EvenOddRegion {
  EvenOddStatus status = EvenOddStatus::done;  ///< done, or why there are no polygons
  std::vector<Polygon> polygons;  ///< empty unless done, and where nothing is enclosed; in order of their least vertex
  double moved = 0.0;             ///< m; no point was moved farther than this: certified (rounded up)
  std::size_t rounds = 0;         ///< roundings that changed something
};

/// The most contacts that edges may have in all with edges that are not their neighbours. Each costs 5 kB while the
/// rings are cut, so that a short text can't ask for more than 80 MB and a second or two. Rings that coincide along
/// their whole length have three contacts for each pair of edges.
inline constexpr std::size_t most_crossings(std::size_t edges) {
  return (std::size_t{1} << 14) + 2 * edges;
}

/// m. Comparing two crossings takes products of seven coordinates: beyond this they would leave the range of the
/// intervals that CGAL's filters compute in.
inline constexpr double kLargestCutCoordinate = 0x1p100;

/// One or two roundings are the rule. After this many plain ones comes snap rounding, on a grid of two units in the
/// last place of the largest coordinate.
inline constexpr std::size_t kPlainRounds = 4;
/// After this many rounds it ends as `not_roundable`.
inline constexpr std::size_t kMostRounds = 8;

/// REQUIRES: all points finite.
EvenOddRegion even_odd_region(const std::vector<Ring>& rings);

}  // namespace exactvo::geometry
