// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/trap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "paper_scenes.h"
#include "trap_cases.h"

namespace exactvo::formation {
namespace {

using test::kRobot;
using test::kSpeed;

TEST(Trap, AFlatWallAlwaysTrapsARobotWhoseFootLiesWithinIt) {
  const geometry::Segment wall{{0.0, -3.0}, {0.0, 3.0}};
  EXPECT_TRUE(stall_possible(wall, {5.0, 1.0}));
  EXPECT_FALSE(stall_possible(wall, {5.0, 3.5}));
  const auto found = equilibria(wall, kRobot, {5.0, 1.0});
  // The flat side, stable, and the two rounded ends, unstable.
  ASSERT_EQ(found.size(), 3u);
  int stable = 0;
  for (const Equilibrium& e : found) {
    stable += e.stable;
    EXPECT_EQ(e.stable, std::isinf(e.radius_of_curvature));
    if (e.stable) {
      EXPECT_NEAR(e.position.x, -kRobot, 1e-12);
      EXPECT_NEAR(e.position.y, 1.0, 1e-12);
    }
  }
  EXPECT_EQ(stable, 1);
}

TEST(Trap, ADiscNeverTraps) {
  const geometry::Disc disc{{0.0, 0.0}, 2.0};
  EXPECT_FALSE(stall_possible(disc, {5.0, 0.0}));
  const auto found = equilibria(disc, kRobot, {5.0, 0.0});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].stable);
  EXPECT_NEAR(found[0].position.x, -2.5, 1e-9);
  EXPECT_NEAR(found[0].radius_of_curvature, 2.5, 1e-12);
  EXPECT_NEAR(found[0].distance, 7.5, 1e-9);
}

TEST(Trap, OnTheMinorAxisTheNoteGivesTheLeastSemiMinorAxis) {
  // b >= (-g + sqrt(g^2 + 4 a^2)) / 2.
  const double a = 3.0, g = 4.0;
  const double least = 0.5 * (-g + std::sqrt(g * g + 4.0 * a * a));
  const geometry::Ellipse thin{{0.0, 0.0}, 0.999 * least, 0.0, a}, thick{{0.0, 0.0}, 1.001 * least, 0.0, a};
  EXPECT_TRUE(stall_possible(thin, {g, 0.0}));
  EXPECT_FALSE(stall_possible(thick, {g, 0.0}));
  EXPECT_LT(evolute_margin(thin, {g, 0.0}), 0.0);
  EXPECT_GT(evolute_margin(thick, {g, 0.0}), 0.0);
}

TEST(Trap, AStableEquilibriumExistsExactlyInsideTheEvolute) {
  test::SeededRandom random(test::seed_of_run(11));
  int traps = 0;
  for (int k = 0; k < 2000; ++k) {
    const double a = random.uniform(1.0, 5.0), b = random.uniform(0.1, 0.99) * a;
    const geometry::Ellipse e = geometry::ellipse_from_axes(random.in_box(3.0), {a, b, random.uniform(-1.5, 1.5)});
    const Vec2 goal = e.center + random.in_box(2.0 * a);
    if (geometry::locate(geometry::GrownShape{e, {}, kRobot}, goal) != geometry::Place::outside) continue;
    // Nearer to the evolute than this the two roots fall into one sample.
    if (std::fabs(evolute_margin(e, goal)) < 1e-2) continue;
    bool stable = false;
    for (const Equilibrium& q : equilibria(e, kRobot, goal)) stable = stable || q.stable;
    ASSERT_EQ(stable, stall_possible(e, goal)) << geometry::to_string(e) << " goal " << goal.x << " " << goal.y;
    traps += stable;
  }
  EXPECT_GT(traps, 100);
}

TEST(Trap, AgreesWithSimulation) {
  test::SeededRandom random(test::seed_of_run(12));
  int traps = 0;
  for (int k = 0; k < 60; ++k) {
    const test::TrapCase c = test::random_trap_case(random);
    EXPECT_TRUE(test::agrees(c)) << "case " << k << ", margin " << c.margin;
    traps += stall_possible(c.ellipse, c.goal);
  }
  EXPECT_GT(traps, 3);
  EXPECT_LT(traps, 50);
}

