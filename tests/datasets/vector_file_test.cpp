// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using geometry::Polygon;
using geometry::Vec2;

class VectorFile : public TemporaryFolder {
 protected:
  void SetUp() override {
    if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
    TemporaryFolder::SetUp();
  }
  void TearDown() override {
    if (!folder_.empty()) TemporaryFolder::TearDown();
  }

  ObstacleFile read(const std::string& name, const std::string& content, const ReadOptions& options = {}) const {
    return read_obstacles(put(name, content), options);
  }
};

std::string collection(const std::string& members, const std::string& geometry) {
  return "{\"type\": \"FeatureCollection\", " + members +
         "\"features\": [{\"type\": \"Feature\", \"properties\": {}, " + "\"geometry\": " + geometry + "}]}";
}

const char* const kSquare =
    R"({"type": "Polygon", "coordinates": [[[13, 52], [13.002, 52], [13.002, 52.002], [13, 52.002], [13, 52]]]})";

TEST_F(VectorFile, GeoJsonSaysThatItIsInMetres) {
  const ObstacleFile file = read("a.geojson", collection("\"units\": \"m\", ", kSquare));
  EXPECT_FALSE(file.origin.has_value());
  EXPECT_EQ(std::get<Polygon>(file.obstacles.at(0).shape).outer.front(), (Vec2{13, 52}));
}

TEST_F(VectorFile, GeoJsonIsInDegreesOtherwise) {
  const ObstacleFile file = read("a.geojson", collection("", kSquare));
  ASSERT_TRUE(file.origin.has_value());
  EXPECT_NEAR(file.origin->longitude, 13.001, 1e-9);
  EXPECT_NEAR(file.origin->latitude, 52.001, 1e-9);
  // A thousandth of a degree at 52.001 north on WGS 84: N cos(phi) and M times pi/180000.
  const Vec2 corner = std::get<Polygon>(file.obstacles.at(0).shape).outer.front();
  EXPECT_NEAR(corner.x, -68.68, 0.01);
  EXPECT_NEAR(corner.y, -111.26, 0.01);
}

TEST_F(VectorFile, TheCallerMayKnowBetter) {
  ReadOptions options;
  options.units = Units::metres;
  EXPECT_FALSE(read("a.geojson", collection("", kSquare), options).origin.has_value());
  options.units = Units::degrees;
  EXPECT_TRUE(read("b.geojson", collection("\"units\": \"m\", ", kSquare), options).origin.has_value());
}

TEST_F(VectorFile, ImpossibleDegreesAreMetresWithANote) {
  const std::string far = R"({"type": "LineString", "coordinates": [[0, 0], [300, 500]]})";
  const ObstacleFile file = read("a.geojson", collection("", far));
  EXPECT_FALSE(file.origin.has_value());
  ASSERT_EQ(file.notes.size(), 2u);
  EXPECT_EQ(file.notes[0].text.rfind("taken as metres: ", 0), 0u) << file.notes[0].text;
  EXPECT_EQ(file.notes[1].text, "extent 0 to 300 m, 0 to 500 m");
  ReadOptions options;
  options.units = Units::degrees;
  EXPECT_EQ(refusal_of([&] { read("b.geojson", collection("", far), options); }).code(), DataCode::projection);
}

// As in a public file of the world's land: rounding took a longitude beyond 180.
TEST_F(VectorFile, DegreesRoundedBeyondTheirRangeAreDegrees) {
  const std::string coast = R"({"type": "LineString", "coordinates": [[179.9, 60], [180.00000000000014, 60.1]]})";
  const ObstacleFile file = read("a.geojson", collection("", coast));
  ASSERT_TRUE(file.origin.has_value());
  ASSERT_TRUE(file.extent.has_value());
  EXPECT_NEAR(file.extent->high.x - file.extent->low.x, 5.57e3, 20.0);  // a tenth of a degree at 60 north
  const std::string far = R"({"type": "LineString", "coordinates": [[179.9, 60], [180.00001, 60.1]]})";
  EXPECT_FALSE(read("b.geojson", collection("", far)).origin.has_value());
}

