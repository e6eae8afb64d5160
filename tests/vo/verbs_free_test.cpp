// SPDX-License-Identifier: GPL-3.0-or-later
// `vo --free`: what several obstacles leave, between two bounds.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "vo/verb_vo.h"

namespace exactvo::test {
namespace {

TEST(VerbVo, FreeVelocitiesOfSeveralObstacles) {
  Workplace place;
  const std::string scene = "vo --obstacle '" + kSquare + "' --obstacle 'POLYGON((-4 -1, -2 -1, -2 1, -4 1, -4 -1))'" +
                            " --position 0,0 --velocity 0,1 --radius 0.5 --time-horizon 4";
  const Outcome run = place.run(scene + " --free --max-speed 1.5 --json --figure free.svg");
  ASSERT_EQ(run.status, 0) << run.err;
  const json out = json::parse(run.out);
  EXPECT_EQ(out.at("obstacles").size(), 2u);
  EXPECT_TRUE(out.at("velocity_is_free").get<bool>());
  EXPECT_EQ(out.at("region").at("inside"), "yes");
  EXPECT_LE(out.at("area")[0], out.at("area")[1]);
  EXPECT_LT(out.at("region").at("area")[1], out.at("area")[0]);
  EXPECT_FALSE(out.at("region").at("lost").empty());
  EXPECT_TRUE(std::filesystem::exists(place.path() / "free.gp"));
  EXPECT_EQ(place.run(scene + " --json").status, 2) << "several obstacles go with --free";
  EXPECT_EQ(place.run(scene + " --free --json").status, 2) << "without a speed";
}

TEST(VerbVo, FreeVelocitiesWithinACourtyard) {
  const json out = json_of("--obstacle " + kCourtyard +
                           " --position 5,5 --radius 0.5 --velocity 0.5,0 --time-horizon 2 --free --max-speed 1");
  EXPECT_GT(out.at("area")[0].get<double>(), 3.14) << "no wall is reached in 2 s";
  EXPECT_TRUE(out.at("velocity_is_free").get<bool>());
  EXPECT_EQ(out.at("region").at("inside"), "yes");
  for (const json& cone : out.at("obstacles")[0].at("cones")) expect_proven(cone);
}

TEST(VerbVo, FreeOnTheObstacleKeepsNothing) {
  const std::string scene =
      "--obstacle '" + kSquare + "' --position 3,0 --radius 0.3 --velocity 1,0 --time-horizon 2 --free --max-speed 1";
  EXPECT_TRUE(json_of(scene).at("region").is_null());
  EXPECT_EQ(json_of(scene).at("area")[1].get<double>(), 0.0);
  EXPECT_NE(words_of(scene).find("an obstacle: no velocity is free"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::test
