// SPDX-License-Identifier: GPL-3.0-or-later
// Mistyped commands: what is wrong, in the program's own words, and where to look it up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "run_program.h"

namespace exactvo::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kScenario = R"({"name": "one", "robots": [{"id": "R1", "position": [0, 0], "goal": [8, 0]}]})";
constexpr const char* kSquare = "POLYGON((4 0, 5 0, 5 1, 4 0))\n";

Workplace& place() {
  static Workplace here;
  here.write("s.json", kScenario);
  here.write("p.wkt", kSquare);
  here.write("t.csv", "t,id,x,y\n0,A,0,0\n1,A,1,0\n");
  return here;
}

struct Mistake {
  const char* command;
  const char* message;
};

/// The command, as words of a test's name.
std::string name_of(const testing::TestParamInfo<Mistake>& mistake) {
  return std::to_string(mistake.index) + "_" +
         std::regex_replace(mistake.param.command, std::regex("[^A-Za-z0-9]+"), "_");
}

class Mistyped : public testing::TestWithParam<Mistake> {};

TEST_P(Mistyped, IsAnsweredInPlainWords) {
  const Outcome outcome = place().run(GetParam().command);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().message));
  // Those of the option library.
  for (const char* foreign : {"Could not convert", "not expected", "is required", "TEXT", "UINT", "FLOAT",
                              "INT:", "not in range", "subcommand", "means nothing", "internal"})
    EXPECT_THAT(outcome.err, Not(HasSubstr(foreign)));
}