TEST_F(VectorFile, NotesSayHowUnitsWereDecidedAndWhereTheFileLies) {
  const ObstacleFile file = read("a.geojson", collection("", kSquare));
  ASSERT_EQ(file.notes.size(), 3u);
  EXPECT_EQ(file.notes[2].text.rfind("lengths and areas are at most ", 0), 0u) << file.notes[2].text;
  EXPECT_EQ(
      file.notes[0].text,
      "degrees: GeoJSON that says nothing of units (RFC 7946); brought to metres round longitude 13.001, latitude "
      "52.001");
  EXPECT_EQ(file.notes[1].text.rfind("extent -68.6", 0), 0u) << file.notes[1].text;
  const ObstacleFile metres = read("b.geojson", collection("\"units\": \"m\", ", kSquare));
  EXPECT_EQ(metres.notes.at(0).text, "metres: by its member \"units\"");
}

TEST_F(VectorFile, UnitsThatMeanNothingAreRefused) {
  const DataError error = refusal_of([&] { read("a.geojson", collection("\"units\": \"feet\", ", kSquare)); });
  expect_refusal(error, DataCode::not_an_option, "/units");
}

TEST_F(VectorFile, ProjectedSystemsAreScaledToMetres) {
  // EPSG:2263 counts in US survey feet, 1200/3937 m each.
  const std::string crs = R"("crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2263"}}, )";
  const std::string line = R"({"type": "LineString", "coordinates": [[3937, 0], [7874, 3937]]})";
  const ObstacleFile file = read("a.geojson", collection(crs, line));
  EXPECT_NEAR(std::get<geometry::Polyline>(file.obstacles.at(0).shape).points[0].x, 1200.0, 1e-6);
}

TEST_F(VectorFile, AnUnknownReferenceSystemIsNoted) {
  for (const char* crs : {R"({"type": "name", "properties": {"name": "EPSG:999999"}})", R"("EPSG:25833")"}) {
    const ObstacleFile file = read("a.geojson", collection(std::string("\"crs\": ") + crs + ", ", kSquare));
    EXPECT_TRUE(file.origin.has_value());
    EXPECT_EQ(file.notes.at(0).place, "/crs");
    EXPECT_NE(file.notes.at(0).text.find("taken as longitude and latitude"), std::string::npos);
  }
}

TEST_F(VectorFile, RingsArePutRightAndNoted) {
  const std::string clockwise = R"({"type": "Polygon", "coordinates": [[[0, 0], [0, 1], [1, 1], [1, 0], [0, 0]]]})";
  const ObstacleFile file = read("a.geojson", collection("\"units\": \"m\", ", clockwise));
  EXPECT_EQ(file.counts.repaired, 1u);
  ASSERT_EQ(file.notes.size(), 3u);
  EXPECT_EQ(file.notes[1].code, DataCode::clockwise);
  EXPECT_EQ(file.notes[1].place.substr(0, 17), "feature 0, ring 0");
}

TEST_F(VectorFile, SelfCrossingRingsAreRefusedWithTheirPlace) {
  const std::string bowtie = R"({"type": "Polygon", "coordinates": [[[0, 0], [2, 2], [2, 0], [0, 2], [0, 0]]]})";
  const DataError error = refusal_of([&] { read("a.geojson", collection("\"units\": \"m\", ", bowtie)); });
  expect_refusal(error, DataCode::self_intersection, "feature 0, ring 0, vertex 0");
  EXPECT_NE(error.found().find("(1, 1)"), std::string::npos) << error.what();
}

TEST_F(VectorFile, BrokenGeoJsonIsRefusedByLineAndColumn) {
  const DataError error =
      refusal_of([&] { read("a.geojson", "{\"type\": \"FeatureCollection\",\n \"features\": [{"); });
  EXPECT_EQ(error.code(), DataCode::json_syntax);
  EXPECT_EQ(error.place(), "line 2, column 16");
}

