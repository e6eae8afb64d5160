// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

std::vector<Vec2> nasty_cloud(SeededRandom& random) {
  const int n = random.integer(1, 40);
  if (random.integer(0, 2) == 0) return test::grid_points(random, n, 3);
  std::vector<Vec2> cloud;
  for (int i = 0; i < n; ++i) cloud.push_back(random.integer(0, 1) == 0 ? random.direction() : random.in_box(1.0));
  const double offset = std::pow(10.0, random.integer(0, 7));
  return test::placed(cloud, random.uniform(-3, 3), std::pow(10.0, -random.integer(0, 9)), 1.0, {offset, -offset});
}

// Properties: (1) the vertices are among the points; (2) every turn is strictly left; (3) no point lies outside.
TEST(ConvexHull, Properties1To3) {
  SeededRandom random(test::seed_of_run(31));
  for (int i = 0; i < 20000; ++i) {
    const std::vector<Vec2> cloud = nasty_cloud(random);
    const std::vector<Vec2> hull = convex_hull(cloud).vertices;
    SCOPED_TRACE(to_string(cloud));
    const std::size_t n = hull.size();
    ASSERT_GE(n, 1U);
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 a = hull[k], b = hull[(k + 1) % n];
      ASSERT_NE(std::find(cloud.begin(), cloud.end(), a), cloud.end());
      if (n > 2) {
        ASSERT_EQ(test::turn(a, b, hull[(k + 2) % n]), 1);
      }
      for (const Vec2 p : cloud) {
        ASSERT_TRUE(n > 2 ? test::turn(a, b, p) >= 0 : test::on_segment({a, b}, p));
      }
    }
  }
}

TEST(ConvexHull, DegenerateInput) {
  EXPECT_EQ(convex_hull({{2, 3}}).vertices.size(), 1U);
  EXPECT_EQ(convex_hull({{2, 3}, {2, 3}, {2, 3}}).vertices.size(), 1U);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}, {1, 1}}).vertices.size(), 2U);
  EXPECT_EQ(convex_hull({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {2, 1}, {0, 2}}).vertices.size(), 4U);
  EXPECT_THROW(convex_hull({}), std::logic_error);
  EXPECT_THROW(convex_hull({{0, 0}, {std::nan(""), 1}}), std::logic_error);
  EXPECT_THROW(convex_hull({{0, std::numeric_limits<double>::infinity()}}), std::logic_error);
}

bool share_no_interior(const std::vector<ConvexPolygon>& pieces, const Ring& ring) {
  test::Rational sum = 0;
  for (const ConvexPolygon& piece : pieces) sum += test::doubled_area(piece.vertices);
  return sum == test::doubled_area(ring);
}

// Properties: (1) every piece is convex and counter-clockwise; (2) its vertices are the ring's; (3) the areas add up to
// the ring's, exactly. As each piece lies within the ring, (3) says that they cover it without overlap.
void expect_partition(const Ring& ring, PartitionMethod method) {
  const auto pieces = convex_pieces(ring, method);
  SCOPED_TRACE(to_string(ring) + " by method " + std::to_string(static_cast<int>(method)));
  for (const ConvexPolygon& piece : pieces) {
    const auto& v = piece.vertices;
    ASSERT_GE(v.size(), 3U);
    for (std::size_t k = 0; k < v.size(); ++k) {
      ASSERT_GE(test::turn(v[k], v[(k + 1) % v.size()], v[(k + 2) % v.size()]), 0);
      ASSERT_NE(std::find(ring.begin(), ring.end(), v[k]), ring.end());
    }
    ASSERT_GT(test::doubled_area(v), 0);
  }
  ASSERT_TRUE(share_no_interior(pieces, ring));
}

TEST(ConvexPieces, Properties1To3OnStars) {
  SeededRandom random(test::seed_of_run(32));
  for (int i = 0; i < 600; ++i) {
    const Ring ring = test::placed(test::star_ring(random, random.integer(3, 20)), random.uniform(-3, 3), 1.0,
                                   std::exp2(random.uniform(-30, 30)), random.in_box(1e3));
    for (const auto method : {PartitionMethod::greene, PartitionMethod::approximate, PartitionMethod::optimal,
                              PartitionMethod::automatic}) {
      expect_partition(ring, method);
    }
  }
}

