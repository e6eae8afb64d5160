// SPDX-License-Identifier: GPL-3.0-or-later
// Predicate A and the rounded support function against bracketed roots.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/infinity.h"
#include "geometry/exact_oracle.h"
#include "geometry/random_grown.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::HalfPlane;
using geometry::Segment;
using geometry::Sign;
using geometry::sign_of_support;
using geometry::Vec2;

int as_int(Sign s) {
  return static_cast<int>(s);
}

using geometry::kInfinity;

TEST(SignOfSupport, AgreesWithBracketedRoots) {
  SeededRandom random(seed_of_run(11));
  for (int i = 0; i < 100000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 n = std::ldexp(1.0, random.integer(-20, 20)) * random.direction();
    const double tau = random.uniform(0.1, 10.0);
    // The second half asks at the rounded value itself, where the filter can't answer.
    const double c = i % 2 == 0 ? scene.size * random.uniform(-3.0, 3.0) : support(scene.s, n).h / tau;
    ASSERT_EQ(as_int(sign_of_support(scene.s, n, tau, c)), sign_of_support_minus(scene.s, exactly(n), Q(tau) * Q(c)))
        << to_string(scene.s.shape);
  }
}

TEST(SignOfSupport, TangentHalfPlanesAreZeroExactly) {
  SeededRandom random(seed_of_run(12));
  for (int i = 0; i < 10000; ++i) {
    const TangentCase t = random_tangent_ellipse(random);
    ASSERT_EQ(sign_of_support(t.s, t.normal, 1.0, t.support), Sign::zero);
    ASSERT_EQ(sign_of_support(t.s, t.normal, 1.0, std::nextafter(t.support, kInfinity)), Sign::negative);
    ASSERT_EQ(sign_of_support(t.s, t.normal, 1.0, std::nextafter(t.support, -kInfinity)), Sign::positive);
  }
}

TEST(SignOfSupport, TangentDiscsAreZeroExactly) {
  SeededRandom random(seed_of_run(13));
  for (int i = 0; i < 10000; ++i) {
    const Pythagorean n = random_pythagorean(random);
    const double unit = std::ldexp(1.0, random.integer(-40, 20));
    const Vec2 centre{random.integer(-9999, 9999) * unit, random.integer(-9999, 9999) * unit};
    const double r = random.integer(0, 999) * unit, grown = random.integer(0, 999) * unit;
    const GrownShape s{Disc{centre, r}, {}, grown};
    const double h = n.p * centre.x + n.q * centre.y + n.h * (r + grown);
    ASSERT_EQ(sign_of_support(s, {n.p, n.q}, 1.0, h), Sign::zero);
    ASSERT_EQ(sign_of_support(s, {n.p, n.q}, 1.0, std::nextafter(h, kInfinity)), Sign::negative);
  }
}

TEST(SignOfSupport, Property1_GrowingNeverLowersIt) {
  SeededRandom random(seed_of_run(14));
  for (int i = 0; i < 4000; ++i) {
    RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 n = random.direction();
    const double c = support(scene.s, n).h;
    const Sign before = sign_of_support(scene.s, n, 1.0, c);
    scene.s.radius = std::nextafter(scene.s.radius, kInfinity);
    ASSERT_GE(as_int(sign_of_support(scene.s, n, 1.0, c)), as_int(before));
  }
}

TEST(SignOfSupport, Property2_PowersOfTwoDoNotChangeIt) {
  SeededRandom random(seed_of_run(15));
  for (int i = 0; i < 4000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 n = random.direction();
    const double c = i % 2 == 0 ? support(scene.s, n).h : scene.size * random.uniform(-1.0, 1.0);
    const double f = std::ldexp(1.0, random.integer(-30, 30));
    ASSERT_EQ(sign_of_support(scene.s, f * n, 1.0, f * c), sign_of_support(scene.s, n, 1.0, c));
  }
}

TEST(SignOfSupport, Property3_NoPointOfSGoesBeyondTheSupport) {
  SeededRandom random(seed_of_run(16));
  int tried = 0;
  for (int i = 0; i < 4000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 n = random.direction();
    const Vec2 q = support_point(scene.s, random.direction());
    if (locate(scene.s, q) == geometry::Place::outside) continue;
    ++tried;
    ASSERT_GE(sign_of_support_minus(scene.s, exactly(n), dot(exactly(n), exactly(q))), 0);
  }
  EXPECT_GT(tried, 500);
}

TEST(SignOfSupport, ZeroNormalIsZero) {
  EXPECT_EQ(sign_of_support({Disc{{1, 2}, 3}, {}, 1}, {0, 0}, 1.0, 0.0), Sign::zero);
  EXPECT_EQ(sign_of_support({Ellipse{{1, 2}, 3, 1, 2}, {}, 1}, {0, 0}, 1.0, 0.0), Sign::zero);
}

