// SPDX-License-Identifier: GPL-3.0-or-later
// `fast_smallest_ellipse` of hull.h: flat input here, the rest by Newton's method in ellipse_solver.cpp. Certified.
#include <algorithm>

#include "enclosure/ellipse_solver.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "rings/convexity.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {

namespace {

FastEllipse of_collinear(const std::vector<Vec2>& points) {
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), detail::lexicographically_less);
  if (*low == *high) return {{*low, 0.0, 0.0, 0.0}, 0.0};
  return {detail::ellipse_of_segment(*low, *high), 0.0};
}

}  // namespace

FastEllipse fast_smallest_ellipse(const std::vector<Vec2>& points) {
  detail::require_places(points);
  if (detail::on_one_line(points)) return of_collinear(points);
  const detail::EllipseCandidate candidate = detail::solve_smallest_ellipse(points);
  return {detail::certified_ellipse(candidate.frame, points), detail::certified_least_area(candidate.support)};
}

}  // namespace exactvo::geometry
