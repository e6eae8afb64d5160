// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/pi.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::Rational;
using test::SeededRandom;

// What a laser in the middle of a room of 8 m by 6 m sees.
std::vector<Vec2> room_scan(SeededRandom& random, int beams, double noise) {
  std::vector<Vec2> hits;
  for (int i = 0; i < beams; ++i) {
    const double angle = 2 * kPi * i / beams;
    const double c = std::cos(angle), s = std::sin(angle);
    const double range = std::min(4.0 / std::max(std::fabs(c), 1e-9), 3.0 / std::max(std::fabs(s), 1e-9));
    hits.push_back((range + random.uniform(-noise, noise)) * Vec2{c, s});
  }
  return hits;
}

// Properties: (1) every finite hit has a facade, no other has; (2) it lies within `deviation` of it, in rationals;
// (3) deviation <= tolerance; (4) the ends of facades are hits.
void expect_properties(const std::vector<Vec2>& hits, const DividedPoints& divided, double tolerance) {
  SCOPED_TRACE(to_string(hits) + " tolerance " + hex_text(tolerance));
  ASSERT_EQ(divided.facade_of.size(), hits.size());
  ASSERT_LE(divided.deviation, tolerance);
  const Rational bound = Rational(divided.deviation) * Rational(divided.deviation);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ASSERT_EQ(divided.facade_of[i].has_value(), is_finite(hits[i]));
    if (!is_finite(hits[i])) continue;
    ASSERT_LT(*divided.facade_of[i], divided.facades.size());
    ASSERT_LE(test::squared_distance(divided.facades[*divided.facade_of[i]], hits[i]), bound);
  }
  for (const Segment& f : divided.facades) {
    ASSERT_NE(std::find(hits.begin(), hits.end(), f.a), hits.end());
    ASSERT_NE(std::find(hits.begin(), hits.end(), f.b), hits.end());
  }
}

TEST(DivideScan, ARoomHasFourWalls) {
  SeededRandom random(test::seed_of_run(91));
  const auto hits = room_scan(random, 720, 0.01);
  const auto divided = divide_scan(hits);
  expect_properties(hits, divided, 0.05);
  // Four walls; the scan starts in the middle of one, and a noisy corner may cost a facade more.
  EXPECT_GE(divided.facades.size(), 5U);
  EXPECT_LE(divided.facades.size(), 9U);
}

TEST(DivideScan, CutsAtRangeJumpsAndMissingReturns) {
  const double nan = std::nan("");
  const std::vector<Vec2> hits = {{0, 0}, {0.1, 0}, {0.2, 0}, {2, 0}, {2.1, 0}, {nan, nan}, {2.2, 0}, {9, 9}};
  const auto divided = divide_scan(hits);
  expect_properties(hits, divided, 0.05);
  ASSERT_EQ(divided.facades.size(), 4U);
  EXPECT_EQ(divided.facades[0].b, (Vec2{0.2, 0}));
  EXPECT_EQ(divided.facades[1].b, (Vec2{2.1, 0}));
  EXPECT_EQ(divided.facades[2].a, divided.facades[2].b);  // a lone hit
  EXPECT_EQ(divided.facades[3].a, (Vec2{9, 9}));
  EXPECT_TRUE(divide_scan({}).facades.empty());
  EXPECT_TRUE(divide_scan({{nan, 0}}).facades.empty());
}

// Along curved walls the farthest hit is not where one would cut: splitting alone leaves more facades than are needed.
TEST(DivideScan, MergesWhatSplittingCutTooOften) {
  SeededRandom random(test::seed_of_run(96));
  std::size_t apart = 0;
  std::size_t joined = 0;
  for (int i = 0; i < 50; ++i) {
    std::vector<Vec2> wall;
    const double bend = random.uniform(0.5, 2.0);
    for (int k = 0; k <= 200; ++k) {
      const double x = 0.02 * k;
      wall.push_back({x, std::sin(bend * x) + random.uniform(-0.02, 0.02)});
    }
    const auto merged = divide_scan(wall, {0.3, 0.05, 1.5});
    expect_properties(wall, merged, 0.05);
    joined += merged.facades.size();
    apart += divide_scan(wall, {0.3, 0.05, 0.0}).facades.size();
  }
  EXPECT_LT(joined, apart);
}