TEST_F(VectorFile, AMalformedPointHidesNoTruncation) {
  const std::string cut = R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {}, "geometry": {"type": "Point"}},
    {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coord)";
  EXPECT_EQ(refusal_of([&] { read("a.geojson", cut); }).code(), DataCode::json_syntax);
}

TEST_F(VectorFile, CsvWithAColumnOfWkt) {
  const ObstacleFile file =
      read("a.csv", "id,WKT\n1,\"POLYGON ((0 0,1 0,1 1,0 0))\"\n2,\"LINESTRING (0 0,5 5)\"\n3,POINT (1 1)\n");
  EXPECT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(file.counts.passed_over, 1u);
}

struct Malformed {
  const char* geometry;
  const char* place;
};
const Malformed kMalformed[] = {
    {R"({"type": "Polygon", "coordinates": [[5, -3], [6, -3], [6, 3], [5, -3]]})", "/geometry/coordinates/0/0"},
    {R"({"type": "Polygon", "coordinates": [[[5, -3], [null, 1], [6, 3], [5, -3]]]})", "/geometry/coordinates/0/1"},
    {R"({"type": "Polygon", "coordinates": [[[5, -3], [1], [6, 3], [5, -3]]]})", "/geometry/coordinates/0/1"},
    {R"({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]], [[5, 1], [6, null], [6, 2], [5, 1]]]})",
     "/geometry/coordinates/1/1"},
    {R"({"type": "Poligon", "coordinates": [[[5, -3], [6, -3], [6, 3], [5, -3]]]})", "/geometry/type"},
    {R"({"type": "MultiPolygon", "coordinates": [[[[0, 0], [1, 0], [1, 1], [0, 0]]], [[5, 5], [6, 5], [6, 6]]]})",
     "/geometry/coordinates/1/0/0"},
    {R"({"type": "LineString", "coordinates": [0, 0, 1, 1]})", "/geometry/coordinates/0"},
    {R"({"type": "LineString", "coordinates": [[0, NaN], [1, 1], 7]})", "/geometry/coordinates/0"},
    {R"({"type": "GeometryCollection", "geometries": [{"type": "Point", "coordinates": [1, 2]}, {"type": "Wall"}]})",
     "/geometry/geometries/1/type"},
    {R"({"type": "Point", "coordinates": [1]})", "/geometry/coordinates"},
    {R"({"type": "Point", "coordinates": [[1, 2], [3, 4]]})", "/geometry/coordinates"},
    {R"({"type": "Point", "coordinates": "1 2"})", "/geometry/coordinates"},
    {R"({"type": "Point"})", "/geometry/coordinates"},
    {R"({"type": "LineString"})", "/geometry/coordinates"},
    {R"({"type": "Polygon", "coordinates": [[["5", -3], [6, -3], [6, 3], [5, -3]]]})", "/geometry/coordinates/0/0"},
    {R"({"type": "MultiPoint", "coordinates": [[1, 2], [null, 3]]})", "/geometry/coordinates/1"},
    {R"({"type": "MultiPoint", "coordinates": [1, 2]})", "/geometry/coordinates/0"},
    {R"({"type": "GeometryCollection", "geometries": [{"type": "Point", "coordinates": [1, "2"]}]})",
     "/geometry/geometries/0/coordinates"}};

std::string feature_place(const std::string& pointer) {
  return pointer.empty() ? "feature 0" : "feature 0, " + pointer;
}

// GDAL would give no geometry for these, or one with parts missing, and no word of it.
TEST_F(VectorFile, MalformedGeoJsonIsRefusedByFeature) {
  for (const Malformed& bad : kMalformed) {
    SCOPED_TRACE(bad.geometry);
    const std::string text = collection("\"units\": \"m\", ", bad.geometry);
    const DataError error = refusal_of([&] { read("a.geojson", text); });
    EXPECT_EQ(error.code(), DataCode::format_syntax);
    EXPECT_EQ(error.place(), feature_place(bad.place));
  }
}

