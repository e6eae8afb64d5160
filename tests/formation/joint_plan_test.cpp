// SPDX-License-Identifier: GPL-3.0-or-later
// Roadmaps, joint search and plans: what they promise.
#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "decision/decision.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/vo/reciprocal.h"
#include "joint_problems.h"
#include "liveness/distances.h"
#include "liveness/groups.h"
#include "liveness/plan_search.h"
#include "support/seeded_random.h"

namespace exactvo::formation::detail {
namespace {

TEST(JointSearch, Properties1To3_EveryPlanIsASequenceOfClearMovesToTheGoals) {
  SeededRandom random(test::seed_of_run(31));
  std::size_t found = 0;
  for (int k = 0; k < 40; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    Problem p(walls, 2 + random.integer(0, 12), random);
    const GuidedBy guided_by = k % 4 < 2 ? GuidedBy::lengths : GuidedBy::lanes;
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000}, guided_by);
    if (answer.end != SearchEnd::found) continue;
    ++found;
    const std::vector<Vec2> starts = positions(p.map, p.joint.starts);
    const std::vector<PlannedMove> as_found = on_map(p.map, answer.moves);
    const std::vector<PlannedMove> plan =
        plan_of(p.map, without_loops(p.map, answer.moves, p.joint.radii), p.joint.radii);
    for (const auto* moves : {static_cast<const std::vector<PlannedMove>*>(&as_found), &plan}) {
      expect_apart(starts, p.joint.radii, *moves, walls);
      std::vector<Vec2> at = starts;
      for (const PlannedMove& m : *moves) at[m.robot] = m.to;
      EXPECT_EQ(at, positions(p.map, p.joint.goals)) << "Property 3";
    }
    EXPECT_LE(plan.size(), answer.moves.size());
  }
  EXPECT_GE(found, 35u);
}

/// A robot that goes along a street, and one that comes the other way: by lengths they meet on one line, with traffic
/// they keep a robot's width apart.
TEST(Traffic, ARobotThatComesTheOtherWayTakesAnotherLane) {
  const Walls walls({{{-40, -2}, {40, -2}}, {{-40, 2}, {40, 2}}});
  Roadmap map(walls, {{-12, -1.44}, {12, 1.44}}, 0.5);
  const PlaceNumber west = map.attach({-10, 0.1}, 0.5), east = map.attach({10, 0.1}, 0.5);
  Traffic traffic(map);
  const auto cost = [&](PlaceNumber a, PlaceNumber b) { return traffic.cost(a, b); };
  const auto way = [&](PlaceNumber from, PlaceNumber to) {
    return traffic.way_from(from, distances_to(map, to, 0.5, cost));
  };
  const auto nearest = [&](const std::vector<PlaceNumber>& a, const std::vector<PlaceNumber>& b) {
    double least = std::numeric_limits<double>::infinity();
    for (const PlaceNumber p : a)
      for (const PlaceNumber q : b)
        if (std::fabs(map.place(p).x) < 6.0) least = std::min(least, norm(map.place(p) - map.place(q)));
    return least;
  };
  const std::vector<PlaceNumber> there = way(west, east), back = way(east, west);
  ASSERT_EQ(there.front(), west);
  ASSERT_EQ(there.back(), east);
  EXPECT_LT(nearest(there, back), 0.5) << "the street is no test";
  traffic.add(there, 1.0);
  EXPECT_GE(nearest(there, way(east, west)), 1.0);
  EXPECT_EQ(way(west, east), there) << "a robot that goes the same way may follow";
  traffic.add(there, -1.0);
  EXPECT_EQ(way(east, west), back);
}