TEST(DivideScan, PropertiesOnRandomWalks) {
  SeededRandom random(test::seed_of_run(92));
  for (int i = 0; i < 1500; ++i) {
    std::vector<Vec2> hits;
    Vec2 at = random.in_box(i % 4 == 0 ? 1e6 : 1.0);
    for (int k = random.integer(1, 80); k > 0; --k) {
      if (random.integer(0, 19) == 0) hits.push_back({std::nan(""), 1.0});
      hits.push_back(at += random.in_box(0.3));
    }
    ScanOptions options;
    options.tolerance = std::exp2(random.uniform(-10, 2));
    options.range_jump = random.uniform(0.1, 0.6);
    expect_properties(hits, divide_scan(hits, options), options.tolerance);
  }
}

TEST(DivideScan, RefusesBadOptions) {
  EXPECT_THROW(divide_scan({{0, 0}}, {0.0, 0.05, 0.1}), std::logic_error);
  EXPECT_THROW(divide_scan({{0, 0}}, {0.3, -1.0, 0.1}), std::logic_error);
  EXPECT_THROW(divide_scan({{0, 0}}, {0.3, 0.05, 4.0}), std::logic_error);
  EXPECT_THROW(divide_scan({{0, 0}}, {0.3, std::nan(""), 0.1}), std::logic_error);
}

std::vector<Vec2> shuffled(SeededRandom& random, std::vector<Vec2> points) {
  for (std::size_t i = points.size(); i > 1; --i) {
    std::swap(points[i - 1], points[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  }
  return points;
}

TEST(DividePoints, FindsTheWallsOfARoomInAnyOrder) {
  SeededRandom random(test::seed_of_run(93));
  for (int i = 0; i < 20; ++i) {
    const auto points = shuffled(random, room_scan(random, 720, 0.01));
    const auto divided = divide_points(points);
    expect_properties(points, divided, 0.05);
    const auto is_long = [](const Segment& f) { return norm(f.b - f.a) > 2.0; };
    EXPECT_GE(std::count_if(divided.facades.begin(), divided.facades.end(), is_long), 4);
    EXPECT_LE(divided.facades.size(), 40U);
  }
}

TEST(DividePoints, PropertiesOnNastyClouds) {
  SeededRandom random(test::seed_of_run(94));
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec2> points = i % 2 == 0 ? test::grid_points(random, random.integer(1, 60), 5) : std::vector<Vec2>{};
    for (int k = random.integer(0, 40); k > 0; --k) points.push_back(random.in_box(2.0));
    points = test::placed(points, random.uniform(-3, 3), 1.0, 0.2, random.in_box(i % 3 == 0 ? 1e6 : 1.0));
    if (i % 5 == 0) points.push_back({std::nan(""), 0});
    expect_properties(points, divide_points(points), 0.05);
  }
}

TEST(DividePoints, IsDeterministic) {
  SeededRandom random(test::seed_of_run(95));
  const auto points = shuffled(random, room_scan(random, 300, 0.02));
  const auto a = divide_points(points);
  const auto b = divide_points(points);
  ASSERT_EQ(a.facades.size(), b.facades.size());
  EXPECT_EQ(a.facade_of, b.facade_of);
}

TEST(DividePoints, DegenerateInput) {
  EXPECT_TRUE(divide_points({}).facades.empty());
  EXPECT_EQ(divide_points({{1, 1}}).facades.size(), 1U);
  EXPECT_EQ(divide_points(std::vector<Vec2>(20, Vec2{3, 4})).deviation <= 0.05, true);
  std::vector<Vec2> line;
  for (int i = 0; i < 50; ++i) line.push_back({0.1 * ((7 * i) % 50), 1e7});
  EXPECT_EQ(divide_points(line).facades.size(), 1U);
  EXPECT_THROW(divide_points({{0, 0}}, {0.0, 0.05, 0.4, 3}), std::logic_error);
  EXPECT_THROW(divide_points({{0, 0}}, {0.3, 0.0, 0.4, 3}), std::logic_error);
  EXPECT_THROW(divide_points({{0, 0}}, {0.3, 0.05, 2.0, 3}), std::logic_error);
  EXPECT_THROW(divide_points({{0, 0}}, {0.3, 0.05, 0.4, 1}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
