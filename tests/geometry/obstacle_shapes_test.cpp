// SPDX-License-Identifier: GPL-3.0-or-later
// Everything made of one obstacle: what is certified is checked again by other means, and nothing throws.
#include "exactvo/geometry/obstacle_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "random_shapes.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

const Polygon kRoomWithTwoPillars{{{0, 0}, {8, 0}, {8, 6}, {0, 6}},
                                  {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}, {{4, 3}, {4, 5}, {6, 5}, {6, 3}}}};

double area_of(const ConvexShape& piece) {
  const auto& ring = std::get<ConvexPolygon>(piece).vertices;
  double twice = 0.0;
  for (std::size_t i = 2; i < ring.size(); ++i) twice += cross(ring[i - 1] - ring[0], ring[i] - ring[0]);
  return 0.5 * twice;
}

double area_of(const std::vector<ConvexShape>& pieces) {
  double sum = 0.0;
  for (const ConvexShape& piece : pieces) sum += area_of(piece);
  return sum;
}

TEST(ObstacleShapes, ARoomWithPillarsHasEverythingCertified) {
  const ObstacleShapes shapes = shapes_of(kRoomWithTwoPillars);
  ASSERT_TRUE(shapes.valid);
  EXPECT_TRUE(shapes.certified());
  EXPECT_EQ(shapes.facades.facades.size(), 12u);
  EXPECT_EQ(shapes.facade_ellipses.size(), 12u);
  EXPECT_EQ(shapes.measurements.area, 48.0 - 1.0 - 4.0);
  EXPECT_EQ(area_of(shapes.pieces), 43.0);
  EXPECT_EQ(shapes.hull.vertices.size(), 4u);
  EXPECT_EQ(shapes.measurements.holes, 2u);
  EXPECT_NEAR(shapes.measurements.ellipse_area, 0.5 * kPi * 48.0, 1e-9) << "pi/2 times the rectangle's area";
}

TEST(ObstacleShapes, HolesThatTouchAreSplitWhereTheyDo) {
  // One hole's corner lies inside the shell's edge, another's on the first one's corner.
  const Polygon polygon{{{0, 0}, {8, 0}, {8, 6}, {0, 6}},
                        {{{4, 0}, {3, 2}, {5, 2}}, {{5, 2}, {5, 4}, {7, 4}, {7, 2}}, {{0, 3}, {1, 4}, {1, 2}}}};
  ASSERT_TRUE(normalize({polygon.outer, polygon.holes[0], polygon.holes[1], polygon.holes[2]}).ok());
  const ObstacleShapes shapes = shapes_of(polygon);
  EXPECT_TRUE(shapes.certified()) << shapes.pieces_cover.reason;
  EXPECT_EQ(area_of(shapes.pieces), 48.0 - 2.0 - 4.0 - 1.0);
}

TEST(ObstacleShapes, AWallIsItsOwnPieces) {
  const ObstacleShapes shapes = shapes_of(Polyline{{{0, 0}, {1, 0}, {2, 0}, {2, 3}}});
  EXPECT_TRUE(shapes.certified());
  EXPECT_EQ(shapes.facades.facades.size(), 2u) << "straight runs are one facade";
  EXPECT_EQ(shapes.pieces.size(), 2u);
  EXPECT_EQ(shapes.measurements.area, 0.0);
}

/// Whether x lies on the piece. Exact.
bool lies_on(const ConvexShape& piece, Vec2 x) {
  return intersect(std::get<Segment>(piece), {x, x});
}

/// Whether the pieces run along the wall from its first point to its last, vertex by vertex, and nowhere else. Exact.
bool run_along(const std::vector<ConvexShape>& pieces, const std::vector<Vec2>& wall) {
  std::size_t at = 0;
  for (const ConvexShape& piece : pieces) {
    const Segment s = std::get<Segment>(piece);
    if (s.a != wall[at]) return false;
    while (wall[at] != s.b) {
      if (++at == wall.size() || !lies_on(piece, wall[at])) return false;
    }
  }
  return at + 1 == wall.size();
}

TEST(ObstacleShapes, PiecesOfAWallKeepEveryEdgeWhateverTheTolerance) {
  SeededRandom random(test::seed_of_run(65));
  ShapeOptions options;
  options.facades.tolerance = 0.5;
  std::size_t simplified = 0;
  for (int k = 0; k < 100; ++k) {
    Polyline wall;
    const int corners = random.integer(3, 30);
    for (int i = 0; i < corners; ++i) wall.points.push_back({0.5 * i, random.uniform(-0.4, 0.4)});
    const ObstacleShapes shapes = shapes_of(wall, options);
    EXPECT_TRUE(shapes.certified()) << shapes.pieces_cover.reason;
    simplified += shapes.facades.facades.size() + 1 < wall.points.size() ? 1 : 0;
    EXPECT_TRUE(run_along(shapes.pieces, wall.points)) << to_string(wall.points);
  }
  EXPECT_GT(simplified, 50u) << "the facades must have left something out for this to mean anything";
}

