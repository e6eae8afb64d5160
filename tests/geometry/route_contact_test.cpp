// SPDX-License-Identifier: GPL-3.0-or-later
// Ends of routes in contact with obstacles: contact is clear, for a point and for a disc.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cell_world.h"
#include "exactvo/geometry/route_certificate.h"
#include "exactvo/geometry/routes.h"
#include "route_case.h"
#include "route_fields.h"
#include "route_verdict.h"
#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

Polygon box_of(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

/// The answer, which both checkers accept.
RouteAnswer proven(const std::vector<Obstacle>& obstacles, double radius, Vec2 start, Vec2 goal) {
  const RoutePlan plan(RouteMap(obstacles), radius);
  RouteAnswer answer = plan.query(start, goal);
  const RouteQuestion question{radius, start, goal};
  EXPECT_EQ(check(obstacles, question, answer), "") << to_string({start, goal});
  EXPECT_EQ(test::verdict_on(obstacles, question, answer), test::RouteVerdict::proven) << to_string({start, goal});
  EXPECT_EQ(plan.is_reachable(start, goal), std::holds_alternative<Route>(answer)) << to_string({start, goal});
  return answer;
}

void expect_length(const std::vector<Obstacle>& obstacles, double radius, Vec2 start, Vec2 goal, double length) {
  for (const auto& [from, to] : {std::pair{start, goal}, std::pair{goal, start}}) {
    const RouteAnswer answer = proven(obstacles, radius, from, to);
    const auto* route = std::get_if<Route>(&answer);
    ASSERT_NE(route, nullptr) << to_string({from, to});
    EXPECT_NEAR(route->length, length, 1e-9 * length) << to_string({from, to});
    EXPECT_NEAR(route->lower_bound, length, 1e-9 * length) << to_string({from, to});
    EXPECT_GE(route->length, route->lower_bound);
  }
}

// --- Points ---

// A point on an edge or corner was said to be blocked.
TEST(RouteContact, PointsStartAndEndOnEdgesCornersAndWalls) {
  const std::vector<Obstacle> two{box_of(0, 0, 2, 2), Polyline{{{5, 0}, {5, 2}, {7, 2}}}};
  expect_length(two, 0.0, {2, 1}, {4, 1}, 2.0);      // an edge
  expect_length(two, 0.0, {2, 2}, {4, 2}, 2.0);      // a corner
  expect_length(two, 0.0, {2, 1}, {5, 1}, 3.0);      // both, and a wall from its left
  expect_length(two, 0.0, {5, 1}, {6, 1}, 1.0);      // from its right
  expect_length(two, 0.0, {5, 0}, {9, 0}, 4.0);      // its end
  expect_length(two, 0.0, {5, 2}, {2, 2}, 3.0);      // its bend
  expect_length(two, 0.0, {2, 0.5}, {2, 1.5}, 1.0);  // along one edge
  expect_length(two, 0.0, {0, 0}, {2, 0}, 2.0);      // from corner to corner of it
  expect_length(two, 0.0, {1, 0}, {2, 1}, 2.0);      // round a corner
  expect_length(two, 0.0, {0, 1}, {2, 1}, 4.0);      // round two
  expect_length(two, 0.0, {0, 0}, {2, 2}, 4.0);      // and between the ends of a diagonal
}

TEST(RouteContact, APointInContactThatStaysHasARouteOfOnePoint) {
  const std::vector<Obstacle> obstacles{box_of(0, 0, 2, 2), Polyline{{{5, 0}, {5, 2}}}, Polyline{{{9, 9}, {9, 9}}}};
  for (const Vec2 x : {Vec2{2, 1}, Vec2{2, 2}, Vec2{5, 1}, Vec2{5, 2}, Vec2{9, 9}}) {
    const RouteAnswer answer = proven(obstacles, 0.0, x, x);
    ASSERT_TRUE(std::holds_alternative<Route>(answer)) << to_string({x});
    EXPECT_EQ(std::get<Route>(answer).points.size(), 1u);
  }
  for (const Vec2 x : {Vec2{1, 1}, Vec2{0.001, 1.999}}) {
    EXPECT_TRUE(std::holds_alternative<Blocked>(proven(obstacles, 0.0, x, x))) << to_string({x});
  }
}

TEST(RouteContact, WhereTwoObstaclesTouchAPointLeavesIntoEachPart) {
  // Two boxes touch in (2, 2); a fence round both leaves one part beside them on either side.
  const std::vector<Obstacle> pinch{box_of(0, 0, 2, 2), box_of(2, 2, 4, 4),
                                    Polyline{{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}}}};
  expect_length(pinch, 0.0, {2, 2}, {1, 3}, std::sqrt(2.0));
  expect_length(pinch, 0.0, {2, 2}, {3, 1}, std::sqrt(2.0));
  EXPECT_TRUE(std::holds_alternative<Separated>(proven(pinch, 0.0, {1, 3}, {3, 1}))) << "nothing passes through";
  EXPECT_TRUE(std::holds_alternative<Separated>(proven(pinch, 0.0, {0, 3}, {3, 2})));
  EXPECT_TRUE(std::holds_alternative<Separated>(proven(pinch, 0.0, {2, 2}, {9, 9})));
  EXPECT_TRUE(std::holds_alternative<Separated>(proven(pinch, 0.0, {9, 9}, {2, 2})));
}

