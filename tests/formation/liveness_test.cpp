// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that are in each other's way: they turn to the right, and no half-plane between them is relaxed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "audited.h"
#include "decision/decision.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/stuck.h"
#include "exactvo/formation/waiting.h"
#include "liveness_scenes.h"
#include "support/c_library.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using test_scenes::add_robot;
using test_scenes::add_wall;
using test_scenes::circle;
using test_scenes::kTurn;
using test_scenes::robot;

std::size_t relaxed(const Recording& run) {
  std::size_t count = 0;
  for (const Step& row : run.steps)
    for (const RobotStep& r : row.robots)
      count += r.status == lp::Status::relaxed || r.status == lp::Status::infeasible;
  return count;
}

TEST(Liveness, CirclesOfTwoToTwentyAllArrive) {
  for (const int count : {2, 3, 4, 5, 6, 8, 12, 20}) {
    for (const Method method : {Method::orca, Method::ivo}) {
      SimulationOptions options;
      options.method = method;
      const Scenario s = circle(count);
      const Recording run = simulate(s, options);
      const Metrics m = measure(s, run);
      EXPECT_TRUE(m.all_arrived) << count << " " << name(method) << ": " << m.outcome;
      EXPECT_TRUE(m.collisions.empty()) << count << " " << name(method);
      EXPECT_EQ(relaxed(run), 0u) << count << " " << name(method);
      EXPECT_EQ(m.uncertified_half_planes, 0u);
    }
  }
}

TEST(Liveness, OffIsThePapersWayInWhichFourWaitForEver) {
  SimulationOptions off;
  off.liveness = Liveness::off;
  EXPECT_FALSE(measure(circle(4), simulate(circle(4), off)).all_arrived);
  Scenario s = circle(4);
  EXPECT_EQ(liveness_of(s, {}), Liveness::plan);
  EXPECT_EQ(liveness_of(s, off), Liveness::off);
  s.liveness = Liveness::off;
  EXPECT_EQ(liveness_of(s, {}), Liveness::off);
}

TEST(Liveness, ALoneRobotGoesStraight) {
  Scenario s;
  s.robots = {robot("R1", {0, 0}, {10, 0})};
  for (const Step& row : simulate(s).steps) EXPECT_EQ(row.robots[0].position.y, 0.0);
}

/// A crowd too dense for its half-planes. Goals may overlap, so that there is no plan to look for.
Scenario full_box(test::SeededRandom& random) {
  Scenario s;
  s.liveness = Liveness::bias;
  s.name = "box";
  s.time_limit = 20.0;
  s.obstacles = {{"box", geometry::Polyline{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}, {-5, -5}}}}};
  for (int i = 0; i < 36; ++i) {  // 28 % of the box
    const Vec2 place{-3.75 + 1.5 * (i % 6), -3.75 + 1.5 * (i / 6)};
    s.robots.push_back(robot("R" + std::to_string(i + 1), place + random.in_box(0.2), random.in_box(4.0)));
  }
  return s;
}

/// Rule R0: nothing is relaxed and no robots overlap.
TEST(Liveness, NothingBetweenRobotsIsRelaxedInACrowd) {
  test::SeededRandom random(test::seed_of_run(17));
  for (int k = 0; k < 3; ++k) {
    const Scenario s = full_box(random);
    const Recording run = simulate(s);
    const Metrics m = measure(s, run);
    EXPECT_EQ(relaxed(run), 0u) << k;
    EXPECT_TRUE(m.collisions.empty()) << k << ": " << m.outcome;
    EXPECT_EQ(m.uncertified_half_planes, 0u) << k;
    SimulationOptions off;
    off.liveness = Liveness::off;
    EXPECT_GT(relaxed(simulate(s, off)), 0u) << "the crowd is no test";
  }
}

std::size_t half_planes_of_robots(const Recording& run) {
  std::size_t count = 0;
  for (const Step& row : run.steps)
    for (const RobotStep& r : row.robots)
      count += static_cast<std::size_t>(std::count_if(r.constraints.begin(), r.constraints.end(), [](const auto& c) {
        return c.source == ConstraintSource::robot;
      }));
  return count;
}

