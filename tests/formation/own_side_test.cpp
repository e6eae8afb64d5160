// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that measure each other and keep to their own sides (docs/guide/uncertainty.md, decision/own_side.h).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "decision/own_side.h"
#include "exact/rational_plane.h"
#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/navigator.h"
#include "exactvo/formation/notices.h"
#include "exactvo/geometry/distance.h"
#include "support/seeded_random.h"
#include "wheels_scenes.h"

namespace exactvo::formation {
namespace {

using datasets::AuditPoint;
using datasets::AuditReport;
using geometry::Segment;
using geometry::rational::exactly;
using geometry::rational::Point;
using geometry::rational::Rational;
using testing::HasSubstr;
using namespace test_scenes;

constexpr double kAcceleration = 0.45;  // m/s^2

detail::DecisionRules rules() {
  detail::DecisionRules r;
  r.time_step = 0.05;
  r.braking_time = 0.5;
  r.acceleration = kAcceleration;
  r.measurements = Measurements{0.02, 0.05, 0.1};
  return r;
}

Scenario measured_circle(const Measurements& bounds, int robots = 8) {
  Scenario s = burgers_on_circle(robots, 1.5, false);
  s.acceleration = Acceleration{kAcceleration};
  s.uncertainty = Uncertainty{0.0, bounds};
  return s;
}

/// Two robots in the true world, and how the first has measured the second.
struct World {
  Vec2 position, velocity;              ///< of the robot itself
  Vec2 other_position, other_velocity;  ///< now
  Vec2 measured_position, measured_velocity;
  double age = 0.0, radii = 0.0;
};

Segment way_of(const detail::DecisionRules& r, Vec2 position, Vec2 velocity) {
  return {position, position + (r.braking_time - r.time_step) * velocity};
}

/// Errors are as large as the bounds allow, mostly. Ways of braking are apart, and often by hardly more than the radii.
World random_world(const detail::DecisionRules& r, test::SeededRandom& random) {
  for (;;) {
    World w;
    w.radii = random.uniform(0.2, 0.5);
    w.velocity = random.uniform(0.0, 0.22) * random.direction();
    Vec2 position = random.uniform(0.2, 1.0) * random.direction(),
         velocity = random.uniform(0.0, 0.22) * random.direction();
    const auto error = [&](double bound) {
      return (random.integer(0, 3) == 0 ? random.uniform(0.0, 1.0) : 1.0) * bound * (1.0 - 1e-12) * random.direction();
    };
    w.measured_position = position + error(r.measurements->position);
    w.measured_velocity = velocity + error(r.measurements->velocity);
    for (int rows = random.integer(0, 2); rows > 0; --rows) {
      velocity += error(r.acceleration * r.time_step);
      position += r.time_step * velocity;
      w.age += r.time_step;
    }
    w.other_position = position;
    w.other_velocity = velocity;
    const double apart = geometry::distance(way_of(r, w.position, w.velocity), way_of(r, position, velocity));
    if (random.integer(0, 1) == 0) w.radii = std::min(w.radii, apart - 2e-6);
    if (apart > w.radii + 1e-6 && w.radii > 0.05) return w;
  }
}

/// The nearest points of the true ways: from the other's to its own.
Vec2 across(const Segment& own, const Segment& other) {
  const auto nearest = [](const Segment& s, Vec2 p) {
    const Vec2 along = s.b - s.a;
    const double square = squared_norm(along);
    return square > 0.0 ? s.a + std::clamp(dot(p - s.a, along) / square, 0.0, 1.0) * along : s.a;
  };
  Vec2 best = own.a - nearest(other, own.a);
  for (const Vec2 b : {own.b - nearest(other, own.b), nearest(own, other.a) - other.a, nearest(own, other.b) - other.b})
    if (norm(b) < norm(best)) best = b;
  return best;
}

/// Whether the way at `u` keeps half of the radii from the line half-way between the true ways, in rationals.
bool keeps_own_side(const detail::DecisionRules& r, const World& w, Vec2 u) {
  const Segment own = way_of(r, w.position, w.velocity), other = way_of(r, w.other_position, w.other_velocity);
  const Point n = exactly(across(own, other));
  const auto along = [&](Vec2 p) { return Rational(dot(n, exactly(p))); };
  const Rational line = (std::min(along(own.a), along(own.b)) + std::max(along(other.a), along(other.b))) / 2;
  const Rational end = along(w.position) + Rational(r.braking_time) * dot(n, exactly(u));
  const Rational off = std::min(along(w.position), end) - line, room = Rational(w.radii) / 2;
  return sgn(off) > 0 && off * off >= room * room * dot(n, n);
}

std::vector<geometry::HalfPlane> lines_of(const detail::DecisionRules& r, const World& w) {
  const detail::OwnSide lines(r, w.position, w.velocity,
                              detail::foreseen_way(r, *r.measurements, w.measured_position, w.measured_velocity, w.age),
                              w.radii);
  return {lines.begin(), lines.end()};
}

bool satisfies(const std::vector<geometry::HalfPlane>& lines, Vec2 u) {
  return std::all_of(lines.begin(), lines.end(), [&](const auto& h) { return dot(h.normal, u) >= h.offset; });
}

/// From braking as far into a direction as the lines allow.
Vec2 farthest(const std::vector<geometry::HalfPlane>& lines, Vec2 from, Vec2 direction) {
  double most = 1.0;
  for (const geometry::HalfPlane& h : lines) {
    const double falls = -dot(h.normal, direction);
    if (falls > 0.0) most = std::min(most, std::max(0.0, (dot(h.normal, from) - h.offset) / falls));
  }
  return from + (1.0 - 1e-12) * most * direction;
}

TEST(OwnSide, RuleB_WhateverSatisfiesTheLinesKeepsToItsOwnSideInTheTrueWorld) {
  const detail::DecisionRules r = rules();
  test::SeededRandom random(test::seed_of_run(71));
  std::size_t asked = 0, tight = 0, broken_at_one_normal = 0;
  for (int k = 0; k < 4000; ++k) {
    const World w = random_world(r, random);
    const std::vector<geometry::HalfPlane> lines = lines_of(r, w);
    const std::vector<geometry::HalfPlane> middle{lines[lines.size() / 2]};
    const Vec2 braked = r.braked(w.velocity);
    ASSERT_TRUE(satisfies(lines, braked)) << k;
    for (int direction = 0; direction < 8; ++direction) {
      const Vec2 towards = random.direction();
      const Vec2 u = farthest(lines, braked, towards);
      if (!satisfies(lines, u)) continue;
      ++asked;
      tight += norm(u - braked) < 0.9;
      ASSERT_TRUE(keeps_own_side(r, w, u)) << "world " << k << ", u " << u.x << ", " << u.y;
      broken_at_one_normal += !keeps_own_side(r, w, farthest(middle, braked, towards));
    }
  }
  EXPECT_GT(asked, 30000u);
  EXPECT_GT(tight, 5000u);
  EXPECT_GT(broken_at_one_normal, 1000u) << "one normal of the cone proves nothing";
}

/// Without errors the line is the bisector: half of what is between the ways is each robot's.
TEST(OwnSide, ExactDataGiveHalfOfTheRoom) {
  detail::DecisionRules r = rules();
  r.measurements = Measurements{};
  const World w{{0.0, 0.0}, {0.1, 0.0}, {1.0, 0.0}, {-0.1, 0.0}, {1.0, 0.0}, {-0.1, 0.0}, 0.0, 0.4};
  const double room = 1.0 - 2.0 * 0.45 * 0.1 - 0.4;
  const Vec2 u = farthest(lines_of(r, w), r.braked(w.velocity), {1.0, 0.0});
  EXPECT_NEAR(0.5 * u.x, 0.45 * 0.1 + 0.5 * room, 1e-6);
}

/// Where errors leave open on which side the other is, a robot only brakes; it is left a velocity all the same.
TEST(OwnSide, WithoutAnyKnowledgeOfTheSideARobotBrakes) {
  const detail::DecisionRules r = rules();
  const Measurements unknown{5.0, 1.0, 1.0};
  const Vec2 v{0.2, 0.1}, braked = r.braked(v);
  const detail::OwnSide side(r, {}, v, detail::foreseen_way(r, unknown, {1.0, 0.0}, {}, 1.0), 0.4);
  const std::vector<geometry::HalfPlane> lines(side.begin(), side.end());
  EXPECT_TRUE(satisfies(lines, braked));
  EXPECT_TRUE(satisfies(lines, 0.5 * braked));
  EXPECT_TRUE(satisfies(lines, {}));
  test::SeededRandom random(test::seed_of_run(72));
  for (int k = 0; k < 1000; ++k) {
    const Vec2 u = farthest(lines, random.uniform(0.0, 1.0) * braked, random.direction());
    const Segment way{{}, braked};
    EXPECT_LT(geometry::distance(way, u), 1e-9) << k;
  }
}

/// Also for fast robots with little room, whose numbers are rounded by more than the room of a slow one.
TEST(OwnSide, BrakingSatisfiesTheLinesOfRobotsOfAnySpeedInRationals) {
  test::SeededRandom random(test::seed_of_run(75));
  std::size_t asked = 0;
  for (const double speed : {0.001, 0.22, 3.0, 30.0, 300.0, 3000.0}) {
    detail::DecisionRules r = rules();
    r.acceleration = random.uniform(0.1, 10.0);
    r.braking_time = 1.1 * speed / r.acceleration + r.time_step;
    for (int k = 0; k < 500; ++k) {
      const Vec2 v = random.uniform(0.0, speed) * random.direction(), braked = r.braked(v);
      const detail::ForeseenWay other{way_of(r, random.uniform(0.5, 2.0) * random.direction(), v), 0.1};
      const detail::OwnSide side(r, {}, v, other, 1.5);
      for (const geometry::HalfPlane& h : side) {
        const Rational room = dot(exactly(h.normal), exactly(braked)) - Rational(h.offset);
        ASSERT_GT(room, Rational(0x1p-50) * Rational(norm(braked))) << "a double beside it; " << speed << " m/s, " << k;
        ++asked;
      }
    }
  }
  EXPECT_GT(asked, 6000u);
}

/// As slow ones do: nothing is relaxed, and the audit proves it.
TEST(OwnSide, RobotsOf300MetresASecondKeepToTheirSides) {
  Scenario s;
  for (int i = 0; i < 4; ++i) {
    Robot robot;
    robot.id = "R" + std::to_string(i + 1);
    robot.position = 8000.0 * heading_vector(17.0 + 90.0 * i);
    robot.goals = {-robot.position};
    robot.radius = 5.0;
    robot.max_speed = 300.0;
    s.robots.push_back(robot);
  }
  s.time_limit = 40.0;
  s.horizons.most = s.horizons.orca = s.horizons.robots = 36.0;
  s.acceleration = Acceleration{10.0};
  s.uncertainty = Uncertainty{0.0, Measurements{0.02, 0.05, 0.1}};
  const datasets::RecordingFile file = recorded(s);
  EXPECT_EQ(relaxed_in(file.recording), 0u);
  const AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "open" : report.findings.front());
  EXPECT_GT(report[AuditPoint::half_planes].proven, 1000u);
}

struct BoundsCase {
  Measurements bounds;
  const char* name;
};
class MeasuredRun : public testing::TestWithParam<BoundsCase> {};

TEST_P(MeasuredRun, BurgersArriveWithoutARelaxedDecision) {
  const datasets::RecordingFile file = recorded(measured_circle(GetParam().bounds));
  const AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "open" : report.findings.front());
  EXPECT_TRUE(report.has_measurements);
  EXPECT_GT(report[AuditPoint::braking].proven, 20u * file.recording.steps.size());
  EXPECT_EQ(relaxed_in(file.recording), 0u);
  EXPECT_THAT(file.recording.outcome, HasSubstr("all robots arrived"));
  EXPECT_THAT(file.recording.outcome, HasSubstr("assumed: robots measure others"));
  RecordProperty("last", std::to_string(last_arrival(file)));
}
INSTANTIATE_TEST_SUITE_P(, MeasuredRun,
                         testing::Values(BoundsCase{{0.0, 0.0, 0.0}, "Exact"}, BoundsCase{{0.02, 0.05, 0.1}, "Usual"},
                                         BoundsCase{{0.05, 0.1, 0.1}, "Poor"}),
                         [](const auto& param) { return param.param.name; });

