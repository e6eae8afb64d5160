// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Polygons inside and outside a shifted cone, and the same of a disc of velocities.

#include "exactvo/geometry/region.h"
#include "exactvo/vo/family.h"

namespace exactvo::vo::detail {

/// Where the polygons are wanted: |v| <= speed, the curves followed to `tolerance` m/s.
struct Window {
  double speed;
  double tolerance;
};

/// The square that holds every region: its half-width is this many speeds.
inline constexpr double kReach = 1.5;
geometry::ConvexPolygon square_of(const Window& window);

/// { v : |v| <= speed }, from inside and from outside.
geometry::Region disc_from_inside(const Window& window);
geometry::Region disc_from_outside(const Window& window);

/// The half-plane with its offset moved to where it parts the square from nothing: the same within the square.
geometry::HalfPlane within_reach(const geometry::HalfPlane& h, const Window& window);

/// The cone within the square. Certified: every point of the first lies in it, and all of its points in the square in
/// the second. Where no legs certify, the line away from the nearest point takes their place; where that does not
/// either, nothing and the whole square. REQUIRES: !cone.cone.overlaps().
geometry::Region cone_from_inside(const ShiftedCone& cone, const Window& window);
geometry::Region cone_from_outside(const ShiftedCone& cone, const Window& window);

}  // namespace exactvo::vo::detail
