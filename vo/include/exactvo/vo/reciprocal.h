// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Robot against robot: the two halves of the reciprocal half-plane (van den Berg et al. 2011; paper, equations (10)
/// and (13) with alpha = 1/2).
///
/// Certified as a pair: both robots use bitwise the same normal (one negated), and both offsets are rounded up, so that
/// two velocities that each satisfy their half do not collide within the horizon.
///
/// Properties (tests quote the numbers):
///  (1) normal_b == -normal_a, bit for bit;
///  (2) offset_a + offset_b >= h_S(normal_a) / tau in the rationals (or >= 0 on a leg);
///  (3) exchanging the robots exchanges the halves, bit for bit.

#include "exactvo/geometry/half_plane.h"

namespace exactvo::vo {

using geometry::HalfPlane;
using geometry::Vec2;

/// A robot as the other one sees it.
struct MovingDisc {
  Vec2 position;        ///< m
  Vec2 velocity;        ///< m/s
  double radius = 0.0;  ///< m, >= 0
};

/// The distance that two discs keep, and how they share the change of velocity.
struct ReciprocalOptions {
  double time_horizon = 2.0;  ///< s, > 0
  double margin = 0.0;        ///< m, >= 0, kept between the rims; where it is already used up, discs only have to part
  double contact_time = 0.1;  ///< s, > 0: the half-planes of discs nearer than the margin restore it within this time
  /// In [0, 1]: how much of the change a takes; b takes the rest. The paper's alpha.
  double responsibility_of_a = 0.5;
};

/// Both halves.
struct ReciprocalHalfPlanes {
  HalfPlane a;             ///< for the new velocity of a
  HalfPlane b;             ///< for the new velocity of b
  bool certified = false;  ///< for the discs without the margin; false where they overlap: nothing can be promised
};

/// REQUIRES: finite numbers, horizons > 0, responsibility_of_a in [0, 1].
ReciprocalHalfPlanes reciprocal_half_planes(const MovingDisc& a, const MovingDisc& b,
                                            const ReciprocalOptions& options = {});

}  // namespace exactvo::vo
