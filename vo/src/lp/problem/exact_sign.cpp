// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/problem/exact_sign.h"

#include <CGAL/Mpzf.h>

#include <algorithm>
#include <cmath>

namespace exactvo::lp {
namespace {

using Exact = CGAL::Mpzf;

int sign_of_double(double x) {
  return (x > 0.0) - (x < 0.0);
}

}  // namespace

int sign_of_violation(const HalfPlane& h, Vec2 v) {
  const double px = h.normal.x * v.x;
  const double py = h.normal.y * v.y;
  const double rounded = h.offset - (px + py);
  const double error = kSignError * (std::abs(px) + std::abs(py) + std::abs(h.offset)) + kSignUnderflow;
  if (std::abs(rounded) > error) return sign_of_double(rounded);
  return static_cast<int>(
      CGAL::sign(Exact(h.offset) - Exact(h.normal.x) * Exact(v.x) - Exact(h.normal.y) * Exact(v.y)));
}

int sign_of_excess_speed(Vec2 v, double radius) {
  if (std::isinf(radius)) return -1;
  const double speed = squared_norm(v);
  const double limit = radius * radius;
  const double error = kSignError * (speed + limit) + kSignUnderflow;
  if (std::abs(speed - limit) > error) return sign_of_double(speed - limit);
  const Exact x(v.x), y(v.y), r(radius);
  return static_cast<int>(CGAL::sign(x * x + y * y - r * r));
}

bool within(const SpeedBound& bound, Vec2 v) {
  return std::abs(v.x) <= bound.box_x && std::abs(v.y) <= bound.box_y && sign_of_excess_speed(v, bound.disc) <= 0;
}

bool must_hold(const Constraint& c, Status status) {
  if (status == Status::optimal || status == Status::no_interior) return true;
  return status == Status::relaxed && c.priority == Priority::hard;
}

bool holds(const Problem& problem, Status status, Vec2 v) {
  if (!is_finite(v) || !within(problem.bound, v)) return false;
  for (const Constraint& c : problem.constraints)
    if (must_hold(c, status) && sign_of_violation(c.half_plane, v) > 0) return false;
  return true;
}

double violation_that_counts(const Problem& problem, Status status, Vec2 v) {
  double most = 0.0;
  for (const Constraint& c : problem.constraints) {
    const bool gives = status == Status::no_interior || (status == Status::relaxed && c.priority == Priority::soft) ||
                       (status == Status::infeasible && c.priority == Priority::hard);
    if (gives) most = std::max(most, geometry::violation(c.half_plane, v));
  }
  return most;
}

}  // namespace exactvo::lp