INSTANTIATE_TEST_SUITE_P(
    Runs, Mistyped,
    testing::Values(
        Mistake{"simulate", "missing argument scenario: JSON file, or - for stdin (see 'exactvo simulate --help')"},
        Mistake{"simulate s.json --metod ivo", "unknown option '--metod'; did you mean '--method'?"},
        Mistake{"simulate s.json --method", "--method: no value given"},
        Mistake{"simulate s.json --time-step 0.1",
                "unknown option '--time-step'; a scenario has the key \"time_step\" for it"},
        Mistake{"simulate s.json o",
                "unexpected argument 'o': the scenario is 's.json'; a place for results goes behind --out"},
        Mistake{"simulate s.json -m", "--method: no value given"}, Mistake{"simulate s.json -z", "unknown option '-z'"},
        Mistake{"simulate s.json t.json", "unexpected argument 't.json'"},
        Mistake{"simulate s.json --no-figures 0", "unexpected argument '0': --no-figures takes no value"},
        Mistake{"simulate s.json --json=maybe", "--json: found 'maybe', expected no value"},
        Mistake{"simulate s.json --decisions", "--decisions"},
        Mistake{"simulate s.json --seed abc", "--seed: found 'abc', expected a whole number from 0"},
        Mistake{"simulate s.json --seed=-1", "--seed: found '-1', expected a whole number from 0"},
        Mistake{"explain s.json", "missing option --time: "},
        Mistake{"explain s.json --time abc --robot R1", "--time: found 'abc', expected a number"},
        Mistake{"explain s.json --time 3s --robot R1", "--time: found '3s', expected a number"},
        Mistake{"trap s.json s.json", "unexpected argument 's.json'"},
        Mistake{"paper --out o --random", "--random: no value given"},
        Mistake{"paper --out o --random abc", "--random: found 'abc', expected a whole number from 1 to 1000000"},
        Mistake{"paper --out o --random 0", "--random: found '0', expected a whole number from 1 to 1000000"},
        Mistake{"paper --out o --ablations --jobs 2000",
                "--jobs: found '2000', expected a whole number from 1 to 1024"},
        Mistake{"simulate s.json -m orca -m ivo", "--method: given 2 times, expected once"},
        Mistake{"trap s.json --json=2", "--json: found '2', expected no value, since it is a switch"},
        Mistake{"trap s.json --json=true", "--json: found 'true', expected no value"},
        Mistake{"simulate s.json --no-figures=1", "--no-figures: found '1', expected no value"},
        Mistake{"--quiet=no simulate s.json", "--quiet: found 'no', expected no value"},
        Mistake{"simulate -h=3", "found '3', expected no value"},
        Mistake{"simulate ''", "scenario: found '', expected a value: JSON file"},
        Mistake{"paper", "missing option --out: "},
        Mistake{"audit", "audit needs a recording (or a folder of them), or --certificate FILE"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Obstacles, Mistyped,
    testing::Values(
        Mistake{"validate", "missing argument files: Obstacle files"},
        Mistake{"validate p.wkt --fromat wkt", "unknown option '--fromat'; did you mean '--format'?"},
        Mistake{"validate p.wkt --strict yes.wkt --format", "--format: no value given"},
        Mistake{"validate p.wkt --cell-size wide", "--cell-size: found 'wide', expected a number"},
        Mistake{"repair p.wkt", "missing option --out: "}, Mistake{"repair p.wkt --out", "--out: no value given"},
        Mistake{"convert p.wkt", "missing argument out: "},
        Mistake{"convert p.wkt o.wkt extra", "unexpected argument 'extra'"},
        Mistake{"convert p.wkt o.wkt --skip 1", "unexpected argument '1': --skip takes no value"},
        Mistake{"generate", "missing argument kind: One of polygon "},
        Mistake{"generate star", "missing option --out: The file to write"},
        Mistake{"generate star --seed abc --out a.wkt", "--seed: found 'abc', expected a whole number"},
        Mistake{"generate star --count 3.5 --out a.wkt", "--count: found '3.5', expected a whole number"},
        Mistake{"generate star --count many --out a.wkt", "--count: found 'many', expected a whole number"},
        Mistake{"validate ''", "files: found '', expected a value: Obstacle files"},
        Mistake{"validate p.wkt --strict=yes", "--strict: found 'yes', expected no value"},
        Mistake{"segment", "missing argument files"},
        Mistake{"segment p.wkt --radius x", "--radius: found 'x', expected a number"},
        Mistake{"segment p.wkt --tolrance 1", "did you mean '--tolerance'?"},
        Mistake{"batch", "missing argument paths"}, Mistake{"batch p.wkt", "missing option --out"},
        Mistake{"batch p.wkt --out o --jobs 0", "--jobs: found '0', expected a whole number from 1 to 4096"},
        Mistake{"batch p.wkt --out o --jobs x", "--jobs: found 'x', expected a whole number from 1 to 4096"},
        Mistake{"batch p.wkt --out o --limit-memory much", "--limit-memory: found 'much', expected "},
        Mistake{"batch p.wkt --out o --limit-memory 2XB", "--limit-memory: found '2XB', expected a number of bytes"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Velocities, Mistyped,
    testing::Values(
        Mistake{"vo", "missing option --obstacle: "}, Mistake{"vo --obstacle", "--obstacle: no value given"},
        Mistake{"vo --obstacle 'DISC(4 0, 1)'", "missing option --position: "},
        Mistake{"vo --obstacle 'DISC(4 0, 1)' --radius x", "--radius: found 'x', expected a number"},
        Mistake{"vo --obstacle 'DISC(4 0, 1)' --responsibility half",
                "--responsibility: found 'half', expected a number"},
        Mistake{"vo --obstacle 'DISC(4 0, 1)' --raduis 1", "did you mean '--radius'?"},
        Mistake{"vo --obstacle 'DISC(4 0, 1)' --position 0 0 --velocity 1,0 --time-horizon 3 --radius 1",
                "--position 0 0: found two words, expected X,Y in one: --position=0,0"},
        Mistake{"vo --obstacle 'DISC(4 0, 1)' --position 0,0 --velocity -1 -2 --time-horizon 3 --radius 1",
                "--velocity -1 -2: found two words, expected X,Y in one: --velocity=-1,-2"},
        Mistake{"lp", "missing argument file: "}, Mistake{"lp s.json t.json", "unexpected argument 't.json'"},
        Mistake{"lp s.json --certfy", "did you mean '--certify'?"},
        Mistake{"audit o --certificate", "--certificate: no value given"},
        Mistake{"audit o p", "unexpected argument 'p'"}, Mistake{"--verison", "did you mean '--version'?"},
        Mistake{"-x", "unknown option '-x'"}, Mistake{"--quiet", "no verb was given"},
        Mistake{"help simulte", "help: found 'simulte'"},
        Mistake{"s.json", "; did you mean 'exactvo simulate s.json'?"},
        Mistake{"p.wkt", "; did you mean 'exactvo validate p.wkt'?"},
        Mistake{"t.csv", "; did you mean 'exactvo check t.csv'?"}, Mistake{"run s.json", "; did you mean 'simulate'?"},
        Mistake{"sim s.json", "did you mean 'simulate'?"}, Mistake{"verify out", "; did you mean 'audit'?"},
        Mistake{"plot out", "; did you mean 'draw' or 'view'?"},
        Mistake{"help plot", "; did you mean 'draw' or 'view'?"}),
    name_of);

TEST(Help, OfAVerbComesEitherWay) {
  const Outcome help = place().run("help simulate"), option = place().run("simulate --help");
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.out, option.out);
  EXPECT_EQ(place().run("help").out, place().run("--help").out);
  EXPECT_EQ(place().run("-V").out, place().run("--version").out);
}

TEST(Messages, AScenarioErrorDoesNotQuoteTheSchema) {
  place().write("bad.json", R"({"name": "a", "robots": [], "time_step": 0.1})");
  EXPECT_THAT(place().run("simulate bad.json").err,
              AllOf(HasSubstr("/robots: found a list of 0, expected at least 1 entry [E_COUNT]")));
  place().write("bad.json",
                R"({"name": "a", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}], "time_step": -1})");
  EXPECT_THAT(place().run("simulate bad.json").err, HasSubstr("found -1, expected a number > 0 (s) [E_RANGE]"));
  place().write("bad.json", R"({"name": "a", "robots": [{"id": "R", "position": [0], "goal": [9, 0]}]})");
  EXPECT_THAT(place().run("simulate bad.json").err, HasSubstr("expected at least 2 entries ([x, y], m) [E_COUNT]"));
  place().write("bad.json", R"({"name": "a", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}],
                               "obstacles": [{"id": "U", "circle": [1, 2]}]})");
  EXPECT_THAT(
      place().run("simulate bad.json").err,
      HasSubstr(
          R"(found only the keys "id", "circle", expected "polyline", or "polygon", or "disc", or "file" [E_NO_ALTERNATIVE])"));
}

TEST(Messages, AMistypedGeneratorIsAnsweredWithThoseThereAre) {
  const std::string all = R"("id" with "position", or "circle", or "grid", or "random", or "file")";
  const std::pair<const char*, std::string> cases[] = {
      {"4", "/robots: found 4, expected a list [{...}] of objects with " + all + " [E_TYPE]"},
      {R"({"count": 4, "radius": 9})", R"(/robots: found only the keys "count", "radius", expected )" + all},
      {R"({"circle": {"count": 4, "radus": 9}})",
       R"(/robots/circle/radus: found an unknown key "radus", expected a known key; did you mean "radius"?)"},
      {R"({"random": {"count": 4, "low": [0, 0]}})",
       "/robots/random: found low without high, expected both corners of the box, or neither"},
      {R"([{"circl": {"count": 4, "radius": 9}}])",
       R"(/robots/0/circl: found an unknown key "circl", expected a known key; did you mean "circle"?)"},
      {R"([{"Grid": {"columns": 2}, "radius": 1}])",
       R"(/robots/0/Grid: found an unknown key "Grid", expected a known key; did you mean "grid"?)"},
      {R"([{"randm": {"count": 4}}])",
       R"(/robots/0/randm: found an unknown key "randm", expected a known key; did you mean "random"?)"},
      {R"([{"type": "ring", "count": 4}])", R"(/robots/0: found only the keys "type", "count", expected )" + all},
      {R"([{"count": 4, "radius": 9}])", R"(/robots/0: found only the keys "count", "radius", expected )" + all},
      {"[{}]", "/robots/0: found an empty object, expected " + all},
      {R"([{"a": 1, "b": 1, "c": 1, "d": 1, "e": 1}])",
       R"(/robots/0: found only the keys "a", "b", "c", "d", ..., expected )" + all},
      {R"([{"circle": {"count": 4, "radius": 3}, "grid": {}}])",
       R"(/robots/0: found keys of several kinds: "circle", "grid", expected )" + all},
      {R"([{"circle": {"count": 4, "radus": 9}}])",
       R"(/robots/0/circle/radus: found an unknown key "radus", expected a known key; did you mean "radius"?)"},
      {R"([{"circle": 4}])", "/robots/0/circle: found 4, expected an object"}};
  for (const auto& [robots, message] : cases) {
    place().write("bad.json", std::string(R"({"name": "a", "robots": )") + robots + "}");
    EXPECT_THAT(place().run("simulate bad.json").err, HasSubstr(message)) << robots;
  }
}

TEST(Messages, PlansThatAreNotMadeAreNoted) {
  place().write("two.json", R"({"name": "two", "time_limit": 0.1, "robots": [
    {"id": "a", "position": [0, 0], "goal": [8, 0]}, {"id": "b", "position": [8, 3], "goal": [0, 3]}],
    "obstacles": [{"id": "o", "polygon": [[4, 9], [5, 9], [5, 10]]}]})");
  const auto noted = [](const std::string& options) { return place().run("simulate two.json " + options).err; };
  const char* words = "note: liveness is bias, not plan: among obstacles joint plans need guidance";
  EXPECT_THAT(noted("--guidance none"), HasSubstr(words));
  EXPECT_THAT(noted("--method ivo-edge --liveness plan"), HasSubstr(words));
  for (const char* options :
       {"", "--method ivo-edge", "--guidance none --liveness off", "--guidance none --liveness bias"})
    EXPECT_THAT(noted(options), Not(HasSubstr("note: "))) << options;
}

