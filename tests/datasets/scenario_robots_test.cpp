// SPDX-License-Identifier: GPL-3.0-or-later
// Robots of a scenario by generators and tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/distance.h"
#include "refusal.h"
#include "same_scenario.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using formation::Robot;
using formation::Scenario;
using geometry::norm;
using geometry::Vec2;

std::string with(const std::string& robots, const std::string& more = "") {
  return R"({"name": "n", "robots": [)" + robots + "]" + more + "}";
}

Scenario read(const std::string& robots, const std::string& more = "", const std::filesystem::path& folder = {}) {
  return parse_scenario(with(robots, more), "s.json", folder);
}

DataError refused(const std::string& robots, const std::string& more = "", const std::filesystem::path& folder = {}) {
  return refusal_of([&] { read(robots, more, folder); });
}

TEST(ScenarioRobots, ACircleOfRobotsHasTheOppositePlacesAsGoals) {
  const Scenario s = read(R"({"circle": {"count": 8, "radius": 10, "centre": [1, 2]}, "radius": 0.3, "max_speed": 2,
                              "prefix": "ring", "cooperates": false})");
  ASSERT_EQ(s.robots.size(), 8U);
  for (const Robot& r : s.robots) {
    EXPECT_NEAR(norm(r.position - Vec2{1, 2}), 10.0, 1e-12);
    ASSERT_EQ(r.goals.size(), 1U);
    EXPECT_NEAR(norm(r.position + r.goals[0] - Vec2{2, 4}), 0.0, 1e-12);
    EXPECT_EQ(r.radius, 0.3);
    EXPECT_EQ(r.max_speed, 2.0);
    EXPECT_FALSE(r.cooperates);
  }
  EXPECT_EQ(s.robots[0].id, "ring/1");
  EXPECT_EQ(s.robots[7].id, "ring/8");
}

const char kBurger[] = R"("radius": 0.105, "kinematics": {"type": "differential", "wheel_separation": 0.16,
                          "max_wheel_speed": 0.22, "max_wheel_acceleration": 1})";

TEST(ScenarioRobots, RobotsOfAGeneratorDriveOnWheelsAndLookTowardsTheirGoals) {
  const Scenario s = read(R"({"circle": {"count": 12, "radius": 2.2}, )" + std::string(kBurger) + "}");
  ASSERT_EQ(s.robots.size(), 12U);
  for (const Robot& r : s.robots) {
    ASSERT_TRUE(r.drive);
    EXPECT_NEAR(norm(r.position), 2.2, 1e-12) << "the reference point";
    EXPECT_NEAR(norm(r.drive->axle), 2.28, 1e-12) << "D behind it";
    EXPECT_NEAR(norm(formation::heading_vector(r.drive->heading) + r.position / 2.2), 0.0, 1e-12);
    EXPECT_EQ(r.max_speed, 0.22);
    EXPECT_GT(r.radius, 0.185);
    EXPECT_LT(r.radius, 0.186);
  }
  const Scenario same = read(R"({"grid": {"columns": 2, "rows": 1, "spacing": 1, "goal": [5, 0]}, "heading": 90, )" +
                             std::string(kBurger) + "}");
  EXPECT_EQ(same.robots[1].drive->axle, (Vec2{1.0, -0.08}));
}

TEST(ScenarioRobots, PlacesThatAreDrawnKeepClearOfDiscsAboutReferencePoints) {
  const std::string alone = R"({"id": "R", "position": [0, 0], "heading": 90, "goal": [0, 3], )" + std::string(kBurger);
  for (int seed = 0; seed < 20; ++seed) {
    const Scenario s = read(alone + R"(}, {"random": {"count": 12, "seed": )" + std::to_string(seed) +
                            R"(, "low": [-1, -1], "high": [1, 1], "apart": 0.01}, )" + kBurger + "}");
    ASSERT_EQ(s.robots.size(), 13U);
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE(norm(s.robots[i].position - s.robots[j].position), s.robots[i].radius + s.robots[j].radius + 0.009);
  }
}

TEST(ScenarioRobots, WheelsOfAGeneratorThatCannotBeAreRefusedAtItsEntry) {
  const std::string circle = R"({"circle": {"count": 3, "radius": 3}, )";
  expect_refusal(refused(circle + R"("heading": 90})"), DataCode::scenario, "/robots/0/heading");
  expect_refusal(refused(circle + R"("max_speed": 1, )" + kBurger + "}"), DataCode::scenario, "/robots/0/max_speed");
  expect_refusal(refused(circle + R"("kinematics": {"type": "differential", "wheel_separation": 0.16}})"),
                 DataCode::key_missing, "/robots/0/kinematics");
}