TEST(JointSearch, Property4_TheSameSeedGivesTheSameMoves) {
  SeededRandom random(test::seed_of_run(32));
  Problem p(two_rooms(1.5), 10, random);
  JointSearch search(p.joint);
  const auto moves_of = [](const JointAnswer& a) {
    std::vector<std::size_t> flat;
    for (const JointMove& m : a.moves) flat.insert(flat.end(), {m.robot, m.from, m.to});
    return flat;
  };
  const JointAnswer a = search.run(5, {200000, 3000}), b = search.run(5, {200000, 3000});
  ASSERT_EQ(a.end, SearchEnd::found);
  EXPECT_EQ(moves_of(a), moves_of(b));
  EXPECT_EQ(a.calls, b.calls);
}

/// The small budgets end within a search.
TEST(PlanSearch, IsDeterministicAndGoesOnWithOtherSeeds) {
  SeededRandom random(test::seed_of_run(77));
  std::size_t planned = 0, spent = 0;
  for (int k = 0; k < 24; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    Problem p(walls, 2 + random.integer(0, 12), random);
    const std::size_t calls = random.integer(0, 1) == 0 ? random.integer(50, 3000) : 75000;
    PlanSearch one, other;
    for (int n = 0; n < 2; ++n) {
      const PlanFound first = one.best_plan(p.joint, calls, true), again = other.best_plan(p.joint, calls, true);
      ASSERT_EQ(first.end, again.end) << k << ", " << calls << " calls";
      ASSERT_EQ(first.nodes, again.nodes) << k << ", " << calls << " calls";
      ASSERT_EQ(first.plan.size(), again.plan.size()) << k;
      for (std::size_t m = 0; m < first.plan.size(); ++m) {
        const PlannedMove &a = first.plan[m], &b = again.plan[m];
        ASSERT_TRUE(a.robot == b.robot && a.from == b.from && a.to == b.to && a.after == b.after) << k << " " << m;
      }
      planned += first.end == PlanEnd::planned;
      spent += first.end == PlanEnd::out_of_budget;
    }
  }
  EXPECT_GE(planned, 20u);
  EXPECT_GE(spent, 1u);
}

/// There is no plan, and the budget lasts for minutes. An exception is passed on.
TEST(PlanSearch, EndsWhenItIsStopped) {
  SeededRandom random(test::seed_of_run(78));
  Problem p(Walls({}), 12, random);
  int asked = 0;
  constexpr std::size_t kMinutes = 1000000000;
  p.joint.is_stopped = [&] { return ++asked > 60; };
  p.joint.goals[1] = p.joint.goals[0];
  EXPECT_EQ(PlanSearch().best_plan(p.joint, kMinutes, true).end, PlanEnd::out_of_budget);
  EXPECT_GT(asked, 60);
  struct Interrupted {};
  asked = 0;
  p.joint.is_stopped = [&] {
    if (++asked > 60) throw Interrupted();
    return false;
  };
  EXPECT_THROW(PlanSearch().best_plan(p.joint, kMinutes, true), Interrupted);
}

/// Two in a dead end cannot change their order: every joint place is tried, and that there is no plan is said.
TEST(JointSearch, InACorridorWithoutASidingThereIsNoneOnTheMap) {
  const Walls walls({{{-4, 0.6}, {4, 0.6}}, {{-4, -0.6}, {4, -0.6}}, {{-4, -0.6}, {-4, 0.6}}, {{4, -0.6}, {4, 0.6}}});
  Roadmap map(walls, {{-3.4, -0.05}, {3.4, 0.05}}, 0.5);
  JointProblem p;
  p.map = &map;
  p.radii = {0.5, 0.5};
  p.starts = {map.attach({-2, 0}, 0.5), map.attach({2, 0}, 0.5)};
  p.goals = {p.starts[1], p.starts[0]};
  const JointAnswer answer = JointSearch(p).run(1, {1000000, 100000});
  EXPECT_EQ(answer.end, SearchEnd::none_on_map);
  EXPECT_GT(answer.nodes, 10u);
}