/// Nearly all pairs of the box fall back, and a row has those that matter.
TEST(Liveness, RowsOfACrowdHaveOnlyThePairsThatMatter) {
  test::SeededRandom random(test::seed_of_run(18));
  Scenario s = full_box(random);
  s.time_limit = 3.0;
  SimulationOptions all;
  all.record_all = true;
  const Recording run = simulate(s), whole = simulate(s, all);
  EXPECT_LT(4 * half_planes_of_robots(run), half_planes_of_robots(whole));
  for (std::size_t k = 0; k < run.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      EXPECT_EQ(run.steps[k].robots[i].chosen, whole.steps[k].robots[i].chosen) << k << " " << i;
}

/// A half that fell back may prove nothing without the other: one in some 20,000 here.
TEST(Liveness, RowsHaveBothHalvesOfPairsThatFellBack) {
  test::SeededRandom random(test::seed_of_run(19));
  for (int k = 0; k < 4; ++k) {
    Scenario s = full_box(random);
    s.time_limit = 12.0;
    EXPECT_TRUE(audits_clean(s, simulate(s))) << k;
  }
}

/// Robots in a jam that were held from all sides had half-planes that no double kept, a few 1e-15 m/s apart.
TEST(Liveness, EveryDecisionOfALongJamIsOptimal) {
  Scenario s = test_scenes::street(14, 4.0);
  s.time_limit = 60.0;
  SimulationOptions bias;
  bias.liveness = Liveness::bias;
  const Recording run = simulate(s, bias);
  std::size_t others = 0;
  for (const Step& row : run.steps)
    for (const RobotStep& r : row.robots) others += r.status != lp::Status::optimal;
  EXPECT_EQ(others, 0u);
  const Metrics m = measure(s, run);
  EXPECT_FALSE(m.all_arrived) << "the street is no test";
  EXPECT_TRUE(m.collisions.empty());
  EXPECT_EQ(m.uncertified_half_planes, 0u);
}

void expect_all_arrive(Scenario s, const SimulationOptions& options = {}) {
  s.time_limit = 400.0;
  const Recording run = simulate(s, options);
  const Metrics m = measure(s, run);
  EXPECT_TRUE(m.all_arrived) << s.name << " " << s.robots.size() << ": " << m.outcome;
  EXPECT_TRUE(m.collisions.empty()) << s.name;
  EXPECT_EQ(relaxed(run), 0u) << s.name;
  EXPECT_EQ(m.uncertified_half_planes, 0u) << s.name;
}

/// Streets of fourteen and eighteen in both directions waited for ever.
TEST(Liveness, Lemma5_StreetsInBothDirectionsArriveByPlan) {
  expect_all_arrive(test_scenes::street(14, 3.0));
  expect_all_arrive(test_scenes::street(18, 4.0));
  SimulationOptions orca;
  orca.method = Method::orca;
  expect_all_arrive(test_scenes::street(14, 3.0), orca);
  SimulationOptions bias;
  bias.liveness = Liveness::bias;
  const Scenario s = test_scenes::street(14, 3.0);
  EXPECT_FALSE(measure(s, simulate(s, bias)).all_arrived) << "the street is no test";
}

/// They can only pass where there is a niche: one of them goes back.
TEST(Liveness, Lemma5_TwoHeadOnInACorridorPassAtItsSiding) {
  expect_all_arrive(test_scenes::siding());
}

TEST(Liveness, Lemma5_RoomsChangeRobotsThroughADoorOfOneAndAHalf) {
  test::SeededRandom random(test::seed_of_run(20));
  expect_all_arrive(test_scenes::door(12, 1.5, random));
}

/// One whose goal lies behind robots that rest at theirs across a street: they make way and come back.
TEST(Liveness, ARobotThatRestsAtItsGoalMakesWay) {
  Scenario s;
  s.name = "resting";
  test_scenes::add_wall(s, {{-8, 0}, {12, 0}, {12, 4}, {-8, 4}, {-8, 0}});
  for (const double y : {0.65, 1.7, 2.75}) test_scenes::add_robot(s, {4.0, y}, {4.0, y});
  test_scenes::add_robot(s, {-5.0, 2.0}, {9.0, 2.0});
  expect_all_arrive(s);
}

TEST(Liveness, ARunByPlanSaysSo) {
  const Scenario s = test_scenes::street(14, 3.0);
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  ASSERT_TRUE(m.plans.has_value());
  EXPECT_GE(m.plans->groups, 1u);
  EXPECT_EQ(m.plans->largest, 14u);
  EXPECT_GT(m.plans->search_nodes, 0u);
  EXPECT_GT(m.plans->time_by_plan, 0.0);
  ASSERT_EQ(run.plans.size(), m.plans->groups);
  for (const JointPlan& plan : run.plans) {
    EXPECT_EQ(plan.robots.size(), plan.starts.size());
    EXPECT_FALSE(plan.moves.empty());
    for (std::size_t k = 0; k < plan.robots.size(); ++k)
      EXPECT_EQ(run.steps[plan.from_row].robots[plan.robots[k]].position, plan.starts[k]);
    const RobotStep& made = run.steps[plan.row].robots[plan.robots.front()];
    EXPECT_EQ(made.mode, plan.from_row < plan.row ? Mode::going_back : Mode::by_plan);
    EXPECT_NE(made.note.find(std::to_string(plan.moves.size()) + " moves"), std::string::npos) << made.note;
  }
  std::string notes;
  bool went_back = false;
  for (const Step& row : run.steps)
    for (const RobotStep& r : row.robots) {
      notes += r.note;
      went_back = went_back || r.mode == Mode::going_back;
    }
  EXPECT_NE(notes.find("14 robots go by plan: "), std::string::npos) << notes;
  EXPECT_NE(notes.find(" waits for "), std::string::npos) << notes;
  EXPECT_EQ(went_back, m.plans->time_back > 0.0);
  EXPECT_EQ(went_back, notes.find("they first go back ") != std::string::npos);
}

/// Scenes as a new user writes them: positions, goals and walls, everything else by default.
std::string as_json(const Scenario& s) {
  const auto point = [](Vec2 p) { return "[" + std::to_string(p.x) + ", " + std::to_string(p.y) + "]"; };
  std::string robots, walls;
  for (const Robot& r : s.robots)
    robots += (robots.empty() ? "" : ", ") + std::string("{\"id\": \"") + r.id +
              "\", \"position\": " + point(r.position) + ", \"goal\": " + point(r.goals[0]) + "}";
  for (const SceneObstacle& o : s.obstacles) {
    std::string line;
    for (const Vec2 p : std::get<geometry::Polyline>(o.shape).points) line += (line.empty() ? "" : ", ") + point(p);
    walls += (walls.empty() ? "" : ", ") + std::string("{\"id\": \"") + o.id + "\", \"polyline\": [" + line + "]}";
  }
  return "{\"name\": \"" + s.name + "\", \"robots\": [" + robots + "], \"obstacles\": [" + walls + "]}";
}

/// s, of the longest straight way at full speed.
double straight_way(const Scenario& s) {
  double longest = 0.0;
  for (const Robot& r : s.robots) longest = std::max(longest, norm(r.goals[0] - r.position) / r.max_speed);
  return longest;
}

void expect_all_arrive_by_default(const Scenario& as_drawn, double time_limit) {
  Scenario s = datasets::parse_scenario(as_json(as_drawn), "mine.json", ".");
  s.time_limit = time_limit;
  const Metrics m = measure(s, simulate(s));
  EXPECT_TRUE(m.all_arrived) << s.name << " " << s.robots.size() << ": " << m.outcome;
  EXPECT_TRUE(m.collisions.empty()) << s.name << " " << s.robots.size();
  EXPECT_EQ(m.relaxed_steps, 0u) << s.name << " " << s.robots.size();
}

TEST(Liveness, CirclesAndStreetsAsANewUserWritesThemArrive) {
  constexpr double kDefault = 120.0;  // s
  for (const int count : {4, 8, 12, 20, 40}) expect_all_arrive_by_default(circle(count), kDefault);
  expect_all_arrive_by_default(test_scenes::street(14, 3.0), kDefault);
  expect_all_arrive_by_default(test_scenes::street(18, 4.0), kDefault);
}

TEST(Liveness, AStreetOfSixtyAsANewUserWritesItArrives) {
  const Scenario s = test_scenes::street(60, 4.0);
  expect_all_arrive_by_default(s, 6.0 * straight_way(s));
}

TEST(Liveness, TwelveOnACircleArriveInLessThanAThirdMoreThanTheStraightWay) {
  const Scenario s = circle(12);
  const Metrics m = measure(s, simulate(s));
  ASSERT_TRUE(m.all_arrived) << m.outcome;
  EXPECT_LE(*m.last_arrival_time, 1.3 * straight_way(s));
}

/// The bytes of every choice, with one, two and four runs at a time.
TEST(Liveness, PlansAreTheSameOnAnyNumberOfThreads) {
  const std::vector<Scenario> scenes{test_scenes::street(14, 4.0), test_scenes::siding(), test_scenes::siding(),
                                     test_scenes::street(14, 4.0)};
  const auto bytes_of = [](const Scenario& s) {
    const Recording run = simulate(s);
    EXPECT_GT(run.liveness.value().groups, 0u);
    std::string bytes;
    for (const Step& row : run.steps)
      for (const RobotStep& r : row.robots)
        for (const double x : {r.position.x, r.position.y, r.chosen.x, r.chosen.y}) test::append_bits(bytes, x);
    return bytes;
  };
  std::vector<std::string> alone;
  for (const Scenario& s : scenes) alone.push_back(bytes_of(s));
  EXPECT_EQ(alone[1], alone[2]);
  EXPECT_EQ(alone[0], alone[3]);
  for (const std::size_t count : {2u, 4u}) {
    std::vector<std::string> together(scenes.size());
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < count; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < scenes.size(); i += count) together[i] = bytes_of(scenes[i]);
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_TRUE(together == alone) << count << " threads";
  }
}

