// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/routes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/route_certificate.h"
#include "routes_campaign.h"

namespace exactvo::geometry {
namespace {

using test::box_at;
using test::FieldKind;
using test::route_field;
using test::RouteCampaign;
using test::RouteField;
using test::SeededRandom;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double above(double x) {
  return std::nextafter(x, kInfinity);
}

/// The answer, seen to be accepted by the checker.
RouteAnswer asked(const std::vector<Obstacle>& obstacles, double radius, Vec2 start, Vec2 goal) {
  const RouteAnswer answer = RoutePlan(RouteMap(obstacles), radius).query(start, goal);
  EXPECT_EQ(check(obstacles, {radius, start, goal}, answer), "");
  return answer;
}

// Property (1) of route_certificate.h: every answer is valid, and the right one, at critical radii too.
class RoutesAtCriticalRadii : public testing::TestWithParam<FieldKind> {};

TEST_P(RoutesAtCriticalRadii, Property1_EveryAnswerIsRightAndProven) {
  SeededRandom random(test::seed_of_run(20240611));
  RouteCampaign campaign;
  for (int k = 0; k < 25; ++k) check_field(route_field(random, GetParam()), random, campaign);
  for (const std::string& failure : campaign.failures) ADD_FAILURE() << failure;
  EXPECT_GT(campaign.routes, 0u);
  EXPECT_GT(campaign.chains + campaign.blocked, 0u);
}
INSTANTIATE_TEST_SUITE_P(Routes, RoutesAtCriticalRadii, testing::ValuesIn(test::kFieldKinds));

TEST(Routes, AGapOfExactlyTwoRadiiIsPassedAndTheNextDoubleIsNot) {
  const std::vector<Obstacle> door{Polyline{{{0, -5}, {0, -0.5}}}, Polyline{{{0, 0.5}, {0, 5}}},
                                   Polyline{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}, {-5, -5}}}};
  EXPECT_TRUE(std::holds_alternative<Route>(asked(door, 0.5, {-3, 1}, {3, -2})));
  const RouteAnswer closed = asked(door, above(0.5), {-3, 1}, {3, -2});
  ASSERT_TRUE(std::holds_alternative<Separated>(closed));
  std::size_t gaps = 0;
  for (const ChainPoint& p : std::get<Separated>(closed).chain) gaps += p.gap_follows ? 1 : 0;
  EXPECT_GE(gaps, 1u);
}

TEST(Routes, OutsideOfAllObstaclesIsFree) {
  const std::vector<Obstacle> wall{Polyline{{{0, -5}, {0, 5}}}};
  const RouteAnswer answer = asked(wall, 0.5, {-1, 0}, {1, 0});
  ASSERT_TRUE(std::holds_alternative<Route>(answer));
  const Route& route = std::get<Route>(answer);
  // Two tangents from (-1, 0) to the circle round the end (0, 5), and the arc between them.
  const double tangent = std::sqrt(26.0 - 0.25);
  const double shortest =
      2.0 * tangent + 0.5 * (2.0 * kPi - 2.0 * std::acos(0.5 / std::sqrt(26.0)) - 2.0 * std::atan2(1.0, 5.0));
  EXPECT_GT(route.length, shortest - 1e-9);
  EXPECT_LT(route.length, 1.001 * shortest);
  EXPECT_LE(route.lower_bound, shortest);
}

TEST(Routes, AWorldWithoutObstaclesIsCrossedStraight) {
  const RouteAnswer answer = asked({}, 0.5, {0, 0}, {0.3, 0.4});
  ASSERT_TRUE(std::holds_alternative<Route>(answer));
  EXPECT_EQ(std::get<Route>(answer).points.size(), 2u);
  EXPECT_DOUBLE_EQ(std::get<Route>(answer).length, 0.5);
}

TEST(Routes, StartThatIsTheGoalGivesOnePoint) {
  const RouteAnswer answer = asked({box_at(0, 0, 1, 1)}, 0.25, {3, 3}, {3, 3});
  ASSERT_TRUE(std::holds_alternative<Route>(answer));
  EXPECT_EQ(std::get<Route>(answer).points.size(), 1u);
}

TEST(Routes, OverlappingPolygonsAreOneObstacle) {
  // Two bars that cross: their common square is inside both, and no free island.
  const std::vector<Obstacle> cross{box_at(-5, -1, 10, 2), box_at(-1, -5, 2, 10)};
  const RouteAnswer inside = asked(cross, 0.1, {0, 0}, {8, 8});
  ASSERT_TRUE(std::holds_alternative<Blocked>(inside));
  EXPECT_TRUE(std::get<Blocked>(inside).inside);
  EXPECT_TRUE(std::holds_alternative<Route>(asked(cross, 0.1, {3, 3}, {-3, -3})));
}

