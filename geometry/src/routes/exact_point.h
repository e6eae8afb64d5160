// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Points of the plane with rational coordinates, and the signs of polynomials in them. A point is two doubles
/// wherever these are exact; where edges of obstacles cross, and in the middle of a gap, it is two fractions.
///
/// `sign_of` evaluates a polynomial that is written once in up to three number types: doubles with a running error
/// bound, then CGAL's Mpzf where every input is a double, then GMP's rationals. Exact. Along the axes, where most walls
/// of maps lie, most zeros are seen by the first.

#include <gmpxx.h>

#include <memory>

#include "exact/exact_number.h"
#include "exact/exact_vector.h"
#include "exact/running_error.h"

namespace exactvo::geometry::routing {

using Rational = mpq_class;
template <typename T>
using Vector = detail::Vector<T>;

class Point {
 public:
  Point() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a double is a rational number.
  Point(Vec2 p) : rounded_(p) {}
  Point(const Rational& x, const Rational& y) : rounded_{x.get_d(), y.get_d()} {
    if (Rational(rounded_.x) != x || Rational(rounded_.y) != y)
      exact_ = std::make_shared<const Vector<Rational>>(Vector<Rational>{x, y});
  }

  /// Each coordinate within an ulp, and exact where `is_double`.
  Vec2 rounded() const { return rounded_; }
  bool is_double() const { return !exact_; }
  Vector<Rational> exact() const { return exact_ ? *exact_ : Vector<Rational>{rounded_.x, rounded_.y}; }

 private:
  Vec2 rounded_;
  std::shared_ptr<const Vector<Rational>> exact_;  ///< null where `rounded_` is exact
};

/// The conversions that a polynomial is evaluated with: a point or a double becomes a number of the stage.
struct ToRunningError {
  using Number = detail::RunningError;
  Number operator()(double d) const { return d; }
  Vector<Number> operator()(const Point& p) const {
    const Vec2 v = p.rounded();
    if (p.is_double()) return {v.x, v.y};
    return {rounded(v.x), rounded(v.y)};
  }

 private:
  static Number rounded(double d) { return {d, std::fabs(d) * 0x1p-52 + detail::kUnderflow}; }
};
struct ToMpzf {
  using Number = detail::Exact;
  bool* lossy;  ///< set where a point is no pair of doubles: the value is of no use then
  Number operator()(double d) const { return Number(d); }
  Vector<Number> operator()(const Point& p) const {
    if (!p.is_double()) *lossy = true;
    return {Number(p.rounded().x), Number(p.rounded().y)};
  }
};
struct ToRational {
  using Number = Rational;
  Number operator()(double d) const { return d; }
  Vector<Number> operator()(const Point& p) const { return p.exact(); }
};

/// What a polynomial returns: to be written as its return type, since GMP's expressions refer to what they are made of.
template <typename Convert>
using NumberOf = typename Convert::Number;

/// The sign of `polynomial(convert)`, -1, 0 or 1, for a polynomial over points and doubles that go through `convert`.
template <typename Polynomial>
int sign_of(const Polynomial& polynomial) {
  const detail::RunningError filtered = polynomial(ToRunningError{});
  if (detail::decided(filtered)) return filtered.value > 0.0 ? 1 : -1;
  if (detail::is_exact_zero(filtered)) return 0;
  bool lossy = false;
  const detail::Exact exact = polynomial(ToMpzf{&lossy});
  if (!lossy) return static_cast<int>(CGAL::sign(exact));
  const Rational rational = polynomial(ToRational{});
  return sgn(rational);
}

}  // namespace exactvo::geometry::routing
