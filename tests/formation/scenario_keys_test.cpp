// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of what moves and who does not yield, from JSON and back.
#include <gtest/gtest.h>

#include "exactvo/datasets/data_error.h"
#include "paper_scenes.h"

namespace exactvo::test {
namespace {

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

}  // namespace
}  // namespace exactvo::test
