// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "ellipse_solver.h"
#include "exactvo/geometry/hull.h"

namespace exactvo::geometry {

FastEllipse fast_smallest_ellipse(const std::vector<Vec2>& points) {
  detail::require_places(points);
  const bool one = std::all_of(points.begin(), points.end(), [&](Vec2 p) { return p == points.front(); });
  if (one) return {{points.front(), 0.0, 0.0, 0.0}, 0.0};
  const detail::EllipseCandidate candidate = detail::solve_smallest_ellipse(points);
  return {detail::certified_ellipse(candidate.frame, points), candidate.least_area};
}

}  // namespace exactvo::geometry
