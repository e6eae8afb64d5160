// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The obvious exact way: every number exact from beginning to end. Hull and pieces with CGAL's
/// Exact_predicates_exact_constructions_kernel, the smallest ellipse by Min_ellipse_2 over rationals, facade ellipses
/// checked in rationals.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::bench {

struct NaiveShapes {
  std::vector<geometry::Vec2> hull;
  std::size_t pieces = 0;
  double ellipse_area = 0.0;  ///< rounded at the very end
  bool facade_ellipses_contain = false;
};

NaiveShapes naive_shapes(const geometry::Polygon& polygon);

}  // namespace exactvo::bench
