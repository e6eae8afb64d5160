// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The continuous motion of a robot between two rows of a recording, with a certified bound of how far it strays from
/// its chords, and the search for a least clearance along it: the ground of every swept clearance. For measuring only;
/// robots are driven by integrators.h and runs/kinematic_run.cpp.

#include <algorithm>
#include <cmath>

#include "exactvo/formation/recording.h"
#include "exactvo/geometry/shapes.h"
#include "motion/integrators.h"

namespace exactvo::formation::detail {

struct Motion {
  MotionLaw law;
  Decay decay;  ///< the step's duration; k3 where exponential
  Vec2 from, from_velocity, to, to_velocity;
  /// m/s: w where exponential, asked for so often that it is computed once.
  Vec2 tracked = law == MotionLaw::exponential ? tracked_between(from_velocity, to_velocity) : Vec2{};

  /// Where the robot is a share s in [0, 1] of the way through the step.
  Vec2 at(double s) const {
    const double t = s * decay.duration;
    if (law == MotionLaw::straight) return from + s * (to - from);
    if (law == MotionLaw::exponential) return from + t * tracked + lag(t) * (from_velocity - tracked);
    return cubic(s);
  }

  geometry::Segment chord(double start, double end) const { return {at(start), at(end)}; }

  /// m: the greatest length met in computing where the robot is: what its coordinates are rounded in proportion to.
  double reach() const { return decay.duration * norm(law == MotionLaw::exponential ? tracked : to_velocity); }

  /// A bound of |x''| over the step, m/s^2.
  double acceleration_bound() const {
    if (law == MotionLaw::straight) return 0.0;
    if (law == MotionLaw::exponential) return decay.gain * norm(from_velocity - tracked);
    return std::max(norm(second_derivative(0.0)), norm(second_derivative(1.0)));
  }

  /// A bound of |x'| over the step, m/s: somewhere it is the mean, and nowhere does it change faster than |x''|.
  double speed_bound() const { return norm(to - from) / decay.duration + acceleration_bound() * decay.duration; }

  /// m: how far the path strays at most from a chord over this share of the step, at equal times: |x''| d^2 / 8.
  double stray(double share) const {
    const double d = share * decay.duration;
    return acceleration_bound() * d * d / 8.0;
  }

 private:
  double lag(double t) const {
    return (t == decay.duration ? decay.settled : -std::expm1(-decay.gain * t)) / decay.gain;
  }
  /// w, from v(T) = w + e^{-k T} (v(0) - w).
  Vec2 tracked_between(Vec2 first, Vec2 last) const { return (last - decay.left * first) / decay.settled; }
  Vec2 cubic(double s) const {
    const Vec2 m0 = decay.duration * from_velocity, m1 = decay.duration * to_velocity;
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * from + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * to + (s3 - s2) * m1;
  }
  Vec2 second_derivative(double s) const {
    const Vec2 m0 = decay.duration * from_velocity, m1 = decay.duration * to_velocity;
    return ((12 * s - 6) * from + (6 * s - 4) * m0 + (6 - 12 * s) * to + (6 * s - 2) * m1) /
           (decay.duration * decay.duration);
  }
};

/// a as seen from b: every law is linear in the states, so it is a motion of the same law. REQUIRES: the same law,
/// duration and gain, which the robots of a recording have.
inline Motion relative(const Motion& a, const Motion& b) {
  return {
      a.law, a.decay, a.from - b.from, a.from_velocity - b.from_velocity, a.to - b.to, a.to_velocity - b.to_velocity};
}

/// What a chord says of the clearance over its share of the step.
struct ChordClearance {
  double clearance;  ///< m, of the chord; roundings taken off
  double stray;      ///< m, how far the motion strays from the chord
};

/// m: chords are halved until they stray by at most this share of their clearance, but no less than the finest and no
/// more than the coarsest: near contact a clearance is sharp, and far from it cheap.
inline constexpr double kStrayShare = 1.25e-4;
inline constexpr double kFinestStray = 1e-10;
inline constexpr double kCoarsestStray = 1e-5;
/// 2^16 chords a step stray 2^-32 of what the whole step does.
inline constexpr int kMostHalvings = 16;

/// A certified lower bound of the clearance over the shares [start, end] of a step; `look(start, end)` gives the
/// ChordClearance of one chord. Stretches that cannot come below `enough` are not looked at more closely.
template <typename Look>
double least_clearance(const Look& look, double start, double end, double enough, int halvings = kMostHalvings) {
  const ChordClearance c = look(start, end);
  const double least = c.clearance - c.stray;
  const double fine = std::clamp(kStrayShare * std::fabs(c.clearance), kFinestStray, kCoarsestStray);
  if (least >= enough || c.stray <= fine || halvings == 0) return least;
  const double middle = 0.5 * (start + end);
  const double first = least_clearance(look, start, middle, enough, halvings - 1);
  return std::min(first, least_clearance(look, middle, end, std::min(enough, first), halvings - 1));
}

}  // namespace exactvo::formation::detail
