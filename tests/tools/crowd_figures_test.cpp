// SPDX-License-Identifier: GPL-3.0-or-later
// What the maps of crowds add up to.
#include "figures/crowd_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "recordings/crowd_headings.h"

namespace exactvo::tools {
namespace {

using datasets::CrowdHeadings;
using testing::AllOf;
using testing::HasSubstr;

class CrowdFigures : public testing::Test {
 protected:
  CrowdFigures() {
    const formation::Scenario scenario = datasets::parse_scenario(
        R"({"name": "streams", "guidance": "none", "time_step": 0.1, "time_limit": 6, "horizons": {"least": 0.3},
            "robots": [{"grid": {"columns": 8, "rows": 12, "spacing": 1.5, "corner": [-20, -9], "goal": [30, 0]}, "max_speed": 1.5}],
            "obstacles": [{"polygon": [[-4, -2], [-2, -2], [-2, 2], [-4, 2]]}]})",
        "streams.json", {});
    datasets::CrowdRecorder recorder(path_, scenario, 4);
    report_ = run_crowd(scenario, {}, &recorder);
    recorder.finish();
    course_ = course_of(path_);
  }
  ~CrowdFigures() override { std::filesystem::remove(path_); }

  /// One of its own for each test: they run at the same time.
  const std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      (std::string("exactvo_crowd_figures_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".evr");
  formation::RunReport report_;
  CrowdCourse course_;
};

/// Writes down where the crowd says that its robots head.
class HeadingsOfRun final : public formation::RunSink {
 public:
  explicit HeadingsOfRun(datasets::CrowdRecorder& recorder) : recorder_(recorder) {}
  void add_state(const formation::RunState& now) override {
    recorder_.add_state(now);
    for (std::size_t i = 0; i < now.positions.size(); ++i)
      headings.push_back(now.crowd->heading(static_cast<formation::RobotId>(i)));
  }
  std::vector<Vec2> headings;

 private:
  datasets::CrowdRecorder& recorder_;
};

TEST(CrowdHeadings, FollowThoseOfTheCrowdWhereEveryStepIsARow) {
  const formation::Scenario scenario = datasets::parse_scenario(
      R"({"name": "burgers", "guidance": "none", "time_step": 0.25, "time_limit": 10, "horizons": {"least": 0.5},
          "robots": {"grid": {"columns": 3, "rows": 3, "spacing": 0.5, "goal": [3, 1]}, "heading": 120, "radius": 0.105,
                     "kinematics": {"type": "differential", "wheel_separation": 0.16, "max_wheel_speed": 0.22,
                                    "max_wheel_acceleration": 1}}})",
      "burgers.json", {});
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "exactvo_crowd_headings.evr";
  std::vector<Vec2> expected;
  {
    datasets::CrowdRecorder recorder(path, scenario, 1);
    HeadingsOfRun run(recorder);
    run_crowd(scenario, {}, &run);
    recorder.finish();
    expected = run.headings;
  }
  datasets::CrowdRecordingReader reader(path);
  CrowdHeadings headings(reader.head());
  datasets::CrowdRow row;
  std::size_t judged = 0, turned = 0;
  while (reader.next(row)) {
    headings.follow(row);
    for (std::size_t i = 0; i < 9; ++i, ++judged) {
      ASSERT_TRUE(headings.has(i));
      EXPECT_LT(norm(headings.of(i).heading - expected.at(judged)), 1e-7) << "row " << row.step;
      turned += norm(expected[judged] - expected[i]) > 0.5;
    }
  }
  const CrowdCourse course = course_of(path);
  std::filesystem::remove(path);
  ASSERT_EQ(course.headings.size(), 9U);
  ASSERT_EQ(course.headings[4].size(), course.paths[4].size());
  EXPECT_LT(norm(course.headings[4].back() - expected.at(expected.size() - 5)), 1e-7);
  EXPECT_NEAR(course.drives[4]->body_radius, 0.105, 1e-9);
  const std::string drawn = crowd_figures(course)[4].data;
  EXPECT_THAT(drawn, AllOf(HasSubstr("where it headed"), HasSubstr("its body there")));
  EXPECT_EQ(judged, expected.size());
  EXPECT_GT(turned, 100U);
  EXPECT_NEAR(headings.drive(0).body_radius, 0.105, 1e-9);
  datasets::CrowdRecordingHead seldom = reader.head();
  seldom.every = 2;
  EXPECT_FALSE(CrowdHeadings(seldom).has(0)) << "what is driven between its rows is not known";
}

