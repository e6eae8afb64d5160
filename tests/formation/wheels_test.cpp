// SPDX-License-Identifier: GPL-3.0-or-later
// Robots on wheels: theorems 1 and 2, lemmas 2 and 3 of docs/guide/wheels.md by their numbers, and whole runs by their
// audit.
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/navigator.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/vo/lp/solve.h"
#include "motion/differential.h"
#include "scene/braking.h"
#include "scene/decision_rules.h"
#include "support/seeded_random.h"
#include "wheels_scenes.h"

namespace exactvo::formation {
namespace {

using detail::TwistOfStep;
using detail::WheelLimits;
using namespace test_scenes;

DifferentialDrive some_drive(test::SeededRandom& random) {
  DifferentialDrive d = burger();
  d.wheel_separation = random.uniform(0.1, 0.6);
  d.reference = random.uniform(0.05, 0.4);
  d.max_wheel_speed = random.uniform(0.1, 0.5);
  return d;
}

/// m/s: the greatest that keeps both wheels within W for ever, by theorem 1.
double reach_of_set(const DifferentialDrive& d, double error) {
  const double beta = d.wheel_separation / (2.0 * d.reference), alpha = std::atan(beta), at = std::fabs(error);
  return at <= alpha ? d.max_wheel_speed / (std::cos(at) + beta * std::sin(at)) : d.max_wheel_speed * std::cos(alpha);
}

/// The wheels of a reference point that goes straight for ever, by the closed form of its heading, sampled.
TEST(Wheels, Theorem1_TheSetIsTheHullOfADiscAndAPoint) {
  test::SeededRandom random(test::seed_of_run(1));
  int later = 0;
  for (int k = 0; k < 4000; ++k) {
    const DifferentialDrive d = some_drive(random);
    const double beta = d.wheel_separation / (2.0 * d.reference), error = random.uniform(-3.141, 3.141);
    const double speed = reach_of_set(d, error);
    double most = 0.0, at_start = 0.0;
    for (int n = 0; n <= 2000; ++n) {
      const double left = 2.0 * std::atan(std::tan(0.5 * error) * std::exp(-0.01 * n));
      const double faster = speed * (std::fabs(std::cos(left)) + beta * std::fabs(std::sin(left)));
      most = std::max(most, faster);
      if (n == 0) at_start = faster;
    }
    EXPECT_NEAR(most, d.max_wheel_speed, 1e-4 * d.max_wheel_speed) << k << " " << error;
    later += most > at_start * (1.0 + 1e-6);
  }
  EXPECT_GT(later, 2000) << "the greatest speed is inside the way more often than at its start";
}

/// Corners of the polygon that stands in the linear program, in rationals: below the lines from the apex, or in the
/// disc.
TEST(Wheels, Theorem1_ThePolygonLiesInTheSet) {
  using Rational = mpq_class;
  test::SeededRandom random(test::seed_of_run(11));
  int corners = 0, beyond_disc = 0;
  std::vector<geometry::HalfPlane> set;
  for (int k = 0; k < 200; ++k) {
    DifferentialDrive d = some_drive(random);
    d.max_wheel_acceleration = 1000.0;  // no change of the wheels cuts anything off
    const WheelLimits limits(d, 0.05, 0.5);
    ASSERT_GT(limits.side_speed(), 0.0);
    limits.half_planes({1.0, 0.0}, {}, {}, set);
    const std::size_t sides = set.size() - 4;
    const Rational beta = Rational(d.wheel_separation) / (2 * Rational(d.reference)), most(d.max_wheel_speed);
    Rational farthest(0);
    for (std::size_t i = 0; i < sides; ++i) {
      const geometry::HalfPlane &one = set[i], &next = set[(i + 1) % sides];
      const Rational ax(one.normal.x), ay(one.normal.y), bx(next.normal.x), by(next.normal.y);
      const Rational det = ax * by - ay * bx, c(one.offset), e(next.offset);
      const Rational x = (c * by - e * ay) / det, y = abs(Rational((ax * e - bx * c) / det));
      const bool is_in_disc = (x * x + y * y) * (1 + beta * beta) <= most * most;
      EXPECT_TRUE(is_in_disc || (y <= beta * x && x + beta * y <= most)) << k << " corner " << i;
      beyond_disc += !is_in_disc;
      if (x > farthest) farthest = x;
      ++corners;
    }
    EXPECT_GT(farthest, Rational(0.98) * most) << k << ": ahead it is as fast as its wheels";
  }
  EXPECT_GT(corners, 5000);
  EXPECT_GE(beyond_disc, 200);
}

// A step that takes next to nothing of the velocity needs the most chords; their number was infinite, and became the
// fewest.
TEST(Wheels, AVeryLongBrakingTimeMakesTheFinestPolygon) {
  const auto sides = [](double braking_time) {
    std::vector<geometry::HalfPlane> set;
    WheelLimits(burger(), 0.05, braking_time).half_planes({1.0, 0.0}, {}, {}, set);
    return set.size();
  };
  EXPECT_GT(sides(1e6), 200u);
  EXPECT_EQ(sides(1e18), sides(1e6));
}

/// End point, heading, stray and wheels of a constant twist.
TEST(Wheels, Theorem2_AConstantTwistTakesTheReferencePointThere) {
  test::SeededRandom random(test::seed_of_run(2));
  double largest_stray = 0.0, fastest = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double step = random.uniform(0.01, 0.2);
    const DifferentialDrive d = some_drive(random);
    const double error = random.uniform(-3.14, 3.14), q_most = d.max_wheel_speed * step / (2.0 * d.reference);
    if (q_most > 0.9) continue;
    const double arc = std::asin(q_most) / q_most;
    const double speed = reach_of_set(d, error) / arc * (k % 2 == 0 ? 1.0 : random.uniform(0.0, 1.0));
    const double start = random.uniform(-3.0, 3.0);
    const Vec2 heading = polar(1.0, start), u = polar(speed, start + error);
    const TwistOfStep twist = detail::twist_of(d, step, heading, u);
    const double forward = 0.5 * (twist.wheels.left + twist.wheels.right);
    const double turn = (twist.wheels.right - twist.wheels.left) / d.wheel_separation;
    EXPECT_NEAR(turn * step, 2.0 * std::atan(twist.turn), 1e-12);
    // The axle along its arc.
    const auto reference_at = [&](double t) {
      const double a = turn * t, half = 0.5 * a;
      const double chord = forward * t * (std::fabs(half) < 1e-9 ? 1.0 : std::sin(half) / half);
      return polar(chord, start + half) + polar(d.reference, start + a);
    };
    const Vec2 from = polar(d.reference, start);
    EXPECT_LT(norm(reference_at(step) - from - step * u), 1e-13) << k;
    EXPECT_LT(norm(polar(1.0, start + turn * step) - detail::turned(heading, twist.turn)), 1e-13) << k;
    const double q = speed * step / (2.0 * d.reference);
    const double left = std::tan(0.5 * (error - turn * step)), before = std::tan(0.5 * error);
    EXPECT_NEAR(left, before * (1.0 - q) / (1.0 + q), 1e-9 * (1.0 + std::fabs(before))) << k;
    const double bound = 0.25 * speed * step * std::fabs(twist.turn);
    for (int n = 1; n < 8; ++n) {
      const double stray = norm(reference_at(step * n / 8.0) - from - (step * n / 8.0) * u);
      EXPECT_LE(stray, bound + 1e-13) << k;
      if (bound > 1e-6) largest_stray = std::max(largest_stray, stray / bound);
    }
    EXPECT_LE(bound, stray_of(d, step));
    for (const double wheel : {twist.wheels.left, twist.wheels.right}) {
      EXPECT_LE(std::fabs(wheel), d.max_wheel_speed * (1.0 + 1e-12)) << k;
      fastest = std::max(fastest, std::fabs(wheel) / d.max_wheel_speed);
    }
  }
  EXPECT_GT(largest_stray, 0.999);
  EXPECT_GT(fastest, 0.999);
}

/// In rationals headings stay unit vectors.
TEST(Wheels, Theorem2_HeadingsStayRational) {
  using Rational = mpq_class;
  Rational ex(1), ey(0);
  const Rational ahead(2, 25), step(1, 20);
  for (int k = 0; k < 40; ++k) {
    const Rational ux(3 - k % 7, 50), uy(k % 5 - 2, 50);
    const Rational x = step * (ux * ex + uy * ey), y = step * (uy * ex - ux * ey), t = y / (2 * ahead + x);
    const Rational c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
    const Rational next = ex * c - ey * s;
    ey = ey * c + ex * s;
    ex = next;
    EXPECT_EQ(Rational(ex * ex + ey * ey), 1);
  }
}

bool is_allowed(const std::vector<geometry::HalfPlane>& set, Vec2 v) {
  return std::all_of(set.begin(), set.end(),
                     [&](const geometry::HalfPlane& h) { return dot(h.normal, v) >= h.offset - 1e-12; });
}

/// From velocity to velocity anywhere in the set: braking is allowed by the half-planes of the next step and keeps the
/// wheels' limits (lemma 2: the set; lemma 3: the change).
TEST(Wheels, Lemmas2And3_BrakingStaysAllowed) {
  test::SeededRandom random(test::seed_of_run(23));
  constexpr double kStep = 0.05;
  int driven = 0, turning = 0, refused = 0;
  for (int drive = 0; drive < 60; ++drive) {
    DifferentialDrive d = drive % 3 == 0 ? burger() : some_drive(random);
    if (drive % 3 == 2) d.max_wheel_acceleration = random.uniform(0.5, 3.0);
    if (drive % 5 == 4) d.max_backward_speed = 0.3 * d.max_wheel_speed;
    if (drive % 7 == 6) d.max_angular_speed = random.uniform(0.8, 2.8);
    const double tau = usual_braking_time(d.max_wheel_speed, d.max_wheel_acceleration, kStep) * (1.0 + drive % 4);
    const WheelLimits limits(d, kStep, tau);
    if (!(limits.side_speed() > 0.0)) continue;
    Vec2 heading = random.direction(), velocity{};
    WheelSpeeds speeds;
    std::vector<geometry::HalfPlane> set;
    for (int k = 0; k < 400; ++k) {
      const Vec2 braked = (1.0 - kStep / tau) * velocity;
      limits.half_planes(heading, speeds, braked, set);
      EXPECT_TRUE(is_allowed(set, braked)) << drive << " " << k;
      EXPECT_TRUE(limits.allows(heading, speeds, braked)) << drive << " " << k;
      // Anything allowed, as far from braking as can be.
      Vec2 u = braked;
      const Vec2 wish = d.max_wheel_speed * random.direction();
      for (double share = 1.0; share > 1e-3; share *= 0.7) {
        const Vec2 some = braked + share * (wish - braked);
        if (!is_allowed(set, some) || !limits.allows(heading, speeds, some)) {
          ++refused;
          continue;
        }
        u = some;
        break;
      }
      const TwistOfStep twist = detail::twist_of(d, kStep, heading, u);
      for (const double wheel : {twist.wheels.left, twist.wheels.right})
        EXPECT_LE(std::fabs(wheel), d.max_wheel_speed * (1.0 + 1e-12));
      turning += std::fabs(twist.turn) > 0.02;
      heading = detail::turned(heading, twist.turn);
      speeds = twist.wheels;
      velocity = u;
      ++driven;
    }
  }
  EXPECT_GT(driven, 15000);
  EXPECT_GT(turning, 1500);
  EXPECT_GT(refused, 10000);
}

// --- Runs ---

/// TurtleBot3 Burgers on a circle of 2.2 m (4: 1.5 m): wheels 0.22 m/s and 1 m/s^2; straight ways take 20 s and 13.6 s.
/// The last robot comes no later than that of the prototype.
TEST(Wheels, BurgersOnACircleArriveInTimeWithNothingRelaxed) {
  struct Case {
    int robots;
    double radius;
    bool turned;
    double last;
    std::uint64_t seed = 5;
    bool pillars = false;
  };
  for (const Case c :
       {Case{4, 1.5, false, 14.7}, Case{12, 2.2, false, 24.35}, Case{12, 2.2, true, 25.95},
        Case{12, 2.2, true, 25.95, 6}, Case{12, 2.2, true, 25.95, 7}, Case{12, 2.2, false, 38.0, 5, true}}) {
    Scenario s = burgers_on_circle(c.robots, c.radius, c.turned, c.seed);
    if (c.pillars) add_pillars(s);
    const datasets::RecordingFile file = recorded(s);
    const datasets::AuditReport report = datasets::audit(file);
    EXPECT_EQ(file.recording.outcome, "all robots arrived") << c.robots;
    EXPECT_EQ(relaxed_in(file.recording), 0u);
    EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
    EXPECT_GT(report[datasets::AuditPoint::kinematics].proven, file.recording.steps.size());
    EXPECT_LE(last_arrival(file), c.last + 1e-9) << c.robots << (c.turned ? ", turned" : "");
  }
}

/// One robot that is to go straight back turns round.
TEST(Wheels, ARobotTurnsRoundAtItsPlace) {
  for (const double backward : {geometry::kInfinity, 0.05}) {
    Scenario s = burgers_on_circle(1, 1.0, false);
    DifferentialDrive d = *s.robots[0].drive;
    d.heading = 0.0;
    d.max_backward_speed = backward;
    d.axle = {};
    put_on_wheels(s.robots[0], d, s.time_step);
    s.robots[0].goals = {{-2.0, 0.0}};
    const datasets::RecordingFile file = recorded(s);
    EXPECT_EQ(file.recording.outcome, "the robot arrived") << backward;
    EXPECT_TRUE(datasets::audit(file).clean());
    EXPECT_LT(file.recording.steps.back().robots[0].wheels->heading.x, -0.99);
  }
}

/// The limit at the start of the step in place of theorem 1, |u.e| + beta |u.n| <= W: such a recording is refused,
/// since a wheel runs faster while the heading comes round.
TEST(Wheels, TheRhombusIsRefused) {
  Scenario s = burgers_on_circle(1, 1.0, false);
  DifferentialDrive d = *s.robots[0].drive;
  d.heading = 0.0;
  d.axle = {};
  d.max_wheel_acceleration = 100.0;  // so that nothing else is refused
  put_on_wheels(s.robots[0], d, s.time_step);
  s.robots[0].goals = {{0.08, 3.0}};
  s.time_limit = 1.0;
  datasets::RecordingFile file = recorded(s);
  Recording& run = file.recording;
  ASSERT_TRUE(datasets::audit(file)[datasets::AuditPoint::kinematics].refuted == 0);
  const double beta = d.wheel_separation / (2.0 * d.reference);
  const Vec2 u{0.0, 0.99 * d.max_wheel_speed / beta};
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k) {
    RobotStep &now = run.steps[k].robots[0], &next = run.steps[k + 1].robots[0];
    const TwistOfStep twist = detail::twist_of(d, s.time_step, now.wheels->heading, u);
    now.chosen = u;
    next.position = next.anchor = now.position + s.time_step * u;
    next.velocity = next.anchor_velocity = u;
    next.wheels = OnWheels{detail::turned(now.wheels->heading, twist.turn), twist.wheels};
  }
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_GT(report[datasets::AuditPoint::kinematics].refuted, 3u);
  EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(), [](const std::string& f) {
    return f.find("runs a wheel faster than it may") != std::string::npos;
  }));
}

