// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/rvo2/RVO.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <vector>

namespace {

using exactvo::formation::CrowdError;
using exactvo::formation::CrowdProblem;
using RVO::RVOSimulator;
using RVO::Vector2;

/// Straight for the goals, slower in the last metre.
void head_for(RVOSimulator& sim, const std::vector<Vector2>& goals) {
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const Vector2 way = goals[i] - sim.getAgentPosition(i);
    sim.setAgentPrefVelocity(i, RVO::absSq(way) > 1.0F ? RVO::normalize(way) : way);
  }
}

std::size_t steps_to(RVOSimulator& sim, const std::vector<Vector2>& goals, float within, std::size_t most) {
  for (std::size_t steps = 0;; ++steps) {
    bool there = true;
    for (std::size_t i = 0; i < goals.size(); ++i)
      there = there && RVO::abs(sim.getAgentPosition(i) - goals[i]) <= within;
    if (there || steps == most) return steps;
    head_for(sim, goals);
    sim.doStep();
  }
}

void expect_problem(CrowdProblem expected, const std::function<void()>& what) {
  try {
    what();
    FAIL() << "nothing was refused";
  } catch (const CrowdError& e) {
    EXPECT_EQ(e.problem(), expected) << e.what();
  }
}

TEST(Rvo2, VectorsCalculateAsTheirNamesSay) {
  const Vector2 a(3.0F, 4.0F), b(1.0F, -2.0F);
  EXPECT_EQ(a + b, Vector2(4.0F, 2.0F));
  EXPECT_EQ(a - b, Vector2(2.0F, 6.0F));
  EXPECT_EQ(-b, Vector2(-1.0F, 2.0F));
  EXPECT_EQ(a * b, -5.0F);
  EXPECT_EQ(2.0F * a, Vector2(6.0F, 8.0F));
  EXPECT_EQ(a / 2.0F, Vector2(1.5F, 2.0F));
  EXPECT_EQ(RVO::abs(a), 5.0F);
  EXPECT_EQ(RVO::absSq(a), 25.0F);
  EXPECT_EQ(RVO::det(a, b), -10.0F);
  EXPECT_GT(RVO::leftOf({0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}), 0.0F);
  EXPECT_EQ(RVO::normalize(a), Vector2(0.6F, 0.8F));
  Vector2 c = a;
  c += b;
  c *= 2.0F;
  c -= a;
  c /= 0.5F;
  EXPECT_EQ(c, Vector2(10.0F, 0.0F));
  EXPECT_NE(c, a);
  std::ostringstream text;
  text << Vector2(1.0F, 2.5F);
  EXPECT_EQ(text.str(), "(1,2.5)");
}

TEST(Rvo2, WithoutDefaultsNoAgentIsAdded) {
  RVOSimulator sim;
  EXPECT_EQ(sim.addAgent({0.0F, 0.0F}), RVO::RVO_ERROR);
  EXPECT_EQ(sim.addObstacle({{0.0F, 0.0F}}), RVO::RVO_ERROR);
  sim.setAgentDefaults(15.0F, 10, 5.0F, 4.0F, 0.5F, 2.0F, {0.25F, 0.0F});
  EXPECT_EQ(sim.addAgent({1.0F, 2.0F}), 0U);
  EXPECT_EQ(sim.getAgentVelocity(0), Vector2(0.25F, 0.0F));
  EXPECT_EQ(sim.getAgentTimeHorizonObst(0), 4.0F);
  EXPECT_EQ(sim.getNumAgents(), 1U);
}

// Figures of RVO2 2.x (gamma.cs.unc.edu/RVO2) on the same scenes, run once with this file's `steps_to`.

TEST(Rvo2, ARingOfAgentsSwapsPlacesInNoMoreStepsThanRvo2Takes) {
  constexpr double kStepsOfRvo2 = 882.0;
  RVOSimulator sim(0.25F, 15.0F, 10, 10.0F, 10.0F, 1.5F, 2.0F);
  std::vector<Vector2> goals;
  for (int i = 0; i < 60; ++i) {
    const float angle = static_cast<float>(i) * 6.2831853F / 60.0F;
    sim.addAgent(50.0F * Vector2(std::cos(angle), std::sin(angle)));
    goals.push_back(-sim.getAgentPosition(sim.getNumAgents() - 1));
  }
  EXPECT_LE(static_cast<double>(steps_to(sim, goals, 1.5F, 2000)), kStepsOfRvo2);
}

