// SPDX-License-Identifier: GPL-3.0-or-later
// simulate --engine crowd as a user meets it, with audit and convert of what it records.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kRing = R"({"name": "ring", "time_step": 0.25, "time_limit": 60, "horizons": {"least": 0.5},
  "robots": [{"circle": {"count": 40, "radius": 20}, "max_speed": 1.5}],
  "obstacles": [{"polygon": [[4, 4], [6, 4], [6, 6], [4, 6]]}]})";

TEST(CrowdVerb, ARunIsRecordedAuditedAndConverted) {
  const Workplace here;
  here.write("ring.json", kRing);
  const Outcome run = here.run("simulate ring.json --engine crowd --record ring.evr --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json metrics = json::parse(run.out);
  EXPECT_EQ(metrics["robots"], 40);
  EXPECT_EQ(metrics["arrived"], 40);
  EXPECT_EQ(metrics["provenance"]["inputs"][0]["path"], "ring.json");
  const json same = json::parse(here.run("simulate ring.json --engine crowd --threads 2 --no-figures --json").out);
  EXPECT_EQ(same["digest"], metrics["digest"]);

  const Outcome audit = here.run("audit ring.evr --json");
  EXPECT_EQ(audit.status, 0) << audit.out;
  EXPECT_EQ(json::parse(audit.out)["motions"], 40 * metrics["steps"].get<int>());
  EXPECT_EQ(here.run("audit ring.evr --sample 100").status, 0);
  EXPECT_EQ(here.run("convert ring.evr ring.csv").status, 0);
  EXPECT_THAT(here.read("ring.csv"), HasSubstr("\n0,0,0,20,0,1,\"G1/1\"\n"));

  const std::string whole = here.read("ring.evr");
  here.write("cut.evr", whole.substr(0, whole.size() / 2));
  const Outcome cut = here.run("audit cut.evr");
  EXPECT_EQ(cut.status, 1);
  EXPECT_THAT(cut.out, HasSubstr("cut.evr: the file was cut off after the last row"));
  const Outcome table = here.run("convert cut.evr cut.csv");
  EXPECT_EQ(table.status, 1);
  EXPECT_THAT(table.err, HasSubstr("cut.evr: the file was cut off after the last of these rows"));
  EXPECT_TRUE(here.has("cut.csv"));
}

TEST(CrowdVerb, WhoRunsManyRobotsOnTheStandardEngineIsToldOfTheCrowd) {
  const Workplace here;
  const auto run = [&](int robots, const std::string& more, const std::string& options) {
    here.write("many.json", R"({"name": "many", "time_limit": 0.05, "robots": [{"circle": {"count": )" +
                                std::to_string(robots) + R"(, "radius": 300}}])" + more + "}");
    const Outcome outcome = here.run("simulate many.json " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.err;
  };
  const auto is_told = HasSubstr("note: 500 robots: --engine crowd can be");
  EXPECT_THAT(run(500, "", ""), is_told);
  EXPECT_THAT(run(499, "", ""), Not(HasSubstr("--engine crowd")));
  EXPECT_EQ(run(500, "", "--quiet"), "");
  EXPECT_THAT(run(500, "", "--engine crowd"), Not(HasSubstr("--engine crowd")));
  EXPECT_THAT(run(500, R"(, "speed_bound": "box")", ""), Not(HasSubstr("--engine crowd"))) << "no crowd can run it";
  EXPECT_THAT(run(500, R"(, "liveness": "plan")", ""), Not(HasSubstr("--engine crowd"))) << "nor make plans";
}

TEST(CrowdVerb, AuditOfAFolderTakesRecordingsOfBothKinds) {
  const Workplace here;
  here.write("ring.json", kRing);
  here.write("one.json", R"({"name": "one", "robots": [{"id": "R", "position": [0, 0], "goal": [3, 0]}]})");
  ASSERT_EQ(here.run("simulate one.json --no-figures --out all/one").status, 0);
  ASSERT_EQ(here.run("simulate ring.json --engine crowd --record all/ring.evr").status, 0);
  const Outcome both = here.run("audit all --json");
  EXPECT_EQ(both.status, 0) << both.err;
  const json verdict = json::parse(both.out);
  EXPECT_GT(verdict["steps"].get<int>(), 10);
  EXPECT_GT(verdict["crowds"]["motions"].get<int>(), 1000);
  EXPECT_TRUE(verdict["crowds"]["clean"].get<bool>());
  EXPECT_EQ(here.run("audit all --sample 100").status, 0);
  here.write("all/b.evr", here.read("all/ring.evr").substr(0, 3000));
  const Outcome cut = here.run("audit all");
  EXPECT_EQ(cut.status, 1);
  EXPECT_THAT(cut.out, HasSubstr("all/b.evr: the file was cut off"));
  EXPECT_EQ(here.run("audit all --scenario one.json").status, 2);
  EXPECT_EQ(here.run("audit all/one --sample 100").status, 2);
}

TEST(CrowdVerb, VerbsThatNeedDecisionsOrAScenarioSayWhatARecordingOfACrowdIs) {
  const Workplace here;
  here.write("ring.json", kRing);
  ASSERT_EQ(here.run("simulate ring.json --engine crowd --record ring.evr --every 100").status, 0);
  for (const char* arguments :
       {"explain ring.evr --time 1 --robot 0", "trap ring.evr", "simulate ring.evr --out out"}) {
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("the recording of a crowd (.evr)")) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("audit, convert, draw and view read recordings of crowds")) << arguments;
  }
}