TEST(Wheels, ForgeriesAreRefuted) {
  const datasets::RecordingFile file = recorded(burgers_on_circle(2, 1.0, true));
  ASSERT_TRUE(datasets::audit(file).clean());
  using datasets::AuditPoint;
  const auto refuted = [&](const auto& forge) {
    datasets::RecordingFile forged = file;
    forge(forged);
    return datasets::audit(forged)[AuditPoint::kinematics].refuted;
  };
  const auto wheels = [](auto& f, std::size_t row) -> OnWheels& { return *f.recording.steps[row].robots[1].wheels; };
  EXPECT_GT(refuted([&](auto& f) { wheels(f, 20).heading.x += 1e-9; }), 0u);
  EXPECT_GT(refuted([&](auto& f) { wheels(f, 20).speeds.left += 1e-6; }), 0u);
  EXPECT_GT(refuted([&](auto& f) { wheels(f, 0).speeds.right = 0.01; }), 0u);
  EXPECT_GT(refuted([&](auto& f) { f.recording.steps[7].robots[0].wheels.reset(); }), 0u);
  EXPECT_GT(refuted([&](auto& f) { f.scenario.robots[0].drive->max_wheel_speed = 0.21; }), 0u);
  EXPECT_GT(refuted([&](auto& f) { f.scenario.robots[0].drive->max_wheel_acceleration = 0.5; }), 0u);
  EXPECT_GT(refuted([&](auto& f) { f.scenario.robots[0].radius -= 0.001; }), 0u);
  EXPECT_GT(refuted([&](auto& f) { f.recording.steps[30].robots[0].chosen.x += 1e-6; }), 0u);
}