/// Robots far from a jam drive the same bits as without it, and the plan is for those of the jam alone.
TEST(Liveness, AJamInOneCornerOfACrowdConcernsNoOtherRobot) {
  Scenario jammed = test_scenes::street(14, 3.0);
  const std::size_t in_jam = jammed.robots.size();
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j) {
      const Vec2 from{100.0 + 3.0 * i, 100.0 + 3.0 * j};
      test_scenes::add_robot(jammed, from, from + Vec2{i % 2 == 0 ? 20.0 : -20.0, 0.1 * j});
    }
  jammed.time_limit = 40.0;
  Scenario free = jammed;
  for (std::size_t i = 0; i < in_jam; ++i) free.robots[i].goals = {free.robots[i].position};
  const Recording with = simulate(jammed), without = simulate(free);
  ASSERT_EQ(without.liveness->groups, 0u);
  ASSERT_EQ(with.liveness->groups, 1u);
  EXPECT_EQ(with.liveness->largest, in_jam);
  // The run without it ends sooner; nothing is chosen in the last row.
  ASSERT_GT(without.steps.size(), 200u);
  for (std::size_t k = 0; k + 1 < std::min(with.steps.size(), without.steps.size()); ++k)
    for (std::size_t i = in_jam; i < jammed.robots.size(); ++i) {
      ASSERT_EQ(with.steps[k].robots[i].position, without.steps[k].robots[i].position) << k << " " << i;
      ASSERT_EQ(with.steps[k].robots[i].chosen, without.steps[k].robots[i].chosen) << k << " " << i;
    }
}

