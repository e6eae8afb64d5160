// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact verdicts in continuous time: whether two bodies in motion, or a body in motion and an obstacle, overlap at any
/// moment, and not only at sampled ones.
///
/// Doubles in, exact inside. Each verdict is decided by a filter in doubles with a running error bound and, where the
/// filter is undecided, in exact arithmetic; `stage_counts` (predicates.h) counts both. Moments and clearances are
/// enclosed: every bound is itself the answer to an exact question.
///
/// Bodies keep their heading. A body at a moment is a closed set. Two bodies *overlap* where their interiors meet; they
/// are in *contact* where they only touch. Two sets without an interior (two points, a point and a wall) count as discs
/// of vanishing radius: they overlap wherever they meet.
///
/// Properties (tests quote the numbers):
///  (1) encounter(a, A, b, B) == encounter(b, B, a, A);
///  (2) scaling all lengths, or all times, by a power of two does not change the verdict;
///  (3) a larger radius never makes the verdict clearer;
///  (4) the verdict over a span of time is the worst of the verdicts over its parts;
///  (5) clearance.high < 0 only for `overlap`, clearance.low > 0 only for `clear`, and `contact` has clearance [0, 0].
///
/// See also: motion_check.h (many trajectories, a map), motion_certificate.h (proofs of `clear`), swept.h (straight
/// motions without times).

#include <variant>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// Where something is at a moment.
struct TimedPoint {
  double time = 0.0;  ///< s
  Vec2 at;            ///< m
};

/// Uniform and straight from one timed point to the other. With equal times the whole way counts, as in the limit of
/// an ever shorter duration. Two such motions at one moment go at the same pace.
struct StraightMotion {
  TimedPoint from;  ///< the start
  TimedPoint to;    ///< the end, to.time >= from.time
};

/// At rest from a timed point on, until a time (the way in which data that is held between samples moves).
StraightMotion held(TimedPoint from, double until);

/// How the points of a CurvedMotion are meant.
enum class CurveBasis : int {
  powers = 0,   ///< p(t) = sum of points[k] (t - start)^k; m, m/s, m/s^2, ...
  bezier = 1,   ///< Bezier control points over [start, end]
  b_spline = 2  ///< control points of a uniform B-spline of degree d: its piece over one knot interval, [start, end]
};

/// The largest degree of a CurvedMotion.
inline constexpr std::size_t kMostDegree = 10;

/// One polynomial piece of a motion. Its degree is the number of its points less one.
struct CurvedMotion {
  CurveBasis basis = CurveBasis::bezier;  ///< of `points`
  double start = 0.0;                     ///< s
  double end = 0.0;                       ///< s, >= start
  std::vector<Vec2> points;               ///< 1 to kMostDegree + 1
};

/// The pieces of a uniform B-spline: piece k has the control points k to k + degree and lasts from the rounded
/// start + k interval to the rounded start + (k + 1) interval. Each piece is exact between these two doubles.
/// REQUIRES: degree <= kMostDegree, more control points than `degree`, interval > 0, finite numbers.
std::vector<CurvedMotion> b_spline_pieces(const std::vector<Vec2>& control_points, std::size_t degree, double start,
                                          double interval);

/// The cubic with these places and velocities at its ends (Hermite's), as a Bezier curve. Its ends are exact, its two
/// inner control points are rounded: to.time - from.time is multiplied by a third of a velocity, m/s.
/// REQUIRES: finite numbers, to.time >= from.time.
CurvedMotion hermite_cubic(const TimedPoint& from, Vec2 velocity, const TimedPoint& to, Vec2 end_velocity);

/// The velocity (m/s) that a Catmull-Rom spline over timed points has at the one between these two: the way from one to
/// the other over the time; 0 where that is beyond all doubles. Rounded. REQUIRES: after.time > before.time.
Vec2 catmull_rom_velocity(const TimedPoint& before, const TimedPoint& after);

/// A motion of a body's reference point.
using Motion = std::variant<StraightMotion, CurvedMotion>;

/// When it begins, s.
double start_of(const Motion& motion);
/// When it ends, s.
double end_of(const Motion& motion);
/// Where it is at a time. Rounded. REQUIRES: start_of(motion) <= time <= end_of(motion).
Vec2 position_at(const Motion& motion, double time);

/// The convex hull of `corners`, grown by `radius`: a disc (one corner), a capsule (two), a convex polygon.
struct RoundedPolygon {
  std::vector<Vec2> corners{{0.0, 0.0}};  ///< m, from the body's reference point; in any order, at least one
  double radius = 0.0;                    ///< m, >= 0
};

/// A rigid body: the union of its parts. Parts of one corner each are a chain of discs.
using RigidBody = std::vector<RoundedPolygon>;

/// A disc round the reference point. REQUIRES: radius >= 0, finite.
RigidBody disc_body(double radius);
/// A polygon without holes, as its convex pieces. Exact. REQUIRES: valid (validity.h), no holes.
RigidBody polygon_body(const Polygon& outline);
/// The body turned counter-clockwise round its reference point, by an angle in rad. Corners are rounded.
RigidBody turned_body(RigidBody body, double angle);

/// How two bodies in motion fare.
enum class Encounter : int {
  clear = 0,    ///< they never touch
  contact = 1,  ///< they touch and never overlap
  overlap = 2   ///< they overlap at some moment
};

/// A lower and an upper bound of a number.
struct Bounds {
  double low = 0.0;   ///< no more than the number
  double high = 0.0;  ///< no less than the number
};

/// The answer in full.
struct MotionVerdict {
  Encounter encounter = Encounter::clear;  ///< exact
  /// m, certified: the least distance over time, less both radii; its negative is the greatest depth. The distance of
  /// two sets (corners, obstacles) that overlap counts as 0, so no depth exceeds the sum of the radii. Infinite where
  /// the two have no moment in common.
  Bounds clearance;
  Bounds first;               ///< s, certified: the first moment of overlap, or of contact (an infimum); 0 if clear
  Bounds last;                ///< s, certified: the last moment of overlap, or of contact (a supremum); 0 if clear
  double nearest_time = 0.0;  ///< s, rounded: a moment of least clearance
  Vec2 place;                 ///< m, rounded: where the two are nearest, or deepest, at that moment
};

/// Whether two bodies overlap at a moment that both motions have; `clear` where there is none. Exact.
/// REQUIRES: finite numbers, times that do not fall, degrees up to kMostDegree, bodies with at least one part, whose
/// parts have at least one corner and radius >= 0; a part of two or more corners on one line has radius > 0.
Encounter encounter(const Motion& a, const RigidBody& body_a, const Motion& b, const RigidBody& body_b);
/// Whether a body overlaps an obstacle at any moment of its motion. A polygon is an obstacle with its inside. Exact.
/// REQUIRES: as above, and a valid obstacle (validity.h; finite vertices are checked, the rest is not).
Encounter encounter(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle);

/// The same with moments, clearance and place.
MotionVerdict examine(const Motion& a, const RigidBody& body_a, const Motion& b, const RigidBody& body_b);
/// The same with moments, clearance and place.
MotionVerdict examine(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle);

}  // namespace exactvo::geometry
