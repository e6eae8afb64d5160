// SPDX-License-Identifier: GPL-3.0-or-later
// The numbered properties of membership.h, against VelocityObstacle::contains.
#include "exactvo/vo/membership.h"
#include "exactvo/geometry/infinity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Vec2;
using vo::Membership;
using vo::VelocityObstacle;

using geometry::kInfinity;

Vec2 nudged(SeededRandom& random, Vec2 v) {
  const double ulps = random.integer(0, 1) == 0 ? 0x1p-52 : std::exp2(random.integer(-50, -2));
  return {v.x * (1.0 + ulps * random.integer(-2, 2)), v.y * (1.0 + ulps * random.integer(-2, 2))};
}

// Anywhere; along a leg, near its tangent point and beyond it; about the cut-off; at rest.
std::vector<Vec2> velocities(SeededRandom& random, const VelocityObstacle& obstacle, double tau) {
  std::vector<Vec2> out{{}, random_velocity(random, obstacle.grown(), tau)};
  if (const auto legs = obstacle.legs()) {
    for (const vo::Leg& leg : {legs->left, legs->right}) {
      out.push_back(nudged(random, leg.touch / tau));
      out.push_back(nudged(random, std::exp2(random.integer(-3, 20)) * leg.direction));
      out.push_back(nudged(random, geometry::perp(leg.normal)));
      out.push_back(nudged(random, -geometry::perp(leg.normal_outside)));
    }
    const double share = random.uniform(-0.1, 1.1);
    out.push_back(nudged(random, (share * legs->left.touch + (1.0 - share) * legs->right.touch) / tau));
  }
  const Vec2 n = geometry::normalized(obstacle.nearest().normal + 0.7 * random.in_box(1.0));
  out.push_back(nudged(random, support_point(obstacle.grown(), n) / tau));
  return out;
}

void expect_same_answers(SeededRandom& random, const VelocityObstacle& obstacle, double tau) {
  const Membership membership(obstacle);
  for (const Vec2 v : velocities(random, obstacle, tau))
    ASSERT_EQ(membership.contains(v), obstacle.contains(v))
        << to_string(obstacle.grown().shape) << " v " << geometry::hex_text(v.x) << " " << geometry::hex_text(v.y);
}

TEST(Membership, Property1_AnswersAsTheVelocityObstacle) {
  SeededRandom random(seed_of_run(91));
  for (int i = 0; i < 20000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const double tau = std::exp2(random.uniform(-6.0, 6.0));
    const VelocityObstacle obstacle = velocity_obstacle(scene.s, tau);
    if (!obstacle.overlaps()) expect_same_answers(random, obstacle, tau);
  }
}

TEST(Membership, Property1_ForEverAndForPolygonalRobots) {
  SeededRandom random(seed_of_run(92));
  for (int i = 0; i < 600; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const VelocityObstacle cone = velocity_obstacle(scene.s, kInfinity);
    if (!cone.overlaps()) expect_same_answers(random, cone, 1.0);
    const ConvexPolygon robot = random_convex_polygon(random, {}, 0.5 * scene.size, random.integer(3, 6));
    const double tau = random.uniform(0.1, 10.0);
    const VelocityObstacle swept(scene.s.shape, scene.s.origin, robot, tau);
    if (!swept.overlaps()) expect_same_answers(random, swept, tau);
  }
}

// Before the chord of a disc at twice its radius lies less than a fifth of S.
TEST(Membership, Property2_LeavesLittleToTheGeneralPredicate) {
  SeededRandom random(seed_of_run(93));
  const Membership membership(VelocityObstacle(Disc{{2.0, 0.0}, 0.5}, {}, 0.5, 2.0));
  constexpr int kVelocities = 10000;
  geometry::reset_stage_counts();
  for (int i = 0; i < kVelocities; ++i) membership.contains(random.in_box(2.0));
  const geometry::StageCounts counts = geometry::stage_counts();
  EXPECT_LT(counts.filter + counts.exact, kVelocities / 20);
  EXPECT_GT(counts.filter + counts.exact, 0);
}

TEST(Membership, RefusesWhatTheVelocityObstacleRefuses) {
  const Membership membership(VelocityObstacle(Disc{{2.0, 0.0}, 0.5}, {}, 0.5, 2.0));
  EXPECT_THROW(membership.contains({std::nan(""), 0.0}), std::logic_error);
  EXPECT_THROW(membership.contains({0.0, std::nan("")}), std::logic_error);
  EXPECT_THROW(membership.contains({kInfinity, 0.0}), std::logic_error);
  EXPECT_THROW(membership.contains({1.0, -kInfinity}), std::logic_error);
  EXPECT_TRUE(membership.contains({0x1p900, 0.0}));
  EXPECT_FALSE(membership.contains({-0x1p900, 0.0}));
}

}  // namespace
}  // namespace exactvo::test
