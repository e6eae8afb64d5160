// SPDX-License-Identifier: GPL-3.0-or-later
// The numbered properties of free_velocities.h, and areas that are known.
#include "exactvo/vo/free_velocities.h"
#include "exactvo/geometry/infinity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::Disc;
using geometry::kPi;
using geometry::Place;
using geometry::Vec2;
using vo::Encounter;
using vo::FreeVelocities;
using vo::FreeVelocityOptions;
using vo::Inside;
using vo::ShiftedCone;
using vo::Variant;

/// m/s: a hundred times what a shift by velocities below 1 m/s rounds by.
constexpr double kShiftRounding = 0x1p-44;
using geometry::kInfinity;

Encounter random_encounter(SeededRandom& random, int i) {
  Encounter e;
  e.radius = random.uniform(0.1, 0.4);
  e.obstacle = random_shape(random, kKinds[i % 4], random.uniform(1.6, 4.0) * random.direction(), 1.0);
  e.obstacle_velocity = i % 3 == 0 ? random.in_box(0.7) : Vec2{};
  e.time_horizon = i % 5 == 0 ? kInfinity : random.uniform(0.5, 4.0);
  if (i % 7 == 0) e.robot = random_convex_polygon(random, {}, e.radius, 5);
  return e;
}

std::vector<ShiftedCone> random_scene_of(SeededRandom& random, int count, int first) {
  std::vector<ShiftedCone> cones;
  while (static_cast<int>(cones.size()) < count) {
    const auto cone = vo::family_member(Variant::vo, random_encounter(random, first++)).cone;
    if (cone) cones.push_back(*cone);
  }
  return cones;
}

TEST(FreeVelocities, NothingForbidsTheDisc) {
  const FreeVelocities free({}, {2.0, 1e-4});
  EXPECT_LE(free.area().low, 4.0 * kPi);
  EXPECT_GE(free.area().high, 4.0 * kPi);
  EXPECT_LT(free.area().high - free.area().low, 1e-2);
  EXPECT_EQ(free.least_components(), 1u);
  EXPECT_TRUE(free.contains({2.0, 0.0}));
  EXPECT_FALSE(free.contains({2.0, 0x1p-30}));
}

TEST(FreeVelocities, AWedgeOfKnownArea) {
  // A disc of radius 1 at distance 2 for ever: a wedge of 60 degrees with its corner at 0.
  const Encounter e{Disc{{2.0, 0.0}, 0.75}, {}, {}, {}, 0.25, {}, kInfinity, 0.5};
  const FreeVelocities free({*vo::family_member(Variant::vo, e).cone}, {1.0, 1e-5});
  const double expected = kPi * 5.0 / 6.0;
  EXPECT_LE(free.area().low, expected);
  EXPECT_GE(free.area().high, expected);
  EXPECT_LT(free.area().high - free.area().low, 1e-3);
}

TEST(FreeVelocities, ACutOffOfKnownArea) {
  // With a horizon the wedge begins at the disc scaled by 1/tau: sector minus the two triangles plus the disc's part.
  const Encounter e{Disc{{2.0, 0.0}, 1.0}, {}, {}, {}, 0.0, {}, 4.0, 0.5};
  const FreeVelocities free({*vo::family_member(Variant::vo, e).cone}, {1.0, 1e-5});
  const double r = 0.25, leg = std::sqrt(0.25 - r * r);
  const double before = leg * r - r * r * kPi / 3.0;  // the kite to the tangent points minus its sector of 120 deg
  const double expected = kPi * 5.0 / 6.0 + before;
  EXPECT_LE(free.area().low, expected);
  EXPECT_GE(free.area().high, expected);
  EXPECT_LT(free.area().high - free.area().low, 1e-3);
}

TEST(FreeVelocities, Property1_BoundsHoldPointByPoint) {
  SeededRandom random(seed_of_run(631));
  int inside = 0, points = 0;
  for (int i = 0; i < 24; ++i) {
    const FreeVelocities free(random_scene_of(random, 3, i), {1.5, 1e-3});
    for (int k = 0; k < 60; ++k, ++points) {
      const Vec2 v = random.in_box(1.5);
      const bool is_free = free.contains(v);
      inside += is_free ? 1 : 0;
      if (free.inner().locate(v) == Place::inside) {
        EXPECT_TRUE(is_free) << v.x << " " << v.y;
      }
      if (is_free) {
        EXPECT_NE(free.outer().locate(v), Place::outside) << v.x << " " << v.y;
      }
      if (free.outer().locate(v) == Place::outside) {
        EXPECT_FALSE(is_free);
      }
    }
  }
  EXPECT_GT(inside, points / 10);
  EXPECT_LT(inside, points * 9 / 10);
}

