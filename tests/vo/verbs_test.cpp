// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs `vo` and `audit` as a user runs them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "tools/run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;

const std::string kSquare = "POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))";

json json_of(const std::string& arguments) {
  const Outcome run = Workplace().run("vo " + arguments + " --json");
  EXPECT_EQ(run.status, 0) << run.err;
  return json::parse(run.out);
}

std::string words_of(const std::string& arguments) {
  const Outcome run = Workplace().run("vo " + arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run.out;
}

TEST(VerbVo, PrintsEveryAnswerWithACertificateThatHolds) {
  for (const std::string enclose : {"none", "ellipse"}) {
    const Outcome run = Workplace().run("vo --obstacle '" + kSquare + "' --enclose " + enclose +
                                        " --position 0,0 --velocity 1,0.2 --radius 0.3 --time-horizon 3 --json");
    ASSERT_EQ(run.status, 0) << run.err;
    const json out = json::parse(run.out);
    EXPECT_FALSE(out.at("overlaps").get<bool>());
    EXPECT_TRUE(out.at("contains_velocity").get<bool>());
    EXPECT_EQ(out.at("legs").size(), 2u);
    EXPECT_LT(out.at("nearest_boundary").at("signed_distance").get<double>(), 0.0);
    EXPECT_EQ(out.at("u").size(), 2u);
    EXPECT_LE(out.at("half_plane").at("offset").get<double>(), 0.0);
    EXPECT_GT(out.at("stage_counts").at("filter").get<int>(), 0);
    const auto certificate = vo::read_certificate(out.at("certificate").at("text"));
    ASSERT_TRUE(certificate);
    EXPECT_EQ(check(*certificate), vo::Verdict::valid);
    EXPECT_EQ(certificate->claim.half_plane.offset, out.at("half_plane").at("offset").get<double>());
  }
}

TEST(VerbVo, ExactLegsCanBeChecked) {
  const Outcome run = Workplace().run(
      "vo --obstacle '" + kSquare + "' --position 0,0 --velocity 1,0 --radius 0 --time-horizon 3 --exact-legs --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json legs = json::parse(run.out).at("exact_legs");
  ASSERT_EQ(legs.size(), 2u);
  EXPECT_EQ(legs[0].at("polynomial"), json({"-1", "2"})) << "towards (2, 1)";
  EXPECT_EQ(legs[0].at("slope"), json({"1/2", "1/2"}));
  EXPECT_EQ(legs[1].at("polynomial"), json({"1", "2"}));
  EXPECT_EQ(legs[1].at("quarter_turns"), 0);
}

TEST(VerbVo, ConesThatShareALegAreListedTogether) {
  // Both pass the direction (2, 1), one on each side; the robot is a point.
  const Outcome run = Workplace().run(
      "vo --obstacle 'POLYGON((2 1, 3 -1, 4 -1, 2 1))' --obstacle 'POLYGON((6 3, 6 5, 4 4, 6 3))' --position 0,0 "
      "--velocity 1,0 --radius 0 --time-horizon 3 --free --max-speed 1 --exact-legs --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json out = json::parse(run.out);
  EXPECT_EQ(out.at("obstacles")[1].at("exact_legs").size(), 2u);
  const json order = out.at("legs_by_angle");
  ASSERT_EQ(order.size(), 3u);
  EXPECT_EQ(order[1], json::parse(R"([{"obstacle": 0, "cone": 0, "side": "left"},
                                     {"obstacle": 1, "cone": 0, "side": "right"}])"));
}

TEST(VerbVo, OverlapHasNoCone) {
  const Outcome run = Workplace().run("vo --obstacle '" + kSquare +
                                      "' --position 3,0 --velocity 1,0 --radius 0.3 --time-horizon 3 --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json out = json::parse(run.out);
  EXPECT_TRUE(out.at("overlaps").get<bool>());
  EXPECT_TRUE(out.at("legs").is_null());
  EXPECT_TRUE(out.at("half_plane").is_null());
}

TEST(VerbVo, BadNumbersAreNamed) {
  const auto with = [](const std::string& radius, const std::string& horizon, const std::string& velocity) {
    return Workplace().run("vo --obstacle '" + kSquare + "' --position 0,0 --velocity " + velocity +
                           " --radius=" + radius + " --time-horizon " + horizon);
  };
  EXPECT_EQ(with("-1", "3", "1,0").status, 2);
  EXPECT_EQ(with("nan", "3", "1,0").status, 2);
  EXPECT_EQ(with("0.3", "0", "1,0").status, 2);
  EXPECT_EQ(with("0.3", "inf", "1,0").status, 2);
  EXPECT_EQ(with("0.3", "3", "1").status, 2);
  EXPECT_NE(with("0.3", "0", "1,0").err.find("--time-horizon"), std::string::npos);
}

TEST(VerbVo, NumbersFarOutOfRangeAreNamed) {
  const auto with = [](const std::string& options) {
    const Outcome run = Workplace().run("vo --obstacle '" + kSquare + "' --position 0,0 --velocity 1,0 --radius 0.3 " +
                                        "--free --time-horizon 3 " + options);
    return std::to_string(run.status) + " " + run.err;
  };
  for (const std::string speed : {"1e120", "1e-300", "1e-310"})
    EXPECT_EQ(with("--max-speed " + speed).find("2 exactvo: error: --max-speed: found"), 0u) << speed;
  EXPECT_EQ(with("--max-speed 1 --obstacle-velocity 1e160,0").find("2 exactvo: error: --obstacle-velocity: found"), 0u);
  EXPECT_EQ(with("--max-speed 1 --obstacle 'LINESTRING(1e200 0, 2 0)'").find("2 exactvo: error: --obstacle: found"),
            0u);
}

TEST(VerbVo, APaperHorizonOfNothingIsNamed) {
  // The exact test says that the two are apart, by a distance that rounds to nothing.
  const std::string scene =
      "vo --obstacle 'LINESTRING(0.4 1.6, 0.5 4.5)' --position 0,0 --velocity 1,0 --radius 1.6492422502470643 ";
  const Outcome run = Workplace().run(scene + "--time-horizon paper");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("--time-horizon: found 'paper, which is 0 s"), std::string::npos) << run.err;
  EXPECT_EQ(Workplace().run(scene + "--time-horizon clamped").status, 0);
}

TEST(VerbVo, TheFamilyOfOneEncounter) {
  const Outcome run = Workplace().run("vo --obstacle '" + kSquare +
                                      "' --obstacle-velocity=-0.5,0 --position 0,0 --velocity 1,0.25 --radius 0.3 "
                                      "--time-horizon infinite --alpha 0.5 --variant all --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json out = json::parse(run.out);
  ASSERT_EQ(out.at("variants").size(), 5u);
  EXPECT_EQ(out.at("variants")[0].at("apex"), json({-0.5, 0.0}));
  EXPECT_EQ(out.at("variants")[1].at("apex"), json({0.25, 0.125}));
  EXPECT_TRUE(out.at("time_horizon").is_null()) << "JSON has no infinity";
  EXPECT_TRUE(out.at("variants")[4].contains("half_plane"));
  const auto certificate = vo::read_certificate(out.at("certificate").at("text"));
  ASSERT_TRUE(certificate);
  EXPECT_EQ(check(*certificate), vo::Verdict::valid);
  EXPECT_EQ(certificate->claim.shape_velocity.x, -0.5);
}

TEST(VerbVo, HorizonsByRule) {
  const auto horizon = [](const std::string& rule) {
    const Outcome run = Workplace().run("vo --obstacle '" + kSquare +
                                        "' --position 0,0 --velocity 0.5,0 --radius 0.5 --json --time-horizon " + rule);
    return json::parse(run.out).at("time_horizon");
  };
  EXPECT_EQ(horizon("paper"), 3.0);
  EXPECT_EQ(horizon("clamped"), 3.0);
  EXPECT_EQ(horizon("2.5"), 2.5);
}

TEST(VerbVo, ARuleTakesTheNearestPieceThatIsClear) {
  // On the first leg of the wall, 3.5 m before the second.
  const std::string on_a_wall =
      "--obstacle 'LINESTRING(0 0,4 0,4 4)' --position 0,0.1 --velocity 1,0 --radius 0.5 --time-horizon ";
  EXPECT_EQ(json_of(on_a_wall + "clamped").at("time_horizon"), 3.0);
  EXPECT_DOUBLE_EQ(json_of(on_a_wall + "paper").at("time_horizon").get<double>(), 3.5);
  EXPECT_EQ(json_of(on_a_wall + "2").at("time_horizon"), 2.0);
  for (const std::string rule : {"clamped", "paper"}) {
    const json inside =
        json_of("--obstacle '" + kSquare + "' --position 3,0 --velocity 1,0 --radius 0.5 --time-horizon " + rule);
    EXPECT_TRUE(inside.at("overlaps").get<bool>());
    EXPECT_TRUE(inside.at("time_horizon").is_null()) << "no piece to measure a horizon from";
    const json touching =
        json_of("--obstacle '" + kSquare + "' --position 1.5,0 --velocity 1,0 --radius 0.5 --time-horizon " + rule);
    EXPECT_TRUE(touching.at("time_horizon").is_null());
    EXPECT_EQ(touching.at("certificate").at("verdict"), "valid") << "for any time";
  }
}

TEST(VerbVo, APolygonalRobot) {
  const std::string rest = " --position 0,0 --velocity 1,0 --time-horizon 3 --json";
  const Outcome run =
      Workplace().run("vo --obstacle '" + kSquare + "' --robot 'POLYGON((-1 -1, 1 -1, 1 1, -1 1, -1 -1))'" + rest);
  ASSERT_EQ(run.status, 0) << run.err;
  const json out = json::parse(run.out);
  EXPECT_TRUE(out.at("contains_velocity").get<bool>());
  EXPECT_NEAR(out.at("half_plane").at("offset").get<double>(), -1.0 / 3.0, 1e-12) << "rims 1 m apart";
}

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

double next_up(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}

/// That the program reads the certificate and finds it changed.
void expect_caught(const std::string& text, const std::string& verdict) {
  EXPECT_TRUE(verdict == "wrong margin" || verdict == "altered") << verdict;
  const Workplace place;
  place.write("changed", text + "\n");
  const Outcome run = place.run("audit --certificate changed --json");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(json::parse(run.out).at("verdicts"), json::array({verdict}));
}

/// What `audit` says of JSON, with its exit status in "status".
json judged(const json& certificates) {
  const Workplace place;
  place.write("vo.json", certificates.dump());
  const Outcome run = place.run("audit --certificate vo.json --json");
  json out = json::parse(run.out);
  out["status"] = run.status;
  return out;
}

/// Whether the certificate is valid and of the half-plane beside it.
void expect_proven(const json& cone) {
  const auto certificate = vo::read_certificate(cone.at("certificate").at("text"));
  ASSERT_TRUE(certificate);
  EXPECT_EQ(check(*certificate), vo::Verdict::valid);
  EXPECT_EQ(certificate->claim.half_plane.offset, cone.at("half_plane").at("offset").get<double>());
  EXPECT_EQ(certificate->claim.half_plane.normal.x, cone.at("half_plane").at("normal")[0].get<double>());
}

TEST(VerbVo, TheCertificateIsOfTheHalfPlaneBesideItWhateverTheShare) {
  const std::string scene =
      "--obstacle '" + kSquare + "' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2 --alpha 0.5";
  const json out = json_of(scene);
  expect_proven(out);
  EXPECT_NEAR(out.at("half_plane").at("offset").get<double>(), -0.75, 1e-12);
  const json& shared = out.at("shared_half_plane");
  EXPECT_NEAR(shared.at("half_plane").at("offset").get<double>(), -0.875, 1e-12);
  EXPECT_TRUE(shared.at("certificate").is_null());
  EXPECT_NE(words_of(scene).find("holds only if the other side takes its share"), std::string::npos);
}

const std::string kCourtyard = "'POLYGON((0 0,10 0,10 10,0 10,0 0),(2 2,2 8,8 8,8 2,2 2))'";
const std::string kCorner = "'POLYGON((0 0,10 0,10 1,1 1,1 10,0 10,0 0))'";

TEST(VerbVo, AnObstacleThatIsNotConvexIsTakenByItsPieces) {
  const std::string in_court = "--obstacle " + kCourtyard + " --position 5,5 --radius 0.5 --time-horizon 2 ";
  const json rest = json_of(in_court + "--velocity 0,0");
  EXPECT_FALSE(rest.at("overlaps").get<bool>());
  EXPECT_FALSE(rest.at("contains_velocity").get<bool>());
  EXPECT_EQ(rest.at("taken_as").at("what"), "convex pieces");
  ASSERT_EQ(rest.at("cones").size(), rest.at("taken_as").at("convex_shapes").get<std::size_t>());
  for (const json& cone : rest.at("cones")) expect_proven(cone);
  EXPECT_NE(words_of(in_court + "--velocity 0,0").find("satisfies the half-planes of all pieces"), std::string::npos);
  const std::string in_wall =
      "--obstacle " + kCourtyard + " --position 1,5 --radius 0.5 --velocity 0,0 --time-horizon 2";
  EXPECT_TRUE(json_of(in_wall).at("overlaps").get<bool>());
  EXPECT_NE(words_of(in_wall).find("No velocity is proven safe"), std::string::npos);
  EXPECT_TRUE(json_of(in_court + "--velocity 2,0").at("contains_velocity").get<bool>()) << "the east wing, 2.5 m away";

  const std::string corner = "--obstacle " + kCorner + " --position 7,7 --velocity -1,-1 --radius 0.5 ";
  EXPECT_FALSE(json_of(corner + "--time-horizon 2").at("contains_velocity").get<bool>());
  EXPECT_TRUE(json_of(corner + "--time-horizon 7").at("contains_velocity").get<bool>());
  const std::string wall = "--obstacle 'LINESTRING(0 0, 4 0, 4 4)' --position 1,3 --radius 0.2 --time-horizon 9 ";
  EXPECT_FALSE(json_of(wall + "--velocity 0,0").at("overlaps").get<bool>());
  EXPECT_EQ(json_of(wall + "--velocity 0,0").at("cones").size(), 2u);
}

TEST(VerbVo, TheHullOnRequestSaysSo) {
  const std::string scene =
      "--obstacle " + kCourtyard + " --position 5,5 --radius 0.5 --velocity 0,0 --time-horizon 2 --pieces hull";
  const json out = json_of(scene);
  EXPECT_TRUE(out.at("overlaps").get<bool>());
  EXPECT_EQ(out.at("taken_as").at("what"), "convex hull");
  EXPECT_NE(words_of(scene).find("touches or overlaps its convex hull"), std::string::npos);
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
  EXPECT_NE(words_of(scene).find("nothing is free, nothing is kept"), std::string::npos);
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
  EXPECT_NE(words_of(two_fronts("-2")).find("(m/s)^2, in 2 pieces; what half-planes keep is free: yes"),
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
      EXPECT_EQ(arcs[k].contains("radius"), kind == "front arc" || kind == "speed circle") << kind;
      EXPECT_EQ(arcs[k].at("cone").is_null(), kind == "speed circle");
      kinds += kind + " of " + arcs[k].at("obstacle").dump() + ", ";
    }
  }
  EXPECT_NE(kinds.find("offset edge of 0, "), std::string::npos) << kinds;
  EXPECT_NE(kinds.find("front arc of 1, "), std::string::npos) << kinds;
  EXPECT_NE(kinds.find("leg of 1, "), std::string::npos) << kinds;
}

TEST(VerbVo, WhatIsNotExactSaysWhy) {
  const auto why = [](const std::string& obstacles, const std::string& reason) {
    const std::string scene =
        obstacles + " --position 0,0 --velocity 0,0 --radius 0.5 --time-horizon 2 --free --max-speed 1";
    const json out = json_of(scene);
    EXPECT_TRUE(out.at("exact").is_null());
    EXPECT_EQ(out.at("why_not_exact"), reason);
    EXPECT_NE(words_of(scene).find("exactly           not shown: " + reason), std::string::npos);
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

TEST(VerbVo, BareContactHasAHalfPlaneWithItsProof) {
  const json out =
      json_of("--obstacle '" + kSquare + "' --position 1.5,0 --radius 0.5 --velocity 1,0 --time-horizon 2");
  EXPECT_TRUE(out.at("overlaps").get<bool>());
  EXPECT_TRUE(out.at("half_plane").is_null());
  EXPECT_EQ(out.at("contact_half_plane").at("offset"), 0.0);
  EXPECT_EQ(out.at("certificate").at("verdict"), "valid");
}

TEST(VerbVo, DiscsAndEllipsesByTheirNumbers) {
  const std::string rest = " --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2";
  const json disc = json_of("--obstacle 'DISC(4 0, 1)'" + rest);
  EXPECT_NEAR(disc.at("half_plane").at("offset").get<double>(), -1.25, 1e-12) << "2.5 m in 2 s";
  expect_proven(disc);
  const json ellipse = json_of("--obstacle 'ellipse (4 1.5, 1.3 0.3 0.5)'" + rest);
  EXPECT_EQ(ellipse.at("shape").get<std::string>(), geometry::to_string(geometry::Ellipse{{4.0, 1.5}, 1.3, 0.3, 0.5}));
  expect_proven(ellipse);
  const json turned = json_of("--obstacle 'ELLIPSE(4 0, 1 2, 90)'" + rest);
  EXPECT_NEAR(turned.at("half_plane").at("offset").get<double>(), -0.75, 1e-9) << "2 m towards the robot";
  const json two = json_of("--obstacle 'DISC(4 0, 1)' --obstacle 'DISC(-4 0, 1)' --free --max-speed 2" + rest);
  EXPECT_EQ(two.at("obstacles").size(), 2u);
  for (const std::string bad : {"DISC(4 0, -1)", "DISC(4 0)", "DISC(4 0, 1", "DISC(4, 0, 1)", "ELLIPSE(4 0, 1)",
                                "ELLIPSE(4 0, -1 1, 0)", "DISC(4 0, nan)", "DISC(4 0, 1x)", "DISC(4 0, 1e40)"}) {
    const Outcome run = Workplace().run("vo --obstacle '" + bad + "'" + rest);
    EXPECT_EQ(run.status, 2) << bad;
    EXPECT_EQ(run.err.find("exactvo: error: --obstacle: found"), 0u) << run.err;
  }
  EXPECT_EQ(Workplace().run("vo --obstacle 'DISC(4 0, 1)' --enclose ellipse" + rest).status, 2);
}

TEST(VerbVo, AnEllipseRoundAnObstacleSaysThatItContainsIt) {
  const std::string scene =
      "--obstacle '" + kSquare + "' --enclose ellipse --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2";
  const json taken = json_of(scene).at("taken_as");
  EXPECT_EQ(taken.at("what"), "smallest ellipse");
  EXPECT_EQ(taken.at("vertices"), 4);
  EXPECT_EQ(taken.at("contained"), 4);
  EXPECT_NE(words_of(scene).find("contains 4 of its 4 vertices exactly, certificate: valid"), std::string::npos);
  const Workplace place;
  const std::string text = taken.at("certificate").at("text");
  place.write("one", text + "\n");
  EXPECT_EQ(place.run("audit --certificate one").status, 0);
  place.write("vo.json", place.run("vo " + scene + " --json").out);
  EXPECT_EQ(json::parse(place.run("audit --certificate vo.json --json").out).at("valid"), 2) << "and the half-plane";
}

TEST(VerbAuditOfCertificates, AContainmentChangedByAnUlpIsCaught) {
  const json taken = json_of("--obstacle '" + kSquare +
                             "' --enclose ellipse --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2")
                         .at("taken_as");
  const auto made = vo::read_containment(taken.at("certificate").at("text"));
  ASSERT_TRUE(made);
  vo::Containment moved = *made, easier = *made, smaller = *made;
  moved.points[0].x = next_up(moved.points[0].x);
  easier.margin = next_up(easier.margin);
  smaller.ellipse.l11 = std::nextafter(smaller.ellipse.l11, 0.0);
  for (const vo::Containment& changed : {moved, easier, smaller})
    expect_caught(write_containment(changed), name(check(changed)));
}

TEST(VerbVo, WhatWouldBeIgnoredIsRefused) {
  const std::string scene = "vo --obstacle '" + kSquare + "' --position 0,0 --velocity 1,0 --time-horizon 2 ";
  const auto refusal = [&](const std::string& options) {
    const Outcome run = Workplace().run(scene + options);
    EXPECT_EQ(run.status, 2) << options;
    EXPECT_TRUE(run.out.empty()) << options;
    return run.err;
  };
  const std::string robot = "--robot 'POLYGON((-1 -1, 1 -1, 1 1, -1 1, -1 -1))'";
  EXPECT_NE(refusal("").find("--radius: found 'nothing'"), std::string::npos);
  EXPECT_NE(refusal("--radius 1 " + robot).find("--radius"), std::string::npos);
  EXPECT_NE(refusal("--radius 1 --max-speed 1").find("--free"), std::string::npos);
  EXPECT_NE(refusal("--radius 1 --free").find("--max-speed: found 'nothing'"), std::string::npos);
  EXPECT_NE(refusal("--radius 1 --pieces hull --enclose ellipse").find("--pieces"), std::string::npos);
  EXPECT_NE(refusal("--robot " + kCorner).find("not convex"), std::string::npos);
  EXPECT_NE(refusal("--robot " + kCourtyard).find("not convex"), std::string::npos);
  EXPECT_NE(refusal("--radius 1 --goal 1,1").find("--goal"), std::string::npos);
}

TEST(VerbVo, ObstaclesThatAreNoneAreNamed) {
  const auto refusal = [](const std::string& obstacle) {
    const Outcome run = Workplace().run(obstacle + " --position 0,0 --velocity 1,0 --radius 1 --time-horizon 2");
    EXPECT_EQ(run.status, 2) << obstacle;
    return run.err;
  };
  EXPECT_NE(refusal("vo --obstacle nofile.wkt").find("a file that is there"), std::string::npos);
  EXPECT_NE(refusal("vo --obstacle 'DISK(3 0, 1)'").find("DISC(x y, r)"), std::string::npos);
  EXPECT_NE(refusal("vo --obstacle 'POINT(3 0)'").find("a point is no obstacle"), std::string::npos);
  const std::string mistyped = refusal("vo --obstcle x");
  EXPECT_NE(mistyped.find("--obstcle means nothing; did you mean '--obstacle'?"), std::string::npos) << mistyped;
}

TEST(VerbVo, EveryFieldIsSaidToBeExactCertifiedOrRounded) {
  const json out = json_of("--obstacle '" + kSquare +
                           "' --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2 --alpha 0.5 --variant all");
  std::string all;
  for (const json& kind : out.at("kinds"))
    for (const json& field : kind) all += " " + field.get<std::string>() + " ";
  for (const auto& [key, value] : out.items()) {
    if (key == "kinds" || key == "time_horizon" || key == "stage_counts" || key == "legs") continue;
    EXPECT_NE(all.find(" " + key + " "), std::string::npos) << key;
  }
}

TEST(VerbVo, FiguresShowTheVelocityBesideALongConeAndWhatAnEllipseEncloses) {
  Workplace place;
  const std::string rest = " --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2 --figure ";
  ASSERT_EQ(place.run("vo --obstacle 'LINESTRING(2 -200, 2 200)'" + rest + "needle.svg").status, 0);
  const std::string script = place.read("needle.gp");
  const std::size_t range = script.find("set xrange [");
  ASSERT_NE(range, std::string::npos);
  double low = 0.0, high = 0.0;
  ASSERT_EQ(std::sscanf(script.c_str() + range, "set xrange [%lf:%lf]", &low, &high), 2);
  EXPECT_LT(high - low, 10.0) << "a velocity of 1 m/s is to be seen";
  ASSERT_EQ(place.run("vo --obstacle '" + kSquare + "' --enclose ellipse" + rest + "ellipse.svg").status, 0);
  EXPECT_NE(place.read("ellipse.gp").find("the obstacle / tau, not grown"), std::string::npos);
}

TEST(VerbVo, UIsAChangeOnlyWhereOneIsNeeded) {
  const std::string scene = "--obstacle '" + kSquare + "' --position 0,0 --radius 0.5 --time-horizon 2 --velocity ";
  EXPECT_NE(words_of(scene + "1,0").find("the least change that avoids it"), std::string::npos);
  EXPECT_NE(words_of(scene + "-1,0").find("to that boundary; no change is needed"), std::string::npos);
}

TEST(VerbAuditOfCertificates, JudgesTextsAndWhatVoPrints) {
  Workplace place;
  const std::string vo = "vo --obstacle " + kCourtyard + " --position 5,5 --radius 0.5 --velocity 0,0 --time-horizon 2";
  const Outcome made = place.run(vo + " --json");
  ASSERT_EQ(made.status, 0) << made.err;
  place.write("vo.json", made.out);
  const Outcome whole = place.run("audit --certificate vo.json --json");
  EXPECT_EQ(whole.status, 0) << whole.out << whole.err;
  const std::size_t count = json::parse(made.out).at("cones").size();
  EXPECT_EQ(json::parse(whole.out).at("valid").get<std::size_t>(), count);

  const std::string text = json::parse(made.out).at("cones")[0].at("certificate").at("text");
  place.write("one", text + "\n");
  EXPECT_EQ(place.run("audit --certificate - < one").status, 0);
  vo::Certificate changed = *vo::read_certificate(text);
  changed.claim.half_plane.offset = std::nextafter(changed.claim.half_plane.offset, -1.0);
  place.write("changed", text + "\n" + write_certificate(changed) + "\nhalf-plane-certificat 1\n");
  const Outcome run = place.run("audit --certificate changed");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.out.find("2: wrong margin"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("3: not a certificate"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("3 certificates, 1 valid"), std::string::npos) << run.out;
  place.write("empty", "");
  for (const std::string bad : {"audit --certificate empty", "audit --certificate nofile", "audit --certificate .",
                                "audit", "audit --certificate one one"})
    EXPECT_EQ(place.run(bad).status, 2) << bad;
}

TEST(VerbAuditOfCertificates, AHalfPlaneChangedByAnUlpIsCaught) {
  const json out = json_of("--obstacle 'DISC(4 0.5, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2");
  const auto made = vo::read_certificate(out.at("certificate").at("text"));
  ASSERT_TRUE(made);
  vo::Certificate turned = *made, later = *made, easier = *made, digest = *made;
  turned.claim.half_plane.normal.x = next_up(turned.claim.half_plane.normal.x);
  later.claim.time_horizon = next_up(later.claim.time_horizon);
  easier.margin = next_up(easier.margin);
  digest.digest ^= 1;
  for (const vo::Certificate& changed : {turned, later, easier, digest})
    expect_caught(write_certificate(changed), name(check(changed)));
}

TEST(VerbAuditOfCertificates, InJsonNoneIsPassedOver) {
  const json whole = json_of("--obstacle '" + kSquare +
                             "' --enclose ellipse --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2");
  EXPECT_EQ(judged(whole).at("status"), 0);
  EXPECT_EQ(judged(whole).at("verdicts"), json({"valid", "valid"}));
  EXPECT_EQ(judged(whole).at("none"), 0);

  for (const std::string beginning : {"half-plane-certificat3 1", "", "?"}) {
    json damaged = whole;
    damaged["certificate"]["text"] = beginning + std::string(whole["certificate"]["text"]).substr(24);
    EXPECT_EQ(judged(damaged).at("status"), 1) << beginning;
    EXPECT_EQ(judged(damaged).at("certificates"), 2) << beginning;
    EXPECT_EQ(judged(damaged).at("valid"), 1) << beginning;
  }
  for (const json& no_text : {json(7), json::object(), json({{"text", nullptr}}), json("text")}) {
    json damaged = whole;
    damaged["certificate"] = no_text;
    EXPECT_EQ(judged(damaged).at("status"), 1) << no_text;
  }
  json without = whole;
  without["certificate"] = nullptr;
  EXPECT_EQ(judged(without).at("none"), 1);
  EXPECT_EQ(judged(without).at("certificates"), 1);
  EXPECT_EQ(judged(json::array({whole["certificate"]["text"]})).at("valid"), 1) << "a list of texts";
}

TEST(VerbAuditOfCertificates, TheEllipseMustBeTheOneBesideIt) {
  const std::string rest = "' --enclose ellipse --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2";
  json one = json_of("--obstacle '" + kSquare + rest);
  const json other = json_of("--obstacle 'POLYGON((2 -1, 4 -1, 4 1.5, 2 1, 2 -1))" + rest);
  one["certificate"] = other["certificate"];
  EXPECT_EQ(judged(one).at("status"), 1);
  EXPECT_EQ(judged(one).at("valid"), 1) << "each is valid for itself";
  EXPECT_NE(judged(one).dump().find("of another ellipse"), std::string::npos);
}

TEST(VerbAuditOfCertificates, JsonThatCannotBeReadIsNotValid) {
  Workplace place;
  const std::string text =
      json_of("--obstacle '" + kSquare + "' --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2").dump();
  const std::string deep(100000, '[');
  for (const std::string& bad : {text.substr(0, text.size() - 1), text + "]", deep, deep + std::string(100000, ']')}) {
    place.write("bad.json", bad);
    const Outcome run = place.run("audit --certificate bad.json");
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.out, "1: unreadable JSON\n1 certificate, 0 valid\n");
  }
}

class VerbAudit : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome run = place_.run("simulate " + data_file("paper/A11.json") + " --method ivo --out out --no-figures");
    ASSERT_EQ(run.status, 0) << run.err;
  }
  Workplace place_;
};

TEST_F(VerbAudit, ARunIsClean) {
  const Outcome run = place_.run("audit out --json");
  ASSERT_EQ(run.status, 0) << run.out << run.err;
  const json out = json::parse(run.out);
  EXPECT_GT(out.at("half_planes").get<int>(), 0);
  EXPECT_EQ(out.at("unsafe").get<int>(), 0);
  EXPECT_GT(out.at("steps").get<int>(), 100);
  EXPECT_EQ(out.at("collisions").get<int>(), 0);
}

TEST_F(VerbAudit, ADigitChangedIsCaught) {
  std::string changed = place_.read("out/recording.jsonl");
  const std::size_t at = changed.find("\"offset\":-", changed.find('\n'));
  ASSERT_NE(at, std::string::npos);
  const std::size_t digit = changed.find_first_of("123456789", at);
  changed[digit] = changed[digit] == '1' ? '2' : '1';
  place_.write("out/recording.jsonl", changed);
  EXPECT_EQ(place_.run("audit out").status, 1);
}

TEST_F(VerbAudit, AFolderWithoutRecordingsIsAMistake) {
  std::filesystem::remove(place_.path() / "out/recording.jsonl");
  EXPECT_EQ(place_.run("audit out").status, 2);
}

}  // namespace
}  // namespace exactvo::test