/// 10^4 of them: `formation_wheels_campaign edits 10000`.
TEST(Wheels, RandomEditsAreRefuted) {
  Scenario s = burgers_on_circle(2, 1.0, true);
  s.time_limit = 1.0;
  const datasets::RecordingFile file = recorded(s);
  ASSERT_TRUE(datasets::audit(file).clean());
  test::SeededRandom random(test::seed_of_run(9));
  int edited = 0;
  for (int k = 0; k < 350; ++k) {
    datasets::RecordingFile forged = file;
    const std::string what = edit_wheels(forged, k % kKindsOfEdit, random);
    EXPECT_FALSE(datasets::audit(forged).clean()) << k << ": " << what;
    ++edited;
  }
  EXPECT_EQ(edited, 350);
}

/// The half-planes of every pair made at the velocities themselves instead of those after a step of braking: decisions
/// have nothing left, and the audit finds ways that do not end in time.
TEST(Wheels, HalfPlanesMadeAtTheVelocitiesThemselvesAreRefused) {
  const Scenario s = burgers_on_circle(12, 1.0, false);
  const double tau = *s.braking_time;
  std::vector<WheelLimits> limits;
  datasets::RecordingFile file{datasets::run_info(s, {}, {}), s, {}};
  Recording& run = file.recording;
  run.time_step = s.time_step;
  Step row;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Robot& robot = s.robots[i];
    limits.emplace_back(*robot.drive, s.time_step, tau);
    run.bodies.push_back({vo::BodyKind::robot, geometry::Disc{robot.position, robot.radius}, {}, {i}});
    RobotStep step;
    step.position = step.anchor = robot.position;
    step.wheels = OnWheels{heading_vector(robot.drive->heading), {}};
    row.robots.push_back(step);
  }
  constexpr int kRows = 160;
  std::size_t nothing_left = 0;
  std::vector<geometry::HalfPlane> set;
  for (int k = 0; k < kRows; ++k) {
    row.time = k * s.time_step;
    Step next = row;
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      RobotStep& me = row.robots[i];
      const Robot& robot = s.robots[i];
      lp::Problem problem;
      problem.bound.disc = robot.max_speed;
      const Vec2 way = robot.goals[0] - me.position;
      me.preferred = problem.preferred =
          geometry::rotated(std::min(0.2, norm(way)) / norm(way) * way, -0.1 * static_cast<double>(1 + i % 3));
      for (std::size_t j = 0; j < s.robots.size(); ++j) {
        if (j == i) continue;
        const RobotStep& other = row.robots[j];
        const vo::ReciprocalHalfPlanes pair = detail::braking_half_planes(
            {me.position, me.velocity, robot.radius}, {other.position, other.velocity, s.robots[j].radius}, tau);
        problem.constraints.push_back({pair.a, lp::Priority::soft});
      }
      limits[i].half_planes(me.wheels->heading, me.wheels->speeds, (1.0 - s.time_step / tau) * me.velocity, set);
      for (const geometry::HalfPlane& h : set) problem.constraints.push_back({h, lp::Priority::hard});
      const lp::Solution solution = lp::solve(problem);
      nothing_left += solution.status != lp::Status::optimal;
      me.chosen = solution.velocity;
      me.status = solution.status;
      RobotStep& then = next.robots[i];
      const TwistOfStep twist = detail::twist_of(*robot.drive, s.time_step, me.wheels->heading, me.chosen);
      then.wheels = OnWheels{detail::turned(me.wheels->heading, twist.turn), twist.wheels};
      then.position = then.anchor = me.position + s.time_step * me.chosen;
      then.velocity = then.anchor_velocity = me.chosen;
    }
    run.steps.push_back(row);
    row.robots = next.robots;
  }
  row.time = kRows * s.time_step;
  run.steps.push_back(row);
  EXPECT_GT(nothing_left, 50u);
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_GT(report[datasets::AuditPoint::braking].refuted, nothing_left) << "ways that do not end in time as well";
  EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(), [](const std::string& f) {
    return f.find("could not brake without touching each other") != std::string::npos ||
           f.find("relaxes a half-plane") != std::string::npos;
  }));
}

