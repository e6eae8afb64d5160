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

  int size() const { return static_cast<int>(first_.size()) - 1; }
  const Arc* begin(int node) const { return arcs_.data() + first_[node]; }
  const Arc* end(int node) const { return arcs_.data() + first_[node + 1]; }
  const Point& foot(int link) const { return feet_[link]; }

 private:
  std::vector<int> first_;
  std::vector<Arc> arcs_;
  std::vector<Point> feet_;  ///< of closed links
};

/// REQUIRES: s and t are free and lie in cells of different components. A short chain, not the shortest.
Separated separating_chain(const ClearancePlan& plan, const ArcGraph& graph, const Point& s, const Point& t);

ExactPoint shown(const Point& p);

}  // namespace exactvo::geometry::routing
