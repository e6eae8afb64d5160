// SPDX-License-Identifier: GPL-3.0-or-later
// The public maps and scenes of the formats that have no library: counts agree with what others counted.
#include <gtest/gtest.h>

#include "exactvo/datasets/obstacle_file.h"
#include "shared_data.h"

namespace exactvo::datasets::test {
namespace {

ObstacleFile read_all(const std::string& path, const std::string& format = "") {
  ReadOptions options;
  options.keep_going = true;
  options.format = format;
  return read_obstacles(shared_data() / path, options);
}

/// "symbols={'@': 38323, '.': 2765}": how many of `symbol`.
long symbol_count(const ManifestRow& row, char symbol) {
  const std::size_t at = row.what.find(std::string("'") + symbol + "': ", row.what.find("symbols="));
  return at == std::string::npos ? 0 : std::strtol(row.what.c_str() + at + 5, nullptr, 10);
}

std::size_t polygons_in(const ObstacleFile& file) {
  std::size_t count = 0;
  for (const formation::SceneObstacle& o : file.obstacles) count += geometry::has_interior(o.shape) ? 1 : 0;
  return count;
}

TEST(SharedFormats, MovingAiMapsHaveTheirBlockedCells) {
  EXACTVO_NEEDS_SHARED_DATA();
  std::size_t maps = 0;
  for (const ManifestRow& row : manifest_of({"movingai", "movingai-odd"})) {
    if (row.format != "movingai-map") continue;
    SCOPED_TRACE(row.path);
    const ObstacleFile file = read_all(row.path);
    ASSERT_TRUE(file.coverage.has_value());
    long blocked = 0;
    for (const char symbol : {'@', 'O', 'T', 'W'}) blocked += symbol_count(row, symbol);
    EXPECT_EQ(static_cast<long>(file.coverage->occupied), blocked);
    EXPECT_EQ(file.counts.rejected, 0u);
    ++maps;
  }
  EXPECT_GE(maps, 20u);
}

TEST(SharedFormats, RosMapsReadOrNameWhatIsMissing) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  std::size_t read = 0;
  for (const ManifestRow& row : manifest_of({"ros-map"})) {
    if (row.format != "ros-map-yaml") continue;
    SCOPED_TRACE(row.path);
    try {
      const ObstacleFile file = read_all(row.path);
      EXPECT_NE(row.what.find("image_exists=True"), std::string::npos);
      EXPECT_EQ(file.counts.rejected, 0u);
      const bool is_a_speed_mask = row.path.find("speed_mask") != std::string::npos;  // all of it is passable
      EXPECT_EQ(file.coverage->occupied == 0u, is_a_speed_mask);
      ++read;
    } catch (const DataError& error) {
      EXPECT_NE(row.what.find("image_exists=False"), std::string::npos) << error.what();
      EXPECT_EQ(error.code(), DataCode::image) << error.what();
    }
  }
  EXPECT_GE(read, 12u);
}

TEST(SharedFormats, OccupiedCellsOfRosMapsAreTheDarkPixels) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  // Pixel counts of the manifest that lie beyond the map's threshold.
  EXPECT_EQ(read_all("ros-map/aws_small_house/map.yaml").coverage->occupied, 3442u);
  EXPECT_EQ(read_all("ros-map/turtlebot3_world/map.yaml").coverage->occupied, 795u);
  EXPECT_EQ(read_all("ros-map/turtlebot_maze/maze.yaml").coverage->occupied, 1494u);
  EXPECT_EQ(read_all("ros-map/stdr_hospital/hospital_section.yaml").coverage->occupied, 74481u);
  EXPECT_EQ(read_all("ros-map/nav2_testmap/testmap.yaml").coverage->occupied, 29u);
  EXPECT_EQ(read_all("ros-map/nav2_speed_mask/speed_mask.yaml").coverage->occupied, 0u) << "128 is no obstacle";
}

