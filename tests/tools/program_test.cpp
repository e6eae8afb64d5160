// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a user meets it: what it prints, what it writes, and how it refuses.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>

#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/recording_file.h"
#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kOneRobot = R"({
  "name": "one", "time_limit": 20,
  "robots": [{ "id": "R1", "position": [0, 0], "goal": [8, 0] }],
  "obstacles": [{ "id": "wall", "polyline": [[4, -1], [4, 1]] }]
})";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kOneRobot;
  return text.replace(text.find(from), from.size(), to);
}

TEST(Program, NoVerbPrintsHelpAndFails) {
  const Workplace here;
  const Outcome outcome = here.run("");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("simulate"), HasSubstr("explain"), HasSubstr("paper")));
  EXPECT_THAT(outcome.out, IsEmpty());
}

TEST(Program, HelpHasExamplesAndExitStatuses) {
  const Workplace here;
  for (const char* arguments : {"--help", "simulate --help", "explain --help", "paper --help"}) {
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.status, 0) << arguments;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Examples:"), HasSubstr("Exit status:"))) << arguments;
  }
}

TEST(Program, VersionHasBuildFacts) {
  const Workplace here;
  const Outcome outcome = here.run("--version");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("exactvo "), HasSubstr("commit "), HasSubstr("CGAL "), HasSubstr("GMP ")));
}

TEST(Program, TrapJudgesAMethodWithoutEnclosures) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome words = here.run("trap s.json --method orca");
  EXPECT_EQ(words.status, 0) << words.err;
  EXPECT_THAT(words.out, AllOf(HasSubstr("a stall is possible"), HasSubstr("rests at")));
  const json findings = json::parse(here.run("trap s.json --method orca --json").out);
  ASSERT_EQ(findings.size(), 2u) << "both sides of the wall";
  EXPECT_NE(findings[0].at("stall_possible"), findings[1].at("stall_possible"));
  here.write("empty.json", with(R"({ "id": "wall", "polyline": [[4, -1], [4, 1]] })", ""));
  EXPECT_THAT(here.run("trap empty.json --method orca").out, HasSubstr("no obstacles"));
}

TEST(Program, TrapAnswersForEveryScenarioOfThePaper) {
  const Workplace here;
  for (const auto& entry : std::filesystem::directory_iterator(data_file("paper"))) {
    if (entry.path().extension() != ".json") continue;
    const Outcome outcome = here.run("trap '" + entry.path().string() + "'");
    EXPECT_EQ(outcome.status, 0) << entry.path() << ": " << outcome.err;
    EXPECT_FALSE(outcome.out.empty()) << entry.path();
  }
}

/// A U that opens towards the robot, which stalls between the ellipses of its right wall and its roof.
constexpr const char* kBeforeAU =
    R"({"name": "U", "robots": [{"id": "R1", "position": [0, 0], "goal": [12, 6]}], "time_limit": 40,
  "obstacles": [{"id": "U", "polygon": [[4, -4], [10, -4], [10, 4], [4, 4], [4, 3.5], [9, 3.5], [9, -3.5], [4, -3.5]]}]})";

TEST(Program, TrapAndSimulateNameTheSameEnclosures) {
  const Workplace here;
  here.write("u.json", kBeforeAU);
  const Outcome trap = here.run("trap u.json --method ivo-edge");
  EXPECT_THAT(trap.out,
              AllOf(HasSubstr("R1, enclosure 4, facade (4, 3.5)-(9, 3.5) of obstacle U: no stall"),
                    HasSubstr("R1, between enclosures 4 and 5 of obstacle U: a stall is possible (overlapping, "
                              "heuristic)"),
                    HasSubstr("in their concave vertex")));
  EXPECT_THAT(here.run("simulate u.json --method ivo-edge").out,
              HasSubstr("blocked between enclosures 4 and 5 of obstacle U"));
  const json findings = json::parse(here.run("trap u.json --method ivo-edge --json").out);
  EXPECT_EQ(findings[4].at("enclosure"), 4);
  EXPECT_TRUE(findings[4].at("overlapping").is_null());
  bool found = false;
  for (const json& f : findings)
    found = found || (!f.at("overlapping").is_null() && f.at("enclosure") == 4 &&
                      f.at("overlapping").at("enclosure") == 5 && f.at("stall_possible") == true);
  EXPECT_TRUE(found);
}

TEST(Program, MistypedWordsAreAnsweredWithTheNearest) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const std::pair<const char*, const char*> cases[] = {{"simulat s.json", "'simulate'"},
                                                       {"simulate s.json --method ivo-clster", "'ivo-cluster'"},
                                                       {"simulate s.json --controller defualt", "'default'"},
                                                       {"simulate s.json --integrator rk5", "'rk4'"},
                                                       {"simulate s.json --methd ivo", "'--method'"},
                                                       {"explain s.json --time 1 --robot R2", "'R1'"}};
  for (const auto& [arguments, nearest] : cases) {
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("did you mean ") + nearest)) << arguments;
    EXPECT_THAT(outcome.out, IsEmpty()) << arguments;
  }
}

TEST(Simulate, AnUnknownMethodNamesTheKnownOnes) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate s.json --method magic --out out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("--method"), HasSubstr("found 'magic'"), HasSubstr("orca"),
                                 HasSubstr("ivo-edge"), HasSubstr("ivo-cluster")));
  EXPECT_FALSE(here.has("out"));
}

TEST(Simulate, MethodsThatPromiseNothingBetweenRobotsSaySo) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  for (const std::string method : {"rvo", "hrvo"}) {
    const Outcome outcome = here.run("simulate s.json --no-figures --force --out out --method " + method);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("method " + method + " promises nothing between robots"));
    EXPECT_THAT(here.run("audit out").out, HasSubstr("the method promises nothing between robots"));
    EXPECT_EQ(here.run("simulate s.json --liveness plan --method " + method).status, 2);
    const Outcome formation = here.run("simulate " + data_file("paper/B0.json") + " --method " + method);
    EXPECT_EQ(formation.status, 2);
    EXPECT_THAT(formation.err, HasSubstr("--method: found '" + method + ", which formations do not have'"));
    here.write("brakes.json", R"({"name": "b", "robots": [{"id": "R", "position": [0, 0], "goal": [3, 0]}],
                                  "acceleration": {"max": 2}})");
    EXPECT_THAT(here.run("simulate brakes.json --method " + method).err, HasSubstr("cannot promise to brake in time"));
  }
}

struct BadScenario {
  const char* name;
  const char* from;
  const char* to;
  const char* pointer;
  const char* code;
};

/// What ctest lists; without it the bytes of the pointers.
void PrintTo(const BadScenario& bad, std::ostream* out) {
  *out << bad.pointer << " " << bad.code;
}

