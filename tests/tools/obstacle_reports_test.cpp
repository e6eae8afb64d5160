// SPDX-License-Identifier: GPL-3.0-or-later
// What the verbs for obstacle files tell: places that a user finds in the file, areas, what was left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A bow tie and a square with a vertex twice, round (13, 52) degrees.
constexpr const char* kDegrees = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
   "coordinates": [[[13, 52], [13.002, 52.002], [13.002, 52], [13, 52.002], [13, 52]]]}},
  {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
   "coordinates": [[[13, 52], [13.002, 52.0005], [13.002, 52.0005], [13.002, 52.002], [13, 52]]]}}]})";

TEST(Validate, NamesPlacesOfAFileInDegreesByTheNumbersThatStandInIt) {
  const Workplace here;
  here.write("d.geojson", kDegrees);
  const Outcome text = here.run("validate d.geojson");
  EXPECT_THAT(text.out, AllOf(HasSubstr("feature 0, ring 0, vertex 0: longitude 13.001, latitude 52.001000"),
                              HasSubstr(" m), on an edge at vertex longitude 13, latitude 52: a ring that crosses"),
                              HasSubstr("feature 1, ring 0, vertex 2: longitude 13.002, latitude 52.0005 (")));
  const json file = json::parse(here.run("validate d.geojson --json").out).at("files").at(0);
  EXPECT_EQ(file.at("origin"), json::parse(R"({"longitude": 13.001, "latitude": 52.001})"));
  const json& crossing = file.at("problems").at(0);
  EXPECT_NEAR(crossing.at("in_file").at(0).get<double>(), 13.001, 1e-9);
  EXPECT_NEAR(crossing.at("in_file").at(1).get<double>(), 52.001, 1e-7);  // a straight line on the local plane
  EXPECT_EQ(crossing.at("at_vertex"), json::array({13.0, 52.0}));
  EXPECT_EQ(file.at("problems").at(1).at("in_file"), json::array({13.002, 52.0005}));
  EXPECT_LT(std::abs(crossing.at("x").get<double>()), 1.0) << "metres";
}

TEST(Validate, NamesPlacesOfAFileInFeetByItsFeet) {
  const Workplace here;
  here.write("f.geojson", R"({"type": "FeatureCollection",
    "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2263"}}, "features": [
    {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
     "coordinates": [[[0, 0], [3937, 3937], [3937, 0], [0, 3937], [0, 0]]]}}]})");
  EXPECT_THAT(here.run("validate f.geojson").out,
              AllOf(HasSubstr("vertex 0: (1968.5"), HasSubstr("m), on an edge at vertex (0, 0): ")));
}

TEST(Validate, SaysWhatWouldBeRepairedAndWhichCommandRepairsTheRest) {
  const Workplace here;
  here.write("turned.wkt", "POLYGON ((0 0, 0 4, 6 4, 6 0, 0 0))\n");
  here.write("bow.wkt", "POLYGON ((0 0, 0 4, 6 4, 6 0, 0 0))\nPOLYGON ((10 0, 12 2, 12 0, 10 2, 10 0))\n");
  const Outcome turned = here.run("validate turned.wkt"), bow = here.run("validate bow.wkt");
  EXPECT_THAT(turned.out, HasSubstr("[E_CLOCKWISE], would be repaired\n"));
  EXPECT_THAT(turned.err, AllOf(HasSubstr("1 would be repaired"), Not(HasSubstr("exactvo repair"))));
  EXPECT_THAT(bow.err, HasSubstr("exactvo repair bow.wkt --out FILE can cut its rings at their crossings"));
  EXPECT_EQ(here.run("repair bow.wkt --out whole.wkt").status, 0);
  EXPECT_EQ(here.run("validate whole.wkt").status, 0);
  EXPECT_THAT(here.run("segment bow.wkt").err, HasSubstr("exactvo repair cuts rings that cross"));
}

TEST(Validate, NamesTheVertexBesideACrossing) {
  const Workplace here;
  here.write("bad.wkt", "POLYGON ((10 0, 12 2, 12 0, 10 2, 10 0))\n");
  EXPECT_THAT(here.run("validate bad.wkt").out, HasSubstr(": (11, 1), on an edge at vertex (10, 0): a ring that"));
}

