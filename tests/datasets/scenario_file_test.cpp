// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/scenario_file.h"

#include <algorithm>
#include <cmath>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/speed_profile.h"
#include "refusal.h"
#include "same_scenario.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using formation::Scenario;
using geometry::Vec2;

const std::filesystem::path kData = std::filesystem::path(EXACTVO_SOURCE_DIR) / "datasets" / "data";

/// Numbers that punish a writer: many digits, tiny, signed zero.
double awkward(SeededRandom& random) {
  switch (random.integer(0, 5)) {
    case 0:
      return -0.0;
    case 1:
      return std::ldexp(random.uniform(-1.0, 1.0), random.integer(-1060, -20));
    case 2:
      return random.integer(-5, 5);
    case 3:
      return std::nextafter(random.integer(-9, 9) * 0.1, 10.0);
    default:
      return random.uniform(-1.0, 1.0);
  }
}

Vec2 near(Vec2 p, SeededRandom& random) {
  return {p.x + awkward(random) * 0.1, p.y + awkward(random) * 0.1};
}

Scenario random_scenario(SeededRandom& random) {
  Scenario s;
  s.name = "random \"quoted\" \xc3\xa4";
  s.description = "line\nbreak\ttab\\";
  for (int i = 0; i < 3; ++i) {
    formation::Robot robot;
    robot.id = "R" + std::to_string(i);
    robot.position = near({10.0 * i, -50.0}, random);
    robot.velocity = {awkward(random), awkward(random)};
    robot.radius = random.uniform(0.1, 0.6);
    robot.max_speed = random.uniform(1.5, 4.0);
    robot.goals = {near({10.0 * i, 50.0}, random), near({10.0 * i, 60.0}, random)};
    s.robots.push_back(robot);
  }
  s.obstacles.push_back(
      {"wall", geometry::Polyline{{near({0, 0}, random), near({3, 1}, random), near({5, 0}, random)}}});
  geometry::Polygon solid;
  solid.outer = {near({10, 0}, random), near({20, 0}, random), near({20, 10}, random), near({10, 10}, random)};
  solid.holes = {{near({12, 2}, random), near({12, 4}, random), near({14, 4}, random), near({14, 2}, random)}};
  s.obstacles.push_back({"solid", solid});
  s.obstacles.push_back(formation::disc_obstacle("post", {near({40, 40}, random), random.uniform(0.01, 2)}));
  s.moving_obstacles.push_back(
      formation::moving_disc("ball", {near({-40, 40}, random), random.uniform(0.01, 2)},
                             formation::path_of({}, {{0.0, random.in_box(1)}, {1.5, random.in_box(1)}}, 20.0)));
  s.horizons = {random.uniform(0.2, 0.4), random.uniform(2, 4), random.uniform(0.2, 0.8), 2.0, random.uniform(1, 3)};
  s.margins = {random.uniform(0, 0.1), random.uniform(0, 0.1)};
  s.time_step = random.uniform(0.01, 0.05);
  s.time_limit = random.uniform(10, 100);
  s.arrival_tolerance = random.uniform(0.05, 0.2);
  s.neighbour_distance = random.uniform(5, 20);
  if (random.integer(0, 1) == 1) s.guidance = formation::Guidance::none;
  if (random.integer(0, 1) == 1) s.unreachable = formation::Unreachable::nearest;
  if (random.integer(0, 1) == 1) s.liveness = formation::Liveness::off;
  if (random.integer(0, 1) == 1) s.speed_bound = formation::SpeedBoundKind::box;
  return s;
}

void add_formation(Scenario& s, SeededRandom& random) {
  formation::FormationSpec spec;
  const double w = random.uniform(0.1, 2.0);
  spec.topology = {{{0, w, 1}, {w, 0, w}, {1, w, 0}}, {1, 0, w}};
  spec.offsets = {near({1, 1}, random), near({-1, 1}, random), near({1, -1}, random)};
  spec.recentre = random.integer(0, 1) == 1;
  spec.leader = {{{near({0, 0}, random), near({25, 25}, random)}, random.uniform(1, 4)}};
  spec.gains = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(10, 40), random.uniform(1, 2)};
  spec.catch_up_speed = random.uniform(1, 4);
  s.formation = spec;
  for (formation::Robot& robot : s.robots) robot.goals.clear();
}