class RefusedScenario : public testing::TestWithParam<BadScenario> {};

TEST_P(RefusedScenario, SaysFilePointerFoundAndExpectedAndWritesNothing) {
  const BadScenario& bad = GetParam();
  const Workplace here;
  here.write("bad.json", with(bad.from, bad.to));
  const Outcome outcome = here.run("simulate bad.json --out out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("bad.json"), HasSubstr(bad.pointer), HasSubstr("found"),
                                 HasSubstr("expected"), HasSubstr(bad.code)));
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_FALSE(here.has("out"));
}

INSTANTIATE_TEST_SUITE_P(
    Scenarios, RefusedScenario,
    testing::Values(
        BadScenario{"WrongType", "[0, 0]", "[0, \"a\"]", "/robots/0/position/1", "E_TYPE"},
        BadScenario{"OutOfRange", "\"time_limit\": 20", "\"time_limit\": -1", "/time_limit", "E_RANGE"},
        BadScenario{"UnknownKey", "\"goal\"", "\"gaol\"", "/robots/0", "E_KEY_UNKNOWN"},
        BadScenario{"NoRobots", R"([{ "id": "R1", "position": [0, 0], "goal": [8, 0] }])", "[]", "/robots", "E_COUNT"},
        BadScenario{"SelfCrossing", R"("polyline": [[4, -1], [4, 1]])",
                    R"("polygon": [[0, 3], [2, 5], [2, 3], [0, 5]])", "/obstacles/0", "E_SELF_INTERSECTION"},
        BadScenario{"MissingFile", R"("polyline": [[4, -1], [4, 1]])", R"("file": "nowhere.geojson")",
                    "nowhere.geojson", "E_FILE_MISSING"}),
    [](const auto& test) { return std::string(test.param.name); });

// GDAL reads no geometry here, and says nothing: the robot drove through the obstacle.
TEST(Simulate, AMalformedPolygonIsRefusedAndNotValid) {
  const Workplace here;
  here.write("flat.geojson", R"({"type": "FeatureCollection", "units": "m", "features": [{"type": "Feature",
    "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[4, -3], [5, -3], [5, 3], [4, 3], [4, -3]]}}]})");
  std::string text = kOneRobot;
  const std::string wall = R"("polyline": [[4, -1], [4, 1]])";
  text.replace(text.find(wall), wall.size(), R"("file": "flat.geojson")");
  here.write("s.json", text);
  const Outcome outcome = here.run("simulate s.json --out out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("flat.geojson: feature 0, /geometry"), HasSubstr("E_FORMAT_SYNTAX")));
  EXPECT_FALSE(here.has("out"));
  EXPECT_EQ(here.run("validate flat.geojson").status, 1);
}

TEST(Simulate, ABrokenTextIsRefusedWithItsLine) {
  const Workplace here;
  here.write("broken.json", "{\n  \"name\": \"x\",\n  \"robots\": [\n");
  const Outcome outcome = here.run("simulate broken.json --out out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("broken.json"), HasSubstr("line"), HasSubstr("E_JSON_SYNTAX")));
  EXPECT_FALSE(here.has("out"));
}

TEST(Simulate, JsonHasEveryKey) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate s.json --json --seed 7");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json metrics = json::parse(outcome.out);
  for (const char* key : {"scenario",
                          "method",
                          "controller",
                          "all_arrived",
                          "last_arrival_time",
                          "min_obstacle_clearance",
                          "min_robot_clearance",
                          "robot_margin",
                          "collisions",
                          "formation_position_error",
                          "formation_velocity_error",
                          "leader_arrival_time",
                          "formation_course",
                          "jitter",
                          "heading_reversals",
                          "decisions",
                          "steps",
                          "wall_time",
                          "robots",
                          "provenance"}) {
    EXPECT_TRUE(metrics.contains(key)) << key;
  }
  for (const char* key : {"id", "arrived", "arrival_time", "path_length", "min_obstacle_clearance"}) {
    EXPECT_TRUE(metrics["robots"][0].contains(key)) << key;
  }
  EXPECT_EQ(metrics["scenario"], "one");
  EXPECT_EQ(metrics["method"], "ivo");
  EXPECT_EQ(metrics["all_arrived"], true);
  EXPECT_EQ(metrics["provenance"]["seed"], 7);
  for (const char* key : {"controller", "min_robot_clearance", "formation_position_error", "leader_arrival_time"}) {
    EXPECT_TRUE(metrics[key].is_null()) << key << " does not apply to one robot with a goal";
  }
}

TEST(Simulate, ARobotThatGetsStuckIsAnAnswerNotAnError) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate s.json --method orca --guidance none --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json metrics = json::parse(outcome.out);
  EXPECT_EQ(metrics["all_arrived"], false);
  EXPECT_TRUE(metrics["last_arrival_time"].is_null());
}

TEST(Simulate, ReadsStandardInput) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate - --json <s.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["scenario"], "one");
}

TEST(Simulate, OutputIsComplete) {
  const Workplace here;
  const Outcome outcome = here.run("simulate " + data_file("paper/B1.json") + " --out out --quiet");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const auto files = here.files("out");
  for (const char* name : {"recording.jsonl", "metrics.json", "trajectory.csv", "lyapunov.csv", "explorer.html"})
    EXPECT_EQ(files.count(name), 1u) << name;
  for (const char* figure :
       {"paths", "obstacle_distance", "robot_distance", "velocity", "formation_error", "lyapunov"}) {
    for (const char* extension : {".dat", ".gp", ".svg", ".png", ".pdf"}) {
      const std::string name = std::string("figures/") + figure + extension;
      ASSERT_EQ(files.count(name), 1u) << name;
      EXPECT_GT(files.at(name).size(), 100u) << name;
    }
    EXPECT_THAT(files.at(std::string("figures/") + figure + ".svg"), HasSubstr("</svg>"));
  }
  EXPECT_TRUE(json::accept(files.at("metrics.json")));
  EXPECT_EQ(files.size(), 5u + 6u * 5u) << "nothing else";
}

