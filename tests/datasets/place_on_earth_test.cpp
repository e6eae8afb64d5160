// SPDX-License-Identifier: GPL-3.0-or-later
// Where on earth files lie: across the antimeridian, far apart, in reference systems that do not keep lengths, and with
// an SRID before well-known text.
#include <cmath>
#include <numeric>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/datasets/repair.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using geometry::Polygon;
using geometry::Ring;
using geometry::Vec2;

class PlaceOnEarth : public TemporaryFolder {
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

std::string positions(const Ring& ring) {
  std::string text;
  for (const Vec2 p : ring)
    text += (text.empty() ? "[" : ", [") + std::to_string(p.x) + ", " + std::to_string(p.y) + "]";
  return "[" + text + "]";
}

Ring rectangle(Vec2 low, Vec2 high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}, low};
}

std::string multi_polygon(const std::vector<Ring>& rings, const std::string& members = "") {
  std::string parts;
  for (const Ring& ring : rings) parts += (parts.empty() ? "[" : ", [") + positions(ring) + "]";
  return R"({"type": "FeatureCollection", )" + members +
         R"("features": [{"type": "Feature", "properties": {}, "geometry": {"type": "MultiPolygon", "coordinates": [)" +
         parts + "]}}]}";
}

std::string named(const std::string& system) {
  return R"("crs": {"type": "name", "properties": {"name": ")" + system + R"("}}, )";
}

double area_of(const ObstacleFile& file) {
  return std::accumulate(file.obstacles.begin(), file.obstacles.end(), 0.0,
                         [](double sum, const auto& o) { return sum + area(std::get<Polygon>(o.shape)); });
}

/// 0.001 by 0.002 degrees at 10 north, on WGS 84, m^2.
constexpr double kPart = 24254.0;

// --- Across the antimeridian ---

std::vector<Ring> parts_round(double longitude) {
  const double west = longitude > 180.0 ? longitude - 360.0 : longitude;
  return {rectangle({longitude - 0.001, 10.0}, {longitude, 10.002}),
          rectangle({west == 180.0 ? -180.0 : west, 10.0}, {west == 180.0 ? -179.999 : west + 0.001, 10.002})};
}

TEST_F(PlaceOnEarth, PartsOnBothSidesOfTheAntimeridianAreNeighbours) {
  const ObstacleFile there = read("a.geojson", multi_polygon(parts_round(100.0)));
  const ObstacleFile across = read("b.geojson", multi_polygon(parts_round(180.0)));
  ASSERT_EQ(across.obstacles.size(), 2u);
  EXPECT_NEAR(area_of(there), 2 * kPart, 5.0);
  EXPECT_NEAR(area_of(across), area_of(there), 0.001);
  ASSERT_TRUE(across.origin && across.extent);
  EXPECT_EQ(std::fabs(across.origin->longitude), 180.0);
  EXPECT_NEAR(across.extent->high.x - across.extent->low.x, there.extent->high.x - there.extent->low.x, 0.001);
  for (const std::size_t k : {0u, 1u}) {  // the file's order, and its mirror
    std::vector<Ring> parts = parts_round(180.0);
    if (k == 1) std::swap(parts[0], parts[1]);
    EXPECT_NEAR(area_of(read("c.geojson", multi_polygon(parts))), 2 * kPart, 5.0);
  }
}

TEST_F(PlaceOnEarth, TheCentreIsTheMiddleOnTheCircleOfLongitudes) {
  const auto centre = [&](double west, double east) {
    return read("a.geojson", multi_polygon({rectangle({west, 10.0}, {west + 0.001, 10.001}),
                                            rectangle({east - 0.001, 10.0}, {east, 10.001})}))
        .origin->longitude;
  };
  EXPECT_NEAR(centre(177.0, -179.0), 179.0, 1e-6);
  EXPECT_NEAR(centre(179.0, -177.0), -179.0, 1e-6);
  EXPECT_NEAR(centre(-179.0, -177.0), -178.0, 1e-6);
  EXPECT_NEAR(centre(-2.0, 1.0), -0.5, 1e-6);
}

