// SPDX-License-Identifier: GPL-3.0-or-later
// The monitor of a control loop: shares against formulas and against an oracle that samples finely.
#include "exactvo/formation/monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "counted_allocations.h"
#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "support/seeded_random.h"

namespace exactvo::test {
namespace {

using formation::Command;
using formation::Monitor;
using formation::MonitorError;
using formation::MonitorProblem;
using formation::MonitorSetup;
using formation::MonitorVerdict;
using formation::Mover;
using formation::SceneObstacle;
using formation::TimedPose;
using geometry::kInfinity;
using geometry::Pose;
using geometry::Vec2;

SceneObstacle wall(std::vector<Vec2> points) {
  return {"wall", geometry::Polyline{std::move(points)}};
}
geometry::RigidBody rectangle(double back, double front, double half_width) {
  return {{{{back, -half_width}, {front, -half_width}, {front, half_width}, {back, half_width}}, 0.0}};
}
/// Holds a command for 0.2 s, brakes with 1 m/s^2 and 2 rad/s^2.
MonitorSetup setup_with(geometry::RigidBody footprint, std::vector<SceneObstacle> obstacles) {
  MonitorSetup setup;
  setup.footprint = std::move(footprint);
  setup.obstacles = std::move(obstacles);
  return setup;
}
std::vector<Mover> mover_at(double x, double max_speed, double position_error = 0.0) {
  return {{{{{x, 0.0}}, 0.3}, max_speed, position_error}};
}
Command ahead(double speed, double turn = 0.0) {
  return {{{speed, 0.0}, turn}, false};
}

// --- Commands ---

TEST(Monitor, ShareOfACommandTowardsAWallStopsAtTheWall) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {wall({{1.0, -2.0}, {1.0, 2.0}})}));
  const MonitorVerdict v = monitor.judge({}, ahead(1.5));
  // 0.7 m are left: 0.2 s * 1.5 m/s * s + (1.5 s)^2 / 2 = 0.7.
  const double s = (-0.3 + std::sqrt(0.09 + 4.0 * 1.125 * 0.7)) / 2.25;
  EXPECT_NEAR(v.share, s, 1e-7);
  EXPECT_LT(v.share, s);
  EXPECT_NEAR(v.not_above, s, 1e-6);
  EXPECT_GT(v.not_above, s);
  ASSERT_TRUE(v.witness);
  EXPECT_FALSE(v.witness->is_mover);
  EXPECT_EQ(v.witness->index, 0u);
  EXPECT_NEAR(v.witness->place.x, 0.85, 1e-6);  // between the reference point's disc centre at 0.7 and the wall
  EXPECT_FALSE(v.in_contact);
  EXPECT_TRUE(v.proven);
}

TEST(Monitor, CommandThatStopsInTimeIsClearAsAWhole) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {wall({{1.0, -2.0}, {1.0, 2.0}})}));
  const MonitorVerdict v = monitor.judge({}, ahead(0.9));  // 0.18 + 0.405 m
  EXPECT_EQ(v.share, 1.0);
  EXPECT_FALSE(v.witness);
  EXPECT_EQ(monitor.judge({}, ahead(0.0)).share, 1.0);
}

TEST(Monitor, VelocityInWorldAxesKeepsTheHeading) {
  Monitor monitor(setup_with(rectangle(-0.2, 0.6, 0.1), {wall({{-2.0, 1.0}, {2.0, 1.0}})}));
  const Command north{{{0.0, 2.0}, 0.0}, true};
  const double left = 0.9;  // the half width is 0.1
  const double s = (-0.4 + std::sqrt(0.16 + 4.0 * 2.0 * left)) / 4.0;
  EXPECT_NEAR(monitor.judge({{0, 0}, 0.0}, north).share, s, 1e-7);
  EXPECT_LT(monitor.judge({{0, 0}, 0.5 * geometry::kPi}, north).share, s) << "its front is 0.6 m ahead";
  EXPECT_THROW(monitor.judge({}, {{{1.0, 0.0}, 0.1}, true}), MonitorError);
}

