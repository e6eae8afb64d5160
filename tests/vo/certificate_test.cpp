// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of half-planes: issued, written, read, and corrupted in every number.
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::Vec2;
using vo::Certificate;
using vo::HalfPlaneClaim;
using vo::Verdict;

HalfPlaneClaim random_claim(SeededRandom& random, Kind kind) {
  for (;;) {
    const RandomScene scene = random_scene(random, kind);
    const double tau = random.uniform(0.1, 5.0);
    const auto h = vo::half_plane(scene.s, tau, random_velocity(random, scene.s, tau));
    if (h && !velocity_obstacle(scene.s, tau).overlaps())
      return {scene.s.shape, scene.s.origin, scene.s.radius, tau, {}, *h};
  }
}

/// Every number of a certificate.
std::vector<double*> numbers_of(Certificate& c) {
  std::vector<double*> all;
  const auto add = [&](Vec2& v) {
    all.push_back(&v.x);
    all.push_back(&v.y);
  };
  HalfPlaneClaim& claim = c.claim;
  if (auto* d = std::get_if<geometry::Disc>(&claim.shape)) {
    add(d->center);
    all.push_back(&d->radius);
  } else if (auto* s = std::get_if<geometry::Segment>(&claim.shape)) {
    add(s->a);
    add(s->b);
  } else if (auto* p = std::get_if<geometry::ConvexPolygon>(&claim.shape)) {
    for (Vec2& v : p->vertices) add(v);
  } else {
    auto& e = std::get<geometry::Ellipse>(claim.shape);
    add(e.center);
    all.insert(all.end(), {&e.l11, &e.l21, &e.l22});
  }
  add(claim.position);
  add(claim.shape_velocity);
  add(claim.half_plane.normal);
  all.insert(all.end(), {&claim.radius, &claim.time_horizon, &claim.half_plane.offset, &c.margin});
  return all;
}

using geometry::kInfinity;

TEST(Certificate, Property1And2_IssuedReadAndValid) {
  SeededRandom random(seed_of_run(61));
  for (int i = 0; i < 2000; ++i) {
    const HalfPlaneClaim claim = random_claim(random, kKinds[i % 4]);
    const auto c = certify(claim);
    ASSERT_TRUE(c);
    ASSERT_EQ(check(*c), Verdict::valid);
    const std::string text = write_certificate(*c);
    const auto read = vo::read_certificate(text);
    ASSERT_TRUE(read) << text;
    ASSERT_EQ(write_certificate(*read), text);
    ASSERT_EQ(check(*read), Verdict::valid);
    const geometry::GrownShape s{claim.shape, claim.position, claim.radius};
    ASSERT_TRUE(is_safe(s, claim.time_horizon, claim.half_plane)) << "the oracle agrees";
  }
}

TEST(Certificate, Property3_AnyNumberAnUlpOffIsRejected) {
  SeededRandom random(seed_of_run(62));
  int corrupted = 0, caught_by_margin = 0;
  while (corrupted < 20000) {
    Certificate good = *certify(random_claim(random, kKinds[corrupted % 4]));
    for (std::size_t k = 0; k < numbers_of(good).size(); ++k) {
      for (const double towards : {-kInfinity, kInfinity}) {
        Certificate bad = good;
        double& x = *numbers_of(bad)[k];
        x = std::nextafter(x, towards);
        const Verdict verdict = check(bad);
        ASSERT_NE(verdict, Verdict::valid) << write_certificate(good) << " number " << k;
        caught_by_margin += verdict == Verdict::wrong_margin;
        ++corrupted;
      }
    }
  }
  EXPECT_GT(caught_by_margin, corrupted / 4) << "without the digest's help";
}

