// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far a double lies from a number of CGAL (certified).

#include <CGAL/number_utils.h>

#include <algorithm>
#include <cmath>

namespace exactvo::geometry::detail {

/// An upper bound of |exact - rounded|.
template <class Number>
double rounding_of(const Number& exact, double rounded) {
  const auto interval = CGAL::to_interval(exact - Number(rounded));
  return std::max(std::fabs(interval.first), std::fabs(interval.second));
}

}  // namespace exactvo::geometry::detail
