// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "exactvo/datasets/scenario_file.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

DataError refused(const std::string& text, const std::filesystem::path& folder = {}) {
  return refusal_of([&] { parse_scenario(text, "bad.json", folder); });
}

/// A scenario that can be run, with `members` beside its name and robot.
std::string with(const std::string& members) {
  return R"({"name": "n", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}], )" + members + "}";
}

std::string with_robot(const std::string& members) {
  return R"({"name": "n", "robots": [{"id": "R", "position": [0, 0], )" + members + "}]}";
}

struct Misfit {
  const char* what;
  std::string text;
  DataCode code;
  const char* place;
};

void PrintTo(const Misfit& misfit, std::ostream* out) {
  *out << misfit.what;
}

class Property2_EveryMisfitIsPlaced : public ::testing::TestWithParam<Misfit> {};

TEST_P(Property2_EveryMisfitIsPlaced, WithCodeAndPointer) {
  const DataError error = refused(GetParam().text);
  expect_refusal(error, GetParam().code, GetParam().place);
  EXPECT_EQ(error.file(), "bad.json");
  EXPECT_FALSE(error.found().empty());
  EXPECT_FALSE(error.expected().empty());
  EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
}

const char* const kSquare = R"("obstacles": [{"polygon": [[5,5],[6,5],[6,6],[5,6]]}, )";

