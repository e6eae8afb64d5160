// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/routes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <thread>

#include "cell_world.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/route_certificate.h"
#include "route_oracle.h"
#include "routes/marks.h"
#include "routes_campaign.h"

namespace exactvo::geometry {
namespace {

using test::box_at;
using test::FieldKind;
using test::route_field;
using test::RouteCampaign;
using test::RouteField;
using test::SeededRandom;

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
  ASSERT_GT(campaign.routes, 0u);
  EXPECT_GT(campaign.chains + campaign.blocked, 0u);
  // Ties are the worst: where the disc just fits everywhere, it crosses gates straight and the bound does not know.
  EXPECT_LT(campaign.sum_of_ratios / static_cast<double>(campaign.routes), 1.02);
}
INSTANTIATE_TEST_SUITE_P(Routes, RoutesAtCriticalRadii, testing::ValuesIn(test::kFieldKinds),
                         [](const auto& kind) { return test::kFieldKindNames[kind.index]; });

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

// A map without the gates that no asked disc is stopped by: the same answers and the same chains, point by point.
TEST(RouteMapForChainsOnly, AnswersAsTheWholeMapDoes) {
  SeededRandom random(test::seed_of_run(20261122));
  std::size_t chains = 0, open = 0;
  for (int k = 0; k < 40; ++k) {
    const RouteField field = route_field(random, test::kFieldKinds[k % std::size(test::kFieldKinds)]);
    RouteMapOptions options;
    options.largest_distance = 100.0;
    const RouteMap whole(field.obstacles, options);
    options.chains_only = true;
    options.largest_radius = random.uniform(0.02, 0.6);
    const RouteMap narrow(field.obstacles, options);
    EXPECT_EQ(narrow.largest_radius(), options.largest_radius);
    EXPECT_LE(narrow.cell_count(), whole.cell_count());
    for (const double share : {1.0, 0.7, 0.3}) {
      const double radius = share * options.largest_radius;
      const RoutePlan of_whole(whole, radius), of_narrow(narrow, radius);
      for (int i = 0; i < 12; ++i) {
        const Vec2 a = field.start + random.in_box(8.0), b = field.goal + random.in_box(8.0);
        ASSERT_EQ(of_narrow.is_reachable(a, b), of_whole.is_reachable(a, b));
        const RouteAnswer expected = of_whole.query(a, b);
        if (std::holds_alternative<Route>(expected)) {
          ++open;
          continue;
        }
        const RouteAnswer answer = of_narrow.query(a, b);
        ASSERT_EQ(answer.index(), expected.index());
        const auto* chain = std::get_if<Separated>(&answer);
        if (!chain) continue;
        ++chains;
        const std::vector<ChainPoint>& same = std::get<Separated>(expected).chain;
        ASSERT_EQ(chain->chain.size(), same.size());
        for (std::size_t p = 0; p < same.size(); ++p) {
          EXPECT_EQ(chain->chain[p].point.rounded, same[p].point.rounded);
          EXPECT_EQ(chain->chain[p].point.x, same[p].point.x);
          EXPECT_EQ(chain->chain[p].on.edge, same[p].on.edge);
          EXPECT_EQ(chain->chain[p].gap_follows, same[p].gap_follows);
        }
      }
    }
  }
  EXPECT_GT(chains, 50u);
  EXPECT_GT(open, 50u);
}

// The campaigns compare it with a bisection over doubles.
TEST(WidestRadius, IsThatOfTheGateThatTheWidestWayCannotAvoid) {
  // Two doors from the left to the right, 2 and 3 m wide, and a niche of 1 m.
  const std::vector<Obstacle> doors{
      Polyline{{{0, -50}, {0, -1}}},        Polyline{{{0, 1}, {0, 10}}},
      Polyline{{{0, 13}, {0, 50}}},         Polyline{{{9, 0}, {9, 4}}},
      Polyline{{{10, 0}, {10, 4}, {9, 4}}}, test::fence({{-50, -50}, {50, -50}, {50, 50}, {-50, 50}})};
  const RouteMap map(doors);
  EXPECT_EQ(map.widest_radius({-20, 0}, {20, 30}), 1.5);
  EXPECT_EQ(map.widest_radius({-20, 0}, {9.5, 2}), 0.5);
  EXPECT_EQ(map.widest_radius({-20, 0}, {9.5, 3.75}), 0.25);  // nearer to the niche's end
  EXPECT_EQ(map.widest_radius({-20, 0}, {60, 0}), 0.0);
  EXPECT_EQ(map.widest_radius({-20, 0}, {0, 20}), 0.0);
  EXPECT_EQ(map.widest_radius({-20, 5}, {-20, 5}), 20.0);
  EXPECT_EQ(RouteMap({}).widest_radius({0, 0}, {1, 1}), RouteMap({}).largest_radius());
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
  EXPECT_THROW(RoutePlan(map, 0x1p-101), std::logic_error);
  EXPECT_THROW(RoutePlan(map, -1.0), std::logic_error);
  EXPECT_THROW(RoutePlan(map, kInfinity), std::logic_error);
  EXPECT_THROW(RoutePlan(map, std::nan("")), std::logic_error);
  EXPECT_THROW(RouteMap({box_at(0, 0, 0x1p101, 1)}), std::logic_error);
  const RoutePlan plan(map, 0.5);
  EXPECT_THROW(plan.query({std::nan(""), 0}, {3, 3}), std::logic_error);
  EXPECT_THROW(plan.query({3, 3}, {1e9, 3}), std::logic_error);
}

// --- Points ---

TEST(RoutesOfPoints, APointPassesEveryGapThatHasAWidth) {
  const auto door = [](double y) {
    return std::vector<Obstacle>{Polyline{{{0, -5}, {0, 0}}}, Polyline{{{0, y}, {0, 5}}},
                                 Polyline{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}, {-5, -5}}}};
  };
  EXPECT_TRUE(std::holds_alternative<Separated>(asked(door(0.0), 0.0, {-3, 1}, {3, -2})));
  for (const double width : {1.0, 1e-9, 1e-15, 1e-20, 1e-30})
    EXPECT_TRUE(std::holds_alternative<Route>(asked(door(width), 0.0, {-3, 1}, {3, -2}))) << width;
}

