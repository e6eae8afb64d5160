// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Does anything touch anything, at any time? Many discs on trajectories, among each other and on a map.
///
/// Pieces of motion are swept in time; those at the same time and near each other are found in a grid. The cost grows
/// as n log n for n pieces, with what is near. Every verdict is exact (motions.h).
///
/// See also: motions.h (one pair, curves, other bodies).

#include <cstddef>
#include <functional>
#include <vector>

#include "exactvo/geometry/motions.h"

namespace exactvo::geometry {

/// A disc that is at these points at these times.
struct Trajectory {
  std::vector<TimedPoint> points;  ///< at least one; times do not fall
  double radius = 0.0;             ///< m, >= 0
};

/// Where a body is between two timed points.
enum class Between : int {
  straight = 0,  ///< uniform and straight from one to the next
  hold = 1       ///< at the first, until the time of the next
};

/// What is asked.
struct MotionCheckOptions {
  Between between = Between::straight;  ///< timed points
  double near = 0.0;                    ///< m, >= 0: the approaches of bodies nearer than this are listed
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
};

/// Two bodies that come nearer to each other than `near`, over all time.
struct Approach {
  std::size_t body = 0;       ///< number of a trajectory
  std::size_t other = 0;      ///< number of the other trajectory, above `body`
  Bounds clearance;           ///< m, certified: the least; below 0 where they overlap
  double nearest_time = 0.0;  ///< s, rounded: a moment of least clearance
  Vec2 place;                 ///< m, rounded: where, at that moment
};

/// What was looked at, and what comes near.
struct MotionCheck {
  std::size_t pieces = 0;            ///< of motion
  std::size_t pairs = 0;             ///< of pieces whose boxes meet at the same time
  std::size_t edge_pairs = 0;        ///< of pieces and edges whose boxes meet
  std::size_t examined = 0;          ///< of both, those that the quick filter could not clear
  std::size_t overlaps = 0;          ///< events
  std::size_t contacts = 0;          ///< events
  std::vector<Approach> approaches;  ///< by body, then by other; empty for `near` 0
};

/// Reports every contact and overlap, in the order in which they end (ties by bodies). Two events of a pair whose
/// moments may be the same are one. Exact. REQUIRES: finite numbers, times that do not fall, at least one point a
/// trajectory, radii >= 0, valid obstacles, near >= 0.
MotionCheck check_motions(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& map,
                          const MotionCheckOptions& options, const std::function<void(const MotionEvent&)>& report);

}  // namespace exactvo::geometry
