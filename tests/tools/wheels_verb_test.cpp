// SPDX-License-Identifier: GPL-3.0-or-later
// Robots on wheels in the program: the page docs/guide/wheels.md as it stands there, the scenes of
// datasets/data/robots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_program.h"

namespace exactvo::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The blocks of code of the page, without their fences.
std::vector<std::string> blocks_of_the_page() {
  std::ifstream page(EXACTVO_SOURCE_DIR "/docs/guide/wheels.md");
  std::vector<std::string> blocks;
  bool is_inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) {
      is_inside = !is_inside;
      if (is_inside) blocks.emplace_back();
    } else if (is_inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

std::string text_of_the_page() {
  std::ifstream page(EXACTVO_SOURCE_DIR "/docs/guide/wheels.md");
  return {std::istreambuf_iterator<char>(page), std::istreambuf_iterator<char>()};
}

const std::string& burgers() {
  static const std::string text = blocks_of_the_page().at(0);
  return text;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(WheelsPage, ItsScenarioAndCommandsRunAsTheyStand) {
  const Workplace here;
  here.write("burgers.json", burgers());
  std::istringstream commands(blocks_of_the_page().at(1));
  std::size_t ran = 0;
  for (std::string line; std::getline(commands, line); ++ran) {
    ASSERT_EQ(line.rfind("exactvo ", 0), 0u) << line;
    const Outcome outcome = here.run(line.substr(8));
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
    const auto names = [&](const char* verb) { return line.find(verb) != std::string::npos; };
    if (names("simulate")) {
      EXPECT_THAT(outcome.out, HasSubstr("all robots arrived"));
    } else if (names("audit")) {
      EXPECT_THAT(outcome.out, AllOf(HasSubstr("wheels and headings follow from choices: "), HasSubstr("0 collisions"),
                                     Not(HasSubstr("refuted")), Not(HasSubstr("left open"))));
    } else if (names("explain")) {
      EXPECT_THAT(outcome.out, AllOf(HasSubstr("wheels of robot R1"), HasSubstr("heading "), HasSubstr("left wheel ")));
    }
  }
  EXPECT_GE(ran, 4u);
  for (const char* file : {"recording.jsonl", "trajectory.csv", "explorer.html", "figures/paths.svg"})
    EXPECT_TRUE(here.has(std::string("out/burgers/") + file)) << file;
  EXPECT_THAT(here.read("out/burgers/trajectory.csv"), HasSubstr("heading_x,heading_y,left_wheel_m_s,right_wheel_m_s"));
}

TEST(WheelsVerb, ExplainGivesTheLimitsOfWheelsAndThoseThatOthersRelyOnThatMeasureThem) {
  const Workplace here;
  const auto limits = [&](const char* scene) {
    return here.run("explain " + data_file(std::string("robots/") + scene) + " --time 0.2 --robot R1").out;
  };
  EXPECT_THAT(limits("burgers_measured.json"),
              HasSubstr("wheels: at most 0.22 m/s and 1 m/s^2; reference point: at most 0.45 m/s^2, 0.0225 m/s in"));
  EXPECT_THAT(limits("burgers4.json"),
              AllOf(HasSubstr("at most 0.22 m/s and 1 m/s^2"), Not(HasSubstr("reference point: "))));
}

/// In a dead end, its goal behind it: in every row, not only where it begins.
TEST(WheelsVerb, ExplainSaysOfLaterRowsThatAFootprintHasNoRoomToTurn) {
  const Workplace here;
  here.write("end.json", R"({"name": "end", "time_step": 0.05, "time_limit": 6,
    "robots": [{"id": "R1", "position": [0.5, 0], "heading": 0, "goal": [-4, 0],
      "kinematics": {"type": "differential", "wheel_separation": 0.5, "max_wheel_speed": 1.5,
                     "max_wheel_acceleration": 2.4, "reference": 0.25},
      "footprint": {"polygon": [[-0.527, -0.296], [0.296, -0.296], [0.296, 0.296], [-0.527, 0.296]]}}],
    "obstacles": [{"polygon": [[-2, 0.36], [2, 0.36], [2, 0.5], [-2, 0.5]]},
                  {"polygon": [[-2, -0.5], [2, -0.5], [2, -0.36], [-2, -0.36]]},
                  {"polygon": [[2, -0.5], [2.2, -0.5], [2.2, 0.5], [2, 0.5]]}]})");
  ASSERT_EQ(here.run("simulate end.json --no-figures --out end").status, 0);
  for (const char* what : {"end", "end.json"})
    for (const char* time : {"3", "5.9"})
      EXPECT_THAT(here.run(std::string("explain ") + what + " --robot R1 --time " + time).out,
                  HasSubstr("Turning: obstacles leave its footprint no room to turn"))
          << what << " at " << time;
}

TEST(WheelsVerb, ScenesOfTheFolderArriveAndAreProven) {
  const Workplace here;
  std::size_t scenes = 0, formations = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data_file("robots"))) {
    if (entry.path().extension() != ".json") continue;
    ++scenes;
    const std::string name = entry.path().stem().string();
    if (name == "burger_movers") continue;  // not on wheels: MoversVerb
    const Outcome run = here.run("simulate " + entry.path().string() + " --no-figures --out " + name);
    EXPECT_EQ(run.status, 0) << run.err;
    const bool is_formation = here.read(name + "/metrics.json").find("\"formation_course\": {") != std::string::npos;
    formations += is_formation;
    const char* const ends = is_formation ? "arrival      3 of 3 robots" : "(all robots|the robot) arrived";
    EXPECT_THAT(run.out, AllOf(testing::ContainsRegex(ends), HasSubstr(", 0 relaxed"))) << name;
    EXPECT_THAT(run.err, HasSubstr(is_formation ? "while no limit of the wheels binds"
                                                : "joint plans rely on robots that can stand at once"));
    const Outcome audit = here.run("audit " + name + " --scenario " + entry.path().string() + " --json");
    EXPECT_EQ(audit.status, 0) << audit.out;
    const nlohmann::json points = nlohmann::json::parse(audit.out).at("points");
    for (const char* point : {"kinematics", "braking", "motions", "choices", "half_planes"}) {
      EXPECT_GT(points.at(point).at("proven"), 100) << name << " " << point;
      EXPECT_EQ(points.at(point).at("asked"), points.at(point).at("proven")) << name << " " << point;
    }
  }
  EXPECT_GE(scenes, 10u);
  EXPECT_EQ(formations, 4u);
}

