// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/facades.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/validity.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::Rational;
using test::SeededRandom;

TEST(Facades, CornersOfARectangleAreKept) {
  const auto set = divide_into_facades(Polygon{{{4, 0}, {4, 3}, {0, 3}, {0, 0}}, {}});
  ASSERT_EQ(set.facades.size(), 4U);
  EXPECT_EQ(set.deviation, 0.0);
  EXPECT_EQ(set.facades[0].a, (Vec2{0, 0}));  // the least corner comes first
  EXPECT_EQ(set.facades[3].b, (Vec2{0, 0}));
}

TEST(Facades, CollinearRunsAreMerged) {
  const auto ring =
      divide_into_facades(Polygon{{{1, 0}, {2, 0}, {4, 0}, {4, 1}, {4, 3}, {2, 3}, {0, 3}, {0, 2}, {0, 0}}, {}});
  EXPECT_EQ(ring.facades.size(), 4U);
  const auto wall = divide_into_facades(Polyline{{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {3, 0}}});
  ASSERT_EQ(wall.facades.size(), 2U);
  EXPECT_EQ(wall.facades[0].b, (Vec2{3, 3}));
  // 0.1, 0.2, 0.3 are not in line with 0.1, 0.2, 0.3 shifted by an ulp: exactness decides.
  const double off = std::nextafter(0.2, 1.0);
  EXPECT_EQ(divide_into_facades(Polyline{{{0.1, 0.1}, {0.2, off}, {0.4, 0.4}}}).facades.size(), 2U);
}

TEST(Facades, ASpikeIsNoStraightWay) {
  const auto spike = divide_into_facades(Polyline{{{0, 0}, {5, 0}, {2, 0}}});
  ASSERT_EQ(spike.facades.size(), 2U);
  EXPECT_EQ(spike.facades[0].b, (Vec2{5, 0}));
}

TEST(Facades, DegenerateObstacles) {
  EXPECT_EQ(divide_into_facades(Polyline{{{1, 2}}}).facades.size(), 1U);
  EXPECT_EQ(divide_into_facades(Polyline{{{1, 2}, {1, 2}}}, {0.5}).facades.size(), 1U);
  EXPECT_EQ(divide_into_facades(Polygon{{{0, 0}, {1, 0}}, {}}, {0.1}).facades.size(), 2U);
  EXPECT_THROW(divide_into_facades(Polyline{}), std::logic_error);
  EXPECT_THROW(divide_into_facades(Polygon{{{0, 0}, {1, 0}, {0, 1}}, {{}}}), std::logic_error);
  EXPECT_THROW(divide_into_facades(Polyline{{{0, 0}, {std::nan(""), 0}}}), std::logic_error);
  EXPECT_THROW(divide_into_facades(Polyline{{{0, 0}, {1, 0}}}, {-1.0}), std::logic_error);
  EXPECT_THROW(divide_into_facades(Polyline{{{0, 0}, {1, 0}}}, {std::numeric_limits<double>::infinity()}),
               std::logic_error);
}

bool within(const Segment& s, Vec2 x, double distance) {
  return test::squared_distance(s, x) <= Rational(distance) * Rational(distance);
}

// Walks along the obstacle's vertices and the facades together: every vertex lies within `deviation` of the facade that
// stands for it, exactly. The facades' ends are vertices, so by convexity every edge does, and by continuity of the
// walk every point of a facade lies that near to the obstacle.
void expect_within(const std::vector<Vec2>& walk, const std::vector<Segment>& facades, double deviation) {
  std::size_t at = 0;
  for (const Segment& facade : facades) {
    ASSERT_EQ(walk.at(at), facade.a);
    while (walk.at(at) != facade.b || at == 0) {
      ASSERT_TRUE(within(facade, walk.at(at), deviation)) << hex_text(deviation) << " " << to_string(facade);
      if (++at == walk.size()) break;
      if (walk.at(at) == facade.b) break;
    }
    ASSERT_LT(at, walk.size()) << "a facade ends off the obstacle";
  }
  EXPECT_EQ(at + 1, walk.size());
}

std::vector<Vec2> closed_walk(Ring ring) {
  std::rotate(
      ring.begin(),
      std::min_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }),
      ring.end());
  ring.push_back(ring.front());
  return ring;
}

