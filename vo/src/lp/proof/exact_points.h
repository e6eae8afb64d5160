// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The numbers of the exact stage: dyadic rationals of any length, and alpha + beta sqrt(D) over them. No divisions:
/// points are homogeneous. Internal; CGAL's number type goes no further than the units that include this.

#include "exact/exact_vector.h"
#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

using geometry::detail::Exact;

inline int sign_of(const Exact& x) {
  return static_cast<int>(CGAL::sign(x));
}

/// The sign of alpha + beta sqrt(d), d >= 0.
inline int sign_of_root(const Exact& alpha, const Exact& beta, const Exact& d) {
  return static_cast<int>(geometry::detail::sign_with_root(alpha, beta, d));
}

using ExactVector = geometry::detail::Vector<Exact>;

inline ExactVector exact(Vec2 v) {
  return geometry::detail::make<Exact>(v);
}

/// normal . v >= offset.
struct ExactLine {
  ExactVector normal;
  Exact offset;
};

inline ExactLine exact(const HalfPlane& h) {
  return {exact(h.normal), Exact(h.offset)};
}

/// ((x0 + x1 sqrt(d)) / w, (y0 + y1 sqrt(d)) / w), w > 0.
struct ExactPoint {
  Exact x0, x1, y0, y1, w, d;
};

/// The sign of offset - normal . v: positive outside.
inline int sign_of_violation(const ExactLine& line, const ExactPoint& v) {
  const Exact alpha = line.offset * v.w - line.normal.x * v.x0 - line.normal.y * v.y0;
  const Exact beta = -(line.normal.x * v.x1 + line.normal.y * v.y1);
  return sign_of_root(alpha, beta, v.d);
}

}  // namespace exactvo::lp