TEST(RouteContact, APointOnAnEdgeThatTwoPolygonsShareIsBlocked) {
  const std::vector<Obstacle> row{box_of(0, 0, 2, 2), box_of(2, 0, 4, 2), box_of(0, 2, 2, 4), box_of(2, 2, 4, 4)};
  for (const Vec2 x : {Vec2{2, 1}, Vec2{2, 2}, Vec2{1, 2}}) {
    const RouteAnswer answer = proven(row, 0.0, x, {9, 9});
    ASSERT_TRUE(std::holds_alternative<Blocked>(answer)) << to_string({x});
    EXPECT_FALSE(std::get<Blocked>(answer).inside) << "on the edges of both";
  }
  expect_length(row, 0.0, {2, 0}, {2, -3}, 3.0);  // where the shared edge ends
  const RouteAnswer deep = proven({box_of(0, 0, 2, 2), box_of(-1, -1, 3, 3)}, 0.0, {2, 1}, {9, 9});
  ASSERT_TRUE(std::holds_alternative<Blocked>(deep));
  EXPECT_TRUE(std::get<Blocked>(deep).inside);
  EXPECT_EQ(std::get<Blocked>(deep).by.obstacle, 1u);
}

TEST(RouteContact, AnEndOnTheInsideOfARoomStaysEnclosed) {
  Polygon ring = box_of(0, 0, 6, 6);
  ring.holes = {{{1, 1}, {1, 5}, {5, 5}, {5, 1}}};
  const Polyline thin{{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}}};
  for (const Vec2 inside : {Vec2{1, 3}, Vec2{1, 1}, Vec2{5, 5}, Vec2{3, 5}}) {
    for (const Vec2 outside : {Vec2{9, 3}, Vec2{6, 3}, Vec2{6, 6}, Vec2{0, 0}}) {
      EXPECT_TRUE(std::holds_alternative<Separated>(proven({ring}, 0.0, inside, outside)));
      EXPECT_TRUE(std::holds_alternative<Separated>(proven({ring}, 0.0, outside, inside)));
    }
  }
  // A thin wall has two sides, and a point on it belongs to both.
  expect_length({thin}, 0.0, {6, 3}, {3, 3}, 3.0);
  expect_length({thin}, 0.0, {6, 3}, {9, 3}, 3.0);
  EXPECT_TRUE(std::holds_alternative<Separated>(proven({thin}, 0.0, {3, 3}, {9, 3})));
}

// A star of walls: an end at its middle is a point of all the rooms between them.
TEST(RouteContact, TheHubOfAWheelIsInEveryRoomOfIt) {
  std::vector<Obstacle> wheel;
  Polyline rim;
  constexpr int kSpokes = 8;
  const Vec2 at[kSpokes] = {{4, 0}, {3, 3}, {0, 4}, {-3, 3}, {-4, 0}, {-3, -3}, {0, -4}, {3, -3}};
  for (const Vec2 p : at) {
    wheel.push_back(Polyline{{{0, 0}, p}});
    rim.points.push_back(p);
  }
  rim.points.push_back(at[0]);
  wheel.push_back(rim);
  for (int k = 0; k < kSpokes; ++k) {
    const Vec2 room = 0.4 * (at[k] + at[(k + 1) % kSpokes]);
    expect_length(wheel, 0.0, {0, 0}, room, norm(room));
    EXPECT_TRUE(std::holds_alternative<Separated>(proven(wheel, 0.0, {0, 0}, 3.0 * room)));
    EXPECT_TRUE(std::holds_alternative<Separated>(proven(wheel, 0.0, 0.5 * at[k], 3.0 * room)));
    expect_length(wheel, 0.0, at[k], 3.0 * room, norm(3.0 * room - at[k]));
  }
}

