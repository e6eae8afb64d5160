// SPDX-License-Identifier: GPL-3.0-or-later
// Clearances to obstacles that turn and change their speed within a step, and what is said of collisions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/distance.h"
#include "formation/moving_scenes.h"
#include "motion/motion.h"
#include "motion/moving_way.h"

namespace exactvo::formation {
namespace {

using exactvo::test::random_motion;
using exactvo::test::robot;
using exactvo::test::SeededRandom;
using exactvo::test::square;

/// Robots that keep their places for `steps` steps.
Recording resting(const Scenario& s, std::size_t steps) {
  Recording rec;
  rec.time_step = s.time_step;
  for (std::size_t k = 0; k <= steps; ++k) {
    Step& row = rec.steps.emplace_back();
    row.time = static_cast<double>(k) * s.time_step;
    for (const Robot& r : s.robots) row.robots.emplace_back().position = r.position;
  }
  rec.outcome = "the robot arrived";
  return rec;
}

/// Over and over: (0, 0) -> (-1, 0) -> (10, 0) -> (0, 0), 22 m a round.
TimedPath shuttle(double speed, int rounds) {
  TimedPath motion{{{0, 0}}, speed};
  for (int k = 0; k < rounds; ++k) {
    for (const Vec2 p : {Vec2{-1, 0}, Vec2{10, 0}, Vec2{0, 0}}) motion.path.push_back(p);
  }
  return motion;
}

TEST(MovingClearance, AnObstacleThatGoesThroughARobotAndBackWithinAStepIsSeen) {
  // At 44 m/s a round takes one step of 0.5 s: at every row the square stands where it began.
  Scenario s;
  s.time_step = 0.5;
  s.robots = {robot("R1", {5.0, 0.0}, {5.0, 0.0})};
  s.moving_obstacles = {square("shuttle", {0, 0}, 0.5, shuttle(44.0, 20))};
  const Metrics m = measure(s, resting(s, 10));
  EXPECT_LE(m.min_obstacle_clearance.value(), -0.5);
  ASSERT_EQ(m.collisions.size(), 1u) << "ten steps one after the other are one collision";
  EXPECT_EQ(m.collisions[0].with, "shuttle");
  EXPECT_FALSE(is_safe(m));
}

TEST(MovingClearance, TheCornerOfAPathIsNotCutOff) {
  // The square turns back 0.1 m before the robot, in the middle of a step.
  Scenario s;
  s.time_step = 0.3;
  s.robots = {robot("R1", {5.0, 0.0}, {5.0, 0.0})};
  s.moving_obstacles = {square("shuttle", {0, 0}, 0.5, {{{0, 0}, {3.9, 0}, {0, 0}}, 1.0})};
  const Metrics m = measure(s, resting(s, 30));
  EXPECT_LE(m.min_obstacle_clearance.value(), 0.1);
  EXPECT_NEAR(m.min_obstacle_clearance.value(), 0.1, 1e-9);
  EXPECT_TRUE(m.collisions.empty());
}

TEST(MovingClearance, AChangeOfSpeedWithinAStepIsFollowed) {
  // The robot runs ahead of the square at 1 m/s; within one step of 4 s the square makes up 1 m and loses it again.
  Scenario s;
  s.time_step = 4.0;
  s.robots = {robot("R1", {2.0, 0.0}, {6.0, 0.0})};
  s.moving_obstacles = {
      square("hasty", {0, 0}, 0.5, {{{0, 0}, {100, 0}}, 0.0, {{0, 1}, {1, 2}, {2, 1}, {3, 0}, {4, 1}}})};
  Recording rec = resting(s, 1);
  rec.steps[1].robots[0].position = {6.0, 0.0};
  // Rims 1 m apart at first; the square's lead over 1 m/s is the area of a triangle of 2 s by 1 m/s: 1 m at t = 2 s.
  EXPECT_NEAR(measure(s, rec).min_obstacle_clearance.value(), 0.0, 1e-9);
  EXPECT_LE(measure(s, rec).min_obstacle_clearance.value(), 0.0);
}

TEST(MovingClearance, AShortRampOfSpeedIsNotCarriedOnToTheEndOfTheStep) {
  // The square stands 1 mm from the rim, and drives away from t = 2 s on: its speed rises within 1e-13 s.
  Scenario s;
  s.time_step = 0.5;
  s.robots = {robot("R1", {0.0, 0.0}, {0.0, 0.0})};
  s.moving_obstacles = {
      square("cart", {1.001, 0.0}, 0.5, {{{0, 0}, {100, 0}}, 0.0, {{2.0, 0.0}, {2.0000000000001, 1.0}}})};
  const Metrics m = measure(s, resting(s, 10));
  EXPECT_TRUE(m.collisions.empty());
  EXPECT_NEAR(m.min_obstacle_clearance.value(), 0.001, 1e-9);
}

/// The displacement of a motion, summed in long doubles: the stretches of speed first, then the legs.
class PreciseWay {
 public:
  explicit PreciseWay(const TimedPath& motion) : motion_(motion) {}

