// SPDX-License-Identifier: GPL-3.0-or-later
// The verb `check` as a user meets it: events, findings, maps, footprints, certificates, long files, bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A and B are 7 m apart at their rows, and meet between them; C passes by A at 0.4 m.
constexpr const char* kCrossing =
    "t,id,x,y\n0,A,0,0\n0,B,5,-5\n1,A,10,0\n1,B,5,5\n2,A,10,0\n2,C,9,0.9\n3,C,11,0.9\n3,A,10,0\n";

std::vector<json> json_lines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

Outcome checked(const std::string& text, const std::string& arguments) {
  const Workplace here;
  here.write("t.csv", text);
  return here.run("check t.csv " + arguments);
}

TEST(CheckVerb, APageAndCertificatesAreTwoFiles) {
  const Outcome same = checked(kCrossing, "--radius 0.25 --page x.html --certificates ./x.html");
  EXPECT_EQ(same.status, 2);
  EXPECT_THAT(same.err, HasSubstr("another file than --certificates writes"));
}

// A decimal comma makes a row longer than the header.
TEST(CheckVerb, RowsThatAreLongerThanTheHeaderAreRefused) {
  const Outcome longer = checked("t,id,x,y\n0,A,0,5,0,5\n0,B,0,6,0,5\n", "--radius 0.2");
  EXPECT_EQ(longer.status, 2);
  EXPECT_THAT(longer.err, AllOf(HasSubstr("6 fields"), HasSubstr("4 fields, as the header has")));
  EXPECT_EQ(checked("t,id,x,y\n0,A,0,5,\n1,A,0,6,\n", "--radius 0.2").status, 0) << "a comma at the end of each row";
}

TEST(CheckVerb, ColumnsMayBeQuoted) {
  const Outcome outcome = checked("\"t\",\"id\",\"x\",\"y\"\n0,\"A, b\",0,0\n1,\"A, b\",1,0\n", "--radius 0.1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("greatest speed: 1 m/s, A, b at 0 s"));
  // A row of units, as some programs write it.
  EXPECT_THAT(checked("\"t\",\"id\",\"x\",\"y\"\n\"s\",\"\",\"m\",\"m\"\n0,A,0,0\n", "--radius 0.1").err,
              HasSubstr("line 2: found \"s\", expected a number as a time"));
}

TEST(CheckVerb, DiscsOfAScenarioAreExact) {
  const Workplace here;
  here.write("sc.json", R"({"name": "s", "robots": [{"id": "r", "position": [9, 9], "goal": [9, 8]}],
    "obstacles": [{"id": "post", "disc": {"centre": [0, 0], "radius": 0.8}}]})");
  here.write("t.csv", "t,id,x,y\n0,A,-5,1.2025\n1,A,5,1.2025\n");
  EXPECT_EQ(here.run("check t.csv --radius 0.4 --map sc.json").status, 0);
  EXPECT_EQ(here.run("check t.csv --radius 0.403 --map sc.json").status, 1);
}

TEST(CheckVerb, AMapWithoutObstaclesIsNamed) {
  const Workplace here;
  here.write("t.csv", kCrossing);
  here.write("pt.wkt", "POINT(1.5 0)\n");
  const Outcome outcome = here.run("check t.csv --radius 0.1 --map pt.wkt");
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1 feature skipped"), HasSubstr("no obstacle in it")));
}

// --- Events ---

TEST(CheckVerb, FindsWhatHappensBetweenTwoRows) {
  const Outcome outcome = checked(kCrossing, "--radius 0.25");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("overlap: A and B, from 0.464645 s to 0.535355 s, 0.5 m deep at 0.5 s, at (5, 0)\n"),
                    HasSubstr("straight and uniform from each row to the next"),
                    HasSubstr("1 overlap, 0 contacts, 0 jumps, 0 gaps\n")));
  const Outcome held = checked(kCrossing, "--radius 0.25 --between hold");
  EXPECT_EQ(held.status, 0);
  EXPECT_THAT(held.out, AllOf(HasSubstr("rests at a row until its next row"), HasSubstr("0 overlaps")));
}

TEST(CheckVerb, CubicsBulgeBeyondTheirRowsAndSamplesAloneSeeNothing) {
  // B waits beside A's way; A's velocities turn A towards it and back.
  const std::string rows =
      "t,id,x,y,vx,vy\n0,A,0,0,4,3\n0,B,2,0.9,0,0\n1,A,4,0,4,-3\n1,B,2,0.9,0,0\n2,A,8,0,4,0\n2,B,2,0.9,0,0\n";
  EXPECT_EQ(checked(rows, "--radius 0.2").status, 0);
  const Outcome cubic = checked(rows, "--radius 0.2 --between cubic");
  EXPECT_EQ(cubic.status, 1);
  EXPECT_THAT(cubic.out, AllOf(HasSubstr("along a cubic from each row to the next, with the file's velocities"),
                               HasSubstr("deep at 0.5 s, at (2, ")));
  EXPECT_THAT(checked(rows, "--radius 0.2 --between cubic --json").out, HasSubstr("\"between\":\"cubic\""));
  const Outcome none = checked(kCrossing, "--radius 0.25 --between none");
  EXPECT_EQ(none.status, 0);
  EXPECT_THAT(none.out, HasSubstr("only the rows count"));
}

// From (0, 0) to (1, 0) in 1 s with (0, 4) m/s at both ends: x = 3 s^2 - 2 s^3, y = 4 s - 12 s^2 + 8 s^3. The speed is
// 4 at the ends and greatest there; the chord has 1 m/s. The acceleration is (6, -24) at the start.
TEST(CheckVerb, SpeedsAndAccelerationsOfCubicsAreThoseOfTheCurve) {
  const std::string rows = "t,id,x,y,vx,vy\n0,A,0,0,0,4\n1,A,1,0,0,4\n";
  EXPECT_THAT(checked(rows, "--radius 0.1").out, HasSubstr("greatest speed: 1 m/s, A at 0 s, line 3\n"));
  const Outcome cubic = checked(rows, "--radius 0.1 --between cubic");
  EXPECT_THAT(cubic.out, AllOf(HasSubstr("greatest speed: 4 m/s, A at 0 s\n"),
                               HasSubstr("greatest acceleration: 24.7386 m/s^2, A at 0 s\n")));
  // At rest at both ends: 1.5 m/s half way.
  const Outcome still = checked("t,id,x,y,vx,vy\n0,A,0,0,0,0\n1,A,1,0,0,0\n", "--radius 0.1 --between cubic");
  EXPECT_THAT(still.out, HasSubstr("greatest speed: 1.5 m/s, A at 0.5 s\n"));
}

