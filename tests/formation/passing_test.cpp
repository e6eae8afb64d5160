// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that have to pass each other and cannot (docs/guide/liveness.md, lemma 6): what is proven, and that nothing is
// proven of robots that can.
#include "exactvo/formation/passing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "liveness_scenes.h"
#include "preflight/square_cover.h"
#include "preflight/strip.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A closed corridor along the x axis, `length` by `width`, with the middle of its floor at the origin.
Scenario corridor(double length, double width) {
  Scenario s;
  s.name = "corridor";
  test_scenes::add_box(s, 0.5 * length, 0.5 * width);
  return s;
}

/// The same scene somewhere else.
Scenario moved(Scenario s, double angle, Vec2 by) {
  const auto move = [&](Vec2 p) { return geometry::rotated(p, angle) + by; };
  for (SceneObstacle& o : s.obstacles)
    for (Vec2& p : std::get<geometry::Polyline>(o.shape).points) p = move(p);
  for (Robot& r : s.robots) {
    r.position = move(r.position);
    for (Vec2& goal : r.goals) goal = move(goal);
  }
  return s;
}

/// Two that face each other in a corridor with a niche of this depth, 1.5 m long, which holds a robot where it is deep.
Scenario with_niche(double depth) {
  Scenario s;
  test_scenes::add_wall(s, {{-5, 0},
                            {5, 0},
                            {5, 1.3},
                            {0.75, 1.3},
                            {0.75, 1.3 + depth},
                            {-0.75, 1.3 + depth},
                            {-0.75, 1.3},
                            {-5, 1.3},
                            {-5, 0}});
  test_scenes::add_robot(s, {-4, 0.65}, {4, 0.65});
  test_scenes::add_robot(s, {4, 0.65}, {-4, 0.65});
  return s;
}

TEST(Passing, Lemma6_AReversedOrderInANarrowStripIsProvenOutOfReach) {
  test::SeededRandom random(test::seed_of_run(61));
  for (int k = 0; k < 20; ++k) {
    const double width = random.uniform(1.02, 1.999);
    Scenario reversed = corridor(10.0, width), kept = reversed;
    const auto across = [&] { return random.uniform(-0.5, 0.5) * (width - 1.01); };
    const Vec2 a{random.uniform(-4.0, -0.6), across()}, b{random.uniform(0.6, 4.0), across()};
    test_scenes::add_robot(reversed, a, b);
    test_scenes::add_robot(reversed, b, a);
    test_scenes::add_robot(kept, a, a + Vec2{0.5, 0.0});
    test_scenes::add_robot(kept, b, b - Vec2{0.1, 0.0});
    const double angle = k % 2 == 0 ? 0.0 : random.uniform(0.0, test_scenes::kTurn);
    const Vec2 by = random.in_box(100.0);
    const std::vector<NoPassing> proofs = robots_without_passing(moved(reversed, angle, by));
    ASSERT_EQ(proofs.size(), 1u) << "width " << width << ", turned by " << angle;
    EXPECT_EQ(std::make_pair(proofs[0].first, proofs[0].second), std::make_pair(std::size_t{0}, std::size_t{1}));
    EXPECT_NEAR(proofs[0].strip, width, 1e-9);
    EXPECT_GE(proofs[0].strip, width - 1e-12);
    EXPECT_THAT(robots_without_passing(moved(kept, angle, by)), IsEmpty()) << width << " " << angle;
  }
}

