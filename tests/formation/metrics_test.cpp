// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of recordings made by hand, where every answer is known.
#include "exactvo/formation/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "exactvo/formation/simulation.h"

namespace exactvo::formation {
namespace {

Scenario scene_of(std::vector<Vec2> goals) {
  Scenario s;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    Robot r;
    r.id = "R" + std::to_string(i + 1);
    r.goals = {goals[i]};
    s.robots.push_back(r);
  }
  return s;
}

RobotStep at(Vec2 position, Vec2 velocity = {}) {
  RobotStep r;
  r.position = position;
  r.velocity = velocity;
  return r;
}

/// m: what a certified clearance lies below the true one, a few metres from the origin: 2^-45 of the coordinates.
constexpr double kRoundingTaken = 1e-11;

/// Rows a second apart.
Recording recording_of(const std::vector<std::vector<RobotStep>>& rows) {
  Recording rec;
  rec.time_step = 1.0;
  rec.bodies = {{vo::BodyKind::enclosure, geometry::Disc{{20.0, 0.0}, 1.0}, {}, {0}}};  // of all half-planes
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Step row;
    row.time = static_cast<double>(k);
    row.robots = rows[k];
    rec.steps.push_back(row);
  }
  return rec;
}

TEST(Metrics, ArrivalIsWhenTheRobotStaysNotWhenItPasses) {
  const Scenario s = scene_of({{2.0, 0.0}});
  const Recording rec = recording_of({{at({0, 0})}, {at({2, 0})}, {at({3, 0})}, {at({2, 0})}, {at({2.05, 0})}});
  const Metrics m = measure(s, rec);
  EXPECT_TRUE(m.all_arrived);
  EXPECT_EQ(m.last_arrival_time.value(), 3.0);
  EXPECT_DOUBLE_EQ(m.robots[0].path_length, 2.0 + 1.0 + 1.0 + 0.05);
  EXPECT_EQ(m.steps, 4u);
  EXPECT_FALSE(m.min_obstacle_clearance.has_value());
  EXPECT_FALSE(m.min_robot_clearance.has_value());
}

TEST(Metrics, ARobotThatSkipsAGoalOnTheWayHasNotArrived) {
  Scenario s = scene_of({{2.0, 0.0}});
  s.robots[0].goals = {{10.0, 0.0}, {2.0, 0.0}};
  EXPECT_FALSE(measure(s, recording_of({{at({2, 0})}, {at({2, 0})}})).all_arrived);
  const Metrics m = measure(s, recording_of({{at({2, 0})}, {at({9.8, 0})}, {at({2, 0})}, {at({2, 0})}}));
  EXPECT_EQ(m.last_arrival_time.value(), 2.0);
}

/// It passed the first goal beside a robot that rests there, as rows do not show.
TEST(Metrics, ARobotThatComesToItsLastGoalHasArrivedWhateverItPassed) {
  Scenario s = scene_of({{2.0, 0.0}});
  s.robots[0].goals = {{10.0, 0.0}, {2.0, 0.0}};
  const Metrics m = measure(s, recording_of({{at({0, 0})}, {at({8, 0})}, {at({2, 0})}, {at({2, 0})}}));
  EXPECT_TRUE(m.all_arrived);
  EXPECT_EQ(m.last_arrival_time.value(), 2.0);
  EXPECT_FALSE(measure(s, recording_of({{at({0, 0})}, {at({2, 0})}, {at({8, 0})}})).all_arrived);
}

TEST(Metrics, ARobotThatEndsElsewhereHasNotArrived) {
  const Metrics m = measure(scene_of({{2.0, 0.0}}), recording_of({{at({2, 0})}, {at({5, 0})}}));
  EXPECT_FALSE(m.all_arrived);
  EXPECT_FALSE(m.last_arrival_time.has_value());
}

TEST(Metrics, AThinWallCrossedBetweenSamplesIsSeen) {
  Scenario s = scene_of({{4.0, 0.0}});
  s.obstacles = {{"wall", geometry::Polyline{{{2.0, -1.0}, {2.0, 1.0}}}}};
  const Metrics m = measure(s, recording_of({{at({0, 0})}, {at({4, 0})}}));
  EXPECT_NEAR(m.min_obstacle_clearance.value(), -0.5, kRoundingTaken);
  EXPECT_LE(m.min_obstacle_clearance.value(), -0.5);
}

TEST(Metrics, TwoRobotsThatSwapPlacesBetweenSamplesCollide) {
  const Scenario s = scene_of({{4.0, 0.0}, {0.0, 0.0}});
  const Metrics m = measure(s, recording_of({{at({0, 0}), at({4, 0})}, {at({4, 0}), at({0, 0})}}));
  EXPECT_NEAR(m.min_robot_clearance.value(), -1.0, kRoundingTaken);
  EXPECT_LE(m.min_robot_clearance.value(), -1.0);
}

