// SPDX-License-Identifier: GPL-3.0-or-later
// simulate without recorded decisions as a user meets it, with audit and convert of what it records.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "run_program.h"
#include "support/forged_crowd.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kRing = R"({"name": "ring", "time_step": 0.25, "time_limit": 90, "horizons": {"least": 0.5},
  "robots": [{"circle": {"count": 40, "radius": 20}, "max_speed": 1.5}],
  "obstacles": [{"polygon": [[4, 4], [6, 4], [6, 6], [4, 6]]}]})";

TEST(CrowdVerb, ARunIsRecordedAuditedAndConverted) {
  const Workplace here;
  here.write("ring.json", kRing);
  const Outcome run = here.run("simulate ring.json --decisions none --record ring.evr --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json metrics = json::parse(run.out);
  EXPECT_EQ(metrics["robots"].size(), 40U);
  EXPECT_EQ(metrics["arrived"], 40);
  EXPECT_EQ(metrics["provenance"]["inputs"][0]["path"], "ring.json");
  const json same = json::parse(here.run("simulate ring.json --decisions none --threads 2 --no-figures --json").out);
  EXPECT_EQ(same["digest"], metrics["digest"]);

  const Outcome audit = here.run("audit ring.evr --json");
  EXPECT_EQ(audit.status, 0) << audit.out;
  EXPECT_EQ(json::parse(audit.out)["steps"], 40 * (metrics["steps"].get<int>() + 1));
  EXPECT_EQ(here.run("audit ring.evr --sample 100").status, 0);
  EXPECT_EQ(here.run("convert ring.evr ring.csv").status, 0);
  EXPECT_THAT(here.read("ring.csv"), HasSubstr("\n0,0,0,20,0,1,\"G1/1\"\n"));

  const std::string whole = here.read("ring.evr");
  here.write("cut.evr", whole.substr(0, whole.size() / 2));
  const Outcome cut = here.run("audit cut.evr");
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.err, HasSubstr("[E_CUT_OFF]"));
  EXPECT_THAT(cut.out, HasSubstr("motions keep clear of everything: "));
  const Outcome table = here.run("convert cut.evr cut.csv");
  EXPECT_EQ(table.status, 1);
  EXPECT_THAT(table.err, HasSubstr("cut.evr: the file was cut off after the last of these rows"));
  EXPECT_TRUE(here.has("cut.csv"));
}

