// SPDX-License-Identifier: GPL-3.0-or-later
// What enclosure.h promises of every ellipse that it returns, checked by predicates and in rationals.
#include "exactvo/geometry/enclosure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/predicates.h"
#include "geometry/plain_fit.h"
#include "geometry/rational_oracle.h"
#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

TEST(FacadeEllipse, HoldsItsFacadeWithTheMargin) {
  SeededRandom random(test::seed_of_run(91));
  for (int i = 0; i < 2000; ++i) {
    const Vec2 a = random.in_box(i % 3 == 0 ? 1e5 : 5.0);
    const Segment facade{a, a + random.uniform(0.0, 4.0) * random.direction()};
    const Ellipse e = facade_ellipse(facade);
    ASSERT_TRUE(test::in_ellipse(e, facade.a) && test::in_ellipse(e, facade.b)) << to_string(ConvexShape{e});
    const EllipseAxes axes = axes_of(e);
    EXPECT_GE(axes.a - 0.5 * norm(facade.b - facade.a), 0.05 - 1e-9);
  }
}

// Equation (8), corrected: robot radius + the least depth of the facade in the ellipse, here by marching.
TEST(FacadeEllipse, Equation8IsTheLeastDepth) {
  const Segment facade{{-1.0, 0.0}, {1.0, 0.0}};
  const Ellipse e{{0.0, 0.0}, 2.0, 0.0, 1.0};
  double least = 1e300;
  for (int i = 0; i < 20000; ++i) {
    const double angle = 6.28318530717958647692 * i / 20000;
    const Vec2 rim{2.0 * std::cos(angle), std::sin(angle)};
    least = std::min(least, norm(rim - Vec2{std::clamp(rim.x, -1.0, 1.0), 0.0}));
  }
  EXPECT_NEAR(clearance_of_equation_8(facade, e, 0.3), 0.3 + least, 1e-6);
}

std::vector<Vec2> random_wall(SeededRandom& random) {
  const Vec2 along = random.direction();
  std::vector<Vec2> points;
  for (int i = 0; i < 6; ++i)
    points.push_back(random.uniform(-1.5, 1.5) * along + random.uniform(-0.1, 0.1) * perp(along));
  return points;
}

TEST(FitTrapFree, WhatIsReturnedHolds) {
  SeededRandom random(test::seed_of_run(92));
  int free = 0, refused = 0;
  for (int i = 0; i < 120; ++i) {
    const std::vector<Vec2> points = random_wall(random);
    const Vec2 start = random.uniform(1.5, 6.0) * random.direction(),
               goal = random.uniform(1.5, 6.0) * random.direction();
    const auto fitted = fit_trap_free(points, 0.3, start, goal);
    if (!fitted) {
      ++refused;
      continue;
    }
    const GrownShape grown{fitted->ellipse, {}, 0.3};
    for (const Vec2 p : points) ASSERT_TRUE(test::in_ellipse(fitted->ellipse, p));
    EXPECT_EQ(locate(grown, start), Place::outside);
    EXPECT_EQ(locate(grown, goal), Place::outside);
    const bool certified =
        fitted->grade == EnclosureGrade::trap_free || fitted->grade == EnclosureGrade::trap_free_thin;
    EXPECT_NE(fitted->grade, EnclosureGrade::tight);
    if (certified) {
      EXPECT_TRUE(goal_outside_evolute(fitted->ellipse, goal));
      ++free;
    }
  }
  EXPECT_GT(free, 40);
  EXPECT_LT(refused, 60);
}

/// Bounds and estimates rule out candidates, and no ellipse that would have been taken: against every candidate asked
/// in full. Walls, needles, symmetric and repeated points, ends so near that the evolute or the ends themselves decide.
TEST(FitTrapFree, IsThePlainFitBitForBit) {
  SeededRandom random(test::seed_of_run(31));
  const auto bits = [](const std::optional<FittedEllipse>& f) {
    if (!f) return std::vector<double>{};
    const Ellipse& e = f->ellipse;
    return std::vector<double>{static_cast<double>(f->grade), e.center.x, e.center.y, e.l11, e.l21, e.l22};
  };
  int grades[5] = {};
  for (int k = 0; k < 2000; ++k) {
    const Vec2 middle = random.in_box(k % 7 == 0 ? 1e3 : 3.0), along = k % 3 == 0 ? Vec2{1, 0} : random.direction();
    const double length = k % 11 == 0 ? 0.0 : random.uniform(0.05, 3.0),
                 height = k % 4 == 0 ? 0.0 : random.uniform(0.0, 2.0);
    std::vector<Vec2> points;
    const int count = k % 20 == 0 ? 16 : 1 + k % 5;
    for (int i = 0; i < count; ++i) {
      Vec2 p = random.in_box(1.0);
      if (k % 6 == 1) p = {i % 2 == 0 ? 1.0 : -1.0, i / 2 % 2 == 0 ? 1.0 : -1.0};
      points.push_back(middle + p.x * length * along + p.y * height * perp(along));
    }
    const double near = k % 5 == 0 ? 0.5 : 4.0;
    const Vec2 start = middle + random.uniform(0.3, near + 1.0) * random.direction();
    const Vec2 goal = middle + random.uniform(0.3, near) * (k % 9 == 0 ? along : random.direction());
    EnclosureOptions options;
    if (k % 8 == 0) options.margin = options.least_margin = 1e-3;
    if (k % 13 == 0) options.slack = 3.0;
    const double radius = k % 10 == 0 ? 0.0 : random.uniform(0.05, 0.5);
    const auto fast = fit_trap_free(points, radius, start, goal, options);
    const auto plain = test::PlainFit(points, radius, start, goal, options).run();
    EXPECT_EQ(bits(fast), bits(plain)) << "case " << k;
    ++grades[fast ? static_cast<int>(fast->grade) : 4];
  }
  for (const int grade : {0, 1, 2, 4}) EXPECT_GT(grades[grade], 20) << grade;
}

