// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The option --footprint: what a body looks like.

#include <algorithm>
#include <string>

#include "exactvo/geometry/motions.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::tools {

/// The one shape of WKT, or of an obstacle file. Throws UsageError, DataError.
geometry::Obstacle footprint_shape(const std::string& text);

/// A polygon grown by the radius, or a line that is `2 radius` wide, in pieces that are convex. Throws UsageError for
/// holes, and for a line without a radius.
geometry::RigidBody footprint_body(const geometry::Obstacle& shape, double radius);

/// m, rounded: the radius of the least disc round the reference point that holds the body.
inline double reach_of(const geometry::RigidBody& body) {
  double reach = 0.0;
  for (const geometry::RoundedPolygon& part : body)
    for (const geometry::Vec2 c : part.corners) reach = std::max(reach, norm(c) + part.radius);
  return reach;
}

}  // namespace exactvo::tools
