// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Does anything touch anything, at any time? Many bodies on trajectories, among each other and on a map.
///
/// Pieces of motion are swept in time; those at the same time and near each other are found in a grid. The cost grows
/// as n log n for n pieces, with what is near; memory with the pieces that are under way at a time. Every verdict is
/// exact (motions.h).
///
/// See also: motions.h (one pair).

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "exactvo/geometry/motions.h"

namespace exactvo::geometry {

/// A body whose reference point is at these points at these times.
struct Trajectory {
  std::vector<TimedPoint> points;   ///< at least one; times do not fall
  RigidBody body = disc_body(0.0);  ///< as motions.h requires it
  /// m/s, at each point, for `Between::cubic`; empty: those of a Catmull-Rom spline, and of the chord at both ends.
  std::vector<Vec2> velocities{};
};

/// Where a body is between two timed points.
enum class Between : int {
  straight = 0,  ///< uniform and straight from one to the next
  hold = 1,      ///< at the first, until the time of the next, when it is at the next one only
  cubic = 2,     ///< `hermite_cubic` from one to the next
  none = 3       ///< nowhere: only the timed points count
};

/// Two pieces of motion, or one and an obstacle, whose boxes meet at the same time.
struct MetPair {
  std::size_t body = 0;        ///< its number; of two bodies the lower
  Motion motion;               ///< of `body`
  bool with_obstacle = false;  ///< whether `other` is an obstacle
  std::size_t other = 0;       ///< number of the other body, or of the obstacle
  Motion other_motion;         ///< of the other body; of an obstacle that is a disc, at rest
};

/// What is asked.
struct MotionCheckOptions {
  Between between = Between::straight;  ///< timed points; with `hold` no piece that lasts has its last moment
  double near = 0.0;                    ///< m, >= 0: approaches nearer than this are listed
  /// Called for each pair whose boxes, each grown by half of `near`, meet: what a proof has to speak of. An obstacle is
  /// named once for each piece. May be empty.
  std::function<void(const MetPair&)> met{};
  /// Of each obstacle: where set, the obstacle is this disc itself, with its inside, and its shape does not matter.
  /// Empty: none is.
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
  Bounds clearance;                          ///< m, certified: the least, so its negative is the greatest depth
  double nearest_time = 0.0;                 ///< s, rounded: a moment of least clearance
  Vec2 place;                                ///< m, rounded: where, at that moment
  Vec2 at;                                   ///< m, rounded: the body's reference point at that moment
  Vec2 other_at;                             ///< m, rounded: the other body's; (0, 0) of obstacles
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

/// What was looked at, and what comes near.
struct MotionCheck {
  std::size_t pieces = 0;            ///< of motion
  std::size_t pairs = 0;             ///< of pieces whose boxes meet at the same time
  std::size_t edge_pairs = 0;        ///< of pieces and edges, or discs of the map, whose boxes meet
  std::size_t examined = 0;          ///< of both, those that the quick filter could not clear
  std::size_t overlaps = 0;          ///< events
  std::size_t contacts = 0;          ///< events
  std::size_t most_held = 0;         ///< pieces in memory at a time
  std::vector<Approach> approaches;  ///< by body, bodies before obstacles, then by other; empty for `near` 0
};

/// Takes pieces of motion one after the other, by the time at which they begin. Keeps those that are under way.
class MotionStream {
 public:
  /// Of `options.between` only `hold` matters, since pieces are given. `map` must outlive the stream.
  MotionStream(const std::vector<Obstacle>& map, MotionCheckOptions options,
               std::function<void(const MotionEvent&)> report);
  ~MotionStream();
  MotionStream(const MotionStream&) = delete;
  MotionStream& operator=(const MotionStream&) = delete;

  /// Returns the body's number: 0, 1, ... REQUIRES: as motions.h of a body.
  std::size_t add_body(RigidBody body);
  /// REQUIRES: a number of `add_body`; finite numbers; a duration >= 0; no piece before began later; of one body, no
  /// piece begins before the one before it ends.
  void add(std::size_t body, const Motion& piece);
  /// Reports what is still open. REQUIRES: called once, last.
  MotionCheck finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reports every contact and overlap, in the order in which they end (ties by bodies). Two events of a pair whose
/// moments may be the same are one. Exact. REQUIRES: finite numbers, times that do not fall, at least one point a
/// trajectory, no velocity or one a point, bodies as in motions.h, valid obstacles, near >= 0;
/// of discs none or one entry an obstacle, finite, with a radius >= 0.
MotionCheck check_motions(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& map,
                          const MotionCheckOptions& options, const std::function<void(const MotionEvent&)>& report);

}  // namespace exactvo::geometry
