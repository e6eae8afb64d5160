// SPDX-License-Identifier: GPL-3.0-or-later
// What a figure is called, and what the folders and scenarios behind it are called, runs nothing: gnuplot takes a file
// name behind < or | for a command, and runs what stands between backticks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "figures/figure.h"
#include "run_program.h"

namespace exactvo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// Each of them creates the file X where it is run or continued as one command or another.
const std::vector<std::string> kHostile = {
    "<touch X;",
    "<cd ..;touch X;",
    "|touch X;",
    "`touch X`",
    "';system('touch X');'",
    "\";system(\"touch X\");\"",
    "@{X}_^~\\$(touch X)",
    "-",
    "a b\xc3\xa9.c",
};

/// These are refused: they would deceive whoever lists the folder.
const std::vector<std::string> kUnprintable = {"a'\nsystem('touch X')\n'", "\xff\x1b[31m"};

std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

constexpr const char* kScene = R"({
  "name": "`touch X`", "time_limit": 3,
  "robots": [{ "id": "<touch X;", "position": [0, 0], "goal": [8, 0] }],
  "obstacles": [{ "id": "|touch X;", "polyline": [[4, -1], [4, 1]] }]
})";

struct FigureOf {
  const char* verb;
  std::string command;  ///< less the name of the figure, which follows
};

/// Only for failure messages.
void PrintTo(const FigureOf& f, std::ostream* out) {
  *out << f.verb;
}

class FigureNames : public testing::TestWithParam<FigureOf> {
 protected:
  FigureNames() {
    work_.write("s.json", kScene);
    work_.write("bow.wkt", "POLYGON((0 0, 2 2, 2 0, 0 2, 0 0))");
    work_.write("square.wkt", "POLYGON((0 0, 2 0, 2 2, 0 2, 0 0))");
    work_.write("walk.csv", "t,id,x,y\n0,A,0,0\n1,A,1,0\n0,B,0,1\n1,B,1,1\n");
  }
  /// Files that are called X, in any folder.
  std::size_t traces() const {
    const auto files = work_.files(".");
    return static_cast<std::size_t>(
        std::count_if(files.begin(), files.end(), [](const auto& f) { return fs::path(f.first).filename() == "X"; }));
  }
  Workplace work_;
};

TEST_P(FigureNames, RunNothingAndAreThoseAskedFor) {
  for (const std::string& stem : kHostile) {
    const std::string folder = "out/" + stem, figure = folder + "/" + stem;
    const Outcome outcome = work_.run(GetParam().command + " " + shell_word(figure + ".svg"));
    EXPECT_EQ(outcome.status, 0) << figure << "\n" << outcome.err;
    EXPECT_EQ(traces(), 0u) << figure;
    for (const char* picture : {".svg", ".png", ".pdf"}) {
      ASSERT_TRUE(work_.has(figure + picture)) << figure << picture;
      EXPECT_GT(fs::file_size(work_.path() / (figure + picture)), 1000u);
    }
    for (const char* source : {".gp", ".dat"})
      EXPECT_TRUE(work_.has(folder + "/" + tools::plain_name(stem) + source)) << figure << source;
    EXPECT_EQ(work_.files("out").size(), 5u) << figure << ": nothing else is left";
    fs::remove_all(work_.path() / "out");
  }
}

TEST_P(FigureNames, AreRefusedWhereTheyAreUnprintable) {
  for (const std::string& stem : kUnprintable) {
    const Outcome outcome = work_.run(GetParam().command + " " + shell_word("out/" + stem + ".svg"));
    EXPECT_EQ(outcome.status, 2) << stem;
    EXPECT_THAT(outcome.err, HasSubstr("control characters"));
    EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("\x1b")));
    EXPECT_EQ(traces(), 0u) << stem;
    EXPECT_FALSE(work_.has("out"));
  }
}