TEST_F(PlaceOnEarth, WhatIsWrittenAcrossTheAntimeridianIsReadBack) {
  const ObstacleFile file = read("a.geojson", multi_polygon(parts_round(180.0)));
  write_obstacles(folder_ / "b.geojson", file.obstacles, {"", file.plane, false, {}});
  const std::string written = content_of(folder_ / "b.geojson");
  EXPECT_NE(written.find("-179.999"), std::string::npos);
  EXPECT_NE(written.find("[-180,"), std::string::npos) << written;
  EXPECT_NEAR(area_of(read_obstacles(folder_ / "b.geojson")), area_of(file), 1e-3);
  ReadOptions plain;  // as other programs take its numbers
  plain.units = Units::metres;
  for (const formation::SceneObstacle& o : read_obstacles(folder_ / "b.geojson", plain).obstacles)
    EXPECT_NEAR(area(std::get<Polygon>(o.shape)), 2e-6, 1e-9);
}

TEST_F(PlaceOnEarth, AShapeThatCrossesTheAntimeridianIsWrittenInOnePiece) {
  const Polygon wide{{{-300, -100}, {300, -100}, {300, 100}, {-300, 100}}, {{{100, -50}, {100, 50}, {200, 50}}}};
  WriteOptions options;
  options.plane.origin = ProjectionOrigin{180.0, 10.0};
  write_obstacles(folder_ / "a.geojson", {{"0", wide}}, options);
  const ObstacleFile file = read_obstacles(folder_ / "a.geojson");
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_TRUE(file.findings.empty());
  EXPECT_NEAR(area_of(file), area(wide), 1e-3);
  options.metres = false;
  ReadOptions plain;
  plain.units = Units::metres;
  const ObstacleFile numbers = read_obstacles(folder_ / "a.geojson", plain);
  EXPECT_LT(numbers.extent->high.x - numbers.extent->low.x, 0.01);
}

TEST_F(PlaceOnEarth, AnEdgeTheLongWayRoundIsRefused) {
  const DataError error = refusal_of([&] {
    read("a.geojson", multi_polygon({rectangle({-179.999, 10.0}, {179.999, 10.002})}));
  });
  EXPECT_EQ(error.code(), DataCode::projection);
  EXPECT_NE(error.expected().find("at the antimeridian each shape"), std::string::npos) << error.what();
}

// --- Far apart ---

TEST_F(PlaceOnEarth, DistortionIsReportedAndBounded) {
  double before = 0.0;
  for (const double apart : {0.01, 1.0, 5.0, 20.0}) {
    const ObstacleFile file = read("a.geojson", multi_polygon({rectangle({0.0, 45.0}, {0.001, 45.001}),
                                                               rectangle({apart, 45.0}, {apart + 0.001, 45.001})}));
    ASSERT_TRUE(file.distortion);
    EXPECT_TRUE(file.distortion->certified);
    const double alone = area_of(read("b.geojson", multi_polygon({rectangle({0.0, 45.0}, {0.001, 45.001})})));
    EXPECT_GE(area_of(file), 2 * alone * (1 - 1e-9));
    EXPECT_LE(area_of(file), 2 * alone * (1 + file.distortion->area + 1e-9));
    EXPECT_LT(file.distortion->area, 1.1 * (area_of(file) / (2 * alone) - 1.0) + 1e-8);  // and not much too large
    EXPECT_GT(file.distortion->length, before);
    before = file.distortion->length;
    EXPECT_NE(file.notes.back().text.find("lengths and areas are at most "), std::string::npos);
  }
}

TEST_F(PlaceOnEarth, FeaturesTooFarApartAreRefused) {
  for (const double apart : {40.0, 80.0, 160.0}) {
    const std::string text =
        multi_polygon({rectangle({0.0, 45.0}, {0.001, 45.001}), rectangle({apart, 45.0}, {apart + 0.001, 45.001})});
    const DataError error = refusal_of([&] { read("a.geojson", text); });
    EXPECT_EQ(error.code(), DataCode::projection);
    EXPECT_NE(error.expected().find("split the file"), std::string::npos) << error.what();
    ReadOptions options;
    options.keep_going = true;
    EXPECT_EQ(refusal_of([&] { read("a.geojson", text, options); }).code(), DataCode::projection);
    options.units = Units::metres;
    EXPECT_EQ(read("a.geojson", text, options).obstacles.size(), 2u);
  }
}