TEST(Liveness, PlansAreTheSameEveryTime) {
  const Scenario s = test_scenes::street(14, 3.0);
  const Recording a = simulate(s), b = simulate(s);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t k = 0; k < a.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      ASSERT_EQ(a.steps[k].robots[i].chosen, b.steps[k].robots[i].chosen) << k << " " << i;
}

/// Which robot waits for which must not depend on what is recorded besides what binds and what is in reach: here a
/// half-plane beyond reach made the difference between a plan and none.
TEST(Liveness, PlansAreTheSameWithEveryHalfPlaneRecorded) {
  struct Start {
    Vec2 from, to;
    double max_speed;
  };
  const Start starts[] = {
      {{5.2584388925238725, -4.250350929947464}, {2.6041263331907496, 4.3332786886028485}, 1.5},
      {{2.329718447292536, -4.718367602059284}, {-2.438117010301775, -1.6300227866780839}, 1.5},
      {{-2.872767485182778, 5.677406675942346}, {4.300483545787563, -4.152019069808673}, 1.0},
      {{-3.3054968716608224, 1.6137021572343295}, {2.163243047160547, 2.2993310136732292}, 0.5},
      {{-0.46483867351264685, -0.5331016511055973}, {5.118584257911942, 3.9071083015554633}, 1.5},
      {{-0.057070043032643625, -3.500762897333343}, {0.041192161790137405, -3.4391429232067727}, 1.0},
      {{-3.0235727311934255, -5.459925347337295}, {-3.979305015775978, 0.32668183143170726}, 1.5},
      {{-2.652935807215216, -1.0502901752236493}, {4.586488885471543, 0.08436832267947203}, 0.5},
      {{4.573336053163529, -1.3754733683458191}, {2.289655304442177, -3.1854102888904894}, 1.5},
      {{-4.393671048835232, -2.7486051041538455}, {-2.913200924844085, -5.551777014922184}, 0.5},
      {{1.3668671209992516, -1.3967472022390401}, {-5.536973505381689, 3.0062960849288034}, 0.5},
      {{1.7030264022077075, 4.565495055261294}, {-1.7992866635484992, -3.7518446496411286}, 0.5},
      {{-4.955093970931951, 5.073673794000862}, {-1.0225688688589942, -0.6136234529210673}, 0.5},
      {{5.073592929719431, 0.898161762532971}, {-4.717564488619057, -4.475653977893573}, 1.0}};
  Scenario s;
  s.time_step = 0.02;
  s.time_limit = 40.0;
  s.arrival_tolerance = 0.05;
  for (const Start& start : starts) {
    Robot r = robot("R" + std::to_string(s.robots.size()), start.from, start.to);
    r.radius = 0.8;
    r.max_speed = start.max_speed;
    s.robots.push_back(r);
  }
  SimulationOptions all;
  all.record_all = true;
  const Recording a = simulate(s), b = simulate(s, all);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t k = 0; k < a.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      ASSERT_EQ(a.steps[k].robots[i].chosen, b.steps[k].robots[i].chosen) << k << " " << i;
}

/// Two meet in a corridor between two rooms; a third, too large for it, is at home in one of them.
TEST(Liveness, ALargerRobotElsewhereDoesNotKeepSmallOnesFromTheirPlan) {
  Scenario s;
  s.time_step = 0.1;
  s.time_limit = 200.0;
  const auto box = [&s](const std::string& id, Vec2 low, Vec2 high) {
    s.obstacles.push_back({id, geometry::Polygon{{low, {high.x, low.y}, high, {low.x, high.y}}, {}}});
  };
  box("north", {-10, 0.65}, {10, 6});
  box("south", {-10, -6}, {10, -0.65});
  box("left", {-21, -6}, {-20, 6});
  box("right", {20, -6}, {21, 6});
  box("top", {-21, 6}, {21, 7});
  box("bottom", {-21, -7}, {21, -6});
  s.robots = {robot("A", {-12, 0}, {14, 0}), robot("B", {12, 0}, {-14, 0}), robot("large", {-17, 4}, {-17, -4})};
  for (Robot& r : s.robots) r.max_speed = 1.0;
  s.robots.back().radius = 1.0;
  const Metrics m = measure(s, simulate(s));
  EXPECT_TRUE(m.all_arrived) << m.outcome;
  EXPECT_TRUE(m.collisions.empty());
}