// Ties (a wall seen at right angles) and near ties included: no double of the moved scene is rounded.
TEST(FitTrapFree, MovesWithTheScene) {
  constexpr double kGrid = 0x1p-20;
  const auto on_grid = [](Vec2 p) { return Vec2{std::round(p.x / kGrid) * kGrid, std::round(p.y / kGrid) * kGrid}; };
  SeededRandom random(test::seed_of_run(94));
  int compared = 0;
  for (int i = 0; i < 30; ++i) {
    const bool tie = i == 0;
    std::vector<Vec2> points = tie ? std::vector<Vec2>{{6, -2}, {6, 2}} : random_wall(random);
    for (Vec2& p : points) p = on_grid(p);
    const Vec2 start = tie ? Vec2{0, 0} : on_grid(4.0 * random.direction());
    const Vec2 goal = tie ? Vec2{12, 0} : on_grid(4.0 * random.direction());
    const auto here = fit_trap_free(points, 0.3, start, goal);
    for (const Vec2 shift : {Vec2{1, 1}, Vec2{64, -64}, Vec2{0x1p20, 1000}}) {
      std::vector<Vec2> moved = points;
      for (Vec2& p : moved) p = p + shift;
      const auto there = fit_trap_free(moved, 0.3, start + shift, goal + shift);
      ASSERT_EQ(here.has_value(), there.has_value()) << "case " << i << ", by " << shift.x << ", " << shift.y;
      if (!here) continue;
      ++compared;
      EXPECT_EQ(here->grade, there->grade);
      // The centre is rounded once, to 2^-33 m at 2^20 m; the ellipse grows to hold the points again.
      constexpr double kRounded = 1e-8;
      EXPECT_NEAR(norm(there->ellipse.center - shift - here->ellipse.center), 0.0, kRounded) << "case " << i;
      EXPECT_NEAR(there->ellipse.l11, here->ellipse.l11, kRounded);
      EXPECT_NEAR(there->ellipse.l21, here->ellipse.l21, kRounded);
      EXPECT_NEAR(there->ellipse.l22, here->ellipse.l22, kRounded);
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(FitTrapFree, NoEllipseWhereTheGoalIsAtTheWall) {
  EXPECT_FALSE(fit_trap_free({{-1, 0}, {1, 0}}, 0.3, {0, -3}, {0, 0.2}));
}

// The smallest ellipse was a segment, which holds no point: an internal error, of a straight wall and a margin of 0
// too.
TEST(FitTrapFree, OfCollinearPointsWithoutAMarginIsAnEllipse) {
  EnclosureOptions options;
  options.margin = options.least_margin = 0.0;
  const std::vector<std::vector<Vec2>> flat{{{3.0, 0.1}, {3.0, 0.1000001}},
                                            {{6.0, -2.0}, {6.0, 2.0}},
                                            {{6.0, 2.2}, {6.0, 3.0}, {6.0, 5.0}},
                                            {{1.0, 1.0}, {2.0, 2.0}, {4.0, 4.0}}};
  for (const std::vector<Vec2>& points : flat) {
    const auto fitted = fit_trap_free(points, 0.5, {0.0, 0.0}, {12.0, 0.0}, options);
    ASSERT_TRUE(fitted.has_value()) << points.back().x << ' ' << points.back().y;
    for (const Vec2 p : points) EXPECT_TRUE(contains(fitted->ellipse, p));
  }
}

TEST(Enclose, EveryObstacleIsCovered) {
  SeededRandom random(test::seed_of_run(93));
  int trap_free = 0;
  for (int i = 0; i < 6; ++i) {
    std::vector<ObstacleParts> obstacles;
    std::vector<std::vector<Vec2>> points;
    for (int k = 0; k < 4; ++k) {
      const Vec2 at = random.in_box(3.0);
      const Polygon box{{at, at + Vec2{0.8, 0}, at + Vec2{0.8, 0.5}, at + Vec2{0, 0.5}}, {}};
      obstacles.push_back(parts_of(Obstacle{box}));
      points.push_back(box.outer);
    }
    const std::vector<Enclosure> enclosures = enclose(obstacles, 0.25, {-6, -6}, {6, 6});
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (const Vec2 p : points[k]) {
        const bool covered = std::any_of(enclosures.begin(), enclosures.end(), [&](const Enclosure& e) {
          const bool mine = std::find(e.obstacles.begin(), e.obstacles.end(), k) != e.obstacles.end();
          return mine && locate({e.shape, {}, 0.0}, p) != Place::outside;
        });
        EXPECT_TRUE(covered) << "obstacle " << k;
      }
    }
    for (const Enclosure& e : enclosures) {
      EXPECT_TRUE(std::is_sorted(e.obstacles.begin(), e.obstacles.end()));
      if (const auto* ellipse = std::get_if<Ellipse>(&e.shape); ellipse != nullptr && e.trap_free()) {
        EXPECT_TRUE(goal_outside_evolute(*ellipse, {6, 6}));
        ++trap_free;
      }
    }
  }
  EXPECT_GE(trap_free, 4);
}

TEST(Enclose, RefusesWhatIsNoPlace) {
  EXPECT_THROW(facade_ellipse({{0, 0}, {std::nan(""), 0}}), std::logic_error);
  EXPECT_THROW(fit_trap_free({}, 0.3, {0, 0}, {1, 1}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::geometry