// In a turned maze a wall ends beside the one it was to end on, by the rounding of a coordinate: a point passes there.
TEST(RoutesOfPoints, AreThereWhereSomeDiscHasOneAndHardlyLongerThanTheirBound) {
  SeededRandom random(test::seed_of_run(21));
  std::size_t counts[3] = {}, with_room = 0;
  for (int k = 0; k < 240; ++k) {
    const FieldKind kind = test::kFieldKinds[static_cast<std::size_t>(k) % std::size(test::kFieldKinds)];
    const RouteField f = route_field(random, kind);
    const RouteMap map(f.obstacles);
    const RoutePlan plan(map, 0.0);
    const RouteAnswer answer = plan.query(f.start, f.goal);
    const std::string text = test::corpus_line(test::RouteCase{f, 0.0});
    EXPECT_EQ(check(f.obstacles, {0.0, f.start, f.goal}, answer), "") << text;
    EXPECT_EQ(plan.is_reachable(f.start, f.goal), answer.index() == 0) << text;
    ++counts[answer.index()];
    const double widest = map.widest_radius(f.start, f.goal);
    const bool has_room = map.widest_radius(f.start, f.start) > 0.0 && map.widest_radius(f.goal, f.goal) > 0.0;
    if (has_room) {
      EXPECT_EQ(widest > 0.0, answer.index() == 0) << text;
    }
    with_room += has_room;
    const auto* route = std::get_if<Route>(&answer);
    if (!route) continue;
    EXPECT_LE(route->length, route->lower_bound * (1.0 + 1e-9)) << text;
    constexpr double kSmall = 1e-6;
    if (widest < kSmall) continue;
    const RouteAnswer of_disc = RoutePlan(map, kSmall).query(f.start, f.goal);
    EXPECT_LE(route->length, std::get<Route>(of_disc).length * (1.0 + 1e-9)) << text;
    if (kind == FieldKind::scattered || kind == FieldKind::boxes || kind == FieldKind::lattice) {
      EXPECT_NEAR(route->length, std::get<Route>(of_disc).length, 1e-3) << text;
    }
  }
  EXPECT_GE(counts[0], 50u);
  EXPECT_GE(counts[1], 1u);
  EXPECT_GE(counts[2], 5u);
  EXPECT_GE(with_room, 150u);
}