TEST(CrowdVerb, ManyRobotsAreRunWithoutRecordedDecisionsUnlessSomethingNeedsThem) {
  const Workplace here;
  const auto run = [&](int robots, const std::string& more, const std::string& options) {
    here.write("many.json", R"({"name": "many", "time_limit": 0.05, "robots": [{"circle": {"count": )" +
                                std::to_string(robots) + R"(, "radius": 300}}])" + more + "}");
    const Outcome outcome = here.run("simulate many.json --json " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const json metrics = json::parse(outcome.out);
    return std::pair(metrics["decisions"]["recorded"].get<std::string>() + " " + metrics["method"].get<std::string>(),
                     outcome.err);
  };
  const std::string box = R"(, "speed_bound": "box")";
  const std::tuple<int, std::string, std::string, std::string, std::string> cases[] = {
      {200, "", "", "none orca",
       "200 robots: places are recorded, not decisions, and the method is orca; --decisions binding"},
      {199, "", "", "binding ivo", ""},
      {200, "", "--quiet", "none orca", ""},
      {200, "", "--method orca", "none orca", "200 robots: places are recorded"},
      {200, "", "--method ivo", "binding ivo", "since --method ivo asks for it: that may take long; --decisions none"},
      {200, "", "--decisions binding", "binding ivo", ""},
      {200, "", "--decisions all", "all ivo", ""},
      {199, "", "--decisions none", "none orca", ""},
      {200, box, "", "binding ivo", "200 robots, and decisions are recorded, since /speed_bound is box"},
      {200, R"(, "liveness": "plan")", "", "none orca", "200 robots: places are recorded"}};
  for (const auto& [robots, more, options, made, words] : cases) {
    const auto [found, said] = run(robots, more, options);
    EXPECT_EQ(found, made) << robots << more << options;
    if (words.empty())
      EXPECT_THAT(said, Not(HasSubstr("robots"))) << robots << more << options;
    else
      EXPECT_THAT(said, HasSubstr(words)) << robots << more << options;
  }
}

// What `explain` computes again is the run that was made.
TEST(CrowdVerb, MetricsNameTheLivenessThatTheRunHad) {
  const Workplace here;
  here.write("ring.json", kRing);
  for (const char* liveness : {"off", "bias", "plan"}) {
    const Outcome run =
        here.run(std::string("simulate ring.json --json --decisions none --guidance none --liveness ") + liveness);
    ASSERT_EQ(run.status, 0) << run.err;
    const json said = json::parse(run.out)["liveness"];
    EXPECT_EQ(said.is_null() ? "off" : said.get<std::string>(), liveness);
  }
}

/// Members that both kinds of run have, in one order.
TEST(CrowdVerb, MetricsHaveTheSameMembersWithAndWithoutDecisions) {
  const Workplace here;
  here.write("ring.json", kRing);
  const auto metrics_of = [&](const std::string& decisions) {
    const Outcome run = here.run("simulate ring.json --json --decisions " + decisions);
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::ordered_json::parse(run.out);
  };
  const auto keys_of = [](const nlohmann::ordered_json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
  };
  const auto with = metrics_of("binding"), without = metrics_of("none");
  EXPECT_EQ(keys_of(with), keys_of(without));
  EXPECT_EQ(keys_of(with["decisions"]), keys_of(without["decisions"]));
  EXPECT_GT(keys_of(with).size(), 30U);
  for (const auto* m : {&with, &without}) {
    EXPECT_EQ((*m)["robots"].size(), 40U);
    EXPECT_EQ((*m)["arrived"], 40);
    EXPECT_EQ((*m)["outcome"], "all robots arrived");
    EXPECT_EQ((*m)["decisions"]["count"], 40 * (*m)["steps"].get<int>());
    EXPECT_EQ((*m)["time"], 0.25 * (*m)["steps"].get<int>());
    EXPECT_GE((*m)["min_robot_clearance"].get<double>(), 0.0);
    EXPECT_GT((*m)["robots"][3]["min_obstacle_clearance"].get<double>(), 0.0);
    EXPECT_GT((*m)["robots"][3]["detour"].get<double>(), 0.0);
    EXPECT_EQ(keys_of((*m)["robots"][3]), keys_of(with["robots"][0]));
  }
  EXPECT_TRUE(with["decisions"]["cut_short"].is_null());
  EXPECT_TRUE(without["decisions"]["active_set_switches"].is_null());
}

TEST(CrowdVerb, AFolderOfARunWithoutDecisionsHasAllThatOneWithThemHas) {
  const Workplace here;
  here.write("ring.json", kRing);
  const Outcome run =
      here.run("simulate ring.json --decisions none --out out --fail-on-collision --fail-unless-arrived");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto files = here.files("out");
  for (const char* name : {"recording.evr", "metrics.json", "trajectory.csv", "explorer.html", "figures/density.dat"})
    EXPECT_EQ(files.count(name), 1U) << name;
  EXPECT_EQ(here.run("audit out").status, 0);
  EXPECT_EQ(here.run("view out --out page.html").status, 0);
  EXPECT_EQ(here.run("draw out --out maps").status, 0);
  EXPECT_TRUE(here.has("maps/flow.dat"));
  // The decision is computed again, and is the one that was carried out.
  const Outcome explained = here.run("explain out --time 4 --robot G1/7 --json");
  ASSERT_EQ(explained.status, 0) << explained.err;
  const json decision = json::parse(explained.out);
  EXPECT_GT(decision["half_planes"].size(), 5U);
  const auto place = [&](int step) {
    const std::string table = here.read("out/trajectory.csv"), row = "\n" + std::to_string(step) + ",";
    std::size_t at = table.find(row);
    while (table.compare(table.find('\n', at + 1) - 6, 6, "\"G1/7\"") != 0) at = table.find(row, at + 1);
    std::istringstream cells(table.substr(at + 1));
    std::vector<std::string> cell(5);
    for (std::string& c : cell) std::getline(cells, c, ',');
    return std::pair(std::stod(cell[3]), std::stod(cell[4]));
  };
  const auto [x, y] = place(16);
  const auto [next_x, next_y] = place(17);
  EXPECT_EQ(decision["position"], json({x, y}));
  EXPECT_NEAR(decision["chosen"][0].get<double>(), 4.0 * (next_x - x), 1e-9);
  EXPECT_NEAR(decision["chosen"][1].get<double>(), 4.0 * (next_y - y), 1e-9);
  EXPECT_EQ(here.run("explain ring.json --decisions none --time 4 --robot G1/7 --json").out, explained.out);
  EXPECT_EQ(here.run("explain out --time 1000 --robot 0").status, 2);
  EXPECT_EQ(here.run("view ring.json --decisions none --out made.html").status, 0);
  here.write("ring.json", std::string(kRing) + " ");
  EXPECT_THAT(here.run("explain out --time 4 --robot 0").err, HasSubstr("or was changed, expected explain SCENARIO"));
  here.write("ring.json", kRing);
  // Another run of the same scenario, whose recording and table replace these.
  EXPECT_THAT(here.run("simulate ring.json --decisions binding --no-figures --out out").err, HasSubstr("E_OTHER_RUN"));
  EXPECT_EQ(here.run("simulate ring.json --decisions binding --no-figures --force --out out").status, 0);
  EXPECT_TRUE(here.has("out/recording.jsonl"));
  EXPECT_FALSE(here.has("out/recording.evr") || here.has("out/explorer.html"));
}

constexpr const char* kPillar = R"({"name": "pillar", "time_limit": 30, "guidance": "none",
  "robots": [{"id": "a", "position": [-4, 0.1], "goal": [6, 0]}],
  "obstacles": [{"id": "wall", "polyline": [[-5, 3], [6, 3]]}, {"id": "pillar", "disc": {"centre": [0, 0], "radius": 0.5}}],
  "moving_obstacles": [{"id": "cart", "disc": {"centre": [0, -3], "radius": 0.5}, "velocity": [0, 0.1]}]})";