TEST(Monitor, MarginCountsAsRadius) {
  MonitorSetup setup = setup_with(geometry::disc_body(0.3), {wall({{1.0, -2.0}, {1.0, 2.0}})});
  const double without = Monitor(setup).judge({}, ahead(1.5)).share;
  setup.margin = 0.1;
  const double with = Monitor(setup).judge({}, ahead(1.5)).share;
  setup.margin = 0.0;
  setup.footprint = geometry::disc_body(0.4);
  EXPECT_NEAR(with, Monitor(setup).judge({}, ahead(1.5)).share, 1e-9);
  EXPECT_LT(with, without - 0.01);
}

// A monitor that looked at samples of a rectangle's outline missed what it turns into (pure rotation of a long
// robot, 0.3 rad/s, beside single points of a scan).
TEST(Monitor, LongRobotThatTurnsOnTheSpotStopsBeforeAPointOfAScan) {
  const double at = 20.0 * geometry::kPi / 180.0;  // seen from the axle, ahead of the side of the front
  const Vec2 point = geometry::rotated({0.9, 0.2}, at);
  MonitorSetup setup = setup_with(rectangle(-0.4, 1.0, 0.2), {formation::disc_obstacle("point", {point, 0.001})});
  setup.period = 2.0;
  Monitor monitor(setup);
  const MonitorVerdict v = monitor.judge({}, ahead(0.0, 0.3));
  EXPECT_LT(v.share, 1.0);
  EXPECT_GT(v.share, 0.3);
  ASSERT_TRUE(v.witness);
  EXPECT_NEAR(v.witness->place.x, point.x, 0.01);
  EXPECT_NEAR(v.witness->time * 0.3, at, 0.03) << "the side reaches it after 20 degrees, less the point's radius";
  EXPECT_EQ(monitor.judge({}, ahead(0.0, -0.3)).share, 1.0) << "away from it";
}

// A monitor that moves the footprint by one step of its simulation, and looks only then, drives on with an obstacle in
// the footprint, and over a post that a step jumps.
TEST(Monitor, WhatIsInTheFootprintNowOrBeforeTheFirstStepStopsTheRobot) {
  constexpr double kStep = 1.0;  // s
  const geometry::RigidBody box = rectangle(-0.5, 0.5, 0.3);
  const auto post = [](double x) { return formation::disc_obstacle("post", {{x, 0.0}, 0.01}); };
  int missed_by_steps = 0, judged = 0;
  for (const double speed : {2.0, 4.0, 8.0}) {
    Monitor inside(setup_with(box, {post(0.45)})), ahead_of_it(setup_with(box, {post(0.75)}));
    const MonitorVerdict on = inside.judge({}, ahead(speed));
    EXPECT_TRUE(on.in_contact);
    EXPECT_LT(on.share, 1e-6) << speed;
    EXPECT_EQ(inside.judge({}, ahead(-speed)).share, 1.0) << "it may leave";
    const MonitorVerdict before = ahead_of_it.judge({}, ahead(speed));
    EXPECT_FALSE(before.in_contact);
    EXPECT_NEAR(speed * ahead_of_it.way(before.share).back().motion.end, 0.24, 1e-6) << "up to the post";
    // The pose after a step is clear of both.
    missed_by_steps += speed * kStep - 0.5 > 0.76;
    ++judged;
  }
  EXPECT_EQ(judged, 3);
  EXPECT_EQ(missed_by_steps, 3);
}

// Between two poses a quarter turn apart a square is clear, and its corner is not.
TEST(Monitor, CornerThatTurnsIntoAWallBetweenTwoClearPosesIsSeen) {
  MonitorSetup setup = setup_with(rectangle(-1.0, 1.0, 1.0), {wall({{1.2, -5.0}, {1.2, 5.0}})});
  setup.latency = setup.period = 0.0;
  setup.max_turn_deceleration = 1e3;
  Monitor monitor(setup);
  const std::vector<TimedPose> quarter{{0.0, {{0, 0}, 0.0}}, {1.0, {{0, 0}, 0.5 * geometry::kPi}}};
  const MonitorVerdict v = monitor.judge(quarter);
  const double then = (std::asin(1.2 / std::sqrt(2.0)) - 0.25 * geometry::kPi) / (0.5 * geometry::kPi);
  EXPECT_NEAR(v.share, then, 0.002);
  EXPECT_LT(v.share, then);
}

// --- Contact ---

