// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Support functions: h_K(n) = max over x in K of n.x, and a point that attains it.
/// Source: docs/guide/velocity-obstacles.md; the single formula behind every velocity obstacle.
///
/// Rounded, with a bound: `h` is within `16 u magnitude` of the true value, u = 2^-53 (derived in support.cpp).
/// Exact questions about supports are in predicates.h.

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// S = (shape - origin) (+) D(0, radius): the obstacle grown by the robot and seen from it. Kept unrounded, as its
/// parts.
struct GrownShape {
  ConvexShape shape;    ///< m, in the coordinates of the scene
  Vec2 origin;          ///< the robot's position, m
  double radius = 0.0;  ///< the robot's radius, m, >= 0
};

/// A rounded support value with the magnitude H that its error bound is a multiple of.
struct SupportValue {
  double h = 0.0;          ///< fl(h_S(n))
  double magnitude = 0.0;  ///< H: the sum of the absolute terms
};

/// h_S(n) for any n (need not be of unit length). Error at most `kSupportError * magnitude + kSupportUnderflow`.
SupportValue support(const GrownShape& s, Vec2 n);

/// A point of S with n.T = h_S(n) up to rounding.
Vec2 support_point(const GrownShape& s, Vec2 n);

/// An upper bound of h_S(n), certified: rounded up by the filter's error bound.
double support_upper_bound(const GrownShape& s, Vec2 n);

/// u: half the distance from 1 to the next double.
inline constexpr double kUnitRoundoff = 0x1p-53;
/// First-order bound 9 u H for the centre, ellipse and disc terms, plus one u for the rounded difference shape -
/// origin; 16 leaves room for the second order.
inline constexpr double kSupportError = 16.0 * kUnitRoundoff;
/// The square root of an underflowed sum of squares is at most about 2^-537; times the few terms.
inline constexpr double kSupportUnderflow = 0x1p-520;

}  // namespace exactvo::geometry
