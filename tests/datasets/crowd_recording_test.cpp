// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/crowd_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/datasets/trajectory_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/speed_profile.h"
#include "refusal.h"
#include "support/forged_crowd.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::fnv1a;
using exactvo::test::ForgedCrowd;
using exactvo::test::in_bytes;
using formation::RunReport;
using formation::Scenario;
using formation::SimulationOptions;
using geometry::Vec2;

/// Sixty through sixty, round two blocks; denser than half-planes hold.
Scenario crossing(const std::string& guidance = "none") {
  return parse_scenario(R"({"name": "crossing", "guidance": ")" + guidance + R"(", "time_step": 0.1, "time_limit": 12,
      "horizons": {"least": 0.3},
      "robots": [{"grid": {"columns": 6, "rows": 10, "spacing": 1.2, "corner": [-14, -6], "goal": [28, 0]}, "max_speed": 1.5},
                 {"grid": {"columns": 6, "rows": 10, "spacing": 1.2, "corner": [8, -6], "goal": [-28, 0]}, "max_speed": 1.7,
                  "radius": 0.4}],
      "obstacles": [{"polygon": [[-2, -4], [1, -4], [1, -2], [-2, -2]]}, {"polyline": [[0, 4], [0, 1], [2, 1]]}]})",
                        "crossing.json", {});
}

class CrowdRecordings : public TemporaryFolder {
 protected:
  RunReport record(const Scenario& scenario, std::uint32_t every, int threads = 1) {
    CrowdRecorder recorder(folder_ / "c.evr", scenario, every);
    SimulationOptions options;
    options.threads = threads;
    const RunReport report = run_crowd(scenario, options, &recorder);
    recorder.finish();
    return report;
  }
};

/// Thirty robots, two obstacles that pass through them, round corners.
Scenario traffic() {
  return parse_scenario(R"({"name": "traffic", "guidance": "none", "time_step": 0.1, "time_limit": 15,
      "horizons": {"least": 0.3},
      "robots": [{"grid": {"columns": 5, "rows": 6, "spacing": 1.6, "corner": [-14, -4], "goal": [24, 0]}, "max_speed": 1.5}],
      "obstacles": [{"polyline": [[0, 7], [0, 5], [2, 5]]}],
      "moving_obstacles": [
        {"id": "tram", "polygon": [[-1, -9], [1, -9], [1, -6], [-1, -6]], "path": [[0, -7], [0, 0], [6, 0], [6, 9]], "speed": 1.3},
        {"id": "bar", "polyline": [[4, 3], [5, 4], [4.5, 2]], "path": [[4, 3], [-8, -3]],
         "profile": {"knots": [[0, 0], [2, 1.7], [9, 0.4]]}}]})",
                        "traffic.json", {});
}

/// How many rows there are, and whether the file is cut off.
std::pair<std::size_t, bool> rows_of(const std::filesystem::path& path) {
  CrowdRecordingReader reader(path);
  CrowdRow row;
  std::size_t rows = 0;
  while (reader.next(row)) ++rows;
  return {rows, reader.is_cut_off()};
}

/// How many findings have these words.
std::size_t found(const AuditReport& audit, const std::string& words) {
  return static_cast<std::size_t>(std::count_if(audit.findings.begin(), audit.findings.end(), [&](const auto& finding) {
    return finding.find(words) != std::string::npos;
  }));
}

/// Whether the robot of "row 7: R overlaps ..." kept its half-planes up to that row, and from it to the next.
bool was_kept(const std::filesystem::path& path, const std::string& finding) {
  std::size_t colon = 0;
  const std::size_t from = std::stoul(finding.substr(4), &colon);
  const std::size_t begin = 4 + colon + 2;
  const std::string id = finding.substr(begin, finding.find(' ', begin) - begin);
  CrowdRecordingReader reader(path);
  CrowdRow row;
  std::size_t robot = 0;
  while (reader.head().name_of(robot) != id) ++robot;
  bool kept = true;
  for (std::size_t k = 0; k <= from + 1; ++k) {
    EXPECT_TRUE(reader.next(row));
    if (k >= from && row.kept[robot] == 0) kept = false;
  }
  return kept;
}

/// Keeps what a run shows.
struct Kept : formation::RunSink {
  void add_state(const formation::RunState& now) override {
    rows.push_back(now.positions);
    now.crowd->kept(marks.emplace_back());
  }
  std::vector<std::vector<geometry::Vec2>> rows;
  std::vector<std::vector<std::uint8_t>> marks;
};

TEST_F(CrowdRecordings, Property1_WhatIsReadIsWhatWasRun) {
  const Scenario scenario = crossing();
  Kept kept;
  run_crowd(scenario, {}, &kept);
  for (const std::uint32_t every : {1U, 7U}) {
    record(scenario, every);
    CrowdRecordingReader reader(folder_ / "c.evr");
    EXPECT_EQ(reader.head().scenario, "crossing");
    EXPECT_EQ(reader.head().kind_of.size(), 120U);
    EXPECT_EQ(reader.head().edges.size(), 6U);
    CrowdRow row;
    std::size_t last = 0;
    while (reader.next(row)) {
      for (std::size_t i = 0; i < row.x.size(); ++i) {
        const geometry::Vec2 at{row.x[i] * reader.head().position_step, row.y[i] * reader.head().position_step};
        ASSERT_EQ(at, kept.rows[row.step][i]);
        bool all = true;
        for (std::size_t step = last + 1; step <= row.step; ++step) all = all && kept.marks[step][i];
        ASSERT_EQ(row.kept[i] != 0, all) << row.step << ' ' << i;
      }
      last = row.step;
    }
    EXPECT_FALSE(reader.is_cut_off());
    EXPECT_EQ(last + 1, kept.rows.size());
  }
}

