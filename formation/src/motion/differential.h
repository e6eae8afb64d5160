// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Differential drive, seen at the reference point p = c + D e: c the axle's centre, e the heading, n = e turned left,
/// b the wheel separation, beta = b / (2 D), W the greatest wheel speed. p moves with any velocity u; the wheels then
/// run at u.e -+ beta u.n (left, right) at first, and the heading turns towards u.
///
/// Theorem 1: both wheels keep within W for ever, whatever is left of u, if u is in conv(disc(0, W cos alpha), W e),
/// tan alpha = beta. So do smaller discs about 0 with the same apex (lemma 2: these sets do not shrink as the heading
/// turns to u, so that keeping on and braking stay allowed).
/// Theorem 2: a constant twist takes p to p + T u exactly: with X = T u.e, Y = T u.n and t = Y / (2 D + X) the heading
/// turns by a, cos a = (1 - t^2) / (1 + t^2), sin a = 2 t / (1 + t^2), and p strays from its chord by s T |t| / 4 at
/// most. Lemma 3: turning alone, with u kept, changes the wheels' speeds; the disc about 0 is so small that braking and
/// turning together keep within the wheels' acceleration.

#include <array>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/half_plane.h"

namespace exactvo::formation::detail {

/// What holds for a step of the reference point with velocity u.
struct TwistOfStep {
  double turn = 0.0;   ///< t = tan(a / 2), a the angle by which the heading turns
  WheelSpeeds wheels;  ///< m/s, constant over the step
};

/// REQUIRES: |u| time_step < 2 reference.
TwistOfStep twist_of(const DifferentialDrive& drive, double time_step, Vec2 heading, Vec2 u);
/// The heading after it, of length 1 up to rounding.
Vec2 turned(Vec2 heading, double turn);
/// The velocity u of the twist that led to this heading with these wheels, up to rounding. REQUIRES: the wheels turn
/// the robot by less than a half turn in a step.
Vec2 velocity_before(const DifferentialDrive& drive, double time_step, const OnWheels& now);
/// A preferred velocity straight backwards would only brake the robot: it is turned by a degree, to the side where it
/// points already or else to the left, until the heading has come round.
Vec2 turned_aside(Vec2 heading, Vec2 preferred);

/// How many `velocities_aside` returns.
inline constexpr std::size_t kVelocitiesAside = 14;
/// Slower, and nearer to the heading, for a body that has no room to turn as fast as the wish asks; in the order of
/// their progress along it.
std::array<Vec2, kVelocitiesAside> velocities_aside(Vec2 heading, Vec2 wish);

/// Half-planes of WheelLimits at most.
inline constexpr std::size_t kMostHalfPlanesOfWheels = 208;

/// A robot on wheels in a run: what it may do.
class WheelLimits {
 public:
  /// `braking_time`: s.
  WheelLimits(const DifferentialDrive& drive, double time_step, double braking_time);

  /// m/s: the largest speed sideways and backwards; 0 where the braking time is too short for its wheels.
  double side_speed() const { return side_; }
  /// Half-planes of velocities: the polygon inside the convex set, turned by the heading, and the change of the wheels'
  /// speeds, rounded; `braked`, the velocity after a step of braking, satisfies them.
  void half_planes(Vec2 heading, const WheelSpeeds& now, Vec2 braked, std::vector<geometry::HalfPlane>& out) const;
  /// Whether the twist of u keeps within the limits of the wheels and their change.
  bool allows(Vec2 heading, const WheelSpeeds& now, Vec2 u) const;

 private:
  bool can_brake(double side, double braking_time) const;
  void make_polygon(double braking_time);

  DifferentialDrive drive_;
  double step_;
  double beta_;
  double arc_ = 1.0;                          ///< a twist's way at most, in chords
  double side_ = 0.0;                         ///< m/s
  std::vector<geometry::HalfPlane> polygon_;  ///< in the frame of the heading
};

/// A robot on wheels, at the start of a step.
struct WheelsNow {
  const WheelLimits* limits;
  OnWheels state;
};

/// Half-planes say what wheels do at the beginning of a twist. Where the whole twist of what `decision` chose breaks a
/// limit, what is preferred is drawn towards `braked` until it does not; `choose` decides again for what is preferred.
/// Where half-planes forbid that, the decision becomes `relaxed`, and the caller falls back to half-planes that braking
/// satisfies; the twist of braking keeps all limits. `is_clear`: whether the body may turn on the way of a velocity
/// (scene/chain.h); it always may while it brakes.
template <class Choose, class IsClear>
void keep_wheels_within_limits(const WheelsNow& wheels, Vec2 braked, Decision& decision, const Choose& choose,
                               const IsClear& is_clear) {
  constexpr double kSame = 1e-12;
  const Vec2 wish = decision.chosen;
  const auto may_turn = [&](Vec2 u) { return norm(u - braked) <= kSame * norm(braked) || is_clear(u); };
  const auto is_done = [&] {
    return decision.status != lp::Status::optimal ||
           (wheels.limits->allows(wheels.state.heading, wheels.state.speeds, decision.chosen) &&
            may_turn(decision.chosen));
  };
  if (!may_turn(wish))
    for (const Vec2 aside : velocities_aside(wheels.state.heading, wish)) {
      if (is_done()) return;
      if (may_turn(aside)) choose(aside);
    }
  for (const double share : {0x1p-40, 0x1p-20, 0x1p-10, 0.03, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
    if (is_done()) return;
    choose(share == 1.0 ? braked : wish + share * (braked - wish));
  }
  if (!is_done()) decision.status = lp::Status::relaxed;
}

}  // namespace exactvo::formation::detail