TEST(CheckVerb, ColumnsThatMayBeHeadingsAreNamedIfTheyAreNotRead) {
  const Outcome outcome = checked("t,id,x,y,yaw_deg\n0,A,0,0,90\n1,A,1,0,90\n", "--radius 0.1");
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("the column \"yaw_deg\" is not read"), HasSubstr("in radians")));
  EXPECT_THAT(checked("t,id,x,y,theta,yaw_deg\n0,A,0,0,1,9\n", "--radius 0.1").err, Not(HasSubstr("not read")));
}

TEST(CheckVerb, CatmullRomTakesTheRowsBeforeAndAfter) {
  // Round a corner a spline goes outside of the rows: A overlaps a wall that its chords do not reach.
  const Workplace here;
  here.write("t.csv", "t,id,x,y\n0,A,0,0\n1,A,4,0\n2,A,4,4\n3,A,0,4\n");
  here.write("map.wkt", "LINESTRING (4.6 0, 4.6 4)\n");
  EXPECT_EQ(here.run("check t.csv --radius 0.2 --map map.wkt").status, 0);
  // Between (4, 0) and (4, 4), with velocities (2, 2) and (-2, 2): x = 4 + 2 s (1 - s), at most 4.5.
  const Outcome outcome = here.run("check t.csv --radius 0.2 --map map.wkt --between cubic");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("velocities of a Catmull-Rom spline"), HasSubstr("0.1 m deep at 1.5 s")));
  EXPECT_EQ(here.run("check t.csv --radius 0.05 --map map.wkt --between cubic").status, 0);
}

TEST(CheckVerb, RobotsThatFollowEachOtherByOneRowDoNotMeetWhereTheyAreHeld) {
  std::string text = "t,id,x,y\n";
  for (int k = 0; k < 6; ++k)
    for (int a = 0; a < 3; ++a)
      text += std::to_string(k) + "," + std::to_string(a) + "," + std::to_string(k - a) + ",0\n";
  const Outcome outcome = checked(text, "--radius 0.3 --between hold");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("0 overlaps, 0 contacts"));
}

TEST(CheckVerb, CubicThroughRowsAtAlmostTheSameTimeIsDecided) {
  const Outcome outcome = checked("t,id,x,y\n0,A,0,0\n5e-324,A,1,0\n1,A,2,0\n", "--radius 0.2 --between cubic");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("0 overlaps"));
}

TEST(CheckVerb, PolynomialsOfSeveralFilesAreOneFleet) {
  const Workplace here;
  // one: (4 t, 3 t - 3 t^2), then on along x; other: against it, 0.7 m higher.
  here.write("fleet/one.csv", "duration,x^0,x^1,x^2,y^0,y^1,y^2\n1,0,4,0,0,3,-3\n1,4,4,0,0,0,0\n");
  here.write("fleet/other.csv", "# duration,x^0,x^1,x^2,y^0,y^1,y^2\n2,8,-4,0,0.7,0,0\n");
  const Outcome clear = here.run("check fleet --radius 0.3 --certificates proofs.jsonl");
  EXPECT_EQ(clear.status, 0) << clear.err;
  EXPECT_THAT(clear.out, AllOf(HasSubstr("of 2 agents, from 0 s to 2 s"), HasSubstr("along the file's polynomials")));
  const Outcome audit = here.run("audit --certificate proofs.jsonl --json");
  EXPECT_EQ(audit.status, 0) << audit.err;
  EXPECT_GE(json::parse(audit.out)["valid"], 2);
  std::string proof = here.read("proofs.jsonl");
  const std::size_t basis = proof.find("\"basis\":\"powers\"");
  ASSERT_NE(basis, std::string::npos);
  here.write("wrong.jsonl", proof.replace(basis, 16, "\"basis\":\"cubics\""));
  EXPECT_EQ(here.run("audit --certificate wrong.jsonl").status, 1);
  const Outcome wide = here.run("check fleet/one.csv fleet/other.csv --radius 0.4");
  EXPECT_EQ(wide.status, 1);
  EXPECT_THAT(wide.out, HasSubstr("overlap: one and other"));
  EXPECT_EQ(here.run("check fleet --radius 0.4 --between hold").status, 2);
  const Outcome away = here.run("check fleet --radius 0.4 --max-gap 5");
  EXPECT_EQ(away.status, 2);
  EXPECT_THAT(away.err, HasSubstr("--max-gap"));
  here.write("second/one.csv", "duration,x^0,y^0\n1,9,9\n");
  const Outcome named = here.run("check fleet second/one.csv --radius 0.1 --json");
  EXPECT_THAT(named.out, AllOf(HasSubstr("\"id\":\"one\""), HasSubstr("\"id\":\"second/one.csv\""))) << named.err;
  for (const char* bad : {"0,1,2,3,4,5,6\n", "1,2\n", "1,0,4,0,0,3,x\n", ""}) {
    here.write("bad.csv", std::string("duration,x^0,x^1,x^2,y^0,y^1,y^2\n") + bad);
    const Outcome outcome = here.run("check bad.csv --radius 1");
    EXPECT_EQ(outcome.status, 2) << bad;
    EXPECT_THAT(outcome.err, HasSubstr("bad.csv: line ")) << bad;
  }
}

TEST(CheckVerb, BSplinesAreDecidedAlongTheCurve) {
  // Two swarm drones: control points apart at every knot, curves that cross between them.
  const std::string line = R"("basis":"b-spline","degree":3,"start":0,"interval":1,"points":)";
  const Outcome outcome = checked(R"({"id":"A",)" + line + "[[-3,0],[-1,0],[1,0],[3,0]]}\n" + R"({"id":"B",)" + line +
                                      "[[0,-3],[0,-1],[0,1],[0,3]]}\n",
                                  "--radius 0.25");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("along the file's polynomials"), HasSubstr("overlap: A and B"),
                                 HasSubstr("0.5 m deep at 0.5 s, at (0, 0)")));
}