TEST(Roadmap, EveryFreePointOfANarrowPlaceSeesAPlace) {
  const Walls walls = two_rooms(1.1);  // a lattice alone may miss it
  const Roadmap map(walls, {{-5.4, -3.4}, {5.4, 3.4}}, 0.5);
  for (double x = -0.5; x <= 0.5; x += 0.125) {
    bool sees = false;
    map.for_each_near({x, 0.0}, 1.6, [&](PlaceNumber p) {
      sees = sees || walls.is_clear({x, 0.0}, map.place(p), 0.5);
    });
    EXPECT_TRUE(sees) << x;
  }
}

/// A place that is added after a robot was found to stay somewhere had ways through that robot.
TEST(Roadmap, WaysOfPlacesThatAreAddedKeepClearOfWhatBlocks) {
  SeededRandom random(test::seed_of_run(35));
  const Walls open({});
  std::size_t ways = 0;
  for (int k = 0; k < 100; ++k) {
    Roadmap map(open, {{-4, -4}, {4, 4}}, 0.5);
    const Vec2 parked = random.in_box(2.0), start = parked + random.in_box(1.5);
    const double keep = 1.04;
    map.block(parked, keep);
    const PlaceNumber added = map.attach(start, 0.5);
    const double least = std::min(keep, norm(start - parked));
    for (const PlaceNumber p : map.ways(added)) {
      EXPECT_GE(std::sqrt(squared_distance(parked, start, map.place(p))), least * (1.0 - 1e-9));
      EXPECT_FALSE(map.is_blocked(p));
      ++ways;
    }
  }
  EXPECT_GT(ways, 300u);
}

/// A robot that stands on a place of the lattice too near to one that stays was left without any way.
TEST(Roadmap, ARobotOnABlockedPlaceMayLeave) {
  const Walls open({});
  Roadmap map(open, {{-4, -4}, {4, 4}}, 0.5);
  const Vec2 start = map.place(20);
  map.block(start + Vec2{1.01, 0.0}, 1.04);
  ASSERT_TRUE(map.is_blocked(20));
  const PlaceNumber own = map.attach(start, 0.5);
  EXPECT_NE(own, 20u);
  EXPECT_FALSE(map.ways(own).empty());
}

/// The place of a small robot near a wall is none for a large one.
TEST(JointSearch, NoRobotGoesWhereOnlyASmallerOneHasRoom) {
  SeededRandom random(test::seed_of_run(36));
  const Walls walls(std::vector<Segment>{{{-5, 0}, {5, 0}}});
  std::size_t found = 0;
  for (int k = 0; k < 20; ++k) {
    Roadmap map(walls, {{-5, 0.1}, {5, 2.2}}, 0.5);
    JointProblem p;
    p.map = &map;
    p.radii = {0.1, 0.5};
    const double x = random.uniform(-1.0, 1.0);
    p.starts = {map.attach({x, 0.15}, 0.1), map.attach({x + 1.0, 0.8}, 0.5)};
    p.goals = {map.attach({x + 1.0, 1.5}, 0.1), map.attach({x - 1.0, 0.8}, 0.5)};
    const JointAnswer answer = JointSearch(p).run(k, {20000, 2000});
    found += answer.end == SearchEnd::found;
    for (const JointMove& m : answer.moves) EXPECT_GE(walls.clearance(map.place(m.to), 1.0), p.radii[m.robot]);
  }
  EXPECT_GE(found, 15u);
}

/// Cell numbers of 32 bits overflowed where robots are small and far from the origin.
TEST(Cells, FarFromTheOriginOnlyWhatIsNearIsVisited) {
  for (const double far : {0.0, 5e6, 1e12, 1e300}) {
    Cells<int> cells(4e-4);
    cells.add(Vec2{far, -far}, 1);
    cells.add(Vec2{-far - 1.0, far}, 2);
    std::multiset<int> seen;
    cells.for_each_about({far, -far}, 1e-3, [&](int n) { seen.insert(n); });
    EXPECT_EQ(seen, std::multiset<int>{1}) << far;
  }
}

