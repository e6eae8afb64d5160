// SPDX-License-Identifier: GPL-3.0-or-later
// The numbered properties of velocity_obstacle.h, its legs and boundary, and what callers may get wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/orca_obstacle.h"
#include "exactvo/vo/reciprocal.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::ConvexShape;
using geometry::cross;
using geometry::Disc;
using geometry::dot;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::HalfPlane;
using geometry::norm;
using geometry::Segment;
using geometry::Vec2;
using vo::BoundaryPart;
using vo::VelocityObstacle;

using geometry::kInfinity;

TEST(VelocityObstacle, Property1_StaticHalfPlanesAdmitRest) {
    SeededRandom random(seed_of_run(51));
  int judged = 0;
  for (int i = 0; i < 20000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const double tau = random.uniform(0.1, 10.0);
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, tau);
    if (obstacle.overlaps()) continue;
    const auto h = obstacle.half_plane(random_velocity(random, scene.s, tau));
    if (!h) continue;
    ASSERT_LE(h->offset, 0.0);
    ++judged;
  }
  EXPECT_GT(judged, 10000);
}

TEST(VelocityObstacle, Property2_SafeForLargerIsSafeForSmaller) {
    SeededRandom random(seed_of_run(52));
  int judged = 0;
  for (int i = 0; i < 8000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const double tau = random.uniform(0.1, 10.0);
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, tau);
    if (obstacle.overlaps()) continue;
    const auto h = obstacle.half_plane(random_velocity(random, scene.s, tau));
    if (!h) continue;
    GrownShape smaller = scene.s;
    smaller.radius *= random.uniform(0.0, 1.0);
        ASSERT_TRUE(is_safe(smaller, tau * random.uniform(0.01, 1.0), *h));
    ++judged;
  }
  EXPECT_GT(judged, 4000);
}

TEST(VelocityObstacle, Property3_ContainsGrowsWithRadiusAndHorizon) {
  SeededRandom random(seed_of_run(53));
  int inside = 0;
  for (int i = 0; i < 6000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const double tau = random.uniform(0.1, 10.0);
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, tau);
    const Vec2 v = random_velocity(random, scene.s, tau);
    if (obstacle.overlaps() || !obstacle.contains(v)) continue;
    ++inside;
    GrownShape larger = scene.s;
    larger.radius = std::nextafter(larger.radius, kInfinity);
    ASSERT_TRUE(velocity_obstacle(scene.s, std::nextafter(tau, kInfinity)).contains(v));
    ASSERT_TRUE(velocity_obstacle(larger, tau).contains(v));
  }
  EXPECT_GT(inside, 500);
}

Vec2 quarter(Vec2 a) {
  return geometry::perp(a);
}
Vec2 mirrored(Vec2 a) {
  return {a.x, -a.y};
}

/// The scene with every point mapped; `reverse` keeps polygons counter-clockwise under a mirror.
template <typename Map>
GrownShape mapped(const GrownShape& s, Map map, bool reverse) {
  GrownShape out = s;
  out.origin = map(s.origin);
  if (auto* d = std::get_if<Disc>(&out.shape)) d->center = map(d->center);
  if (auto* g = std::get_if<Segment>(&out.shape)) *g = {map(g->a), map(g->b)};
  if (auto* p = std::get_if<ConvexPolygon>(&out.shape)) {
    for (Vec2& v : p->vertices) v = map(v);
    if (reverse) std::reverse(p->vertices.begin(), p->vertices.end());
  }
  return out;
}