TEST_F(VectorFile, MalformedFeaturesAreCountedAndTheOthersRead) {
  ReadOptions options;
  options.keep_going = true;
  const std::string flat = R"({"type": "Feature", "properties": {"name": "caf)"
                           "\xe9"
                           R"("}, "geometry": )" +
                           std::string(kMalformed[0].geometry) + "}";
  const std::string good = R"({"type": "Feature", "properties": {}, "geometry": )" + std::string(kSquare) + "}";
  const ObstacleFile file =
      read("a.geojson", R"({"type": "FeatureCollection", "features": [)" + flat + ", " + good + "]}", options);
  EXPECT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(file.counts.passed_over, 0u);
  ASSERT_EQ(file.rejected.size(), 1u);
  EXPECT_EQ(file.rejected[0].place().rfind("feature 0, /geometry", 0), 0u) << file.rejected[0].what();
}

TEST_F(VectorFile, WhatOtherProgramsWriteBeyondJsonIsRead) {
  ReadOptions options;
  options.keep_properties = true;
  const std::string members = R"("height": NaN, "low": -Infinity, "name": "caf)"
                              "\xe9\t\"";
  const std::string feature = R"({"type": "Feature", "properties": {)" + members + R"(}, "geometry": )" + kSquare + "}";
  for (const std::string& text : {feature, R"({"type": "FeatureCollection", "features": [)" + feature + "]}"}) {
    for (const char* name : {"a.geojson", "a.geojsonl"}) {
      const ObstacleFile file = read(name, text, options);
      ASSERT_EQ(file.obstacles.size(), 1u);
      EXPECT_EQ(file.properties.at(0).members, R"({"height":null,"low":null,"name":"caf?\t"})");
    }
  }
  const std::string whole = R"({"type": "Feature", "properties": {"name": "caf\u00e9 )"
                            "\xc3\xa9"
                            R"( N-I \" NaN"}, "geometry": )" +
                            std::string(kSquare) + "}";
  EXPECT_EQ(read("b.geojson", whole, options).properties.at(0).members,
            "{\"name\":\"caf\xc3\xa9 \xc3\xa9 N-I \\\" NaN\"}");
}

/// Blocks have 64 KiB: a word or a character of several bytes lies across their border.
TEST_F(VectorFile, WordsAcrossBlocksAreRead) {
  ReadOptions options;
  options.keep_properties = true;
  const std::string begin = R"({"type": "Feature", "properties": {"pad": ")";
  for (std::size_t shift = 0; shift < 24; ++shift) {
    const std::string pad((std::size_t{1} << 16) - begin.size() - shift, 'x');
    const std::string text =
        begin + pad + "\xe2\x82\xac\", \"a\": -Infinity}, \"geometry\": " + std::string(kSquare) + "}";
    const ObstacleFile file = read("a.geojson", text, options);
    EXPECT_EQ(file.properties.at(0).members, "{\"pad\":\"" + pad + "\xe2\x82\xac\",\"a\":null}") << shift;
  }
}

TEST_F(VectorFile, ACollectionWithoutFeaturesIsRefused) {
  for (const char* text : {R"({"type": "FeatureCollection"})", R"({"type": "FeatureCollection", "features": {}})"})
    expect_refusal(refusal_of([&] { read("a.geojson", text); }), DataCode::format_syntax, "/features");
}

TEST_F(VectorFile, GeoJsonWithoutAReferenceSystemIsInMetres) {
  const ObstacleFile file = read("a.geojson", collection("\"crs\": null, ", kSquare));
  EXPECT_FALSE(file.origin.has_value());
  EXPECT_EQ(file.notes.at(0).text, "taken as metres: names no reference system");
}