TEST(CrowdVerb, ExplainNamesDiscsAtRestAndMovingObstacles) {
  const Workplace here;
  here.write("pillar.json", kPillar);
  const Outcome explained = here.run("explain pillar.json --decisions none --time 1 --robot a");
  ASSERT_EQ(explained.status, 0) << explained.err;
  EXPECT_THAT(explained.out, HasSubstr("of obstacle pillar"));
  EXPECT_THAT(explained.out, HasSubstr("moving obstacle cart"));
  std::string alone = kPillar;
  alone.erase(alone.find(",\n  \"moving_obstacles\""));
  here.write("alone.json", alone + "}");
  const Outcome resting = here.run("explain alone.json --decisions none --time 1 --robot a");
  ASSERT_EQ(resting.status, 0) << resting.err;
  EXPECT_THAT(resting.out, HasSubstr("of obstacle pillar"));
  EXPECT_THAT(resting.out, Not(HasSubstr("moving obstacle")));
  // The pillar is the only body there.
  const json counts = json::parse(here.run("simulate alone.json --decisions none --json").out)["decisions"];
  EXPECT_GT(counts["against_bodies"], 0);
  EXPECT_THAT(here.run("simulate alone.json --decisions none").out,
              HasSubstr(" against bodies (discs at rest and moving obstacles)\n"));
}