/// A corridor in which no robot can pass another: the run ends at its time limit and says that there is no plan.
TEST(Liveness, WhereThereIsNoPlanItIsReported) {
  Scenario s;
  s.time_limit = 30.0;
  test_scenes::add_wall(s, {{-8, 0}, {8, 0}, {8, 1.4}, {-8, 1.4}, {-8, 0}});
  test_scenes::add_robot(s, {-6.0, 0.7}, {6.0, 0.7});
  test_scenes::add_robot(s, {6.0, 0.7}, {-6.0, 0.7});
  const Metrics m = measure(s, simulate(s));
  EXPECT_FALSE(m.all_arrived);
  EXPECT_NE(m.outcome.find("there is no plan on the roadmap for R1 and R2"), std::string::npos) << m.outcome;
  EXPECT_NE(m.outcome.find("a deadlock of two"), std::string::npos) << m.outcome;
}

/// A cart stands in the only door: plans through it were made again and again, and more time was said to be missing.
TEST(Liveness, AMovingObstacleThatStandsInTheOnlyWayIsNamed) {
  Scenario s;
  s.time_step = 0.1;
  s.time_limit = 40.0;
  s.obstacles.push_back({"south", geometry::Polyline{{{0, -8}, {0, -0.8}}}});
  s.obstacles.push_back({"north", geometry::Polyline{{{0, 0.8}, {0, 8}}}});
  s.obstacles.push_back({"room", geometry::Polyline{{{-9, -8}, {9, -8}, {9, 8}, {-9, 8}, {-9, -8}}}});
  s.robots = {robot("R1", {-6, 0}, {6, 0}), robot("R2", {-7.5, 0}, {7.5, 0})};
  MovingObstacle cart;
  cart.id = "cart";
  cart.shape = geometry::Polygon{{{-0.6, -0.6}, {0.6, -0.6}, {0.6, 0.6}, {-0.6, 0.6}}, {}};
  cart.motion.path = {{0, 0}};
  s.moving_obstacles = {cart};
  const std::string outcome = measure(s, simulate(s)).outcome;
  EXPECT_NE(outcome.find("R1 waits: moving obstacle 'cart' stands on its route, and none leads round it"),
            std::string::npos)
      << outcome;
  EXPECT_EQ(outcome.find("more time"), std::string::npos) << outcome;
}

/// A niche that is taken for a long time: plans through it are in vain, and are made again once it is free.
TEST(Liveness, PlansInVainAreMadeAgainOnceWhatStoodThereHasMoved) {
  Scenario s;
  s.time_step = 0.1;
  s.time_limit = 1000.0;
  s.obstacles.push_back(
      {"w",
       geometry::Polyline{
           {{-8, 0.8}, {-0.8, 0.8}, {-0.8, 2.2}, {0.8, 2.2}, {0.8, 0.8}, {8, 0.8}, {8, -0.8}, {-8, -0.8}, {-8, 0.8}}}});
  s.robots = {robot("R1", {-4, 0}, {4, 0}), robot("R2", {4, 0}, {-4, 0})};
  MovingObstacle door;
  door.id = "door";
  door.shape = geometry::Polygon{{{-0.7, 1.0}, {0.7, 1.0}, {0.7, 2.1}, {-0.7, 2.1}}, {}};
  door.motion.path = {{0, 0}, {0, 60}};
  door.motion.profile = {{0, 0}, {150, 0}, {151, 1}, {500, 1}};
  s.moving_obstacles = {door};
  EXPECT_EQ(measure(s, simulate(s)).outcome, "all robots arrived");
}

/// Between 2 diameters, up to which it is proven that they cannot, and 2.06, which plans with their gaps need, they
/// stand.
TEST(Liveness, TwoPassEachOtherWhereTheyHaveJustRoomSideBySide) {
  for (const double width : {2.07, 2.1, 2.14, 2.18, 2.3}) {
    Scenario s;
    test_scenes::add_box(s, 10.0, 0.5 * width);
    s.robots = {robot("R1", {-5, 0}, {5, 0}), robot("R2", {5, 0}, {-5, 0})};
    const Recording run = simulate(s);
    EXPECT_EQ(measure(s, run).outcome, "all robots arrived") << width;
    EXPECT_EQ(relaxed(run), 0u) << width;
    EXPECT_TRUE(audits_clean(s, run)) << width;
  }
}

