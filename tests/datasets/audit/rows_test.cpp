// SPDX-License-Identifier: GPL-3.0-or-later
// The audit of a file or a pipe reads it once, row by row: it finds what the audit of the whole recording in memory
// finds.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "audit/edits.h"
#include "exactvo/datasets/audit.h"
#include "recordings/audit_rows.h"

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;

class AuditRowByRow : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }

  const fs::path path_ = fs::temp_directory_path() / ("exactvo_rows_" + std::to_string(getpid()) + ".jsonl");
};

/// But for the seal, which only a file has.
std::string told(AuditReport report, bool has_seal) {
  report[AuditPoint::scenario].proven -= has_seal ? 1 : 0;
  return to_json(report);
}

TEST_F(AuditRowByRow, FindsWhatTheAuditOfAllRowsFinds) {
  const std::uint64_t seed = exactvo::test::seed_of_run(97);
  const std::vector<ShortRun> runs = short_runs();
  std::size_t refuted = 0;
  for (std::size_t n = 0; n < 300; ++n) {
    exactvo::test::SeededRandom random(seed * 1000003 + n);
    const ShortRun& run = runs[n % runs.size()];
    Lines lines = run.lines;
    const Edit done = edit(lines, random);
    const std::string text = sealed(lines);
    write(text);
    try {
      const AuditReport whole = audit(parse_recording(text, "text"), &run.scenario);
      const AuditReport by_rows = audit_recording(path_, &run.scenario);
      EXPECT_EQ(told(by_rows, true), told(whole, false)) << run.name << ": " << done.field << " " << done.place;
      refuted += whole.clean() ? 0 : 1;
    } catch (const DataError& refused) {
      EXPECT_THROW(audit_recording(path_, &run.scenario), DataError) << refused.what();
    }
  }
  EXPECT_GT(refuted, 50u) << "else little was compared";
}

TEST_F(AuditRowByRow, FindsInAPipeWhatItFindsInAFile) {
  for (const ShortRun& run : short_runs()) {
    write(sealed(run.lines));
    const std::string of_file = to_json(audit_recording(path_, &run.scenario));
    const fs::path pipe = path_.string() + ".pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { write_recording(pipe, read_recording(path_)); });
    EXPECT_EQ(to_json(audit_recording(pipe, &run.scenario)), of_file) << run.name;
    writer.join();
    EXPECT_TRUE(fs::is_fifo(pipe)) << "no file takes its place";
    fs::remove(pipe);
  }
}

formation::Step row_at(double x) {
  formation::Step row;
  for (const double y : {0.0, 5.0}) row.robots.emplace_back().anchor = {x, y};
  return row;
}

TEST(PlacesInRows, KnowsTheLastOfTheRowsThatHavePassed) {
  RecordingFile run;
  run.recording.time_step = 0.5;
  run.scenario.robots.resize(2);
  run.recording.outlooks = {{1.0, 0, 0, {}}, {1.25, 0, 0, {}}};  // of row 2, and of none
  PlacesInRows places(run, 6);                                   // three rows of two robots
  const auto plan = [&](std::size_t from_row) { run.recording.plans.push_back({5, from_row, {0, 1}, {}, {}}); };
  for (std::size_t k = 0; k < 8; ++k) {
    if (k == 5)
      for (const std::size_t from : {2, 3, 4, 5}) plan(from);
    places.take(row_at(static_cast<double>(k)));
  }
  const std::vector<formation::JointPlan>& plans = run.recording.plans;
  EXPECT_TRUE(places.is_forgotten(plans[0], 1)) << "rows 3 to 5 were known when it came up";
  EXPECT_EQ(places.at_begin(plans[0], 1), nullptr);
  for (std::size_t k = 1; k < plans.size(); ++k) {
    EXPECT_FALSE(places.is_forgotten(plans[k], 1));
    ASSERT_NE(places.at_begin(plans[k], 1), nullptr) << plans[k].from_row;
    EXPECT_EQ(*places.at_begin(plans[k], 1), (geometry::Vec2{static_cast<double>(plans[k].from_row), 5.0}));
  }
  ASSERT_NE(places.at_begin(run.recording.outlooks[0]), nullptr);
  EXPECT_EQ(*places.at_begin(run.recording.outlooks[0]), (geometry::Vec2{2.0, 0.0}));
  EXPECT_EQ(places.at_begin(run.recording.outlooks[1]), nullptr);
}

}  // namespace
}  // namespace exactvo::datasets::test
