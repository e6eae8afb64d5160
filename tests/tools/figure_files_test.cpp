// SPDX-License-Identifier: GPL-3.0-or-later
// What a figure consists of: SVG, PNG and PDF, whichever was named; nothing half drawn, nothing of an earlier figure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "run_program.h"

namespace exactvo::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kVo =
    "vo --obstacle 'LINESTRING(2 -1, 2 1)' --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2 --figure ";

TEST(FigureFiles, AnyOfTheThreeExtensionsDrawsAllThree) {
  for (const char* extension : {"svg", "png", "pdf"}) {
    const Workplace here;
    const Outcome outcome = here.run(std::string(kVo) + "out/a." + extension);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("wrote out/a.") + extension));
    EXPECT_EQ(here.files("out").size(), 5u);
    EXPECT_EQ(here.read("out/a.pdf").substr(0, 5), "%PDF-");
    EXPECT_EQ(here.read("out/a.png").substr(1, 3), "PNG");
    EXPECT_THAT(here.read("out/a.svg"), HasSubstr("<svg"));
  }
}

TEST(FigureFiles, AnotherExtensionIsRefusedAndTheThreeAreNamed) {
  const Workplace here;
  here.write("s.json",
             R"({"name": "s", "robots": [{"id": "R1", "position": [0, 0], "goal": [8, 0]}], "obstacles": []})");
  here.write("bow.wkt", "POLYGON((0 0, 2 2, 2 0, 0 2, 0 0))");
  for (const std::string& command :
       {std::string(kVo), std::string("explain s.json --time 1 --robot 0 --out "),
        std::string("repair bow.wkt --out repaired.wkt --figure "), std::string("segment bow.wkt --repair --figure "),
        std::string("generate star --count 1 --out star.wkt --figure ")}) {
    for (const char* name : {"a.jpg", "a", "a.SVG.txt", "pdf"}) {
      const Outcome outcome = here.run(command + name);
      EXPECT_EQ(outcome.status, 2) << command << name;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(".svg"), HasSubstr(".png"), HasSubstr(".pdf"))) << command << name;
      EXPECT_FALSE(here.has(name));
    }
    EXPECT_FALSE(here.has("repaired.wkt") || here.has("star.wkt")) << "refused before the work";
  }
}

TEST(FigureFiles, HelpNamesAllThree) {
  const Workplace here;
  for (const char* verb : {"vo", "explain", "repair", "segment", "generate", "check"})
    EXPECT_THAT(here.run(std::string("help ") + verb).out, HasSubstr("FILE.svg, FILE.png or FILE.pdf")) << verb;
}

TEST(FigureFiles, CharactersThatNoFontHasAreNamed) {
  const Workplace here;
  const auto drawn = [&](const std::string& id) {
    here.write("s.json", R"({"name": "s", "robots": [{"id": ")" + id + R"(", "position": [0, 0], "goal": [3, 0]}]})");
    return here.run("explain s.json --time 1 --robot 0 --out x.svg").err;
  };
  const std::string private_use = "\xf4\x8f\xbf\xbd";
  EXPECT_THAT(drawn("R" + private_use), HasSubstr("no font on this machine has " + private_use + ": PNG and PDF"));
  // Pango draws the number of such a character in a box as large as the picture; a square is as small as a letter.
  const std::string picture = here.read("x.png"), svg = here.read("x.svg");
  EXPECT_THAT(svg, HasSubstr(private_use));
  drawn("R\xe2\x96\xa1");
  EXPECT_EQ(here.read("x.png"), picture);
  EXPECT_THAT(drawn("R\xc3\xa4\xe2\x80\xa6\xe2\x80\x8d"), Not(HasSubstr("no font"))) << "usual, or not to be seen";
}

