// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles that are discs, at rest and moving, from the scene to the audit; and motions from velocities.
#include "exactvo/formation/disc_obstacle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "audited.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/round_polygon.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using geometry::Disc;
using testing::HasSubstr;

TEST(PolygonRound, HoldsItsDiscAndIsNoLargerThanItSays) {
  test::SeededRandom random(test::seed_of_run(91));
  int judged = 0;
  for (const double scale : {1e-3, 1.0, 1e3})
    for (const double shift : {0.0, 1e3, 1e6})
      for (int k = 0; k < 30; ++k, ++judged) {
        const Disc disc{shift * random.direction() + scale * random.in_box(5), scale * random.uniform(0.01, 3.0)};
        const geometry::Polygon polygon = geometry::polygon_round(disc);
        ASSERT_EQ(polygon.outer.size(), static_cast<std::size_t>(geometry::kRoundCorners));
        EXPECT_TRUE(geometry::holds_disc(polygon, disc));
        EXPECT_FALSE(geometry::holds_disc(polygon, {disc.center, disc.radius * 1.001 + 1e-6 * scale}));
        const double most = geometry::kRoundExcess * disc.radius + 0x1p-46 * (shift + 10 * scale + disc.radius);
        for (const Vec2 corner : polygon.outer) EXPECT_LE(norm(corner - disc.center) - disc.radius, 1.001 * most);
      }
  EXPECT_EQ(judged, 270);
}

TEST(PolygonRound, RefusesWhatHasNoCornersToTellApart) {
  for (const Disc& disc :
       {Disc{{0, 0}, 0.0}, Disc{{0, 0}, -1.0}, Disc{{1e6, 0}, 1e-9}, Disc{{NAN, 0}, 1.0}, Disc{{0, 0}, INFINITY}})
    EXPECT_THROW(geometry::polygon_round(disc), std::invalid_argument) << disc.radius;
}

/// A robot from left to right, and a post in its way.
Scenario post(double scale = 1.0, Vec2 shift = {}) {
  Scenario s;
  s.name = "post";
  const auto at = [&](double x, double y) { return scale * Vec2{x, y} + shift; };
  s.robots.resize(1);
  s.robots[0] = {"R1", at(-4, 0.1), {}, 0.4 * scale, 1.0 * scale, {at(4, 0)}};
  s.obstacles.push_back(disc_obstacle("post", {at(0, 0), 1.0 * scale}));
  s.margins.obstacle *= scale;
  s.margins.robot *= scale;
  s.arrival_tolerance *= scale;
  s.neighbour_distance *= scale;
  s.time_limit = 30.0;
  return s;
}

TEST(DiscObstacle, EveryMethodGoesRoundItAndTheAuditAgrees) {
  int judged = 0;
  for (const Method method : {Method::ivo, Method::ivo_cluster, Method::ivo_edge, Method::orca})
    for (const Guidance guidance : {Guidance::route, Guidance::none})
      for (const bool is_shifted : {false, true}) {
        Scenario s = is_shifted ? post(1.0, {1e6, -1e6}) : post();
        s.guidance = guidance;
        ASSERT_TRUE(validate(s).empty());
        SimulationOptions options;
        options.method = method;
        const Recording run = simulate(s, options);
        const Metrics m = evaluate(s, run).metrics;
        EXPECT_TRUE(m.collisions.empty()) << name(method) << ": " << m.outcome;
        ASSERT_TRUE(m.min_obstacle_clearance);
        EXPECT_GE(*m.min_obstacle_clearance, 0.0) << name(method);
        EXPECT_LT(*m.min_obstacle_clearance, 0.5) << name(method) << ": it goes by";
        EXPECT_TRUE(audits_clean(s, run)) << name(method) << " " << static_cast<int>(guidance);
        const bool has_route = guidance == Guidance::route && method != Method::ivo_edge;
        EXPECT_TRUE(m.all_arrived || !has_route) << name(method) << ": " << m.outcome;
        ++judged;
      }
  EXPECT_EQ(judged, 16);
}

TEST(DiscObstacle, AnAuditAgainstALargerDiscFails) {
  const Scenario s = post();
  const Recording run = simulate(s);
  ASSERT_TRUE(audits_clean(s, run));
  Scenario larger = s;
  larger.obstacles[0] = disc_obstacle("post", {{0, 0}, 1.2});
  EXPECT_FALSE(audits_clean(larger, run));
  larger = s;
  larger.obstacles[0].disc->radius = 1.001;  // its polygon does not hold it, and no body stands for it
  EXPECT_FALSE(audits_clean(larger, run));
}

TEST(DiscObstacle, TheVelocityObstacleIsThatOfTheDisc) {
  const Recording run = simulate(post());
  int discs = 0, others = 0;
  for (const vo::Body& body : run.bodies)
    if (body.kind == vo::BodyKind::enclosure) {
      const auto* disc = std::get_if<Disc>(&body.shape);
      disc && disc->radius == 1.0 && disc->center == Vec2{} ? ++discs : ++others;
    }
  EXPECT_EQ(discs, 1);
  EXPECT_EQ(others, 0);
}

TEST(DiscObstacle, ScaledScenesEndAlike) {
  const Metrics usual = evaluate(post(), simulate(post())).metrics;
  for (const double scale : {1e3, 1e-3}) {
    const Scenario s = post(scale);
    const Metrics m = evaluate(s, simulate(s)).metrics;
    EXPECT_TRUE(m.all_arrived) << scale;
    EXPECT_NEAR(*m.min_obstacle_clearance / scale, *usual.min_obstacle_clearance, 0.02) << scale;
  }
}