/// The word "double" stands in the command lines of both; the decisions differ in their last bits.
TEST(CrowdVerb, ExplainTakesThePrecisionFromItsOptionAlone) {
  const Workplace here;
  here.write("ring.json", kRing);
  const auto half_planes = [&](const std::string& folder, const std::string& precision) {
    EXPECT_EQ(here.run("simulate ring.json --decisions none --no-figures" + precision + " --out " + folder).status, 0);
    const Outcome explained = here.run("explain " + folder + " --time 4 --robot G1/7 --json");
    EXPECT_EQ(explained.status, 0) << explained.err;
    return json::parse(explained.out)["half_planes"];
  };
  const json expected = half_planes("single", "");
  EXPECT_EQ(half_planes("double-0", ""), expected);
  EXPECT_EQ(half_planes("double-1", " --precision float"), expected);
  EXPECT_NE(half_planes("fine-0", " --precision double"), expected);
  EXPECT_NE(half_planes("fine-1", " --precision=double"), expected);
}

TEST(CrowdVerb, ExplainRefusesARunWhoseMapWasChanged) {
  const Workplace here;
  const auto map_to = [&](int x) {
    here.write("map.wkt", "POLYGON ((4 4, " + std::to_string(x) + " 4, 6 6, 4 6, 4 4))\n");
  };
  map_to(6);
  here.write("mapped.json", R"({"name": "mapped", "robots": [{"id": "a", "position": [0, 0], "goal": [3, 3]}],
    "obstacles": [{"file": "map.wkt"}]})");
  const Outcome run = here.run("simulate mapped.json --decisions none --no-figures --out out");
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string explain = "explain out --time 1 --robot a";
  EXPECT_EQ(here.run(explain).status, 0);
  map_to(7);
  const Outcome changed = here.run(explain);
  EXPECT_NE(changed.status, 0);
  EXPECT_THAT(changed.err, HasSubstr("or was changed, expected explain SCENARIO"));
}

TEST(CrowdVerb, AuditOfAFolderTakesRecordingsOfBothKinds) {
  const Workplace here;
  here.write("ring.json", kRing);
  here.write("one.json", R"({"name": "one", "robots": [{"id": "R", "position": [0, 0], "goal": [3, 0]}]})");
  ASSERT_EQ(here.run("simulate one.json --no-figures --out all/one").status, 0);
  ASSERT_EQ(here.run("simulate ring.json --decisions none --record all/ring.evr").status, 0);
  const Outcome both = here.run("audit all --json");
  EXPECT_EQ(both.status, 0) << both.err;
  const json verdict = json::parse(both.out);
  EXPECT_GT(verdict["steps"].get<int>(), 1000);
  EXPECT_GT(verdict["points"]["choices"]["proven"].get<int>(), 10) << "of the run with decisions";
  EXPECT_EQ(here.run("audit all --sample 100").status, 0);
  here.write("all/b.evr", here.read("all/ring.evr").substr(0, 3000));
  const Outcome cut = here.run("audit all");
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.err, HasSubstr("all/b.evr"));
  EXPECT_THAT(cut.err, HasSubstr("[E_CUT_OFF]"));
  EXPECT_EQ(here.run("audit all --scenario one.json").status, 2);
  EXPECT_EQ(here.run("audit all/one --sample 100").status, 2);
}

TEST(CrowdVerb, AuditOfACutOffFileFailsByWhatIsRefutedOrOpenFirst) {
  const Workplace here;
  const auto status_of = [&](std::int64_t to) {
    ForgedCrowd crowd{{{0, {{0, 0}}, {}}, {500, {{to, 0}}, {}}}, {{0.3, -5, 0.3, 5}}};
    crowd.is_whole = false;
    here.write("cut.evr", bytes_of(crowd));
    const Outcome outcome = here.run("audit cut.evr");
    EXPECT_THAT(outcome.err, HasSubstr("[E_CUT_OFF]"));
    return outcome.status;
  };
  EXPECT_EQ(status_of(0), 2) << "clear";
  EXPECT_EQ(status_of(5), 1) << "open";
  EXPECT_EQ(status_of(250), 1) << "refuted";
}

