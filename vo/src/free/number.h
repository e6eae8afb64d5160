// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact algebraic numbers: rationals, sums, products, quotients and square roots, whose signs are exact. They are
/// CORE::Expr with its floating-point filter kept from three mistakes (CGAL 5 and 6):
///
///  - a value whose size *equals* its error bound passes the filter, but the logarithm of their difference, -2^31, is
///    taken for the number's size: what is computed from it then asks for 2^31 bits. Inputs that are an ulp or two from
///    a coincidence get there.
///  - division by a value whose double approximation is 0 writes a message to the file Core_Diagnostics;
///  - so does the square root of a value whose approximation is negative.

#include <CGAL/CORE_Expr.h>

#include "exact/algebraic_root.h"

namespace exactvo::vo::detail {

class Number {
 public:
  Number() = default;
  explicit Number(double x) : value_(x) {}
  explicit Number(const Rational& x);

  int sign() const { return value_.sign(); }
  double rounded() const { return value_.doubleValue(); }
  /// Within 2^-bits.
  Rational approximate(int bits) const;

  friend Number operator+(const Number& a, const Number& b) { return filtered(a.value_ + b.value_); }
  friend Number operator-(const Number& a, const Number& b) { return filtered(a.value_ - b.value_); }
  friend Number operator*(const Number& a, const Number& b) { return filtered(a.value_ * b.value_); }
  friend Number operator-(const Number& a) { return filtered(-a.value_); }
  friend bool operator<(const Number& a, const Number& b) { return (a - b).sign() < 0; }
  friend bool operator<=(const Number& a, const Number& b) { return (a - b).sign() <= 0; }

  /// a / b. REQUIRES: b not zero.
  friend Number quotient(const Number& a, const Number& b);
  /// REQUIRES: x >= 0.
  friend Number root_of(const Number& x);

 private:
  /// The value with a filter that passes only what exceeds its error bound.
  static Number filtered(const CORE::Expr& value);

  CORE::Expr value_;
};

Number quotient(const Number& a, const Number& b);
Number root_of(const Number& x);

}  // namespace exactvo::vo::detail