/// The doubles next to x, x among them.
std::vector<Vec2> round_about(Vec2 x) {
  std::vector<Vec2> out;
  for (const double left : {-kInfinity, x.x, kInfinity})
    for (const double down : {-kInfinity, x.y, kInfinity})
      out.push_back({std::nextafter(x.x, left), std::nextafter(x.y, down)});
  return out;
}

/// On the legs and on the cut-off, to rounding.
std::vector<Vec2> boundary_of(const ShiftedCone& cone) {
  std::vector<Vec2> out;
  const auto legs = cone.cone.legs();
  if (!legs) return out;
  const double scale = 1.0 / cone.cone.time_horizon();
  for (const vo::Leg& leg : {legs->left, legs->right})
    for (const double far : {0.0, 0.25, 1.0}) out.push_back(cone.apex + scale * leg.touch + far * leg.direction);
  for (int i = 1; i < 8; ++i) {
    const Vec2 n = (i / 8.0) * legs->left.normal + (1.0 - i / 8.0) * legs->right.normal;
    out.push_back(cone.apex + scale * support_point(cone.cone.grown(), n));
  }
  return out;
}

/// How many of the doubles round about x the two bounds tell apart wrongly; none.
int wrong_round(const FreeVelocities& free, std::size_t k, Vec2 x) {
  int wrong = 0;
  for (const Vec2 v : round_about(x)) {
    const bool within = std::max(std::fabs(v.x), std::fabs(v.y)) < 1.5;  // in the square of the bounds at speed 1.5
    const bool forbidden = free.cones()[k].contains(v);
    if (!forbidden && free.cone_from_inside(k).locate(v) == Place::inside) ++wrong;
    if (forbidden && within && free.cone_from_outside(k).locate(v) == Place::outside) ++wrong;
  }
  return wrong;
}