/// Its way back leads through a robot that rests there and does not cooperate: it went "back" for the whole run without
/// a move, plan after plan, and more time was said to be all that was missing.
TEST(Liveness, ARobotWithoutAWayBackMakesNoPlanToGoBack) {
  for (const double half : {1.25, 1.5}) {
    Scenario s;
    s.time_limit = 60.0;
    test_scenes::add_box(s, 8.0, half);
    s.robots = {robot("R1", {-5, 0}, {5, 0}), robot("R2", {5, 0}, {-5, 0})};
    s.robots[0].cooperates = false;
    const Metrics m = measure(s, simulate(s));
    EXPECT_EQ(m.plans->groups, 0u) << half;
    EXPECT_NE(m.outcome.find("there is no plan on the roadmap for R2"), std::string::npos) << m.outcome;
  }
}

/// With a sight of half a radius robots saw each other too late and overlapped: whoever can be met in a step is seen.
TEST(Liveness, ARobotThatCanBeMetIsSeenHoweverShortTheNeighbourDistance) {
  for (const double distance : {0.1, 0.5, 1.1, 1.2}) {
    Scenario s = test_scenes::circle(4, 3.0);
    for (Robot& r : s.robots) r.max_speed = 3.0;
    s.neighbour_distance = distance;
    const Metrics m = measure(s, simulate(s));
    EXPECT_TRUE(m.collisions.empty()) << distance;
    EXPECT_EQ(m.relaxed_steps, 0u) << distance;
    EXPECT_TRUE(m.all_arrived) << distance << ": " << m.outcome;
  }
}

TEST(Liveness, ARunThatEndsDuringAPlanSaysSo) {
  Scenario s = test_scenes::street(14, 3.0);
  s.time_limit = 20.0;
  const Metrics m = measure(s, simulate(s));
  EXPECT_FALSE(m.all_arrived);
  EXPECT_NE(m.outcome.find("14 robots were still going by a joint plan, with "), std::string::npos) << m.outcome;
}

/// Only the robots of the last plan that was not found were named, and none where another plan was found after it.
TEST(Liveness, AllThatHaveNoPlanAreNamed) {
  Scenario s;
  s.time_limit = 12.0;
  for (const double y : {0.0, 10.0}) {
    test_scenes::add_wall(s, {{-8, y}, {8, y}, {8, y + 1.4}, {-8, y + 1.4}, {-8, y}});
    test_scenes::add_robot(s, {-6.0, y + 0.7}, {6.0, y + 0.7});
    test_scenes::add_robot(s, {6.0, y + 0.7}, {-6.0, y + 0.7});
  }
  const Metrics m = measure(s, simulate(s));
  EXPECT_NE(m.outcome.find("for R1 and R2"), std::string::npos) << m.outcome;
  EXPECT_NE(m.outcome.find("for R3 and R4"), std::string::npos) << m.outcome;
}

/// A robot that passes a goal has a longer way again. That counted as standing still, until it was as near to the next
/// goal: robots went by plans in the open, all by themselves.
TEST(Liveness, ARobotThatHeadsForItsNextGoalIsNotStalled) {
  Scenario s;
  s.robots = {robot("R1", {0, 0}, {20, 0})};
  s.robots[0].goals = {{20, 0}, {0, 0}, {20, 0}};
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  EXPECT_TRUE(m.all_arrived) << m.outcome;
  ASSERT_TRUE(m.plans.has_value());
  EXPECT_EQ(m.plans->groups, 0u);
}

/// A robot at the end of its way stood there until the last robot of its plan was at the end of its own, although it
/// had another goal to go to.
TEST(Liveness, ARobotAtTheEndOfItsWayGoesOnToItsNextGoalWithoutTheOthers) {
  Scenario s = test_scenes::street(14, 3.0);
  s.time_limit = 400.0;
  for (Robot& r : s.robots) r.goals.push_back(r.goals[0] + Vec2{r.goals[0].x > 0.0 ? 9.0 : -9.0, 0.0});
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  EXPECT_TRUE(m.all_arrived) << m.outcome;
  EXPECT_TRUE(m.collisions.empty());
  EXPECT_EQ(relaxed(run), 0u);
  ASSERT_FALSE(run.plans.empty()) << "the street is no test";
  const JointPlan& plan = run.plans.front();
  const std::size_t end = run.plans.size() > 1 ? run.plans[1].row : run.steps.size() - 1;
  double alone = 0.0;  // s, that some of the plan's robots went on and others were still by plan
  for (std::size_t k = plan.row; k < end; ++k) {
    std::size_t by_plan = 0;
    for (const std::size_t i : plan.robots) {
      const Mode mode = run.steps[k].robots[i].mode;
      by_plan += mode == Mode::by_plan || mode == Mode::going_back;
    }
    alone += by_plan > 0 && by_plan < plan.robots.size() ? s.time_step : 0.0;
  }
  EXPECT_GT(alone, 1.0);
}

