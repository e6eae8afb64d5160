// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The filter stage of a segment against a disc, which also tells most segments from the ellipses between two discs.

#include <cmath>

#include "exactvo/geometry/support.h"

namespace exactvo::geometry::detail {

enum class FilterAnswer { disjoint, intersects, uncertain };

/// Whether [0, t v] meets the disc of squared radius r2 round p. With P = |p.x| + |p.y|, V = |v.x| + |v.y|:
///
///   c = v x p errs by 3 u P V (p itself by u, its products by 1 u, their sum by 1 u), c^2 by 7 u P^2 V^2, r2 |v|^2 by
///   15 u r2 V^2, their difference by 1 u of both; |p - t v|^2 by 6 u (P + t V)^2. kError = 32 u is more than any.
///
/// The foot of p on the line is told by the rounded p.v and p.v - t |v|^2, which err by e <= 4 u V (P + t V). If it is
/// taken for beyond an end though it lies before it, then by at most e / |v|, and the distance is less than that
/// to the end by e^2 / |v|^2 <= 32 u^2 (P + t V)^2 at most, squared: no more than the second order. Beside it
/// what underflow adds to p.v (2^-1073) can move the squared distance by 2 t times as much.
/// REQUIRES: p and r2 in error by at most u and 12 u of themselves, t >= 0. `uncertain` for NaN and on
/// overflow.
inline FilterAnswer segment_disc_filter(Vec2 p, Vec2 v, double t, double r2) {
  constexpr double kError = 32.0 * kUnitRoundoff;
  constexpr double kMost = 0x1p100;              // of a number; no product of them overflows
  constexpr double kLostToUnderflow = 0x1p-600;  // more than an underflow times the largest of them
  const auto side = [](double gap, double error) {
    return gap > error ? FilterAnswer::disjoint : gap < -error ? FilterAnswer::intersects : FilterAnswer::uncertain;
  };
  const double size_p = std::fabs(p.x) + std::fabs(p.y);
  const double size_v = std::fabs(v.x) + std::fabs(v.y);
  if (!(size_p + size_v + t <= kMost && r2 <= kMost * kMost)) return FilterAnswer::uncertain;
  const double pv = dot(p, v);
  const double size2 = size_p * size_p + r2;
  if (pv <= 0.0) return side(squared_norm(p) - r2, kError * size2 + kLostToUnderflow);
  const double speed2 = squared_norm(v);
  const double c = cross(v, p);
  const FilterAnswer line = side(c * c - r2 * speed2, kError * size2 * (size_v * size_v) + kLostToUnderflow);
  if (line == FilterAnswer::disjoint || pv < t * speed2) return line;
  const double size_end = size_p + t * size_v;
  return side(squared_norm(p - t * v) - r2, kError * (size_end * size_end + r2) + kLostToUnderflow);
}

}  // namespace exactvo::geometry::detail