TEST(Monitor, RobotInContactMayLeaveAndSlideButNotGoDeeper) {
  // The front is 0.1 m into the wall.
  Monitor monitor(setup_with(rectangle(-0.5, 0.5, 0.3), {wall({{0.4, -3.0}, {0.4, 3.0}})}));
  const MonitorVerdict back = monitor.judge({}, ahead(-1.0));
  EXPECT_EQ(back.share, 1.0);
  EXPECT_TRUE(back.in_contact);
  EXPECT_EQ(monitor.judge({}, {{{0.0, 1.0}, 0.0}, false}).share, 1.0) << "along the wall";
  const MonitorVerdict on = monitor.judge({}, ahead(0.1));
  EXPECT_LT(on.share, 1e-6);
  ASSERT_TRUE(on.witness);
  EXPECT_LT(monitor.judge({}, ahead(0.0, 0.5)).share, 1e-3) << "a corner would go deeper";
  EXPECT_EQ(monitor.judge({}, ahead(0.0)).share, 1.0) << "to stand is always allowed";
}

TEST(Monitor, RobotThatTouchesExactlyMayDriveAlongAndAway) {
  Monitor monitor(setup_with(rectangle(-0.5, 0.5, 0.25), {wall({{-3.0, 0.25}, {3.0, 0.25}})}));
  EXPECT_EQ(monitor.judge({}, ahead(1.0)).share, 1.0);
  EXPECT_EQ(monitor.judge({}, {{{0.5, -0.5}, 0.0}, false}).share, 1.0);
  EXPECT_LT(monitor.judge({}, {{{0.5, 0.01}, 0.0}, false}).share, 1e-4);
}

// A square that turns on the spot beside a wall leaves the contact with its corner, and comes back with the next one
// after a quarter turn.
TEST(Monitor, ArcThatLeavesAContactMayNotReturnToIt) {
  MonitorSetup setup = setup_with(rectangle(-1.0, 1.0, 1.0), {wall({{1.3, -5.0}, {1.3, 5.0}})});
  setup.latency = setup.period = 0.0;
  const auto turns = [](double angle) { return ahead(0.0, 2.0 * std::sqrt(angle)); };  // half of turn^2 / 2 rad/s^2
  const double at_start = 0.25 * geometry::kPi;
  const double back = 0.5 * geometry::kPi - (std::acos(1.3 / std::sqrt(2.0)));
  int judged = 0;
  for (const double sign : {1.0, -1.0}) {
    Monitor monitor(setup);
    for (const double angle : {1.0, 3.0, 2.0 * geometry::kPi, 20.0}) {
      Command command = turns(angle);
      command.twist.turn *= sign;
      const MonitorVerdict v = monitor.judge({{0, 0}, at_start}, command);
      EXPECT_TRUE(v.in_contact);
      // A share s of the turn rate turns by s^2 of the angle.
      EXPECT_NEAR(v.share * v.share * angle, std::min(angle, back), 1e-6) << sign << " " << angle;
      ++judged;
    }
  }
  EXPECT_EQ(judged, 8);
  // The same for a circle that leads away from a wall and back to it, and for a mover that stands.
  Monitor disc(setup_with(geometry::disc_body(0.3), {wall({{-10.0, 0.9}, {10.0, 0.9}})}));
  const Command circle = ahead(8.0, -4.0);
  const double share = disc.judge({{0.0, 0.7}, 0.0}, circle).share;
  EXPECT_GT(share, 0.5);
  EXPECT_LT(disc.judge({{0.0, 0.7}, 0.0}, ahead(8.0, 4.0)).share, 1e-3) << "into the wall";
  EXPECT_LT(share, 1.0);
  Monitor open(setup_with(geometry::disc_body(0.3), {}));
  const std::vector<Mover> stands{{{{{0.0, 1.1}}, 0.2}, 0.0, 0.0}};
  const double beside = open.judge({{0.0, 0.7}, 0.0}, circle, stands).share;
  EXPECT_GT(beside, 0.5);
  EXPECT_LT(beside, 1.0);
}

