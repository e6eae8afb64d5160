// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Between plain polygons and CGAL's, with the checks that keep CGAL's preconditions.

#include <CGAL/Polygon_with_holes_2.h>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::geometry::detail {

/// The polygon with its rings the right way round. Throws std::logic_error if it is not valid.
inline Polygon checked_polygon(const Polygon& polygon) {
  std::vector<Ring> rings = {polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  NormalizedPolygon normalized = normalize(rings);
  EXACTVO_REQUIRE(normalized.ok(),
                  "outer ring " + excerpt(polygon.outer) + " and " + std::to_string(polygon.holes.size()) + " holes");
  return std::move(normalized.polygon);
}

template <class Kernel>
CGAL::Polygon_2<Kernel> to_cgal(const Ring& ring) {
  CGAL::Polygon_2<Kernel> out;
  for (const Vec2 p : ring) {
    out.push_back(typename Kernel::Point_2(typename Kernel::FT(p.x), typename Kernel::FT(p.y)));
  }
  return out;
}

template <class Kernel>
CGAL::Polygon_with_holes_2<Kernel> to_cgal(const Polygon& polygon) {
  CGAL::Polygon_with_holes_2<Kernel> out(to_cgal<Kernel>(polygon.outer));
  for (const Ring& hole : polygon.holes) out.add_hole(to_cgal<Kernel>(hole));
  return out;
}

}  // namespace exactvo::geometry::detail
