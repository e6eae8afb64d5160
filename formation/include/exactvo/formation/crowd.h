// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Many robots, one step at a time: reciprocal collision avoidance (van den Berg, Guy, Lin, Manocha, "Reciprocal n-body
/// collision avoidance", 2011) for one robot or a million, every step certified.
///
/// Positions are whole multiples of a lattice step q (2^-18 m unless another is chosen), and so is what a robot moves
/// in a time step: p' = p + m is exact, and m q / dt is the velocity that was decided on. What is certified is what is
/// driven. "Float" and "double" name the arithmetic of half-planes and of the linear program only.
///
/// A step has two levels. The first makes half-planes against neighbours and obstacles, and asks a linear program for
/// the best velocity: the robot's *wish*. Half-planes between robots are relaxed there where they contradict each
/// other. The second turns wishes into motions that keep all robots apart, in integers; rest is always one
/// (hard_level.h).
///
/// Promises (tests quote the numbers). Let a robot be *kept* in a step if its velocity provably satisfies all its
/// half-planes, and let two robots *touch* if they are nearer than the sum R of their radii and a rounding error:
/// 40 u (|dx| + |dy| + R), u = 2^-24 (float) or 2^-53.
///  (1) Two robots that do not overlap at the beginning of a step do not overlap at any moment of it, kept or not, at
///  any
///      density (exact contact is no overlap). Exact, for `CrowdOptions::certified`; radii are rounded up to whole
///      lattice steps. Two robots that overlap by more than 8 lattice steps have no promise until they are apart;
///      a smaller overlap is the rounding of places and radii, and such two do not come nearer.
///  (2) Both robots of a pair use the same normal, one negated, bit for bit; their offsets add up to at least what the
///      pair needs.
///  (3) |velocity| <= max_speed, exactly.
///  (4) The same calls give the same bits, on every SIMD target and with any number of threads and of ranks.
///  (5) Every robot that could be met within the step is among the neighbours, however many they are.
///  (6) A crowd that was restored from a snapshot goes on with the same bits.
///  (7) A robot that no edge of an obstacle and no body at rest touches at the beginning of a step (nearer than the
///      radius and a rounding error) meets none in it, kept or not. Certified, for `CrowdOptions::certified`.
///  (8) No robot comes nearer to an edge or a body at rest that touches it, up to the same rounding error. Certified,
///  for
///      `CrowdOptions::certified`.
///  (9) A kept robot and a moving body that do not touch at the beginning of a step are apart at every moment of it; if
///      they touch, they do not overlap at its end. Certified, for `CrowdOptions::certified`.
///  (10) A robot on wheels drives a constant twist in a step, by which its wheels keep within their speed, their change
///      from the step before and the other limits of its kind. Exact: the audit proves it from where the robot headed
///      at first and from its places.
/// A robot that is not kept violates half-planes against other robots or moving bodies, since these contradict each
/// other
/// (`StepReport::relaxed`), since another robot would be met within the step (`StepReport::cut_short`), or since it
/// drives to a reserved place (`StepReport::reserved`). Which velocity is best is heuristic in its last digits.
///
/// Units are metres, seconds, metres per second. See also: vo/reciprocal.h is the rule for one pair in double.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/formation/ranks.h"
#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/shapes.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::formation {

namespace crowd {
class CrowdBody;
}

using geometry::Vec2;

/// Names a robot until it is removed; then it may be given to another. Small numbers: 0 ... id_end() - 1.
using RobotId = std::uint32_t;
/// Names a kind of robots: 0, 1, ... in the order of `add_kind`.
using KindId = std::uint16_t;
/// Names an obstacle until it is removed.
using ObstacleId = std::uint32_t;

/// Two wheels on an axle. What the crowd moves is the reference point of the robot, `reference` ahead of the axle's
/// centre; it can go in any direction, and the heading follows as a trailer follows its coupling. A robot on wheels
/// starts at rest and can always stop within a step. One that prefers to go straight back for ever stands in the end,
/// since its heading becomes too uncertain (ADR 0022). Prefer a direction that differs by a degree.
struct CrowdWheels {
  double reference = 0.0;         ///< m, at least max_speed times the time step and a sixteenth of the separation
  double wheel_separation = 0.0;  ///< m, > 0
  /// m/s^2, at least the kind's max_speed divided by the time step: a wheel can stop within a step.
  double max_wheel_acceleration = geometry::kInfinity;
  double max_angular_speed = geometry::kInfinity;   ///< rad/s, at least 2^-20 in a time step
  double max_backward_speed = geometry::kInfinity;  ///< m/s, >= 0, of the axle's centre
};

