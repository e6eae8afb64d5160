// SPDX-License-Identifier: GPL-3.0-or-later
// Every ring of the public vector files can be split into convex pieces. convex_pieces proves each answer before it
// gives it; what is counted here is that it answers.
#include <gtest/gtest.h>

#include <iostream>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/validity.h"
#include "shared_data.h"
#include "support/corpus.h"

namespace exactvo::datasets::test {
namespace {

using geometry::ConvexPolygon;
using geometry::Ring;

// Greene's may fail inside, and `triangles` must then answer in its place.
void expect_pieces(const Ring& ring) {
  using geometry::PartitionMethod;
  for (const PartitionMethod method :
       {PartitionMethod::automatic, PartitionMethod::triangles, PartitionMethod::greene}) {
    std::vector<ConvexPolygon> pieces;
    ASSERT_NO_THROW(pieces = geometry::convex_pieces(ring, method)) << exactvo::test::corpus_line(ring);
    ASSERT_FALSE(pieces.empty());
    for (const ConvexPolygon& piece : pieces)
      ASSERT_TRUE(geometry::is_valid(piece)) << exactvo::test::corpus_line(ring);
  }
}

std::size_t split_all(const ManifestRow& row) {
  SCOPED_TRACE(row.path);
  ReadOptions options;
  options.keep_going = true;
  options.units = Units::metres;  // rings as they stand, however far they reach
  std::size_t rings = 0;
  for (const formation::SceneObstacle& obstacle : read_obstacles(shared_data() / row.path, options).obstacles) {
    const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape);
    if (polygon == nullptr) continue;
    expect_pieces(polygon->outer);
    for (const Ring& hole : polygon->holes) expect_pieces(Ring(hole.rbegin(), hole.rend()));
    rings += 1 + polygon->holes.size();
  }
  return rings;
}

TEST(SharedPartitions, EveryRingOfEveryVectorFile) {
  EXACTVO_NEEDS_SHARED_DATA();
  std::vector<std::string> folders{"wkt-jts"};
  if (built_with_gdal()) {
    for (const char* more : {"geojson-nasty", "geojson-naturalearth", "geojson-osm", "geojson-polyclip"})
      folders.push_back(more);
  }
  std::size_t rings = 0;
  for (const ManifestRow& row : manifest_of(folders)) EXPECT_NO_THROW(rings += split_all(row)) << row.path;
  std::cout << rings << " rings split\n";
  EXPECT_GT(rings, built_with_gdal() ? 1800u : 140u);
}

}  // namespace
}  // namespace exactvo::datasets::test