TEST(VelocityObstacle, Property4_MirrorsAndQuarterTurnsOfDiscsSegmentsAndPolygonsCarryOver) {
    SeededRandom random(seed_of_run(54));
  int turns = 0, mirrors = 0;
  for (int i = 0; i < 6000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 3]);
    const double tau = random.uniform(0.1, 10.0);
    const Vec2 v = random_velocity(random, scene.s, tau);
    if (v == Vec2{} || velocity_obstacle(scene.s, tau).overlaps()) continue;
    const auto h = velocity_obstacle(scene.s, tau).half_plane(v);
    if (!h) continue;
    const auto turned = velocity_obstacle(mapped(scene.s, quarter, false), tau).half_plane(quarter(v));
    const auto flipped = velocity_obstacle(mapped(scene.s, mirrored, true), tau).half_plane(mirrored(v));
    ASSERT_TRUE(turned && flipped);
    ASSERT_EQ(turned->normal, quarter(h->normal)) << text_of(scene.s, tau, v);
        ASSERT_EQ(turned->offset, h->offset);
    ++turns;
    if (i % 3 == 2) continue;  // a mirrored polygon lists its vertices in another order
    ASSERT_EQ(flipped->normal, mirrored(h->normal)) << text_of(scene.s, tau, v);
        ASSERT_EQ(flipped->offset, h->offset);
    ++mirrors;
  }
  EXPECT_GT(turns, 3000);
  EXPECT_GT(mirrors, 2000);
}

TEST(VelocityObstacle, Property5_WhatSatisfiesTheHalfPlaneIsNotInside) {
  SeededRandom random(seed_of_run(55));
  int checked = 0;
  for (int i = 0; i < 20000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const double tau = random.uniform(0.1, 10.0);
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, tau);
    if (obstacle.overlaps()) continue;
    const Vec2 v = random_velocity(random, scene.s, tau);
    const auto h = obstacle.half_plane(v);
    if (!h) continue;
    const Vec2 w = random_velocity(random, scene.s, tau);
    const Q out = Q(h->offset) - dot(exactly(h->normal), exactly(w));
    if (sgn(out) >= 0) continue;  // violates it, or lies on it
    ASSERT_FALSE(obstacle.contains(w)) << text_of(scene.s, tau, w);
    ++checked;
  }
  EXPECT_GT(checked, 5000);
}

TEST(VelocityObstacle, LegsBracketTheTangentsInRationals) {
    SeededRandom random(seed_of_run(56));
  int judged = 0;
  for (int i = 0; i < 8000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, 1.0);
    if (obstacle.overlaps()) continue;
    const auto legs = obstacle.legs();
    ASSERT_TRUE(legs) << text_of(scene.s, 1.0, {});
    for (const vo::Leg& leg : {legs->left, legs->right}) {
      ASSERT_LE(sign_of_support_minus(scene.s, exactly(leg.normal), Q(0)), 0);
      ASSERT_GT(sign_of_support_minus(scene.s, exactly(leg.normal_outside), Q(0)), 0);
      ASSERT_NEAR(norm(leg.direction), 1.0, 1e-12);
    }
    ASSERT_GT(cross(legs->right.direction, legs->left.direction), -1e-12) << text_of(scene.s, 1.0, {});
    ASSERT_LE(dot(legs->left.normal, legs->right.direction), 1e-7);
        ASSERT_LE(dot(legs->right.normal, legs->left.direction), 1e-7);
    ++judged;
  }
  EXPECT_GT(judged, 4000);
}

TEST(VelocityObstacle, LegsOfADiscInClosedForm) {
  // |p| = 5, R = 3: the tangents make an angle with sine 3/5 with the centre line.
  const auto legs = VelocityObstacle(Disc{{5, 0}, 2}, {}, 1.0, 2.0).legs();
  ASSERT_TRUE(legs);
  EXPECT_NEAR(legs->left.direction.x, 0.8, 1e-15);
  EXPECT_NEAR(legs->left.direction.y, 0.6, 1e-15);
  EXPECT_NEAR(legs->right.direction.y, -0.6, 1e-15);
  EXPECT_NEAR(norm(legs->left.touch), 4.0, 1e-14);
  EXPECT_NEAR(legs->left.normal.x, -0.6, 1e-13);
  EXPECT_NEAR(legs->left.normal.y, 0.8, 1e-13);
}