/// Half of a heading (degrees; 0 along x, 90 along y) as a vector of any length: a crowd takes the heading of a robot
/// on wheels to be exactly twice the angle of this vector. Exact for quarter turns, else the heading is within 2^-50
/// rad of the degrees; the same bits everywhere.
Vec2 half_heading_of(double degrees);

/// What robots of a kind have in common.
struct CrowdKind {
  /// m, > 0. On wheels: of a disc about the reference point that holds the body at every heading, and `stray_of`
  /// (scenario.h), by which the reference point strays from its chord.
  double radius = 0.5;
  double max_speed = 1.5;            ///< m/s, at least 16 lattice steps and at most 2^22 of them a time step
  double time_horizon = 5.0;         ///< s, at least the time step; a pair uses the shorter one of its two
  double neighbour_distance = 15.0;  ///< m, > 0; at least the distance within which two robots can meet in a step
  int neighbours = 10;               ///< 1 ... 15: the nearest within the distance, and all that could be met, (5)
  double edge_horizon = 0.0;         ///< s, of edges and bodies at rest: at least the time step; 0: time_horizon
  std::optional<CrowdWheels> wheels = {};  ///< none: the velocity may jump. Else max_speed is that of a wheel
};

/// The arithmetic of half-planes and linear programs.
enum class CrowdPrecision {
  float_lines,  ///< "float": offsets are rounded up by about 1e-6 m/s
  double_lines  ///< "double": by about 1e-15 m/s
};

/// "float", "double".
const char* name(CrowdPrecision precision);
/// False for an unknown name; `out` is then unchanged.
bool parse(const std::string& text, CrowdPrecision& out);

/// What holds for a whole crowd.
struct CrowdOptions {
  double time_step = 0.25;         ///< s, > 0
  double position_step = 0x1p-18;  ///< m, q: a power of two in [2^-40, 1]; positions stay below 2^30 q
  CrowdPrecision precision = CrowdPrecision::float_lines;  ///< of half-planes and linear programs
  bool certified = true;     ///< false: offsets are rounded to nearest and nothing is promised; for comparison
  int threads = 1;           ///< 1 ... 1024, oneTBB's; 0: as many as there are
  bool time_phases = false;  ///< fills Crowd::phases
  /// The processes that step the same crowd together with this one (ranks.h): `step` decides for a share of the robots,
  /// and then all ranks have all decisions. Lives as long as the crowd. Null: none. Whatever `step` throws, it calls
  /// `Ranks::fail`.
  Ranks* ranks = nullptr;
};

/// What is wrong with an argument, and with which robot.
enum class CrowdProblem {
  not_finite,        ///< a number is NaN or infinite
  out_of_range,      ///< a number is outside the range that its field states
  beyond_lattice,    ///< a position at or beyond 2^30 q
  coincident,        ///< two robots in one place, one of them new
  too_many,          ///< more than 2^30 robots, 2^14 kinds, 2^24 edges and corners of bodies
  unknown_robot,     ///< no robot has this id
  unknown_kind,      ///< no kind has this number
  unknown_obstacle,  ///< no obstacle has this id
  wrong_count,       ///< an array is shorter than id_end()
  bad_snapshot       ///< not a snapshot, cut off, or changed
};

/// "not-finite", "out-of-range" and so on.
const char* name(CrowdProblem problem);

/// A caller's mistake; the crowd is as it was before the call.
class CrowdError : public std::invalid_argument {
 public:
  /// `words` is what `what()` returns.
  CrowdError(CrowdProblem problem, const std::string& words) : std::invalid_argument(words), problem_(problem) {}
  /// What is wrong.
  CrowdProblem problem() const { return problem_; }

 private:
  CrowdProblem problem_;
};