TEST(ScenarioRobots, EntriesOfAllKindsStandBesideEachOther) {
  const Scenario s = read(R"({"id": "R", "position": [0, 0], "goal": [9, 0]},
      {"grid": {"columns": 3, "rows": 2, "spacing": 1.5, "corner": [20, 0], "goal": [0, 30]}},
      {"grid": {"columns": 1, "rows": 1, "spacing": 1, "corner": [50, 0], "goal": [0, 30]}, "prefix": "last"})");
  ASSERT_EQ(s.robots.size(), 8U);
  EXPECT_EQ(s.robots[1].id, "G2/1");
  EXPECT_EQ(s.robots[6].position, (Vec2{23, 1.5}));
  EXPECT_EQ(s.robots[6].goals[0], (Vec2{23, 31.5}));
  EXPECT_EQ(s.robots[7].id, "last/1");
}

const char* const kWall = R"(, "obstacles": [{"polygon": [[5, 5], [15, 5], [15, 15], [5, 15]]}])";

TEST(ScenarioRobots, RandomRobotsAreApartAndClearAndTheSameForASeed) {
  const std::string group = R"({"id": "R", "position": [2, 2], "goal": [9, 2]},
      {"random": {"count": 60, "seed": 7, "low": [0, 0], "high": [30, 30], "apart": 0.2}, "radius": 0.4})";
  const Scenario s = read(group, kWall), again = read(group, kWall);
  ASSERT_EQ(s.robots.size(), 61U);
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    EXPECT_TRUE(same_bits(s.robots[i].position, again.robots[i].position));
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE(norm(s.robots[i].position - s.robots[j].position),
                s.robots[i].radius + s.robots[j].radius + 0.2 - 1e-12);
    for (std::size_t j = 0; j < i; ++j)  // at their goals they have room as well
      EXPECT_GE(norm(s.robots[i].goals[0] - s.robots[j].goals[0]),
                s.robots[i].radius + s.robots[j].radius + 0.2 - 1e-12);
    if (i == 0) continue;
    EXPECT_GE(geometry::signed_distance(s.obstacles[0].shape, s.robots[i].position), 0.6);
    EXPECT_GE(geometry::signed_distance(s.obstacles[0].shape, s.robots[i].goals[0]), 0.6);
  }
  const Scenario other = read(R"({"random": {"count": 60, "seed": 8, "low": [0, 0], "high": [30, 30]}})");
  EXPECT_FALSE(other.robots[0].position == s.robots[1].position);
}

TEST(ScenarioRobots, RobotsThatOverlapAtTheStartAreNamedByTheirIds) {
  const DataError overlap = refused(R"({"id": "left", "position": [0, 0], "goal": [9, 0]},
                                       {"id": "right", "position": [0.3, 0], "goal": [-9, 0]})");
  EXPECT_NE(overlap.found().find("overlapping robot 'left' by 0.7 m"), std::string::npos) << overlap.found();
}

TEST(ScenarioRobots, AnOverlapIsNamedHoweverSmallItIs) {
  const DataError robots = refused(R"({"id": "A", "position": [0, 0], "goal": [9, 0]},
                                      {"id": "B", "position": [0.9999999999, 0], "goal": [-9, 0]})");
  EXPECT_EQ(robots.found(), "[0.9999999999, 0], overlapping robot 'A' by 1e-10 m");
  const DataError wall = refused(R"({"id": "A", "position": [0, 0], "goal": [9, 0]})",
                                 R"(, "obstacles": [{"polyline": [[0.49999999, -1], [0.49999999, 1]]}])");
  EXPECT_EQ(wall.found(), "[0, 0], overlapping obstacle 'O1' by 1e-08 m");
  const DataError far = refused(R"({"id": "A", "position": [1e6, 1e6], "goal": [9, 0]},
                                   {"id": "B", "position": [1000000.99999, 1e6], "goal": [-9, 0]})");
  EXPECT_EQ(far.found(), "[1000000.99999, 1000000], overlapping robot 'A' by 1e-05 m");
}

TEST(ScenarioRobots, NumbersThatAreComparedDifferInTheMessage) {
  const DataError least = refused(R"({"id": "A", "position": [0, 0], "goal": [9, 0]})",
                                  R"(, "time_step": 0.05, "horizons": {"least": 0.09999999999})");
  EXPECT_EQ(least.found(), "0.09999999999");
  EXPECT_EQ(least.expected(), "at least twice /time_step, 0.1 (s)");
}

