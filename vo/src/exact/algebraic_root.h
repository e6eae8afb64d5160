// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Real roots of polynomials with integer coefficients, exactly: Sturm's theorem finds them, halving narrows them.

#include <vector>

#include "exact/integer_polynomial.h"

namespace exactvo::vo::detail {

using Integer = mpz_class;
using Rational = mpq_class;

using Polynomial = geometry::detail::IntegerPolynomial;
using geometry::detail::gcd;
using geometry::detail::primitive;
using geometry::detail::sign_at;
using geometry::detail::square_free;
using geometry::detail::SturmChain;

/// The only root of a square-free f in (low, high), neither of which is a root; or low = high is it.
struct Root {
  Polynomial f;
  Rational low, high;

  /// Whether the root is known as a number. A root of a linear f in an interval is rational as well; `settled` finds
  /// it.
  bool is_settled() const { return low == high; }
};

/// Roots in (low, high], ascending. Each interval is open and of positive length, also where f is linear: its ends tell
/// what changes sign at the root. REQUIRES: f square-free, low < high.
std::vector<Root> isolate(const Polynomial& f, const Rational& low, const Rational& high);

/// Where the root is rational and f of degree 1 or 2: the linear factor with low = high.
Root settled(Root root);

Root rational_root(const Rational& x);

/// Halves the interval, or finds the root. REQUIRES: low < high.
void halve(Root& root);

int compare(const Root& a, const Rational& b);
int compare(Root a, Root b);

}  // namespace exactvo::vo::detail
