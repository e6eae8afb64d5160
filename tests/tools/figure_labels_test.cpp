// SPDX-License-Identifier: GPL-3.0-or-later
// What can be read in figures: every label of every kind of figure as it is drawn, and every caption.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <ostream>
#include <regex>
#include <string>
#include <vector>

#include "paper/campaign.h"
#include "run_program.h"

namespace exactvo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// Whether a reader would see markup: gnuplot's, or a power or an index as one types it.
bool shows_markup(const std::string& text) {
  static const std::regex markup(R"([{}\\^@]|/:|[A-Za-z0-9]_|\*\*|[A-Za-z]\*|sqrt|\btau\b)");
  return std::regex_search(text, markup);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// The words of an SVG as they are drawn.
std::vector<std::string> labels_of(const std::string& svg) {
  std::vector<std::string> labels;
  static const std::regex tag("<[^>]*>");
  for (std::size_t at = svg.find("<text>"); at != std::string::npos; at = svg.find("<text>", at + 1)) {
    std::string text = std::regex_replace(svg.substr(at, svg.find("</text>", at) - at), tag, "");
    for (const auto& [from, to] : {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&amp;", "&"}})
      text = replaced(text, from, to);
    labels.push_back(text);
  }
  return labels;
}

/// Looks at every SVG and every script's first line, which says what it shows, below `folder`; the number of figures.
int check_figures(const Workplace& here, const std::string& folder) {
  int figures = 0;
  for (const auto& [name, text] : here.files(folder)) {
    const std::string extension = fs::path(name).extension();
    if (extension == ".gp") {
      EXPECT_FALSE(shows_markup(text.substr(0, text.find('\n')))) << name << ": " << text.substr(0, text.find('\n'));
    }
    if (extension != ".svg") continue;
    ++figures;
    const std::vector<std::string> labels = labels_of(text);
    EXPECT_GT(labels.size(), 5u) << name;
    for (const std::string& label : labels) EXPECT_FALSE(shows_markup(label)) << name << ": " << label;
  }
  return figures;
}

TEST(FigureLabels, TheCheckSeesMarkup) {
  for (const char* text : {"a_{k+1}", "10^6", "v_x [m/s]", "m^2", "{/:Italic v}", "\\tau", "S / tau", "(m/s)^2"})
    EXPECT_TRUE(shows_markup(text)) << text;
  for (const char* text : {"Σ |ak+1 − ak|", "106", "vx [m/s]", "obstacle divided by τ", "(a) A0: all robots arrived"})
    EXPECT_FALSE(shows_markup(text)) << text;
  EXPECT_THAT(labels_of("<text><tspan a=\"b\">v</tspan><tspan>x</tspan></text><text>&lt;</text>"),
              testing::ElementsAre("vx", "<"));
}

struct Drawing {
  const char* name;
  std::string command;  ///< into the folder out
  int figures;
};

void PrintTo(const Drawing& d, std::ostream* out) {
  *out << d.name;
}

class FigureLabels : public testing::TestWithParam<Drawing> {};

const std::string kRobot = " --position 0,0 --velocity 1,0.2 --radius 0.5 --time-horizon 2 ";
const std::string kSquare = "'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))'";
constexpr const char* kMoving = R"({
  "name": "carts", "time_limit": 4,
  "robots": [{ "id": "R1", "position": [0, 0], "goal": [8, 0] }, { "id": "R2", "position": [8, 1], "goal": [0, 1] }],
  "obstacles": [{ "id": "wall", "polyline": [[4, -1], [4, 0]] }, { "id": "box", "polygon": [[3, 3], [5, 3], [5, 4]] }],
  "moving_obstacles": [{ "id": "cart", "polygon": [[-4, -1], [-3, -1], [-3, 1], [-4, 1]], "path": [[0, 0], [9, 0]], "speed": 4 }]
})";

TEST_P(FigureLabels, ShowNoMarkup) {
  const Workplace here;
  here.write("moving.json", kMoving);
  here.write("bow.wkt", "POLYGON((0 0, 2 2, 2 0, 0 2, 0 0))");
  here.write("u.wkt", "POLYGON((0 0, 4 0, 4 4, 3 4, 3 1, 1 1, 1 4, 0 4, 0 0))");
  fs::create_directories(here.path() / "out");
  const Outcome outcome = here.run(GetParam().command);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(check_figures(here, "out"), GetParam().figures);
}

INSTANTIATE_TEST_SUITE_P(
    EveryKind, FigureLabels,
    testing::Values(
        Drawing{"Cone", "vo --obstacle " + kSquare + " --enclose ellipse" + kRobot + "--figure out/a.svg", 1},
        Drawing{"Shared",
                "vo --obstacle " + kSquare + " --obstacle-velocity=-1,0 --responsibility 0.5" + kRobot +
                    "--figure out/a.svg",
                1},
        Drawing{"Pieces", "vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 3 0, 2 1, 2 -1))'" + kRobot + "--figure out/a.svg",
                1},
        Drawing{"Free", "vo --obstacle " + kSquare + " --free --max-speed 1.5" + kRobot + "--figure out/a.svg", 1},
        Drawing{"Explain", "explain moving.json --time 1 --robot 0 --out out/a.svg", 1},
        Drawing{"Simulate", "simulate moving.json --method orca --out out/run", 4},
        Drawing{"Formation", "simulate '" + data_file("paper/B3.json") + "' --out out/run", 6},
        Drawing{"Repair", "repair bow.wkt --out out/b.wkt --figure out/a.svg", 1},
        Drawing{"Segment", "segment u.wkt --figure out/a.svg", 1},
        Drawing{"Generate", "generate maze --count 1 --out out/m.wkt --figure out/a.svg", 1}),
    [](const auto& test) { return test.param.name; });

/// The scenarios of the paper over a tenth of a second, the one of the comparison under another name.
void write_short_paper(const Workplace& here) {
  const std::regex name(R"("name": *"A2")"), limit(R"("time_limit": *[0-9.]+)");
  fs::create_directories(here.path() / "data/paper");
  for (const auto& entry : fs::directory_iterator(data_file("paper"))) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream in(entry.path());
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    text = std::regex_replace(text, name, R"("name": "other")", std::regex_constants::format_first_only);
    text = std::regex_replace(text, limit, R"("time_limit": 0.1)");
    here.write("data/paper/" + entry.path().filename().string(), text);
  }
}