/// navground's Cross: 20 robots go to and fro for 300 s, with margins up to three radii wide. No robot stands at the
/// end.
TEST(Liveness, InNavgroundsCrossNoRobotStandsInTheEnd) {
  constexpr double kLast = 5.0, kStands = 0.02;  // s, m/s
  for (const double margin : {0.02, 0.22}) {
    test::SeededRandom random(test::seed_of_run(2));
    const Scenario s = test_scenes::cross(margin, random);
    const Recording run = simulate(s);
    EXPECT_TRUE(measure(s, run).collisions.empty()) << margin;
    EXPECT_EQ(relaxed(run), 0u) << margin;
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      bool moved = false;
      for (std::size_t k = run.steps.size() - 1; run.steps[k].time > s.time_limit - kLast; --k)
        moved = moved ||
                norm(run.steps[k].robots[i].position - run.steps[k - 1].robots[i].position) > kStands * s.time_step;
      EXPECT_TRUE(moved) << margin << " " << i;
    }
  }
}

/// Robots with a wide margin stop farther apart than a radius, and counted as waiting for none.
TEST(Liveness, RobotsWithAWideMarginWaitForEachOther) {
  Scenario s;
  s.time_limit = 20.0;
  s.margins.robot = 1.0;
  test_scenes::add_wall(s, {{-8, 0}, {8, 0}, {8, 1.4}, {-8, 1.4}, {-8, 0}});
  test_scenes::add_robot(s, {-6.0, 0.7}, {6.0, 0.7});
  test_scenes::add_robot(s, {6.0, 0.7}, {-6.0, 0.7});
  const Metrics m = measure(s, simulate(s));
  EXPECT_NE(m.outcome.find("a deadlock of two"), std::string::npos) << m.outcome;
}

/// Twenty that cross a square of 10 m. Pairs that fell back used to keep a micrometre, and no number said so.
TEST(Liveness, PairsThatFallBackKeepWhatIsLeftOfTheirMargin) {
  std::size_t judged = 0, repaired = 0;
  for (const int seed : {1, 2, 3}) {
    test::SeededRandom random(seed);
    Scenario s;
    s.name = "square";
    s.margins.robot = 0.3;
    const auto from = test_scenes::scattered(20, {-5, -5}, {5, 5}, 1.35, random);
    const auto to = test_scenes::scattered(20, {-5, -5}, {5, 5}, 1.35, random);
    for (std::size_t i = 0; i < from.size(); ++i) test_scenes::add_robot(s, from[i], to[i]);
    s.time_limit = 30.0;
    for (const Liveness liveness : {Liveness::bias, Liveness::plan}) {
      s.liveness = liveness;
      const Recording run = simulate(s, {});
      const Metrics m = measure(s, run);
      EXPECT_EQ(relaxed(run), 0u);
      ASSERT_TRUE(m.robot_margin.has_value());
      const bool is_kept = m.min_robot_clearance.value() >= kMarginKept * s.margins.robot;
      EXPECT_TRUE(is_kept || m.robot_margin->pair_rows > 0) << "what is not kept is counted";
      if (m.plans->time_by_plan == 0.0) {
        EXPECT_TRUE(is_kept) << seed << ": " << *m.min_robot_clearance;
      }
      for (const Step& row : run.steps)
        for (std::size_t i = 0; i < row.robots.size(); ++i)
          for (const DecisionConstraint& c : row.robots[i].constraints) repaired += c.fell_back;
      ++judged;
    }
  }
  EXPECT_EQ(judged, 6u);
  EXPECT_GT(repaired, 100u);
}

/// The same in millimetres and in kilometres, and far from the origin, as surveyors count.
TEST(Liveness, PlansKeepTheMarginWhereTheFreeSpaceAllowsIt) {
  for (const double scale : {1.0, 1e3, 1e-3}) {
    for (const bool is_mirrored : {false, true}) {
      if (is_mirrored && scale != 1.0) continue;
      Scenario s = circle(20, 9.0 * kTurn / 20);  // 9 m
      s.margins.robot = 0.3 * scale;
      s.margins.obstacle *= scale;
      s.arrival_tolerance *= scale;
      s.neighbour_distance *= scale;
      for (Robot& r : s.robots) {
        const auto to = [&](Vec2 p) { return scale * Vec2{is_mirrored ? -p.x : p.x, p.y}; };
        r.position = to(r.position);
        r.goals = {to(r.goals[0])};
        r.radius *= scale;
        r.max_speed = 3.0 * scale;
      }
      const Recording run = simulate(s);
      const Metrics m = measure(s, run);
      EXPECT_TRUE(m.all_arrived) << scale << ": " << m.outcome;
      ASSERT_TRUE(m.plans && m.robot_margin && m.min_robot_clearance);
      EXPECT_GT(m.plans->groups, 0u) << scale;
      EXPECT_EQ(m.robot_margin->pair_rows, 0u) << scale << ": it was 1427 with plans that knew no margin";
      constexpr double kRounding = 1e-6;
      EXPECT_GE(*m.min_robot_clearance, (1.0 - kRounding) * s.margins.robot) << scale;
    }
  }
}

