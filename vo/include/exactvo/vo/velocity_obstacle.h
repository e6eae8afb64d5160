// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The velocity obstacle of a convex shape (paper, equations (7) and (9), corrected: 0 < t <= tau), truncated or, with
/// tau infinite, the whole cone; for a robot that is a disc or a convex polygon. One construction for every shape,
/// through the support function.
///
/// With S = (O - p) (+) D(0, r), or O - p plus the mirrored polygon of the robot, seen from the robot and 0 not in S,
///
///     VO = { v : t v in S for some 0 < t <= tau }  is convex, and  h_VO(n) = h_S(n) / tau where h_S(n) <= 0,
///     infinite elsewhere.
///
///              \     leg: h_S = 0    /
///               \                   /            Every n with h_S(n) <= 0 gives a half-plane
///                \    V O          /             { v : n.v >= h_S(n) / tau } disjoint from the interior of VO:
///                 \               /              a poor n is conservative, never unsafe.
///                  `--cut-off----'  S / tau
///                        |
///                        o  v = 0
///
/// Exact: `overlaps`, `contains`, `exact_legs`. Certified: `half_plane`, `legs` (bracket). Rounded: `nearest_boundary`,
/// `nearest`.
/// For a polygonal robot the last two kinds speak of `grown()`, a shape round S within `grown_error()` of it:
/// half-planes and inner normals of legs are as safe, and that much less tight. See also: family.h (RVO, HRVO, moving
/// obstacles), algebraic_direction.h (the exact legs), free_velocities.h (what many of them leave), reciprocal.h (robot
/// against robot), orca_obstacle.h (the baseline's polygon rule), lp/ (which velocity).
///
/// Properties (tests quote the numbers):
///  (1) `half_plane` of a static obstacle admits v = 0;
///  (2) a half-plane safe for this VO is safe for every VO inside it: a smaller radius, a shorter horizon;
///  (3) the cone grows with the robot's radius and with the horizon;
///  (4) turning a scene of discs, segments and polygons by 90 degrees turns the half-plane bit for bit, and so does
///      mirroring one of discs and segments (polygons change the order of their vertices, ellipses their L);
///  (5) a velocity that satisfies `half_plane` is not inside the velocity obstacle.

#include <memory>
#include <optional>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/support.h"
#include "exactvo/geometry/swept.h"
#include "exactvo/vo/algebraic_direction.h"

namespace exactvo::vo {

using geometry::HalfPlane;
using geometry::Vec2;

class VelocityObstacle;
namespace detail {
struct UnroundedInput;
UnroundedInput unrounded_input(const VelocityObstacle& obstacle);
}  // namespace detail

/// One side of the cone.
struct Leg {
  Vec2 normal;          ///< outward; certified: h_S(normal) <= 0, so { v : normal.v >= 0 } is safe
  Vec2 normal_outside;  ///< certified: h_S(normal_outside) > 0; the true leg's normal lies between the two
  Vec2 direction;       ///< of the ray along the leg, away from the robot; rounded, |direction| = 1
  Vec2 touch;           ///< m, the tangent point on S, rounded
};

/// Both sides of a cone.
struct Legs {
  Leg left;   ///< seen from the robot
  Leg right;  ///< seen from the robot
};

/// The parts of a velocity obstacle's boundary.
enum class BoundaryPart {
  left_leg,   ///< seen from the robot
  right_leg,  ///< seen from the robot
  cut_off,    ///< the shape divided by the horizon
  apex        ///< v = 0, of a cone that is not truncated
};
/// "left leg", "right leg", "cut-off", "apex".
const char* name(BoundaryPart part);

/// The boundary point of VO nearest to a velocity. Rounded.
struct NearestBoundary {
  Vec2 normal;                   ///< outward at that point, |normal| = 1 up to rounding
  double signed_distance = 0.0;  ///< m/s from v to the boundary: negative inside VO
  Vec2 u;                        ///< m/s, the least change of velocity that reaches the boundary (equation (10))
  BoundaryPart part = BoundaryPart::cut_off;  ///< on which part of the boundary it lies
};

/// The velocities of a robot that collide with one convex obstacle, at rest, within the horizon. Immutable.
class VelocityObstacle {
 public:
  /// `obstacle` and `robot_position` in metres, `robot_radius` >= 0 m, `time_horizon` > 0 s, may be infinite.
  /// REQUIRES: all else finite, the shape valid (geometry::is_valid).
  VelocityObstacle(geometry::ConvexShape obstacle, Vec2 robot_position, double robot_radius, double time_horizon);