TEST(CrowdVerb, ViewSaysOnStderrThatARecordingWasCutOff) {
  const Workplace here;
  here.write("ring.json", kRing);
  ASSERT_EQ(here.run("simulate ring.json --engine crowd --record ring.evr").status, 0);
  EXPECT_THAT(here.run("view ring.evr --out whole.html").err, testing::Not(HasSubstr("cut off")));
  here.write("cut.evr", here.read("ring.evr").substr(0, 3000));
  const Outcome outcome = here.run("view cut.evr --out cut.html");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: cut.evr: the recording was cut off after its last whole row"));
}

TEST(CrowdVerb, WhatDoesNotFitIsRefusedAndNothingIsWritten) {
  const Workplace here;
  here.write("ring.json", kRing);
  here.write("box.json",
             R"({"name": "b", "speed_bound": "box", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}]})");
  here.write("slow.json", R"({"name": "s", "robots": [{"id": "A", "position": [0, 0], "goal": [9, 0]},
      {"id": "B", "position": [5, 5], "goal": [9, 0], "max_speed": 1e-6}]})");
  const std::pair<const char*, const char*> cases[] = {
      {"simulate ring.json --engine crwd", "one of standard crowd; did you mean 'crowd'?"},
      {"simulate ring.json --record out.evr",
       "--record: found 'out.evr', expected - for stdout, or a pipe; --out DIR writes a recording to disk"},
      {"simulate ring.json --record out.jsonl --out out", "--record cannot be combined with --out: --out DIR already"},
      {"simulate ring.json --engine crowd --method ivo", "--method: found 'ivo', expected orca"},
      {"simulate ring.json --engine crowd --out out", "--out cannot be combined with --engine crowd: a crowd is"},
      {"simulate ring.json --engine crowd --record-all",
       "--record-all cannot be combined with --engine crowd: only the standard engine has that option"},
      {"simulate ring.json --every 3", "--every needs --engine crowd: only that engine has the option"},
      {"simulate ring.json --engine crowd --record ring.json",
       "--record: found 'ring.json', expected a name that ends in .evr"},
      {"simulate ring.json --engine crowd --precision half", "float or double"},
      {"simulate ring.json --engine crowd --every 0 --record out.evr",
       "--every: found '0', expected a whole number from 1 to 1000000"},
      {"simulate slow.json --engine crowd", "slow.json: robot B: max_speed: found "},
      {"simulate box.json --engine crowd --record out.evr", "/speed_bound"},
      {"audit ring.json --sample 3", ".evr"},
      {"audit none.evr", "E_FILE_MISSING"},
      {"convert none.evr out.geojson", "FILE.csv"},
      {"convert none.evr out.csv", "E_FILE_MISSING"}};
  for (const auto& [arguments, words] : cases) {
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << arguments;
    EXPECT_TRUE(outcome.out.empty()) << arguments;
    EXPECT_FALSE(here.has("out") || here.has("out.evr") || here.has("out.csv")) << arguments;
  }
}

