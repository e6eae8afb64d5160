// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// By what half-planes against edges and bodies are rounded to the safe side.

#include <cmath>

#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::crowd::edge_rounding {

inline constexpr double kUnit = 0x1p-53;

/// In units of u of the magnitudes: a difference, an end that was cut (4), two products, two sums, |n| and a maximum
/// round at most 13 times.
inline constexpr double kSupportError = 16.0 * kUnit;

/// The radius is grown before a normal is looked for, so that it stays valid once it is rounded (in units of its
/// precision) and its support value is rounded up (in units of double).
inline constexpr double kRoundingRoom = 8.0, kSupportRoom = 64.0 * kUnit;

/// In units of kSupportError: by how much an offset exceeds its support value, so that it also excludes other edges at
/// the vertex it stands for, however their own support values are rounded.
inline constexpr double kSharedVertex = 3.0;

/// An offset is a quotient and a product: 2 u. It is negative and moves towards 0.
inline constexpr double kTowardsZero = 1.0 - 4.0 * kUnit;

/// The product of horizon and offset is off by u, and its product with this factor by another u: whatever is at most
/// the rounded result is at most the exact product.
inline constexpr double kAwayFromZero = 1.0 + 8.0 * kUnit;

/// Vectors whose square is below it have no direction: the square would lose digits to underflow.
inline constexpr double kNoDirection = 0x1p-900;

/// A range is widened by this factor, for its own rounding.
inline constexpr double kWiden = 1.0 + 0x1p-20;

/// Ends of edges are cut at this many times the range.
inline constexpr double kCutRanges = 2.0;

/// The direction of a, of length 1; 0 where there is none.
inline geometry::Vec2 direction(geometry::Vec2 a) {
  const double squared = geometry::squared_norm(a);
  return squared > kNoDirection ? 1.0 / std::sqrt(squared) * a : geometry::Vec2{};
}

}  // namespace exactvo::formation::crowd::edge_rounding
