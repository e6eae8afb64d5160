// SPDX-License-Identifier: GPL-3.0-or-later
// The audit of a file or a pipe reads it once, row by row: it finds what the audit of the whole recording in memory
// finds.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
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

bool has_goals_out_of_turn(const AuditReport& report) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [](const std::string& f) { return f.find("come out of turn") != std::string::npos; });
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
      // Whose goals' bodies come out of turn names other ones in a row, depending on whether later ones are known.
      if (has_goals_out_of_turn(whole))
        EXPECT_EQ(by_rows[AuditPoint::bodies].refuted, whole[AuditPoint::bodies].refuted) << run.name;
      else
        EXPECT_EQ(told(by_rows, true), told(whole, false)) << run.name << ": " << done.field << " " << done.place;
      refuted += whole.clean() ? 0 : 1;
    } catch (const DataError& refused) {
      if (refused.code() != DataCode::cut_off)
        EXPECT_THROW(audit_recording(path_, &run.scenario), DataError) << refused.what();
      else
        EXPECT_FALSE(audit_recording(path_, &run.scenario).clean()) << refused.what();
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

/// The number of the first line of this kind, from `after` on.
std::size_t line_of(const Lines& lines, const char* kind, std::size_t after = 0) {
  while (after < lines.size() && !lines[after].contains(kind)) ++after;
  return after;
}

TEST_F(AuditRowByRow, GoalBodiesBeforeTheirTimeCountFromItOnAndLateOnesAreRefused) {
  std::size_t moved = 0;
  for (const ShortRun& run : short_runs()) {
    write(sealed(run.lines));
    const std::string whole = to_json(audit_recording(path_, &run.scenario));
    const std::size_t first_row = line_of(run.lines, "row");
    for (std::size_t at = line_of(run.lines, "goal_bodies", first_row); at < run.lines.size();
         at = line_of(run.lines, "goal_bodies", at + 1)) {
      Lines early = run.lines, late = run.lines;
      const std::size_t own_row = line_of(run.lines, "row", at);
      // Bodies that are named first there have to come along: only lines with known ones move.
      if (line_of(run.lines, "body", first_row) < at) continue;
      const auto begin = [](Lines& lines, std::size_t k) { return lines.begin() + static_cast<std::ptrdiff_t>(k); };
      std::rotate(begin(early, first_row), begin(early, at), begin(early, at + 1));
      write(sealed(early));
      EXPECT_EQ(to_json(audit_recording(path_, &run.scenario)), whole) << run.name << " " << at;
      std::rotate(begin(late, at), begin(late, at + 1), begin(late, own_row + 1));
      write(sealed(late));
      try {
        audit_recording(path_, &run.scenario);
        ADD_FAILURE() << run.name << " " << at;
      } catch (const DataError& refused) {
        EXPECT_EQ(refused.code(), DataCode::out_of_range) << refused.what();
      }
      ++moved;
    }
  }
  EXPECT_GT(moved, 0u);
}

TEST_F(AuditRowByRow, ABodyThatIsGivenTwiceIsRefused) {
  int judged = 0;
  for (const ShortRun& run : short_runs()) {
    Lines lines = run.lines;
    const std::size_t body = line_of(lines, "body");
    if (body == lines.size()) continue;
    const nlohmann::json again = lines[body];
    lines.insert(lines.end() - 1, again);
    write(sealed(lines));
    try {
      audit_recording(path_, &run.scenario);
      ADD_FAILURE() << run.name;
    } catch (const DataError& refused) {
      EXPECT_EQ(refused.code(), DataCode::out_of_range) << refused.what();
      ++judged;
    }
  }
  EXPECT_GT(judged, 0);
}

/// Cut off anywhere: the rows that are there are audited, nothing of them is refuted, and it is no whole run.
TEST_F(AuditRowByRow, SaysWhatItFoundInARecordingThatEndsEarly) {
  for (const ShortRun& run : short_runs()) {
    write(sealed(run.lines));
    ASSERT_TRUE(audit_recording(path_, &run.scenario).clean()) << run.name;
    const std::string text = sealed(run.lines);
    std::size_t rows = 0, asked_before = 0;
    for (std::size_t end = text.find('\n'); end + 1 < text.size(); end = text.find('\n', end + 1)) {
      rows += text.compare(text.rfind('\n', end - 1) + 1, 7, "{\"row\":") == 0 ? 1 : 0;
      write(text.substr(0, end + 1) + (rows % 2 == 0 ? "" : "{\"row\":{\"ti"));
      if (rows == 0) {
        EXPECT_THROW(audit_recording(path_, &run.scenario), DataError);
        continue;
      }
      const AuditReport report = audit_recording(path_, &run.scenario);
      EXPECT_FALSE(report.clean()) << run.name;
      EXPECT_EQ(report.rows, rows) << run.name;
      ASSERT_EQ(report.cut_off.size(), 1u) << run.name;
      EXPECT_NE(report.cut_off[0].find(" after " + std::to_string(rows) + " row"), std::string::npos)
          << report.cut_off[0];
      EXPECT_NE(report.cut_off[0].find("[E_CUT_OFF]"), std::string::npos) << report.cut_off[0];
      EXPECT_TRUE(report.findings.empty() || report[AuditPoint::half_planes].open > 0 ||
                  report[AuditPoint::choices].open > 0 || report[AuditPoint::completeness].open > 0)
          << run.name << ": " << report.findings.front();
      std::size_t asked = 0;
      for (const PointCount& point : report.points) {
        EXPECT_EQ(point.refuted, 0u) << run.name << " after " << rows;
        asked += point.asked();
      }
      EXPECT_GE(asked, asked_before) << run.name;
      asked_before = asked;
    }
  }
}

TEST_F(AuditRowByRow, FindsWhatIsWrongBeforeTheEnd) {
  const ShortRun run = short_runs().front();
  Lines lines = run.lines;
  nlohmann::json& chosen = lines[line_of(lines, "row")]["row"]["robots"][0]["chosen"];
  chosen[1] = chosen[1].get<double>() + 0.125;
  const std::string text = sealed(lines);
  write(text.substr(0, text.rfind("{\"end\":")));
  const AuditReport report = audit_recording(path_, &run.scenario);
  EXPECT_GT(report[AuditPoint::sequence].refuted + report[AuditPoint::choices].refuted, 0u);
  ASSERT_EQ(report.cut_off.size(), 1u);
  EXPECT_EQ(report.cut_off[0].find(" 0 refuted"), std::string::npos) << report.cut_off[0];
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
  run.recording.goal_bodies = {{1.0, 0, 0, {}}, {1.25, 0, 0, {}}};  // of row 2, and of none
  PlacesInRows places(run, 6);                                      // three rows of two robots
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
  ASSERT_NE(places.at_begin(run.recording.goal_bodies[0]), nullptr);
  EXPECT_EQ(*places.at_begin(run.recording.goal_bodies[0]), (geometry::Vec2{2.0, 0.0}));
  EXPECT_EQ(places.at_begin(run.recording.goal_bodies[1]), nullptr);
}

}  // namespace
}  // namespace exactvo::datasets::test
