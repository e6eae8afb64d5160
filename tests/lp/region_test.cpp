// SPDX-License-Identifier: GPL-3.0-or-later
// The speeds that can occur in a problem, and the problems that are refused.
#include "lp/problem/region.h"
#include "exactvo/geometry/infinity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace exactvo::lp {
namespace {

using geometry::kInfinity;

Problem in_disc(double disc) {
  Problem p;
  p.bound.disc = disc;
  return p;
}

TEST(LpRegion, WithoutABoundTheDataSayHowFastItMayGet) {
  Problem p;
  p.preferred = {3.0, -4.0};
  EXPECT_EQ(largest_speed(p), 5.0);
  p.constraints.push_back({{{0.0, 2.0}, -30.0}, Priority::hard, -1});
  EXPECT_EQ(largest_speed(p), 15.0) << "the line's distance";
  p.bound.disc = 1.0;
  EXPECT_EQ(largest_speed(p), 1.0);
  EXPECT_GT(largest_speed(in_disc(0.0)), 0.0) << "a slack of something";
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