/// s between the two offsets, in a simulation of small steps; interpolated within a step.
double simulated_escape(const test::TrapCase& c, const Equilibrium& e, double s0, double s1) {
  Scenario s = c.scenario;
  s.time_step = 0.002;
  s.time_limit = 60.0;
  s.horizons.least = 0.01;  // on the boundary at once
  // From the boundary itself, half of the way to the first offset.
  s.robots[0].position = e.position + 1e-4 * e.normal + 0.5 * s0 * geometry::perp(e.normal);
  const Recording r = simulate(s, c.options);
  const auto offset = [&](std::size_t k) {
    return std::fabs(dot(geometry::perp(e.normal), r.steps[k].robots[0].position - e.position));
  };
  const auto crossing = [&](double level) {
    std::size_t k = 1;
    while (k + 1 < r.steps.size() && offset(k) < level) ++k;
    const double share = (level - offset(k - 1)) / (offset(k) - offset(k - 1));
    return r.steps[k - 1].time + share * s.time_step;
  };
  return crossing(s1) - crossing(s0);
}

TEST(Trap, EscapeTimesMatchSimulationWithinOnePerCent) {
  test::SeededRandom random(test::seed_of_run(13));
  int judged = 0;
  for (int k = 0; judged < 50; ++k) {
    ASSERT_LT(k, 2000);
    test::TrapCase c = test::random_trap_case(random);
    // On the minor axis, where the boundary is symmetric and the linear law holds to second order.
    const geometry::EllipseAxes axes = geometry::axes_of(c.ellipse);
    c.goal = c.ellipse.center + random.uniform(1.0, 12.0) * geometry::rotated({0.0, 1.0}, axes.angle);
    if (geometry::locate(test::grown(c.ellipse), c.goal) != geometry::Place::outside) continue;
    if (evolute_margin(c.ellipse, c.goal) < 0.3) continue;
    const auto found = equilibria(c.ellipse, kRobot, c.goal);
    if (found.size() != 1 || !test::place_start(c, 1e-3)) continue;
    const Equilibrium e = found.front();
    // Beyond the tie-break's angle, within the linear range.
    const double s1 = 0.05 * axes.a, s0 = 0.2 * s1;
    const double angle = 0.5 * s0 * (1.0 / e.radius_of_curvature - 1.0 / e.distance);
    if (angle < 1.2e-3) continue;
    const double predicted = std::log(s1 / s0) / e.rate_at(kSpeed);  // linearised: right to second order in s1 / rho
    EXPECT_NEAR(simulated_escape(c, e, s0, s1), predicted, 0.01 * predicted) << "case " << k;
    ++judged;
  }
}

TEST(Trap, FindingsOfTheScenesSayWhatTheRunsShow) {
  // The clusters of A1-A13 carry the certificate where the goal and the start are clear of them.
  SimulationOptions options;
  options.method = Method::ivo_cluster;
  int trap_free = 0;
  for (const TrapFinding& f : trap_test(test::paper_scene("A4"), options)) {
    if (!f.place.enclosure.trap_free()) continue;
    ++trap_free;
    EXPECT_FALSE(f.stall_possible);
    EXPECT_TRUE(f.start_clear);
    EXPECT_GT(f.margin.value(), 0.0);
    for (const Equilibrium& e : f.equilibria) EXPECT_FALSE(e.stable);
  }
  EXPECT_GT(trap_free, 0);
  // An ellipse an edge, thin: A11 stops at its wall.
  options.method = Method::ivo_edge;
  options.facade_fixed_minor = 0.1;
  const auto thin = trap_test(test::paper_scene("A11"), options);
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_TRUE(thin[0].stall_possible);
  EXPECT_FALSE(thin[0].slide_time.has_value());
}

/// A robot at the origin, its goal 8 m to the east.
Scenario one_robot(geometry::Obstacle obstacle) {
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  Robot r;
  r.id = "R1";
  r.goals = {{8.0, 0.0}};
  s.robots = {r};
  s.obstacles = {{"o", std::move(obstacle)}};
  return s;
}

std::vector<Equilibrium> rests_without_enclosures(const Scenario& s) {
  SimulationOptions options;
  options.method = Method::orca;
  std::vector<Equilibrium> rests;
  for (const TrapFinding& f : trap_test(s, options)) {
    EXPECT_EQ(f.stall_possible, !f.equilibria.empty());
    rests.insert(rests.end(), f.equilibria.begin(), f.equilibria.end());
  }
  return rests;
}