TEST(CheckVerb, SeveralFilesAndFoldersAreCheckedOneAfterTheOther) {
  const Workplace here;
  here.write("all/a.csv", kCrossing);
  here.write("all/b.csv", "t,id,x,y\n0,A,0,0\n1,A,1,0\n");
  here.write("all/readme.txt", "Nothing that is recognised.\n");
  const Outcome folder = here.run("check all --radius 0.25");
  EXPECT_EQ(folder.status, 1);
  EXPECT_THAT(folder.out, AllOf(HasSubstr("a.csv: csv, 8 rows"), HasSubstr("b.csv: csv, 2 rows")));
  const Outcome bad = here.run("check all/b.csv missing.csv all/a.csv --radius 0.25");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, AllOf(HasSubstr("missing.csv"), HasSubstr("E_FILE_MISSING")));
  EXPECT_THAT(bad.out, AllOf(HasSubstr("b.csv: csv"), HasSubstr("overlap: A and B")));
  EXPECT_EQ(here.run("check all --radius 0.25 --figure x.png").status, 2);
  EXPECT_EQ(here.run("check all --radius 0.25 --certificates x.jsonl").status, 2);
  here.write("none/readme.txt", "Nothing that is recognised.\n");
  const Outcome none = here.run("check none --radius 0.25");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("no file of trajectories"));
  ASSERT_EQ(here.run("simulate " + data_file("paper/A1.json") + " --out run --no-figures").status, 0);
  EXPECT_THAT(here.run("check run --json").out, HasSubstr("\"format\":\"recording\""));
}

TEST(CheckVerb, UnknownCellsOfAMapAreFreeOrBlocked) {
  const Workplace here;
  here.write("t.csv", "t,id,x,y\n0,A,0.5,0.5\n1,A,2.5,0.5\n");
  // Three cells of 1 m: free, unknown, free.
  here.write("map.pgm", std::string("P5\n3 1\n255\n\xfe\xcd\xfe"));
  here.write("map.yaml",
             "image: map.pgm\nresolution: 1.0\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
             "free_thresh: 0.196\n");
  const Outcome free = here.run("check t.csv --radius 0.2 --map map.yaml");
  EXPECT_EQ(free.status, 0) << free.err;
  const Outcome blocked = here.run("check t.csv --radius 0.2 --map map.yaml --unknown blocked");
  EXPECT_EQ(blocked.status, 1) << blocked.err;
}

TEST(CheckVerb, CountsWhatSamplesMiss) {
  // The overlap lasts from 0.4646 s to 0.5354 s of a move of 1 s.
  EXPECT_THAT(checked(kCrossing, "--radius 0.25 --samples 1").out,
              HasSubstr("1 sample of each move misses 1 of 1 over"));
  EXPECT_THAT(checked(kCrossing, "--radius 0.25 --samples 2").out,
              HasSubstr("2 samples of each move miss 0 of 1 over"));
  EXPECT_THAT(checked(kCrossing, "--radius 0.25 --samples 3").out,
              HasSubstr("3 samples of each move miss 1 of 1 over"));
  EXPECT_THAT(checked(kCrossing, "--radius 2 --samples 1 --json").out, HasSubstr("\"samples\":1,\"missed\":1"));
  EXPECT_THAT(checked("t,id,x,y\n0,A,0,0\n1,A,4,0\n2,A,8,0\n0,B,4,0\n2,B,4,0\n", "--radius 0.5 --samples 1").out,
              HasSubstr("misses 0 of 1"));
}

TEST(CheckVerb, ContactIsClearAndIsReported) {
  const Outcome outcome = checked("t,id,x,y\n0,A,0,0\n1,A,4,0\n0,B,2,1\n1,B,2,1\n", "--radius 0.5");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("contact: A and B, at 0.5 s, at (2, 0.5)"), HasSubstr("1 contact,")));
}

TEST(CheckVerb, JsonEnclosesMomentsAndDepth) {
  const Outcome outcome = checked(kCrossing, "--radius 0.25 --json --near 1");
  EXPECT_EQ(outcome.status, 1);
  const std::vector<json> lines = json_lines(outcome.out);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0]["event"], "overlap");
  const double first = 0.5 - std::sqrt(0.5) / 20.0;
  EXPECT_LE(lines[0]["first"][0], first);
  EXPECT_GE(lines[0]["first"][1], first);
  EXPECT_LE(lines[0]["clearance"][0], -0.5);
  EXPECT_EQ(lines[2]["approach"][0].get<double>() > 0.39, true);
  EXPECT_EQ(lines[2]["other"], "C");
  EXPECT_LE(lines[2]["approach"][0], 0.4);
  EXPECT_GE(lines[2]["approach"][1], 0.4 - 1e-12);
  const json& whole = lines[3]["summary"];
  EXPECT_EQ(whole["overlaps"], 1);
  EXPECT_EQ(whole["between"], "straight");
  EXPECT_EQ(whole["bodies"].size(), 3u);
  EXPECT_EQ(whole["bodies"][0]["speed"]["value"], 10.0);
}

TEST(CheckVerb, MapsAreLookedAt) {
  const Workplace here;
  here.write("t.csv", "t,id,x,y\n0,A,0,0\n1,A,10,0\n");
  here.write("map.wkt", "LINESTRING (5 -1, 5 1)\nPOLYGON ((7 0.4, 8 0.4, 8 2, 7 2, 7 0.4))\n");
  const Outcome outcome = here.run("check t.csv --radius 0.3 --map map.wkt");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("overlap: A and wall 1, from 0.47 s to 0.53 s"),
                                 HasSubstr("near: A and polygon 2, 0.1 m apart")));
}

TEST(CheckVerb, FootprintsKeepTheirHeading) {
  const char* const rows = "t,id,x,y,theta\n0,A,0,0,1.5707963267948966\n1,A,10,0,1.5707963267948966\n";
  const Workplace here;
  here.write("t.csv", rows);
  here.write("map.wkt", "LINESTRING (0 0.7, 10 0.7)\n");
  const std::string long_body = "'POLYGON ((-1 -0.5, 1 -0.5, 1 0.5, -1 0.5, -1 -0.5))'";
  EXPECT_EQ(here.run("check t.csv --map map.wkt --footprint " + long_body).status, 1);
  here.write("t.csv", "t,id,x,y,theta\n0,A,0,0,0\n1,A,10,0,0\n");
  EXPECT_EQ(here.run("check t.csv --map map.wkt --footprint " + long_body).status, 0);
  const Outcome cubic = here.run("check t.csv --between cubic --map map.wkt --footprint " + long_body);
  EXPECT_EQ(cubic.status, 0);
  EXPECT_THAT(cubic.out, HasSubstr("which no agent changes"));
  here.write("t.csv", "t,id,x,y,theta\n0,A,0,0,0\n1,A,10,0,0.1\n");
  const Outcome turning = here.run("check t.csv --between cubic --map map.wkt --footprint " + long_body);
  EXPECT_EQ(turning.status, 2);
  EXPECT_THAT(turning.err, AllOf(HasSubstr("line 3"), HasSubstr("turns"), HasSubstr("[E_RANGE]")));
  const Outcome disc = here.run("check t.csv --map map.wkt --radius 0.5");
  EXPECT_EQ(disc.status, 0);
  EXPECT_THAT(disc.out, HasSubstr("which have no heading"));
  EXPECT_EQ(here.run("check t.csv --map map.wkt --footprint 'LINESTRING (0 -1, 0 1)' --radius 0.1").status, 1);
}

