// SPDX-License-Identifier: GPL-3.0-or-later
// Routes round curves of many vertices, and past vertices that lie almost in one point: lengths against what is known
// of them, and the work of a search against the number of vertices.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/route_certificate.h"
#include "exactvo/geometry/routes.h"
#include "route_fields.h"
#include "routes/links.h"
#include "routes/planar_graph.h"
#include "routes/realise.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

std::vector<Vec2> circle(double radius, int vertices) {
  std::vector<Vec2> out;
  for (int k = 0; k < vertices; ++k) {
    const double angle = 2.0 * kPi * k / vertices;
    out.push_back(radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return out;
}

/// The shortest curve round a circle, from one point to the opposite one at the same distance from its centre.
double length_round(double radius, double distance) {
  return 2.0 * std::sqrt(distance * distance - radius * radius) + radius * (kPi - 2.0 * std::acos(radius / distance));
}

/// The checker holds every piece against every edge: of the largest maps that would take a minute.
Route route_of(const std::vector<Obstacle>& obstacles, double radius, Vec2 start, Vec2 goal, bool checked = true) {
  RouteAnswer answer = RoutePlan(RouteMap(obstacles), radius).query(start, goal);
  if (checked) {
    EXPECT_EQ(check(obstacles, {radius, start, goal}, answer), "");
  }
  auto* route = std::get_if<Route>(&answer);
  if (route == nullptr) throw std::runtime_error("no route");
  return *route;
}

/// A search alone, in a square that is large enough.
class Searched {
 public:
  Searched(const std::vector<Obstacle>& obstacles, double half, double radius)
      : Searched(routing::CellMap(routing::planar_graph(obstacles), Square(half).corners), radius) {}
  Searched(routing::CellMap cells, double radius)
      : cells_(std::move(cells)), grid_(cells_), plan_(cells_, grid_, radius) {}

  std::optional<routing::Way> find(Vec2 s, Vec2 t, std::size_t most = routing::WaySearch::kMostNodes) {
    routing::WaySearch search(plan_, most);
    std::optional<routing::Way> way = search.find(s, {cell_of(s)}, t, {cell_of(t)});
    steps = search.steps();
    was_second = search.was_second_search();
    return way;
  }
  double length_of(const routing::Way& way, Vec2 s, Vec2 t) const {
    const auto points = routing::realised(plan_, s, t, way);
    if (!points) return 0.0;
    double length = 0.0;
    for (std::size_t k = 1; k < points->size(); ++k)
      length += norm((*points)[k].rounded() - (*points)[k - 1].rounded());
    return length;
  }
  std::size_t steps = 0;
  bool was_second = false;

 private:
  struct Square {
    Vec2 corners[4];
    explicit Square(double h) : corners{{-h, -h}, {h, -h}, {h, h}, {-h, h}} {}
  };
  int cell_of(Vec2 x) const {
    for (std::size_t f = 0; f < cells_.triangles.size(); ++f) {
      const int triangle = static_cast<int>(f);
      if (cells_.triangles[f].free && cells_.triangle_holds(triangle, x)) return cells_.cell_in(triangle, x);
    }
    throw std::runtime_error("no free triangle");
  }

  routing::CellMap cells_;
  routing::PieceTree grid_;
  routing::ClearancePlan plan_;
};

// The search was quadratic, was given up, and a route thirty times too long came out.
TEST(RouteCurves, TheWayRoundACircleOfManyVerticesIsItsLength) {
  constexpr double kCircle = 100.0, kAway = 200.0;  // m
  for (const int n : {500, 1000, 1500, 4000, 20000}) {
    for (const double radius : {0.5, 2.0, 5.0}) {
      const Route route = route_of({Polygon{circle(kCircle, n), {}}}, radius, {-kAway, 0}, {kAway, 0}, n <= 1000);
      const double least = length_round(kCircle * std::cos(kPi / n) + radius, kAway);
      const double most = length_round(kCircle + radius, kAway);
      EXPECT_GE(route.length, least * (1.0 - 1e-9)) << n << " " << radius;
      EXPECT_LE(route.length, most * 1.0001) << n << " " << radius;
      EXPECT_LE(route.lower_bound, most) << n << " " << radius;
      EXPECT_GE(route.lower_bound, 0.995 * most) << n << " " << radius;
    }
  }
}

TEST(RouteCurves, ASearchRoundACircleTakesALittleMoreThanLinearlyManySteps) {
  for (const int n : {500, 2000, 8000}) {
    Searched searched({Polygon{circle(100.0, n), {}}}, 6000.0, 2.0);
    ASSERT_TRUE(searched.find({-200, 1}, {200, 1})) << n;
    EXPECT_FALSE(searched.was_second) << n;
    EXPECT_LT(searched.steps, static_cast<std::size_t>(20 * n)) << n;  // 6 to 9 of each vertex
  }
}

// A corridor that is closed at both ends, with half a circle standing in it: all its cells are dead ends.
TEST(RouteCurves, ABulgeInACorridorIsPassedAlongItsTangents) {
  constexpr double kBulge = 5.0, kEnd = 18.0;
  for (const int n : {500, 2000}) {
    std::vector<Vec2> wall{{-20, 0}};
    for (int k = 0; k <= n; ++k) wall.push_back(kBulge * Vec2{-std::cos(kPi * k / n), std::sin(kPi * k / n)});
    for (const Vec2 p : {Vec2{20, 0}, Vec2{20, 8}, Vec2{-20, 8}}) wall.push_back(p);
    const std::vector<Obstacle> corridor{test::fence(wall)};
    constexpr double kRadius = 0.5, kHeight = 1.5;
    const Route route = route_of(corridor, kRadius, {-kEnd, kHeight}, {kEnd, kHeight}, n <= 500);
    const double distance = std::hypot(kEnd, kHeight), around = kBulge + kRadius;
    const double most = length_round(around, distance) - 2.0 * around * std::atan2(kHeight, kEnd);
    EXPECT_GE(route.length, most * (1.0 - 1e-5)) << n;
    EXPECT_LE(route.length, most * 1.0001) << n;
  }
}

// --- Two curves that face each other ---

std::vector<Obstacle> ring_road(double outer, int vertices) {
  return {Polygon{circle(100.0, vertices), {}}, test::fence(circle(outer, vertices))};
}

constexpr Vec2 kSquare[4] = {{-6000, -6000}, {6000, -6000}, {6000, 6000}, {-6000, 6000}};

// A vertex of one curve sees as many sides of triangles as the other has, and no wall behind them: maps took quadratic
// time, and walls were cut at fractions in vain.
// Each view crossed a link of every vertex: 1.3 s for 3000 vertices each.
TEST(RouteCurves, ASearchBetweenTwoCirclesTakesALittleMoreThanLinearlyManySteps) {
  constexpr double kRadius = 0.5;
  const Vec2 start{-150, 1}, goal{150, -1};
  for (const std::size_t n : {500, 2000}) {
    const routing::CellMap whole(routing::planar_graph(ring_road(200.0, static_cast<int>(n))), kSquare);
    const std::vector<int> needed = whole.needed_links(kRadius);
    EXPECT_LT(needed.size(), whole.links.size() / 10);
    Searched searched(routing::CellMap(whole, needed), kRadius);
    const std::optional<routing::Way> way = searched.find(start, goal);
    ASSERT_TRUE(way) << n;
    EXPECT_FALSE(searched.was_second) << n;
    EXPECT_LT(searched.steps, 40 * n) << n;  // 7 to 12 of each
    if (n > 500) continue;
    Searched with_all(whole, kRadius);
    const std::optional<routing::Way> other = with_all.find(start, goal);
    ASSERT_TRUE(other);
    EXPECT_LE(way->lower_bound, other->lower_bound * (1.0 + 1e-9));
    EXPECT_GE(way->lower_bound, other->lower_bound * (1.0 - 1e-6));
  }
}

TEST(RouteCurves, LinksBetweenTwoCirclesTakeALittleMoreThanLinearlyManySteps) {
  for (const double outer : {110.0, 200.0, 1000.0}) {
    for (const std::size_t n : {500, 2000}) {
      const routing::CellMap map(routing::planar_graph(ring_road(outer, static_cast<int>(n))), kSquare);
      EXPECT_EQ(map.graph.vertices.size(), 2 * n) << outer;  // no wall was cut
      const routing::LinkBounds bounds{200 * n, 10 * n};     // 119 n and 3 n for 1000 vertices each
      EXPECT_TRUE(routing::gabriel_links(map, bounds, routing::LinksFrom::walls)) << outer << " " << n;
    }
  }
}

TEST(RouteLinks, AreTheSameFromVerticesAsFromWalls) {
  SeededRandom random(test::seed_of_run(12));
  for (int k = 0; k < 60; ++k) {
    const test::RouteField f =
        test::route_field(random, test::kFieldKinds[static_cast<std::size_t>(k) % std::size(test::kFieldKinds)]);
    const routing::CellMap map(routing::planar_graph(f.obstacles), kSquare);
    const auto found = [&](routing::LinksFrom from) {
      std::vector<std::tuple<int, int, int, int, std::vector<std::pair<int, int>>>> out;
      const std::optional<std::vector<routing::Link>> links = routing::gabriel_links(map, {}, from);
      for (const routing::Link& link : *links) {
        std::vector<std::pair<int, int>> exits;
        for (const routing::Link::Exit& e : link.exits) exits.emplace_back(e.triangle, e.side);
        out.emplace_back(link.vertex, link.wall, link.a, link.b, exits);
      }
      std::sort(out.begin(), out.end());
      return out;
    };
    EXPECT_EQ(found(routing::LinksFrom::vertices), found(routing::LinksFrom::walls)) << k;
  }
}

// --- What lies far away ---

// Beside one wall far away all others lay in one cell of a grid, and each question looked at all of them.
TEST(RoutePieces, NearAPlaceAreFewWhereverTheOthersLie) {
  SeededRandom random(test::seed_of_run(13));
  std::vector<Obstacle> obstacles;
  for (int k = 0; k < 2000; ++k)
    obstacles.push_back(test::box_at(random.uniform(0, 200), random.uniform(0, 200), 1, 1));
  obstacles.push_back(Polyline{{{1e9, 1e9}, {1e9 + 1.0, 1e9}}});
  constexpr double h = 1e10;
  const Vec2 square[4] = {{-h, -h}, {h, -h}, {h, h}, {-h, h}};
  const routing::CellMap map(routing::planar_graph(obstacles), square);
  const routing::PieceTree pieces(map);
  for (int k = 0; k < 100; ++k) {
    const Vec2 a = random.in_box(200), b = a + 3.0 * random.direction();
    std::size_t named = 0, near = 0;
    pieces.for_each_near(a, b, 0.5, [&](int) { return ++named > 0; });
    for (std::size_t e = 0; e < map.graph.edges.size(); ++e) {
      const auto [i, j] = map.ends_of(static_cast<int>(e));
      near += distance(Segment{a, b}, Segment{map.vertex(i).rounded(), map.vertex(j).rounded()}) < 0.5 ? 1 : 0;
    }
    EXPECT_GE(named, near);
    EXPECT_LT(named, 100u);
  }
}

// What the second search found went through the middles of portals, and its bound was the straight line.
TEST(RouteCurves, TheSecondSearchIsPulledTautToo) {
  for (const int n : {50, 2000}) {
    Searched searched({Polygon{circle(100.0, n), {}}}, 6000.0, 2.0);
    const Vec2 s{-200, 1}, t{200, 1};
    const std::optional<routing::Way> best = searched.find(s, t);
    const std::optional<routing::Way> way = searched.find(s, t, n / 5);
    ASSERT_TRUE(best && way && searched.was_second) << n;
    EXPECT_LE(searched.length_of(*way, s, t), 1.01 * searched.length_of(*best, s, t)) << n;
    EXPECT_GE(way->lower_bound, norm(t - s)) << n;
    EXPECT_LE(way->lower_bound, best->lower_bound * (1.0 + 1e-9)) << n;
  }
}

// Each pair of equal edges was looked at: a thousand squares took ten seconds.
TEST(RouteLumps, EqualObstaclesCountOnce) {
  const Polygon square{{{2, 2}, {4, 2}, {4, 4}, {2, 4}}, {}};
  const Polygon hole{{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}}};
  const std::vector<Obstacle> many(20000, Obstacle(square));
  EXPECT_EQ(RouteMap(many).vertex_count(), 4u);
  EXPECT_TRUE(std::holds_alternative<Route>(RoutePlan(RouteMap(many), 0.5).query({1, 1}, {5, 5})));
  EXPECT_TRUE(std::holds_alternative<Blocked>(RoutePlan(RouteMap(many), 0.5).query({1, 1}, {3, 3})));
  // A square that fills a hole lies on the other side of its edges than the solid round it; so do walls on neither.
  const std::vector<Obstacle> filled{square, hole, Polyline{{{4, 2}, {2, 2}}}};
  for (const Vec2 inside : {Vec2{3, 3}, Vec2{0, 0}})
    EXPECT_TRUE(std::holds_alternative<Blocked>(RoutePlan(RouteMap(filled), 0.1).query({20, 0}, inside)));
  const std::vector<Obstacle> open{hole, Polyline{{{4, 2}, {2, 2}}}};
  EXPECT_TRUE(std::holds_alternative<Separated>(RoutePlan(RouteMap(open), 0.1).query({20, 0}, {3, 3})));
}

// --- Vertices almost in one point ---

// Two houses side by side whose common corners differ: a route three hundred times too long went through the middles of
// all portals, since the string was taken to be taut where the proof could not take it to be clear.
TEST(RouteLumps, CornersThatDifferByAlmostNothingDoNotLengthenTheRoute) {
  for (const double turned : {0.0, 0.7, 2.5}) {
    const test::Turn turn(turned);
    for (double off = 1e-16; off < 1e-3; off *= 3.0) {
      const std::vector<Obstacle> houses{
          Polygon{{turn({0, 0}), turn({6, 0}), turn({6, 7}), turn({0, 7})}, {}},
          Polygon{{turn({6 + off, 0}), turn({9, 0}), turn({9, 7 + off}), turn({6 + off, 7 + off})}, {}}};
      for (const double radius : {0.5, 0.05}) {
        const Route route = route_of(houses, radius, turn({-1, 5}), turn({10, 6}));
        EXPECT_LT(route.length, 1.02 * route.lower_bound) << turned << " " << off << " " << radius;
      }
    }
  }
}

// A lump of vertices of which the outermost is in the middle of the turn, cut by no straight piece of the string.
TEST(RouteLumps, AVertexThatOnlyAnArcCutsIsGoneRound) {
  for (double off = 1e-14; off < 1e-4; off *= 7.0) {
    const std::vector<Obstacle> posts{Polygon{{{0, 0}, {-4, 0}, {-4, 8}, {0, 8}}, {}},
                                      Polyline{{{off, -off}, {off, -off}}}};
    const Route route = route_of(posts, 0.5, {-3, -0.6}, {0.6, 5});
    EXPECT_LT(route.length, 1.02 * route.lower_bound) << off;
  }
}

}  // namespace
}  // namespace exactvo::geometry