TEST(Simulate, SaysWhatAFormationIsBeforeAndWhyARobotStopped) {
  const Workplace here;
  const Outcome formation = here.run("simulate " + data_file("paper/B0.json") + " --integrator euler");
  EXPECT_THAT(formation.err,
              AllOf(HasSubstr("eigenvalues of L + B from 1 to 4"), HasSubstr("step limit is 0.05089 s")));
  EXPECT_THAT(formation.out, AllOf(HasSubstr("V of (18)"), HasSubstr("valid V"), HasSubstr("peak acceleration")));
  const Outcome stuck = here.run("simulate " + data_file("paper/A11.json") + " --method orca --out out --no-figures");
  EXPECT_THAT(stuck.out, AllOf(HasSubstr("stuck        R1 is 11.5 m from its goal"), HasSubstr("a stable trap")));
  const std::string recording = here.read("out/recording.jsonl");
  const json end = json::parse(recording.substr(recording.rfind('\n', recording.size() - 2) + 1))["end"];
  ASSERT_EQ(end["stuck"].size(), 1u);
  EXPECT_EQ(end["stuck"][0]["equilibrium"]["stable"], true);
  EXPECT_EQ(json::parse(here.read("out/metrics.json"))["stuck"].size(), 1u);
}

TEST(Simulate, WithoutFiguresNoneOfAnEarlierRunStay) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A1.json") + " --out out", "PATH=/nowhere").status, 0);
  ASSERT_TRUE(here.has("out/figures/paths.gp"));
  ASSERT_EQ(here.run("simulate " + data_file("paper/A1.json") + " --out out --no-figures").status, 0);
  EXPECT_FALSE(here.has("out/figures"));
}

TEST(Simulate, AnEarlierRunOfAnotherKindIsReplacedOnlyByForce) {
  const Workplace here;
  const std::string a1 = "simulate " + data_file("paper/A1.json") + " --out out --no-figures";
  EXPECT_THAT(here.run(a1).err, Not(HasSubstr("in place of")));
  const Outcome again = here.run(a1);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("wrote out, in place of an earlier run of A1, method ivo"));
  for (const std::string& other :
       {"simulate " + data_file("paper/A3.json") + " --out out --no-figures", a1 + " --method orca"}) {
    const Outcome refused = here.run(other);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr("E_OTHER_RUN"), HasSubstr("an earlier run of A1, method ivo"), HasSubstr("--force")));
    EXPECT_EQ(json::parse(here.read("out/metrics.json"))["method"], "ivo");
    EXPECT_EQ(json::parse(here.read("out/metrics.json"))["scenario"], "A1");
  }
  EXPECT_EQ(here.run(a1 + " --method orca --force").status, 0);
  EXPECT_EQ(json::parse(here.read("out/metrics.json"))["method"], "orca");
}

/// A slow robot before a fast cart.
const char* const kRunOver = R"({ "name": "run over", "time_limit": 100,
  "robots": [ { "id": "slow", "position": [0, 0], "goal": [40, 0], "max_speed": 0.5 } ],
  "moving_obstacles": [ { "id": "cart", "polygon": [[-10, -1], [-8, -1], [-8, 1], [-10, 1]],
                          "path": [[0, 0], [60, 0]], "speed": 4 } ] })";

TEST(Simulate, ACollisionIsReportedToMachines) {
  const Workplace here;
  here.write("cart.json", kRunOver);
  const Outcome outcome = here.run("simulate cart.json --out out --fail-on-collision");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("moving obstacle 'cart' moves at up to 4 m/s, faster than slow"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("COLLISION: slow overlapped moving obstacle 'cart' by "),
                                 HasSubstr("  collision    slow with moving obstacle 'cart' from ")));
  const json metrics = json::parse(here.read("out/metrics.json"));
  ASSERT_GE(metrics["collisions"].size(), 1u);
  EXPECT_EQ(metrics["collisions"][0]["robot"], "slow");
  EXPECT_EQ(metrics["collisions"][0]["with"], "cart");
  EXPECT_GT(metrics["collisions"][0]["depth"].get<double>(), 0.1);
  EXPECT_THAT(metrics["outcome"].get<std::string>(), testing::StartsWith("COLLISION: "));
  const std::string text = here.read("out/recording.jsonl");
  const json end = json::parse(text.substr(text.rfind("\n{") + 1))["end"];
  EXPECT_EQ(end["outcome"], metrics["outcome"]);
  EXPECT_EQ(end["collisions"], metrics["collisions"]);
  EXPECT_THAT(end["ended"].get<std::string>(), Not(HasSubstr("COLLISION")));
  const datasets::RecordingFile again = datasets::read_recording(here.path() / "out/recording.jsonl");
  EXPECT_EQ(measure(again.scenario, again.recording).outcome, metrics["outcome"]) << "said once, not twice";
  EXPECT_THAT(here.read("out/figures/paths.gp"), HasSubstr("title 'collision'"));
  EXPECT_TRUE(here.has("out/figures/obstacle_distance.svg"));
  EXPECT_EQ(here.run("simulate cart.json").status, 0) << "only where asked for";
  const std::string clear = "simulate " + data_file("paper/A1.json") + " --fail-on-collision";
  EXPECT_EQ(here.run(clear).status, 0);
}

TEST(Simulate, ARobotThatDoesNotArriveIsReportedToMachines) {
  const Workplace here;
  here.write("shut.json", R"({ "name": "shut", "time_limit": 5,
    "robots": [ { "id": "in", "position": [0, 0], "goal": [8, 0] }, { "id": "free", "position": [9, 9], "goal": [8, 9] } ],
    "obstacles": [ { "id": "cell", "polyline": [[-2, -2], [2, -2], [2, 2], [-2, 2], [-2, -2]] } ] })");
  EXPECT_EQ(here.run("simulate shut.json").status, 0) << "only where asked for";
  const Outcome outcome = here.run("simulate shut.json --out out --fail-unless-arrived");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("did not arrive"));
  EXPECT_FALSE(json::parse(here.read("out/metrics.json"))["all_arrived"].get<bool>());
  EXPECT_EQ(here.run("simulate " + data_file("paper/A1.json") + " --fail-unless-arrived").status, 0);
  EXPECT_EQ(here.run("simulate shut.json --decisions none --fail-unless-arrived").status, 1);
}

TEST(Simulate, MarginsThatAreNotKeptAndSlotsThatMoveAreReported) {
  const Workplace here;
  here.write("near.json", R"({ "name": "near", "time_limit": 5, "margins": { "robot": 0.3 },
    "robots": [ { "id": "a", "position": [0, 0], "goal": [8, 0] }, { "id": "b", "position": [0, 1.1], "goal": [8, 1.1] } ] })");
  EXPECT_THAT(here.run("simulate near.json").out,
              HasSubstr("of robots nearer to each other than margins.robot, 0.3 m (2 robots)"));
  EXPECT_THAT(here.run("simulate " + data_file("paper/B1.json")).err,
              HasSubstr("formation: recentre moves every slot by (-0.3333, -0.3333)"));
}

