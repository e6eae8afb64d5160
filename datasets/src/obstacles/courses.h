// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The points of obstacles as most files list them.

#include <utility>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets {

/// With its first point once more at the end.
inline geometry::Ring closed(geometry::Ring ring) {
  if (!ring.empty()) ring.push_back(ring.front());
  return ring;
}

/// The outer ring, then the holes, each closed; of a polyline its points.
inline std::vector<geometry::Ring> courses_of(const geometry::Obstacle& shape) {
  if (const auto* line = std::get_if<geometry::Polyline>(&shape)) return {line->points};
  const auto& polygon = std::get<geometry::Polygon>(shape);
  std::vector<geometry::Ring> rings{closed(polygon.outer)};
  for (const geometry::Ring& hole : polygon.holes) rings.push_back(closed(hole));
  return rings;
}

}  // namespace exactvo::datasets
