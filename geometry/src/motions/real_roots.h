// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Real roots of polynomials over the rationals, exactly (exact/integer_polynomial.h). From them, the times in [0, 1]
/// at which polynomials are negative. The last stage: microseconds to milliseconds.

#include <memory>
#include <vector>

#include "exact/integer_polynomial.h"

namespace exactvo::geometry::motions {

using detail::gcd;
using detail::IntegerPolynomial;
using detail::primitive;
using detail::sign_at;
using detail::square_free;
using detail::SturmChain;

/// A real number: a rational, or the only root of a square-free polynomial in an interval with ends that are no roots.
class RealNumber {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): a rational is a real number.
  RealNumber(mpq_class value) : low_(value), high_(std::move(value)) {}
  RealNumber(std::shared_ptr<const IntegerPolynomial> polynomial, mpq_class low, mpq_class high)
      : polynomial_(std::move(polynomial)), low_(std::move(low)), high_(std::move(high)) {}

  const mpq_class& low() const { return low_; }
  const mpq_class& high() const { return high_; }
  bool is_rational() const { return low_ == high_; }
  /// Halves the interval.
  void refine();

  /// -1, 0 or 1; refines both.
  friend int compare(RealNumber& x, RealNumber& y);

 private:
  std::shared_ptr<const IntegerPolynomial> polynomial_;
  mpq_class low_, high_;
};

/// The distinct roots in [0, 1] of a polynomial that is not zero, rising; their intervals are disjoint.
std::vector<RealNumber> roots_in_unit(const IntegerPolynomial& p);

/// Times from one to another, the ends included or not as the set says.
struct TimeSpan {
  RealNumber from, to;
};
/// A union of spans in [0, 1], rising.
using TimeSet = std::vector<TimeSpan>;

enum class Ends { open, closed };

/// The times in [0, 1] at which the polynomial is negative (open: relative to [0, 1]) or not positive (closed).
TimeSet times_below_zero(const IntegerPolynomial& p, Ends ends);

/// The times in both.
TimeSet common_times(TimeSet a, TimeSet b, Ends ends);

}  // namespace exactvo::geometry::motions