TEST(RouteContact, PointsOnBordersOfCellsHaveTheShortestRoutes) {
  SeededRandom random(test::seed_of_run(5));
  std::size_t routes = 0, chains = 0, blocked = 0, pinches = 0, touching = 0;
  for (int k = 0; k < 400; ++k) {
    test::CellWorld world(random, random.integer(2, 9), random.uniform(0.15, 0.6));
    world.put_ends_on_cells_borders(random);
    using Contact = test::CellWorld::Contact;
    const Contact contacts[] = {world.contact_of_start(), world.contact_of_goal()};
    const RouteAnswer answer = proven(world.obstacles(), 0.0, world.start(), world.goal());
    const std::string text = to_string({world.start(), world.goal()});
    bool is_blocked = false;
    for (const Contact c : contacts) {
      is_blocked = is_blocked || c == Contact::blocked_on_every_side;
      pinches += c == Contact::pinch;
      touching += c == Contact::a_side_or_corner;
    }
    ASSERT_EQ(is_blocked, std::holds_alternative<Blocked>(answer)) << text;
    blocked += is_blocked;
    if (is_blocked) continue;
    const double shortest = world.start() == world.goal() ? 0.0 : world.shortest();
    ASSERT_EQ(std::isinf(shortest), std::holds_alternative<Separated>(answer)) << text;
    chains += std::isinf(shortest);
    if (std::isinf(shortest)) continue;
    ++routes;
    EXPECT_NEAR(std::get<Route>(answer).length, shortest, 1e-9 * shortest) << text;
    EXPECT_NEAR(std::get<Route>(answer).lower_bound, shortest, 1e-12 * shortest) << text;
  }
  EXPECT_GE(routes, 120u);
  EXPECT_GE(chains, 40u);
  EXPECT_GE(blocked, 20u);
  EXPECT_GE(pinches, 10u);
  EXPECT_GE(touching, 250u);
}

// Walls and polygons that overlap and cross, turned mazes, lattices: ends are vertices of them, or middles of edges as
// far as doubles have these.
TEST(RouteContact, EndsOnObstaclesOfEveryKindAreProven) {
  SeededRandom random(test::seed_of_run(27));
  std::size_t counts[3] = {}, touching = 0;
  for (int k = 0; k < 240; ++k) {
    const test::FieldKind kind = test::kFieldKinds[static_cast<std::size_t>(k) % std::size(test::kFieldKinds)];
    const test::RouteField f = test::route_field(random, kind);
    // Gaps of 1e-12 m between corners that almost coincide leave a point no room to go near the shortest curve.
    const double longer = 1e-9;
    const RoutePlan plan(RouteMap(f.obstacles), 0.0);
    const auto place_on = [&] {
      const std::vector<Segment> edges =
          edges_of(f.obstacles[static_cast<std::size_t>(random.integer(0, static_cast<int>(f.obstacles.size()) - 1))]);
      const Segment e = edges[static_cast<std::size_t>(random.integer(0, static_cast<int>(edges.size()) - 1))];
      return random.integer(0, 2) == 0 ? 0.5 * (e.a + e.b) : e.a;
    };
    for (int end = 0; end < 4; ++end) {
      const RouteQuestion question{0.0, place_on(), end % 2 == 0 ? f.goal : place_on()};
      const RouteAnswer answer = plan.query(question.start, question.goal);
      const std::string text =
          test::corpus_line(test::RouteCase{{f.obstacles, question.start, question.goal}, question.radius});
      EXPECT_EQ(check(f.obstacles, question, answer), "") << text;
      EXPECT_EQ(test::verdict_on(f.obstacles, question, answer), test::RouteVerdict::proven) << text;
      EXPECT_EQ(plan.query(question.goal, question.start).index(), answer.index()) << text;
      ++counts[answer.index()];
      if (const auto* route = std::get_if<Route>(&answer)) {
        EXPECT_LE(route->length, route->lower_bound * (1.0 + longer)) << text;
        touching += check(f.obstacles, {1e-300, question.start, question.start},
                          Route{{{question.start, {}, {}}}, 0.0, 0.0}) != "";
      }
    }
  }
  EXPECT_GE(counts[0], 300u);
  EXPECT_GE(counts[1], 8u);
  EXPECT_GE(counts[2], 60u);
  EXPECT_GE(touching, 200u);
}

TEST(RouteContact, AnyScaleAndPlaceGivesTheSameRoutes) {
  std::size_t judged = 0;
  for (const double scale : {1.0, 1e-3, 1e3, 0x1p-60, 0x1p60}) {
    for (const Vec2 shift : {Vec2{0, 0}, Vec2{1e6, -1e6}}) {
      const auto at = [&](double x, double y) { return scale * Vec2{x + shift.x, y + shift.y}; };
      const std::vector<Obstacle> boxes{Polygon{{at(0, 0), at(2, 0), at(2, 2), at(0, 2)}, {}},
                                        Polygon{{at(2, 2), at(4, 2), at(4, 4), at(2, 4)}, {}}};
      expect_length(boxes, 0.0, at(2, 2), at(4, 2), norm(at(4, 2) - at(2, 2)));
      expect_length(boxes, 0.0, at(2, 0), at(4, 4), norm(at(4, 2) - at(2, 0)) + norm(at(4, 4) - at(4, 2)));
      judged += 4;
    }
  }
  EXPECT_EQ(judged, 40u);
}