TEST_F(CrowdRecordings, MovingObstaclesGoAlongTheirPathsAndAnAuditJudgesThem) {
  const Scenario scenario = traffic();
  for (const std::uint32_t every : {1U, 3U}) {
    const RunReport run = record(scenario, every);
    EXPECT_GT(run.against_bodies, 1000U);
    CrowdRecordingReader reader(folder_ / "c.evr");
    ASSERT_EQ(reader.head().bodies.size(), 2U);
    EXPECT_TRUE(reader.head().bodies[0].moves);
    EXPECT_EQ(std::get<geometry::ConvexPolygon>(reader.head().bodies[0].shape).vertices.size(), 4U);
    const double q = reader.head().position_step;
    for (CrowdRow row; reader.next(row);)
      for (std::size_t k = 0; k < 2; ++k) {
        const Vec2 at = displacement_at(scenario.moving_obstacles[k], 0.1 * row.step);
        EXPECT_NEAR(q * static_cast<double>(row.body_x[k]), at.x, 0.51 * q) << row.step;
        EXPECT_NEAR(q * static_cast<double>(row.body_y[k]), at.y, 0.51 * q) << row.step;
      }
    const AuditReport audit = audit_recording(folder_ / "c.evr");
    EXPECT_EQ(audit.moving_questions, 2 * audit.steps);
    EXPECT_EQ(audit[AuditPoint::sequence].refuted + audit.unproven, 0U);
    EXPECT_GT(audit.collisions, 0U) << "robots that others hem in are run over";
    EXPECT_EQ(found(audit, " overlaps moving obstacle "), audit.findings.size());
    for (const std::string& finding : audit.findings) EXPECT_FALSE(was_kept(folder_ / "c.evr", finding)) << finding;
  }
  const RunReport one = record(scenario, 1), two = record(scenario, 1, 2);
  EXPECT_EQ(one.digest, two.digest);
}

TEST_F(CrowdRecordings, DiscsAreBodiesAndAnAuditJudgesThem) {
  const Scenario scenario = parse_scenario(R"({"name": "discs", "guidance": "none", "time_step": 0.1, "time_limit": 15,
      "horizons": {"least": 0.3},
      "robots": [{"grid": {"columns": 5, "rows": 6, "spacing": 1.6, "corner": [-14, -4], "goal": [24, 0]}, "max_speed": 1.5}],
      "obstacles": [{"disc": {"centre": [0, 0], "radius": 1.5}}, {"polyline": [[0, 7], [0, 5]]}],
      "moving_obstacles": [{"disc": {"centre": [3, 9], "radius": 0.75}, "velocity": [0, -1.1]}]})",
                                           "discs.json", {});
  record(scenario, 1);
  CrowdRecordingReader reader(folder_ / "c.evr");
  ASSERT_EQ(reader.head().bodies.size(), 2U);
  EXPECT_FALSE(reader.head().bodies[0].moves);
  EXPECT_EQ(std::get<geometry::Disc>(reader.head().bodies[0].shape).radius, 1.5);
  EXPECT_EQ(std::get<geometry::Disc>(reader.head().bodies[1].shape).radius, 0.75);
  EXPECT_EQ(reader.head().edges.size(), 1U) << "those of the wall";
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_TRUE(audit.clean()) << (audit.findings.empty() ? "" : audit.findings.front());
  EXPECT_EQ(audit.moving_questions, audit.steps);
  EXPECT_EQ(audit.obstacle_questions, 2 * audit.steps);
}

TEST_F(CrowdRecordings, AnAuditOfARunAsksManyThingsAndRefutesNone) {
  const RunReport run = record(crossing(), 1);
  EXPECT_GT(run.relaxed, 0U);
  EXPECT_GT(run.cut_short, 0U);
  EXPECT_EQ(run.overlapping, 0U);
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_TRUE(audit.clean()) << (audit.findings.empty() ? "" : audit.findings.front());
  EXPECT_EQ(audit.rows, run.steps + 1);
  EXPECT_EQ(audit.steps, (run.steps + 1) * 120) << "the first row, and each step";
  EXPECT_EQ(audit[AuditPoint::sequence].proven, run.steps * 120);
  EXPECT_EQ(audit.robot_questions, (run.steps + 1) * 120 * 119);
  EXPECT_EQ(audit.obstacle_questions, (run.steps + 1) * 120 * 2) << "the block, and the wall";
  const AuditReport some = audit_recording(folder_ / "c.evr", nullptr, 2000);
  EXPECT_TRUE(some.clean());
  EXPECT_GT(some.steps, 1000U);
  EXPECT_LT(some.steps, 4000U);
  EXPECT_EQ(some.left_out, audit.steps - some.steps);
}

/// The state of a crowd that no run has made.
void add_state_of(const formation::Crowd& crowd, std::size_t steps, CrowdRecorder& to) {
  std::vector<Vec2> places, velocities;
  crowd.positions(places);
  crowd.velocities(velocities);
  to.add_state({steps, 0.0, places, velocities, &crowd});
}

/// The state of two robots of a crowd elsewhere, with marks of what is kept.
void add_other(CrowdRecorder& to, std::size_t steps, const formation::CrowdKind& kind, Vec2 a, Vec2 b) {
  formation::Crowd other;
  other.add_kind(kind);
  other.add_robot(a);
  other.add_robot(b);
  other.step();
  add_state_of(other, steps, to);
}

/// Robots put elsewhere by other means than the crowd's.
struct Moved : formation::RunSink {
  explicit Moved(CrowdRecorder& to) : to_(to) {}
  void add_state(const formation::RunState& now) override {
    if (now.steps == 0) return to_.add_state(now);
    const auto steps = static_cast<double>(now.steps);
    add_other(to_, now.steps, {0.5, 1.0, 5.0, 15.0, 10}, {0.1 * steps, 0.0}, {3.0 - 0.1 * steps, 0.4});
  }
  CrowdRecorder& to_;
};