TEST(Trap, RestsOutsideOfARoomAreOutOfReachOfARobotInside) {
  for (const bool has_door : {false, true}) {
    Scenario room =
        one_robot(geometry::Polyline{{{10, 10}, {-10, 10}, {-10, -10}, {10, -10}, {10, has_door ? 8.0 : 10.0}}});
    room.robots[0].goals = {{7.0, 3.0}};
    for (const Method method : {Method::orca, Method::ivo, Method::ivo_edge}) {
      SimulationOptions options;
      options.method = method;
      options.guidance = Guidance::none;
      std::size_t outside = 0;
      for (const TrapFinding& f : trap_test(room, options))
        for (const Equilibrium& e : f.equilibria) {
          if (std::max(std::fabs(e.position.x), std::fabs(e.position.y)) < 10.0) continue;
          EXPECT_EQ(e.reachable, has_door) << name(method) << " " << e.position.x << " " << e.position.y;
          ++outside;
        }
      EXPECT_GT(outside, 1u) << name(method);
    }
  }
}

TEST(Trap, WithoutEnclosuresAFlatEdgeBeforeTheGoalTraps) {
  const Scenario wall = one_robot(geometry::Polyline{{{4.0, -1.0}, {4.0, 1.0}}});
  const auto rests = rests_without_enclosures(wall);
  ASSERT_EQ(rests.size(), 1u) << "from the side that looks away from the goal only";
  EXPECT_NEAR(rests[0].position.x, 4.0 - wall.robots[0].radius, 1e-12);
  EXPECT_NEAR(rests[0].position.y, 0.0, 1e-12);
  EXPECT_TRUE(rests[0].stable);
  SimulationOptions options;
  options.method = Method::orca;
  const Recording run = simulate(wall, options);
  EXPECT_LT(norm(run.steps.back().robots[0].position - rests[0].position), 0.05);

  const geometry::Polygon desk{{{3.0, -0.5}, {5.0, -0.5}, {5.0, 0.5}, {3.0, 0.5}}, {}};
  EXPECT_EQ(rests_without_enclosures(one_robot(desk)).size(), 1u) << "not the side that faces the goal";
  const geometry::Polygon aside{{{3.0, 0.5}, {5.0, 0.5}, {5.0, 1.5}, {3.0, 1.5}}, {}};
  EXPECT_TRUE(rests_without_enclosures(one_robot(aside)).empty());
}

TEST(Trap, WithoutEnclosuresAHollowCornerTraps) {
  // A wedge that opens to the west: the goal's foot lies on neither wall.
  const Scenario wedge = one_robot(geometry::Polyline{{{3.0, -1.5}, {4.0, 0.0}, {3.0, 1.5}}});
  const auto rests = rests_without_enclosures(wedge);
  ASSERT_EQ(rests.size(), 1u);
  EXPECT_NEAR(rests[0].position.y, 0.0, 1e-12);
  EXPECT_LT(rests[0].position.x, 4.0 - wedge.robots[0].radius);
  SimulationOptions options;
  options.method = Method::orca;
  const Recording run = simulate(wedge, options);
  EXPECT_LT(norm(run.steps.back().robots[0].position - rests[0].position), 0.05);
  // Seen from behind, the same corner parts the ways.
  const Scenario behind = one_robot(geometry::Polyline{{{5.0, -1.5}, {4.0, 0.0}, {5.0, 1.5}}});
  EXPECT_TRUE(rests_without_enclosures(behind).empty());
}

Recording run_without_enclosures(const Scenario& s) {
  SimulationOptions options;
  options.method = Method::orca;
  return simulate(s, options);
}

TEST(Trap, WithoutEnclosuresAGoalNearerToAnEdgeThanTheRadiusTrapsToo) {
  // The robot cannot come nearer to the wall than its radius: over a goal 0.1 m before it, it rests.
  const double radius = one_robot(geometry::Polyline{{{4.0, -1.0}, {4.0, 1.0}}}).robots[0].radius;
  const auto before = [](double gap) { return one_robot(geometry::Polyline{{{8.0 + gap, -1.0}, {8.0 + gap, 1.0}}}); };
  const auto from_the_west = [&](double gap) {
    int count = 0;
    for (const Equilibrium& e : rests_without_enclosures(before(gap))) count += e.normal.x < 0.0;
    return count;
  };
  ASSERT_GT(radius, 0.2);
  EXPECT_EQ(from_the_west(0.1), 1);
  EXPECT_EQ(from_the_west(0.99 * radius), 1);
  EXPECT_EQ(from_the_west(radius), 0) << "it arrives";
  EXPECT_EQ(from_the_west(1.01 * radius), 0);
  EXPECT_NEAR(run_without_enclosures(before(0.1)).steps.back().robots[0].position.x, 8.1 - radius, 0.05);
}