// --- Navigators ---

/// What the wheels did says what was chosen.
TEST(Wheels, Theorem2_TheTwistTellsTheVelocityBefore) {
  test::SeededRandom random(test::seed_of_run(22));
  for (int k = 0; k < 5000; ++k) {
    const DifferentialDrive d = some_drive(random);
    const Vec2 heading = random.direction(), u = random.uniform(0.0, 0.9) * d.max_wheel_speed * random.direction();
    if (norm(u) * 0.05 >= d.reference) continue;
    const TwistOfStep twist = detail::twist_of(d, 0.05, heading, u);
    const Vec2 told = detail::velocity_before(d, 0.05, {detail::turned(heading, twist.turn), twist.wheels});
    EXPECT_LT(norm(told - u), 1e-13) << k;
  }
}

struct Driven {
  Vec2 axle;
  OnWheels wheels;
};

/// By the twist, whatever it is, along its arc.
Driven driven_by(const Twist& twist, const Driven& from, double step) {
  const double half = 0.5 * twist.angular * step;
  const double chord = twist.linear * step * (std::fabs(half) < 1e-9 ? 1.0 : std::sin(half) / half);
  return {from.axle + chord * geometry::rotated(from.wheels.heading, half),
          {geometry::rotated(from.wheels.heading, 2.0 * half), twist.wheels}};
}

