// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact/integer_polynomial.h"

#include <cstddef>
#include <utility>

namespace exactvo::geometry::detail {
namespace {

/// Divides by the greatest common divisor of the coefficients: a positive number, so that signs stay.
void make_coprime(IntegerPolynomial& f) {
  while (!f.empty() && sgn(f.back()) == 0) f.pop_back();
  mpz_class content = 0;
  for (const mpz_class& c : f) content = gcd(content, c);
  if (content > 1)
    for (mpz_class& c : f) mpz_divexact(c.get_mpz_t(), c.get_mpz_t(), content.get_mpz_t());
}

/// A positive multiple of the remainder of a over b, b not zero.
IntegerPolynomial remainder(IntegerPolynomial a, const IntegerPolynomial& b) {
  const mpz_class scale = abs(b.back());
  while (a.size() >= b.size()) {
    const mpz_class factor = sgn(b.back()) > 0 ? a.back() : mpz_class(-a.back());
    const std::size_t shift = a.size() - b.size();
    for (mpz_class& c : a) c *= scale;
    for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] -= factor * b[i];
    make_coprime(a);
  }
  return a;
}

/// REQUIRES: b divides a, and its coefficients are coprime: then the quotient has whole ones (Gauss's lemma).
IntegerPolynomial quotient(IntegerPolynomial a, const IntegerPolynomial& b) {
  IntegerPolynomial out(a.size() - b.size() + 1);
  for (std::size_t k = out.size(); k-- > 0;) {
    out[k] = a[k + b.size() - 1] / b.back();
    for (std::size_t i = 0; i < b.size(); ++i) a[k + i] -= out[k] * b[i];
  }
  return out;
}

IntegerPolynomial derivative(const IntegerPolynomial& f) {
  IntegerPolynomial out;
  for (std::size_t i = 1; i < f.size(); ++i) out.push_back(f[i] * static_cast<unsigned long>(i));
  make_coprime(out);
  return out;
}

}  // namespace

IntegerPolynomial primitive(const std::vector<mpq_class>& coefficients) {
  mpz_class denominator = 1;
  for (const mpq_class& c : coefficients) denominator = lcm(denominator, c.get_den());
  IntegerPolynomial f;
  for (const mpq_class& c : coefficients) f.push_back(mpq_class(c * denominator).get_num());
  make_coprime(f);
  return f;
}

IntegerPolynomial gcd(const IntegerPolynomial& a, const IntegerPolynomial& b) {
  if (b.empty()) return a;
  return gcd(b, remainder(a, b));
}

IntegerPolynomial square_free(IntegerPolynomial p) {
  make_coprime(p);
  if (p.size() > 2) p = quotient(p, gcd(p, derivative(p)));
  if (sgn(p.back()) < 0)
    for (mpz_class& c : p) c = -c;
  return p;
}

int sign_at(const IntegerPolynomial& f, const mpq_class& x) {
  mpz_class sum = 0, power = 1;  // Horner, times the denominator's power
  for (std::size_t i = f.size(); i-- > 0;) {
    sum = sum * x.get_num() + f[i] * power;
    power *= x.get_den();
  }
  return sgn(sum);
}

SturmChain::SturmChain(const IntegerPolynomial& p) : links_{p, derivative(p)} {
  while (links_.back().size() > 1) {
    IntegerPolynomial next = remainder(links_[links_.size() - 2], links_.back());
    for (mpz_class& c : next) c = -c;
    links_.push_back(std::move(next));
  }
}

int SturmChain::changes_at(const mpq_class& x) const {
  int changes = 0, before = 0;
  for (const IntegerPolynomial& link : links_) {
    const int sign = sign_at(link, x);
    if (sign != 0 && before == -sign) ++changes;
    if (sign != 0) before = sign;
  }
  return changes;
}

}  // namespace exactvo::geometry::detail