/// m: between the rims of neighbours on a circle.
double gap_on(const Scenario& s) {
  const Robot &a = s.robots[0], &b = s.robots[1];
  return norm(a.position - b.position) - a.radius - b.radius;
}

TEST(ScenarioRobots, ACircleWithoutARadiusHasRoomForItsRobots) {
  for (const double radius : {0.5, 500.0, 5e-4})
    for (const int count : {100, 1000}) {
      const std::string of = R"({"circle": {"count": )" + std::to_string(count) + R"(, "centre": [7, -3]}, "radius": )";
      const Scenario s = read(of + std::to_string(radius) + "}");
      ASSERT_EQ(s.robots.size(), static_cast<std::size_t>(count));
      EXPECT_NEAR(gap_on(s), 2.0 * radius, 1e-9 * radius * count);
      EXPECT_NEAR(norm(s.robots[0].position + s.robots[0].goals[0] - Vec2{14, -6}), 0.0, 1e-9 * radius * count);
    }
  for (const int count : {1, 2, 3, 15}) {  // the circle of a small crowd has a least radius of ten robot radii
    const Scenario s = read(R"({"circle": {"count": )" + std::to_string(count) + "}}");
    EXPECT_NEAR(norm(s.robots[0].position), 5.0, 1e-12) << count;
  }
}

TEST(ScenarioRobots, RandomRobotsWithoutABoxHaveRoomAboutTheOrigin) {
  for (const int count : {1, 40, 2000}) {
    const Scenario s = read(R"({"random": {"count": )" + std::to_string(count) + R"(, "apart": 0.5}})");
    ASSERT_EQ(s.robots.size(), static_cast<std::size_t>(count));
    const double half = 0.5 * 3.0 * 1.5 * std::sqrt(count);
    for (const Robot& r : s.robots)
      for (const Vec2 p : {r.position, r.goals[0]}) EXPECT_LE(std::max(std::fabs(p.x), std::fabs(p.y)), half);
  }
}

TEST(ScenarioRobots, RandomRobotsWithoutABoxStandAmongTheObstacles) {
  const Scenario hall =
      read(R"({"random": {"count": 30}})",
           R"(, "obstacles": [{"polyline": [[1000, 0], [1060, 0], [1060, 40], [1000, 40], [1000, 0]]}])");
  for (const Robot& r : hall.robots)
    for (const Vec2 p : {r.position, r.goals[0]})
      EXPECT_TRUE(p.x > 1000 && p.x < 1060 && p.y > 0 && p.y < 40) << p.x << ", " << p.y;
  EXPECT_EQ(read(R"({"random": {"count": 300}})", kWall).robots.size(), 300U) << "a box that the obstacle fills";
  EXPECT_EQ(read(R"({"random": {"count": 5}})", kWall).robots.size(), 5U) << "and hardly room round it";
}

/// Robots by an entry in the place of the list.
TEST(ScenarioRobots, AnEntryAloneIsReadAsAListOfIt) {
  const auto alone = [](const std::string& robots, const std::filesystem::path& folder = {}) {
    return parse_scenario(R"({"name": "n", "robots": )" + robots + "}", "s.json", folder);
  };
  for (const char* entry : {R"({"circle": {"count": 8, "radius": 10}, "prefix": "ring"})",
                            R"({"grid": {"columns": 3, "rows": 2, "spacing": 1.5, "goal": [0, 30]}})",
                            R"({"random": {"count": 9}})", R"({"id": "R", "position": [0, 0], "goal": [9, 0]})"})
    EXPECT_EQ(write_scenario(alone(entry)), write_scenario(read(entry))) << entry;
  const auto refused_alone = [&](const std::string& robots) { return refusal_of([&] { alone(robots, "/nowhere"); }); };
  expect_refusal(refused_alone(R"({"circle": {"count": 0}})"), DataCode::out_of_range, "/robots/circle/count");
  expect_refusal(refused_alone(R"({"circle": {"count": 20, "radius": 1}})"), DataCode::scenario, "/robots");
  expect_refusal(refused_alone(R"({"file": "none.csv"})"), DataCode::file_missing, "/robots/file");
  expect_refusal(refused_alone(R"({"id": "R", "position": [0, 0], "goal": [1e99, 0]})"), DataCode::out_of_range,
                 "/robots/goal/0");
  expect_refusal(refused_alone(R"("circle")"), DataCode::wrong_type, "/robots");
  expect_refusal(refused_alone("null"), DataCode::wrong_type, "/robots");
}

class ScenarioRobotTables : public TemporaryFolder {};

