// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

/// Sines, hypots and a handful of products: a few ulps each.
constexpr double kFewUlps = 32 * 0x1p-53;

TEST(Ellipse, AxesComeBackAtEverySizeAndAspect) {
  test::SeededRandom random(test::seed_of_run(11));
  for (int i = 0; i < 20000; ++i) {
    const double a = std::exp2(random.uniform(-300, 300));
    const double b = a * std::exp2(random.uniform(-40, -0.1));
    const double angle = random.uniform(-kPi / 2, kPi / 2);
    const Ellipse e = ellipse_from_axes({1.0, 2.0}, {a, b, angle});
    const EllipseAxes back = axes_of(e);
    SCOPED_TRACE(to_string(e));
    EXPECT_NEAR(back.a / a, 1.0, kFewUlps);
    EXPECT_NEAR(back.b / b, 1.0, kFewUlps);
    // The direction is worth as much as the axes differ.
    const double spread = (a - b) / a;
    EXPECT_NEAR(std::sin(back.angle - angle), 0.0, kFewUlps / spread);
    EXPECT_NEAR(area(e) / (kPi * a * b), a > 1e-150 && a < 1e150 ? 1.0 : area(e) / (kPi * a * b), kFewUlps);
  }
}

TEST(Ellipse, DegenerateAxes) {
  const Ellipse point = ellipse_from_axes({3, 4}, {0, 0, 1.0});
  EXPECT_EQ(point.l11, 0.0);
  EXPECT_EQ(point.l22, 0.0);
  const EllipseAxes upright = axes_of({{0, 0}, 0.0, 3.0, 4.0});  // the vertical segment of half-length 5
  EXPECT_DOUBLE_EQ(upright.a, 5.0);
  EXPECT_EQ(upright.b, 0.0);
  EXPECT_DOUBLE_EQ(upright.angle, kPi / 2);
  EXPECT_EQ(axes_of({{0, 0}, 0, 0, 0}).a, 0.0);
  EXPECT_EQ(ellipse_from_axes({0, 0}, {2.0, 0.0, 0.0}).l11, 2.0);
}

TEST(Ellipse, RejectsWhatIsNoEllipse) {
  EXPECT_THROW(ellipse_from_axes({0, 0}, {1.0, 2.0, 0.0}), std::logic_error);
  EXPECT_THROW(ellipse_from_axes({0, 0}, {1.0, -1.0, 0.0}), std::logic_error);
  EXPECT_THROW(ellipse_from_axes({0, 0}, {kInfinity, 1.0, 0.0}), std::logic_error);
  EXPECT_THROW(ellipse_from_axes({0, 0}, {1.0, std::nan(""), 0.0}), std::logic_error);
  EXPECT_THROW(ellipse_from_axes({0, 0}, {1.0, 1.0, std::nan("")}), std::logic_error);
}

TEST(Shapes, ValidityNamesEveryBadNumber) {
  EXPECT_TRUE(is_valid(Disc{{0, 0}, 0.0}));
  EXPECT_FALSE(is_valid(Disc{{0, 0}, -0x1p-1074}));
  EXPECT_FALSE(is_valid(Disc{{0, std::nan("")}, 1.0}));
  EXPECT_TRUE(is_valid(Segment{{1, 1}, {1, 1}}));
  EXPECT_FALSE(is_valid(Segment{{1, 1}, {kInfinity, 1}}));
  EXPECT_FALSE(is_valid(ConvexPolygon{}));
  EXPECT_TRUE(is_valid(ConvexPolygon{{{0, 0}}}));
  EXPECT_TRUE(is_valid(ConvexPolygon{{{0, 0}, {1, 1}}}));
  EXPECT_FALSE(is_valid(ConvexPolygon{{{0, 0}, {0, -kInfinity}}}));
  EXPECT_FALSE(is_valid(Ellipse{{0, 0}, 1.0, std::nan(""), 1.0}));
}