TEST_F(CrowdRecordings, AnAuditFindsOverlapsSpeedAndWalls) {
  const Scenario scenario = parse_scenario(R"({"name": "two", "time_step": 0.25, "time_limit": 5, "guidance": "none",
      "horizons": {"least": 0.5}, "obstacles": [{"polyline": [[2.2, -3], [2.2, -0.4]]}],
      "robots": [{"id": "a", "position": [0, 0], "goal": [30, 0], "max_speed": 1},
                 {"id": "b", "position": [3, 0.4], "goal": [-30, 0.4], "max_speed": 0.3}]})",
                                           "two.json", {});
  CrowdRecorder recorder(folder_ / "c.evr", scenario, 1);
  Moved sink(recorder);
  run_crowd(scenario, {}, &sink);
  recorder.finish();
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_FALSE(audit.clean());
  EXPECT_GT(found(audit, "b moves 0.1"), 0U) << "too fast";
  EXPECT_GT(found(audit, "a overlaps robot 'b'"), 0U);
  EXPECT_GT(found(audit, "overlaps obstacle 'O1'"), 0U);
}

/// Two robots that are where they are put, with marks as if they had kept everything.
struct Put : formation::RunSink {
  using Places = std::function<std::pair<geometry::Vec2, geometry::Vec2>(double steps)>;
  Put(CrowdRecorder& to, Places places) : to_(to), places_(std::move(places)) {}
  void add_state(const formation::RunState& now) override {
    if (now.steps == 0) return to_.add_state(now);
    const auto [a, b] = places_(static_cast<double>(now.steps));
    add_other(to_, now.steps, {0.01, 1.0, 5.0, 15.0, 10}, a, b);  // so small that nothing touches
  }
  CrowdRecorder& to_;
  Places places_;
};

class PutRobots : public CrowdRecordings {
 protected:
  /// A wall at x = 2, robots of radius 0.5.
  AuditReport audit_of(const Put::Places& places, std::uint32_t every = 1) {
    const Scenario scenario = parse_scenario(R"({"name": "two", "time_step": 0.25, "time_limit": 5, "guidance": "none",
        "horizons": {"least": 0.5}, "obstacles": [{"polyline": [[2, -3], [2, 3]]}],
        "robots": [{"id": "a", "position": [0, 0], "goal": [-300, 0], "max_speed": 20},
                   {"id": "b", "position": [8, 0], "goal": [300, 0.4], "max_speed": 20}]})",
                                             "two.json", {});
    CrowdRecorder recorder(folder_ / "c.evr", scenario, every);
    Put sink(recorder, places);
    run_crowd(scenario, {}, &sink);
    recorder.finish();
    return audit_recording(folder_ / "c.evr");
  }
};

TEST_F(PutRobots, AnOverlapFailsWhateverWasPromised) {
  for (const std::uint32_t every : {1U, 4U}) {
    const AuditReport stay = audit_of([](double) { return std::pair(Vec2{-5, 0}, Vec2{-4.2, 0}); }, every);
    EXPECT_GT(stay.collisions, 2U);
    EXPECT_FALSE(stay.clean());
    EXPECT_GT(found(stay, "b overlaps robot 'a'"), 2U);
  }
  // In turns overlapping and apart.
  const AuditReport turns = audit_of([](double k) {
    return std::pair(Vec2{-5, 0}, Vec2{std::fmod(k, 2.0) > 0.0 ? -4.2 : -3.9, 0});
  });
  EXPECT_GT(turns.collisions, 10U);
}

TEST_F(PutRobots, ExactContactIsClear) {
  for (const double gap : {0.0, -0x1p-18, 0x1p-18}) {
    const AuditReport audit = audit_of([&](double) { return std::pair(Vec2{-5, 0}, Vec2{-4.0 + gap, 0}); });
    EXPECT_GT(audit.robot_questions, 2U);
    EXPECT_EQ(found(audit, "overlaps robot") > 0, gap < 0.0) << gap;
  }
}

TEST_F(PutRobots, AnAuditFindsRobotsThatComeNearerToAnEdgeThatTheyTouched) {
  for (const std::uint32_t every : {1U, 4U}) {
    const auto far = [](double x) { return std::pair(Vec2{x, 0}, Vec2{30, 0}); };
    const AuditReport nearer = audit_of([&](double k) { return far(1.5 + 0.01 * k); }, every);
    EXPECT_GT(found(nearer, "a overlaps obstacle 'O1'"), 2U);
    EXPECT_FALSE(nearer.clean());
    const AuditReport rests = audit_of([&](double) { return far(1.5); }, every);
    EXPECT_EQ(found(rests, "'O1'"), 0U);
    const AuditReport leaves = audit_of([&](double k) { return far(1.51 - 0.01 * k); }, every);
    EXPECT_EQ(found(leaves, "'O1'"), 0U);
    const AuditReport deep = audit_of([&](double) { return far(1.7); }, every);
    EXPECT_GT(found(deep, "a overlaps obstacle 'O1'"), 4U);
    const AuditReport on_it = audit_of([&](double) { return far(2.0); }, every);
    EXPECT_GT(on_it.collisions, 3U);
    EXPECT_EQ(on_it.unproven, 0U);
  }
}

/// A disc of 1 m at (0, 0) that rests, one at (9, 0) that may move, and a robot of 0.5 m that is put anywhere, with
/// marks as if it had kept everything.
AuditReport audit_beside_bodies(const std::filesystem::path& path, const std::function<Vec2(double)>& place) {
  const auto crowd_at = [&](double radius, std::size_t step) {
    formation::Crowd crowd;
    crowd.add_kind({radius, 20.0, 5.0, 15.0, 10});
    crowd.add_body(geometry::Disc{{0.0, 0.0}, 1.0});
    crowd.add_moving_body(geometry::Disc{{9.0, 0.0}, 1.0}, {});
    crowd.add_robot(place(static_cast<double>(step)));
    crowd.step();
    return crowd;
  };
  Scenario scenario;
  CrowdRecorder recorder(path, scenario, 1);
  add_state_of(crowd_at(0.5, 0), 0, recorder);
  for (std::size_t step = 1; step <= 10; ++step) add_state_of(crowd_at(0.01, step), step, recorder);  // touches nothing
  recorder.finish();
  return audit_recording(path);
}