TEST(FigureFiles, APdfIsTheSameAtAnyTime) {
  const Workplace here;
  ASSERT_EQ(here.run(std::string(kVo) + "a.pdf", "TZ=Asia/Kolkata").status, 0);
  ASSERT_EQ(here.run(std::string(kVo) + "a/a.pdf").status, 0);
  EXPECT_TRUE(here.read("a.pdf") == here.read("a/a.pdf"));
  EXPECT_THAT(here.read("a.pdf"), HasSubstr("/CreationDate (D:19700101000000Z"));
}

/// A program `gnuplot` that stands before the real one.
void write_gnuplot(const Workplace& here, const std::string& body) {
  here.write("fake/gnuplot", "#!/bin/sh\nPATH=${PATH#*:}\n" + body + "\n");
  fs::permissions(here.path() / "fake/gnuplot", fs::perms::owner_all);
}

const std::string kFakeFirst = "PATH=\"$PWD/fake:$PATH\"";

TEST(FigureFiles, WithoutTheTerminalPdfcairoTheRestIsDrawnAndThatIsReported) {
  const Workplace here;
  fs::create_directories(here.path() / "fake");
  write_gnuplot(here, "sed 's/GPVAL_TERMINALS/\" png pngcairo svg x11 \"/g' | gnuplot \"$@\"");
  here.write("a.gp", "of an earlier figure");
  here.write("a.pdf", "of an earlier figure");
  const Outcome outcome = here.run(std::string(kVo) + "a.svg", kFakeFirst);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("cannot draw PDF (its terminal pdfcairo)"), HasSubstr("gnuplot-nox")));
  EXPECT_TRUE(here.has("a.svg") && here.has("a.png"));
  EXPECT_FALSE(here.has("a.pdf")) << "one of an earlier figure would show something else";
}

TEST(FigureFiles, WithoutAnyTerminalThereIsTheScript) {
  const Workplace here;
  fs::create_directories(here.path() / "fake");
  write_gnuplot(here, "sed 's/GPVAL_TERMINALS/\" dumb \"/g' | gnuplot \"$@\"");
  const Outcome outcome = here.run(std::string(kVo) + "a.svg", kFakeFirst);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("SVG"), HasSubstr("PNG"), HasSubstr("PDF"), HasSubstr("wrote a.gp")));
  EXPECT_THAT(outcome.err, Not(HasSubstr("wrote a.svg")));
  EXPECT_TRUE(here.has("a.gp") && here.has("a.dat"));
}

TEST(FigureFiles, WithoutGnuplotNoPictureIsReportedAsWritten) {
  const Workplace here;
  const Outcome outcome = here.run(std::string(kVo) + "a.svg", "PATH=/nowhere");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("gnuplot is not installed"), HasSubstr("wrote a.gp")));
  EXPECT_THAT(outcome.err, Not(HasSubstr("wrote a.svg")));
}

TEST(FigureFiles, APictureThatIsOfNoFigureStaysWhereNothingIsDrawn) {
  const Workplace here;
  for (const char* name : {"a.png", "a.svg", "a.pdf"}) here.write(name, "a map");
  EXPECT_EQ(here.run(std::string(kVo) + "a.svg", "PATH=/nowhere").status, 0);
  for (const char* name : {"a.png", "a.svg", "a.pdf"}) EXPECT_TRUE(here.has(name)) << name;
  EXPECT_TRUE(here.has("a.gp"));
}

/// Every verb that draws a figure, each with a file that it reads or writes besides and that the figure would replace.
struct Replacing {
  std::string command;
  std::string replaced;
};

constexpr const char* kScenario =
    R"({"name": "s", "robots": [{"id": "R1", "position": [0, 0], "goal": [8, 0]}], "obstacles": [{"file": "room.yaml"}]})";