TEST_F(ScenarioRobotTables, ATableAloneIsAmongTheFilesOfTheScenario) {
  std::ofstream(folder_ / "robots.csv") << "x,y,goal_x,goal_y\n1,2,3,4\n";
  std::ofstream(folder_ / "s.json") << R"({"name": "n", "robots": {"file": "robots.csv"}})";
  EXPECT_EQ(load_scenario(folder_ / "s.json").robots.size(), 1U);
  EXPECT_EQ(files_of_scenario(folder_ / "s.json"), (std::vector{folder_ / "s.json", folder_ / "robots.csv"}));
}

TEST_F(ScenarioRobotTables, RobotsOnWheelsStandByTheirAxles) {
  std::ofstream(folder_ / "robots.csv") << "x,y,goal_x,goal_y,heading\n1,2,3,4,90\n5,2,3,4,0\n";
  const std::string entry = R"({"file": "robots.csv")";
  const Scenario s = read(entry + ", " + kBurger + "}", "", folder_);
  ASSERT_EQ(s.robots.size(), 2U);
  EXPECT_EQ(s.robots[0].drive->axle, (Vec2{1, 2}));
  EXPECT_EQ(s.robots[0].position, (Vec2{1, 2.08}));
  EXPECT_EQ(s.robots[1].position, (Vec2{5.08, 2}));
  expect_refusal(refused(entry + "}", "", folder_), DataCode::scenario, "line 1");
  std::ofstream(folder_ / "robots.csv") << "x,y,goal_x,goal_y,max_speed\n1,2,3,4,1\n";
  expect_refusal(refused(entry + ", " + kBurger + "}", "", folder_), DataCode::scenario, "line 1");
}

TEST_F(ScenarioRobotTables, AByteOrderMarkIsLeftOut) {
  std::ofstream(folder_ / "robots.csv") << "\xEF\xBB\xBFx,y,goal_x,goal_y\r\n1,2,3,4\r\n";
  const Scenario s = read(R"({"file": "robots.csv"})", "", folder_);
  ASSERT_EQ(s.robots.size(), 1U);
  EXPECT_EQ(s.robots[0].position, (Vec2{1, 2}));
}

TEST_F(ScenarioRobotTables, FieldsMayBeQuoted) {
  std::ofstream(folder_ / "robots.csv")
      << "\"id\",x,y, \"goal_x\" ,goal_y\n\"a, \"\"b\"\"\",\"1\",2,3,4\nplain,5,6,7,8\n";
  const Scenario s = read(R"({"file": "robots.csv"})", "", folder_);
  ASSERT_EQ(s.robots.size(), 2U);
  EXPECT_EQ(s.robots[0].id, "a, \"b\"");
  EXPECT_EQ(s.robots[0].position, (Vec2{1, 2}));
  EXPECT_EQ(s.robots[1].id, "plain");
  for (const char* row : {"\"a,1,2,3,4\n", "\"a\"b,1,2,3,4\n", "\"a\"\",1,2,3,4\n"}) {
    std::ofstream(folder_ / "robots.csv") << "id,x,y,goal_x,goal_y\n" << row;
    expect_refusal(refused(R"({"file": "robots.csv"})", "", folder_), DataCode::format_syntax, "line 2");
  }
}

TEST_F(ScenarioRobotTables, AThousandRobotsAreRead) {
  std::ofstream table(folder_ / "robots.csv");
  table << "goal_x,goal_y,x,y,radius,id,vx\n";
  for (int i = 0; i < 1000; ++i) table << i << ",5," << 2 * i << ",0.5,0.25,r" << i << ",0.125\r\n";
  table.close();
  std::ofstream(folder_ / "s.json") << with(R"({"file": "robots.csv", "max_speed": 1})");
  const LoadedScenario loaded = load_scenario_with_notes(folder_ / "s.json");
  ASSERT_EQ(loaded.scenario.robots.size(), 1000U);
  const Robot& r = loaded.scenario.robots[999];
  EXPECT_EQ(r.id, "r999");
  EXPECT_EQ(r.position, (Vec2{1998, 0.5}));
  EXPECT_EQ(r.goals[0], (Vec2{999, 5}));
  EXPECT_EQ(r.velocity, (Vec2{0.125, 0}));
  EXPECT_EQ(r.radius, 0.25);
  EXPECT_EQ(r.max_speed, 1.0);
  EXPECT_EQ(loaded.files, (std::vector{folder_ / "s.json", folder_ / "robots.csv"}));
  EXPECT_EQ(files_of_scenario(folder_ / "s.json"), loaded.files);
}