INSTANTIATE_TEST_SUITE_P(
    Scenario, Property2_EveryMisfitIsPlaced,
    ::testing::Values(
        Misfit{"NotJson", "{\n  \"name\": oops}", DataCode::json_syntax, "line 2, column 11"},
        Misfit{"Empty", "", DataCode::json_syntax, "line 1, column 1"},
        Misfit{"CutShort", "{\"name\": \"n\"", DataCode::json_syntax, "line 1, column 13"},
        Misfit{"DuplicateKey", "{\"name\": \"n\",\n \"name\": 1}", DataCode::json_duplicate_key, "line 2, column 8"},
        Misfit{"HugeNumber", "{\"name\": 1e999}", DataCode::number, "line 1, column 16"},
        Misfit{"NotAnObject", "[]", DataCode::wrong_type, ""},
        Misfit{"NoRobots", R"({"name": "n"})", DataCode::key_missing, ""},
        Misfit{"EmptyRobots", R"({"name": "n", "robots": []})", DataCode::wrong_count, "/robots"},
        Misfit{"NameIsNumber", R"({"name": 3, "robots": []})", DataCode::wrong_type, "/name"},
        Misfit{"EmptyName", R"({"name": "", "robots": []})", DataCode::wrong_count, "/name"},
        Misfit{"NoPosition", R"({"name": "n", "robots": [{"id": "R"}]})", DataCode::key_missing, "/robots/0"},
        Misfit{"ZeroRadius", with_robot(R"("radius": 0)"), DataCode::out_of_range, "/robots/0/radius"},
        Misfit{"NegativeSpeed", with_robot(R"("max_speed": -1)"), DataCode::out_of_range, "/robots/0/max_speed"},
        Misfit{"ThreeCoordinates", with_robot(R"("goal": [1, 2, 3])"), DataCode::wrong_count, "/robots/0/goal"},
        Misfit{"TextCoordinate", with_robot(R"("goal": [1, "2"])"), DataCode::wrong_type, "/robots/0/goal/1"},
        Misfit{"NullCoordinate", with_robot(R"("goal": [null, 2])"), DataCode::wrong_type, "/robots/0/goal/0"},
        Misfit{"FarAway", with_robot(R"("goal": [1e10, 2])"), DataCode::out_of_range, "/robots/0/goal/0"},
        Misfit{"GoalAndGoals", with_robot(R"("goal": [1, 2], "goals": [])"), DataCode::no_alternative, "/robots/0"},
        Misfit{"MistypedKey", with_robot(R"("radios": 1)"), DataCode::key_unknown, "/robots/0/radios"},
        Misfit{"StrangeKey", with(R"("a/b~c": 1)"), DataCode::key_unknown, "/a~1b~0c"},
        Misfit{"SpeedBound", with(R"("speed_bound": "circle")"), DataCode::not_an_option, "/speed_bound"},
        Misfit{"ZeroStep", with(R"("time_step": 0)"), DataCode::out_of_range, "/time_step"},
        Misfit{"NoObstacleKind", with(R"("obstacles": [{"id": "x"}])"), DataCode::no_alternative, "/obstacles/0"},
        Misfit{"ObstacleIsList", with(R"("obstacles": [[[0, 0], [1, 1]]])"), DataCode::wrong_type, "/obstacles/0"},
        Misfit{"TwoKinds", with(R"("obstacles": [{"polyline": [[1,1],[2,2]], "polygon": []}])"),
               DataCode::no_alternative, "/obstacles/0"},
        Misfit{"OnePointWall", with(R"("obstacles": [{"polyline": [[1, 1]]}])"), DataCode::wrong_count,
               "/obstacles/0/polyline"},
        Misfit{"SamePointTwice", with(R"("obstacles": [{"polyline": [[1, 1], [1, 1]]}])"), DataCode::too_few_points,
               "/obstacles/0/polyline"},
        Misfit{"FlatPolygon", with(R"("obstacles": [{"polygon": [[1,1],[2,2],[3,3]]}])"), DataCode::zero_area,
               "/obstacles/0/polygon"},
        Misfit{"Bowtie", with(std::string(kSquare) + R"({"polygon": [[1,1],[3,3],[3,1],[1,3]]}])"),
               DataCode::self_intersection, "/obstacles/1/polygon"},
        Misfit{"HoleOutside", with(R"("obstacles": [{"polygon": [[5,5],[6,5],[6,6],[5,6]],
               "holes": [[[7,7],[8,7],[8,8]]]}])"),
               DataCode::hole_outside, "/obstacles/0/holes/0"},
        Misfit{"NoSuchFile", with(R"("obstacles": [{"file": "no such.wkt"}])"), DataCode::file_missing,
               "/obstacles/0/file"},
        Misfit{"RobotTwice",
               R"({"name": "n", "robots": [{"id": "R", "position": [0, 0]}, {"id": "R", "position": [5, 5]}]})",
               DataCode::scenario, "/robots/1/id"},
        Misfit{"ObstacleTwice", with(R"("obstacles": [{"id": "a", "polyline": [[3,3],[4,4]]},
               {"id": "a", "polyline": [[5,5],[6,6]]}])"),
               DataCode::scenario, "/obstacles/1/id"},
        Misfit{"UnnamedObstacleTwice", with(R"("obstacles": [{"id": "O2", "polyline": [[3,3],[4,4]]},
               {"polyline": [[5,5],[6,6]]}])"),
               DataCode::scenario, "/obstacles/1"}),
    [](const auto& each) { return std::string(each.param.what); });

TEST(ScenarioRefusals, Property3_TheNearestKeyIsSuggested) {
  EXPECT_EQ(refused(with_robot(R"("radios": 1)")).expected(), "a known key; did you mean \"radius\"?");
  EXPECT_EQ(refused(with(R"("obstacle": [])")).expected(), "a known key; did you mean \"obstacles\"?");
  EXPECT_EQ(refused(R"({"name": "n", "robot": []})").expected(), "a known key; did you mean \"robots\"?");
  EXPECT_EQ(refused(R"({"name": "n", "robots": [{"id": "R1", "position": [0,0], "golas": [[9,0]]}]})").expected(),
            "a known key; did you mean \"goals\"?");
  EXPECT_EQ(refused(R"({"name": "n", "robots": [{"id": "R1", "position": [0,0], "goal": [9,0], "gaol": []}]})")
                .expected()
                .substr(0, 6),
            "one of")
      << "a second goal was not meant";
  EXPECT_NE(refused(with(R"("xyzzyx": 1)")).expected().find("one of"), std::string::npos);
}