TEST_F(PlaceOnEarth, RoundAPoleTheCentreIsThePole) {
  const ObstacleFile file = read(
      "a.geojson", multi_polygon({rectangle({-170.0, 88.0}, {-169.9, 88.01}), rectangle({-50.0, 88.0}, {-49.9, 88.01}),
                                  rectangle({70.0, 88.0}, {70.1, 88.01})}));
  EXPECT_EQ(file.origin->latitude, 90.0);
  EXPECT_LT(file.distortion->length, 3e-4);
}

// --- Reference systems ---

TEST_F(PlaceOnEarth, WebMercatorBecomesMetres) {
  const Vec2 low{1491681.0, 6891042.0};  // 13.4 east, 52.5 north
  const ObstacleFile file =
      read("a.geojson", multi_polygon({rectangle(low, low + Vec2{100, 100})}, named("EPSG:3857")));
  EXPECT_NEAR(area_of(file), 3707.0, 15.0);
  EXPECT_EQ(file.projected_from, "WGS 84 / Pseudo-Mercator");
  EXPECT_NEAR(file.origin->latitude, 52.5, 0.01);
  EXPECT_NE(file.notes.front().text.find("does not keep lengths"), std::string::npos) << file.notes.front().text;
  ReadOptions options;
  options.units = Units::metres;
  EXPECT_NEAR(
      area_of(read("a.geojson", multi_polygon({rectangle(low, low + Vec2{100, 100})}, named("EPSG:3857")), options)),
      1e4, 1e-3);
}

TEST_F(PlaceOnEarth, WebMercatorAtTheEquatorStaysAsItIs) {
  const ObstacleFile file =
      read("a.geojson", multi_polygon({rectangle({1e6, -50.0}, {1e6 + 100, 50.0})}, named("EPSG:3857")));
  EXPECT_FALSE(file.origin);
  EXPECT_NEAR(file.distortion->length, 0.0067, 0.0002);  // along the meridian by e^2: its formulas are a sphere's
  EXPECT_FALSE(file.distortion->certified);
}

TEST_F(PlaceOnEarth, SystemsThatKeepLengthsStayWithTheirDistortion) {
  struct Kept {
    const char* system;
    Vec2 low;
    double length;  ///< how far it is from the ground there
  };
  // UTM on its meridian and at a zone's edge on the equator, Gauss-Krueger, New York in feet, Lambert-93.
  for (const Kept& kept :
       {Kept{"EPSG:32633", {500000.0, 5800000.0}, 4e-4}, Kept{"EPSG:32633", {833900.0, 100.0}, 9.8e-4},
        Kept{"EPSG:31468", {4500000.0, 5800000.0}, 0.0}, Kept{"EPSG:2263", {980000.0, 200000.0}, 1e-5},
        Kept{"EPSG:2154", {700000.0, 6600000.0}, 9e-4}}) {
    SCOPED_TRACE(kept.system);
    const ObstacleFile file =
        read("a.geojson", multi_polygon({rectangle(kept.low, kept.low + Vec2{100, 100})}, named(kept.system)));
    EXPECT_FALSE(file.origin);
    ASSERT_TRUE(file.distortion);
    EXPECT_NEAR(file.distortion->length, kept.length, 1e-4);
    EXPECT_NEAR(file.distortion->area, 2 * file.distortion->length, 1e-5);
  }
}

