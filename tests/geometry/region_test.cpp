// SPDX-License-Identifier: GPL-3.0-or-later
// Regions against what is known of their parts: places, areas, pieces, and that nothing rounds.
#include "exactvo/geometry/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/random_shapes.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

const ConvexPolygon kSquare{{{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}}};

Region square() {
  return Region::hull_of(kSquare.vertices);
}
Region shifted(Vec2 by) {
  std::vector<Vec2> corners = kSquare.vertices;
  for (Vec2& c : corners) c += by;
  return Region::hull_of(corners);
}

/// By De Morgan's law: what is left of a large square where neither is.
Region union_of(const Region& a, const Region& b) {
  const Region all = Region::hull_of({{-64.0, -64.0}, {64.0, -64.0}, {64.0, 64.0}, {-64.0, 64.0}});
  return all.difference(all.difference(a).difference(b));
}

/// Certified brackets of numbers that are doubles: nothing between.
void expect_area(const Region& region, double area) {
  EXPECT_EQ(region.area().low, area);
  EXPECT_EQ(region.area().high, area);
}

Region random_hull(SeededRandom& random) {
  std::vector<Vec2> points;
  for (int k = 0; k < 8; ++k) points.push_back({random.integer(-8, 8) * 0.25, random.integer(-8, 8) * 0.25});
  return Region::hull_of(points);
}

TEST(Region, OperationsOfTwoSquares) {
  const Region a = square(), b = shifted({1.0, 1.0});
  expect_area(a, 4.0);
  expect_area(union_of(a, b), 7.0);
  expect_area(a.intersection(b), 1.0);
  expect_area(a.difference(b), 3.0);
  expect_area(b.difference(a), 3.0);
  EXPECT_TRUE(a.difference(a).is_empty());
  EXPECT_TRUE(Region().is_empty());
  expect_area(union_of(Region(), a), 4.0);
  EXPECT_TRUE(Region().intersection(a).is_empty());
}

TEST(Region, PlacesAreExactToAnUlp) {
  const Region a = square();
  EXPECT_EQ(a.locate({2.0, 1.0}), Place::boundary);
  EXPECT_EQ(a.locate({std::nextafter(2.0, 3.0), 1.0}), Place::outside);
  EXPECT_EQ(a.locate({std::nextafter(2.0, 1.0), 1.0}), Place::inside);
  EXPECT_EQ(a.locate({0.0, 0.0}), Place::boundary);
  EXPECT_EQ(Region().locate({0.0, 0.0}), Place::outside);
  // A cut along 3 x = y + 1, which leaves the square between two doubles, the lower of which is a third rounded down.
  const Region cut = a.cut({{-3.0, 1.0}, -1.0});
  EXPECT_EQ(cut.locate({1.0 / 3.0, 0x1p-60}), Place::inside);
  EXPECT_EQ(cut.locate({std::nextafter(1.0 / 3.0, 1.0), 0.0}), Place::outside);
}

TEST(Region, WhatHoldsOfPlacesHoldsOfOperations) {
  SeededRandom random(test::seed_of_run(811));
  int in_both = 0, in_one = 0, in_none = 0;
  for (int i = 0; i < 60; ++i) {
    const Region a = random_hull(random), b = random_hull(random);
    const Region either = union_of(a, b), both = a.intersection(b), rest = a.difference(b);
    for (int k = 0; k < 40; ++k) {
      const Vec2 x{random.integer(-16, 16) * 0.125, random.integer(-16, 16) * 0.125};
      const Place in_a = a.locate(x), in_b = b.locate(x);
      if (in_a == Place::boundary || in_b == Place::boundary) continue;  // regularised: either may be lost
      const bool of_a = in_a == Place::inside, of_b = in_b == Place::inside;
      EXPECT_EQ(either.locate(x) == Place::inside, of_a || of_b);
      EXPECT_EQ(both.locate(x) == Place::inside, of_a && of_b);
      EXPECT_EQ(rest.locate(x) == Place::inside, of_a && !of_b);
      ++(of_a && of_b ? in_both : of_a || of_b ? in_one : in_none);
    }
  }
  EXPECT_GT(in_both, 50);
  EXPECT_GT(in_one, 50);
  EXPECT_GT(in_none, 50);
}

TEST(Region, AreasAddUp) {
  constexpr double kRounded = 1e-12;  // of some brackets of a few ulps
  SeededRandom random(test::seed_of_run(812));
  for (int i = 0; i < 60; ++i) {
    const Region a = random_hull(random), b = random_hull(random);
    const double sum = a.area().low + b.area().low;
    EXPECT_NEAR(union_of(a, b).area().low + a.intersection(b).area().low, sum, kRounded);
    EXPECT_NEAR(a.difference(b).area().low + a.intersection(b).area().low, a.area().low, kRounded);
    EXPECT_LE(a.area().low, a.area().high);
    EXPECT_LE(a.area().high - a.area().low, kRounded);
  }
}