TEST(CrowdVerb, VerbsThatNeedDecisionsOrAScenarioSayWhatARecordingOfACrowdIs) {
  const Workplace here;
  here.write("ring.json", kRing);
  ASSERT_EQ(here.run("simulate ring.json --decisions none --record ring.evr --every 100").status, 0);
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
  ASSERT_EQ(here.run("simulate ring.json --decisions none --record ring.evr").status, 0);
  EXPECT_THAT(here.run("view ring.evr --out whole.html").err, testing::Not(HasSubstr("cut off")));
  here.write("cut.evr", here.read("ring.evr").substr(0, 3000));
  const Outcome outcome = here.run("view cut.evr --out cut.html");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: cut.evr: the recording was cut off after its last whole row"));
}

TEST(CrowdVerb, WhatDoesNotFitIsRefusedAndNothingIsWritten) {
  const Workplace here;
  here.write("ring.json", kRing);
  here.write("huge.json",
             R"({"name": "huge", "time_limit": 1, "robots": {"circle": {"count": 2001, "radius": 2000}}})");
  here.write("box.json",
             R"({"name": "b", "speed_bound": "box", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}]})");
  here.write("slow.json", R"({"name": "s", "robots": [{"id": "A", "position": [0, 0], "goal": [9, 0]},
      {"id": "B", "position": [5, 5], "goal": [9, 0], "max_speed": 1e-6}]})");
  const std::pair<const char*, const char*> cases[] = {
      {"simulate ring.json --decisions nne", "--decisions: found 'nne', expected one of none"},
      {"simulate ring.json --record out.evr",
       "--record out.evr needs --decisions none: a recording of decisions goes to - or a pipe"},
      {"simulate ring.json --record out.jsonl --out out", "--record cannot be combined with --out: --out DIR already"},
      {"simulate ring.json --decisions none --method ivo",
       "--method ivo cannot be combined with --decisions none: without recorded decisions the method is orca"},
      {"simulate ring.json --decisions none --record out.evr --out out", "--record cannot be combined with --out: "},
      {"simulate ring.json --every 3", "--every needs --decisions none: audit proves of recorded decisions"},
      {"simulate ring.json --precision double",
       "--precision needs --decisions none: recorded decisions are made in doubles"},
      {"simulate huge.json --fail-on-collision", "--fail-on-collision cannot be combined with a run of more than 2000"},
      {"simulate ring.json --decisions none --record ring.json",
       "--record: found 'ring.json', expected a name that ends in .evr"},
      {"simulate ring.json --decisions none --precision half", "float or double"},
      {"simulate ring.json --decisions none --every 0 --record out.evr",
       "--every: found '0', expected a whole number from 1 to 1000000"},
      {"simulate slow.json --decisions none", "slow.json: robot B: max_speed: found "},
      {"simulate box.json --decisions none --record out.evr", "/speed_bound"},
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
  const Outcome words = here.run("simulate locked.json --decisions none");
  EXPECT_EQ(words.status, 0) << words.err;
  EXPECT_THAT(words.out, HasSubstr("1 of 2 robots did not arrive; locked cannot reach its goal: "));
  EXPECT_THAT(words.out, HasSubstr("box"));
  const json metrics = json::parse(here.run("simulate locked.json --decisions none --json").out);
  ASSERT_EQ(metrics["stuck"].size(), 1U);
  EXPECT_THAT(metrics["stuck"][0].get<std::string>(), testing::StartsWith("locked cannot reach its goal: "));
  // Both goals are one place: the robot that comes second pushes off the first.
  here.write("one.json",
             R"({"name": "one", "time_limit": 60, "guidance": "none", "horizons": {"least": 0.5}, "liveness": "off",
      "robots": [{"id": "a", "position": [-2, 0], "goal": [0, 0]}, {"id": "b", "position": [12, 0.1], "goal": [0, 0]}]})");
  const json one = json::parse(here.run("simulate one.json --decisions none --json").out);
  EXPECT_EQ(one["arrived"], 1) << one;
  EXPECT_THAT(one["stuck"][0].get<std::string>(), HasSubstr("from its goal, "));
}