TEST(ScenarioFile, Property1_RoundTripKeepsEveryBit) {
  SeededRandom random(exactvo::test::seed_of_run(7));
  for (int k = 0; k < 200; ++k) {
    Scenario scenario = random_scenario(random);
    if (k % 2 == 1) add_formation(scenario, random);
    const std::string text = write_scenario(scenario);
    const Scenario again = parse_scenario(text, "round trip", {});
    expect_same(scenario, again);
    EXPECT_EQ(write_scenario(again), text);
    if (HasFailure()) FAIL() << text;
  }
}

Scenario with_obstacles(const std::string& standing, const std::string& moving) {
  return parse_scenario(R"({"name": "n", "time_limit": 10, "robots": [{"id": "R", "position": [9, 9], "goal": [8, 8]}],
    "obstacles": [)" + standing +
                            R"(], "moving_obstacles": [)" + moving + "]}",
                        "t", {});
}

TEST(ScenarioFile, DiscsAreReadAsDiscs) {
  const Scenario s = with_obstacles(
      R"({"id": "post", "disc": {"centre": [1, 2], "radius": 0.25}}, {"disc": {"centre": [4, 4],
    "radius": 1}})",
      R"({"id": "ball", "disc": {"centre": [-3, 0], "radius": 0.5}, "path": [[0, 0], [1, 0]], "speed": 2})");
  ASSERT_TRUE(s.obstacles.at(0).disc);
  EXPECT_EQ(s.obstacles[0].disc->center, (Vec2{1, 2}));
  EXPECT_EQ(s.obstacles[0].disc->radius, 0.25);
  EXPECT_EQ(s.obstacles[1].id, "O2");
  ASSERT_TRUE(s.moving_obstacles.at(0).disc);
  EXPECT_EQ(s.moving_obstacles[0].disc->radius, 0.5);
  EXPECT_EQ(s.moving_obstacles[0].motion.speed, 2.0);
  EXPECT_TRUE(formation::validate(s).empty());
}

TEST(ScenarioFile, MovingObstaclesMaySayTheirVelocity) {
  const std::string square = R"("polygon": [[0, 0], [1, 0], [1, 1], [0, 1]], )";
  const Scenario one = with_obstacles("", "{" + square + R"("velocity": [0.5, -1]})");
  for (const double t : {0.0, 5.0, 10.0})
    EXPECT_LT(norm(formation::displacement_at(one.moving_obstacles.at(0), t) - t * Vec2{0.5, -1}), 1e-12);
  const Scenario many = with_obstacles("", "{" + square + R"("velocities": [[1, 1, 0], [3, 0, -2]]})");
  EXPECT_EQ(formation::displacement_at(many.moving_obstacles.at(0), 1.0), Vec2{});
  EXPECT_LT(norm(formation::displacement_at(many.moving_obstacles[0], 3.0) - Vec2{2, 0}), 1e-12);
  EXPECT_LT(norm(formation::displacement_at(many.moving_obstacles[0], 10.0) - Vec2{2, -14}), 1e-12);
  expect_same(many, parse_scenario(write_scenario(many), "t", {}));
}

TEST(ScenarioFile, WrongDiscsAndVelocitiesAreNamed) {
  struct Wrong {
    std::string standing, moving, place;
  };
  const std::string ball = R"({"disc": {"centre": [0, 0], "radius": 1}, )";
  for (const Wrong& w :
       {Wrong{R"({"disc": {"centre": [0, 0]}})", "", "/obstacles/0/disc"},
        Wrong{R"({"disc": {"centre": [0, 0], "radius": 0}})", "", "/obstacles/0/disc/radius"},
        Wrong{R"({"disc": {"centre": [1e9, 0], "radius": 1e-6}})", "", "/obstacles/0/disc/radius"},
        Wrong{"", ball + R"("velocity": [1, 2, 3]})", "/moving_obstacles/0/velocity"},
        Wrong{"", ball + R"("velocity": [1, 2], "path": [[0, 0]]})", "/moving_obstacles/0"},
        Wrong{"", ball + R"("velocity": [1, 2], "velocities": [[0, 1, 2]]})", "/moving_obstacles/0"},
        Wrong{"", ball + R"("velocities": [[1, 1, 2], [0, 1, 2]]})", "/moving_obstacles/0/velocities/1/0"},
        Wrong{"", ball + R"("velocities": [[-1, 1, 2]]})", "/moving_obstacles/0/velocities/0/0"},
        Wrong{"", ball + R"("path": [[0, 0]]})", "/moving_obstacles/0"}}) {
    const DataError refused = refusal_of([&] { with_obstacles(w.standing, w.moving); });
    EXPECT_EQ(refused.place(), w.place) << refused.what();
  }
}

