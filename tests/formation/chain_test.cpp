// SPDX-License-Identifier: GPL-3.0-or-later
// Footprints of robots on wheels as chains of discs beside obstacles: lemma 7 and the suffix lemma of
// docs/guide/wheels.md, and a robot that passes a door that its disc does not fit through.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/trap.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/twist.h"
#include "metrics/clearances.h"
#include "motion/differential.h"
#include "scene/chain.h"
#include "support/seeded_random.h"
#include "wheels_scenes.h"

namespace exactvo::formation {
namespace {

using datasets::AuditPoint;
using datasets::AuditReport;
using detail::kRoomOfLinks;
using detail::links_are_clear;
using detail::ObstacleSpace;
using testing::HasSubstr;
using namespace test_scenes;

constexpr double kStep = 0.05, kBraking = 0.7;  // s

/// A Neobotix MP-500 (datasets/data/robots/README.md).
DifferentialDrive mp500() {
  DifferentialDrive d;
  d.wheel_separation = 0.5;
  d.max_wheel_speed = 1.5;
  d.max_wheel_acceleration = 2.4;
  d.reference = 0.25;
  d.footprint = {{-0.527, -0.296}, {0.296, -0.296}, {0.296, 0.296}, {-0.527, 0.296}};
  return d;
}

Robot on_wheels(DifferentialDrive d, Vec2 axle, double heading, std::vector<Vec2> goals) {
  Robot r;
  r.id = "M";
  d.axle = axle;
  d.heading = heading;
  put_on_wheels(r, d, kStep);
  r.goals = std::move(goals);
  return r;
}

geometry::Polygon box(Vec2 low, Vec2 high) {
  return {{low, {high.x, low.y}, high, {low.x, high.y}}, {}};
}

/// A wall of 0.15 m at x = 3 with a door of `width` about y = 0.
Scenario door(double width, DifferentialDrive d = mp500()) {
  Scenario s;
  s.name = "door";
  s.time_limit = 30.0;
  s.margins.obstacle = 0.01;
  s.obstacles = {{"north", box({3.0, 0.5 * width}, {3.15, 6.0})}, {"south", box({3.0, -6.0}, {3.15, -0.5 * width})}};
  s.robots = {on_wheels(d, {0.0, 0.3}, 0.0, {{6.0, -0.3}})};
  return s;
}

/// m: the least distance of the edges of the polygon itself from the obstacles, sampled within steps.
double least_gap(const datasets::RecordingFile& file) {
  const Scenario& s = file.scenario;
  const DifferentialDrive& d = *s.robots[0].drive;
  double least = 1e9;
  for (std::size_t k = 0; k + 1 < file.recording.steps.size(); ++k) {
    const RobotStep& now = file.recording.steps[k].robots[0];
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      const detail::TwistOfStep part =
          detail::twist_of(d, s.time_step, now.wheels->heading, now.chosen);  // at constant speed of its wheels
      const double angle = 2.0 * std::atan(part.turn) * share;
      const Vec2 e = geometry::rotated(now.wheels->heading, angle);
      const Vec2 axle = now.position + share * s.time_step * now.chosen - d.reference * e;
      std::vector<Vec2> corners;
      for (const Vec2 c : d.footprint) corners.push_back(axle + c.x * e + c.y * Vec2{-e.y, e.x});
      for (const SceneObstacle& o : s.obstacles) {
        for (std::size_t a = 0; a < corners.size(); ++a)
          least = std::min(least, geometry::swept_distance(o.shape, {corners[a], corners[(a + 1) % corners.size()]}));
      }
    }
  }
  return least;
}

/// A disc at d behind a reference point that goes straight at s accelerates by |d| (s / D)^2 |sin delta|.
TEST(Chain, Lemma7_TheAccelerationOfADiscBehindThePoint) {
  test::SeededRandom random(test::seed_of_run(7));
  for (int k = 0; k < 2000; ++k) {
    const double ahead = random.uniform(0.05, 0.5), speed = random.uniform(0.05, 1.5),
                 behind = random.uniform(-0.5, 1.0);
    const double error = random.uniform(-3.1, 3.1), h = 1e-4 * ahead / speed;
    const auto at = [&](double t) {
      const double left = 2.0 * std::atan(std::tan(0.5 * error) * std::exp(-speed * t / ahead));
      return Vec2{speed * t - behind * std::cos(left), behind * std::sin(left)};
    };
    const Vec2 second = (at(h) - 2.0 * at(0.0) + at(-h)) / (h * h);
    const double lemma = std::fabs(behind) * (speed / ahead) * (speed / ahead) * std::fabs(std::sin(error));
    EXPECT_NEAR(norm(second), lemma, 1e-4 * (lemma + speed * speed / ahead)) << k;
  }
}

/// Any point of the footprint is in a disc of the chain, whatever the shape and the reference point.
TEST(Chain, ItHoldsTheFootprint) {
  test::SeededRandom random(test::seed_of_run(3));
  int asked = 0;
  for (int k = 0; k < 300; ++k) {
    DifferentialDrive d = mp500();
    d.reference = random.uniform(0.1, 0.9);
    const double front = random.uniform(0.05, 0.8), rear = random.uniform(0.05, 0.8), half = random.uniform(0.05, 0.6);
    d.footprint = {{-rear, -half}, {front, -half}, {front, half}, {-rear, half}};
    Robot r;
    put_on_wheels(r, d, kStep);
    const double more = stray_of(d, kStep);
    EXPECT_EQ(r.drive->chain[0].center, (Vec2{d.reference, 0.0}));
    for (int n = 0; n < 200; ++n, ++asked) {
      const Vec2 p{random.uniform(-rear, front), random.uniform(-half, half)};
      EXPECT_TRUE(std::any_of(r.drive->chain.begin(), r.drive->chain.end(),
                              [&](const geometry::Disc& disc) { return norm(p - disc.center) + more <= disc.radius; }))
          << k << " " << p.x << " " << p.y;
    }
  }
  EXPECT_EQ(asked, 60000);
}

/// Random poses among pillars: where the way and the turn of a velocity are clear, no disc touches anything in any
/// twist of the braking that follows.
TEST(Chain, SuffixLemma_WhatIsClearStaysClearWhileBraking) {
  test::SeededRandom random(test::seed_of_run(5));
  std::vector<SceneObstacle> pillars;
  for (int k = 0; k < 14; ++k) {
    const Vec2 at = random.in_box(3.0);
    pillars.push_back({"P" + std::to_string(k), box(at, at + Vec2{0.2, 0.3})});
  }
  const ObstacleSpace space(pillars);
  const Robot robot = on_wheels(mp500(), {}, 0.0, {});
  const DifferentialDrive& d = *robot.drive;
  int clear = 0, blocked = 0;
  for (int k = 0; k < 4000; ++k) {
    Vec2 at = random.in_box(3.0), e = random.direction(), u = random.uniform(0.0, 1.5) * random.direction();
    if (!links_are_clear(space, d, at, e, u, kBraking)) {
      ++blocked;
      continue;
    }
    ++clear;
    for (int step = 0; step < 40; ++step) {
      const detail::TwistOfStep twist = detail::twist_of(d, kStep, e, u);
      for (const double share : {0.0, 0.5}) {
        const Vec2 now = geometry::rotated(e, 2.0 * share * std::atan(twist.turn));
        for (std::size_t link = 1; link < d.chain.size(); ++link) {
          const geometry::Disc disc = link_at(d, link, at + share * kStep * u, now);
          ASSERT_GE(space.clearance(disc.center, 2.0 * disc.radius), disc.radius) << k << " " << step << " " << link;
        }
      }
      at += kStep * u;
      e = detail::turned(e, twist.turn);
      u = (1.0 - kStep / kBraking) * u;
    }
  }
  EXPECT_GT(clear, 300);
  EXPECT_GT(blocked, 300);
}

TEST(Chain, AnMp500PassesADoorOf70Centimetres) {
  const Scenario s = door(0.7);
  EXPECT_GT(s.robots[0].radius, 0.8);
  EXPECT_LT(obstacle_radius(s.robots[0]), 0.32);
  const datasets::RecordingFile file = recorded(s);
  EXPECT_EQ(file.recording.outcome, "the robot arrived");
  EXPECT_EQ(relaxed_in(file.recording), 0u);
  const AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_GT(report[AuditPoint::braking].proven, 2 * file.recording.steps.size());
  const double gap = least_gap(file);
  EXPECT_GT(gap, 0.0);
  EXPECT_LT(gap, 0.06) << "there is a door";
  const Metrics metrics = evaluate(s, file.recording).metrics;
  EXPECT_TRUE(metrics.collisions.empty());
  ASSERT_TRUE(metrics.min_obstacle_clearance);
  EXPECT_GE(*metrics.min_obstacle_clearance, 0.0);
  EXPECT_LT(*metrics.min_obstacle_clearance, gap);
  std::printf("door of 0.70 m: %.2f s, least gap of the body %.3f m\n", last_arrival(file), gap);
}

/// For a body that is round about its reference point the first disc of the chain is larger than the disc between
/// robots, and routes are planned for either.
TEST(Chain, ABodyThatIsRoundAboutItsReferencePointArrives) {
  DifferentialDrive d;
  d.wheel_separation = 0.5;
  d.max_wheel_speed = 0.5;
  d.max_wheel_acceleration = 1.0;
  d.reference = 0.3;
  d.footprint = {{0.8, 0.0},  {0.65, 0.35},   {0.3, 0.5},  {-0.05, 0.35},
                 {-0.2, 0.0}, {-0.05, -0.35}, {0.3, -0.5}, {0.65, -0.35}};
  Scenario s;
  s.name = "round";
  s.robots = {on_wheels(d, {-2.3, 0.0}, 0.0, {{2.5, 0.0}})};
  s.obstacles.push_back(disc_obstacle("post", {{0.0, 0.05}, 0.03}));
  ASSERT_GT(obstacle_radius(s.robots[0]), s.robots[0].radius);
  const datasets::RecordingFile file = recorded(s);
  EXPECT_THAT(file.recording.outcome, testing::HasSubstr("the robot arrived"));
  EXPECT_TRUE(datasets::audit(file).clean());
}

/// With half-planes about the first disc alone the tail would cut a corner: the audit refutes such a run.
TEST(Chain, WithoutTheCheckOfItsTurnsTheAuditRefutesTheRun) {
  Scenario s = door(0.7);
  s.obstacles = {{"corner", box({1.2, 0.5}, {4.0, 4.0})}};
  s.robots = {on_wheels(mp500(), {0.0, 0.0}, 0.0, {{4.6, 3.0}})};
  const datasets::RecordingFile with = recorded(s);
  EXPECT_EQ(with.recording.outcome, "the robot arrived");
  EXPECT_TRUE(datasets::audit(with).clean());
  EXPECT_GT(least_gap(with), 0.0);
  Scenario blind = s;
  blind.robots[0].drive->chain.resize(1);
  datasets::RecordingFile file{datasets::run_info(s, {}, {}), s, {}};
  file.recording = simulate(blind);
  EXPECT_EQ(least_gap(file), 0.0) << "its tail cuts the corner";
  const AuditReport report = datasets::audit(file);
  EXPECT_GT(report[AuditPoint::braking].refuted, 0u);
  EXPECT_GT(report[AuditPoint::motions].refuted + report[AuditPoint::motions].open, 0u);
}

/// A turn on the spot swings the rear of an MP-500 into a wall beside it, while its first disc moves away.
TEST(Chain, ItsRearCountsInDistancesAndCollisions) {
  Scenario s;
  s.time_step = kStep;
  s.robots = {on_wheels(mp500(), {}, 0.0, {{6.0, 0.0}})};
  const Robot& robot = s.robots[0];
  const DifferentialDrive& d = *robot.drive;
  const double below = -(obstacle_radius(robot) + 0.02);
  const geometry::Polyline wall{{{-2.0, below}, {-0.4, below}}};
  s.obstacles = {{"wall", wall}};
  const WheelSpeeds speeds{-0.5, 0.5};
  const double turn = (speeds.right - speeds.left) / d.wheel_separation;
  const Vec2 ahead{1.0, 0.0}, turned = geometry::rotated(ahead, kStep * turn);
  const geometry::Twist twist{{0.0, d.reference * turn}, turn};
  const Vec2 end = robot.position + geometry::displacement_after(twist, kStep).by;
  double least = 1e9;
  for (std::size_t link = 1; link < d.chain.size(); ++link) {
    const geometry::Disc disc = link_at(d, link, end, turned);
    least = std::min(least, geometry::swept_distance(wall, {disc.center, disc.center}) - disc.radius);
  }
  ASSERT_LT(least, -0.01);
  ASSERT_GT(geometry::swept_distance(wall, {robot.position, end}) - obstacle_radius(robot), 0.02);

  Recording run;
  run.motion = MotionLaw::straight;
  run.time_step = kStep;
  run.steps.resize(2);
  for (Step& row : run.steps) row.robots.resize(1);
  run.steps[1].time = kStep;
  run.steps[0].robots[0].position = robot.position;
  run.steps[0].robots[0].wheels = OnWheels{ahead, {}};
  run.steps[1].robots[0].position = end;
  run.steps[1].robots[0].wheels = OnWheels{turned, speeds};

  const std::vector<double> series = obstacle_distance_series(s, run, 0);
  ASSERT_EQ(series.size(), 2u);
  EXPECT_NEAR(series[0], 0.02, 1e-9);
  EXPECT_NEAR(series[1], least, 1e-9);

  detail::ClearanceSweep sweep(s, run);
  for (const Step& row : run.steps) sweep.add(row);
  const detail::Clearances found = sweep.result();
  ASSERT_EQ(found.collisions.size(), 1u);
  const Collision& c = found.collisions.front();
  EXPECT_NEAR(c.depth, -least, 2e-3);
  EXPECT_NEAR(c.deepest_at, kStep, 1e-9) << "the rear is deepest at the end of its swing";
  EXPECT_NEAR(norm(c.place - end), 0.0, 1e-9);
}

/// Against obstacles the trap test asks about the first disc, not about the wide one that holds between robots.
TEST(Chain, TheTrapTestTakesTheRadiusBesideObstacles) {
  Scenario s;
  s.name = "wall";
  s.time_step = kStep;
  s.obstacles = {{"wall", box({3.0, -2.0}, {3.15, 2.0})}};
  s.robots = {on_wheels(mp500(), {2.2, 0.0}, 0.0, {{6.0, 0.0}})};
  const double radius = obstacle_radius(s.robots[0]), gap = 3.0 - s.robots[0].position.x;
  ASSERT_LT(radius, gap);
  ASSERT_GT(s.robots[0].radius, gap);
  SimulationOptions options;
  options.method = Method::orca;
  int rests = 0;
  for (const TrapFinding& finding : trap_test(s, options)) {
    EXPECT_TRUE(finding.start_clear);
    for (const Equilibrium& e : finding.equilibria) {
      ++rests;
      EXPECT_NEAR(e.position.x, 3.0 - radius, 1e-12);
      EXPECT_TRUE(e.reachable);
    }
  }
  EXPECT_EQ(rests, 1);
}

/// In a dead end, its goal behind it.
TEST(Chain, ARobotWithoutRoomToTurnIsGivenThatReason) {
  Scenario s;
  s.name = "dead end";
  s.time_step = kStep;
  s.time_limit = 10.0;
  s.obstacles = {{"left", box({-2.0, 0.36}, {2.0, 0.5})},
                 {"right", box({-2.0, -0.5}, {2.0, -0.36})},
                 {"end", box({2.0, -0.5}, {2.2, 0.5})}};
  s.robots = {on_wheels(mp500(), {0.5, 0.0}, 0.0, {{-4.0, 0.0}})};
  const Recording run = simulate(s);
  constexpr const char* kReason = "has no room between obstacles to turn its footprint";
  EXPECT_THAT(run.outcome, HasSubstr("the robot did not arrive"));
  EXPECT_THAT(run.outcome, HasSubstr(kReason));
  EXPECT_TRUE(std::any_of(run.steps.begin(), run.steps.end(),
                          [&](const Step& row) { return row.robots[0].note.find(kReason) != std::string::npos; }));
}

TEST(Chain, ForgeriesAreRefuted) {
  const datasets::RecordingFile file = recorded(door(0.7));
  const auto refuted = [&](AuditPoint point, const auto& forge) {
    datasets::RecordingFile forged = file;
    forge(forged);
    return datasets::audit(forged)[point].refuted;
  };
  const auto drive = [](auto& f) -> DifferentialDrive& { return *f.scenario.robots[0].drive; };
  EXPECT_EQ(refuted(AuditPoint::kinematics, [&](auto&) {}), 0u);
  EXPECT_GT(refuted(AuditPoint::kinematics, [&](auto& f) { drive(f).chain[2].radius -= 0.01; }), 0u);
  EXPECT_GT(refuted(AuditPoint::kinematics, [&](auto& f) { drive(f).chain.pop_back(); }), 0u);
  EXPECT_GT(refuted(AuditPoint::kinematics, [&](auto& f) { drive(f).chain[0].center.x += 0.01; }), 0u);
  EXPECT_GT(refuted(AuditPoint::kinematics, [&](auto& f) { drive(f).footprint[0].y -= 0.01; }), 0u);
  EXPECT_GT(refuted(AuditPoint::braking,
                    [&](auto& f) {
                      f.scenario.obstacles[0].shape = box({3.0, 0.3}, {3.15, 6.0});
                    }),
            0u);
}

}  // namespace
}  // namespace exactvo::formation
