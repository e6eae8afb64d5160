// SPDX-License-Identifier: GPL-3.0-or-later
#include "preflight/strip.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Segment;

/// Coordinates along a wall and across it, from its first end, m. Each is off by less than `rounding`.
class Frame {
 public:
  Frame(const Segment& wall, double largest_coordinate)
      : origin_(wall.a),
        along_((wall.b - wall.a) / norm(wall.b - wall.a)),
        rounding_(8.0 * geometry::rounding_of_distance(largest_coordinate)) {}

  double along(Vec2 p) const { return dot(along_, p - origin_); }
  double across(Vec2 p) const { return cross(along_, p - origin_); }
  double rounding() const { return rounding_; }

 private:
  Vec2 origin_, along_;
  double rounding_;
};

/// From where to where the squares reach along a wall, and on which side of it their middles are.
struct Extent {
  double low = geometry::kInfinity, high = -geometry::kInfinity;          ///< m
  double nearest = geometry::kInfinity, farthest = -geometry::kInfinity;  ///< m, across
};

Extent extent_of(const std::vector<Vec2>& squares, double side, const Frame& frame) {
  Extent e;
  for (const Vec2 corner : squares) {
    const Vec2 middle = corner + Vec2{0.5 * side, 0.5 * side};
    e.low = std::min(e.low, frame.along(middle) - side);
    e.high = std::max(e.high, frame.along(middle) + side);
    e.nearest = std::min(e.nearest, frame.across(middle));
    e.farthest = std::max(e.farthest, frame.across(middle));
  }
  return e;
}

/// The farther of two walls at the ends of the squares, if it faces all of them from beyond their middles. Slanted
/// walls count up to a slope of a half: squares are small beside radii, so that none lies on both sides of a wall.
std::optional<double> width_to(const Segment& wall, const Frame& frame, const Extent& squares) {
  const double a = frame.along(wall.a), b = frame.along(wall.b);
  if (!(std::min(a, b) + frame.rounding() <= squares.low && squares.high <= std::max(a, b) - frame.rounding()))
    return std::nullopt;
  const double slope = (frame.across(wall.b) - frame.across(wall.a)) / (b - a);
  if (!(std::fabs(slope) <= 0.5)) return std::nullopt;
  const double at_low = frame.across(wall.a) + slope * (squares.low - a);
  const double at_high = frame.across(wall.a) + slope * (squares.high - a);
  if (!(std::min(at_low, at_high) > squares.farthest)) return std::nullopt;
  return std::max(at_low, at_high) + 8.0 * frame.rounding();
}

bool order_would_change(const DiscWithGoal& first, const DiscWithGoal& second, const Frame& frame) {
  const double start = frame.along(second.start) - frame.along(first.start);
  const double goal = frame.along(second.goal) - frame.along(first.goal), reach = first.reach + second.reach;
  const double rounding = 4.0 * frame.rounding();
  return start > rounding ? goal + reach < -rounding : start < -rounding && goal - reach > rounding;
}

/// By number, so that the same one is found whatever the order of the grid. The walls of a strip narrower than
/// `side_by_side` reach past a disc in it, and so come nearer to its middle than that.
std::vector<std::size_t> walls_near(Vec2 middle, double side_by_side, double rounding, const EdgesByPlace& walls) {
  std::vector<std::size_t> near;
  walls.grid().for_each_within(middle, side_by_side + rounding, [&](std::size_t k) { near.push_back(k); });
  std::sort(near.begin(), near.end());
  return near;
}

/// Whether both discs start level with the wall and the first to the left of it, nearer than `most`, m.
bool may_bound(double length, const Frame& frame, const DiscWithGoal& first, const DiscWithGoal& second, double most) {
  const double across = frame.across(first.start);
  const auto is_level = [&](Vec2 p) { return frame.along(p) > 0.0 && frame.along(p) < length; };
  return across > 0.0 && across < most && is_level(first.start) && is_level(second.start);
}

/// Takes them off what is left; nothing is left where that was too little.
bool has_looks(std::size_t& left, std::size_t wanted) {
  const bool enough = wanted <= left;
  left = enough ? left - wanted : 0;
  return enough;
}

}  // namespace

std::optional<double> strip_that_keeps_order(const DiscWithGoal& first, const DiscWithGoal& second, double side_by_side,
                                             const std::vector<Vec2>& squares, double side, const EdgesByPlace& walls,
                                             std::size_t& looks) {
  double largest = walls.largest_with(squares.front());
  for (const Vec2 goal : {first.goal, second.goal}) largest = std::max(largest, walls.largest_with(goal));
  const double rounding = 16.0 * geometry::rounding_of_distance(largest);
  const std::vector<std::size_t> near = walls_near(first.start, side_by_side, rounding, walls);
  if (!has_looks(looks, 2 * near.size())) return std::nullopt;
  for (const std::size_t k : near) {
    const Segment wall = walls[k];
    for (const Segment& from : {wall, Segment{wall.b, wall.a}}) {  // squares are to the left of one of them
      const Frame frame(from, largest);
      const double length = norm(wall.b - wall.a);
      if (!may_bound(length, frame, first, second, side_by_side) || !order_would_change(first, second, frame)) continue;
      if (!has_looks(looks, squares.size() + near.size())) return std::nullopt;
      const Extent extent = extent_of(squares, side, frame);
      if (!(frame.rounding() <= extent.low && extent.high <= length - frame.rounding() && extent.nearest > 0.0))
        continue;
      for (const std::size_t other : near)
        if (const std::optional<double> width = width_to(walls[other], frame, extent); width && *width < side_by_side)
          return width;
    }
  }
  return std::nullopt;
}

}  // namespace exactvo::formation::detail