/// A query of more cells than could be looked at, as about robots of micrometres within a margin of centimetres.
TEST(Cells, ALargeBoxIsSeenInTheSameOrder) {
  Cells<int> small(1e-9), large(0.25);
  SeededRandom random(2612);
  for (int k = 0; k < 200; ++k) {
    const Vec2 place{0.25 * std::floor(random.uniform(-8.0, 8.0)), 0.25 * std::floor(random.uniform(-8.0, 8.0))};
    small.add(place, k);
    large.add(place, k);
  }
  const auto seen = [](const Cells<int>& cells, bool latest_first) {
    std::vector<int> numbers;
    const auto take = [&](int n) { numbers.push_back(n); };
    const geometry::Box box{{-1.0, -1.0}, {1.1, 1.1}};
    latest_first ? cells.for_each_in_latest_first(box, take) : cells.for_each_in(box, take);
    return numbers;
  };
  EXPECT_GT(seen(small, false).size(), 10u);
  EXPECT_EQ(seen(small, false), seen(large, false));
  EXPECT_EQ(seen(small, true), seen(large, true));
}

/// Planning takes seconds, in which a user may want to stop.
TEST(JointSearch, EndsWhenItIsStopped) {
  SeededRandom random(test::seed_of_run(37));
  Problem p(two_rooms(1.5), 12, random);
  for (const int most : {0, 3, 15}) {
    int asked = 0;
    p.joint.is_stopped = [&] { return asked++ >= most; };
    const JointAnswer answer = JointSearch(p.joint).run(1, {200000, 3000});
    EXPECT_EQ(answer.end, SearchEnd::out_of_budget);
    EXPECT_TRUE(answer.moves.empty());
    EXPECT_EQ(asked, most + 1);
  }
}

/// Thousands in a row that all have to go on by one: each asks the next to go first, on the stack of a thread.
TEST(JointSearch, ALongRowOfRobotsNeedsLittleStack) {
  constexpr std::size_t kRow = 2000;
  const auto plan = [](void*) -> void* {
    const Walls open({});
    Roadmap map(open, {{0.0, 0.0}, {1.06 * (kRow + 2), 0.1}}, 0.5);
    JointProblem p;
    p.map = &map;
    for (std::size_t i = 0; i < kRow; ++i) {
      p.radii.push_back(0.5);
      p.starts.push_back(static_cast<PlaceNumber>(i));
      p.goals.push_back(static_cast<PlaceNumber>(i + 1));
    }
    const JointAnswer answer = JointSearch(p).run(1, {10 * kRow, 3});
    return reinterpret_cast<void*>(answer.calls);
  };
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, std::size_t{1} << 19);
  pthread_t thread;
  ASSERT_EQ(pthread_create(&thread, &attributes, plan, nullptr), 0);
  void* calls = nullptr;
  pthread_join(thread, &calls);
  pthread_attr_destroy(&attributes);
  EXPECT_GE(reinterpret_cast<std::size_t>(calls), kRow);
}

TEST(History, ForgetsTheOldestRowsThatAreNotNeeded) {
  History history(20);  // ten rows of two
  for (int k = 0; k < 100; ++k) {
    history.add({{1.0 * k, 0.0}, {0.0, 1.0 * k}});
    history.forget_before(k < 50 ? 5 : history.last());
    EXPECT_EQ(history.last(), static_cast<std::size_t>(k));
    EXPECT_EQ(history.first(), static_cast<std::size_t>(k < 15 ? std::max(0, k - 9) : k < 50 ? 5 : k - 9));
    EXPECT_EQ(history[history.first()][0].x, static_cast<double>(history.first()));
  }
  History one(1);
  one.add({{}, {}, {}});
  one.forget_before(0);
  EXPECT_EQ(one.last(), 0u);
}

