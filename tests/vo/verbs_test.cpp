// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs `vo` and `audit` as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "exactvo/vo/certificate.h"
#include "tools/run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;

const std::string kSquare = "POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))";

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