TEST_F(CrowdRecordings, AnAuditFindsRobotsThatMeetBodies) {
  const std::filesystem::path path = folder_ / "c.evr";
  const auto along_x = [&](double from, double by) {
    return audit_beside_bodies(path, [=](double k) { return Vec2{from + by * k, 0.0}; });
  };
  const AuditReport through = audit_beside_bodies(path, [](double k) { return Vec2{0.0, -3.0 + 0.49 * k}; });
  EXPECT_GT(through.collisions, 1U);
  EXPECT_GT(found(through, "#1 overlaps obstacle 'body 1'"), 1U);
  const AuditReport nearer = along_x(1.5, -0.01), rests = along_x(1.5, 0.0), leaves = along_x(1.5, 0.01);
  EXPECT_GT(found(nearer, "#1 overlaps obstacle 'body 1'"), 5U);
  EXPECT_EQ(rests.collisions, 0U);
  EXPECT_EQ(leaves.collisions, 0U);
  EXPECT_EQ(along_x(1.4, 0.01).collisions, 11U) << "10 cm inside at the beginning";
  const AuditReport still_there = along_x(7.6, 0.0), apart = along_x(7.4, 0.0);
  EXPECT_GT(found(still_there, "#1 overlaps moving obstacle 'body 2'"), 5U);
  EXPECT_TRUE(apart.clean());
}

// A scene has the polygon round an ellipse: a robot between the two overlaps no ellipse.
TEST_F(CrowdRecordings, EllipsesAreLeftOutWhereOverlapsAreDecided) {
  const std::filesystem::path path = folder_ / "e.evr";
  formation::Crowd crowd;
  crowd.add_kind({0.3, 20.0, 5.0, 15.0, 10});
  crowd.add_body(geometry::Ellipse{{0.0, 0.0}, 5.0, 0.0, 5.0});
  crowd.add_body(geometry::Disc{{20.0, 0.0}, 1.0});
  crowd.add_robot({5.305, 0.0});
  CrowdRecorder recorder(path, Scenario(), 1);
  for (std::size_t step = 0; step < 3; ++step) {
    crowd.step();
    add_state_of(crowd, step, recorder);
  }
  recorder.finish();
  TrajectoryReader reader(path.string(), {});
  reader.read([](const TrajectoryRow&) {});
  ASSERT_EQ(reader.file().obstacles.size(), 1U);
  EXPECT_EQ(reader.file().obstacles[0].id, "body 2");
  EXPECT_THAT(reader.file().notes, testing::Contains("1 ellipse left out"));
}

TEST_F(CrowdRecordings, ThreadsDoNotChangeARunNorDoesRecordingIt) {
  const RunReport one = record(crossing("route"), 5), two = record(crossing("route"), 5, 2);
  EXPECT_EQ(one.digest, two.digest);
  EXPECT_EQ(one.digest, run_crowd(crossing("route"), {}).digest);
  EXPECT_EQ(one.steps, two.steps);
}

TEST_F(CrowdRecordings, AlongRoutesAllArriveAndARobotWithoutOneStays) {
  const Scenario scenario = parse_scenario(R"({"name": "rooms", "time_step": 0.1, "time_limit": 120,
      "horizons": {"least": 0.3},
      "robots": [{"random": {"count": 20, "low": [-9, -9], "high": [-3, 9], "goal_low": [3, -9], "goal_high": [9, 9], "apart": 0.3},
                  "radius": 0.3, "max_speed": 1.5},
                 {"id": "locked", "position": [20, 0], "goal": [0, 8]}],
      "obstacles": [{"polyline": [[0, -10], [0, -2]]}, {"polyline": [[0, 2], [0, 10]]},
                    {"polyline": [[18, -2], [22, -2], [22, 2], [18, 2], [18, -2]]}]})",
                                           "rooms.json", {});
  const RunReport run = run_crowd(scenario, {});
  EXPECT_EQ(run.arrived, 20U);
  EXPECT_EQ(run.without_route.size(), 1U);
  EXPECT_GT(run.path_length, 20 * 6.0);
}

TEST_F(CrowdRecordings, Property2_ACutOffFileReadsUpToThereAndAChangedOneIsRefused) {
  const RunReport run = record(crossing(), 1);
  const std::string whole = content_of(folder_ / "c.evr");
  for (const std::size_t size : {whole.size() - 1, whole.size() - 2, whole.size() / 2}) {
    const auto [rows, cut_off] = rows_of(put("cut.evr", whole.substr(0, size)));
    EXPECT_TRUE(cut_off);
    EXPECT_LE(rows, run.steps + 1);
    EXPECT_GT(rows, run.steps / 3);
  }
  std::size_t tried = 0, refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 97, ++tried) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    try {
      refused += rows_of(put("changed.evr", changed)).second;  // a changed size reads as an end
    } catch (const DataError& error) {
      EXPECT_EQ(error.code(), DataCode::format_syntax) << error.what();
      ++refused;
    }
  }
  EXPECT_EQ(refused, tried);
  // A row that becomes the end hides those behind it.
  for (std::size_t at = whole.find('R', 200), found = 0; at != std::string::npos && found < 400;
       at = whole.find('R', at + 1), ++found) {
    std::string ended = whole;
    ended[at] = 'E';
    EXPECT_THROW(rows_of(put("ended.evr", ended)), DataError) << at;
  }
  expect_refusal(refusal_of([&] { rows_of(put("longer.evr", whole + "x")); }), DataCode::format_syntax,
                 "byte " + std::to_string(whole.size() - 16));
  expect_refusal(refusal_of([&] { audit_recording(put("head.evr", whole.substr(0, 40))); }), DataCode::format_syntax,
                 "byte 24");
  expect_refusal(refusal_of([&] { audit_recording(folder_ / "none.evr"); }), DataCode::file_missing, "");
  expect_refusal(refusal_of([&] { audit_recording(put("short.evr", "EXA")); }), DataCode::format_syntax, "byte 0");
  const DataError empty = refusal_of([&] { audit_recording(put("empty.evr", "")); });
  EXPECT_EQ(empty.code(), DataCode::cut_off);
  EXPECT_EQ(empty.found(), "an empty file");
}