/// What happened in a step. Every count is the same on every machine and with any number of threads and of ranks.
struct StepReport {
  std::size_t robots = 0;      ///< how many decided
  std::size_t neighbours = 0;  ///< half-planes made
  std::size_t relaxed = 0;     ///< robots whose wish violates half-planes, as little as possible up to rounding
  std::size_t touching = 0;    ///< robots that touched another at the beginning of the step
  std::size_t widened = 0;     ///< robots with more in reach of the step than their kind's neighbours: took more, (5)
  std::size_t edges = 0;       ///< half-planes made against edges of obstacles
  std::size_t bodies = 0;      ///< half-planes made against bodies, at rest and in motion
  std::size_t stopped = 0;     ///< robots that stay, since edges, bodies and wheels allow nothing else that was tried
  std::size_t nudged = 0;      ///< kept robots whose velocity had to be rounded to another place of the lattice
  std::size_t overlapping =
      0;  ///< robots that overlapped another by more than 8 lattice steps at the beginning of the step
  std::size_t reserved = 0;   ///< robots that drive straight to a reserved place
  std::size_t cut_short = 0;  ///< robots that do not get their wish, since they would meet another within the step
};

/// Seconds of threads in each phase, summed over the steps; only with CrowdOptions::time_phases.
struct CrowdPhases {
  double sort = 0.0;    ///< robots by place
  double search = 0.0;  ///< neighbours
  double lines = 0.0;   ///< half-planes between robots
  double edges = 0.0;   ///< half-planes against obstacles and bodies
  double solve = 0.0;   ///< linear programs
  double hard = 0.0;    ///< the second level: wishes into motions that keep robots apart
  double finish = 0.0;  ///< rounding to the lattice, moving
};

/// A range of robots whose preferred velocities are asked for. Positions and velocities are exact.
class CrowdSlice {
 public:
  /// How many robots it holds.
  std::size_t size() const { return count_; }
  /// The name of robot k of the slice. REQUIRES, as the others: k < size().
  RobotId id(std::size_t k) const { return static_cast<RobotId>(id_[k]); }
  /// The kind of robot k.
  KindId kind(std::size_t k) const { return static_cast<KindId>(tag_[k] & kKindBits); }
  /// m.
  Vec2 position(std::size_t k) const { return {step_ * x_[k], step_ * y_[k]}; }
  /// m/s.
  Vec2 velocity(std::size_t k) const { return {step_ * mx_[k] / time_step_, step_ * my_[k] / time_step_}; }
  /// m/s, finite, below 2^20. What is not set is 0.
  void prefer(std::size_t k, Vec2 velocity) { preferred_[k] = velocity; }

 private:
  template <class T>
  friend class CrowdEngine;
  static constexpr std::uint16_t kKindBits = 0x3FFF;
  std::size_t count_ = 0;
  const std::int32_t *id_ = nullptr, *x_ = nullptr, *y_ = nullptr, *mx_ = nullptr, *my_ = nullptr;
  const std::uint16_t* tag_ = nullptr;
  double step_ = 0.0, time_step_ = 0.0;
  Vec2* preferred_ = nullptr;
};

/// A body where it was added, and how far it has come.
struct CrowdBodyState {
  ObstacleId id = 0;            ///< what `add_body` or `add_moving_body` returned
  geometry::ConvexShape shape;  ///< m, where it was added
  bool moves = false;           ///< by `add_moving_body`
  Vec2 displacement;            ///< m, from there, exact
  Vec2 velocity;                ///< m/s, of the whole lattice steps that it goes
};

/// Called from several threads at once where there are several; what it sets for a robot must not depend on the slice.
/// With several ranks, each rank calls its own function for its share of the robots.
using Steering = std::function<void(CrowdSlice&)>;

