// SPDX-License-Identifier: GPL-3.0-or-later
// A recording proven again: clean as it was made, found out however it is tampered with.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "exactvo/datasets/audit.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::test {
namespace {

namespace fs = std::filesystem;
using datasets::AuditReport;
using datasets::RecordingFile;
using formation::ConstraintSource;

/// Two robots that pass each other and a wall.
RecordingFile recorded() {
  formation::Scenario scenario;
  scenario.name = "audit";
  formation::Robot a, b;
  a.id = "a";
  a.position = {0.0, 0.1};
  a.goals = {{8.0, 0.0}};
  b.id = "b";
  b.position = {8.0, -0.1};
  b.goals = {{0.0, 0.0}};
  scenario.robots = {a, b};
  scenario.obstacles = {{"wall", geometry::Polyline{{{4.0, 1.2}, {4.0, 4.0}}}}};
  scenario.time_limit = 20.0;
  formation::SimulationOptions options;
  options.record_all = true;
  RecordingFile file;
  file.scenario = scenario;
  file.info.scenario = scenario.name;
  file.info.method = "ivo";
  file.recording = formation::simulate(scenario, options);
  return file;
}

const RecordingFile& clean() {
  static const RecordingFile file = recorded();
  return file;
}

TEST(Audit, ARunIsProvenAgain) {
  const AuditReport report = audit(clean());
  EXPECT_TRUE(report.clean()) << datasets::to_json(report);
  EXPECT_GT(report.half_planes, 50u);
  EXPECT_EQ(report.steps, 2 * (clean().recording.steps.size() - 1));
}

TEST(Audit, AHalfPlaneThatCutsIntoItsVelocityObstacleIsUnsafe) {
  RecordingFile file = clean();
  std::size_t changed = 0;
  for (formation::Step& step : file.recording.steps) {
    for (formation::RobotStep& robot : step.robots) {
      for (formation::DecisionConstraint& c : robot.constraints) {
        if (c.source == ConstraintSource::robot || !c.certified) continue;
        c.half_plane.offset -= 1.0;
        ++changed;
      }
    }
  }
  EXPECT_GT(changed, 0u);
  EXPECT_EQ(audit(file).unsafe, changed) << "the skin kept between the rims is far thinner than 0.3 m";
}

TEST(Audit, AWayThroughTheWallIsACollision) {
  RecordingFile file = clean();
  const std::size_t middle = file.recording.steps.size() / 2;
  file.recording.steps[middle].robots[0].position = {3.4, 3.0};
  file.recording.steps[middle + 1].robots[0].position = {4.6, 3.0};
  EXPECT_GE(audit(file).collisions, 1u);
}

TEST(Audit, TouchingIsNoCollisionAndAnUlpNearerIs) {
  RecordingFile file = clean();
  file.recording.steps.resize(2);
  file.recording.steps[0].robots[1].position = file.recording.steps[1].robots[1].position = {40.0, 0.0};
  file.scenario.robots[0].radius = 0.5;
  for (formation::Step& step : file.recording.steps) step.robots[0].position = {3.5, 2.0};
  EXPECT_EQ(audit(file).collisions, 0u);
  file.recording.steps[1].robots[0].position.x = std::nextafter(3.5, 4.0);
  EXPECT_EQ(audit(file).collisions, 1u);
}

TEST(Audit, RobotsThatSwapPlacesMeetOnTheWay) {
  RecordingFile file = clean();
  file.recording.steps.resize(2);
  file.scenario.obstacles.clear();
  file.recording.steps[0].robots[0].position = file.recording.steps[1].robots[1].position = {0.0, 0.0};
  file.recording.steps[1].robots[0].position = file.recording.steps[0].robots[1].position = {9.0, 0.0};
  EXPECT_EQ(audit(file).collisions, 2u);
}

TEST(Audit, ARowThatIsMissingIsNoticed) {
  RecordingFile file = clean();
  file.recording.steps.erase(file.recording.steps.begin() + 5);
  EXPECT_GE(audit(file).inconsistencies, 1u);
}

TEST(Audit, PositionsThatAreNoneAreInconsistent) {
  RecordingFile file = clean();
  file.recording.steps[3].robots[0].position.x = std::nan("");
  EXPECT_FALSE(audit(file).clean());
}

class AuditOfAFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ =
        fs::temp_directory_path() /
        ("exactvo_audit_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".jsonl");
    write_recording(path_, clean());
  }
  void TearDown() override { fs::remove(path_); }

  std::string text() const {
    std::ostringstream out;
    out << std::ifstream(path_).rdbuf();
    return out.str();
  }
  void rewrite(const std::string& text) const { std::ofstream(path_) << text; }

  fs::path path_;
};

TEST_F(AuditOfAFile, AsItWasWrittenIsClean) {
  const AuditReport report = datasets::audit_recording(path_);
  EXPECT_TRUE(report.clean()) << datasets::to_json(report);
}

// A certified half-plane keeps more than an ulp beyond its bound: shifted by one, it still excludes every collision,
// and only the digest of the lines shows the change.
TEST_F(AuditOfAFile, TheDigestCatchesAHalfPlaneShiftedByAnUlp) {
  RecordingFile file = clean();
  for (formation::Step& step : file.recording.steps) {
    for (formation::RobotStep& robot : step.robots) {
      for (formation::DecisionConstraint& c : robot.constraints) {
        if (c.half_plane.offset == 0.0) continue;
        const std::string good = text();
        c.half_plane.offset = std::nextafter(c.half_plane.offset, -std::numeric_limits<double>::infinity());
        write_recording(path_, file);
        EXPECT_TRUE(datasets::audit_recording(path_).clean()) << "with a digest of its own";
        const std::string bad = text();
        const auto end_of = [](const std::string& text) { return text.rfind('\n', text.size() - 2) + 1; };
        rewrite(bad.substr(0, end_of(bad)) + good.substr(end_of(good)));
        const AuditReport report = datasets::audit_recording(path_);
        EXPECT_EQ(report[datasets::AuditPoint::scenario].refuted, 1u) << datasets::to_json(report);
        EXPECT_EQ(report[datasets::AuditPoint::half_planes].refuted, 0u);
        return;
      }
    }
  }
  FAIL() << "no half-plane to shift";
}

TEST_F(AuditOfAFile, ARemovedRowIsCaught) {
  const std::string good = text();
  const std::size_t begin = good.find("\n{\"row\"", good.size() / 2) + 1;
  const std::string without = good.substr(0, begin) + good.substr(good.find('\n', begin) + 1);
  rewrite(without);
  EXPECT_THROW(datasets::audit_recording(path_), datasets::DataError) << "the end counts the rows";
}

}  // namespace
}  // namespace exactvo::test