TEST_P(FigureNames, DrawInAFolderOfAnyName) {
  const std::string folder = "`touch X`\n'\"\xff";
  fs::create_directories(work_.path() / folder);
  for (const char* file : {"s.json", "bow.wkt", "square.wkt", "walk.csv"})
    work_.write(folder + "/" + file, work_.read(file));
  const std::string command = "cd " + shell_word((work_.path() / folder).string()) + " && '" EXACTVO_PROGRAM "' " +
                              GetParam().command + " plain.svg > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(work_.has(folder + "/plain.png"));
  EXPECT_EQ(traces(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Verbs, FigureNames,
    testing::Values(FigureOf{"vo",
                             "vo --obstacle 'LINESTRING(2 -1, 2 1)' --position 0,0 --velocity 1,0 --radius 0.3 "
                             "--time-horizon 2 --figure"},
                    FigureOf{"explain", "explain s.json --time 1 --robot 0 --out"},
                    FigureOf{"repair", "repair bow.wkt --out repaired.wkt --figure"},
                    FigureOf{"segment", "segment square.wkt --figure"},
                    FigureOf{"route", "route square.wkt --from -2,0 --to 9,1 --radius 0.1 --figure"},
                    FigureOf{"check", "check walk.csv --radius 0.1 --figure"},
                    FigureOf{"generate", "generate star --count 1 --out star.wkt --figure"}),
    [](const auto& test) { return test.param.verb; });

TEST(FigureNames, AScriptDrawsItsFigureAgain) {
  const Workplace here;
  const std::string stem = "<touch X;";
  ASSERT_EQ(here.run("generate star --count 1 --out star.wkt --figure " + shell_word(stem + ".svg")).status, 0);
  const std::string plain = tools::plain_name(stem);
  EXPECT_FALSE(here.has(plain + ".svg"));
  ASSERT_EQ(std::system(("cd '" + here.path().string() + "' && gnuplot '" + plain + ".gp'").c_str()), 0);
  EXPECT_EQ(here.read(plain + ".png"), here.read(stem + ".png"));
}

TEST(FigureNames, ThoseOfRobotsAndObstaclesAreWrittenAsTheyStand) {
  const Workplace here;
  const std::vector<std::string> ids = {"'.system('touch X').'", "\"`touch X`", "@{a}_b^c~d&e\\", "</title><script>"};
  nlohmann::json robots = nlohmann::json::array();
  for (const std::string& id : ids)
    robots.push_back({{"id", id}, {"position", {0, 3 * robots.size()}}, {"goal", {2, 3 * robots.size()}}});
  const nlohmann::json wall = {{"id", "'; system('touch X') #"}, {"polyline", {{1, -2}, {1, -1}}}};
  const nlohmann::json scene = {{"name", "'"}, {"time_limit", 1}, {"robots", robots}, {"obstacles", {wall}}};
  here.write("s.json", scene.dump());
  const Outcome outcome = here.run("simulate s.json --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_FALSE(here.has("X") || here.has("out/figures/X"));
  const std::string svg = here.read("out/figures/paths.svg");
  for (const char* id :
       {">'.system('touch X').'<", ">\"`touch X`<", ">@{a}_b^c~d&amp;e\\<", ">&lt;/title>&lt;script><"})
    EXPECT_THAT(svg, HasSubstr(id));
  for (const char* name : {"paths", "obstacle_distance", "robot_distance", "velocity"})
    EXPECT_TRUE(here.has(std::string("out/figures/") + name + ".png")) << name;
  const Outcome explained = here.run("explain s.json --time 0.5 --robot 0 --out space.svg");
  EXPECT_EQ(explained.status, 0) << explained.err;
  EXPECT_THAT(here.read("space.svg"), HasSubstr("velocity space of '.system('touch X').'"));
}

TEST(FigureNames, ScenariosOfThePaperWriteNowhereElse) {
  const Workplace here;
  const std::regex name(R"("name": *"[^"]*")"), limit(R"("time_limit": *[0-9.]+)");
  fs::create_directories(here.path() / "data/paper");
  for (const auto& entry : fs::directory_iterator(data_file("paper"))) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream in(entry.path());
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    text =
        std::regex_replace(text, name, R"("name": "../../../../elsewhere")", std::regex_constants::format_first_only);
    text = std::regex_replace(text, limit, R"("time_limit": 0.1)");
    here.write("data/paper/" + entry.path().filename().string(), text);
  }
  const Outcome outcome = here.run("paper --data data --out a/b/out", "PATH=/nowhere");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(here.has("a/b/out/figures/fig6-ivo/A2/paths.gp"));
  for (const auto& entry : fs::recursive_directory_iterator(here.path()))
    EXPECT_NE(entry.path().filename(), "elsewhere") << entry.path();
}

TEST(PlainName, IsTheNameItselfOrAnotherOfItsOwn) {
  for (const char* name : {"a", "fig-3_b.2", "two words", ".hidden", "Gr\xc3\xbc\xc3\x9f"})
    EXPECT_EQ(tools::plain_name(name), name);
  std::set<std::string> seen;
  std::vector<std::string> names = kHostile;
  names.insert(names.end(), kUnprintable.begin(), kUnprintable.end());
  for (const std::string& name : names) {
    const std::string plain = tools::plain_name(name);
    EXPECT_EQ(plain.find_first_of("<>|`'\"$;@{}~\\\n\x1b"), std::string::npos) << plain;
    EXPECT_EQ(tools::plain_name(plain), plain);
    EXPECT_TRUE(seen.insert(plain).second) << plain;
  }
  EXPECT_LT(tools::plain_name(std::string(5000, '<')).size(), 100u);
  EXPECT_FALSE(tools::plain_name("").empty());
}

}  // namespace
}  // namespace exactvo::test
