// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that are only nearly where a run has them (docs/guide/uncertainty.md), and footprints of robots on wheels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/navigator.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/distance.h"
#include "support/seeded_random.h"
#include "wheels_scenes.h"

namespace exactvo::formation {
namespace {

using datasets::AuditPoint;
using datasets::AuditReport;
using testing::HasSubstr;
using namespace test_scenes;

constexpr double kTracking = 0.02;  // m

/// Four on wheels and two that move in any direction, among pillars.
Scenario mixed_scene() {
  Scenario s = burgers_on_circle(4, 1.5, false, 5, kTracking);
  add_pillars(s);
  for (const double side : {-1.0, 1.0}) {
    Robot r;
    r.id = side < 0.0 ? "west" : "east";
    r.position = {side * 2.2, 0.9};
    r.goals = {{-side * 2.2, 0.9}};
    r.max_speed = 0.3;
    keep_within_tube(r, 0.15, kTracking);
    s.robots.push_back(r);
  }
  s.acceleration = Acceleration{1.0};
  return s;
}

/// m: its body about where the run has it.
geometry::Disc body_at(const Robot& robot, const RobotStep& state) {
  if (!robot.drive) return {state.position, robot.body_radius};
  return {state.position - robot.drive->reference * state.wheels->heading, robot.drive->body_radius};
}

/// Worlds in which bodies are off by the whole tracking error: towards each other, towards an obstacle, anywhere.
TEST(Tube, BodiesOffByTheTrackingErrorTouchNothing) {
  const datasets::RecordingFile file = recorded(mixed_scene());
  const Scenario& s = file.scenario;
  EXPECT_THAT(file.recording.outcome, HasSubstr("all robots arrived"));
  test::SeededRandom random(test::seed_of_run(1));
  std::size_t pairs = 0, close = 0;
  for (const Step& row : file.recording.steps) {
    std::vector<geometry::Disc> bodies;
    for (std::size_t i = 0; i < s.robots.size(); ++i) bodies.push_back(body_at(s.robots[i], row.robots[i]));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = i + 1; j < bodies.size(); ++j, ++pairs) {
        const Vec2 apart = bodies[i].center - bodies[j].center;
        const Vec2 worst = kTracking / norm(apart) * apart;
        const double radii = bodies[i].radius + bodies[j].radius;
        const double gap = norm(bodies[i].center - worst - (bodies[j].center + worst)) - radii;
        EXPECT_GE(gap, -1e-12) << "t = " << row.time << ": " << s.robots[i].id << ", " << s.robots[j].id;
        close += gap < 0.1;
        const Vec2 any_i = kTracking * random.uniform(0.0, 1.0) * random.direction();
        const Vec2 any_j = kTracking * random.uniform(0.0, 1.0) * random.direction();
        EXPECT_GE(norm(bodies[i].center + any_i - bodies[j].center - any_j), radii);
      }
      for (const SceneObstacle& o : s.obstacles)
        EXPECT_GE(geometry::signed_distance(o.shape, bodies[i].center) - kTracking - bodies[i].radius, -1e-12)
            << "t = " << row.time << ": " << s.robots[i].id << ", " << o.id;
    }
  }
  EXPECT_GT(pairs, 1000u);
  EXPECT_GT(close, 10u) << "nothing came near";
}

TEST(Tube, TheAuditAsksForItAndSaysWhatIsAssumed) {
  const datasets::RecordingFile file = recorded(mixed_scene());
  const AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_TRUE(report.has_tube);
  EXPECT_THAT(datasets::not_audited(report), testing::Contains(HasSubstr("tracking error")));
  EXPECT_THAT(file.recording.outcome, HasSubstr("assumed: no body is farther than 0.02 m from where the run has it"));
  datasets::RecordingFile forged = file;
  forged.scenario.uncertainty->tracking += 1e-9;
  const AuditReport refuted = datasets::audit(forged);
  EXPECT_EQ(refuted[AuditPoint::scenario].refuted, 2u) << "of the robots that move in any direction";
  EXPECT_EQ(refuted[AuditPoint::kinematics].refuted, 4u) << "of those on wheels";
  const datasets::RecordingFile without = recorded(burgers_on_circle(1, 1.0, false));
  EXPECT_FALSE(datasets::audit(without).has_tube);
  EXPECT_EQ(assumed_words(without.scenario), "");
}

