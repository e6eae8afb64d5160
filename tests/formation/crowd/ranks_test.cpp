// SPDX-License-Identifier: GPL-3.0-or-later
// A crowd over several ranks, which are threads here: the same bits as in one (tests/tools/crowd_ranks_test.cpp has
// those of mpirun).
#include "exactvo/formation/ranks.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "crowd_scenes.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/vo/lp/batch.h"
#include "lp/sets/target.h"
#include "support/thread_ranks.h"

namespace exactvo::formation {
namespace {

using test::in_ranks;

/// Robots of three kinds among squares, discs, ellipses, hexagons, segments and points, some under way, inside a wall.
CrowdScene mixed_scene(std::size_t robots) {
  CrowdScene s = crowd_scene("bodies", robots);
  const CrowdScene pillars = crowd_scene("pillars", robots), mixture = crowd_scene("mixture", robots);
  for (std::size_t k = 0; k < pillars.obstacles.size(); k += 3) s.obstacles.push_back(pillars.obstacles[k]);
  s.kinds = mixture.kinds;
  for (std::size_t i = 0; i < robots; ++i) s.robots[i].kind = mixture.robots[i].kind;
  return s;
}

std::string snapshot_of(const Crowd& crowd) {
  std::ostringstream to;
  crowd.snapshot(to);
  return to.str();
}

std::vector<std::size_t> counts_of(const StepReport& r) {
  return {r.robots, r.neighbours, r.relaxed, r.touching, r.widened, r.edges, r.bodies, r.stopped, r.nudged};
}

void steer(Crowd& crowd, const CrowdScene& scene) {
  crowd.set_steering([&scene](CrowdSlice& slice) {
    for (std::size_t k = 0; k < slice.size(); ++k) slice.prefer(k, scene.preferred(slice.id(k), slice.position(k)));
  });
}

constexpr int kSteps = 24, kRestart = 9;

TEST(CrowdRanks, SharesAreEqualAndHoldAll) {
  EXPECT_EQ(share_ends(10, 1), (std::vector<std::size_t>{10}));
  EXPECT_EQ(share_ends(10, 4), (std::vector<std::size_t>{3, 6, 8, 10}));
  EXPECT_EQ(share_ends(2, 3), (std::vector<std::size_t>{1, 2, 2}));
  EXPECT_EQ(share_ends(0, 2), (std::vector<std::size_t>{0, 0}));
}

/// Every target x threads 1, 2, 7 x ranks 1, 2, 4 x going on from a snapshot on other ranks and threads.
TEST(CrowdRanks, Property4_EveryTargetThreadsRanksAndARestartGiveTheSameBits) {
  const tbb::global_control more_than_processors(tbb::global_control::max_allowed_parallelism, 7);
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdScene s = mixed_scene(225);
    s.options.precision = precision;
    Crowd alone = crowd_of(s);
    std::vector<std::vector<std::size_t>> counts;
    std::string at_restart;
    for (int k = 0; k < kSteps; ++k) {
      if (k == kRestart) at_restart = snapshot_of(alone);
      counts.push_back(counts_of(alone.step()));
    }
    const std::string at_end = snapshot_of(alone);
    for (const char* target : {"", "AVX3", "AVX2", "SSE4", "SSSE3"}) {
      if (!lp::limit_batch_target(target)) continue;  // not on this machine
      for (const int threads : {1, 2, 7})
        for (const int count : {1, 2, 4})
          in_ranks(count, [&](Ranks& ranks) {
            const std::string which = std::string(crowd_target()) + ' ' + std::to_string(threads) + " threads, rank " +
                                      std::to_string(ranks.rank()) + " of " + std::to_string(count);
            CrowdScene own = s;
            own.options.threads = threads;
            own.options.ranks = &ranks;
            Crowd through = crowd_of(own);
            std::istringstream from(at_restart);
            Crowd restarted = Crowd::restored(from, 8 - threads, &ranks);
            steer(restarted, own);
            for (int k = 0; k < kSteps; ++k) {
              EXPECT_EQ(counts_of(through.step()), counts[static_cast<std::size_t>(k)]) << which << ", step " << k;
              if (k + 1 == kRestart) {
                EXPECT_TRUE(snapshot_of(through) == at_restart) << which;
              }
              if (k >= kRestart) restarted.step();
            }
            EXPECT_TRUE(snapshot_of(through) == at_end) << which;
            EXPECT_TRUE(snapshot_of(restarted) == at_end) << which;
          });
    }
    lp::limit_batch_target("");
  }
}

TEST(CrowdRanks, MoreRanksThanRobotsGiveTheSameBits) {
  CrowdScene s = crowd_scene("crowd", 3);
  Crowd alone = crowd_of(s);
  for (int k = 0; k < 10; ++k) alone.step();
  in_ranks(5, [&](Ranks& ranks) {
    CrowdScene own = s;
    own.options.ranks = &ranks;
    Crowd crowd = crowd_of(own);
    for (int k = 0; k < 10; ++k) crowd.step();
    EXPECT_EQ(crowd.digest(), alone.digest());
  });
}

TEST(CrowdRanks, RobotsComeAndGoAndPreferencesAreByArray) {
  const CrowdScene s = mixed_scene(100);
  std::uint64_t digest = 0;
  for (const int count : {1, 3})
    in_ranks(count, [&](Ranks& ranks) {
      CrowdScene own = s;
      own.options.ranks = &ranks;
      Crowd crowd = crowd_of(own);
      std::vector<Vec2> at, preferred(100);
      for (int k = 0; k < 12; ++k) {
        crowd.positions(at);
        for (std::size_t i = 0; i < 100; ++i) preferred[i] = s.preferred(i, at[i]);
        crowd.set_preferred(preferred);
        crowd.step();
        if (k == 4) crowd.remove_robot(17), crowd.remove_robot(60);
        if (k == 8) crowd.add_robot({-5.0, -5.0}, 1);
      }
      if (count == 1) digest = crowd.digest();
      EXPECT_EQ(crowd.digest(), digest);
      const Vec2 chosen = crowd.explain(33).chosen;
      crowd.step();
      EXPECT_EQ(crowd.velocity(33), chosen) << ranks.rank();
    });
}

TEST(CrowdRanks, WhatTheSteeringOfOneRankThrowsEndsAll) {
  struct Lost {};
  const CrowdScene s = crowd_scene("crowd", 90);
  for (const int thrower : {0, 2}) {
    int quiet = 0;
    EXPECT_THROW(in_ranks(
                     3,
                     [&](Ranks& ranks) {
                       CrowdScene own = s;
                       own.options.ranks = &ranks;
                       Crowd crowd = crowd_of(own);
                       crowd.step();
                       crowd.set_steering([&](CrowdSlice&) {
                         if (ranks.rank() == thrower) throw Lost();
                       });
                       crowd.step();
                     },
                     &quiet),
                 Lost);
    EXPECT_EQ(quiet, 2);
  }
}

TEST(CrowdRanks, AnErrorOfAllRanksIsReportedByTheFirst) {
  int quiet = 0;
  try {
    in_ranks(
        3,
        [&](Ranks& ranks) {
          CrowdOptions options;
          options.ranks = &ranks;
          Crowd crowd(options);
          crowd.add_kind({});
          crowd.add_robot({1.0, 1.0});
          crowd.add_robot({1.0, 1.0});
          crowd.step();
        },
        &quiet);
    FAIL() << "nothing was refused";
  } catch (const CrowdError& e) {
    EXPECT_EQ(e.problem(), CrowdProblem::coincident);
  }
  EXPECT_EQ(quiet, 0) << "each found it by itself";
}

// --- Runs of scenarios ---

/// Robots through a door in a wall, one without a way, four with one goal, a tram across.
Scenario door_scenario() {
  Scenario s;
  s.name = "door";
  s.time_step = 0.1;
  s.time_limit = 30.0;
  for (int k = 0; k < 30; ++k) {
    Robot r;
    r.id = "R" + std::to_string(k);
    r.radius = k % 3 == 0 ? 0.4 : 0.25;
    r.max_speed = 1.0 + 0.1 * (k % 4);
    r.position = {-3.0 - 1.2 * (k / 6), 1.3 * (k % 6) - 3.0};
    r.goals = {{6.0 + k / 6, 1.3 * (k % 6) - 3.0}};
    if (k % 5 == 0) r.goals.push_back({-8.0, 7.0});
    if (k == 7) r.goals = {{20.0, 0.0}};
    if (k == 3 || k == 11 || k == 19 || k == 26) r.goals = {{4.0, 5.5}};
    s.robots.push_back(r);
  }
  const auto wall = [&](std::string id, std::vector<Vec2> points) {
    s.obstacles.push_back({std::move(id), geometry::Polyline{std::move(points)}});
  };
  wall("below", {{0.0, -9.0}, {0.0, -1.2}});
  wall("above", {{0.0, 1.2}, {0.0, 9.0}});
  wall("cell", {{18.0, -2.0}, {22.0, -2.0}, {22.0, 2.0}, {18.0, 2.0}, {18.0, -2.0}});
  MovingObstacle tram;
  tram.id = "tram";
  tram.shape = geometry::Polygon{{{3.0, -12.0}, {4.0, -12.0}, {4.0, -9.0}, {3.0, -9.0}}, {}};
  tram.motion.path = {{3.5, -10.5}, {3.5, 14.0}};
  tram.motion.speed = 0.8;
  s.moving_obstacles.push_back(tram);
  return s;
}

struct Taken final : RunSink {
  std::vector<std::uint64_t> digests;
  void add_state(const RunState& now) override { digests.push_back(now.crowd->digest()); }
};

std::vector<std::string> in_words(const std::vector<RobotNotThere>& robots) {
  std::vector<std::string> words;
  for (const RobotNotThere& r : robots) words.push_back(std::to_string(r.robot) + ": " + r.why);
  return words;
}

TEST(CrowdRanks, ARunOverRanksHasTheStatesSnapshotsAndReportOfOneProcess) {
  const Scenario s = door_scenario();
  for (const Guidance guidance : {Guidance::route, Guidance::none}) {
    const auto run = [&](Ranks* ranks, const std::string& resume, Taken& taken, std::vector<std::string>& snapshots) {
      SimulationOptions options;
      options.guidance = guidance;
      options.ranks = ranks;
      options.resume_from = resume;
      options.snapshot_every = 40;
      options.keep_snapshot = [&](const std::string& bytes) { snapshots.push_back(bytes); };
      return run_crowd(s, options, &taken);
    };
    Taken alone;
    std::vector<std::string> kept;
    const RunReport expected = run(nullptr, "", alone, kept);
    ASSERT_GT(kept.size(), 3U);
    EXPECT_GT(expected.arrived, 5U);
    EXPECT_GE(expected.goal_taken.size(), 2U);
    for (const int count : {2, 3, 4})
      for (const bool resumes : {false, true}) {
        Taken taken;
        std::vector<std::string> snapshots;
        in_ranks(count, [&](Ranks& ranks) {
          Taken nothing;
          std::vector<std::string> none;
          const bool is_first = ranks.rank() == 0;
          const RunReport r =
              run(&ranks, resumes ? kept[1] : "", is_first ? taken : nothing, is_first ? snapshots : none);
          EXPECT_EQ(r.digest, expected.digest);
          EXPECT_EQ(r.steps, expected.steps);
          EXPECT_TRUE(nothing.digests.empty() && none.empty());
          if (!is_first) return;
          EXPECT_EQ(r.robots, expected.robots);
          EXPECT_EQ(r.arrived, expected.arrived);
          EXPECT_EQ(in_words(r.route_cut), in_words(expected.route_cut));
          EXPECT_EQ(in_words(r.without_route), in_words(expected.without_route));
          EXPECT_EQ(in_words(r.goal_taken), in_words(expected.goal_taken));
          EXPECT_EQ(r.stands_still, expected.stands_still);
          EXPECT_EQ(r.outcome, expected.outcome);
          EXPECT_EQ(r.path_length, expected.path_length);
          EXPECT_EQ(r.relaxed, expected.relaxed);
          EXPECT_EQ(r.against_robots, expected.against_robots);
          EXPECT_EQ(r.against_edges, expected.against_edges);
          EXPECT_EQ(r.against_bodies, expected.against_bodies);
        });
        EXPECT_TRUE(std::equal(snapshots.rbegin(), snapshots.rend(), kept.rbegin())) << count << resumes;
        EXPECT_TRUE(std::equal(taken.digests.rbegin(), taken.digests.rend(), alone.digests.rbegin()));
      }
  }
}

/// Two robots that meet in a street too narrow for both, and others that go elsewhere.
Scenario street_scenario() {
  Scenario s;
  s.name = "street";
  s.time_step = 0.1;
  s.time_limit = 100.0;
  const auto add = [&](const char* id, Vec2 from, Vec2 to) {
    Robot r;
    r.id = id;
    r.radius = 0.3;
    r.max_speed = 1.0;
    r.position = from;
    r.goals = {to};
    s.robots.push_back(r);
  };
  add("west", {0.0, 0.0}, {10.0, 0.0});
  add("east", {10.0, 0.0}, {0.0, 0.0});
  add("far", {0.0, 5.0}, {3.0, 5.0});
  add("near", {0.0, 7.0}, {1.0, 7.0});
  for (const double y : {-0.5, 0.5})
    s.obstacles.push_back({y < 0.0 ? "lower" : "upper", geometry::Polyline{{{-2.0, y}, {12.0, y}}}});
  return s;
}

TEST(CrowdRanks, ARunEndsWhereNothingChangesAnyMore) {
  Scenario s = street_scenario();
  s.liveness = Liveness::bias;  // with reservations the two get past each other
  const auto run = [&](Ranks* ranks, const std::string& resume, std::vector<std::string>* snapshots, RunSink* sink) {
    SimulationOptions options;
    options.ranks = ranks;
    options.resume_from = resume;
    options.snapshot_every = snapshots ? 1 : 0;
    if (snapshots) options.keep_snapshot = [snapshots](const std::string& bytes) { snapshots->push_back(bytes); };
    return run_crowd(s, options, sink);
  };
  std::vector<std::string> kept;
  const RunReport whole = run(nullptr, "", &kept, nullptr);
  EXPECT_TRUE(whole.stands_still);
  EXPECT_EQ(whole.arrived, 2U);
  EXPECT_LT(whole.steps, 500U);
  for (std::size_t k = whole.steps - 12; k < whole.steps; ++k) {
    const RunReport r = run(nullptr, kept[k - 1], nullptr, nullptr);
    EXPECT_TRUE(r.stands_still);
    EXPECT_EQ(r.steps, whole.steps) << "resumed after " << k;
  }
  in_ranks(3, [&](Ranks& ranks) {
    const RunReport r = run(&ranks, "", nullptr, nullptr);
    EXPECT_TRUE(r.stands_still);
    EXPECT_EQ(r.steps, whole.steps);
    EXPECT_EQ(r.digest, whole.digest);
  });
  // The same without that end: a tram that starts when all is over, far away.
  MovingObstacle tram;
  tram.id = "tram";
  tram.shape = geometry::Polygon{{{50.0, 50.0}, {51.0, 50.0}, {51.0, 51.0}, {50.0, 51.0}}, {}};
  tram.motion.path = {{50.5, 50.5}, {60.5, 50.5}};
  tram.motion.profile = {{0.0, 0.0}, {99.0, 0.0}, {99.5, 1.0}};
  s.moving_obstacles.push_back(tram);
  struct Places final : RunSink {
    std::vector<std::vector<Vec2>> rows;
    void add_state(const RunState& now) override { rows.push_back(now.positions); }
  } places;
  const RunReport longer = run(nullptr, "", nullptr, &places);
  EXPECT_FALSE(longer.stands_still);
  EXPECT_EQ(longer.steps, 1000U);
  EXPECT_EQ(longer.arrived, 2U);
  for (std::size_t k = whole.steps; k < places.rows.size(); ++k)
    EXPECT_EQ(places.rows[k], places.rows[whole.steps]) << k;
}

TEST(CrowdRanks, ProgressInAnyRankStopsAll) {
  const Scenario s = door_scenario();
  std::size_t kept = 0;
  in_ranks(3, [&](Ranks& ranks) {
    SimulationOptions options;
    options.ranks = &ranks;
    options.guidance = Guidance::none;
    options.progress = [&](double time) { return ranks.rank() != 2 || time < 1.95; };
    options.keep_snapshot = [&](const std::string&) { ++kept; };
    const RunReport r = run_crowd(s, options);
    EXPECT_TRUE(r.interrupted);
    EXPECT_EQ(r.steps, 20U);
  });
  EXPECT_EQ(kept, 1U);
}

TEST(CrowdRanks, ASinkThatFailsEndsAll) {
  struct Full final : RunSink {
    void add_state(const RunState& now) override {
      if (now.steps == 5) throw std::runtime_error("full");
    }
  };
  int quiet = 0;
  EXPECT_THROW(in_ranks(
                   3,
                   [&](Ranks& ranks) {
                     SimulationOptions options;
                     options.ranks = &ranks;
                     options.guidance = Guidance::none;
                     Full sink;
                     run_crowd(door_scenario(), options, &sink);
                   },
                   &quiet),
               std::runtime_error);
  EXPECT_EQ(quiet, 2);
}

TEST(CrowdRanks, RanksThatComeToOtherStatesAreFoundOut) {
  int quiet = 0;
  EXPECT_THROW(in_ranks(
                   3,
                   [&](Ranks& ranks) {
                     Scenario s = door_scenario();
                     s.time_limit = 2.0;
                     if (ranks.rank() == 1) s.robots[4].position.y += 1e-3;
                     SimulationOptions options;
                     options.ranks = &ranks;
                     options.guidance = Guidance::none;
                     run_crowd(s, options);
                   },
                   &quiet),
               RanksDiffer);
  EXPECT_EQ(quiet, 0) << "all see that";
}

}  // namespace
}  // namespace exactvo::formation