/// Among people who walk as they like; results name what is assumed of them and promised to the robot.
TEST(MoversVerb, ItsSceneArrivesIsProvenAndSaysWhatIsAssumed) {
  const Workplace here;
  const char* const words =
      "no moving obstacle is faster than its max_speed, 0.5 m/s at most: then no robot that moves";
  const std::string scene = data_file("robots/burger_movers.json");
  const Outcome run = here.run("simulate " + scene + " --out run");
  EXPECT_THAT(run.out, AllOf(HasSubstr("the robot arrived"), HasSubstr(", 0 relaxed"), HasSubstr(words),
                             HasSubstr("robots that stood were hit by moving obstacles 1 time;"),
                             HasSubstr(" s, while it stood\n"), Not(HasSubstr("COLLISION"))))
      << run.err;
  const Outcome audit = here.run("audit run --scenario " + scene + " --json");
  EXPECT_EQ(audit.status, 0) << audit.out;
  const nlohmann::json report = nlohmann::json::parse(audit.out);
  for (const char* point : {"braking", "motions", "choices"}) {
    EXPECT_GT(report.at("points").at(point).at("proven"), 300) << point;
    EXPECT_EQ(report.at("points").at(point).at("asked"), report.at("points").at(point).at("proven")) << point;
  }
  EXPECT_GT(report.at("points").at("half_planes").at("proven"), 20);
  EXPECT_GT(report.at("hits_standing"), 0);
  EXPECT_THAT(here.run("audit run").out, HasSubstr("robots that stood were hit in "));
  EXPECT_THAT(here.run("explain run --robot R1 --time 2").out,
              AllOf(HasSubstr(words), HasSubstr("if it brakes: proven to touch no moving obstacle before")));
  EXPECT_THAT(here.run("explain run --robot R1 --time 8").out,
              AllOf(HasSubstr("nothing is promised to it"), HasSubstr("Why: it stands, since a moving obstacle could"),
                    Not(HasSubstr("leads along a proven route"))));
  EXPECT_EQ(here.run("view run --out page.html").status, 0);
}