TEST(Simulate, RobotsThatHaveArrivedBeforeTheyMoveAreNamedByBothEngines) {
  const Workplace here;
  here.write("small.json", R"({ "name": "small", "time_limit": 5,
    "robots": [ { "id": "a", "position": [0, 0], "goal": [0.05, 0], "radius": 0.01 } ] })");
  for (const std::string engine : {"", " --decisions none"})
    EXPECT_THAT(here.run("simulate small.json" + engine).err,
                HasSubstr("warning: 1 robot within arrival_tolerance, 0.1 m, of the goal at the start"))
        << engine;
}

/// MB that the program takes at most.
double peak_memory(const Workplace& here, const std::vector<std::string>& arguments) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::chdir(here.path().c_str()) != 0 || !std::freopen("/dev/null", "w", stdout) ||
        !std::freopen("/dev/null", "w", stderr))
      ::_exit(99);
    std::vector<char*> argv{const_cast<char*>(EXACTVO_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(EXACTVO_PROGRAM, argv.data());
    ::_exit(99);
  }
  int status = 0;
  struct rusage used {};
  EXPECT_EQ(::wait4(child, &status, 0, &used), child);
  EXPECT_EQ(status, 0);
  return static_cast<double>(used.ru_maxrss) / 1024.0;
}

TEST(Simulate, MemoryDoesNotGrowWithTheRun) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer keeps what was freed";
#endif
  const Workplace here;
  // A robot that waits for ever before a wall.
  const auto scenario = [](int seconds) {
    return R"({ "name": "wait", "time_limit": )" + std::to_string(seconds) + R"(,
      "robots": [ { "id": "R", "position": [0, 0], "goal": [8, 0] } ],
      "obstacles": [ { "id": "U", "polyline": [[2, -4], [4, -4], [4, 4], [2, 4]] } ] })";
  };
  here.write("short.json", scenario(200));
  here.write("long.json", scenario(2000));
  const double less =
      peak_memory(here, {"simulate", "short.json", "--method", "ivo-edge", "--out", "short", "--no-figures"});
  const double more =
      peak_memory(here, {"simulate", "long.json", "--method", "ivo-edge", "--out", "long", "--no-figures"});
  EXPECT_EQ(json::parse(here.read("long/metrics.json"))["steps"], 40000);
  EXPECT_LT(more - less, 5.0) << less << " MB for 4,000 rows, " << more << " MB for 40,000";
}

TEST(Audit, AnObstacleThatMovesIsOne) {
  const Workplace here;
  here.write("cart.json", kRunOver);
  ASSERT_EQ(here.run("simulate cart.json --out out --no-figures").status, 0);
  const Outcome outcome = here.run("audit out --json");
  EXPECT_EQ(outcome.status, 1);
  const json report = json::parse(outcome.out);
  EXPECT_GT(report["collisions"], 0);
  EXPECT_EQ(report["proved"]["against_moving_obstacles"], report["steps"]);
  EXPECT_FALSE(report["not_audited"].empty());
}

TEST(Audit, SaysHowManyFindingsItDoesNotList) {
  const Workplace here;
  std::string slower = kRunOver;  // the longer one overlaps the other, the more there is to list
  slower.replace(slower.find("\"speed\": 4"), 10, "\"speed\": 1");
  here.write("cart.json", slower);
  ASSERT_EQ(here.run("simulate cart.json --out out --no-figures").status, 0);
  const json report = json::parse(here.run("audit out --json").out);
  std::size_t found = 0, unlisted = 0;
  for (const json& point : report["points"]) {
    found += point["refuted"].get<std::size_t>() + point["open"].get<std::size_t>();
    unlisted += point["unlisted"].get<std::size_t>();
  }
  EXPECT_EQ(report["findings"].size() + unlisted, found);
  ASSERT_GT(report["points"]["motions"]["unlisted"], 0);
  EXPECT_THAT(here.run("audit out").out,
              HasSubstr("... and " + report["points"]["motions"]["unlisted"].dump() + " more findings of"));
}

TEST(Audit, ARunAmongEdgesThatItNeverMetIsProven) {
  const Workplace here;
  here.write("far.json", R"({ "name": "far", "robots": [ { "id": "R", "position": [0, 0], "goal": [6, 0] } ],
    "obstacles": [ { "id": "w", "polyline": [[0, 6], [6, 6]] } ] })");
  for (const char* method : {"orca", "ivo-edge", "ivo-cluster", "ivo"}) {
    ASSERT_EQ(here.run(std::string("simulate far.json --no-figures --force --out out -m ") + method).status, 0);
    EXPECT_EQ(here.run("audit out").status, 0) << method << here.run("audit out").out;
  }
}

/// The lines of a recording with an end and a digest made anew.
std::string sealed_again(std::vector<json> lines) {
  std::string text;
  lines.back()["end"]["rows"] =
      std::count_if(lines.begin(), lines.end(), [](const json& l) { return l.contains("row"); });
  lines.back()["end"]["collisions"] = json::array();
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) text += lines[k].dump() + "\n";
  lines.back()["end"]["sha256"] = datasets::sha256_of(text);
  return text + lines.back().dump() + "\n";
}

TEST(Audit, ARunThatIsCutOffBeforeItsCollisionIsRefuted) {
  const Workplace here;
  here.write("truck.json",
             R"({ "name": "mov", "robots": [ { "id": "a", "position": [0, 0], "max_speed": 1, "goal": [10, 0] } ],
    "moving_obstacles": [ { "id": "truck", "polygon": [[12, -1], [14, -1], [14, 1], [12, 1]], "path": [[0, 0], [-20, 0]], "speed": 4 } ] })");
  ASSERT_EQ(here.run("simulate truck.json --out out --no-figures").status, 0);
  std::vector<json> lines;
  std::istringstream recording(here.read("out/recording.jsonl"));
  for (std::string line; std::getline(recording, line);) lines.push_back(json::parse(line));
  for (const std::size_t rows : {1u, 40u, 61u}) {
    std::vector<json> cut;
    std::size_t kept = 0;
    for (const json& line : lines)
      if (!line.contains("row") || kept++ < rows) cut.push_back(line);
    here.write("cut.jsonl", sealed_again(cut));
    const Outcome outcome = here.run("audit cut.jsonl --scenario truck.json");
    EXPECT_EQ(outcome.status, 1) << rows;
    EXPECT_THAT(outcome.out, HasSubstr("the last row is before the time limit, and not every robot has arrived"));
  }
}

