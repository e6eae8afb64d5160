// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/problem/exact_sign.h"

#include <CGAL/Mpzf.h>

#include <algorithm>
#include <initializer_list>

#include "lp/proof/double_double.h"

namespace exactvo::lp {
namespace {

using Exact = CGAL::Mpzf;

/// Between these the product of two is exact as two doubles (double_double.h).
constexpr double kLeastFactor = 0x1p-400, kMostFactor = 0x1p400;

bool have_exact_products(std::initializer_list<double> factors) {
  return std::all_of(factors.begin(), factors.end(),
                     [](double x) { return x == 0.0 || (std::abs(x) >= kLeastFactor && std::abs(x) <= kMostFactor); });
}

/// A sum of up to three products, exact: doubles none of which overlaps another, in order of magnitude, without zeros
/// (Shewchuk, Adaptive precision floating-point arithmetic, 1997: GROW-EXPANSION with zero elimination).
class ExactSum {
 public:
  /// REQUIRES: they have exact products.
  void add_product(double a, double b) {
    const DoubleDouble product = two_product(a, b);
    add(product.low);
    add(product.high);
  }
  int sign() const { return count_ == 0 ? 0 : sign_of_double(parts_[count_ - 1]); }

 private:
  void add(double x) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const DoubleDouble sum = two_sum(x, parts_[k]);
      x = sum.high;
      if (sum.low != 0.0) parts_[kept++] = sum.low;
    }
    if (x != 0.0) parts_[kept++] = x;
    count_ = kept;
  }

  double parts_[6];
  std::size_t count_ = 0;
};

}  // namespace

int exact_sign_of_violation(const HalfPlane& h, Vec2 v) {
  if (have_exact_products({h.offset, h.normal.x, h.normal.y, v.x, v.y})) {
    ExactSum sum;
    sum.add_product(h.offset, 1.0);
    sum.add_product(-h.normal.x, v.x);
    sum.add_product(-h.normal.y, v.y);
    return sum.sign();
  }
  return static_cast<int>(
      CGAL::sign(Exact(h.offset) - Exact(h.normal.x) * Exact(v.x) - Exact(h.normal.y) * Exact(v.y)));
}

/// Velocities at the bound are the usual case, and 106 bits tell most of them from it. What is left open has |v|^2 <= 2
/// `limit`, so that the two sums are wrong by 64 u^2 `limit` at most (double_double.h). Within these bounds what a
/// product may lose below the normal range is far less.
int exact_sign_of_excess_speed(Vec2 v, double radius) {
  constexpr double kError = 128.0 * 0x1p-106;
  const double limit = radius * radius;
  if (limit > 0x1p-600 && limit < 0x1p600) {
    const DoubleDouble excess = two_product(v.x, v.x) + two_product(v.y, v.y) - two_product(radius, radius);
    if (std::abs(excess.high) > kError * limit) return sign_of_double(excess.high);
  }
  if (have_exact_products({v.x, v.y, radius})) {
    ExactSum sum;
    sum.add_product(v.x, v.x);
    sum.add_product(v.y, v.y);
    sum.add_product(-radius, radius);
    return sum.sign();
  }
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
