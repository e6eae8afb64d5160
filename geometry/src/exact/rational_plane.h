// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Plane geometry in rationals, for checkers: of routes here, of recordings in datasets. What finds an answer must not
/// use it, so that a mistake in it is not made twice.

#include <gmpxx.h>

#include <algorithm>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::rational {

using Rational = mpq_class;

struct Point {
  Rational x, y;
};
inline Point exactly(Vec2 v) {
  return {Rational(v.x), Rational(v.y)};
}
inline bool operator==(const Point& a, const Point& b) {
  return a.x == b.x && a.y == b.y;
}
inline Point operator+(const Point& a, const Point& b) {
  return {Rational(a.x + b.x), Rational(a.y + b.y)};
}
inline Point operator-(const Point& a, const Point& b) {
  return {Rational(a.x - b.x), Rational(a.y - b.y)};
}
inline Point operator*(const Rational& s, const Point& a) {
  return {Rational(s * a.x), Rational(s * a.y)};
}
inline Rational dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y;
}
inline Rational cross(const Point& a, const Point& b) {
  return a.x * b.y - a.y * b.x;
}

/// From one point to another, straight.
struct Straight {
  Point from, to;
};
inline Straight exactly(const Segment& s) {
  return {exactly(s.a), exactly(s.b)};
}

inline Rational squared_distance(const Point& p, const Straight& s) {
  const Point e = s.to - s.from, d = p - s.from;
  const Rational length2 = dot(e, e);
  Rational t = sgn(length2) > 0 ? Rational(dot(d, e) / length2) : Rational(0);
  t = std::min(std::max(t, Rational(0)), Rational(1));
  const Point rest = d - t * e;
  return dot(rest, rest);
}

/// Whether they cross in a point within both.
inline bool cross_properly(const Straight& a, const Straight& b) {
  const Point e = a.to - a.from, f = b.to - b.from;
  return sgn(cross(e, b.from - a.from)) * sgn(cross(e, b.to - a.from)) < 0 &&
         sgn(cross(f, a.from - b.from)) * sgn(cross(f, a.to - b.from)) < 0;
}

/// Whether some point of a is nearer than r to some point of b. REQUIRES: r > 0.
inline bool come_nearer_than(const Straight& a, const Straight& b, const Rational& r) {
  const auto apart = [&](const Rational& a0, const Rational& a1, const Rational& b0, const Rational& b1) {
    return std::max(a0, a1) + r <= std::min(b0, b1) || std::max(b0, b1) + r <= std::min(a0, a1);
  };
  if (apart(a.from.x, a.to.x, b.from.x, b.to.x) || apart(a.from.y, a.to.y, b.from.y, b.to.y)) return false;
  if (cross_properly(a, b)) return true;
  const Rational r2 = r * r;
  return squared_distance(a.from, b) < r2 || squared_distance(a.to, b) < r2 || squared_distance(b.from, a) < r2 ||
         squared_distance(b.to, a) < r2;
}

/// Whether the ray from p along d crosses ab, behind p; of its ends the one on the left counts.
inline bool ray_crosses(const Point& p, const Point& d, const Point& a, const Point& b) {
  const bool is_east = sgn(d.y) == 0 && sgn(d.x) > 0;  // as it mostly is: without products
  const auto is_left = [&](const Point& x) { return is_east ? x.y > p.y : sgn(cross(d, x - p)) > 0; };
  const bool b_left = is_left(b);
  if (is_left(a) == b_left) return false;
  const int side = sgn(cross(b - a, p - a));
  return b_left ? side > 0 : side < 0;
}

/// The direction to the right.
inline const Point& east() {
  static const Point right{1, 0};
  return right;
}

}  // namespace exactvo::geometry::rational