/// Nothing is proven where two fit side by side at one end, where a wall ends before the strip does, or where both have
/// arrived in the order in which they start.
TEST(Passing, AStripIsNarrowOverItsWholeLength) {
  const auto wedge = [](double left, double right) {
    Scenario s;
    test_scenes::add_wall(s, {{-5, 0}, {5, 0}, {5, right}, {-5, left}, {-5, 0}});
    test_scenes::add_robot(s, {-3, 0.6}, {3, 0.6});
    test_scenes::add_robot(s, {3, 0.6}, {-3, 0.6});
    return s;
  };
  const std::vector<NoPassing> proofs = robots_without_passing(wedge(1.7, 1.98));
  ASSERT_EQ(proofs.size(), 1u);
  EXPECT_GT(proofs[0].strip, 1.9);
  EXPECT_LT(proofs[0].strip, 1.98);
  EXPECT_THAT(robots_without_passing(wedge(1.7, 2.3)), IsEmpty());
  EXPECT_THAT(robots_without_passing(wedge(2.01, 2.01)), IsEmpty());

  Scenario of_two_walls = wedge(1.9, 1.9);
  std::get<geometry::Polyline>(of_two_walls.obstacles[0].shape).points = {{-5, 0},  {1, 0},    {5, 0},
                                                                          {5, 1.9}, {-5, 1.9}, {-5, 0}};
  EXPECT_EQ(robots_without_passing(of_two_walls).size(), 0u) << "not looked for along a wall of two edges";

  Scenario to_the_middle = wedge(1.9, 1.9);
  to_the_middle.robots[0].goals = {{0.5, 0.6}};
  to_the_middle.robots[1].goals = {{-0.5, 0.6}};
  EXPECT_EQ(robots_without_passing(to_the_middle).size(), 1u);
  to_the_middle.arrival_tolerance = 1.5;
  EXPECT_THAT(robots_without_passing(to_the_middle), IsEmpty());
}

TEST(Passing, OfDifferentRadii) {
  const auto with_radii = [](double width, double a, double b) {
    Scenario s = corridor(10.0, width);
    test_scenes::add_robot(s, {-3, 0}, {3, 0});
    test_scenes::add_robot(s, {3, 0}, {-3, 0});
    s.robots[0].radius = a;
    s.robots[1].radius = b;
    return robots_without_passing(s);
  };
  EXPECT_EQ(with_radii(1.55, 0.5, 0.3).size(), 1u);
  EXPECT_EQ(with_radii(1.55, 0.3, 0.5).size(), 1u);
  EXPECT_THAT(with_radii(1.65, 0.5, 0.3), IsEmpty());
}

TEST(Passing, AmongFourInAStripEachPairWhoseOrderChangesIsProven) {
  Scenario s = corridor(14.0, 1.4);
  const double goals[] = {-5.0, 4.0, 0.0, 6.0};  // the second and the third change places
  for (int i = 0; i < 4; ++i) test_scenes::add_robot(s, {-6.0 + 4.0 * i, 0.0}, {goals[i], 0.0});
  const std::vector<NoPassing> proofs = robots_without_passing(s);
  ASSERT_EQ(proofs.size(), 1u);
  EXPECT_EQ(proofs[0].first, 1u);
  EXPECT_EQ(proofs[0].second, 2u);
}

TEST(Passing, ANicheMattersWhenItHoldsARobot) {
  EXPECT_EQ(robots_without_passing(with_niche(0.3)).size(), 1u);
  EXPECT_THAT(robots_without_passing(with_niche(1.4)), IsEmpty());
}

/// A strip with a branch: a robot in the branch lets the other pass, if the branch is long enough.
TEST(Passing, ATreeOfStripsIsProvenWhereNoBranchHoldsARobot) {
  const auto tree = [](double branch) {
    constexpr double kHalf = 0.6;
    Scenario s;
    test_scenes::add_wall(s, {{-6, -kHalf},
                              {6, -kHalf},
                              {6, kHalf},
                              {kHalf, kHalf},
                              {kHalf, kHalf + branch},
                              {-kHalf, kHalf + branch},
                              {-kHalf, kHalf},
                              {-6, kHalf},
                              {-6, -kHalf}});
    test_scenes::add_robot(s, {-4, 0}, {4, 0});
    test_scenes::add_robot(s, {4, 0}, {-4, 0});
    return s;
  };
  EXPECT_EQ(robots_without_passing(tree(0.5)).size(), 1u);
  EXPECT_THAT(robots_without_passing(tree(1.5)), IsEmpty());
}

TEST(Passing, RadiiCount) {
  Scenario s = corridor(8.0, 1.6);
  test_scenes::add_robot(s, {-3, 0}, {3, 0});
  test_scenes::add_robot(s, {3, 0}, {-3, 0});
  EXPECT_EQ(robots_without_passing(s).size(), 1u);
  for (Robot& r : s.robots) r.radius = 0.35;
  EXPECT_THAT(robots_without_passing(s), IsEmpty()) << "two of them fit side by side";
  s.robots[0].radius = 0.7;
  EXPECT_EQ(robots_without_passing(s).size(), 1u);
}

