// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact signs for doubles taken as the rationals they are: a round-to-nearest filter, then sums of doubles without
/// rounding, and outside of their range integers of any length. From them, which constraints a velocity satisfies, and
/// which an answer has to.

#include <cmath>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// Error of a rounded c - (n.x v.x + n.y v.y): three rounded operations on top of the rounded products. 4 u of the
/// terms' magnitudes covers them to first order with room to spare, the underflow what products may lose below the
/// normal range.
inline constexpr double kSignError = 4.0 * 0x1p-53;
inline constexpr double kSignUnderflow = 0x1p-1060;

// What the filters leave open.
int exact_sign_of_violation(const HalfPlane& h, Vec2 v);
int exact_sign_of_excess_speed(Vec2 v, double radius);

inline int sign_of_double(double x) {
  return (x > 0.0) - (x < 0.0);
}

/// The sign of offset - normal . v: positive where v lies outside the half-plane. Exact.
inline int sign_of_violation(const HalfPlane& h, Vec2 v) {
  const double px = h.normal.x * v.x;
  const double py = h.normal.y * v.y;
  const double rounded = h.offset - (px + py);
  const double error = kSignError * (std::abs(px) + std::abs(py) + std::abs(h.offset)) + kSignUnderflow;
  return std::abs(rounded) > error ? sign_of_double(rounded) : exact_sign_of_violation(h, v);
}

/// The sign of |v| - radius, radius >= 0 and maybe infinite. Exact.
inline int sign_of_excess_speed(Vec2 v, double radius) {
  if (std::isinf(radius)) return -1;
  const double speed = squared_norm(v);
  const double limit = radius * radius;
  const double error = kSignError * (speed + limit) + kSignUnderflow;
  return std::abs(speed - limit) > error ? sign_of_double(speed - limit) : exact_sign_of_excess_speed(v, radius);
}

/// Whether v keeps the disc and the box. Exact.
bool within(const SpeedBound& bound, Vec2 v);

/// Whether an answer of that status must satisfy the constraint: all (optimal), the hard ones (relaxed), none
/// (infeasible).
bool must_hold(const Constraint& c, Status status);

/// Whether v satisfies the speed bound and all that `must_hold`. Exact.
bool holds(const Problem& problem, Status status, Vec2 v);

/// The largest violation of the constraints that may give: soft (relaxed), hard (infeasible), all (no_interior).
/// Rounded.
double violation_that_counts(const Problem& problem, Status status, Vec2 v);

}  // namespace exactvo::lp
