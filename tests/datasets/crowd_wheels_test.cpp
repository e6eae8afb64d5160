// SPDX-License-Identifier: GPL-3.0-or-later
// Scenarios of robots on wheels on a crowd: what is recorded of them, and what the audit proves of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "refusal.h"
#include "support/forged_crowd.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::fnv1a;
using exactvo::test::in_bytes;
using formation::RunReport;
using formation::Scenario;
using formation::SimulationOptions;

/// Burgers on a square, each to the place opposite of its own, one that goes straight ahead far from them, and a robot
/// that moves in any direction.
constexpr std::size_t kOnWheels = 17;
Scenario burgers(const std::string& more = "", const std::string& keys = "") {
  std::string robots;
  const auto add = [&](const std::string& id, double x, double y, double goal_x, double goal_y, int heading) {
    robots += R"({"id": ")" + id + R"(", "position": [)" + std::to_string(x) + ", " + std::to_string(y) +
              R"(], "goal": [)" + std::to_string(goal_x) + ", " + std::to_string(goal_y) + R"(], "heading": )" +
              std::to_string(heading) + R"(, "radius": 0.105, "kinematics": {"type": "differential",
              "wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1)" +
              more + "}}, ";
  };
  for (int k = 0; k < 16; ++k) {
    const double x = 1.2 * (k % 4), y = 1.2 * (k / 4);
    add("B" + std::to_string(k), x, y, 3.7 - x, 3.65 - y, 25 * k);
  }
  add("L", 0.0, 20.0, 2.9544, 20.5209, 10);
  return parse_scenario(R"({"name": "burgers", "guidance": "none", "time_step": 0.25, "time_limit": 150,
      "arrival_tolerance": 0.05, "horizons": {"least": 0.5, "orca": 3}, )" +
                            keys + R"("robots": [)" + robots + R"({"id": "O", "position": [-1, 1.7], "goal": [5, 1.7],
      "radius": 0.15, "max_speed": 0.3}], "obstacles": [{"polyline": [[-1, -0.5], [5, -0.5]]}]})",
                        "burgers.json", {});
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The first of these numbers in the bytes becomes the other.
void replace(std::string& bytes, double was, double is) {
  const std::size_t at = bytes.find(in_bytes(was));
  ASSERT_NE(at, std::string::npos) << was;
  bytes.replace(at, sizeof is, in_bytes(is));
}

/// With another head, and checksums that fit.
std::string with_head(const std::string& whole, const std::function<void(std::string&)>& edit) {
  constexpr std::size_t kMark = 8, kPrefix = 16;
  std::string head = whole.substr(kMark + kPrefix, number_at<std::uint64_t>(whole, kMark));
  std::size_t at = kMark + kPrefix + head.size();
  edit(head);
  std::string out = whole.substr(0, kMark) + in_bytes<std::uint64_t>(head.size()) + in_bytes(fnv1a(head)) + head;
  std::uint64_t sum = fnv1a(head);
  while (whole[at] == 'R') {
    const auto size = number_at<std::uint64_t>(whole, at + 1);
    out += whole.substr(at, 1 + kPrefix + size);
    sum = fnv1a(in_bytes(sum) + in_bytes(number_at<std::uint64_t>(whole, at + 9)));
    at += 1 + kPrefix + size;
  }
  const std::string seal = whole.substr(at + 1 + kPrefix, 8) + in_bytes(sum);
  return out + "E" + in_bytes<std::uint64_t>(seal.size()) + in_bytes(fnv1a(seal)) + seal;
}

class CrowdsOnWheels : public TemporaryFolder {
 protected:
  RunReport record(const Scenario& scenario, std::uint32_t every = 1) {
    CrowdRecorder recorder(folder_ / "c.evr", scenario, every);
    const RunReport report = run_crowd(scenario, {}, &recorder);
    recorder.finish();
    return report;
  }
  /// The audit of the recording with an edited head.
  AuditReport audit_with(const std::function<void(std::string&)>& edit) {
    std::ofstream(folder_ / "d.evr", std::ios::binary) << with_head(bytes_of(folder_ / "c.evr"), edit);
    return audit_recording(folder_ / "d.evr");
  }
  static std::size_t found(const AuditReport& audit, const std::string& words) {
    std::size_t count = 0;
    for (const std::string& finding : audit.findings) count += finding.find(words) != std::string::npos;
    return count;
  }
};

