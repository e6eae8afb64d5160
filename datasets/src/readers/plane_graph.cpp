// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/plane_graph.h"

#include <algorithm>

#include "exactvo/geometry/box.h"

namespace exactvo::datasets {
namespace {

using geometry::Vec2;

class ChainWalker {
 public:
  explicit ChainWalker(const PlaneGraph& graph) : graph_(graph), at_(graph.points.size()), used_(graph.edges.size()) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      at_[graph.edges[e].first].push_back(e);
      at_[graph.edges[e].second].push_back(e);
    }
  }

  std::vector<GraphChain> chains() {
    for (std::size_t node = 0; node < at_.size(); ++node) {
      if (at_[node].size() != 2) walk_all_from(node);
    }
    for (std::size_t node = 0; node < at_.size(); ++node) walk_all_from(node);
    return std::move(chains_);
  }

 private:
  void walk_all_from(std::size_t node) {
    for (const std::size_t edge : at_[node]) {
      if (!used_[edge]) walk(node, edge);
    }
  }

  void walk(std::size_t start, std::size_t edge) {
    GraphChain chain;
    std::size_t node = start;
    chain.points.push_back(graph_.points[node]);
    for (;;) {
      used_[edge] = true;
      node = graph_.edges[edge].first == node ? graph_.edges[edge].second : graph_.edges[edge].first;
      chain.points.push_back(graph_.points[node]);
      if (node == start || at_[node].size() != 2) break;
      edge = used_[at_[node][0]] ? at_[node][1] : at_[node][0];
      if (used_[edge]) break;
    }
    chain.closed = node == start;
    chains_.push_back(std::move(chain));
  }

  const PlaneGraph& graph_;
  std::vector<std::vector<std::size_t>> at_;  ///< the edges at each point
  std::vector<bool> used_;
  std::vector<GraphChain> chains_;
};

double half_perimeter_of_box(const std::vector<Vec2>& points) {
  geometry::Box box{points.front(), points.front()};
  for (const Vec2 p : points) box.add(p);
  return (box.high.x - box.low.x) + (box.high.y - box.low.y);
}

void put_largest_first(std::vector<GraphChain>& rings) {
  const auto less = [](const GraphChain& a, const GraphChain& b) {
    return half_perimeter_of_box(a.points) < half_perimeter_of_box(b.points);
  };
  std::iter_swap(rings.begin(), std::max_element(rings.begin(), rings.end(), less));
}

void add_walls(std::vector<GraphChain> chains, const std::string& place, Collector& out) {
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const std::string number = std::to_string(k);
    out.add({RawKind::polyline, number, place + ", chain " + number, {std::move(chains[k].points)}});
  }
}

bool is_lonely(const PlaneGraph& graph, Collector& out, const std::string& place) {
  if (!graph.edges.empty()) return false;
  out.pass_over(place, "points without edges skipped: points are no obstacles");
  return true;
}

}  // namespace

std::vector<GraphChain> chains_of(const PlaneGraph& graph) {
  return ChainWalker(graph).chains();
}

void add_graph(const PlaneGraph& graph, const std::string& place, Collector& out) {
  if (is_lonely(graph, out, place)) return;
  std::vector<GraphChain> chains = chains_of(graph);
  if (!std::all_of(chains.begin(), chains.end(), [](const GraphChain& c) { return c.closed; }))
    return add_walls(std::move(chains), place, out);
  put_largest_first(chains);
  RawGeometry raw{RawKind::polygon, "0", place, {}};
  for (GraphChain& chain : chains) raw.rings.push_back(std::move(chain.points));
  out.add(raw);
}

void add_graph_as_walls(const PlaneGraph& graph, const std::string& place, Collector& out) {
  if (!is_lonely(graph, out, place)) add_walls(chains_of(graph), place, out);
}

}  // namespace exactvo::datasets
