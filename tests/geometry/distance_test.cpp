// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

/// "A few ulps of the coordinates": the foot point is off by at most 10 u M, the norm by a few u of the distance.
constexpr double kFewUlps = 32 * 0x1p-53;

double scale_of(const Segment& s, Vec2 x) {
  return std::max(
      {std::fabs(s.a.x), std::fabs(s.a.y), std::fabs(s.b.x), std::fabs(s.b.y), std::fabs(x.x), std::fabs(x.y)});
}

double oracle(const Segment& s, Vec2 x) {
  return std::sqrt(CGAL::to_double(test::squared_distance(s, x)));
}

Segment random_segment(SeededRandom& random) {
  const double scale = std::exp2(random.uniform(-20, 20));
  const Vec2 offset = random.in_box(random.integer(0, 1) == 0 ? 0.0 : 1e5);
  const Vec2 a = scale * random.in_box(1.0) + offset;
  return {a, random.integer(0, 9) == 0 ? a : scale * random.in_box(1.0) + offset};
}

TEST(Distance, AgreesWithRationals) {
  SeededRandom random(test::seed_of_run(21));
  for (int i = 0; i < 100000; ++i) {
    const Segment s = random_segment(random);
    const Vec2 x = random.integer(0, 1) == 0 ? random_segment(random).a : s.a + random.uniform(-1, 2) * (s.b - s.a);
    ASSERT_NEAR(distance(s, x), oracle(s, x), kFewUlps * scale_of(s, x))
        << to_string(s) << " to " << hex_text(x.x) << " " << hex_text(x.y);
  }
}

TEST(Distance, NeitherOverflowsNorUnderflows) {
  const Segment tiny = {{0x1p-600, 0}, {0x1p-599, 0}};
  EXPECT_DOUBLE_EQ(distance(tiny, Vec2{0x1p-600, 0x1p-600}), 0x1p-600);
  const Segment huge = {{-0x1p600, 0}, {0x1p600, 0}};
  EXPECT_DOUBLE_EQ(distance(huge, Vec2{0, 0x1p590}), 0x1p590);
  EXPECT_EQ(nearest_point({{3, 4}, {3, 4}}, {0, 0}), (Vec2{3, 4}));
}

TEST(NearestOn, IsWithinTheSegmentAndNearest) {
  EXPECT_EQ(nearest_share({1, 1}, {5, 1}, {2, 7}), 0.25);
  EXPECT_EQ(nearest_on({1, 1}, {5, 1}, {2, 7}), (Vec2{2, 1}));
  EXPECT_EQ(nearest_on({1, 1}, {5, 1}, {0, 0}), (Vec2{1, 1}));
  EXPECT_EQ(nearest_on({1, 1}, {5, 1}, {9, 2}), (Vec2{5, 1}));
  EXPECT_EQ(nearest_on({3, 4}, {3, 4}, {0, 0}), (Vec2{3, 4}));
}

/// Squares rule out three of the four lengths, and change no bit: at every scale, with ties, and where squares
/// overflow.
TEST(Distance, BetweenSegmentsIsTheLeastOfTheFourFromEnds) {
  test::SeededRandom random(test::seed_of_run(7));
  int apart = 0;
  for (int k = 0; k < 20000; ++k) {
    const double scale = k % 3 == 0 ? 1.0 : std::ldexp(1.0, random.integer(-1060, 900));
    const auto point = [&] {
      const Vec2 p =
          k % 2 == 0 ? random.in_box(4.0) : Vec2{std::round(random.in_box(3.0).x), std::round(random.in_box(3.0).y)};
      return scale * p;
    };
    const Segment s{point(), point()}, t{point(), k % 5 == 0 ? s.b : point()};
    if (intersect(s, t)) {
      EXPECT_EQ(distance(s, t), 0.0);
      continue;
    }
    ++apart;
    EXPECT_EQ(distance(s, t), std::min({distance(s, t.a), distance(s, t.b), distance(t, s.a), distance(t, s.b)}))
        << "case " << k;
  }
  EXPECT_GT(apart, 5000);
}

TEST(Distance, IntersectIsExactOnAGrid) {
  SeededRandom random(test::seed_of_run(22));
  for (int i = 0; i < 100000; ++i) {
    const auto p = test::grid_points(random, 4, 4);
    const Segment s = {p[0], p[1]};
    const Segment t = {p[2], p[3]};
    ASSERT_EQ(intersect(s, t), test::segments_meet(s, t)) << to_string(s) << " and " << to_string(t);
    ASSERT_EQ(intersect(s, t), intersect(t, s));
    if (intersect(s, t)) {
      ASSERT_EQ(distance(s, t), 0.0);
    }
  }
}

