// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/exact/inward.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lp/kernel.h"
#include "lp/problem/exact_sign.h"
#include "lp/problem/region.h"

namespace exactvo::lp {
namespace {

/// Neighbours up to this many steps away are tried; a vertex rounded to nearest lies within one of the exact one.
constexpr int kReach = 3;

/// Steps of float that a velocity may be moved by to stay inside when it becomes one.
constexpr int kInwardSteps = 3;

std::optional<Vec2> neighbour_inside(const Problem& problem, Status status, Vec2 target) {
  const double step = 2.0 * kUnitRoundoff * std::max(std::abs(target.x), std::abs(target.y));
  for (int ring = 1; ring <= kReach; ++ring) {
    for (int i = -ring; i <= ring; ++i) {
      for (int j = -ring; j <= ring; ++j) {
        if (std::max(std::abs(i), std::abs(j)) != ring) continue;
        const Vec2 v = {target.x + i * step, target.y + j * step};
        if (holds(problem, status, v)) return v;
      }
    }
  }
  return std::nullopt;
}

/// From `v` that holds to `target` that does not: the middle, or what holds beside it, while that is nearer.
Vec2 brought_nearer(const Problem& problem, Status status, Vec2 target, Vec2 v) {
  for (;;) {
    const Vec2 middle = target + 0.5 * (v - target);
    const std::optional<Vec2> next =
        holds(problem, status, middle) ? std::optional<Vec2>(middle) : neighbour_inside(problem, status, middle);
    if (!next || !(squared_norm(*next - target) < squared_norm(v - target))) return v;
    v = *next;
  }
}

/// Out of line, since GCC 12 drops such conversions where it sees two side by side.
[[gnu::noinline]] double rounded_to_float(double x) {
  return static_cast<double>(static_cast<float>(x));
}

Problem mandatory_near(const Problem& problem, Status status, Vec2 target) {
  Problem mandatory;
  mandatory.bound = problem.bound;
  mandatory.preferred = target;
  for (const Constraint& c : problem.constraints)
    if (must_hold(c, status)) mandatory.constraints.push_back(c);
  return mandatory;
}

}  // namespace

Solution in_float(const Problem& problem, Solution s) {
  if (s.status != Status::optimal && s.status != Status::relaxed) return s;
  const Vec2 exact = s.velocity;
  const double step =
      static_cast<double>(std::numeric_limits<float>::epsilon()) / 2.0 * std::max(std::abs(exact.x), std::abs(exact.y));
  const Status asked = s.status;
  s.status = Status::no_interior;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -kInwardSteps; i <= kInwardSteps; ++i) {
    for (int j = -kInwardSteps; j <= kInwardSteps; ++j) {
      const Vec2 v = {rounded_to_float(exact.x + i * step), rounded_to_float(exact.y + j * step)};
      const double away = squared_norm(v - exact);
      if (!(away < least) || !holds(problem, asked, v)) continue;
      least = away;
      s.velocity = v;
      s.status = asked;
    }
  }
  s.violation = violation_that_counts(problem, s.status, s.velocity);
  return s;
}

Vec2 into_box(Vec2 v, const SpeedBound& b) {
  return {std::clamp(v.x, -b.box_x, b.box_x), std::clamp(v.y, -b.box_y, b.box_y)};
}

std::optional<Vec2> nearest_double_inside(const Problem& problem, Status status, Vec2 target) {
  if (!is_finite(target)) return std::nullopt;
  target = into_box(target, problem.bound);
  if (holds(problem, status, target)) return target;
  if (const auto neighbour = neighbour_inside(problem, status, target)) return neighbour;
  const Problem mandatory = mandatory_near(problem, status, target);
  for (const double slack : kSlacks) {
    const std::optional<Vec2> v = optimum_inside(mandatory, slack);
    if (v && holds(problem, status, *v)) return brought_nearer(problem, status, target, *v);
  }
  return std::nullopt;
}

}  // namespace exactvo::lp
