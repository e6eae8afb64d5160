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

TEST(ConvexSum, IntoMemoryThatIsUsedAgain) {
  SeededRandom random(test::seed_of_run(79));
  ConvexSum again;
  for (int i = 0; i < 2000; ++i) {
    const ConvexPolygon a = random_convex(random, random.integer(1, 9), i % 2 == 0);
    const ConvexPolygon b = random_convex(random, random.integer(1, 9), i % 2 == 0);
    minkowski_sum(a, b, again);
    const ConvexSum once = minkowski_sum(a, b);
    ASSERT_EQ(again.polygon.vertices, once.polygon.vertices);
    ASSERT_EQ(again.error, once.error);
  }
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

Polygon star(SeededRandom& random, int size) {
  return {test::star_ring(random, size, 0.3), {}};
}

Rational area_of(const Polygon& p) {
  Rational sum = test::doubled_area(p.outer);
  for (const Ring& hole : p.holes) sum += test::doubled_area(hole);
  return sum / 2;
}

// Both of CGAL's methods, which share little: the same rings, and every sum of points of the two is inside.
TEST(PolygonSum, ConvolutionAgreesWithDecomposition) {
  SeededRandom random(test::seed_of_run(74));
  for (int i = 0; i < 60; ++i) {
    const Polygon a = star(random, random.integer(3, 12));
    const Polygon b = star(random, random.integer(3, 8));
    const PolygonSum fast = minkowski_sum(a, b);
    const PolygonSum check = minkowski_sum(a, b, SumMethod::decomposition);
    SCOPED_TRACE(to_string(a.outer) + " (+) " + to_string(b.outer));
    ASSERT_LE(fast.error, 1e-15);  // an ulp of each coordinate, below 2 m
    ASSERT_EQ(fast.polygon.holes.size(), check.polygon.holes.size());
    ASSERT_NEAR(CGAL::to_double(area_of(fast.polygon)), CGAL::to_double(area_of(check.polygon)), 1e-12);
    for (int k = 0; k < 100; ++k) {
      const Vec2 p = random.in_box(1.0), q = random.in_box(1.0);
      if (!contains(a, p) || !contains(b, q)) continue;
      ASSERT_LE(signed_distance(fast.polygon, p + q), 1e-15);
    }
  }
}

// A ring-shaped room: what the robot leaves of the hole stays a hole; a robot too big fills it.
TEST(PolygonSum, HolesStayWhileTheyFit) {
  const Polygon room = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{1, 1}, {1, 9}, {9, 9}, {9, 1}}}};
  const auto robot = [](double h) { return Polygon{{{-h, -h}, {h, -h}, {h, h}, {-h, h}}, {}}; };
  for (const SumMethod method : {SumMethod::convolution, SumMethod::decomposition}) {
    const PolygonSum grown = minkowski_sum(room, robot(1), method);
    ASSERT_EQ(grown.polygon.holes.size(), 1U);
    EXPECT_EQ(CGAL::to_double(area_of(grown.polygon)), 144.0 - 36.0);
    EXPECT_EQ(grown.error, 0.0);
    EXPECT_TRUE(minkowski_sum(room, robot(5), method).polygon.holes.empty());
  }
}

TEST(PolygonSum, RefusesInvalidPolygons) {
  const Polygon square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}};
  EXPECT_THROW(minkowski_sum(Polygon{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}, square), std::logic_error);
  EXPECT_THROW(minkowski_sum(square, Polygon{{{0, 0}, {1, 0}}, {}}), std::logic_error);
  EXPECT_THROW(minkowski_sum(square, Polygon{{{0, 0}, {1, 0}, {0, std::nan("")}}, {}}), std::logic_error);
}

Rational squared_distance_to(const Polygon& polygon, Vec2 x) {
  if (contains(polygon, x)) return 0;
  Rational least = test::squared_distance({polygon.outer[0], polygon.outer[0]}, x);
  for (const Segment& e : edges_of(polygon)) least = std::min(least, test::squared_distance(e, x));
  return least;
}

bool near(const Polygon& polygon, Vec2 x, double distance) {
  return squared_distance_to(polygon, x) <= Rational(distance) * Rational(distance);
}