TEST_F(CrowdsOnWheels, ArriveAndTheAuditProvesWhatTheyDrove) {
  const Scenario scenario = burgers();
  ASSERT_TRUE(formation::crowd_problems(scenario).empty());
  const RunReport report = record(scenario);
  EXPECT_EQ(report.arrived, kOnWheels + 1) << report.steps << " steps";
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_TRUE(audit.clean());
  EXPECT_EQ(audit[AuditPoint::kinematics].refuted + audit[AuditPoint::kinematics].open, 0U);
  EXPECT_EQ(audit[AuditPoint::kinematics].proven, 1 + 2 * kOnWheels * report.steps)
      << "speeds and changes of both wheels";
  EXPECT_GT(audit.robot_questions, 0U);
}

TEST_F(CrowdsOnWheels, WhatIsReadIsWhatWasWritten) {
  const Scenario scenario = burgers(R"(, "max_angular_speed": 2, "max_backward_speed": 0.1, "reference": 0.07)");
  record(scenario);
  EXPECT_EQ(bytes_of(folder_ / "c.evr").substr(0, 8), "EXACTVR5");
  CrowdRecordingReader reader(folder_ / "c.evr");
  const CrowdRecordingHead& head = reader.head();
  ASSERT_EQ(head.half_headings.size(), kOnWheels + 1);
  EXPECT_EQ(head.half_headings[0], (geometry::Vec2{1.0, 0.0}));
  EXPECT_EQ(head.half_headings[3], formation::half_heading_of(75.0));
  ASSERT_EQ(head.kinds.size(), 2U);
  ASSERT_TRUE(head.kinds[0].wheels);
  EXPECT_FALSE(head.kinds[1].wheels);
  const formation::CrowdWheels& w = *head.kinds[0].wheels;
  EXPECT_EQ((std::vector<double>{w.reference, w.wheel_separation, w.max_wheel_acceleration, w.max_angular_speed,
                                 w.max_backward_speed}),
            (std::vector<double>{0.07, 0.16, 1.0, 2.0, 0.1}));
  EXPECT_EQ(head.kinds[0].body_radius, 0.105);
  EXPECT_EQ(head.kinds[1].body_radius, 0.15);
  EXPECT_EQ(head.tracking, 0.0);
  EXPECT_EQ(head.ids.back(), "O");
  EXPECT_TRUE(audit_recording(folder_ / "c.evr").clean());
}

TEST_F(CrowdsOnWheels, TheAuditRefutesOtherHeadingsLimitsAndRadii) {
  record(burgers());
  EXPECT_TRUE(audit_with([](std::string&) {}).clean());
  const geometry::Vec2 ahead = formation::half_heading_of(10.0), aside = formation::half_heading_of(100.0);
  const AuditReport turned = audit_with([&](std::string& head) {
    const std::size_t at = head.find(in_bytes(ahead.x) + in_bytes(ahead.y));
    ASSERT_NE(at, std::string::npos);
    head.replace(at, 2 * sizeof(double), in_bytes(aside.x) + in_bytes(aside.y));
  });
  EXPECT_GT(found(turned, "L runs a wheel faster than it may"), 0U);
  const AuditReport slower = audit_with([](std::string& head) { replace(head, 0.22, 0.2); });
  EXPECT_GT(found(slower, "runs a wheel faster than it may"), 0U);
  const AuditReport softer = audit_with([](std::string& head) { replace(head, 1.0 * 0.16, 0.3); });
  EXPECT_FALSE(softer.clean()) << "wheels farther apart run faster";
  const double radius = burgers().robots[0].radius;
  const AuditReport smaller = audit_with([&](std::string& head) { replace(head, radius, 0.004); });
  EXPECT_EQ(found(smaller, "have no room for body, tracking error and the arc of a step"), 1U);
  EXPECT_FALSE(audit_with([](std::string& head) { replace(head, 0.105, 0.105 + 1e-9); }).clean()) << "a larger body";
}

constexpr const char* kTube = R"("uncertainty": {"tracking": 0.02}, )";