TEST(DiscObstacle, BetweenRimAndPolygonThereIsRoomToStand) {
  // In the direction of a corner, nearer than the corner.
  Scenario s = post();
  const double angle = geometry::kPi / geometry::kRoundCorners, gap = 1e-3;
  s.robots[0].position = (1.4 + gap) * Vec2{std::cos(angle), std::sin(angle)};
  EXPECT_LT(geometry::signed_distance(s.obstacles[0].shape, s.robots[0].position), s.robots[0].radius);
  EXPECT_NEAR(signed_distance(s.obstacles[0], s.robots[0].position), s.robots[0].radius + gap, 1e-12);
  EXPECT_TRUE(validate(s).empty());
  const Recording run = simulate(s);
  const Metrics m = evaluate(s, run).metrics;
  EXPECT_TRUE(m.collisions.empty()) << m.outcome;
  EXPECT_TRUE(audits_clean(s, run));
  s.robots[0].position = 1.399 * Vec2{std::cos(angle), std::sin(angle)};
  ASSERT_EQ(validate(s).size(), 1u);
  EXPECT_THAT(validate(s)[0].found, HasSubstr("overlapping obstacle 'post' by 0.001 m"));
}

TEST(DiscObstacle, OneThatItsPolygonDoesNotHoldIsRefused) {
  Scenario s = post();
  s.obstacles[0].disc->radius = 1.01;
  ASSERT_FALSE(validate(s).empty());
  EXPECT_EQ(validate(s)[0].pointer, "/obstacles/0/disc");
}

TEST(DiscObstacle, MovingDiscsAreAvoidedAsDiscs) {
  int judged = 0;
  for (const Method method : {Method::ivo, Method::orca})
    for (const double from : {3.0, -3.0}) {
      Scenario s = post();
      s.obstacles.clear();
      s.moving_obstacles.push_back(moving_disc("ball", {{0, from}, 0.5}, {{{0, from}, {0, -from}}, 0.8}));
      SimulationOptions options;
      options.method = method;
      const Recording run = simulate(s, options);
      const Metrics m = evaluate(s, run).metrics;
      EXPECT_TRUE(m.collisions.empty()) << m.outcome;
      EXPECT_TRUE(m.all_arrived) << m.outcome;
      EXPECT_TRUE(audits_clean(s, run));
      const geometry::ConvexShape hull = hull_of(s.moving_obstacles[0], {1, 2});
      ASSERT_TRUE(std::holds_alternative<Disc>(hull));
      EXPECT_EQ(std::get<Disc>(hull).center, (Vec2{1, from + 2}));
      ++judged;
    }
  EXPECT_EQ(judged, 4);
}

TEST(DiscObstacle, OneThatRunsIntoARobotOverlapsItByWhatTheDiscsDo) {
  // The robot cannot get away: walls on both sides, and the ball comes at it.
  Scenario s = post();
  s.obstacles.clear();
  s.robots[0].position = s.robots[0].goals[0] = {0, 0};
  s.robots[0].max_speed = 1e-3;
  s.moving_obstacles.push_back(moving_disc("ball", {{2, 0}, 0.5}, {{{2, 0}, {0.8, 0}}, 1.0}));
  s.time_limit = 3.0;
  s.robots[0].goals = {{-1, 0}};
  const Recording run = simulate(s);
  const Metrics m = evaluate(s, run).metrics;
  ASSERT_EQ(m.collisions.size(), 1u);
  EXPECT_NEAR(m.collisions[0].depth, 0.1, 4e-3);
}

TEST(PathOf, OneVelocityIsAStraightPathThatLastsBeyondTheEnd) {
  const TimedPath motion = path_of({1, 2}, {{0.0, {3, -4}}}, 10.0);
  EXPECT_EQ(motion.speed, 5.0);
  EXPECT_TRUE(motion.profile.empty());
  const MovingObstacle o = moving_disc("o", {{1, 2}, 0.5}, motion);
  for (const double t : {0.0, 1.0, 9.99, 10.0}) EXPECT_LT(norm(displacement_at(o, t) - t * Vec2{3, -4}), 1e-12);
}

TEST(PathOf, VelocitiesAreKeptUntilTheNext) {
  const std::vector<TimedVelocity> velocities{{1.0, {1, 0}}, {2.0, {0, 0}}, {3.0, {0, 2}}, {4.5, {-1, -1}}};
  const MovingObstacle o = moving_disc("o", {{0, 0}, 0.5}, path_of({0, 0}, velocities, 20.0));
  int judged = 0;
  for (double t = 0.0; t <= 20.0; t += 0.125, ++judged) {
    Vec2 place{};
    for (std::size_t k = 0; k < velocities.size(); ++k) {
      const double until = k + 1 < velocities.size() ? velocities[k + 1].time : 20.0;
      place += std::max(0.0, std::min(t, until) - velocities[k].time) * velocities[k].velocity;
    }
    EXPECT_LT(norm(displacement_at(o, t) - place), 1e-11) << t;
  }
  EXPECT_EQ(judged, 161);
  EXPECT_EQ(path_of({4, 4}, {}, 5.0).path.size(), 1u);
  EXPECT_EQ(displacement_at(moving_disc("o", {{0, 0}, 1}, path_of({}, {{0.0, {0, 0}}}, 5.0)), 4.0), Vec2{});
}

}  // namespace
}  // namespace exactvo::formation
