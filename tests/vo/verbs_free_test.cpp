// SPDX-License-Identifier: GPL-3.0-or-later
// `vo --free`: what several obstacles leave, between two bounds and exactly.
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

/// Discs of radius 1, one from either side: their fronts, of radius 1 too, are `gap` apart at the velocity 0.
std::string two_fronts(const std::string& gap) {
  return "--obstacle 'DISC(3 0, 1)' --obstacle 'DISC(-3 0, 1)' --obstacle-velocity=" + gap +
         ",0 --obstacle-velocity 2,0 --position 0,0 --velocity 0,1 --radius 0 --time-horizon 1 --free --max-speed 2";
}

TEST(VerbVo, FrontsThatTouchPartWhatIsFreeExactly) {
  const json touching = json_of(two_fronts("-2"));
  const json& exact = touching.at("exact");
  EXPECT_EQ(exact.at("components"), 2);
  EXPECT_EQ(exact.at("pieces").size(), 2u);
  EXPECT_TRUE(touching.at("why_not_exact").is_null());
  EXPECT_EQ(exact.at("region_inside"), "yes");
  EXPECT_LE(touching.at("area")[0], exact.at("area")[0]);
  EXPECT_GE(touching.at("area")[1], exact.at("area")[1]);
  EXPECT_LT(exact.at("area")[1].get<double>() - exact.at("area")[0].get<double>(), 0x1p-40);
  EXPECT_EQ(json_of(two_fronts("-1.9999999999999998")).at("exact").at("components"), 1) << "an ulp apart";
  EXPECT_NE(words_of(two_fronts("-2")).find("(m/s)^2, 2 connected parts; all that the half-planes allow is free: yes"),
            std::string::npos);
}

TEST(VerbVo, TheArcsOfAnExactPieceSayWhoseTheyAreAndJoin) {
  const json out =
      json_of("--obstacle " + kCourtyard + " --obstacle 'DISC(6.5 5, 0.25)' --position 5,5 --radius 0.25 " +
              "--velocity 0,0 --time-horizon 2 --free --max-speed 2");
  std::string kinds;
  for (const json& piece : out.at("exact").at("pieces")) {
    const json& arcs = piece.at("arcs");
    for (std::size_t k = 0; k < arcs.size(); ++k) {
      EXPECT_EQ(arcs[k].at("to"), arcs[(k + 1) % arcs.size()].at("from"));
      const std::string kind = arcs[k].at("kind");
      EXPECT_EQ(arcs[k].contains("radius"), kind == "cut-off arc" || kind == "speed circle") << kind;
      EXPECT_EQ(arcs[k].at("cone").is_null(), kind == "speed circle");
      kinds += kind + " of " + arcs[k].at("obstacle").dump() + ", ";
    }
  }
  EXPECT_NE(kinds.find("offset edge of 0, "), std::string::npos) << kinds;
  EXPECT_NE(kinds.find("cut-off arc of 1, "), std::string::npos) << kinds;
  EXPECT_NE(kinds.find("leg of 1, "), std::string::npos) << kinds;
}

TEST(VerbVo, WhatIsNotExactSaysWhy) {
  const auto why = [](const std::string& obstacles, const std::string& reason) {
    const std::string scene =
        obstacles + " --position 0,0 --velocity 0,0 --radius 0.5 --time-horizon 2 --free --max-speed 1";
    const json out = json_of(scene);
    EXPECT_TRUE(out.at("exact").is_null());
    EXPECT_EQ(out.at("why_not_exact"), reason);
    EXPECT_NE(words_of(scene).find("exact result      none: " + reason), std::string::npos);
  };
  why("--obstacle 'DISC(4 0, 1)' --obstacle 'ELLIPSE(-4 0, 2 0 1)'",
      "obstacle 1 takes part as an ellipse, whose offset has degree eight");
  why("--obstacle 'DISC(1.5 0, 1)'", "the robot touches or overlaps obstacle 0");
  std::string many;
  for (int k = 0; k < 65; ++k) many += "--obstacle 'DISC(4 " + std::to_string(k) + ", 0.25)' ";
  why(many, "65 convex shapes, more than 64");
  why("--obstacle 'DISC(3 3, 1e-300)'", "a number of the scene is neither 0 nor between 2^-60 and 2^30");
  // On a parabola all of whose vertices face the robot: 280 edges, 281 arcs, 2 legs. The text is too long for a file's
  // name, which is no mistake.
  std::string parabola;
  for (int k = -140; k <= 140; ++k)
    parabola += std::to_string(4.0 + k * k / 32768.0) + " " + std::to_string(k / 64.0) + ", ";
  why("--obstacle 'POLYGON((" + parabola + parabola.substr(0, parabola.find(',')) + "))'",
      "563 boundary curves, more than 512");
}

}  // namespace
}  // namespace exactvo::test
