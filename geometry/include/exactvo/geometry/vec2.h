// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The vector of the plane: two doubles, in whatever unit the caller says (positions m, velocities m/s).
/// x forward, y left, counter-clockwise positive (REP-103). A finite double *is* a rational number: predicates over
/// these types (predicates.h) are exact for the numbers given; the operations here are plain rounded arithmetic.

#include <algorithm>
#include <cmath>

namespace exactvo::geometry {

/// A point or a vector.
struct Vec2 {
  double x = 0.0;  ///< forward
  double y = 0.0;  ///< left
};

///@{
/// Coordinate by coordinate; every operation rounded to nearest.
constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
constexpr Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
constexpr Vec2 operator*(Vec2 a, double s) { return {s * a.x, s * a.y}; }
constexpr Vec2 operator/(Vec2 a, double s) { return {a.x / s, a.y / s}; }
constexpr Vec2& operator+=(Vec2& a, Vec2 b) { return a = a + b; }
constexpr Vec2& operator-=(Vec2& a, Vec2 b) { return a = a - b; }
///@}
///@{
/// Whether both coordinates are equal. Exact; a NaN equals nothing.
constexpr bool operator==(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }
constexpr bool operator!=(Vec2 a, Vec2 b) { return !(a == b); }
///@}

/// The scalar product. Rounded.
constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// The z component of a x b: positive where b lies counter-clockwise of a.
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
/// |a|^2. Rounded.
constexpr double squared_norm(Vec2 a) { return dot(a, a); }
/// |a|. Rounded; infinite or 0 where |a|^2 leaves the range of doubles.
inline double norm(Vec2 a) { return std::sqrt(squared_norm(a)); }
/// The larger of |x| and |y|.
inline double largest_coordinate(Vec2 a) { return std::max(std::fabs(a.x), std::fabs(a.y)); }
/// `a` turned by +90 degrees.
constexpr Vec2 perp(Vec2 a) { return {-a.y, a.x}; }
/// `a` turned by `angle` radians, counter-clockwise.
inline Vec2 rotated(Vec2 a, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * a.x - s * a.y, s * a.x + c * a.y};
}
/// `a` scaled to length 1 up to rounding; (0, 0) stays (0, 0).
inline Vec2 normalized(Vec2 a) {
  const double length = std::hypot(a.x, a.y);
  return length > 0.0 ? a / length : Vec2{};
}
/// In [0, 1], rounded: the share of the segment from a to b at which it is nearest to p; 0 if |b - a|^2 is 0.
inline double nearest_share(Vec2 a, Vec2 b, Vec2 p) {
  const double length2 = squared_norm(b - a);
  return length2 > 0.0 ? std::clamp(dot(p - a, b - a) / length2, 0.0, 1.0) : 0.0;
}
/// The point of the segment from a to b nearest to p. Rounded; `nearest_point` (distance.h) is good beyond 1e150 m too.
inline Vec2 nearest_on(Vec2 a, Vec2 b, Vec2 p) { return a + nearest_share(a, b, p) * (b - a); }
/// Whether neither coordinate is NaN or infinite.
inline bool is_finite(Vec2 a) { return std::isfinite(a.x) && std::isfinite(a.y); }

}  // namespace exactvo::geometry
