// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Sums of products rounded up: the one bound behind every certified offset n.v + c.
///
/// A value computed from terms t_1, t_2, ... each of which passes at most k roundings errs by at most
///
///     ((1 + u)^k - 1) sum |t_i|  <=  k u (1 + k u) sum |t_i|,       u = 2^-53,
///
/// and, where a product underflows, by another 2^-1075 each. The computed sum of magnitudes is itself low by at most a
/// factor 1 - (k + 1) u, and adding the bound rounds once more, by u of the value. Twice the first-order bound covers
/// all of it for 2 <= k <= 2^20, and 2^-1060 covers 2^14 products that underflow.
///
/// Certified. See also: support.h has u and the bound of a support function.

#include <cmath>
#include <limits>

#include "exactvo/geometry/support.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry {

/// |a b| as computed, but above 0 where neither is 0: what has underflowed is still seen to be there.
inline double product_magnitude(double a, double b) {
  if (a == 0.0 || b == 0.0) return 0.0;
  return std::fmax(std::fabs(a * b), std::numeric_limits<double>::denorm_min());
}

/// The magnitudes of the two products of n.v.
inline double dot_magnitude(Vec2 n, Vec2 v) {
  return product_magnitude(n.x, v.x) + product_magnitude(n.y, v.y);
}

/// At least the exact value of the sum that `value` was computed for. `magnitude` is the sum of its terms' magnitudes
/// as computed, products by `product_magnitude`; each term passed at most `roundings` roundings, 2 or more, the
/// product's own among them. Where the magnitude is 0 every term is, and so is the sum: exact.
inline double rounded_up_sum(double value, double magnitude, double roundings) {
  constexpr double kUnderflow = 0x1p-1060;
  if (magnitude == 0.0) return value;
  return value + (2.0 * roundings * kUnitRoundoff * magnitude + kUnderflow);
}

}  // namespace exactvo::geometry
