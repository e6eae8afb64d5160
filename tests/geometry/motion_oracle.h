// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What bodies in motion do, in rationals of Boost.Multiprecision: slow, and by another way than the library. Positions
/// are evaluated by de Casteljau, de Boor and Horner, polynomials are interpolated, and the least distance is sought
/// among all times at which the distance to some edge or corner is stationary. Such times are rational for straight
/// motions; for others they are bisected, to 2^-130 of the span; a squared distance is then taken for
/// equal where it differs by less than 2^-100 of itself.

#include <boost/multiprecision/gmp.hpp>

#include <optional>
#include <utility>
#include <vector>

#include "geometry/motion_case.h"

namespace exactvo::test {

using Q = boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

struct OraclePoint {
  Q x, y;
};

class MotionOracle {
 public:
  explicit MotionOracle(const MotionCase& c);

  /// Whether the two have a moment in common.
  bool concurrent() const { return from_ <= to_; }
  /// The verdict over the whole common time, or over a part of it.
  geometry::Encounter encounter() const { return encounter(from_, to_); }
  geometry::Encounter encounter(const Q& from, const Q& to) const;
  /// Compares the least distance, less the reaches, with a number: -1, 0 or 1. 0 inside counts as distance.
  int compare_clearance(const Q& number) const;
  const Q& from() const { return from_; }
  const Q& to() const { return to_; }

 private:
  using Point = OraclePoint;
  /// A pair of convex parts: edges of the difference of both, in no order; a point or a segment has one.
  struct Pair {
    std::vector<std::pair<Point, Point>> edges;
    std::vector<std::pair<geometry::Vec2, geometry::Vec2>> rounded;  ///< the edges
    std::vector<Point> corners_a, corners_b;                         ///< hulls, counter-clockwise
    Q reach;
    bool thin = false;
  };
  Point relative(const Q& from, const Q& to, const Q& share) const;
  bool is_far(const Pair& pair, const Point& p, const Q& reach) const;
  bool interiors_meet(const Pair& pair, const Point& p) const;
  bool is_inside(const Point& p) const;
  geometry::Encounter decide(const Q& from, const Q& to, const Q& more, bool thin_counts, unsigned bits) const;

  const MotionCase& case_;
  Q from_, to_;
  std::vector<Pair> pairs_;
  std::size_t degree_ = 1;
};

}  // namespace exactvo::test