TEST(ScenarioFile, SlowlyBrakingRobotsLookAheadUntilTheyStand) {
  const std::string head =
      R"({"name": "n", "robots": [{"id": "R", "position": [1, 2], "goal": [3, 4], "max_speed": 3}], )";
  const Scenario read = parse_scenario(head + R"("acceleration": {"max": 0.5}})", "t", {});
  EXPECT_EQ(read.horizons.most, formation::braking_time_of(read));
  EXPECT_EQ(read.horizons.robots, formation::braking_time_of(read));
  EXPECT_EQ(read.horizons.orca, formation::braking_time_of(read));
  const Scenario quick = parse_scenario(head + R"("acceleration": {"max": 50}})", "t", {});
  EXPECT_EQ(quick.horizons.most, formation::Horizons{}.most);
  const DataError refused = refusal_of(
      [&] { parse_scenario(head + R"("acceleration": {"max": 0.5}, "horizons": {"robots": 2}})", "t", {}); });
  EXPECT_EQ(refused.place(), "/horizons/robots") << refused.what();
}

TEST(ScenarioFile, RobotsThatPartCannotHaveAnAcceleration) {
  const DataError refused = refusal_of([&] {
    parse_scenario(R"({"name": "n", "robots": [{"id": "R", "position": [1, 2], "goal": [3, 4]}], "separate": true,
                       "acceleration": {"max": 3}})",
                   "t", {});
  });
  EXPECT_EQ(refused.place(), "/separate") << refused.what();
}

TEST(ScenarioFile, DefaultsAreThoseOfTheStructs) {
  const Scenario read =
      parse_scenario(R"({"name": "n", "robots": [{"id": "R", "position": [1, 2], "goal": [3, 4]}]})", "t", {});
  Scenario expected;
  expected.name = "n";
  formation::Robot robot;
  robot.id = "R";
  robot.position = {1, 2};
  robot.goals = {{3, 4}};
  expected.robots = {robot};
  expect_same(expected, read);
}

TEST(ScenarioFile, RingsArePutRight) {
  const Scenario scenario = parse_scenario(R"({"name": "n", "robots": [{"id": "R", "position": [9, 9], "goal": [8, 8]}],
    "obstacles": [{"polygon": [[0, 0], [0, 1], [1, 1], [1, 0], [0, 0]]},
                  {"polygon": [[5, 5], [6, 5], [6, 5], [6, 6]]}]})",
                                           "t", {});
  const auto& square = std::get<geometry::Polygon>(scenario.obstacles[0].shape);
  EXPECT_EQ(square.outer.size(), 4u);
  double doubled_area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) doubled_area += cross(square.outer[i], square.outer[(i + 1) % 4]);
  EXPECT_EQ(doubled_area, 2.0) << "counter-clockwise";
  EXPECT_EQ(std::get<geometry::Polygon>(scenario.obstacles[1].shape).outer.size(), 3u);
  EXPECT_EQ(scenario.obstacles[0].id, "O1");
}

class EveryPaperScenario : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryPaperScenario, LoadsAndRoundTrips) {
  const std::string name = GetParam();
  const Scenario scenario = load_scenario(kData / "paper" / (name + ".json"));
  EXPECT_EQ(scenario.name, name);
  EXPECT_EQ(scenario.formation.has_value(), name[0] == 'B');
  EXPECT_EQ(scenario.time_step, name[0] == 'B' ? 0.02 : 0.05);
  EXPECT_EQ(scenario.time_limit, name[0] == 'B' ? 25.0 : 120.0);
  for (const formation::Robot& robot : scenario.robots) {
    EXPECT_EQ(robot.radius, 0.5);
    EXPECT_EQ(robot.max_speed, name[0] == 'B' ? 6.0 : 3.0);
  }
  expect_same(scenario, parse_scenario(write_scenario(scenario), name, {}));
}

INSTANTIATE_TEST_SUITE_P(SectionV, EveryPaperScenario,
                         ::testing::Values("A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10", "A11",
                                           "A12", "A13", "A14", "A15", "B0", "B1", "B2", "B3"),
                         [](const auto& each) { return std::string(each.param); });

