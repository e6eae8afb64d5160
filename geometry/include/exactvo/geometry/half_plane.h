// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The half-plane { v : normal . v >= offset }: the one currency between velocity obstacles and the linear program.

#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry {

/// { v : normal . v >= offset }. `normal` points into the allowed side and is about, not exactly, of length 1: the pair
/// of doubles is what is proven, so do not renormalise it.
struct HalfPlane {
  Vec2 normal;          ///< dimensionless, |normal| = 1 up to rounding
  double offset = 0.0;  ///< m/s
};

/// How far v lies outside, in units of |normal| (negative inside). Rounded.
constexpr double violation(const HalfPlane& h, Vec2 v) { return h.offset - dot(h.normal, v); }

}  // namespace exactvo::geometry
