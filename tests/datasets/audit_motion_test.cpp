// SPDX-License-Identifier: GPL-3.0-or-later
// Audited motions: moving obstacles that turn and change their speed, robots that are driven along curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/motions.h"
#include "formation/moving_scenes.h"
#include "recordings/exact_motion.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::random_motion;
using exactvo::test::robot;
using exactvo::test::SeededRandom;
using exactvo::test::square;
using formation::MotionLaw;
using formation::MovingObstacle;
using formation::Robot;
using formation::TimedPath;
using geometry::Vec2;

/// Judges motions alone: the recordings here are made by hand and have no half-planes.
bool moves_clear(const RecordingFile& file) {
  const AuditReport report = audit(file);
  return report.collisions == 0 && report.unproven == 0;
}

/// Robots that keep their places for `steps` steps.
RecordingFile resting(const formation::Scenario& s, std::size_t steps) {
  RecordingFile file;
  file.scenario = s;
  file.recording.time_step = s.time_step;
  for (std::size_t k = 0; k <= steps; ++k) {
    formation::Step& row = file.recording.steps.emplace_back();
    row.time = static_cast<double>(k) * s.time_step;
    for (const Robot& r : s.robots) {
      row.robots.emplace_back().position = r.position;
      row.robots.back().anchor = r.position;
    }
  }
  return file;
}

TEST(AuditMotion, ACartThatRunsASlowRobotOverIsACollision) {
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.robots = {robot("slow", {0, 0}, {40, 0})};
  s.robots[0].max_speed = 0.5;
  s.moving_obstacles = {square("cart", {-9, 0}, 1.0, {{{0, 0}, {60, 0}}, 4.0})};
  s.time_limit = 10.0;
  RecordingFile file;
  file.scenario = s;
  file.recording = formation::simulate(s);
  const AuditReport report = audit(file);
  EXPECT_GT(report.collisions, 0u);
  EXPECT_EQ(report.inconsistencies, 0u) << to_json(report);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_NE(report.findings.front().find("slow overlaps moving obstacle 'cart'"), std::string::npos);
}

TEST(AuditMotion, AnObstacleThatIsBackAtEveryRowIsSeenBetween) {
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_step = 0.5;
  s.robots = {robot("R1", {5.0, 0.0}, {5.0, 0.0})};
  TimedPath round{{{0, 0}}, 44.0};
  for (int k = 0; k < 10; ++k)
    for (const Vec2 p : {Vec2{-1, 0}, Vec2{10, 0}, Vec2{0, 0}}) round.path.push_back(p);
  s.moving_obstacles = {square("shuttle", {0, 0}, 0.5, round)};
  const AuditReport report = audit(resting(s, 10));
  EXPECT_EQ(report.collisions, 10u);
  EXPECT_EQ(report.moving_questions, 10u);
}

TEST(AuditMotion, ToTouchAtACornerIsNoCollisionAndAnUlpNearerIs) {
  // The square's front is at 3.5 m where it turns, in the middle of a step.
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_step = 0.4;
  s.robots = {robot("R1", {4.0, 0.0}, {4.0, 0.0})};
  s.moving_obstacles = {square("shuttle", {0, 0}, 0.5, {{{0, 0}, {3, 0}, {0, 0}}, 1.0})};
  EXPECT_TRUE(moves_clear(resting(s, 20)));
  s.robots[0].radius = std::nextafter(0.5, 1.0);
  EXPECT_EQ(audit(resting(s, 20)).collisions, 1u);
}

TEST(AuditMotion, CornersAfterLegsOfIrrationalLengthAreEnclosed) {
  // A wall's end goes to (3, 3) and back; the robot's rim is a picometre beyond it, or a picometre this side.
  for (const double gap : {1e-12, -1e-12}) {
    formation::Scenario s;
    s.guidance = formation::Guidance::none;
    s.liveness = formation::Liveness::off;
    s.time_step = 0.7;
    const double away = 3.0 + (0.5 + gap) / std::sqrt(2.0);
    s.robots = {robot("R1", {away, away}, {away, away})};
    s.moving_obstacles = {
        {"spear", geometry::Polyline{{{-1, -1}, {0, 0}}}, {{{0, 0}, {1, 1}, {1, 1}, {3, 3}, {0, 0.5}}, 1.3}}};
    const AuditReport report = audit(resting(s, 10));
    EXPECT_EQ(report.collisions > 0, gap < 0.0) << gap;
    EXPECT_EQ(report.unproven, 0u) << gap;
  }
}

