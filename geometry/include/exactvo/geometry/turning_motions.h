// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact verdicts for a body on a constant twist: whether it overlaps what stands still, at any moment of its drive.
///
/// Every point of the body goes along a circle about one centre. With t = tan(angle / 2) circles, and whether a corner
/// is near an edge of the other or the other way round, are polynomials in t over the rationals (quarter turns are
/// taken off first): the roots are isolated and compared exactly. Where the drive ends is the tangent of a rational
/// number, which is transcendental (Lindemann): no such root can be there, so that ever finer enclosures of it decide.
///
/// Doubles in, exact inside: a filter (turning.h) decides what it can, `stage_counts` (predicates.h) counts both. What
/// is meant by *overlap* and *contact* stands in motions.h; here every part of the body has an interior.
///
/// See also: motions.h (bodies that keep their heading), turning_pairs.h (moments and clearance; both move; certified,
/// not exact).

#include <optional>

#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/motions.h"
#include "exactvo/geometry/twist.h"

namespace exactvo::geometry {

/// A drive at a constant twist. The body is given as it stands at the start, in the axes of the world.
struct TurningMotion {
  double start = 0.0;  ///< s
  double end = 0.0;    ///< s, >= start
  Vec2 at;             ///< m, the reference point at the start
  Twist twist;         ///< m/s and rad/s, in the axes of the world at the start
};

/// Whether the body overlaps an obstacle at any moment of its drive. A polygon is an obstacle with its inside. Exact.
/// REQUIRES: finite numbers, times that do not fall; parts with at least one corner and radius >= 0, a radius > 0 where
/// the corners lie on one line; a valid obstacle (validity.h; finite vertices are checked, the rest is not).
Encounter encounter(const TurningMotion& motion, const RigidBody& body, const Obstacle& obstacle);

/// The same against a body at rest; the same is required of its parts. Exact.
Encounter encounter(const TurningMotion& motion, const RigidBody& body, const RigidBody& other, Vec2 other_at);

/// A proof that the body stays clear of the obstacle (motion_certificate.h has the kind); none if they touch or
/// overlap, if the body turns by more than 64 rad, or if they are so near to touching that 2^40 pieces of time are not
/// enough. For each piece of time and each pair of a part and an edge it has a direction n and a margin: a corner c of
/// the part goes along a circle, so that over a piece of length d
///
///     n.c(t)  >=  least of n.c(from), n.c(to)  -  |n| |turn| |speed of c| d^2 / 8
///
/// REQUIRES: as `encounter`.
std::optional<MotionCertificate> certify(const TurningMotion& motion, const RigidBody& body, const Obstacle& obstacle);
/// The same for two bodies that both may turn, over the time that both have; also none where more than 2^16 pieces of
/// time would be needed.
std::optional<MotionCertificate> certify(const TurningMotion& a, const RigidBody& body_a, const TurningMotion& b,
                                         const RigidBody& body_b);

/// Whether the certificate proves that the two stay clear. In rationals, by code of its own: sines and cosines are
/// enclosed by their series. False too where the body turns by more than 64 rad. REQUIRES: as `encounter`.
bool proves_clear(const MotionCertificate& certificate, const TurningMotion& motion, const RigidBody& body,
                  const Obstacle& obstacle);
/// The same for two bodies.
bool proves_clear(const MotionCertificate& certificate, const TurningMotion& a, const RigidBody& body_a,
                  const TurningMotion& b, const RigidBody& body_b);

}  // namespace exactvo::geometry
