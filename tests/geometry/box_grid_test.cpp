// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked up by place is what looking at everything finds; sums rounded up are not below the exact ones.
#include "exactvo/geometry/box_grid.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/obstacle_index.h"
#include "exactvo/geometry/rounding.h"
#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

using test::seed_of_run;
using test::SeededRandom;

/// Mostly small, some of them long, some points.
Box random_box(SeededRandom& random) {
  Box box;
  box.add(random.in_box(20.0));
  const double size = random.integer(0, 9) == 0 ? 30.0 : random.uniform(0.0, 1.0);
  if (random.integer(0, 4) != 0) box.add(box.low + random.in_box(size));
  return box;
}

TEST(BoxGrid, FindsWhatLookingAtEveryBoxFinds) {
  SeededRandom random(seed_of_run(11));
  for (const int count : {0, 1, 2, 17, 300}) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back(random_box(random));
    const BoxGrid grid(boxes);
    for (int k = 0; k < 400; ++k) {
      const Vec2 x = random.in_box(k % 5 == 0 ? 200.0 : 25.0);
      const double reach = k % 7 == 0 ? kInfinity : random.uniform(0.0, 10.0);
      std::vector<std::size_t> found, all;
      grid.for_each_within(x, reach, [&](std::size_t i) { found.push_back(i); });
      for (std::size_t i = 0; i < boxes.size(); ++i)
        if (distance_below(boxes[i], x) <= reach) all.push_back(i);
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, all) << count << " boxes, query " << k;
    }
  }
}

TEST(BoxGrid, ASceneOnALineHasCellsToo) {
  std::vector<Box> boxes(100);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].add(Vec2{static_cast<double>(i), 3.0});
  const BoxGrid grid(boxes);
  std::size_t found = 0;
  grid.for_each_within({50.0, 3.0}, 2.0, [&](std::size_t) { ++found; });
  EXPECT_EQ(found, 5u);
}

TEST(BoxGrid, ABoxAtTheEndOfTheReachIsFound) {
  // Points where cells begin (their side is 1 m), looked at from as far as `distance_below` says.
  std::vector<Box> boxes(33);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].add(Vec2{2.0 * static_cast<double>(i), 3.0});
  boxes.pop_back();
  boxes.back().high.x = boxes.back().low.x = 64.0;
  const BoxGrid grid(boxes);
  SeededRandom random(seed_of_run(14));
  for (int k = 0; k < 2000; ++k) {
    const Vec2 x{random.uniform(-1.0, 65.0), 3.0};
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      bool found = false;
      grid.for_each_within(x, distance_below(boxes[i], x), [&](std::size_t j) { found = found || i == j; });
      ASSERT_TRUE(found) << i << " from " << x.x;
    }
  }
}

TEST(BoxGrid, ExtentsWhoseSquareOverflowsHaveFewCells) {
  for (const double far : {1e150, 1e200, 1e308}) {
    std::vector<Box> boxes;
    for (const Vec2 corner : {Vec2{-far, -far}, Vec2{far, far}, Vec2{-far, far}, Vec2{0, 0}}) {
      boxes.emplace_back().add(corner);
    }
    const BoxGrid grid(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      std::vector<std::size_t> found;
      grid.for_each_within(boxes[i].low, 1.0, [&](std::size_t j) { found.push_back(j); });
      EXPECT_EQ(found, std::vector<std::size_t>{i}) << far;
    }
    std::size_t all = 0;
    grid.for_each_within({0, 0}, kInfinity, [&](std::size_t) { ++all; });
    EXPECT_EQ(all, boxes.size()) << far;
  }
}

TEST(Box, DistanceBelowIsNeverAboveTheTrueDistance) {
  SeededRandom random(seed_of_run(15));
  const auto number = [&](int exponent) { return std::ldexp(random.uniform(-1.0, 1.0), exponent); };
  int tight = 0;
  for (int k = 0; k < 20000; ++k) {
    const int exponent = random.integer(-1074, 1024);
    Box box;
    box.add(Vec2{number(exponent), number(exponent)});
    if (k % 3 == 0) box.add(Vec2{number(exponent), number(exponent)});
    const Vec2 x{number(exponent - random.integer(0, 60)), number(exponent - random.integer(0, 60))};
    const auto away = [](double low, double high, double at) {
      const mpq_class below = mpq_class(low) - mpq_class(at), above = mpq_class(at) - mpq_class(high);
      return std::max({below, above, mpq_class(0)});
    };
    const mpq_class dx = away(box.low.x, box.high.x, x.x), dy = away(box.low.y, box.high.y, x.y);
    const double found = distance_below(box, x);
    ASSERT_TRUE(std::isfinite(found));
    const mpq_class squared = dx * dx + dy * dy;
    ASSERT_LE(mpq_class(found) * mpq_class(found), squared) << found << " at 2^" << exponent;
    // Not far below either, where doubles have all their bits and range.
    if (exponent < -380 || exponent > 1000) continue;
    const mpq_class up = mpq_class(found) * mpq_class(1.0 + 0x1p-48);
    ASSERT_GE(up * up, squared) << found << " at 2^" << exponent;
    tight += sgn(squared) > 0;
  }
  EXPECT_GT(tight, 5000);
  EXPECT_EQ(distance_below({}, {1.0, 2.0}), kInfinity);
}

