// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Numbers as people read them, in warnings and outcomes.

#include <cstdio>
#include <string>

namespace exactvo::formation::detail {

/// In at most so many significant digits.
inline std::string number_text(double x, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

/// "0.25 m".
inline std::string metres(double x, int digits = 3) {
  return number_text(x, digits) + " m";
}

}  // namespace exactvo::formation::detail
