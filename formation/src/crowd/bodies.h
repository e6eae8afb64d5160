// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Solid convex bodies, at rest or in motion: which are near a robot, and a half-plane against each.
///
/// With S the shape seen from the robot, w its velocity, r the robot's radius and h(n) = max { n.s : s in S } + r |n|,
/// the half-plane n.(v - w) >= c excludes what meets the body within the horizon t iff h(n) <= 0 and h(n) <= t c: for
/// any n (docs/guide/velocity-obstacles.md). So a normal may be looked for at a polygon round an ellipse; its offset is
/// that of the ellipse itself, rounded up.
///
/// Bodies move by whole steps of the lattice: where they are at the end of a step is exact.

#include <cstdint>
#include <vector>

#include "exactvo/formation/crowd.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation::crowd {

/// A body where it was added, and how far it has come since.
struct Body {
  ObstacleId id = 0;
  geometry::ConvexShape shape;
  bool moves = false;
  std::int64_t x = 0, y = 0;    ///< lattice steps from where it was added
  std::int32_t mx = 0, my = 0;  ///< lattice steps a time step
  std::vector<Vec2> corners;    ///< counter-clockwise: the hull is what normals are looked for at
  std::vector<Vec2> normals;    ///< outward, of the edge from corner k to the next; 0 where these are one point
  double round = 0.0;           ///< m, that the hull is grown by: of a disc its radius
  geometry::Box box;            ///< m, round it where it was added
};

/// The robot that asks for half-planes.
struct BodyQuery {
  std::int32_t x = 0, y = 0;   ///< lattice, of `position`
  Vec2 position, velocity;     ///< m, m/s
  double radius = 0.0;         ///< m
  double still_horizon = 0.0;  ///< s, of bodies at rest
  double horizon = 0.0;        ///< s, of bodies that move
  double max_speed = 0.0;      ///< m/s
  bool float_normals = false;  ///< normals are to be floats
};

/// A half-plane against a body.
struct BodyLine {
  Vec2 normal;                 ///< of the precision asked for
  double offset = 0.0;         ///< m/s, rounded up; <= 0 against what stands still
  std::uint32_t obstacle = 0;  ///< number of the body
  bool touching = false;       ///< the disc meets it, or all but
};

/// By their ids.
class Bodies {
 public:
  Bodies(double position_step, double time_step) : position_step_(position_step), time_step_(time_step) {}

  bool empty() const { return bodies_.empty(); }
  const std::vector<Body>& all() const { return bodies_; }
  const Body* find(ObstacleId id) const;
  Body* find(ObstacleId id);
  /// REQUIRES: a valid shape; an id above those of the bodies that are there.
  Body& add(ObstacleId id, const geometry::ConvexShape& shape, bool moves);
  /// False where there is none of this id.
  bool remove(ObstacleId id);
  /// After changes, and before robots ask.
  void lay_out();
  /// By a time step.
  void move();
  /// m/s
  Vec2 velocity_of(const Body& body) const;
  std::size_t bytes() const;

  /// Half-planes against all bodies that can be met within the horizon, those at rest first, each kind by number; how
  /// many are at rest. Certified: a velocity that satisfies one meets the body not within the horizon if they do not
  /// touch. One that touches: not nearer to a body at rest; apart from one that moves at the end of the step.
  /// `near` is scratch.
  std::size_t lines(const BodyQuery& query, std::vector<std::uint32_t>& near, std::vector<BodyLine>& out) const;

 private:
  void add_line(std::uint32_t number, const BodyQuery& query, std::vector<BodyLine>& out) const;

  double position_step_, time_step_;
  std::vector<Body> bodies_;  ///< by id
  geometry::BoxGrid still_, moving_;
  std::vector<std::uint32_t> still_number_, moving_number_;
  double fastest_ = 0.0;  ///< m/s
  bool changed_ = false, moved_ = false;
};

}  // namespace exactvo::formation::crowd
