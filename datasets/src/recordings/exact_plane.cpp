// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/exact_plane.h"

#include <cmath>
#include <limits>

namespace exactvo::datasets::exact {
namespace {

/// Numbers are rounded outward to multiples of 2^-kGrid where they would grow without end.
constexpr unsigned kGrid = 256;

Rational grid_step() {
  return Rational(1) / Rational(mpz_class(1) << kGrid);
}

Rational down(const Rational& x) {
  mpz_class scaled;
  const mpz_class up = x.get_num() << kGrid;
  mpz_fdiv_q(scaled.get_mpz_t(), up.get_mpz_t(), x.get_den_mpz_t());
  Rational rounded(scaled, mpz_class(1) << kGrid);
  rounded.canonicalize();
  return rounded;
}
Rational up(const Rational& x) {
  return -down(-x);
}

/// e^-z for 0 <= z <= 1/2, z on the grid. The terms fall by half at least, so what is left out is below the last one;
/// each term is rounded down by less than a step of the grid.
Interval decay_of_little(const Rational& z) {
  const Rational step = grid_step();
  Rational sum(1), term(1);
  unsigned n = 0;
  while (term > step) {
    term = down(term * z / ++n);
    sum += n % 2 == 1 ? Rational(-term) : term;
  }
  const Rational off = Rational(n + 2) * step + term;
  return {Rational(sum - off), Rational(sum + off)};
}

}  // namespace

bool is_inside(const Point& p, const geometry::Obstacle& obstacle) {
  if (!geometry::has_interior(obstacle)) return false;
  bool inside = false;
  for (const geometry::Segment& edge : edges_of(obstacle))
    inside ^= ray_crosses(p, east(), exactly(edge.a), exactly(edge.b));
  return inside;
}

Interval operator+(const Interval& a, const Interval& b) {
  return {Rational(a.low + b.low), Rational(a.high + b.high)};
}
Interval operator-(const Interval& a, const Interval& b) {
  return {Rational(a.low - b.high), Rational(a.high - b.low)};
}
Interval operator/(const Interval& a, const Interval& b) {
  return {Rational(a.low / (sgn(a.low) >= 0 ? b.high : b.low)), Rational(a.high / (sgn(a.high) >= 0 ? b.low : b.high))};
}

Interval root(const Rational& x) {
  // sqrt(n / d) = sqrt(n d) / d.
  constexpr unsigned kBits = 200;
  const mpz_class product = x.get_num() * x.get_den();
  if (mpz_perfect_square_p(product.get_mpz_t()) != 0) {
    Rational exact(sqrt(product), x.get_den());
    exact.canonicalize();
    return {exact, exact};
  }
  const mpz_class scaled = sqrt(mpz_class(product << (2 * kBits)));
  const mpz_class scale = mpz_class(x.get_den() << kBits);
  Rational low(scaled, scale), high(mpz_class(scaled + 1), scale);
  low.canonicalize();
  high.canonicalize();
  return {low, high};
}

Interval decay(const Rational& x) {
  // e^-x = (e^-(x / 2^m))^(2^m); beyond 2^10 it is below 2^-1000.
  if (x > 1024) return {Rational(0), grid_step()};
  unsigned halvings = 0;
  Rational z = x;
  while (z > Rational(1, 2)) {
    z /= 2;
    ++halvings;
  }
  const Rational lower = down(z);
  Interval e = decay_of_little(lower);
  if (lower != z) e.low -= grid_step();  // the slope is at most 1
  for (; halvings > 0; --halvings) {
    e.low = std::max(e.low, Rational(0));
    e = {down(e.low * e.low), up(e.high * e.high)};
  }
  return e;
}

double at_least(const Rational& x) {
  const double near = x.get_d();  // rounded towards zero
  return Rational(near) >= x ? near : std::nextafter(near, std::numeric_limits<double>::infinity());
}
double at_most(const Rational& x) {
  const double near = x.get_d();
  return Rational(near) <= x ? near : std::nextafter(near, -std::numeric_limits<double>::infinity());
}

}  // namespace exactvo::datasets::exact