TEST(AuditMotion, ASpeedThatChangesWithinAStepIsFollowed) {
  // It makes up one metre on the robot and loses it again, all within one step.
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_step = 4.0;
  s.robots = {robot("R1", {2.0, 0.0}, {6.0, 0.0})};
  s.moving_obstacles = {
      square("hasty", {0, 0}, 0.5, {{{0, 0}, {100, 0}}, 0.0, {{0, 1}, {1, 2}, {2, 1}, {3, 0}, {4, 1}}})};
  const auto with_gap = [&](double gap) {
    s.robots[0].position.x = 2.0 + gap;
    RecordingFile file = resting(s, 1);
    file.scenario.robots[0].velocity = {1.0, 0.0};
    file.recording.steps[0].robots[0].chosen = file.recording.steps[0].robots[0].velocity = {1.0, 0.0};
    file.recording.steps[1].robots[0].velocity = {1.0, 0.0};
    file.recording.steps[1].robots[0].position.x += 4.0;
    return audit(file);
  };
  EXPECT_EQ(with_gap(1e-9)[AuditPoint::motions].proven, 1u);
  EXPECT_EQ(with_gap(-1e-9).collisions, 1u);
  EXPECT_EQ(with_gap(0.0).unproven, 1u) << "a curve that touches is not told from one that does not";
}

/// One step of v' = -k (v - w), as the run computes it.
RecordingFile curve(double k, double dt, Vec2 from, Vec2 v0, Vec2 w) {
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_step = dt;
  s.robots = {robot("R1", from, {})};
  s.robots[0].goals.clear();
  s.robots[0].radius = 0.25;
  s.robots[0].velocity = v0;
  s.formation.emplace();
  s.formation->gains.k3 = k;
  s.formation->topology = {{{0.0}}, {1.0}};
  s.formation->offsets = {{0, 0}};
  s.formation->leader.path = {{0, 0}};
  RecordingFile file = resting(s, 1);
  file.recording.offsets = {{0, 0}};
  file.recording.motion = MotionLaw::exponential;
  file.recording.tracking_gain = k;
  const double decayed = std::exp(-k * dt), lag = -std::expm1(-k * dt) / k;
  file.recording.steps[0].robots[0].velocity = v0;
  file.recording.steps[1].robots[0].velocity = w + decayed * (v0 - w);
  file.recording.steps[1].robots[0].position = from + dt * w + lag * (v0 - w);
  file.scenario.time_limit = file.scenario.time_step;
  return file;
}

TEST(AuditMotion, TheCurveThatWasDrivenCountsNotTheStraightWay) {
  // From (0, 0) up and then to the right: it bulges to the left of the straight way.
  const double k = 2.0, dt = 1.0;
  const Vec2 v0{0.0, 2.0}, w{2.0, 0.0};
  const auto on_curve = [&](double t) { return t * w + (-std::expm1(-k * t) / k) * (v0 - w); };
  RecordingFile file = curve(k, dt, {0, 0}, v0, w);
  const Vec2 straight = 0.4 * file.recording.steps[1].robots[0].position;
  const Vec2 outward = geometry::normalized(on_curve(0.4) - straight);
  ASSERT_GT(norm(on_curve(0.4) - straight), 0.1);
  const auto with_speck = [&](double reach) {
    const Vec2 speck = on_curve(0.4) + reach * outward;
    file.scenario.obstacles = {{"speck", geometry::Polyline{{speck, speck + 0.001 * outward}}}};
    return audit(file);
  };
  EXPECT_EQ(with_speck(0.24).collisions, 1u) << "the straight way between the rows is clear of it";
  EXPECT_EQ(with_speck(0.30)[AuditPoint::motions].proven, 1u) << to_json(with_speck(0.30));
  EXPECT_EQ(with_speck(0.30).curved_steps, 1u);
  EXPECT_GT(with_speck(0.30).largest_bulge, 0.1);
  // And the other way round: what only the straight way touches was not touched.
  const Vec2 within = straight - 0.24 * outward;
  file.scenario.obstacles = {{"speck", geometry::Polyline{{within, within - 0.001 * outward}}}};
  EXPECT_TRUE(moves_clear(file));
}