TEST_F(CrowdsOnWheels, DiscsHoldBodiesAndTheTrackingErrorThatTheRecordingNames) {
  record(burgers("", kTube));
  {
    CrowdRecordingReader reader(folder_ / "c.evr");
    EXPECT_EQ(reader.head().tracking, 0.02);
    const Scenario scene = scene_of(reader.head()).scenario;
    EXPECT_EQ(tracking_error_of(scene), 0.02);
    EXPECT_EQ(scene.robots.back().body_radius, 0.15);
  }
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_TRUE(audit.clean());
  EXPECT_THAT(not_audited(audit), testing::Contains(testing::HasSubstr("up to the tracking error")));
  const AuditReport farther = audit_with([](std::string& head) { replace(head, 0.02, 0.02 + 1e-9); });
  EXPECT_EQ(found(farther, "kind 0 have no room for body, tracking error and the arc of a step"), 1U);
  EXPECT_EQ(found(farther, "kind 1 have no room for body and tracking error"), 1U);
  EXPECT_FALSE(audit_with([](std::string& head) { replace(head, 0.15, 0.15 + 1e-9); }).clean()) << "a larger body";
}

TEST_F(CrowdsOnWheels, ATrackingErrorIsRecordedOfRobotsWithoutWheelsToo) {
  Scenario scenario = burgers("", kTube);
  scenario.robots.erase(scenario.robots.begin(), scenario.robots.end() - 1);
  record(scenario);
  EXPECT_EQ(bytes_of(folder_ / "c.evr").substr(0, 8), "EXACTVR5");
  CrowdRecordingReader reader(folder_ / "c.evr");
  EXPECT_TRUE(reader.head().half_headings.empty());
  EXPECT_EQ(reader.head().name_of(0), "O");
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_TRUE(audit.clean());
  EXPECT_EQ(audit[AuditPoint::kinematics].proven, 1U);
  const AuditReport farther = audit_with([](std::string& head) { replace(head, 0.02, 0.03); });
  EXPECT_EQ(farther[AuditPoint::kinematics].refuted, 1U);
}

/// Without the tracking error, the radii of bodies and the ids of obstacles.
TEST_F(CrowdsOnWheels, RecordingsOfTheVersionBeforeAreRead) {
  const RunReport report = record(burgers());
  const std::string was = with_head(bytes_of(folder_ / "c.evr"), [](std::string& head) {
    const std::size_t kinds = 2, bodies = head.find(in_bytes(0.0) + in_bytes(0.105));
    ASSERT_NE(bodies, std::string::npos);
    head.erase(bodies, sizeof(double));
    for (std::size_t k = 0, at = bodies; k < kinds; ++k, at += 1 + 5 * sizeof(double)) head.erase(at, sizeof(double));
    const std::string one = in_bytes(std::uint32_t{1});
    head.erase(head.rfind(one + one));  // an obstacle, of an edge
  });
  std::ofstream(folder_ / "d.evr", std::ios::binary) << "EXACTVR4" << was.substr(8);
  CrowdRecordingReader reader(folder_ / "d.evr");
  EXPECT_EQ(reader.head().kinds.at(0).body_radius, 0.0);
  EXPECT_EQ(reader.head().half_headings.at(3), formation::half_heading_of(75.0));
  EXPECT_EQ(reader.head().ids.back(), "O");
  const AuditReport audit = audit_recording(folder_ / "d.evr");
  EXPECT_TRUE(audit.clean());
  EXPECT_EQ(audit[AuditPoint::kinematics].proven, 1 + 2 * kOnWheels * report.steps);
}

TEST_F(CrowdsOnWheels, TheAuditRefutesWheelsThatChangeTheirSpeedTooMuch) {
  Scenario scenario = burgers();
  CrowdRecorder recorder(folder_ / "c.evr", scenario, 1);
  for (formation::Robot& robot : scenario.robots)
    if (robot.drive) robot.drive->max_wheel_acceleration = 1e6;
  run_crowd(scenario, {}, &recorder);
  recorder.finish();
  EXPECT_TRUE(audit_recording(folder_ / "c.evr").clean());
  const AuditReport audit = audit_with([](std::string& head) { replace(head, 1e6, 0.88); });
  EXPECT_GT(found(audit, "changes the speed of a wheel by more than it may"), 0U);
}