/// One robot's next decision, recomputed from the present state.
struct CrowdExplanation {
  /// A half-plane against another robot.
  struct Neighbour {
    RobotId robot = 0;               ///< the other one
    geometry::HalfPlane half_plane;  ///< of the velocity; what is certified
    bool touching = false;           ///< they touch
  };
  /// A half-plane against an edge of an obstacle.
  struct Edge {
    geometry::Segment edge;          ///< m, the edge
    geometry::HalfPlane half_plane;  ///< of the velocity; what is certified
    bool touching = false;           ///< nothing is promised of this edge
  };
  /// A half-plane against a body.
  struct Body {
    ObstacleId body = 0;             ///< which
    geometry::HalfPlane half_plane;  ///< of the velocity; what is certified
    bool touching = false;           ///< what is promised of this body is (8), or the second half of (9)
  };
  RobotId robot = 0;  ///< the one asked about
  Vec2 position;      ///< m, exact
  Vec2 velocity;      ///< m/s, now
  Vec2 preferred;     ///< m/s, as it was rounded for the linear program
  Vec2 wish;          ///< m/s, the answer to the half-planes below: m q / dt
  Vec2 chosen;        ///< m/s, what `step` will choose, m q / dt: the wish, unless another would be met within the step
  bool kept = false;  ///< its velocity will provably satisfy all its half-planes
  /// More robots are in reach of the step than its kind's neighbours: all of them are listed, (5)
  bool widened = false;
  /// It drives straight to a place that it has reserved: half-planes against other robots do not turn it.
  bool reserved = false;
  std::size_t ways = 0;  ///< half-planes, not listed, that keep it out of the ways of others to their reserved places
  std::vector<Neighbour> neighbours;        ///< nearest first
  std::vector<Edge> edges;                  ///< nearest first, without those that an earlier half-plane excludes
  std::vector<geometry::HalfPlane> wheels;  ///< of the velocity: what its wheels allow
  std::vector<Body> bodies;                 ///< those at rest first, each kind in the order in which they were added
};

/// The robots, the obstacles and the time step. Not to be called from two threads at once. What a caller gets wrong is
/// a CrowdError, and the crowd stays as it was.
class Crowd {
 public:
  /// Without robots, kinds or obstacles. Throws CrowdError for options out of range.
  explicit Crowd(const CrowdOptions& options = {});
  ~Crowd();
  /// Moves; the object moved from can only be assigned to or destroyed.
  Crowd(Crowd&&) noexcept;
  /// Moves; the object moved from can only be assigned to or destroyed.
  Crowd& operator=(Crowd&&) noexcept;

  /// Numbered from 0. Throws CrowdError: `out_of_range`, `too_many`.
  KindId add_kind(const CrowdKind& kind);
  /// At the place of the lattice nearest to `position`, at the velocity of the lattice that is nearest among those
  /// within the kind's speed limit. |velocity| <= max_speed. O(1); two robots in one place are found by `step`.
  RobotId add_robot(Vec2 position, KindId kind = 0, Vec2 velocity = {});
  /// Reserves memory for this many robots, for callers that know their number.
  void reserve(std::size_t robots);
  /// Where a robot on wheels heads, degrees; after `add_robot` it heads along x. It is at rest then. Throws CrowdError:
  /// `unknown_robot`, `not_finite`, `out_of_range` where the robot has no wheels or moves.
  void set_heading(RobotId robot, double degrees);
  /// O(1), but O(n) the first time after a step.
  void remove_robot(RobotId robot);

  /// Its edges are walls, seen from both sides; whether a robot stands inside is not checked. Coordinates below 2^40 m.
  /// The grid of edges is laid out anew before the next step, in O(edges).
  ObstacleId add_obstacle(const geometry::Obstacle& obstacle);
  /// A solid body that stands still: a disc, a segment, a convex polygon, an ellipse. Coordinates below 2^40 m. Robots
  /// keep off it as off edges, and one that starts inside is led out by the shortest way that it finds. Bodies are laid
  /// out anew before the next step, in O(bodies).
  ObstacleId add_body(const geometry::ConvexShape& shape);
  /// A solid body that moves, without turning: robots take the whole responsibility, (9). It goes the nearest
  /// whole number of lattice steps in a time step, whatever is in its way, until `set_body_velocity`. Velocity in m/s,
  /// at most 2^15 and 2^22 lattice steps a time step.
  ObstacleId add_moving_body(const geometry::ConvexShape& shape, Vec2 velocity);
  /// From the next step on, limits as of `add_moving_body`. Throws CrowdError: `unknown_obstacle` where none that moves
  /// has this id.
  void set_body_velocity(ObstacleId body, Vec2 velocity);
  /// m/s, of the whole lattice steps that it goes; 0 at rest. Throws where there is none of this id.
  Vec2 body_velocity(ObstacleId body) const;
  /// m: how far a body has come from where it was added, exact. Throws where there is none of this id.
  Vec2 body_displacement(ObstacleId body) const;
  /// All bodies, in the order in which they were added.
  std::vector<CrowdBodyState> bodies() const;
  /// An obstacle's edges, or a body, are gone from the next step on. O(edges) or O(bodies) before that step.
  void remove_obstacle(ObstacleId obstacle);