TEST(AuditMotion, ACurveIsProvenClearUpToAMicrometre) {
  RecordingFile file = curve(37.5, 0.02, {0, 0.25 + 1e-6}, {0.0, 0.0}, {3.0, 0.0});
  file.scenario.obstacles = {{"floor", geometry::Polyline{{{-9, 0}, {9, 0}}}}};
  EXPECT_TRUE(moves_clear(file)) << to_json(audit(file));
  file.recording.steps[0].robots[0].position.y = file.recording.steps[1].robots[0].position.y = 0.25 - 1e-6;
  EXPECT_EQ(audit(file).collisions, 1u);
}

TEST(AuditMotion, RobotsThatDriveTheSameCurveSideBySideKeepTheirDistanceExactly) {
  RecordingFile file = curve(37.5, 0.02, {0, 0}, {0.3, 0.1}, {3.0, -1.0});
  file.scenario.robots.push_back(file.scenario.robots[0]);
  file.scenario.robots[1].id = "R2";
  file.scenario.formation->topology = formation::Topology{{{0, 1}, {1, 0}}, {1, 1}};
  for (formation::Step& row : file.recording.steps) row.robots.push_back(row.robots[0]);
  // A dyadic shift that costs neither row a rounding.
  for (formation::Step& row : file.recording.steps) {
    row.robots[0].position.x = std::ldexp(std::round(std::ldexp(row.robots[0].position.x, 40)), -40);
    row.robots[0].position.y = std::ldexp(std::round(std::ldexp(row.robots[0].position.y, 40)), -40);
    row.robots[1].position = row.robots[0].position + Vec2{0.5, 0.0};
  }
  AuditReport report = audit(file);
  EXPECT_EQ(report.collisions, 0u);
  EXPECT_EQ(report.unproven, 0u);
  file.scenario.robots[1].radius = std::nextafter(0.25, 1.0);
  EXPECT_EQ(audit(file).collisions, 2u);
}

TEST(AuditMotion, TheCubicOfTheGeneralIntegratorsIsDecidedToo) {
  RecordingFile file = curve(2.0, 1.0, {0, 0}, {0, 4}, {0, 0});
  file.recording.motion = MotionLaw::hermite;
  file.info.integrator = "rk4";
  file.recording.steps[1].robots[0].position = {1, 0};
  file.recording.steps[1].robots[0].velocity = {0, -4};
  // y = 4 s (1 - s): 1 m high in the middle.
  const auto with_ceiling = [&](double y) {
    file.scenario.obstacles = {{"ceiling", geometry::Polyline{{{-9, y}, {9, y}}}}};
    return audit(file);
  };
  EXPECT_EQ(with_ceiling(1.25 + 1e-9)[AuditPoint::motions].proven, 1u);
  EXPECT_EQ(with_ceiling(1.25 - 1e-9).collisions, 1u);
}

TEST(AuditMotion, ARowThatDoesNotFollowIsInconsistent) {
  RecordingFile file = curve(37.5, 0.02, {100.0, 0}, {0.3, 0.1}, {3.0, -1.0});
  EXPECT_EQ(audit(file).inconsistencies, 0u) << to_json(audit(file));
  file.recording.steps[1].robots[0].position.x += 1e-11;
  EXPECT_EQ(audit(file).inconsistencies, 1u);

  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.robots = {robot("R1", {3, 4}, {9, 9})};
  s.time_limit = 1.0;
  RecordingFile straight;
  straight.scenario = s;
  straight.recording = formation::simulate(s);
  EXPECT_TRUE(audit(straight).clean()) << to_json(audit(straight));
  const formation::Recording good = straight.recording;
  straight.recording.steps[3].robots[0].chosen.x += 1e-9;
  EXPECT_EQ(audit(straight).inconsistencies, 1u);
  straight.recording = good;
  straight.recording.steps[4].robots[0].velocity.y += 1e-9;
  straight.recording.steps[4].robots[0].anchor_velocity = straight.recording.steps[4].robots[0].velocity;
  EXPECT_EQ(audit(straight).inconsistencies, 1u) << "the velocity is not the one that was chosen";
  straight.recording.time_step = 0.06;
  EXPECT_GT(audit(straight).inconsistencies, 1u) << "not the scenario's";
}

