// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Is this ring of points an obstacle? Every problem found has a code that the documentation lists
/// (docs/guide/codes.md).

#include <cstddef>
#include <vector>

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// What can be wrong with a ring.
enum class RingProblemCode {
  not_finite,         ///< a coordinate is NaN or infinite
  too_few_points,     ///< fewer than three distinct vertices (two for a polyline)
  unclosed,           ///< the last point does not repeat the first (repaired by `normalize`)
  repeated_vertex,    ///< consecutive vertices are equal (repaired)
  clockwise,          ///< an outer ring is clockwise or a hole counter-clockwise (repaired)
  zero_area,          ///< all vertices are collinear
  self_intersection,  ///< two edges that are not neighbours meet, or neighbours overlap (a spike)
  hole_outside        ///< a hole is not inside its outer ring, lies in another hole, or crosses another ring
};

/// "E_SELF_INTERSECTION" and so on.
const char* code_name(RingProblemCode code);

/// One problem, and where it is.
struct RingProblem {
  RingProblemCode code;    ///< what is wrong
  std::size_t ring = 0;    ///< 0 is the outer ring, then the holes
  std::size_t vertex = 0;  ///< index into the ring as given
  Vec2 where;              ///< m; a crossing of two edges is rounded
  bool repaired = false;   ///< `normalize` repaired it
};

/// A polygon after `normalize`.
struct NormalizedPolygon {
  Polygon polygon;                    ///< valid iff `ok()`
  std::vector<RingProblem> problems;  ///< in order of ring and vertex
  bool ok() const;                    ///< every problem was repaired
};

/// Repairs the problems that have one correct repair (winding, closure, consecutive duplicates) and reports the rest.
/// Exact: no tolerance, only comparisons and orientation tests. O(n log n) while rings keep apart; rings that touch
/// cost a search over pairs of edges whose boxes meet.
///
/// `rings[0]` is the outer ring; each may or may not repeat its first point. Holes may touch each other or the outer
/// ring in single points, as in OGC simple features; that the interior stays connected is not checked. A ring's own
/// vertices and edges may not touch. At most one self-intersection and one misplaced hole are reported per ring.
///
/// Properties: (1) a valid polygon comes back unchanged; (2) the result of an ok() answer is valid: normalising it
/// again repairs nothing but closure; (3) reversing rings or rotating their start changes neither ok() nor the point
/// set.
NormalizedPolygon normalize(const std::vector<Ring>& rings);

/// A chain after `normalize_polyline`.
struct NormalizedPolyline {
  Polyline polyline;                  ///< valid iff `ok()`
  std::vector<RingProblem> problems;  ///< in order of vertex
  bool ok() const;                    ///< every problem was repaired
};

/// The same for an open chain: drops consecutive duplicates, reports `not_finite` and `too_few_points`. A wall may
/// cross itself.
NormalizedPolyline normalize_polyline(const std::vector<Vec2>& points);

/// Whether the closed ring is simple: at least three vertices, consecutive ones distinct, and edges meeting only where
/// neighbours share their vertex. Exact, O(n log n). REQUIRES: all finite.
bool is_simple(const Ring& ring);

/// The sign of the area of a simple ring: positive is counter-clockwise. Exact. REQUIRES: simple.
Sign winding(const Ring& ring);

}  // namespace exactvo::geometry
