// SPDX-License-Identifier: GPL-3.0-or-later
// Every half-plane that is returned is audited in rationals: discs, segments, polygons, ellipses, near and far, tiny
// and huge, every horizon.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "exactvo/vo/orca_obstacle.h"
#include "exactvo/vo/reciprocal.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::GrownShape;
using geometry::HalfPlane;
using geometry::Vec2;
using vo::VelocityObstacle;

TEST(CertifiedHalfPlanes, HundredThousandAuditedNoneUnsafe) {
  SeededRandom random(seed_of_run(41));
  int audited = 0, refused = 0, overlapping = 0;
  for (int i = 0; audited < 100000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const double tau = std::pow(10.0, random.uniform(-2.0, 2.0));
    const Vec2 v = random_velocity(random, scene.s, tau);
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, tau);
    if (obstacle.overlaps()) {
      ++overlapping;
      continue;
    }
    const auto h = obstacle.half_plane(v);
    if (!h) {
      ++refused;
      continue;
    }
    ++audited;
    ASSERT_TRUE(is_safe(scene.s, tau, *h)) << text_of(scene.s, tau, v);
  }
  EXPECT_EQ(refused, 0) << "half-planes that could not be certified, of " << audited;
  EXPECT_LT(overlapping, 5000);
}

TEST(CertifiedHalfPlanes, AnUlpFromContactTheyAreSafeOrNone) {
  SeededRandom random(seed_of_run(42));
  int given = 0;
  for (int i = 0; i < 5000; ++i) {
    // Discs and walls in exact contact, then the robot's radius an ulp or a few smaller.
    const Pythagorean n = random_pythagorean(random);
    const double unit = std::ldexp(1.0, random.integer(-30, 20));
    const Vec2 centre = unit * Vec2{n.p, n.q};
    const double ulps = random.integer(0, 3) == 0 ? 0.0 : random.integer(1, 60);
    GrownShape s{geometry::Disc{centre, 0.0}, {}, n.h * unit * (1.0 - ulps * 0x1p-53)};
    if (i % 2 == 1) {
      const Vec2 along = unit * random.integer(1, 9) * geometry::perp(Vec2{n.p, n.q});
      s.shape = geometry::Segment{centre - along, centre + along};
    }
    const double tau = random.uniform(0.1, 5.0);
    const VelocityObstacle obstacle = velocity_obstacle(s, tau);
    EXPECT_EQ(obstacle.overlaps(), ulps == 0.0);
    const Vec2 v = unit * random.in_box(2.0 * n.h);
    if (ulps == 0.0) {
      if (const auto h = obstacle.contact_half_plane()) {
        ASSERT_TRUE(is_safe(s, tau, *h)) << text_of(s, tau, v);
      }
      continue;
    }
    if (const auto h = obstacle.half_plane(v)) {
      ++given;
      ASSERT_TRUE(is_safe(s, tau, *h)) << text_of(s, tau, v);
    }
  }
  EXPECT_GT(given, 2500);
}

TEST(CertifiedHalfPlanes, AnyNormalWithNegativeSupportIsSafe) {
  // The theorem behind it all: no velocity of the interior of VO satisfies n.v >= h_S(n)/tau when h_S(n) <= 0.
  SeededRandom random(seed_of_run(43));
  int tried = 0;
  for (int i = 0; i < 20000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const QPoint n = exactly(random.direction());
    if (sign_of_support_minus(scene.s, n, Q(0)) > 0) continue;
    const double tau = random.uniform(0.1, 5.0);
    // A velocity of VO: a point of S reached at some 0 < t <= tau.
    const Vec2 q = support_point(scene.s, random.direction());
    if (place_in(scene.s, exactly(q)) > 0) continue;
    const Q t = Q(tau) * Q(random.uniform(0.01, 1.0));
    const Q reach = dot(n, exactly(q)) / t;  // n.v
    ASSERT_GE(sign_of_support_minus(scene.s, n, Q(tau) * reach), 0);
    ++tried;
  }
  EXPECT_GT(tried, 1000);
}

Vec2 moved(SeededRandom& random) {
  return random.in_box(2.0);
}