/// The message says where, and what to change.
TEST(MoversVerb, BadSpeedsAreRefusedWithTheirCodes) {
  const Workplace here;
  std::ifstream file(data_file("robots/burger_movers.json"));
  const std::string scene{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const auto refusal = [&](const std::string& from, const std::string& to) {
    here.write("bad.json", with(scene, from, to));
    const Outcome outcome = here.run("validate bad.json");
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    return outcome.out + outcome.err;
  };
  const std::string speed = "/moving_obstacles/0/max_speed: found ", mine = "\"max_speed\": 0.5,";
  EXPECT_THAT(
      refusal("\"acceleration\": { \"max\": 0.45 },", ""),
      AllOf(HasSubstr(speed + "robots without /acceleration, expected an /acceleration"), HasSubstr("[E_SCENARIO]")));
  EXPECT_THAT(refusal(mine, "\"max_speed\": -0.5,"), AllOf(HasSubstr(speed + "-0.5"), HasSubstr("[E_RANGE]")));
  EXPECT_THAT(refusal(mine, "\"max_speed\": NaN,"), HasSubstr("[E_JSON_SYNTAX]"));
  EXPECT_THAT(refusal(mine, "\"max_speed\": 0.3,"),
              AllOf(HasSubstr("/moving_obstacles/0/speed: found 0.4, expected at most its max_speed, 0.3 m/s")));
  EXPECT_THAT(refusal(mine, ""), HasSubstr("/moving_obstacles/0: found no max_speed, with /acceleration"));
  std::string on_wheels =
      with(burgers(), "\"robots\":", R"("moving_obstacles": [{ "id": "walker", "speed": 0.4, "max_speed": 0.5,
    "path": [[1, -2], [1, 2]], "disc": { "centre": [1, -2], "radius": 0.25 } }], "robots":)");
  here.write("bad.json", on_wheels);
  EXPECT_THAT(here.run("simulate bad.json").err,
              AllOf(HasSubstr("bad.json: /moving_obstacles: found 1 obstacle, expected none with robots on wheels"),
                    HasSubstr("the reference point of one may be a robot without kinematics")));
}

/// With the keys that the page names for crowds.
TEST(WheelsVerb, CrowdsOnWheelsAreProvenAndExplained) {
  const Workplace here;
  const std::string keys = R"("time_step": 0.25, "horizons": { "least": 0.5 })";
  EXPECT_NE(text_of_the_page().find(keys), std::string::npos);
  here.write("burgers.json", with(burgers(), "\"time_limit\": 60", keys + ", \"time_limit\": 60"));
  const Outcome run = here.run("simulate burgers.json --decisions none --no-figures --out run");
  EXPECT_THAT(run.out, HasSubstr("all robots arrived")) << run.err;
  EXPECT_THAT(here.run("audit run").out, HasSubstr("wheels and headings follow from choices: "));
  EXPECT_THAT(here.run("explain run --robot R1 --time 2").out,
              AllOf(HasSubstr("heading "), HasSubstr("wheels of robot R1")));
}

/// What bodies may be off by is said wherever results are.
TEST(WheelsVerb, WhatIsAssumedOfBodiesIsReported) {
  const Workplace here;
  const char* const words = "no body is farther than 0.02 m from where the run has it";
  EXPECT_THAT(here.run("simulate " + data_file("robots/burgers_tube.json") + " --no-figures --out run").out,
              HasSubstr(words));
  EXPECT_THAT(here.run("explain run --robot R1 --time 3").out, HasSubstr(words));
  EXPECT_THAT(here.run("audit run").out, HasSubstr("up to the tracking error of the scenario, which is assumed"));
  EXPECT_EQ(here.run("view run --out page.html").status, 0);
}

