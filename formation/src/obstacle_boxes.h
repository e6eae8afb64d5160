// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Boxes round obstacles: most are seen to be out of the way without a look at their edges.

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"

namespace exactvo::formation::detail {

class ObstacleBoxes {
 public:
  explicit ObstacleBoxes(const std::vector<SceneObstacle>& obstacles) {
    boxes_.reserve(obstacles.size());
    for (const SceneObstacle& o : obstacles) {
      geometry::Box& box = boxes_.emplace_back();
      for (const geometry::Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
    }
  }

  /// Whether `signed_distance` from x to that obstacle is at least that, rounding and all.
  bool is_beyond(std::size_t obstacle, geometry::Vec2 x, double distance) const {
    const geometry::Box& b = boxes_[obstacle];
    const double largest = std::max({std::fabs(b.low.x), std::fabs(b.low.y), std::fabs(b.high.x), std::fabs(b.high.y),
                                     std::fabs(x.x), std::fabs(x.y)});
    return geometry::distance_below(b, x) >= distance + 2.0 * geometry::rounding_of_distance(largest);
  }

 private:
  std::vector<geometry::Box> boxes_;
};

}  // namespace exactvo::formation::detail