TEST(SharedFormats, NegatedTwinsGiveTheSamePolygons) {
  EXACTVO_NEEDS_SHARED_DATA();
  const ObstacleFile one = read_all("ros-map/nav2_depot/depot.yaml");
  const ObstacleFile two = read_all("ros-map/nav2_depot/depot_negated.yaml");
  ASSERT_EQ(one.obstacles.size(), two.obstacles.size());
  EXPECT_EQ(one.coverage->occupied, 5947u);
  for (std::size_t k = 0; k < one.obstacles.size(); ++k) {
    EXPECT_EQ(geometry::vertices_of(one.obstacles[k].shape), geometry::vertices_of(two.obstacles[k].shape));
  }
}

/// Clockwise obstacles of Menge: closed walls.
std::size_t rooms_in(const ObstacleFile& file) {
  return static_cast<std::size_t>(
      std::count_if(file.obstacles.begin(), file.obstacles.end(), [&](const formation::SceneObstacle& o) {
        const auto* wall = std::get_if<geometry::Polyline>(&o.shape);
        return file.format == "menge-xml" && wall != nullptr && wall->points.front() == wall->points.back();
      }));
}

TEST(SharedFormats, CrowdScenesCount) {
  EXACTVO_NEEDS_SHARED_DATA();
  std::size_t files = 0;
  for (const ManifestRow& row : manifest_of({"menge-xml", "sumo-poly", "earcut-json", "opentraj-xml"})) {
    if (row.format != "menge-scene-xml" && row.format != "sumo-poly-xml" && row.format != "rings-json") continue;
    SCOPED_TRACE(row.path);
    const ObstacleFile file = read_all(row.path);
    EXPECT_EQ(static_cast<long>(polygons_in(file) + rooms_in(file) + file.counts.rejected), row.count("poly"));
    EXPECT_EQ(file.counts.read,
              file.counts.done + file.counts.repaired + file.counts.passed_over + file.counts.rejected);
    ++files;
  }
  EXPECT_GE(files, 35u);
}

TEST(SharedFormats, JuPedSimHolesAreSolidAndShellsAreWalls) {
  EXACTVO_NEEDS_SHARED_DATA();
  for (const ManifestRow& row : manifest_of({"jupedsim-wkt"})) {
    SCOPED_TRACE(row.path);
    const ObstacleFile file = read_all(row.path, "jupedsim-wkt");
    EXPECT_EQ(static_cast<long>(polygons_in(file) + file.counts.rejected), row.count("holes"));
    EXPECT_EQ(static_cast<long>(file.obstacles.size() - polygons_in(file)), row.count("poly"));
  }
  for (const ManifestRow& row : manifest_of({"jupedsim-xml"})) {
    const ObstacleFile file = read_all(row.path);
    EXPECT_EQ(static_cast<long>(file.obstacles.size()), row.count("polygons")) << row.path;
    EXPECT_EQ(static_cast<long>(geometry::vertices_of(file.obstacles[0].shape).size()), row.count("vertices"))
        << row.path;
  }
}

TEST(SharedFormats, BarnCylindersCountOnce) {
  EXACTVO_NEEDS_SHARED_DATA();
  for (const ManifestRow& row : manifest_of({"barn-world"})) {
    EXPECT_EQ(static_cast<long>(read_all(row.path).obstacles.size()), row.count("cylinders")) << row.path;
  }
}

TEST(SharedFormats, ScansAndPointsBecomeCells) {
  EXACTVO_NEEDS_SHARED_DATA();
  const ObstacleFile scan = read_all("laser-csm-json/stallo2.log");
  EXPECT_EQ(scan.format, "csm-log");
  // 1024 - 288 and 1024 - 380 readings are neither null nor invalid.
  bool counted = false;
  for (const DataNote& note : scan.notes) counted = counted || note.text == "1380 hits";
  EXPECT_TRUE(counted);
  const ObstacleFile points = read_all("points-csv/2D_oneBox.csv");
  EXPECT_EQ(points.format, "points-csv");
  EXPECT_EQ(points.notes.front().text, "361 hits");
  EXPECT_GT(points.coverage->occupied, 50u);
}

}  // namespace
}  // namespace exactvo::datasets::test