/// Eight of them in a ring with a post, each by itself, told the poses and wheels of the others: nothing is relaxed, no
/// wheel breaks a limit, no bodies overlap.
TEST(Wheels, NavigatorsDriveByPosesAndTwists) {
  Scenario s = burgers_on_circle(8, 1.3, true);
  s.obstacles.push_back({"post", geometry::Polygon{{{-0.1, -0.1}, {0.1, -0.1}, {0.0, 0.1}}, {}}});
  std::vector<Navigator> navigators;
  std::vector<Driven> now;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    // Aside of the opposite place, so that they need not wait for each other for ever.
    navigators.emplace_back(navigator_setup(s, i), std::vector<Vec2>{geometry::rotated(s.robots[i].goals[0], 0.6)});
    now.push_back({s.robots[i].drive->axle, {heading_vector(s.robots[i].drive->heading), {}}});
  }
  std::size_t decisions = 0, wishes_changed = 0, turning = 0, arrived = 0;
  for (int k = 0; k < 900; ++k) {
    std::vector<Driven> next;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const DifferentialDrive& drive = *s.robots[i].drive;
      std::vector<Neighbour> others;
      for (std::size_t j = 0; j < now.size(); ++j)
        if (j != i)
          others.push_back(neighbour_on_wheels(j, *s.robots[j].drive, s.time_step, now[j].axle, now[j].wheels));
      const Decision& d = navigators[i].decide({k * s.time_step, now[i].axle, {}, now[i].wheels}, others);
      EXPECT_EQ(d.status, lp::Status::optimal) << k << " " << i;
      EXPECT_EQ(d.uncertified, 0u);
      wishes_changed += d.preferred != d.chosen;
      ++decisions;
      const Twist twist = navigators[i].twist();
      const WheelSpeeds was = now[i].wheels.speeds, is = twist.wheels;
      turning += std::fabs(twist.angular) > 0.1;
      EXPECT_NEAR(is.left, twist.linear - 0.5 * drive.wheel_separation * twist.angular, 1e-12);
      EXPECT_LE(std::max(std::fabs(is.left), std::fabs(is.right)), drive.max_wheel_speed);
      EXPECT_LE(std::max(std::fabs(is.left - was.left), std::fabs(is.right - was.right)),
                drive.max_wheel_acceleration * s.time_step);
      next.push_back(driven_by(twist, now[i], s.time_step));
      const Vec2 before = now[i].axle + drive.reference * now[i].wheels.heading;
      const Vec2 after = next[i].axle + drive.reference * next[i].wheels.heading;
      EXPECT_LT(norm(after - before - s.time_step * d.chosen), 1e-13);
    }
    now = next;
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(norm(now[i].axle - now[j].axle), 0.21) << k;
  }
  for (const Navigator& n : navigators) arrived += n.has_arrived();
  EXPECT_EQ(decisions, 900u * navigators.size());
  EXPECT_GT(wishes_changed, 100u);
  EXPECT_GT(turning, 100u);
  EXPECT_GE(arrived, navigators.size() / 2);
}

