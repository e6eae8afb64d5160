// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A constant twist: a body drives and turns at constant rates, as `cmd_vel` asks for it. Its reference point goes
/// along an arc, every point of it on a circle of its own at constant speed:
///
///     x(t) = c(t) + R(w t) q,    c(t) = c + t (sin h / h) R(h) v,    h = w t / 2
///
/// with the velocity v of the reference point and the turn rate w at t = 0. A body that does not turn has w = 0.
///
/// Rounded, with a bound on the rounding (`twist_rounding`); lengths that are bounds are rounded up. The elementary
/// functions are taken to be right to one ulp.
///
/// See also: turning.h (does a body on a twist touch anything?).

#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry {

/// Where a body is and which way it points.
struct Pose {
  Vec2 at;               ///< m, the reference point
  double heading = 0.0;  ///< rad, counter-clockwise from x
};

/// How a body moves at a moment. The axes are the caller's: those of the world, or those of the body.
struct Twist {
  Vec2 velocity;      ///< m/s, of the reference point
  double turn = 0.0;  ///< rad/s, counter-clockwise
};

/// What a constant twist does in a time: a turn about the origin, then a shift.
struct Displacement {
  Vec2 by;              ///< m, of the reference point
  double cosine = 1.0;  ///< of the angle turned
  double sine = 0.0;    ///< of the angle turned
  /// Where a point goes that is at `q` from the reference point's first place.
  Vec2 moved(Vec2 q) const { return by + turned(q); }
  /// `q` turned.
  Vec2 turned(Vec2 q) const { return {cosine * q.x - sine * q.y, sine * q.x + cosine * q.y}; }
};

/// The displacement by a twist in `time` s, in the axes of the twist at the start. REQUIRES: finite numbers.
Displacement displacement_after(const Twist& twist, double time);

/// The pose after `time` s of a twist in the body's axes (x ahead, y left).
Pose pose_after(const Pose& pose, const Twist& in_body_axes, double time);

/// The twist in the body's axes that leads from one pose to the other in `time` s, turning by less than half a turn.
/// REQUIRES: time > 0.
Twist twist_between(const Pose& from, const Pose& to, double time);

/// m/s: the speed of the point at `q` from the reference point, which is constant.
double speed_of(const Twist& twist, Vec2 q);

/// m: how far the point at `q` strays from the chord of its way in `time` s, at most: |w| |v_q| t^2 / 8, rounded up.
/// (Each point is accelerated by |w| |v_q|, exactly.)
double stray_of(const Twist& twist, Vec2 q, double time);

/// m: a bound on the rounding error of `Displacement::moved(q)`.
double twist_rounding(const Twist& twist, Vec2 q, double time);

/// Rims of the two wheels of a differential drive, m/s.
struct WheelSpeeds {
  double left = 0.0;   ///< m/s
  double right = 0.0;  ///< m/s
};

/// The wheels of a drive whose axle's centre goes ahead at `forward` m/s; `separation` m apart. Rounded.
inline WheelSpeeds wheel_speeds(double forward, double turn, double separation) {
  return {forward - 0.5 * separation * turn, forward + 0.5 * separation * turn};
}

/// A twist of a differential drive that leads a point ahead of the axle where it should be.
struct ReferenceTwist {
  double forward = 0.0;       ///< m/s, of the axle's centre
  double turn = 0.0;          ///< rad/s
  double half_tangent = 0.0;  ///< t = tan(half the angle turned): cos = (1 - t^2)/(1 + t^2), sin = 2 t/(1 + t^2)
};

/// The constant twist that takes the point `ahead` m before the axle's centre in `time` s by exactly time * velocity,
/// a velocity in the body's axes: tan(turn time / 2) = Y / (2 ahead + X) with (X, Y) = time * velocity. Rounded.
/// REQUIRES: time > 0, |velocity| time < 2 ahead.
ReferenceTwist reference_twist(Vec2 velocity, double ahead, double time);

}  // namespace exactvo::geometry
