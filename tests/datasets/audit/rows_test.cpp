// SPDX-License-Identifier: GPL-3.0-or-later
// The audit of a file reads it row by row, twice: it finds what the audit of the whole recording in memory finds.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "audit/edits.h"
#include "exactvo/datasets/audit.h"
#include "recordings/recording_lines.h"

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

TEST_F(AuditRowByRow, RefusesAFileThatChangesBetweenItsTwoReadings) {
  const std::vector<ShortRun> runs = short_runs();
  const TakeRow ignore = [](const RecordingFile&, const formation::Step&, const formation::LyapunovRow*) {};
  write(sealed(runs[0].lines));
  SealedRecording recording(path_);
  recording.read(ignore);
  EXPECT_TRUE(recording.is_sealed());
  EXPECT_NO_THROW(recording.read(ignore));
  write(sealed(runs[1].lines));
  try {
    recording.read(ignore);
    FAIL() << "the rows judged would not be those that were counted";
  } catch (const DataError& e) {
    EXPECT_EQ(e.code(), DataCode::file_unreadable) << e.what();
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