TEST(CrowdVerb, ARobotWhoseGoalIsTakenStaysBesideItAndARunThatStandsStillEnds) {
  const Workplace here;
  here.write("one.json", R"({"name": "one", "time_limit": 60, "horizons": {"least": 0.5},
      "robots": [{"id": "a", "position": [-2, 0], "goal": [0, 0]}, {"id": "b", "position": [12, 0.1], "goal": [0, 0]}]})");
  const Outcome words = here.run("simulate one.json --decisions none");
  EXPECT_THAT(words.out, HasSubstr("1 of 2 robots did not arrive; b stays: a was first at the goal that "
                                   "both have"));
  const json one = json::parse(here.run("simulate one.json --decisions none --json").out);
  EXPECT_EQ(one["stuck"], json::parse(R"(["b stays: a was first at the goal that both have, which )"
                                      R"(leaves no room for both"])"));
  EXPECT_LT(one["time"], 20.0);
  here.write("street.json", R"({"name": "street", "liveness": "bias", "robots": [
      {"id": "a", "position": [0, 0], "goal": [10, 0], "radius": 0.3}, {"id": "b", "position": [10, 0], "goal": [0, 0], "radius": 0.3}],
      "obstacles": [{"id": "u", "polyline": [[-2, 0.5], [12, 0.5]]}, {"id": "l", "polyline": [[-2, -0.5], [12, -0.5]]}]})");
  EXPECT_THAT(here.run("simulate street.json --decisions none").out,
              HasSubstr("; nothing moves, and every further step would repeat"));
  EXPECT_EQ(json::parse(here.run("simulate street.json --decisions none --json").out)["stands_still"], true);
}

/// Its goal on the way is taken, which it passes by resting beside it.
TEST(CrowdVerb, ARobotThatRestsBesideATakenGoalOnTheWayArrivesAtItsLast) {
  const Workplace here;
  here.write("two.json", R"({"name": "two", "time_limit": 60, "horizons": {"least": 0.5}, "robots": [
      {"id": "a", "position": [-2, 0], "goal": [0, 0]}, {"id": "b", "position": [12, 0.1], "goals": [[0, 0], [0, 5]]}]})");
  const Outcome run = here.run("simulate two.json --decisions none --fail-unless-arrived --json");
  EXPECT_EQ(run.status, 0) << run.out;
  EXPECT_EQ(json::parse(run.out)["outcome"], "all robots arrived");
}

TEST(CrowdVerb, DrawMakesMapsAndSaysThatARecordingWasCutOff) {
  const Workplace here;
  here.write("ring.json", kRing);
  ASSERT_EQ(here.run("simulate ring.json --decisions none --record ring.evr").status, 0);
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
  const std::string options = "simulate ring.json --decisions none --guidance none --every 10 --json";
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

TEST(CrowdVerb, AFolderOfAKilledRunIsThatOfAWholeOne) {
  const Workplace here;
  here.write("ring.json", R"({"name": "ring", "time_step": 0.05, "time_limit": 60, "horizons": {"least": 0.3},
    "robots": [{"circle": {"count": 400, "radius": 100}, "max_speed": 1.5}]})");
  const std::string options = "simulate ring.json --guidance none --no-figures --every 10 --json";
  const Outcome whole = here.run(options + " --out whole");
  ASSERT_EQ(whole.status, 0) << whole.err;
  const std::string run = options + " --out deep/killed --snapshot-every 25 --resume";
  Outcome outcome;
  int kills = 0;
  for (int tenths = 1; outcome = here.run(run, "timeout -s KILL " + std::to_string(0.1 * tenths)), outcome.status != 0;
       ++tenths) {
    ASSERT_LT(++kills, 200) << outcome.err;
    EXPECT_FALSE(here.has("deep/killed/metrics.json"));
  }
  EXPECT_GT(kills, 0);
  EXPECT_TRUE(here.read("deep/killed/recording.evr") == here.read("whole/recording.evr"));
  EXPECT_TRUE(here.read("deep/killed/trajectory.csv") == here.read("whole/trajectory.csv"));
  for (const char* left : {"deep/killed.evr", "deep/killed.evr.snapshot", "deep/killed.evr.unfinished"})
    EXPECT_FALSE(here.has(left)) << left;
}