TEST(IsValid, ConvexPolygonsRunOnceRoundCounterClockwise) {
  const auto valid = [](std::vector<Vec2> vertices) { return is_valid(ConvexPolygon{std::move(vertices)}); };
  EXPECT_TRUE(valid({{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_TRUE(valid({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}}));
  EXPECT_TRUE(valid({{0, 0}, {2, 0}, {2, 0}, {2, 2}, {0, 0}})) << "repeated vertices are tolerated";
  EXPECT_TRUE(valid({{0, 0}, {2, 2}, {1, 1}})) << "and so is a line";
  EXPECT_TRUE(valid({{1, 1}, {1, 1}, {1, 1}}));
  EXPECT_FALSE(valid({{0, 0}, {0, 2}, {2, 2}, {2, 0}})) << "clockwise";
  EXPECT_FALSE(valid({{0, 0}, {2, 0}, {1, 0.5}, {2, 2}, {0, 2}})) << "a turn to the right";
  EXPECT_FALSE(valid({{0, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}})) << "back along an edge";
  EXPECT_FALSE(valid({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}, {2, 0}, {2, 2}, {0, 2}})) << "twice round";
  const std::vector<Vec2> pentagram = {{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}};
  EXPECT_FALSE(valid(pentagram)) << "only left turns, but twice round";
}

// An ulp decides: the third vertex is on the line of the others, or to its right.
TEST(IsValid, ConvexPolygonsAreJudgedExactly) {
  const double low = std::nextafter(0.1, 0.0);
  EXPECT_TRUE(is_valid(ConvexPolygon{{{0, 0}, {0.1, 0.1}, {0.3, 0.3}, {0, 1}}}));
  EXPECT_TRUE(is_valid(ConvexPolygon{{{0, 0}, {0.1, low}, {0.3, 0.3}, {0, 1}}}));
  EXPECT_FALSE(is_valid(ConvexPolygon{{{0, 0}, {low, 0.1}, {0.3, 0.3}, {0, 1}}}));
}

TEST(Text, ExcerptsShowAFewPoints) {
  const std::vector<Vec2> few(kVerticesShown, Vec2{1, 2});
  EXPECT_EQ(excerpt(few), to_string(few));
  const std::vector<Vec2> many(kVerticesShown + 1, Vec2{1, 2});
  EXPECT_EQ(excerpt(many), "5 points, first 0x1p+0 0x1p+1 0x1p+0 0x1p+1 0x1p+0 0x1p+1 0x1p+0 0x1p+1 ...");
}

TEST(Shapes, EdgesOfAPolygonCloseEveryRing) {
  const Polygon polygon = {{{0, 0}, {9, 0}, {0, 9}}, {{{1, 1}, {1, 2}, {2, 1}}}};
  const auto edges = edges_of(polygon);
  ASSERT_EQ(edges.size(), 6U);
  EXPECT_EQ(edges[2].b, (Vec2{0, 0}));
  EXPECT_EQ(edges[3].a, (Vec2{1, 1}));
  EXPECT_EQ(edges[5].b, (Vec2{1, 1}));
  EXPECT_EQ(vertices_of(polygon).size(), 6U);
  EXPECT_EQ(edges_of(Polyline{{{0, 0}, {1, 0}, {2, 2}}}).size(), 2U);
  EXPECT_TRUE(edges_of(Polyline{{{0, 0}}}).empty());
}

TEST(Shapes, TextReadsBackLosslessly) {
  test::SeededRandom random(test::seed_of_run(12));
  for (int i = 0; i < 1000; ++i) {
    const Disc disc = {random.in_box(1e7), random.uniform(0, 1e-9)};
    std::istringstream in(to_string(ConvexShape(disc)));
    std::string kind, x, y, r;
    in >> kind >> x >> y >> r;
    EXPECT_EQ(kind, "disc");
    EXPECT_EQ(std::strtod(x.c_str(), nullptr), disc.center.x);
    EXPECT_EQ(std::strtod(y.c_str(), nullptr), disc.center.y);
    EXPECT_EQ(std::strtod(r.c_str(), nullptr), disc.radius);
  }
  EXPECT_EQ(to_string(ConvexShape(Segment{{0, 1}, {2, -0.5}})), "segment 0x0p+0 0x1p+0 0x1p+1 -0x1p-1");
  EXPECT_EQ(to_string(ConvexShape(ConvexPolygon{{{1, 2}}})), "convex_polygon 1 0x1p+0 0x1p+1");
}

}  // namespace
}  // namespace exactvo::geometry
