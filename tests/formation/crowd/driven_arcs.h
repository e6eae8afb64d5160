// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What robots on wheels drove, from where they headed first and from their places alone: headings in whole numbers,
/// speeds of wheels in rationals with bounds of the arc tangent. Written for itself: it shares nothing with the engine
/// and nothing with the audit.

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "exactvo/formation/crowd.h"

namespace exactvo::formation {

struct Bounds {
  mpq_class low, high;
};

/// atan(t) / t by its series, |t| < 1: the terms fall and alternate in sign. A t with many digits is rounded first; the
/// derivative is below 1, so that the result moves by no more.
inline Bounds arc_bounds(const mpq_class& t) {
  const mpq_class near(t.get_d()), off = abs(t - near), square = near * near;
  mpq_class power(1), sum(0), before(0);
  for (int k = 0; k < 3 || power > 0x1p-40; ++k) {
    before = sum;
    sum += mpq_class((k % 2 == 0 ? 1 : -1) * power / (2 * k + 1));
    power *= square;
  }
  return {std::min(before, sum) - off, std::max(before, sum) + off};
}

/// One robot, step by step.
class DrivenArc {
 public:
  /// Lengths in m; `half`: half_heading_of.
  DrivenArc(const CrowdKind& kind, double time_step, double position_step, Vec2 half)
      : kind_(kind), step_(time_step), unit_(position_step), a_(half.x), b_(half.y) {}

  std::string wrong;               ///< what broke a limit first
  Bounds left{0, 0}, right{0, 0};  ///< m/s
  mpq_class turn;                  ///< tan of half the angle by which the heading turned

  /// m, exact.
  void go(Vec2 from, Vec2 to) {
    const mpq_class mx = mpq_class(to.x) - mpq_class(from.x), my = mpq_class(to.y) - mpq_class(from.y);
    const CrowdWheels& w = *kind_.wheels;
    const mpq_class ahead = 2 * mpq_class(w.reference), whole = a_ * a_ + b_ * b_;
    const mpq_class ex = (a_ * a_ - b_ * b_) / whole, ey = 2 * a_ * b_ / whole;
    const mpq_class x = mx * ex + my * ey, y = my * ex - mx * ey;
    const mpq_class t = turn = y / (ahead + x), middle = x + y * t, across = mpq_class(w.wheel_separation) * t;
    const Bounds arc = arc_bounds(t);
    const Bounds before_left = left, before_right = right;
    left = speed(middle - across, arc);
    right = speed(middle + across, arc);
    const mpq_class most(kind_.max_speed);
    for (const auto& [now, before] : {std::pair(left, before_left), std::pair(right, before_right)}) {
      ask(now.high <= most && now.low >= -most, "a wheel is too fast");
      if (!std::isfinite(w.max_wheel_acceleration)) continue;
      const mpq_class change = mpq_class(w.max_wheel_acceleration) * mpq_class(step_);
      ask(now.high - before.low <= change && before.high - now.low <= change, "a wheel changes its speed too much");
    }
    if (std::isfinite(w.max_angular_speed)) {
      const mpq_class turns = mpq_class(w.wheel_separation) * mpq_class(w.max_angular_speed);
      ask(right.high - left.low <= turns && left.high - right.low <= turns, "it turns too fast");
    }
    if (std::isfinite(w.max_backward_speed))
      ask(left.low + right.low >= -2 * mpq_class(w.max_backward_speed), "it drives back too fast");
    mpq_class a = (ahead + mx) * a_ + my * b_, b = (ahead - mx) * b_ + my * a_;
    std::swap(a_, a), std::swap(b_, b);
    shorten();
  }
  /// The heading, of unit length; the half-heading is off only by what `shorten` rounds.
  Vec2 heading() const {
    const mpq_class whole = a_ * a_ + b_ * b_;
    return {mpq_class((a_ * a_ - b_ * b_) / whole).get_d(), mpq_class(2 * a_ * b_ / whole).get_d()};
  }

 private:
  void ask(bool holds, const char* what) {
    if (!holds && wrong.empty()) wrong = what;
  }
  Bounds speed(const mpq_class& way, const Bounds& arc) const {
    const mpq_class one = way * arc.low / mpq_class(step_), other = way * arc.high / mpq_class(step_);
    return {std::min(one, other), std::max(one, other)};
  }
  /// Whole numbers in place of the common factor; of more than 400 bits the last are cut: some 2^-400 of the angle.
  void shorten() {
    mpz_class factor;
    mpz_lcm(factor.get_mpz_t(), a_.get_den_mpz_t(), b_.get_den_mpz_t());
    mpz_class a(a_ * factor), b(b_ * factor), shared;
    mpz_gcd(shared.get_mpz_t(), a.get_mpz_t(), b.get_mpz_t());
    if (shared > 1) a /= shared, b /= shared;
    constexpr std::size_t kBits = 400;
    const std::size_t bits = std::max(mpz_sizeinbase(a.get_mpz_t(), 2), mpz_sizeinbase(b.get_mpz_t(), 2));
    if (bits > kBits) a >>= bits - kBits, b >>= bits - kBits;
    a_ = a, b_ = b;
  }

  CrowdKind kind_;
  double step_, unit_;
  mpq_class a_, b_;
};

}  // namespace exactvo::formation
