// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The smallest-area ellipse round points, numerically, and its certification.
///
/// The points are sheared and scaled so that they fill a unit box (needles and far-away clouds become ordinary). There
/// the dual is solved: maximise log det of M(w) = sum w_i q_i q_i^T, q_i = (x_i, y_i, 1), over weights w >= 0 that add
/// up to 1; optimal iff q_i^T M^-1 q_i <= 3 for all i, with equality where w_i > 0 (John 1948; Khachiyan, Rounding of
/// polytopes in the real number model of computation, 1996). Newton's method on at most a handful of points with
/// positive weight, and the worst outsider joins until there is none.

#include <optional>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

struct WeightedPoint {
  Vec2 point;
  double weight;  ///< > 0; of any sum
};

/// What the enclosing shapes take: at least one point, all finite and below 2^1000, so that differences do not
/// overflow. Throws std::logic_error otherwise.
void require_places(const std::vector<Vec2>& points);

/// An affine map x -> K^-1 (x - center) with K = [k11 0; k21 k22], on (y, x) instead of (x, y) where `swapped`.
struct EllipseFrame {
  Vec2 center;
  double k11 = 0.0;
  double k21 = 0.0;
  double k22 = 0.0;
  bool swapped = false;
};

/// The image of the unit disc under the frame's inverse: { center + K w : |w| <= 1 }. Rounded.
Ellipse ellipse_of(const EllipseFrame& frame);

/// A numerical optimum, not certified.
struct EllipseCandidate {
  EllipseFrame frame;
  std::vector<WeightedPoint> support;  ///< of the points, with the dual's weights; their bound is near the least area
};

/// REQUIRES: at least two distinct points, all finite. For points that are collinear up to rounding, k22 is a few ulps.
EllipseCandidate solve_smallest_ellipse(const std::vector<Vec2>& points);

/// The candidate scaled to fit, then grown in steps until every point lies in it by predicate E.
Ellipse certified_ellipse(const EllipseFrame& candidate, const std::vector<Vec2>& points);

/// Every point lies in the ellipse. Exact.
bool contains_all(const Ellipse& ellipse, const std::vector<Vec2>& points);

/// Inflates until predicate E holds for every point: the ellipse was rounded, the answer may not be. Nothing of one
/// that is a segment to rounding.
std::optional<Ellipse> inflate_to_contain(Ellipse e, const std::vector<Vec2>& points);

/// The segment itself (l22 = 0) where doubles can say it, else a certified sliver 2^-36 of the coordinates wide.
/// REQUIRES: a != b.
Ellipse ellipse_of_segment(Vec2 a, Vec2 b);

/// m^2; no ellipse round the points is smaller. Certified for any weights, and below what they give by less than a
/// relative 2^-44. 0 for fewer than three points, for points on one line, and at the ends of the doubles' range.
double certified_least_area(const std::vector<WeightedPoint>& support);

/// A lower bound of twice the area of a triangle, below it by less than a relative 2^-47; 0 below 2^-1000 m^2.
double doubled_area_below(Vec2 a, Vec2 b, Vec2 c);

}  // namespace exactvo::geometry::detail
