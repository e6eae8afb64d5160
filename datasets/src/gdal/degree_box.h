// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The box of a file's longitudes and latitudes, as numbers and on the circle of longitudes: two features on either
/// side of the antimeridian are neighbours.

#include <vector>

#include "exactvo/geometry/box.h"

namespace exactvo::datasets {

class DegreeBox {
 public:
  /// All longitudes between its least and its greatest: an edge from 179 to -179 runs the long way round (RFC 7946,
  /// 3.1.9 has such shapes cut at the antimeridian). What is not finite is left out.
  void add(const geometry::Ring& ring);
  /// A place by itself; finite.
  void add(geometry::Vec2 place);

  bool is_empty() const { return numbers_.is_empty(); }
  /// Degrees, as they are written.
  const geometry::Box& numbers() const { return numbers_; }
  /// The narrowest interval of longitudes that holds all, from -180 on, its end beyond 180 where it crosses the
  /// antimeridian. Gaps of less than a tenth of a degree are not looked for.
  geometry::Box on_circle() const;
  /// The middle of `on_circle`, longitude within (-180, 180]; the pole where the box is round one.
  geometry::Vec2 middle() const;

 private:
  struct Interval {
    double west;
    double east;
  };
  static std::size_t bin_of(double longitude);
  void cover(double west, double east);

  geometry::Box numbers_;
  std::vector<Interval> bins_;  ///< what is covered of each tenth of a degree; west > east where nothing is
};

}  // namespace exactvo::datasets