TEST(MeasuredAudit, RefusesMeasurementsBeyondTheBoundsAndChoicesBeyondTheSide) {
  Scenario s = measured_circle({0.02, 0.05, 0.1}, 4);
  s.time_limit = 8.0;
  const datasets::RecordingFile file = recorded(s);
  ASSERT_TRUE(datasets::audit(file).clean());
  test::SeededRandom random(test::seed_of_run(73));
  std::size_t edits = 0;
  for (int k = 0; k < 60; ++k) {
    datasets::RecordingFile forged = file;
    const auto row = static_cast<std::size_t>(random.integer(20, static_cast<int>(file.recording.steps.size()) - 2));
    RobotStep& robot = forged.recording.steps[row].robots[static_cast<std::size_t>(random.integer(0, 3))];
    if (robot.measured.empty()) continue;
    MeasuredRobot& m = robot.measured.front();
    if (k % 4 == 0) m.position += 0.041 * random.direction();
    if (k % 4 == 1) m.velocity += 0.101 * random.direction();
    if (k % 4 == 2) m.age += 0.05;
    if (k % 4 == 3) m.robot = 7;
    ++edits;
    EXPECT_GT(datasets::audit(forged)[AuditPoint::braking].refuted, 0u) << "edit " << k;
  }
  EXPECT_GT(edits, 50u);
  std::size_t lines = 0;
  for (std::size_t row = 20; row < 60; row += 8)
    for (std::size_t k = 0; k < file.recording.steps[row].robots[0].constraints.size(); ++k, ++lines) {
      datasets::RecordingFile forged = file;
      forged.recording.steps[row].robots[0].constraints[k].time_horizon += 0.1;
      EXPECT_GT(datasets::audit(forged)[AuditPoint::half_planes].refuted, 0u) << row << ", line " << k;
    }
  EXPECT_GT(lines, 3u);
  // The half-planes of pairs that tell each other where they are let a robot follow another: not here.
  datasets::RecordingFile told = file;
  Scenario others = s;
  others.uncertainty.reset();
  told = recorded(others);
  told.scenario.uncertainty = s.uncertainty;
  EXPECT_GT(datasets::audit(told)[AuditPoint::braking].refuted, 0u);
}

