// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/proof/rounded_gap.h"

#include <algorithm>
#include <cmath>

#include "lp/proof/double_double.h"

namespace exactvo::lp {
namespace {

/// Every quantity below is a polynomial of degree 5 at most in its numbers, evaluated at most 16 operations deep (the
/// deepest: the square of a coordinate of p + w, twice four sums and a product, times 1 + nu, and two sums). An
/// operation is wrong by a unit of its result, so the value by 16 units of its terms taken absolutely; twice that
/// leaves room for rounding these terms themselves.
constexpr double kDepth = 32.0;

template <class Number>
constexpr double kUnit = 0x1p-53;
template <>
constexpr double kUnit<DoubleDouble> = 0x1p-102;

/// Within these no product of five numbers, nor its rounding error in 106 bits, leaves the normal range.
constexpr double kLeast = 0x1p-150, kMost = 0x1p150;

bool in_range(double x) {
  return x == 0.0 || (std::abs(x) >= kLeast && std::abs(x) <= kMost);
}

bool in_range(const SpeedBound& b) {
  const auto fits = [](double x) { return std::isinf(x) || in_range(x); };
  return fits(b.disc) && fits(b.box_x) && fits(b.box_y);
}

bool in_range(const Problem& problem, const Multipliers& m, const Claim& claim) {
  const Vec2 p = problem.preferred, v = claim.velocity;
  bool all = in_range(problem.bound) && in_range(p.x) && in_range(p.y) && in_range(v.x) && in_range(v.y) &&
             in_range(claim.violation);
  for (std::size_t k = 0; k < m.count && all; ++k) {
    all = in_range(m.value[k]);
    if (m.binding[k] == kDisc) continue;
    const HalfPlane h = half_plane_at(problem, m.binding[k]);
    all = all && in_range(h.normal.x) && in_range(h.normal.y) && in_range(h.offset);
  }
  return all;
}

double rounded(double x) {
  return x;
}
double rounded(const DoubleDouble& x) {
  return x.high;
}

/// A number, and the sum of the terms it comes from, each taken absolutely.
template <class Number>
struct Sum {
  Number value{0.0};
  double terms = 0.0;

  Sum() = default;
  Sum(double x) : value(x), terms(std::abs(x)) {}  // NOLINT: a double is a sum of one term
  Sum(Number v, double t) : value(v), terms(t) {}

  friend Sum operator+(const Sum& a, const Sum& b) { return {a.value + b.value, a.terms + b.terms}; }
  friend Sum operator-(const Sum& a, const Sum& b) { return {a.value - b.value, a.terms + b.terms}; }
  friend Sum operator*(const Sum& a, const Sum& b) { return {a.value * b.value, a.terms * b.terms}; }