TEST(Metrics, RobotsThatPassAtDifferentTimesDoNot) {
  // Both paths cross (2, 0); one gets there a second after the other.
  const Scenario s = scene_of({{4.0, 0.0}, {2.0, 10.0}});
  const Recording rec =
      recording_of({{at({0, 0}), at({2, -10})}, {at({4, 0}), at({2, -10})}, {at({4, 0}), at({2, 10})}});
  EXPECT_NEAR(measure(s, rec).min_robot_clearance.value(), 1.0, 1e-12);
}

TEST(Metrics, ACurvedStepIsBoundedNotSampled) {
  // v' = -k (v - w) from (0, 2) to w = (2, 0): the path bulges to the left of its chord; a wall along the bulge is met.
  Scenario s = scene_of({{2.0, 0.0}});
  s.robots[0].radius = 0.01;
  Recording rec = recording_of({{}, {}});
  rec.motion = MotionLaw::exponential;
  rec.tracking_gain = 2.0;
  const double decayed = std::exp(-2.0), lag = (1.0 - decayed) / 2.0;
  const Vec2 w{2.0, 0.0}, v0{0.0, 2.0};
  rec.steps[0].robots = {at({0, 0}, v0)};
  rec.steps[1].robots = {at(w + lag * (v0 - w), w + decayed * (v0 - w))};
  const auto on_path = [&](double t) { return t * w + ((1.0 - std::exp(-2.0 * t)) / 2.0) * (v0 - w); };
  s.obstacles = {{"speck", geometry::Polyline{{on_path(0.4), on_path(0.4) + Vec2{0.0, 1e-3}}}}};
  const double clearance = measure(s, rec).min_obstacle_clearance.value();
  EXPECT_LE(clearance, -0.01 + 1e-12);
  EXPECT_GT(clearance, -0.01 - 1e-3);  // and not far below the truth: the bound is sharp
}

TEST(Metrics, JitterSumsTheChangesOfAcceleration) {
  // Velocities 0, 1, 0, 1 a second apart: accelerations 1, -1, 1; their changes 2 and 2.
  const Recording rec =
      recording_of({{at({0, 0}, {0, 0})}, {at({0, 0}, {1, 0})}, {at({1, 0}, {0, 0})}, {at({1, 0}, {1, 0})}});
  EXPECT_DOUBLE_EQ(measure(scene_of({{9.0, 0.0}}), rec).jitter, 4.0);
}

TEST(Metrics, HeadingReversalsCountChangesOfTurningSense) {
  const auto heading = [](double angle) { return at({0, 0}, {std::cos(angle), std::sin(angle)}); };
  const Recording left_right_left =
      recording_of({{heading(0.0)}, {heading(0.1)}, {heading(0.0)}, {heading(0.1)}, {heading(0.2)}});
  EXPECT_EQ(measure(scene_of({{9.0, 0.0}}), left_right_left).heading_reversals, 2u);
  const Recording below_notice = recording_of({{heading(0.0)}, {heading(5e-4)}, {heading(0.0)}, {heading(5e-4)}});
  EXPECT_EQ(measure(scene_of({{9.0, 0.0}}), below_notice).heading_reversals, 0u);
}

TEST(Metrics, HeadingReversalsLeaveOutRobotsAtRest) {
  const auto heading = [](double angle, double speed) {
    return at({0, 0}, {speed * std::cos(angle), speed * std::sin(angle)});
  };
  std::vector<std::vector<RobotStep>> rows;
  for (int k = 0; k < 20; ++k) rows.push_back({heading(k % 2 == 0 ? 0.0 : 2.0, 1e-12)});
  EXPECT_EQ(measure(scene_of({{9.0, 0.0}}), recording_of(rows)).heading_reversals, 0u);
  for (std::vector<RobotStep>& row : rows) row[0].velocity = 1e12 * row[0].velocity;
  EXPECT_GT(measure(scene_of({{9.0, 0.0}}), recording_of(rows)).heading_reversals, 10u);
}

RobotStep with_active(std::vector<std::size_t> indices) {
  RobotStep r = at({0, 0});
  for (std::size_t i : indices) {
    DecisionConstraint c;
    c.index = i;
    c.active = true;
    r.constraints.push_back(c);
  }
  return r;
}

