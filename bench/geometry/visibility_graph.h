// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What routes are compared with: shortest paths as textbooks have them, by brute force in doubles (Lozano-Perez and
/// Wesley 1979 for points, Laumond 1987 for discs). All pairs are tested against all edges, O(n^3); a question connects
/// its ends, O(n^2), and runs Dijkstra's search.
///
/// REQUIRES: convex polygons, counter-clockwise, in general position, farther apart than two radii.

#include <cstddef>
#include <utility>
#include <vector>

#include "exactvo/geometry/vec2.h"

namespace exactvo::bench {

using ConvexRings = std::vector<std::vector<geometry::Vec2>>;

class VisibilityGraph {
 public:
  /// `radius`: m, of the disc that moves; 0: a point.
  VisibilityGraph(const ConvexRings& rings, double radius);

  /// m; infinite where there is no way.
  double shortest(geometry::Vec2 start, geometry::Vec2 goal) const;

 private:
  struct Corner {
    geometry::Vec2 at, from, to;  ///< normals of the edge that ends here and of the one that begins here
  };
  struct Edge {
    geometry::Vec2 a, b;
  };
  /// A place where the way leaves or reaches the circle about a corner; of a point the corner itself.
  struct Node {
    geometry::Vec2 at;
    int corner;    ///< -1: an end of the way
    double angle;  ///< rad, of the place on the circle, from the first normal on
  };
  struct Graph {
    std::vector<Node> nodes;
    std::vector<std::vector<std::pair<int, double>>> ways;  ///< to a node, m
  };

  bool is_free(geometry::Vec2 p, geometry::Vec2 q) const;
  int add_node(Graph& graph, geometry::Vec2 at, int corner) const;
  void connect(Graph& graph, geometry::Vec2 p, int corner, geometry::Vec2 q, int other) const;
  void connect_corners(Graph& graph, int i, int j) const;
  void connect_end(Graph& graph, int end, int j) const;
  void add_arcs(Graph& graph) const;

  double radius_;
  std::vector<Corner> corners_;
  std::vector<Edge> edges_;
  Graph graph_;
};

}  // namespace exactvo::bench