TEST(Wheels, NavigatorsRefuseWhatTheirProofLacks) {
  const auto words_of = [](const auto& change) -> std::string {
    NavigatorSetup setup;
    setup.drive = burger();
    NavigatorState now{0.0, {0, 0}, {}, {{1, 0}, {}}};
    change(setup, now);
    try {
      Navigator navigator(setup, {{6, 0}});
      navigator.decide(now);
    } catch (const NavigatorError& e) {
      return e.what();
    }
    return "";
  };
  using Setup = NavigatorSetup;
  using State = NavigatorState;
  EXPECT_EQ(words_of([](Setup&, State&) {}), "");
  EXPECT_EQ(words_of([](Setup&, State& n) { n.wheels.heading = {}; }),
            "heading: found 0, 0, expected a vector of length 1");
  EXPECT_NE(
      words_of([](Setup&, State& n) { n.wheels.speeds.left = -0.5; }).find("wheels: found -0.5, 0, expected speeds"),
      std::string::npos);
  EXPECT_NE(words_of([](Setup&, State& n) { n.wheels.heading.x = std::nan(""); }).find("heading: found nan"),
            std::string::npos);
  EXPECT_NE(words_of([](Setup& s, State&) { s.drive->reference = 0.0; }).find("kinematics/reference: found 0"),
            std::string::npos);
  EXPECT_NE(words_of([](Setup& s, State&) { s.drive->reference = 0.01; }).find("kinematics/reference: found 0.01"),
            std::string::npos);
  EXPECT_NE(words_of([](Setup& s, State&) { s.braking_time = 0.2; }).find("braking_time: found 0.2"),
            std::string::npos);
  EXPECT_NE(words_of([](Setup& s, State&) { s.horizons.robots = 0.2; }).find("horizons/robots: found 0.2"),
            std::string::npos);
  EXPECT_NE(words_of([](Setup& s, State&) { s.cooperates = false; }).find("cooperates: found false"),
            std::string::npos);
  EXPECT_NE(words_of([](Setup& s, State&) {
              s.obstacles = {{"box", geometry::Polygon{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {}}}};
            }).find("position: found"),
            std::string::npos);
}