TEST(Distance, IntersectIsExactWhereOrientationIsHard) {
  SeededRandom random(test::seed_of_run(23));
  for (int i = 0; i < 20000; ++i) {
    // An end within an ulp or so of the other segment.
    const Segment s = random_segment(random);
    const Vec2 near = s.a + random.uniform(0, 1) * (s.b - s.a);
    const Segment t = {near, random_segment(random).a};
    ASSERT_EQ(intersect(s, t), test::segments_meet(s, t)) << to_string(s) << " and " << to_string(t);
  }
}

// An independent crossing count: the ray runs downwards instead of to the right.
Place oracle_place(const Polygon& polygon, Vec2 x) {
  bool odd = false;
  for (const Segment& e : edges_of(polygon)) {
    if (test::on_segment(e, x)) return Place::boundary;
    const Vec2 left = e.a.x < e.b.x ? e.a : e.b;
    const Vec2 right = e.a.x < e.b.x ? e.b : e.a;
    if (left.x <= x.x && x.x < right.x && test::turn(left, right, x) > 0) odd = !odd;
  }
  return odd ? Place::inside : Place::outside;
}

TEST(Distance, LocateIsExactOnDegenerateRings) {
  SeededRandom random(test::seed_of_run(24));
  for (int i = 0; i < 50000; ++i) {
    Polygon polygon = {test::grid_points(random, random.integer(2, 7), 4), {}};
    if (random.integer(0, 1) == 1) polygon.holes.push_back(test::grid_points(random, 3, 4));
    const Vec2 x = test::grid_points(random, 1, 4)[0];
    ASSERT_EQ(locate(polygon, x), oracle_place(polygon, x))
        << to_string(polygon.outer) << " at " << hex_text(x.x) << " " << hex_text(x.y);
    ASSERT_EQ(contains(polygon, x), oracle_place(polygon, x) != Place::outside);
  }
}

const Polygon kSquareWithHole = {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{{1, 1}, {1, 3}, {3, 3}, {3, 1}}}};

TEST(SignedDistance, SignAndDepth) {
  EXPECT_DOUBLE_EQ(signed_distance(kSquareWithHole, {5, 2}), 1.0);
  EXPECT_DOUBLE_EQ(signed_distance(kSquareWithHole, {0.25, 2}), -0.25);
  EXPECT_DOUBLE_EQ(signed_distance(kSquareWithHole, {2, 2}), 1.0);  // in the hole: free
  EXPECT_EQ(signed_distance(kSquareWithHole, {4, 1}), 0.0);
  EXPECT_DOUBLE_EQ(signed_distance(Polyline{{{0, 0}, {0, 4}}}, {-3, 8}), 5.0);
  EXPECT_THROW(signed_distance(kSquareWithHole, {std::nan(""), 0}), std::logic_error);
}

TEST(SweptDistance, AStepAcrossAThinWallDoesNotSlipThrough) {
  const Polyline wall = {{{1, -1}, {1, 1}}};
  EXPECT_EQ(swept_distance(wall, Segment{{0, 0}, {100, 0}}), 0.0);
  EXPECT_EQ(swept_distance(wall, Segment{{0, 0}, {1, 0}}), 0.0);
  EXPECT_DOUBLE_EQ(swept_distance(wall, Segment{{0, 2}, {2, 2}}), 1.0);
  const Polygon sliver = {{{1, -1}, {1 + 0x1p-52, -1}, {1 + 0x1p-52, 1}, {1, 1}}, {}};
  EXPECT_EQ(swept_distance(sliver, Segment{{0, 0.1}, {2, 0.2}}), 0.0);
}

TEST(SweptDistance, InsideAtEitherEndIsNegative) {
  EXPECT_LT(swept_distance(kSquareWithHole, Segment{{-2, 2}, {0.5, 2}}), 0.0);
  EXPECT_LT(swept_distance(kSquareWithHole, Segment{{0.5, 2}, {-2, 2}}), 0.0);
  EXPECT_DOUBLE_EQ(swept_distance(kSquareWithHole, Segment{{0.5, 2}, {0.25, 2}}), -0.5);
  EXPECT_EQ(swept_distance(kSquareWithHole, Segment{{-1, 2}, {5, 2}}), 0.0);
}

TEST(SweptDistance, NeverAboveAnySample) {
  SeededRandom random(test::seed_of_run(25));
  for (int i = 0; i < 3000; ++i) {
    const Polygon polygon = {test::star_ring(random, random.integer(3, 12)), {}};
    const Segment path = {random.in_box(2.0), random.in_box(2.0)};
    const double swept = swept_distance(polygon, path);
    for (int k = 0; k <= 16; ++k) {
      const double at = signed_distance(polygon, path.a + (k / 16.0) * (path.b - path.a));
      // Between the ends only the fact of being inside is reported, not the depth.
      ASSERT_LE(swept, std::max(at, 0.0) + 1e-14) << to_string(polygon.outer) << " path " << to_string(path);
    }
  }
}