TEST(AuditMotion, ARunThatBeginsElsewhereIsInconsistent) {
  RecordingFile file = curve(37.5, 0.02, {0, 0}, {0.3, 0.1}, {3.0, -1.0});
  file.scenario.robots[0].position.y = 0x1p-1074;
  EXPECT_EQ(audit(file).inconsistencies, 1u);
  file.scenario.robots[0].position.y = 0.0;
  file.scenario.robots[0].velocity.x = 0.25;
  EXPECT_EQ(audit(file).inconsistencies, 1u);
}

TEST(AuditMotion, NumbersThatAreNoneAreInconsistent) {
  const RecordingFile good = curve(37.5, 0.02, {0, 0}, {0.3, 0.1}, {3.0, -1.0});
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const std::function<void(formation::Recording&)> breaks[] = {
      [&](auto& r) { r.steps[0].time = nan; },
      [&](auto& r) { r.steps[1].time = inf; },
      [&](auto& r) { r.steps[1].time = -1.0; },
      [&](auto& r) { r.steps[1].robots[0].velocity.x = nan; },
      [&](auto& r) { r.time_step = 0.0; },
      [&](auto& r) { r.time_step = nan; },
      [&](auto& r) { r.tracking_gain = 0.0; },
      [&](auto& r) { r.tracking_gain = inf; },
      [&](auto& r) { r.steps[0].time = -5.0; },
      [&](auto& r) {
        for (formation::Step& step : r.steps) step.time += 100.0;
      },
      [&](auto& r) {
        for (formation::Step& step : r.steps) step.time -= 100.0;
      },
      [&](auto& r) { r.steps.back().time = 1e-9; },
      [&](auto& r) { r.motion = formation::MotionLaw::hermite; },
      [&](auto& r) { r.motion = formation::MotionLaw::straight; },
      [&](auto& r) {
        r.steps[1].robots[0].position = {1.7e308, 1.7e308};
      },
      [&](auto& r) {
        r.steps[1].robots[0].velocity = {-1.7e308, 1.7e308};
      },
      [&](auto& r) { r.steps.clear(); },
      [&](auto& r) { r.steps[1].robots[0].position.y = -inf; },
  };
  for (const auto& how : breaks) {
    RecordingFile file = good;
    how(file.recording);
    EXPECT_GE(audit(file).inconsistencies, 1u);
  }
}

TEST(AuditMotion, TheWayOfAnObstacleIsWhatTheRunGoesBy) {
  SeededRandom random(exactvo::test::seed_of_run(94));
  for (int round = 0; round < 100; ++round) {
    const TimedPath motion = random_motion(random);
    const exact::ExactWay way(motion);
    const MovingObstacle obstacle{"", geometry::Polyline{{{0, 0}, {1, 0}}}, motion};
    const double start = random.uniform(0.0, 8.0), end = start + random.uniform(0.01, 2.0);
    exact::Rational last(start);
    for (const auto& piece : way.over(exact::Rational(start), exact::Rational(end))) {
      EXPECT_EQ(piece.start, last) << "pieces follow one another";
      last = piece.end;
      const Vec2 from = displacement_at(obstacle, piece.start.get_d()),
                 to = displacement_at(obstacle, piece.end.get_d());
      EXPECT_NEAR(piece.chord.way.from.x.get_d(), from.x, 1e-9) << round;
      EXPECT_NEAR(piece.chord.way.from.y.get_d(), from.y, 1e-9) << round;
      EXPECT_NEAR(piece.chord.way.to.x.get_d(), to.x, 1e-9) << round;
      EXPECT_NEAR(piece.chord.way.to.y.get_d(), to.y, 1e-9) << round;
    }
    EXPECT_EQ(last, exact::Rational(end));
  }
}

/// The least clearance over one step by sampling.
struct Sampled {
  double least = std::numeric_limits<double>::infinity();  ///< m
  /// m: the true least clearance is lower by at most this. From a sample to half-way to the next the obstacle goes half
  /// of what its greatest speed allows, and the robot half of the way between the samples and, as its speed varies,
  /// half of its second difference; all of that one is taken.
  double slack = 0.0;
};