// --- Navigators ---

class MeasuredNavigators : public testing::TestWithParam<int> {};

/// On a circle, each by a navigator of its own that only measures the others, with errors as large as bounds say.
TEST_P(MeasuredNavigators, NeverMeet) {
  const Measurements bounds{0.02, 0.05, 0.0};
  const Scenario s = measured_circle(bounds, GetParam());
  std::vector<Navigator> navigators;
  std::vector<Vec2> at, velocity;
  std::vector<NavigatorState> states;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const DifferentialDrive& d = *s.robots[i].drive;
    navigators.emplace_back(navigator_setup(s, i), s.robots[i].goals);
    NavigatorState state;
    state.position = d.axle;
    state.wheels = {heading_vector(d.heading), {}};
    states.push_back(state);
  }
  test::SeededRandom random(test::seed_of_run(74));
  double least = 9.0;
  std::size_t relaxed = 0, recorded_measurements = 0;
  bool all_there = false;
  for (int row = 0; row < 1200 && !all_there; ++row) {
    std::vector<Vec2> places, speeds;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const DifferentialDrive& d = *s.robots[i].drive;
      places.push_back(states[i].position + d.reference * states[i].wheels.heading);
      speeds.push_back(row == 0 ? Vec2{} : detail::velocity_before(d, s.time_step, states[i].wheels));
    }
    all_there = true;
    for (std::size_t i = 0; i < states.size(); ++i) {
      std::vector<Neighbour> seen;
      for (std::size_t j = 0; j < states.size(); ++j) {
        if (j == i) continue;
        least = std::min(least, norm(places[i] - places[j]) - 2.0 * s.robots[i].radius);
        Neighbour n{j, places[j] + 0.0199 * random.direction(), speeds[j] + 0.0499 * random.direction(),
                    s.robots[j].radius, s.robots[j].max_speed};
        n.measured = bounds;
        seen.push_back(n);
      }
      const Decision& decision = navigators[i].decide(states[i], seen);
      relaxed += decision.status != lp::Status::optimal;
      recorded_measurements += navigators[i].recorded().measured.size();
      all_there = all_there && navigators[i].has_arrived();
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      const DifferentialDrive& d = *s.robots[i].drive;
      OnWheels& wheels = states[i].wheels;
      const detail::TwistOfStep twist =
          detail::twist_of(d, s.time_step, wheels.heading, navigators[i].recorded().chosen);
      const Vec2 place = places[i] + s.time_step * navigators[i].recorded().chosen;
      wheels = {detail::turned(wheels.heading, twist.turn), twist.wheels};
      states[i].position = place - d.reference * wheels.heading;
      states[i].time += s.time_step;
    }
  }
  EXPECT_TRUE(all_there);
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 0.1) << "they hardly met";
  EXPECT_EQ(relaxed, 0u);
  EXPECT_GT(recorded_measurements, 500u);
}

