// SPDX-License-Identifier: GPL-3.0-or-later
// What a file says beside its shapes, and where they lie on earth, through `convert` and `repair`: kept where the
// format can, named where it can't. Read back by the program itself and by GDAL, as other programs do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#ifdef EXACTVO_WITH_GDAL
#include <gdal_utils.h>
#endif

#include <cmath>
#include <nlohmann/json.hpp>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

constexpr const char* kTown = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "id": "way/7", "properties": {"name": "M\u00fchle", "levels": 3, "height": 9.5, "open": true,
    "tags": {"use": "mill"}, "none": null},
   "geometry": {"type": "Polygon", "coordinates": [[[13.4, 52.5], [13.4001, 52.5], [13.4001, 52.5001], [13.4, 52.5]]]}},
  {"type": "Feature", "id": "way/8", "properties": {"name": "Hof", "levels": 1},
   "geometry": {"type": "LineString", "coordinates": [[13.401, 52.501], [13.402, 52.501]]}}]})";

constexpr const char* kRoom = "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0), (1 1, 1 2, 2.125 2, 2 1, 1 1))\n";

json features_of(const Workplace& here, const std::string& file) {
  return json::parse(here.read(file)).at("features");
}

TEST(Properties, GeoJsonKeepsThemAndFeatureIds) {
  const Workplace here;
  here.write("town.geojson", kTown);
  const Outcome outcome = here.run("convert town.geojson out.geojson");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("lost")));
  const json given = json::parse(kTown).at("features");
  const json written = features_of(here, "out.geojson");
  ASSERT_EQ(written.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(written[k].at("id"), given[k].at("id"));
    for (const auto& [key, value] : given[k].at("properties").items())
      EXPECT_EQ(written[k].at("properties").at(key), value) << key;
  }
}

// They became 1 and 2, without a word.
TEST(Properties, NumbersOfFeaturesSurviveGeoPackage) {
  const Workplace here;
  std::string town = kTown;
  for (const auto& [id, number] : {std::pair{"\"way/7\"", "70000000000"}, std::pair{"\"way/8\"", "3"}})
    town.replace(town.find(id), std::string(id).size(), number);
  here.write("town.geojson", town);
  const Outcome there = here.run("convert town.geojson out.gpkg");
  ASSERT_EQ(there.status, 0) << there.err;
  EXPECT_THAT(there.err, Not(HasSubstr("lost")));
  ASSERT_EQ(here.run("convert out.gpkg back.geojson").status, 0);
  const json back = features_of(here, "back.geojson");
  ASSERT_EQ(back.size(), 2u);
  for (const json& feature : back) {
    const bool is_mill = feature.at("properties").at("levels") == 3;
    EXPECT_EQ(feature.at("id"), is_mill ? 70000000000 : 3);
  }
}

TEST(Properties, IdsOfFeaturesThatAreNoNumbersAreReportedToStandInAColumn) {
  for (const std::string format : {"gpkg", "fgb"}) {
    const Workplace here;
    here.write("town.geojson", kTown);
    const Outcome there = here.run("convert town.geojson out." + format);
    ASSERT_EQ(there.status, 0) << there.err;
    EXPECT_THAT(there.err, AllOf(HasSubstr("lost: feature ids"), HasSubstr("column \"feature_id\""))) << there.err;
  }
}

// 1e-16 of a degree apart: the same decimals.
TEST(Properties, GeoJsonInDegreesRepeatsNoVertex) {
  const Workplace here;
  here.write("room.wkt", "POLYGON ((0 0, 6 0, 6.000000000001 0.000000000001, 6 4, 0 4, 0 0))\n");
  ASSERT_EQ(here.run("convert room.wkt room.geojson").status, 0);
  const json ring = features_of(here, "room.geojson").at(0).at("geometry").at("coordinates").at(0);
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) EXPECT_NE(ring.at(k), ring.at(k + 1)) << ring;
  EXPECT_EQ(here.run("validate room.geojson").status, 0);
}

