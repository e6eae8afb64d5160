// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The constrained Delaunay triangulation of a planar graph inside a large square, as plain arrays. Exact: CGAL, with
/// predicates on doubles where all vertices are doubles, on fractions else.

#include <vector>

#include "routes/planar_graph.h"

namespace exactvo::geometry::routing {

/// A triangle, counter-clockwise. Side i lies opposite vertex i and runs from vertex i+1 to vertex i+2.
struct Triangle {
  int vertex[3];
  int neighbour[3];  ///< across the side; -1 outside of the square
  int wall[3];       ///< the graph's edge along the side; -1 none
  bool free;         ///< in no solid
};

/// The corners of the square are vertices behind the graph's own: they are no obstacles. `corners` counter-clockwise.
std::vector<Triangle> triangulate(const PlanarGraph& graph, const Vec2 (&corners)[4]);

}  // namespace exactvo::geometry::routing