TEST(Monitor, ContactIsLeftAlsoFarFromTheOrigin) {
  int judged = 0;
  for (const double far : {0.0, 3e4, 1e6, 1e8}) {
    const auto at = [&](double x, double y) { return Vec2{far + x, -far + y}; };
    Monitor monitor(setup_with(rectangle(-0.5, 0.5, 0.25), {wall({at(0.375, -3.0), at(0.375, 3.0)})}));
    const auto share = [&](const Command& command) { return monitor.judge({at(0.0, 0.0), 0.0}, command).share; };
    EXPECT_EQ(share(ahead(-1.0)), 1.0) << far;
    EXPECT_EQ(share({{{0.0, 1.0}, 0.0}, false}), 1.0) << far << ", along the wall";
    EXPECT_LT(share(ahead(0.25)), 1e-6) << far;
    EXPECT_EQ(monitor.judge({at(0.0, 0.0), 0.0}, ahead(-1.0), {{{{at(0.75, 0.0)}, 0.375}, 1.0, 0.0}}).share, 1.0)
        << far << ", and a mover";
    const std::vector<TimedPose> away{{0.0, {at(0.0, 0.0), 0.0}}, {1.0, {at(-1.0, 0.0), 0.0}}, {2.0, {at(-2, 1), 1.0}}};
    EXPECT_EQ(monitor.judge(away).share, 1.0) << far;
    judged += 5;
  }
  EXPECT_EQ(judged, 20);
}

TEST(Monitor, InsideOfAPolygonCountsAsObstacle) {
  const SceneObstacle block{"block", geometry::Polygon{{{1, -1}, {3, -1}, {3, 1}, {1, 1}}, {}}};
  Monitor monitor(setup_with(geometry::disc_body(0.2), {block}));
  const MonitorVerdict inside = monitor.judge({{1.5, 0.0}, 0.0}, ahead(0.5));
  EXPECT_TRUE(inside.in_contact);
  EXPECT_LT(inside.share, 1e-6);
  EXPECT_EQ(monitor.judge({{1.5, 0.0}, geometry::kPi}, ahead(0.5)).share, 1.0) << "the way out";
}

// --- Movers ---

TEST(Monitor, MoverIsNotMetWhileTheRobotMoves) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {}));
  const MonitorVerdict v = monitor.judge({}, ahead(1.0), mover_at(3.0, 1.5));
  EXPECT_GT(v.share, 0.5);
  EXPECT_LT(v.share, 1.0);
  ASSERT_TRUE(v.witness);
  EXPECT_TRUE(v.witness->is_mover);
  // Head-on: 2.4 m less 1.5 m/s * (0.2 s + s 1 s) are left for 0.2 s + s^2 / 2.
  const double s = -1.7 + std::sqrt(1.7 * 1.7 + 2.0 * 2.1);
  EXPECT_NEAR(v.share, s, 0.02);
  EXPECT_LE(v.share, s);
  EXPECT_EQ(monitor.judge({}, ahead(1.0), mover_at(3.0, 0.0)).share, 1.0);
  const double with_error = monitor.judge({}, ahead(1.0), mover_at(3.0, 1.5, 0.3)).share;
  EXPECT_LT(with_error, v.share - 0.05);
  EXPECT_EQ(monitor.judge({}, ahead(1.0), mover_at(13.0, 1.5)).share, 1.0) << "far off";
}

TEST(Monitor, RobotBesideAMoverMayLeaveIt) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {}));
  const std::vector<Mover> close = mover_at(0.55, 1.0, 0.1);
  const MonitorVerdict v = monitor.judge({}, ahead(-0.5), close);
  EXPECT_EQ(v.share, 1.0);
  EXPECT_TRUE(v.in_contact);
  EXPECT_LT(monitor.judge({}, ahead(0.5), close).share, 0.01);
  EXPECT_EQ(monitor.judge({}, ahead(0.0), close).share, 1.0) << "to stand is always allowed";
  EXPECT_EQ(monitor.judge({}, ahead(0.0), mover_at(0.9, 5.0)).share, 1.0);
}