// Combs and staircases: collinear vertices, equal coordinates, right angles.
TEST(ConvexPieces, Properties1To3OnRectilinearRings) {
  Ring comb;
  for (int i = 0; i < 8; ++i) {
    comb.push_back({2.0 * i, 0});
    comb.push_back({2.0 * i + 1, 0});
    comb.push_back({2.0 * i + 1, -3});
    comb.push_back({2.0 * i + 2, -3});
  }
  comb.push_back({16, 1});
  comb.push_back({8, 1});
  comb.push_back({0, 1});
  const Ring straight = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  const Ring l_shape = {{0, 0}, {2, 0}, {4, 0}, {4, 1}, {2, 1}, {1, 1}, {1, 4}, {0, 4}, {0, 2}};
  for (const auto method : {PartitionMethod::greene, PartitionMethod::approximate, PartitionMethod::automatic}) {
    expect_partition(comb, method);
    expect_partition(straight, method);
    expect_partition(l_shape, method);
  }
  EXPECT_EQ(convex_pieces(l_shape, PartitionMethod::optimal).size(), 2U);
}

TEST(ConvexPieces, RefusesWhatIsNoSimpleCounterClockwiseRing) {
  EXPECT_THROW(convex_pieces({{0, 0}, {4, 4}, {4, 0}, {0, 4}}), std::logic_error);
  EXPECT_THROW(convex_pieces({{0, 0}, {0, 4}, {4, 4}, {4, 0}}), std::logic_error);
  EXPECT_THROW(convex_pieces({{0, 0}, {1, 1}}), std::logic_error);
  EXPECT_THROW(convex_pieces({{0, 0}, {1, 1}, {2, 2}}), std::logic_error);
  EXPECT_THROW(convex_pieces({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), std::logic_error);
  EXPECT_THROW(convex_pieces({{0, 0}, {1, 0}, {std::nan(""), 1}}), std::logic_error);
}

// The exact smallest circle through two or three points is the least of all: no circle with 1e-9 less holds them.
double oracle_radius(const std::vector<Vec2>& points) {
  double best = std::numeric_limits<double>::infinity();
  const auto consider = [&](Vec2 c) {
    double r = 0;
    for (const Vec2 p : points) r = std::max(r, norm(p - c));
    best = std::min(best, r);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      consider(0.5 * (points[i] + points[j]));
      for (std::size_t k = 0; k < j; ++k) {
        const Vec2 b = points[j] - points[i], c = points[k] - points[i];
        const double d = 2 * cross(b, c);
        if (std::fabs(d) < 1e-6) continue;
        const double bb = squared_norm(b), cc = squared_norm(c);
        consider(points[i] + Vec2{c.y * bb - b.y * cc, b.x * cc - c.x * bb} / d);
      }
    }
  }
  return best;
}

TEST(SmallestCircle, CertifiedAndSmallest) {
  SeededRandom random(test::seed_of_run(33));
  for (int i = 0; i < 2000; ++i) {
    std::vector<Vec2> cloud;
    for (int k = random.integer(2, 9); k > 0; --k) cloud.push_back(random.in_box(1.0));
    const Disc disc = smallest_circle(cloud);
    for (const Vec2 p : cloud) ASSERT_TRUE(test::in_disc(disc, p)) << to_string(cloud);
    ASSERT_LE(disc.radius, oracle_radius(cloud) * (1 + 1e-9)) << to_string(cloud);
  }
}

TEST(SmallestCircle, NastyClouds) {
  SeededRandom random(test::seed_of_run(34));
  for (int i = 0; i < 5000; ++i) {
    const std::vector<Vec2> cloud = nasty_cloud(random);
    const Disc disc = smallest_circle(cloud);
    double widest = 0;
    for (const Vec2 p : cloud) {
      ASSERT_TRUE(test::in_disc(disc, p)) << to_string(cloud);
      for (const Vec2 q : cloud) widest = std::max(widest, norm(p - q));
    }
    // Jung's theorem: the radius is at most width / sqrt 3. Rounding the centre adds an ulp of the coordinates.
    ASSERT_LE(disc.radius, widest / std::sqrt(3.0) * (1 + 1e-9) + 1e7 * 0x1p-51) << to_string(cloud);
  }
  EXPECT_EQ(smallest_circle({{5, 6}}).radius, 0.0);
  EXPECT_EQ(smallest_circle({{0, 0}, {2, 0}}).radius, 1.0);
  EXPECT_THROW(smallest_circle({}), std::logic_error);
  EXPECT_THROW(smallest_circle({{std::nan(""), 0}}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