TEST(Properties, SurviveGeoPackageFlatGeobufAndCsv) {
  for (const std::string format : {"gpkg", "fgb", "csv"}) {
    const Workplace here;
    here.write("town.geojson", kTown);
    const Outcome there = here.run("convert town.geojson out." + format);
    ASSERT_EQ(there.status, 0) << there.err;
    EXPECT_THAT(there.err, Not(HasSubstr("propert"))) << format;
    ASSERT_EQ(here.run("convert out." + format + " back.geojson").status, 0);
    const json back = features_of(here, "back.geojson").at(0).at("properties");
    EXPECT_EQ(back.at("name"), "M\u00fchle") << format;
    EXPECT_EQ(back.at("feature_id"), "way/7") << format;
    EXPECT_EQ(json::parse(back.at("tags").get<std::string>()).at("use"), "mill") << format;
    if (format == "csv") {
      EXPECT_EQ(back.at("levels"), "3") << "a column of text";
    } else {
      EXPECT_EQ(back.at("levels"), 3) << format;
      EXPECT_EQ(back.at("height"), 9.5) << format;
      EXPECT_EQ(back.at("open"), true) << format;
    }
  }
}

/// Which is a column of geometry in CSV alone.
TEST(Properties, OfTheNameWktSurvive) {
  for (const std::string format : {"gpkg", "fgb"}) {
    const Workplace here;
    here.write("a.geojson", R"({"type": "Feature", "properties": {"WKT": "x", "n": 1}, "geometry": {"type": "Polygon",
      "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}})");
    ASSERT_EQ(here.run("convert a.geojson out." + format).status, 0);
    ASSERT_EQ(here.run("convert out." + format + " back.geojson").status, 0);
    EXPECT_EQ(features_of(here, "back.geojson").at(0).at("properties").at("WKT"), "x") << format;
  }
}

TEST(Properties, AreNamedWhereTheFormatHasNoPlaceForThem) {
  const Workplace here;
  here.write("town.geojson", kTown);
  for (const std::string output : {"out.wkt", "out.poly.xml", "menge.xml --to menge-xml"}) {
    const Outcome outcome = here.run("convert town.geojson " + output);
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("lost: 6 properties (name, levels, height, open, tags, none) of 2 obstacles"),
                      HasSubstr("lost: 2 feature ids"), HasSubstr("lost: where (0, 0) lies on earth")))
        << output;
  }
}

TEST(Properties, OfARepairedFileAreKept) {
  const Workplace here;
  here.write("town.geojson", kTown);
  ASSERT_EQ(here.run("repair town.geojson --out repaired.geojson").status, 0);
  EXPECT_EQ(features_of(here, "repaired.geojson").at(1).at("properties").at("name"), "Hof");
}

TEST(Properties, NamesThatDifferInCaseOrAreTakenGetColumnsOfTheirOwn) {
  const Workplace here;
  here.write("a.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
    "properties": {"Name": 1, "name": "x", "fid": 7, "geom": 2}, "geometry": {"type": "Polygon",
    "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}}]})");
  const Outcome outcome = here.run("convert a.geojson a.gpkg");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("its column is called \"name_2\""));
  ASSERT_EQ(here.run("convert a.gpkg b.geojson").status, 0);
  const json back = features_of(here, "b.geojson").at(0).at("properties");
  EXPECT_EQ(back.at("Name"), 1);
  EXPECT_EQ(back.at("name_2"), "x");
}

TEST(Convert, RefusesItsInputAsItsOutputByWhateverName) {
  const Workplace here;
  here.write("a.wkt", kRoom);
  fs::create_symlink("a.wkt", here.path() / "link.wkt");
  fs::create_hard_link(here.path() / "a.wkt", here.path() / "hard.wkt");
  fs::create_directory(here.path() / "sub");
  for (const std::string output : {"a.wkt", "./sub/../a.wkt", "link.wkt", "hard.wkt"}) {
    for (const std::string& arguments : {"convert a.wkt " + output, "repair a.wkt --out " + output}) {
      const Outcome outcome = here.run(arguments);
      EXPECT_EQ(outcome.status, 2) << arguments;
      EXPECT_THAT(outcome.err, HasSubstr("another file than the input a.wkt")) << arguments;
    }
  }
  EXPECT_EQ(here.read("a.wkt"), kRoom);
  EXPECT_TRUE(fs::is_symlink(here.path() / "link.wkt"));
}

// --- Degrees and metres ---

/// m, width of the first ring, given in degrees, by the ellipsoid's radii of curvature at the equator.
double width_at_equator(const json& geometry) {
  constexpr double kMetresADegree = 6378137.0 * 3.14159265358979323846 / 180.0;
  const json& ring = geometry.at("coordinates").at(0);
  return (ring.at(1).at(0).get<double>() - ring.at(0).at(0).get<double>()) * kMetresADegree;
}