  /// One rounding more, to double, is counted with the rest.
  double error() const { return kDepth * kUnit<Number> * terms + kUnit<double> * std::abs(rounded(value)); }
  Bounds bounds() const {
    const double middle = rounded(value), e = 2.0 * error();
    return {middle - e, middle + e};
  }
};

/// What a sum of constraints says: w.v >= offset.
template <class Number>
struct Combined {
  Sum<Number> x, y, offset, giving, disc;
};

template <class Number>
Combined<Number> combined(const Problem& problem, const Multipliers& m, Scope scope) {
  Combined<Number> sum;
  for (std::size_t k = 0; k < m.count; ++k) {
    const Sum<Number> multiplier(m.value[k]);
    if (m.binding[k] == kDisc) {
      sum.disc = sum.disc + multiplier;
      continue;
    }
    const HalfPlane h = half_plane_at(problem, m.binding[k]);
    sum.x = sum.x + multiplier * h.normal.x;
    sum.y = sum.y + multiplier * h.normal.y;
    sum.offset = sum.offset + multiplier * h.offset;
    if (may_give(problem, m.binding[k], scope)) sum.giving = sum.giving + multiplier;
  }
  return sum;
}

/// What squares may lose below the normal range is far less than this; its root is far below any number in range.
constexpr double kSquareUnderflow = 0x1p-1000;

/// Four roundings (a product, a sum, a root, a product) of numbers of one sign.
constexpr double kUp = 1.0 + 8.0 * kUnit<double>, kDown = 1.0 - 8.0 * kUnit<double>;

Bounds magnitude(const Bounds& x) {
  const double most = std::max(std::abs(x.low), std::abs(x.high));
  const bool may_be_zero = x.low <= 0.0 && x.high >= 0.0;
  return {may_be_zero ? 0.0 : std::min(std::abs(x.low), std::abs(x.high)), most};
}

bool may_be_positive(const Bounds& x) {
  return x.high > 0.0;
}

/// sigma(w): the largest w.v within the speed bound, by the disc or the box, whichever is less.
std::optional<Bounds> reach(const SpeedBound& b, const Bounds& wx, const Bounds& wy) {
  const Bounds x = magnitude(wx), y = magnitude(wy);
  if (!may_be_positive(x) && !may_be_positive(y)) return Bounds{0.0, 0.0};
  const bool has_disc = std::isfinite(b.disc), has_box = std::isfinite(b.box_x) && std::isfinite(b.box_y);
  if (!has_disc && !has_box) return std::nullopt;
  if (std::isfinite(b.box_x) != std::isfinite(b.box_y)) return std::nullopt;  // serves only where a coordinate is 0
  Bounds least{HUGE_VAL, HUGE_VAL};
  if (has_disc)
    least = {b.disc * std::sqrt(x.low * x.low + y.low * y.low) * kDown,
             b.disc * std::sqrt(x.high * x.high + y.high * y.high + kSquareUnderflow) * kUp};
  if (has_box) {
    least.low = std::min(least.low, (b.box_x * x.low + b.box_y * y.low) * kDown);
    least.high = std::min(least.high, (b.box_x * x.high + b.box_y * y.high) * kUp);
  }
  return least;
}

/// x / by, by > 0.
Bounds divided(const Bounds& x, const Bounds& by) {
  const auto down = [](double q) { return q * (q > 0.0 ? kDown : kUp); };
  const auto up = [](double q) { return q * (q > 0.0 ? kUp : kDown); };
  return {down(x.low / (x.low > 0.0 ? by.high : by.low)), up(x.high / (x.high > 0.0 ? by.low : by.high))};
}

Bounds plus(const Bounds& a, const Bounds& b) {
  const double low = a.low + b.low, high = a.high + b.high;
  // Twice the unit: half of it below a power of two would be rounded away again.
  return {low - 2.0 * kUnit<double> * std::abs(low), high + 2.0 * kUnit<double> * std::abs(high)};
}

template <class Number>
std::optional<Bounds> sigma(const Problem& problem, const Sum<Number>& x, const Sum<Number>& y) {
  return reach(problem.bound, x.bounds(), y.bounds());
}

/// (4)
template <class Number>
std::optional<Bounds> gap_of_nearest(const Problem& problem, const Combined<Number>& sum, Vec2 velocity) {
  using S = Sum<Number>;
  const S px(problem.preferred.x), py(problem.preferred.y), weight = S(1.0) + sum.disc;
  const S ax = S(velocity.x) - px, ay = S(velocity.y) - py, gx = px + sum.x, gy = py + sum.y;
  S open = ax * ax + ay * ay - px * px - py * py - S(2.0) * sum.offset;
  if (rounded(sum.disc.value) > 0.0) {
    const S disc(problem.bound.disc);
    open = open + sum.disc * (disc * disc);
  }
  return divided((weight * open + (gx * gx + gy * gy)).bounds(), weight.bounds());
}

/// (3)
template <class Number>
std::optional<Bounds> gap_of_farthest(const Problem& problem, const Combined<Number>& sum, Vec2 velocity) {
  using S = Sum<Number>;
  const S dx(problem.preferred.x), dy(problem.preferred.y);
  const auto most = sigma(problem, dx + sum.x, dy + sum.y);
  if (!most) return std::nullopt;
  return plus(*most, (S(0.0) - sum.offset - dx * S(velocity.x) - dy * S(velocity.y)).bounds());
}

/// (2)
template <class Number>
std::optional<Bounds> gap_of_violation(const Problem& problem, const Combined<Number>& sum, double violation) {
  const auto most = sigma(problem, sum.x, sum.y);
  const Bounds giving = sum.giving.bounds();
  if (!most || !(giving.low > 0.0)) return std::nullopt;
  return divided(plus(*most, (Sum<Number>(violation) * sum.giving - sum.offset).bounds()), giving);
}

template <class Number>
std::optional<Bounds> gap_in(const Problem& problem, const Multipliers& m, Scope scope, const Claim& claim) {
  const Combined<Number> sum = combined<Number>(problem, m, scope);
  if (scope != Scope::all_must_hold) return gap_of_violation(problem, sum, claim.violation);
  return problem.objective == Objective::nearest ? gap_of_nearest(problem, sum, claim.velocity)
                                                 : gap_of_farthest(problem, sum, claim.velocity);
}

}  // namespace

std::optional<Bounds> rounded_gap(const Problem& problem, const Multipliers& m, Scope scope, const Claim& claim,
                                  Digits digits) {
  if (!in_range(problem, m, claim)) return std::nullopt;
  return digits == Digits::of_double ? gap_in<double>(problem, m, scope, claim)
                                     : gap_in<DoubleDouble>(problem, m, scope, claim);
}

std::optional<Bounds> rounded_surplus(const Problem& problem, const Multipliers& m, Scope scope) {
  if (!in_range(problem, m, {})) return std::nullopt;
  const Combined<DoubleDouble> sum = combined<DoubleDouble>(problem, m, scope);
  const auto most = sigma(problem, sum.x, sum.y);
  if (!most) return std::nullopt;
  return plus({-most->high, -most->low}, sum.offset.bounds());
}

}  // namespace exactvo::lp
