// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Is this ring of points an obstacle? Every problem found has a code that the documentation lists (docs/guide/codes.md).

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

enum class RingProblemCode {
  not_finite,         ///< a coordinate is NaN or infinite
  too_few_points,     ///< fewer than three distinct vertices (two for a polyline)
  unclosed,           ///< the last point does not repeat the first (mended by `normalize`)
  repeated_vertex,    ///< consecutive vertices are equal (mended)
  clockwise,          ///< an outer ring is clockwise or a hole counter-clockwise (mended)
  zero_area,          ///< all vertices are collinear
  self_intersection,  ///< two edges that are not neighbours meet, or neighbours overlap (a spike)
  hole_outside        ///< a hole is not inside its outer ring, or crosses another ring
};

/// "E_SELF_INTERSECTION" and so on.
const char* code_name(RingProblemCode code);

struct RingProblem {
  RingProblemCode code;
  std::size_t ring = 0;    ///< 0 is the outer ring, then the holes
  std::size_t vertex = 0;  ///< index into the ring as given
  Vec2 where;
  bool mended = false;  ///< `normalize` put it right
};

struct NormalizedPolygon {
  Polygon polygon;                    ///< valid iff `ok()`
  std::vector<RingProblem> problems;  ///< in order of ring and vertex
  bool ok() const;                    ///< every problem was mended
};

/// Puts right what has one right answer (winding, closure, consecutive duplicates) and reports the rest. Exact.
/// `rings[0]` is the outer ring; each may or may not repeat its first point. O(n log n) for the crossing test (CGAL).
NormalizedPolygon normalize(const std::vector<Ring>& rings);

}  // namespace exactvo::geometry