TEST_F(VectorFile, AbsentAndEmptyGeometriesArePassedOver) {
  for (const char* geometry :
       {"null", R"({"type": "Polygon", "coordinates": []})", R"({"type": "Polygon", "coordinates": [[]]})",
        R"({"type": "MultiPolygon", "coordinates": []})", R"({"type": "GeometryCollection", "geometries": []})",
        R"({"type": "Point", "coordinates": [1, 2]})", R"({"type": "Point", "coordinates": []})",
        R"({"type": "MultiPoint", "coordinates": []})",
        R"({"type": "MultiPoint", "coordinates": [[1, 2, 3], [3, 4]]})"}) {
    SCOPED_TRACE(geometry);
    const ObstacleFile file = read("a.geojson", collection("\"units\": \"m\", ", geometry));
    EXPECT_EQ(file.counts.passed_over, 1u);
    EXPECT_TRUE(file.obstacles.empty());
  }
}

TEST_F(VectorFile, AMalformedPartOfAGeometryThatStandsAloneIsRefused) {
  const std::string parts = R"({"type": "MultiPolygon", "coordinates": [[[[0,0],[1,0],[1,1],[0,0]]], [[5,5],[6,5]]]})";
  EXPECT_EQ(refusal_of([&] { read("a.geojson", parts); }).code(), DataCode::format_syntax);
}

std::string record(const std::string& geometry) {
  return R"({"type": "Feature", "properties": {}, "geometry": )" + geometry + "}\n";
}

TEST_F(VectorFile, SequencesAreReadByTheirNames) {
  for (const char* name : {"a.geojsonl", "a.geojsons", "a.ndjson", "a.geojsonseq", "a.GeoJSONL"}) {
    SCOPED_TRACE(name);
    const ObstacleFile file = read(name, record(kSquare) + record("null") + "\r\n" + std::string(kSquare) + "\n");
    EXPECT_EQ(file.obstacles.size(), 2u);
    EXPECT_EQ(file.counts.passed_over, 1u);
    ASSERT_TRUE(file.origin.has_value());
    EXPECT_NEAR(file.origin->longitude, 13.001, 1e-9);
  }
  EXPECT_EQ(read("one.geojsonl", record(kSquare)).obstacles.size(), 1u);
  EXPECT_EQ(read("rs.geojsonseq", "\x1e" + record(kSquare) + "\x1e" + record(kSquare)).obstacles.size(), 2u);
}

TEST_F(VectorFile, MalformedLinesOfASequenceAreNamedByLineAndTheOthersRead) {
  ReadOptions options;
  options.keep_going = true;
  const std::string text = record(kMalformed[0].geometry) + record(kSquare) + "\n{\"type\": \"Feature\", \"geom\n" +
                           R"({"type": "Poligon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]})" + "\n" +
                           "hello\n[1, 2]\n" + record(kSquare) +
                           record(R"({"type": "LineString", "coordinates": [[13, NaN], [14, 52], 7]})") +
                           R"({"type": "FeatureCollection", "features": []})" + "\n";
  const ObstacleFile file = read("a.ndjson", text, options);
  EXPECT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(file.counts.read, 9u);
  const std::pair<const char*, DataCode> refusals[] = {{"line 1, /geometry/coordinates/0/0", DataCode::format_syntax},
                                                       {"line 4, column 26", DataCode::json_syntax},
                                                       {"line 5, /type", DataCode::format_syntax},
                                                       {"line 6, column 1", DataCode::json_syntax},
                                                       {"line 7", DataCode::format_syntax},
                                                       {"line 9, /geometry/coordinates/0", DataCode::format_syntax},
                                                       {"line 10, /type", DataCode::format_syntax}};
  ASSERT_EQ(file.rejected.size(), std::size(refusals));
  for (std::size_t k = 0; k < file.rejected.size(); ++k) {
    EXPECT_EQ(file.rejected[k].place(), refusals[k].first) << file.rejected[k].what();
    EXPECT_EQ(file.rejected[k].code(), refusals[k].second) << file.rejected[k].what();
  }
  expect_refusal(refusal_of([&] { read("b.ndjson", record(kSquare) + "{\n"); }), DataCode::json_syntax,
                 "line 2, column 2");
}