TEST(VelocityObstacle, NearestBoundaryIsTheLeastOverAllDirections) {
  SeededRandom random(seed_of_run(57));
  for (int i = 0; i < 3000; ++i) {
    const double size = 1.0;
    const Vec2 origin = random.in_box(2.0);
    const double radius = random.uniform(0.0, 0.5);
    const Vec2 centre = origin + (size + radius + random.uniform(0.01, 4.0)) * random.direction();
    const GrownShape s{random_shape(random, kKinds[i % 4], centre, size), origin, radius};
    const double tau = random.uniform(0.3, 3.0);
    const Vec2 v = random_velocity(random, s, tau);
    const VelocityObstacle obstacle = velocity_obstacle(s, tau);
    double best = kInfinity;
    constexpr int kDirections = 20000;
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * geometry::kPi * k / kDirections;
      const Vec2 n{std::cos(angle), std::sin(angle)};
      const double h = support(s, n).h;
      if (h <= 0.0) best = std::min(best, h / tau - dot(n, v));
    }
    const auto nearest = obstacle.nearest_boundary(v);
    // The grid is 2 pi / 20000 fine; f changes by at most (|S| + |tau v|) / tau a radian, twice that at a leg.
    const double reach = (norm(centre - origin) + size + radius + tau * norm(v)) / tau;
    const double grid = 2.0 * reach * 3.15 / kDirections;
    EXPECT_LE(-nearest.signed_distance, best + 1e-9 * reach) << text_of(s, tau, v);
    EXPECT_GE(-nearest.signed_distance, best - grid) << text_of(s, tau, v);
    EXPECT_NEAR(norm(nearest.u), std::fabs(nearest.signed_distance), 1e-12 * reach);
    const auto h = obstacle.half_plane(v);
    ASSERT_TRUE(h);
    EXPECT_NEAR(violation(*h, v), -nearest.signed_distance, 1e-9 * reach) << text_of(s, tau, v);
  }
}

TEST(VelocityObstacle, PartsOfTheBoundary) {
  const VelocityObstacle obstacle(Disc{{5, 0}, 2}, {}, 1.0, 2.0);
  EXPECT_EQ(obstacle.nearest_boundary({0, 0}).part, BoundaryPart::cut_off);
  EXPECT_EQ(obstacle.nearest_boundary({9, 6}).part, BoundaryPart::left_leg);
  EXPECT_EQ(obstacle.nearest_boundary({9, -6}).part, BoundaryPart::right_leg);
  EXPECT_NEAR(obstacle.nearest_boundary({0, 0}).signed_distance, 1.0, 1e-15);
}

TEST(VelocityObstacle, HalfResponsibilityTakesHalfOfTheChange) {
  const VelocityObstacle obstacle(Disc{{5, 0}, 2}, {}, 1.0, 2.0);
  const Vec2 v{1.5, 0.0};  // 0.5 m/s into the cut-off
  EXPECT_NEAR(violation(*obstacle.half_plane(v, 1.0), v), 0.5, 1e-14);
  EXPECT_NEAR(violation(*obstacle.half_plane(v, 0.5), v), 0.25, 1e-14);
}

TEST(VelocityObstacle, OverlapHasNoCone) {
  for (const ConvexShape& shape :
       {ConvexShape{Disc{{0, 0}, 1}}, ConvexShape{Segment{{-1, 0}, {1, 0}}},
        ConvexShape{ConvexPolygon{{{-1, -1}, {1, -1}, {0, 1}}}}, ConvexShape{Ellipse{{0, 0}, 2, 0.5, 1}}}) {
    const VelocityObstacle obstacle(shape, {0.1, 0.0}, 0.5, 2.0);
    EXPECT_TRUE(obstacle.overlaps());
    EXPECT_FALSE(obstacle.legs());
    EXPECT_FALSE(obstacle.half_plane({1, 0}));
    EXPECT_FALSE(obstacle.contact_half_plane());
    EXPECT_LT(obstacle.nearest().distance, 0.0);
  }
}

