// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The boundary of a shape grown by a disc, run through by the angle of its outward normal. Rounded.

#include <vector>

#include "exactvo/geometry/support.h"

namespace exactvo::formation::detail {

using geometry::Vec2;

inline constexpr double kFullTurn = 6.28318530717958647692;

struct BoundaryPoint {
  Vec2 position;                   ///< m
  Vec2 normal;                     ///< unit, outward
  double radius_of_curvature = 0;  ///< m; at a polygon's corner the disc's radius
};

class Boundary {
 public:
  Boundary(geometry::ConvexShape shape, double radius);

  /// The boundary point whose outward normal has this angle.
  BoundaryPoint at(double angle) const;

  /// Whether the radius of curvature is finite everywhere: an ellipse or a disc.
  bool smooth() const { return edges_.empty(); }

  /// The flat parts of the shape, not grown, interior on their left, once round it.
  const std::vector<geometry::Segment>& flat_edges() const { return edges_; }

  /// rho at a normal; infinite exactly on a flat edge's normal.
  double radius_of_curvature(Vec2 normal) const;

  /// The angles, ascending, at which the goal lies straight behind the boundary: goal = position - D normal, D > 0.
  std::vector<double> facing_away(Vec2 goal) const;

 private:
  std::vector<double> flat_equilibria(Vec2 goal) const;
  double lateral(double angle, Vec2 goal) const;

  geometry::GrownShape grown_;
  std::vector<geometry::Segment> edges_;  ///< the flat parts, interior on their left
};

}  // namespace exactvo::formation::detail