  /// How many robots there are.
  std::size_t size() const;
  /// Above every id: arrays by id have this length. Entries of ids that name no robot are neither read nor written.
  std::size_t id_end() const;
  /// The options of the constructor.
  const CrowdOptions& options() const;
  /// The kind as it was added.
  const CrowdKind& kind(KindId kind) const;

  /// m/s, by id; they stay until they are set again. New robots prefer 0. Takes the place of a steering function.
  void set_preferred(const std::vector<Vec2>& by_id);
  /// Called at every step from now on. Not part of a snapshot.
  void set_steering(Steering steering);
  /// Places (m) that robots have reserved, by id, until they are set again; `reserved`: 0 of robots without one. A
  /// robot with a reservation drives straight in the direction that it prefers: half-planes against other robots do not
  /// turn it, the second level of the step slows it down. It keeps off edges and bodies at rest, but does not evade
  /// moving bodies. Other robots keep out of its way to the place where they can. New robots have no reservation.
  /// Throws CrowdError: `wrong_count`, `not_finite`.
  void set_reservations(const std::vector<Vec2>& place, const std::vector<std::uint8_t>& reserved);

  /// Decides for all robots and moves them. Throws CrowdError where a robot would leave the lattice, where two are in
  /// one place and one of them is new, or where the steering function prefers what is not finite or too large;
  /// exceptions of the function itself are passed on. The robots are then as they were before.
  StepReport step();

  /// m, exact, by id; grows the array to id_end().
  void positions(std::vector<Vec2>& by_id) const;
  /// m/s, m q / dt, by id: exact where q / dt is a power of two, else the nearest double.
  void velocities(std::vector<Vec2>& by_id) const;
  /// 1: the robot was kept in the last step. 0: it was not, or is new.
  void kept(std::vector<std::uint8_t>& by_id) const;
  /// 1: another robot could have been met within the last step. REQUIRES: called after `step`, before robots are added
  /// or removed and before `snapshot` or `explain`; not part of a snapshot.
  void met(std::vector<std::uint8_t>& by_id) const;
  /// m, exact.
  Vec2 position(RobotId robot) const;
  /// m/s, m q / dt.
  Vec2 velocity(RobotId robot) const;
  /// Where a robot on wheels heads: a unit vector, within 2^-23 of the exact one. REQUIRES: it has wheels.
  Vec2 heading(RobotId robot) const;
  /// m/s, of the left and the right wheel in the last step, up to 2^-17 of max_speed. REQUIRES: it has wheels.
  Vec2 wheel_speeds(RobotId robot) const;
  /// The number that `add_robot` was given.
  KindId kind_of(RobotId robot) const;

  /// Recomputed, with the same bits that `step` would choose. Throws what `step` would throw.
  CrowdExplanation explain(RobotId robot) const;

  /// Everything but the steering function, in a binary form of this version. Throws std::ios_base::failure where the
  /// stream fails.
  void snapshot(std::ostream& to) const;
  /// Uses these threads (CrowdOptions::threads) and ranks, whatever the saved crowd used.
  static Crowd restored(std::istream& from, int threads = 1, Ranks* ranks = nullptr);

  /// A digest of positions, motions and kinds by id, and of moving bodies, for comparing runs.
  std::uint64_t digest() const;
  /// Memory that grows with the robots.
  std::size_t bytes() const;
  /// Where the time went, if CrowdOptions::time_phases asks for it; else all 0.
  const CrowdPhases& phases() const;

 private:
  explicit Crowd(std::unique_ptr<crowd::CrowdBody> body);
  std::unique_ptr<crowd::CrowdBody> body_;
};

/// The name of the SIMD target in use ("AVX3", "AVX2", "SSE4", ...).
const char* crowd_target();

}  // namespace exactvo::formation