TEST(ScenarioRefusals, SelfCrossingRingsSayWhere) {
  const DataError error = refused(with(R"("obstacles": [{"polygon": [[1,1],[3,3],[3,1],[1,3]]}])"));
  EXPECT_NE(error.found().find("(2, 2)"), std::string::npos) << error.what();
}

// The words of what() are what people get to see.
TEST(ScenarioRefusals, MessagesAreSentences) {
  const auto message = [](const std::string& text) { return std::string(refused(text).what()); };
  EXPECT_NE(message(with_robot(R"("goal": [1, 2], "goals": [])"))
                .find("found both \"goal\" and \"goals\", expected goal or goals, not both"),
            std::string::npos);
  EXPECT_NE(message(R"({"name": "n", "robots": []})").find("expected at least 1 entry ["), std::string::npos);
  EXPECT_NE(message(R"({"name": "", "robots": []})").find("expected at least 1 character ["), std::string::npos);
  EXPECT_NE(message(with(R"("obstacles": [{"polyline": [[1, 1]]}])")).find("expected at least 2 entries"),
            std::string::npos);
  EXPECT_NE(message(with(R"("obstacles": [{"polygon": [[1,1],[3,3],[3,1],[1,3]]}])")).find("at vertex 0, (2, 2)"),
            std::string::npos);
}

TEST(ScenarioRefusals, EndlessNestingIsRefused) {
  const DataError error = refused(std::string(100000, '['));
  EXPECT_EQ(error.code(), DataCode::nesting);
  EXPECT_EQ(refused("{\"name\":" + std::string(100000, '{')).code(), DataCode::json_syntax);
}

using ScenarioFiles = TemporaryFolder;

TEST_F(ScenarioFiles, AMissingScenarioIsNamed) {
  const DataError error = refusal_of([&] { load_scenario(folder_ / "none.json"); });
  EXPECT_EQ(error.code(), DataCode::file_missing);
  EXPECT_EQ(error.file(), (folder_ / "none.json").string());
  EXPECT_EQ(refusal_of([&] { load_scenario(folder_); }).code(), DataCode::file_unreadable);
}

TEST_F(ScenarioFiles, AnEmptyScenarioIsCalledSo) {
  const auto path = put("empty.json", "");
  const DataError error = refusal_of([&] { load_scenario(path); });
  EXPECT_EQ(error.code(), DataCode::json_syntax);
  EXPECT_EQ(error.found(), "an empty file");
}

TEST_F(ScenarioFiles, AScenarioThatNamesItselfHasAnEnd) {
  const auto self = put("self.json", with(R"("obstacles": [{"file": "self.json"}])"));
  put("a.json", with(R"("obstacles": [{"file": "b.json"}, {"file": "b.json"}])"));
  put("b.json", with(R"("obstacles": [{"file": "a.json"}, {"file": "a.json"}])"));
  for (const auto& path : {self, folder_ / "a.json"}) {
    const DataError error = refusal_of([&] { load_scenario(path); });
    EXPECT_EQ(error.code(), DataCode::nesting) << error.what();
  }
  put("0.json", with(R"("obstacles": [{"polyline": [[3, 3], [5, 3]]}])"));
  for (int k = 1; k <= 8; ++k) {
    const std::string below = std::to_string(k - 1) + ".json";
    put(std::to_string(k) + ".json", with("\"obstacles\": [{\"file\": \"" + below + "\"}]"));
  }
  EXPECT_EQ(load_scenario(folder_ / "8.json").obstacles.size(), 1u);
}

// Scenario, pointer and path: all three are needed to correct it.
void expect_named(const DataError& error, DataCode code, const std::string& place, const std::filesystem::path& path) {
  EXPECT_EQ(error.file(), "scenario.json") << error.what();
  expect_refusal(error, code, place);
  EXPECT_NE(error.found().find(path.string()), std::string::npos) << error.what();
}