TEST(RoutesOfPoints, AreTheShortestAmongCells) {
  SeededRandom random(test::seed_of_run(20261123));
  std::size_t routes = 0, chains = 0;
  for (int k = 0; k < 120; ++k) {
    const test::CellWorld world(random, random.integer(3, 14), random.uniform(0.15, 0.5));
    const std::vector<Obstacle> obstacles = world.obstacles();
    const RouteAnswer answer = asked(obstacles, 0.0, world.start(), world.goal());
    const double shortest = world.shortest();
    const std::string text = test::corpus_line(test::RouteCase{{obstacles, world.start(), world.goal()}, 0.0});
    ASSERT_EQ(std::isinf(shortest), std::holds_alternative<Separated>(answer)) << text;
    if (std::isinf(shortest)) {
      ++chains;
      continue;
    }
    ++routes;
    EXPECT_NEAR(std::get<Route>(answer).length, shortest, 1e-9 * shortest) << text;
    EXPECT_NEAR(std::get<Route>(answer).lower_bound, shortest, 1e-12 * shortest) << text;
  }
  EXPECT_GE(routes, 30u);
  EXPECT_GE(chains, 5u);
}

// --- How long ---

// A search that went round a corner at which many portals end for ever, and gave up, answered with a way five times too
// long; an end in contact was left by a detour along the tangent.
TEST(Routes, LengthsLieBetweenTheirBoundsAndAnIndependentOptimum) {
  SeededRandom random(test::seed_of_run(99));
  std::size_t compared = 0;
  for (int k = 0; k < 40; ++k) {
    const FieldKind kind = k % 4 ? FieldKind::scattered : FieldKind::maze;
    RouteField f = route_field(random, kind);
    if (f.obstacles.size() > 16) f.obstacles.resize(16);
    const double radius = random.uniform(0.1, 0.7);
    const RouteAnswer answer = asked(f.obstacles, radius, f.start, f.goal);
    const auto* route = std::get_if<Route>(&answer);
    if (!route) continue;
    ++compared;
    const double optimum = test::TangentGraph(f, radius).shortest();
    const std::string text = test::corpus_line(test::RouteCase{f, radius});
    EXPECT_LE(route->lower_bound, optimum * (1.0 + 1e-6)) << text;
    EXPECT_GE(route->length, optimum * (1.0 - 1e-6)) << text;
    EXPECT_LE(route->length, optimum * 1.02) << text;
  }
  EXPECT_GE(compared, 10u);
}

// --- Sizes ---

/// Teeth along a wall, all of one height.
std::vector<Obstacle> comb(int teeth) {
  std::vector<Obstacle> out{Polyline{{{0, 1.0 * teeth}, {1.0 * teeth, 1.0 * teeth}}}};
  for (int k = 1; k < teeth; ++k) out.push_back(Polyline{{{1.0 * k, 0}, {1.0 * k, -1.0}}});
  return out;
}

// All links together crossed n^2 / 4 sides, and the search for one needed a frame of the stack for each.
TEST(RouteMapSize, AWallThatManyVerticesFaceIsNotCrossedByAllOfThem) {
  for (const int teeth : {500, 4000}) EXPECT_LT(RouteMap(comb(teeth)).cell_count(), 20u * teeth) << teeth;
}

TEST(RouteMapSize, CutWallsAnswerAsWholeOnesDo) {
  const std::vector<Obstacle> obstacles = comb(1000);
  const RouteMap map(obstacles);
  for (const auto& [radius, goal] : std::vector<std::pair<double, Vec2>>{
           {500.0, {1500, 500}}, {above(500.0), {1500, 500}}, {0.5, {500.5, -0.5}}, {above(0.5), {500.5, -0.5}}}) {
    const Vec2 start{-1200, 500};
    EXPECT_EQ(check(obstacles, {radius, start, goal}, RoutePlan(map, radius).query(start, goal)), "") << radius;
  }
  EXPECT_TRUE(std::holds_alternative<Route>(RoutePlan(map, 0.5).query({-1200, 500}, {500.5, -0.5})));
  EXPECT_TRUE(std::holds_alternative<Blocked>(RoutePlan(map, above(0.5)).query({-1200, 500}, {500.5, -0.5})));
}