TEST(Routes, WallsThatCrossAtAPointThatIsNoDoubleAreCutThere) {
  // A triangle of three long walls: each pair crosses at thirds.
  const std::vector<Obstacle> walls{Polyline{{{-9, 0}, {9, 1}}}, Polyline{{{-1, -9}, {4, 9}}},
                                    Polyline{{{9, -7}, {-5, 8}}}};
  EXPECT_TRUE(std::holds_alternative<Separated>(asked(walls, 0.01, {1.76, 0.66}, {20, 20})));
  EXPECT_TRUE(std::holds_alternative<Route>(asked(walls, 0.01, {-3, -3}, {20, 20})));
}

TEST(Routes, AHoleIsFreeAndSeparatedByItsPolygonAlone) {
  const Polygon ring{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{{3, 3}, {3, 6}, {6, 6}, {6, 3}}}};
  const RouteAnswer answer = asked({ring}, 0.5, {4.5, 4.5}, {-3, 4});
  ASSERT_TRUE(std::holds_alternative<Separated>(answer));
  for (const ChainPoint& p : std::get<Separated>(answer).chain) EXPECT_FALSE(p.gap_follows);
}

TEST(Routes, ABlockedEndNamesWhatBlocksIt) {
  const std::vector<Obstacle> two{box_at(10, 10, 1, 1), Polyline{{{0, 0}, {1, 0}, {2, 0}}}};
  const RouteAnswer goal = asked(two, 0.5, {5, 5}, {1.5, 0.25});
  ASSERT_TRUE(std::holds_alternative<Blocked>(goal));
  EXPECT_EQ(std::get<Blocked>(goal).end, Blocked::End::goal);
  EXPECT_EQ(std::get<Blocked>(goal).by.obstacle, 1u);
  EXPECT_FALSE(std::get<Blocked>(goal).inside);
}

TEST(Routes, AWallOfOnePointIsAnObstacle) {
  const std::vector<Obstacle> point{Polyline{{{0, 0}, {0, 0}}}};
  const RouteAnswer round = asked(point, 0.5, {-2, 0}, {2, 0});
  ASSERT_TRUE(std::holds_alternative<Route>(round));
  EXPECT_GT(std::get<Route>(round).length, 4.0);
  EXPECT_TRUE(std::holds_alternative<Blocked>(asked(point, 0.5, {0.1, 0}, {2, 0})));
}

TEST(Routes, ManyThreadsGiveTheSameBits) {
  SeededRandom random(test::seed_of_run(77));
  const RouteField f = route_field(random, FieldKind::maze);
  const RoutePlan plan(RouteMap(f.obstacles), 0.2);
  const auto text = [&] {
    const RouteAnswer answer = plan.query(f.start, f.goal);
    std::string out = std::to_string(answer.index());
    if (const auto* route = std::get_if<Route>(&answer))
      for (const ExactPoint& p : route->points) out += to_string(std::vector<Vec2>{p.rounded}) + p.x + p.y;
    return out;
  };
  const std::string expected = text();
  std::vector<std::string> got(4);
  std::vector<std::thread> threads;
  for (std::string& mine : got)
    threads.emplace_back([&] {
      for (int k = 0; k < 20; ++k) mine = text();
    });
  for (std::thread& t : threads) t.join();
  for (const std::string& mine : got) EXPECT_EQ(mine, expected);
}

TEST(Routes, CallersMistakesAreNamed) {
  const RouteMap map({box_at(0, 0, 1, 1)});
  EXPECT_THROW(RoutePlan(map, 0.0), std::logic_error);
  EXPECT_THROW(RoutePlan(map, -1.0), std::logic_error);
  EXPECT_THROW(RoutePlan(map, kInfinity), std::logic_error);
  EXPECT_THROW(RoutePlan(map, std::nan("")), std::logic_error);
  EXPECT_THROW(RouteMap({box_at(0, 0, 0x1p101, 1)}), std::logic_error);
  const RoutePlan plan(map, 0.5);
  EXPECT_THROW(plan.query({std::nan(""), 0}, {3, 3}), std::logic_error);
  EXPECT_THROW(plan.query({3, 3}, {1e9, 3}), std::logic_error);
}

// --- The checker ---

