// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The boundaries of all obstacles as one planar graph: cut wherever two of them cross or touch, equal pieces merged.
/// Exact.

#include <vector>

#include "exactvo/geometry/routes.h"
#include "routes/exact_point.h"

namespace exactvo::geometry::routing {

struct PlanarGraph {
  /// A piece of an obstacle's edge; no other vertex lies on it.
  struct Edge {
    int a, b;     ///< vertices
    int winding;  ///< how many more solids lie on its left than on its right
    EdgeName on;  ///< an edge of an obstacle that it is a piece of
  };
  std::vector<Point> vertices;
  std::vector<EdgeName> on;  ///< of each vertex, an edge of an obstacle that it lies on
  std::vector<Edge> edges;
  std::vector<int> isolated;  ///< vertices that are whole edges: of walls that do not move
};

/// REQUIRES: finite coordinates.
PlanarGraph planar_graph(const std::vector<Obstacle>& obstacles);

}  // namespace exactvo::geometry::routing
