// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two bodies of which at least one drives and turns: whether they overlap, when, and how near they come.
///
/// Time is divided. Over each piece one direction separates two convex parts (turning.h), or their overlap at a moment
/// is a witness. Certified: `clear` and `overlap` are certain, whatever was rounded. Where the two come so near to
/// touching that doubles cannot tell, a body on a twist is judged exactly against what stands still
/// (turning_motions.h); of two that both move, the verdict then stays open and says how near they come.
///
/// See also: motions.h (bodies that keep their heading: exact), motion_check.h (many bodies and a map).

#include <vector>

#include "exactvo/geometry/turning_motions.h"

namespace exactvo::geometry {

/// Whether two bodies of which one turns meet: certified.
struct TurningVerdict {
  /// Encounter, moments and clearance. At `nearest_time` the clearance is within its bounds, up to rounding: no other
  /// moment is nearer by more than these are apart.
  MotionVerdict verdict;
  /// The two come nearer than verdict.clearance.high, and whether they touch or overlap is not known; the encounter is
  /// `contact`.
  bool is_open = false;
};

/// Over the time that both have. REQUIRES: as `encounter` in turning_motions.h; numbers that are not 0 of a size
/// between 1e-100 and 1e100.
TurningVerdict examine(const TurningMotion& a, const RigidBody& body_a, const TurningMotion& b,
                       const RigidBody& body_b);
/// Against an obstacle; the inside of a polygon counts as distance 0.
TurningVerdict examine(const TurningMotion& a, const RigidBody& body_a, const Obstacle& obstacle);
/// Against some edges of an obstacle, and its inside if it has one. REQUIRES: all edges that the body may touch.
TurningVerdict examine(const TurningMotion& a, const RigidBody& body_a, const Obstacle& obstacle,
                       const std::vector<Segment>& edges);

}  // namespace exactvo::geometry
