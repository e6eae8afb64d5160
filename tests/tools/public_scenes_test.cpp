// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes after public reports of checks that missed a collision, rebuilt small. Each names its report; a test also
// shows what the reported check would have seen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

Outcome checked(const std::string& rows, const std::string& arguments, const std::string& map = "") {
  const Workplace here;
  here.write("t.csv", rows);
  if (!map.empty()) here.write("map.wkt", map);
  return here.run("check t.csv " + arguments + (map.empty() ? "" : " --map map.wkt"));
}

json monitored(const std::string& line, const std::string& arguments, const std::string& map) {
  const Workplace here;
  here.write("line.jsonl", line + "\n");
  here.write("map.wkt", map);
  const Outcome outcome = here.run("monitor line.jsonl --map map.wkt " + arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out);
}

constexpr const char* kLongBox = "--footprint 'POLYGON ((-0.5 -0.3, 0.5 -0.3, 0.5 0.3, -0.5 0.3))'";

// ros-navigation/navigation2 3171: a rectangular robot turns on the spot at 0.3 rad/s, and the projection of its
// footprint 2 s ahead does not see the obstacle beside it, which its corner is going to meet.
TEST(PublicScenes, Navigation2_3171_PureRotationMeetsTheObstacleBesideTheRobot) {
  // The corner (0.5, 0.3) is 0.583 m from the centre: above 0.4 m from 0.216 rad on, 0.72 s of 2 s.
  const std::string post = "POLYGON ((0.3 0.4, 0.5 0.4, 0.5 0.6, 0.3 0.6))\n";
  const std::string limits = std::string(kLongBox) + " --period 2 --latency 0 --max-turn-deceleration 100";
  const json turns = monitored(R"({"pose": [0, 0, 0], "velocity": [0, 0], "turn": 0.3})", limits, post);
  EXPECT_GT(turns["share"], 0.1);
  EXPECT_LT(turns["share"], 0.6);
  EXPECT_FALSE(turns["witness"].is_null());
  const json other_way = monitored(R"({"pose": [0, 0, 0], "velocity": [0, 0], "turn": -0.01})", limits, post);
  EXPECT_EQ(other_way["share"], 1.0);
  // The same as recorded poses: clear at both, through the post between.
  const std::string rows = "t,id,x,y,theta\n0,robot,0,0,0\n10,robot,0,0,3.141592653589793\n";
  EXPECT_EQ(checked(rows, std::string(kLongBox) + " --between none", post).status, 0);
  EXPECT_EQ(checked(rows, kLongBox, post).status, 1);
}

// ros-navigation/navigation2 4355: the projection begins with the first step, so that an obstacle that is in the
// polygon already is passed over where a step is long.
TEST(PublicScenes, Navigation2_4355_WhatIsInThePolygonAtTimeZeroCounts) {
  // A post of 4 cm, inside the nose now; a step of 1 s at 1.5 m/s leaves it behind.
  const std::string post = "POLYGON ((0.42 -0.02, 0.46 -0.02, 0.46 0.02, 0.42 0.02))\n";
  const json ahead = monitored(R"({"pose": [0, 0, 0], "velocity": [1.5, 0], "turn": 0})", kLongBox, post);
  EXPECT_TRUE(ahead["in_contact"]);
  EXPECT_LT(ahead["share"], 1e-6);
  const json back = monitored(R"({"pose": [0, 0, 0], "velocity": [-1.5, 0], "turn": 0})", kLongBox, post);
  EXPECT_TRUE(back["in_contact"]);
  EXPECT_EQ(back["share"], 1.0);
}

// ros-navigation/navigation2 6346: a projection of 3 s at the present velocity brakes for a wall that the robot means
// to stop in front of; a shorter one would see people too late. A trajectory says where the robot stops.
TEST(PublicScenes, Navigation2_6346_ATrajectoryThatStopsAtAWallIsClearAndAPersonOnItIsNot) {
  // At 0.5 m/s towards a wall 1 m ahead of the nose, slower on the last half metre, at rest 0.1 m before it.
  const std::string wall = "LINESTRING (1.5 -2, 1.5 2)\n";
  const std::string limits = std::string(kLongBox) + " --max-deceleration 0.5 --latency 0.1";
  const json projected = monitored(R"({"pose": [0, 0, 0], "velocity": [0.5, 0]})", limits + " --period 3", wall);
  EXPECT_LT(projected["share"], 1.0) << "as the reported projection says";
  const std::string way = R"("trajectory": [[0, 0, 0, 0], [1, 0.5, 0, 0], [3, 0.9, 0, 0], [4, 0.9, 0, 0]])";
  const json planned = monitored("{" + way + "}", limits, wall);
  EXPECT_TRUE(planned["proven"]);
  EXPECT_EQ(planned["share"], 1.0);
  // A person stands on the way, or may step onto it.
  for (const char* person : {R"("position": [1.2, 0], "radius": 0.2, "max_speed": 0)",
                             R"("position": [1.5, 1.5], "radius": 0.2, "max_speed": 0.4)"}) {
    const json braked = monitored("{" + way + R"(, "movers": [{"id": "person", )" + person + "}]}", limits, wall);
    EXPECT_TRUE(braked["proven"]) << person;
    EXPECT_LT(braked["share"], 1.0) << person;
    EXPECT_EQ(braked["witness"]["mover"], "person") << person;
  }
}

// flexible-collision-library/fcl 120: conservative advancement reports no contact for two boxes of which one is moved
// through the other.
TEST(PublicScenes, Fcl_120_ABoxThatIsMovedThroughABoxMeetsIt) {
  const std::string rows = "t,id,x,y\n0,a,-5,0\n0,b,0,0\n1,a,5,0\n1,b,0,0\n";
  const Outcome outcome = checked(rows, "--footprint 'POLYGON ((-0.5 -0.5, 0.5 -0.5, 0.5 0.5, -0.5 0.5))'");
  EXPECT_EQ(outcome.status, 1);
  // 1 m between the centres: from 0.4 s to 0.6 s.
  EXPECT_THAT(outcome.out, HasSubstr("overlap: a and b, from 0.4 s to 0.6 s"));
}