/// The SVG of some scripts of a folder.
void draw(const Workplace& here, const std::string& folder, const std::vector<std::string>& stems) {
  std::string command = "cd '" + (here.path() / folder).string() + "'";
  for (const std::string& stem : stems) command += " && gnuplot -d -e \"formats = 'svg'\" " + stem + ".gp";
  ASSERT_EQ(std::system(command.c_str()), 0);
}

TEST(FigureLabels, SheetsOfThePaperShowNoMarkupAndHaveLetters) {
  const Workplace here;
  write_short_paper(here);
  const Outcome outcome = here.run("paper --data data --out out", "PATH=/nowhere");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  draw(here, "out/figures", {"all-ivo", "all-formation", "jitter"});
  EXPECT_EQ(check_figures(here, "out/figures"), 3);
  const std::string sheet = here.read("out/figures/all-ivo.svg");
  for (const char* words : {">(a) A0: ", ">(p) A15: ", ">x [m]<", ">y [m]<", ">wall<", ">goal<", ">start, end<"})
    EXPECT_THAT(sheet, HasSubstr(words));
  const std::string jitter = here.read("out/figures/jitter.svg");
  EXPECT_THAT(labels_of(jitter), testing::Contains(HasSubstr("Σ |ak+1 − ak|")));
}

TEST(FigureLabels, ASheetWithoutRunsIsLeftOut) {
  const Workplace here;
  write_short_paper(here);
  const Outcome outcome = here.run("paper --data data --out out", "PATH=/nowhere");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(here.has("out/figures/all-orca.gp"));
  EXPECT_FALSE(here.has("out/figures/two-walls.gp")) << "it compares A2 by two methods";
}

TEST(FigureLabels, ThoseOfACampaignShowNoMarkup) {
  const Workplace here;
  write_short_paper(here);
  const auto files = tools::ablations({here.path() / "parts", 1, 7, 1}, here.path() / "data/paper");
  ASSERT_EQ(files.figures.size(), 2u);
  fs::create_directories(here.path() / "out");
  for (const tools::Figure& figure : files.figures) {
    write_sources(figure, here.path() / "out");
    draw(here, "out", {figure.name});
  }
  EXPECT_EQ(check_figures(here, "out"), 2);
}

}  // namespace
}  // namespace exactvo::test
