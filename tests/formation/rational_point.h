// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Points with rational coordinates, with which tests judge decisions exactly.

#include <gmpxx.h>

#include "exactvo/geometry/vec2.h"

namespace exactvo::formation {

using geometry::Vec2;

using Rational = mpq_class;

struct Point {
  Rational x, y;
};
inline Point exactly(Vec2 v) {
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

}  // namespace exactvo::formation
