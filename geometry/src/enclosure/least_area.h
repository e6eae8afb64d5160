// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A certified lower bound of the area of every ellipse round given points.
///
/// Let w >= 0 be weights of the points that add up to 1, m their weighted mean and C = sum w (p - m)(p - m)^T. An
/// ellipse { x : |A x + b| <= 1 } round the points has tr(A C A^T) <= sum w |A p + b|^2 <= 1, hence
/// 2 sqrt(det A C A^T) <= 1 (the geometric mean is at most the arithmetic one), and its area pi / det A is at least
/// 2 pi sqrt(det C). By the formula of Cauchy and Binet
///
///   det C = sum over i < j < k of w_i w_j w_k D_ijk^2,   D_ijk twice the area of the triangle of three points:
///
/// all terms are positive, and a sum of them is below det C as soon as each |D| is. For the best weights the bound is
/// the least area itself, for three points 4 pi / (3 sqrt 3) of their triangle.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

struct WeightedPoint {
  Vec2 point;
  double weight;  ///< > 0; of any sum
};

/// m^2; no ellipse round the points is smaller. Certified for any weights, and below what they give by less than a
/// relative 2^-44. 0 for fewer than three points, for points on one line, and at the ends of the doubles' range.
double certified_least_area(const std::vector<WeightedPoint>& support);

/// A lower bound of twice the area of a triangle, below it by less than a relative 2^-47; 0 below 2^-1000 m^2.
double doubled_area_below(Vec2 a, Vec2 b, Vec2 c);

}  // namespace exactvo::geometry::detail
