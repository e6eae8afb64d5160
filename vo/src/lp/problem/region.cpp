// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/problem/region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {
namespace {

std::string words(double x, double y) {
  return "(" + std::to_string(x) + ", " + std::to_string(y) + ")";
}

std::string words(std::size_t index, const HalfPlane& h) {
  return "constraint " + std::to_string(index) + " with normal " + words(h.normal.x, h.normal.y) + " and offset " +
         std::to_string(h.offset);
}

}  // namespace

bool bound_is_finite(const SpeedBound& b) {
  return std::isfinite(b.disc) || (std::isfinite(b.box_x) && std::isfinite(b.box_y));
}

void require_well_formed(const Problem& problem) {
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const HalfPlane& h = problem.constraints[i].half_plane;
    EXACTVO_REQUIRE(is_finite(h.normal) && std::isfinite(h.offset), words(i, h));
    EXACTVO_REQUIRE(h.normal != Vec2{}, words(i, h));
  }
  const Vec2 p = problem.preferred;
  EXACTVO_REQUIRE(is_finite(p), "preferred " + words(p.x, p.y));
  const SpeedBound& b = problem.bound;
  EXACTVO_REQUIRE(b.disc >= 0.0 && b.box_x >= 0.0 && b.box_y >= 0.0,
                  "disc " + std::to_string(b.disc) + ", box " + words(b.box_x, b.box_y));
  if (problem.objective == Objective::nearest) return;
  EXACTVO_REQUIRE(bound_is_finite(b), "no finite speed bound for a linear objective");
  EXACTVO_REQUIRE(p != Vec2{}, "direction " + words(p.x, p.y));
}

const char* name(BindingKind kind) {
  constexpr const char* kNames[] = {"constraint", "disc", "box-right", "box-left", "box-top", "box-bottom"};
  return kNames[static_cast<int>(kind)];
}

HalfPlane side_of_box(const SpeedBound& bound, BindingKind side) {
  switch (side) {
    case BindingKind::box_right:
      return {{-1.0, 0.0}, -bound.box_x};
    case BindingKind::box_left:
      return {{1.0, 0.0}, -bound.box_x};
    case BindingKind::box_top:
      return {{0.0, -1.0}, -bound.box_y};
    default:
      return {{0.0, 1.0}, -bound.box_y};
  }
}

const char* name(Status status) {
  constexpr const char* kNames[] = {"optimal", "relaxed", "infeasible", "no-interior"};
  return kNames[static_cast<int>(status)];
}

double largest_speed(const Problem& problem) {
  const SpeedBound& b = problem.bound;
  const bool has_box = std::isfinite(b.box_x) && std::isfinite(b.box_y);
  const double bounded = has_box ? std::min(b.disc, std::hypot(b.box_x, b.box_y)) : b.disc;
  if (std::isfinite(bounded)) return std::max(bounded, std::numeric_limits<double>::min());
  double speed = std::max(norm(problem.preferred), std::numeric_limits<double>::min());
  for (const Constraint& c : problem.constraints)
    speed = std::max(speed, std::abs(c.half_plane.offset) / norm(c.half_plane.normal));
  return speed;
}

}  // namespace exactvo::lp