TEST(PaperScenarios, RobotsAreThoseOfTheTables) {
  const auto robots = [](const std::string& name) {
    return load_scenario(kData / "paper" / (name + ".json")).robots.size();
  };
  EXPECT_EQ(robots("A1"), 2u);
  EXPECT_EQ(robots("A7"), 4u);
  for (const char* alone : {"A11", "A14", "A15"}) EXPECT_EQ(robots(alone), 1u) << alone;
  EXPECT_EQ(robots("B3"), 3u);
}

TEST(PaperScenarios, WallOfA9IsTwelveMetresAndItsMiddleAsStated) {
  const Scenario a9 = load_scenario(kData / "paper" / "A9.json");
  const auto& points = std::get<geometry::Polyline>(a9.obstacles.at(0).shape).points;
  const Vec2 middle = 0.5 * (points[0] + points[1]);
  EXPECT_NEAR(middle.x, 9.0, 1e-12);
  EXPECT_NEAR(middle.y, 4.68, 1e-12);
  EXPECT_NEAR(norm(points[1] - points[0]), 12.0, 1e-3);  // |w| = 0.99997
}

TEST(PaperScenarios, LeaderOfTheFormationMovesAtThreeByThree) {
  const Scenario b0 = load_scenario(kData / "paper" / "B0.json");
  EXPECT_EQ(b0.formation->leader.speed, std::sqrt(18.0));
  EXPECT_EQ(b0.formation->leader.path.back(), (Vec2{25, 25}));
}

TEST(FilesOfScenario, NamesTheScenarioAndWhatItRefersTo) {
  const auto files = files_of_scenario(kData / "office" / "office.json");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[1].filename(), "floor.geojson");
  EXPECT_EQ(files_of_scenario(kData / "paper" / "A2.json").size(), 1u);
}

class FilesOfARun : public TemporaryFolder {};

TEST_F(FilesOfARun, IncludeWhatIsReadWithObstacleFiles) {
  put("room.pgm", "P2\n3 3\n255\n255 255 255\n255 0 255\n255 255 255\n");
  put("room.yaml",
      "image: room.pgm\nresolution: 1\norigin: [5, 5, 0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.2\n");
  put("inner.json", R"({"name": "inner", "robots": [{"id": "R", "position": [0, 0], "goal": [1, 0]}],
             "obstacles": [{"file": "room.yaml"}]})");
  put("s.json", R"({"name": "s", "robots": [{"id": "R", "position": [0, 0], "goal": [1, 0]}],
             "obstacles": [{"file": "inner.json", "id": "a"}, {"file": "room.yaml", "id": "b"}]})");
  std::vector<std::string> names;
  for (const auto& file : load_scenario_with_notes(folder_ / "s.json").files) names.push_back(file.filename().string());
  EXPECT_EQ(names, (std::vector<std::string>{"s.json", "inner.json", "room.yaml", "room.pgm"}));
}

TEST_F(FilesOfARun, AScenarioSaysWhatUnknownCellsOfAMapAre) {
  put("room.pgm", "P2\n3 3\n255\n205 255 255\n255 0 255\n255 255 205\n");
  put("room.yaml", "image: room.pgm\nresolution: 1\norigin: [5, 5, 0]\n");
  const auto load = [&](const std::string& option) {
    return load_scenario_with_notes(put("s.json", R"({"name": "s", "robots": [{"id": "R", "position": [0, 0],
             "goal": [1, 0]}], "obstacles": [{"file": "room.yaml")" +
                                                      option + "}]}"));
  };
  const auto has_note = [](const LoadedScenario& s, const std::string& words) {
    return std::any_of(s.notes.begin(), s.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_EQ(load("").scenario.obstacles.size(), 1u);
  EXPECT_TRUE(has_note(load(R"(, "unknown": "free")"), "2 unknown cells taken as free"));
  const LoadedScenario blocked = load(R"(, "unknown": "blocked")");
  EXPECT_EQ(blocked.scenario.obstacles.size(), 3u);
  EXPECT_TRUE(has_note(blocked, "2 unknown cells taken as blocked"));
  const DataError refused = refusal_of([&] { load(R"(, "unknown": "wall")"); });
  EXPECT_EQ(refused.place(), "/obstacles/0/unknown");
}

}  // namespace
}  // namespace exactvo::datasets::test