// Both rows are clear; between them a corner of the one swings through the wall, and of the two into each other.
constexpr const char* kTurning =
    "t,id,x,y,theta\n0,A,0,0,0\n0,B,5,0,1.5\n0,C,6.7,0,1.6\n1,A,0,0,1.6\n1,B,5,0,-1.5\n1,C,6.7,0,4.6\n2,A,2,0,1.6\n";
constexpr const char* kTurningBox = "--footprint 'POLYGON ((-0.5 -0.5, 1 -0.5, 1 0.5, -0.5 0.5))' --near 0.3";

TEST(CheckVerb, FootprintsThatTurnAreDecidedBetweenRows) {
  const Workplace here;
  here.write("t.csv", kTurning);
  here.write("map.wkt", "LINESTRING (-3 1.08, 3 1.08)\n");
  const std::string ask = std::string("check t.csv --map map.wkt ") + kTurningBox;
  EXPECT_EQ(here.run(ask + " --between none").status, 0);
  EXPECT_EQ(here.run(ask + " --between hold").status, 0);
  const Outcome outcome = here.run(ask + " --figure out/turning.svg --page out/turning.html");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("turns evenly from row to row, on the arc of a constant twist"),
                                 HasSubstr("overlap: A and wall 1, from 0.5"), HasSubstr("overlap: B and C, from 0."),
                                 HasSubstr("2 overlaps, 0 contacts, 0 jumps, 0 gaps\n")));
  // The body is drawn as it is turned: the heading of A goes into the page.
  EXPECT_THAT(here.read("out/turning.html"), HasSubstr("heading"));
}

TEST(CheckVerb, ProofsOfFootprintsThatTurnAreAcceptedAndChangedOnesRefused) {
  const Workplace here;
  here.write("t.csv", "t,id,x,y,theta\n0,A,0,0,0\n0,B,5,0,1.5\n0,C,7,0,1.6\n1,A,0,0,1.6\n1,B,5,0,-1.5\n1,C,7,0,4.6\n");
  here.write("map.wkt", "LINESTRING (-3 1.1, 3 1.1)\nPOLYGON ((8 1.5, 9 1.5, 9 2.5, 8 2.5))\n");
  const std::string box = "--footprint 'POLYGON ((-0.3 -0.2, 0.9 -0.2, 0.9 0.2, -0.3 0.2))' --near 0.3";
  const Outcome outcome = here.run("check t.csv --map map.wkt --certificates proofs.jsonl " + box);
  ASSERT_EQ(outcome.status, 0) << outcome.out;
  std::size_t turning = 0, of_two = 0, refused = 0;
  for (const json& line : json_lines(here.read("proofs.jsonl"))) {
    if (!line.contains("certificate") || line["certificate"].is_null() || !line["certificate"]["a"].contains("turn"))
      continue;
    ++turning;
    of_two += line["certificate"].contains("b");
    json changed = line;
    changed["certificate"]["a"]["turn"] = 9.0;
    here.write("changed.jsonl", changed.dump() + "\n");
    refused += here.run("audit --certificate changed.jsonl").status == 1;
  }
  EXPECT_GE(turning, 2u);
  EXPECT_GE(of_two, 1u);
  EXPECT_GE(refused, 1u);
  EXPECT_EQ(here.run("audit --certificate proofs.jsonl").status, 0);
}

TEST(CheckVerb, TipsThatMeetExactlyWhileBothTurnAreLeftOpen) {
  // Both turn from -0.5 to 0.5 rad; at 0 two corners meet, to a rounding.
  const Outcome outcome = checked("t,id,x,y,theta\n0,A,0,0,-0.5\n0,B,6,0,-0.5\n1,A,0,0,0.5\n1,B,6,0,0.5\n",
                                  "--footprint 'POLYGON ((-3 0, 0 -3, 3 0, 0 3))' --near 0");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("close: A and B, at 0.5 s, nearer than "),
                                 HasSubstr("whether they touch is open"), HasSubstr("0 overlaps, 0 contacts, 1 open")));
}

// The tips touch exactly until both turn; then it is open whether they overlap.
TEST(CheckVerb, AContactThatGoesOnIntoWhatIsOpenIsLeftOpen) {
  const Outcome outcome =
      checked("t,id,x,y,theta\n0,A,0,0,0\n0,B,6,0,0\n1,A,0,0,0\n1,B,6,0,0\n2,A,0,0,0.5\n2,B,6,0,0.5\n",
              "--footprint 'POLYGON ((-3 0, 0 -3, 3 0, 0 3))' --near 0");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("close: A and B, from 0 s to 1"),
                                 HasSubstr("; they touch, and whether they overlap is open, at (3, 0)\n"),
                                 HasSubstr("0 overlaps, 0 contacts, 1 open")));
}

TEST(CheckVerb, TheExampleOfAnOverlapIsNoMomentAtWhichTheyOnlyTouch) {
  // Two squares touch for a second before both turn, corner into side.
  const Outcome outcome =
      checked("t,id,x,y,theta\n0,A,0,0,0\n0,B,1,0,0\n1,A,0,0,0\n1,B,1,0,0\n2,A,0,0,0.5\n2,B,1,0,0.5\n",
              "--footprint 'POLYGON ((-0.5 -0.5, 0.5 -0.5, 0.5 0.5, -0.5 0.5))' --json");
  EXPECT_EQ(outcome.status, 1);
  const json overlap = json_lines(outcome.out).front();
  EXPECT_EQ(overlap["event"], "overlap");
  EXPECT_EQ(overlap["first"][0], 0.0);
  EXPECT_GT(overlap["time"], 1.0);
}

