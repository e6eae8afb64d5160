// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of crowds that jam without reservations (liveness/reservations.h): all robots arrive, and none overlap.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "exactvo/formation/crowd_run.h"
#include "liveness_scenes.h"

namespace exactvo::formation {
namespace {

using namespace test_scenes;

struct Scene {
  std::string name;
  Scenario scenario;
};

Scenario run_along_routes(Scenario s) {
  s.guidance = Guidance::route;
  s.time_step = 0.1;
  s.time_limit = 400.0;
  s.arrival_tolerance = 0.2;
  s.horizons.orca = 5.0;
  return s;
}

std::vector<Scene> scenes() {
  test::SeededRandom random(test::seed_of_run(21));
  std::vector<Scene> all = {
      {"circle", circle(40)},          {"street", street(30, 4.4)},       {"narrow street", street(14, 3.0)},
      {"door", door(24, 1.5, random)}, {"rooms", rooms(20, 2.2, random)}, {"box", crowded_box(60, 30.0, random)}};
  for (Scene& scene : all) scene.scenario = run_along_routes(std::move(scene.scenario));
  return all;
}

TEST(ReservedRun, AllRobotsArriveAndNoneOverlap) {
  for (const auto& [name, s] : scenes()) {
    const RunReport r = run_crowd(s, {});
    EXPECT_EQ(r.arrived, s.robots.size()) << name;
    EXPECT_EQ(r.overlapping, 0u) << name;
    EXPECT_GT(r.reserved, 0u) << name;
  }
}

TEST(ReservedRun, WithoutAJamNoRobotReservesBeforeItIsAtItsGoal) {
  Scenario s;
  for (int k = 0; k < 5; ++k) add_robot(s, {0.0, 4.0 * k}, {20.0, 4.0 * k});
  s = run_along_routes(s);
  EXPECT_EQ(run_crowd(s, {}).arrived, 5u);
  s.time_limit = 10.0;  // 15 m
  const RunReport r = run_crowd(s, {});
  EXPECT_EQ(r.arrived, 0u);
  EXPECT_EQ(r.reserved, 0u);
}

TEST(ReservedRun, OffAndBiasReserveNothing) {
  for (const Liveness liveness : {Liveness::off, Liveness::bias}) {
    Scenario s = run_along_routes(street(14, 3.0));
    s.time_limit = 60.0;
    s.liveness = liveness;
    const RunReport r = run_crowd(s, {});
    EXPECT_EQ(r.reserved, 0u);
    EXPECT_EQ(r.overlapping, 0u);
    EXPECT_LT(r.arrived, s.robots.size()) << "there is a jam to get out of";
  }
}

/// Any number of threads, and from any snapshot.
TEST(ReservedRun, TheSameBitsOnTwoThreadsAndFromASnapshot) {
  test::SeededRandom random(test::seed_of_run(22));
  const Scenario s = run_along_routes(door(24, 1.5, random));
  SimulationOptions options;
  std::vector<std::string> snapshots;
  options.snapshot_every = 150;
  options.keep_snapshot = [&](const std::string& bytes) { snapshots.push_back(bytes); };
  const RunReport whole = run_crowd(s, options);
  ASSERT_GE(snapshots.size(), 2u);
  options.threads = 2;
  EXPECT_EQ(run_crowd(s, options).digest, whole.digest);
  for (const std::string& bytes : std::vector<std::string>(snapshots)) {
    SimulationOptions again;
    again.resume_from = bytes;
    const RunReport r = run_crowd(s, again);
    EXPECT_EQ(r.digest, whole.digest);
    EXPECT_EQ(r.steps, whole.steps);
    EXPECT_EQ(r.reserved, whole.reserved);
  }
}

/// Reservations keep more than the radii: robots pushed each other off such goals by turns until time ran out.
TEST(ReservedRun, RobotsStayAtGoalsThatAreAsNearToEachOtherAsTheirRadiiAllow) {
  for (const double apart : {1.0, 1.0028, 1.0045}) {
    test::SeededRandom random(test::seed_of_run(23));
    Scenario s = run_along_routes(crowded_box(30, 15.0, random));
    // Two robots with goals `apart` from each other, in the midst of the others.
    s.robots[1].goals = {s.robots[0].goals.back() + Vec2{apart * 2.0 * s.robots[0].radius, 0.0}};
    s.time_limit = 200.0;
    const RunReport r = run_crowd(s, {});
    EXPECT_EQ(r.arrived + r.goal_taken.size(), s.robots.size()) << apart;
    EXPECT_LT(r.time, s.time_limit) << apart;
  }
}

}  // namespace
}  // namespace exactvo::formation
