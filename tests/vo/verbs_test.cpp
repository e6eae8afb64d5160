// SPDX-License-Identifier: GPL-3.0-or-later
// The verb `vo` as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "exactvo/vo/certificate.h"
#include "vo/verb_vo.h"

namespace exactvo::test {
namespace {

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
  const std::string far = with("--max-speed 1 --obstacle 'LINESTRING(1e200 0, 2 0)'");
  EXPECT_EQ(far.find("2 exactvo: error: --obstacle: line 1, column 1, ring 0, vertex 0: found"), 0u) << far;
  EXPECT_NE(far.find("[E_RANGE]"), std::string::npos) << far;
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

TEST(VerbVo, AnInfiniteHorizonIsNullAndProven) {
  const Outcome run = Workplace().run("vo --obstacle '" + kSquare +
                                      "' --obstacle-velocity=-0.5,0 --position 0,0 --velocity 1,0.25 --radius 0.3 "
                                      "--time-horizon infinite --responsibility 0.5 --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json out = json::parse(run.out);
  EXPECT_TRUE(out.at("time_horizon").is_null()) << "JSON has no infinity";
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

TEST(VerbVo, BareContactHasAHalfPlaneWithItsProof) {
  const json out =
      json_of("--obstacle '" + kSquare + "' --position 1.5,0 --radius 0.5 --velocity 1,0 --time-horizon 2");
  EXPECT_TRUE(out.at("overlaps").get<bool>());
  EXPECT_TRUE(out.at("half_plane").is_null());
  EXPECT_EQ(out.at("contact_half_plane").at("offset"), 0.0);
  EXPECT_EQ(out.at("certificate").at("verdict"), "valid");
}

TEST(VerbVo, HorizonsOutOfRangeAreRefused) {
  const auto with = [](const std::string& options) {
    return Workplace().run("vo --obstacle 'DISC(4 0, 1)' --radius 0.5 " + options);
  };
  const std::string here = "--position 0,0 --velocity 1,0 --time-horizon ";
  for (const std::string& bad : {here + "1e-320", here + "7.8e-31", here + "1.3e30",
                                 std::string("--position 1e15,0.1 --velocity 1,0 --time-horizon 1e-300"),
                                 std::string("--position 0,0 --velocity 1e-40,0 --time-horizon paper")}) {
    EXPECT_EQ(with(bad).status, 2) << bad;
    EXPECT_NE(with(bad).err.find("a time from 2^-100 s to 2^100 s"), std::string::npos) << with(bad).err;
  }
  for (const char* good : {"7.888609052210118e-31", "1.2676506002282294e30", "infinite"}) {
    const Outcome run = with(here + good + " --json");
    ASSERT_EQ(run.status, 0) << good << run.err;
    expect_proven(json::parse(run.out));
  }
}

TEST(VerbVo, TheReasonForAMissingCertificateIsPrinted) {
  const std::string rest = " --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2";
  const std::string far = "--obstacle 'POLYGON((10 0,1e30 0,1e30 1e30,10 0))'" + rest;
  EXPECT_TRUE(json_of(far).at("certificate").is_null());
  EXPECT_EQ(json_of(far).at("why_no_certificate"), "rounding");
  EXPECT_NE(words_of(far).find("certificate       none: rounding"), std::string::npos);
  EXPECT_TRUE(json_of("--obstacle 'DISC(4 0, 1)'" + rest).at("why_no_certificate").is_null());
  EXPECT_EQ(json_of("--obstacle 'DISC(0.5 0, 1)'" + rest).at("why_no_certificate"), "contact");
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
  for (const char* shape :
       {"TRIANGLE((3 0,4 0,4 1,3 0))", "LINEARRING(3 0,4 0,4 1,3 0)", "SRID=28992;POLYGON((3 0,4 0,4 1,3 0))"})
    EXPECT_EQ(
        Workplace()
            .run("vo --obstacle '" + std::string(shape) + "' --position 0,0 --velocity 1,0 --radius 1 --time-horizon 2")
            .status,
        0)
        << shape;
  EXPECT_NE(refusal("vo --obstacle 'DISK(3 0, 1)'").find("DISC(x y, r)"), std::string::npos);
  EXPECT_NE(refusal("vo --obstacle 'POINT(3 0)'").find("a point is no obstacle"), std::string::npos);
  const std::string mistyped = refusal("vo --obstcle x");
  EXPECT_NE(mistyped.find("unknown option '--obstcle'; did you mean '--obstacle'?"), std::string::npos) << mistyped;
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
  EXPECT_NE(place.read("ellipse.gp").find("obstacle divided by τ, not grown"), std::string::npos);
  for (const char* figure : {"needle.gp", "ellipse.gp"})
    EXPECT_NE(place.read(figure).find("hatched side: forbidden"), std::string::npos) << figure;
}

/// The rows of every data set with this title.
std::vector<std::vector<double>> rows_of(const std::string& data, const std::string& title) {
  std::vector<std::vector<double>> rows;
  std::istringstream in(data);
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("# ", 0) == 0 && line.find(": ") != std::string::npos)
      inside = line.substr(line.find(": ") + 2) == title;
    std::istringstream numbers(line);
    std::vector<double> row;
    for (double x = 0.0; numbers >> x;) row.push_back(x);
    if (inside && !row.empty()) rows.push_back(row);
  }
  return rows;
}

TEST(VerbVo, FiguresHatchTheForbiddenSideOfHalfPlanes) {
  const Workplace place;
  const std::string rest = " --position 0,0 --velocity 1,0.2 --radius 0.3 --time-horizon 2 --json --figure a.svg";
  const Outcome outcome = place.run("vo --obstacle '" + kSquare + "'" + rest);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json h = json::parse(outcome.out)["half_plane"];
  const auto side = [&](const std::vector<double>& p) {
    return h["normal"][0].get<double>() * p[0] + h["normal"][1].get<double>() * p[1] - h["offset"].get<double>();
  };
  const auto strokes = rows_of(place.read("a.dat"), "half-plane: hatching on the forbidden side");
  ASSERT_GE(strokes.size(), 20u);
  ASSERT_EQ(strokes.size() % 2, 0u);
  for (std::size_t i = 0; i < strokes.size(); i += 2) {
    EXPECT_NEAR(side(strokes[i]), 0.0, 1e-6) << "it begins on the boundary";
    EXPECT_LT(side(strokes[i + 1]), -1e-3) << "it ends on the forbidden side";
  }
}

TEST(VerbVo, UIsAChangeOnlyWhereOneIsNeeded) {
  const std::string scene = "--obstacle '" + kSquare + "' --position 0,0 --radius 0.5 --time-horizon 2 --velocity ";
  EXPECT_NE(words_of(scene + "1,0").find("the least change that avoids it"), std::string::npos);
  EXPECT_NE(words_of(scene + "-1,0").find("to that boundary; no change is needed"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::test