// In exact contact one direction alone is safe, and that of a 3-4-5 triangle is lost when it is divided by its length.
TEST(VelocityObstacle, ExactContactInARationalDirectionIsProven) {
  constexpr double kTriples[][3] = {{3, 4, 5},   {4, 3, 5},    {5, 12, 13}, {12, 5, 13},  {8, 15, 17},
                                    {7, 24, 25}, {20, 21, 29}, {9, 40, 41}, {28, 45, 53}, {119, 120, 169}};
  std::size_t judged = 0, rounded_away = 0;
  for (const auto& [a, b, c] : kTriples) {
    for (const double scale : {1.0, 0x1p-10, 0x1p10}) {
      for (const Vec2 shift : {Vec2{0, 0}, Vec2{1e6, -3e6}}) {
        for (const double sx : {1.0, -1.0}) {
          for (const double sy : {1.0, -1.0}) {
            const auto at = [&](double x, double y) { return scale * Vec2{sx * x + shift.x, sy * y + shift.y}; };
            const Vec2 robot = at(a, b);
            // A corner, two discs, an end of a wall, and a wall that runs square to the direction.
            std::vector<Vec2> box{at(0, 0), at(-9, 0), at(-9, -9), at(0, -9)};
            if (sx * sy < 0.0) std::reverse(box.begin(), box.end());
            const std::pair<ConvexShape, double> contacts[] = {{ConvexPolygon{box}, c},
                                                               {Disc{at(0, 0), scale * 1.0}, c - 1.0},
                                                               {Segment{at(0, 0), at(-7, 0)}, c},
                                                               {Segment{at(-b, a), at(b, -a)}, c}};
            for (const auto& [shape, radius] : contacts) {
              const VelocityObstacle obstacle(shape, robot, scale * radius, 2.0);
              ASSERT_TRUE(obstacle.overlaps()) << "contact is exact";
              const std::optional<HalfPlane> h = obstacle.contact_half_plane();
              ASSERT_TRUE(h) << a << " " << b << " " << c << " scale " << scale << " at " << shift.x;
              EXPECT_EQ(h->offset, 0.0);
              EXPECT_GT(dot(h->normal, Vec2{sx * a, sy * b}), 0.0);
              EXPECT_TRUE(vo::certify({shape, robot, scale * radius, 2.0, {}, *h}));
              EXPECT_NEAR(norm(h->normal), 1.0, 0.415);
              rounded_away += norm(h->normal) < 0.999 || norm(h->normal) > 1.001;
              ++judged;
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(judged, 960u);
  EXPECT_GT(rounded_away, 100u);
  const VelocityObstacle deeper(Segment{{0, 0}, {4, 0}}, {8, 3}, std::nextafter(5.0, 6.0), 2.0);
  EXPECT_FALSE(deeper.contact_half_plane());
}

TEST(VelocityObstacle, PointsWithoutRadiusAreRays) {
  const VelocityObstacle point(Segment{{3, 4}, {3, 4}}, {}, 0.0, 1.0);
  EXPECT_FALSE(point.overlaps());
  EXPECT_TRUE(point.contains({3, 4}));
  EXPECT_TRUE(point.contains({6, 8}));
  EXPECT_FALSE(point.contains({1.5, 2}));
  EXPECT_FALSE(point.contains({6, std::nextafter(8.0, 9.0)}));
  for (const Vec2 v : {Vec2{3, 4}, Vec2{6, 8}, Vec2{-1, 0}, Vec2{0, 0}, Vec2{10, 0}}) {
    const auto h = point.half_plane(v);
    ASSERT_TRUE(h);
    EXPECT_TRUE(is_safe(point.grown(), 1.0, *h));
  }
}

TEST(VelocityObstacle, CallersMistakesAreLogicErrors) {
  const double nan = std::nan("");
  const Disc disc{{5, 0}, 1};
  for (const double bad : {nan, kInfinity, -kInfinity, -1.0}) {
    EXPECT_THROW(VelocityObstacle(disc, {}, bad, 1.0), std::logic_error);
    if (bad != kInfinity) {
      EXPECT_THROW(VelocityObstacle(disc, {}, 1.0, bad), std::logic_error);
    }
    EXPECT_THROW(VelocityObstacle(Disc{{5, 0}, bad}, {}, 1.0, 1.0), std::logic_error);
  }
  for (const double bad : {nan, kInfinity, -kInfinity}) {
    EXPECT_THROW(VelocityObstacle(disc, {0, bad}, 1.0, 1.0), std::logic_error);
    EXPECT_THROW(VelocityObstacle(Disc{{bad, 0}, 1}, {}, 1.0, 1.0), std::logic_error);
    EXPECT_THROW(VelocityObstacle(Segment{{1, 0}, {bad, 0}}, {}, 1.0, 1.0), std::logic_error);
    EXPECT_THROW(VelocityObstacle(ConvexPolygon{{{1, 0}, {2, bad}, {1, 1}}}, {}, 1.0, 1.0), std::logic_error);
    EXPECT_THROW(VelocityObstacle(Ellipse{{5, 0}, bad, 0, 1}, {}, 1.0, 1.0), std::logic_error);
    const VelocityObstacle good(disc, {}, 1.0, 1.0);
    EXPECT_THROW(good.contains({bad, 0}), std::logic_error);
    EXPECT_THROW(good.half_plane({0, bad}), std::logic_error);
    EXPECT_THROW(good.nearest_boundary({0, bad}), std::logic_error);
    EXPECT_THROW(good.half_plane({0, 0}, bad), std::logic_error);
    EXPECT_THROW(vo::reciprocal_half_planes({{0, 0}, {bad, 0}, 1}, {{5, 0}, {}, 1}), std::logic_error);
    EXPECT_THROW(vo::reciprocal_half_planes({{0, bad}, {0, 0}, 1}, {{5, 0}, {}, 1}), std::logic_error);
    EXPECT_THROW(vo::reciprocal_half_planes({{0, 0}, {0, 0}, bad}, {{5, 0}, {}, 1}), std::logic_error);
    vo::OrcaChain chain = vo::orca_chains(geometry::Polyline{{{0, 0}, {1, 0}}})[0];
    EXPECT_THROW(vo::orca_half_planes(chain, {0}, {bad, 2}, {}, 0.5, 1.0), std::logic_error);
    EXPECT_THROW(vo::orca_half_planes(chain, {0}, {0, 2}, {0, bad}, 0.5, 1.0), std::logic_error);
  }
  EXPECT_THROW(VelocityObstacle(disc, {}, 1.0, 0.0), std::logic_error);
  EXPECT_THROW(VelocityObstacle(ConvexPolygon{}, {}, 1.0, 1.0), std::logic_error);
  EXPECT_THROW(VelocityObstacle(disc, {}, 1.0, 1.0).half_plane({0, 0}, 0.0), std::logic_error);
  vo::ReciprocalOptions options;
  options.time_horizon = 0.0;
  EXPECT_THROW(vo::reciprocal_half_planes({{0, 0}, {}, 1}, {{5, 0}, {}, 1}, options), std::logic_error);
}

TEST(VelocityObstacle, ExtremeNumbersGiveSafeHalfPlanesOrNone) {
    const double sizes[] = {1e-300, 1e-150, 1e-9, 1.0, 1e9, 1e150, 1e300};
  int judged = 0;
  for (const double size : sizes) {
    for (const double away : sizes) {
      for (const ConvexShape& shape :
           {ConvexShape{Disc{{away, 0.5 * away}, size}}, ConvexShape{Ellipse{{away, 0}, size, size, size}},
            ConvexShape{Segment{{away, -size}, {away, size}}},
            ConvexShape{ConvexPolygon{{{away, 0}, {away + size, 0}, {away + size, size}}}}}) {
        const GrownShape s{shape, {}, 0.5 * size};
        const VelocityObstacle obstacle = velocity_obstacle(s, 2.0);
        if (obstacle.overlaps()) continue;
        for (const Vec2 v : {Vec2{0, 0}, Vec2{away, away}, Vec2{1, -1}}) {
          if (const auto h = obstacle.half_plane(v)) {
                        EXPECT_TRUE(is_safe(s, 2.0, *h)) << text_of(s, 2.0, v);
            ++judged;
          }
        }
      }
    }
  }
  EXPECT_GT(judged, 100);
}

}  // namespace
}  // namespace exactvo::test
