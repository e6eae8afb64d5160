// SPDX-License-Identifier: GPL-3.0-or-later
// Which robot waits for which: rows made by hand, and a run whose end is known.
#include "exactvo/formation/waiting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Robots that all want to go right and stand; `edges`: the robots that each waits for, nearest first.
struct Row {
  Scenario scenario;
  Step step;

  explicit Row(const std::vector<std::vector<std::size_t>>& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      scenario.robots.emplace_back().id = "R" + std::to_string(i + 1);
      RobotStep& r = step.robots.emplace_back();
      r.preferred = {1.0, 0.0};
      for (const std::size_t j : edges[i]) {
        DecisionConstraint& c = r.constraints.emplace_back();
        c.source = ConstraintSource::robot;
        c.hard = false;
        c.index = j;
        c.half_plane = {{-1.0, 0.0}, 0.0};
      }
    }
  }
  WaitForGraph graph() const { return waiting_in(scenario, step); }
  std::string words(std::size_t i) const { return waiting_words(scenario, step, graph(), i); }
};

TEST(Waiting, ACycleIsADeadlockThatEachOfItsRobotsNames) {
  const Row row({{1}, {2}, {0}, {1}});
  EXPECT_THAT(deadlocks_in(row.graph()), ElementsAre(ElementsAre(0, 1, 2)));
  EXPECT_EQ(row.words(1), "R2 waits for R3, which waits for R1, which waits for R2: a deadlock of three");
  EXPECT_EQ(row.words(3), "R4 waits for R2, which is in a deadlock of three");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(is_dead(row.scenario, row.graph(), row.step, i));
}

TEST(Waiting, TheRobotThatPressesMostComesFirst) {
  Row row({{1, 2}, {0}, {}});
  row.step.robots[0].constraints[1].multiplier = 0.5;
  EXPECT_THAT(row.graph()[0], ElementsAre(2, 1));
  EXPECT_THAT(deadlocks_in(row.graph()), IsEmpty());
}

TEST(Waiting, ARobotThatRestsAtItsGoalIsNoDeadlockAndMakesOne) {
  Row row({{1}, {}});
  row.step.robots[1].mode = Mode::arrived;
  EXPECT_EQ(row.words(0), "R1 waits for R2, which rests at its goal");
  EXPECT_TRUE(is_dead(row.scenario, row.graph(), row.step, 0));
  EXPECT_THAT(deadlocks_in(row.graph()), IsEmpty());
}

TEST(Waiting, ARobotAtTheEndOfAQueueHasAReasonToStay) {
  Row row({{1}, {2}, {}});
  for (Robot& r : row.scenario.robots) r.goals = {{9.0, 0.0}};
  row.scenario.robots[0].goals = row.scenario.robots[2].goals = {{-9.0, 0.0}};
  row.step.robots[2].mode = Mode::staying;
  EXPECT_THAT(row.words(0), HasSubstr("which waits for R3, which stays, since its goal is out of reach"));
  row.step.robots[1].constraints.clear();
  row.step.robots[1].mode = Mode::staying;
  row.step.robots[2].mode = Mode::arrived;
  row.scenario.robots[2].goals = {{9.4, 0.0}};
  row.step.robots[2].position = {9.4, 0.0};
  EXPECT_EQ(row.words(0), "R1 waits for R2, which stays, since R3 was first at its goal, 0.4 m from that of R2");
  EXPECT_EQ(why_it_stays(row.scenario, row.step, 1), "R3 was first at its goal, 0.4 m from that of R2");
}

TEST(Waiting, AQueueBehindOneThatMovesIsAlive) {
  Row row({{1}, {2}, {3}, {}});
  row.step.robots[3].chosen = {1.0, 0.0};
  EXPECT_EQ(row.words(0), "queue of 4: R1 waits for R2, which waits for R3, which waits for R4, which moves");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(is_dead(row.scenario, row.graph(), row.step, i));
}

/// What counts as standing was a speed in m/s: slow robots stood, whatever they did.
TEST(Waiting, ASlowRobotThatDrivesAsFastAsItCanMoves) {
  Row row({{1}, {}});
  for (Robot& r : row.scenario.robots) r.max_speed = 0.05;
  for (RobotStep& r : row.step.robots) r.preferred = {0.05, 0.0};
  row.step.robots[1].chosen = {0.05, 0.0};
  EXPECT_FALSE(is_dead(row.scenario, row.graph(), row.step, 0));
  EXPECT_EQ(row.words(0), "R1 waits for R2, which moves");
  for (RobotStep& r : row.step.robots) r.preferred = {1e-3, 0.0};
  EXPECT_THAT(row.graph()[0], ElementsAre(1));
}

TEST(Waiting, ARobotThatGetsWhatItPrefersOrIsFarWaitsForNone) {
  Row fast({{1}, {0}});
  fast.step.robots[0].chosen = {kHeldBelow, 0.0};
  EXPECT_THAT(fast.graph(), ElementsAre(IsEmpty(), ElementsAre(0)));
  Row far({{1}, {0}});
  far.step.robots[0].constraints[0].clearance = far.scenario.robots[0].radius;
  EXPECT_THAT(far.graph(), ElementsAre(IsEmpty(), ElementsAre(0)));
  EXPECT_EQ(far.words(0), "");
  Row beside({{1}, {0}});
  beside.step.robots[0].constraints[0].half_plane = {{0.0, 1.0}, 0.0};
  EXPECT_THAT(beside.graph()[0], IsEmpty());
}

TEST(Waiting, ALongCycleIsAbridged) {
  std::vector<std::vector<std::size_t>> edges;
  for (std::size_t i = 0; i < 12; ++i) edges.push_back({(i + 1) % 12});
  EXPECT_THAT(Row(edges).words(0), HasSubstr(" and so on through six more to R1: a deadlock of 12"));
}

TEST(Waiting, AFormationHasNoneWhileItsLeaderDrives) {
  Row row({{1}, {0}});
  Leader& leader = row.scenario.formation.emplace().leader;
  leader.path = {{0.0, 0.0}, {10.0, 0.0}};
  leader.speed = 1.0;
  row.step.time = 5.0;
  EXPECT_THAT(row.graph(), ElementsAre(IsEmpty(), IsEmpty()));
  row.step.time = 60.0;
  EXPECT_THAT(row.graph(), ElementsAre(ElementsAre(1), ElementsAre(0)));
}

/// Two that meet in a corridor in which they cannot pass: outcome, metrics and reports name the deadlock.
TEST(Waiting, TwoHeadOnInACorridorAreADeadlockOfTwo) {
  Scenario s;
  s.liveness = Liveness::bias;
  s.time_limit = 15.0;
  s.obstacles = {{"north", geometry::Polyline{{{-20, 0.8}, {20, 0.8}}}},
                 {"south", geometry::Polyline{{{-20, -0.8}, {20, -0.8}}}}};
  for (const double side : {-1.0, 1.0}) {
    Robot& r = s.robots.emplace_back();
    r.id = side < 0.0 ? "W" : "E";
    r.position = {5.0 * side, 0.0};
    r.goals = {{-5.0 * side, 0.0}};
  }
  const Metrics m = measure(s, simulate(s));
  EXPECT_THAT(m.deadlock, ElementsAre("W", "E"));
  EXPECT_THAT(m.outcome, HasSubstr("; W waits for E, which waits for W: a deadlock of two"));
  ASSERT_EQ(m.stuck.size(), 2u);
  EXPECT_THAT(m.stuck[1], HasSubstr("E waits for W, which waits for E: a deadlock of two"));
}

}  // namespace
}  // namespace exactvo::formation