/// The drawing has each body, and the page its headings.
TEST(WheelsVerb, FiguresAndPagesShowBodiesAndHeadings) {
  const Workplace here;
  here.write("burgers.json", burgers());
  ASSERT_EQ(here.run("simulate burgers.json --out run").status, 0);
  EXPECT_TRUE(here.has("run/figures/wheels.svg"));
  const std::string drawn = here.read("run/figures/paths.dat"), bodies = "bodies of R1\n# x [m], y [m]\n";
  const std::size_t at = drawn.find(bodies);
  ASSERT_NE(at, std::string::npos);
  EXPECT_NE(drawn.compare(at + bodies.size(), 3, "NaN"), 0) << "no body is drawn";
  EXPECT_EQ(here.run("draw run").status, 0);
  EXPECT_EQ(here.run("view run --out page.html").status, 0);
  EXPECT_THAT(here.read("page.html"), HasSubstr("drawOnWheels"));
}

TEST(WheelsVerb, RunsThatCannotKeepThePromiseAreRefused) {
  const Workplace here;
  here.write("burgers.json", burgers());
  EXPECT_THAT(here.run("simulate burgers.json --method hrvo").err, HasSubstr("with robots on wheels"));
  const Outcome none = here.run("simulate burgers.json --decisions none --record a.evr");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("/robots/0/kinematics"));
}

/// Figures and pages of a formation on wheels have headings and wheels, and no Lyapunov functions.
TEST(WheelsVerb, FormationsAreDrawnWithHeadings) {
  const Workplace here;
  const Outcome run = here.run("simulate " + data_file("robots/B1_huskies.json") + " --out run");
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("on wheels no theorem says that robots reach their slots"), Not(HasSubstr("V of (18)"))))
      << run.err;
  for (const char* file : {"figures/wheels.svg", "figures/formation_error.svg", "figures/paths.svg", "explorer.html"})
    EXPECT_TRUE(here.has(std::string("run/") + file)) << file;
  EXPECT_FALSE(here.has("run/lyapunov.csv"));
  EXPECT_FALSE(here.has("run/figures/lyapunov.svg"));
  EXPECT_THAT(here.read("run/explorer.html"), HasSubstr("drawOnWheels"));
  EXPECT_THAT(here.run("explain run --robot R1 --time 21").out, AllOf(HasSubstr("heading "), HasSubstr("left wheel ")));
  EXPECT_EQ(here.run("audit run").status, 0);
  for (const char* flags : {"--controller paper-signs", "--integrator euler", "--controller-option filter_last=off",
                            "--controller-option brake_point=on"}) {
    const Outcome refused = here.run("simulate " + data_file("robots/B1_huskies.json") + " " + flags);
    EXPECT_EQ(refused.status, 2) << flags;
    EXPECT_THAT(refused.err, HasSubstr("with robots on wheels")) << flags;
  }
}

/// One robot of it without wheels, or a controller that its proof lacks.
TEST(WheelsVerb, FormationsThatAreNotProvenOnWheelsAreRefused) {
  const Workplace here;
  const std::string scene = here.read(data_file("robots/B1_huskies.json"));
  const auto refusal = [&](const std::string& from, const std::string& to) {
    here.write("bad.json", with(scene, from, to));
    const Outcome outcome = here.run("simulate bad.json");
    EXPECT_EQ(outcome.status, 2) << to;
    return outcome.err;
  };
  const std::size_t first = scene.find("\"heading\""), end = scene.find("},\n", first);
  EXPECT_THAT(refusal(scene.substr(first, end - first), "\"radius\": 0.598, \"max_speed\": 1 "),
              AllOf(HasSubstr("/robots/0/kinematics"), HasSubstr("E_SCENARIO"), HasSubstr("on wheels, or none")));
  const std::string options = "\"recentre\": true, \"controller_options\": ";
  EXPECT_THAT(refusal("\"recentre\": true", options + "{\"acceleration_bound\": 2}"),
              AllOf(HasSubstr("/formation/controller_options/acceleration_bound"), HasSubstr("E_SCENARIO")));
  EXPECT_THAT(refusal("\"recentre\": true", options + "{\"filter_last\": false}"),
              AllOf(HasSubstr("/formation/controller_options/filter_last"), HasSubstr("E_SCENARIO")));
  EXPECT_THAT(refusal("\"recentre\": true", options + "{\"brake_point\": true}"),
              AllOf(HasSubstr("/formation/controller_options/brake_point"), HasSubstr("E_SCENARIO")));
}