// flexible-collision-library/fcl 555: two boxes that come towards each other; signed bounds of both ways cancel, and
// the step goes past the contact.
TEST(PublicScenes, Fcl_555_BoxesThatComeTowardsEachOtherMeet) {
  const std::string rows = "t,id,x,y,theta\n0,a,0,-3,0\n0,b,0,3,0\n1,a,0,3,0\n1,b,0,-3,0\n";
  const std::string box = "--footprint 'POLYGON ((-1 -1, 1 -1, 1 1, -1 1))'";
  const Outcome outcome = checked(rows, box);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("overlap: a and b, from 0.333333 s to 0.666667 s"));
  // The same while both turn: corners meet before faces do.
  const std::string turning = "t,id,x,y,theta\n0,a,0,-3,0\n0,b,0,3,0\n1,a,0,3,1.5\n1,b,0,-3,-1.5\n";
  const Outcome turns = checked(turning, box + " --json");
  EXPECT_EQ(turns.status, 1);
  const json event = json::parse(turns.out.substr(0, turns.out.find('\n')));
  EXPECT_EQ(event["event"], "overlap");
  EXPECT_LT(event["first"][1], 0.333);
}

// ZJU-FAST-Lab/EGO-Planner-v2 59: two drones meet sooner than one can brake, and the check plans anew before it brakes.
TEST(PublicScenes, EgoPlanner2_59_NotEnoughTimeToBrakeIsReported) {
  // 2 m/s, 1 m/s^2: 2 m to brake. The wall is 1 m ahead.
  const std::string limits = "--radius 0.2 --period 0.1 --latency 0.1 --max-deceleration 1";
  const std::string line = R"({"trajectory": [[0, 0, 0, 0], [1, 2, 0, 0]]})";
  const json late = monitored(line, limits, "LINESTRING (1.2 -1, 1.2 1)\n");
  EXPECT_FALSE(late["proven"]);
  EXPECT_EQ(late["share"], 0.0);
  const json early = monitored(line, limits, "LINESTRING (4 -1, 4 1)\n");
  EXPECT_TRUE(early["proven"]);
  EXPECT_GT(early["share"], 0.5);
}

// ZJU-FAST-Lab/EGO-Planner-v2 60: only the first three quarters of a trajectory are checked.
TEST(PublicScenes, EgoPlanner2_60_TheLastQuarterOfATrajectoryIsChecked) {
  // Polynomials, x and y: one goes east at 1 m/s for 4 s; the other rests at (3.5, 0).
  const std::string head =
      "duration,x^0,x^1,x^2,x^3,x^4,x^5,x^6,x^7,y^0,y^1,y^2,y^3,y^4,y^5,y^6,y^7,z^0,z^1,z^2,z^3,z^4,"
      "z^5,z^6,z^7,yaw^0,yaw^1,yaw^2,yaw^3,yaw^4,yaw^5,yaw^6,yaw^7\n";
  std::string rest;
  for (int k = 0; k < 16; ++k) rest += ",0";
  const Workplace here;
  here.write("east.csv", head + "4,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0" + rest + "\n");
  here.write("rests.csv", head + "4,3.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0" + rest + "\n");
  const Outcome outcome = here.run("check east.csv rests.csv --radius 0.1");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("from 3.3 s to 3.7 s"));
}

// ZJU-FAST-Lab/Swarm-Formation 35: the loop over the future compares the present places.
TEST(PublicScenes, SwarmFormation35_DronesThatAreFarApartNowMeetLater) {
  const std::string rows = "t,id,x,y\n0,one,-4,0\n0,two,0,-4\n4,one,4,0\n4,two,0,4\n";
  EXPECT_EQ(checked(rows, "--radius 0.25 --between none").status, 0) << "5.7 m apart at both rows";
  const Outcome outcome = checked(rows, "--radius 0.25");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("overlap: one and two"), HasSubstr("deep at 2 s, at (0, 0)")));
}

// ZJU-FAST-Lab/Swarm-Formation 36: a new trajectory begins where the drone was when planning began: a jump of 1.093 m
// in 2.547 ms, and 1.302 ms later a warning about another drone.
TEST(PublicScenes, SwarmFormation36_AJumpBetweenTwoTrajectoriesIsFoundAndWhatItCrossesToo) {
  std::string rows = "t,id,x,y\n";
  const auto row = [&](double t, const char* id, double x, double y) {
    std::ostringstream line;
    line.precision(17);
    line << t << "," << id << "," << x << "," << y << "\n";
    rows += line.str();
  };
  for (int k = 0; k <= 20; ++k) row(0.1 * k, "one", 0.1 * k, 0.0);
  row(2.0 + 0.002547, "one", 2.0 - 1.093, 0.0);
  for (int k = 1; k <= 10; ++k) row(2.0 + 0.1 * k, "one", 2.0 - 1.093 + 0.1 * k, 0.0);
  // Beside the way, in the middle of the jump; away before and after it.
  row(1.9, "three", 1.45, 3.0);
  row(2.001, "three", 1.45, 0.1);
  row(2.1, "three", 1.45, -3.0);
  const Outcome outcome = checked(rows, "--radius 0.15 --max-speed 50");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("jump: one, line 23: 1.093 m in 0.002547 s, 429.132 m/s"),
                                 HasSubstr("overlap: one and three, from 2.00")));
}

}  // namespace
}  // namespace exactvo::test
