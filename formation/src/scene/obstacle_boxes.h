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
    std::vector<geometry::Box> boxes;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      geometry::Box box;
      for (const geometry::Vec2 p : geometry::vertices_of(obstacles[k].shape)) box.add(p);
      if (box.is_empty()) continue;
      if (!geometry::is_finite(box.low) || !geometry::is_finite(box.high)) {
        anywhere_.push_back(k);
        continue;
      }
      obstacle_of_.push_back(k);
      boxes.push_back(box);
      for (const geometry::Vec2 p : {box.low, box.high}) largest_ = largest_with(p);
    }
    by_place_ = geometry::BoxGrid(std::move(boxes));
  }

  /// In order, all to which `signed_distance` from x may be less than that, rounding and all.
  std::vector<std::size_t> near(geometry::Vec2 x, double distance) const {
    std::vector<std::size_t> found = anywhere_;
    const double rounding = 2.0 * geometry::rounding_of_distance(largest_with(x));
    by_place_.for_each_within(x, distance + rounding, [&](std::size_t k) { found.push_back(obstacle_of_[k]); });
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  double largest_with(geometry::Vec2 x) const { return std::max({largest_, std::fabs(x.x), std::fabs(x.y)}); }

  std::vector<std::size_t> obstacle_of_, anywhere_;  ///< of the grid; whose box is not finite
  geometry::BoxGrid by_place_;
  double largest_ = 0.0;  ///< m, coordinate
};

}  // namespace exactvo::formation::detail