// GDAL takes these for GeoJSON of one feature, and says nothing of what follows.
TEST_F(VectorFile, WhatFollowsTheFirstLineOfASequenceIsNotLost) {
  ReadOptions options;
  options.keep_going = true;
  for (const std::string bad : {"[1, 2]", "x", "[[[[", "\x01{"}) {
    for (const char* name : {"a.ndjson", "a.geojson"}) {
      SCOPED_TRACE(bad + " in " + name);
      const ObstacleFile file = read(name, record(kSquare) + bad + "\n" + record(kSquare), options);
      EXPECT_EQ(file.obstacles.size(), 2u);
      ASSERT_EQ(file.rejected.size(), 1u);
      EXPECT_EQ(file.rejected[0].place().rfind("line 2", 0), 0u) << file.rejected[0].what();
    }
  }
  EXPECT_EQ(read("one.geojson", "\n" + record(kSquare) + "\n \n").counts.read, 1u);
}

std::string on_one_line(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
  return text;
}

TEST_F(VectorFile, RecordsNeedNoLinesOfTheirOwn) {
  const std::string one = on_one_line(record(kSquare));
  const std::string spread =
      "{\n\"type\": \"Feature\",\n\"properties\": {\"a\": \"}{\\\"\"},\n\"geometry\":\n" + std::string(kSquare) + "\n}";
  for (const std::string& text :
       {"\xef\xbb\xbf" + one + "\n" + one + "\n", one + one, one + " \t" + one + "\n", one + "\r" + one + "\r",
        one + "\r\n" + one, spread + "\n" + spread + "\n", spread + spread, "\xef\xbb\xbf\n" + spread + "\n" + one}) {
    for (const char* name : {"a.geojson", "a.json", "a.ndjson"}) {
      SCOPED_TRACE(std::string(name) + ": " + text);
      const ObstacleFile file = read(name, text);
      EXPECT_EQ(file.obstacles.size(), 2u);
      EXPECT_EQ(file.counts.read, 2u);
    }
  }
}

TEST_F(VectorFile, ABadRecordBehindAnotherIsNamedByItsColumn) {
  ReadOptions options;
  options.keep_going = true;
  const std::string good = on_one_line(record(kSquare));
  const std::string column = std::to_string(good.size() + 1);
  for (const char* bad : {R"({"type": "Poligon", "coordinates": []})", R"({"type": "Point", "coordinates": [1,,2]})"}) {
    const ObstacleFile file = read("a.geojson", good + bad + good + "\n", options);
    EXPECT_EQ(file.obstacles.size(), 2u);
    ASSERT_EQ(file.rejected.size(), 1u);
    EXPECT_EQ(file.rejected[0].place().rfind("line 1, column " + column, 0), 0u) << file.rejected[0].what();
  }
  const ObstacleFile spoilt = read("b.geojson", good + " x\n" + good, options);
  EXPECT_EQ(spoilt.obstacles.size(), 1u);
  EXPECT_EQ(spoilt.rejected.size(), 1u);
}

