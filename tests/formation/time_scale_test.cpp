// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing depends on the unit of time: a scene whose times are all multiplied, and whose speeds are divided, ends as it
// does in its own time, robot by robot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "liveness_scenes.h"
#include "moving_scenes.h"
#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

// --- A scene in another time ---

void slow_down(TimedPath& motion, double by) {
  motion.speed /= by;
  for (SpeedKnot& knot : motion.profile) knot = {knot.time * by, knot.speed / by};
}

void slow_down(FormationSpec& formation, double by) {
  slow_down(formation.leader, by);
  formation.catch_up_speed /= by;
  formation.gains.k1 /= by * by;
  formation.gains.k2 /= by;
  formation.gains.k3 /= by;
  formation.gains.kappa /= by;
  if (formation.controller_options.acceleration_bound) *formation.controller_options.acceleration_bound /= by * by;
}

Scenario slowed_down(Scenario s, double by) {
  for (Robot& robot : s.robots) {
    robot.velocity = robot.velocity / by;
    robot.max_speed /= by;
  }
  for (double* time :
       {&s.horizons.least, &s.horizons.most, &s.horizons.orca, &s.horizons.robots, &s.time_step, &s.time_limit})
    *time *= by;
  for (MovingObstacle& o : s.moving_obstacles) slow_down(o.motion, by);
  if (s.formation) slow_down(*s.formation, by);
  return s;
}

// --- How runs end ---

struct RobotEnd {
  bool arrived = false, collided = false, stuck = false;
  bool operator==(const RobotEnd& o) const {
    return arrived == o.arrived && collided == o.collided && stuck == o.stuck;
  }
};

std::vector<RobotEnd> ends_of(const Scenario& s, const SimulationOptions& options) {
  const Metrics m = test::run(s, options).metrics;
  std::vector<RobotEnd> ends;
  for (const RobotMetrics& robot : m.robots) {
    RobotEnd& end = ends.emplace_back();
    end.arrived = robot.arrived;
    for (const Collision& c : m.collisions) end.collided = end.collided || c.robot == robot.id || c.with == robot.id;
    for (const std::string& words : m.stuck)
      end.stuck = end.stuck || (words.rfind(robot.id + " is ", 0) == 0 && words.find("at rest") != std::string::npos);
  }
  return ends;
}

std::string words_of(const RobotEnd& end) {
  return std::string(end.arrived ? "arrived" : "did not arrive") + (end.collided ? ", collided" : "") +
         (end.stuck ? ", at rest elsewhere" : "");
}

struct Judged {
  std::size_t runs = 0, robots = 0, arrived = 0;
};

void compare(const Scenario& s, const SimulationOptions& options, Judged& judged) {
  const std::vector<RobotEnd> own = ends_of(s, options);
  for (const double by : {0.01, 100.0}) {
    const std::vector<RobotEnd> slow = ends_of(slowed_down(s, by), options);
    ASSERT_EQ(own.size(), slow.size());
    ++judged.runs;
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_EQ(own[i], slow[i]) << s.name << ", method " << name(options.method) << ", times " << by << " times, "
                                 << s.robots[i].id << ": " << words_of(own[i]) << " became " << words_of(slow[i]);
      ++judged.robots;
      judged.arrived += own[i].arrived;
    }
  }
}

std::vector<SimulationOptions> options_for(const Scenario& s) {
  std::vector<SimulationOptions> all;
  constexpr std::size_t kMany = 50;  // robots: the default alone
  if (s.robots.size() > kMany) return {{}};
  for (const Method method : {Method::orca, Method::ivo_edge, Method::ivo_cluster, Method::ivo}) {
    all.push_back(test::with_method(method));
    if (s.formation) continue;
    all.back().guidance = Guidance::none;
    all.back().liveness = Liveness::off;
  }
  all.push_back({});
  return all;
}

Scenario data_scene(const std::string& path) {
  return datasets::load_scenario(std::string(EXACTVO_SOURCE_DIR) + "/datasets/data/" + path + ".json");
}