TEST_F(CrowdRecordings, ATableHasALineARobotAndRow) {
  record(crossing(), 50);
  AtomicFile table(folder_ / "c.csv");
  const auto [rows, cut_off] = write_crowd_csv(folder_ / "c.evr", table);
  EXPECT_FALSE(cut_off);
  table.commit();
  const std::string text = content_of(folder_ / "c.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), 1 + 120 * rows);
  EXPECT_EQ(text.find("step,time,robot,x,y,kept,id\n0,0,0,-14,-6,1,\"G1/1\"\n"), 0U);
  EXPECT_NE(text.find(",\"G2/60\"\n"), std::string::npos);
}

std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

TEST_F(CrowdRecordings, AMovingBodyMarkedAsRestingIsRefuted) {
  record(traffic(), 1);
  const std::string whole = content_of(folder_ / "c.evr");
  const std::size_t size = number_at(whole, 8);
  std::string head = whole.substr(24, size);
  // Name, three numbers, a kind, thirty robots, two edges, how many bodies there are.
  const std::size_t moves = 4 + 7 + 8 + 8 + 4 + 4 + 16 + 4 + 30 * 2 + 4 + 2 * 32 + 4;
  ASSERT_EQ(head.at(moves), 1);
  head[moves] = 0;
  const std::string first = whole.substr(0, 16) + in_bytes(fnv1a(head)) + head;
  std::uint64_t sum = fnv1a(head);
  std::size_t at = 24 + size;
  for (; whole.at(at) == 'R'; at += 17 + number_at(whole, at + 1))
    sum = fnv1a(in_bytes(sum) + in_bytes(number_at(whole, at + 9)));
  const std::string seal = whole.substr(at + 17, 8) + in_bytes(sum);
  const std::string forged =
      first + whole.substr(24 + size, at - 24 - size) + "E" + in_bytes(seal.size()) + in_bytes(fnv1a(seal)) + seal;
  const AuditReport audit = audit_recording(put("forged.evr", forged));
  EXPECT_GT(found(audit, "tram has moved, and stands still"), 10U);
}

/// The same recording as an earlier version wrote it: the first `head_size` bytes of the head, and another mark.
std::string in_earlier_version(const std::string& whole, const std::string& mark, std::size_t head_size) {
  std::size_t at = 24 + number_at(whole, 8);
  const std::string head = whole.substr(24, head_size);
  std::uint64_t sum = fnv1a(head);
  std::string out = mark + in_bytes(head.size()) + in_bytes(sum) + head;
  for (; whole.at(at) == 'R'; at += 17 + number_at(whole, at + 1)) {
    out += whole.substr(at, 17 + number_at(whole, at + 1));
    sum = fnv1a(in_bytes(sum) + in_bytes(number_at(whole, at + 9)));
  }
  const std::string seal = whole.substr(at + 17, 8) + in_bytes(sum);
  return out + "E" + in_bytes(seal.size()) + in_bytes(fnv1a(seal)) + seal;
}

TEST_F(CrowdRecordings, RobotsKeepTheirIds) {
  Scenario scenario = crossing();
  const std::string odd[] = {"", "R, \"1\"", "robot", "robot/1", "\xc3\xa4rm", std::string(200, 'x')};
  for (std::size_t k = 0; k < std::size(odd); ++k) scenario.robots[7 * k].id = odd[k];
  record(scenario, 40);
  const CrowdRecordingReader reader(folder_ / "c.evr");
  ASSERT_EQ(reader.head().ids.size(), scenario.robots.size());
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    EXPECT_EQ(reader.head().ids[i], scenario.robots[i].id);
    EXPECT_EQ(reader.head().name_of(i), scenario.robots[i].id);
  }
  AtomicFile table(folder_ / "c.csv");
  write_crowd_csv(folder_ / "c.evr", table);
  table.commit();
  EXPECT_NE(content_of(folder_ / "c.csv").find(",\"R, \"\"1\"\"\"\n"), std::string::npos);
}

TEST_F(CrowdRecordings, AnIdOfTwoRobotsIsRefused) {
  Scenario scenario = crossing();
  scenario.robots[70].id = "G2/61";
  record(scenario, 40);
  std::string whole = content_of(folder_ / "c.evr");
  EXPECT_GT(rows_of(folder_ / "c.evr").first, 0u);
  // The same with the id of another robot in its place, and a checksum that fits.
  const std::size_t size = number_at(whole, 8);
  std::string head = whole.substr(24, size);
  const std::size_t at = head.rfind("61");
  ASSERT_NE(at, std::string::npos);
  head.replace(at, 2, "60");
  const std::string changed =
      whole.substr(0, 8) + in_bytes(size) + in_bytes(fnv1a(head)) + head + whole.substr(24 + size);
  const DataError refusal = refusal_of([&] { rows_of(put("twice.evr", changed)); });
  EXPECT_EQ(refusal.code(), DataCode::format_syntax);
  EXPECT_NE(std::string(refusal.what()).find("an id that another robot has"), std::string::npos) << refusal.what();
  TrajectoryReader reader((folder_ / "twice.evr").string());
  EXPECT_EQ(refusal_of([&] { reader.read([](const TrajectoryRow&) {}); }).code(), DataCode::format_syntax);
}

