// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/metrics_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace exactvo::datasets::test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

RunInfo info() {
  return {"A1", "ivo", std::nullopt, std::nullopt, make_provenance({"exactvo"}, 0)};
}

formation::Metrics metrics() {
  formation::Metrics m;
  m.all_arrived = true;
  m.last_arrival_time = 13.45;
  m.jitter = 1.5;
  m.heading_reversals = 3;
  m.steps = 269;
  m.robots = {{"R1", true, 13.45, 30.25, 0.08}, {"R2", false, std::nullopt, 12.0, std::nullopt}};
  return m;
}

TEST(MetricsFile, TheKeysAreTheseInThisOrder) {
  const Json tree = Json::parse(metrics_json(info(), metrics()));
  EXPECT_EQ(keys_of(tree), (std::vector<std::string>{"scenario",
                                                     "method",
                                                     "controller",
                                                     "arrived",
                                                     "all_arrived",
                                                     "median_arrival_time",
                                                     "last_arrival_time",
                                                     "min_obstacle_clearance",
                                                     "min_robot_clearance",
                                                     "robot_margin",
                                                     "collisions",
                                                     "formation_position_error",
                                                     "formation_velocity_error",
                                                     "leader_arrival_time",
                                                     "formation_course",
                                                     "jitter",
                                                     "velocity_variation",
                                                     "peak_acceleration",
                                                     "heading_reversals",
                                                     "decisions",
                                                     "steps",
                                                     "time",
                                                     "wall_time",
                                                     "digest",
                                                     "outcome",
                                                     "not_measured",
                                                     "warnings",
                                                     "plans",
                                                     "routes",
                                                     "deadlock",
                                                     "stands_still",
                                                     "stuck",
                                                     "lyapunov",
                                                     "robots",
                                                     "provenance"}));
  EXPECT_EQ(keys_of(tree["robots"][0]),
            (std::vector<std::string>{"id", "arrived", "arrival_time", "path_length", "min_obstacle_clearance",
                                      "detour", "largest_slot_error"}));
}

TEST(MetricsFile, ARunOnACrowdHasTheSameKeysAndItsOwnCounts) {
  formation::Metrics m = metrics();
  RunInfo about = info();
  about.decisions = "none";
  const Json with = Json::parse(metrics_json(info(), m));
  m.crowd.emplace();
  m.crowd->cut_short = 7;
  m.crowd->digest = 0xABC;
  m.not_measured = {"clearances"};
  const Json without = Json::parse(metrics_json(about, m));
  EXPECT_EQ(keys_of(with), keys_of(without));
  EXPECT_EQ(keys_of(with["decisions"]), keys_of(without["decisions"]));
  EXPECT_EQ(with["decisions"]["recorded"], "binding");
  EXPECT_EQ(without["decisions"]["recorded"], "none");
  EXPECT_EQ(without["decisions"]["count"], 2 * 269);
  EXPECT_TRUE(with["decisions"]["cut_short"].is_null());
  EXPECT_EQ(without["decisions"]["cut_short"], 7);
  EXPECT_EQ(with["decisions"]["active_set_switches"], 0);
  EXPECT_TRUE(without["decisions"]["active_set_switches"].is_null());
  EXPECT_EQ(without["digest"], "0000000000000abc");
  EXPECT_TRUE(with["digest"].is_null() && with["stands_still"].is_null());
  EXPECT_EQ(without["stands_still"], false);
  EXPECT_EQ(without["not_measured"].dump(), R"(["clearances"])");
}

TEST(MetricsFile, ACollisionHasItsPartnerTimeAndDepth) {
  formation::Metrics m = metrics();
  m.collisions = {{"R1", formation::CollisionKind::moving_obstacle, "cart", 1.75, 3.25, 2.5, 1.5, {2.0, -1.0}, true}};
  const Json c = Json::parse(metrics_json(info(), m))["collisions"][0];
  EXPECT_EQ(c.dump(),
            R"({"robot":"R1","kind":"moving-obstacle","with":"cart","from":1.75,"until":3.25,"deepest_at":2.5,)"
            R"("depth":1.5,"place":[2,-1],"relaxed":true})");
  EXPECT_EQ(Json::parse(metrics_json(info(), metrics()))["collisions"].size(), 0u);
}

TEST(MetricsFile, AFormationHasACourse) {
  formation::Metrics m = metrics();
  m.formation_course = formation::FormationCourse{4.0, 3.0, "R2", 1.0, std::nullopt, 0.75, 0.5};
  EXPECT_EQ(Json::parse(metrics_json(info(), m))["formation_course"].dump(),
            R"({"largest_error":4,"largest_error_at":3,"largest_error_of":"R2","first_formed":1,"formed_since":null,)"
            R"("share_formed":0.75,"rms_error":0.5})");
  EXPECT_TRUE(Json::parse(metrics_json(info(), metrics()))["formation_course"].is_null());
}

TEST(MetricsFile, MarginsThatWereNotKeptAreCounted) {
  formation::Metrics m = metrics();
  m.robot_margin = formation::RobotMarginCourse{0.3, 12, 4};
  EXPECT_EQ(Json::parse(metrics_json(info(), m))["robot_margin"].dump(), R"({"asked":0.3,"pair_rows":12,"robots":4})");
  EXPECT_TRUE(Json::parse(metrics_json(info(), metrics()))["robot_margin"].is_null());
}

TEST(MetricsFile, WhatDoesNotApplyIsNull) {
  const Json tree = Json::parse(metrics_json(info(), metrics()));
  for (const char* key : {"controller", "min_obstacle_clearance", "min_robot_clearance", "formation_position_error",
                          "formation_velocity_error", "leader_arrival_time"}) {
    EXPECT_TRUE(tree[key].is_null()) << key;
  }
  EXPECT_TRUE(tree["robots"][1]["arrival_time"].is_null());
  EXPECT_EQ(tree["last_arrival_time"], 13.45);
  EXPECT_EQ(tree["heading_reversals"], 3);
}

TEST(MetricsFile, ASummaryIsAnArrayOfThem) {
  const std::string one = metrics_json(info(), metrics());
  const Json tree = Json::parse(summary_json({one, one}));
  ASSERT_EQ(tree.size(), 2u);
  EXPECT_EQ(tree[0], Json::parse(one));
  EXPECT_EQ(Json::parse(summary_json({})).size(), 0u);
}

}  // namespace
}  // namespace exactvo::datasets::test
