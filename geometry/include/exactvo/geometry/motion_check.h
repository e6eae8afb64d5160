// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Finds contacts and overlaps over all time: many bodies on trajectories, with each other and with a map.
///
/// A sweep in time goes over the pieces of motion, and a grid finds those that are near each other at the same time.
/// The cost grows as n log n with the number of pieces n, and with the pairs that are near; memory grows with the
/// pieces that are under way at a time. Every verdict is exact (motions.h). Bodies may turn: verdicts on those that do
/// are certified (turning_pairs.h).
///
/// See also: motions.h (one pair), turning_pairs.h (one pair of which one turns).

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "exactvo/geometry/motions.h"
#include "exactvo/geometry/turning_motions.h"

namespace exactvo::geometry {

/// A body whose reference point is at these points at these times.
struct Trajectory {
  std::vector<TimedPoint> points;   ///< at least one; times do not decrease
  RigidBody body = disc_body(0.0);  ///< as motions.h requires
  /// m/s, at each point, for `Between::cubic`. Empty: Catmull-Rom velocities, and at both ends that of the chord.
  std::vector<Vec2> velocities{};
};

/// Where a body is between two timed points.
enum class Between : int {
  straight = 0,  ///< uniform and straight from one to the next
  hold = 1,      ///< at the first, until the time of the next, when it is at the next one only
  cubic = 2,     ///< `hermite_cubic` from one to the next
  none = 3       ///< nowhere: only the timed points count
};

/// How a body is turned during a piece of motion.
struct Turned {
  double from = 0.0;  ///< rad, counter-clockwise, at the start: from how the body was given
  /// rad, over the whole piece, at most half a turn either way. If it is not 0, the body goes evenly along the arc of a
  /// constant twist to the end of a straight piece (`twist_between`, rounded), not straight.
  double by = 0.0;
};

/// Two pieces of motion, or one and an obstacle, whose boxes meet at the same time.
struct MetPair {
  std::size_t body = 0;        ///< the body's number; the lower one if both are bodies
  Motion motion;               ///< of `body`
  bool with_obstacle = false;  ///< whether `other` is an obstacle
  std::size_t other = 0;       ///< number of the other body, or of the obstacle
  Motion other_motion;         ///< the other body's; for a disc obstacle a motion at rest
  Turned turned;               ///< of `body`
  Turned other_turned;         ///< of the other body
};

/// Options of a check.
struct MotionCheckOptions {
  Between between = Between::straight;  ///< how to join timed points; with `hold` a lasting piece lacks its last moment
  double near = 0.0;                    ///< m, >= 0: approaches nearer than this are listed
  /// Called for each pair whose boxes, each grown by half of `near`, meet: a proof must cover these pairs. Each piece
  /// names an obstacle once. May be empty.
  std::function<void(const MetPair&)> met{};
  /// One entry for each obstacle, or empty. If an entry is set, the obstacle is this disc, with its interior, and the
  /// check ignores the obstacle's shape.
  std::vector<std::optional<Disc>> discs{};
};

/// Two bodies, or a body and an obstacle, that touch or overlap for a while without a break.
struct MotionEvent {
  Encounter encounter = Encounter::overlap;  ///< contact or overlap
  std::size_t body = 0;                      ///< number of the trajectory; the lower one of two
  bool with_obstacle = false;                ///< whether `other` is an obstacle
  std::size_t other = 0;                     ///< number of the other trajectory, or of the obstacle
  Bounds first;                              ///< s, certified: its first moment
  Bounds last;                               ///< s, certified: its last moment
  Bounds clearance;                          ///< m, certified: the least; its negative is the greatest depth
  double nearest_time = 0.0;                 ///< s, rounded: a moment of least clearance
  Vec2 place;                                ///< m, rounded: where, at that moment
  Vec2 at;                                   ///< m, rounded: the body's reference point at that moment
  Vec2 other_at;                             ///< m, rounded: the other body's; (0, 0) for an obstacle
  double turned = 0.0;                       ///< rad, rounded: how the body is turned at that moment
  double other_turned = 0.0;                 ///< rad, rounded: how the other body is
  /// Undecided: two bodies, of which one turns, come nearer than clearance.high and may overlap. They touch for certain
  /// if clearance.high is 0. The encounter is `contact`.
  bool is_open = false;
};

/// Two bodies, or a body and an obstacle, that come nearer to each other than `near`, over all time.
struct Approach {
  std::size_t body = 0;        ///< number of a trajectory
  bool with_obstacle = false;  ///< whether `other` is an obstacle
  std::size_t other = 0;       ///< number of the other trajectory, above `body`, or of the obstacle
  Bounds clearance;            ///< m, certified: the least; below 0 where they overlap
  double nearest_time = 0.0;   ///< s, rounded: a moment of least clearance
  Vec2 place;                  ///< m, rounded: where, at that moment
};

/// The counts of a check, and the approaches that it found.
struct MotionCheck {
  std::size_t pieces = 0;            ///< pieces of motion
  std::size_t pairs = 0;             ///< pairs of pieces whose boxes meet at the same time
  std::size_t edge_pairs = 0;        ///< pairs of a piece and an edge or disc of the map, whose boxes meet
  std::size_t examined = 0;          ///< pairs of both kinds that the quick filter could not clear
  std::size_t overlaps = 0;          ///< events
  std::size_t contacts = 0;          ///< events
  std::size_t open = 0;              ///< events of bodies that turn: whether they overlap is not known
  std::size_t most_held = 0;         ///< pieces in memory at a time
  std::vector<Approach> approaches;  ///< by body, bodies before obstacles, then by other; empty for `near` 0
};

/// Takes pieces of motion one after the other, by the time at which they begin. Keeps those that are under way.
class MotionStream {
 public:
  /// `options.between` matters only if it is `hold`, since the caller gives pieces. `map` must outlive the stream.
  MotionStream(const std::vector<Obstacle>& map, MotionCheckOptions options,
               std::function<void(const MotionEvent&)> report);
  ~MotionStream();
  MotionStream(const MotionStream&) = delete;
  MotionStream& operator=(const MotionStream&) = delete;

  /// Returns the body's number: 0, 1, ... REQUIRES: a body as motions.h requires.
  std::size_t add_body(RigidBody body);
  /// REQUIRES: a number from `add_body`; finite numbers; a duration >= 0; pieces in the order of their beginnings; a
  /// body's piece begins no earlier than its previous piece ends; only straight pieces that last may turn, and then no
  /// piece of any body is curved, or a move of zero duration. Discs round the reference point are taken not to
  /// turn.
  void add(std::size_t body, const Motion& piece, const Turned& turned = {});
  /// Reports the events that are still open. REQUIRES: called once, last.
  MotionCheck finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reports every contact and overlap, in the order in which they end (ties by bodies). Two events of a pair whose
/// moments may be the same are one. Exact. REQUIRES: finite numbers; times that do not decrease; at least one point for
/// each trajectory; no velocity or one for each point; bodies as in motions.h; valid obstacles; near >= 0; no discs or
/// one entry for each obstacle, finite, with a radius >= 0.
MotionCheck check_motions(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& map,
                          const MotionCheckOptions& options, const std::function<void(const MotionEvent&)>& report);

/// The motion of a straight piece whose body turns: along the arc of a constant twist. Rounded.
/// REQUIRES: a piece that lasts.
TurningMotion turning_motion(const StraightMotion& piece, const Turned& turned);

}  // namespace exactvo::geometry