/// A robot whose speed is bounded by a box drives faster than `max_speed` along the diagonal. Going back at `max_speed`
/// it fell behind its own way.
TEST(Groups, AStepUnderABoxBoundIsUndoneInOneStep) {
  Scenario s;
  Robot& r = s.robots.emplace_back();
  const Vec2 fastest{r.max_speed * s.time_step, -r.max_speed * s.time_step};
  DecisionRules rules = rules_of(s, {});
  rules.speed_bound = SpeedBoundKind::box;
  constexpr double kRounding = 1e-12;
  for (const double share : {0.5, 1.0, 4.0}) {
    const Vec2 expected = std::min(1.0, share) / s.time_step * fastest;
    EXPECT_NEAR(norm(velocity_along(rules, r.max_speed, share * fastest) - expected), 0.0, kRounding) << share;
  }
  rules.speed_bound = SpeedBoundKind::disc;
  EXPECT_NEAR(norm(velocity_along(rules, r.max_speed, fastest)), r.max_speed, kRounding);
}

/// A map of all that stand together on a large ring had more places than memory.
TEST(Groups, OnALargeRingPlansAreMadeForAsManyAsFit) {
  constexpr std::size_t kCount = 2000;
  Scenario s;
  Step row;
  std::vector<RobotNow> now;
  const double around = 1.2 * kCount / 6.283185307179586;
  for (std::size_t i = 0; i < kCount; ++i) {
    Robot& r = s.robots.emplace_back();
    r.id = "R" + std::to_string(i);
    r.position = around * geometry::rotated({1.0, 0.0}, 6.283185307179586 * static_cast<double>(i) / kCount);
    r.goals = {r.position + Vec2{3.0, 0.0}};
    now.push_back({r.position, r.goals[0], false, true});
    RobotStep& step = row.robots.emplace_back();
    step.position = r.position;
    step.preferred = {1.0, 0.0};
    DecisionConstraint& c = step.constraints.emplace_back();
    c.source = vo::BodyKind::robot;
    c.index = (i + 1) % kCount;
    c.half_plane = {{-1.0, 0.0}, 0.0};
  }
  const ObstacleSpace open({});
  int asked = 0;
  const DecisionRules rules = rules_of(s, {});
  Groups groups(s, rules, s.robots, open, true, [&] { return ++asked > 300; });  // a few plans are enough
  const auto way_left = [](std::size_t) { return 3.0; };
  groups.begin_step(0.0, now, way_left);
  groups.end_step(row);
  groups.begin_step(100.0, now, way_left);
  groups.end_step(row);
  groups.begin_step(100.05, now, way_left);
  EXPECT_GT(groups.course().search_nodes, 0u);
  EXPECT_LT(groups.course().largest, 1000u);
}

/// Lemma 2: the half-planes of two that go by a plan which is free of collision hold what they want, in rationals; and
/// where they do not, it was not.
TEST(Lemmas, Lemma2_APairKeepsTheVelocitiesOfACollisionFreePlan) {
  SeededRandom random(test::seed_of_run(33));
  std::size_t held = 0, cut = 0;
  for (int k = 0; k < 20000; ++k) {
    const double tau = 0.05, radius = 0.5;
    const Vec2 apart = (1.0 + std::ldexp(random.uniform(0.5, 1.0), random.integer(-20, 0))) *
                       geometry::rotated({1.0, 0.0}, random.uniform(0.0, 6.28));
    const Vec2 a = random.in_box(1.5), b = random.in_box(1.5);
    vo::ReciprocalOptions options;
    options.time_horizon = options.contact_time = tau;
    const auto pair = vo::reciprocal_half_planes({{}, a, radius}, {apart, b, radius}, options);
    ASSERT_TRUE(pair.certified);
    const auto keeps = [](const geometry::HalfPlane& h, Vec2 v) {
      return dot(exactly(h.normal), exactly(v)) >= Rational(h.offset);
    };
    const bool both = keeps(pair.a, a) && keeps(pair.b, b);
    // The way of a relative to b within tau, against a disc of both radii.
    const Rational distance2 = exact_squared_distance(apart, {}, tau * (a - b));
    const double clear = std::sqrt(distance2.get_d()) - 2.0 * radius;
    if (clear > 1e-9) {
      EXPECT_TRUE(both) << clear;
      ++held;
    } else if (clear < -1e-9) {
      EXPECT_FALSE(both) << clear;
      ++cut;
    }
  }
  EXPECT_GT(held, 1000u);
  EXPECT_GT(cut, 1000u);
}

