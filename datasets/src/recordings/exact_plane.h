// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Plane geometry in rationals, for the audit. Written out here though others have such lines (vo's exact legs, the
/// benches' oracles): the checker shares nothing with what it checks but the plain types.

#include <gmpxx.h>

#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets::exact {

using Rational = mpq_class;

struct Point {
  Rational x, y;
};
inline Point exactly(geometry::Vec2 v) {
  return {Rational(v.x), Rational(v.y)};
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
/// |x| + |y|: at least the length.
inline Rational length_at_most(const Point& a) {
  return abs(a.x) + abs(a.y);
}

/// From one point to another, straight.
struct Straight {
  Point from, to;
};

Rational squared_distance(const Point& p, const Straight& s);

/// Whether some point of a is nearer than r to some point of b.
bool come_nearer_than(const Straight& a, const Straight& b, const Rational& r);

/// Whether p lies inside by the even-odd rule. Exact off the boundary.
bool is_inside(const Point& p, const geometry::Obstacle& obstacle);

/// A closed interval that holds a number.
struct Interval {
  Rational low, high;
  Rational middle() const { return (low + high) / 2; }
  Rational half_width() const { return (high - low) / 2; }
};
inline Interval exactly_that(const Rational& x) {
  return {x, x};
}
Interval operator+(const Interval& a, const Interval& b);
Interval operator-(const Interval& a, const Interval& b);
/// REQUIRES: b.low > 0.
Interval operator/(const Interval& a, const Interval& b);

/// sqrt(x), x >= 0: exact where the root is a rational, else 2^-200 wide.
Interval root(const Rational& x);

/// e^-x, x >= 0: at most 2^-180 wide.
Interval decay(const Rational& x);

/// A double that is no less, and one that is no more.
double at_least(const Rational& x);
double at_most(const Rational& x);

}  // namespace exactvo::datasets::exact
