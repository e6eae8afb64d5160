// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The scene of an audited run: obstacles as rationals, with boxes in doubles that tell what can be skipped.

#include <algorithm>
#include <vector>

#include "recordings/exact_motion.h"
#include "recordings/exact_plane.h"

namespace exactvo::datasets {

/// Doubles that hold what they stand for.
struct AuditBox {
  double left, right, bottom, top;
};

inline AuditBox box_of(const geometry::Segment& s) {
  return {std::min(s.a.x, s.b.x), std::max(s.a.x, s.b.x), std::min(s.a.y, s.b.y), std::max(s.a.y, s.b.y)};
}

inline AuditBox box_of(geometry::Vec2 p) {
  return {p.x, p.x, p.y, p.y};
}

inline AuditBox box_of(const exact::Chord& c) {
  const auto [left, right] = std::minmax(c.way.from.x, c.way.to.x);
  const auto [bottom, top] = std::minmax(c.way.from.y, c.way.to.y);
  return {exact::at_most(left - c.stray), exact::at_least(right + c.stray), exact::at_most(bottom - c.stray),
          exact::at_least(top + c.stray)};
}

/// A difference of doubles that is rounded above r is above r: rounding never changes an order.
inline bool are_apart(const AuditBox& a, const AuditBox& b, double r) {
  return a.left - b.right > r || b.left - a.right > r || a.bottom - b.top > r || b.bottom - a.top > r;
}

/// An obstacle's edges as rationals, once for all steps.
struct RationalObstacle {
  explicit RationalObstacle(const geometry::Obstacle& shape) : obstacle(&shape), segments(edges_of(shape)) {
    for (const geometry::Segment& edge : segments) {
      edges.push_back({exact::exactly(edge.a), exact::exactly(edge.b)});
      boxes.push_back(box_of(edge));
    }
    box = boxes.front();
    for (const AuditBox& b : boxes) {
      box.left = std::min(box.left, b.left);
      box.right = std::max(box.right, b.right);
      box.bottom = std::min(box.bottom, b.bottom);
      box.top = std::max(box.top, b.top);
    }
  }

  /// Numbers of the edges that something within the box may come nearer to than r.
  std::vector<std::size_t> near(const AuditBox& within, double r) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (!are_apart(within, boxes[k], r)) out.push_back(k);
    return out;
  }

  const geometry::Obstacle* obstacle;
  std::vector<geometry::Segment> segments;
  std::vector<exact::Straight> edges;
  std::vector<AuditBox> boxes;
  AuditBox box;  ///< of the whole, its inside too
};

inline std::vector<RationalObstacle> rational_obstacles(const formation::Scenario& scenario) {
  std::vector<RationalObstacle> all;
  for (const formation::SceneObstacle& o : scenario.obstacles) all.emplace_back(o.shape);
  return all;
}

}  // namespace exactvo::datasets
