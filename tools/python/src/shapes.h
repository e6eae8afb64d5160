// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Shapes and obstacles between Python and C++. A convex shape is a tuple ("disc", center, radius), ("segment", a, b),
/// ("polygon", vertices), ("ellipse", center, (l11, l21, l22)); obstacles are ragged arrays as in shapely 2 and
/// GeoArrow.

#include <vector>

#include "arguments.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::python {

/// Valid, or an ArgumentError.
geometry::ConvexShape convex_shape(py::handle object, const char* name);
py::tuple as_tuple(const geometry::ConvexShape& shape);

/// Several obstacles: ring r has the points ring_offsets[r] to ring_offsets[r + 1] (m), obstacle k the rings
/// obstacle_offsets[k] to obstacle_offsets[k + 1], the outer one first; a wall is one open chain.
struct Obstacles {
  std::vector<formation::SceneObstacle> list;
};

std::vector<geometry::Obstacle> shapes_of(const Obstacles& obstacles);

/// A polygon as a list of rings, the outer one first.
py::list rings_of(const geometry::Polygon& polygon);

}  // namespace exactvo::python