TEST_F(CrowdFigures, CellsHoldAllTheTimeAndTheWaysOfEveryRobot) {
  double time = 0.0, way = 0.0;
  Vec2 moved;
  for (const CellCourse& cell : course_.cells) {
    time += cell.time;
    way += cell.way;
    moved += cell.moved;
  }
  EXPECT_EQ(course_.robots, 96u);
  EXPECT_NEAR(course_.duration, 6.0, 1e-12);
  EXPECT_NEAR(time, 96.0 * 6.0, 1e-8);
  // Rows leave out the corners of what was driven in between.
  EXPECT_LE(way, report_.path_length * (1.0 + 1e-12));
  EXPECT_GT(way, 0.97 * report_.path_length);
  EXPECT_GT(moved.x, 0.9 * way) << "all go to the right";
  EXPECT_LE(norm(moved), way);
}

TEST_F(CrowdFigures, ThereAreNoMoreCellsThanCanBeSeen) {
  const CellGrid& g = course_.grid;
  EXPECT_LE(std::max(g.columns, g.rows), kMostCells + 1);
  EXPECT_GE(std::max(g.columns, g.rows), kMostCells / 4);
  for (std::size_t k = 0; k < g.size(); k += 7) EXPECT_EQ(g.at(g.centre(k)), k);
  EXPECT_EQ(g.at({-1e9, -1e9}), 0u) << "the nearest";
  EXPECT_EQ(g.at({1e9, 1e9}), g.size() - 1);
}

TEST_F(CrowdFigures, SpeedsLieBetweenTheirTenthsAndSamplesAreBounded) {
  ASSERT_EQ(course_.speeds.size(), 15u);
  for (const SpeedsThen& then : course_.speeds) {
    EXPECT_LE(then.slow, then.median);
    EXPECT_LE(then.median, then.fast);
    EXPECT_LE(then.fast, 1.5 + 1e-6);
  }
  EXPECT_EQ(course_.paths.size(), kMostPaths);
  EXPECT_EQ(course_.paths.front().size(), 16u);
  EXPECT_FALSE(course_.cut_off);
}

TEST_F(CrowdFigures, ScriptsNameTheirUnitsAndDataHasEmptyCells) {
  const std::vector<Figure> figures = crowd_figures(course_);
  ASSERT_EQ(figures.size(), 5u);
  EXPECT_EQ(figures[0].name, "density");
  EXPECT_THAT(figures[0].body, HasSubstr("robots / m^2"));
  EXPECT_THAT(figures[0].data, HasSubstr("nan"));
  EXPECT_THAT(figures[1].body, HasSubstr("with vectors"));
  EXPECT_THAT(figures[1].body, HasSubstr("robots / (m s)"));
  EXPECT_THAT(figures[2].body, HasSubstr("'m/s'"));
  EXPECT_THAT(figures[4].shows, HasSubstr("the ways of 60 of them"));
  EXPECT_THAT(figures[4].data, testing::Not(HasSubstr("where it headed"))) << "they move in any direction";
}

TEST_F(CrowdFigures, ABodyAtTheRimIsDrawnWholeAndOneThatIsFarAwayChangesNoPicture) {
  const std::string without = crowd_figures(course_)[4].body;
  course_.bodies = {geometry::Disc{{1e4, 0.0}, 1.0}};
  EXPECT_EQ(crowd_figures(course_)[4].body.substr(0, without.find("plot")), without.substr(0, without.find("plot")));
  course_.bodies = {geometry::Disc{course_.view.low, 3.0}};
  const std::string with = crowd_figures(course_)[4].body, range = "set xrange [";
  const std::size_t at = with.find(range);
  ASSERT_NE(at, std::string::npos) << with;
  EXPECT_LT(std::stod(with.substr(at + range.size())), course_.view.low.x - 3.0);
}

}  // namespace
}  // namespace exactvo::tools