TEST(Trap, WithoutEnclosuresACornerThatTheRobotDoesNotFitInIsNone) {
  const double radius = one_robot(geometry::Polyline{{{4.0, -1.0}, {4.0, 1.0}}}).robots[0].radius;
  // A wedge whose edges are shorter than the way to where the robot would touch both.
  const geometry::Polyline small{{{4.0 - 0.1 * radius, -0.1 * radius}, {4.0, 0.0}, {4.0 - 0.1 * radius, 0.1 * radius}}};
  EXPECT_TRUE(rests_without_enclosures(one_robot(small)).empty());
  // A wedge with a bar before it, over where the robot would rest: only the bar is left.
  const geometry::Polyline open{{{3.0, -1.5}, {4.0, 0.0}, {3.0, 1.5}}};
  const auto in_the_open = rests_without_enclosures(one_robot(open));
  ASSERT_EQ(in_the_open.size(), 1u);
  const double x = in_the_open[0].position.x;
  const geometry::Polyline barred{{{3.0, -1.5}, {4.0, 0.0}, {3.0, 1.5}, {x, 1.5}, {x, 0.1 * radius}}};
  for (const Equilibrium& e : rests_without_enclosures(one_robot(barred)))
    EXPECT_GT(norm(e.position - in_the_open[0].position), 0.5 * radius);
}

TEST(Trap, WithoutEnclosuresAGoalInTheCornerItselfIsReached) {
  Scenario wedge = one_robot(geometry::Polyline{{{3.0, -1.5}, {4.0, 0.0}, {3.0, 1.5}}});
  wedge.robots[0].goals = {rests_without_enclosures(wedge).at(0).position};
  for (const Equilibrium& e : rests_without_enclosures(wedge)) EXPECT_GT(e.distance, 0.0);
}

TEST(Trap, WithoutEnclosuresASceneThatPassesIsClear) {
  // A desk beside the way, a block on it that turns a corner to the robot, a slanted wall: it slides past them.
  const Scenario scenes[] = {
      one_robot(geometry::Polygon{{{3.0, 0.6}, {5.0, 0.6}, {5.0, 1.5}, {3.0, 1.5}}, {}}),
      one_robot(geometry::Polygon{{{3.0, 0.1}, {4.5, -0.6}, {5.0, 0.3}, {4.3, 0.9}}, {}}),
      one_robot(geometry::Polyline{{{2.0, 0.3}, {5.0, -2.5}}}),
  };
  for (const Scenario& scene : scenes) {
    EXPECT_TRUE(rests_without_enclosures(scene).empty());
    const Vec2 end = run_without_enclosures(scene).steps.back().robots[0].position;
    EXPECT_LT(norm(end - scene.robots[0].goals[0]), 0.1);
  }
}

TEST(Trap, WithoutEnclosuresNoSceneThatStopsIsCleared) {
  for (const std::string name : {"A1", "A4", "A11"}) {
    const Scenario scene = test::paper_scene(name);
    EXPECT_FALSE(rests_without_enclosures(scene).empty()) << name;
  }
}

// --- Two enclosures that overlap ---

SimulationOptions with_facade_ellipses() {
  SimulationOptions options;
  options.method = Method::ivo_edge;
  return options;
}

/// A U that opens towards the robot, its goal beyond a corner: every facade alone lets the robot pass.
Scenario before_a_u() {
  Scenario s =
      one_robot(geometry::Polygon{{{4, -4}, {10, -4}, {10, 4}, {4, 4}, {4, 3.5}, {9, 3.5}, {9, -3.5}, {4, -3.5}}, {}});
  s.robots[0].goals = {{12.0, 6.0}};
  s.time_limit = 40.0;
  return s;
}

Vec2 end_of(const Recording& run) {
  return run.steps.back().robots[0].position;
}