TEST_F(PlaceOnEarth, EquidistantCylindersBecomeMetres) {
  const Vec2 low{1491681.0, 5844273.0};  // 13.4 east, 52.5 north, on the sphere of the projection
  const ObstacleFile file =
      read("a.geojson", multi_polygon({rectangle(low, low + Vec2{100, 100})}, named("EPSG:4087")));
  ASSERT_TRUE(file.origin);
  EXPECT_NEAR(area_of(file), 1e4 * std::cos(52.5 * 3.14159265358979 / 180.0), 80.0);
}

TEST_F(PlaceOnEarth, GradsFromParisBecomeMetres) {
  const std::vector<Ring> square{rectangle({0.0, 52.0}, {0.001, 52.001})};  // at Paris: 2.3372 east, 46.8 north
  const ObstacleFile file = read("a.geojson", multi_polygon(square, named("EPSG:4807")));
  ASSERT_TRUE(file.origin);
  EXPECT_NEAR(file.origin->longitude, 2.3377, 1e-3);
  EXPECT_NEAR(file.origin->latitude, 46.8, 1e-2);
  EXPECT_NEAR(area_of(file), 100.06 * 68.6, 50.0);
}

TEST_F(PlaceOnEarth, APlaneOfOnesOwnMustKeepLengthsToo) {
  const std::vector<Ring> square{rectangle({13.4, 52.5}, {13.401, 52.501})};
  const auto member = [](const char* system) {
    return std::string(R"("local_metres": {"reference_system": ")") + system + R"("}, )";
  };
  EXPECT_TRUE(read("a.geojson", multi_polygon(square, member("EPSG:32633"))).distortion);
  expect_refusal(refusal_of([&] { read("a.geojson", multi_polygon(square, member("EPSG:3857"))); }),
                 DataCode::projection, "/local_metres/reference_system");
}

TEST_F(PlaceOnEarth, CoordinatesFromTheMiddleOfTheEarthAreRefused) {
  const std::string text = multi_polygon({rectangle({4e6, 1e6}, {4e6 + 100, 1e6 + 100})}, named("EPSG:4978"));
  EXPECT_EQ(refusal_of([&] { read("a.geojson", text); }).code(), DataCode::projection);
}

// --- SRID before well-known text ---

const char* const kSquare = "POLYGON((13.4 52.5, 13.401 52.5, 13.401 52.501, 13.4 52.501, 13.4 52.5))";
constexpr double kSquareArea = 7557.0;

TEST_F(PlaceOnEarth, AnSridIsReadWhereverWktIs) {
  const std::string text = std::string("SRID=4326;") + kSquare;
  const ObstacleFile wkt = read("a.wkt", text + "\n" + text + "\nSRID=4326;POINT(13.4 52.5)\n");
  EXPECT_EQ(wkt.format, "wkt");
  ASSERT_EQ(wkt.obstacles.size(), 2u);
  EXPECT_EQ(wkt.counts.passed_over, 1u);
  EXPECT_NEAR(area_of(wkt), 2 * kSquareArea, 20.0);
  EXPECT_EQ(wkt.notes.front().text.rfind("degrees: by SRID=4326; brought to metres round longitude 13.4005", 0), 0u);
  EXPECT_NEAR(area_of(read("a.csv", "id,WKT\n1,\"" + text + "\"\n")), kSquareArea, 10.0);
  EXPECT_NEAR(area_of(parse_wkt(text, "text")), kSquareArea, 10.0);
  EXPECT_NEAR(area_of(read("a.xml", "<run><case><a>" + text + "</a></case></run>")), kSquareArea, 10.0);
  ReadOptions options;
  options.format = "jupedsim-wkt";
  EXPECT_TRUE(read("b.wkt", text, options).origin);
  const ObstacleFile mercator = read(
      "c.wkt", "SRID=3857;POLYGON((1491681 6891042,1491781 6891042,1491781 6891142,1491681 6891142,1491681 6891042))");
  EXPECT_NEAR(area_of(mercator), 3707.0, 15.0);
  EXPECT_FALSE(
      read("d.wkt", "SRID=32633;POLYGON((500000 5800000,500100 5800000,500100 5800100,500000 5800000))").origin);
}

/// As PostGIS prints geometries: little-endian, with the flag of an SRID.
std::string hexadecimal(int srid) {
  std::string bytes("\x01\x03\x00\x00\x20", 5);
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(srid);
  append(std::uint32_t{1});
  append(std::uint32_t{5});
  for (const Vec2 p : rectangle({13.4, 52.5}, {13.401, 52.501})) {
    append(p.x);
    append(p.y);
  }
  std::string text;
  for (const char c : bytes) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += digits;
  }
  return text;
}