TEST(Tube, NavigatorsOfAScenarioAndTheirNeighboursHaveItsRadii) {
  const Scenario s = mixed_scene();
  std::size_t driven = 0;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const NavigatorSetup setup = navigator_setup(s, i);
    EXPECT_NO_THROW(Navigator(setup, s.robots[i].goals));
    if (!setup.drive) {
      EXPECT_EQ(setup.radius, s.robots[i].radius);
      continue;
    }
    ++driven;
    EXPECT_EQ(setup.drive->tracking, kTracking);
    const DifferentialDrive& drive = *s.robots[i].drive;
    const Neighbour seen = neighbour_on_wheels(i, drive, s.time_step, drive.axle, {heading_vector(drive.heading), {}});
    EXPECT_EQ(seen.radius, s.robots[i].radius);
    EXPECT_EQ(seen.position, s.robots[i].position);
  }
  EXPECT_EQ(driven, 4u);
}

/// Without it the same bodies come nearer than twice the error: the tube is what keeps them apart.
TEST(Tube, WithoutItBodiesComeNearer) {
  const auto least = [](const Scenario& s) {
    double gap = 1e9;
    for (const Step& row : recorded(s).recording.steps)
      for (std::size_t i = 0; i < s.robots.size(); ++i)
        for (std::size_t j = i + 1; j < s.robots.size(); ++j)
          gap = std::min(gap, norm(row.robots[i].position - row.robots[j].position) - 2.0 * 0.185);
    return gap;
  };
  EXPECT_LT(least(burgers_on_circle(8, 1.5, false)), 2.0 * 0.05);
  EXPECT_GE(least(burgers_on_circle(8, 1.5, false, 5, 0.05)), 2.0 * 0.05);
}

// --- Files ---

constexpr const char* kText = R"({"name": "tube", "uncertainty": {"tracking": 0.02}, "robots": [
  {"id": "R1", "position": [0, 0], "heading": 90, "goal": [0, 4],
   "footprint": {"polygon": [[-0.3, -0.2], [0.1, -0.2], [0.1, 0.2], [-0.3, 0.2]]},
   "kinematics": {"type": "differential", "wheel_separation": 0.3, "max_wheel_speed": 0.5, "max_wheel_acceleration": 2.0}},
  {"id": "R2", "position": [3, 0], "goal": [3, 4], "radius": 0.2, "max_speed": 0.3},
  {"circle": {"count": 3, "radius": 2, "centre": [20, 0]}, "radius": 0.25}]})";

TEST(Tube, ScenariosKeepTheRadiusOfTheBody) {
  const Scenario s = datasets::parse_scenario(kText, "tube.json", {});
  EXPECT_EQ(tracking_error_of(s), 0.02);
  EXPECT_EQ(s.robots[1].body_radius, 0.2);
  EXPECT_NEAR(s.robots[1].radius, 0.22, 1e-12);
  EXPECT_GE(s.robots[1].radius, 0.22);
  EXPECT_NEAR(s.robots[3].radius, 0.27, 1e-12);
  const std::string written = datasets::write_scenario(s);
  EXPECT_THAT(written, HasSubstr("\"tracking\": 0.02"));
  const Scenario again = datasets::parse_scenario(written, "again.json", {});
  EXPECT_EQ(datasets::write_scenario(again), written);
  for (std::size_t i = 0; i < s.robots.size(); ++i) EXPECT_EQ(again.robots[i].radius, s.robots[i].radius) << i;
  Scenario changed = s;
  changed.robots[1].radius = 0.2;
  EXPECT_EQ(validate(changed).front().pointer, "/robots/1/radius");
  changed = s;
  changed.robots[1].position = changed.robots[1].goals[0] = changed.robots[0].position;
  EXPECT_THAT(validate(changed).front().found, HasSubstr("with the tracking error of 0.02 m"));
  changed = s;
  changed.uncertainty->tracking = std::nan("");
  EXPECT_EQ(validate(changed).front().pointer, "/uncertainty/tracking");
}

