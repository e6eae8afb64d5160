// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Upright boxes round shapes: what is looked up by place. Never too small, at most a few ulps too large.

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// { x : low <= x <= high }, both coordinates; empty as it begins.
struct Box {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};  ///< m, least coordinates
  /// m, greatest coordinates.
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  /// Grows to hold p.
  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  /// Grows to hold b.
  void add(const Box& b) {
    low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y)};
    high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y)};
  }
  /// Larger by that on every side, m. Rounded.
  Box grown(double by) const { return {low - Vec2{by, by}, high + Vec2{by, by}}; }
  /// The largest |coordinate| of its points, m; infinite of an empty one.
  double largest_coordinate() const {
    return std::max(geometry::largest_coordinate(low), geometry::largest_coordinate(high));
  }
  /// Whether it holds no point.
  bool is_empty() const { return !(low.x <= high.x && low.y <= high.y); }
  /// Whether it holds p. Exact.
  bool contains(Vec2 p) const { return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y; }
  double width() const { return is_empty() ? 0.0 : high.x - low.x; }   ///< m, rounded; 0 of an empty one
  double height() const { return is_empty() ? 0.0 : high.y - low.y; }  ///< m, rounded; 0 of an empty one
  double diagonal() const { return std::hypot(width(), height()); }    ///< m, rounded; 0 of an empty one
};

/// Whether they have a point in common; none where one is empty. Exact.
inline bool meet(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

/// Holds the shape: exact for segments and polygons, rounded outward for discs and ellipses.
Box box_of(const ConvexShape& shape);

/// The least distance from x to the box, m: 0 inside, infinite from an empty box. Rounded down: never more than the
/// true one and, from 2^-450 m on, lower by at most 16 ulps; where that is beyond the range of doubles, their largest.
/// REQUIRES: x is finite.
double distance_below(const Box& box, Vec2 x);

}  // namespace exactvo::geometry