TEST(Audit, ComparesTheScenarioThatItIsGiven) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A1.json") + " --out out --no-figures").status, 0);
  const Outcome same = here.run("audit out --json --scenario " + data_file("paper/A1.json"));
  EXPECT_EQ(same.status, 0) << same.out;
  const json report = json::parse(same.out);
  for (const char* point : {"scenario", "bodies", "completeness", "half_planes", "choices", "sequence", "motions"}) {
    EXPECT_GT(report["points"][point]["asked"], 0) << point;
    EXPECT_EQ(report["points"][point]["asked"], report["points"][point]["proven"]) << point;
  }
  const Outcome other = here.run("audit out --scenario " + data_file("paper/A2.json"));
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.out, HasSubstr("the scenario of the recording is not the one given"));
  EXPECT_THAT(other.out, HasSubstr("choices satisfy their half-planes and are the best: "));
  const Outcome none = here.run("audit out --scenario nowhere.json");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(here.run("audit out").out, HasSubstr("--scenario FILE compares them"));
}

TEST(Audit, TheCurvesOfAFormationAreProven) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/B1.json") + " --out out --no-figures").status, 0);
  const Outcome outcome = here.run("audit out --json");
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["proved"]["curved_steps"], report["steps"]);
  EXPECT_EQ(report["proved"]["clear_steps"], report["steps"]);
  EXPECT_GT(report["proved"]["largest_bulge"], 0.0);
}

TEST(Paper, AnInterruptedCampaignNamesTheFolderItLeavesOrThatItLeavesNothing) {
  const Workplace here;
  const Outcome outcome = here.run("paper --out pp --random 100000 --jobs 1", "timeout -s INT 0.5");
  EXPECT_THAT(outcome.err, HasSubstr(here.has("pp") ? "is kept in pp" : "nothing is kept"));
}

TEST(Paper, OptionsOfCampaignsAreNotedWhereThereIsNone) {
  const Workplace here;
  const Outcome outcome = here.run("paper --out out --random 1 --fields 3");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("note: --fields does nothing here"));
}

TEST(Simulate, TheLastRowHasNoDerivatives) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/B0.json") + " --out out --no-figures").status, 0);
  const auto line_from_last = [&](const std::string& file, int before) {
    std::string text = here.read(file);
    for (; before > 0; --before) text.resize(text.rfind('\n', text.size() - 2) + 1);
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  };
  EXPECT_THAT(line_from_last("out/lyapunov.csv", 0), testing::EndsWith(",,,,\n"));
  const json row = json::parse(line_from_last("out/recording.jsonl", 1))["row"];
  EXPECT_TRUE(row["lyapunov"].contains("paper"));
  EXPECT_FALSE(row["lyapunov"].contains("paper_rates"));
  EXPECT_EQ(here.run("audit out").status, 0);
}

TEST(Simulate, ALeaderThatNeverArrivesIsReportedBeforeAndAfter) {
  const Workplace here;
  std::ifstream file(data_file("paper/B0.json"));
  json scene = json::parse(file);
  scene["formation"]["leader"].erase("speed");
  scene["formation"]["leader"]["profile"] = {{"knots", {{0, 2}, {3, 0}}}};
  scene["formation"]["leader"]["path"] = {{0, 0}, {90, 0}};
  here.write("never.json", scene.dump());
  const Outcome outcome = here.run("simulate never.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: the leader never reaches the end of its path"));
  EXPECT_THAT(outcome.out, HasSubstr("; the leader did not reach its end"));
}

TEST(Simulate, ControllerOptionsByNameAndOnSwitches) {
  const Workplace here;
  const std::string scene = "simulate " + data_file("paper/B1.json") + " --json ";
  const auto jitter = [&](const std::string& flags) {
    return json::parse(here.run(scene + flags).out)["jitter"].get<double>();
  };
  EXPECT_EQ(jitter("--ablation default"), jitter(""));
  EXPECT_LT(jitter("--controller-option smoothing=on"), jitter(""));
  EXPECT_EQ(jitter("--controller-option smoothing=on"), jitter("--ablation 'with smoothing'"));
  EXPECT_EQ(jitter("--ablation 'no margins'"), jitter("--controller-option margins=off"));
  const std::pair<const char*, const char*> bad[] = {
      {"--ablation 'no margin'", "'no margins'"},
      {"--controller-option smothing=on", "'smoothing'"},
      {"--controller-option smoothing=yes", "smoothing=on or smoothing=off"},
      {"--controller-option acceleration_bound=-1", "at least 0"}};
  for (const auto& [flags, expected] : bad) {
    const Outcome outcome = here.run(scene + flags);
    EXPECT_EQ(outcome.status, 2) << flags;
    EXPECT_THAT(outcome.err, HasSubstr(expected)) << flags;
  }
}

TEST(Simulate, ARunThatKeepsAllIsAuditedWhole) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A14.json") + " --decisions all --no-figures --out out").status, 0);
  const Outcome audit = here.run("audit out --json");
  EXPECT_EQ(audit.status, 0) << audit.out;
  EXPECT_THAT(audit.out, HasSubstr("\"unsafe\": 0"));
}

TEST(Simulate, TwoRunsGiveTheSameBytesButForTimes) {
  const Workplace first;
  const Workplace second;
  for (const Workplace* here : {&first, &second}) {
    const Outcome outcome = here->run("simulate " + data_file("paper/A2.json") + " --out out");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  const auto a = first.files("out");
  const auto b = second.files("out");
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, text] : a) {
    ASSERT_EQ(b.count(name), 1u) << name;
    EXPECT_TRUE(without_times(text) == without_times(b.at(name))) << name << " differs";
  }
}

TEST(Simulate, EqualRunsHaveEqualDigestsWhateverTheTime) {
  const Workplace here, there;
  const std::string digest = "\"sha256\":\"[0-9a-f]{64}\"[}]}\n$";
  std::vector<std::string> ends;
  for (const auto& [place, time] : {std::pair(&here, "1700000000"), std::pair(&there, "1700000001")}) {
    const std::string command = "simulate " + data_file("paper/A2.json") + " --out out --no-figures";
    ASSERT_EQ(place->run(command, std::string("SOURCE_DATE_EPOCH=") + time).status, 0);
    std::smatch found;
    const std::string text = place->read("out/recording.jsonl");
    ASSERT_TRUE(std::regex_search(text, found, std::regex(digest))) << text.substr(text.size() - 300);
    ends.push_back(found.str());
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(Simulate, AnExistingFolderKeepsWhatIsNotOurs) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  std::filesystem::create_directory(here.path() / "out");
  here.write("out/notes.txt", "mine");
  here.write("out/metrics.json", "mine too");
  EXPECT_EQ(here.run("simulate s.json --out out --no-figures").status, 2) << "a folder of somebody else's";
  EXPECT_EQ(here.read("out/metrics.json"), "mine too");
  here.write("out/metrics.json", "{\n  \"scenario\": \"old\",\n  \"min_obstacle_clearance\": null\n}\n");
  ASSERT_EQ(here.run("simulate s.json --out out --no-figures --force").status, 0);
  EXPECT_EQ(here.read("out/notes.txt"), "mine");
  EXPECT_TRUE(json::accept(here.read("out/metrics.json")));
}

TEST(Simulate, AFolderThatCannotBeWrittenIsRefused) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  here.write("taken", "a file");
  const Outcome outcome = here.run("simulate s.json --out taken");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("taken"), HasSubstr("E_FILE_UNWRITABLE")));
  EXPECT_EQ(here.read("taken"), "a file");
}

