// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/arc_measure.h"

#include <mpfr.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"

namespace exactvo::vo::detail {
namespace {

using geometry::kInfinity;

/// Bits that an answer has beyond the speed (or its square): what is stated is 2^-48.
constexpr int kBits = 56;

/// Each coordinate within 2^-bits.
RationalVector approximate(const Point& x, int bits) {
  return {x.x.approximate(bits), x.y.approximate(bits)};
}

/// x up to 2^error, rounded outward.
geometry::Bracket bracket_of(const Rational& x, int error) {
  const Rational low = x - Rational(std::ldexp(1.0, error)), high = x + Rational(std::ldexp(1.0, error));
  double a = low.get_d(), b = high.get_d();
  while (Rational(a) > low) a = std::nextafter(a, -kInfinity);
  while (Rational(b) < high) b = std::nextafter(b, kInfinity);
  return {a, b};
}

class Real {
 public:
  explicit Real(mpfr_prec_t precision) { mpfr_init2(value_, precision); }
  Real(mpfr_prec_t precision, const Rational& x) : Real(precision) { mpfr_set_q(value_, x.get_mpq_t(), MPFR_RNDN); }
  ~Real() { mpfr_clear(value_); }
  Real(const Real&) = delete;
  Real& operator=(const Real&) = delete;
  mpfr_ptr get() { return value_; }
  Rational rational() const {
    Rational out;
    mpfr_get_q(out.get_mpq_t(), value_);
    return out;
  }

 private:
  mpfr_t value_;
};

/// The angle between two vectors from 0 to pi, minus its sine. Ends that are rounded may lie the wrong way round by
/// their rounding: then the arc is nothing, or half of the circle.
Rational angle_without_sine(const RationalVector& a, const RationalVector& b, mpfr_prec_t precision) {
  const Rational across = cross(a, b), along = dot(a, b);
  if (sgn(across) < 0 && sgn(along) > 0) return 0;
  Real y(precision, across), x(precision, along), angle(precision), sine(precision);
  mpfr_atan2(angle.get(), y.get(), x.get(), MPFR_RNDN);
  if (sgn(across) < 0) mpfr_neg(angle.get(), angle.get(), MPFR_RNDN);
  mpfr_sin(sine.get(), angle.get(), MPFR_RNDN);
  mpfr_sub(angle.get(), angle.get(), sine.get(), MPFR_RNDN);
  return angle.rational();
}

/// What bounds the errors of a walk: e, of its points' coordinates, moves a cross product of two points by at most
/// 8 V e, and an arc's angle by 4 e/r, that is r^2 (t - sin t)/2 by at most 4 r e. So n stretches are off by n (4 V + 4
/// r) e in all; the roundings of MPFR, of r^2 t, by n r^2 2^(4 - precision).
struct Fineness {
  int bits;
  mpfr_prec_t precision;

  Fineness(const Arrangement& arrangement, const std::vector<Stretch>& walk, double max_speed) {
    double largest = max_speed;
    for (const Stretch& s : walk)
      if (arrangement.curve(s).is_arc) largest = std::max(largest, arrangement.curve(s).circle.radius.get_d());
    const int speed = std::ilogb(max_speed), radius = std::ilogb(largest) + 1;
    const int count = std::ilogb(static_cast<double>(walk.size())) + 1;
    bits = kBits + count + radius + 4 - 2 * speed;
    precision = kBits + count + 8 + 2 * (radius - speed) + 64;
  }
};

}  // namespace

PointBracket bracket_of(const Point& x, double max_speed) {
  const int bits = kBits - std::ilogb(max_speed);
  const RationalVector at = approximate(x, bits);
  return {bracket_of(at.x, -bits), bracket_of(at.y, -bits)};
}

// Green's theorem: the triangles with the origin, and the segments between arcs and their chords.
geometry::Bracket area_of(const Arrangement& arrangement, const std::vector<Stretch>& walk, double max_speed) {
  const Fineness fineness(arrangement, walk, max_speed);
  Rational twice = 0;
  for (const Stretch& s : walk) {
    const RationalVector from = approximate(arrangement.point(s.from), fineness.bits);
    const RationalVector to = approximate(arrangement.point(s.to), fineness.bits);
    twice += cross(from, to);
    const Curve& c = arrangement.curve(s);
    if (!c.is_arc) continue;
    const RationalVector a = from - c.circle.centre, b = to - c.circle.centre;
    const Rational r2 = c.circle.radius * c.circle.radius;
    if (c.is_counter_clockwise) twice += r2 * angle_without_sine(a, b, fineness.precision);
    if (!c.is_counter_clockwise) twice -= r2 * angle_without_sine(b, a, fineness.precision);
  }
  return bracket_of(twice / 2, 2 * std::ilogb(max_speed) - kBits + 1);
}

}  // namespace exactvo::vo::detail