/// Lemma 3: robots that pause as they like keep their distances, the earliest move is never held back, and all arrive.
TEST(Lemmas, Lemma3_FollowingKeepsDistancesAndEnds) {
  SeededRandom random(test::seed_of_run(34));
  for (int k = 0; k < 12; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    Problem p(walls, 8, random);
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    std::vector<Vec2> at = positions(p.map, p.joint.starts);
    Following following(plan_of(p.map, answer.moves, p.joint.radii), p.joint.radii);
    double length = 0.0, least = std::numeric_limits<double>::infinity();
    for (const PlannedMove& m : following.plan()) length += norm(m.to - m.from);
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        least = std::min(least, norm(at[i] - at[j]) / (p.joint.radii[i] + p.joint.radii[j]));
    least = std::min(least, 1.0 + kPlannedGap);
    const double stride = 0.075;
    std::size_t steps = 0;
    const std::size_t most = 40 * (following.plan().size() + static_cast<std::size_t>(length / stride) + 1);
    while (following.moves_left() > 0 && steps++ < most) {
      std::vector<Vec2> next = at;
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (random.integer(0, 9) < 3) continue;  // pauses
        const Vec2 way = following.within_reach(i, at) - at[i];
        const double size = norm(way);
        next[i] = size <= stride ? at[i] + way : at[i] + stride / size * way;
      }
      for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const double distance = std::sqrt(squared_distance(at[j] - at[i], {}, (next[i] - at[i]) - (next[j] - at[j])));
          ASSERT_GE(distance, (least - 1e-6) * (p.joint.radii[i] + p.joint.radii[j]));
        }
      at = next;
      following.advance(at);
    }
    EXPECT_EQ(following.moves_left(), 0u);
  }
}

/// Lemma 4: a run backwards is a run: from where it ended, each robot may go back as it came, and keeps the half-planes
/// of a pair that plans to.
TEST(Lemmas, Lemma4_EveryStepOfARunMayBeGoneBackwards) {
  Scenario s;
  s.time_limit = 12.0;
  s.liveness = Liveness::bias;
  for (int i = 0; i < 8; ++i) {
    Robot& r = s.robots.emplace_back();
    r.id = "R" + std::to_string(i);
    r.position = 4.0 * geometry::rotated({1.0, 0.0}, 6.283185307179586 * i / 8);
    r.max_speed = 1.5;
    r.goals = {-r.position};
  }
  const Recording run = simulate(s);
  const SimulationOptions options;
  const DecisionRules rules = rules_of(s, options);
  Scene scene(s, options);
  std::vector<std::vector<Constraint>> constraints;
  std::size_t pairs = 0;
  for (std::size_t k = run.steps.size() - 1; k > 0; --k) {
    std::vector<Anchor> anchors;
    std::vector<std::optional<Vec2>> back;
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      const Vec2 here = run.steps[k].robots[i].position;
      anchors.push_back({here, {}});
      back.emplace_back((run.steps[k - 1].robots[i].position - here) / s.time_step);
    }
    PairMemory memory;
    const RobotsAt now{rules, s.robots, anchors, scene};
    robot_constraints(now, memory, constraints);
    follow_plans(now, back, constraints);
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      pairs += constraints[i].size();
      EXPECT_EQ(allowed_share(*back[i], {}, constraints[i]), 1.0) << run.steps[k].time << " " << i;
    }
  }
  EXPECT_GT(pairs, 10u);
}

}  // namespace
}  // namespace exactvo::formation::detail
