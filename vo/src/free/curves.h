// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The curves that bound what is allowed: circles, lines and stretches of them over exact algebraic numbers
/// (number.h).
///
/// A curve runs so that what its owner allows lies on its left: the speed's circle counter-clockwise, a cone's front
/// clockwise, from its right leg, inward, over the front to its left leg, outward.

#include <CGAL/CORE_Expr.h>

#include <vector>

#include "exact/algebraic_root.h"
#include "exact/exact_sum.h"
#include "exact/exact_vector.h"
#include "exactvo/vo/free_arrangement.h"

namespace exactvo::vo::detail {

/// Exact algebraic numbers: rationals, sums, products, quotients and square roots, whose signs are exact. They are
/// CORE::Expr with its floating-point filter kept from three mistakes (CGAL 5 and 6):
///
///  - a value whose size *equals* its error bound passes the filter, but the logarithm of their difference, -2^31, is
///    taken for the number's size: what is computed from it then asks for 2^31 bits. Inputs that are an ulp or two from
///    a coincidence get there.
///  - division by a value whose double approximation is 0 writes a message to the file Core_Diagnostics;
///  - so does the square root of a value whose approximation is negative.
class Number {
 public:
  Number() = default;
  explicit Number(double x) : value_(x) {}
  explicit Number(const Rational& x);

  int sign() const { return value_.sign(); }
  double rounded() const { return value_.doubleValue(); }
  /// Within 2^-bits.
  Rational approximate(int bits) const;

  friend Number operator+(const Number& a, const Number& b) { return filtered(a.value_ + b.value_); }
  friend Number operator-(const Number& a, const Number& b) { return filtered(a.value_ - b.value_); }
  friend Number operator*(const Number& a, const Number& b) { return filtered(a.value_ * b.value_); }
  friend Number operator-(const Number& a) { return filtered(-a.value_); }
  friend bool operator<(const Number& a, const Number& b) { return (a - b).sign() < 0; }
  friend bool operator<=(const Number& a, const Number& b) { return (a - b).sign() <= 0; }

  /// a / b. REQUIRES: b not zero.
  friend Number quotient(const Number& a, const Number& b);
  /// REQUIRES: x >= 0.
  friend Number root_of(const Number& x);

 private:
  /// The value with a filter that passes only what exceeds its error bound.
  static Number filtered(const CORE::Expr& value);

  CORE::Expr value_;
};

Number quotient(const Number& a, const Number& b);
Number root_of(const Number& x);

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