TEST(RouteMarks, AreEmptyAgainAfterTheirCounterHasComeRound) {
  routing::Remembered<int> marks(3, std::numeric_limits<std::uint32_t>::max() - 1);
  marks.set(0, 7);
  marks.clear();
  EXPECT_EQ(marks.find(0), nullptr);
  marks.set(1, 7);
  marks.clear();
  for (int k = 0; k < 3; ++k) EXPECT_EQ(marks.find(k), nullptr);
  marks.set(2, 7);
  ASSERT_NE(marks.find(2), nullptr);
  EXPECT_EQ(*marks.find(2), 7);
}

// --- Scales ---

RouteField scaled(const RouteField& f, double factor) {
  RouteField out = f;
  const auto scale = [&](std::vector<Vec2>& points) {
    for (Vec2& p : points) p = factor * p;
  };
  for (Obstacle& o : out.obstacles) {
    if (auto* wall = std::get_if<Polyline>(&o)) scale(wall->points);
    if (auto* polygon = std::get_if<Polygon>(&o)) {
      scale(polygon->outer);
      for (Ring& hole : polygon->holes) scale(hole);
    }
  }
  out.start = factor * f.start;
  out.goal = factor * f.goal;
  return out;
}

// Tolerances in metres made routes of small maps fail, and of large ones long.
TEST(RouteScales, AMapOfAnySizeGivesTheSameRoutes) {
  SeededRandom random(test::seed_of_run(3));
  for (int k = 0; k < 40; ++k) {
    const RouteField f =
        route_field(random, test::kFieldKinds[static_cast<std::size_t>(k) % std::size(test::kFieldKinds)]);
    const double radius = random.uniform(0.05, 0.6);
    const RouteAnswer answer = asked(f.obstacles, radius, f.start, f.goal);
    for (const double factor : {0x1p66, 0x1p-66}) {  // 7e19 and 1e-20
      const RouteField g = scaled(f, factor);
      const RouteAnswer other = asked(g.obstacles, factor * radius, g.start, g.goal);
      ASSERT_EQ(other.index(), answer.index());
      const auto *one = std::get_if<Route>(&answer), *two = std::get_if<Route>(&other);
      if (one) {
        EXPECT_EQ(two->length, factor * one->length) << test::corpus_line(test::RouteCase{f, radius});
        EXPECT_EQ(two->points.size(), one->points.size());
      }
    }
  }
}

TEST(RouteScales, FarFromTheOriginEveryAnswerIsProven) {
  SeededRandom random(test::seed_of_run(4));
  for (int k = 0; k < 30; ++k) {
    RouteField f = route_field(random, test::kFieldKinds[static_cast<std::size_t>(k) % std::size(test::kFieldKinds)]);
    const Vec2 away{4.5e5, 5.2e6};
    for (Obstacle& o : f.obstacles) {
      if (auto* wall = std::get_if<Polyline>(&o))
        for (Vec2& p : wall->points) p += away;
      if (auto* polygon = std::get_if<Polygon>(&o))
        for (Vec2& p : polygon->outer) p += away;
    }
    asked(f.obstacles, random.uniform(0.05, 0.6), f.start + away, f.goal + away);
  }
}

// A line from far away is off by more than a cell of the grid in which the obstacles beside it were looked up.
TEST(RouteScales, RoutesFromFarAwayMeetNoObstacleUnseen) {
  SeededRandom random(test::seed_of_run(6));
  RouteMapOptions options;
  options.largest_distance = 1e13;
  for (int k = 0; k < 10; ++k) {
    std::vector<Obstacle> obstacles;
    for (int j = 0; j < 100; ++j) {
      const Vec2 a{random.uniform(-1, 1), random.uniform(-1, 1)};
      obstacles.push_back(Polyline{{a, a + 0.02 * random.direction()}});
    }
    const RouteMap map(obstacles, options);
    const double radius = 0.01;
    const RoutePlan plan(map, radius);
    for (int j = 0; j < 10; ++j) {
      const Vec2 start = 1e12 * random.direction(), goal = random.in_box(1.5);
      const RouteAnswer answer = plan.query(start, goal);
      EXPECT_EQ(check(obstacles, {radius, start, goal}, answer), "")
          << test::corpus_line(test::RouteCase{{obstacles, start, goal}, radius});
    }
  }
}

