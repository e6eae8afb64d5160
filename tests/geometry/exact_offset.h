// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A polygon grown by a disc, unrounded: segments that may lie on irrational lines, and circular arcs. CGAL's conic
/// arcs over algebraic numbers carry it (offset_polygon_2 with Arr_conic_traits_2), behind an immutable handle.
///
/// The oracle for grown shapes: 0.5 ms for a square, seconds for a star of a hundred corners.

#include <cstddef>
#include <memory>
#include <vector>

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::test {

using geometry::Place;
using geometry::Polygon;
using geometry::Vec2;

/// A piece of the boundary as doubles can show it: each coordinate rounded.
struct OffsetCurve {
  Vec2 from;            ///< m, where it begins
  Vec2 to;              ///< m, where it ends
  bool is_arc = false;  ///< of a circle round `center`; else straight
  Vec2 center;          ///< of an arc, m
};

/// The grown polygon, behind a handle: copies share.
class ExactOffset {
 public:
  /// polygon (+) D(0, radius). REQUIRES: polygon valid (see `normalize`), radius > 0, finite.
  ExactOffset(const Polygon& polygon, double radius);

  /// Where x lies. Exact: the side of the conic arcs, in algebraic numbers.
  Place locate(Vec2 x) const;

  /// The boundary's pieces in order: the outer ring counter-clockwise, then what is left of holes. Arcs are split where
  /// they turn back in x.
  const std::vector<std::vector<OffsetCurve>>& boundary() const;

  double area() const;  ///< m^2; rounded

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace exactvo::test
