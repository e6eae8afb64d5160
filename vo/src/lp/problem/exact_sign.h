// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact signs for doubles taken as the rationals they are: a round-to-nearest filter, then integers of any length.

#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// Of a rounded c - (n.x v.x + n.y v.y): three rounded operations on top of the rounded products. 4 u of the terms'
/// magnitudes covers them to first order with room to spare, the underflow what products may lose below the normal
/// range.
inline constexpr double kSignError = 4.0 * 0x1p-53;
inline constexpr double kSignUnderflow = 0x1p-1060;

/// The sign of offset - normal . v: positive where v lies outside the half-plane. Exact.
int sign_of_violation(const HalfPlane& h, Vec2 v);

/// The sign of |v| - radius, radius >= 0 and maybe infinite. Exact.
int sign_of_excess_speed(Vec2 v, double radius);

/// Whether v keeps the disc and the box. Exact.
bool within(const SpeedBound& bound, Vec2 v);

}  // namespace exactvo::lp
