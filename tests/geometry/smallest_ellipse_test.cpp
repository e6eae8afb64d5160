// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Min_ellipse_2.h>
#include <CGAL/Min_ellipse_2_traits_2.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

/// What an ellipse of doubles can't help: its centre and slant are rounded at the coordinates' ulp, which counts as
/// much as the ellipse is narrow beside the coordinates. 1e-10 is the numerical optimum's own slack.
double area_tolerance(const Ellipse& e, const std::vector<Vec2>& points) {
  double reach = 0;
  for (const Vec2 p : points) reach = std::max({reach, std::fabs(p.x), std::fabs(p.y)});
  return 1e-10 + 64 * 0x1p-53 * reach / axes_of(e).b;
}

void expect_certified(const Ellipse& e, const std::vector<Vec2>& points) {
  for (const Vec2 p : points) {
    ASSERT_TRUE(contains(e, p)) << to_string(ConvexShape(e)) << " of " << to_string(points);
    ASSERT_TRUE(test::in_ellipse(e, p)) << to_string(ConvexShape(e)) << " of " << to_string(points);
  }
}

std::vector<Vec2> cloud(SeededRandom& random, int n) {
  std::vector<Vec2> points;
  const int kind = random.integer(0, 2);
  for (int i = 0; i < n; ++i) points.push_back(kind == 0 ? random.direction() : random.in_box(1.0));
  return points;
}

// Property 1: every point is inside, exactly. Property 2: the area is within the tolerance of the dual bound, hence of
// the least. Near and far, fat and thin.
TEST(SmallestEllipse, Properties1And2NearAndFar) {
  SeededRandom random(test::seed_of_run(41));
  int judged = 0;
  for (const double offset : {0.0, 1.0, 1e5, 1e7}) {
    for (const double aspect : {1.0, 1e-3, 1e-6}) {
      for (int i = 0; i < 60; ++i) {
        const auto points = test::placed(cloud(random, random.integer(3, 30)), random.uniform(-3, 3), aspect,
                                         std::exp2(random.uniform(-3, 3)), {offset, -0.7 * offset});
        const FastEllipse fast = fast_smallest_ellipse(points);
        expect_certified(fast.ellipse, points);
        const double tolerance = area_tolerance(fast.ellipse, points);
        if (tolerance > 0.1) continue;  // thinner than the coordinates can say
        SCOPED_TRACE(to_string(points));
        ASSERT_LE(area(fast.ellipse), fast.least_area * (1 + tolerance));
        ++judged;
      }
    }
  }
  EXPECT_GT(judged, 360);
}

// The area by CGAL's own exact conic, of centred points.
double oracle_area(const std::vector<Vec2>& points) {
  using Kernel = CGAL::Simple_cartesian<test::Rational>;
  using MinEllipse = CGAL::Min_ellipse_2<CGAL::Min_ellipse_2_traits_2<Kernel>>;
  std::vector<Kernel::Point_2> input;
  for (const Vec2 p : points) {
    input.emplace_back(test::Rational(p.x) - test::Rational(points[0].x),
                       test::Rational(p.y) - test::Rational(points[0].y));
  }
  const MinEllipse ellipse(input.begin(), input.end(), true);
  double r, s, t, u, v, w;
  ellipse.ellipse().double_coefficients(r, s, t, u, v, w);
  const double det = 4 * r * s - t * t;  // r x^2 + s y^2 + t x y + u x + v y + w = 0
  const double x = (t * v - 2 * s * u) / det, y = (t * u - 2 * r * v) / det;
  const double level = r * x * x + s * y * y + t * x * y - w;
  return 2 * kPi * std::fabs(level) / std::sqrt(det);
}

TEST(SmallestEllipse, AgreesWithCgalsConic) {
  SeededRandom random(test::seed_of_run(42));
  for (int i = 0; i < 300; ++i) {
    const Vec2 offset = random.in_box(i % 2 == 0 ? 0.0 : 1e5);
    const auto points = test::placed(cloud(random, random.integer(3, 20)), 0.0, 0.3, 1.0, offset);
    const double expected = oracle_area(points);
    ASSERT_NEAR(area(fast_smallest_ellipse(points).ellipse) / expected, 1.0, 1e-7) << to_string(points);
  }
}