/// They are pushed apart, or out of the wall, to any side.
TEST(Passing, NothingIsProvenOfRobotsThatOverlapAtTheStart) {
  const auto changing = [](Vec2 a, Vec2 b) {
    Scenario s = corridor(8.0, 1.5);
    test_scenes::add_robot(s, a, {3, 0});
    test_scenes::add_robot(s, b, {-3, 0});
    return s;
  };
  EXPECT_EQ(robots_without_passing(changing({-1, 0}, {0.01, 0})).size(), 1u);
  EXPECT_THAT(robots_without_passing(changing({-1, 0}, {-0.5, 0})), IsEmpty());
  EXPECT_EQ(robots_without_passing(changing({-1, 0.24}, {1, 0})).size(), 1u);
  EXPECT_THAT(robots_without_passing(changing({-1, 0.26}, {1, 0})), IsEmpty());
}

/// Goals that walls alone keep out of reach, whatever room there is to pass: beyond the strip, in a wall, or behind a
/// gap that is just too narrow.
TEST(Passing, NothingIsReportedOfAGoalThatIsOutOfReachByItself) {
  const auto reversed = [](double length, double width, Vec2 goal) {
    Scenario s = corridor(length, width);
    test_scenes::add_robot(s, {-3, 0}, goal);
    test_scenes::add_robot(s, {3, 0}, {-3, 0});
    return s;
  };
  EXPECT_EQ(robots_without_passing(reversed(12.0, 1.5, {4, 0})).size(), 1u);
  EXPECT_THAT(robots_without_passing(reversed(12.0, 1.5, {7, 0})), IsEmpty()) << "beyond the end of the strip";
  EXPECT_THAT(robots_without_passing(reversed(12.0, 1.5, {4, 5})), IsEmpty()) << "beside it";
  EXPECT_THAT(robots_without_passing(reversed(12.0, 1.5, {4, 0.5})), IsEmpty()) << "in the wall";
  EXPECT_THAT(robots_without_passing(reversed(12.0, 3.0, {0, 5})), IsEmpty()) << "where there is room to pass";
  Scenario by_strips = reversed(12.0, 1.5, {4, 0});
  by_strips.robots[1].goals = {{-9, 0}};
  EXPECT_THAT(robots_without_passing(by_strips), IsEmpty()) << "of the second one";

  const auto with_chamber = [](double gap) {
    Scenario s;
    test_scenes::add_wall(s, {{-6, -0.75},
                              {5, -0.75},
                              {5, -0.5 * gap},
                              {5.2, -0.5 * gap},
                              {5.2, -0.75},
                              {8, -0.75},
                              {8, 0.75},
                              {5.2, 0.75},
                              {5.2, 0.5 * gap},
                              {5, 0.5 * gap},
                              {5, 0.75},
                              {-6, 0.75},
                              {-6, -0.75}});
    test_scenes::add_robot(s, {-3, 0}, {7, 0});
    test_scenes::add_robot(s, {3, 0}, {-3, 0});
    return moved(s, 0.0, {0.03, 0.06});  // the middle of the gap within squares
  };
  EXPECT_EQ(robots_without_passing(with_chamber(1.001)).size(), 1u);
  EXPECT_THAT(robots_without_passing(with_chamber(0.999)), IsEmpty());
}

/// Then there is no room at the goals, whether the two can pass or not.
TEST(Passing, NothingIsReportedOfGoalsTooNearToEachOther) {
  const auto with_goals = [](double first, double second) {
    Scenario s = corridor(12.0, 1.5);
    test_scenes::add_robot(s, {-3, 0}, {first, 0});
    test_scenes::add_robot(s, {3, 0}, {second, 0});
    return robots_without_passing(s);
  };
  EXPECT_EQ(with_goals(1.0, 0.05).size(), 1u);
  EXPECT_THAT(with_goals(1.0, 0.5), IsEmpty());
}

