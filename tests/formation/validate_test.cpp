// SPDX-License-Identifier: GPL-3.0-or-later
// validate() names the field, what was found and what was expected, one broken field a row.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

struct Break {
  const char* name;
  const char* pointer;
  std::function<void(Scenario&)> how;
  bool formation = true;  ///< start from B1, else from A2
};

const double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Break> kBreaks = {
    {"NoRobots", "/robots", [](Scenario& s) { s.robots.clear(); }, false},
    {"Radius", "/robots/1/radius", [](Scenario& s) { s.robots[1].radius = 0.0; }},
    {"MaxSpeed", "/robots/0/max_speed", [](Scenario& s) { s.robots[0].max_speed = -1.0; }},
    {"Position", "/robots/0/position", [](Scenario& s) { s.robots[0].position.x = kNan; }},
    {"Velocity", "/robots/2/velocity", [](Scenario& s) { s.robots[2].velocity.y = kNan; }},
    {"NoGoal", "/robots/0/goal", [](Scenario& s) { s.robots[0].goals.clear(); }, false},
    {"GoalNotFinite", "/robots/1/goal", [](Scenario& s) { s.robots[1].goals[0].x = kNan; }, false},
    {"RobotsCoincide", "/robots/1/position", [](Scenario& s) { s.robots[1].position = s.robots[0].position; }},
    {"StartInsideObstacle", "/robots/0/position",
     [](Scenario& s) {
       s.robots[0].position = {10.0, 10.0};
     }},
    {"TimeStep", "/time_step", [](Scenario& s) { s.time_step = 0.0; }},
    {"TimeLimit", "/time_limit", [](Scenario& s) { s.time_limit = -5.0; }},
    {"ArrivalTolerance", "/arrival_tolerance", [](Scenario& s) { s.arrival_tolerance = 0.0; }},
    {"NeighbourDistance", "/neighbour_distance", [](Scenario& s) { s.neighbour_distance = kNan; }},
    {"LeastHorizon", "/horizons/least", [](Scenario& s) { s.horizons.least = 1.5 * s.time_step; }},
    {"MostHorizon", "/horizons/most", [](Scenario& s) { s.horizons.most = 0.1; }},
    {"SpeedFloor", "/horizons/speed_floor", [](Scenario& s) { s.horizons.speed_floor = 0.0; }},
    {"OrcaHorizon", "/horizons/orca", [](Scenario& s) { s.horizons.orca = 0.0; }},
    {"RobotsHorizon", "/horizons/robots", [](Scenario& s) { s.horizons.robots = 0.0; }},
    {"OrcaHorizonBelowAStep", "/horizons/orca", [](Scenario& s) { s.horizons.orca = 0.9 * s.time_step; }},
    {"RobotsHorizonBelowAStep", "/horizons/robots", [](Scenario& s) { s.horizons.robots = 0.9 * s.time_step; }},
    {"ObstacleMargin", "/margins/obstacle", [](Scenario& s) { s.margins.obstacle = -0.1; }},
    {"RobotMargin", "/margins/robot", [](Scenario& s) { s.margins.robot = -0.1; }},
    {"AdjacencyShape", "/formation/topology", [](Scenario& s) { s.formation->topology.adjacency.pop_back(); }},
    {"NegativeWeight", "/formation/topology/adjacency/0/1",
     [](Scenario& s) { s.formation->topology.adjacency[0][1] = s.formation->topology.adjacency[1][0] = -1.0; }},
    {"AsymmetricWeight", "/formation/topology/adjacency/0/1",
     [](Scenario& s) { s.formation->topology.adjacency[0][1] = 2.0; }},
    {"NegativePinning", "/formation/topology/pinning/0", [](Scenario& s) { s.formation->topology.pinning[0] = -1.0; }},
    {"NobodyPinned", "/formation/topology",
     [](Scenario& s) {
       s.formation->topology.pinning = {0.0, 0.0, 0.0};
     }},
    {"Disconnected", "/formation/topology",
     [](Scenario& s) {
       s.formation->topology.adjacency = {{0, 1, 0}, {1, 0, 0}, {0, 0, 0}};
       s.formation->topology.pinning = {1, 0, 0};
     }},
    {"OffsetCount", "/formation/offsets", [](Scenario& s) { s.formation->offsets.pop_back(); }},
    {"OffsetNotFinite", "/formation/offsets/1", [](Scenario& s) { s.formation->offsets[1].x = kNan; }},
    {"LeaderPath", "/formation/leader/path", [](Scenario& s) { s.formation->leader.path.clear(); }},
    {"LeaderSpeed", "/formation/leader/speed", [](Scenario& s) { s.formation->leader.speed = -1.0; }},
    {"K1", "/formation/gains/k1", [](Scenario& s) { s.formation->gains.k1 = 0.0; }},
    {"K2", "/formation/gains/k2", [](Scenario& s) { s.formation->gains.k2 = -0.45; }},
    {"K3", "/formation/gains/k3", [](Scenario& s) { s.formation->gains.k3 = 0.0; }},
    {"Kappa", "/formation/gains/kappa", [](Scenario& s) { s.formation->gains.kappa = kNan; }},
    {"CatchUpSpeed", "/formation/catch_up_speed", [](Scenario& s) { s.formation->catch_up_speed = 0.0; }},
};

class Validate : public testing::TestWithParam<Break> {};

TEST_P(Validate, NamesTheField) {
  Scenario scenario = test::paper_scene(GetParam().formation ? "B1" : "A2");
  ASSERT_TRUE(validate(scenario).empty());
  GetParam().how(scenario);
  const std::vector<ScenarioProblem> problems = validate(scenario);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.front().pointer, GetParam().pointer);
  EXPECT_FALSE(problems.front().found.empty());
  EXPECT_FALSE(problems.front().expected.empty());
  EXPECT_THROW(simulate(scenario), std::logic_error);
}

INSTANTIATE_TEST_SUITE_P(Fields, Validate, testing::ValuesIn(kBreaks),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace exactvo::formation