TEST(SmallestEllipse, KnownOnes) {
  // Steiner's: the area of the ellipse round a triangle is 4 pi / (3 sqrt 3) of the triangle's.
  EXPECT_NEAR(area(fast_smallest_ellipse({{0, 0}, {3, 0}, {0, 4}}).ellipse), 6 * 4 * kPi / (3 * std::sqrt(3.0)), 1e-10);
  EXPECT_NEAR(area(fast_smallest_ellipse({{0, 0}, {2, 0}, {2, 1}, {0, 1}}).ellipse), kPi * 2 / 2, 1e-10);
  std::vector<Vec2> circle;
  for (int i = 0; i < 64; ++i) circle.push_back(3.0 * Vec2{std::cos(0.1 * i), std::sin(0.1 * i)});
  EXPECT_NEAR(area(fast_smallest_ellipse(circle).ellipse), 9 * kPi, 1e-9);
}

TEST(SmallestEllipse, PointsAndSegments) {
  const auto smallest = [](const std::vector<Vec2>& p) { return fast_smallest_ellipse(p).ellipse; };
  EXPECT_EQ(area(smallest({{7, 8}})), 0.0);
  EXPECT_EQ(smallest({{7, 8}, {7, 8}}).l11, 0.0);
  for (const std::vector<Vec2>& line : std::vector<std::vector<Vec2>>{{{0, 0}, {2, 0}},
                                                                      {{0, 0}, {0, 2}, {0, 1}},
                                                                      {{0.1, 0.2}, {0.3, 0.7}},
                                                                      {{1, 1}, {2, 2}, {3, 3}, {1.5, 1.5}},
                                                                      {{1e7, 1e7}, {1e7 + 1, 1e7 - 2}},
                                                                      {{-1, 3}, {4, -5}}}) {
    const Ellipse e = smallest(line);
    expect_certified(e, line);
    const EllipseAxes axes = axes_of(e);
    double reach = 1;
    for (const Vec2 p : line) reach = std::max({reach, std::fabs(p.x), std::fabs(p.y)});
    EXPECT_LE(axes.b, 0x1p-36 * reach) << to_string(line);
    EXPECT_NEAR(axes.a, 0.5 * norm(convex_hull(line).vertices[0] - convex_hull(line).vertices[1]), 1e-6);
  }
  EXPECT_EQ(smallest({{0, 0}, {2, 0}}).l22, 0.0);
  EXPECT_EQ(smallest({{0, 0}, {0, 2}}).l22, 0.0);
}

// Lattices: many points on one conic, many collinear.
TEST(SmallestEllipse, GridsAreCertifiedToo) {
  SeededRandom random(test::seed_of_run(43));
  for (int i = 0; i < 1500; ++i) {
    const auto points = test::grid_points(random, random.integer(1, 12), 3);
    const FastEllipse fast = fast_smallest_ellipse(points);
    expect_certified(fast.ellipse, points);
    if (axes_of(fast.ellipse).b > 1e-3) {
      ASSERT_LE(area(fast.ellipse), fast.least_area * (1 + 1e-9)) << to_string(points);
    }
  }
}

TEST(SmallestEllipse, ExtremeSizes) {
  SeededRandom random(test::seed_of_run(44));
  for (const double scale : {0x1p-500, 0x1p-100, 0x1p100, 0x1p480}) {
    const auto points = test::placed(cloud(random, 12), 0.5, 0.2, scale, {0, 0});
    expect_certified(fast_smallest_ellipse(points).ellipse, points);
  }
}

TEST(SmallestEllipse, RefusesWhatIsNoPlace) {
  EXPECT_THROW(fast_smallest_ellipse({}), std::logic_error);
  EXPECT_THROW(fast_smallest_ellipse({{0, 0}, {std::nan(""), 0}}), std::logic_error);
  EXPECT_THROW(fast_smallest_ellipse({{0x1p1001, 0}}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