constexpr const char* kText = R"({"name": "pair", "braking_time": 0.5, "robots": [
  {"id": "R1", "position": [0, 0], "heading": 90, "radius": 0.105, "goal": [0, 2],
   "kinematics": {"type": "differential", "wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1.0}},
  {"id": "R2", "position": [1, 0], "goal": [1, 2], "radius": 0.2, "max_speed": 0.3,
   "kinematics": {"type": "omnidirectional"}}]})";

/// A robot that moves in any direction brakes for those on wheels.
TEST(Wheels, NavigatorsBesideRobotsOnWheelsBrakeAsTheyDo) {
  const Scenario s = datasets::parse_scenario(kText, "pair.json", {});
  const NavigatorSetup setup = navigator_setup(s, 1);
  EXPECT_FALSE(setup.drive);
  EXPECT_FALSE(setup.acceleration);
  EXPECT_EQ(setup.braking_time, 0.5);
  Navigator navigator(setup, {{1, 2}});
  EXPECT_GT(norm(navigator.decide({0.0, {1, 0}, {}, {}}).chosen), 0.29);
  EXPECT_THROW(navigator.decide({0.05, {1, 0}, {}, {}}, {{0, {3, 0}, {}, 0.2, 0.3, false}}), NavigatorError);
}

/// Subnormal numbers have no direction, which the way of braking of a footprint rests on.
TEST(Wheels, BrakingKeepsItsDirectionUntilTheRobotRests) {
  test::SeededRandom random(test::seed_of_run(7));
  std::size_t steps = 0, rested = 0;
  for (int k = 0; k < 50; ++k) {
    detail::DecisionRules rules;
    rules.braking_time = random.uniform(rules.time_step, 10.0 * rules.time_step);
    const Vec2 first = random.uniform(0.01, 3.0) * random.direction();
    Vec2 now = first;
    for (int step = 0; step < 10000 && now != Vec2{}; ++step, ++steps) {
      EXPECT_LE(std::fabs(cross(now / norm(now), first / norm(first))), 1e-12);
      now = rules.braked(now);
    }
    rested += now == Vec2{};
  }
  EXPECT_EQ(rested, 50u);
  EXPECT_GT(steps, 5000u);
}

// --- Files, and what cannot be run ---

TEST(Wheels, ScenariosSayWhereTheAxleIs) {
  const Scenario s = datasets::parse_scenario(kText, "pair.json", {});
  ASSERT_TRUE(s.robots[0].drive);
  EXPECT_FALSE(s.robots[1].drive);
  EXPECT_EQ(s.robots[0].drive->reference, 0.08);
  EXPECT_EQ(s.robots[0].position, (Vec2{0.0, 0.08}));
  EXPECT_GT(s.robots[0].radius, 0.185);
  EXPECT_LT(s.robots[0].radius, 0.1855);
  const std::string written = datasets::write_scenario(s);
  EXPECT_EQ(datasets::write_scenario(datasets::parse_scenario(written, "again.json", {})), written);
}