TEST(FreeVelocities, Property1_BoundsHoldToTheLastDoubleForEveryVariant) {
  SeededRandom random(seed_of_run(636));
  int seen = 0, rounded_apices = 0;
  for (int i = 0; i < 24; ++i) {
    Encounter e = random_encounter(random, i);
    e.velocity = random.in_box(1.0);
    for (const Variant variant : {Variant::vo, Variant::rvo, Variant::hrvo}) {
      const auto cone = vo::family_member(variant, e).cone;
      if (!cone) continue;
      const FreeVelocities free({*cone}, {1.5, 1e-2});
      rounded_apices += cone->minus_apex.terms[1] != Vec2{} ? 1 : 0;
      for (const auto& piece : free.cone_from_inside(0).pieces())
        for (const Vec2 corner : piece.polygon.outer) EXPECT_EQ(wrong_round(free, 0, corner), 0) << i;
      const auto h = cone->cone.half_plane(-cone->apex);
      ASSERT_TRUE(h) << i;
      const double beyond = h->offset + dot(h->normal, cone->apex) + 0.1;  // by more than both tolerances
      EXPECT_EQ(free.compare({{h->normal, beyond}}).inside, Inside::yes) << i;
      for (const Vec2 x : boundary_of(*cone)) {
        if (norm(x) > 2.0) continue;
        EXPECT_EQ(wrong_round(free, 0, x), 0) << i;
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 200);
  EXPECT_GT(rounded_apices, 5);
}

/// The area of what the bounds of one cone leave open.
double width_of(const FreeVelocities& free) {
  return free.area().high - free.area().low;
}

FreeVelocities at_a_wall(double half_length, double radius, double tau, double speed) {
  const geometry::ConvexShape wall = geometry::fast_smallest_ellipse({{2.0, -half_length}, {2.0, half_length}}).ellipse;
  return FreeVelocities({{vo::VelocityObstacle(wall, {}, radius, tau), {}, {}}}, {speed, 1e-4});
}

TEST(FreeVelocities, TheBracketOfALongWallIsNarrow) {
  for (const double half_length : {2.0, 50.0, 300.0, 500.0, 1e6}) {
    const FreeVelocities free = at_a_wall(half_length, 0.5, 1.0, 2.0);
    EXPECT_LT(width_of(free), 0.01) << half_length;
    EXPECT_LT(free.area().low, 12.0) << half_length;
  }
}

TEST(FreeVelocities, TheBracketOfAHugeDiscIsNarrow) {
  for (const double radius : {11.0, 1e3, 1e6}) {
    const double away = radius + 1.0;
    const FreeVelocities free({{vo::VelocityObstacle(Disc{{away, 0.0}, radius}, {}, 0.0, 1.0), {}, {}}}, {2.0, 1e-4});
    EXPECT_LT(width_of(free), 0.01) << radius;
    EXPECT_LT(free.area().high, 4.0 * kPi - 1.0) << radius;
  }
}

TEST(FreeVelocities, NoSpeedAndNoHorizonTakesLong) {
  // Each of them followed a curve outside the disc through millions of contacts: the limit is far below that.
  for (const double speed : {vo::kLeastMaxSpeed, 1e-12, 1e-10, 1e-3, 1e10, vo::kMostMaxSpeed}) {
    const FreeVelocities free = at_a_wall(2.0, 0.5, 1.0, speed);
    EXPECT_LE(width_of(free), 0.01 * speed * speed) << speed;
  }
  for (const double tau : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e-9, 1e-6, 1e9, 1e300}) {
    const FreeVelocities free = at_a_wall(2.0, 0.5, tau, 2.0);
    EXPECT_LE(width_of(free), 0.01) << tau;
  }
}

TEST(FreeVelocities, AFastObstacleIsHeldToTheRoundingOfItsVelocity) {
  for (const double u : {1e3, 1e8, 1e20, vo::kMostApex}) {
    const ShiftedCone cone{vo::VelocityObstacle(Disc{{3.0, 0.0}, 1.0}, {}, 0.5, 1.0), {{{-u, 0.0}}}, {u, 0.0}};
    const FreeVelocities free({cone}, {2.0, 1e-4});
    EXPECT_EQ(free.least_components(), 1u) << u;
    EXPECT_LT(width_of(free), 0.01) << u;
    const ShiftedCone from_behind{cone.cone, {{{u, 0.0}}}, {-u, 0.0}};
    EXPECT_EQ(FreeVelocities({from_behind}, {2.0, 1e-4}).area().high, 0.0) << u;
  }
}

TEST(FreeVelocities, AlmostInContactHalfTheDiscIsFree) {
  const geometry::Segment wall{{1.0, -2.0}, {1.0, 2.0}};
  for (const geometry::ConvexShape& shape :
       {geometry::ConvexShape{wall}, geometry::ConvexShape{Disc{{2.0, 0.0}, 1.0}}}) {
    const FreeVelocities free({{vo::VelocityObstacle(shape, {}, std::nextafter(1.0, 0.0), 2.0), {}, {}}}, {1.0, 1e-3});
    EXPECT_NEAR(free.area().low, 0.5 * kPi, 0.01);
    EXPECT_NEAR(free.area().high, 0.5 * kPi, 0.01);
    EXPECT_EQ(free.least_components(), 1u);
  }
}

TEST(FreeVelocities, WhatNeitherBoundTellsIsUndecided) {
  // Half-planes across the cut-off, a circle of radius 1 round (2, 0), at a normal that is no contact of the polygons.
  const Encounter e{Disc{{2.0, 0.0}, 0.75}, {}, {}, {}, 0.25, {}, 1.0, 0.5};
  const FreeVelocities free({*vo::family_member(Variant::vo, e).cone}, {1.5, 1e-2});
  const Vec2 n{-std::cos(0.1), -std::sin(0.1)};
  const double touching = 2.0 * n.x + 1.0;
  EXPECT_EQ(free.compare({{n, touching + 1e-7}}).inside, Inside::yes);
  EXPECT_EQ(free.compare({{n, touching - 1e-7}}).inside, Inside::undecided) << "a sliver between the polygons";
  EXPECT_EQ(free.compare({{n, touching - 0.1}}).inside, Inside::no);
}

TEST(FreeVelocities, Property2_TheBracketShrinks) {
  SeededRandom random(seed_of_run(632));
  for (int i = 0; i < 6; ++i) {
    const std::vector<ShiftedCone> cones = random_scene_of(random, 3, i);
    double before = kInfinity;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      const auto area = FreeVelocities(cones, {1.5, tolerance}).area();
      EXPECT_LE(area.low, area.high);
      EXPECT_LT(area.high - area.low, before);
      EXPECT_LT(area.high - area.low, 60.0 * tolerance);  // the boundary's length times twice the width
      before = area.high - area.low;
    }
  }
}

TEST(FreeVelocities, Property3_MoreObstaclesLeaveLess) {
  SeededRandom random(seed_of_run(633));
  for (int i = 0; i < 6; ++i) {
    std::vector<ShiftedCone> cones = random_scene_of(random, 4, i);
    geometry::Bracket before{kInfinity, kInfinity};
    for (std::size_t count = 1; count <= cones.size(); ++count) {
      const auto area =
          FreeVelocities({cones.begin(), cones.begin() + static_cast<std::ptrdiff_t>(count)}, {1.5, 1e-3}).area();
      EXPECT_LE(area.low, before.low);
      EXPECT_LE(area.high, before.high);
      before = area;
    }
  }
}