INSTANTIATE_TEST_SUITE_P(, MeasuredNavigators, testing::Values(2, 4));

TEST(MeasuredNavigator, BoundsThatCannotBeAreRefused) {
  NavigatorSetup setup;
  setup.max_speed = 0.2;
  setup.horizons.robots = 2.0;
  Neighbour n{1, {3.0, 0.0}, {}, 0.2, 0.2};
  n.measured = Measurements{0.02, 0.05, 0.1};
  Navigator jumps(setup, {{5.0, 0.0}});
  EXPECT_THROW(jumps.decide({0.0, {}, {}}, {n}), NavigatorError) << "no acceleration";
  setup.acceleration = 1.0;
  Navigator navigator(setup, {{5.0, 0.0}});
  EXPECT_NO_THROW(navigator.decide({0.0, {}, {}}, {n}));
  n.measured->age = -0.1;
  EXPECT_THROW(navigator.decide({0.0, {}, {}}, {n}), NavigatorError);
  n.measured->age = std::nan("");
  EXPECT_THROW(navigator.decide({0.0, {}, {}}, {n}), NavigatorError);
}

// --- Files ---

constexpr const char* kText = R"({"name": "measured", "acceleration": {"max": 0.5}, "braking_time": 0.5,
  "uncertainty": {"measurements": {"position": 0.02, "velocity": 0.05, "age": 0.1}}, "robots": [
  {"id": "R1", "position": [0, 0], "goal": [4, 0], "radius": 0.2, "max_speed": 0.2},
  {"id": "R2", "position": [4, 0.1], "goal": [0, 0.1], "radius": 0.2, "max_speed": 0.2}]})";