TEST(Liveness, WhereNoPlanKeepsTheMarginOneWithoutItIsReported) {
  // A street in which two have room side by side, but not with the margin between them.
  Scenario s;
  s.name = "pass";
  add_wall(s, {{-9, -1.2}, {9, -1.2}, {9, 1.2}, {-9, 1.2}, {-9, -1.2}});
  add_robot(s, {-6, 0}, {6, 0});
  add_robot(s, {6, 0}, {-6, 0});
  s.margins.robot = 0.6;
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  EXPECT_TRUE(m.all_arrived) << m.outcome;
  EXPECT_GT(*m.min_robot_clearance, 0.0);
  ASSERT_TRUE(m.robot_margin);
  EXPECT_GT(m.robot_margin->pair_rows, 0u);
  std::size_t said = 0;
  for (const Step& row : run.steps)
    for (const RobotStep& r : row.robots) said += r.note.find("does not keep margins.robot") != std::string::npos;
  EXPECT_EQ(said, run.plans.size());
  EXPECT_GT(said, 0u);
}

TEST(Liveness, PlansDependNeitherOnTheUnitNorOnTheOrigin) {
  const Scenario s = test_scenes::siding();
  const auto moved = [&](double scale, Vec2 by) {
    Scenario other = s;
    const auto put = [&](Vec2& p) { p = scale * p + by; };
    for (SceneObstacle& o : other.obstacles)
      for (Vec2& p : std::get<geometry::Polyline>(o.shape).points) put(p);
    for (Robot& r : other.robots) {
      put(r.position);
      for (Vec2& goal : r.goals) put(goal);
      r.radius *= scale;
      r.max_speed *= scale;
    }
    other.arrival_tolerance *= scale;
    other.neighbour_distance *= scale;
    other.margins.obstacle *= scale;
    other.margins.robot *= scale;
    return other;
  };
  for (const Scenario& other : {moved(0.03125, {}), moved(1024.0, {}), moved(1.0, {500000.0, 5700000.0})}) {
    const Recording run = simulate(other);
    const Metrics m = measure(other, run);
    EXPECT_TRUE(m.all_arrived) << m.outcome;
    EXPECT_TRUE(m.collisions.empty());
    EXPECT_EQ(relaxed(run), 0u);
    EXPECT_EQ(m.plans->groups, 1u);
  }
}

TEST(Liveness, AmongObstaclesPlansNeedGuidance) {
  Scenario s = test_scenes::street(2, 3.0);
  s.guidance = Guidance::none;
  EXPECT_EQ(liveness_of(s, {}), Liveness::bias);
  s.obstacles.clear();
  EXPECT_EQ(liveness_of(s, {}), Liveness::plan);
}

/// What a pair falls back to is satisfied at rest, opposite bit for bit, and proven.
TEST(Liveness, APairThatFallsBackMayRest) {
  test::SeededRandom random(test::seed_of_run(18));
  for (int k = 0; k < 2000; ++k) {
    Scenario s;
    s.robots = {robot("a", {}, {9, 9}), robot("b", {}, {-9, 9})};
    s.robots[0].radius = random.uniform(0.1, 1.0);
    s.robots[1].radius = random.uniform(0.1, 1.0);
    const double gap = std::ldexp(random.uniform(0.5, 1.0), random.integer(-40, 2));
    s.robots[1].position =
        (s.robots[0].radius + s.robots[1].radius + gap) * geometry::rotated({1.0, 0.0}, random.uniform(0.0, kTurn));
    const SimulationOptions options;
    const detail::DecisionRules rules = detail::rules_of(s, options);
    detail::Scene scene(s, options);
    std::vector<detail::Anchor> anchors{{s.robots[0].position, random.in_box(2.0)},
                                        {s.robots[1].position, random.in_box(2.0)}};
    std::vector<std::vector<detail::Constraint>> constraints;
    detail::PairMemory memory;
    const detail::RobotsAt now{rules, s.robots, anchors, scene};
    detail::robot_constraints(now, memory, constraints);
    detail::fall_back(now, 0, 1, constraints);
    for (int i = 0; i < 2; ++i) {
      ASSERT_EQ(constraints[i].size(), 1u);
      EXPECT_LE(constraints[i][0].half_plane.offset, 0.0) << gap;
      EXPECT_EQ(constraints[i][0].proof, vo::Proof::pair) << gap;
    }
    EXPECT_EQ(constraints[0][0].half_plane.normal, -constraints[1][0].half_plane.normal);
  }
}

}  // namespace
}  // namespace exactvo::formation