TEST(Messages, JsonThatIsMalformedIsAnsweredByLineAndColumnInPlainWords) {
  struct Case {
    const char* text;
    const char* message;
  };
  const Case cases[] = {
      {"{\"a\": 1,}", "line 1, column 9: found \"}\", expected a key in double quotes"},
      {"{a: 1}", "line 1, column 2: found \"a: 1}\", expected a key in double quotes"},
      {"{\n  \"a\" 1}", "line 2, column 7: found \"1}\", expected a colon after the key"},
      {"{\"a\": 1 \"b\": 2}", "expected a comma or \"}\""},
      {"{\"a\": [1 2]}", "line 1, column 10: found \"2]}\", expected a comma or \"]\""},
      {"{\"a\": [1,]}", "expected a JSON value: an object, a list, a number, text in double quotes"},
      {"{\"a\": tru}", "expected a JSON value"},
      {"{\"a\": 'x'}", "expected a JSON value"},
      {"{\"a\": 1.}", "expected a number as JSON writes it"},
      {"{\"a\": \"x}", "expected a closing double quote"},
      {"{\"a\": \"\\x\"}", "after a backslash"},
      {"{\"a\": \"x\ny\"}", "expected text without line breaks"},
      {"{\"a\": 1", "found the end of the file, expected a comma or \"}\""},
      {"{\"a\": 1} 2", "expected the end of the file after one JSON value"},
      {"{\"a\": 1e999}", "found the number 1e999, expected a number that a finite double can hold"},
  };
  for (const Case& c : cases) {
    place().write("bad.json", c.text);
    const Outcome outcome = place().run("simulate bad.json");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(c.message)) << c.text;
    for (const char* foreign : {"unexpected", "literal", "last read", "parsing"})
      EXPECT_THAT(outcome.err, Not(HasSubstr(foreign))) << c.text;
  }
}

TEST(Messages, MalformedGeoJsonIsNotAnsweredInTheWordsOfALibrary) {
  place().write("bad.geojson", R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0] [1, 1]]]}}]})");
  const Outcome outcome = place().run("validate bad.geojson");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, HasSubstr("bad.geojson: line 2, column 87: found \"[1, 1]]]}}]}\", expected a comma"));
}

/// In a sequence the record is rejected, not the file.
int status_of_refused(const std::string& file) {
  return file.find(".geojsonl") != std::string::npos ? 1 : 2;
}