TEST(GeoJsonInDegrees, ARoomOfSixMetresIsOneForEveryReader) {
  const Workplace here;
  here.write("room.wkt", kRoom);
  const Outcome outcome = here.run("convert room.wkt room.geojson");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no place on earth is known"));
  const json written = json::parse(here.read("room.geojson"));
  EXPECT_FALSE(written.contains("units"));
  EXPECT_NEAR(width_at_equator(written.at("features").at(0).at("geometry")), 6.0, 1e-6);
  ASSERT_EQ(here.run("convert room.geojson back.wkt").status, 0);
  EXPECT_EQ(here.read("back.wkt"), kRoom) << "metres of few decimals come back bit for bit";
}

TEST(GeoJsonInDegrees, EveryWriterOfGeoJsonWritesThem) {
  const Workplace here;
  here.write("room.wkt", kRoom);
  for (const auto& [arguments, file] : std::vector<std::pair<std::string, std::string>>{
           {"convert room.wkt c.geojson", "c.geojson"},
           {"repair room.wkt --out r.geojson", "r.geojson"},
           {"generate star --count 3 --out g.geojson", "g.geojson"},
           {"segment room.wkt --out s.geojson", "s.geojson"},
           {"batch room.wkt --write geojson --out b", "b/obstacles.geojson"}}) {
    ASSERT_EQ(here.run(arguments).status, 0) << arguments << here.read(".stderr");
    const json degrees = json::parse(here.read(file));
    EXPECT_FALSE(degrees.contains("units")) << file;
    ASSERT_EQ(here.run(arguments + " --metres").status, 0) << arguments << here.read(".stderr");
    const json metres = json::parse(here.read(file));
    EXPECT_EQ(metres.at("units"), "m") << file;
    const auto first = [](const json& collection) {
      const json* at = &collection.at("features").at(0).at("geometry").at("coordinates");
      while (at->at(0).is_array()) at = &at->back();
      return at->at(0).get<double>() + at->at(1).get<double>();
    };
    EXPECT_NEAR(first(degrees) * 111000.0, first(metres), 0.02 * std::fabs(first(metres)) + 1e-9) << file;
  }
}

TEST(GeoJsonInDegrees, DegreesComeBackThroughEveryFormatThatKeepsThePlane) {
  for (const std::string between : {"x.geojson", "x.gpkg", "x.fgb"}) {
    const Workplace here;
    here.write("town.geojson", kTown);
    ASSERT_EQ(here.run("convert town.geojson " + between).status, 0);
    ASSERT_EQ(here.run("convert " + between + " back.geojson").status, 0);
    const json given = json::parse(kTown).at("features");
    const json back = features_of(here, "back.geojson");
    const auto compare = [&](const json& a, const json& b) {
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_NEAR(a.at(k).at(0).get<double>(), b.at(k).at(0).get<double>(), 1e-12) << between;
        EXPECT_NEAR(a.at(k).at(1).get<double>(), b.at(k).at(1).get<double>(), 1e-12) << between;
      }
    };
    compare(back.at(0).at("geometry").at("coordinates").at(0), given.at(0).at("geometry").at("coordinates").at(0));
    compare(back.at(1).at("geometry").at("coordinates"), given.at(1).at("geometry").at("coordinates"));
  }
}

TEST(GeoJsonInDegrees, AMapOfAProjectedSystemLiesWhereThatSaysAndComesBack) {
  const Workplace here;
  // A building of Berlin, to be read on the plane of UTM 33 N.
  here.write("room.json",
             R"({"type": "FeatureCollection", "local_metres": {"reference_system": "EPSG:32633", "offset": [0, 0],
    "decimals": 3}, "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
    [[[13.394, 52.514], [13.3945, 52.514], [13.3945, 52.5142], [13.394, 52.514]]]}}]})");
  ASSERT_EQ(here.run("convert room.json utm.gpkg").status, 0) << here.read(".stderr");
  const Outcome back = here.run("convert utm.gpkg back.geojson");
  ASSERT_EQ(back.status, 0) << back.err;
  EXPECT_THAT(back.err, Not(HasSubstr("no place on earth")));
  const json ring = features_of(here, "back.geojson").at(0).at("geometry").at("coordinates").at(0);
  EXPECT_NEAR(ring.at(1).at(0).get<double>(), 13.3945, 1e-8) << "metres were rounded to millimetres";
  EXPECT_NEAR(ring.at(1).at(1).get<double>(), 52.514, 1e-8);
  const Outcome again = here.run("convert back.geojson again.wkt");
  ASSERT_EQ(again.status, 0) << again.err;
  ASSERT_EQ(here.run("convert utm.gpkg utm.wkt").status, 0);
  EXPECT_EQ(here.read("again.wkt"), here.read("utm.wkt"));
}

