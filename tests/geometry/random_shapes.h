// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random rings and clouds for the tests of geometry/, plain and nasty.

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/geometry/shapes.h"
#include "support/seeded_random.h"

namespace exactvo::test {

/// Points with integer coordinates in [0, size]: full of duplicates, collinear runs and touching edges.
inline std::vector<geometry::Vec2> grid_points(SeededRandom& random, int count, int size) {
  std::vector<geometry::Vec2> points;
  for (int i = 0; i < count; ++i) {
    const int x = random.integer(0, size);
    points.push_back({static_cast<double>(x), static_cast<double>(random.integer(0, size))});
  }
  return points;
}

/// A counter-clockwise ring round the origin, star-shaped, so simple up to rounding.
inline geometry::Ring star_ring(SeededRandom& random, int count, double least_radius = 0.3) {
  geometry::Ring ring;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * 3.14159265358979 * (i + random.uniform(0.1, 0.9)) / count;
    ring.push_back(random.uniform(least_radius, 1.0) * geometry::Vec2{std::cos(angle), std::sin(angle)});
  }
  return ring;
}

/// The same points turned, flattened to `aspect` and moved: needles far away.
inline std::vector<geometry::Vec2> placed(std::vector<geometry::Vec2> points, double angle, double aspect, double scale,
                                          geometry::Vec2 offset) {
  for (geometry::Vec2& p : points) p = scale * geometry::rotated({p.x, aspect * p.y}, angle) + offset;
  return points;
}

}  // namespace exactvo::test