TEST(Certificate, AHalfPlaneMovedInwardFailsByItsMarginAlone) {
    SeededRandom random(seed_of_run(63));
  int judged = 0;
  for (int i = 0; i < 5000; ++i) {
    Certificate c = *certify(random_claim(random, kKinds[i % 4]));
    if (c.claim.half_plane.offset == 0.0) continue;  // a leg: its margin is that of h_S <= 0
        c.claim.half_plane.offset = std::nextafter(c.claim.half_plane.offset, -kInfinity);
    ASSERT_EQ(check(c), Verdict::wrong_margin);
    ++judged;
  }
  EXPECT_GT(judged, 1000);
}

TEST(Certificate, CorruptedTextIsRejected) {
  SeededRandom random(seed_of_run(64));
  int different = 0;
  for (int i = 0; i < 12000; ++i) {
    static std::string text;
    if (i % 100 == 0) text = write_certificate(*certify(random_claim(random, kKinds[(i / 100) % 4])));
    std::string bad = text;
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bad.size()) - 1));
    const int what = random.integer(0, 2);
    if (what == 0) bad[at] = "0123456789abcdef .-px"[random.integer(0, 20)];
    if (what == 1) bad.erase(at, 1);
    if (what == 2) bad.insert(at, 1, "0123456789abcdef "[random.integer(0, 16)]);
    if (bad == text) continue;
    ++different;
    const auto read = vo::read_certificate(bad);
    ASSERT_TRUE(!read || check(*read) != Verdict::valid) << bad;
  }
  EXPECT_GT(different, 10000);
}

// The guess at a margin that is found from squares was 0 here, and every double on the way was tried.
TEST(Certificate, LengthsWhoseSquaresUnderflowAreCertifiedSoon) {
  for (const double unit : {1e-150, 1e-170, 1e-200, 1e-300}) {
    HalfPlaneClaim claim;
    claim.shape = geometry::Disc{{4.0 * unit, 3.0 * unit}, unit};
    claim.radius = 0.5 * unit;
    claim.time_horizon = 2.0;
    claim.half_plane = {{-0.8, -0.6}, -1.7 * unit};  // the disc begins 3.5 away
    const auto c = certify(claim);
    ASSERT_TRUE(c) << unit;
    EXPECT_EQ(check(*c), Verdict::valid) << unit;
    EXPECT_NEAR(c->margin / unit, 0.1, 1e-9) << unit;
  }
}

TEST(Certificate, UnsafeClaimsGetNone) {
  const geometry::Disc disc{{5, 0}, 1};
  HalfPlaneClaim claim{disc, {}, 1.0, 2.0, {}, {{-1, 0}, -1.5}};
  EXPECT_TRUE(is_true(claim));
  EXPECT_EQ(certify(claim)->margin, 0.0);
  claim.half_plane.offset = std::nextafter(-1.5, -2.0);
  EXPECT_FALSE(is_true(claim));
  EXPECT_FALSE(certify(claim));
  claim.half_plane = {{0, 1}, 100.0};
  EXPECT_FALSE(is_true(claim)) << "h > 0: no offset helps";
}

TEST(Certificate, MovingObstaclesShiftTheClaim) {
  const geometry::Disc disc{{5, 0}, 1};
  HalfPlaneClaim claim{disc, {}, 1.0, 2.0, {-1.0, 0.5}, {{-1, 0}, -0.5}};
  EXPECT_TRUE(is_true(claim));
  claim.half_plane.offset = std::nextafter(-0.5, -1.0);
  EXPECT_FALSE(is_true(claim));
}

TEST(Certificate, NumbersThatAreNoneAreMalformed) {
  const HalfPlaneClaim claim{geometry::Disc{{5, 0}, 1}, {}, 1.0, 2.0, {}, {{-1, 0}, -1.0}};
  const Certificate good = *certify(claim);
  Certificate bad = good;
  const std::size_t count = numbers_of(bad).size();
  for (std::size_t k = 0; k < count; ++k) {
    for (const double value : {std::nan(""), kInfinity}) {
      bad = good;
      *numbers_of(bad)[k] = value;
      if (bad.claim.time_horizon == kInfinity) {  // a cone without end, but not the one that was certified
        EXPECT_NE(check(bad), Verdict::valid);
        continue;
      }
      EXPECT_EQ(check(bad), Verdict::malformed);
      EXPECT_EQ(is_true(bad.claim), k + 1 == count) << "the last is the margin, no part of the claim";
    }
  }
  bad.claim.radius = -1.0;
  EXPECT_EQ(check(bad), Verdict::malformed);
  bad = good;
  bad.claim.time_horizon = 0.0;
  EXPECT_EQ(check(bad), Verdict::malformed);
  bad = good;
  bad.claim.shape = geometry::ConvexPolygon{};
  EXPECT_EQ(check(bad), Verdict::malformed);
}

