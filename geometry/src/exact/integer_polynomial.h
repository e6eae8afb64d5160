// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Polynomials with integer coefficients, for real roots: Sturm's theorem counts them, the greatest common divisor
/// tells whether two are one. Exact; nothing is tuned for high degrees.

#include <gmpxx.h>

#include <vector>

namespace exactvo::geometry::detail {

/// Coefficients of powers, the constant first; no leading zero, so that the zero polynomial is empty.
using IntegerPolynomial = std::vector<mpz_class>;

/// A positive multiple of the polynomial with these coefficients that has integers without a common divisor.
IntegerPolynomial primitive(const std::vector<mpq_class>& coefficients);

/// REQUIRES: coefficients of each without a common divisor. Those of the result have none either.
IntegerPolynomial gcd(const IntegerPolynomial& a, const IntegerPolynomial& b);

/// The same roots, each once; the last coefficient is positive. REQUIRES: not zero.
IntegerPolynomial square_free(IntegerPolynomial p);

int sign_at(const IntegerPolynomial& p, const mpq_class& x);

/// Sturm's chain of a square-free polynomial: the number of sign changes along it falls by one at every root.
class SturmChain {
 public:
  explicit SturmChain(const IntegerPolynomial& p);
  int changes_at(const mpq_class& x) const;
  /// Roots in (low, high].
  int count(const mpq_class& low, const mpq_class& high) const { return changes_at(low) - changes_at(high); }

 private:
  std::vector<IntegerPolynomial> links_;
};

}  // namespace exactvo::geometry::detail
