// SPDX-License-Identifier: GPL-3.0-or-later
#include "violation.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace exactvo::bench {
namespace {

/// Two products, two sums: the rounded value is within 4 u of the sum of the terms' magnitudes; twice that decides.
constexpr double kUndecided = 8.0 * 0x1p-53;

double exactly(const lp::HalfPlane& h, lp::Vec2 v) {
  const mpq_class difference = mpq_class(h.offset) - mpq_class(h.normal.x) * v.x - mpq_class(h.normal.y) * v.y;
  return difference.get_d();
}

}  // namespace

double worst_violation(const std::vector<lp::Constraint>& constraints, lp::Vec2 velocity) {
  if (!is_finite(velocity)) return std::numeric_limits<double>::max();
  double worst = 0.0;
  for (const lp::Constraint& c : constraints) {
    const lp::HalfPlane& h = c.half_plane;
    const double rounded = geometry::violation(h, velocity);
    const double terms = std::abs(h.offset) + std::abs(h.normal.x * velocity.x) + std::abs(h.normal.y * velocity.y);
    const bool is_decided = std::abs(rounded) > kUndecided * terms;
    worst = std::max(worst, is_decided ? rounded : exactly(h, velocity));
  }
  return std::min(worst, std::numeric_limits<double>::max());
}

double worst_breach(const lp::Problem& problem, lp::Vec2 velocity) {
  const double of_lines = worst_violation(problem.constraints, velocity), disc = problem.bound.disc;
  if (!is_finite(velocity)) return of_lines;
  const mpq_class x = velocity.x, y = velocity.y, limit = disc;
  const mpq_class beyond = x * x + y * y - limit * limit;
  if (sgn(beyond) <= 0) return of_lines;
  const double sum = std::hypot(velocity.x, velocity.y) + disc;
  if (!std::isfinite(sum)) return std::numeric_limits<double>::max();
  const mpq_class excess = beyond / mpq_class(sum);  // not in doubles: they have no square of 1e200
  return std::max(of_lines, excess.get_d());
}

}  // namespace exactvo::bench