TEST_F(CrowdsOnWheels, WhereRowsAreSeveralStepsApartWheelsAreLeftOpen) {
  record(burgers(), 5);
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_EQ(audit[AuditPoint::kinematics].open, kOnWheels);
  EXPECT_EQ(audit[AuditPoint::kinematics].refuted, 0U);
  EXPECT_EQ(found(audit, "its twists are not known"), kOnWheels);
}

TEST_F(CrowdsOnWheels, ASampledAuditFollowsSomeRobotsThroughAllTheirSteps) {
  const RunReport report = record(burgers());
  const AuditReport audit = audit_recording(folder_ / "c.evr", nullptr, (kOnWheels + 1) * report.steps / 3);
  const std::size_t asked = audit[AuditPoint::kinematics].proven - 1;
  EXPECT_TRUE(audit.clean());
  EXPECT_EQ(asked % (2 * report.steps), 0U);
  EXPECT_GT(asked, 0U);
  EXPECT_LT(asked, 2 * kOnWheels * report.steps);
}

TEST_F(CrowdsOnWheels, GoOnFromASnapshotToTheSameBytes) {
  const Scenario scenario = burgers();
  const RunReport whole = record(scenario);
  struct Killed {};
  std::string snapshot;
  SimulationOptions options;
  options.snapshot_every = 20;
  options.keep_snapshot = [&](const std::string& bytes) {
    if (!snapshot.empty()) throw Killed();
    snapshot = bytes;
  };
  {
    CrowdRecorder recorder(folder_ / "d.evr", scenario, 1, Unfinished::stays);
    EXPECT_THROW(run_crowd(scenario, options, &recorder), Killed);
  }
  options = {};
  options.resume_from = snapshot;
  CrowdRecorder recorder(folder_ / "d.evr", scenario, 1, Unfinished::stays);
  const RunReport report = run_crowd(scenario, options, &recorder);
  recorder.finish();
  EXPECT_EQ(report.digest, whole.digest);
  EXPECT_TRUE(bytes_of(folder_ / "d.evr") == bytes_of(folder_ / "c.evr"));
}

TEST_F(CrowdsOnWheels, DamagedHeadsAreRefused) {
  record(burgers());
  const auto refused = [&](const std::function<void(std::string&)>& edit) {
    std::ofstream(folder_ / "d.evr", std::ios::binary) << with_head(bytes_of(folder_ / "c.evr"), edit);
    EXPECT_EQ(refusal_of([&] { CrowdRecordingReader reader(folder_ / "d.evr"); }).code(), DataCode::format_syntax);
  };
  refused([](std::string& head) { replace(head, 0.16, -0.16); });
  refused([](std::string& head) { replace(head, 0.08, 0.001); });
  refused([](std::string& head) { replace(head, 0.105, -0.105); });
  refused([](std::string& head) { replace(head, formation::half_heading_of(75.0).x, 7.0); });
  refused([](std::string& head) { replace(head, 1.0, std::nan("")); });
  refused([](std::string& head) { head.pop_back(); });
  refused([](std::string& head) {  // behind the last heading: whether ids follow
    const geometry::Vec2 last = formation::half_heading_of(10.0);
    const std::size_t at = head.find(in_bytes(last.x) + in_bytes(last.y)) + 2 * sizeof(double);
    ASSERT_EQ(head.at(at), 1);
    head[at] = 2;
  });
}

TEST_F(CrowdsOnWheels, ScenariosWhoseRobotsCannotStopInAStepAreRefused) {
  const auto pointer = [](const Scenario& s) { return formation::crowd_problems(s).at(0).pointer; };
  Scenario scenario = burgers();
  scenario.robots[2].drive->max_wheel_acceleration = 0.8;
  EXPECT_EQ(pointer(scenario), "/robots/2/kinematics/max_wheel_acceleration");
  EXPECT_NE(formation::crowd_problems(scenario)[0].expected.find("a time_step of at least 0.275 s"), std::string::npos);
  scenario = burgers();
  scenario.robots[1].drive->reference = 0.05;
  EXPECT_EQ(pointer(scenario), "/robots/1/kinematics/reference");
  scenario = burgers();
  scenario.robots[0].drive->footprint = {{0.1, 0.1}, {-0.1, 0.1}, {-0.1, -0.1}};
  EXPECT_EQ(pointer(scenario), "/robots/0/footprint");
}

}  // namespace
}  // namespace exactvo::datasets::test