TEST(Trap, TheVertexBetweenTwoEnclosuresOfAUIsAStall) {
  const Scenario u = before_a_u();
  const auto findings = trap_test(u, with_facade_ellipses());
  const Vec2 end = end_of(simulate(u, with_facade_ellipses()));
  ASSERT_GT(norm(end - u.robots[0].goals[0]), 1.0) << "it stalls";
  const TrapFinding* between = nullptr;
  for (const TrapFinding& f : findings)
    if (f.overlapping && f.place.number == 4 && f.overlapping->number == 5) between = &f;
  ASSERT_NE(between, nullptr);
  EXPECT_TRUE(between->stall_possible);
  ASSERT_EQ(between->equilibria.size(), 1u);
  EXPECT_LT(norm(between->equilibria[0].position - end), 0.05);
}

TEST(Trap, AFindingNamesItsFacade) {
  const auto findings = trap_test(before_a_u(), with_facade_ellipses());
  std::size_t alone = 0;
  for (const TrapFinding& f : findings) {
    if (f.overlapping) continue;
    EXPECT_EQ(f.place.number, alone++);
    ASSERT_TRUE(f.place.facade.has_value());
    const auto& ellipse = std::get<geometry::Ellipse>(f.place.enclosure.shape);
    EXPECT_LT(norm(0.5 * (f.place.facade->a + f.place.facade->b) - ellipse.center), 1e-9);
  }
  EXPECT_EQ(alone, 8u);
}

TEST(Trap, AGoalInsideAnEnclosureIsAStall) {
  // 0.8 m behind the wall, where the robot itself has room, but inside the wall's ellipse grown by the robot.
  Scenario s = one_robot(geometry::Polyline{{{4.0, -3.0}, {4.0, 3.0}}});
  s.robots[0].goals = {{4.8, 2.0}};
  s.robots[0].position = {-2.0, 4.0};
  s.time_limit = 30.0;
  const auto findings = trap_test(s, with_facade_ellipses());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_FALSE(findings[0].goal_clear);
  EXPECT_TRUE(findings[0].stall_possible);
  const Vec2 end = end_of(simulate(s, with_facade_ellipses()));
  EXPECT_GT(norm(end - s.robots[0].goals[0]), s.arrival_tolerance);
  EXPECT_LT(test::distance_to_rests(findings, end), 0.05);
}

TEST(Trap, OverlappingFacadesAgreeWithSimulation) {
  test::SeededRandom random(test::seed_of_run(14));
  int stalls = 0, between = 0, passed = 0;
  for (int k = 0; stalls + passed < 60; ++k) {
    ASSERT_LT(k, 5000);
    const auto pair = test::random_pair(random);
    if (!pair) continue;
    const test::PairOutcome outcome = test::outcome_of(*pair);
    EXPECT_TRUE(outcome.agrees()) << "case " << k << ": " << outcome.words;
    stalls += !outcome.arrived;
    passed += outcome.arrived;
    between += !outcome.arrived && outcome.between;
  }
  EXPECT_GT(between, 3);
  EXPECT_GT(passed, 20);
}

TEST(Trap, ARobotThatStartsBeforeAVertexReportedAsATrapRestsThere) {
  test::SeededRandom random(test::seed_of_run(15));
  int judged = 0;
  for (int k = 0; judged < 40; ++k) {
    ASSERT_LT(k, 5000);
    const auto pair = test::random_pair(random);
    if (!pair) continue;
    for (const test::VertexOutcome& vertex : test::vertex_outcomes(*pair)) {
      EXPECT_LT(vertex.distance, 0.05) << "case " << k << ": " << vertex.words;
      ++judged;
    }
  }
}