/// A gnuplot that kills its parent: the run has ended, and its figures are not drawn yet.
TEST(CrowdVerb, ARunKilledWhileItsFiguresAreDrawnGoesOn) {
  const Workplace here;
  here.write("ring.json", kRing);
  const std::string options = "simulate ring.json --decisions none";
  ASSERT_EQ(here.run(options + " --no-figures --out whole").status, 0);
  std::filesystem::create_directory(here.path() / "bin");
  here.write("bin/gnuplot", "#!/bin/sh\nkill -KILL $PPID\n");
  std::filesystem::permissions(here.path() / "bin/gnuplot", std::filesystem::perms::owner_all);
  const std::string run = options + " --snapshot-every 5 --resume --out out";
  EXPECT_NE(here.run(run, "PATH=\"$PWD/bin:$PATH\"").status, 0);
  EXPECT_FALSE(here.has("out/metrics.json"));
  EXPECT_TRUE(here.has("out.evr.snapshot"));
  const Outcome resumed = here.run(run + " --no-figures");
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("goes on from"));
  EXPECT_TRUE(here.read("out/recording.evr") == here.read("whole/recording.evr"));
  for (const char* left : {"out.evr", "out.evr.snapshot", "out.evr.unfinished"}) EXPECT_FALSE(here.has(left)) << left;
}

TEST(CrowdVerb, AFileInThePlaceOfTheRecordingOfAFolderStays) {
  const Workplace here;
  here.write("ring.json", kRing);
  here.write("out.evr", "other bytes");
  const Outcome run = here.run("simulate ring.json --decisions none --no-figures --snapshot-every 5 --force --out out");
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_THAT(run.err, HasSubstr("out.evr: found a file, expected none"));
  EXPECT_EQ(here.read("out.evr"), "other bytes");
  EXPECT_FALSE(here.has("out"));
}

TEST(CrowdVerb, ASnapshotOfAnotherRunIsRefused) {
  const Workplace here;
  here.write("ring.json", kRing);
  const std::string run = "simulate ring.json --decisions none --record ring.evr --snapshot-every 5 --resume";
  Outcome killed;
  for (int tries = 0; tries < 50 && !here.has("ring.evr.snapshot"); ++tries)
    killed = here.run(run + " --every 1", "timeout -s KILL 0.0" + std::to_string(3 + tries % 7));
  if (!here.has("ring.evr.snapshot")) GTEST_SKIP() << "never killed in time";
  const Outcome other = here.run(run + " --every 2");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("the snapshot of another run"));
  EXPECT_EQ(here.run("simulate ring.json --decisions none --record ring.evr").status, 0) << "without snapshots";
  EXPECT_EQ(here.run(run + " --every 1").status, 0);
}

TEST(CrowdVerb, OptionsOfSnapshotsNeedEachOther) {
  const Workplace here;
  here.write("ring.json", kRing);
  const Outcome alone = here.run("simulate ring.json --decisions none --snapshot-every 5");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("--snapshot-every needs --out DIR or --record FILE.evr: a snapshot"));
  const Outcome resume = here.run("simulate ring.json --decisions none --record ring.evr --resume");
  EXPECT_EQ(resume.status, 2);
  EXPECT_THAT(resume.err, HasSubstr("--resume needs --snapshot-every N: "));
  EXPECT_EQ(here.run("simulate ring.json --resume").status, 2) << "with recorded decisions";
}

}  // namespace
}  // namespace exactvo::test
