// SPDX-License-Identifier: GPL-3.0-or-later
#include "inward.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "active_set.h"
#include "exact_sign.h"

namespace exactvo::lp {
namespace {

/// Neighbours up to this many steps away are tried; a vertex rounded to nearest lies within one of the exact one.
constexpr int kReach = 3;

/// Steps of float that a velocity may be moved by to stay inside when it becomes one.
constexpr int kInwardSteps = 3;

bool must_hold(const Constraint& c, Status status) {
  if (status == Status::optimal || status == Status::pinched) return true;
  return status == Status::relaxed && c.priority == Priority::hard;
}

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

/// Out of line, since GCC 12 drops such conversions where it sees two side by side.
[[gnu::noinline]] double rounded_to_float(double x) {
  return static_cast<double>(static_cast<float>(x));
}

Problem musts_near(const Problem& problem, Status status, Vec2 target) {
  Problem musts;
  musts.bound = problem.bound;
  musts.preferred = target;
  for (const Constraint& c : problem.constraints)
    if (must_hold(c, status)) musts.constraints.push_back(c);
  return musts;
}

}  // namespace

bool holds(const Problem& problem, Status status, Vec2 v) {
  if (!is_finite(v) || !within(problem.bound, v)) return false;
  for (const Constraint& c : problem.constraints)
    if (must_hold(c, status) && sign_of_violation(c.half_plane, v) > 0) return false;
  return true;
}

double violation_that_counts(const Problem& problem, Status status, Vec2 v) {
  double most = 0.0;
  for (const Constraint& c : problem.constraints) {
    const bool gives = status == Status::pinched || (status == Status::relaxed && c.priority == Priority::soft) ||
                       (status == Status::infeasible && c.priority == Priority::hard);
    if (gives) most = std::max(most, geometry::violation(c.half_plane, v));
  }
  return most;
}

Solution in_float(const Problem& problem, Solution s) {
  if (s.status != Status::optimal && s.status != Status::relaxed) return s;
  const Vec2 exact = s.velocity;
  const double step =
      static_cast<double>(std::numeric_limits<float>::epsilon()) / 2.0 * std::max(std::abs(exact.x), std::abs(exact.y));
  const Status asked = s.status;
  s.status = Status::pinched;
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
  const Problem musts = musts_near(problem, status, target);
  for (const double slack : kSlacks) {
    const Found found = best_velocity(region_of(musts, slack), Objective::nearest, target);
    const Vec2 v = into_box(found.velocity, problem.bound);
    if (found.feasible && holds(problem, status, v)) return v;
  }
  return std::nullopt;
}

}  // namespace exactvo::lp