Vec2 place_of_robot(const formation::Recording& rec, double s) {
  const formation::RobotStep &a = rec.steps[0].robots[0], &b = rec.steps[1].robots[0];
  const double dt = rec.time_step, k = rec.tracking_gain;
  Vec2 place = a.position + s * (b.position - a.position);
  if (rec.motion == MotionLaw::exponential) {
    const double g = (-std::expm1(-k * s * dt) + s * std::expm1(-k * dt)) / (-k * std::expm1(-k * dt));
    place += g * (a.velocity - b.velocity);
  }
  if (rec.motion == MotionLaw::hermite) {
    const Vec2 d = b.position - a.position;
    place += s * (1 - s) * (1 - s) * (dt * a.velocity - d) - s * s * (1 - s) * (dt * b.velocity - d);
  }
  return place;
}

double top_speed(const TimedPath& motion) {
  double top = motion.profile.empty() ? motion.speed : 0.0;
  for (const formation::SpeedKnot& knot : motion.profile) top = std::max(top, knot.speed);
  return top;
}

Sampled sampled_clearance(const RecordingFile& file) {
  constexpr int kSamples = 2000;
  const formation::Recording& rec = file.recording;
  const MovingObstacle& o = file.scenario.moving_obstacles[0];
  Sampled found;
  double step = 0.0, bend = 0.0;
  Vec2 before, last;
  for (int m = 0; m <= kSamples; ++m) {
    const double s = static_cast<double>(m) / kSamples;
    const Vec2 place = place_of_robot(rec, s);
    const Vec2 moved = displacement_at(o, rec.steps[0].time + s * rec.time_step);
    found.least =
        std::min(found.least, geometry::signed_distance(o.shape, place - moved) - file.scenario.robots[0].radius);
    if (m > 0) step = std::max(step, norm(place - last));
    if (m > 1) bend = std::max(bend, norm(place - 2.0 * last + before));
    before = last;
    last = place;
  }
  found.slack = 0.5 * step + bend + 0.5 * top_speed(o.motion) * rec.time_step / kSamples + 1e-9;
  return found;
}

TEST(AuditMotion, AgreesWithSamplesOverRandomPathsProfilesAndCurves) {
  SeededRandom random(exactvo::test::seed_of_run(95));
  int clear = 0, meets = 0;
  for (int round = 0; round < 600; ++round) {
    RecordingFile file = curve(random.uniform(0.5, 40.0), random.uniform(0.05, 1.5), random.in_box(3), random.in_box(3),
                               random.in_box(3));
    file.recording.motion = static_cast<MotionLaw>(round % 3);
    file.scenario.moving_obstacles = {square("box", random.in_box(2), random.uniform(0.1, 1.0), random_motion(random))};
    const double start = random.uniform(0.0, 0.5);  // while the box is still near
    file.recording.steps[1].time += start;
    file.recording.steps[0].time = start;
    const AuditReport report = audit(file);
    const Sampled sampled = sampled_clearance(file);
    EXPECT_EQ(report.unproven, 0u) << round;
    if (report.collisions == 0) {
      EXPECT_GT(sampled.least, -1e-9) << round;
      ++clear;
    } else {
      EXPECT_LT(sampled.least, sampled.slack) << round;
      ++meets;
    }
  }
  EXPECT_GT(clear, 30);
  EXPECT_GT(meets, 30);
}

/// A number of 2^-3 m, so that bodies often touch exactly.
double on_grid(double x) {
  return std::round(8.0 * x) / 8.0;
}
Vec2 on_grid(Vec2 p) {
  return {on_grid(p.x), on_grid(p.y)};
}

/// Two robots and an obstacle, one step of a motion that geometry/motions.h has too: all its numbers are exact there.
struct Shared {
  RecordingFile file;
  std::vector<geometry::Motion> motions;
};