const Replacing kReplacing[] = {
    {"segment room.yaml --figure room.svg", "room.png"},
    {"segment room.yaml --figure ./sub/../room.pdf", "room.png"},
    {"segment --format ros-map room.map --figure room.svg", "room.png"},
    {"segment map.pdf --format wkt --figure map.svg", "map.pdf"},
    {"segment a.wkt map.pdf --figure map.png", "map.pdf"},
    {"segment roads.tab --figure roads.svg", "roads.dat"},
    {"repair room.yaml --out r.wkt --figure room.svg", "room.png"},
    {"repair map.pdf --format wkt --out r.wkt --figure map.svg", "map.pdf"},
    {"repair a.wkt --out r.dat --to wkt --figure r.svg", "r.dat"},
    {"generate star --count 1 --out r.dat --to wkt --figure r.svg", "r.dat"},
    {"explain room.svg --time 1 --robot 0 --out room.svg", "room.svg"},
    {"explain s.json --time 1 --robot 0 --out room.svg", "room.png"},
    {"vo --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 2 --obstacle room.yaml --figure room.svg",
     "room.png"},
    {"vo --position 0,0 --velocity 1,0 --time-horizon 2 --obstacle a.wkt --format wkt --robot map.pdf --figure map.svg",
     "map.pdf"},
};

TEST(FigureFiles, AFigureNeverReplacesWhatItsCommandReadsOrWritesBesides) {
  const Workplace here;
  fs::create_directories(here.path() / "sub");
  for (const char* name : {"a.wkt", "map.pdf"}) here.write(name, "POLYGON((2 0, 4 0, 4 2, 2 2, 2 0))");
  for (const char* name : {"room.yaml", "room.map"})
    here.write(name,
               "image: room.png\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.6\n"
               "free_thresh: 0.2\n");
  for (const char* name : {"room.png", "roads.tab", "roads.dat"}) here.write(name, "kept as it is");
  for (const char* name : {"s.json", "room.svg"}) here.write(name, kScenario);
  const auto files = [&here] {
    auto all = here.files(".");
    for (const char* printed : {".stdout", ".stderr"}) all.erase(printed);
    return all;
  };
  const auto before = files();
  for (const Replacing& r : kReplacing) {
    const Outcome outcome = here.run(r.command);
    EXPECT_EQ(outcome.status, 2) << r.command;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("would replace "), HasSubstr(r.replaced))) << r.command;
    EXPECT_TRUE(files() == before) << r.command << ": refused before the work";
  }
}

TEST(FigureFiles, AnObstacleFileNeverReplacesThePictureOfItsMap) {
  const Workplace here;
  here.write("room.yaml", "image: room.png\nresolution: 0.1\norigin: [0, 0, 0]\n");
  here.write("room.png", "kept as it is");
  for (const char* command : {"convert room.yaml room.png --to wkt", "repair room.yaml --out room.png --to wkt"}) {
    const Outcome outcome = here.run(command);
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_THAT(outcome.err, HasSubstr("another file than the input")) << command;
    EXPECT_EQ(here.read("room.png"), "kept as it is") << command;
  }
}

TEST(FigureFiles, AFigureMayStandBesideItsInput) {
  const Workplace here;
  here.write("a.wkt", "POLYGON((2 0, 4 0, 4 2, 2 2, 2 0))");
  EXPECT_EQ(here.run("segment a.wkt --figure a.svg").status, 0);
  EXPECT_EQ(here.run("segment a.wkt --figure a.svg").status, 0) << "and be drawn again";
  EXPECT_EQ(here.read("a.wkt"), "POLYGON((2 0, 4 0, 4 2, 2 2, 2 0))");
}

TEST(FigureFiles, AGnuplotThatFailsLeavesNothing) {
  const Workplace here;
  fs::create_directories(here.path() / "fake");
  write_gnuplot(here, "(cat; echo 'exit status 3') | gnuplot \"$@\"");
  const Outcome outcome = here.run(std::string(kVo) + "out/a.svg", kFakeFirst);
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("gnuplot failed"));
  EXPECT_TRUE(here.files("out").empty());
}

}  // namespace
}  // namespace exactvo::test