TEST_F(CrowdRecordings, RobotsOfOneIdAreRecordedWithoutIds) {
  Scenario scenario = crossing();
  scenario.robots[70].id = scenario.robots[3].id;
  record(scenario, 40);
  const CrowdRecordingReader reader(folder_ / "c.evr");
  EXPECT_TRUE(reader.head().ids.empty());
  EXPECT_EQ(reader.head().name_of(70), "#71");
  scenario.obstacles.clear();
  record(scenario, 40);
  EXPECT_EQ(content_of(folder_ / "c.evr").substr(0, 8), "EXACTVR2");
}

TEST_F(CrowdRecordings, ObstaclesKeepTheirIds) {
  Scenario scenario = traffic();
  scenario.obstacles[0].id = "R, \"wall\"";
  scenario.obstacles.push_back({"desk", geometry::Polygon{{{20, 20}, {21, 20}, {21, 21}}, {}}});
  const geometry::Disc post{{20.0, 0.0}, 0.5};
  scenario.obstacles.push_back({"post", geometry::Polygon{{{20, 0}, {20.5, 0}, {20, 0.5}}, {}}, post});
  record(scenario, 40);
  EXPECT_EQ(content_of(folder_ / "c.evr").substr(0, 8), "EXACTVR5");
  const RecordingFile scene = scene_of(CrowdRecordingReader(folder_ / "c.evr").head());
  std::vector<std::string> still, moving;
  for (const auto& o : scene.scenario.obstacles) still.push_back(o.id);
  for (const auto& o : scene.scenario.moving_obstacles) moving.push_back(o.id);
  EXPECT_THAT(still, testing::ElementsAre("R, \"wall\"", "desk", "post"));
  EXPECT_THAT(moving, testing::ElementsAre("tram", "bar"));
  record(scenario, 1);
  const AuditReport audit = audit_recording(folder_ / "c.evr");
  EXPECT_GT(found(audit, " overlaps moving obstacle 'tram'") + found(audit, " overlaps moving obstacle 'bar'"), 0U);
  EXPECT_EQ(found(audit, "'body "), 0U);
}

/// A file that was changed says that obstacles have other edges than there are.
TEST_F(CrowdRecordings, ObstaclesOfOtherEdgesAreRefused) {
  Scenario scenario = crossing();
  scenario.obstacles[1].id = "last";
  record(scenario, 40);
  const std::string whole = content_of(folder_ / "c.evr");
  const std::size_t size = number_at(whole, 8);
  std::string head = whole.substr(24, size);
  const std::size_t edges = head.rfind("last") - 6;  // a number of four bytes, then two lengths
  ASSERT_EQ(head[edges], 2);
  head[edges] = 3;
  const std::string changed =
      whole.substr(0, 8) + in_bytes(size) + in_bytes(fnv1a(head)) + head + whole.substr(24 + size);
  EXPECT_THAT(refusal_of([&] { rows_of(put("other.evr", changed)); }).what(),
              testing::HasSubstr("obstacles of another number of edges than there are"));
}

TEST_F(CrowdRecordings, RecordingsOfEarlierVersionsAreReadWithoutIds) {
  record(crossing(), 25);
  const std::string whole = content_of(folder_ / "c.evr");
  ASSERT_EQ(whole.substr(0, 8), "EXACTVR5");
  // Name, three numbers, two kinds, 120 robots, six edges; then bodies, of which there are none.
  const std::size_t before_bodies = 4 + 8 + 8 + 8 + 4 + 4 + 2 * 16 + 4 + 120 * 2 + 4 + 6 * 32;
  for (const auto& [mark, size] : {std::pair("EXACTVR1", before_bodies), std::pair("EXACTVR2", before_bodies + 4)}) {
    const std::filesystem::path old = put("old.evr", in_earlier_version(whole, mark, size));
    EXPECT_EQ(rows_of(old), rows_of(folder_ / "c.evr")) << mark;
    CrowdRecordingReader then(old), now(folder_ / "c.evr");
    EXPECT_TRUE(then.head().ids.empty());
    EXPECT_EQ(then.head().name_of(3), "#4");
    CrowdRow a, b;
    while (then.next(a) && now.next(b)) EXPECT_TRUE(a.x == b.x && a.y == b.y && a.kept == b.kept);
    EXPECT_TRUE(audit_recording(old).clean());
    AtomicFile table(folder_ / "old.csv");
    write_crowd_csv(old, table);
    table.commit();
    EXPECT_EQ(content_of(folder_ / "old.csv").find("step,time,robot,x,y,kept\n0,0,0,-14,-6,1\n"), 0U) << mark;
  }
  for (const char* mark : {"EXACTVR1", "EXACTVR2"})  // with a head of the present version
    EXPECT_EQ(refusal_of([&] { rows_of(put("b.evr", mark + whole.substr(8))); }).code(), DataCode::format_syntax);
  expect_refusal(refusal_of([&] { rows_of(put("b.evr", "EXACTVR6" + whole.substr(8))); }), DataCode::format_syntax,
                 "byte 0");
}

// --- Recordings that no run has made ---

class ForgedCrowds : public CrowdRecordings {
 protected:
  AuditReport audit_of(const ForgedCrowd& crowd, std::size_t sample = 0) const {
    return audit_recording(put("forged.evr", bytes_of(crowd)), nullptr, sample);
  }
};

/// A wall along the y axis.
ForgedCrowd::Edge wall_at(double x) {
  return {x, -5.0, x, 5.0};
}

/// The motions that are proven, refuted and open.
std::vector<std::size_t> motions_of(const AuditReport& audit) {
  const PointCount& motions = audit[AuditPoint::motions];
  return {motions.proven, motions.refuted, motions.open};
}
using Counts = std::vector<std::size_t>;

constexpr double kLattice = 0x1p10;  // steps in a metre

ForgedCrowd::Place at_x(double x) {
  return {static_cast<std::int64_t>(x * kLattice), 0};
}