// For an end in contact with several sites only the first four pieces were looked at, and all were of one wall.
TEST(Routes, AnEndInContactWithManySitesLeavesAlongTheOneThatLetsIt) {
  // The disc of radius 5 round (0, 0) touches a long wall behind it and a vertex on either side.
  std::vector<Obstacle> obstacles{Polyline{{{3 - 40, -4 - 30}, {3 + 40, -4 + 30}}}, Polyline{{{-4, -3}, {-8, -6}}},
                                  Polyline{{{4, 3}, {8, 6}}}};
  for (int k = 0; k < 400; ++k) obstacles.push_back(Polyline{{{-40.0 + 0.2 * k, 60}, {-40.0 + 0.2 * k, 61}}});
  const RouteAnswer answer = asked(obstacles, 5.0, {0, 0}, {-17, 31});
  EXPECT_TRUE(std::holds_alternative<Route>(answer));
}

// Beside a wall that ends in open space the points to leave it at doubled from the start, so that the route overshot.
TEST(Routes, AnEndInContactLeavesTheWallWhereItEnds) {
  const auto expect_short = [](const std::vector<Obstacle>& walls, double radius, Vec2 start, Vec2 goal) {
    for (const RouteAnswer& answer : {asked(walls, radius, start, goal), asked(walls, radius, goal, start)}) {
      const auto* route = std::get_if<Route>(&answer);
      ASSERT_NE(route, nullptr);
      EXPECT_LE(route->length, 1.05 * route->lower_bound);
    }
  };
  expect_short({Polyline{{{-4, -8}, {-4, 3}}}, Polyline{{{-4, 4}, {-4, 8}}}}, 0.2, {-4.2, -2.800978000983318},
               {-3.8, -6.097638863922139});
  expect_short({Polyline{{{-5, -8}, {-5, -1}}}, Polyline{{{-5, -0.5}, {-5, 8}}}}, 1e-9,
               {-5.000000001, -0.3491071895813336}, {-4.999999999, 0.9166390616227158});
}

// The distance to a crossing of walls may round to 0: the widest radius was looked for from there without end.
TEST(Routes, TheWidestRadiusOfAStartBesideACrossingIsFound) {
  const std::vector<Obstacle> crossing{Polyline{{{0, 0}, {3, 1}}}, Polyline{{{0, 1}, {3, 0}}},
                                       Polyline{{{1, 0}, {2, 1}}}};
  for (const double x : {1.5, std::nextafter(1.5, 2.0), std::nextafter(1.5, 1.0)})
    for (const double y : {0.5, std::nextafter(0.5, 1.0), std::nextafter(0.5, 0.0)})
      EXPECT_LT(RouteMap(crossing).widest_radius({x, y}, {9, 9}), 1e-15);
  // 1/3 + 2^-54 or so from the walls' crossing at (1, 1/3), which is no double.
  const std::vector<Obstacle> thirds{Polyline{{{0, 0}, {3, 1}}}, Polyline{{{1, 0}, {1, 1}}}};
  EXPECT_LT(RouteMap(thirds).widest_radius({1.0, 1.0 / 3.0}, {9, 9}), 1e-15);
}

// --- Cells of points ---

// Cells of points are joined across sides of triangles; what a view passes through them must stay inside. Rooms whose
// walls lie on one line are where a piece from portal to portal could run along a wall.
TEST(Routes, PointsPassRowsOfDoorsOnOneLine) {
  std::vector<Obstacle> rooms{test::fence({{0, 0}, {12, 0}, {12, 8}, {0, 8}})};
  for (int k = 0; k < 6; ++k) rooms.push_back(Polyline{{{2.0 * k, 4}, {2.0 * k + 1, 4}}});
  for (int k = 1; k < 6; ++k) rooms.push_back(Polyline{{{2.0 * k, 0.5}, {2.0 * k, 7.5}}});
  SeededRandom random(test::seed_of_run(61));
  std::size_t routes = 0;
  const RoutePlan point(RouteMap(rooms), 0.0), disc(RouteMap(rooms), 1e-7);
  for (int k = 0; k < 300; ++k) {
    const Vec2 start{random.uniform(0.1, 11.9), random.uniform(0.1, 7.9)};
    const Vec2 goal{random.uniform(0.1, 11.9), random.uniform(0.1, 7.9)};
    const RouteAnswer answer = point.query(start, goal);
    EXPECT_EQ(check(rooms, {0.0, start, goal}, answer), "") << test::corpus_line({{rooms, start, goal}, 0.0});
    const auto* route = std::get_if<Route>(&answer);
    const RouteAnswer other = disc.query(start, goal);
    const auto* wider = std::get_if<Route>(&other);
    if (route == nullptr || wider == nullptr) continue;
    ++routes;
    EXPECT_LE(route->length, wider->length * (1.0 + 1e-9)) << test::corpus_line({{rooms, start, goal}, 0.0});
    EXPECT_GE(route->length, wider->length * (1.0 - 1e-5)) << test::corpus_line({{rooms, start, goal}, 0.0});
  }
  EXPECT_GT(routes, 250u);
}