TEST(Monitor, CornersOfAMoverMayComeInAnyOrder) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {}));
  std::vector<Vec2> corners{{2, -5}, {2, 5}, {6, 0}};
  const auto is_before = [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  int judged = 0, cut = 0;
  do {
    const MonitorVerdict fast = monitor.judge({}, ahead(-0.5), {{{corners, 0.0}, 20.0, 0.0}});
    EXPECT_LT(fast.share, 1e-3) << "it is 2 m away and comes at 20 m/s";
    const double slow = monitor.judge({}, ahead(1.0), {{{corners, 0.1}, 1.0, 0.0}}).share;
    cut += slow < 1.0;
    EXPECT_EQ(slow, monitor.judge({}, ahead(1.0), {{{{{2, -5}, {6, 0}, {2, 5}}, 0.1}, 1.0, 0.0}}).share);
    ++judged;
  } while (std::next_permutation(corners.begin(), corners.end(), is_before));
  EXPECT_EQ(judged, 6);
  EXPECT_EQ(cut, 6);
}

// The time at which the robot rests is a root that loses half of the digits: this mover comes 1e-8 m too near then.
TEST(Monitor, MoverThatArrivesAsTheRobotComesToRestIsMet) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {}));
  EXPECT_LT(monitor.judge({}, ahead(15.62243126268577), mover_at(520.7451345042193, 24.963955443195523)).share, 1.0);
}

TEST(Monitor, LessIsClearTheLessIsKnownWhereAMoverIs) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {}));
  double last = 1.0;
  int in_contact = 0;
  for (int k = 0; k <= 30; ++k) {
    const MonitorVerdict v = monitor.judge({}, ahead(1.0), mover_at(1.0, 1.0, 0.03 * k));
    EXPECT_LE(v.share, last) << 0.03 * k;
    in_contact += v.in_contact;
    last = v.share;
  }
  EXPECT_GE(in_contact, 15);
  EXPECT_LT(in_contact, 31);
}

// --- Trajectories ---

TEST(Monitor, TrajectoryThatLeavesAContactMayNotReturnToIt) {
  MonitorSetup setup = setup_with(geometry::disc_body(0.3), {wall({{1.0, -10.0}, {1.0, 10.0}})});
  Monitor monitor(setup);
  const auto pose = [](double x) { return Pose{{x, 0}, 0}; };
  const MonitorVerdict v = monitor.judge({{0.0, pose(0.9)}, {1.0, pose(-2.0)}, {2.0, pose(0.9)}});
  EXPECT_TRUE(v.in_contact);
  // It is at 0.7 after 1 + 2.7 / 2.9 s, and needs 0.1 s + 1.45 s of way.
  EXPECT_NEAR(v.share, (1.0 + 2.7 / 2.9 - 1.55) / 2.0, 1e-6);
  EXPECT_EQ(monitor.judge({{0.0, pose(0.9)}, {1.0, pose(0.8)}, {2.0, pose(-2.0)}}).share, 1.0) << "it leaves";
}

TEST(Monitor, TrajectoryThatIsTooFastIsRefusedAndTheMonitorIsAsItWas) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {wall({{1.0, -10.0}, {1.0, 10.0}})}));
  monitor.judge({}, ahead(0.5));
  int refused = 0;
  const std::vector<std::vector<TimedPose>> bad{{{0.0, {{-5, 0}, 0}}, {5e-324, {{-5, 0}, 3}}},
                                                {{0.0, {{-5, 0}, 0}}, {1e-300, {{0.9, 0}, 0}}}};
  for (const auto& trajectory : bad) {
    try {
      monitor.judge(trajectory);
    } catch (const MonitorError& e) {
      EXPECT_EQ(e.problem(), MonitorProblem::out_of_range);
      ++refused;
    }
    ASSERT_EQ(monitor.way(1.0).size(), 1u);
    EXPECT_EQ(monitor.way(1.0)[0].motion.twist.velocity.x, 0.5);
  }
  EXPECT_EQ(refused, 2);
  EXPECT_EQ(monitor.judge({{0.0, {{-5, 0}, 0}}, {5e-324, {{-5, 0}, 0}}}, mover_at(9.0, 1.0)).share, 1.0);
  MonitorSetup setup;
  setup.max_deceleration = 1e-320;
  EXPECT_THROW(Monitor m(setup), MonitorError);
}

