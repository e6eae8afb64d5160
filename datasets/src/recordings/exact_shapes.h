// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Convex shapes in rationals, for the audit: what lies in them, and how far points are from them. Exact.

#include "exactvo/geometry/shapes.h"
#include "recordings/exact_plane.h"

namespace exactvo::datasets::exact {

/// Whether p lies in the shape, boundary included. REQUIRES: a valid shape.
bool contains(const geometry::ConvexShape& shape, const Point& p);

/// Whether some point of the shape is at most r away from p. REQUIRES: a valid disc, segment or polygon; r >= 0.
bool is_within(const geometry::ConvexShape& shape, const Point& p, const Rational& r);

/// Whether every point of the shape is at least r away from p. REQUIRES: as `is_within`.
bool is_clear(const geometry::ConvexShape& shape, const Point& p, const Rational& r);

/// Whether { v : n.v >= offset } excludes every velocity with which a point, relative to the centre of a disc, gets
/// nearer than `reach` to it within `time`: n.centre + reach |n| <= min(0, time offset). `centre` is seen from the
/// point.
bool excludes_disc(const Point& centre, const Rational& reach, const Point& n, const Rational& offset,
                   const Rational& time);

}  // namespace exactvo::datasets::exact