  /// A robot that is a convex polygon, its vertices relative to `robot_position`. It does not turn.
  VelocityObstacle(geometry::ConvexShape obstacle, Vec2 robot_position, geometry::ConvexPolygon robot,
                   double time_horizon);

  /// S with its parts; for a polygonal robot a shape round S.
  const geometry::GrownShape& grown() const { return grown_; }
  /// m; how far `grown()` may reach beyond S: 0 for a disc.
  double grown_error() const { return polygonal_ ? polygonal_->error : 0.0; }
  /// s, as it was given.
  double time_horizon() const { return tau_; }

  /// Whether the robot touches or overlaps the obstacle: 0 in S. Then no cone exists. Exact.
  bool overlaps() const;

  /// Whether v collides within the horizon: the closed VO. Exact. REQUIRES: !overlaps().
  bool contains(Vec2 v) const;
  /// The same for the exact sum of some velocities: v relative to something that moves.
  bool contains_sum(const geometry::VectorSum& v) const;

  /// The outward normal of S at the point nearest the robot and the distance between the two (negative: the depth
  /// of an overlap), m. Rounded.
  struct Nearest {
    Vec2 normal;            ///< outward, |normal| = 1 up to rounding
    double distance = 0.0;  ///< m, negative in overlap
  };
  /// Rounded; in overlap the way out that is shortest.
  Nearest nearest() const;

  /// Both sides of the cone; nothing where the robot overlaps or is so near (a few ulps) that no bracket certifies.
  std::optional<Legs> legs() const;

  /// Both sides as algebraic numbers, of S itself also where the robot is a polygon; nothing where the robot overlaps.
  /// Exact; tens of microseconds a vertex.
  std::optional<ExactLegs> exact_legs() const;

  /// REQUIRES: !overlaps().
  NearestBoundary nearest_boundary(Vec2 v) const;

  /// Equation (10): { v' : n.v' >= n.(v + alpha u) }, alpha the responsibility. 1 is the full one, for a static
  /// obstacle: certified disjoint from the interior of VO. Less leaves the rest of u to the obstacle, and the offset is
  /// rounded to nearest: nothing is certified (reciprocal.h makes and certifies both halves of a pair). Nothing
  /// where no half-plane could be certified: overlap, or a few ulps from it. REQUIRES: 0 < responsibility <= 1, v
  /// finite.
  std::optional<HalfPlane> half_plane(Vec2 v, double responsibility = 1.0) const;

  /// { v' : n.v' >= 0 } away from the nearest point: for a robot in bare contact. Certified; nothing where the robot
  /// overlaps beyond proof. n is the rounded unit normal, or where only that is proven an exact normal of length
  /// sqrt(1/2) to sqrt(2).
  std::optional<HalfPlane> contact_half_plane() const;

 private:
  /// What `grown_` was rounded from, kept for the exact questions.
  struct Polygonal {
    geometry::ConvexShape obstacle;
    geometry::ConvexPolygon robot;
    double error;
  };

  friend detail::UnroundedInput detail::unrounded_input(const VelocityObstacle& obstacle);

  geometry::GrownShape grown_;
  double tau_;
  std::shared_ptr<const Polygonal> polygonal_;  ///< nothing for a disc
};

/// `VelocityObstacle::half_plane` with responsibility 1, for a shape that stands somewhere already: nothing is copied.
/// REQUIRES: `s` valid and finite, its radius >= 0, time_horizon > 0, v finite. Only the last two are checked.
std::optional<HalfPlane> half_plane(const geometry::GrownShape& s, double time_horizon, Vec2 v);

}  // namespace exactvo::vo
