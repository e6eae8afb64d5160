// SPDX-License-Identifier: GPL-3.0-or-later
// The lower bound of the area of enclosing ellipses, against closed forms and a dual of its own in multiprecision. Most
// points lie on a line but for a few units in their last place.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <vector>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/obstacle_shapes.h"
#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;
using Number = boost::multiprecision::cpp_bin_float_100;  // of doubles below 2^60: every sum and product here is exact

Number pi() {
  return 4 * atan(Number(1));
}

Number doubled_area(Vec2 a, Vec2 b, Vec2 c) {
  const Number ax = a.x, ay = a.y;
  return abs((Number(b.x) - ax) * (Number(c.y) - ay) - (Number(b.y) - ay) * (Number(c.x) - ax));
}

/// The area of Steiner's ellipse round a triangle: 4 pi / (3 sqrt 3) of the triangle's.
Number least_of_triangle(const std::vector<Vec2>& p) {
  return 2 * pi() / (3 * sqrt(Number(3))) * doubled_area(p[0], p[1], p[2]);
}

/// The area of an enclosing ellipse, near the least: the dual by multiplicative steps, and the ellipse of its weights,
/// enlarged until all points lie in it.
Number nearly_least_of(const std::vector<Vec2>& points, int steps) {
  const std::size_t n = points.size();
  std::vector<Number> weights(n, Number(1) / n), far(n);
  Number best = -1;
  for (int step = 0; step < steps; ++step) {
    Number mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < n; ++i) {
      mx += weights[i] * points[i].x;
      my += weights[i] * points[i].y;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Number x = points[i].x - mx, y = points[i].y - my;
      xx += weights[i] * x * x;
      xy += weights[i] * x * y;
      yy += weights[i] * y * y;
    }
    const Number det = xx * yy - xy * xy;
    Number farthest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Number x = points[i].x - mx, y = points[i].y - my;
      far[i] = (yy * x * x - 2 * xy * x * y + xx * y * y) / det;
      farthest = std::max(farthest, far[i]);
    }
    const Number area = pi() * farthest * sqrt(det);
    if (best < 0 || area < best) best = area;
    for (std::size_t i = 0; i < n; ++i) weights[i] *= (far[i] + 1) / 3;
  }
  return best;
}

/// Bounds from both ways to the smallest ellipse: neither above the least area.
void expect_bound(const std::vector<Vec2>& points, const Number& least, const Number& tightness) {
  const double bound = fast_smallest_ellipse(points).least_area;
  ASSERT_LE(Number(bound), least) << to_string(points);
  ASSERT_GE(Number(bound), least * (1 - tightness)) << to_string(points);
}

struct Sliver {
  Vec2 a, b;      ///< the ends
  double height;  ///< m, of the others above the line, before they are rounded
};

Sliver random_sliver(SeededRandom& random) {
  const double scale = std::pow(10.0, random.integer(-3, 3));
  const Vec2 shift = random.integer(0, 2) == 0 ? random.in_box(1e6) : Vec2{};
  const Vec2 a = scale * random.in_box(10.0) + shift, b = scale * random.in_box(10.0) + shift;
  return {a, b, scale * std::pow(10.0, random.uniform(-16.0, 0.0))};
}

Vec2 beside(const Sliver& s, double share, double sense) {
  return s.a + share * (s.b - s.a) + sense * s.height * normalized(perp(s.b - s.a));
}

// It was 1.6 % too large for the first one: more than the area of the ellipse that had been found.
TEST(LeastEllipseArea, IsNotAboveThatOfATriangle) {
  expect_bound({{0.1, 0.2}, {10.3, 5.7}, {5.200000000000003, 2.94999999999999}},
               least_of_triangle({{0.1, 0.2}, {10.3, 5.7}, {5.200000000000003, 2.94999999999999}}), Number(1e-13));
  SeededRandom random(test::seed_of_run(81));
  std::size_t judged = 0, thin = 0;
  for (int k = 0; k < 14000; ++k) {
    const Sliver s = random_sliver(random);
    std::vector<Vec2> points{s.a, s.b, beside(s, random.uniform(-0.2, 1.2), 1.0)};
    std::swap(points[0], points[static_cast<std::size_t>(random.integer(0, 2))]);
    const Number least = least_of_triangle(points);
    if (least == 0) {
      EXPECT_EQ(fast_smallest_ellipse(points).least_area, 0.0) << to_string(points);
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(expect_bound(points, least, Number(1e-13)));
    ++judged;
    const Number length2 = squared_norm(points[1] - points[0]) + squared_norm(points[2] - points[0]);
    thin += least < 1e-9 * length2;
  }
  EXPECT_GE(judged, 12000u);
  EXPECT_GE(thin, 4000u);
}

TEST(LeastEllipseArea, IsNotAboveThatOfAParallelogram) {
  SeededRandom random(test::seed_of_run(82));
  std::size_t judged = 0;
  for (int k = 0; k < 3000; ++k) {
    // Whole numbers, so that the fourth corner is exact; then scaled by a power of two.
    const auto whole = [&](double most) { return std::round(random.uniform(-most, most)); };
    const double scale = std::ldexp(1.0, random.integer(-40, 10));
    const Vec2 p{whole(1e9), whole(1e9)}, along{whole(1e6), whole(1e6)};
    const Vec2 across = random.integer(0, 1) == 0 ? Vec2{whole(3), whole(3)} : along + Vec2{whole(3), whole(3)};
    std::vector<Vec2> points{scale * p, scale * (p + along), scale * (p + along + across), scale * (p + across)};
    std::rotate(points.begin(), points.begin() + random.integer(0, 3), points.end());
    const Number doubled = doubled_area(points[0], points[1], points[3]);
    if (doubled == 0) continue;
    ASSERT_NO_FATAL_FAILURE(expect_bound(points, pi() / 2 * doubled, Number(0.2)));
    ++judged;
  }
  EXPECT_GE(judged, 2500u);
}

TEST(LeastEllipseArea, IsNotAboveThatOfAnyPoints) {
  SeededRandom random(test::seed_of_run(83));
  std::size_t judged = 0, of_obstacles = 0;
  for (int k = 0; k < 160; ++k) {
    const Sliver s = random_sliver(random);
    std::vector<Vec2> points{s.a, s.b};
    const int more = random.integer(2, 4);
    for (int i = 0; i < more; ++i)
      points.push_back(beside(s, random.uniform(0.0, 1.0), i % 2 == 0 ? random.uniform(0.3, 1.0) : -1.0));
    const std::vector<Vec2> hull = convex_hull(points).vertices;
    if (hull.size() < 4) continue;
    const Number least = nearly_least_of(hull, 120);
    ASSERT_NO_FATAL_FAILURE(expect_bound(hull, least, Number(0.2)));
    ++judged;
    const ObstacleShapes shapes = shapes_of(Polygon{hull, {}}, {});
    if (!shapes.valid) continue;
    ++of_obstacles;
    EXPECT_LE(Number(shapes.measurements.least_ellipse_area), least) << to_string(hull);
    EXPECT_LE(shapes.measurements.least_ellipse_area, shapes.measurements.ellipse_area) << to_string(hull);
  }
  EXPECT_GE(judged, 60u);
  EXPECT_GE(of_obstacles, 40u);
}

}  // namespace
}  // namespace exactvo::geometry