TEST_F(PlaceOnEarth, AnSridIsReadFromBinaryToo) {
  EXPECT_NEAR(area_of(read("a.csv", "id,WKT\n1," + hexadecimal(4326) + "\n")), kSquareArea, 10.0);
  EXPECT_NEAR(area_of(read("a.xml", "<run><case><a>" + hexadecimal(4326) + "</a></case></run>")), kSquareArea, 10.0);
}

TEST_F(PlaceOnEarth, SridZeroIsNone) {
  const std::string text = std::string("SRID=0;") + kSquare;
  for (const ObstacleFile& file : {read("a.wkt", text), read("a.csv", "id,WKT\n1,\"" + text + "\"\n")}) {
    EXPECT_FALSE(file.origin);
    EXPECT_NEAR(area_of(file), 1e-6, 1e-9);
  }
  ReadOptions options;
  options.units = Units::metres;
  EXPECT_NEAR(area_of(read("b.wkt", std::string("SRID=4326;") + kSquare, options)), 1e-6, 1e-9);
  EXPECT_NEAR(area_of(read("b.csv", std::string("id,WKT\n1,\"SRID=4326;") + kSquare + "\"\n", options)), 1e-6, 1e-9);
}

TEST_F(PlaceOnEarth, OneReferenceSystemAFile) {
  const std::string degrees = std::string("SRID=4326;") + kSquare, plain = kSquare;
  ReadOptions options;
  options.keep_going = true;
  for (const auto& [first, second] :
       {std::pair{degrees, plain}, std::pair{plain, degrees}, std::pair{degrees, "SRID=32633;" + plain}}) {
    const std::string table = "id,WKT\n1,\"" + first + "\"\n2,\"" + second + "\"\n";
    for (const ObstacleFile& file :
         {read("a.wkt", first + "\n" + second + "\n", options), read("a.csv", table, options)}) {
      EXPECT_EQ(file.obstacles.size(), 1u);
      ASSERT_EQ(file.rejected.size(), 1u);
      EXPECT_EQ(file.rejected[0].code(), DataCode::projection) << file.rejected[0].what();
    }
    EXPECT_EQ(refusal_of([&] { read("b.wkt", first + "\n" + second + "\n"); }).code(), DataCode::projection);
  }
}

TEST_F(PlaceOnEarth, UnknownSridsAreRefused) {
  for (const char* text : {"SRID=999999;", "SRID=-7;", "SRID=1.5;", "SRID=x;"})
    EXPECT_NE(refusal_of([&] { read("a.wkt", text + std::string(kSquare)); }).what(), std::string()) << text;
  EXPECT_EQ(refusal_of([&] { read("a.wkt", std::string("SRID=999999;") + kSquare); }).code(), DataCode::projection);
  EXPECT_EQ(refusal_of([&] { read("a.csv", std::string("id,WKT\n1,\"SRID=999999;") + kSquare + "\"\n"); }).code(),
            DataCode::projection);
}

// --- Shapefiles ---

template <class T>
void put_big(std::string& bytes, T value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>((static_cast<std::uint32_t>(value) >> shift) & 0xff);
}

