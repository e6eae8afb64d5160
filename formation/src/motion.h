// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The continuous motion between two rows of a recording, as chords with a certified bound of how far the path strays
/// from each: the ground of every swept clearance.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exactvo/formation/recording.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation::detail {

struct Motion {
  MotionLaw law;
  double duration;  ///< s
  double gain;      ///< k3 where exponential
  Vec2 from, from_velocity, to, to_velocity;

  /// Where the robot is a share s in [0, 1] of the way through the step.
  Vec2 at(double s) const {
    const double t = s * duration;
    switch (law) {
      case MotionLaw::straight:
        return from + s * (to - from);
      case MotionLaw::exponential:
        return from + t * tracked() + lag(t) * (from_velocity - tracked());
      case MotionLaw::hermite:
        return cubic(s);
    }
    return from;
  }

  /// m: the greatest length met in computing where the robot is: what its coordinates are rounded in proportion to.
  double reach() const {
    return law == MotionLaw::exponential ? duration * norm(tracked()) : duration * norm(to_velocity);
  }

  /// A bound of |x''| over the step, m/s^2.
  double acceleration_bound() const {
    switch (law) {
      case MotionLaw::straight:
        return 0.0;
      case MotionLaw::exponential:
        return gain * norm(from_velocity - tracked());
      case MotionLaw::hermite:
        return std::max(norm(second_derivative(0.0)), norm(second_derivative(1.0)));
    }
    return 0.0;
  }

  /// Calls f(chord, sagitta): a chord of duration d strays at most |x''| d^2 / 8 from the path.
  template <typename F>
  void for_each_chord(const F& f) const {
    for_each_chord_in_time([&f](const geometry::Segment& chord, double, double, double sagitta) { f(chord, sagitta); });
  }

  /// The same with the shares of the step between which the chord runs: f(chord, start, end, sagitta).
  template <typename F>
  void for_each_chord_in_time(const F& f) const {
    const std::size_t chords = chord_count();
    const double n = static_cast<double>(chords), sagitta = sagitta_of(chords);
    for (std::size_t k = 0; k < chords; ++k) {
      const double start = static_cast<double>(k) / n, end = static_cast<double>(k + 1) / n;
      f(geometry::Segment{at(start), at(end)}, start, end, sagitta);
    }
  }

  /// Enough for the sagitta to be below 0.01 mm, at most 64.
  std::size_t chord_count() const {
    constexpr double kSagitta = 1e-5;
    constexpr double kMost = 64.0;
    return static_cast<std::size_t>(std::clamp(std::ceil(std::sqrt(sagitta_of(1) / kSagitta)), 1.0, kMost));
  }

  double sagitta_of(std::size_t chords) const {
    const double d = duration / static_cast<double>(chords);
    return acceleration_bound() * d * d / 8.0;
  }

 private:
  double lag(double t) const { return -std::expm1(-gain * t) / gain; }
  /// w, from v(T) = w + e^{-k T} (v(0) - w).
  Vec2 tracked() const {
    const double decayed = std::exp(-gain * duration);
    return (to_velocity - decayed * from_velocity) / -std::expm1(-gain * duration);
  }
  Vec2 cubic(double s) const {
    const Vec2 m0 = duration * from_velocity, m1 = duration * to_velocity;
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * from + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * to + (s3 - s2) * m1;
  }
  Vec2 second_derivative(double s) const {
    const Vec2 m0 = duration * from_velocity, m1 = duration * to_velocity;
    return ((12 * s - 6) * from + (6 * s - 4) * m0 + (6 - 12 * s) * to + (6 * s - 2) * m1) / (duration * duration);
  }
};

/// Both motions cut alike, with the sum of their sagittas.
template <typename F>
void for_each_chord_pair(const Motion& a, const Motion& b, const F& f) {
  const std::size_t chords = std::max(a.chord_count(), b.chord_count());
  const double n = static_cast<double>(chords);
  const double sagitta = a.sagitta_of(chords) + b.sagitta_of(chords);
  for (std::size_t k = 0; k < chords; ++k) {
    const double s = static_cast<double>(k) / n, e = static_cast<double>(k + 1) / n;
    f(geometry::Segment{a.at(s), a.at(e)}, geometry::Segment{b.at(s), b.at(e)}, sagitta);
  }
}

}  // namespace exactvo::formation::detail
