// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Boxes round obstacles: most are seen to be out of the way without a look at their edges.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box_grid.h"
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
    std::vector<geometry::Box> placed;
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
      if (boxes_[k].is_empty()) continue;
      if (!geometry::is_finite(boxes_[k].low) || !geometry::is_finite(boxes_[k].high)) {
        anywhere_.push_back(k);
        continue;
      }
      obstacle_of_.push_back(k);
      placed.push_back(boxes_[k]);
      largest_ = std::max({largest_, std::fabs(boxes_[k].low.x), std::fabs(boxes_[k].low.y),
                           std::fabs(boxes_[k].high.x), std::fabs(boxes_[k].high.y)});
    }
    by_place_ = geometry::BoxGrid(std::move(placed));
  }

  /// All that are not `is_beyond`, in order.
  std::vector<std::size_t> near(geometry::Vec2 x, double distance) const {
    std::vector<std::size_t> found = anywhere_;
    const double largest = std::max({largest_, std::fabs(x.x), std::fabs(x.y)});
    by_place_.for_each_within(x, distance + 2.0 * geometry::rounding_of_distance(largest), [&](std::size_t k) {
      if (!is_beyond(obstacle_of_[k], x, distance)) found.push_back(obstacle_of_[k]);
    });
    std::sort(found.begin(), found.end());
    return found;
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
  std::vector<std::size_t> obstacle_of_, anywhere_;  ///< of the grid; whose box is not finite
  geometry::BoxGrid by_place_;
  double largest_ = 0.0;  ///< m, coordinate
};

}  // namespace exactvo::formation::detail