TEST(SweptDistance, TwoMovingPointsAreNeverNearerThanTheBound) {
  SeededRandom random(test::seed_of_run(26));
  for (int i = 0; i < 10000; ++i) {
    const Segment a = {random.in_box(2.0), random.in_box(2.0)};
    const Segment b = {random.in_box(2.0), random.in_box(2.0)};
    double least = 1e9;
    for (int k = 0; k <= 256; ++k) {
      const double t = k / 256.0;
      least = std::min(least, norm(a.a + t * (a.b - a.a) - b.a - t * (b.b - b.a)));
    }
    const double swept = swept_distance(a, b);
    ASSERT_LE(swept, least + 1e-14) << to_string(a) << " and " << to_string(b);
    ASSERT_GE(swept, least - 12.0 / 256.0);  // they close in at most at 12 m a step's unit time
  }
  EXPECT_EQ(swept_distance(Segment{{0, 0}, {2, 0}}, Segment{{2, 0}, {0, 0}}), 0.0);
}

// Whether `computed` is within `bound` of the root of `squared`, in rationals.
bool is_within(double computed, const test::Rational& squared, double bound) {
  const test::Rational low = test::Rational(computed) - test::Rational(bound);
  const test::Rational high = test::Rational(computed) + test::Rational(bound);
  return (low <= 0 || low * low <= squared) && high * high >= squared;
}

test::Rational squared_distance(const Segment& s, const Segment& t) {
  if (test::segments_meet(s, t)) return 0;
  return std::min({test::squared_distance(s, t.a), test::squared_distance(s, t.b), test::squared_distance(t, s.a),
                   test::squared_distance(t, s.b)});
}

Segment hard_segment(SeededRandom& random, Vec2 offset) {
  const Vec2 a = offset + random.in_box(1.0);
  return {a, a + std::exp2(random.uniform(-40, 2)) * random.direction()};
}

double largest_coordinate(const Segment& s, const Segment& t) {
  double largest = 0.0;
  for (const Vec2 p : {s.a, s.b, t.a, t.b}) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

TEST(RoundingOfDistance, BoundsSegmentsNearAndFar) {
  SeededRandom random(test::seed_of_run(27));
  for (int i = 0; i < 40000; ++i) {
    const Vec2 offset = std::pow(10.0, random.integer(-3, 7)) * random.direction();
    const Segment s = hard_segment(random, offset), t = hard_segment(random, offset);
    const double bound = rounding_of_distance(largest_coordinate(s, t));
    ASSERT_TRUE(is_within(distance(s, t), squared_distance(s, t), bound)) << to_string(s) << " and " << to_string(t);
  }
}

test::Rational squared_swept(const Segment& a, const Segment& b) {
  const auto difference = [](Vec2 p, Vec2 q) {
    return test::RationalPoint{test::Rational(p.x) - test::Rational(q.x), test::Rational(p.y) - test::Rational(q.y)};
  };
  const test::RationalPoint from = difference(a.a, b.a), to = difference(a.b, b.b);
  const test::Rational dx = to.x - from.x, dy = to.y - from.y, length2 = dx * dx + dy * dy;
  test::Rational t = 0;
  if (length2 > 0) t = -(from.x * dx + from.y * dy) / length2;
  t = std::max(test::Rational(0), std::min(test::Rational(1), t));
  const test::Rational x = from.x + t * dx, y = from.y + t * dy;
  return x * x + y * y;
}

TEST(RoundingOfDistance, BoundsPathsNearAndFar) {
  SeededRandom random(test::seed_of_run(28));
  for (int i = 0; i < 40000; ++i) {
    const Vec2 offset = std::pow(10.0, random.integer(-3, 7)) * random.direction();
    const Segment a = hard_segment(random, offset), b = hard_segment(random, offset);
    const double bound = rounding_of_distance(largest_coordinate(a, b));
    ASSERT_TRUE(is_within(swept_distance(a, b), squared_swept(a, b), bound)) << to_string(a) << " and " << to_string(b);
  }
}

TEST(RoundingOfDistance, IsSmallAndRefusesNonsense) {
  EXPECT_LT(rounding_of_distance(1e4), 1e-9);
  EXPECT_GT(rounding_of_distance(0.0), 0.0);
  EXPECT_THROW(rounding_of_distance(-1.0), std::logic_error);
  EXPECT_THROW(rounding_of_distance(std::nan("")), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
