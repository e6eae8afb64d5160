// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/minkowski.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/validity.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::Rational;
using test::SeededRandom;

ConvexPolygon random_convex(SeededRandom& random, int size, bool on_grid) {
  if (on_grid) return convex_hull(test::grid_points(random, size, 6));
  std::vector<Vec2> cloud;
  for (int i = 0; i < size; ++i) cloud.push_back(random.in_box(1.0));
  const double offset = random.integer(0, 3) == 0 ? 1e6 : 0.0;
  return convex_hull(test::placed(cloud, random.uniform(-3, 3), std::exp2(-random.integer(0, 30)),
                                  std::exp2(random.uniform(-20, 20)), {offset, -offset}));
}

// Collinear vertices and another start: the same set.
ConvexPolygon with_extra_vertices(SeededRandom& random, const ConvexPolygon& p) {
  ConvexPolygon out;
  for (std::size_t i = 0; i < p.vertices.size(); ++i) {
    const Vec2 a = p.vertices[i], b = p.vertices[(i + 1) % p.vertices.size()];
    out.vertices.push_back(a);
    if (random.integer(0, 1) == 1) out.vertices.push_back(0.5 * (a + b));  // exact on the grid
  }
  std::rotate(out.vertices.begin(), out.vertices.begin() + random.integer(0, static_cast<int>(out.vertices.size()) - 1),
              out.vertices.end());
  return out;
}

std::vector<Vec2> every_sum(const ConvexPolygon& a, const ConvexPolygon& b) {
  std::vector<Vec2> sums;
  for (const Vec2 p : a.vertices) {
    for (const Vec2 q : b.vertices) sums.push_back(p + q);
  }
  return sums;
}

// On a grid nothing is rounded: the sum is the hull of all sums of vertices.
TEST(ConvexSum, IsTheHullOfAllSumsOnAGrid) {
  SeededRandom random(test::seed_of_run(71));
  for (int i = 0; i < 60000; ++i) {
    const ConvexPolygon a = random_convex(random, random.integer(1, 9), true);
    const ConvexPolygon b = random_convex(random, random.integer(1, 9), true);
    const ConvexSum sum = minkowski_sum(with_extra_vertices(random, a), with_extra_vertices(random, b));
    ASSERT_EQ(sum.error, 0.0);
    const std::vector<Vec2> expected = convex_hull(every_sum(a, b)).vertices;
    ASSERT_EQ(convex_hull(sum.polygon.vertices).vertices, expected)
        << to_string(a.vertices) << " (+) " << to_string(b.vertices);
    ASSERT_EQ(minkowski_sum(a, b).polygon.vertices.size(), expected.size());
  }
}

Rational exact_support(const std::vector<Vec2>& vertices, Vec2 n) {
  Rational best = Rational(vertices[0].x) * n.x + Rational(vertices[0].y) * n.y;
  for (const Vec2 v : vertices) best = std::max(best, Rational(Rational(v.x) * n.x + Rational(v.y) * n.y));
  return best;
}

// Property 3, in rationals; with the certified error where vertices were rounded.
TEST(ConvexSum, Property3SupportsAddUp) {
  SeededRandom random(test::seed_of_run(72));
  int rounded = 0;
  for (int i = 0; i < 20000; ++i) {
    const ConvexPolygon a = random_convex(random, random.integer(1, 20), false);
    const ConvexPolygon b = random_convex(random, random.integer(1, 20), false);
    const ConvexSum sum = minkowski_sum(a, b);
    rounded += sum.error > 0.0 ? 1 : 0;
    for (int k = 0; k < 8; ++k) {
      const Vec2 n = random.direction();
      const Rational gap =
          exact_support(sum.polygon.vertices, n) - exact_support(a.vertices, n) - exact_support(b.vertices, n);
      // |n| is 1 up to a few ulps.
      ASSERT_LE(CGAL::abs(gap), Rational(sum.error * (1 + 0x1p-40)))
          << to_string(a.vertices) << " (+) " << to_string(b.vertices);
    }
    const auto& v = sum.polygon.vertices;
    for (std::size_t k = 0; k < v.size() && v.size() > 2; ++k) {
      ASSERT_GE(test::turn(v[k], v[(k + 1) % v.size()], v[(k + 2) % v.size()]), 0) << to_string(v);
    }
  }
  EXPECT_GT(rounded, 1000);
}

