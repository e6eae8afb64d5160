// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Directions whose slope is an algebraic number: the legs of a velocity obstacle, unrounded (VelocityObstacle::
/// exact_legs). A value that a reader can check: a polynomial with integer coefficients, an interval of rationals
/// that holds exactly one of its roots t, and the number of quarter turns k of
///
///     direction = (1, t) turned counter-clockwise by k quarter turns,   -1 < t <= 1,   k = 0, 1, 2, 3
///
///                    k = 1
///             .-------------. t = 1        every direction has one k and one t; the ends of the
///             |  \       /  |              quarters are rational, so no comparison straddles them
///       k = 2 |      o      | k = 0
///             |  /       \  |
///             '-------------' t = -1 (excluded: that is k = 3, t = 1)
///                    k = 3
///
/// The polynomial: turn the scene back by k quarter turns. For the body with centre p seen from the robot, with
/// L (Sigma = L L^T) and grown by r, whose tangent the leg is (an ellipse; a disc or the disc round a vertex: Sigma = 0
/// and its radius), a left leg along (1, t) has the outward normal n = (-t, 1), a right leg -n, and
///
///     K = (p_y - p_x t)^2,   B = Sigma11 t^2 - 2 Sigma12 t + Sigma22,   D = r^2 (1 + t^2),
///     h(+-n) = 0   implies   p_y - p_x t = 0                  for a point (degree 1),
///                            K - B - D = 0                    where B or D is nothing (degree 2),
///                            (K - B - D)^2 - 4 B D = 0        for an ellipse with a disc (degree 4).
///
/// Its square-free part is kept, with coprime coefficients and a positive leading one; where the root of a
/// quadratic is rational, the linear factor. It need not be irreducible. Which root is the leg was decided by the sign
/// of h at both ends of its interval, in rationals.
///
/// Exact throughout, but for `rounded`. Microseconds; for study, not for loops (see VelocityObstacle::legs for those).
///
/// Properties (tests quote the numbers):
///  (1) the polynomial changes its sign between `low` and `high`, or both are its root;
///  (2) `compare` is a total order, the one of the angles in (-pi, pi]; equality is decided, not guessed;
///  (3) turn(a, b) == -turn(b, a), and turn is zero iff the directions are equal or opposite;
///  (4) the certified bracket of VelocityObstacle::legs holds the leg;
///  (5) `refined` is the same direction: it compares equal;
///  (6) scaling the scene by a power of two changes neither leg.

#include <memory>
#include <string>
#include <vector>

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::vo {

namespace detail {
struct AlgebraicValue;
struct AlgebraicAccess;
}  // namespace detail

/// A direction, unrounded. Immutable; copies share.
class AlgebraicDirection {
 public:
  /// The direction of a vector of doubles, exactly. REQUIRES: v finite, not zero.
  explicit AlgebraicDirection(geometry::Vec2 v);

  /// Integers in decimal, from the constant term up; the last one is positive.
  std::vector<std::string> polynomial() const;
  /// Rationals in decimal, "p/q" or "p": the slope t lies between them, or is both of them. (A root of a polynomial of
  /// degree 4 may be rational without being known to be.)
  std::string low() const;
  /// As `low`: the other end.
  std::string high() const;
  /// k above.
  int quarter_turns() const;

  /// The same direction with an interval no wider than `width`. REQUIRES: width > 0.
  AlgebraicDirection refined(double width) const;

  /// The direction in doubles, of length 1; rounded: each coordinate is off by at most 4 ulps of 1.
  geometry::Vec2 rounded() const;

 private:
  friend struct detail::AlgebraicAccess;
  explicit AlgebraicDirection(std::shared_ptr<const detail::AlgebraicValue> value);

  std::shared_ptr<const detail::AlgebraicValue> value_;
};

/// By the angle in (-pi, pi]: negative where a comes first, zero where they are equal. Exact.
geometry::Sign compare(const AlgebraicDirection& a, const AlgebraicDirection& b);

/// The sign of cross(a, b): positive where b lies less than half a turn counter-clockwise of a. Exact.
geometry::Sign turn(const AlgebraicDirection& a, const AlgebraicDirection& b);

/// The signs of cross(a, v) and dot(a, v). Exact. REQUIRES: v finite.
geometry::Sign turn(const AlgebraicDirection& a, geometry::Vec2 v);
/// The sign of dot(a, v).
geometry::Sign along(const AlgebraicDirection& a, geometry::Vec2 v);

/// The directions of both sides of a cone, away from the apex.
struct ExactLegs {
  AlgebraicDirection left;   ///< seen from the robot
  AlgebraicDirection right;  ///< seen from the robot
};

}  // namespace exactvo::vo