TEST(Wheels, WrongValuesInAFileAreRefusedWithACode) {
  const auto refusal = [](const std::string& from,
                          const std::string& to) -> std::pair<datasets::DataCode, std::string> {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    try {
      datasets::parse_scenario(text, "pair.json", {});
    } catch (const datasets::DataError& e) {
      return {e.code(), e.place()};
    }
    return {datasets::DataCode::cut_off, "was read"};
  };
  using datasets::DataCode;
  const auto scenario = [](const char* place) { return std::pair(DataCode::scenario, std::string(place)); };
  const std::string of_all = "\"braking_time\": 0.5, ";
  EXPECT_EQ(refusal("\"heading\": 90", "\"heading\": \"north\"").first, DataCode::wrong_type);
  EXPECT_EQ(refusal("\"max_wheel_speed\": 0.22, ", ""),
            std::pair(DataCode::key_missing, std::string("/robots/0/kinematics")));
  EXPECT_EQ(refusal("\"omnidirectional\"", "\"omnidirectional\", \"reference\": 1"), scenario("/robots/1/kinematics"));
  EXPECT_EQ(refusal("0.22", "0").second, "/robots/0/kinematics/max_wheel_speed");
  EXPECT_EQ(refusal("\"goal\": [0, 2]", "\"goal\": [0, 2], \"max_speed\": 1"), scenario("/robots/0/max_speed"));
  EXPECT_EQ(refusal("\"goal\": [1, 2]", "\"goal\": [1, 2], \"heading\": 3"), scenario("/robots/1/heading"));
  EXPECT_EQ(refusal("\"goal\": [1, 2]", "\"goal\": [1, 2], \"cooperates\": false"), scenario("/robots/1/cooperates"));
  EXPECT_EQ(refusal(of_all, of_all + "\"separate\": true, "), scenario("/separate"));
  EXPECT_EQ(refusal(of_all, "\"braking_time\": 0.2, "), scenario("/braking_time"));
  EXPECT_EQ(refusal("0.22", "4"), scenario("/robots/0/kinematics/reference"));
  EXPECT_EQ(refusal(of_all, of_all + R"("moving_obstacles": [{"id": "m", "polygon": [[9, 9], [10, 9], [9, 10]],
                                        "path": [[0, 0], [1, 0]], "speed": 1}], )"),
            scenario("/moving_obstacles"));
}

TEST(Wheels, OtherRunsAreRefused) {
  Scenario s = datasets::parse_scenario(kText, "pair.json", {});
  EXPECT_EQ(crowd_problems(s).at(0).pointer, "/robots/0/kinematics/max_wheel_acceleration");
  SimulationOptions options;
  options.method = Method::rvo;
  EXPECT_THROW(simulate(s, options), std::logic_error);
}

TEST(Wheels, RecordingsKeepHeadings) {
  const datasets::RecordingFile file = recorded(burgers_on_circle(2, 0.6, true));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("exactvo_wheels_" + std::to_string(::getpid()) + ".jsonl");
  datasets::write_recording(path, file);
  const datasets::AuditReport report = datasets::audit_recording(path, &file.scenario);
  const datasets::RecordingFile read = datasets::read_recording(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_GT(report[datasets::AuditPoint::kinematics].proven, file.recording.steps.size());
  ASSERT_EQ(read.recording.steps.size(), file.recording.steps.size());
  for (std::size_t k = 0; k < read.recording.steps.size(); ++k) {
    const OnWheels &was = *file.recording.steps[k].robots[1].wheels, &is = *read.recording.steps[k].robots[1].wheels;
    EXPECT_EQ(was.heading, is.heading);
    EXPECT_EQ(was.speeds.left, is.speeds.left);
  }
}

std::string problem_at(const Scenario& s, const std::string& pointer) {
  for (const ScenarioProblem& p : validate(s))
    if (p.pointer == pointer) return p.found + "; expected " + p.expected;
  return "";
}

TEST(Wheels, ValidateSaysWhatToChange) {
  const Scenario s = datasets::parse_scenario(kText, "pair.json", {});
  ASSERT_TRUE(validate(s).empty());
  const auto with = [&](const auto& change) {
    Scenario other = s;
    DifferentialDrive d = *other.robots[0].drive;
    change(other, d);
    put_on_wheels(other.robots[0], d, other.time_step);
    return other;
  };
  using Drive = DifferentialDrive;
  EXPECT_NE(
      problem_at(with([](auto&, Drive& d) { d.wheel_separation = 0.0; }), "/robots/0/kinematics/wheel_separation"), "");
  EXPECT_NE(problem_at(with([](auto&, Drive& d) { d.reference = 0.01; }), "/robots/0/kinematics/reference"), "");
  EXPECT_NE(problem_at(with([](auto& o, Drive&) { o.braking_time = 0.2; }), "/braking_time"), "");
  EXPECT_NE(problem_at(with([](auto& o, Drive&) { o.robots[0].velocity = {0.1, 0.0}; }), "/robots/0/velocity"), "");
  EXPECT_NE(problem_at(with([](auto& o, Drive&) { o.horizons.robots = 0.4; }), "/horizons/robots"), "");
  Scenario moved = s;
  moved.robots[0].position.x += 0.1;
  EXPECT_NE(problem_at(moved, "/robots/0"), "");
}

}  // namespace
}  // namespace exactvo::formation
