// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact/algebraic_root.h"

#include <algorithm>

namespace exactvo::vo::detail {
namespace {

Rational middle(const Rational& a, const Rational& b) {
  return (a + b) / 2;
}

/// The root x with an interval round it that holds no other.
Root round_about(const Polynomial& f, const SturmChain& chain, const Rational& x, Rational reach) {
  while (chain.count(x - reach, x + reach) != 1 || sign_at(f, x - reach) == 0) reach /= 2;
  return {{Integer(-x.get_num()), x.get_den()}, x - reach, x + reach};
}

void isolate_within(const Polynomial& f, const SturmChain& chain, const Rational& low, const Rational& high,
                    std::vector<Root>& out) {
  const int count = chain.count(low, high);
  if (count == 0) return;
  if (count == 1 && sign_at(f, high) == 0) {
    out.push_back(round_about(f, chain, high, high - low));
    return;
  }
  if (count == 1 && sign_at(f, low) != 0) {
    out.push_back({f, low, high});
    return;
  }
  const Rational half = middle(low, high);
  isolate_within(f, chain, low, half, out);
  isolate_within(f, chain, half, high, out);
}

/// Whether the common divisor of both has a root where the intervals overlap: that is then the root of both.
bool are_equal(const Root& a, const Root& b) {
  const Polynomial common = gcd(a.f, b.f);
  if (common.size() < 2) return false;
  return sign_at(common, std::max(a.low, b.low)) * sign_at(common, std::min(a.high, b.high)) < 0;
}

}  // namespace

std::vector<Root> isolate(const Polynomial& f, const Rational& low, const Rational& high) {
  std::vector<Root> out;
  if (f.size() > 1) isolate_within(f, SturmChain(f), low, high, out);
  return out;
}

Root rational_root(const Rational& x) {
  return {{Integer(-x.get_num()), x.get_den()}, x, x};
}

Root settled(Root root) {
  const Polynomial& f = root.f;
  if (f.size() == 2) return rational_root(Rational(-f[0]) / Rational(f[1]));
  if (f.size() != 3) return root;
  const Integer discriminant = f[1] * f[1] - 4 * f[0] * f[2];
  if (mpz_perfect_square_p(discriminant.get_mpz_t()) == 0) return root;
  for (const Integer& side : {Integer(sqrt(discriminant)), Integer(-sqrt(discriminant))}) {
    const Rational x = Rational(Integer(side - f[1])) / Rational(Integer(2 * f[2]));
    if (root.low < x && x < root.high) return rational_root(x);
  }
  return root;
}

void halve(Root& root) {
  const Rational half = middle(root.low, root.high);
  const int sign = sign_at(root.f, half);
  if (sign == 0) {
    root = rational_root(half);
  } else if (sign == sign_at(root.f, root.high)) {
    root.high = half;
  } else {
    root.low = half;
  }
}

int compare(const Root& a, const Rational& b) {
  if (a.is_settled()) {
    const int order = cmp(a.low, b);
    return (order > 0) - (order < 0);
  }
  if (b <= a.low) return 1;
  if (b >= a.high) return -1;
  const int sign = sign_at(a.f, b);
  if (sign == 0) return 0;
  return sign == sign_at(a.f, a.high) ? -1 : 1;
}

int compare(Root a, Root b) {
  bool may_be_equal = true;
  for (;;) {
    if (b.is_settled()) return compare(a, b.low);
    if (a.is_settled()) return -compare(b, a.low);
    if (a.high <= b.low) return -1;
    if (b.high <= a.low) return 1;
    if (may_be_equal && are_equal(a, b)) return 0;
    may_be_equal = false;
    halve(Rational(a.high - a.low) < Rational(b.high - b.low) ? b : a);
  }
}

}  // namespace exactvo::vo::detail
