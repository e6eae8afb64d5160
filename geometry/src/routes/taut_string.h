// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The shortest curve for a disc between two points, round given vertices: circles about them, their common tangents.
/// Rounded; what is made of it is proven in realise.h.

#include <optional>
#include <vector>

#include "routes/plan.h"

namespace exactvo::geometry::routing {

struct Circle {
  Vec2 centre;
  int sense;  ///< 1: the route turns left round it, which lies to its left; -1: right
  int vertex;
  std::size_t at = 0;  ///< its portal's place in the way
};

/// The shortest curve from one point to another that passes given circles on given sides, as a polyline outside of
/// them.
class TautString {
 public:
  TautString(const ClearancePlan& plan, Vec2 from, Vec2 to, std::vector<Circle> circles);

  /// Drops circles that the string does not touch and takes up those that it cuts, until neither is left. False where
  /// that does not come to an end. A round is linear; a row of vertices that are all cut takes the logarithm of them.
  bool pull();

  /// The corners between the ends, arcs in steps of at most `step` rad.
  std::vector<Point> corners(double step) const;

 private:
  /// A straight piece of the string: from one circle, or end of the string (null), to the next.
  struct Tangent {
    double angle;  ///< rad
    Segment piece;
  };
  Tangent tangent(const Circle* from, const Circle* to) const;
  void drop_loose_circles();
  bool take_up_cut_vertices();
  std::optional<Circle> cut_by_arc(std::size_t i) const;
  std::optional<Circle> deepest_cut(std::size_t i) const;

  const ClearancePlan& plan_;
  Vec2 from_, to_;
  std::vector<Circle> circles_;
  double radius_;
  std::vector<Tangent> tangents_;
};

}  // namespace exactvo::geometry::routing
