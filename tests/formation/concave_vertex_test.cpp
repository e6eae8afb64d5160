// SPDX-License-Identifier: GPL-3.0-or-later
#include "traps/concave_vertex.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exactvo/geometry/shapes.h"
#include "support/seeded_random.h"

namespace exactvo::formation::detail {
namespace {

using geometry::ConvexShape;
using geometry::GrownShape;
using geometry::Vec2;
using test::SeededRandom;

constexpr double kRadius = 0.5;  // m

/// A rectangle, which is turned by nothing, by a whole degree, or by any angle: the angles of its normals are rounded.
ConvexShape rectangle(SeededRandom& random) {
  const int kind = random.integer(0, 2);
  const double degree = std::acos(-1.0) / 180.0;
  const double turn = kind == 0 ? 0.0 : kind == 1 ? random.integer(0, 359) * degree : random.uniform(0.0, 7.0);
  const Vec2 centre = random.in_box(2.0), along{std::cos(turn), std::sin(turn)}, across = geometry::perp(along);
  const double length = random.uniform(0.01, 3.0), width = random.uniform(0.01, 3.0);
  return geometry::ConvexPolygon{{centre - length * along - width * across, centre + length * along - width * across,
                                  centre + length * along + width * across, centre - length * along + width * across}};
}

ConvexShape wall(SeededRandom& random) {
  const Vec2 a = random.in_box(3.0);
  return geometry::Segment{a, a + random.uniform(0.01, 4.0) * random.direction()};
}

/// Down to a width that is lost beside its length.
ConvexShape ellipse(SeededRandom& random) {
  const double turn = random.uniform(0.0, 7.0), length = random.uniform(0.1, 3.0);
  const double width = length * std::pow(10.0, random.uniform(-18.0, 0.0));
  return geometry::ellipse_from_axes(random.in_box(2.0), {length, width, turn});
}

ConvexShape any_shape(SeededRandom& random) {
  switch (random.integer(0, 2)) {
    case 0:
      return rectangle(random);
    case 1:
      return wall(random);
    default:
      return ellipse(random);
  }
}

// Round a corner the angle of a normal may be rounded past that of the edge beside it.
TEST(ConcaveVertex, CrossingsLieOnBothBoundaries) {
  SeededRandom random(test::seed_of_run(20));
  int found = 0;
  for (int k = 0; k < 3000; ++k) {
    const GrownShape a{any_shape(random), {}, kRadius}, b{any_shape(random), {}, kRadius};
    for (const Crossing& c : crossings(a, b)) {
      ++found;
      EXPECT_NEAR(distance_to(a, c.position), 0.0, 1e-9) << "pair " << k;
      EXPECT_NEAR(distance_to(b, c.position), 0.0, 1e-9) << "pair " << k;
    }
  }
  EXPECT_GT(found, 2000);
}

}  // namespace
}  // namespace exactvo::formation::detail