// --- Containment ---

vo::Containment random_containment(SeededRandom& random) {
  std::vector<Vec2> points;
  const double scale = std::ldexp(1.0, random.integer(-20, 20));
  for (int k = random.integer(3, 12); k > 0; --k)
    points.push_back({scale * random.uniform(-3.0, 5.0), scale * random.uniform(-2.0, 2.0)});
  const auto c = vo::certify_containment(geometry::fast_smallest_ellipse(points).ellipse, points);
  EXPECT_TRUE(c);
  return *c;
}

TEST(Containment, Property1And2_OfSmallestEllipsesIssuedReadAndValid) {
  SeededRandom random(seed_of_run(66));
  for (int i = 0; i < 200; ++i) {
    const vo::Containment c = random_containment(random);
    const std::string text = write_containment(c);
    ASSERT_EQ(check(c), Verdict::valid) << text;
    const auto read = vo::read_containment(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(write_containment(*read), text);
    EXPECT_EQ(check(*read), Verdict::valid);
    for (const Vec2 x : c.points) EXPECT_TRUE(geometry::contains(c.ellipse, x)) << text;
  }
}

TEST(Containment, Property3_AnyNumberChangedByAnUlpIsNoticed) {
  SeededRandom random(seed_of_run(67));
  for (int i = 0; i < 50; ++i) {
    vo::Containment c = random_containment(random);
    std::vector<double*> numbers{&c.ellipse.center.x, &c.ellipse.center.y, &c.ellipse.l11,
                                 &c.ellipse.l21,      &c.ellipse.l22,      &c.margin};
    for (Vec2& x : c.points) numbers.insert(numbers.end(), {&x.x, &x.y});
    for (double* number : numbers) {
      const double kept = *number;
      for (const double to : {-kInfinity, kInfinity}) {
        *number = std::nextafter(kept, to);
        EXPECT_NE(check(c), Verdict::valid);
      }
      *number = std::nan("");
      EXPECT_EQ(check(c), Verdict::malformed);
      *number = kept;
    }
    c.digest ^= 1;
    EXPECT_EQ(check(c), Verdict::altered);
  }
}

TEST(Containment, WhatIsNotContainedOrFlatHasNone) {
  const geometry::Ellipse unit{{0.0, 0.0}, 1.0, 0.0, 1.0};
  const auto touching = vo::certify_containment(unit, {{0.6, 0.8}, {-1.0, 0.0}, {0.28125, 0.0}});
  EXPECT_FALSE(touching) << "the doubles 0.6 and 0.8 lie an ulp beyond the circle";
  const auto on_it = vo::certify_containment(unit, {{-1.0, 0.0}, {0.0, 1.0}});
  ASSERT_TRUE(on_it);
  EXPECT_EQ(on_it->margin, 0.0);
  EXPECT_FALSE(vo::certify_containment(unit, {{std::nextafter(1.0, 2.0), 0.0}}));
  EXPECT_FALSE(vo::certify_containment(unit, {}));
  EXPECT_FALSE(vo::certify_containment({{0.0, 0.0}, 1.0, 0.0, 0.0}, {{0.5, 0.0}})) << "a segment";
  vo::Containment forged = *on_it;
  forged.points[0].x = -1.5;
  EXPECT_EQ(check(forged), Verdict::wrong_margin);
}

}  // namespace
}  // namespace exactvo::test
