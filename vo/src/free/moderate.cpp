// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/moderate.h"

#include <algorithm>
#include <cmath>

#include "exact/grown_body.h"

namespace exactvo::vo::detail {
namespace {

template <class Points>
bool are_moderate(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](Vec2 v) { return is_moderate(v); });
}

struct ShapeIsModerate {
  bool operator()(const geometry::Disc& d) const { return is_moderate(d.center) && is_moderate(d.radius); }
  bool operator()(const geometry::Segment& s) const { return is_moderate(s.a) && is_moderate(s.b); }
  bool operator()(const geometry::ConvexPolygon& p) const { return are_moderate(p.vertices); }
  bool operator()(const geometry::Ellipse& e) const {
    return is_moderate(e.center) && is_moderate(e.l11) && is_moderate(e.l21) && is_moderate(e.l22);
  }
};

}  // namespace

bool is_moderate(double x) {
  return x == 0.0 || (std::fabs(x) >= kLeastArrangedNumber && std::fabs(x) <= kMostArrangedNumber);
}

bool is_moderate(Vec2 v) {
  return is_moderate(v.x) && is_moderate(v.y);
}

bool is_moderate(const ShiftedCone& cone) {
  const Given given = as_given(cone.cone);
  const double tau = cone.cone.time_horizon();
  return (std::isinf(tau) || is_moderate(tau)) && is_moderate(given.position) && is_moderate(given.radius) &&
         are_moderate(cone.minus_apex.terms) && (!given.robot || are_moderate(given.robot->vertices)) &&
         std::visit(ShapeIsModerate{}, given.obstacle);
}

}  // namespace exactvo::vo::detail
