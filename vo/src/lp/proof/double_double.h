// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Numbers of 106 bits: the sum of two doubles, |low| <= u |high|. Certified: +, - and * of finite numbers are wrong by
/// at most 16 u^2 of the result (Joldes, Muller, Popescu: Tight and rigorous error bounds for basic building blocks of
/// double-word arithmetic, ACM TOMS 44, 2017: 3 u^2 for sums, 9 u^2 for products, both to first order), as long as no
/// product leaves [2^-968, 2^968], where its own rounding error would no longer be a double.

namespace exactvo::lp {

struct DoubleDouble {
  double high = 0.0, low = 0.0;
  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double x) : high(x) {}  // NOLINT: a double is a number of 106 bits
  constexpr DoubleDouble(double h, double l) : high(h), low(l) {}
};

/// a + b; exact where |a| >= |b|.
constexpr DoubleDouble sum_of_ordered(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b, exact (Knuth's TwoSum).
constexpr DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, second = sum - a;
  return {sum, (a - (sum - second)) + (b - second)};
}

/// The leading 26 bits of a, and the rest (Veltkamp).
constexpr DoubleDouble veltkamp_split(double a) {
  const double scaled = 0x1p27 * a + a, leading = scaled - (scaled - a);
  return {leading, a - leading};
}

/// a b, exact (Dekker's TwoProduct).
constexpr DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  const DoubleDouble p = veltkamp_split(a), q = veltkamp_split(b);
  return {product, ((p.high * q.high - product) + p.high * q.low + p.low * q.high) + p.low * q.low};
}

constexpr DoubleDouble operator-(DoubleDouble a) {
  return {-a.high, -a.low};
}

constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
  const DoubleDouble sum = sum_of_ordered(high.high, high.low + low.high);
  return sum_of_ordered(sum.high, low.low + sum.low);
}

constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) {
  return a + -b;
}

constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return sum_of_ordered(product.high, product.low + (a.high * b.low + a.low * b.high));
}

}  // namespace exactvo::lp
