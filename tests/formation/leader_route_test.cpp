// SPDX-License-Identifier: GPL-3.0-or-later
// The leader's path as a proven route, from a scenario as text.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/leader_route.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/distance.h"

namespace exactvo::formation {
namespace {

using geometry::Vec2;
using testing::AllOf;
using testing::HasSubstr;

/// Three robots side by side before a wall across the way, closed at both ends but for a door.
std::string text_of(const std::string& leader, double door_from, double door_to, const std::string& more = "") {
  const auto wall = [](double from, double to, int k) {
    return R"({"id": "wall )" + std::to_string(k) + R"(", "polyline": [[10, )" + std::to_string(from) + "], [10, " +
           std::to_string(to) + "]]}";
  };
  return R"({"name": "door", "time_limit": 60)" + more + R"(,
    "robots": [{"id": "R1", "position": [0, 1.5]}, {"id": "R2", "position": [0, 0]}, {"id": "R3", "position": [0, -1.5]}],
    "obstacles": [{"id": "frame", "polyline": [[-8, -12], [28, -12], [28, 12], [-8, 12], [-8, -12]]}, )" +
         wall(-12, door_from, 1) + ", " + wall(door_to, 12, 2) + R"(],
    "formation": {"topology": {"complete": true}, "offsets": [[0, 1.5], [0, 0], [0, -1.5]], "leader": )" +
         leader + "}}";
}

Scenario scenario_of(const std::string& text) {
  return datasets::parse_scenario(text, "s.json", ".");
}

double clearance_of(const Scenario& s, const std::vector<Vec2>& path) {
  double least = 1e9;
  for (std::size_t k = 1; k < path.size(); ++k)
    for (const SceneObstacle& o : s.obstacles)
      least = std::min(least, geometry::swept_distance(o.shape, {path[k - 1], path[k]}));
  return least;
}

TEST(LeaderRoute, LeavesTheWholeFormationRoom) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 0], "speed": 1})", 2, 9));
  const Leader& leader = s.formation->leader;
  EXPECT_EQ(leader.path.front(), (Vec2{0, 0})) << "where the robots are nearest to their slots";
  EXPECT_EQ(leader.path.back(), (Vec2{20, 0}));
  EXPECT_GT(leader.path.size(), 2u);
  EXPECT_GE(clearance_of(s, leader.path), 2.0 + s.margins.obstacle) << "1.5 m to the outer slots and 0.5 m of radius";
  EXPECT_EQ(leader.why_short, "");
  EXPECT_EQ(leader.note, "");
}

TEST(LeaderRoute, WhereTheFormationDoesNotFitLeavesOneRobotRoom) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 0], "speed": 1})", 4, 6));
  const Leader& leader = s.formation->leader;
  EXPECT_EQ(leader.path.back(), (Vec2{20, 0}));
  EXPECT_GE(clearance_of(s, leader.path), 0.5 + s.margins.obstacle);
  EXPECT_EQ(leader.why_short, "");
  EXPECT_THAT(leader.note, AllOf(HasSubstr("too narrow for the formation, 4 m wide about the leader"),
                                 HasSubstr("single robots, of 0.5 m radius")));
  EXPECT_THAT(warnings_before(s), testing::Contains(leader.note));
}

TEST(LeaderRoute, OutOfReachSaysWhyAndStays) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 0], "speed": 1})", 4, 4.9));
  const Leader& leader = s.formation->leader;
  EXPECT_EQ(leader.path, (std::vector<Vec2>{{0, 0}}));
  EXPECT_THAT(leader.why_short,
              AllOf(HasSubstr("the leader cannot reach (20, 0): obstacles 'frame', 'wall 1' and 'wall 2' enclose"),
                    HasSubstr("with a gap of 0.9 m for a robot 1 m wide")));
  EXPECT_THAT(warnings_before(s), testing::Contains(leader.why_short));
  const Recording run = simulate(s, {});
  EXPECT_THAT(run.outcome, HasSubstr(leader.why_short));
  EXPECT_THAT(run.warnings, testing::Contains(leader.why_short));
}

