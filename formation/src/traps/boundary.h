// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The boundary of a shape grown by a disc, run through by the angle of its outward normal. Rounded.

#include <vector>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/support.h"

namespace exactvo::formation::detail {

using geometry::Vec2;

inline constexpr double kFullTurn = 2.0 * geometry::kPi;

/// Unit, to the right of the edge.
inline Vec2 outward(const geometry::Segment& edge) {
  return -geometry::perp(geometry::normalized(edge.b - edge.a));
}

/// Whether the point's foot lies on the edge, ends included.
inline bool is_over(const geometry::Segment& edge, Vec2 point) {
  const Vec2 along = edge.b - edge.a;
  const double foot = dot(point - edge.a, along);
  return foot >= 0.0 && foot <= squared_norm(along);
}

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

  /// The angles of the normals of flat edges strictly behind which the goal lies, with its foot on the edge.
  std::vector<double> flat_equilibria(Vec2 goal) const;

  /// The angles, ascending, at which the goal lies straight behind the boundary: goal = position - D normal, D > 0.
  std::vector<double> facing_away(Vec2 goal) const;

 private:
  double lateral(double angle, Vec2 goal) const;

  geometry::GrownShape grown_;
  std::vector<geometry::Segment> edges_;  ///< the flat parts, interior on their left
};

}  // namespace exactvo::formation::detail
