// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Zero without a sign, for numbers that are printed.

#include "exactvo/geometry/vec2.h"

namespace exactvo::tools {

/// 0 for -0; every other number as it is.
inline double unsigned_zero(double x) {
  return x == 0.0 ? 0.0 : x;
}
inline geometry::Vec2 unsigned_zero(geometry::Vec2 v) {
  return {unsigned_zero(v.x), unsigned_zero(v.y)};
}

}  // namespace exactvo::tools