  /// m, so that `at` is off by no more than this (x87 and binary128 have at least eleven bits more than a double).
  double rounding() const { return rounding_; }

  Vec2 at(double time, Vec2 from) const {
    Real left = distance(time);
    rounding_ = 64.0 * static_cast<double>(std::numeric_limits<Real>::epsilon() * (left + 20));
    const std::vector<Vec2>& path = motion_.path;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Real x = Real(path[i].x) - path[i - 1].x, y = Real(path[i].y) - path[i - 1].y;
      const Real length = std::hypot(x, y);
      if (length > 0 && left <= length)
        return difference(path[i - 1].x + left / length * x, path[i - 1].y + left / length * y, from);
      left -= length;
    }
    return difference(path.back().x, path.back().y, from);
  }

 private:
  using Real = long double;

  /// From where the path begins, and then from there.
  Vec2 difference(Real x, Real y, Vec2 from) const {
    return {static_cast<double>(x - motion_.path.front().x - from.x),
            static_cast<double>(y - motion_.path.front().y - from.y)};
  }

  Real distance(double time) const {
    const std::vector<SpeedKnot>& knots = motion_.profile;
    if (knots.empty()) return Real(motion_.speed) * time;
    Real sum = Real(knots.front().speed) * std::min(time, knots.front().time);
    for (std::size_t k = 1; k < knots.size() && knots[k - 1].time < time; ++k) {
      const Real span = Real(knots[k].time) - knots[k - 1].time;
      const Real passed = std::min(Real(time), Real(knots[k].time)) - knots[k - 1].time;
      if (span > 0)
        sum += passed * (knots[k - 1].speed + (Real(knots[k].speed) - knots[k - 1].speed) * passed / span / 2);
    }
    if (time > knots.back().time) sum += Real(knots.back().speed) * (Real(time) - knots.back().time);
    return sum;
  }

