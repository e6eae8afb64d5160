// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/supported_range.h"

#include <algorithm>
#include <cmath>

#include "exact/exact_sum.h"
#include "exactvo/geometry/shape_numbers.h"

namespace exactvo::vo::detail {
namespace {

template <class Numbers>
bool are_in_supported_range(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](const auto& x) { return is_in_supported_range(x); });
}

}  // namespace

bool is_in_supported_range(double x) {
  return x == 0.0 || (std::fabs(x) >= kLeastArrangedNumber && std::fabs(x) <= kMostArrangedNumber);
}

bool is_in_supported_range(Vec2 v) {
  return is_in_supported_range(v.x) && is_in_supported_range(v.y);
}

bool is_in_supported_range(const ShiftedCone& cone) {
  const UnroundedInput input = unrounded_input(cone.cone);
  const double tau = cone.cone.time_horizon();
  return (std::isinf(tau) || is_in_supported_range(tau)) && is_in_supported_range(input.position) &&
         is_in_supported_range(input.radius) && are_in_supported_range(cone.minus_apex.terms) &&
         (!input.robot || are_in_supported_range(input.robot->vertices)) &&
         are_in_supported_range(geometry::numbers_of(input.obstacle));
}

}  // namespace exactvo::vo::detail