TEST(CrowdVerb, ARunNamesRobotsWithoutARouteAndTheReason) {
  const Workplace here;
  here.write("locked.json", R"({"name": "locked", "time_limit": 20, "horizons": {"least": 0.5}, "liveness": "off",
      "robots": [{"id": "free", "position": [-3, 0], "goal": [-9, 0]}, {"id": "locked", "position": [20, 0], "goal": [0, 8]}],
      "obstacles": [{"id": "box", "polyline": [[18, -2], [22, -2], [22, 2], [18, 2], [18, -2]]}]})");
  const Outcome words = here.run("simulate locked.json --engine crowd");
  EXPECT_EQ(words.status, 0) << words.err;
  EXPECT_THAT(words.out, HasSubstr("1 of 2 robots arrived, 1 without a route\n  no route     locked: "));
  EXPECT_THAT(words.out, HasSubstr("box"));
  const json metrics = json::parse(here.run("simulate locked.json --engine crowd --json").out);
  ASSERT_EQ(metrics["without_route"].size(), 1U);
  EXPECT_EQ(metrics["without_route"][0]["robot"], "locked");
  EXPECT_FALSE(metrics["without_route"][0]["why"].get<std::string>().empty());
  // Both goals are one place: the robot that comes second pushes off the first.
  here.write("one.json",
             R"({"name": "one", "time_limit": 60, "guidance": "none", "horizons": {"least": 0.5}, "liveness": "off",
      "robots": [{"id": "a", "position": [-2, 0], "goal": [0, 0]}, {"id": "b", "position": [12, 0.1], "goal": [0, 0]}]})");
  const json one = json::parse(here.run("simulate one.json --engine crowd --json").out);
  EXPECT_EQ(one["arrived"], 1) << one;
}

TEST(CrowdVerb, WhoseGoalIsTakenStaysBesideItAndARunThatStandsStillEnds) {
  const Workplace here;
  here.write("one.json", R"({"name": "one", "time_limit": 60, "horizons": {"least": 0.5},
      "robots": [{"id": "a", "position": [-2, 0], "goal": [0, 0]}, {"id": "b", "position": [12, 0.1], "goal": [0, 0]}]})");
  const Outcome words = here.run("simulate one.json --engine crowd");
  EXPECT_THAT(words.out, HasSubstr("1 of 2 robots arrived, 0 without a route, 1 whose goal is taken\n"
                                   "  goal taken   b: stays: a was first at the goal that both have"));
  const json one = json::parse(here.run("simulate one.json --engine crowd --json").out);
  EXPECT_EQ(one["goal_taken"],
            json::parse(
                R"([{"robot": "b", "why": "stays: a was first at the goal that both have, which leaves no room for both"}])"));
  EXPECT_LT(one["time"], 20.0);
  here.write("street.json", R"({"name": "street", "liveness": "bias", "robots": [
      {"id": "a", "position": [0, 0], "goal": [10, 0], "radius": 0.3}, {"id": "b", "position": [10, 0], "goal": [0, 0], "radius": 0.3}],
      "obstacles": [{"id": "u", "polyline": [[-2, 0.5], [12, 0.5]]}, {"id": "l", "polyline": [[-2, -0.5], [12, -0.5]]}]})");
  EXPECT_THAT(here.run("simulate street.json --engine crowd").out, HasSubstr("  standstill   2 robots: nothing moves"));
  EXPECT_EQ(json::parse(here.run("simulate street.json --engine crowd --json").out)["stands_still"], true);
}