// --- The corpus ---

TEST(RouteCorpus, EveryCaseIsAnsweredWithProof) {
  const std::vector<test::CorpusCase> cases = test::read_corpus("geometry/routes.txt");
  ASSERT_FALSE(cases.empty());
  for (const test::CorpusCase& c : cases) {
    const test::RouteCase one = test::route_case_of(c);
    const RouteAnswer answer = asked(one.field.obstacles, one.radius, one.field.start, one.field.goal);
    if (const auto* route = std::get_if<Route>(&answer)) {
      EXPECT_LT(route->length, 1.2 * route->lower_bound) << test::corpus_line(one);
    }
  }
}

// Property (1): no detour to cross the gate in which the route begins.
TEST(RoutePlan, ARouteFromTheMiddleOfATightGateGoesStraightOn) {
  const std::vector<Obstacle> gate{Polyline{{{0, 0}, {24, 0}, {24, 24}, {0, 24}, {0, 0}}},
                                   Polyline{{{20, 9}, {22, 9}}}};
  for (const Vec2 goal : {Vec2{23, 12}, Vec2{23, 5}}) {
    const RouteAnswer answer = asked(gate, 1.0, {23, 9}, goal);
    ASSERT_TRUE(std::holds_alternative<Route>(answer));
    EXPECT_EQ(check(gate, {1.0, {23, 9}, goal}, answer), "");
    EXPECT_DOUBLE_EQ(std::get<Route>(answer).length, std::fabs(goal.y - 9.0));
  }
}

TEST(RouteCorpus, ALineReadsBackWithItsHoles) {
  const test::RouteCase one{
      {{Polygon{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{{3, 3}, {3, 6}, {6, 6}}}}, Polyline{{{0, 0.1}, {1, 2}}}},
       {0.1, 0.2},
       {-3, 4}},
      0.3};
  const std::string line = test::corpus_line(one);
  const std::vector<test::CorpusCase> cases = test::parse_corpus(line, "text");
  ASSERT_EQ(cases.size(), 1u);
  const test::RouteCase back = test::route_case_of(cases[0]);
  EXPECT_EQ(test::corpus_line(back), line);
  ASSERT_EQ(back.field.obstacles.size(), 2u);
  EXPECT_EQ(std::get<Polygon>(back.field.obstacles[0]).holes.size(), 1u);
  test::CorpusCase cut = cases[0];
  cut.numbers.pop_back();
  EXPECT_THROW(test::route_case_of(cut), std::runtime_error);
  cut = cases[0];
  cut.numbers.push_back(1.0);
  EXPECT_THROW(test::route_case_of(cut), std::runtime_error);
}

// --- The checker ---

// Property (3): an answer that was tampered with is refused.
TEST(RouteCertificate, Property3_TamperedRoutesAreRefused) {
  SeededRandom random(test::seed_of_run(5));
  std::size_t tampered = 0;
  for (int k = 0; k < 40; ++k) {
    const RouteField f =
        route_field(random, test::kFieldKinds[static_cast<std::size_t>(k) % std::size(test::kFieldKinds)]);
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
    ExactPoint& fraction =
        *std::find_if(route->points.begin(), route->points.end() - 1, [](const ExactPoint& p) { return !p.x.empty(); });
    fraction.rounded.x += fraction.x.empty() ? 0.0 : std::max(1e-9, 1e-9 * std::fabs(fraction.rounded.x));
    if (!fraction.x.empty()) refused();
    route->length *= 1.0 + 1e-9;
    refused();
    route->lower_bound = 1.001 * route->length;
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
