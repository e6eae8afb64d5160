// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/obstacle_write.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exactvo/datasets/obstacle_file.h"
#include "refusal.h"
#include "same_scenario.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using ObstacleWrite = TemporaryFolder;

std::vector<formation::SceneObstacle> some_obstacles() {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(29));
  std::vector<formation::SceneObstacle> obstacles;
  for (int k = 0; k < 40; ++k) {
    const geometry::Vec2 at{30.0 * k, -1e-300};
    const auto near = [&](double x, double y) { return at + geometry::Vec2{x, y} + random.in_box(0.3); };
    if (k % 2 == 0) {
      obstacles.push_back({"w" + std::to_string(k), geometry::Polyline{{near(0, 0), near(5, 0), near(5, 5)}}});
    } else {
      obstacles.push_back({"s" + std::to_string(k), geometry::Polygon{{near(0, 0), near(9, 0), near(9, 9), near(0, 9)},
                                                                      {{near(2, 2), near(2, 4), near(4, 4)}}}});
    }
  }
  return obstacles;
}

TEST_F(ObstacleWrite, Property1_WktReadsBackBitForBit) {
  const auto obstacles = some_obstacles();
  write_obstacles(folder_ / "a.wkt", obstacles);
  const ObstacleFile file = read_obstacles(folder_ / "a.wkt");
  ASSERT_EQ(file.obstacles.size(), obstacles.size());
  EXPECT_EQ(file.counts.done, obstacles.size());
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    EXPECT_TRUE(same_bits(file.obstacles[k].shape, obstacles[k].shape)) << k;
}

/// The largest distance between corners, m; NaN where the shapes have other numbers of them.
double largest_move(const formation::SceneObstacle& a, const formation::SceneObstacle& b) {
  const std::vector<geometry::Vec2> from = geometry::vertices_of(a.shape);
  const std::vector<geometry::Vec2> to = geometry::vertices_of(b.shape);
  if (from.size() != to.size()) return std::numeric_limits<double>::quiet_NaN();
  double largest = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) largest = std::max(largest, norm(from[k] - to[k]));
  return largest;
}

TEST_F(ObstacleWrite, Property1_GeoJsonInDegreesReadsBackWithinTwentyNanometres) {
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  std::vector<formation::SceneObstacle> obstacles = some_obstacles();
  for (const geometry::Vec2 far : {geometry::Vec2{9e4, 0}, geometry::Vec2{0, -9e4}, geometry::Vec2{-6e4, 6e4}}) {
    geometry::Polyline line = std::get<geometry::Polyline>(obstacles[0].shape);
    for (geometry::Vec2& p : line.points) p = p + far;
    obstacles.push_back({"far", line});
  }
  for (const std::optional<ProjectionOrigin>& origin :
       {std::optional<ProjectionOrigin>(), std::optional<ProjectionOrigin>(ProjectionOrigin{13.4, 52.5}),
        std::optional<ProjectionOrigin>(ProjectionOrigin{-70.9, -41.25})}) {
    WriteOptions options;
    options.plane.origin = origin;
    write_obstacles(folder_ / "a.geojson", obstacles, options);
    const ObstacleFile file = read_obstacles(folder_ / "a.geojson");
    ASSERT_EQ(file.obstacles.size(), obstacles.size());
    EXPECT_EQ(file.origin.has_value(), origin.has_value());
    for (std::size_t k = 0; k < obstacles.size(); ++k)
      EXPECT_LT(largest_move(file.obstacles[k], obstacles[k]), 20e-9) << k;
  }
}

TEST_F(ObstacleWrite, Property1_GeoJsonInDegreesReadsBackBitForBitWhereMetresHaveFewDecimals) {
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(31));
  for (const double places : {1.0, 10.0, 1e3, 1e6}) {
    std::vector<formation::SceneObstacle> obstacles;
    for (int k = 0; k < 40; ++k) {
      const auto rounded = [&](double x) { return std::round(x * places) / places; };
      geometry::Polyline line;
      for (int i = 0; i < 3; ++i) {
        const geometry::Vec2 p = random.in_box(2000.0);
        line.points.push_back({rounded(p.x), rounded(p.y) + 5.0 * i});
      }
      for (geometry::Vec2& p : line.points) p = {rounded(p.x), rounded(p.y)};
      obstacles.push_back({std::to_string(k), line});
    }
    write_obstacles(folder_ / "a.geojson", obstacles);
    const ObstacleFile file = read_obstacles(folder_ / "a.geojson");
    ASSERT_EQ(file.obstacles.size(), obstacles.size());
    for (std::size_t k = 0; k < obstacles.size(); ++k)
      EXPECT_TRUE(same_bits(file.obstacles[k].shape, obstacles[k].shape)) << places << " " << k;
  }
}

TEST_F(ObstacleWrite, Property1_GeoJsonInMetresReadsBackBitForBit) {
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  const auto obstacles = some_obstacles();
  WriteOptions options;
  options.metres = true;
  write_obstacles(folder_ / "a.geojson", obstacles, options);
  const ObstacleFile file = read_obstacles(folder_ / "a.geojson");
  ASSERT_EQ(file.obstacles.size(), obstacles.size());
  EXPECT_FALSE(file.origin.has_value());
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    EXPECT_TRUE(same_bits(file.obstacles[k].shape, obstacles[k].shape)) << k;
}

TEST_F(ObstacleWrite, OtherExtensionsAreRefused) {
  EXPECT_EQ(refusal_of([&] { write_obstacles(folder_ / "a.dwg", {}); }).code(), DataCode::format_unknown);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST(Findings, EveryProblemIsListedAlsoOfRefusedObstacles) {
  ReadOptions options;
  options.keep_going = true;
  // Unclosed, clockwise and with a repeated vertex; then a bow tie whose other problems are repaired in vain.
  const ObstacleFile file =
      parse_wkt("POLYGON ((0 0, 0 1, 0 1, 1 1, 1 0))\nPOLYGON ((0 0, 2 2, 2 2, 2 0, 0 2))", "t.wkt", options);
  EXPECT_EQ(file.counts.repaired, 1u);
  EXPECT_EQ(file.counts.rejected, 1u);
  const auto count = [&](DataCode code, bool repaired) {
    return std::count_if(file.findings.begin(), file.findings.end(),
                         [&](const RingFinding& f) { return f.code == code && f.repaired == repaired; });
  };
  EXPECT_EQ(count(DataCode::clockwise, true), 1);
  EXPECT_EQ(count(DataCode::unclosed, true), 2);
  EXPECT_EQ(count(DataCode::repeated_vertex, true), 2);
  EXPECT_EQ(count(DataCode::self_intersection, false), 1);
  for (const RingFinding& finding : file.findings) {
    if (finding.code == DataCode::self_intersection) {
      EXPECT_EQ(finding.where, (geometry::Vec2{1, 1}));
    }
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