TEST(Messages, TextThatItsParserHasNoMemoryForIsRefused) {
  // A point of two digits takes 300 bytes in GDAL's parser, fifty times its text.
  std::string points = "[1,1]";
  while (points.size() < 20'000'000) points += "," + points;
  const std::string polygon = R"({"type": "Polygon", "coordinates": [[)" + points + "]]}";
  place().write("many.geojsonl", polygon + "\n");
  place().write("many.geojson",
                R"({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": )" + polygon + "}]}");
  place().write(
      "many.topojson",
      R"({"type": "Topology", "objects": {"o": {"type": "Polygon", "arcs": [[0]]}}, "arcs": [[)" + points + "]]}");
  std::string words = "1,1";
  while (words.size() < 8'000'000) words += " " + words;
  place().write("many.kml",
                R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><Polygon>)"
                "<outerBoundaryIs><LinearRing><coordinates>" +
                    words + "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>");
  for (const char* file : {"many.geojsonl", "many.geojson", "many.topojson", "many.kml"}) {
    const Outcome outcome = place().run(std::string("validate ") + file);
    EXPECT_EQ(outcome.status, status_of_refused(file)) << file;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("[E_SIZE]"), Not(HasSubstr("OGR_")))) << file;
    std::filesystem::remove(place().path() / file);
  }
}

/// `payload` repeated, with commas between.
std::string repeated(const std::string& payload, std::size_t count) {
  std::string text = payload;
  for (std::size_t k = 1; k < count; ++k) text += "," + payload;
  return text;
}

std::string feature_with(const std::string& members) {
  return R"({"type": "Feature", "properties": {)" + members +
         R"(}, "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}})";
}

