// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Vectors over any ring of numbers: formulas are written once, for the filter and for the exact stages.

#include "exact/exact_number.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry::detail {

template <typename T>
struct Vector {
  T x, y;

  friend Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y}; }
  friend Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y}; }
  friend Vector operator*(const T& s, const Vector& a) { return {s * a.x, s * a.y}; }
  friend T dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y; }
  friend T cross(const Vector& a, const Vector& b) { return a.x * b.y - a.y * b.x; }
  friend Vector perp(const Vector& a) { return {-a.y, a.x}; }
};
template <typename T>
Vector<T> make(Vec2 v) {
  return {T(v.x), T(v.y)};
}
template <typename T>
Vector<T> difference(Vec2 a, Vec2 b) {
  return {T(a.x) - T(b.x), T(a.y) - T(b.y)};
}
template <typename T>
T squared(const T& a) {
  return a * a;
}

inline Sign sign_of_double(double x) {
  return x > 0 ? Sign::positive : x < 0 ? Sign::negative : Sign::zero;
}

/// Sign of a + b sqrt(d), d >= 0.
template <typename T>
Sign sign_with_root(const T& a, const T& b, const T& d) {
  const Sign sa = sign_of(a), sb = sign_of(d) == Sign::zero ? Sign::zero : sign_of(b);
  if (sa == sb || sb == Sign::zero) return sa;
  if (sa == Sign::zero) return sb;
  const Sign larger = sign_of(T(a * a - b * b * d));
  return larger == Sign::positive ? sa : larger == Sign::negative ? sb : Sign::zero;
}

/// Sign of k + sqrt(b) + sqrt(d), b, d >= 0, by repeated squaring.
template <typename T>
Sign sign_with_two_roots(const T& k, const T& b, const T& d) {
  const Sign sk = sign_of(k);
  if (sk == Sign::positive) return sk;
  if (sk == Sign::zero) return sign_of(b) == Sign::zero && sign_of(d) == Sign::zero ? Sign::zero : Sign::positive;
  const T e = k * k - b - d;
  if (sign_of(e) == Sign::negative) return Sign::positive;
  return sign_of(T(T(4) * b * d - e * e));
}

}  // namespace exactvo::geometry::detail
