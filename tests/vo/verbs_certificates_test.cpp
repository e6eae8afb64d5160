// SPDX-License-Identifier: GPL-3.0-or-later
// The certificates that `vo` prints, and the verb `audit`, which judges them and recorded runs.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "vo/verb_vo.h"

namespace exactvo::test {
namespace {

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

TEST(VerbVo, TheCertificateIsOfTheHalfPlaneBesideItWhateverTheShare) {
  const std::string scene =
      "--obstacle '" + kSquare + "' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2 --responsibility 0.5";
  const json out = json_of(scene);
  expect_proven(out);
  EXPECT_NEAR(out.at("half_plane").at("offset").get<double>(), -0.75, 1e-12);
  const json& shared = out.at("shared_half_plane");
  EXPECT_NEAR(shared.at("half_plane").at("offset").get<double>(), -0.875, 1e-12);
  EXPECT_TRUE(shared.at("certificate").is_null());
  EXPECT_NE(words_of(scene).find("holds only if the other side takes the rest"), std::string::npos);
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
  place.write("notes", "Half-planes\nare fine.\n");
  for (const std::string bad : {"audit --certificate empty", "audit --certificate notes", "audit --certificate nofile",
                                "audit --certificate .", "audit", "audit --certificate one one"})
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

TEST(VerbAuditOfCertificates, TheClaimThatIsPrintedIsTheCertificatesOwn) {
  json one = json_of("--obstacle 'DISC(4 0, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2");
  const Workplace place;
  place.write("vo.json", one.dump());
  const std::string judged = place.run("audit --certificate vo.json").out;
  EXPECT_NE(judged.find("1: valid; -1 v_x +0 v_y >= -1.25 m/s, robot at (0, 0), radius 0.5 m, 2 s"), std::string::npos)
      << judged;
  one["half_plane"]["offset"] = -3.0;
  place.write("vo.json", one.dump());
  EXPECT_EQ(place.run("audit --certificate vo.json").out, judged);
}

TEST(VerbAuditOfCertificates, AnswersWithoutACertificateAreCounted) {
  const json overlap =
      json_of("--obstacle 'DISC(0.5 0, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2");
  json without = overlap;
  without["certificate"] = nullptr;
  EXPECT_EQ(judged(without).at("status"), 0);
  EXPECT_EQ(judged(without).at("none"), 1);
  EXPECT_EQ(judged(without).at("certificates"), 0);
  const Workplace place;
  place.write("none.json", without.dump());
  EXPECT_EQ(place.run("audit --certificate none.json").out, "0 certificates, 0 valid, 1 none\n");
  place.write("nothing.json", "{}");
  EXPECT_EQ(place.run("audit --certificate nothing.json").status, 2);
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
