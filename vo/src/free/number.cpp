// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/number.h"

#include <cmath>
#include <limits>

namespace exactvo::vo::detail {
namespace {

/// What no filter accepts.
const CORE::filteredFp kUnfiltered(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                   1);

/// The logarithm of a double that is not 0 is more.
constexpr long kLeastLogarithm = -1100;

CORE::Expr expression(const Rational& x) {
  const double rounded = x.get_d();
  if (Rational(rounded) == x) return CORE::Expr(rounded);
  return CORE::Expr(CORE::BigRat(x.get_mpq_t()));
}

}  // namespace

Number::Number(const Rational& x) : value_(expression(x)) {}

Rational Number::approximate(int bits) const {
  value_.approx(CORE::extLong::getPosInfty(), CORE::extLong(bits));
  return Rational(value_.BigRatValue().get_mp());
}

// The true value lies within |v| of v, and so within 2 |v|: such a filter decides nothing here, and is right about what
// is computed from it.
Number Number::filtered(const CORE::Expr& value) {
  Number out;
  out.value_ = value;
  CORE::filteredFp& filter = out.value_.Rep()->ffVal;
  const double v = std::fabs(filter.getValue());
  if (v > 0.0 && filter.isOK() && filter.lMSB() < CORE::extLong(kLeastLogarithm))
    filter = CORE::filteredFp(filter.getValue(), 2.0 * v / CORE_EPS, 1);
  return out;
}

Number quotient(const Number& a, const Number& b) {
  CORE::filteredFp& filter = b.value_.Rep()->ffVal;
  if (filter.getValue() == 0.0) filter = kUnfiltered;
  return Number::filtered(a.value_ / b.value_);
}

Number root_of(const Number& x) {
  CORE::filteredFp& filter = x.value_.Rep()->ffVal;
  if (filter.getValue() < 0.0) filter = kUnfiltered;
  return Number::filtered(sqrt(x.value_));
}

}  // namespace exactvo::vo::detail