TEST(SignOfSupport, PointsOfEveryKindAgree) {
  const Vec2 p{0.1, -0.7}, n{0.3, 0.9};
  const double c = dot(n, p);
  const Sign expected = sign_of_support({Segment{p, p}, {}, 0.0}, n, 1.0, c);
  EXPECT_EQ(sign_of_support({Disc{p, 0.0}, {}, 0.0}, n, 1.0, c), expected);
  EXPECT_EQ(sign_of_support({ConvexPolygon{{p}}, {}, 0.0}, n, 1.0, c), expected);
  EXPECT_EQ(sign_of_support({Ellipse{p, 0, 0, 0}, {}, 0.0}, n, 1.0, c), expected);
}

TEST(SignOfSupport, UnderflowingSquaresAreNotTrusted) {
  // |L^T n| is 2^-600, its square underflows: a filter without the absolute term would call this negative.
  const double tiny = std::ldexp(1.0, -600);
  const GrownShape s{Ellipse{{0, 0}, tiny, 0, tiny}, {}, 0.0};
  EXPECT_EQ(sign_of_support(s, {1, 0}, 1.0, 0.5 * tiny), Sign::positive);
  EXPECT_EQ(sign_of_support(s, {1, 0}, 1.0, tiny), Sign::zero);
  EXPECT_EQ(sign_of_support(s, {1, 0}, 1.0, 2.0 * tiny), Sign::negative);
}

TEST(SignOfSupport, TheFilterAnswersRandomQuestionsAndNotTangentOnes) {
  SeededRandom random(seed_of_run(17));
  geometry::reset_stage_counts();
  constexpr int kAsked = 100000;
  for (int i = 0; i < kAsked; ++i) {
    const GrownShape s{random_shape(random, kKinds[i % 4], random.in_box(10.0), 1.0), random.in_box(10.0), 0.5};
    sign_of_support(s, random.direction(), 1.0, random.uniform(-3.0, 3.0));
  }
  EXPECT_EQ(geometry::stage_counts().filter + geometry::stage_counts().exact, kAsked);
  EXPECT_LE(geometry::stage_counts().exact, 10u);

  geometry::reset_stage_counts();
  for (int i = 0; i < 100; ++i) {
    const TangentCase t = random_tangent_ellipse(random);
    sign_of_support(t.s, t.normal, 1.0, t.support);
  }
  EXPECT_EQ(geometry::stage_counts().exact, 100u);
}

TEST(SignOfSupport, HalfPlaneIsSafeNeedsBothConditions) {
  const GrownShape s{Disc{{10, 0}, 1}, {}, 1};
  EXPECT_TRUE(half_plane_is_safe(s, 2.0, {{-1, 0}, -4.0}));
  EXPECT_FALSE(half_plane_is_safe(s, 2.0, {{-1, 0}, std::nextafter(-4.0, -5.0)}));
  EXPECT_FALSE(half_plane_is_safe(s, 2.0, {{0, 0}, 0.0})) << "every velocity";
  EXPECT_TRUE(half_plane_is_safe(s, 2.0, {{0, 0}, 1.0})) << "no velocity";
  EXPECT_FALSE(half_plane_is_safe(s, 2.0, {{0, 1}, 100.0})) << "h > 0: the cone is unbounded that way";
}

TEST(SignOfSupport, NotANumberIsTheCallersMistake) {
  const GrownShape s{Disc{{10, 0}, 1}, {}, 1};
  const double nan = std::nan("");
  EXPECT_THROW(sign_of_support(s, {nan, 0}, 1.0, 0.0), std::logic_error);
  EXPECT_THROW(sign_of_support(s, {1, 0}, kInfinity, 0.0), std::logic_error);
  EXPECT_THROW(sign_of_support(s, {1, 0}, 1.0, nan), std::logic_error);
  EXPECT_THROW(sign_of_support({Disc{{nan, 0}, 1}, {}, 1}, {1, 0}, 1.0, 0.0), std::logic_error);
  EXPECT_THROW(sign_of_support({Disc{{1, 0}, kInfinity}, {}, 1}, {1, 0}, 1.0, 0.0), std::logic_error);
  EXPECT_THROW(half_plane_is_safe(s, 0.0, {{-1, 0}, 0.0}), std::logic_error);
  EXPECT_THROW(half_plane_is_safe(s, nan, {{-1, 0}, 0.0}), std::logic_error);
}

TEST(Support, ErrorIsWithinItsBound) {
  SeededRandom random(seed_of_run(18));
  for (int i = 0; i < 20000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 n = std::ldexp(1.0, random.integer(-40, 40)) * random.direction();
    const geometry::SupportValue v = support(scene.s, n);
    const Q slack = Q(geometry::kSupportError) * Q(v.magnitude) + Q(geometry::kSupportUnderflow);
    ASSERT_LE(sign_of_support_minus(scene.s, exactly(n), Q(v.h) + slack), 0);
    ASSERT_GE(sign_of_support_minus(scene.s, exactly(n), Q(v.h) - slack), 0);
    ASSERT_LE(sign_of_support_minus(scene.s, exactly(n), Q(support_upper_bound(scene.s, n))), 0);
  }
}

}  // namespace
}  // namespace exactvo::test
