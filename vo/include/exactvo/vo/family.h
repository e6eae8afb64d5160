// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The family: velocity obstacles of different papers for one encounter, as values.
///
///   VO    u + C(tau)              velocities that collide if the obstacle keeps u      Fiorini and Shiller 1998
///   RVO   (v + u)/2 + C(2 tau)    the obstacle does half: 2 v' - v lies in the VO      van den Berg, Lin, Manocha 2008
///   HRVO  apex + C(2 tau)         RVO's leg on the robot's own side, VO's on the other   Snape et al. 2011
///   ORCA  one half-plane          v + a share (least change), on the shape as it stands  van den Berg et al. 2011
///
/// u is the obstacle's velocity, v the robot's, v' the new velocity; C(tau) is the velocity obstacle of a robot and an
/// obstacle with relative velocity (velocity_obstacle.h). The three cones are one cone with different apices. A paper
/// without a horizon means an infinite one; RVO's and HRVO's are cut off at 2 tau here, since v' stands for twice its
/// offset.
///
/// Exact: `ShiftedCone::contains` for the apex that is stated; VO's and RVO's apices are exact sums, HRVO's is the
/// intersection of two legs, rounded. Certified: ORCA's half-plane with responsibility 1, against the obstacle that
/// keeps its velocity; with a smaller one only together with the obstacle's (see reciprocal.h, which gives both).
///
/// Properties (tests quote the numbers):
///  (1) VO, RVO and HRVO of an obstacle at rest as seen by a robot at rest have the apex 0;
///  (2) RVO's apex is the mean of the two velocities, exactly;
///  (3) v' lies in RVO iff 2 v' - v lies in VO, exactly;
///  (4) HRVO's apex lies on a leg of RVO and on the other leg of VO, to rounding;
///  (5) ORCA's offset is affine in `responsibility`: 0 leaves v allowed, 1 is VO's half-plane;
///  (6) moving everything by one velocity moves every member by it.

#include <optional>

#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo {

/// The members, in the order of the table above.
enum class Variant {
  vo,    ///< Fiorini and Shiller 1998
  rvo,   ///< van den Berg, Lin and Manocha 2008
  hrvo,  ///< Snape et al. 2011
  orca   ///< van den Berg et al. 2011
};

/// One robot and one obstacle, both with a velocity.
struct Encounter {
  geometry::ConvexShape obstacle;                ///< m, in the coordinates of the scene
  Vec2 obstacle_velocity;                        ///< m/s
  Vec2 position;                                 ///< m, of the robot
  Vec2 velocity;                                 ///< m/s, of the robot
  double radius = 0.0;                           ///< m, >= 0; ignored where the robot is a polygon
  std::optional<geometry::ConvexPolygon> robot;  ///< vertices relative to `position`; nothing for a disc
  double time_horizon = 3.0;                     ///< s, > 0, may be infinite
  double responsibility = 0.5;                   ///< in [0, 1]: how much of the change ORCA's robot takes
};

/// The velocity obstacle of the obstacle as the robot sees it, for relative velocities. REQUIRES: see its constructor.
VelocityObstacle cone_of(const Encounter& encounter);

/// { apex + w : w in C }: a velocity obstacle in absolute velocities.
struct ShiftedCone {
  VelocityObstacle cone;           ///< of relative velocities
  geometry::VectorSum minus_apex;  ///< v - apex is the sum of v and this
  Vec2 apex;                       ///< m/s, rounded, for people and pictures

  /// Exact. REQUIRES: !cone.overlaps().
  bool contains(Vec2 v) const;
};

/// What one author's rule allows the robot.
struct Member {
  Variant variant = Variant::vo;        ///< whose rule
  std::optional<ShiftedCone> cone;      ///< VO, RVO, HRVO: forbidden
  std::optional<HalfPlane> half_plane;  ///< ORCA: allowed
};

/// Neither cone nor half-plane where the robot touches or overlaps the obstacle. REQUIRES: see `cone_of`; velocities
/// finite; responsibility in [0, 1].
Member family_member(Variant variant, const Encounter& encounter);

/// The paper's horizon (equation (9)): distance to S over speed; infinite at rest, 0 in contact. Rounded.
double paper_time_horizon(const VelocityObstacle& obstacle, Vec2 velocity);

/// The same within 0.3 s and 3 s, so that it is a horizon for every robot: clamp(distance / max(speed, 0.5 m/s)):
/// slower robots look ahead as far as one of that speed. Rounded.
double clamped_time_horizon(const VelocityObstacle& obstacle, Vec2 velocity);

}  // namespace exactvo::vo
