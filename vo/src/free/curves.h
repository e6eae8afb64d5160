// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The curves that bound what is allowed: circles, lines and stretches of them over exact algebraic numbers
/// (number.h).
///
/// A curve runs so that what its owner allows lies on its left: the speed's circle counter-clockwise, a cone's front
/// clockwise, from its right leg, inward, over the front to its left leg, outward.

#include <vector>

#include "exact/exact_sum.h"
#include "exact/exact_vector.h"
#include "exactvo/vo/free_arrangement.h"
#include "free/number.h"

namespace exactvo::vo::detail {

using Point = geometry::detail::Vector<Number>;

Point point(const RationalVector& v);

struct Circle {
  RationalVector centre;
  Rational radius;
};

/// A stretch of a line or of a circle (at most half of it).
struct Curve {
  ArcKind kind = ArcKind::leg;
  std::size_t owner = 0;
  bool is_arc = false;
  bool is_counter_clockwise = false;  ///< of arcs
  Circle circle;                      ///< of arcs
  Point anchor, direction;            ///< of lines; of arcs the start and the chord: positions are measured along it
  Point from, to;                     ///< where there are such
  bool has_from = true, has_to = true;

  /// Grows along the curve. REQUIRES: x on the curve.
  Number position(const Point& x) const { return dot(x - anchor, direction); }
  /// Positive where the curve bends to its left.
  Rational curvature() const;
  /// The sign of how far x lies on the left of the line, or of the chord.
  int side(const Point& x) const { return cross(direction, x - anchor).sign(); }
  /// Whether a point of the whole line or circle is one of the stretch, its ends included.
  bool reaches(const Point& x) const;
};

/// A part of what is allowed: inside the disc, on the left of a line, outside a cone. A ray is a cone without area: a
/// wall or a point that a robot without extent sees end on. Both its legs lie on it, in opposite directions.
struct Owner {
  enum class Kind { disc, half_plane, cone, ray } kind = Kind::disc;
  Circle disc;
  std::vector<Curve> curves;

  /// Whether it allows x, which is on none of its curves.
  bool allows(const Point& x) const;
};

Owner speed_disc(double max_speed);
Owner allowed_by(const HalfPlane& h);
/// REQUIRES: FreeArrangement::can_hold(cone), !cone.cone.overlaps(). `index` is the owner's.
Owner outside_of(const ShiftedCone& cone);

/// Whether both are stretches of one line or circle.
bool coincide(const Curve& a, const Curve& b);

/// The points that the whole lines or circles have in common. REQUIRES: they do not coincide.
std::vector<Point> common_points(const Curve& a, const Curve& b);

}  // namespace exactvo::vo::detail