TEST(Trap, SlideTimesAreThoseOfTheRun) {
  // A disc-like enclosure met off its axis: the robot slides until its way is free.
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  Robot r;
  r.id = "R1";
  r.position = {-8.0, 0.5};
  r.goals = {{9.0, 0.0}};
  s.robots = {r};
  s.obstacles = {{"wall", geometry::Polyline{{{0.0, -2.0}, {0.0, 2.0}}}}};
  s.time_step = 0.005;
  s.horizons.least = 0.01;
  SimulationOptions options;
  options.method = Method::ivo_edge;
  options.facade_minor_to_major = 0.9;
  options.record_all = true;
  const auto found = trap_test(s, options);
  ASSERT_EQ(found.size(), 1u);
  ASSERT_TRUE(found[0].slide_time.has_value());
  const Recording run = simulate(s, options);
  double sliding = 0.0;
  for (const Step& row : run.steps)
    for (const DecisionConstraint& c : row.robots[0].constraints)
      if (c.active && geometry::locate({run.bodies.at(c.body).shape, {}, r.radius + 0.05}, row.robots[0].position) ==
                          geometry::Place::inside)
        sliding += s.time_step;
  EXPECT_NEAR(sliding, *found[0].slide_time, 0.1 * *found[0].slide_time);
}

/// Two walls whose enclosures overlap, with a concave vertex near (-0.7732, 1.4079); mirrored, near (0.7732, 1.4079).
Scenario overlapping_pair(bool is_mirrored) {
  const auto at = [&](double x, double y) { return Vec2{is_mirrored ? -x : x, y}; };
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  Robot r;
  r.id = "R1";
  r.position = at(-0x1.269abe495912ap+1, 0x1.26c4bc54d333p+2);
  r.goals = {at(0x1.ea89e40f3f6dcp+1, -0x1.426d6adffe43cp+1)};
  s.robots = {r};
  s.obstacles = {{"a", geometry::Polyline{{at(0x1.06d8ecc66a2cdp-2, 0x1.f9e556d2bbccp-1),
                                           at(0x1.dc84fabb0a68cp-4, 0x1.8534d074e1d2cp+1)}}},
                 {"b", geometry::Polyline{{at(-0x1.a1c13684e5824p-1, -0x1.faa4044877d6ep-1),
                                           at(0x1.01055908e88c2p+0, 0x1.a85f8b80772f7p+0)}}}};
  s.time_limit = 60.0;
  return s;
}

/// The direction to the goal is outside the cone of rest by 5e-4 rad; the tie-break turns the robot by 1e-3 into it,
/// against enclosure 0, and it stands for the rest of the minute.
TEST(Trap, ARestThatTheTieBreakMakesIsPredicted) {
  const Scenario s = overlapping_pair(false);
  const test::PairOutcome outcome = test::outcome_of(s);
  EXPECT_FALSE(outcome.arrived);
  EXPECT_TRUE(outcome.between) << outcome.words;
  EXPECT_NE(outcome.words.find("blocked between enclosure 0 of obstacle a and enclosure 1 of obstacle b"),
            std::string::npos)
      << outcome.words;
  EXPECT_EQ(outcome.words.find("unstable"), std::string::npos) << outcome.words;
}

/// The goal is turned round the mirrored vertex, so that its direction is in the cone by `depth` rad beside the edge
/// at which the robot meets enclosure 1 head-on.
Scenario mirrored_pair_with_depth(double depth) {
  constexpr double kOutside = 5.433e-4;  // rad, by which the direction misses the cone before
  Scenario s = overlapping_pair(true);
  const Vec2 vertex{0x1.8bdd773f7e3ebp-1, 0x1.68698401075b8p+0};
  s.robots[0].goals = {vertex + geometry::rotated(s.robots[0].goals[0] - vertex, -(kOutside + depth))};
  return s;
}

TEST(Trap, ARestThatTheTieBreakEndsIsNotPredicted) {
  for (const double depth : {1e-4, 5e-4, 9e-4}) {
    const Scenario s = mirrored_pair_with_depth(depth);
    const auto findings = trap_test(s, test::pair_options());
    ASSERT_TRUE(findings.back().overlapping);
    EXPECT_FALSE(findings.back().stall_possible) << "depth " << depth;
    EXPECT_TRUE(test::outcome_of(s).arrived) << "depth " << depth << ": " << test::outcome_of(s).words;
  }
}

TEST(Trap, BeyondTheReachOfTheTieBreakTheRestIsPredicted) {
  const Scenario s = mirrored_pair_with_depth(1.1e-3);
  const test::PairOutcome outcome = test::outcome_of(s);
  EXPECT_FALSE(outcome.arrived);
  EXPECT_TRUE(outcome.between) << outcome.words;
  EXPECT_NEAR(*trap_test(s, test::pair_options()).back().margin, -1.1e-3, 1e-5);
}

}  // namespace
}  // namespace exactvo::formation