TEST(CheckVerb, PairsWithoutAProofSayWhetherTheyTouch) {
  const Workplace here;
  here.write("t.csv", "t,id,x,y,theta\n0,A,0,0,-0.5\n0,B,6,0,-0.5\n1,A,0,0,0.5\n1,B,6,0,0.5\n");
  here.write("straight.csv", "t,id,x,y,theta\n0,A,0,0,0\n0,B,6,0,0\n1,A,0,0,0\n1,B,6,0,0\n");
  const std::string diamond = " --footprint 'POLYGON ((-3 0, 0 -3, 3 0, 0 3))' --certificates proofs.jsonl";
  EXPECT_THAT(here.run("check t.csv" + diamond).err,
              HasSubstr("0 certificates for motions that come near and stay clear, none for 1 too near for a proof"));
  const json open = json_lines(here.read("proofs.jsonl")).front();
  EXPECT_TRUE(open["certificate"].is_null());
  EXPECT_EQ(open["why"], "too near");
  EXPECT_THAT(here.run("check straight.csv" + diamond).err, HasSubstr("none for 1 that touches\n"));
  EXPECT_EQ(json_lines(here.read("proofs.jsonl")).front()["why"], "touches");
}

TEST(CheckVerb, PlansOfCellsLieOnTheirMap) {
  const Workplace here;
  here.write("grid.map", "type octile\nheight 3\nwidth 4\nmap\n....\n.@@.\n....\n");
  here.write("free.paths", "Agent 0: (0,0)->(0,1)->(0,2)->\nAgent 1: (2,3)->(1,3)->\n");
  here.write("through.paths", "Agent 0: (0,1)->(1,1)->\n");
  here.write("swap.paths", "Agent 0: (0,0)->(0,1)->\nAgent 1: (0,1)->(0,0)->\n");
  EXPECT_EQ(here.run("check free.paths --radius 0.4 --map grid.map").status, 0);
  EXPECT_EQ(here.run("check through.paths --radius 0.4 --map grid.map").status, 1);
  const Outcome swap = here.run("check swap.paths --radius 0.4 --map grid.map");
  EXPECT_EQ(swap.status, 1);
  EXPECT_THAT(swap.out, HasSubstr("at (1, 2.5)"));
  const Outcome scaled = here.run("check swap.paths --radius 0.1 --map grid.map --scale 0.5 --cell-size 0.5");
  EXPECT_THAT(scaled.out, HasSubstr("at (0.5, 1.25)")) << scaled.err;
  const Outcome mixed = here.run("check swap.paths --radius 0.1 --map grid.map --cell-size 0.5");
  EXPECT_EQ(mixed.status, 2);
  EXPECT_THAT(mixed.err, HasSubstr("the side of the map's cells, 0.5 m"));
}

// --- Findings ---

TEST(CheckVerb, JumpsAndGapsAreFindings) {
  std::string text = "t,id,x,y\n";
  for (int k = 0; k < 60; ++k)
    if (k != 40) text += std::to_string(k) + ",A," + std::to_string(k + (k >= 20 ? 50 : 0)) + ",0\n";
  const Outcome outcome = checked(text, "--radius 0.2");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("jump: A, line 22: 51 m in 1 s, 51 m/s\n"),
                                 HasSubstr("gap: A, line 42: no row from 39 s to 41 s\n"), HasSubstr("1 jump (faster"),
                                 HasSubstr("1 gap\n")));
  EXPECT_THAT(checked(text, "--radius 0.2 --max-speed 100").out, HasSubstr("0 jumps (faster than 100 m/s), 1 gap\n"));
}

TEST(CheckVerb, AJumpWhereAPlanIsSwitchedIsAFinding) {
  // A planner starts its new plan where the robot was when planning began: it jumps by 1.093 m within 2.547 ms, to
  // another robot.
  std::string text = "t,id,x,y\n";
  const auto row = [&](double t, const char* id, double x, double y) {
    text += std::to_string(t) + "," + id + "," + std::to_string(x) + "," + std::to_string(y) + "\n";
  };
  for (int k = 0; k <= 40; ++k) {
    row(0.1 * k, "1", 0.1 * k, 0.0);
    row(0.1 * k, "3", 5.3, 0.1);
  }
  row(4.002547, "1", 5.093, 0.0);
  row(4.1, "1", 5.2, 0.0);
  row(4.1, "3", 5.3, 0.1);
  const Outcome outcome = checked(text, "--radius 0.2");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("jump: 1, line 84: 1.093 m in 0.002547 s, 429.132 m/s"),
                                 HasSubstr("overlap: 1 and 3"), HasSubstr("1 jump ")));
}

TEST(CheckVerb, AnAgentIsAwayInAGapWhereAsked) {
  const char* const text = "t,id,x,y\n0,A,0,0\n1,A,1,0\n9,A,9,0\n10,A,10,0\n0,B,5,0\n10,B,5,0\n";
  EXPECT_EQ(checked(text, "--radius 0.2").status, 1);
  const Outcome away = checked(text, "--radius 0.2 --max-gap 5");
  EXPECT_EQ(away.status, 0);
  EXPECT_THAT(away.out, HasSubstr("away where it has no row for more than 5 s"));
}

TEST(CheckVerb, RowsInTheOrderOfAgentsGiveTheSameAnswer) {
  std::string by_time = "t,id,x,y\n", by_agent = by_time;
  const auto row = [](int k, int a) {
    const double x = a == 0 ? 0.1 * k : 10.0 - 0.1 * k, y = 0.3 * std::sin(0.37 * k + a);
    return std::to_string(0.25 * k) + "," + std::to_string(a) + "," + std::to_string(x) + "," + std::to_string(y) +
           "\n";
  };
  for (int k = 0; k < 100; ++k)
    for (int a = 0; a < 2; ++a) by_time += row(k, a);
  for (int a = 0; a < 2; ++a)
    for (int k = 0; k < 100; ++k) by_agent += row(k, a);
  const Outcome one = checked(by_time, "--radius 0.3"), other = checked(by_agent, "--radius 0.3");
  EXPECT_EQ(one.status, 1);
  EXPECT_THAT(one.err, Not(HasSubstr("memory")));
  EXPECT_THAT(other.err, HasSubstr("not in the order of time"));
  const auto events = [](const std::string& text) {
    return text.substr(text.find("overlap"), text.find("greatest") - text.find("overlap"));
  };
  EXPECT_EQ(events(one.out), events(other.out));
}

// --- Recordings ---

TEST(CheckVerb, RecordingsBringTheirRadiiAndObstacles) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A1.json") + " --out run --no-figures").status, 0);
  const Outcome outcome = here.run("check run/recording.jsonl --json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json whole = json_lines(outcome.out).back()["summary"];
  EXPECT_EQ(whole["format"], "recording");
  EXPECT_EQ(whole["footprint"], "discs of the file's radii");
  EXPECT_GT(whole["pieces"], 100);
  EXPECT_FALSE(whole["map"].is_null());
  const Outcome table = here.run("check run/trajectory.csv --radius 0.5 --json");
  EXPECT_EQ(json_lines(table.out).back()["summary"]["rows"], whole["rows"]);
}

