// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact straight ways where the disc has no room for rounding: through the middle of a gate that it just fits through,
/// and out of contact with a site. Their points are fractions; each way is proven clear.

#include <vector>

#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// A point with exact directions in which the disc leaves it straight, and reaches it from the other side.
struct Stop {
  Point at;
  std::vector<Vector<Rational>> ways;
};

class StraightWays {
 public:
  explicit StraightWays(const ClearancePlan& plan) : plan_(plan), map_(plan.map()) {}

  /// The middle of the gate that a portal is a piece of, and the way out of it, at right angles, as it is crossed.
  Stop gate_of(int portal, bool from_left) const;

  /// An end of the route. Where the disc stands in contact with sites, it can leave along their tangents, which are
  /// rational, and perhaps in no other direction that doubles name.
  Stop end_at(Vec2 x) const;

  /// Whether the gate is strict Gabriel. The middle of any other narrow side may be off the way, or not free; there is
  /// a narrower gate beside it, which the way crosses too.
  bool is_gabriel(int portal) const;

  /// Points from which it is reached straight, farthest first; the last is the point itself.
  std::vector<Point> near(const Stop& stop) const;

  /// The same ways as far as they are clear: to where a passage ends that is a few units in the last place wider than
  /// the disc, too few for a taut string. With the points on the way beside `goal` and just beyond the corners. May be
  /// empty.
  std::vector<Point> far(const Stop& stop, const Point& goal, const std::vector<Vec2>& corners) const;

 private:
  Vector<Rational> stretch(const Vector<Rational>& way, double share) const;
  void add_straight_on(const Point& x, const Vector<Rational>& step, const Point& goal,
                       const std::vector<Vec2>& corners, std::vector<Point>& out) const;

  const ClearancePlan& plan_;
  const CellMap& map_;
};

}  // namespace exactvo::geometry::routing