TEST_F(ScenarioFiles, AnObstacleFileThatCannotBeReadIsNamedWithTheScenario) {
  std::filesystem::create_directory(folder_ / "walls");
  put("empty.wkt", "");
  put("strange.xyz", "what is this\n");
  const auto refusal = [&](const std::string& members) {
    return refusal_of([&] { parse_scenario(with("\"obstacles\": [{" + members + "}]"), "scenario.json", folder_); });
  };
  expect_named(refusal(R"("file": "none.wkt")"), DataCode::file_missing, "/obstacles/0/file", folder_ / "none.wkt");
  expect_named(refusal(R"("file": "walls")"), DataCode::file_unreadable, "/obstacles/0/file", folder_ / "walls");
  expect_named(refusal(R"("file": "empty.wkt")"), DataCode::format_unknown, "/obstacles/0/file", folder_ / "empty.wkt");
  expect_named(refusal(R"("file": "strange.xyz")"), DataCode::format_unknown, "/obstacles/0/file",
               folder_ / "strange.xyz");
  expect_named(refusal(R"("file": "strange.xyz", "format": "wtk")"), DataCode::not_an_option, "/obstacles/0/format",
               folder_ / "strange.xyz");
}

TEST_F(ScenarioFiles, NotesTellWhatWasDoneToObstacleFiles) {
  put("walls.wkt", "POINT (0 0)\nPOLYGON ((30 0, 31 1, 31 0, 30 0))\n");
  const LoadedScenario loaded =
      parse_scenario_with_notes(with(R"("obstacles": [{"file": "walls.wkt"}])"), "scenario.json", folder_);
  EXPECT_EQ(loaded.scenario.obstacles.size(), 1u);
  ASSERT_EQ(loaded.notes.size(), 2u);
  EXPECT_EQ(loaded.notes[0].rfind((folder_ / "walls.wkt").string() + ": 1 of the obstacles repaired", 0), 0u);
  EXPECT_EQ(loaded.notes[1].rfind((folder_ / "walls.wkt").string() + ": 1 skipped", 0), 0u);
}

TEST_F(ScenarioFiles, ObstacleFilesAreFoundBesideTheScenario) {
  put("walls.wkt", "LINESTRING (20 0, 21 1)\nPOLYGON ((30 0, 31 0, 31 1, 30 0))\n");
  const auto path = put("s.json", with(R"("obstacles": [{"file": "walls.wkt"}])"));
  const formation::Scenario scenario = load_scenario(path);
  ASSERT_EQ(scenario.obstacles.size(), 2u);
  EXPECT_EQ(scenario.obstacles[0].id, "walls/1");
  EXPECT_EQ(scenario.obstacles[1].id, "walls/2");
}

TEST_F(ScenarioFiles, WhatIsWrongInAnObstacleFileIsNamedInThatFile) {
  put("walls.wkt", "POLYGON ((30 0, 31 1, 31 0, 30 1, 30 0))\n");
  const DataError error = refused(with(R"("obstacles": [{"file": "walls.wkt"}])"), folder_);
  EXPECT_EQ(error.file(), (folder_ / "walls.wkt").string());
  expect_refusal(error, DataCode::self_intersection, "line 1, column 1, ring 0, vertex 0");
}

// An obstacle of a file that lies farther than the schema lets one lie that stands in the scenario: enclosures failed.
TEST_F(ScenarioFiles, ObstaclesOfFilesLieWithinTheScenariosBound) {
  const std::string scenario = with(R"("obstacles": [{"file": "walls.wkt"}])");
  put("walls.wkt", "LINESTRING (20 0, 21 1)\nLINESTRING (30 -1e9, 30 1e9)\n");
  EXPECT_NO_THROW(parse_scenario(scenario, "scenario.json", folder_));
  put("walls.wkt", "LINESTRING (20 0, 21 1)\nLINESTRING (30 -1e20, 30 1e20)\n");
  const DataError error = refused(scenario, folder_);
  EXPECT_EQ(error.file(), (folder_ / "walls.wkt").string());
  expect_refusal(error, DataCode::out_of_range, "obstacle 2");
}

}  // namespace
}  // namespace exactvo::datasets::test