  const TimedPath& motion_;
  mutable double rounding_ = 0.0;
};

TEST(MovingWay, ThePiecesAreTheWay) {
  SeededRandom random(exactvo::test::seed_of_run(91));
  double most = 0.0;
  for (int round = 0; round < 500; ++round) {
    const TimedPath motion = random_motion(random);
    const std::vector<detail::WayPiece> way = detail::way_of(motion, 10.0);
    const PreciseWay precise(motion);
    const auto check = [&](const detail::WayPiece& piece, double time) {
      const double off = norm(precise.at(time, piece.at(time)));
      EXPECT_LE(off, piece.error + precise.rounding()) << round << " at " << time;
      EXPECT_LE(piece.error, 1e-12) << round << " at " << time;
      if (piece.error > 0.0) most = std::max(most, off / piece.error);
    };
    for (int k = 0; k <= 200; ++k) {
      const std::size_t at = detail::piece_at(way, 0.05 * k);
      ASSERT_LT(at, way.size());
      check(way[at], 0.05 * k);
    }
    // Corners and knots, where rounding of times shows.
    for (const detail::WayPiece& piece : way) {
      check(piece, piece.from);
      if (piece.to <= 10.0) check(piece, piece.to);
    }
  }
  // Else the bound says nothing: rounding must come within a thousandth of it.
  EXPECT_GT(most, 1e-3);
}

Vec2 position_at(const Recording& rec, double share) {
  const RobotStep& a = rec.steps[0].robots[0];
  const RobotStep& b = rec.steps[1].robots[0];
  return detail::Motion{rec.motion, detail::Decay(rec.tracking_gain, rec.time_step), a.position, a.velocity, b.position,
                        b.velocity}
      .at(share);
}

TEST(MovingClearance, IsBelowEverySampleAndNotFarBelow) {
  SeededRandom random(exactvo::test::seed_of_run(92));
  for (int round = 0; round < 300; ++round) {
    Scenario s;
    s.time_step = random.uniform(0.05, 2.0);
    s.robots = {robot("R1", random.in_box(9), {0, 0})};
    s.moving_obstacles = {square("box", random.in_box(6), random.uniform(0.1, 1.0), random_motion(random))};
    Recording rec = resting(s, 1);
    const double start = random.uniform(0.0, 3.0);
    rec.steps[0].time = start;
    rec.steps[1].time = start + s.time_step;
    rec.motion = static_cast<MotionLaw>(round % 3);
    rec.tracking_gain = random.uniform(0.5, 40.0);
    rec.steps[0].robots[0].velocity = random.in_box(3);
    rec.steps[1].robots[0].velocity = random.in_box(3);
    rec.steps[1].robots[0].position += random.in_box(2);
    if (rec.motion == MotionLaw::exponential) {
      const double k = rec.tracking_gain, decayed = std::exp(-k * s.time_step);
      const Vec2 v0 = rec.steps[0].robots[0].velocity, v1 = rec.steps[1].robots[0].velocity;
      const Vec2 w = (v1 - decayed * v0) / (1.0 - decayed);
      rec.steps[1].robots[0].position =
          rec.steps[0].robots[0].position + s.time_step * w + ((1.0 - decayed) / k) * (v0 - w);
    }
    const double certified = measure(s, rec).min_obstacle_clearance.value();
    double sampled = std::numeric_limits<double>::infinity();
    constexpr int kSamples = 4000;
    for (int m = 0; m <= kSamples; ++m) {
      const double share = static_cast<double>(m) / kSamples;
      const Vec2 moved = displacement_at(s.moving_obstacles[0], start + share * s.time_step);
      const Vec2 place = position_at(rec, share);
      sampled = std::min(sampled, geometry::signed_distance(s.moving_obstacles[0].shape, place - moved) - 0.5);
    }
    EXPECT_LE(certified, std::max(sampled, 0.0)) << round;
    // In contact 65 moments are looked at: between two of them it gets no deeper than 25 m/s let it.
    EXPECT_LE(certified, sampled + (sampled < 0.0 ? 25.0 * s.time_step / 128 : 0.0)) << round;
    // Between samples the two come nearer by at most 25 m/s over half a sample, and chords stray by 1e-5 m.
    if (sampled > 0.0) {
      EXPECT_GE(certified, sampled - 25.0 * s.time_step / kSamples - 1.1e-5) << round;
    }
  }
}

/// What is known round a place spares later steps a look at obstacles, and changes no bit: robots that come near, go
/// away, rest, slide along walls, go through them and stay inside.
TEST(StaticClearance, IsTheLeastOfEachStepMeasuredAlone) {
  SeededRandom random(exactvo::test::seed_of_run(93));
  int touching = 0, clear = 0;
  for (int round = 0; round < 60; ++round) {
    Scenario s;
    s.time_step = 0.1;
    s.robots = {robot("R1", {0, 0}, {0, 0})};
    const int obstacles = round % 7;
    for (int o = 0; o < obstacles; ++o) {
      const Vec2 at = random.in_box(8.0);
      const double side = random.uniform(0.2, 3.0);
      if (o % 2 == 0)
        s.obstacles.push_back({"wall", geometry::Polyline{{at, at + random.in_box(6.0), at + random.in_box(6.0)}}});
      else
        s.obstacles.push_back(
            {"box", geometry::Polygon{{at, at + Vec2{side, 0}, at + Vec2{side, side}, at + Vec2{0, side}}, {}}});
    }
    Recording rec = resting(s, 150);
    Vec2 place = random.in_box(8.0), velocity = random.in_box(1.0);
    for (Step& row : rec.steps) {
      if (random.uniform(0.0, 1.0) < 0.05) velocity = random.uniform(0.0, 1.0) < 0.3 ? Vec2{} : random.in_box(1.5);
      row.robots[0].position = place;
      row.robots[0].velocity = velocity;
      place += s.time_step * velocity;
    }
    std::optional<double> least;
    std::size_t steps_in_contact = 0;
    for (std::size_t k = 0; k + 1 < rec.steps.size(); ++k) {
      Recording alone = rec;
      alone.steps = {rec.steps[k], rec.steps[k + 1]};
      const std::optional<double> c = measure(s, alone).min_obstacle_clearance;
      if (c) least = std::min(least.value_or(*c), *c);
      if (touched(c)) ++steps_in_contact;
    }
    const Metrics whole = measure(s, rec);
    EXPECT_EQ(whole.min_obstacle_clearance, least) << "round " << round;
    EXPECT_EQ(whole.collisions.empty(), steps_in_contact == 0) << "round " << round;
    (steps_in_contact > 0 ? touching : clear) += 1;
  }
  EXPECT_GT(touching, 10);
  EXPECT_GT(clear, 10);
}

TEST(Collisions, ACartThatRunsARobotOverIsNamedWithTimeAndDepth) {
  // Its front is at 2 t - 4; the robot's disc spans from -0.5 to 0.5, so contact is from 1.75 s on.
  Scenario s;
  s.time_step = 0.25;
  s.robots = {robot("R1", {0, 0}, {0, 0})};
  s.moving_obstacles = {square("cart", {-5, 0}, 1.0, {{{0, 0}, {20, 0}}, 2.0})};
  const Metrics m = measure(s, resting(s, 40));
  ASSERT_EQ(m.collisions.size(), 1u);
  const Collision& c = m.collisions[0];
  EXPECT_EQ(c.robot, "R1");
  EXPECT_EQ(c.kind, CollisionKind::moving_obstacle);
  EXPECT_EQ(c.with, "cart");
  EXPECT_DOUBLE_EQ(c.from, 1.75);
  EXPECT_DOUBLE_EQ(c.until, 3.25);
  EXPECT_NEAR(c.deepest_at, 2.5, 0.01);
  EXPECT_NEAR(c.depth, 1.5, 0.02) << "its middle on the robot's: a side's half and the radius";
  EXPECT_EQ(m.min_obstacle_clearance, -c.depth);
  EXPECT_EQ(m.outcome, "COLLISION: R1 overlapped moving obstacle 'cart' by 1.5 m at 2.5 s; the robot arrived");
}

TEST(Collisions, TheDepthInAWallIsAtMostTheRadius) {
  // The centre goes through a wall without thickness, on a curve whose chords stray: the certified bound lay below.
  Scenario s;
  s.time_step = 0.02;
  s.robots = {robot("R1", {-0.05, 0}, {1, 1})};
  s.obstacles = {{"wall", geometry::Polyline{{{0, -5}, {0, 5}}}}};
  Recording rec = resting(s, 1);
  rec.motion = MotionLaw::exponential;
  rec.tracking_gain = 37.5;
  rec.steps[0].robots[0].velocity = {8, -7};
  rec.steps[1].robots[0].position = {0.03, 0.02};
  rec.steps[1].robots[0].velocity = {1, 5};
  const Metrics m = measure(s, rec);
  ASSERT_EQ(m.collisions.size(), 1u);
  const double radius = s.robots[0].radius;
  EXPECT_LE(m.collisions[0].depth, radius);
  EXPECT_NEAR(m.collisions[0].depth, radius, 1e-4);
  EXPECT_GE(m.min_obstacle_clearance.value(), -radius);
}

TEST(Collisions, EachStretchOfContactIsOne) {
  Scenario s;
  s.time_step = 0.5;
  s.robots = {robot("R1", {5.0, 0.0}, {5.0, 0.0})};
  s.moving_obstacles = {square("shuttle", {0, 0}, 0.5, {{{0, 0}, {5, 0}, {0, 0}, {5, 0}}, 1.0})};
  const Metrics m = measure(s, resting(s, 30));
  ASSERT_EQ(m.collisions.size(), 2u);
  EXPECT_LT(m.collisions[0].until, m.collisions[1].from);
  EXPECT_EQ(m.outcome.rfind("COLLISION: R1 overlapped moving obstacle 'shuttle' by 1 m at ", 0), 0u) << m.outcome;
  EXPECT_NE(m.outcome.find(", the deepest of 2 collisions"), std::string::npos) << m.outcome;
}

TEST(Collisions, RobotsThatOverlapInRelaxedDecisionsAreReported) {
  Scenario s;
  s.time_step = 1.0;
  s.robots = {robot("R1", {0, 0}, {0, 0}), robot("R2", {2, 0}, {2, 0})};
  Recording rec = resting(s, 3);
  rec.outcome = "all robots arrived";
  rec.steps[2].robots[1].position = {0.986, 0};
  rec.steps[1].robots[1].status = lp::Status::relaxed;
  const Metrics m = measure(s, rec);
  ASSERT_EQ(m.collisions.size(), 1u);
  EXPECT_TRUE(m.collisions[0].relaxed);
  EXPECT_EQ(m.collisions[0].kind, CollisionKind::robot);
  EXPECT_NEAR(m.collisions[0].depth, 0.014, 1e-9);
  EXPECT_EQ(m.outcome,
            "COLLISION: R1 overlapped robot 'R2' by 0.014 m at 2 s, in a relaxed decision (no velocity kept every "
            "half-plane); all robots arrived");
}

TEST(Collisions, NoneIsReportedWhereRimsOnlyMeet) {
  Scenario s;
  s.time_step = 1.0;
  s.robots = {robot("R1", {0, 0}, {0, 0}), robot("R2", {1, 0}, {1, 0})};
  const Metrics m = measure(s, resting(s, 2));
  EXPECT_TRUE(m.collisions.empty());
  EXPECT_EQ(m.outcome, "the robot arrived");
}

TEST(Collisions, ACurveNearAWallIsMeasuredNotPresumed) {
  // v' = -k (v - w) along a wall: the rim keeps 1e-7 m off it while the speed changes; chords that stray by 1e-5 m say
  // otherwise.
  Scenario s;
  s.time_step = 0.5;
  s.robots = {robot("R1", {0, 0.5 + 1e-7}, {4, 0.5})};
  s.obstacles = {{"wall", geometry::Polyline{{{-9, 0}, {9, 0}}}}};
  Recording rec = resting(s, 1);
  rec.motion = MotionLaw::exponential;
  rec.tracking_gain = 4.0;
  const double decayed = std::exp(-2.0);
  rec.steps[1].robots[0].velocity = {3.0 * (1.0 - decayed), 0.0};
  rec.steps[1].robots[0].position += Vec2{3.0 * 0.5 - 3.0 * (1.0 - decayed) / 4.0, 0.0};
  const Metrics m = measure(s, rec);
  EXPECT_TRUE(m.collisions.empty()) << m.outcome;
  EXPECT_LE(m.min_obstacle_clearance.value(), 1e-7);
  EXPECT_GT(m.min_obstacle_clearance.value(), -1e-7);
}

TEST(FormationCourse, TheLargestErrorAndWhenTheFormationHoldsAgain) {
  Scenario s;
  s.time_step = 1.0;
  for (const char* id : {"R1", "R2"}) {
    s.robots.push_back(robot(id, {0, 0}, {0, 0}));
    s.robots.back().radius = 0.1;
    s.robots.back().goals.clear();
  }
  s.formation.emplace();
  s.formation->leader = {{{{0, 0}, {6, 0}}, 1.0}};
  s.formation->topology = {{{0, 1}, {1, 0}}, {1, 1}};
  Recording rec;
  rec.time_step = 1.0;
  rec.offsets = {{0, 1}, {0, -1}};
  rec.outcome = "formation error 0 m at the end";
  const double aside[] = {3.0, 0.0, 2.0, 4.0, 0.05, 0.0, 0.0};
  for (std::size_t k = 0; k < 7; ++k) {
    Step& row = rec.steps.emplace_back();
    row.time = static_cast<double>(k);
    row.leader_position = {row.time, 0.0};
    row.robots.resize(2);
    row.robots[0].position = row.leader_position + rec.offsets[0];
    row.robots[1].position = row.leader_position + rec.offsets[1] - Vec2{0.0, aside[k]};
  }
  const Metrics m = measure(s, rec);
  ASSERT_TRUE(m.formation_course.has_value());
  EXPECT_DOUBLE_EQ(m.formation_course->largest_error, 4.0) << "not the 3 m at which it was put";
  EXPECT_EQ(m.formation_course->largest_error_at, 3.0);
  EXPECT_EQ(m.formation_course->largest_error_of, "R2");
  EXPECT_EQ(m.formation_course->first_formed.value(), 1.0);
  EXPECT_EQ(m.formation_course->formed_since.value(), 4.0);
  EXPECT_DOUBLE_EQ(m.formation_course->share_formed, 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(m.formation_course->rms_error, std::sqrt((4.0 + 16.0 + 0.0025) / 12.0));
  EXPECT_DOUBLE_EQ(m.robots[0].largest_slot_error.value(), 0.0);
  EXPECT_NEAR(m.robots[0].detour.value(), 0.0, 1e-12);
  // The slot's way is 6 m and the start 3 m from it; the robot drove hypot(1, 3) + 2 hypot(1, 2) + hypot(1, 3.95) + ...
  const double path = m.robots[1].path_length;
  EXPECT_NEAR(m.robots[1].detour.value(), path - 9.0, 1e-12);
  EXPECT_GT(path - 9.0, 0.25 * 9.0);
  EXPECT_NE(m.outcome.find("; R2 went a detour of "), std::string::npos) << m.outcome;
  EXPECT_NE(m.outcome.find(" m, up to 4 m from its slot; the formation holds since 4 s"), std::string::npos)
      << m.outcome;
}

/// Row by row, so that roundings differ: robots whose rims touch, and a robot at a wall.
TEST(Clearances, ContactIsZero) {
  test::SeededRandom random(11);
  for (int k = 0; k < 200; ++k) {
    Scenario s;
    const Vec2 middle = random.in_box(100.0);
    const Vec2 apart = 0.5 * random.direction();  // the sum of the radii, up to rounding
    s.robots = {robot("R1", middle, middle), robot("R2", middle + apart, middle + apart)};
    s.robots[0].radius = 0.2;
    s.robots[1].radius = 0.3;
    s.obstacles = {{"wall", geometry::Polyline{{middle + Vec2{-0.2, -3.0}, middle + Vec2{-0.2, 3.0}}}}};
    const Metrics m = measure(s, resting(s, 2));
    for (const std::optional<double>& clearance : {m.min_robot_clearance, m.robots[0].min_obstacle_clearance}) {
      EXPECT_GE(clearance.value(), 0.0) << "case " << k;
      EXPECT_LE(clearance.value(), 1e-12) << "case " << k;
    }
    EXPECT_FALSE(is_safe(m)) << "contact is no proof of a distance";
  }
  Scenario deep;
  deep.robots = {robot("R1", {0, 0}, {0, 0}), robot("R2", {0.99, 0}, {0.99, 0})};
  EXPECT_NEAR(measure(deep, resting(deep, 2)).min_robot_clearance.value(), -0.01, 1e-9);
}

TEST(RobotMargin, PairsNearerThanTheMarginAreCountedInEachRow) {
  Scenario s;
  s.margins.robot = 0.3;
  s.robots = {robot("R1", {0, 0}, {0, 0}), robot("R2", {1.2, 0}, {1.2, 0}), robot("R3", {2.5, 0}, {2.5, 0}),
              robot("R4", {9, 0}, {9, 0})};
  Metrics m = measure(s, resting(s, 4));  // gaps of 0.2 m and 0.3 m
  ASSERT_TRUE(m.robot_margin.has_value());
  EXPECT_EQ(m.robot_margin->asked, 0.3);
  EXPECT_EQ(m.robot_margin->pair_rows, 5u);
  EXPECT_EQ(m.robot_margin->robots, 2u);
  s.margins.robot = 0.1;
  EXPECT_EQ(measure(s, resting(s, 4)).robot_margin->pair_rows, 0u);
  s.margins.robot = 0.0;
  EXPECT_FALSE(measure(s, resting(s, 4)).robot_margin.has_value());
}

TEST(DistanceSeries, MovingObstaclesCount) {
  Scenario s;
  s.time_step = 1.0;
  s.robots = {robot("R1", {0, 0}, {0, 0})};
  s.moving_obstacles = {square("cart", {-5, 0}, 1.0, {{{0, 0}, {20, 0}}, 2.0})};
  const std::vector<double> series = obstacle_distance_series(s, resting(s, 3), 0);
  ASSERT_EQ(series.size(), 4u);
  EXPECT_DOUBLE_EQ(series[0], 3.5);
  EXPECT_DOUBLE_EQ(series[1], 1.5);
  EXPECT_DOUBLE_EQ(series[2], -0.5);
}

}  // namespace
}  // namespace exactvo::formation
