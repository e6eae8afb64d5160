// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Numbers as people read them, in warnings and outcomes.

#include <string>

#include "exactvo/geometry/told_apart.h"

namespace exactvo::formation::detail {

/// In at most this many significant digits.
inline std::string number_text(double x, int digits) {
  return geometry::in_digits(x, digits);
}

/// "0.25 m".
inline std::string metres(double x, int digits = 3) {
  return number_text(x, digits) + " m";
}

}  // namespace exactvo::formation::detail
