// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the audit has beside the plane in rationals (exact/rational_plane.h): the inside of obstacles, enclosures of
/// roots and exponentials. It shares nothing with what it checks but the plain types.

#include "exact/rational_plane.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets::exact {

using namespace geometry::rational;

/// |x| + |y|: at least the length.
inline Rational length_at_most(const Point& a) {
  return abs(a.x) + abs(a.y);
}

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
