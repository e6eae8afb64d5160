// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Distances between what discs sweep, rounded, for searching: plans leave `kPlannedGap` between discs, which is far
/// more than any rounding, and half-planes decide in the end.

#include <algorithm>

#include "exactvo/geometry/shapes.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::detail {

using geometry::Segment;
using geometry::Vec2;

/// Share of the sum of two radii: what a plan leaves between discs that were not nearer before.
inline constexpr double kPlannedGap = 0.04;
/// Share of the same: what distances may fall short of where discs were nearer before.
inline constexpr double kSweepRounding = 1e-9;

inline double squared_distance(Vec2 p, Vec2 from, Vec2 to) {
  return squared_norm(p - nearest_on(from, to, p));
}

inline bool cross_each_other(const Segment& s, const Segment& t) {
  const Vec2 u = s.b - s.a, v = t.b - t.a;
  const double a = cross(u, t.a - s.a), b = cross(u, t.b - s.a), c = cross(v, s.a - t.a), d = cross(v, s.b - t.a);
  return ((a > 0.0) != (b > 0.0)) && ((c > 0.0) != (d > 0.0)) && a != b && c != d;
}

inline double squared_distance(const Segment& s, const Segment& t) {
  if (cross_each_other(s, t)) return 0.0;
  return std::min({squared_distance(s.a, t.a, t.b), squared_distance(s.b, t.a, t.b), squared_distance(t.a, s.a, s.b),
                   squared_distance(t.b, s.a, s.b)});
}

/// Squared distance that centres keep whose radii add up to `radii`: as much as a plan wants, or what they had.
inline double squared_keep(double radii, double squared_before) {
  const double wanted = (1.0 + kPlannedGap) * radii;
  const double least = std::min(wanted * wanted, squared_before);
  return least - kSweepRounding * radii * radii;
}

}  // namespace exactvo::formation::detail