TEST(Rvo2, TwoRanksThroughEachOtherEndWhereThoseOfRvo2End) {
  RVOSimulator sim(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  std::vector<Vector2> goals;
  for (int i = 0; i < 10; ++i) {
    const float y = 2.0F * static_cast<float>(i);
    sim.addAgent({-12.0F, y});
    sim.addAgent({12.0F, y + 0.3F});
    goals.push_back({12.0F, y});
    goals.push_back({-12.0F, y + 0.3F});
  }
  EXPECT_EQ(steps_to(sim, goals, 0.2F, 2000), 98U);
  EXPECT_LT(RVO::abs(sim.getAgentPosition(0) - Vector2(11.8141F, -0.0042F)), 1e-3F);
  EXPECT_LT(RVO::abs(sim.getAgentPosition(5) - Vector2(-11.8141F, 4.3042F)), 1e-3F);
  EXPECT_LT(RVO::abs(sim.getAgentPosition(11) - Vector2(-11.8168F, 10.3040F)), 1e-3F);
  EXPECT_EQ(sim.getGlobalTime(), 24.5F);
}

class Rvo2Block : public testing::Test {
 protected:
  Rvo2Block() : sim(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F) {
    EXPECT_EQ(sim.addObstacle({{-2.0F, -1.0F}, {2.0F, -1.0F}, {2.0F, 2.0F}, {-2.0F, 2.0F}}), 0U);
    sim.processObstacles();
  }
  RVOSimulator sim;
};

TEST_F(Rvo2Block, AgentsPassItOrStopBeforeItAsThoseOfRvo2Do) {
  std::vector<Vector2> goals, ends;
  for (int i = 0; i < 6; ++i) {
    const float y = 0.9F * static_cast<float>(i) - 4.0F;
    sim.addAgent({-8.0F, y});
    goals.push_back({8.0F, y});
    ends.push_back({i < 4 ? 8.0F : -2.4F, y});
  }
  EXPECT_EQ(steps_to(sim, goals, 0.2F, 400), 400U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_LT(RVO::abs(sim.getAgentPosition(i) - ends[i]), 2e-3F) << i;
}

TEST_F(Rvo2Block, VisibilityIsThatOfRvo2) {
  EXPECT_FALSE(sim.queryVisibility({-5.0F, 0.0F}, {5.0F, 0.0F}));
  EXPECT_TRUE(sim.queryVisibility({-5.0F, 0.0F}, {-5.0F, 5.0F}));
  EXPECT_TRUE(sim.queryVisibility({-5.0F, 2.5F}, {5.0F, 2.5F}, 0.5F));  // touches
  EXPECT_FALSE(sim.queryVisibility({-5.0F, 2.5F}, {5.0F, 2.5F}, 0.51F));
  EXPECT_FALSE(sim.queryVisibility({-3.0F, 2.5F}, {3.0F, 2.5F}, std::nextafter(0.5F, 1.0F)));
  EXPECT_FALSE(sim.queryVisibility({-3.0F, 3.0F}, {-1.0F, 1.5F}));  // ends inside
}

/// An agent that a rounding error has put nearer to a wall than its radius is not blind.
TEST_F(Rvo2Block, FromBesideAnEdgeTheWayAwayAndAlongItIsVisible) {
  const float near = std::nextafter(2.5F, 0.0F);
  EXPECT_TRUE(sim.queryVisibility({-1.0F, near}, {-1.0F, 9.0F}, 0.5F));
  EXPECT_TRUE(sim.queryVisibility({-1.0F, near}, {6.0F, 2.5F}, 0.5F));
  EXPECT_TRUE(sim.queryVisibility({6.0F, 2.5F}, {-1.0F, near}, 0.5F));
  EXPECT_FALSE(sim.queryVisibility({-1.0F, near}, {1.0F, 2.4F}, 0.5F) &&
               sim.queryVisibility({-5.0F, 2.6F}, {5.0F, 2.4F}, 0.5F));
  EXPECT_FALSE(sim.queryVisibility({-1.0F, near}, {1.0F, -3.0F}, 0.5F));
}

TEST_F(Rvo2Block, ObstaclesAreInTheWayOnceTheyAreProcessed) {
  sim.addObstacle({{-5.0F, -9.0F}, {-5.0F, 9.0F}});
  EXPECT_EQ(sim.getNumObstacleVertices(), 6U);
  EXPECT_EQ(sim.getNextObstacleVertexNo(3), 0U);
  EXPECT_EQ(sim.getPrevObstacleVertexNo(4), 5U);
  EXPECT_EQ(sim.getObstacleVertex(1), Vector2(2.0F, -1.0F));
  EXPECT_TRUE(sim.queryVisibility({-6.0F, 5.0F}, {-4.0F, 5.0F}));
  sim.addAgent({-6.0F, 5.0F}, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  sim.setAgentPrefVelocity(0, {1.0F, 0.0F});
  sim.doStep();
  EXPECT_EQ(sim.getAgentPosition(0), Vector2(-5.75F, 5.0F));
  sim.processObstacles();
  EXPECT_FALSE(sim.queryVisibility({-6.0F, 5.0F}, {-4.0F, 5.0F}));
  sim.doStep();
  EXPECT_LT(sim.getAgentVelocity(0).x(), 0.2F);
  ASSERT_EQ(sim.getAgentNumObstacleNeighbors(0), 1U);
  EXPECT_GE(sim.getAgentObstacleNeighbor(0, 0), 4U);
}

TEST(Rvo2, LinesAreThoseOfTheLastStepAndTheVelocityKeepsThem) {
  RVOSimulator sim(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  sim.addAgent({0.0F, 0.0F});
  sim.addAgent({2.0F, 0.1F});
  sim.addAgent({4.0F, 3.0F});
  EXPECT_EQ(sim.getAgentNumORCALines(0), 0U);
  for (int k = 0; k < 2; ++k) {
    sim.setAgentPrefVelocity(0, {1.0F, 0.0F});
    sim.setAgentPrefVelocity(1, {-1.0F, 0.0F});
    sim.doStep();
    ASSERT_EQ(sim.getAgentNumORCALines(0), 2U);
    EXPECT_EQ(sim.getAgentNumAgentNeighbors(0), 2U);
    EXPECT_EQ(sim.getAgentAgentNeighbor(0, 0), 1U);
    EXPECT_EQ(sim.getAgentAgentNeighbor(0, 1), 2U);
    for (std::size_t i : {0U, 1U}) {
      const RVO::Line line = sim.getAgentORCALine(i, 0);
      EXPECT_NEAR(RVO::abs(line.direction), 1.0F, 1e-5F);
      // Binding: on the line, and not to its right.
      EXPECT_NEAR(RVO::det(line.direction, sim.getAgentVelocity(i) - line.point), 0.0F, 1e-4F);
    }
  }
  EXPECT_EQ(sim.getStepReport().robots, 3U);
}

TEST(Rvo2, LinesOfTheLastStepStayWhateverIsSetAfterIt) {
  const auto after_a_step = [](RVOSimulator& sim) {
    sim.addAgent({0.0F, 0.0F});
    sim.addAgent({2.0F, 0.1F});
    sim.addAgent({4.0F, 3.0F});
    sim.addObstacle({{0.0F, 2.0F}, {5.0F, 2.0F}});
    sim.processObstacles();
    sim.setAgentPrefVelocity(0, {1.0F, 0.0F});
    sim.doStep();
  };
  RVOSimulator one(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F), other(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  after_a_step(one);
  after_a_step(other);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  other.setAgentRadius(1, 0.9F);
  other.setAgentMaxNeighbors(0, 1);
  other.setAgentTimeHorizon(0, nan);  // the next step refuses it
  other.setTimeStep(0.5F);
  other.addAgent({-2.0F, 0.0F});
  other.addObstacle({{0.0F, -2.0F}, {5.0F, -2.0F}});
  other.processObstacles();
  for (int again = 0; again < 2; ++again)
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(one.getAgentNumORCALines(i), other.getAgentNumORCALines(i));
      EXPECT_EQ(one.getAgentNumAgentNeighbors(i), other.getAgentNumAgentNeighbors(i));
      EXPECT_EQ(one.getAgentNumObstacleNeighbors(i), other.getAgentNumObstacleNeighbors(i));
      for (std::size_t k = 0; k < one.getAgentNumORCALines(i); ++k) {
        EXPECT_EQ(one.getAgentORCALine(i, k).point, other.getAgentORCALine(i, k).point);
        EXPECT_EQ(one.getAgentORCALine(i, k).direction, other.getAgentORCALine(i, k).direction);
      }
    }
  EXPECT_EQ(other.getAgentNumORCALines(3), 0U) << "added after the step";
}

TEST(Rvo2, WhatIsSetBetweenStepsHolds) {
  RVOSimulator sim(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  sim.addAgent({0.0F, 0.0F});
  sim.setAgentPrefVelocity(0, {9.0F, 0.0F});
  sim.doStep();
  EXPECT_NEAR(sim.getAgentVelocity(0).x(), 1.5F, 1e-4F);
  sim.setAgentMaxSpeed(0, 0.5F);
  sim.setAgentPosition(0, {10.0F, -3.0F});
  sim.setTimeStep(0.5F);
  sim.doStep();
  EXPECT_NEAR(sim.getAgentVelocity(0).x(), 0.5F, 1e-4F);
  EXPECT_NEAR(sim.getAgentPosition(0).x(), 10.25F, 1e-4F);
  EXPECT_EQ(sim.getAgentPosition(0).y(), -3.0F);
  EXPECT_EQ(sim.getGlobalTime(), 0.75F);
  // Slower than the crowd's slowest: RVO2's agents of speed 0 stand, these creep.
  sim.setAgentMaxSpeed(0, 0.0F);
  sim.doStep();
  EXPECT_LE(sim.getAgentVelocity(0).x(), 2.5e-4F);
}

TEST(Rvo2, AThousandAgentsOfParametersOfTheirOwnAndFarOutKeepApart) {
  RVOSimulator sim;
  sim.setTimeStep(0.25F);
  const float far = 40000.0F;  // beyond a lattice of the finest step
  for (int i = 0; i < 1000; ++i) {
    const auto k = static_cast<float>(i);
    sim.addAgent({far + 1.5F * static_cast<float>(i % 40), 1.5F * static_cast<float>(i / 40)}, 8.0F, 10, 3.0F, 3.0F,
                 0.3F + 1e-4F * k, 1.0F + 1e-3F * k);
  }
  for (int step = 0; step < 20; ++step) {
    for (std::size_t i = 0; i < 1000; ++i)
      sim.setAgentPrefVelocity(i, RVO::normalize(Vector2(far + 30.0F, 19.0F) - sim.getAgentPosition(i)));
    sim.doStep();
    EXPECT_EQ(sim.getStepReport().robots, 1000U);
  }
  EXPECT_GT(sim.getStepReport().neighbours, 5000U);
}

TEST(Rvo2, AnAgentGoesOnBeyondTheLatticeItBeganOn) {
  RVOSimulator sim(16.0F, 10.0F, 8, 40.0F, 40.0F, 0.4F, 4.0F);
  sim.addAgent({4000.0F, 0.0F});
  sim.setAgentPrefVelocity(0, {4.0F, 0.0F});
  for (int k = 0; k < 40; ++k) sim.doStep();
  EXPECT_NEAR(sim.getAgentPosition(0).x(), 4000.0F + 40.0F * 64.0F, 0.1F);
}

TEST(Rvo2, WhatRvo2LeavesUndefinedIsRefused) {
  RVOSimulator sim(0.25F, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  sim.addAgent({0.0F, 0.0F});
  expect_problem(CrowdProblem::unknown_robot, [&] { sim.getAgentPosition(1); });
  expect_problem(CrowdProblem::unknown_obstacle, [&] { sim.getObstacleVertex(0); });
  const float nan = std::numeric_limits<float>::quiet_NaN();
  sim.setAgentPrefVelocity(0, {nan, 0.0F});
  expect_problem(CrowdProblem::not_finite, [&] { sim.doStep(); });
  sim.setAgentPrefVelocity(0, {0.0F, 0.0F});
  sim.setAgentRadius(0, nan);
  expect_problem(CrowdProblem::not_finite, [&] { sim.doStep(); });
  sim.setAgentRadius(0, -1.0F);
  expect_problem(CrowdProblem::out_of_range, [&] { sim.doStep(); });
  sim.setAgentRadius(0, 0.4F);
  sim.addAgent({0.0F, 0.0F});
  expect_problem(CrowdProblem::coincident, [&] { sim.doStep(); });
  sim.setAgentPosition(1, {5.0F, 0.0F});
  sim.doStep();
  expect_problem(CrowdProblem::not_finite, [&] { sim.addObstacle({{0.0F, 0.0F}, {nan, 1.0F}}); });
  const float infinite = std::numeric_limits<float>::infinity();
  expect_problem(CrowdProblem::not_finite, [&] { sim.addObstacle({{0.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, -infinite}}); });
  EXPECT_EQ(sim.getNumObstacleVertices(), 0U);
  expect_problem(CrowdProblem::not_finite, [&] { sim.queryVisibility({nan, 0.0F}, {1.0F, 0.0F}); });
  expect_problem(CrowdProblem::not_finite, [&] { sim.queryVisibility({0.0F, 0.0F}, {1.0F, 0.0F}, nan); });
  sim.addObstacle({{9.0F, 9.0F}, {9.0F, 9.0F}, {10.0F, 9.0F}});  // an edge of length 0
  sim.processObstacles();
  sim.doStep();
  RVOSimulator no_time;
  no_time.addAgent({0.0F, 0.0F}, 10.0F, 8, 4.0F, 4.0F, 0.4F, 1.5F);
  expect_problem(CrowdProblem::out_of_range, [&] { no_time.doStep(); });
}

}  // namespace
