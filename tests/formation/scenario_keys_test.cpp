// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of moving obstacles and of robots that do not yield, from JSON and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exactvo/datasets/data_error.h"
#include "paper_scenes.h"

namespace exactvo::test {
namespace {

using testing::HasSubstr;

const char* const kText = R"({
  "name": "cart", "robots": [ { "id": "R1", "position": [0, 0], "goal": [9, 0], "cooperates": false } ],
  "moving_obstacles": [ { "id": "cart", "polygon": [[4, 4], [5, 4], [5, 5]], "path": [[0, 0], [0, -3]], "speed": 0.5 } ]
})";

TEST(ScenarioKeys, MovingObstaclesAndCooperationAreRead) {
  const formation::Scenario s = datasets::parse_scenario(kText, "cart.json", ".");
  EXPECT_FALSE(s.robots[0].cooperates);
  ASSERT_EQ(s.moving_obstacles.size(), 1u);
  EXPECT_EQ(s.moving_obstacles[0].motion.path.back(), (geometry::Vec2{0, -3}));
  EXPECT_EQ(s.moving_obstacles[0].motion.speed, 0.5);
  EXPECT_EQ(geometry::vertices_of(s.moving_obstacles[0].shape).size(), 3u);
}

TEST(ScenarioKeys, WritingAndReadingAgain) {
  const std::string once = datasets::write_scenario(datasets::parse_scenario(kText, "cart.json", "."));
  EXPECT_EQ(datasets::write_scenario(datasets::parse_scenario(once, "again.json", ".")), once);
  EXPECT_NE(once.find("\"cooperates\": false"), std::string::npos);
}

TEST(ScenarioKeys, AMovingObstacleNeedsItsPath) {
  const std::string text = R"({ "name": "x", "robots": [ { "id": "R1", "position": [0, 0], "goal": [9, 0] } ],
    "moving_obstacles": [ { "polygon": [[4, 4], [5, 4], [5, 5]], "speed": 0.5 } ] })";
  EXPECT_THROW(datasets::parse_scenario(text, "cart.json", "."), datasets::DataError);
}

TEST(ScenarioKeys, AMovingObstacleMayHaveASpeedProfile) {
  const std::string text = R"({ "name": "x", "robots": [ { "id": "R1", "position": [0, 0], "goal": [9, 0] } ],
    "moving_obstacles": [ { "polygon": [[4, 4], [5, 4], [5, 5]], "path": [[0, 0], [9, 0]],
                            "profile": { "knots": [[0, 0.5], [2, 3], [2, 1]] } } ] })";
  const formation::Scenario s = datasets::parse_scenario(text, "cart.json", ".");
  const std::vector<formation::SpeedKnot>& profile = s.moving_obstacles[0].motion.profile;
  ASSERT_EQ(profile.size(), 3u);
  EXPECT_EQ(profile[1].time, 2.0);
  EXPECT_EQ(profile[1].speed, 3.0);
  const std::string once = datasets::write_scenario(s);
  EXPECT_EQ(datasets::parse_scenario(once, "again.json", ".").moving_obstacles[0].motion.profile.size(), 3u)
      << "a recording that loses it is audited against another motion";
}

/// What is refused of a moving obstacle with these members beside its shape.
std::string refusal_of_moving(const std::string& members) {
  const std::string text = R"({ "name": "x", "robots": [ { "id": "R1", "position": [0, 0], "goal": [9, 0] } ],
    "moving_obstacles": [ { "polyline": [[4, 4], [5, 4]], )" +
                           members + " } ] }";
  try {
    datasets::parse_scenario(text, "cart.json", ".");
  } catch (const datasets::DataError& e) {
    return e.what();
  }
  return "";
}

TEST(ScenarioKeys, AMovingObstacleHasASpeedOrAProfile) {
  const std::string path = R"("path": [[0, 0], [9, 0]])";
  const std::string speed = R"("speed": 1)", profile = R"("profile": { "legs": [2] })";
  EXPECT_EQ(refusal_of_moving(path + ", " + speed), "");
  EXPECT_EQ(refusal_of_moving(path + ", " + profile), "") << "a profile says all of the speed";
  const std::string both = refusal_of_moving(path + ", " + speed + ", " + profile);
  EXPECT_THAT(both, HasSubstr("/moving_obstacles/0")) << both;
  EXPECT_THAT(both, HasSubstr("both \"speed\" and \"profile\"")) << both;
  const std::string neither = refusal_of_moving(path);
  EXPECT_THAT(neither, HasSubstr("\"path\" with \"speed\", or \"path\" with \"profile\", or \"velocity\"")) << neither;
  EXPECT_THAT(refusal_of_moving(speed), HasSubstr("\"path\""));
}

TEST(ScenarioKeys, MovingObstaclesHaveIdsOfTheirOwn) {
  const std::string cart = R"({ "id": "cart", "polygon": [[4, 4], [5, 4], [5, 5]], "path": [[0, 0]], "speed": 1 })";
  const std::string text = R"({ "name": "x", "robots": [ { "id": "R1", "position": [0, 0], "goal": [9, 0] } ],
    "moving_obstacles": [ )" +
                           cart + ", " + cart + " ] }";
  EXPECT_THROW(datasets::parse_scenario(text, "cart.json", "."), datasets::DataError);
}

/// A formation of five with `extra` in it.
std::string five(const std::string& extra) {
  return R"({ "name": "five", "time_step": 0.02, "robots": [
    { "id": "a", "position": [0, 0] }, { "id": "b", "position": [-3, 2] }, { "id": "c", "position": [-3, -2] },
    { "id": "d", "position": [-6, 4] }, { "id": "e", "position": [-6, -4] } ], "formation": { )" +
         extra + " } }";
}
formation::FormationSpec spec_of(const std::string& extra) {
  return *datasets::parse_scenario(five(extra), "five.json", ".").formation;
}

