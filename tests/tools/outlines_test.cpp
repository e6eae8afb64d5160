// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn of a velocity obstacle is the velocity obstacle, held against the exact predicates.
#include "figures/outlines.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "exactvo/vo/velocity_obstacle.h"
#include "support/seeded_random.h"

namespace exactvo::tools {
namespace {

using geometry::ConvexShape;
using geometry::GrownShape;

const Box kView{{-4.0, -4.0}, {4.0, 4.0}};
constexpr double kTau = 1.5;
/// m/s: how far the drawn boundary may stray from the true one: 256 directions over at most half a turn, on shapes of
/// radius below 5 m/s in velocity space, R (1 - cos(pi/512)) < 1e-4.
constexpr double kDrawn = 1e-3;

ConvexShape shape_of_kind(int kind, Vec2 at) {
  switch (kind) {
    case 0:
      return geometry::Disc{at, 1.0};
    case 1:
      return geometry::Segment{at + Vec2{-1.0, -0.5}, at + Vec2{1.0, 0.5}};
    case 2:
      return geometry::ConvexPolygon{{at + Vec2{-1.0, -1.0}, at + Vec2{1.0, -1.0}, at + Vec2{0.0, 1.5}}};
    default:
      return geometry::ellipse_from_axes(at, {2.0, 0.7, 0.8});
  }
}

class DrawnVelocityObstacle : public testing::TestWithParam<int> {
 protected:
  DrawnVelocityObstacle() : shape_(shape_of_kind(GetParam(), {3.0, 2.0})), seen_{shape_, {-0.5, 0.0}, 0.5} {}
  ConvexShape shape_;
  GrownShape seen_;
};

Vec2 centre(const Points& ring) {
  Vec2 sum;
  for (const Vec2 p : ring) sum += p;
  return sum / static_cast<double>(ring.size());
}

TEST_P(DrawnVelocityObstacle, HoldsExactlyTheCollidingVelocities) {
  const vo::VelocityObstacle exact(shape_, seen_.origin, seen_.radius, kTau);
  const Vec2 shift{0.4, -0.3};
  const Points ring = velocity_obstacle_in(kView, seen_, kTau, shift);
  ASSERT_GE(ring.size(), 3u);
  test::SeededRandom random(test::seed_of_run(11));
  for (int i = 0; i < 2000; ++i) {
    const Vec2 v = random.in_box(4.0);
    double outside = -1e9;  // how far v lies outside the convex ring, by its edges
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 edge = ring[(k + 1) % ring.size()] - ring[k];
      if (norm(edge) > 0.0) outside = std::max(outside, cross(v - ring[k], edge) / norm(edge));
    }
    if (outside > kDrawn) {
      EXPECT_FALSE(exact.contains(v - shift)) << v.x << " " << v.y;
    }
    if (outside < -kDrawn) {
      EXPECT_TRUE(exact.contains(v - shift)) << v.x << " " << v.y;
    }
  }
}

TEST_P(DrawnVelocityObstacle, LegNormalsAreWhereTheSupportChangesSign) {
  const auto legs = leg_normals(seen_);
  ASSERT_TRUE(legs.has_value());
  for (const Vec2 n : {legs->first, legs->second}) EXPECT_NEAR(support(seen_, n).h, 0.0, 1e-12);
  EXPECT_GT(cross(perp(legs->second), -perp(legs->first)), 0.0) << "the left leg lies left of the right one";
}

TEST_P(DrawnVelocityObstacle, OutlineTouchesTheSupportLines) {
  const Points ring = outline(shape_);
  for (int i = 0; i < 16; ++i) {
    const Vec2 n = geometry::rotated({1.0, 0.0}, i * 0.4);
    double most = -1e9;
    for (const Vec2 p : ring) most = std::max(most, dot(n, p));
    EXPECT_NEAR(most, support({shape_, {0.0, 0.0}, 0.0}, n).h, kDrawn);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, DrawnVelocityObstacle, testing::Range(0, 4), [](const auto& test) {
  return std::string(std::array<const char*, 4>{"Disc", "Segment", "Polygon", "Ellipse"}[test.param]);
});

TEST(Outlines, NoConeWhereTheRobotOverlaps) {
  const GrownShape inside{geometry::Disc{{0.0, 0.0}, 1.0}, {0.5, 0.0}, 0.5};
  EXPECT_FALSE(leg_normals(inside).has_value());
  EXPECT_TRUE(velocity_obstacle_in(kView, inside, kTau, {}).empty());
}

TEST(Clipped, KeepsTheSideThatIsAsked) {
  const Points square = corners(Box{{0.0, 0.0}, {2.0, 2.0}});
  const Points right = clipped(square, {{1.0, 0.0}, 1.5});
  ASSERT_EQ(right.size(), 4u);
  for (const Vec2 p : right) EXPECT_GE(p.x, 1.5);
  EXPECT_NEAR(centre(right).x, 1.75, 1e-15);
  EXPECT_TRUE(clipped(square, {{1.0, 0.0}, 3.0}).empty());
  EXPECT_EQ(clipped(square, {{1.0, 0.0}, -1.0}).size(), 4u);
}

TEST(ClippedTo, CutsARingThatIsNotConvexAtTheBox) {
  // A U whose arms stick out of the top of the box: two pieces within it, joined along its upper side.
  const Points u = {{0, 0}, {3, 0}, {3, 9}, {2, 9}, {2, 1}, {1, 1}, {1, 9}, {0, 9}};
  const Box box{{-1.0, -1.0}, {4.0, 4.0}};
  const Points kept = clipped_to(u, box);
  double twice_area = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_TRUE(box.contains(kept[i]));
    twice_area += cross(kept[i], kept[(i + 1) % kept.size()]);
  }
  EXPECT_DOUBLE_EQ(twice_area / 2.0, 3.0 + 2.0 * 3.0);
  EXPECT_TRUE(clipped_to(u, Box{{10.0, 10.0}, {11.0, 11.0}}).empty());
}

}  // namespace
}  // namespace exactvo::tools