template <class T>
void put_little(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The header of .shp and .shx; lengths are in words of two bytes.
std::string shape_header(std::size_t bytes) {
  std::string head;
  put_big(head, 9994);
  for (int k = 0; k < 5; ++k) put_big(head, 0);
  put_big(head, (100 + bytes) / 2);
  put_little(head, std::int32_t{1000});
  put_little(head, std::int32_t{5});  // polygons
  for (const double x : {-100.0, -100.0, 100.0, 100.0, 0.0, 0.0, 0.0, 0.0}) put_little(head, x);
  return head;
}

class Shapefile : public PlaceOnEarth {
 protected:
  /// One record with these rings.
  ObstacleFile read_shape(const std::vector<Ring>& rings, const ReadOptions& options = {}) const {
    std::string body;
    put_little(body, std::int32_t{5});
    for (const double x : {-100.0, -100.0, 100.0, 100.0}) put_little(body, x);
    std::size_t points = 0;
    for (const Ring& ring : rings) points += ring.size();
    put_little(body, static_cast<std::int32_t>(rings.size()));
    put_little(body, static_cast<std::int32_t>(points));
    std::int32_t start = 0;
    for (const Ring& ring : rings) {
      put_little(body, start);
      start += static_cast<std::int32_t>(ring.size());
    }
    for (const Ring& ring : rings) {
      for (const Vec2 p : ring) {
        put_little(body, p.x);
        put_little(body, p.y);
      }
    }
    std::string record, index;
    put_big(record, 1);
    put_big(record, body.size() / 2);
    put_big(index, 50);
    put_big(index, body.size() / 2);
    put("a.shx", shape_header(index.size()) + index);
    return read_obstacles(put("a.shp", shape_header(record.size() + body.size()) + record + body), options);
  }
};

Ring clockwise(double half) {
  return {{-half, -half}, {-half, half}, {half, half}, {half, -half}, {-half, -half}};
}

Ring counter_clockwise(double half) {
  const Ring ring = clockwise(half);
  return {ring.rbegin(), ring.rend()};
}

std::string codes_of(const ObstacleFile& file) {
  std::string text;
  for (const RingFinding& f : file.findings)
    text += code_name(f.code) + ("@" + std::to_string(f.ring)) + (f.repaired ? " " : "! ");
  return text;
}

TEST_F(Shapefile, RingsWoundAsTheFormatDemandsAreRight) {
  ReadOptions repairing;
  repairing.repair = true;
  for (const ReadOptions& options : {ReadOptions{}, repairing}) {
    for (const auto& rings : {std::vector<Ring>{clockwise(10)}, std::vector<Ring>{clockwise(10), counter_clockwise(5)},
                              std::vector<Ring>{counter_clockwise(5), clockwise(10)}}) {
      const ObstacleFile file = read_shape(rings, options);
      ASSERT_EQ(file.obstacles.size(), 1u);
      EXPECT_EQ(codes_of(file), "");
      EXPECT_EQ(file.counts.done, 1u);
      EXPECT_TRUE(file.repairs.empty());
      for (const DataNote& note : file.notes)
        EXPECT_EQ(note.text.find("Simple Geometry"), std::string::npos) << "GDAL, that it kept the rings apart";
      EXPECT_EQ(area_of(file), rings.size() == 1 ? 400.0 : 300.0);
    }
  }
}

TEST_F(Shapefile, RingsWoundAgainstTheFormatAreRepairedAndReported) {
  EXPECT_EQ(codes_of(read_shape({counter_clockwise(10)})), "E_CLOCKWISE@0 ");
  const ObstacleFile both = read_shape({counter_clockwise(10), counter_clockwise(5)});
  EXPECT_EQ(both.obstacles.size(), 1u);
  EXPECT_EQ(area_of(both), 300.0);
  EXPECT_EQ(codes_of(both), "E_CLOCKWISE@0 ");
  const ObstacleFile island = read_shape({counter_clockwise(10), counter_clockwise(5), counter_clockwise(2)});
  EXPECT_EQ(island.obstacles.size(), 2u);
  EXPECT_EQ(area_of(island), 316.0);
}

TEST_F(Shapefile, IslandsInHolesAreOuterRings) {
  const ObstacleFile file = read_shape({clockwise(20), clockwise(5), counter_clockwise(10), counter_clockwise(2)});
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(codes_of(file), "");
  EXPECT_EQ(area_of(file), 1600.0 - 400.0 + 100.0 - 16.0);
}

}  // namespace
}  // namespace exactvo::datasets::test