/// MB; the largest that this process ever was.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Whatever line ends there are, and wherever the collection says what it is.
TEST_F(VectorFile, MemoryDoesNotGrowWithACollectionOnOneLine) {
  const std::string feature = on_one_line(record(kSquare));
  std::size_t read_in_all = 0;
  const ObstacleStream stream{[&](const formation::SceneObstacle&, bool) { ++read_in_all; }, [](const DataError&) {},
                              [](double) {}};
  const auto peak_of = [&](std::size_t features) {
    {
      std::ofstream file(folder_ / "a.geojson");
      file << R"({"units": "m", "features": [)" << feature;
      for (std::size_t k = 1; k < features; ++k) file << "," << feature;
      file << R"(], "type": "FeatureCollection"})"
           << "\n";
    }
    read_in_all = 0;
    read_obstacles(folder_ / "a.geojson", {}, stream);
    EXPECT_EQ(read_in_all, features);
    return peak_memory();
  };
  const double small = peak_of(2'000);
  constexpr std::size_t kFeatures = 80'000;
  const double megabytes = static_cast<double>(kFeatures * feature.size()) / 1048576.0;
  EXPECT_LT(peak_of(kFeatures) - small, 0.5 * megabytes);
}

TEST_F(VectorFile, EntriesAmongFeaturesThatAreNoObjectsAreCountedAndTold) {
  ReadOptions options;
  options.keep_going = true;
  const std::string good = on_one_line(record(kSquare));
  const std::string text = R"({"features": [[)" + good + "], " + good + R"(, 5, "x,]{", null, true, -1.5e3, )" + good +
                           R"(], "type": "FeatureCollection", "more": [1, 2]})";
  const ObstacleFile file = read("a.geojson", text, options);
  EXPECT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(file.counts.read, 8u);
  ASSERT_EQ(file.rejected.size(), 6u);
  const char* const found[] = {"an array", "a number", "a string", "null", "true or false", "a number"};
  const char* const places[] = {"0", "2", "3", "4", "5", "6"};
  for (std::size_t k = 0; k < 6; ++k) {
    expect_refusal(file.rejected[k], DataCode::format_syntax, std::string("/features/") + places[k]);
    EXPECT_EQ(file.rejected[k].found(), found[k]);
  }
  EXPECT_EQ(read("b.geojson", R"({"type": "FeatureCollection", "features": [ ]})").counts.read, 0u);
}

TEST_F(VectorFile, AGeometryAmongFeaturesIsRefused) {
  const std::string text = R"({"type": "FeatureCollection", "features": [)" + std::string(kSquare) + "]}";
  expect_refusal(refusal_of([&] { read("a.geojson", text); }), DataCode::format_syntax, "feature 0");
}

TEST_F(VectorFile, MalformedWktInAColumnIsRefused) {
  for (const char* header : {"id,WKT\n", "id,geometry\n", "id,_WKTshape\n"}) {
    for (const char* text : {"\"POLYGON((0 0,1 0,1 1,0 0\"", "garbage", "\"POLYGON((0 0,1 0,x,0 0))\""}) {
      SCOPED_TRACE(std::string(header) + text);
      const std::string rows = "1,POLYGON EMPTY\n2,\n3," + std::string(text) + "\n";
      expect_refusal(refusal_of([&] { read("a.csv", header + rows); }), DataCode::format_syntax, "feature 2");
    }
  }
  EXPECT_EQ(read("a.csv", "id,WKT\n1,POLYGON EMPTY\n2,\n3,\"  \"\n4,POINT(1 2)\n").counts.passed_over, 4u);
}

TEST_F(VectorFile, ContentGoesBeforeTheName) {
  EXPECT_EQ(read("a.csv", "POLYGON ((0 0, 1 0, 1 1, 0 0))").format, "wkt");
  EXPECT_EQ(read("a.txt", "LINESTRING (0 0, 1 0)").format, "wkt");
  EXPECT_EQ(refusal_of([&] { read("a.xyz", "hello"); }).code(), DataCode::format_unknown);
  ReadOptions options;
  options.format = "nonsense";
  EXPECT_EQ(refusal_of([&] { read("b.wkt", "POINT EMPTY", options); }).code(), DataCode::not_an_option);
}

TEST(ObstacleFiles, AMissingFileIsNamed) {
  const DataError error = refusal_of([] { read_obstacles("/nowhere/a.wkt"); });
  EXPECT_EQ(error.code(), DataCode::file_missing);
  EXPECT_EQ(error.file(), "/nowhere/a.wkt");
}

TEST_F(VectorFile, TheOfficeIsInMetresAndSixRobotsCrossIt) {
  const formation::Scenario office =
      load_scenario(std::filesystem::path(EXACTVO_SOURCE_DIR) / "datasets/data/office/office.json");
  EXPECT_EQ(office.robots.size(), 6u);
  EXPECT_EQ(office.obstacles.size(), 46u);
  for (const formation::SceneObstacle& obstacle : office.obstacles) {
    for (const Vec2 p : geometry::vertices_of(obstacle.shape)) {
      EXPECT_TRUE(p.x >= 0.0 && p.x <= 30.0 && p.y >= 0.0 && p.y <= 20.0) << obstacle.id;
    }
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
