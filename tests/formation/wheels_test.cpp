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
#include "exactvo/datasets/run_info.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/navigator.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/pi.h"
#include "motion/differential.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using detail::TwistOfStep;
using detail::WheelLimits;
using geometry::kPi;

DifferentialDrive burger() {
  DifferentialDrive d;
  d.wheel_separation = 0.16;
  d.max_wheel_speed = 0.22;
  d.max_wheel_acceleration = 1.0;
  d.reference = 0.08;
  d.body_radius = 0.105;
  return d;
}

DifferentialDrive some_drive(test::SeededRandom& random) {
  DifferentialDrive d = burger();
  d.wheel_separation = random.uniform(0.1, 0.6);
  d.reference = random.uniform(0.05, 0.4);
  d.max_wheel_speed = random.uniform(0.1, 0.5);
  return d;
}

Vec2 polar(double length, double angle) {
  return length * Vec2{std::cos(angle), std::sin(angle)};
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

Scenario on_circle(int robots, double radius, bool turned, double first = 0.0) {
  Scenario s;
  s.name = "burgers";
  s.time_limit = 90.0;
  s.arrival_tolerance = 0.02;
  s.braking_time = 0.5;
  s.margins.robot = 0.0;
  test::SeededRandom random(5);
  for (int k = 0; k < robots; ++k) {
    const double angle = 2.0 * kPi * k / robots + first;
    Robot r;
    r.id = "R" + std::to_string(k + 1);
    DifferentialDrive d = burger();
    d.heading = 180.0 / kPi * (angle + kPi + (turned ? random.uniform(-3.1, 3.1) : 0.0));
    d.axle = polar(radius, angle) - d.reference * heading_vector(d.heading);
    put_on_wheels(r, d, s.time_step);
    r.goals = {polar(-radius, angle)};
    s.robots.push_back(r);
  }
  return s;
}

datasets::RecordingFile recorded(const Scenario& s) {
  return {datasets::run_info(s, {}, {}), s, simulate(s)};
}

double last_arrival(const datasets::RecordingFile& file) {
  double last = 0.0;
  for (const Step& row : file.recording.steps)
    for (std::size_t i = 0; i < row.robots.size(); ++i)
      if (norm(row.robots[i].position - file.scenario.robots[i].goals.back()) > file.scenario.arrival_tolerance)
        last = row.time + file.scenario.time_step;
  return last;
}

std::size_t relaxed_in(const Recording& run) {
  std::size_t relaxed = 0;
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k)
    for (const RobotStep& r : run.steps[k].robots) relaxed += r.status != lp::Status::optimal;
  return relaxed;
}

/// TurtleBot3 Burgers on a circle of 2.2 m (4: 1.5 m): wheels 0.22 m/s and 1 m/s^2. The times are the prototype's,
/// whose straight ways take 20 s and 13.6 s.
TEST(Wheels, BurgersOnACircleArriveWithNothingRelaxed) {
  struct Case {
    int robots;
    double radius;
    bool turned;
    double last;
  };
  for (const Case c : {Case{4, 1.5, false, 15.6}, Case{12, 2.2, false, 26.7}, Case{12, 2.2, true, 25.95}}) {
    const datasets::RecordingFile file = recorded(on_circle(c.robots, c.radius, c.turned));
    const datasets::AuditReport report = datasets::audit(file);
    EXPECT_EQ(file.recording.outcome, "all robots arrived") << c.robots;
    EXPECT_EQ(relaxed_in(file.recording), 0u);
    EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
    EXPECT_GT(report[datasets::AuditPoint::kinematics].proven, file.recording.steps.size());
    std::printf("%d Burgers%s: last %.2f s (prototype %.2f s), %zu decisions\n", c.robots, c.turned ? ", turned" : "",
                last_arrival(file), c.last, (file.recording.steps.size() - 1) * file.scenario.robots.size());
  }
}

/// One robot that is to go straight back turns round.
TEST(Wheels, ARobotTurnsRoundAtItsPlace) {
  for (const double backward : {geometry::kInfinity, 0.05}) {
    Scenario s = on_circle(1, 1.0, false);
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
  Scenario s = on_circle(1, 1.0, false);
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
  const datasets::RecordingFile file = recorded(on_circle(2, 1.0, true));
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

/// Random edits of headings, wheels and choices, from a millionth of their size on.
TEST(Wheels, RandomEditsAreRefuted) {
  Scenario s = on_circle(2, 1.0, true);
  s.time_limit = 1.0;
  const datasets::RecordingFile file = recorded(s);
  ASSERT_TRUE(datasets::audit(file).clean());
  test::SeededRandom random(test::seed_of_run(9));
  const int last = static_cast<int>(file.recording.steps.size()) - 1;
  int edited = 0;
  for (int k = 0; k < 400; ++k) {
    datasets::RecordingFile forged = file;
    const auto row = static_cast<std::size_t>(random.integer(0, last - 1));
    RobotStep& robot = forged.recording.steps[row].robots[k % 2];
    const double by = std::pow(10.0, random.uniform(-6.0, 0.0)) * (random.integer(0, 1) == 0 ? -1.0 : 1.0);
    const int what = k / 2 % 6;
    if (what == 0) robot.wheels->heading = geometry::rotated(robot.wheels->heading, by);
    if (what == 1) robot.wheels->heading.y += by;
    if (what == 2) robot.wheels->speeds.left += by;
    if (what == 3) robot.wheels->speeds.right += by;
    if (what == 4) robot.chosen.x += by;
    if (what == 5) robot.chosen.y += by;
    EXPECT_FALSE(datasets::audit(forged).clean()) << k << " row " << row << " by " << by;
    ++edited;
  }
  EXPECT_EQ(edited, 400);
}

// --- Files, and what cannot be run ---

constexpr const char* kText = R"({"name": "pair", "braking_time": 0.5, "robots": [
  {"id": "R1", "position": [0, 0], "heading": 90, "radius": 0.105, "goal": [0, 2],
   "kinematics": {"type": "differential", "wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1.0}},
  {"id": "R2", "position": [1, 0], "goal": [1, 2], "radius": 0.2, "max_speed": 0.3,
   "kinematics": {"type": "omnidirectional"}}]})";

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

TEST(Wheels, WhatAFileSaysWrongIsRefusedByACode) {
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
  EXPECT_EQ(crowd_problems(s).at(0).pointer, "/robots/0/kinematics");
  EXPECT_THROW(navigator_setup(s, 0), NavigatorError);
  SimulationOptions options;
  options.method = Method::rvo;
  EXPECT_THROW(simulate(s, options), std::logic_error);
  s.formation.emplace();
  const std::vector<ScenarioProblem> problems = validate(s);
  EXPECT_TRUE(std::any_of(problems.begin(), problems.end(),
                          [](const ScenarioProblem& p) { return p.pointer == "/robots/0/kinematics"; }));
}

TEST(Wheels, RecordingsKeepHeadings) {
  const datasets::RecordingFile file = recorded(on_circle(2, 0.6, true));
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