TEST(Passing, AProofAboutTwoIsReportedWhateverIsReportedOfOthers) {
  Scenario s = corridor(12.0, 1.5);
  test_scenes::add_robot(s, {-3, 0}, {3, 0});
  test_scenes::add_robot(s, {3, 0}, {-3, 0});
  test_scenes::add_robot(s, {5, 0}, {9, 0});
  s.time_limit = 1.0;
  EXPECT_THAT(warnings_before(s), testing::ElementsAre(HasSubstr("goal of R3, (9, 0), cannot be reached"),
                                                       HasSubstr("R1 and R2 cannot both reach their goals")));
  const std::string outcome = simulate(s).outcome;
  EXPECT_THAT(outcome, HasSubstr("R3 cannot reach its goal"));
  EXPECT_THAT(outcome, HasSubstr("R1 and R2 cannot both reach their goals"));
  EXPECT_THAT(outcome, testing::Not(HasSubstr("R3 cannot both")));
  EXPECT_THAT(outcome, testing::Not(HasSubstr("and R3 cannot")));
}

/// Corridors of 2 m to 2.06 m for robots 1 m wide are passed by no plan, and nothing was said.
TEST(Passing, WhereOnlyTheGapsOfPlansAreMissingThatIsReported) {
  const auto head_on = [](double width, double margin) {
    Scenario s = corridor(12.0, width);
    s.margins.obstacle = margin;
    s.time_limit = 60.0;
    test_scenes::add_robot(s, {-3, 0}, {3, 0});
    test_scenes::add_robot(s, {3, 0}, {-3, 0});
    return s;
  };
  EXPECT_THAT(robots_without_gaps_to_pass(head_on(1.99, 0.08)), IsEmpty()) << "there is no room at all";
  EXPECT_THAT(robots_without_gaps_to_pass(head_on(2.07, 0.08)), IsEmpty());
  EXPECT_THAT(robots_without_gaps_to_pass(head_on(2.05, 0.0)), IsEmpty());
  const Scenario narrow = head_on(2.05, 0.08);
  EXPECT_THAT(robots_without_passing(narrow), IsEmpty());
  EXPECT_THAT(
      warnings_before(narrow),
      testing::ElementsAre("R1 and R2 may have room to pass each other, but not with the gaps of plans (they are in "
                           "a strip 2.05 m wide, and side by side they take 2.06 m)"));
  EXPECT_FALSE(measure(narrow, simulate(narrow)).all_arrived);
  const Scenario wide = head_on(2.07, 0.08), with_less = head_on(2.05, 0.0);
  EXPECT_TRUE(measure(wide, simulate(wide)).all_arrived);
  EXPECT_TRUE(measure(with_less, simulate(with_less)).all_arrived);
}

/// Walls elsewhere cost nothing, and are no walls of the strip.
TEST(Passing, OnlyWallsNearAStripAreLookedAt) {
  Scenario s = corridor(12.0, 1.5);
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) {
      const Vec2 p{20.0 + 5.0 * x, -100.0 + 5.0 * y};
      test_scenes::add_wall(s, {p, p + Vec2{3.0, 0.0}, p + Vec2{3.0, 3.0}});
    }
  const detail::EdgesByPlace walls(s.obstacles);
  std::vector<Vec2> squares;  // of the middles' places, 11 m by 0.5 m
  for (int x = -44; x < 44; ++x)
    for (int y = -2; y < 2; ++y) squares.push_back({0.125 * x, 0.125 * y});
  const detail::DiscWithGoal there{{-3, 0}, {3, 0}, 0.05}, back{{3, 0}, {-3, 0}, 0.05};
  constexpr std::size_t kLooks = 1000;
  std::size_t left = kLooks;
  ASSERT_TRUE(detail::strip_that_keeps_order(there, back, 2.0, squares, 0.125, walls, left).has_value());
  EXPECT_GT(walls.all().size(), 3 * kLooks);
  EXPECT_GT(left, kLooks / 2);
  std::size_t few = 100;
  EXPECT_FALSE(detail::strip_that_keeps_order(there, back, 2.0, squares, 0.125, walls, few).has_value());
  EXPECT_EQ(few, 0u);
}