TEST(Simulate, AFolderOfOthersIsRefusedBeforeAnythingIsWritten) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate s.json --out .");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("other files"), HasSubstr("E_FILE_UNWRITABLE")));
  EXPECT_FALSE(here.has("metrics.json"));
}

TEST(Simulate, AFullStandardOutputIsAnError) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  for (const char* options : {"--json", "--json --out out --no-figures", ""}) {
    const std::string full = " >/dev/full 2>err; echo status $?";
    const Outcome outcome = here.run(std::string("simulate s.json ") + options + full);
    EXPECT_THAT(outcome.out, HasSubstr("status 2")) << options;
    EXPECT_THAT(here.read("err"), AllOf(HasSubstr("standard output"), HasSubstr("E_FILE_UNWRITABLE"))) << options;
    EXPECT_FALSE(here.has("out"));
  }
}

TEST(Simulate, EmptyNamesAndSeedsOutOfRangeAreRefused) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  for (const char* options :
       {"--out ''", "--seed -1", "--seed=-1", "--seed 18446744073709551616", "--out \"$(printf 'a\\nb')\""}) {
    const Outcome outcome = here.run(std::string("simulate s.json ") + options);
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_THAT(outcome.err, HasSubstr("found '")) << options;
    EXPECT_THAT(outcome.out, IsEmpty()) << options;
  }
}

TEST(Generate, TheSameSeedGivesTheSameFile) {
  const Workplace here;
  EXPECT_THAT(here.run("generate --list").out, AllOf(HasSubstr("maze"), HasSubstr("needle"), HasSubstr("field-open")));
  EXPECT_EQ(here.run("generate star --seed 5 --count 20 --out a.wkt").status, 0);
  EXPECT_EQ(here.run("generate star --seed 5 --count 20 --out b.wkt").status, 0);
  EXPECT_EQ(here.run("generate star --seed 6 --count 20 --out c.wkt").status, 0);
  EXPECT_EQ(here.read("a.wkt"), here.read("b.wkt"));
  EXPECT_NE(here.read("a.wkt"), here.read("c.wkt"));
  EXPECT_EQ(here.run("generate star --count 0 --out d.wkt").status, 2);
  for (const char* seed : {"-1", "18446744073709551616", "99999999999999999999"}) {
    const Outcome outcome = here.run(std::string("generate star --out d.wkt --seed ") + seed);
    EXPECT_EQ(outcome.status, 2) << seed;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("--seed"), HasSubstr(seed)));
  }
  EXPECT_FALSE(here.has("d.wkt"));
  EXPECT_THAT(here.run("generate star --seed 18446744073709551615 --count 1 --out e.wkt").err,
              HasSubstr("seed 18446744073709551615"));
  EXPECT_EQ(here.run("generate star").status, 2);
  EXPECT_FALSE(here.has("d.wkt"));
}

TEST(Simulate, OptionsOfFormationsAreNotedWhereThereIsNone) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate s.json --controller paper-signs");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("--controller has no effect"), Not(HasSubstr("--integrator"))));
  EXPECT_THAT(here.run("simulate s.json").err, IsEmpty());
}

TEST(Simulate, NamesRunNothingAndSendNothingToTheTerminal) {
  const Workplace here;
  here.write("s.json", with("\"one\"", R"("x'\n system('touch pwned')\n`touch pwned` {@_^ \u001b[31m\\")"));
  const Outcome outcome = here.run("simulate s.json --out out");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("\x1b")));
  EXPECT_THAT(outcome.out, HasSubstr("\\x1b[31m"));
  EXPECT_FALSE(here.has("pwned") || here.has("out/figures/pwned"));
  EXPECT_TRUE(here.has("out/figures/paths.png"));
}

TEST(Simulate, ARobotAtItsGoalIsDrawn) {
  const Workplace here;
  here.write("s.json", with("[8, 0]", "[0, 0]"));
  const Outcome outcome = here.run("simulate s.json --out out");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("the robot arrived"));
  for (const char* name : {"paths", "velocity", "obstacle_distance"})
    EXPECT_TRUE(here.has(std::string("out/figures/") + name + ".png")) << name;
}

TEST(Simulate, AFormationListsItsRobotsToo) {
  const Workplace here;
  const Outcome outcome = here.run("simulate " + data_file("paper/B1.json"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("  R1 "), HasSubstr("  R3 "), HasSubstr("position error")));
}

TEST(Simulate, WithoutGnuplotTheDataAndScriptsStand) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("simulate s.json --out out", "PATH=/nowhere");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("gnuplot is not installed"));
  EXPECT_TRUE(here.has("out/figures/paths.dat"));
  EXPECT_TRUE(here.has("out/figures/paths.gp"));
  EXPECT_FALSE(here.has("out/figures/paths.png"));
  EXPECT_TRUE(here.has("out/metrics.json"));
}