TEST(Measurements, ScenariosKeepThem) {
  const Scenario s = datasets::parse_scenario(kText, "measured.json", {});
  ASSERT_TRUE(measures_others(s));
  EXPECT_EQ(s.uncertainty->measurements->velocity, 0.05);
  EXPECT_EQ(tracking_error_of(s), 0.0);
  const std::string written = datasets::write_scenario(s);
  EXPECT_EQ(datasets::write_scenario(datasets::parse_scenario(written, "again.json", {})), written);
  EXPECT_THAT(assumed_words(s), HasSubstr("0.1 s ago at most, within 0.02 m and 0.05 m/s"));
}

TEST(Measurements, ARobotThatFollowsWithinTheWayOnWhichItBrakesIsRefused) {
  Scenario s = datasets::parse_scenario(kText, "measured.json", {});
  const double way = 0.2 * (braking_time_of(s) - s.time_step);
  for (Robot& robot : s.robots) robot.velocity = {0.2, 0.0};
  s.robots[1].position = {0.4 + 1.01 * way, 0.0};
  EXPECT_TRUE(validate(s).empty());
  s.robots[1].position = {0.4 + 0.99 * way, 0.0};
  const std::vector<ScenarioProblem> problems = validate(s);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/robots/0/velocity");
  EXPECT_THAT(problems[0].found, HasSubstr("meets robot 'R2' before it has braked"));
  s.uncertainty->measurements.reset();  // robots that brake alike may follow
  EXPECT_TRUE(validate(s).empty());
}

TEST(Measurements, RecordingsKeepThem) {
  Scenario s = measured_circle({0.02, 0.05, 0.1}, 4);
  s.time_limit = 3.0;
  const datasets::RecordingFile file = recorded(s);
  const std::string path = testing::TempDir() + "measured.jsonl";
  datasets::write_recording(path, file);
  const datasets::RecordingFile again = datasets::read_recording(path);
  ASSERT_EQ(again.recording.steps.size(), file.recording.steps.size());
  std::size_t compared = 0;
  for (std::size_t k = 0; k < file.recording.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      const auto &a = file.recording.steps[k].robots[i].measured, &b = again.recording.steps[k].robots[i].measured;
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t m = 0; m < a.size(); ++m, ++compared)
        EXPECT_TRUE(a[m].robot == b[m].robot && a[m].position == b[m].position && a[m].velocity == b[m].velocity &&
                    a[m].age == b[m].age);
    }
  EXPECT_GT(compared, 500u);
  EXPECT_TRUE(datasets::audit(again).clean());
}

TEST(Measurements, WrongValuesInAFileAreRefusedWithAPlace) {
  const auto refusal = [](const std::string& from, const std::string& to) {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    try {
      datasets::parse_scenario(text, "measured.json", {});
    } catch (const datasets::DataError& e) {
      return e.place() + ": " + e.expected();
    }
    return std::string("was read");
  };
  EXPECT_THAT(refusal("\"acceleration\": {\"max\": 0.5}, \"braking_time\": 0.5,", ""),
              testing::AllOf(HasSubstr("/uncertainty/measurements"), HasSubstr("/acceleration")));
  EXPECT_THAT(refusal("\"age\": 0.1", "\"age\": -0.1"), HasSubstr("/uncertainty/measurements/age"));
  EXPECT_THAT(refusal(", \"age\": 0.1", ""), HasSubstr("age"));
}

}  // namespace
}  // namespace exactvo::formation
