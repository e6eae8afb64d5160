// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The proof that two places are separated: a closed chain of obstacles and of gaps that the disc does not fit through.

#include <vector>

#include "exactvo/geometry/routes.h"
#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// What chains are made of, for one plan: the nodes are the vertices and the edges of the graph ("walls"); an arc joins
/// a wall to one of its ends, or what a closed gap joins. Made once, since feet of links are fractions.
class ArcGraph {
 public:
  static constexpr int kEnd = -1, kSide = -2;
  struct Arc {
    int to;
    int link;  ///< of a gap between a vertex and a wall; kEnd: a wall and its end; kSide: two vertices
  };

  explicit ArcGraph(const ClearancePlan& plan);
  /// The same graph cut at a point that touches obstacles: a chain passes through it only where no free triangle about
  /// it lies in between, from one edge to another of the same solid angle. The vertex becomes a node for each of these.
  ArcGraph(const ArcGraph& graph, const CellMap& map, const std::vector<CellMap::TriangleAt>& about);

  int size() const { return static_cast<int>(first_.size()) - 1; }
  /// The vertex that a node stands for, which is no wall.
  int vertex_of(int node) const { return node < whole_ ? node : vertex_of_part_[node - whole_]; }
  bool is_part(int node) const { return node >= whole_; }
  const Arc* begin(int node) const { return arcs_.data() + first_[node]; }
  const Arc* end(int node) const { return arcs_.data() + first_[node + 1]; }
  const Point& foot(int link) const { return feet_[link]; }

 private:
  struct Pair {
    int a, b, link;
  };
  void set_arcs(int nodes, const std::vector<Pair>& pairs);

  std::vector<int> first_;
  std::vector<Arc> arcs_;
  std::vector<Point> feet_;  ///< of closed links
  int whole_ = 0;            ///< vertices and walls; nodes behind them are parts of vertices
  std::vector<int> vertex_of_part_;
};

/// What a chain separates.
struct ChainEnd {
  Vec2 at;
  std::vector<CellMap::TriangleAt> about;  ///< where it is a point's and touches obstacles
};

/// REQUIRES: s and t are free and no cell of one is connected with a cell of the other. A short chain, not the
/// shortest.
Separated separating_chain(const ClearancePlan& plan, const ArcGraph& graph, const ChainEnd& s, const ChainEnd& t);

ExactPoint shown(const Point& p);

}  // namespace exactvo::geometry::routing