TEST(ScenarioRobots, Property2_EntriesThatAreNoRobotsArePlaced) {
  expect_refusal(refused(R"({"id": "R"})"), DataCode::key_missing, "/robots/0");
  expect_refusal(refused(R"({"circel": {}})"), DataCode::key_unknown, "/robots/0/circel");
  expect_refusal(refused(R"({"ring": {}})"), DataCode::no_alternative, "/robots/0");
  expect_refusal(refused(R"({"circle": {"count": 0, "radius": 1}})"), DataCode::out_of_range, "/robots/0/circle/count");
  expect_refusal(refused(R"({"circle": {"count": 2.5, "radius": 1}})"), DataCode::wrong_type, "/robots/0/circle/count");
  expect_refusal(refused(R"({"circle": {"radius": 3}})"), DataCode::key_missing, "/robots/0/circle");
  expect_refusal(refused(R"({"random": {"count": 3, "high": [9, 9]}})"), DataCode::scenario, "/robots/0/random");
  expect_refusal(refused(R"({"circle": {"count": 3, "radius": 9}, "grid": {}})"), DataCode::no_alternative,
                 "/robots/0");
  expect_refusal(refused(R"({"grid": {"columns": 1000000, "rows": 1000000, "spacing": 1, "goal": [1, 0]}})"),
                 DataCode::size, "/robots/0/grid");
  expect_refusal(refused(R"({"random": {"count": 99, "low": [0, 0], "high": [3, 3]}})"), DataCode::scenario,
                 "/robots/0/random");
  expect_refusal(refused(R"({"file": "none.csv"})", "", "/nowhere"), DataCode::file_missing, "/robots/0/file");
}

TEST(ScenarioRobots, RobotsOfAGeneratorThatCannotStartAreNamed) {
  const DataError tight = refused(R"({"id": "R", "position": [90, 90], "goal": [91, 0]},
                                     {"circle": {"count": 20, "radius": 1}, "prefix": "ring"})");
  expect_refusal(tight, DataCode::scenario, "/robots/1");
  EXPECT_EQ(tight.found().find("robot 'ring/2' at "), 0U) << tight.found();
  expect_refusal(
      refused(R"({"grid": {"columns": 1, "rows": 1, "spacing": 1, "corner": [9, 9], "goal": [1, 0]}})", kWall),
      DataCode::scenario, "/robots/0");
  expect_refusal(refused(R"({"circle": {"count": 2, "radius": 9}, "prefix": "a"},
                            {"circle": {"count": 2, "radius": 20}, "prefix": "a"})"),
                 DataCode::scenario, "/robots/1");
}

struct Table {
  const char* text;
  DataCode code;
  const char* place;
};

TEST_F(ScenarioRobotTables, Property2_MistakesArePlaced) {
  for (const Table& table :
       {Table{"", DataCode::format_syntax, ""}, Table{"x,y,goal_x\n1,2,3\n", DataCode::key_missing, "line 1"},
        Table{"x,y,goal_x,goal_y,colour\n", DataCode::key_unknown, "line 1"},
        Table{"x,y,goal_x,goal_y,x\n", DataCode::json_duplicate_key, "line 1"},
        Table{"x,y,goal_x,goal_y\n", DataCode::wrong_count, ""},
        Table{"x,y,goal_x,goal_y\n1,2,3\n", DataCode::wrong_count, "line 2"},
        Table{"x,y,goal_x,goal_y\n1,2,3,4\n\n1,2,a,4\n", DataCode::number, "line 4"},
        Table{"x,y,goal_x,goal_y\n1,nan,3,4\n", DataCode::out_of_range, "line 2"},
        Table{"x,y,goal_x,goal_y,radius\n1,2,3,4,0\n", DataCode::out_of_range, "line 2"}}) {
    std::ofstream(folder_ / "t.csv") << table.text;
    const DataError error = refused(R"({"file": "t.csv"})", "", folder_);
    EXPECT_EQ(error.code(), table.code) << error.what();
    EXPECT_EQ(error.file(), (folder_ / "t.csv").string());
    EXPECT_EQ(error.place(), table.place) << error.what();
  }
}

/// Ten thousand, quickly: no pair of robots, nor of robot and obstacle, is looked at that is far apart.
TEST(ScenarioRobots, ManyAreReadAndWrittenOutOneByOne) {
  const Scenario s = read(R"({"grid": {"columns": 100, "rows": 100, "spacing": 2, "goal": [500, 0]}})");
  ASSERT_EQ(s.robots.size(), 10000U);
  EXPECT_EQ(parse_scenario(write_scenario(s), "w.json", {}).robots.size(), 10000U);
}

}  // namespace
}  // namespace exactvo::datasets::test