TEST(Repair, NamesThePlaceOfWhatItCutInTheFilesNumbers) {
  const Workplace here;
  here.write("d.geojson", kDegrees);
  EXPECT_THAT(here.run("repair d.geojson --out m.geojson").out,
              HasSubstr("feature 0: E_SELF_INTERSECTION: ring 0, vertex 0, longitude 13.001, latitude 52.001"));
}

TEST(Repair, AreasAreNeverBelowZeroAndHolesAreToldApart) {
  const Workplace here;
  here.write("hole.wkt",
             "POLYGON ((0 0, 0 10, 10 10, 10 0, 0 0), (20 20, 20 60, 60 60, 60 20, 20 20))\n"
             "POLYGON ((10 0, 12 2, 12 0, 10 2, 10 0))\n");
  const Outcome text = here.run("repair hole.wkt --out m.wkt");
  EXPECT_THAT(
      text.out,
      AllOf(HasSubstr("polygons 1 -> 2, vertices 8 -> 8, within outer rings 100 -> 1700 m^2; holes 1 -> 0, "
                      "within them 1600 -> 0 m^2"),
            HasSubstr("within outer rings 0 -> 2 m^2"), Not(HasSubstr("-1500")), Not(HasSubstr("moved by 0 m"))));
  EXPECT_THAT(text.err, HasSubstr("areas before are by the shoelace formula"));
  const json record =
      json::parse(here.run("repair hole.wkt --out m.wkt --json").out).at("files").at(0).at("repairs").at(0);
  EXPECT_TRUE(record.at("before").at("area").is_null());
  EXPECT_EQ(record.at("before").at("outer_area"), 100.0);
  EXPECT_EQ(record.at("before").at("hole_area"), 1600.0);
  EXPECT_EQ(record.at("after").at("area"), 1700.0);
}

TEST(Repair, TellsWhatItCannotReadOrMendAndWhatItDropped) {
  const Workplace here;
  here.write("bad.wkt",
             "POLYGON ((0 0, 4 x, 4 4, 0 0))\nPOLYGON ((0 0, 1 0, 0 0))\n"
             "POLYGON ((0 0, 4 0, 4 4, 0 0), (1 1, 2 1, 1 1))\n");
  EXPECT_THAT(here.run("repair bad.wkt --out m.wkt").out,
              AllOf(HasSubstr("not repaired: bad.wkt: line 1, column 18: found"), HasSubstr("[E_NUMBER]"),
                    HasSubstr("not repaired: bad.wkt: line 2, column 1, ring 0, vertex 0: found too few"),
                    HasSubstr("line 3, column 1: E_TOO_FEW_POINTS: ring 1, vertex 0, (1, 1): polygons 1 -> 1"),
                    HasSubstr("holes 1 -> 0, within them 0 -> 0 m^2")));
}

TEST(Segment, CoordinatesWithoutAnAreaInDoublesAreRefused) {
  const Workplace here;
  here.write("far.wkt", "POLYGON ((0 0, 1e200 0, 1e200 1e200, 0 1e200, 0 0))\nPOLYGON ((0 0, 1 0, 0 1, 0 0))\n");
  const Outcome outcome = here.run("segment far.wkt");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("0.5 m^2"), Not(HasSubstr("inf"))));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("line 1, column 1, ring 0, vertex 1: found a coordinate beyond 2^100 m"),
                                 HasSubstr("[E_RANGE]")));
}

TEST(Batch, FoldersOfEarlierBatchesAreNotedAndNotRead) {
  const Workplace here;
  std::filesystem::create_directories(here.path() / "maps");
  here.write("maps/good.wkt", "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))\n");
  EXPECT_EQ(here.run("batch maps --out maps/one --write measurements").status, 0);
  const Outcome outcome = here.run("batch maps --out two --write measurements");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: not read: maps/one holds an earlier batch (2 files)"));
  EXPECT_THAT(outcome.out, HasSubstr("1 file: 1 done"));
  const Outcome nothing = here.run("batch maps/one --out two --write measurements");
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, HasSubstr("no file to read; maps/one holds an earlier batch"));
  EXPECT_THAT(here.run("batch two --out two --write measurements").err, HasSubstr("two is where the results go"));
  EXPECT_THAT(here.run("batch maps --out two --write measurements --resume").err, HasSubstr("nothing left to do"));
}

}  // namespace
}  // namespace exactvo::test