TEST(Simulate, FollowsProvenRoutes) {
  const Workplace here;
  const auto door = [](const char* upper) {
    return R"({ "name": "door", "time_limit": 60, "time_step": 0.1,
      "robots": [ { "id": "R", "position": [-4, 3], "goal": [4, 3] } ],
      "obstacles": [ { "id": "lower", "polyline": [[0, -6], [0, -0.6]] }, { "id": "upper", "polyline": [[0, )" +
           std::string(upper) + R"(], [0, 6]] },
                     { "id": "frame", "polyline": [[-6, -6], [6, -6], [6, 6], [-6, 6], [-6, -6]] } ] })";
  };
  here.write("open.json", door("0.6"));
  here.write("shut.json", door("0.3"));
  const Outcome open = here.run("simulate open.json --out open --no-figures");
  ASSERT_EQ(open.status, 0) << open.err;
  EXPECT_THAT(open.out, HasSubstr("method ivo, guidance route, liveness plan: the robot arrived"));
  EXPECT_EQ(json::parse(here.read("open/metrics.json"))["guidance"], "route");
  EXPECT_THAT(here.read("open/trajectory.csv"), HasSubstr(",guided,"));
  EXPECT_EQ(here.run("audit open --scenario open.json").status, 0);
  EXPECT_THAT(here.run("explain open --time 1 --robot R").out, HasSubstr("leads along a proven route"));
  EXPECT_EQ(here.run("draw open").status, 0);
  EXPECT_THAT(here.read("open/figures/paths.dat"), HasSubstr("routes of R"));
  const Outcome explained = here.run("explain open --time 1 --robot R --map map.svg");
  EXPECT_THAT(explained.out, AllOf(HasSubstr("Route: "), HasSubstr(" to (4, 3); it heads for (")));
  EXPECT_THAT(here.read("map.dat"), HasSubstr("route from here"));
  EXPECT_THAT(here.run("simulate open.json --guidance none --out open --no-figures").err, HasSubstr("guidance route"))
      << "another run";

  const Outcome shut = here.run("simulate shut.json --out shut");
  EXPECT_EQ(shut.status, 0);
  EXPECT_THAT(shut.out, AllOf(HasSubstr("R cannot reach its goal: obstacles "), HasSubstr("with a gap of 0.9 m")));
  EXPECT_THAT(shut.err, HasSubstr("cannot be reached: obstacles ")) << "said before the run";
  EXPECT_THAT(here.read("shut/figures/paths.dat"), HasSubstr("gaps that are too narrow"));
  EXPECT_THAT(here.run("explain shut --time 0 --robot R --map shut.svg").out,
              HasSubstr("Route: none, out of reach: obstacles "));
  EXPECT_THAT(here.read("shut.dat"), HasSubstr("gap, too narrow"));

  EXPECT_EQ(here.run("simulate open.json --guidance route --method ivo-edge").status, 2);
  EXPECT_THAT(here.run("simulate open.json --guidance routes").err, HasSubstr("one of none route"));
  EXPECT_THAT(here.run("simulate " + data_file("paper/B0.json") + " --guidance route").err,
              HasSubstr("--guidance has no effect: robots of a formation have no goals"));
  EXPECT_THAT(here.run("trap open.json --guidance route").err, HasSubstr("--guidance has no effect"));
}

TEST(Simulate, WithoutFiguresTakesAwayOnlyFiguresOfItsOwn) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  ASSERT_EQ(here.run("simulate s.json --out run", "PATH=/nowhere").status, 0);
  here.write("run/figures/notes.txt", "mine");
  here.write("run/figures/mine.svg", "mine");
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  EXPECT_FALSE(here.has("run/figures/paths.gp"));
  EXPECT_FALSE(here.has("run/figures/paths.dat"));
  EXPECT_EQ(here.read("run/figures/notes.txt"), "mine");
  EXPECT_EQ(here.read("run/figures/mine.svg"), "mine");
}

TEST(Program, ANameThatIsTooLongIsNoDefect) {
  const Workplace here;
  const std::string name(300, 'n');
  for (const std::string& command : {"audit " + name, "generate maze --out m.wkt --figure " + name + ".svg",
                                     "batch . --out " + name, "paper --data " + name + " --out p"}) {
    const Outcome outcome = here.run(command);
    EXPECT_EQ(outcome.status, 2) << command << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("[E_FILE_")) << command;
  }
}

TEST(Program, EndlessOutputEndsWhenItsReaderIsGone) {
  const Workplace here;
  here.write("wall.wkt", "LINESTRING (4 -1, 4 1)");
  here.write("run.sh", "yes '{\"pose\": [0, 0, 0], \"velocity\": [1, 0], \"turn\": 0}' | timeout 60 '" EXACTVO_PROGRAM
                       "' monitor --map wall.wkt --radius 0.5 | head -1 > first; echo ${PIPESTATUS[1]} > status");
  EXPECT_EQ(std::system(("cd '" + here.path().string() + "' && bash run.sh").c_str()), 0);
  EXPECT_EQ(here.read("status"), "0\n");
}

// What is longer than stdout's buffer fails where it is written, not at the flush.
TEST(Program, AReaderThatLeavesALongAnswerIsNoError) {
  const Workplace here;
  std::string obstacles;
  for (int k = 0; k < 120; ++k)
    obstacles += (k ? "," : "") + std::string(R"({"id": "a wall with a name that takes room, number )") +
                 std::to_string(k) + R"(", "polyline": [[4, )" + std::to_string(3 * k) + R"(], [6, )" +
                 std::to_string(3 * k + 1) + "]]}";
  here.write("s.json", R"({"name": "s", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}], "obstacles": [)" +
                           obstacles + "]}");
  const Outcome one =
      here.run("vo --obstacle 'DISC(4 0, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2");
  ASSERT_EQ(one.status, 0) << one.err;
  const json answer = json::parse(
      here.run("vo --obstacle 'DISC(4 0, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2 --json").out);
  std::string certificates;
  for (int k = 0; k < 1000; ++k) certificates += answer.dump() + "\n";
  here.write("c.jsonl", certificates);
  for (const char* arguments : {"trap s.json", "audit --certificate c.jsonl", "audit --certificate c.jsonl --json"}) {
    ASSERT_GT(here.run(arguments).out.size(), 5000U) << arguments;
    here.run(std::string(arguments) + " 2>words; echo $? >status; } | true", "{ sleep 0.2;");
    EXPECT_EQ(here.read("words"), "") << arguments;
    EXPECT_NE(here.read("status"), "2\n") << arguments;
  }
}

TEST(Explain, SaysWhatHoldsARobotAndDrawsIt) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("explain s.json --method orca --guidance none --time 10 --robot R1 --out stuck.svg");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("R1 of one at t = 10.00 s"), HasSubstr("[1] the edge "),
                    HasSubstr("of obstacle wall, binding: "), HasSubstr("The robot is held by"), HasSubstr("Karush")));
  for (const char* name : {"stuck.svg", "stuck.png", "stuck.pdf", "stuck.dat", "stuck.gp"})
    EXPECT_TRUE(here.has(name)) << name;
}

TEST(Explain, ARobotGoesByNumberToo) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  EXPECT_EQ(here.run("explain s.json --time 1 --robot 0").out, here.run("explain s.json --time 1 --robot R1").out);
  EXPECT_EQ(here.run("explain s.json --time 1 --robot 1").status, 2);
}

/// Two that cannot pass each other between two walls, and three that stand aside.
constexpr const char* kNarrow = R"({"name": "narrow", "time_limit": 12, "guidance": "none", "robots": [
  {"id": "left", "position": [-4, 0], "goal": [4, 0]}, {"id": "right", "position": [4, 0], "goal": [-4, 0]},
  {"id": "a", "position": [0, 9], "goal": [0, 9]}, {"id": "b", "position": [4, 9], "goal": [4, 9]},
  {"id": "c", "position": [8, 9], "goal": [8, 9]}],
  "obstacles": [{"id": "low", "polyline": [[-6, -0.7], [6, -0.7]]},
    {"id": "high", "polyline": [[-6, 0.7], [6, 0.7]]}]})";