TEST(Reciprocal, Property1And2_NormalsMirrorAndHalvesAddUp) {
  SeededRandom random(seed_of_run(44));
  int certified = 0;
  for (int i = 0; i < 20000; ++i) {
    const vo::MovingDisc a{random.in_box(3.0), moved(random), random.uniform(0.0, 0.8)};
    const vo::MovingDisc b{random.in_box(3.0), moved(random), random.uniform(0.0, 0.8)};
    vo::ReciprocalOptions options;
    options.time_horizon = random.uniform(0.1, 5.0);
    options.responsibility_of_a = i % 3 == 0 ? random.uniform(0.0, 1.0) : 0.5;
    options.margin = i % 2 == 0 ? 0.0 : 0.05;
    const auto pair = vo::reciprocal_half_planes(a, b, options);
    ASSERT_EQ(pair.b.normal, -pair.a.normal);
    if (!pair.certified) continue;
    ++certified;
    const GrownShape s{geometry::Disc{b.position, b.radius}, a.position, a.radius};
    const QPoint n = exactly(pair.a.normal);
    ASSERT_LE(sign_of_support_minus(s, n, Q(0)), 0);
    ASSERT_LE(sign_of_support_minus(s, n, Q(options.time_horizon) * (Q(pair.a.offset) + Q(pair.b.offset))), 0);
  }
  EXPECT_GT(certified, 10000);
}

TEST(Reciprocal, Property3_ExchangingTheRobotsExchangesTheHalves) {
    SeededRandom random(seed_of_run(45));
  int apart = 0;
  for (int i = 0; i < 10000; ++i) {
    const vo::MovingDisc a{random.in_box(3.0), moved(random), random.uniform(0.0, 0.8)};
    const vo::MovingDisc b{i % 10 == 0 ? a.position : random.in_box(3.0), moved(random), random.uniform(0.0, 0.8)};
    vo::ReciprocalOptions ab, ba;
    ab.responsibility_of_a = i % 2 == 0 ? 0.5 : 0.25;
    ba.responsibility_of_a = 1.0 - ab.responsibility_of_a;
    const auto one = vo::reciprocal_half_planes(a, b, ab);
    const auto other = vo::reciprocal_half_planes(b, a, ba);
    if (a.position == b.position) continue;  // nothing tells them apart
    ASSERT_EQ(one.a.normal, other.b.normal);
    ASSERT_EQ(one.a.offset, other.b.offset);
    ASSERT_EQ(one.b.normal, other.a.normal);
        ASSERT_EQ(one.b.offset, other.a.offset);
    ++apart;
  }
  EXPECT_GE(apart, 9000);
}

TEST(Orca, EdgesOfPolygonsAndWallsAreSafe) {
  SeededRandom random(seed_of_run(46));
  int audited = 0;
  for (int i = 0; i < 5000; ++i) {
    const double size = std::pow(10.0, random.uniform(-1.0, 1.0));
    const geometry::ConvexPolygon polygon = random_convex_polygon(random, random.in_box(20.0), size, 3 + i % 5);
    const geometry::Obstacle obstacle = i % 2 == 0 ? geometry::Obstacle{geometry::Polygon{polygon.vertices, {}}}
                                                   : geometry::Obstacle{geometry::Polyline{polygon.vertices}};
    const Vec2 position = polygon.vertices[0] + size * random.in_box(3.0);
    const double radius = size * random.uniform(0.0, 0.5), tau = random.uniform(0.2, 5.0);
    for (const vo::OrcaChain& chain : vo::orca_chains(obstacle)) {
      std::vector<std::size_t> edges(chain.vertices.size());
      std::iota(edges.begin(), edges.end(), std::size_t{0});
      for (const auto& line : vo::orca_half_planes(chain, edges, position, random.in_box(3.0), radius, tau)) {
        if (!line.certified) continue;
        const std::size_t n = chain.vertices.size();
        const geometry::Segment edge{chain.vertices[line.edge], chain.vertices[(line.edge + 1) % n]};
        ASSERT_TRUE(is_safe({edge, position, radius}, tau, line.half_plane));
        ++audited;
      }
    }
  }
  EXPECT_GT(audited, 4000);
}

}  // namespace
}  // namespace exactvo::test
