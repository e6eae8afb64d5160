// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact straight ways where the disc has no room for rounding: through the middle of a gate that it just fits through,
/// and out of contact with a site. Their points are fractions; each way is proven clear.

#include <vector>

#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// A tight gate: its exact middle and the exact direction at right angles to it.
struct Gate {
  Point middle;
  Vector<Rational> through;  ///< in the sense of the route
  double width;              ///< m, |through|, rounded
};

class StraightWays {
 public:
  explicit StraightWays(const ClearancePlan& plan) : plan_(plan), map_(plan.map()) {}

  /// The gate that a portal is a piece of, as it is crossed.
  Gate gate_of(int portal, bool from_left) const;

  /// Whether the gate is strict Gabriel. The middle of any other narrow side may be off the way, or not free; there is
  /// a narrower gate beside it, which the way crosses too.
  bool is_gabriel(int portal) const;

  /// Points from which a gate's middle is reached straight at right angles (`sense` -1) or to which it is left so (1),
  /// farthest first; the last is the middle itself.
  std::vector<Point> approach(const Gate& gate, int sense) const;

  /// Points from which an end of the route is reached straight, farthest first; the last is the end itself. Where the
  /// disc stands in contact with a site, it can leave along the tangent, which is rational, and perhaps in no other
  /// direction that doubles name.
  std::vector<Point> departures(Vec2 end) const;

  /// The same ways as far as they are clear: to where a passage ends that is a few units in the last place wider than
  /// the disc, too few for a taut string. With the point on the way beside `goal`. May be empty.
  std::vector<Point> far_approach(const Gate& gate, int sense, const Point& goal) const;
  std::vector<Point> far_departures(Vec2 end, const Point& goal) const;

 private:
  std::vector<Vector<Rational>> tangents_at(Vec2 x) const;
  void add_straight_on(const Point& x, const Vector<Rational>& step, const Point& goal, std::vector<Point>& out) const;

  const ClearancePlan& plan_;
  const CellMap& map_;
};

}  // namespace exactvo::geometry::routing