/// What is proven to be out of reach is never reached: closed scenes with little room, run.
TEST(Passing, NothingIsProvenOfRobotsThatArrive) {
  test::SeededRandom random(test::seed_of_run(62));
  int arrived = 0, proven = 0;
  for (int k = 0; k < 12; ++k) {
    Scenario s = corridor(9.0, random.uniform(1.1, 2.6));
    if (k % 3 == 0) s = with_niche(random.uniform(0.2, 1.8));
    if (k % 3 != 0) {
      const Vec2 a{random.uniform(-3.5, -1.0), 0.0}, b{random.uniform(1.0, 3.5), 0.0};
      test_scenes::add_robot(s, a, random.integer(0, 2) > 0 ? b : a);
      test_scenes::add_robot(s, b, s.robots[0].goals[0] == b ? a : b);
    }
    s.time_limit = 60.0;
    const bool is_proven = !robots_without_passing(s).empty();
    const bool all_arrive = measure(s, simulate(s)).all_arrived;
    EXPECT_FALSE(is_proven && all_arrive) << k;
    arrived += all_arrive;
    proven += is_proven;
  }
  EXPECT_GT(arrived, 2);
  EXPECT_GT(proven, 2);
}

TEST(Passing, ItIsReportedBeforeTheRunAndAtItsEnd) {
  Scenario s = corridor(8.0, 1.5);
  s.time_limit = 10.0;
  test_scenes::add_robot(s, {-3, 0}, {3, 0});
  test_scenes::add_robot(s, {3, 0}, {-3, 0});
  const char* const words = "R1 and R2 cannot both reach their goals: they have no room to pass each other (proven: ";
  const std::vector<std::string> warnings = warnings_before(s);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr(words));
  EXPECT_THAT(simulate(s).outcome, HasSubstr(words));
}

/// Robots in the open use up looks.
TEST(Passing, RobotsInTheOpenChangeNoProofOfOthers) {
  for (const int others : {0, 1, 4, 20}) {
    Scenario s;
    test_scenes::add_box(s, 4.0, 0.75);
    test_scenes::add_robot(s, {-3, 0}, {3, 0});
    for (int k = 0; k < others; ++k) test_scenes::add_robot(s, {100.0 * (k + 1), 0}, {100.0 * (k + 1), 5});
    test_scenes::add_robot(s, {3, 0}, {-3, 0});
    const std::vector<NoPassing> proofs = robots_without_passing(s);
    ASSERT_EQ(proofs.size(), 1u) << others;
    EXPECT_EQ(proofs[0].first, 0u);
    EXPECT_EQ(proofs[0].second, static_cast<std::size_t>(others) + 1);
  }
}

/// A robot in the open gets to any number of squares; to see that takes one row of them, not all that a cover may have.
TEST(SquareCover, RowLeadsFromTheOpenBeyondAllWallsAndFromAClosedRoomNowhere) {
  constexpr double kRadius = 0.5, kSide = 0.25;
  Scenario open;
  test_scenes::add_wall(open, {{-3.0, -5.0}, {3.0, -5.0}, {3.0, 5.0}});
  Scenario closed = corridor(12.0, 8.0);
  test_scenes::add_wall(closed, {{20.0, -5.0}, {20.0, 5.0}});
  for (const double angle : {0.0, 0.3, 1.1}) {
    const detail::CoverWalls in_open(moved(open, angle, {7.0, 1.0}).obstacles);
    const detail::CoverWalls in_closed(moved(closed, angle, {7.0, 1.0}).obstacles);
    std::size_t looks = 1000;
    EXPECT_TRUE(detail::leads_outside({7.0, 1.0}, kRadius, kSide, in_open, looks)) << angle;
    EXPECT_GT(looks, 900U) << angle;
    std::size_t of_cover = 100000;
    EXPECT_FALSE(detail::cover_from({7.0, 1.0}, kRadius, kSide, in_open, of_cover).is_whole) << angle;
    looks = 1000;
    EXPECT_FALSE(detail::leads_outside({7.0, 1.0}, kRadius, kSide, in_closed, looks)) << angle;
    EXPECT_TRUE(detail::cover_from({7.0, 1.0}, kRadius, kSide, in_closed, of_cover).is_whole) << angle;
    looks = 3;
    EXPECT_FALSE(detail::leads_outside({7.0, 1.0}, kRadius, kSide, in_open, looks)) << angle;
    EXPECT_EQ(looks, 0U) << angle;
  }
}

}  // namespace
}  // namespace exactvo::formation