TEST(Metrics, ASlideFromOneEdgeToTheNextIsASwitch) {
  // The usual method's constraint is the edge, not the whole obstacle: a number stands for one edge.
  Scenario s = scene_of({{12.0, 0.0}});
  s.obstacles = {{"before", geometry::Polyline{{{0.0, 20.0}, {9.0, 20.0}}}},
                 {"roof", geometry::Polygon{{{9.0, -1.0}, {8.0, -0.2}, {7.0, 0.2}, {6.0, -0.2}, {5.0, -1.0}}, {}}}};
  SimulationOptions orca;
  orca.method = Method::orca;
  orca.guidance = Guidance::none;  // into the roof, not round it
  orca.liveness = Liveness::off;
  s.time_limit = 20.0;
  const Recording rec = simulate(s, orca);
  std::map<std::size_t, std::string> edges;
  for (const Step& row : rec.steps)
    for (const DecisionConstraint& c : row.robots[0].constraints) {
      const std::string edge = geometry::to_string(rec.bodies.at(c.body).shape);
      EXPECT_EQ(edges.emplace(c.index, edge).first->second, edge);
    }
  EXPECT_GE(edges.size(), 2u);
  EXPECT_GE(measure(s, rec).active_set_switches, 2u);
}

TEST(Metrics, PiecesOfOneEnclosureAreToldApart) {
  RobotStep first = with_active({1}), second = with_active({1});
  second.constraints[0].piece = 2;
  const Metrics m = measure(scene_of({{9.0, 0.0}}), recording_of({{first}, {second}, {first}, {at({0, 0})}}));
  EXPECT_EQ(m.active_set_switches, 2u);
}

TEST(Metrics, VelocityVariationAndPeakAcceleration) {
  const Recording rec = recording_of({{at({0, 0}, {0, 0})}, {at({0, 0}, {3, 0})}, {at({1, 0}, {3, 4})}});
  const Metrics m = measure(scene_of({{9.0, 0.0}}), rec);
  EXPECT_DOUBLE_EQ(m.velocity_variation, 7.0);
  EXPECT_DOUBLE_EQ(m.peak_acceleration, 4.0);
}

TEST(Metrics, ClearancesFarFromTheOriginAreLowerBoundsToo) {
  // A kilometre out the wall lies a radius away, up to rounding: contact, and no clearance may be promised.
  Scenario s = scene_of({{1000.0, 4.0}});
  s.robots[0].radius = 0.3;
  s.obstacles = {{"wall", geometry::Polyline{{{1000.3, -9.0}, {1000.3, 9.0}}}}};
  const Metrics m = measure(s, recording_of({{at({1000.0, 0.0})}, {at({1000.0, 4.0})}}));
  EXPECT_EQ(m.min_obstacle_clearance.value(), 0.0);
  EXPECT_FALSE(is_safe(m));
}

TEST(Metrics, ActiveSetSwitchesIgnoreTheOrder) {
  const Recording rec = recording_of(
      {{with_active({1, 2})}, {with_active({2, 1})}, {with_active({2})}, {with_active({2})}, {with_active({})}});
  // The last row is the final state: its decisions do not count.
  EXPECT_EQ(measure(scene_of({{9.0, 0.0}}), rec).active_set_switches, 1u);
}

TEST(Metrics, CountsRelaxedAndUncertifiedDecisions) {
  RobotStep relaxed = at({0, 0});
  relaxed.status = lp::Status::relaxed;
  relaxed.uncertified = 3;
  const Metrics m = measure(scene_of({{9.0, 0.0}}), recording_of({{relaxed}, {relaxed}, {at({0, 0})}}));
  EXPECT_EQ(m.relaxed_steps, 2u);
  EXPECT_EQ(m.uncertified_half_planes, 6u);
}

TEST(Metrics, FormationErrorIsMeasuredFromTheOffsetsInUse) {
  Scenario s = scene_of({{0.0, 0.0}});
  s.robots[0].goals.clear();
  s.formation.emplace();
  s.formation->leader = {{{{0.0, 0.0}, {2.0, 0.0}}, 1.0}};
  s.formation->topology = {{{0.0}}, {1.0}};
  Recording rec = recording_of({{at({1, 1}, {1, 0})}, {at({2, 1}, {1, 0})}, {at({3, 1.5}, {0.25, 0})}});
  for (std::size_t k = 0; k < 3; ++k) rec.steps[k].leader_position = {static_cast<double>(k), 0.0};
  rec.offsets = {{1.0, 1.0}};
  const Metrics m = measure(s, rec);
  EXPECT_DOUBLE_EQ(m.formation_position_error.value(), 0.5);
  EXPECT_DOUBLE_EQ(m.formation_velocity_error.value(), 0.25);
  EXPECT_DOUBLE_EQ(m.leader_arrival_time.value(), 2.0);
}

}  // namespace
}  // namespace exactvo::formation
