// SPDX-License-Identifier: GPL-3.0-or-later
// A run that is measured and written row by row is the run that is kept whole and measured at its end.
#include "support/run_recorder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "run_program.h"

namespace exactvo::tools {
namespace {

namespace fs = std::filesystem;
using datasets::RecordingFile;
using formation::Step;

std::string content_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

RecordingFile about(const formation::Scenario& scenario) {
  RecordingFile file;
  file.scenario = scenario;
  file.info = {scenario.name, "ivo", std::nullopt, std::nullopt, {}};
  return file;
}

/// The files of a run by both ways. The recordings' last lines hold wall times, and digests of what is above them.
void expect_same(const std::string& scenario_file) {
  const formation::Scenario scenario = datasets::load_scenario(EXACTVO_SOURCE_DIR "/datasets/data/" + scenario_file);
  const test::Workplace here;
  RunRecorder recorder(about(scenario), {here.path()});
  RecordingFile shown;
  formation::Recording end = simulate(scenario, {}, recorder);
  EXPECT_TRUE(end.steps.empty());
  formation::Metrics metrics = recorder.finish(std::move(end), shown);

  RecordingFile whole = about(scenario);
  whole.recording = formation::simulate(scenario);
  formation::Evaluation found = evaluate(scenario, whole.recording);
  whole.lyapunov = found.lyapunov;
  whole.stuck = found.stuck;
  whole.collisions = found.metrics.collisions;
  whole.outcome = found.metrics.outcome;
  whole.recording.wall_time = metrics.wall_time = found.metrics.wall_time = 0.0;
  write_recording(here.path() / "whole.jsonl", whole);

  EXPECT_EQ(datasets::metrics_json(whole.info, metrics), datasets::metrics_json(whole.info, found.metrics));
  const auto before_end = [](std::string text) { return text.erase(text.rfind("{\"end\"")); };
  EXPECT_EQ(before_end(content_of(here.path() / "recording.jsonl")),
            before_end(content_of(here.path() / "whole.jsonl")))
      << scenario_file;
  const RecordingFile again = datasets::read_recording(here.path() / "recording.jsonl");
  EXPECT_EQ(again.outcome, whole.outcome);
  EXPECT_EQ(again.stuck.size(), whole.stuck.size());
  EXPECT_EQ(shown.recording.steps.size(), whole.recording.steps.size());
  EXPECT_EQ(shown.lyapunov.size(), whole.lyapunov.size());
  ASSERT_TRUE(fs::exists(here.path() / "trajectory.csv"));
  EXPECT_EQ(fs::exists(here.path() / "lyapunov.csv"), scenario.formation.has_value());
}

TEST(RunRecorder, WritesTheRunThatIsKeptWhole) {
  expect_same("paper/A9.json");   // several goals and robots
  expect_same("paper/A14.json");  // stuck or turning round a trap
}
TEST(RunRecorder, WritesTheFormationThatIsKeptWhole) {
  expect_same("paper/B3.json");
}

Step row(std::size_t k, std::size_t robots) {
  Step step;
  step.time = static_cast<double>(k);
  step.robots.resize(robots);
  step.robots[0].constraints.resize(1);
  return step;
}

TEST(ShownRows, OfAShortRunAreAll) {
  ShownRows shown;
  for (std::size_t k = 0; k < 1000; ++k) shown.add(row(k, 3), nullptr);
  RecordingFile file;
  shown.move_to(file);
  ASSERT_EQ(file.recording.steps.size(), 1000u);
  for (std::size_t k = 0; k < 1000; ++k) EXPECT_EQ(file.recording.steps[k].time, static_cast<double>(k));
  EXPECT_TRUE(file.recording.steps[0].robots[0].constraints.empty());
}

TEST(ShownRows, OfALongRunAreEvenlySpacedAndEndWithTheLast) {
  constexpr std::size_t kRobots = 5000, kMost = ShownRows::kMostStates / kRobots;
  for (const std::size_t rows : {kMost, kMost + 1, 3 * kMost, 10 * kMost + 7}) {
    ShownRows shown;
    for (std::size_t k = 0; k < rows; ++k) {
      formation::LyapunovRow values;
      values.time = static_cast<double>(k);
      shown.add(row(k, kRobots), &values);
    }
    RecordingFile file;
    shown.move_to(file);
    const std::vector<Step>& kept = file.recording.steps;
    ASSERT_LE(kept.size(), kMost) << rows;
    ASSERT_GE(kept.size(), kMost / 3) << rows;
    EXPECT_EQ(kept.back().time, static_cast<double>(rows - 1));
    for (std::size_t k = 1; k + 1 < kept.size(); ++k) EXPECT_EQ(kept[k].time, static_cast<double>(k) * kept[1].time);
    ASSERT_EQ(file.lyapunov.size(), kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) EXPECT_EQ(file.lyapunov[k].time, kept[k].time);
  }
}

}  // namespace
}  // namespace exactvo::tools