TEST(ObstacleShapes, AStraightWallIsFlatAndStillFreeOfTraps) {
  const ObstacleShapes shapes = shapes_of(Polyline{{{0, 0}, {4, 0}}});
  EXPECT_TRUE(shapes.certified());
  EXPECT_EQ(shapes.measurements.ellipse_area, 0.0);
  EXPECT_TRUE(std::isinf(shapes.measurements.trap_free_beyond));
  ASSERT_TRUE(shapes.trap_free.ellipse && shapes.trap_free.for_every_goal);
  EXPECT_NEAR(shapes.measurements.trap_free_area, kPi * 4.0 / std::sqrt(2.0), 1e-6);
}

TEST(ObstacleShapes, InvalidOnesGiveCodesAndNothingElse) {
  const ObstacleShapes bow = shapes_of(Polygon{{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {}});
  EXPECT_FALSE(bow.valid);
  EXPECT_FALSE(bow.certified());
  ASSERT_EQ(bow.problems.size(), 1u);
  EXPECT_EQ(bow.problems[0].code, RingProblemCode::self_intersection);
  EXPECT_TRUE(bow.facades.facades.empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(shapes_of(Polygon{{{0, 0}, {1, nan}, {0, 1}}, {}}).problems.at(0).code, RingProblemCode::not_finite);
  EXPECT_EQ(shapes_of(Polygon{}).problems.back().code, RingProblemCode::too_few_points);
  EXPECT_FALSE(shapes_of(Polyline{}).valid);
}

TEST(ObstacleShapes, AClockwiseShellIsTurnedAndReported) {
  const ObstacleShapes shapes = shapes_of(Polygon{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}, {}});
  EXPECT_TRUE(shapes.certified());
  ASSERT_EQ(shapes.problems.size(), 1u);
  EXPECT_EQ(shapes.problems[0].code, RingProblemCode::clockwise);
}

TEST(ObstacleShapes, AWayGivesAnEllipseMadeToMeasureOrTheReasonWhyNot) {
  ShapeOptions options;
  options.robot_radius = 0.5;
  options.way = StartAndGoal{{-5, 0.1}, {9, 0.1}};
  const Polyline wall{{{2, -2}, {2, 2}}};
  const ObstacleShapes round = shapes_of(wall, options);
  EXPECT_EQ(round.trap_free.grade, EnclosureGrade::trap_free);
  EXPECT_TRUE(round.trap_free_contains.certified);
  EXPECT_TRUE(goal_outside_evolute(*round.trap_free.ellipse, options.way->goal));
  options.way->goal = {2.0, 0.3};
  const ObstacleShapes near = shapes_of(wall, options);
  EXPECT_FALSE(near.trap_free.ellipse);
  EXPECT_FALSE(near.trap_free_contains.reason.empty());
  EXPECT_TRUE(near.certified()) << "no room for an ellipse is an answer";
}

TEST(ObstacleShapes, AnEllipseThatIsMissingIsExcusedByAWayAlone) {
  ObstacleShapes shapes = shapes_of(kRoomWithTwoPillars);
  ASSERT_TRUE(shapes.certified());
  EXPECT_EQ(shapes.trap_free.answer, TrapFreeAnswer::found);
  shapes.trap_free = {};
  shapes.trap_free_contains = {false, "no such ellipse found"};
  EXPECT_FALSE(shapes.certified()) << "nothing excuses it";
  shapes.trap_free.answer = TrapFreeAnswer::no_room;
  EXPECT_TRUE(shapes.certified());
}

TEST(ObstacleShapes, NoRoomAndTooLargeAreToldApart) {
  ShapeOptions options;
  options.robot_radius = 0.1;
  options.way = StartAndGoal{{-5.0, 0.1}, {0.1, 0.0}};
  const Polyline wall{{{0, -2}, {0, 2}}};
  const ObstacleShapes near = shapes_of(wall, options);
  EXPECT_EQ(near.trap_free.answer, TrapFreeAnswer::no_room);
  options.way->goal = {3.0, 0.0};
  EXPECT_EQ(shapes_of(wall, options).trap_free.answer, TrapFreeAnswer::found);
  options.enclosure.most_inflation = 0.01;
  const ObstacleShapes small = shapes_of(wall, options);
  EXPECT_EQ(small.trap_free.answer, TrapFreeAnswer::too_large);
  EXPECT_NE(small.trap_free_contains.reason, near.trap_free_contains.reason);
  EXPECT_TRUE(small.certified());
}

TEST(ObstacleShapes, TrapFreeForEveryGoalIsDecidedExactly) {
  const Ellipse just{{0, 0}, std::sqrt(2.0), 0.0, 1.0};  // the double above or below sqrt(2)
  const Ellipse below{{0, 0}, std::nextafter(std::sqrt(2.0), 0.0), 0.0, 1.0};
  const Ellipse above{{0, 0}, std::nextafter(std::sqrt(2.0), 2.0), 0.0, 1.0};
  EXPECT_FALSE(trap_free_for_every_goal(just)) << "fl(sqrt 2)^2 > 2";
  EXPECT_TRUE(trap_free_for_every_goal(below));
  EXPECT_FALSE(trap_free_for_every_goal(above));
  EXPECT_TRUE(trap_free_for_every_goal({{3, 4}, 0, 0, 0}));
  EXPECT_FALSE(trap_free_for_every_goal({{3, 4}, 1, 1, 0}));
}

TEST(ObstacleShapes, GoalsOutsideATrapFreeEllipseLieOutsideItsEvolute) {
  SeededRandom random(test::seed_of_run(61));
  int judged = 0;
  for (int k = 0; k < 300; ++k) {
    const Ellipse e = ellipse_from_axes(random.in_box(5.0), {random.uniform(1.0, 1.5), 1.0, random.uniform(-1.5, 1.5)});
    if (!trap_free_for_every_goal(e)) continue;
    for (int j = 0; j < 20; ++j) {
      const Vec2 n = random.direction();
      const Vec2 goal = e.center + random.uniform(1.0, 1.02) * Vec2{e.l11 * n.x, e.l21 * n.x + e.l22 * n.y};
      if (contains(e, goal)) continue;
      EXPECT_TRUE(goal_outside_evolute(e, goal))
          << to_string(ConvexShape{e}) << " goal " << hex_text(goal.x) << " " << hex_text(goal.y);
      ++judged;
    }
  }
  EXPECT_GT(judged, 1000);
}

TEST(ObstacleShapes, RandomStarsFarAwayAndFlatAreCertified) {
  SeededRandom random(test::seed_of_run(62));
  int judged = 0;
  for (int k = 0; k < 400; ++k) {
    const Ring star = test::star_ring(random, random.integer(3, 40));
    const double aspect = std::pow(10.0, random.uniform(-6.0, 0.0));
    const double scale = std::pow(10.0, random.uniform(-2.0, 3.0));
    const Ring ring = test::placed(star, random.uniform(0.0, 6.0), aspect, scale, random.in_box(1e6));
    const ObstacleShapes shapes = shapes_of(Polygon{ring, {}});
    if (!shapes.valid) continue;  // rounding may have made it cross itself
    EXPECT_TRUE(shapes.certified()) << to_string(ring) << "\n" << shapes.trap_free_contains.reason;
    EXPECT_TRUE(shapes.trap_free.for_every_goal) << to_string(ring);
    for (const Vec2 p : ring) {
      EXPECT_TRUE(contains(shapes.smallest_ellipse, p));
      EXPECT_TRUE(contains(*shapes.trap_free.ellipse, p));
      EXPECT_TRUE(contains(shapes.hull, p));
    }
    EXPECT_NEAR(area_of(shapes.pieces), shapes.measurements.area, 1e-6 * shapes.measurements.hull_area);
    EXPECT_GE(shapes.measurements.trap_free_area, shapes.measurements.least_ellipse_area * (1.0 - 1e-9));
    ++judged;
  }
  EXPECT_GT(judged, 200);
}

TEST(ObstacleShapes, HullMembershipAgreesWithTheEvenOddRule) {
  SeededRandom random(test::seed_of_run(63));
  for (int k = 0; k < 200; ++k) {
    const std::vector<Vec2> points = test::grid_points(random, random.integer(3, 12), 8);
    const ConvexPolygon hull = convex_hull(points);
    for (int x = -1; x <= 9; ++x) {
      for (int y = -1; y <= 9; ++y) {
        const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
        const bool expected = hull.vertices.size() > 2
                                  ? contains(Polygon{hull.vertices, {}}, p)
                                  : intersect({hull.vertices.front(), hull.vertices.back()}, {p, p});
        ASSERT_EQ(contains(hull, p), expected) << to_string(hull.vertices) << " " << x << " " << y;
      }
    }
  }
}

TEST(ObstacleShapes, SimplifiedFacadesStayWithinTheirTolerance) {
  SeededRandom random(test::seed_of_run(64));
  ShapeOptions options;
  options.facades.tolerance = 0.05;
  int judged = 0, fewer = 0;
  for (int k = 0; k < 100; ++k) {
    const Ring ring = test::star_ring(random, 40, 0.9);
    const ObstacleShapes shapes = shapes_of(Polygon{ring, {}}, options);
    if (!shapes.valid) continue;
    EXPECT_TRUE(shapes.certified()) << to_string(ring) << shapes.facades_follow.reason;
    ++judged;
    fewer += shapes.facades.facades.size() < shapes_of(Polygon{ring, {}}).facades.facades.size();
  }
  EXPECT_GT(judged, 80);
  EXPECT_GT(2 * fewer, judged) << "the tolerance merges facades";
}

}  // namespace
}  // namespace exactvo::geometry