Shared random_shared(SeededRandom& random, bool is_curved) {
  const double duration = 0.75;  // a third of it is a double
  const auto place = [&] { return on_grid(random.in_box(1.5)); };
  const Vec2 first = place();
  Vec2 second = place();
  Shared out{curve(2.0, duration, first, {}, {}), {}};
  formation::Scenario& s = out.file.scenario;
  s.robots.push_back(s.robots[0]);
  s.robots[1].id = "R2";
  s.formation->topology = formation::Topology{{{0, 1}, {1, 0}}, {1, 1}};
  out.file.recording.offsets = s.formation->offsets = {{0, 0}, {0, 0}};
  for (Robot& r : s.robots) r.radius = on_grid(random.uniform(0.125, 0.5));
  while (norm(first - second) < s.robots[0].radius + s.robots[1].radius) second = place();
  const Vec2 corner = place(), side{on_grid(random.uniform(0.25, 1.0)), 0.0}, up = on_grid(random.in_box(0.5));
  const bool is_solid = up.y > 0.0 && random.integer(0, 1) == 1;
  geometry::Obstacle shape = geometry::Polyline{{corner, corner + side}};
  if (is_solid) shape = geometry::Polygon{{corner, corner + side, corner + side + up, corner + up}, {}};
  s.obstacles = {{"block", shape}};
  out.file.recording.motion = is_curved ? MotionLaw::hermite : MotionLaw::straight;
  if (is_curved) out.file.info.integrator = "rk4";
  for (const Vec2 from : {first, second}) {
    const std::size_t i = out.motions.size();
    const Vec2 to = place(), v0 = on_grid(random.in_box(4.0)), v1 = on_grid(random.in_box(4.0));
    for (formation::Step& row : out.file.recording.steps) row.robots.resize(2);
    formation::RobotStep &start = out.file.recording.steps[0].robots[i], &end = out.file.recording.steps[1].robots[i];
    start.position = start.anchor = from;
    end.position = end.anchor = to;
    if (is_curved) {
      start.velocity = v0;
      end.velocity = v1;
      out.motions.emplace_back(geometry::hermite_cubic({0.0, from}, v0, {duration, to}, v1));
    } else {
      out.motions.emplace_back(geometry::StraightMotion{{0.0, from}, {duration, to}});
    }
  }
  return out;
}

// The audit, the metrics and `check` decide motions each by themselves
// (docs/adr/0023-the-audit-decides-motions-itself.md).
TEST(AuditMotion, TheAuditTheMetricsAndTheRoomOfMotionsSayTheSame) {
  SeededRandom random(exactvo::test::seed_of_run(42));
  int counts[3] = {}, in_contact_open = 0, distances = 0;
  for (int round = 0; round < 3000; ++round) {
    const bool is_curved = round % 2 == 1;
    const Shared x = random_shared(random, is_curved);
    const std::vector<Robot>& robots = x.file.scenario.robots;
    const geometry::RigidBody one = geometry::disc_body(robots[0].radius), two = geometry::disc_body(robots[1].radius);
    const geometry::Obstacle& block = x.file.scenario.obstacles[0].shape;
    const geometry::MotionVerdict pair = examine(x.motions[0], one, x.motions[1], two);
    const geometry::MotionVerdict walls[] = {examine(x.motions[0], one, block), examine(x.motions[1], two, block)};
    const geometry::Encounter all[] = {pair.encounter, walls[0].encounter, walls[1].encounter};
    const geometry::Encounter worst = *std::max_element(std::begin(all), std::end(all));
    ++counts[static_cast<int>(worst)];
    const AuditReport report = audit(x.file);
    EXPECT_EQ(report.collisions > 0, worst == geometry::Encounter::overlap) << round << ' ' << to_json(report);
    const bool touches =
        std::any_of(std::begin(all), std::end(all), [](auto e) { return e == geometry::Encounter::contact; });
    EXPECT_TRUE(report.unproven == 0 || (is_curved && touches)) << round << ' ' << to_json(report);
    in_contact_open += report.unproven > 0 && worst == geometry::Encounter::contact ? 1 : 0;
    const formation::Metrics metrics = measure(x.file.scenario, x.file.recording);
    const auto agrees = [&](const std::optional<double>& measured, const geometry::MotionVerdict& v) {
      EXPECT_EQ(formation::touched(measured), v.encounter == geometry::Encounter::overlap) << round;
      if (v.encounter == geometry::Encounter::overlap) return;  // depths in polygons are measured otherwise
      EXPECT_TRUE(measured && *measured <= v.clearance.high && v.clearance.low - *measured < 1e-4) << round;
      ++distances;
    };
    agrees(metrics.min_robot_clearance, pair);
    for (const std::size_t i : {0, 1}) agrees(metrics.robots[i].min_obstacle_clearance, walls[i]);
  }
  std::printf("%d clear, %d in contact (%d of them open), %d overlap; %d distances\n", counts[0], counts[1],
              in_contact_open, counts[2], distances);
  EXPECT_GT(counts[0], 300);
  EXPECT_GT(counts[1], 20);
  EXPECT_GT(counts[2], 300);
  EXPECT_GT(distances, 1000);
}