// Property (3): an answer that was tampered with is refused.
TEST(RouteCertificate, Property3_TamperedRoutesAreRefused) {
  SeededRandom random(test::seed_of_run(5));
  std::size_t tampered = 0;
  for (int k = 0; k < 40; ++k) {
    const RouteField f = route_field(random, test::kFieldKinds[k % 5]);
    const double radius = 0.3;
    RouteAnswer answer = RoutePlan(RouteMap(f.obstacles), radius).query(f.start, f.goal);
    auto* route = std::get_if<Route>(&answer);
    if (!route || route->points.size() < 3) continue;
    const RouteAnswer good = answer;
    const RouteQuestion question{radius, f.start, f.goal};
    const auto refused = [&] {
      ++tampered;
      EXPECT_NE(check(f.obstacles, question, answer), "");
      answer = good;
    };
    route->points.erase(route->points.begin());
    refused();
    route->points.pop_back();
    refused();
    // Onto a corner of an obstacle: nearer to it than any radius.
    ExactPoint& middle = route->points[route->points.size() / 2];
    middle = {
        vertices_of(
            f.obstacles[static_cast<std::size_t>(random.integer(0, static_cast<int>(f.obstacles.size()) - 1))])[0],
        {},
        {}};
    refused();
    route->points[1].x = "1/0";
    refused();
    route->points[1].y = "nonsense";
    refused();
  }
  EXPECT_GE(tampered, 50u);
}

TEST(RouteCertificate, Property3_TamperedChainsAreRefused) {
  const std::vector<Obstacle> door{Polyline{{{0, -5}, {0, -0.5}}}, Polyline{{{0, 0.5}, {0, 5}}},
                                   Polyline{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}, {-5, -5}}}};
  const RouteQuestion question{0.6, {-3, 1}, {3, -2}};
  const RouteAnswer good = asked(door, question.radius, question.start, question.goal);
  ASSERT_TRUE(std::holds_alternative<Separated>(good));
  const std::size_t n = std::get<Separated>(good).chain.size();
  for (std::size_t k = 0; k < n; ++k) {
    RouteAnswer bad = good;
    std::get<Separated>(bad).chain[k].point.rounded.y = above(std::get<Separated>(bad).chain[k].point.rounded.y + 0.01);
    std::get<Separated>(bad).chain[k].point.x = std::get<Separated>(bad).chain[k].point.y = "";
    std::get<Separated>(bad).chain[k].point.rounded.x += 0.01;
    EXPECT_NE(check(door, question, bad), "") << "point " << k << " off its edge";
    bad = good;
    std::get<Separated>(bad).chain[k].on = {99, 0};
    EXPECT_NE(check(door, question, bad), "");
    bad = good;
    std::get<Separated>(bad).chain.erase(std::get<Separated>(bad).chain.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_NE(check(door, question, bad), "") << "without point " << k;
  }
  // The same chain where the disc fits through the door: its gap is too wide.
  EXPECT_NE(check(door, {0.5, question.start, question.goal}, good), "");
  // Both ends on one side of it.
  EXPECT_NE(check(door, {0.6, question.start, {-3, -2}}, good), "");
}

// Property (2): a valid chain leaves no valid route.
TEST(RouteCertificate, Property2_AStraightWayThroughAChainIsRefused) {
  const std::vector<Obstacle> door{Polyline{{{0, -5}, {0, -0.5}}}, Polyline{{{0, 0.5}, {0, 5}}}};
  const Route through{{{{-3, 0}, {}, {}}, {{3, 0}, {}, {}}}, 6.0, 6.0};
  EXPECT_EQ(check(door, {0.5, {-3, 0}, {3, 0}}, through), "");
  EXPECT_NE(check(door, {above(0.5), {-3, 0}, {3, 0}}, through), "");
}

TEST(RouteCertificate, BlockedEndsAreChecked) {
  const std::vector<Obstacle> two{box_at(0, 0, 2, 2), Polyline{{{5, 0}, {5, 2}}}};
  const RouteQuestion question{0.5, {1, 1}, {4.75, 1}};
  EXPECT_EQ(check(two, question, Blocked{Blocked::End::start, true, {0, 0}}), "");
  EXPECT_NE(check(two, question, Blocked{Blocked::End::start, true, {1, 0}}), "");
  EXPECT_NE(check(two, question, Blocked{Blocked::End::goal, true, {0, 0}}), "");
  EXPECT_EQ(check(two, question, Blocked{Blocked::End::goal, false, {1, 0}}), "");
  EXPECT_NE(check(two, question, Blocked{Blocked::End::goal, false, {0, 1}}), "");
  EXPECT_NE(check(two, question, Blocked{Blocked::End::goal, false, {0, 9}}), "");
}

}  // namespace
}  // namespace exactvo::geometry