TEST(Explain, NamesTheRobotsThatARobotWaitsForAlsoInJson) {
  const Workplace here;
  here.write("s.json", kNarrow);
  const std::string words = "left waits for right, which waits for left: a deadlock of two";
  EXPECT_THAT(here.run("explain s.json --time 9 --robot left").out, HasSubstr("  waiting    " + words + "\n"));
  const json decision = json::parse(here.run("explain s.json --time 9 --robot left --json").out);
  EXPECT_EQ(decision.at("waiting"), words);
  EXPECT_EQ(decision.at("waits_for"), json::array({"right"}));
  EXPECT_EQ(decision.at("all_half_planes"), true);
  EXPECT_EQ(decision.at("half_planes").at(0).at("number"), 1);
  ASSERT_EQ(here.run("simulate s.json --no-figures --out run").status, 0);
  EXPECT_EQ(json::parse(here.run("explain run --time 9 --robot left --json").out).at("all_half_planes"), false);
}

TEST(Explain, ManyRobotsAreNamedAsARange) {
  const Workplace here;
  here.write("s.json", kNarrow);
  EXPECT_THAT(here.run("explain s.json --time 1 --robot 80").err,
              HasSubstr("expected a number from 0 to 4 or an id: left, right, a and 2 more\n"));
}

TEST(Explain, ATimeAfterTheEndIsRefused) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  const Outcome outcome = here.run("explain s.json --time 1000 --robot R1 --out x.svg");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("--time"), HasSubstr("found '1000'"), HasSubstr("when the run ends")));
  EXPECT_FALSE(here.has("x.svg"));
  EXPECT_EQ(here.run("explain s.json --time 1 --robot R1 --out x.jpg").status, 2);
}

TEST(Explain, TheEndOfTheRunIsPrintedWithoutARoundingError) {
  const Workplace here;
  here.write("s.json", R"({"name": "s", "robots": [{"id": "R", "position": [0, 0], "goal": [3, 0]}],
    "time_step": 0.1, "time_limit": 0.3})");
  EXPECT_THAT(here.run("explain s.json --time 1000 --robot R").err, HasSubstr("expected at most 0.3 s, when"));
}

TEST(Explain, ARecordingSaysWhatTheRunSays) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  ASSERT_EQ(here.run("simulate s.json --method orca --guidance none --out out --no-figures --decisions all").status, 0);
  for (const char* time : {"0", "2.5", "10"}) {
    const std::string question = std::string(" --time ") + time + " --robot R1 --out ";
    const Outcome run = here.run("explain s.json --method orca --guidance none" + question + "run.svg");
    for (const char* recorded : {"explain out", "explain out/recording.jsonl"}) {
      const Outcome again = here.run(recorded + question + "again.svg");
      ASSERT_EQ(again.status, 0) << again.err;
      EXPECT_EQ(again.out, run.out) << time;
      EXPECT_EQ(here.read("again.dat"), here.read("run.dat"));
    }
  }
  EXPECT_THAT(here.run("explain out --time 1 --robot 0 --method ivo").err,
              HasSubstr("--method has no effect: the run is read from its recording"));
  EXPECT_EQ(here.run("explain out --time 1000 --robot R1").status, 2);
  EXPECT_EQ(here.run("explain out --time 1 --robot 0 --out out/recording.jsonl").status, 2);
  ASSERT_EQ(here.run("simulate s.json --method orca --guidance none --out less --no-figures").status, 0);
  EXPECT_THAT(here.run("explain less --time 10 --robot R1").out,
              AllOf(HasSubstr("The robot is held by"), HasSubstr("--decisions all")));
}

TEST(Draw, GivesTheFiguresOfTheRun) {
  for (const char* scenario : {"paper/A2.json", "paper/B1.json"}) {
    const Workplace here;
    ASSERT_EQ(here.run("simulate " + data_file(scenario) + " --out run").status, 0);
    ASSERT_EQ(here.run("draw run/recording.jsonl --out again").status, 0);
    EXPECT_EQ(here.files("again"), here.files("run/figures")) << scenario;
  }
}

TEST(Explain, ARecordingOfAFormationSaysWhatTheRunSays) {
  const Workplace here;
  // The last robot is boxed in: the formation first grows apart, which is no reason to call it stuck.
  json scenario = json::parse(std::ifstream(data_file("paper/B1.json")));
  const json position = scenario["robots"][2]["position"];
  const double x = position[0], y = position[1];
  scenario["time_limit"] = 8;
  scenario["obstacles"].push_back(
      {{"id", "box"}, {"polyline", {{x - 1, y - 1}, {x + 1, y - 1}, {x + 1, y + 1}, {x - 1, y + 1}, {x - 1, y - 1}}}});
  here.write("s.json", scenario.dump());
  ASSERT_EQ(here.run("simulate s.json --out out --no-figures --decisions all").status, 0);
  const std::string robot = scenario["robots"][2]["id"];
  for (const char* time : {"0", "1", "4", "7.9"}) {
    const std::string question = std::string(" --time ") + time + " --robot " + robot;
    EXPECT_EQ(here.run("explain out" + question).out, here.run("explain s.json" + question).out) << time;
  }
}

TEST(Draw, PutsThemBesideTheRecordingAndRefusesOtherFolders) {
  const Workplace here;
  here.write("s.json", kOneRobot);
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  EXPECT_FALSE(here.has("run/figures"));
  for (int again = 0; again < 2; ++again) {
    ASSERT_EQ(here.run("draw run", "PATH=/nowhere").status, 0);
    EXPECT_TRUE(here.has("run/figures/paths.gp"));
    EXPECT_EQ(here.run("draw run --out run/figures", "PATH=/nowhere").status, 0);
    EXPECT_EQ(here.run("draw run --out other", "PATH=/nowhere").status, 0);
  }
  here.write("run/figures/paths.txt", "mine");
  EXPECT_THAT(here.run("draw run").err, AllOf(HasSubstr("paths.txt"), HasSubstr("holds figures only")));
  std::filesystem::create_directory(here.path() / "mine");
  here.write("mine/paths.svg", "mine too");
  EXPECT_EQ(here.run("draw run --out mine").status, 2);
  EXPECT_EQ(here.read("mine/paths.svg"), "mine too");
  EXPECT_THAT(here.run("draw mine").err, HasSubstr("mine/recording.jsonl"));
  EXPECT_THAT(here.run("draw s.json").err, HasSubstr("E_"));
  EXPECT_THAT(here.run("draw /dev/stdin < run/recording.jsonl").err, HasSubstr("--out"));
  EXPECT_THAT(here.run("draw /dev/fd/0 < run/recording.jsonl").err, HasSubstr("--out"));
}

}  // namespace
}  // namespace exactvo::test