/// `decide` over [0, 1], where parts longer than 2^-depth round `where` are not told, and how many parts it asks for.
struct Decision {
  exact::Verdict verdict;
  int chords;
};
Decision decide_with(int depth, const std::function<bool(const exact::Rational&, const exact::Rational&)>& is_open,
                     exact::Verdict answer = exact::Verdict::clear) {
  const exact::Rational fine = exact::Rational(1) / (exact::Rational(1) << depth);
  int chords = 0;
  const auto over = [](const exact::Rational& from, const exact::Rational& to) { return std::make_pair(from, to); };
  const auto test = [&](const auto& part) {
    ++chords;
    if (!is_open(part.first, part.second)) return exact::Verdict::clear;
    return part.second - part.first > fine ? exact::Verdict::unknown : answer;
  };
  const exact::Verdict verdict = exact::decide(over, test, exact::Rational(0), exact::Rational(1));
  return {verdict, chords};
}

TEST(ExactMotion, AQuestionIsGivenUpAfterItsChords) {
  const auto everywhere = [](const exact::Rational&, const exact::Rational&) { return true; };
  const Decision enough = decide_with(11, everywhere);
  EXPECT_EQ(enough.verdict, exact::Verdict::clear);
  EXPECT_EQ(enough.chords, 4095) << "2^11 parts and those that were halved";
  const Decision too_many = decide_with(12, everywhere);
  EXPECT_EQ(too_many.verdict, exact::Verdict::unknown);
  EXPECT_LE(too_many.chords, exact::kMostChords + 1);
  EXPECT_EQ(decide_with(12, everywhere, exact::Verdict::meets).verdict, exact::Verdict::meets) << "seen before that";
}

TEST(ExactMotion, OnePlaceIsHalvedSoOftenAndNoMore) {
  const exact::Rational place(1, 3);
  const auto round_it = [&](const exact::Rational& from, const exact::Rational& to) {
    return from <= place && place <= to;
  };
  const Decision near = decide_with(exact::kMostHalvings, round_it);
  EXPECT_EQ(near.verdict, exact::Verdict::clear);
  EXPECT_EQ(near.chords, 2 * exact::kMostHalvings + 1);
  const Decision contact = decide_with(exact::kMostHalvings + 1, round_it);
  EXPECT_EQ(contact.verdict, exact::Verdict::unknown);
  EXPECT_LE(contact.chords, 2 * exact::kMostHalvings + 1);
}

TEST(AuditMotion, EndsWhenItsCallerIsInterrupted) {
  struct Stopped {};
  static int calls = 0;
  calls = 0;
  set_wait_hook([] {
    if (++calls == 3) throw Stopped();
  });
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.robots = {robot("R1", {0, 0}, {9, 0})};
  s.moving_obstacles = {square("box", {5, 3}, 0.5, {{{0, 0}, {9, 0}}, 1.0})};
  EXPECT_THROW(audit(resting(s, 50)), Stopped);
  set_wait_hook(nullptr);
}

TEST(ExactNumbers, RootsAndDecaysAreEnclosed) {
  EXPECT_EQ(exact::root(exact::Rational(25, 4)).low, exact::Rational(5, 2));
  EXPECT_EQ(exact::root(exact::Rational(25, 4)).high, exact::Rational(5, 2));
  for (const double x : {2.0, 1e-30, 3e20, 0.7}) {
    const exact::Interval r = exact::root(exact::Rational(x));
    EXPECT_LT(r.low * r.low, exact::Rational(x));
    EXPECT_GT(r.high * r.high, exact::Rational(x));
    EXPECT_LT(r.high - r.low, exact::Rational(0x1p-190));
  }
  for (const double x : {0.0, 1e-12, 0.3, 0.5, 0.75, 3.0, 40.0, 700.0, 5000.0}) {
    const exact::Interval e = exact::decay(exact::Rational(x));
    EXPECT_LE(e.low.get_d(), std::exp(-x) * (1 + 1e-15)) << x;
    EXPECT_GE(e.high.get_d(), std::exp(-x) * (1 - 1e-15)) << x;
    EXPECT_LE(e.high - e.low, exact::Rational(0x1p-180)) << x;
    EXPECT_GE(e.low, 0) << x;
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
