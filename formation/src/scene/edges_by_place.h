// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The edges of all static obstacles, looked up by place.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box_grid.h"

namespace exactvo::formation::detail {

class EdgesByPlace {
 public:
  /// In the order of the obstacles and along each. REQUIRES: finite coordinates.
  explicit EdgesByPlace(const std::vector<SceneObstacle>& obstacles) {
    std::vector<geometry::Box> boxes;
    for (const SceneObstacle& o : obstacles) {
      for (const geometry::Segment& edge : geometry::edges_of(o.shape)) {
        edges_.push_back(edge);
        boxes.push_back(geometry::box_of(edge));
        for (const Vec2 p : {edge.a, edge.b}) largest_ = largest_with(p);
      }
    }
    grid_ = geometry::BoxGrid(std::move(boxes));
  }

  const std::vector<geometry::Segment>& all() const { return edges_; }
  const geometry::Segment& operator[](std::size_t k) const { return edges_[k]; }
  /// Its boxes have the edges' numbers.
  const geometry::BoxGrid& grid() const { return grid_; }
  /// m: the largest coordinate of them and of x, for the rounding of a distance between them.
  double largest_with(Vec2 x) const { return std::max({largest_, std::fabs(x.x), std::fabs(x.y)}); }

 private:
  std::vector<geometry::Segment> edges_;
  geometry::BoxGrid grid_;
  double largest_ = 0.0;  ///< m, coordinate
};

}  // namespace exactvo::formation::detail
