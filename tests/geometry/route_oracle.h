// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The length of the shortest route by brute force, in doubles: Dijkstra's search over the tangents of all circles
/// round vertices (Laumond 1987). O(n^3) and a few digits less exact than doubles; it shares nothing with routes.h.

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "route_fields.h"

namespace exactvo::test {

class TangentGraph {
 public:
  /// REQUIRES: radius > 0; start and goal are free.
  TangentGraph(const RouteField& field, double radius) : radius_(radius) {
    for (const Obstacle& o : field.obstacles) {
      for (const geometry::Segment& e : geometry::edges_of(o)) edges_.push_back(e);
      for (const Vec2 v : geometry::vertices_of(o))
        if (std::find(centres_.begin(), centres_.end(), v) == centres_.end()) centres_.push_back(v);
    }
    on_circle_.resize(centres_.size());
    start_ = add_node(field.start);
    goal_ = add_node(field.goal);
    add_straight(start_, goal_);
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      add_tangents(start_, i);
      add_tangents(goal_, i);
      for (std::size_t j = 0; j < i; ++j) add_bitangents(i, j);
    }
    for (std::size_t i = 0; i < centres_.size(); ++i) add_arcs(i);
  }

  /// m; infinite where there is no route.
  double shortest() const {
    std::vector<double> best(arcs_.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
    queue.emplace(best[start_] = 0.0, start_);
    while (!queue.empty()) {
      const auto [length, at] = queue.top();
      queue.pop();
      if (length > best[at]) continue;
      for (const auto& [to, more] : arcs_[at])
        if (length + more < best[to]) queue.emplace(best[to] = length + more, to);
    }
    return best[goal_];
  }

 private:
  static constexpr double kSlack = 1e-9, kStep = 0.01;  // m; rad

  struct OnCircle {
    double angle;
    int node;
  };

  int add_node(Vec2 p) {
    places_.push_back(p);
    arcs_.emplace_back();
    return static_cast<int>(places_.size()) - 1;
  }
  void connect(int a, int b, double length) {
    arcs_[a].emplace_back(b, length);
    arcs_[b].emplace_back(a, length);
  }
  bool add_straight(int a, int b) {
    const geometry::Segment s{places_[a], places_[b]};
    for (const geometry::Segment& e : edges_)
      if (geometry::distance(s, e) < radius_ - kSlack) return false;
    connect(a, b, norm(s.b - s.a));
    return true;
  }
  Vec2 at(std::size_t circle, double angle) const {
    return centres_[circle] + radius_ * Vec2{std::cos(angle), std::sin(angle)};
  }
  int add_on_circle(std::size_t circle, double angle) {
    angle -= 2.0 * geometry::kPi * std::floor(angle / (2.0 * geometry::kPi));
    const int node = add_node(at(circle, angle));
    on_circle_[circle].push_back({angle, node});
    return node;
  }
  void add_tangents(int point, std::size_t circle) {
    const Vec2 d = places_[point] - centres_[circle];
    const double towards = std::atan2(d.y, d.x), half = std::acos(std::min(1.0, radius_ / norm(d)));
    for (const double angle : {towards - half, towards + half}) add_straight(point, add_on_circle(circle, angle));
  }
  void add_bitangents(std::size_t i, std::size_t j) {
    const Vec2 d = centres_[j] - centres_[i];
    const double towards = std::atan2(d.y, d.x), distance = norm(d);
    for (const double side : {-0.5 * geometry::kPi, 0.5 * geometry::kPi})
      add_straight(add_on_circle(i, towards + side), add_on_circle(j, towards + side));
    if (distance < 2.0 * radius_) return;
    const double half = std::acos(2.0 * radius_ / distance);
    for (const double angle : {towards - half, towards + half})
      add_straight(add_on_circle(i, angle), add_on_circle(j, angle + geometry::kPi));
  }
  void add_arcs(std::size_t circle) {
    std::vector<OnCircle>& nodes = on_circle_[circle];
    std::sort(nodes.begin(), nodes.end(), [](const OnCircle& a, const OnCircle& b) { return a.angle < b.angle; });
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const OnCircle &a = nodes[k], &b = nodes[(k + 1) % nodes.size()];
      const double turn = b.angle - a.angle + (k + 1 == nodes.size() ? 2.0 * geometry::kPi : 0.0);
      if (is_free_arc(circle, a.angle, turn)) connect(a.node, b.node, radius_ * turn);
    }
  }
  bool is_free_arc(std::size_t circle, double from, double turn) const {
    const int count = 1 + static_cast<int>(turn / kStep);
    for (int k = 0; k <= count; ++k)
      for (const geometry::Segment& e : edges_)
        if (geometry::distance(e, at(circle, from + turn * k / count)) < radius_ - kSlack) return false;
    return true;
  }

  double radius_;
  std::vector<geometry::Segment> edges_;
  std::vector<Vec2> centres_, places_;
  std::vector<std::vector<OnCircle>> on_circle_;
  std::vector<std::vector<std::pair<int, double>>> arcs_;
  int start_ = 0, goal_ = 0;
};

}  // namespace exactvo::test