struct BadWheels {
  const char* from;
  const char* to;
  const char* pointer;
  const char* code;
  const char* advice;
};

void PrintTo(const BadWheels& bad, std::ostream* out) {
  *out << bad.pointer << " " << bad.code;
}

class RefusedWheels : public testing::TestWithParam<BadWheels> {};

TEST_P(RefusedWheels, SaysWhatToChange) {
  const BadWheels& bad = GetParam();
  const Workplace here;
  here.write("bad.json", with(burgers(), bad.from, bad.to));
  for (const char* verb : {"simulate bad.json --out out", "validate bad.json"}) {
    const Outcome outcome = here.run(verb);
    EXPECT_NE(outcome.status, 0) << verb;
    EXPECT_THAT(outcome.err + outcome.out,
                AllOf(HasSubstr("bad.json"), HasSubstr(bad.pointer), HasSubstr(bad.code), HasSubstr(bad.advice)))
        << verb;
  }
  EXPECT_FALSE(here.has("out"));
}

INSTANTIATE_TEST_SUITE_P(
    Wheels, RefusedWheels,
    testing::Values(
        BadWheels{"\"time_limit\": 60", "\"time_limit\": 60, \"braking_time\": 0.2", "/braking_time", "E_SCENARIO",
                  "more than the fastest robot needs to stop"},
        BadWheels{"\"time_limit\": 60", "\"time_limit\": 60, \"horizons\": {\"robots\": 0.1}", "/horizons/robots",
                  "E_SCENARIO", "needs to stop"},
        BadWheels{"\"time_limit\": 60", "\"time_limit\": 60, \"time_step\": 0.5, \"horizons\": {\"least\": 1}",
                  "/robots/0/kinematics/reference", "E_SCENARIO", "more than a step of max_wheel_speed"},
        BadWheels{"\"heading\": 180", "\"heading\": \"west\"", "/robots/1/heading", "E_TYPE", "number"},
        BadWheels{"\"heading\": 180", "\"heading\": 1e300", "/robots/1/heading", "E_RANGE", "1000000"},
        BadWheels{"\"wheel_separation\": 0.16", "\"wheel_axis\": 0.16", "/robots/0/kinematics", "E_KEY_UNKNOWN",
                  "wheel_separation"},
        BadWheels{"\"wheel_separation\": 0.16", "\"wheel_seperation\": 0.16", "/robots/0/kinematics/wheel_seperation",
                  "E_KEY_UNKNOWN", "did you mean \"wheel_separation\"?"},
        BadWheels{"\"radius\": 0.105", "\"raduis\": 0.105", "/robots/0/raduis", "E_KEY_UNKNOWN",
                  "did you mean \"radius\"?"},
        BadWheels{"\"radius\": 0.105",
                  "\"footprint\": {\"polygon\": [[0.1, -0.1], [0.3, -0.1], [0.3, 0.1], [0.1, 0.1]]}",
                  "/robots/0/footprint/polygon", "E_SCENARIO", "the centre of the axle"},
        BadWheels{"\"time_limit\": 60", "\"time_limit\": 60, \"uncertainty\": {\"tracking\": -1}",
                  "/uncertainty/tracking", "E_RANGE", "0"},
        BadWheels{"\"radius\": 0.105", "\"radius\": 0", "/robots/0/radius", "E_RANGE", "0"},
        BadWheels{"\"position\": [2, 0.1]", "\"position\": [0.3, 0.1]", "/robots/1/position", "E_SCENARIO", "overlap"},
        BadWheels{"\"differential\"", "\"ackermann\"", "/robots/0/kinematics/type", "E_OPTION", "differential"}));

}  // namespace
}  // namespace exactvo::test
