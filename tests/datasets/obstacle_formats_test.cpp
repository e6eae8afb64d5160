// SPDX-License-Identifier: GPL-3.0-or-later
// Every writable format: what is written reads back, bit for bit but for what the format can't hold, and that is said.
#include <gtest/gtest.h>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/obstacle_write.h"
#include "refusal.h"
#include "same_scenario.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using formation::SceneObstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::Vec2;

/// Walls and polygons, some with holes, of odd doubles, far apart.
std::vector<SceneObstacle> some_obstacles(bool with_walls, bool with_holes) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(107));
  std::vector<SceneObstacle> obstacles;
  for (int k = 0; k < 12; ++k) {
    const Vec2 at{30.0 * k + 4e6, -1e-300};
    const auto near = [&](double x, double y) { return at + Vec2{x, y} + random.in_box(0.3); };
    const std::string id = "id \"" + std::to_string(k) + "\" <&>, \xc3\xa9";
    if (with_walls && k % 3 == 0) {
      obstacles.push_back({id, Polyline{{near(0, 0), near(5, 0), near(5, 5)}}});
      continue;
    }
    Polygon polygon{{near(0, 0), near(9, 0), near(9, 9), near(0, 9)}, {}};
    if (with_holes) polygon.holes = {{near(2, 2), near(2, 4), near(4, 4)}};
    obstacles.push_back({id, polygon});
  }
  return obstacles;
}

struct Format {
  const char* name;
  const char* file;
  bool walls;
  bool holes;
  bool several;
};

void PrintTo(const Format& format, std::ostream* out) {
  *out << format.name;
}

class EveryFormat : public TemporaryFolder, public ::testing::WithParamInterface<Format> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("exactvo_format_" + std::string(GetParam().name) + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  bool can_be_tested() const {
    const bool needs_gdal = std::string(GetParam().name) != "wkt" && std::string(GetParam().name) != "rings-json" &&
                            std::string(GetParam().name) != "menge-xml" && std::string(GetParam().name) != "sumo-poly";
    return built_with_gdal() || !needs_gdal;
  }
  std::vector<SceneObstacle> fitting() const {
    std::vector<SceneObstacle> obstacles = some_obstacles(GetParam().walls, GetParam().holes);
    if (!GetParam().several) obstacles.resize(1);
    return obstacles;
  }
};

TEST_P(EveryFormat, Property1_ReadsBackBitForBit) {
  if (!can_be_tested()) GTEST_SKIP() << "built without GDAL";
  const std::vector<SceneObstacle> obstacles = fitting();
  const std::filesystem::path path = folder_ / GetParam().file;
  WriteOptions options;
  options.format = GetParam().name;
  options.metres = true;  // through degrees: obstacle_write_test.cpp
  for (const std::string& loss : write_obstacles(path, obstacles, options))
    EXPECT_EQ(loss.find("hole"), std::string::npos) << loss;
  const ObstacleFile file = read_obstacles(path);
  ASSERT_EQ(file.obstacles.size(), obstacles.size());
  EXPECT_FALSE(file.origin.has_value());
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    EXPECT_TRUE(same_bits(file.obstacles[k].shape, obstacles[k].shape)) << k;
}

TEST_P(EveryFormat, Property2_LossesAreNamed) {
  if (!can_be_tested()) GTEST_SKIP() << "built without GDAL";
  std::vector<SceneObstacle> obstacles = some_obstacles(false, true);
  if (!GetParam().several) obstacles.resize(1);
  std::string all;
  for (const std::string& loss : write_obstacles(folder_ / GetParam().file, obstacles, {GetParam().name})) all += loss;
  EXPECT_EQ(all.find("12 holes filled") != std::string::npos, !GetParam().holes) << all;
}

TEST_P(EveryFormat, Property3_TheSameObstaclesAreTheSameBytes) {
  if (!can_be_tested()) GTEST_SKIP() << "built without GDAL";
  const std::vector<SceneObstacle> obstacles = fitting();
  const std::string name = GetParam().file;
  write_obstacles(folder_ / ("1" + name), obstacles, {GetParam().name});
  write_obstacles(folder_ / ("2" + name), obstacles, {GetParam().name});
  EXPECT_EQ(content_of(folder_ / ("1" + name)), content_of(folder_ / ("2" + name)));
  EXPECT_FALSE(content_of(folder_ / ("1" + name)).empty());
}

// Walls that end where they begin came back from SUMO as polygons, without a word.
TEST_P(EveryFormat, Property4_AClosedWallStaysOneOrIsNamed) {
  if (!can_be_tested() || !GetParam().walls) GTEST_SKIP() << "no such format, or none with walls";
  const std::vector<SceneObstacle> wall{{"a", Polyline{{{0, 0}, {4, 0}, {4, 4}, {0, 0}}}}};
  WriteOptions options;
  options.format = GetParam().name;
  options.metres = true;
  std::string all;
  for (const std::string& loss : write_obstacles(folder_ / GetParam().file, wall, options)) all += loss;
  const ObstacleFile file = read_obstacles(folder_ / GetParam().file);
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_NE(same_bits(file.obstacles[0].shape, wall[0].shape),
            all.find("1 closed wall made solid") != std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, EveryFormat,
    ::testing::Values(Format{"wkt", "a.wkt", true, true, true}, Format{"geojson", "a.geojson", true, true, true},
                      Format{"gpkg", "a.gpkg", true, true, true}, Format{"fgb", "a.fgb", true, true, true},
                      Format{"csv", "a.csv", true, true, true}, Format{"rings-json", "a.json", false, true, false},
                      Format{"menge-xml", "a.xml", true, false, true},
                      Format{"sumo-poly", "a.poly.xml", true, false, true}),
    [](const auto& each) {
      std::string name = each.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

using ObstacleFormats = TemporaryFolder;

TEST_F(ObstacleFormats, TheExtensionSaysTheFormatWhateverItsCase) {
  EXPECT_EQ(format_to_write("x/A.WKT"), "wkt");
  EXPECT_EQ(format_to_write("a.json"), "geojson");
  EXPECT_EQ(format_to_write("a.poly.xml"), "sumo-poly");
  EXPECT_EQ(format_to_write("a.xml", "menge-xml"), "menge-xml");
  EXPECT_EQ(refusal_of([] { format_to_write("a.xml"); }).code(), DataCode::format_unknown);
  EXPECT_EQ(refusal_of([] { format_to_write("a.wkt", "shp"); }).code(), DataCode::not_an_option);
}

TEST_F(ObstacleFormats, RingsJsonHoldsOnePolygonAndNothingIsHalfWritten) {
  const auto obstacles = some_obstacles(true, true);
  EXPECT_EQ(refusal_of([&] { write_obstacles(folder_ / "a.json", obstacles, {"rings-json"}); }).code(),
            DataCode::wrong_count);
  EXPECT_EQ(refusal_of([&] { write_obstacles(folder_ / "no.json/b.json", obstacles, {"sumo-poli"}); }).code(),
            DataCode::not_an_option);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(ObstacleFormats, NothingAtAllIsAFileOfEveryFormatThatHoldsSeveral) {
  for (const std::string& format : writable_formats()) {
    if (format == "rings-json" || format == "fgb") {
      EXPECT_EQ(refusal_of([&] { write_obstacles(folder_ / "none", {}, {format}); }).code(), DataCode::wrong_count);
      continue;
    }
    write_obstacles(folder_ / "empty", {}, {format});
    EXPECT_FALSE(content_of(folder_ / "empty").empty() && format != "wkt") << format;
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