TEST(Monitor, TrajectoryIsClearUntilBrakingMustBegin) {
  MonitorSetup setup = setup_with(geometry::disc_body(0.3), {wall({{3.0, -2.0}, {3.0, 2.0}})});
  Monitor monitor(setup);
  const std::vector<TimedPose> on{{0.0, {{0, 0}, 0}}, {1.0, {{1, 0}, 0}}, {4.0, {{4, 0}, 0}}};
  const MonitorVerdict v = monitor.judge(on);
  // In contact after 2.7 s; brake 0.1 s + 0.5 s of way before.
  EXPECT_NEAR(v.share, 2.1 / 4.0, 1e-7);
  EXPECT_NEAR(v.not_above, 2.1 / 4.0, 1e-5);
  EXPECT_TRUE(v.proven);
  const std::vector<TimedPose> too_near{{0.0, {{2.5, 0}, 0}}, {1.0, {{3.5, 0}, 0}}};
  EXPECT_EQ(monitor.judge(too_near).share, 0.0);
  EXPECT_FALSE(monitor.judge(too_near).proven) << "it cannot brake in time";
  EXPECT_THROW(monitor.judge({{0.0, {}}}), MonitorError);
  EXPECT_THROW(monitor.judge({{0.0, {}}, {0.0, {{1, 0}, 0}}}), MonitorError);
}

TEST(Monitor, WayIsThatOfTheShare) {
  Monitor monitor(setup_with(geometry::disc_body(0.3), {}));
  EXPECT_TRUE(monitor.way(1.0).empty());
  monitor.judge({{1, 2}, 0.5}, ahead(1.0, 0.4));
  ASSERT_EQ(monitor.way(1.0).size(), 1u);
  EXPECT_NEAR(monitor.way(1.0)[0].motion.end, 0.2 + 0.5, 1e-12);
  EXPECT_NEAR(monitor.way(0.5)[0].motion.end, 0.1 + 0.125, 1e-12);
  EXPECT_EQ(monitor.way(0.5)[0].heading, 0.5);
  monitor.judge({{0.0, {{0, 0}, 0}}, {1.0, {{1, 0}, 0}}, {2.0, {{2, 0}, 1}}});
  EXPECT_EQ(monitor.way(1.0).size(), 3u) << "the last one for braking";
  EXPECT_EQ(monitor.way(0.0).size(), 1u);
}

// --- Against an oracle that samples ---

/// The least clearance of a convex footprint from walls over the way at share s, by fine samples.
double sampled_gap(const geometry::RigidBody& body, const Pose& pose, const Command& command, double share,
                   const std::vector<std::vector<Vec2>>& walls) {
  const double brake = std::max(geometry::norm(command.twist.velocity), std::fabs(command.twist.turn) / 2.0);
  const double length = 0.2 * share + 0.5 * share * share * brake;
  double least = kInfinity;
  constexpr int kSamples = 2000;
  for (int k = 0; k <= kSamples; ++k) {
    const Pose at = geometry::pose_after(pose, command.twist, length * k / kSamples);
    for (const geometry::RoundedPolygon& part : body) {
      std::vector<Vec2> corners;
      for (const Vec2 c : part.corners) corners.push_back(at.at + geometry::rotated(c, at.heading));
      for (const std::vector<Vec2>& w : walls) {
        geometry::GapKeeper keeper;
        least = std::min(least, keeper.gap_at({{{}, {}, {corners.data(), corners.size()}},
                                               {{}, {}, {w.data(), w.size()}},
                                               0.0,
                                               part.radius,
                                               0.0,
                                               0.0},
                                              0.0));
      }
    }
  }
  return least;
}