// Properties 1 and 2 for rings of many sizes, near and far, and tolerances from nothing to more than the ring.
TEST(Facades, Properties1And2OnRings) {
  SeededRandom random(test::seed_of_run(61));
  int judged = 0;
  for (int i = 0; i < 1500; ++i) {
    const double scale = std::exp2(random.uniform(-10, 10));
    const Ring ring = test::placed(test::star_ring(random, random.integer(3, 60), 0.8), random.uniform(-3, 3), 1.0,
                                   scale, random.in_box(i % 3 == 0 ? 1e6 : 1.0));
    if (!is_simple(ring)) continue;
    const double tolerance = scale * std::exp2(random.uniform(-30, 1));
    SCOPED_TRACE(to_string(ring) + " tolerance " + hex_text(tolerance));
    const auto set = divide_into_facades(Polygon{ring, {}}, {tolerance});
    ASSERT_LE(set.deviation, tolerance);
    if (set.facades.size() > 1) {
      expect_within(closed_walk(ring), set.facades, set.deviation);
      ++judged;
    }
  }
  EXPECT_GT(judged, 700);
}

TEST(Facades, Properties1And2OnWallsThatCrossThemselves) {
  SeededRandom random(test::seed_of_run(62));
  for (int i = 0; i < 1500; ++i) {
    std::vector<Vec2> wall;
    Vec2 at = random.in_box(100.0);
    for (int k = random.integer(2, 80); k > 0; --k) wall.push_back(at += random.in_box(1.0));
    const double tolerance = std::exp2(random.uniform(-12, 3));
    SCOPED_TRACE(to_string(wall) + " tolerance " + hex_text(tolerance));
    const auto set = divide_into_facades(Polyline{wall}, {tolerance});
    ASSERT_LE(set.deviation, tolerance);
    expect_within(wall, set.facades, set.deviation);
  }
}

bool any_two_cross(const std::vector<Segment>& facades) {
  for (std::size_t i = 0; i < facades.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Segment &s = facades[i], &t = facades[j];
      if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) continue;
      if (intersect(s, t)) return true;
    }
  }
  return false;
}

// What plain Douglas-Peucker would break: two rings a hair apart, simplified by far more than that.
TEST(Facades, RingsThatKeptApartDoNotCross) {
  SeededRandom random(test::seed_of_run(63));
  for (int i = 0; i < 100; ++i) {
    const Ring outer = test::star_ring(random, 60, 0.7);
    Ring hole;
    for (auto p = outer.rbegin(); p != outer.rend(); ++p) hole.push_back(0.97 * *p);
    const auto set = divide_into_facades(Polygon{outer, {hole}}, {0.2});
    ASSERT_FALSE(any_two_cross(set.facades)) << to_string(outer);
    ASSERT_LT(set.facades.size(), 110U);
  }
}

// Property 3.
TEST(Facades, Property3StartOfARingDoesNotMatter) {
  SeededRandom random(test::seed_of_run(64));
  for (int i = 0; i < 300; ++i) {
    Ring ring = test::star_ring(random, random.integer(3, 40), 0.8);
    const auto first = divide_into_facades(Polygon{ring, {}}, {0.05});
    std::rotate(ring.begin(), ring.begin() + random.integer(0, static_cast<int>(ring.size()) - 1), ring.end());
    const auto second = divide_into_facades(Polygon{ring, {}}, {0.05});
    ASSERT_EQ(first.facades.size(), second.facades.size());
    ASSERT_EQ(first.deviation, second.deviation);
    for (std::size_t k = 0; k < first.facades.size(); ++k) {
      ASSERT_EQ(first.facades[k].a, second.facades[k].a);
      ASSERT_EQ(first.facades[k].b, second.facades[k].b);
    }
  }
}

TEST(Facades, AToleranceThinsALongRing) {
  Ring circle;
  for (int i = 0; i < 10000; ++i) {
    circle.push_back(10.0 * Vec2{std::cos(2e-4 * kPi * i), std::sin(2e-4 * kPi * i)});
  }
  const auto set = divide_into_facades(Polygon{circle, {}}, {0.05});
  // A chord whose ends lie on radius 10 and that sags by 0.05 spans 2 acos(1 - 0.05 / 10) = 0.2 rad, so at least 31.4
  // of them go round; greedy decimation needs up to twice as many.
  EXPECT_GE(set.facades.size(), 32U);
  EXPECT_LE(set.facades.size(), 64U);
}

}  // namespace
}  // namespace exactvo::geometry