std::vector<std::string> data_scenes() {
  std::vector<std::string> names;
  for (int k = 0; k <= 15; ++k) names.push_back("paper/A" + std::to_string(k));
  for (int k = 0; k <= 3; ++k) names.push_back("paper/B" + std::to_string(k));
  for (const char* name : {"room/room", "office/office", "formation/hundred"}) names.emplace_back(name);
  return names;
}

TEST(TimeScale, ScenesOfTheProjectEndAlike) {
  Judged judged;
  std::size_t expected = 0;
  for (const std::string& path : data_scenes()) {
    const Scenario s = data_scene(path);
    for (const SimulationOptions& options : options_for(s)) compare(s, options, judged);
    expected += 2 * options_for(s).size();
  }
  std::printf("%zu runs, %zu robots, of which %zu arrive\n", judged.runs, judged.robots, judged.arrived);
  EXPECT_EQ(judged.runs, expected);
  EXPECT_EQ(judged.runs, 222u);
  EXPECT_GT(judged.arrived, judged.robots / 2);
}

TEST(TimeScale, RobotsInEachOthersWayEndAlike) {
  using namespace test_scenes;
  test::SeededRandom random(7);
  std::vector<Scenario> scenes{
      circle(7),          street(6, 1.3), door(8, 1.4, random), rooms(6, 1.3, random), crowded_box(12, 30.0, random),
      cross(0.1, random), siding(),       at_slots(circle(6))};
  Scenario carts;
  carts.name = "carts";
  carts.time_limit = 60.0;
  carts.robots = {test::robot("R1", {-6, 0}, {6, 0}), test::robot("R2", {6, 1}, {-6, 1})};
  carts.moving_obstacles = {test::square("cart", {0, -4}, 0.5, {{{0, -4}, {0, 4}}, 0.7}),
                            test::square("late", {3, 4}, 0.5, {{{3, 4}, {3, 0}}, 0.0, {{2.0, 0.0}, {4.0, 1.0}}})};
  scenes.push_back(carts);
  Judged judged;
  for (Scenario& s : scenes) {
    s.time_limit = std::min(s.time_limit, 90.0);
    compare(s, {}, judged);
  }
  std::printf("%zu runs, %zu robots, of which %zu arrive\n", judged.runs, judged.robots, judged.arrived);
  EXPECT_EQ(judged.runs, scenes.size() * 2);
  EXPECT_GT(judged.arrived, judged.robots / 2);
}

// --- Slow robots ---

/// Inside a U that is open on the left, the goal behind its bottom.
Scenario in_a_u(double max_speed, double margin) {
  Scenario s;
  s.name = "U";
  Robot r = test::robot("r", {1.0, 0.1}, {8.0, 0.1});
  r.radius = 0.18;
  r.max_speed = max_speed;
  s.robots = {r};
  s.obstacles = {{"U", geometry::Polyline{{{0, 2}, {5, 2}, {5, -2}, {0, -2}}}}};
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  s.margins.obstacle = margin;
  s.time_limit = 25.0 / max_speed + 5.0;
  return s;
}

/// Where a robot drives less than the margin in the least horizon, it used to stand before the wall for ever.
TEST(TimeScale, SlowRobotsFollowBoundariesToo) {
  std::size_t judged = 0;
  for (const double margin : {0.0, 0.02, 0.08, 0.3})
    for (const double max_speed : {0.02, 0.1, 0.22, 0.26, 0.27, 1.0, 3.0}) {
      Scenario s = in_a_u(max_speed, margin);
      const test::FinishedRun run = test::run(s, {});
      EXPECT_TRUE(run.metrics.all_arrived) << max_speed << " m/s, margin " << margin << ": " << run.metrics.outcome;
      EXPECT_TRUE(run.metrics.collisions.empty());
      for (Vec2* p : {&s.robots[0].position, &s.robots[0].goals[0]}) p->y = -p->y;  // the U is its own mirror image
      EXPECT_TRUE(test::run(s, {}).metrics.all_arrived) << max_speed << " m/s, margin " << margin << ", mirrored";
      judged += 2;
    }
  EXPECT_EQ(judged, 56u);
}

}  // namespace
}  // namespace exactvo::formation