TEST_F(ForgedCrowds, ARobotDeepInAnObstacleIsRefutedInEveryRow) {
  ForgedCrowd crowd;
  for (std::uint32_t step = 0; step < 5; ++step) crowd.rows.push_back({step, {at_x(0)}, {}});
  ForgedCrowd in_disc = crowd;
  crowd.edges = {wall_at(0.1)};
  EXPECT_EQ(motions_of(audit_of(crowd)), (Counts{0, 5, 0}));
  for (ForgedCrowd::Row& row : in_disc.rows) row.bodies = {{0, 0}};
  for (const bool moves : {false, true}) {
    in_disc.bodies = {{moves, 0, {1.2, 0.0, 1.0}}};
    EXPECT_EQ(motions_of(audit_of(in_disc)), (Counts{0, 5, 0})) << moves;
  }
}

TEST_F(ForgedCrowds, ContactIsClearHoweverFarRowsAreApart) {
  for (const std::uint32_t steps : {1U, 1000U, 1'000'000U}) {
    ForgedCrowd crowd{{{0, {at_x(0)}, {}}, {steps, {at_x(0)}, {}}}};
    crowd.edges = {wall_at(0.3)};
    const AuditReport audit = audit_of(crowd);
    EXPECT_EQ(motions_of(audit), (Counts{2, 0, 0})) << steps;
    EXPECT_EQ(audit.ends_only, steps > 1 ? 1U : 0U);
  }
}

// Rounding adds up from step to step, up to a share of the radius.
TEST_F(ForgedCrowds, WhatTouchesComesNoNearerThanRoundingExplains) {
  const auto counts = [&](std::uint32_t steps, double to) {
    ForgedCrowd crowd{{{0, {at_x(0)}, {}}, {steps, {at_x(to)}, {}}}};
    crowd.edges = {wall_at(0.3)};
    return motions_of(audit_of(crowd));
  };
  EXPECT_EQ(counts(1, 0.002), (Counts{1, 1, 0})) << "2 mm in a step";
  EXPECT_EQ(counts(500, 0.002), (Counts{2, 0, 0}));
  EXPECT_EQ(counts(500, 0.005), (Counts{1, 0, 1})) << "more than 1 % of the radius";
  EXPECT_EQ(counts(500, 0.24), (Counts{1, 1, 0})) << "24 cm inside";
}

TEST_F(ForgedCrowds, TheFirstRowIsCheckedAlone) {
  ForgedCrowd crowd{{{0, {at_x(0), at_x(0.001)}, {}}}};
  crowd.kind_of = {0, 0};
  EXPECT_EQ(motions_of(audit_of(crowd)), (Counts{0, 2, 0}));
  crowd.rows[0].robots[1] = at_x(0.75);
  EXPECT_EQ(motions_of(audit_of(crowd)), (Counts{2, 0, 0}));
  crowd.rows[0].step = 700;
  expect_refusal(refusal_of([&] { audit_of(crowd); }), DataCode::format_syntax, "row 0");
  crowd.rows.clear();
  const DataError no_rows = refusal_of([&] { audit_of(crowd); });
  EXPECT_EQ(no_rows.code(), DataCode::format_syntax);
  EXPECT_EQ(no_rows.found(), "no row");
  crowd.is_whole = false;
  EXPECT_EQ(audit_of(crowd).cut_off.size(), 1U);
}

TEST_F(ForgedCrowds, ABodyThatTouchesMayLeaveAndNotDriveThrough) {
  for (const auto& [by, expected] : {std::pair(1.0, Counts{2, 0, 0}), std::pair(-2.7, Counts{1, 1, 0})}) {
    ForgedCrowd crowd{{{0, {at_x(0)}, {{0, 0}}}, {1, {at_x(0)}, {at_x(by)}}}};
    crowd.bodies = {{true, 0, {1.3, 0.0, 1.0}}};
    EXPECT_EQ(motions_of(audit_of(crowd)), expected) << by;
  }
}

TEST_F(ForgedCrowds, WhatIsNotJudgedIsCountedAndReported) {
  const auto says = [](const AuditReport& audit, const std::string& words) {
    const std::vector<std::string> all = not_audited(audit);
    return std::any_of(all.begin(), all.end(),
                       [&](const std::string& s) { return s.find(words) != std::string::npos; });
  };
  ForgedCrowd crowd;
  for (const std::uint32_t step : {0U, 1U, 5U, 9U}) crowd.rows.push_back({step, {at_x(0)}, {}});
  const AuditReport audit = audit_of(crowd);
  EXPECT_EQ(audit.ends_only, 2U);
  EXPECT_TRUE(says(audit, "of 2 motions only the ends are judged"));
  EXPECT_TRUE(says(audit, "radii, speed limits, wheels, the tracking error, edges and bodies"));
  EXPECT_FALSE(says(audit, "--sample"));
  const AuditReport some = audit_of(crowd, 1);
  EXPECT_EQ(some.steps + some.left_out, 4U);
  EXPECT_GT(some.left_out, 0U);
  EXPECT_TRUE(says(some, "that --sample left out"));
  const Scenario scenario;
  EXPECT_THROW(audit_recording(folder_ / "forged.evr", &scenario), std::logic_error);
}

TEST(CrowdProblems, WhatACrowdCannotRunIsNamed) {
  Scenario s = crossing();
  EXPECT_TRUE(crowd_problems(s).empty());
  s.robots[3].cooperates = false;
  ASSERT_EQ(crowd_problems(s).size(), 1U);
  EXPECT_EQ(crowd_problems(s)[0].pointer, "/robots/3/cooperates");
  s = crossing();
  s.speed_bound = formation::SpeedBoundKind::box;
  EXPECT_EQ(crowd_problems(s)[0].pointer, "/speed_bound");
}

