// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Points joined by edges, as some formats hold their polygons: decomposed into rings and open chains.

#include <cstddef>
#include <utility>
#include <vector>

#include "readers/raw_geometry.h"

namespace exactvo::datasets {

struct PlaneGraph {
  std::vector<geometry::Vec2> points;
  std::vector<std::pair<std::size_t, std::size_t>> edges;  ///< indices of points
};

struct GraphChain {
  std::vector<geometry::Vec2> points;  ///< closed: the first is repeated at the end
  bool closed = false;
};

/// Every edge in one chain: from ends and forks to the next, then round what is left. O(points + edges), in the order
/// of the points. REQUIRES: every index that of a point.
std::vector<GraphChain> chains_of(const PlaneGraph& graph);

/// Where nothing but rings is: one polygon, the ring with the largest box outside. Else walls, each chain one.
void add_graph(const PlaneGraph& graph, const std::string& place, Collector& out);
/// Walls in any case: of edges that say nothing about what is inside.
void add_graph_as_walls(const PlaneGraph& graph, const std::string& place, Collector& out);

}  // namespace exactvo::datasets
