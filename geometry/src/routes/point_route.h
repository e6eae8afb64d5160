// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// From a way through portals to the route of a point (radius 0): a polyline that touches no obstacle, as little longer
/// than the shortest curve as it is asked for. It has no middle of a gate to go through and no arc to go along:
///
///   A portal's interior is free, and cells are convex. So a polyline with a corner inside each portal of the way
///   touches nothing, whatever these corners are.
///
/// The corners lie where the shortest curve crosses the portals, but never at a portal's end, where that touches a
/// vertex. Most are left out again: wherever two of them see each other. Exact; and where doubles are too coarse, as in
/// a crack of 1e-20 m, the corners are fractions.
///
/// An end may touch obstacles: the route leaves it, and comes to it, through the inside of a triangle that it is a
/// point of, and touches nothing else.

#include <optional>
#include <vector>

#include "routes/search.h"

namespace exactvo::geometry::routing {

/// An end of a route.
struct RouteEnd {
  Vec2 at;
  /// Where it touches an obstacle: inside the triangle, of the way's first or last cell, that the route goes through.
  std::optional<Point> inside;
  std::vector<CellMap::TriangleAt> about;  ///< then, the triangles about it
};

/// From s to t inclusive. REQUIRES: the plan's radius is 0; the way leads from s to t.
std::vector<Point> point_route(const ClearancePlan& plan, const RouteEnd& s, const RouteEnd& t, const Way& way);

}  // namespace exactvo::geometry::routing