/// Robots of a crowd stand on a lattice: none can come as near to a goal between its points as a finer tolerance asks.
TEST(CrowdProblems, AToleranceBelowTheLatticeIsNamed) {
  Scenario s = crossing();
  s.arrival_tolerance = 0x1p-18;
  EXPECT_TRUE(crowd_problems(s).empty());
  s.arrival_tolerance = 1e-6;
  ASSERT_EQ(crowd_problems(s).size(), 1U);
  EXPECT_EQ(crowd_problems(s)[0].pointer, "/arrival_tolerance");
  EXPECT_EQ(crowd_problems(s)[0].found, "1e-06 m");
  EXPECT_NE(crowd_problems(s)[0].expected.find("at least 3.8147e-06 m"), std::string::npos);
  s = crossing();
  s.arrival_tolerance = 1e-3;
  EXPECT_TRUE(crowd_problems(s).empty());
  s.robots[0].goals[0] = {4e6, 0.0};  // a wider scene has a coarser lattice
  ASSERT_EQ(crowd_problems(s).size(), 1U);
  EXPECT_EQ(crowd_problems(s)[0].pointer, "/arrival_tolerance");
}

// --- Runs that are interrupted ---

struct Killed {};

/// Runs until the `last`-th snapshot was kept, as if the program were killed then: whatever is written behind it is
/// lost or spoilt.
std::string snapshot_before_death(const std::filesystem::path& path, const Scenario& scenario, std::uint32_t every,
                                  std::size_t snapshot_every, std::size_t last, std::string from) {
  SimulationOptions options;
  options.snapshot_every = snapshot_every;
  options.resume_from = std::move(from);
  std::string kept;
  std::size_t count = 0;
  options.keep_snapshot = [&](const std::string& bytes) {
    if (count++ == last) throw Killed();
    kept = bytes;
  };
  CrowdRecorder recorder(path, scenario, every, Unfinished::stays);
  EXPECT_THROW(run_crowd(scenario, options, &recorder), Killed);
  return kept;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST_F(CrowdRecordings, GoOnFromAnySnapshotToTheSameBytes) {
  for (const auto& [scenario, every] : {std::pair(crossing(), 1U), {crossing("route"), 7U}, {traffic(), 10U}}) {
    const RunReport whole = record(scenario, every);
    const std::string bytes = bytes_of(folder_ / "c.evr");
    std::size_t deaths = 0;
    for (const std::size_t steps : {1U, 13U, 40U}) {
      // Killed again and again: each time it comes two snapshots farther.
      std::string snapshot;
      std::size_t at = 0;
      for (int k = 0; k < 15 && at + 3 * steps <= whole.steps; ++k, at += 2 * steps, ++deaths) {
        snapshot = snapshot_before_death(folder_ / "d.evr", scenario, every, steps, 2, std::move(snapshot));
        std::ofstream(folder_ / "d.evr.unfinished", std::ios::app | std::ios::binary) << "half a row";
      }
      SimulationOptions options;
      options.resume_from = snapshot;
      options.threads = 2;
      CrowdRecorder recorder(folder_ / "d.evr", scenario, every, Unfinished::stays);
      const RunReport report = run_crowd(scenario, options, &recorder);
      recorder.finish();
      EXPECT_TRUE(bytes_of(folder_ / "d.evr") == bytes) << scenario.name << " every " << steps;
      EXPECT_FALSE(std::filesystem::exists(folder_ / "d.evr.unfinished"));
      EXPECT_EQ(report.digest, whole.digest);
      EXPECT_EQ(report.steps, whole.steps);
      EXPECT_EQ(report.path_length, whole.path_length);
      EXPECT_EQ(report.against_robots, whole.against_robots);
      EXPECT_EQ(report.outcome, whole.outcome);
      EXPECT_EQ(report.arrived, whole.arrived);
    }
    EXPECT_GT(deaths, 5U) << scenario.name;
  }
}

TEST_F(CrowdRecordings, SnapshotsThatWereChangedOrAreOfSomethingElseAreRefused) {
  const Scenario scenario = crossing();
  const std::string snapshot = snapshot_before_death(folder_ / "d.evr", scenario, 1, 10, 2, "");
  const auto expect_refused = [](const Scenario& s, std::string from) {
    SimulationOptions options;
    options.resume_from = std::move(from);
    try {
      run_crowd(s, options);
      ADD_FAILURE() << "went on";
    } catch (const formation::CrowdError& e) {
      EXPECT_EQ(e.problem(), formation::CrowdProblem::bad_snapshot);
    }
  };
  expect_refused(scenario, snapshot.substr(0, snapshot.size() / 2));
  expect_refused(scenario, "x");
  for (std::size_t at = 0; at < snapshot.size(); at += 997) {
    std::string changed = snapshot;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    expect_refused(scenario, changed);
  }
  expect_refused(traffic(), snapshot);
}

TEST_F(CrowdRecordings, GoOnOnlyWithTheRowsThatTheSnapshotKnowsOf) {
  const Scenario scenario = crossing();
  SimulationOptions options;
  options.resume_from = snapshot_before_death(folder_ / "d.evr", scenario, 1, 10, 2, "");
  {
    CrowdRecorder other(folder_ / "d.evr", scenario, 2, Unfinished::stays);
    expect_refusal(refusal_of([&] { run_crowd(scenario, options, &other); }), DataCode::format_syntax, "byte 8");
  }
  {
    CrowdRecorder first(folder_ / "d.evr", scenario, 1, Unfinished::stays);
    expect_refusal(refusal_of([&] { CrowdRecorder(folder_ / "d.evr", scenario, 1, Unfinished::stays); }),
                   DataCode::file_unwritable, "");
  }
  std::filesystem::resize_file(folder_ / "d.evr.unfinished", 100);
  CrowdRecorder recorder(folder_ / "d.evr", scenario, 1, Unfinished::stays);
  expect_refusal(refusal_of([&] { run_crowd(scenario, options, &recorder); }), DataCode::format_syntax, "byte 100");
}

}  // namespace
}  // namespace exactvo::datasets::test