TEST(CheckVerb, BodiesOfRobotsOnWheelsAreAboutTheAxle) {
  const Workplace here;
  // The axle goes from (0, 0) to (0, 0.92), heading along y; the reference point is 0.08 m ahead.
  here.write("burger.json", R"({"name": "a Burger", "time_limit": 60, "arrival_tolerance": 0.02,
    "time_step": 0.25, "horizons": {"least": 0.5}, "robots": [
    {"id": "R1", "position": [0, 0], "heading": 90, "radius": 0.105, "goal": [0, 1], "kinematics": {"type":
     "differential", "wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1}}]})");
  ASSERT_EQ(here.run("simulate burger.json --out run --no-figures").status, 0);
  ASSERT_EQ(here.run("simulate burger.json --decisions none --record crowd.evr").status, 0);
  here.write("behind.wkt", "LINESTRING (-0.05 -0.95, 0.05 -0.95)\n");
  here.write("beside.wkt", "LINESTRING (-0.9 -0.5, -0.9 1.5)\n");
  here.write("close.wkt", "LINESTRING (-0.05 -0.1, 0.05 -0.1)\n");
  here.write("ahead.wkt", "LINESTRING (-0.05 1.06, 0.05 1.06)\n");
  const std::string footprint = " --footprint 'POLYGON ((-1 -0.1, 0.5 -0.1, 0.5 0.1, -1 0.1))'";
  for (const std::string check : {"check run --map ", "check crowd.evr --map "}) {
    const Outcome behind = here.run(check + "behind.wkt" + footprint);
    EXPECT_EQ(behind.status, 1) << behind.out << behind.err;
    EXPECT_THAT(behind.out, AllOf(HasSubstr("overlap: R1 and wall 1, from 0 s"), HasSubstr("at the axle's centre")));
    const Outcome beside = here.run(check + "beside.wkt" + footprint);
    EXPECT_EQ(beside.status, 0) << beside.out << beside.err;
    EXPECT_THAT(beside.out, Not(HasSubstr("no headings")));
    const Outcome close = here.run(check + "close.wkt --radius 0.105");
    EXPECT_EQ(close.status, 1) << close.out << close.err;
    EXPECT_THAT(close.out, HasSubstr("round the axle's centre"));
    EXPECT_EQ(here.run(check + "ahead.wkt --radius 0.105").status, 0);
    const Outcome own = here.run(check + "ahead.wkt");
    EXPECT_EQ(own.status, 1) << "the disc about the reference point";
    EXPECT_THAT(own.out, HasSubstr("discs of the file's radii, of robots on wheels round the reference point"));
  }
  ASSERT_EQ(here.run("simulate burger.json --decisions none --every 3 --record seldom.evr").status, 0);
  const Outcome seldom = here.run("check seldom.evr --radius 0.105");
  EXPECT_EQ(seldom.status, 2) << seldom.out;
  EXPECT_THAT(seldom.err, HasSubstr("a row every 3 steps, from which headings do not follow"));
}

TEST(CheckVerb, ARunWithAFootprintNeedsOneOfItsOwn) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("robots/mp500_doors.json") + " --out run --no-figures").status, 0);
  const Outcome refused = here.run("check run");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("which has a footprint"), HasSubstr("[E_SCENARIO]")));
  // The MP-500 passes its doors; a body that is wider than they are does not.
  const auto with_width = [&](const std::string& half) {
    return here.run("check run --near 0 --footprint 'POLYGON ((-0.527 -" + half + ", 0.296 -" + half + ", 0.296 " +
                    half + ", -0.527 " + half + "))'");
  };
  const Outcome passes = with_width("0.296");
  EXPECT_EQ(passes.status, 0) << passes.out << passes.err;
  EXPECT_THAT(passes.out, HasSubstr("on the arc of a constant twist"));
  EXPECT_EQ(with_width("0.36").status, 1);
}

TEST(CheckVerb, RecordingsOfCrowdsAreChecked) {
  const Workplace here;
  here.write("c.json", R"({"name": "c", "robots": [{"id": "a", "position": [0, 0], "goal": [4, 0]},
    {"id": "b", "position": [4, 0.1], "goal": [0, 0.1]}], "time_limit": 20,
    "obstacles": [{"id": "wall", "polyline": [[0, 3], [4, 3]]}]})");
  ASSERT_EQ(here.run("simulate c.json --decisions none --record c.evr").status, 0);
  const Outcome outcome = here.run("check c.evr --json");
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_EQ(json_lines(outcome.out).back()["summary"]["format"], "crowd-recording");
  const Outcome scaled = here.run("check c.evr --scale 2");
  EXPECT_EQ(scaled.status, 2) << "radii and obstacles would stay as they are";
  EXPECT_THAT(scaled.err, HasSubstr("found the scale 2, expected no scale for a recording"));
}

TEST(CheckVerb, DiscsOfRecordingsAreDiscs) {
  // The robot rests where it touches the corners of a polygon round the disc, but not the disc.
  const Workplace here;
  const auto scenario = [&](double reach) {
    const double angle = std::acos(-1.0) / 32.0;
    json robot{{"id", "a"}, {"radius", 0.5}, {"max_speed", 1}};
    robot["position"] = robot["goal"] = {reach * std::cos(angle), reach * std::sin(angle)};
    const json disc{{"id", "pillar"}, {"disc", {{"centre", {0, 0}}, {"radius", 10}}}};
    return json{{"name", "c"},
                {"guidance", "none"},
                {"time_limit", 1},
                {"robots", json::array({robot})},
                {"obstacles", json::array({disc})},
                {"margins", {{"obstacle", 0}}}}
        .dump();
  };
  here.write("clear.json", scenario(10.52));
  ASSERT_EQ(here.run("simulate clear.json --decisions all --out run --no-figures --force").status, 0);
  ASSERT_EQ(here.run("simulate clear.json --decisions none --record c.evr --force").status, 0);
  std::size_t judged = 0;
  for (const char* file : {"run/recording.jsonl", "c.evr"}) {
    const Outcome clear = here.run(std::string("check ") + file + " --near 0.1");
    EXPECT_EQ(clear.status, 0) << file << clear.out << clear.err;
    EXPECT_THAT(clear.out, AllOf(HasSubstr("1 obstacle"), HasSubstr("near: a and "), HasSubstr("0.02"))) << file;
    EXPECT_THAT(clear.err, Not(HasSubstr("left out")));
    EXPECT_EQ(here.run(std::string("check ") + file + " --radius 0.53").status, 1);
    EXPECT_EQ(here.run(std::string("check ") + file + " --certificates proofs.jsonl").status, 0);
    const Outcome audit = here.run("audit --certificate proofs.jsonl --json");
    EXPECT_EQ(audit.status, 0) << audit.err;
    EXPECT_GE(json::parse(audit.out)["valid"], 1);
    ++judged;
  }
  EXPECT_EQ(judged, 2u);
}