TEST(GeoJsonInDegrees, WhatReachesTooFarForOnePlaneIsRefusedUnlessInMetres) {
  const Workplace here;
  here.write("wide.wkt", "LINESTRING (0 0, 9e6 0)\n");
  const Outcome outcome = here.run("convert wide.wkt wide.geojson");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("E_PROJECTION"));
  EXPECT_FALSE(here.has("wide.geojson"));
  EXPECT_EQ(here.run("convert wide.wkt wide.geojson --metres").status, 0);
  // Far away and small is no matter: the offset is kept.
  here.write("far.wkt", "LINESTRING (5e8 3e8, 500000006.5 3e8)\n");
  ASSERT_EQ(here.run("convert far.wkt far.geojson").status, 0) << here.read(".stderr");
  ASSERT_EQ(here.run("convert far.geojson back.wkt").status, 0);
  EXPECT_EQ(here.read("back.wkt"), "LINESTRING (5e+08 3e+08, 500000006.5 3e+08)\n");
}

TEST(GeoJsonInDegrees, AMalformedPlaneIsRefused) {
  const Workplace here;
  for (const std::string plane : {R"({"centre": [13]})", R"({"centre": [999, 0]})", R"({"centre": "x"})", "7",
                                  R"({"reference_system": "EPSG:4326"})", R"({"reference_system": "/etc/passwd"})"}) {
    here.write("a.geojson", R"({"type": "FeatureCollection", "local_metres": )" + plane +
                                R"(, "features": [{"type": "Feature", "properties": {}, "geometry": {"type":
        "LineString", "coordinates": [[0, 0], [1, 0]]}}]})");
    const Outcome outcome = here.run("validate a.geojson");
    EXPECT_EQ(outcome.status, 2) << plane;
    EXPECT_THAT(outcome.out, HasSubstr("/local_metres")) << plane;
  }
}

#ifdef EXACTVO_WITH_GDAL

/// What the program ogr2ogr does.
void ogr2ogr(const fs::path& from, const fs::path& to) {
  GDALAllRegister();
  const GDALDatasetH source = GDALOpenEx(from.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr);
  ASSERT_NE(source, nullptr) << from;
  GDALVectorTranslateOptions* options = GDALVectorTranslateOptionsNew(nullptr, nullptr);
  GDALDatasetH sources[] = {source};
  const GDALDatasetH target = GDALVectorTranslate(to.c_str(), nullptr, 1, sources, options, nullptr);
  ASSERT_NE(target, nullptr) << to;
  GDALClose(target);
  GDALVectorTranslateOptionsFree(options);
  GDALClose(source);
}

TEST(GeoJsonInDegrees, OneTripThroughOgr2ogrKeepsTheSize) {
  const Workplace here;
  here.write("room.wkt", kRoom);
  ASSERT_EQ(here.run("convert room.wkt room.geojson").status, 0);
  ASSERT_EQ(here.run("convert room.wkt room.gpkg").status, 0);
  for (const std::string file : {"through.gpkg", "through.geojson", "through.shp"})
    ogr2ogr(here.path() / "room.geojson", here.path() / file);
  ogr2ogr(here.path() / "room.gpkg", here.path() / "packed.gpkg");
  for (const std::string file : {"through.gpkg", "through.geojson", "through.shp", "room.gpkg", "packed.gpkg"}) {
    const Outcome outcome = here.run("segment " + file + " --json");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NEAR(json::parse(outcome.out).at("area").get<double>(), 24.0 - 1.0625, 1e-4) << file;
  }
}

#endif

// --- What a batch writes ---

TEST(BatchSizes, ArePrintedBeforeAndWhatIsThirtyTimesTheInputIsWrittenOnRequest) {
  const Workplace here;
  here.write("room.wkt", kRoom);
  const Outcome outcome = here.run("batch room.wkt --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1 file, 67 B: about 87.1 B in out"), HasSubstr("--write geopackage adds"),
                                 HasSubstr("--write geojson adds")));
  EXPECT_TRUE(here.has("out/measurements.jsonl"));
  EXPECT_THAT(here.read("out/index.html"), AllOf(HasSubstr("1 file: 1 done"), HasSubstr("1 obstacle: 1 done")));
  EXPECT_FALSE(here.has("out/obstacles.gpkg"));
  EXPECT_FALSE(here.has("out/obstacles.geojson"));
}

}  // namespace
}  // namespace exactvo::test
