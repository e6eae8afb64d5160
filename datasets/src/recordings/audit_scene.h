// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The scene of an audited run: obstacles as rationals, with boxes in doubles that tell what can be skipped.

#include <algorithm>
#include <vector>

#include "exactvo/geometry/box.h"
#include "recordings/exact_motion.h"
#include "recordings/exact_plane.h"

namespace exactvo::datasets {

inline geometry::Box box_of(const geometry::Segment& s) {
  geometry::Box box{s.a, s.a};
  box.add(s.b);
  return box;
}

inline geometry::Box box_of(geometry::Vec2 p) {
  return {p, p};
}

inline geometry::Box box_of(const exact::Chord& c) {
  const auto [left, right] = std::minmax(c.way.from.x, c.way.to.x);
  const auto [bottom, top] = std::minmax(c.way.from.y, c.way.to.y);
  return {{exact::at_most(left - c.stray), exact::at_most(bottom - c.stray)},
          {exact::at_least(right + c.stray), exact::at_least(top + c.stray)}};
}

/// A difference of doubles that is rounded above r is above r: rounding never changes an order.
inline bool are_apart(const geometry::Box& a, const geometry::Box& b, double r) {
  return a.low.x - b.high.x > r || b.low.x - a.high.x > r || a.low.y - b.high.y > r || b.low.y - a.high.y > r;
}

/// An obstacle's edges as rationals, once for all steps.
struct RationalObstacle {
  explicit RationalObstacle(const geometry::Obstacle& shape) : obstacle(&shape), segments(edges_of(shape)) {
    for (const geometry::Segment& edge : segments) {
      edges.push_back({exact::exactly(edge.a), exact::exactly(edge.b)});
      boxes.push_back(box_of(edge));
    }
    for (const geometry::Box& b : boxes) box.add(b);
  }

  /// Numbers of the edges that something within the box may come nearer to than r.
  std::vector<std::size_t> near(const geometry::Box& within, double r) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (!are_apart(within, boxes[k], r)) out.push_back(k);
    return out;
  }

  const geometry::Obstacle* obstacle;
  std::vector<geometry::Segment> segments;
  std::vector<exact::Straight> edges;
  std::vector<geometry::Box> boxes;
  geometry::Box box;  ///< of the whole, its inside too
};

inline std::vector<RationalObstacle> rational_obstacles(const formation::Scenario& scenario) {
  std::vector<RationalObstacle> all;
  for (const formation::SceneObstacle& o : scenario.obstacles) all.emplace_back(o.shape);
  return all;
}

}  // namespace exactvo::datasets