// Inside lies within the exact sum, outside contains it, and both keep the tolerance: membership in rationals.
TEST(OffsetPolygon, CertifiedFromBothSides) {
  SeededRandom random(test::seed_of_run(75));
  for (int i = 0; i < 25; ++i) {
    Polygon polygon = star(random, random.integer(3, 9));
    if (i % 3 == 0) {
      for (auto p = polygon.outer.rbegin(); p != polygon.outer.rend(); ++p) {
        if (polygon.holes.empty()) polygon.holes.emplace_back();
        polygon.holes[0].push_back(0.9 * *p);
      }
    }
    const double radius = random.uniform(0.02, 0.5);
    const double tolerance = radius * std::pow(10.0, random.uniform(-4, -1));
    const PolygonSum in = offset_polygon(polygon, radius, Side::inside, tolerance);
    const PolygonSum out = offset_polygon(polygon, radius, Side::outside, tolerance);
    SCOPED_TRACE(to_string(polygon.outer) + " radius " + hex_text(radius) + " tolerance " + hex_text(tolerance));
    ASSERT_LE(std::max(in.error, out.error), tolerance);
    for (const Vec2 v : in.polygon.outer) ASSERT_TRUE(near(polygon, v, radius));
    for (const Vec2 v : out.polygon.outer) {
      ASSERT_FALSE(near(polygon, v, radius * (1 - 1e-12)));
      ASSERT_TRUE(near(polygon, v, radius + tolerance));
    }
    for (int k = 0; k < 400; ++k) {
      const Vec2 x = random.in_box(1.6);
      const bool exact = near(polygon, x, radius);
      const std::string at = hex_text(x.x) + " " + hex_text(x.y);
      ASSERT_TRUE(exact || !contains(in.polygon, x)) << at;
      ASSERT_TRUE(!exact || contains(out.polygon, x)) << at;
      ASSERT_TRUE(!near(polygon, x, radius - tolerance) || contains(in.polygon, x)) << at;
    }
  }
}

TEST(OffsetPolygon, RefusesWhatItCannotCertify) {
  const Polygon square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}};
  EXPECT_THROW(offset_polygon(square, 0.0, Side::inside, 0.1), std::logic_error);
  EXPECT_THROW(offset_polygon(square, -1.0, Side::inside, 0.1), std::logic_error);
  EXPECT_THROW(offset_polygon(square, 1.0, Side::inside, 0.0), std::logic_error);
  EXPECT_THROW(offset_polygon(square, 1.0, Side::inside, 1e-15), std::logic_error);
  EXPECT_THROW(offset_polygon(square, std::nan(""), Side::outside, 0.1), std::logic_error);
}

// Rounded points: about a hundred ulps of the shape's size.
constexpr double kRounding = 1e-13;

TEST(Outline, StaysWithinItsStatedError) {
  SeededRandom random(test::seed_of_run(76));
  for (int i = 0; i < 300; ++i) {
    const Ellipse ellipse =
        ellipse_from_axes(random.in_box(1.0), {1.0, random.uniform(0.0, 1.0), random.uniform(-1, 1)});
    const GrownShape shape = {i % 2 == 0 ? ConvexShape(ellipse) : ConvexShape(random_convex(random, 6, true)),
                              random.in_box(1.0), random.integer(0, 1) == 0 ? 0.0 : random.uniform(0.01, 2.0)};
    const double tolerance = std::pow(10.0, random.uniform(-6, -1));
    const Outline drawn = outline(shape, tolerance);
    SCOPED_TRACE(to_string(shape.shape) + " radius " + hex_text(shape.radius));
    ASSERT_LE(drawn.error, tolerance);
    const Polygon ring = {drawn.ring, {}};
    for (int k = 0; k < 50; ++k) {
      const Vec2 x = support_point(shape, random.direction());
      double least = 1e9;
      for (const Segment& e : edges_of(ring)) least = std::min(least, distance(e, x));
      ASSERT_LE(least, drawn.error + kRounding);
    }
    for (const Vec2 x : drawn.ring) {
      GrownShape larger = shape;
      larger.radius += kRounding;
      ASSERT_NE(locate(larger, x), Place::outside);
    }
  }
}

TEST(Outline, PolygonsKeepTheirCorners) {
  const GrownShape square = {ConvexPolygon{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, {}, 0.0};
  EXPECT_EQ(outline(square, 0.01).ring.size(), 4U);
  EXPECT_EQ(outline({Disc{{1, 2}, 0.0}, {}, 0.0}, 0.1).ring.size(), 1U);
  EXPECT_THROW(outline(square, 0.0), std::logic_error);
  EXPECT_THROW(outline({Disc{{1, 2}, -1.0}, {}, 0.0}, 0.1), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