TEST(Monitor, SharesAreClearAndLargerOnesAreNot) {
  SeededRandom random(seed_of_run(91));
  int whole = 0, cut = 0, tight = 0;
  for (int i = 0; i < 150; ++i) {
    std::vector<SceneObstacle> obstacles;
    std::vector<std::vector<Vec2>> walls;
    for (int k = 0; k < 8; ++k) {
      const Vec2 a = random.in_box(3.0);
      walls.push_back({a, a + random.in_box(1.0)});
      obstacles.push_back(wall(walls.back()));
    }
    const geometry::RigidBody body = i % 2 == 0 ? rectangle(-0.3, 0.5, 0.2) : geometry::disc_body(0.25);
    Monitor monitor(setup_with(body, obstacles));
    const Pose pose{random.in_box(1.0), random.uniform(-4.0, 4.0)};
    const Command command{{random.in_box(1.8), random.uniform(-3.0, 3.0)}, false};
    const MonitorVerdict v = monitor.judge(pose, command);
    if (v.in_contact) continue;
    ASSERT_GE(sampled_gap(body, pose, command, v.share, walls), -1e-12) << i;
    ASSERT_LE(v.share, v.not_above);
    if (v.share == 1.0) {
      ++whole;
      continue;
    }
    ++cut;
    if (v.not_above < 1.0) {
      ASSERT_LT(sampled_gap(body, pose, command, v.not_above * (1.0 + 1e-6), walls), 1e-9) << i;
    }
    if (v.not_above - v.share < 1e-5) ++tight;
  }
  std::printf("%d whole, %d cut, of these %d within 1e-5\n", whole, cut, tight);
  EXPECT_GE(whole, 20);
  EXPECT_GE(cut, 20);
  EXPECT_GE(tight * 100, cut * 95);
}

TEST(Monitor, JudgesWithoutAllocatingOnceItsListsAreLong) {
  std::vector<SceneObstacle> obstacles;
  for (int k = 0; k < 200; ++k)
    obstacles.push_back(wall({{k * 0.1 - 10.0, 1.0}, {k * 0.1 - 9.9, 1.0 + 0.01 * (k % 3)}}));
  Monitor monitor(setup_with(rectangle(-0.3, 0.5, 0.2), obstacles));
  const std::vector<Mover> movers = mover_at(2.0, 1.0, 0.1);
  double sum = 0.0;
  std::size_t before = 0;
  for (int k = 0; k < 50; ++k) {
    if (k == 5) before = allocations();
    sum += monitor.judge({{-0.1 * k, 0.0}, 0.0}, ahead(1.0, 0.02 * k), movers).share;
  }
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_GT(sum, 5.0);
  EXPECT_LT(sum, 50.0);
}

TEST(Monitor, RefusesWhatIsWrongAndGoesOn) {
  std::string place;
  const auto problem_of = [&](const auto& call) {
    try {
      call();
    } catch (const MonitorError& e) {
      EXPECT_EQ(e.what(), e.place() + ": found " + e.found() + ", expected " + e.expected());
      place = e.place();
      return name(e.problem());
    }
    return "none";
  };
  const double nan = std::nan("");
  MonitorSetup setup;
  setup.max_deceleration = 0.0;
  EXPECT_STREQ(problem_of([&] { Monitor m(setup); }), "out-of-range");
  setup = {};
  setup.footprint = {{{{0, 0}, {1, 0}}, 0.0}};
  EXPECT_STREQ(problem_of([&] { Monitor m(setup); }), "out-of-range");
  EXPECT_EQ(place, "footprint/0");
  setup.footprint.clear();
  EXPECT_STREQ(problem_of([&] { Monitor m(setup); }), "out-of-range");
  setup = setup_with(geometry::disc_body(0.3), {{"crossed", geometry::Polygon{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}}});
  EXPECT_STREQ(problem_of([&] { Monitor m(setup); }), "out-of-range");
  EXPECT_EQ(place, "obstacles/0");
  Monitor monitor(MonitorSetup{});
  EXPECT_STREQ(problem_of([&] { monitor.judge({{nan, 0}, 0}, ahead(1)); }), "not-finite");
  EXPECT_STREQ(problem_of([&] { monitor.judge({}, ahead(1e300)); }), "out-of-range");
  EXPECT_STREQ(problem_of([&] {
                 monitor.judge({}, ahead(1), std::vector<Mover>{{{{}, 0.1}, 0.0, 0.0}});
               }),
               "out-of-range");
  EXPECT_STREQ(problem_of([&] { monitor.judge({}, ahead(1), mover_at(9.0, -1.0)); }), "out-of-range");
  EXPECT_EQ(place, "movers/0/max_speed");
  EXPECT_STREQ(problem_of([&] { monitor.judge({{0.0, {}}, {0.0, {}}}); }), "no-trajectory");
  EXPECT_EQ(place, "trajectory/1");
  EXPECT_EQ(monitor.judge({}, ahead(1)).share, 1.0);
}

}  // namespace
}  // namespace exactvo::test