// --- Certificates and figures ---

TEST(CheckVerb, CertificatesAreAcceptedByTheAudit) {
  const Workplace here;
  here.write("t.csv", kCrossing);
  here.write("map.wkt", "POLYGON ((8 0.6, 8.5 0.6, 8.5 2, 8 2, 8 0.6))\n");
  const Outcome outcome = here.run("check t.csv --radius 0.25 --near 1 --map map.wkt --certificates proofs.jsonl");
  EXPECT_EQ(outcome.status, 1);
  const Outcome audit = here.run("audit --certificate proofs.jsonl --json");
  EXPECT_EQ(audit.status, 0) << audit.err;
  const json counts = json::parse(audit.out);
  EXPECT_GE(counts["certificates"], 3);
  EXPECT_EQ(counts["certificates"], counts["valid"]);
  EXPECT_EQ(counts["none"], 1);  // A and B
  // A changed number is no proof.
  std::string text = here.read("proofs.jsonl");
  const std::size_t radius = text.find("\"radius\":0.25");
  ASSERT_NE(radius, std::string::npos);
  here.write("wrong.jsonl", text.replace(radius, 13, "\"radius\":0.95"));
  EXPECT_EQ(here.run("audit --certificate wrong.jsonl").status, 1);
}

TEST(CheckVerb, TheFigureShowsTheOverlaps) {
  const Workplace here;
  here.write("t.csv", kCrossing);
  const Outcome outcome = here.run("check t.csv --radius 0.25 --figure out/check.svg");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(here.has("out/check.png"));
  EXPECT_THAT(here.read("out/check.gp"), AllOf(HasSubstr("t.csv: 1 overlap"), HasSubstr("A and B, t = 0.5 s")));
  here.write("map.wkt", "LINESTRING (2 -1, 2 1)\n");
  here.run("check t.csv --radius 0.25 --map map.wkt --figure out/wall.svg");
  EXPECT_THAT(here.read("out/wall.gp"), HasSubstr("A and wall 1, t = 0.2 s")) << "as the answer names it";
  EXPECT_EQ(here.run("check t.csv --radius 0.25 --figure t.csv").status, 2);
}

TEST(CheckVerb, ThePageHoldsTheTrajectoriesAndTheOverlaps) {
  const Workplace here;
  here.write("t.csv", kCrossing);
  for (const char* more : {"", " --between hold", " --between none", " --between cubic", " --max-gap 0.5"}) {
    const Outcome outcome = here.run(std::string("check t.csv --radius 0.25 --page out/check.html") + more);
    EXPECT_LE(outcome.status, 1) << more << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("wrote out/check.html")) << more;
    EXPECT_THAT(here.read("out/check.html"), HasSubstr("<title>")) << more;
  }
  EXPECT_THAT(here.run("check t.csv --radius 0.25 --page check.png").err, HasSubstr(".html"));
  EXPECT_THAT(here.run("check t.csv t.csv --radius 0.25 --page check.html").err, HasSubstr("several files"));
  EXPECT_THAT(here.run("view t.csv --out page.html").err, HasSubstr("--page"));
  here.write("t.html", kCrossing);
  EXPECT_THAT(here.run("check t.html --radius 0.25 --page t.html").err, HasSubstr("another file"));
}

// --- Long files ---

TEST(CheckVerb, AMillionRowsThroughAPipeNeedLittleMemory) {
  const Workplace here;
  here.write("rows.awk",
             "BEGIN { print \"t,id,x,y\"; for (k = 0; k < 10000; ++k) for (a = 0; a < 100; ++a) "
             "printf \"%d,%d,%.3f,%d\\n\", k, a, 0.01 * k, 3 * a }\n");
  // 1,000,000 rows take 48 MB as rows and more as pieces; the program alone maps some 200 MB of libraries.
  const Outcome outcome = here.run("check - --radius 0.3 --json; }", "awk -f rows.awk | { ulimit -v 400000;");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json whole = json_lines(outcome.out).back()["summary"];
  EXPECT_EQ(whole["rows"], 1000000);
  EXPECT_LE(whole["most_held"], 300);
}

// --- Bad input ---

