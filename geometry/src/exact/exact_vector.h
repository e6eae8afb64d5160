// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Vectors over any ring of numbers: the formulas of the predicates are written once, for the filter and for the exact
/// stage.

#include "exact/exact_number.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry::detail {

template <typename T>
struct Vector {
  T x, y;
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
Vector<T> minus(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <typename T>
T dot_of(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y;
}
template <typename T>
T cross_of(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.y - a.y * b.x;
}
template <typename T>
T squared(const T& a) {
  return a * a;
}

inline Sign sign_of_double(double x) {
  return x > 0 ? Sign::positive : x < 0 ? Sign::negative : Sign::zero;
}

/// Sign of k + sqrt(b) + sqrt(d), b, d >= 0, by repeated squaring.
inline Sign sign_with_two_roots(const Exact& k, const Exact& b, const Exact& d) {
  const Sign sk = sign_of(k);
  if (sk == Sign::positive) return sk;
  if (sk == Sign::zero) return sign_of(b) == Sign::zero && sign_of(d) == Sign::zero ? Sign::zero : Sign::positive;
  const Exact e = k * k - b - d;
  if (sign_of(e) == Sign::negative) return Sign::positive;
  return sign_of(Exact(4) * b * d - e * e);
}

}  // namespace exactvo::geometry::detail