TEST(Region, CutsOneByOneAndAllAtOnceAreTheSame) {
  SeededRandom random(test::seed_of_run(813));
  for (int i = 0; i < 60; ++i) {
    std::vector<HalfPlane> keep;
    for (int k = 0; k < 6; ++k) keep.push_back({random.direction(), random.uniform(-1.5, 0.2)});
    Region one_by_one = square();
    for (const HalfPlane& h : keep) one_by_one = one_by_one.cut(h);
    const Region at_once = Region::cut(kSquare, keep);
    EXPECT_TRUE(one_by_one.difference(at_once).is_empty());
    EXPECT_TRUE(at_once.difference(one_by_one).is_empty());
  }
}

TEST(Region, ACutKeepsTheSideOfTheNormal) {
  const Region right = square().cut({{2.0, 0.0}, 3.0});
  expect_area(right, 1.0);
  EXPECT_EQ(right.locate({1.75, 1.0}), Place::inside);
  EXPECT_EQ(right.locate({1.5, 1.0}), Place::boundary);
  EXPECT_TRUE(square().cut({{1.0, 0.0}, 2.0}).is_empty()) << "an edge has no area";
  expect_area(square().cut({{1.0, 0.0}, 0.0}), 4.0);
  expect_area(square().cut({{0.0, 0.0}, 0.0}), 4.0);
  EXPECT_TRUE(square().cut({{0.0, 0.0}, 1.0}).is_empty());
  EXPECT_TRUE(Region::cut(kSquare, {{{0.0, 0.0}, 1.0}}).is_empty());
}

TEST(Region, PiecesAreLargestFirst) {
  const Region two =
      union_of(square(), shifted({3.0, 2.0})).difference(Region::hull_of({{4.0, 2.0}, {5.0, 2.0}, {5.0, 3.0}}));
  const std::vector<Region::Piece> pieces = two.pieces();
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].area.low, 4.0);
  EXPECT_EQ(pieces[1].area.low, 3.5);
  EXPECT_EQ(pieces[0].polygon.outer.size(), 4U);
  EXPECT_EQ(pieces[1].polygon.outer.size(), 5U);
  EXPECT_EQ(pieces[0].region.locate({1.0, 1.0}), Place::inside);
  EXPECT_EQ(pieces[1].region.locate({1.0, 1.0}), Place::outside);
  EXPECT_TRUE(Region().pieces().empty());
  EXPECT_EQ(union_of(square(), shifted({2.0, 2.0})).pieces().size(), 1U) << "they touch in a corner";
}

TEST(Region, APieceMayHaveAHole) {
  const Region ring = square().difference(Region::hull_of({{0.5, 0.5}, {1.5, 0.5}, {1.5, 1.5}, {0.5, 1.5}}));
  const std::vector<Region::Piece> pieces = ring.pieces();
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].polygon.holes.size(), 1U);
  EXPECT_EQ(pieces[0].area.low, 3.0);
  EXPECT_EQ(ring.locate({1.0, 1.0}), Place::outside);
}

TEST(Region, WhatHasNoAreaIsNothing) {
  EXPECT_TRUE(Region::hull_of({}).is_empty());
  EXPECT_TRUE(Region::hull_of({{1.0, 1.0}}).is_empty());
  EXPECT_TRUE(Region::hull_of({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}).is_empty());
  EXPECT_TRUE(square().intersection(shifted({2.0, 0.0})).is_empty()) << "a common edge";
  expect_area(union_of(square(), shifted({2.0, 0.0})), 8.0);
  EXPECT_EQ(union_of(square(), shifted({2.0, 0.0})).pieces().size(), 1U);
}

TEST(Region, NumbersBeyondTheRangeAreTheCallersMistake) {
  const double nan = std::nan(""), far = 2.0 * kLargestRegionCoordinate;
  for (const double x : {nan, far, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(Region::hull_of({{0.0, 0.0}, {x, 0.0}, {0.0, 1.0}}), std::logic_error);
    EXPECT_THROW(square().cut({{x, 1.0}, 0.0}), std::logic_error);
    EXPECT_THROW(square().cut({{1.0, 1.0}, x}), std::logic_error);
    EXPECT_THROW(Region::cut(kSquare, {{{1.0, 1.0}, x}}), std::logic_error);
    EXPECT_THROW(square().locate({x, 0.0}), std::logic_error);
  }
  const double most = kLargestRegionCoordinate;
  const Region huge = Region::hull_of({{-most, -most}, {most, -most}, {most, most}, {-most, most}});
  expect_area(huge, 4.0 * most * most);
  EXPECT_EQ(huge.locate({most, 0.0}), Place::boundary);
}

}  // namespace
}  // namespace exactvo::geometry