TEST(ConvexSum, Properties1And2) {
  SeededRandom random(test::seed_of_run(73));
  for (int i = 0; i < 5000; ++i) {
    const ConvexPolygon a = random_convex(random, 8, true);
    const ConvexPolygon b = random_convex(random, 8, true);
    ASSERT_EQ(minkowski_sum(a, b).polygon.vertices, minkowski_sum(b, a).polygon.vertices);
    const Vec2 shift = {3.0, -2.0};
    const ConvexSum moved = minkowski_sum(a, {{shift}});
    ASSERT_EQ(moved.polygon.vertices.size(), a.vertices.size());
    for (const Vec2 p : moved.polygon.vertices) {
      ASSERT_NE(std::find(a.vertices.begin(), a.vertices.end(), p - shift), a.vertices.end());
    }
  }
}

TEST(ConvexSum, ExtremeScales) {
  const ConvexPolygon tiny = {{{0, 0}, {0x1p-600, 0}, {0x1p-600, 0x1p-601}}};
  const ConvexPolygon also = {{{0, 0}, {0x1p-601, 0}, {0x1p-601, 0x1p-602}}};
  EXPECT_EQ(minkowski_sum(tiny, also).polygon.vertices.size(), 3U);  // all edges are parallel and join
  const ConvexPolygon huge = {{{0, 0}, {0x1p900, 0}, {0, 0x1p900}}};
  EXPECT_EQ(minkowski_sum(huge, huge).polygon.vertices.size(), 3U);
  EXPECT_GT(minkowski_sum(huge, tiny).error, 0.0);
}

TEST(ConvexSum, RefusesWhatIsNotConvex) {
  const ConvexPolygon square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  EXPECT_THROW(minkowski_sum(square, {{{0, 0}, {0, 1}, {1, 1}, {1, 0}}}), std::logic_error);  // clockwise
  EXPECT_THROW(minkowski_sum({{{0, 0}, {2, 0}, {1, 0.5}, {2, 2}}}, square), std::logic_error);
  EXPECT_THROW(minkowski_sum({}, square), std::logic_error);
  EXPECT_THROW(minkowski_sum(square, ConvexPolygon{{{std::nan(""), 0}}}), std::logic_error);
  // A pentagram turns left all the way, twice round.
  EXPECT_THROW(minkowski_sum({{{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}}}, square), std::logic_error);
}

// Rounded points: about a hundred ulps of the shape's size.
constexpr double kRounding = 1e-13;

TEST(GrownByPolygon, AnEllipseIsHeldWithinTheStatedError) {
  SeededRandom random(test::seed_of_run(76));
  for (int i = 0; i < 300; ++i) {
    const double size = std::exp2(random.uniform(-10, 10));
    const Ellipse ellipse =
        ellipse_from_axes(size * random.in_box(1.0), {size, size * random.uniform(0.0, 1.0), random.uniform(-1, 1)});
    const OuterShape outer = grown_by_polygon(ellipse, {{{0.0, 0.0}}}, {});
    SCOPED_TRACE(to_string(ConvexShape{ellipse}));
    ASSERT_LE(outer.error, 0x1p-10 * size);
    GrownShape larger = outer.shape;
    larger.radius += kRounding * size;
    for (int k = 0; k < 50; ++k)
      ASSERT_NE(locate(larger, support_point({ellipse, {}, 0.0}, random.direction())), Place::outside);
    const GrownShape reach{ellipse, {}, outer.error - outer.shape.radius + kRounding * size};
    for (const Vec2 x : std::get<ConvexPolygon>(outer.shape.shape).vertices)
      ASSERT_NE(locate(reach, x), Place::outside);
  }
}

}  // namespace
}  // namespace exactvo::geometry