// --- Discs ---

TEST(RouteContact, ADiscInExactContactStartsAndArrives) {
  const std::vector<Obstacle> obstacles{box_of(0, 0, 8, 8), Polyline{{{24, 0}, {24, 8}}}};
  // At an edge, a corner (3-4-5), a wall and its end; from and to both in contact, and from == to.
  const Vec2 contacts[] = {{13, 4}, {11, 12}, {19, 4}, {27, 12}, {4, -5}};
  std::size_t judged = 0;
  for (const Vec2 from : contacts) {
    for (const Vec2 to : contacts) {
      EXPECT_TRUE(std::holds_alternative<Route>(proven(obstacles, 5.0, from, to))) << to_string({from, to});
      ++judged;
    }
  }
  EXPECT_EQ(judged, 25u);
  EXPECT_TRUE(std::holds_alternative<Blocked>(proven(obstacles, std::nextafter(5.0, 6.0), {13, 4}, {15, 15})));
}

// --- Certificates ---

// Such an edge was passed over, or ended the program, as there is no rational for it.
TEST(RouteContact, ACheckRefusesObstaclesThatAreNotFinite) {
  const RouteQuestion question{0.1, {0, 0}, {1, 0}};
  const RouteAnswer route = Route{{{{0, 0}, {}, {}}, {{1, 0}, {}, {}}}, 1.0, 0.0};
  EXPECT_EQ(check({Polyline{{{0, 1}, {1, 1}}}}, question, route), "");
  for (const double bad : {std::nan(""), HUGE_VAL})
    EXPECT_THROW(check({Polyline{{{0, 1}, {bad, 1}}}}, question, route), std::logic_error);
}

TEST(RouteContact, CertificatesThatTouchMoreThanTheirEndsAreRefused) {
  const std::vector<Obstacle> two{box_of(0, 0, 2, 2), box_of(2, 2, 4, 4)};
  const auto route = [](std::vector<Vec2> points) {
    Route made;
    for (const Vec2 p : points) made.points.push_back({p, {}, {}});
    for (std::size_t k = 1; k < points.size(); ++k) made.length += norm(points[k] - points[k - 1]);
    return made;
  };
  const auto is_proven = [&](Vec2 start, Vec2 goal, const RouteAnswer& answer) {
    const RouteQuestion question{0.0, start, goal};
    const bool accepted = check(two, question, answer).empty();
    EXPECT_EQ(accepted, test::verdict_on(two, question, answer) == test::RouteVerdict::proven);
    return accepted;
  };
  EXPECT_TRUE(is_proven({2, 1}, {4, 1}, route({{2, 1}, {4, 1}})));
  EXPECT_TRUE(is_proven({2, 1}, {3, 2}, route({{2, 1}, {3, 2}})));
  EXPECT_FALSE(is_proven({2, 0}, {2, 1}, route({{2, 0}, {2, 1}}))) << "along the edge";
  EXPECT_FALSE(is_proven({2, 1}, {4, 2}, route({{2, 1}, {3, 2}, {4, 2}}))) << "touches between";
  EXPECT_FALSE(is_proven({0, 1}, {2, 1}, route({{0, 1}, {2, 1}}))) << "through the box";
  EXPECT_FALSE(is_proven({0, 1}, {1, 1}, route({{0, 1}, {1, 1}}))) << "into the box";
  EXPECT_FALSE(is_proven({1, 3}, {3, 1}, route({{1, 3}, {2, 2}, {3, 1}}))) << "between two that touch";
  EXPECT_FALSE(is_proven({1, 3}, {3, 1}, route({{1, 3}, {3, 1}})));
  EXPECT_FALSE(is_proven({2, 1}, {9, 9}, Blocked{Blocked::End::start, false, {0, 1}})) << "free on one side";
  EXPECT_FALSE(is_proven({2, 1}, {9, 9}, Blocked{Blocked::End::start, true, {0, 0}})) << "on the border";
  EXPECT_TRUE(is_proven({1, 1}, {9, 9}, Blocked{Blocked::End::start, true, {0, 0}}));
  // The ring of the first box, round nothing: it passes through its own corner.
  Separated ring;
  for (const auto& [p, edge] : {std::pair{Vec2{0, 0}, 0}, {Vec2{2, 0}, 1}, {Vec2{2, 2}, 2}, {Vec2{0, 2}, 3}})
    ring.chain.push_back({{p, {}, {}}, {0, static_cast<std::size_t>(edge)}, false});
  EXPECT_FALSE(is_proven({2, 1}, {9, 9}, ring));
  EXPECT_FALSE(is_proven({1, 1}, {9, 9}, ring)) << "an end inside";
}

}  // namespace
}  // namespace exactvo::geometry
