// SPDX-License-Identifier: GPL-3.0-or-later
// The public vector files: each loads or is refused with a code, and the counts agree with what others counted.
#include <gtest/gtest.h>

#include "exactvo/datasets/obstacle_file.h"
#include "shared_data.h"

namespace exactvo::datasets::test {
namespace {

ObstacleFile read_all(const ManifestRow& row) {
  ReadOptions options;
  options.keep_going = true;
  return read_obstacles(shared_data() / row.path, options);
}

long vertices_with_closure(const ObstacleFile& file) {
  long count = 0;
  for (const formation::SceneObstacle& obstacle : file.obstacles) {
    if (const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape)) {
      count += static_cast<long>(polygon->outer.size()) + 1;
      for (const geometry::Ring& hole : polygon->holes) count += static_cast<long>(hole.size()) + 1;
    }
  }
  return count;
}

void expect_books_balanced(const ObstacleFile& file) {
  const ReadCounts& n = file.counts;
  EXPECT_EQ(n.read, n.done + n.repaired + n.passed_over + n.rejected);
  EXPECT_EQ(n.done + n.repaired, file.obstacles.size());
  EXPECT_EQ(n.rejected, file.rejected.size());
}

/// In metres on the earth, or, where a file reaches too far for that, its numbers as they stand.
ObstacleFile read_or_count(const ManifestRow& row, std::size_t& too_far) {
  try {
    return read_all(row);
  } catch (const DataError& error) {
    EXPECT_EQ(error.code(), DataCode::projection) << error.what();
    ++too_far;
    ReadOptions options;
    options.keep_going = true;
    options.units = Units::metres;
    return read_obstacles(shared_data() / row.path, options);
  }
}

TEST(SharedVectors, PolygonsCountAsInTheManifest) {
  EXACTVO_NEEDS_SHARED_DATA();
  std::vector<std::string> folders{"wkt-georust", "wkt-jts", "wkt-osm", "wkt-rvo2"};
  if (built_with_gdal()) {
    for (const char* more : {"geojson-nasty", "geojson-naturalearth", "geojson-osm", "geojson-polyclip"})
      folders.push_back(more);
  }
  std::size_t files = 0, too_far = 0;
  for (const ManifestRow& row : manifest_of(folders)) {
    SCOPED_TRACE(row.path);
    const ObstacleFile file = read_or_count(row, too_far);
    expect_books_balanced(file);
    std::size_t polygons = 0;
    for (const formation::SceneObstacle& o : file.obstacles) polygons += geometry::has_interior(o.shape) ? 1 : 0;
    if (const auto stated = row.count("poly")) {
      EXPECT_EQ(static_cast<long>(polygons + file.counts.rejected), *stated);
    }
    const bool untouched = file.counts.rejected == 0 && row.count("rings_with_consecutive_dups").value_or(0) == 0 &&
                           row.count("unclosed_ring").value_or(0) == 0;
    if (untouched && row.count("verts")) {
      EXPECT_EQ(vertices_with_closure(file), *row.count("verts"));
    }
    ++files;
  }
  EXPECT_GT(files, built_with_gdal() ? 30u : 10u);
  EXPECT_EQ(too_far, built_with_gdal() ? 9u : 0u);
}

TEST(SharedVectors, RefusalsNameFeatureRingAndVertex) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  const ObstacleFile file = read_all({"geojson-nasty/overlap_self_intersect.geojson", "", ""});
  ASSERT_EQ(file.rejected.size(), 2u);
  EXPECT_EQ(file.rejected[0].code(), DataCode::self_intersection);
  EXPECT_EQ(file.rejected[0].place().substr(0, 25), "feature 0, ring 0, vertex");
}

TEST(SharedVectors, DegreesComeOutAsMetresRoundTheirCentre) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  // The same buildings are there in metres, projected by others: equirectangular, with 110.54 km a degree of latitude
  // where the ellipsoid has 111.27 here, 0.7 % apart; coordinates rounded to 1 mm.
  constexpr double kOthersError = 0.007;
  constexpr double kOthersRounding = 0.002;
  const ObstacleFile degrees = read_all({"geojson-osm/neukolln_buildings.geojson", "", ""});
  const ObstacleFile metres = read_all({"wkt-osm/neukolln_buildings_m.wkt", "", ""});
  ASSERT_TRUE(degrees.origin.has_value());
  ASSERT_EQ(degrees.obstacles.size(), metres.obstacles.size());
  const auto first_edge = [](const ObstacleFile& file, std::size_t k) {
    const geometry::Segment edge = geometry::edges_of(file.obstacles[k].shape).front();
    return norm(edge.b - edge.a);
  };
  for (std::size_t k = 0; k < degrees.obstacles.size(); ++k) {
    EXPECT_NEAR(first_edge(degrees, k), first_edge(metres, k), kOthersRounding + kOthersError * first_edge(metres, k))
        << k;
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