const char* const kWedge = R"("pattern": { "name": "wedge", "spacing": 2, "heading": [0, 1] },
    "topology": { "neighbours_within": 2.5, "pinned": ["a"] },
    "leader": { "path": [[0, 0], [0, 30]], "profile": { "trapezoid": { "speed": 2, "acceleration": 0.5 } } },
    "controller_options": { "smoothing": true, "side_commitment": false, "acceleration_bound": 12 })";

TEST(ScenarioKeys, PatternsTopologiesProfilesAndControllerOptionsAreRead) {
  const formation::FormationSpec f = spec_of(kWedge);
  ASSERT_EQ(f.offsets.size(), 5u);
  EXPECT_GT(f.offsets[0].y, f.offsets[4].y);  // the point leads along the heading
  EXPECT_EQ(f.topology.pinning, (std::vector<double>{1, 0, 0, 0, 0}));
  EXPECT_EQ(f.topology.adjacency[0], (std::vector<double>{0, 1, 1, 0, 0}));
  ASSERT_EQ(f.leader.profile.size(), 4u);
  EXPECT_EQ(f.leader.profile[1].time, 4.0);
  EXPECT_EQ(f.controller_options.smoothing, true);
  EXPECT_EQ(f.controller_options.side_commitment, false);
  EXPECT_EQ(f.controller_options.brake_point, std::nullopt);
  EXPECT_EQ(f.controller_options.acceleration_bound, 12.0);
}

TEST(ScenarioKeys, EveryPatternAndTopologyRuns) {
  for (const char* pattern : {"line", "wedge", "circle", "grid"}) {
    const std::string text = std::string(R"("topology": { "complete": true }, "leader": { "path": [[0, 0], [9, 0]],
      "profile": { "knots": [[0, 0.5], [3, 2]] } }, "pattern": { "spacing": 2, "name": ")") +
                             pattern + "\" }";
    const formation::Scenario s = datasets::parse_scenario(five(text), "five.json", ".");
    EXPECT_LT(run(s, {}).metrics.formation_position_error.value(), 1e-9) << pattern;
  }
}

TEST(ScenarioKeys, TheSwitchesChangeTheRun) {
  const std::string rest = R"("topology": { "complete": true }, "offsets": [[0,0],[2,0],[4,0],[2,2],[0,2]],
    "leader": { "path": [[0, 0], [9, 0]], "profile": { "legs": [2] } })";
  const auto chosen = [&](const std::string& controller_options) {
    const formation::Scenario s = datasets::parse_scenario(five(rest + controller_options), "five.json", ".");
    return formation::simulate(s).steps[40].robots[3].chosen;
  };
  EXPECT_EQ(chosen(""), chosen(R"(, "controller_options": {})"));
  for (const char* off : {"saturation", "filter_last", "brake_point", "absolute_frame", "signs", "recentred"})
    EXPECT_FALSE(chosen("") == chosen(std::string(", \"controller_options\": { \"") + off + "\": false }")) << off;
}

TEST(ScenarioKeys, FormationsWrittenAndReadAgain) {
  const std::string once = datasets::write_scenario(datasets::parse_scenario(five(kWedge), "five.json", "."));
  EXPECT_EQ(datasets::write_scenario(datasets::parse_scenario(once, "again.json", ".")), once);
  EXPECT_NE(once.find("\"smoothing\": true"), std::string::npos);
  EXPECT_NE(once.find("\"knots\""), std::string::npos);
}

TEST(ScenarioKeys, WhatDoesNotFitIsRefused) {
  const std::string rest = R"(, "leader": { "path": [[0, 0], [9, 0]], "speed": 1 })";
  const char* const kGrid = R"("pattern": { "name": "grid", "spacing": 2 })";
  const std::string bad[] = {
      std::string(kGrid) + R"(, "topology": { "neighbours_within": 2.5, "pinned": ["z"] })" + rest,
      std::string(kGrid) + R"(, "offsets": [[0, 0]], "topology": { "complete": true })" + rest,
      R"("pattern": { "name": "star", "spacing": 2 }, "topology": { "complete": true })" + rest,
      R"("pattern": { "name": "line", "spacing": 2, "heading": [0, 0] }, "topology": { "complete": true })" + rest,
      R"("topology": { "complete": true })" + rest,
      std::string(kGrid) + R"(, "topology": { "complete": true }, "leader": { "path": [[0, 0], [9, 0]] })",
      std::string(kGrid) + R"(, "topology": { "complete": true },
        "leader": { "path": [[0, 0], [9, 0]], "profile": { "legs": [1, 2] } })",
      std::string(kGrid) + R"(, "topology": { "complete": true },
        "leader": { "path": [[0, 0], [9, 0]], "speed": 1, "profile": { "legs": [1] } })",
      std::string(kGrid) + R"(, "topology": { "complete": true }, "controller_options": { "smothing": true })" + rest};
  for (const std::string& text : bad) EXPECT_THROW(spec_of(text), datasets::DataError) << text;
}

}  // namespace
}  // namespace exactvo::test