TEST(Box, HoldsItsShapeAndIsNotMuchLarger) {
  SeededRandom random(seed_of_run(12));
  for (int k = 0; k < 2000; ++k) {
    const Vec2 c = random.in_box(100.0);
    const double a = random.uniform(0.0, 5.0);
    for (const ConvexShape& shape :
         {ConvexShape{Disc{c, a}}, ConvexShape{Ellipse{c, a, random.uniform(-3, 3), random.uniform(0, 3)}},
          ConvexShape{Segment{c, c + random.in_box(3)}}}) {
      const Box box = box_of(shape);
      for (const Vec2 n : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}}) {
        const double reach = n.x > 0 ? box.high.x : n.x < 0 ? -box.low.x : n.y > 0 ? box.high.y : -box.low.y;
        const GrownShape s{shape, {}, 0.0};
        EXPECT_NE(sign_of_support(s, n, 1.0, reach), Sign::positive) << to_string(shape);
        EXPECT_LT(reach - support(s, n).h, 1e-12 * (1.0 + std::fabs(reach)));
      }
    }
  }
}

/// Rectangles with a hole, walls and triangles.
std::vector<Obstacle> scene(SeededRandom& random) {
  std::vector<Obstacle> all;
  for (int i = 0; i < 12; ++i) {
    const Vec2 c = random.in_box(12.0);
    const double w = random.uniform(0.5, 3.0);
    switch (i % 3) {
      case 0:
        all.push_back(Polygon{{c, c + Vec2{w, 0}, c + Vec2{w, w}, c + Vec2{0, w}},
                              {{c + Vec2{0.2 * w, 0.2 * w}, c + Vec2{0.2 * w, 0.8 * w}, c + Vec2{0.8 * w, 0.5 * w}}}});
        break;
      case 1:
        all.push_back(Polyline{{c, c + random.in_box(3), c + random.in_box(3)}});
        break;
      default:
        all.push_back(Polygon{{c, c + Vec2{w, 0}, c + Vec2{0, w}}, {}});
    }
  }
  return all;
}

TEST(ObstacleIndex, GivesTheSweptDistanceBitForBit) {
  SeededRandom random(seed_of_run(13));
  for (int k = 0; k < 40; ++k) {
    for (const Obstacle& o : scene(random)) {
      const ObstacleIndex index(o);
      for (int q = 0; q < 40; ++q) {
        const Vec2 from = random.in_box(q % 10 == 0 ? 60.0 : 14.0);
        const Segment path{from, q % 9 == 0 ? from : from + random.in_box(q % 4 == 0 ? 8.0 : 0.3)};
        const double least = swept_distance(o, path);
        ASSERT_EQ(index.swept_distance(path, kInfinity), least) << to_string(ConvexShape{path});
        const double enough = random.uniform(0.0, 4.0);
        const double within = index.swept_distance(path, enough);
        if (least < enough) {
          ASSERT_EQ(within, least);
        } else {
          ASSERT_GE(within, enough);
        }
      }
    }
  }
}

/// A comb whose teeth are as high as itself: every edge crosses every height.
TEST(ObstacleIndex, PreparesLongEdgesInMemoryThatGrowsWithTheirNumber) {
  constexpr int kTeeth = 20000;
  Ring ring;
  for (int i = 0; i < kTeeth; ++i) {
    ring.push_back({2.0 * i, 0.0});
    ring.push_back({2.0 * i + 1.0, 1000.0});
  }
  ring.push_back({2.0 * kTeeth, -1.0});
  ring.push_back({0.0, -1.0});
  const Obstacle comb = Polygon{ring, {}};
  const ObstacleIndex index(comb);
  for (const Segment path :
       {Segment{{3.0, 900.0}, {3.1, 900.0}}, Segment{{2.0, 500.0}, {2.0, 500.1}}, Segment{{-5.0, 3.0}, {-4.0, 3.0}}})
    EXPECT_EQ(index.swept_distance(path, kInfinity), swept_distance(comb, path));
}

TEST(RoundedUpSum, IsNotBelowTheExactSum) {
  SeededRandom random(seed_of_run(14));
  for (int k = 0; k < 20000; ++k) {
    const double scale = std::ldexp(1.0, random.integer(-1060, 900));
    const Vec2 n = random.direction(), v = scale * random.in_box(1.0);
    const double c = scale * random.uniform(-1.0, 1.0) * (k % 3 == 0 ? 1e-16 : 1.0);
    const double up = rounded_up_sum(c + dot(n, v), product_magnitude(1.0, c) + dot_magnitude(n, v), 4.0);
    const mpq_class exact = mpq_class(c) + mpq_class(n.x) * mpq_class(v.x) + mpq_class(n.y) * mpq_class(v.y);
    ASSERT_GE(mpq_class(up), exact) << hex_text(c) << " " << hex_text(v.x) << " " << hex_text(v.y);
  }
}

TEST(RoundedUpSum, AddsNothingToZero) {
  EXPECT_EQ(rounded_up_sum(0.0, dot_magnitude({1, 0}, {0, 5}), 4.0), 0.0);
  // A product that underflows is seen to be there.
  EXPECT_GT(rounded_up_sum(0.0, dot_magnitude({0x1p-600, 0}, {0x1p-600, 0}), 4.0), 0.0);
}

}  // namespace
}  // namespace exactvo::geometry
