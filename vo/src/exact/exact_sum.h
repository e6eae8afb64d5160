// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// S of a velocity obstacle, the exact Minkowski sum of obstacle and robot, as the hull of bodies that are all alike: a
/// disc, or an ellipse with a disc, put at each of some points, all in rationals. A polygon's bodies are discs round
/// its vertices, an ellipse is one body. And the legs of such a sum (its tangents from 0) as algebraic numbers. Exact.

#include <vector>

#include "exact/algebraic_value.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo::detail {

/// { L w : |w| <= 1 } (+) D(0, r), Sigma = L L^T. Where Sigma is a multiple of the unit matrix with a rational root,
/// it is in the radius.
struct Body {
  Rational s11 = 0, s12 = 0, s22 = 0;
  Rational radius = 0;

  bool is_disc() const { return sgn(s11) == 0 && sgn(s22) == 0; }
};

/// hull(centres) (+) body, seen from the robot.
struct ExactSum {
  std::vector<RationalVector> centres;  ///< of a polygon counter-clockwise, as given; of a sum in no order
  Body body;
};

/// What a velocity obstacle was made of, unrounded. It refers to the obstacle.
struct UnroundedInput {
  const geometry::ConvexShape& obstacle;
  const geometry::ConvexPolygon* robot;  ///< null for a disc
  Vec2 position;
  double radius;  ///< 0 for a polygon
};
UnroundedInput unrounded_input(const VelocityObstacle& obstacle);

/// S, unrounded, also where the robot is a polygon.
ExactSum exact_sum(const VelocityObstacle& obstacle);

/// The sign of k + sqrt(b) + sqrt(d), b, d >= 0.
inline int sign_with_roots(const Rational& k, const Rational& b, const Rational& d) {
  return static_cast<int>(geometry::detail::sign_with_two_roots(k, b, d));
}

/// Both legs. REQUIRES: 0 is not in S.
ExactLegs legs_of(const ExactSum& s);

}  // namespace exactvo::vo::detail
