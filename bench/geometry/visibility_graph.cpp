// SPDX-License-Identifier: GPL-3.0-or-later
#include "visibility_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include "exactvo/geometry/pi.h"

namespace exactvo::bench {

using geometry::kPi;
using geometry::Vec2;

namespace {

/// m: tangents touch their circles up to rounding.
constexpr double kTouch = 1e-9;

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double share = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
  return norm(p - a - share * d);
}

bool cross_inside(Vec2 p, Vec2 q, Vec2 a, Vec2 b) {
  return (cross(q - p, a - p) > 0.0) != (cross(q - p, b - p) > 0.0) &&
         (cross(b - a, p - a) > 0.0) != (cross(b - a, q - a) > 0.0);
}

double turn(Vec2 from, Vec2 to) {
  const double angle = std::atan2(cross(from, to), dot(from, to));
  return angle < -kTouch ? angle + 2.0 * kPi : std::max(0.0, angle);
}

}  // namespace

VisibilityGraph::VisibilityGraph(const ConvexRings& rings, double radius) : radius_(radius) {
  for (const std::vector<Vec2>& ring : rings) {
    const std::size_t n = ring.size();
    const auto normal = [&](std::size_t k) {
      const Vec2 d = ring[(k + 1) % n] - ring[k % n];
      return Vec2{d.y, -d.x} / norm(d);
    };
    for (std::size_t k = 0; k < n; ++k) {
      edges_.push_back({ring[k], ring[(k + 1) % n]});
      corners_.push_back({ring[k], normal(k + n - 1), normal(k)});
    }
  }
  const int count = static_cast<int>(corners_.size());
  if (radius_ == 0.0)
    for (int i = 0; i < count; ++i) add_node(graph_, corners_[i].at, i);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j) connect_corners(graph_, i, j);
}

int VisibilityGraph::add_node(Graph& graph, Vec2 at, int corner) const {
  const double angle = corner < 0 || radius_ == 0.0 ? 0.0 : turn(corners_[corner].from, at - corners_[corner].at);
  graph.nodes.push_back({at, corner, angle});
  graph.ways.emplace_back();
  return static_cast<int>(graph.nodes.size()) - 1;
}

/// Whether the straight way keeps the radius from every edge; of a point: whether it crosses none, nor a polygon from
/// corner to corner, whose edges it only touches.
bool VisibilityGraph::is_free(Vec2 p, Vec2 q) const {
  const double x0 = std::min(p.x, q.x) - radius_, x1 = std::max(p.x, q.x) + radius_;
  const double y0 = std::min(p.y, q.y) - radius_, y1 = std::max(p.y, q.y) + radius_;
  for (const Edge& e : edges_) {
    if (std::max(e.a.x, e.b.x) < x0 || std::min(e.a.x, e.b.x) > x1 || std::max(e.a.y, e.b.y) < y0 ||
        std::min(e.a.y, e.b.y) > y1)
      continue;
    if (radius_ == 0.0 && (e.a == p || e.a == q || e.b == p || e.b == q)) continue;
    if (cross_inside(p, q, e.a, e.b)) return false;
    if (radius_ > 0.0 &&
        (distance_to_segment(p, e.a, e.b) < radius_ - kTouch || distance_to_segment(q, e.a, e.b) < radius_ - kTouch ||
         distance_to_segment(e.a, p, q) < radius_ - kTouch || distance_to_segment(e.b, p, q) < radius_ - kTouch))
      return false;
  }
  return true;
}

void VisibilityGraph::connect(Graph& graph, Vec2 p, int corner, Vec2 q, int other) const {
  if (!is_free(p, q)) return;
  const int i = add_node(graph, p, corner), j = add_node(graph, q, other);
  graph.ways[i].emplace_back(j, norm(q - p));
  graph.ways[j].emplace_back(i, norm(q - p));
}

void VisibilityGraph::connect_corners(Graph& graph, int i, int j) const {
  const Corner &a = corners_[i], &b = corners_[j];
  const Vec2 d = b.at - a.at;
  if (radius_ == 0.0) {
    // Into a polygon leads what lies behind both edges of a corner.
    const auto leads_inside = [](Vec2 away, const Corner& c) {
      return dot(away, c.from) < -kTouch && dot(away, c.to) < -kTouch;
    };
    if (leads_inside(d, a) || leads_inside(-d, b) || !is_free(a.at, b.at)) return;
    graph.ways[i].emplace_back(j, norm(d));
    graph.ways[j].emplace_back(i, norm(d));
    return;
  }
  const Vec2 u = d / norm(d);
  for (const double side : {0.5 * kPi, -0.5 * kPi}) {
    const Vec2 out = radius_ * rotated(u, side);
    connect(graph, a.at + out, i, b.at + out, j);
  }
  if (norm(d) < 2.0 * radius_) return;
  const double half = std::acos(2.0 * radius_ / norm(d));
  for (const double side : {half, -half}) {
    const Vec2 out = radius_ * rotated(u, side);
    connect(graph, a.at + out, i, b.at - out, j);
  }
}

void VisibilityGraph::connect_end(Graph& graph, int end, int j) const {
  const Vec2 p = graph.nodes[end].at, d = p - corners_[j].at;
  const auto add = [&](Vec2 q, int node) {
    graph.ways[end].emplace_back(node, norm(q - p));
    graph.ways[node].emplace_back(end, norm(q - p));
  };
  if (radius_ == 0.0) {
    if ((dot(d, corners_[j].from) >= 0.0 || dot(d, corners_[j].to) >= 0.0) && is_free(p, corners_[j].at))
      add(corners_[j].at, j);
    return;
  }
  const double half = std::acos(std::min(1.0, radius_ / norm(d)));
  for (const double side : {half, -half}) {
    const Vec2 q = corners_[j].at + radius_ * rotated(d / norm(d), side);
    if (is_free(p, q)) add(q, add_node(graph, q, j));
  }
}

/// Along each circle, from tangent to tangent. A tangent that is free touches it between the normals of its edges.
void VisibilityGraph::add_arcs(Graph& graph) const {
  std::vector<std::vector<int>> on(corners_.size());
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    if (graph.nodes[k].corner >= 0) on[graph.nodes[k].corner].push_back(static_cast<int>(k));
  for (std::vector<int>& nodes : on) {
    std::sort(nodes.begin(), nodes.end(), [&](int i, int j) { return graph.nodes[i].angle < graph.nodes[j].angle; });
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const double length = radius_ * (graph.nodes[nodes[k]].angle - graph.nodes[nodes[k - 1]].angle);
      graph.ways[nodes[k]].emplace_back(nodes[k - 1], length);
      graph.ways[nodes[k - 1]].emplace_back(nodes[k], length);
    }
  }
}

double VisibilityGraph::shortest(Vec2 start, Vec2 goal) const {
  Graph graph = graph_;
  const int s = add_node(graph, start, -1), t = add_node(graph, goal, -1);
  if (is_free(start, goal)) return norm(goal - start);
  for (int j = 0; j < static_cast<int>(corners_.size()); ++j) {
    connect_end(graph, s, j);
    connect_end(graph, t, j);
  }
  if (radius_ > 0.0) add_arcs(graph);
  std::vector<double> best(graph.nodes.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
  queue.emplace(best[s] = 0.0, s);
  while (!queue.empty()) {
    const auto [length, at] = queue.top();
    queue.pop();
    if (at == t) break;
    if (length > best[at]) continue;
    for (const auto& [to, more] : graph.ways[at])
      if (length + more < best[to]) queue.emplace(best[to] = length + more, to);
  }
  return best[t];
}

}  // namespace exactvo::bench
