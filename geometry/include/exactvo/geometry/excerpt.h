// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Shapes in error messages: whole and lossless while they are small, their first vertices where they are not.

#include <string>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// The shape in one line, a polygon abridged to `kVerticesShown` vertices.
inline std::string excerpt(const ConvexShape& shape) {
  const auto* polygon = std::get_if<ConvexPolygon>(&shape);
  if (polygon == nullptr || polygon->vertices.size() <= kVerticesShown) return to_string(shape);
  return "convex_polygon " + excerpt(polygon->vertices);
}

}  // namespace exactvo::geometry