/// The farthest corner from the reference point, [-0.3, 0.2] from [0.15, 0].
TEST(Footprint, TheDiscIsTheSmallestAboutTheReferencePoint) {
  const Scenario s = datasets::parse_scenario(kText, "tube.json", {});
  const double stray = stray_of(*s.robots[0].drive, s.time_step);
  EXPECT_NEAR(s.robots[0].radius, std::hypot(0.45, 0.2) + 0.02 + stray, 1e-12);
}

/// At every heading of a run; a corner farther out is refuted.
TEST(Footprint, ItsCornersStayInTheDisc) {
  Scenario s = datasets::parse_scenario(kText, "tube.json", {});
  s.robots[0].goals = {{-2.0, -1.0}};
  const datasets::RecordingFile file = recorded(s);
  const DifferentialDrive& d = *s.robots[0].drive;
  double farthest = 0.0;
  for (const Step& row : file.recording.steps) {
    const Vec2 e = row.robots[0].wheels->heading, axle = row.robots[0].position - d.reference * e;
    for (const Vec2 c : d.footprint)
      farthest = std::max(farthest, norm(axle + c.x * e + c.y * Vec2{-e.y, e.x} - row.robots[0].position));
  }
  EXPECT_LE(farthest + kTracking, s.robots[0].radius);
  EXPECT_GT(farthest + kTracking, s.robots[0].radius - 0.01);
  EXPECT_TRUE(datasets::audit(file).clean());
  datasets::RecordingFile forged = file;
  forged.scenario.robots[0].drive->footprint[3] = {-0.31, 0.2};
  EXPECT_EQ(datasets::audit(forged)[AuditPoint::kinematics].refuted, 2u) << "the disc, and the chain";
}

TEST(Footprint, WrongValuesInAFileAreRefusedWithACode) {
  using datasets::DataCode;
  const auto refusal = [](const std::string& from, const std::string& to) -> std::pair<DataCode, std::string> {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    try {
      datasets::parse_scenario(text, "tube.json", {});
    } catch (const datasets::DataError& e) {
      return {e.code(), e.place() + ": " + e.expected()};
    }
    return {DataCode::cut_off, "was read"};
  };
  const auto [beside, words] =
      refusal("[-0.3, -0.2], [0.1, -0.2], [0.1, 0.2], [-0.3, 0.2]", "[0.1, -0.2], [0.4, -0.2], [0.4, 0.2], [0.1, 0.2]");
  EXPECT_EQ(beside, DataCode::scenario);
  EXPECT_THAT(words, testing::AllOf(HasSubstr("/robots/0/footprint/polygon/3: "), HasSubstr("the centre of the axle")));
  EXPECT_THAT(refusal("[0.1, 0.2], [-0.3, 0.2]", "[-0.3, 0.2], [0.1, 0.2]").second,
              testing::AllOf(HasSubstr("/robots/0/footprint/polygon/1: "), HasSubstr("do not cross")));
  EXPECT_EQ(refusal("[0.1, -0.2], [0.1, 0.2], [-0.3, 0.2]", "[0.1, -0.2]").first, DataCode::wrong_count);
  EXPECT_THAT(refusal("\"goal\": [0, 4]", "\"goal\": [0, 4], \"radius\": 0.4").second, HasSubstr("footprint alone"));
  EXPECT_EQ(
      refusal("\"goal\": [3, 4]", "\"goal\": [3, 4], \"footprint\": {\"polygon\": [[-1, -1], [1, 0], [0, 1]]}").first,
      DataCode::scenario);
  EXPECT_EQ(refusal("\"tracking\": 0.02", "\"tracking\": -0.02").first, DataCode::out_of_range);
  EXPECT_EQ(refusal("\"tracking\": 0.02", "\"trackng\": 0.02").first, DataCode::key_unknown);
  EXPECT_THAT(refusal("\"max_wheel_speed\": 0.5", "\"max_wheel_sped\": 0.5").second, HasSubstr("did you mean"));
}

}  // namespace
}  // namespace exactvo::formation