TEST(CheckVerb, BadInputIsNamed) {
  struct Bad {
    const char* rows;
    const char* arguments;
    const char* words;
  };
  const Bad all[] = {
      {kCrossing, "", "--radius or --footprint"},
      {kCrossing, "--radius -1", "--radius"},
      {kCrossing, "--radius nan", "--radius"},
      {kCrossing, "--radius 0.2 --between quintic", "one of straight hold cubic none"},
      {kCrossing, "--radius 0.2 --unknown open", "--unknown"},
      {kCrossing, "--radius 0.2 --scale 0", "--scale"},
      {kCrossing, "--radius 0.2 --frame-rate 0", "--frame-rate: found '0', expected frames a second, above 0"},
      {kCrossing, "--radius 0.2 --max-gap -1", "--max-gap"},
      {kCrossing, "--radius 0.2 --format obsmatt", "did you mean 'obsmat'?"},
      {kCrossing, "--radius 0.2 --map nothing.wkt", "E_FILE_MISSING"},
      {kCrossing, "--footprint 'POLYGON ((0 0, 1 0))'", "E_TOO_FEW_POINTS"},
      {kCrossing, "--footprint 'LINESTRING (0 0, 1 0)'", "--radius"},
      {"t,id,x,y\n0,A,1,2\n1,A,nan,2\n", "--radius 1", "line 3"},
      {"t,id,x,y\n1,A,1,2\n0,A,1,2\n", "--radius 1", "line 3"},
      {"t,id,x,y\n0,A,1,2\n0,A,1,3\n", "--radius 1", "line 3"},
      {"t,id,x,y\n0,A,1,2\n1,A,inf,2\n", "--radius 1", "line 3"},
      {"t,id,x,y,theta\n0,A,1,2,0\n0,A,1,2,1\n", "--radius 1", "a second heading at 0 s"},
      {"t,id,x,y,vx,vy\n0,A,1,2,0,0\n0,A,1,2,1,0\n", "--radius 1 --between cubic", "a second velocity at 0 s"},
      {"t,id,x,y\nnan,A,1,2\n", "--radius 1", "E_NOT_FINITE"},
      {"t,id,x,y\n0,A,1e300,2\n", "--radius 1", "2^100"},
      {"t,id,x,y\n0,A,1\n", "--radius 1", "E_COUNT"},
      {"t,id,x,y\n0,,1,2\n", "--radius 1", "an empty id"},
      {"t,id,x,y,vx,vy\n0,A,1,2,nan,0\n", "--radius 1 --between cubic", "line 2"},
      {"t,id,x,y,vx,vy\n0,A,1,2,0,0\n1,A,1,2,1e308,0\n", "--radius 1 --between cubic", "line 3"},
      {"t,id,x,y,vx,vy\n0,A,1,2,1e308,0\n", "--radius 1", "velocities in m/s up to 2^100"},
      {"t,id,x,y\n", "--radius 1", "no row"},
      {"t,id,x,y\n0,A,1,2\n1,A,+-1,2\n", "--radius 1", "E_NUMBER"},
      {"t,id,x,y\n0,\"A\nB\",1,2\n", "--radius 1", "CSV whose fields end on their line"},
  };
  std::size_t judged = 0;
  for (const Bad& bad : all) {
    const Outcome outcome = checked(bad.rows, bad.arguments);
    EXPECT_EQ(outcome.status, 2) << bad.arguments << outcome.out << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(bad.words)) << bad.arguments;
    ++judged;
  }
  EXPECT_EQ(judged, std::size(all));
}

TEST(CheckVerb, MixedFrameRatesAreDecidedExactly) {
  // A has 10 rows a second, B three, C one; B crosses A's way as A passes, between rows of both.
  std::string text = "t,id,x,y\n";
  const auto rows = [&](const char* id, int count, double over, auto at) {
    for (int k = 0; k <= count; ++k) {
      const double t = over * k / count;
      const auto [x, y] = at(t);
      text += std::to_string(t) + "," + id + "," + std::to_string(x) + "," + std::to_string(y) + "\n";
    }
  };
  rows("A", 40, 4.0, [](double t) { return std::pair(t, 0.0); });
  rows("B", 12, 4.0, [](double t) { return std::pair(1.9, t - 1.9); });
  rows("C", 4, 4.0, [](double t) { return std::pair(t - 1.0, 1.0); });
  const Outcome outcome = checked(text, "--radius 0.1 --near 0");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("overlap: A and B"), HasSubstr("0.2 m deep at 1.9 s"), HasSubstr("0 gaps")));
  EXPECT_THAT(outcome.out, HasSubstr("overlap: B and C"));
}

TEST(CheckVerb, ARowThatComesTwiceIsLeftOutAndReported) {
  const Outcome outcome = checked("t,id,x,y\n0,A,1,2\n0,A,1,2\n1,A,1,2\n", "--radius 1");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("1 row that repeats the one before was left out"));
  const Outcome two = checked("t,id,x,y,theta\n0,A,1,2,0\n0,A,1,2,0\n0,A,1,2,\n1,A,1,2,0\n", "--radius 1");
  EXPECT_EQ(two.status, 0);
  EXPECT_THAT(two.err, HasSubstr("2 rows that repeat the one before were left out"));
  EXPECT_EQ(checked("t,id,x,y,vx,vy\n0,A,1,2,0,0\n0,A,1,2,1,0\n1,A,1,2,0,0\n", "--radius 1").status, 0)
      << "velocities matter to cubics only";
}

TEST(CheckVerb, TheDepthOfPolygonsIsNotMeasured) {
  const std::string rows = "t,id,x,y\n0,A,0,0\n0,B,2,0\n1,A,4,0\n1,B,2,0\n";
  const std::string square = "--footprint 'POLYGON ((-0.5 -0.5, 0.5 -0.5, 0.5 0.5, -0.5 0.5))'";
  const Outcome outcome = checked(rows, square);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("depth of polygons is not measured"), HasSubstr("for example at "),
                                 Not(HasSubstr(" deep at "))));
  EXPECT_THAT(checked(rows, square + " --radius 0.1").out, HasSubstr("0.2 m deep at "));
  const json event = json_lines(checked(rows, square + " --json").out).front();
  for (const json& bound : event.at("clearance")) {
    EXPECT_EQ(bound.get<double>(), 0.0);
    EXPECT_FALSE(std::signbit(bound.get<double>()));
  }
}

TEST(CheckVerb, HeadingsInDegreesAreNoted) {
  const char* const words = "most headings are beyond 2 pi: they are read in radians";
  EXPECT_THAT(checked("t,id,x,y,yaw\n0,A,0,0,90\n1,A,1,0,90\n", "--radius 0.1").err, HasSubstr(words));
  EXPECT_THAT(checked("t,id,x,y,yaw\n0,A,0,0,6\n1,A,1,0,7\n", "--radius 0.1").err, Not(HasSubstr(words)));
}

TEST(CheckVerb, MillionsOfRowsOfOneAgentNeedLittleMemory) {
  const Workplace here;
  here.write("rows.awk",
             "BEGIN { print \"t,id,x,y\"; for (k = 0; k < 4000000; ++k) printf \"%d,A,%d,0\\n\", k, k % 1000 }\n");
  // The rows would take 256 MB as rows alone.
  const Outcome outcome = here.run("check - --radius 0.3 --json; }", "awk -f rows.awk | { ulimit -v 400000;");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json whole = json_lines(outcome.out).back()["summary"];
  EXPECT_EQ(whole["rows"], 4000000);
  EXPECT_LE(whole["most_held"], 300);
}

TEST(CheckVerb, OnePointIsAnAnswer) {
  const Outcome outcome = checked("t,id,x,y\n0,A,1,2\n", "--radius 1");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("0 overlaps, 0 contacts, 0 jumps, 0 gaps\n"));
  const Outcome two = checked("t,id,x,y\n0,A,1,2\n0,B,1,2.5\n", "--radius 1");
  EXPECT_EQ(two.status, 1);
  EXPECT_THAT(two.out, HasSubstr("overlap: A and B, at 0 s"));
}

}  // namespace
}  // namespace exactvo::test