/// Before the command: as much memory as a reader may take, as addresses. `kMapped`: what is mapped but not touched,
/// with room for other libraries than those of Debian 12, with which an empty file needs 180 MB of addresses and
/// touches 57.
std::string within_rule(std::size_t bytes) {
#ifdef __SANITIZE_ADDRESS__  // it maps terabytes
  return "";
#else
  constexpr std::size_t kMapped = 200'000;
  return "ulimit -v " + std::to_string(20 * bytes / 1000 + 200'000 + kMapped) + "; ";
#endif
}

TEST(Messages, MemoryOfJsonIsEstimatedFromAllItsTokens) {
  const std::string points = repeated("[1,1]", 2'000'000);
  const std::string objects = repeated("{}", 2'600'000);
  const std::string collection = R"({"type": "FeatureCollection", "x": [)" + objects + R"(], "features": [)";
  const std::pair<const char*, std::string> files[] = {
      {"objects.topojson", R"({"type": "Topology", "x": [)" + repeated("{}", 400'000) +
                               R"(], "objects": {"o": {"type": "Polygon", "arcs": [[0]]}}, "arcs": [[[0,0],[1,1]]]})"},
      {"objects.geojsonl", feature_with("\"p\": [" + objects + "]") + "\n"},
      {"members.geojson", collection + feature_with("") + "]}"},
      {"geometry.geojson", R"({"type": "Polygon", "coordinates": [[)" + points + "]]}"},
      {"feature.geojson", feature_with("\"features\": 1, \"p\": [" + points + "]")}};
  for (const auto& [name, text] : files) {
    place().write(name, text);
    const Outcome outcome = place().run(std::string("validate ") + name, within_rule(text.size()));
    EXPECT_EQ(outcome.status, status_of_refused(name)) << name << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("[E_SIZE]")) << name;
    std::filesystem::remove(place().path() / name);
  }
}

/// `count` members of a JSON object.
std::string members(std::size_t count) {
  std::string text = "\"0\":0";
  for (std::size_t k = 1; k < count; ++k) text += ",\"" + std::to_string(k) + "\":0";
  return text;
}

/// Lists of strings or objects, and objects of many members, took minutes for a megabyte.
TEST(Messages, JsonBelowTheLimitOfMemoryIsRead) {
  const std::string many = repeated(feature_with("\"a\": 1"), 2'500) + "]}";
  const std::pair<const char*, std::string> files[] = {
      {"objects.geojsonl", feature_with("\"p\": [" + repeated("{}", 160'000) + "]") + "\n"},
      {"numbers.geojson", feature_with("\"p\": [" + repeated("1.1", 500'000) + "]")},
      {"numbers.geojsonl", feature_with("\"p\": [" + repeated("1.1", 4'000'000) + "]") + "\n"},
      {"points.geojsonl", feature_with("\"p\": [" + repeated("[1,1]", 1'000'000) + "]") + "\n"},
      {"lists.geojson", feature_with("\"p\": [" + repeated("[]", 1'300'000) + "]")},
      {"strings.geojson", feature_with("\"p\": [" + repeated("\"\"", 400'000) + "]")},
      {"members.geojson", feature_with(members(100'000))},
      {"members.geojsonl", feature_with(members(100'000)) + "\n"},
      {"described.geojson",
       R"({"description": ")" + std::string(5000, 'x') + R"(", "type": "FeatureCollection", "features": [)" + many},
      {"x.geojson",
       R"({"type": "FeatureCollection", "x": [)" + repeated("{}", 150'000) + R"(], "features": [)" + many}};
  for (const auto& [name, text] : files) {
    place().write(name, text);
    const Outcome outcome = place().run(std::string("validate ") + name, within_rule(text.size()) + "timeout 20 ");
    EXPECT_EQ(outcome.status, 0) << name << outcome.err << outcome.out.substr(0, 500);
    std::filesystem::remove(place().path() / name);
  }
}

/// GDAL looks for it in the first 6000 bytes.
TEST(Messages, GeoJsonWhoseTypeStandsFarBackIsRead) {
  place().write("late.geojson",
                R"({"description": ")" + std::string(7000, 'x') + R"(", "type": "FeatureCollection", "features": []})");
  const Outcome outcome = place().run("validate late.geojson");
  EXPECT_THAT(outcome.err, HasSubstr("late.geojson: gdal, 0 read"));
  place().write("other.json", R"({"type": "Parcel", "features": []})");
  EXPECT_THAT(
      place().run("validate other.json").out,
      HasSubstr("/type: found \"Parcel\", expected FeatureCollection, Feature or a geometry [E_FORMAT_SYNTAX]"));
}

TEST(Messages, PointsBelowAHeaderAreAListOfPoints) {
  place().write("header.csv", "# from a survey\nx,y\n1,2\n3,4\n");
  EXPECT_THAT(place().run("validate header.csv").err, HasSubstr("points-csv, 2 read: 2 valid"));
  place().write("three.csv", "x,y,z\n1,2,3\n");
  EXPECT_THAT(place().run("validate three.csv").out,
              AllOf(HasSubstr("found a table without a column of geometry"), HasSubstr("the format points-csv")));
  for (const char* command : {"route three.csv --from 0,0 --to 1,1 --radius 0.1", "convert three.csv o.wkt",
                              "check t.csv --radius 0.1 --map three.csv", "segment three.csv"})
    EXPECT_EQ(place().run(command).status, 2) << command << ": no way is clear of a map that was not read";
}

TEST(Messages, TheUnitInTheHeaderOfADrawingIsNamed) {
  const auto drawing = [](const std::string& header) {
    return "0\nSECTION\n2\nHEADER\n" + header + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nwalls\n" +
           "10\n0\n20\n0\n11\n4000\n21\n0\n0\nENDSEC\n0\nEOF\n";
  };
  place().write("mm.dxf", drawing("9\n$INSUNITS\n 70\n     4\n"));
  EXPECT_THAT(place().run("validate mm.dxf").err,
              HasSubstr("taken as metres: names no reference system; its header states millimetres ($INSUNITS)\n"));
  for (const char* header : {"9\n$INSUNITS\n70\n6\n", "9\n$INSUNITS\n70\n0\n", "9\n$INSUNITS\n"}) {
    place().write("m.dxf", drawing(header));
    EXPECT_THAT(place().run("validate m.dxf").err, Not(HasSubstr("its header"))) << header;
  }
}

TEST(Messages, AnImageIsReferredToItsMap) {
  place().write("room.pgm", "P2\n2 2\n255\n0 0 0 0\n");
  EXPECT_THAT(place().run("validate room.pgm").out, HasSubstr("of a ROS map give the .yaml that names its image"));
  place().write("mystery.xyz", "abc\n");
  EXPECT_THAT(place().run("validate mystery.xyz").out,
              HasSubstr("name it with --format (convert: --from; check, monitor: --map-format)"));
}

TEST(Messages, AGoalThatIsWalledInIsReportedBeforeTheRun) {
  place().write("room.json",
                R"({"name": "room", "robots": [{"id": "R1", "position": [8, 0], "goal": [0, 0]}], "time_limit": 1,
    "obstacles": [{"id": "room", "polyline": [[3, 0.4], [3, 3], [-3, 3], [-3, -3], [3, -3], [3, -0.4]]}]})");
  EXPECT_THAT(place().run("simulate room.json").err,
              HasSubstr("goal of R1, (0, 0), cannot be reached: obstacle 'room' encloses it, with a gap of 0.8 m for a "
                        "robot 1 m wide"));
}

TEST(Messages, TasksInPlaceOfObstaclesAreSentToRoute) {
  place().write("t.scen", "version 1\n0\tgrid.map\t4\t3\t0\t0\t3\t2\t5\n");
  for (const char* verb : {"validate t.scen", "convert t.scen t.geojson"}) {
    const Outcome outcome = place().run(verb);
    EXPECT_EQ(outcome.status, 2) << verb;
    EXPECT_THAT(outcome.out + outcome.err, HasSubstr("tasks of Moving AI are for exactvo route MAP --queries")) << verb;
  }
}

TEST(Messages, ObstaclesInPlaceOfAScenarioAreCalledThatWithTheWayToUseThem) {
  place().write("o.geojson", R"({"type": "FeatureCollection", "features": []})");
  place().write("o.json", R"({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]})");
  place().write("rings.json", "[[[0, 0], [1, 0], [1, 1]]]");
  const std::pair<const char*, const char*> files[] = {{"o.geojson", "GeoJSON (FeatureCollection)"},
                                                       {"o.json", "GeoJSON (Polygon)"},
                                                       {"rings.json", "format rings-json"},
                                                       {"p.wkt", "format wkt"}};
  for (const auto& [file, format] : files) {
    for (const char* verb : {"simulate ", "trap ", "explain --time 0 --robot R1 "}) {
      const Outcome outcome = place().run(verb + std::string(file));
      EXPECT_EQ(outcome.status, 2) << verb << file;
      EXPECT_THAT(outcome.err, HasSubstr(std::string(file) + ": found a file of obstacles, " + format +
                                         ", expected a scenario in JSON, which has robots and names such a file: "
                                         "\"obstacles\": [{\"file\": \"" +
                                         file + "\"}] [E_FORMAT_UNKNOWN]"))
          << verb << file;
    }
  }
  EXPECT_THAT(place().run("simulate -", "cat o.geojson | ").err, HasSubstr("-: found a file of obstacles, GeoJSON"));
}

TEST(Messages, AStartOnAWallOverlapsItByALength) {
  place().write("start.json", R"({"name": "s", "robots": [{"id": "R1", "position": [5.8, 0], "goal": [12, 0]}],
      "obstacles": [{"id": "wall", "polyline": [[6, -2], [6, 2]]}]})");
  EXPECT_THAT(place().run("simulate start.json").err,
              HasSubstr("/robots/0/position: found [5.8, 0], overlapping obstacle 'wall' by 0.3 m, expected"));
}

TEST(Messages, AVelocityOfAnObstacleIsReferredToMovingObstacles) {
  for (const char* key : {"velocity", "speed", "path"}) {
    place().write("moves.json", R"({"name": "m", "robots": [{"id": "R1", "position": [0, 0], "goal": [9, 0]}],
        "obstacles": [{"id": "still", "polygon": [[3, 3], [4, 3], [4, 4]]},
                      {"id": "cart", "polygon": [[5, 8], [7, 8], [7, 9]], ")" +
                                    std::string(key) + R"(": [1, 0]}]})");
    const Outcome outcome = place().run("simulate moves.json");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err,
                HasSubstr("/obstacles/1/" + std::string(key) + ": found an unknown key \"" + key +
                          "\", expected an obstacle that stands; one that moves goes into the list "
                          "\"moving_obstacles\", with a \"path\" and a \"speed\", or a \"velocity\" [E_KEY_UNKNOWN]"));
  }
}

TEST(Messages, AFileOfARunIsReferredToTheFolderOfTheRun) {
  ASSERT_EQ(place().run("simulate s.json --out run", "PATH=/nowhere").status, 0);
  for (const char* file :
       {"trajectory.csv", "metrics.json", "explorer.html", "figures", "figures/", "figures/paths.gp"}) {
    ASSERT_TRUE(place().has(std::string("run/") + file)) << file;
    for (const char* verb :
         {"serve run/", "view --out p.html run/", "draw run/", "audit run/", "explain --time 0 --robot R1 run/"}) {
      const Outcome outcome = place().run(verb + std::string(file));
      EXPECT_EQ(outcome.status, 2) << verb << file;
      EXPECT_THAT(outcome.err, HasSubstr("expected the folder of the run: run [E_FORMAT_UNKNOWN]")) << verb << file;
    }
  }
  place().write("run/mine.json", kScenario);  // a scenario may stand beside its run
  EXPECT_EQ(place().run("explain --time 0 --robot R1 run/mine.json").status, 0);
}

TEST(Messages, ARunWhereAScenarioIsExpectedIsCalledThat) {
  ASSERT_EQ(place().run("simulate s.json --no-figures --out run2").status, 0);
  place().write("moved.jsonl", place().read("run2/recording.jsonl"));
  for (const char* run : {"run2", "run2/recording.jsonl", "run2/metrics.json", "moved.jsonl"})
    for (const char* verb : {"simulate ", "trap "}) {
      const Outcome outcome = place().run(verb + std::string(run));
      EXPECT_EQ(outcome.status, 2) << verb << run;
      EXPECT_THAT(outcome.err, HasSubstr("expected a scenario in JSON; draw, explain, view, serve and audit take runs"))
          << verb << run;
    }
}

TEST(Messages, AScenarioWhereARunIsExpectedIsCalledThat) {
  for (const char* verb : {"draw", "audit"}) {
    const Outcome outcome = place().run(verb + std::string(" s.json"));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("s.json: found a scenario, which is no run yet, expected a recording.jsonl, as "
                                       "simulate --out writes it [E_FORMAT_UNKNOWN]"));
  }
}

TEST(Messages, WhereStandardInputIsNotReadTheMessageSaysWhatIs) {
  for (const char* command : {"validate -", "convert - out.wkt", "repair - --out out.wkt", "segment -",
                              "audit --scenario - .", "route - --from 0,0 --to 1,1 --radius 1"})
    EXPECT_THAT(place().run(command).err + place().run(command).out, HasSubstr("standard input is read as /dev/stdin"))
        << command;
  EXPECT_THAT(place().run("batch - --out out").err, HasSubstr("a batch does not read standard input"));
  EXPECT_EQ(place().run("validate --format wkt /dev/stdin", "echo 'POLYGON((0 0, 1 0, 1 1, 0 0))' | ").status, 0);
}

// It was taken for the name of a file.
TEST(Messages, AnEmptyObstacleOnTheCommandLineIsNamedForWhatItIs) {
  for (const char* empty : {"POLYGON EMPTY", "LINESTRING EMPTY", "multipolygon empty", "POINT EMPTY"})
    EXPECT_THAT(place()
                    .run("vo --obstacle '" + std::string(empty) +
                         "' --position 0,0 --radius 0.5 --time-horizon 2 --velocity 1,0")
                    .err,
                HasSubstr("found '" + std::string(empty) + "', expected a polygon or a line"));
}

TEST(Messages, AGuessedFormatIsNamedWhereReadingFails) {
  place().write("g.txt", "POLYGON((0 0, 1 0, 1 x))\n");
  EXPECT_THAT(place().run("validate g.txt").out, Not(HasSubstr("guessed"))) << "one obstacle of a file that was read";
  place().write("g.map", "type octile\nheight 2\nwidth x\nmap\n..\n");
  const std::string guess = "; read as movingai-map, which is guessed from its content and name: ";
  EXPECT_THAT(place().run("validate g.map").out, HasSubstr(guess + "--format names another format"));
  EXPECT_THAT(place().run("segment g.map").err, HasSubstr(guess + "--format names another format"));
  EXPECT_THAT(place().run("repair g.map --out o.wkt").err, HasSubstr(guess + "--format names another format"));
  const Outcome converted = place().run("convert g.map o.wkt");
  EXPECT_EQ(converted.status, 2);
  EXPECT_THAT(converted.err, HasSubstr(guess + "--from names another format"));
  EXPECT_THAT(place().run("validate g.map --format movingai-map").out, Not(HasSubstr("guessed")));
  EXPECT_THAT(place().run("validate missing.map").out, Not(HasSubstr("guessed")));
  place().write("empty.geojson", "");
  EXPECT_THAT(place().run("convert empty.geojson o.wkt").err,
              AllOf(HasSubstr("found an empty file"), Not(HasSubstr("guessed"))));
}

TEST(Messages, InputForAnotherVerbOrKeyIsRefusedWithItsName) {
  EXPECT_THAT(place().run("simulate t.csv").err,
              HasSubstr("found a file of trajectories, format csv, expected a scenario in JSON; check takes"));
  place().write("mystery.xyz", "abc\n");
  place().write("with.json", R"({"name": "w", "robots": [{"id": "R", "position": [0, 0], "goal": [1, 0]}],
    "obstacles": [{"file": "mystery.xyz"}]})");
  EXPECT_THAT(place().run("simulate with.json").err,
              AllOf(HasSubstr("/obstacles/0/file: "), HasSubstr("name it with the key \"format\": wkt")));
  place().write("d.svg", "<svg/>");
  EXPECT_THAT(place().run("validate d.svg").out, HasSubstr("of a drawing, its shapes in metres as WKT"));
  place().write("p.png", "\x89PNG");
  EXPECT_THAT(place().run("validate p.png").out, HasSubstr("for another picture write one: image, resolution"));
  place().write("comma.csv", "t;id;x;y\n0,5;A;1;2\n");
  EXPECT_THAT(place().run("check comma.csv --radius 1").err,
              HasSubstr("found \"0,5\", expected a number as a time, with a decimal point"));
  ASSERT_EQ(place().run("simulate s.json --no-figures --out ran").status, 0);
  EXPECT_THAT(place().run("check ran/metrics.json --radius 1").err, HasSubstr("found the metrics of a run"));
  EXPECT_THAT(place().run("monitor --radius 1", "echo '{\"speed\": 1}' | ").out,
              HasSubstr("known are id, pose, velocity"));
}

TEST(Messages, AFormatThatIsCertainIsNoGuess) {
  place().write("bad.json", R"({"name": "a", "robots": []})");
  place().write("cut.geojson", R"({"type": "FeatureCollection", "features": [)");
  place().write("cut.xml", "<Experiment><ObstacleSet>");
  for (const char* file : {"bad.json", "cut.geojson", "cut.xml"})
    EXPECT_THAT(place().run(std::string("validate ") + file).out, AllOf(HasSubstr("[E_"), Not(HasSubstr("guessed"))))
        << file;
  place().write("cut.json", R"({"type": "FeatureCollection", "features": [)");
  EXPECT_THAT(place().run("validate cut.json").out, HasSubstr("read as gdal, which is guessed"));
}

TEST(Messages, ARecordingInThePlaceOfAVerbIsSentToItsVerbs) {
  const std::string words = "; did you mean 'exactvo audit {0}' or 'exactvo draw {0}' or 'exactvo view {0}'?";
  ASSERT_EQ(place().run("simulate s.json --no-figures --out done").status, 0);
  for (const std::string recording : {"done", "done/recording.jsonl"}) {
    const Outcome outcome = place().run(recording);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(std::regex_replace(words, std::regex("\\{0\\}"), recording)));
  }
}

TEST(Messages, PointsMayHaveAnyUsualSeparator) {
  for (const char* between : {",", ", ", ";", "\t", " ", "   "}) {
    place().write("points.csv", std::string("x") + between + "y\n1" + between + "2\n3" + between + "4\n");
    EXPECT_THAT(place().run("validate points.csv").err, HasSubstr("points-csv, 2 read: 2 valid")) << between;
  }
  place().write("points.csv", "1,2\n3\n");
  EXPECT_THAT(place().run("validate points.csv").out,
              HasSubstr("line 2: found 1 number in a line, expected two, x and y, with a comma, a semicolon, a tab or "
                        "blanks between them [E_COUNT]"));
}

TEST(Messages, AnEmptyRecordingIsCalledEmpty) {
  place().write("empty.jsonl", "");
  EXPECT_THAT(place().run("audit empty.jsonl").err,
              HasSubstr("empty.jsonl: found an empty file, expected a recording.jsonl, as simulate --out writes it"));
}

TEST(Messages, WhatIsNoRecordingIsNamed) {
  const auto said = [](const std::string& name, const std::string& content) {
    place().write(name, content);
    const Outcome outcome = place().run("audit " + name);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("[E_FORMAT_UNKNOWN]"));
    return outcome.err;
  };
  const std::pair<const char*, std::string> packed[] = {{"zstd", "\x28\xb5\x2f\xfd more\n"},
                                                        {"gzip", "\x1f\x8b more\n"},
                                                        {"xz",
                                                         "\xfd"
                                                         "7zXZ more\n"},
                                                        {"bzip2", "BZh9 more\n"},
                                                        {"lz4", "\x04\x22\x4d\x18 more\n"}};
  for (const auto& [program, content] : packed)
    EXPECT_THAT(said("r.packed", content),
                HasSubstr(std::string("r.packed: found what ") + program +
                          " has packed, expected a recording.jsonl: unpack it, into a file or into the audit, " +
                          program + " -dc FILE | exactvo audit -"));
  EXPECT_THAT(said("r.bin", "\x01\x02\n"), HasSubstr("r.bin: found no text, expected a recording.jsonl"));
  EXPECT_THAT(said("m.json", R"({"scenario": "s", "outcome": "", "provenance": {}})"),
              HasSubstr("m.json: found the metrics of a run, expected a recording.jsonl"));
  EXPECT_THAT(said("s.json", kScenario), HasSubstr("s.json: found a scenario, which is no run yet"));
  EXPECT_THAT(place().run("audit s.json -").err,
              HasSubstr("unexpected argument '-': the path is 's.json'; a scenario goes behind --scenario"));
}

TEST(Messages, ATimeStepBeyondTheHorizonIsReportedAsTheTimeStep) {
  place().write("slow.json", R"({"name": "slow", "time_step": 1,
    "robots": [{"id": "R1", "position": [0, 0], "goal": [8, 0]}]})");
  EXPECT_THAT(place().run("simulate slow.json").err,
              HasSubstr("/time_step: found 1, expected at most half of /horizons/least, which is 0.3 (s)"));
  place().write("slow.json", R"({"name": "slow", "horizons": {"least": 0.01},
    "robots": [{"id": "R1", "position": [0, 0], "goal": [8, 0]}]})");
  EXPECT_THAT(place().run("simulate slow.json").err, HasSubstr("/horizons/least: found 0.01, expected at least twice"));
}

TEST(Messages, OneIsSingular) {
  EXPECT_THAT(place().run("convert p.wkt q.wkt").err, HasSubstr("q.wkt (wkt): 1 obstacle\n"));
  EXPECT_THAT(place().run("generate star --count 1 --out star.wkt").err, HasSubstr(": 1 obstacle of 1 item, star"));
  EXPECT_THAT(place().run("batch p.wkt --out batch").err, HasSubstr("1 file, "));
  place().write("p.jsonl", R"({"bound": {"disc": 2}, "preferred": [2, 0], "constraints": []})");
  EXPECT_THAT(place().run("lp p.jsonl").out, HasSubstr("1 problem: 1 optimal"));
  EXPECT_THAT(place().run("segment p.wkt").out, HasSubstr(", 1 piece ("));
}

constexpr const char* kVo = "vo --position 0,0 --radius 0.5 --time-horizon 2 --obstacle ";

TEST(Messages, ContactPointsToItsHalfPlane) {
  const Outcome touching = place().run(std::string(kVo) + "'DISC(1.5 0, 1)' --velocity 1,0");
  EXPECT_THAT(touching.out, AllOf(HasSubstr("The half-plane of contact stands below"), HasSubstr("(contact)\n")));
  const Outcome within = place().run(std::string(kVo) + "'DISC(0.5 0, 1)' --velocity 1,0");
  EXPECT_THAT(within.out, HasSubstr("No half-plane of contact can be proven"));
}

/// A minus before a zero that no other digit follows.
testing::AssertionResult has_no_negative_zero(const std::string& text) {
  const std::regex zero(R"(-0(\.0*)?([^.0-9x]|$))");
  std::smatch found;
  if (!std::regex_search(text, found, zero)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << found.prefix().str().substr(std::max(found.position() - 60L, 0L)) << found[0];
}

TEST(Messages, ZeroHasNoSign) {
  const std::string polygon = "'POLYGON((2 -1, 3 -1, 3 1, 2 1, 2 -1))' ";
  for (const std::string& arguments : {std::string("--velocity=-0.0,0"), std::string("--velocity=-0.0,0 --json"),
                                       std::string("--velocity 1,0.2 --free --max-speed 1.5"),
                                       std::string("--velocity 1,0.2 --free --max-speed 1.5 --json")})
    EXPECT_TRUE(has_no_negative_zero(place().run(kVo + polygon + arguments).out)) << arguments;
  place().write("p.jsonl", R"({"bound": {"disc": 2}, "preferred": [-0.0, -0.0], "constraints": []})");
  EXPECT_TRUE(has_no_negative_zero(place().run("lp p.jsonl").out));
  EXPECT_TRUE(has_no_negative_zero(place().run("lp p.jsonl --json").out));
}

TEST(Messages, FreeVelocitiesHaveUnitsInEveryLine) {
  const std::string out =
      place()
          .run(std::string(kVo) + "'POLYGON((2 -1, 3 -1, 3 1, 2 1, 2 -1))' --velocity 1,0.2 --free --max-speed 1.5")
          .out;
  std::istringstream lines(out);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_THAT(line, HasSubstr("(m/s)^2")) << out;
  EXPECT_EQ(count, 6u) << out;
}

TEST(Messages, ATrapFindingHasOneVerdict) {
  place().write("wall.json", R"({"name": "wall", "robots": [{"id": "R1", "position": [0, 0], "goal": [20, 0]}],
    "obstacles": [{"id": "wall", "polyline": [[9, -3], [9, 3]]}]})");
  const std::string out = place().run("trap wall.json").out;
  EXPECT_THAT(out, AllOf(HasSubstr("no stall (trap-free), relative margin "),
                         HasSubstr("\n    unstable equilibrium, no stall, at ("), Not(HasSubstr("may balance"))));
}

TEST(Messages, ColumnsOfAnswersHaveAHeader) {
  place().write("p.jsonl", R"({"bound": {"disc": 2}, "preferred": [2, 0], "constraints": []})");
  EXPECT_THAT(place().run("lp p.jsonl").out, testing::StartsWith(" problem status "));
}

}  // namespace
}  // namespace exactvo::test
