// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Polygons before and after a repair, side by side: the rings as given with their problems marked, and the polygons
/// that they became, a colour each.

#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// One polygon that was recombined.
struct RepairedPolygon {
  std::string title;
  std::vector<geometry::Ring> before;
  std::vector<geometry::Vec2> problems;  ///< where
  std::vector<geometry::Polygon> after;  ///< empty where it could not be repaired
};

/// At most so many are drawn, a row each.
inline constexpr std::size_t kMostRepairedDrawn = 6;

/// REQUIRES: at least one.
Figure repair_figure(const std::vector<RepairedPolygon>& polygons);

}  // namespace exactvo::tools
