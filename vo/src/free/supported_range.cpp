// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/supported_range.h"

#include <algorithm>
#include <cmath>

#include "exact/exact_sum.h"

namespace exactvo::vo::detail {
namespace {

template <class Points>
bool are_in_supported_range(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](Vec2 v) { return is_in_supported_range(v); });
}

struct ShapeIsInSupportedRange {
  bool operator()(const geometry::Disc& d) const {
    return is_in_supported_range(d.center) && is_in_supported_range(d.radius);
  }
  bool operator()(const geometry::Segment& s) const { return is_in_supported_range(s.a) && is_in_supported_range(s.b); }
  bool operator()(const geometry::ConvexPolygon& p) const { return are_in_supported_range(p.vertices); }
  bool operator()(const geometry::Ellipse& e) const {
    return is_in_supported_range(e.center) && is_in_supported_range(e.l11) && is_in_supported_range(e.l21) &&
           is_in_supported_range(e.l22);
  }
};

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
         std::visit(ShapeIsInSupportedRange{}, input.obstacle);
}

}  // namespace exactvo::vo::detail
