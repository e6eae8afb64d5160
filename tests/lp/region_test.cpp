// SPDX-License-Identifier: GPL-3.0-or-later
// What the double-precision solvers make of a problem: lines moved inward, the sides of the box, a smaller disc.
#include "lp/problem/region.h"
#include "exactvo/geometry/infinity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lp/problem/exact_sign.h"
#include "lp/sets/generated_sets.h"

namespace exactvo::lp {
namespace {

using geometry::kInfinity;

Problem in_disc(double disc) {
  Problem p;
  p.bound.disc = disc;
  return p;
}

TEST(LpRegion, LinesAreMovedInwardByTheSlackOfTheSpeed) {
  Problem p = in_disc(2.0);
  p.constraints.push_back({{{0.6, -0.8}, 0.25}, Priority::soft, 7});
  for (const double units : kSlacks) {
    const Region region = region_of(p, units);
    ASSERT_EQ(region.lines.size(), 1U);
    const Line& line = region.lines[0];
    EXPECT_EQ(region.speed, 2.0);
    EXPECT_DOUBLE_EQ(line.slack, units * kInwardSlack * 2.0 * 1.4);
    EXPECT_EQ(line.offset, 0.25 + line.slack);
    EXPECT_NEAR(line.squared_length, 1.0, 1e-15);
    EXPECT_TRUE(line.soft);
    EXPECT_EQ(line.binding, constraint_at(0));
    EXPECT_LT(region.disc, 2.0);
    EXPECT_GE(region.disc, 2.0 * (1.0 - units * kInwardSlack));
  }
}

TEST(LpRegion, APointThatKeepsAMovedLineKeepsTheGivenOne) {
    std::size_t judged = 0;
  for (const Problem& p : generate("RF10", 300, 41)) {
    const Region region = region_of(p);
    for (const Line& line : region.lines) {
      // The foot of 0 on the moved line, and what of a rounding error it may be beyond: kNoise is let pass.
      const Vec2 v = ((line.offset - kNoise * region.speed) / line.squared_length) * line.normal;
      if (norm(v) > region.speed) continue;
      ASSERT_LE(excess(line, v), 2.0 * kNoise * region.speed);
            ASSERT_LE(sign_of_violation(p.constraints[line.binding.index].half_plane, v), 0);
      ++judged;
    }
  }
  EXPECT_GT(judged, 1000u);
}

TEST(LpRegion, SidesOfTheBoxAreLinesWithoutSlack) {
  Problem p;
  p.bound.box_x = 3.0;
  p.bound.box_y = 4.0;
  p.constraints.push_back({{{1.0, 0.0}, -9.0}, Priority::hard, -1});
  const Region region = region_of(p);
  ASSERT_EQ(region.lines.size(), 5U);
  EXPECT_EQ(region.speed, 5.0) << "the corner's";
  EXPECT_TRUE(std::isinf(region.disc));
  const Vec2 on_side[] = {{3.0, 1.0}, {-3.0, 1.0}, {1.0, 4.0}, {1.0, -4.0}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Line& side = region.lines[k + 1];
    EXPECT_EQ(side.binding, kBoxSides[k]);
    EXPECT_EQ(side.slack, 0.0);
    EXPECT_FALSE(side.soft);
    EXPECT_EQ(excess(side, on_side[k]), 0.0);
    EXPECT_GT(excess(side, 1.5 * on_side[k]), 0.0);
  }
}

TEST(LpRegion, WithoutABoundTheDataSayHowFastItMayGet) {
  Problem p;
  p.preferred = {3.0, -4.0};
  EXPECT_EQ(region_of(p).speed, 5.0);
  p.constraints.push_back({{{0.0, 2.0}, -30.0}, Priority::hard, -1});
  EXPECT_EQ(region_of(p).speed, 15.0) << "the line's distance";
  p.bound.disc = 1.0;
  EXPECT_EQ(region_of(p).speed, 1.0);
  EXPECT_GT(region_of(in_disc(0.0)).speed, 0.0) << "a slack of something";
}

TEST(LpRegion, ABasisKnowsItsMembers) {
  Basis basis;
  EXPECT_FALSE(basis.has(0));
  basis.add(4);
  basis.add(kDiscPosition);
  EXPECT_TRUE(basis.has(4));
  EXPECT_TRUE(basis.has(kDiscPosition));
  EXPECT_FALSE(basis.has(0)) << "what stands in a free place is no member";
}

TEST(LpRegion, MistakesNameTheConstraint) {
  const auto message = [](const Problem& p) {
    try {
      require_well_formed(p);
    } catch (const std::logic_error& mistake) {
      return std::string(mistake.what());
    }
    return std::string("none");
  };
  Problem p = in_disc(1.0);
  EXPECT_EQ(message(p), "none");
  p.constraints.assign(3, {{{1.0, 0.0}, -1.0}, Priority::hard, -1});
  p.constraints[2].half_plane.normal = {};
  EXPECT_NE(message(p).find("constraint 2"), std::string::npos);
  p.constraints[2].half_plane = {{1.0, 0.0}, kInfinity};
  EXPECT_NE(message(p).find("constraint 2"), std::string::npos);
  EXPECT_NE(message(in_disc(-1.0)).find("disc"), std::string::npos);
  EXPECT_NE(message(in_disc(std::nan(""))).find("disc"), std::string::npos);
  Problem farthest;
  farthest.objective = Objective::farthest;
  farthest.preferred = {1.0, 0.0};
  EXPECT_NE(message(farthest).find("bound"), std::string::npos);
  farthest.bound.disc = 1.0;
  EXPECT_EQ(message(farthest), "none");
  farthest.preferred = {};
  EXPECT_NE(message(farthest).find("direction"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::lp