TEST(CrowdVerb, DrawMakesMapsAndSaysThatARecordingWasCutOff) {
  const Workplace here;
  here.write("ring.json", kRing);
  ASSERT_EQ(here.run("simulate ring.json --engine crowd --record ring.evr").status, 0);
  const Outcome drawn = here.run("draw ring.evr --out maps");
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  for (const char* name : {"density", "flow", "speed", "speeds", "paths"}) {
    EXPECT_TRUE(here.has(std::string("maps/") + name + ".dat")) << name;
    EXPECT_TRUE(here.has(std::string("maps/") + name + ".gp")) << name;
  }
  here.write("cut.evr", here.read("ring.evr").substr(0, 3000));
  const Outcome cut = here.run("draw cut.evr --out cut");
  EXPECT_EQ(cut.status, 1);
  EXPECT_THAT(cut.err, HasSubstr("cut.evr: the file was cut off after the last of the rows drawn"));
}

/// Killed after longer and longer times, and each time gone on with.
TEST(CrowdVerb, AKilledRunGoesOnToTheSameBytes) {
  const Workplace here;
  here.write("ring.json", R"({"name": "ring", "time_step": 0.05, "time_limit": 60, "horizons": {"least": 0.3},
    "robots": [{"circle": {"count": 400, "radius": 100}, "max_speed": 1.5}],
    "moving_obstacles": [{"id": "tram", "polygon": [[-1, -9], [1, -9], [1, -6], [-1, -6]], "path": [[0, -7], [0, 70]], "speed": 1.3}]})");
  const std::string options = "simulate ring.json --engine crowd --guidance none --every 10 --json";
  const Outcome whole = here.run(options + " --record whole.evr");
  ASSERT_EQ(whole.status, 0) << whole.err;
  json expected = json::parse(whole.out);
  const std::string run = options + " --record killed.evr --snapshot-every 25 --resume";
  Outcome outcome;
  int kills = 0;
  for (int hundredths = 2;; hundredths += 3) {
    outcome = here.run(run, "timeout -s KILL " + std::to_string(0.01 * std::min(hundredths, 90)));
    if (outcome.status == 0 || kills > 200) break;
    ++kills;
    // A kill may come when the recording stands in its place and the program has not ended yet.
    EXPECT_TRUE(!here.has("killed.evr") || here.read("killed.evr") == here.read("whole.evr"));
  }
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(kills, 0);
  EXPECT_TRUE(here.read("killed.evr") == here.read("whole.evr"));
  EXPECT_FALSE(here.has("killed.evr.snapshot"));
  EXPECT_FALSE(here.has("killed.evr.unfinished"));
  json found = json::parse(outcome.out);
  for (json* metrics : {&expected, &found})
    for (const char* key : {"wall_time", "provenance"}) metrics->erase(key);
  EXPECT_EQ(found, expected);
}

TEST(CrowdVerb, ASnapshotOfAnotherRunIsRefused) {
  const Workplace here;
  here.write("ring.json", kRing);
  const std::string run = "simulate ring.json --engine crowd --record ring.evr --snapshot-every 5 --resume";
  Outcome killed;
  for (int tries = 0; tries < 50 && !here.has("ring.evr.snapshot"); ++tries)
    killed = here.run(run + " --every 1", "timeout -s KILL 0.0" + std::to_string(3 + tries % 7));
  if (!here.has("ring.evr.snapshot")) GTEST_SKIP() << "never killed in time";
  const Outcome other = here.run(run + " --every 2");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("the snapshot of another run"));
  EXPECT_EQ(here.run("simulate ring.json --engine crowd --record ring.evr").status, 0) << "without snapshots";
  EXPECT_EQ(here.run(run + " --every 1").status, 0);
}

TEST(CrowdVerb, OptionsOfSnapshotsNeedEachOther) {
  const Workplace here;
  here.write("ring.json", kRing);
  const Outcome alone = here.run("simulate ring.json --engine crowd --snapshot-every 5");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("--snapshot-every needs --record FILE.evr: a snapshot"));
  const Outcome resume = here.run("simulate ring.json --engine crowd --record ring.evr --resume");
  EXPECT_EQ(resume.status, 2);
  EXPECT_THAT(resume.err, HasSubstr("--resume needs --snapshot-every N: "));
  EXPECT_EQ(here.run("simulate ring.json --resume").status, 2) << "of the standard engine";
}

}  // namespace
}  // namespace exactvo::test