TEST(LeaderRoute, OutOfReachGoesAsNearAsItCanWhereTheScenarioSaysSo) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 4.45], "speed": 1})", 4, 4.9, R"(, "unreachable": "nearest")"));
  const Vec2 end = s.formation->leader.path.back();
  EXPECT_NEAR(end.y, 4.45, 1e-4);
  EXPECT_GT(end.x, 9.5);
  EXPECT_LT(end.x, 10.0);
  EXPECT_THAT(s.formation->leader.why_short, HasSubstr("goes as near as it can, 10.2 m from it"));
}

TEST(LeaderRoute, BeginsWhereItIsAskedTo) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 0], "from": [-2, 3], "speed": 1})", 2, 9));
  EXPECT_EQ(s.formation->leader.path.front(), (Vec2{-2, 3}));
  const Scenario blocked = scenario_of(text_of(R"({"to": [20, 0], "from": [-8, 3], "speed": 1})", 2, 9));
  EXPECT_THAT(blocked.formation->leader.why_short, HasSubstr("is nearer than the robot's radius to obstacle 'frame'"));
}

TEST(LeaderRoute, TakesAProfileAlongIt) {
  const std::string profile = R"({"to": [20, 0], "profile": {"trapezoid": {"speed": 1, "acceleration": 0.5}}})";
  const Scenario s = scenario_of(text_of(profile, 2, 9));
  EXPECT_EQ(s.formation->leader.profile.size(), 4u);
  EXPECT_NO_THROW(scenario_of(text_of(profile, 4, 4.9))) << "a path of one point";
}

TEST(LeaderRoute, IsWrittenAsThePathThatWasPlanned) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 0], "speed": 1})", 2, 9));
  const Scenario again = scenario_of(datasets::write_scenario(s));
  EXPECT_EQ(again.formation->leader.path, s.formation->leader.path);
}

TEST(LeaderRoute, IsFollowedByTheFormation) {
  const Scenario s = scenario_of(text_of(R"({"to": [20, 0], "speed": 1})", 2, 9));
  const Metrics m = measure(s, simulate(s, {}));
  EXPECT_TRUE(m.all_arrived) << m.outcome;
  EXPECT_TRUE(is_safe(m));
}

struct Refused {
  const char* leader;
  datasets::DataCode code;
  const char* pointer;
  const char* words;
};

TEST(LeaderRoute, WhatMeansNothingIsRefused) {
  using datasets::DataCode;
  const Refused all[] = {
      {R"({"to": [20], "speed": 1})", DataCode::wrong_count, "/formation/leader/to", "2"},
      {R"({"to": "there", "speed": 1})", DataCode::wrong_type, "/formation/leader/to", "a list ([x, y], m)"},
      {R"({"to": [20, 1e10], "speed": 1})", DataCode::out_of_range, "/formation/leader/to/1", "1000000000"},
      {R"({"to": [20, 0], "path": [[0, 0]], "speed": 1})", DataCode::no_alternative, "/formation/leader",
       "keys of several kinds: \"path\", \"to\""},
      {R"({"to": [20, 0], "from": [0, null], "speed": 1})", DataCode::wrong_type, "/formation/leader/from/1", "null"},
      {R"({"to": [20, 0]})", DataCode::no_alternative, "/formation/leader", "speed"},
      {R"({"to": [20, 0], "profile": {"legs": [1, 2]}})", DataCode::scenario, "/formation/leader/profile/legs",
       "speeds of legs, for a path that is planned"},
  };
  for (const Refused& r : all) {
    try {
      scenario_of(text_of(r.leader, 2, 9));
      ADD_FAILURE() << r.leader;
    } catch (const datasets::DataError& e) {
      EXPECT_EQ(e.code(), r.code) << r.leader << ": " << e.what();
      EXPECT_THAT(std::string(e.what()), AllOf(HasSubstr(r.pointer), HasSubstr(r.words))) << r.leader;
    }
  }
}

}  // namespace
}  // namespace exactvo::formation