TEST(FreeVelocities, Property4_CertifiedHalfPlanesStayInside) {
  SeededRandom random(seed_of_run(634));
  for (int i = 0; i < 12; ++i) {
    const std::vector<ShiftedCone> cones = random_scene_of(random, 3, i);
    const FreeVelocities free(cones, {1.5, 1e-3});
    std::vector<geometry::HalfPlane> half_planes;
    for (const ShiftedCone& cone : cones) {
      const auto h = cone.cone.half_plane(-cone.apex);
      ASSERT_TRUE(h);
      const double shift = dot(h->normal, cone.apex);
      half_planes.push_back({h->normal, h->offset + shift + kShiftRounding});
    }
    const vo::RegionReport report = free.compare(half_planes);
    EXPECT_EQ(report.inside, Inside::yes);
    EXPECT_LE(report.given_away.low, report.given_away.high);
    EXPECT_NEAR(report.given_away.low, free.area().low - report.area.high, 0.1);
    double lost = 0.0;
    for (const vo::LostPiece& piece : report.lost) {
      lost += piece.area.high;
      EXPECT_GT(violation(half_planes[piece.half_plane], piece.farthest), 0.0);
    }
    EXPECT_LE(lost, report.given_away.high);
  }
}

TEST(FreeVelocities, HalfPlanesThatCutIntoAConeAreNotInside) {
  SeededRandom random(seed_of_run(635));
  int cut = 0;
  for (int i = 0; i < 24; ++i) {
    const FreeVelocities free(random_scene_of(random, 2, i), {1.5, 1e-3});
    const std::vector<geometry::HalfPlane> half_planes{{random.direction(), random.uniform(-1.0, 0.0)},
                                                       {random.direction(), random.uniform(-1.0, 0.0)}};
    const Inside inside = free.compare(half_planes).inside;
    for (int k = 0; k < 40; ++k) {
      const Vec2 v = random.in_box(1.0);
      const bool in_region = norm(v) < 1.5 && violation(half_planes[0], v) < 0.0 && violation(half_planes[1], v) < 0.0;
      if (!in_region || free.contains(v)) continue;
      EXPECT_NE(inside, Inside::yes);
      if (free.outer().locate(v) == Place::outside) {
        EXPECT_EQ(inside, Inside::no);
        ++cut;
      }
    }
  }
  EXPECT_GT(cut, 10);
}

TEST(FreeVelocities, AWallOfConesSplitsTheDisc) {
  // Two walls ahead and behind that come nearer: what is left lies to the left and to the right.
  std::vector<ShiftedCone> cones;
  for (const double side : {1.0, -1.0}) {
    const Encounter e{
        geometry::Segment{{2.0 * side, -2.0}, {2.0 * side, 2.0}}, {-0.1 * side, 0.0}, {}, {}, 0.3, {}, kInfinity, 0.5};
    cones.push_back(*vo::family_member(Variant::vo, e).cone);
  }
  const FreeVelocities free(cones, {1.0, 1e-3});
  EXPECT_EQ(free.least_components(), 2u);
  EXPECT_EQ(free.inner().pieces().size(), 2u);
}

TEST(FreeVelocities, OverlapLeavesNothing) {
  ShiftedCone cone{vo::VelocityObstacle(Disc{{0.5, 0.0}, 1.0}, {}, 0.1, 1.0), {}, {}};
  const FreeVelocities free({cone}, {1.0, 1e-3});
  EXPECT_EQ(free.area().high, 0.0);
  EXPECT_FALSE(free.contains({}));
}

TEST(FreeVelocities, OptionsOutOfRangeAreMistakes) {
  EXPECT_THROW(FreeVelocities({}, {0.0, 1e-3}), std::logic_error);
  EXPECT_THROW(FreeVelocities({}, {kInfinity, 1e-3}), std::logic_error);
  EXPECT_THROW(FreeVelocities({}, {1.0, 0.0}), std::logic_error);
  EXPECT_THROW(FreeVelocities({}, {1e-310, 1e-3}), std::logic_error);
  EXPECT_THROW(FreeVelocities({}, {1e120, 1e-3}), std::logic_error);
  const ShiftedCone fast{vo::VelocityObstacle(Disc{{3.0, 0.0}, 1.0}, {}, 0.5, 1.0), {{{-1e160, 0.0}}}, {1e160, 0.0}};
  EXPECT_THROW(FreeVelocities({fast}, {1.0, 1e-3}), std::logic_error);
}

TEST(Region, NumbersOutOfRangeAreMistakes) {
  using geometry::Region;
  const double most = geometry::kLargestRegionCoordinate, beyond = 2.0 * most;
  const auto triangle = [](double r) { return std::vector<Vec2>{{0.0, 0.0}, {r, 0.0}, {0.0, r}}; };
  EXPECT_EQ(Region::hull_of(triangle(most)).area().high, 0.5 * most * most);
  EXPECT_THROW(Region::hull_of(triangle(beyond)), std::logic_error);
  EXPECT_THROW(Region::cut({triangle(1.0)}, {{{1.0, 0.0}, beyond}}), std::logic_error);
  EXPECT_THROW(Region::hull_of(triangle(1.0)).locate({beyond, 0.0}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
