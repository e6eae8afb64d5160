// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// From a body to a half-plane of the velocities that keep clear of it: the one sequence that obstacles, moving
/// obstacles and robots go through, each with its policy.
///
///     margin     room to spare: the half-plane nearest the present velocity, for a robot grown by `room`;
///     restore    the room is used up: part so fast that it is restored within `restore_within` (robots only);
///     contact    bare contact: the half-plane through v = 0 away from the nearest point;
///     push-out   overlap: nothing can be proven; the half-plane leads the robot out.
///
/// Certified where `proof` says so. Bodies have numbers: a constraint, a recording and an audit name the body by its
/// number, and its shape is not copied. See also: velocity_obstacle.h (one velocity obstacle by itself), reciprocal.h
/// (the halves of a pair of robots), orca_obstacle.h (the baseline's rule for edges), lp/ (the best velocity).

#include <cstddef>
#include <deque>
#include <limits>
#include <vector>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/support.h"
#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo {

/// What a body stands for.
enum class BodyKind {
  enclosure,       ///< one or several obstacles: an ellipse round them, a convex piece or a facade of one
  obstacle_edge,   ///< an edge of an obstacle
  robot,           ///< another robot, a disc
  moving_obstacle  ///< the convex hull of a moving obstacle
};

/// A convex set to keep clear of.
struct Body {
  BodyKind kind = BodyKind::enclosure;  ///< what it stands for
  geometry::ConvexShape shape;          ///< m; a robot or moving obstacle as it stands at present
  Vec2 velocity;                        ///< m/s, at present; 0 for what stands still
  /// Which obstacles of the scene it stands for, ascending; the one robot or moving obstacle it is.
  std::vector<std::size_t> owners;
};

/// The bodies of a run, by number.
class BodyTable {
 public:
  /// Names a body: 0, 1, ... in the order of `add`.
  using Number = std::size_t;

  /// REQUIRES: a valid shape (geometry::is_valid).
  Number add(Body body);
  /// Another shape and velocity for a body that moves. Allocates nothing for a shape of the kind that it had, with no
  /// more vertices. REQUIRES: a valid shape.
  void move(Number body, const geometry::ConvexShape& shape, Vec2 velocity);

  /// How many bodies there are.
  std::size_t size() const { return entries_.size(); }
  /// The body of that number. REQUIRES: body < size().
  const Body& operator[](Number body) const { return entries_[body].body; }
  /// Its `geometry::box_of`.
  const geometry::Box& box(Number body) const { return entries_[body].box; }

  /// The body grown by a robot and seen from it, without a copy. The reference stays valid, also after `add`; what it
  /// refers to changes with the next call for this body.
  geometry::GrownShape& seen(Number body, Vec2 position, double radius) {
    geometry::GrownShape& s = entries_[body].seen;
    s.origin = position;
    s.radius = radius;
    return s;
  }

 private:
  struct Entry {
    Body body;
    geometry::Box box;
    geometry::GrownShape seen;  ///< the shape again, with the origin and radius of the last robot that asked
  };
  std::deque<Entry> entries_;  ///< references to entries outlast `add`
};

/// What is certain of a half-plane, for the robot as it is and the body's present velocity.
enum class Proof {
  none,   ///< overlap: nothing can be promised
  alone,  ///< disjoint from the body's velocity obstacle
  pair    ///< so are two velocities of which each keeps its half (reciprocal.h)
};

/// A half-plane and where it comes from.
struct Constraint {
  HalfPlane half_plane;                        ///< of velocities that keep clear
  BodyTable::Number body = 0;                  ///< which body it keeps clear of
  lp::Priority priority = lp::Priority::hard;  ///< whether it may give
  Proof proof = Proof::none;                   ///< what is certain of it
  double clearance = 0.0;                      ///< m, robot's rim to the body; negative in overlap. Rounded
  Vec2 normal;                                 ///< unit, from the body's nearest point to the robot. Rounded
  double time_horizon = 0.0;                   ///< s
};

/// How a robot keeps clear of a body.
struct ClearancePolicy {
  double time_horizon = 2.0;    ///< s, > 0
  double room = 0.0;            ///< m, >= 0, kept in addition to the radii while there is room
  double restore_within = 0.0;  ///< s; > 0: used-up room is restored within this time; 0: bare contact is enough
  double push_out_time = 0.2;   ///< s, > 0: in overlap the half-plane leads the robot out within this time
  double push_out_speed = std::numeric_limits<double>::infinity();  ///< m/s, at this speed at most
};

/// A half-plane with its proof.
struct ProvenHalfPlane {
  HalfPlane half_plane;       ///< of velocities that keep clear
  Proof proof = Proof::none;  ///< what is certain of it
};

/// The robot's rim to the body, and the normal there. Rounded.
VelocityObstacle::Nearest clearance_of(const geometry::GrownShape& seen);

/// The sequence above, for the velocity of the robot relative to the body; the half-plane is of relative velocities.
/// `seen` is the body grown by the bare robot, and is so again afterwards; `nearest` its `clearance_of`. Nothing is
/// copied or allocated. REQUIRES: a valid shape, finite numbers, a sensible policy.
ProvenHalfPlane half_plane_against(geometry::GrownShape& seen, const VelocityObstacle::Nearest& nearest, Vec2 velocity,
                                   const ClearancePolicy& policy);

/// Its last two steps alone: contact, else push-out.
ProvenHalfPlane contact_or_push_out(const geometry::GrownShape& seen, const VelocityObstacle::Nearest& nearest,
                                    const ClearancePolicy& policy);

/// { v : n.(v - u) >= c } as { v : n.v >= c' }, c' rounded up. Certified if h is; h itself if u is 0.
HalfPlane shifted_by(const HalfPlane& h, Vec2 u);

}  // namespace exactvo::vo
