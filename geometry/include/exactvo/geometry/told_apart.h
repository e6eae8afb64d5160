// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Pairs of numbers in messages that speak of their difference: "0.9999 m, at least 1 m".

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

namespace exactvo::geometry {

/// `x` in at most this many significant digits.
inline std::string in_digits(double x, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

/// `x` in as few digits as read back to the same double, at least nine where they are needed: "1000000", "1e-10".
inline std::string lossless(double x) {
  constexpr int kFew = 9, kEnough = 17;
  for (int digits = kFew; digits < kEnough; ++digits) {
    std::string text = in_digits(x, digits);
    if (std::strtod(text.c_str(), nullptr) == x) return text;
  }
  return in_digits(x, kEnough);
}

/// The text of two numbers for a message that says that the first is less: with the fewest digits, at least `digits`,
/// that show it. If rounding left no difference, or one of the wrong sign, the first reads "less than 2".
inline std::pair<std::string, std::string> told_apart(double less, double more, int digits = 3) {
  constexpr int kEnough = 17;
  if (less < more)
    for (; digits <= kEnough; ++digits) {
      std::string a = in_digits(less, digits), b = in_digits(more, digits);
      if (a != b) return {std::move(a), std::move(b)};
    }
  std::string limit = lossless(more);
  return {"less than " + limit, std::move(limit)};
}

}  // namespace exactvo::geometry
