// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/exact_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::ExactOffset;
using test::OffsetCurve;
using test::Rational;
using test::SeededRandom;

const Polygon kSquare = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {}};

TEST(ExactOffset, OfARectangleHasFourSidesAndFourRoundCorners) {
  const ExactOffset offset(kSquare, 0.5);
  EXPECT_NEAR(offset.area(), 2 + 6 * 0.5 + kPi * 0.25, 1e-12);
  ASSERT_EQ(offset.boundary().size(), 1U);
  int lines = 0;
  for (const OffsetCurve& curve : offset.boundary()[0]) {
    lines += curve.is_arc ? 0 : 1;
    if (curve.is_arc) {
      EXPECT_NEAR(norm(curve.from - curve.center), 0.5, 1e-15);
      EXPECT_NEAR(norm(curve.to - curve.center), 0.5, 1e-15);
    }
  }
  EXPECT_EQ(lines, 4);
}

// A 3-4-5 corner: the point at distance exactly r is a rational one.
TEST(ExactOffset, LocatesPointsOnItsBoundary) {
  const ExactOffset offset(kSquare, 5.0);
  EXPECT_EQ(offset.locate({5, 5}), Place::boundary);  // (2, 1) + (3, 4)
  EXPECT_EQ(offset.locate({-3, 5}), Place::boundary);
  EXPECT_EQ(offset.locate({1, 6}), Place::boundary);
  EXPECT_EQ(offset.locate({5, std::nextafter(5.0, 6.0)}), Place::outside);
  EXPECT_EQ(offset.locate({5, std::nextafter(5.0, 4.0)}), Place::inside);
  EXPECT_EQ(offset.locate({1, 0.5}), Place::inside);
}

Place oracle(const Polygon& polygon, double radius, Vec2 x) {
  if (contains(polygon, x)) return Place::inside;
  Rational least = test::squared_distance(edges_of(polygon)[0], x);
  for (const Segment& e : edges_of(polygon)) least = std::min(least, test::squared_distance(e, x));
  const int sign = static_cast<int>(CGAL::sign(least - Rational(radius) * Rational(radius)));
  return static_cast<Place>(sign);
}

TEST(ExactOffset, AgreesWithRationalDistances) {
  SeededRandom random(test::seed_of_run(81));
  for (int i = 0; i < 60; ++i) {
    const Polygon polygon = {test::star_ring(random, random.integer(3, 10), 0.3), {}};
    const double radius = random.uniform(0.1, 0.6);
    const ExactOffset offset(polygon, radius);
    for (int k = 0; k < 100; ++k) {
      const Vec2 x = random.in_box(1.7);
      ASSERT_EQ(offset.locate(x), oracle(polygon, radius, x))
          << to_string(polygon.outer) << " radius " << hex_text(radius) << " at " << hex_text(x.x) << " "
          << hex_text(x.y);
    }
  }
}

// Steiner's formula: a convex set of area A and perimeter P, grown by r, has the area A + P r + pi r^2.
TEST(ExactOffset, OfAConvexPolygonHasTheAreaOfSteinersFormula) {
  SeededRandom random(test::seed_of_run(82));
  for (int i = 0; i < 5; ++i) {
    std::vector<Vec2> cloud;
    for (int k = 0; k < 6; ++k) cloud.push_back(random.in_box(1.0));
    const Polygon polygon = {convex_hull(cloud).vertices, {}};
    double perimeter = 0.0;
    for (const Segment& e : edges_of(polygon)) perimeter += norm(e.b - e.a);
    const double own = 0.5 * CGAL::to_double(test::doubled_area(polygon.outer));
    EXPECT_NEAR(ExactOffset(polygon, 0.2).area(), own + 0.2 * perimeter + kPi * 0.04, 1e-12) << to_string(cloud);
  }
}

TEST(ExactOffset, KeepsWhatIsLeftOfAHole) {
  const Polygon room = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{1, 1}, {1, 9}, {9, 9}, {9, 1}}}};
  const ExactOffset offset(room, 1.0);
  EXPECT_EQ(offset.boundary().size(), 2U);
  EXPECT_EQ(offset.locate({5, 5}), Place::outside);
  EXPECT_EQ(offset.locate({2, 5}), Place::boundary);
  EXPECT_EQ(offset.locate({1.5, 5}), Place::inside);
}

TEST(ExactOffset, RefusesInvalidInput) {
  EXPECT_THROW(ExactOffset(kSquare, 0.0), std::logic_error);
  EXPECT_THROW(ExactOffset(kSquare, std::nan("")), std::logic_error);
  EXPECT_THROW(ExactOffset(Polygon{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}, 1.0), std::logic_error);
  EXPECT_THROW(ExactOffset(kSquare, 1.0).locate({std::nan(""), 0}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
