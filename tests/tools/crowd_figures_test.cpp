// SPDX-License-Identifier: GPL-3.0-or-later
// What the maps of crowds add up to.
#include "figures/crowd_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"

namespace exactvo::tools {
namespace {

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

TEST_F(CrowdFigures, CellsAreAsManyAsCanBeSeen) {
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
