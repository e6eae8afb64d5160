// SPDX-License-Identifier: GPL-3.0-or-later
// A part as bytes: nothing lost, and no more room than they take.
#include "batch/work/part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "batch/formats/bytes.h"
#include "batch/formats/geopackage.h"
#include "exactvo/datasets/obstacle_file.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

TEST(BatchPart, ItsBytesTakeTheRoomThatWasReckonedAndNoMore) {
  batch::Part part;
  part.counts.obstacles = 3;
  part.counts.certified = 2;
  part.counts.vertices = 17;
  part.counts.no_half_plane = 5;
  part.measurements = std::string(1000, 'f');
  for (std::size_t k = 0; k < batch::layers().size(); ++k) part.features.emplace_back(100 + k, 'l');
  part.rows = std::string(500, 'r');
  part.pictures = "<svg/>";
  const std::string bytes = batch::to_bytes(part);
  EXPECT_EQ(bytes.capacity(), bytes.size());
  const batch::PartView again = batch::view_of_part(bytes, "part");
  EXPECT_EQ(again.counts.obstacles, part.counts.obstacles);
  EXPECT_EQ(again.counts.certified, part.counts.certified);
  EXPECT_EQ(again.counts.vertices, part.counts.vertices);
  EXPECT_EQ(again.counts.no_half_plane, part.counts.no_half_plane);
  EXPECT_EQ(again.pictures, part.pictures);
  EXPECT_EQ(again.measurements, part.measurements);
  EXPECT_TRUE(std::equal(again.features.begin(), again.features.end(), part.features.begin(), part.features.end()));
  EXPECT_EQ(again.rows, part.rows);
  std::istringstream stream(bytes);
  EXPECT_EQ(batch::pictures_at_start(stream, "part"), part.pictures);
  std::istringstream whole("facts\n" + bytes), longer("facts\n" + bytes + "x");
  for (std::istringstream* file : {&whole, &longer}) file->ignore(6);
  EXPECT_TRUE(batch::holds_whole_part(whole));
  EXPECT_FALSE(batch::holds_whole_part(longer));
}

TEST(BatchPart, ItsBytesCutShortAnywhereAreRefused) {
  batch::Part part;
  part.features.resize(batch::layers().size());
  part.pictures = "<svg/>";
  part.measurements = "{}\n";
  part.rows = "r";
  const std::string bytes = batch::to_bytes(part);
  const std::size_t end_of_pictures = bytes.find("<svg/>") + part.pictures.size();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(batch::view_of_part(bytes.substr(0, length), "part"), DataError) << length;
    std::istringstream cut(bytes.substr(0, length));
    EXPECT_FALSE(batch::holds_whole_part(cut)) << length;
    std::istringstream stream(bytes.substr(0, length));
    if (length >= end_of_pictures) continue;
    EXPECT_THROW(batch::pictures_at_start(stream, "part"), DataError) << length;
  }
}

TEST(BatchPart, AFeaturesRowIsReadBackAsItsGeometryAndItsValues) {
  batch::Feature feature;
  feature.layer = 2;  // pieces
  feature.is_polygon = true;
  feature.rings = {{{0, 1}, {4, -2}, {3, 7}}, {{1, 1}, {2, 1}, {1, 2}}};
  feature.fields = {{"key", std::string("in#0")}, {"number", std::int64_t{7}}};
  std::string bytes;
  batch::append_row(bytes, feature);
  std::string_view rest = bytes;
  const batch::Row row = batch::read_row(rest);
  EXPECT_TRUE(rest.empty());
  EXPECT_EQ(row.layer, 2u);
  ASSERT_EQ(row.values.size(), 2u);
  EXPECT_EQ(row.values[0], feature.fields[0].value);
  EXPECT_EQ(row.values[1], feature.fields[1].value);
  std::string_view geometry = row.geometry;
  EXPECT_EQ(batch::take_raw<char>(geometry), 1) << "little-endian";
  for (const std::uint32_t number : {3, 2, 4}) EXPECT_EQ(batch::take_raw<std::uint32_t>(geometry), number);
  EXPECT_EQ(geometry.size(), (4 + 4) * sizeof(geometry::Vec2) + sizeof(std::uint32_t));
}

class BatchPackage : public TemporaryFolder {};

// From some number of features on GDAL would build spatial indices in a thread of its own.
TEST_F(BatchPackage, ManyFeaturesAreAllThere) {
  if (!built_with_gdal()) GTEST_SKIP() << "a build without GDAL";
  constexpr std::size_t kFeatures = 250'000;
  const auto package = batch::make_geopackage(folder_ / "many.gpkg", "{}");
  batch::Feature feature;
  feature.layer = 3;  // hulls
  feature.is_polygon = true;
  feature.fields = {{"key", std::string("in#0")}, {"area", 0.5}};
  std::string rows;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    const auto x = static_cast<double>(k);
    feature.rings = {{{x, 0}, {x + 1, 0}, {x, 1}}};
    append_row(rows, feature);
  }
  package->add(rows);
  package->finish();
  std::size_t count = 0;
  ObstacleStream stream;
  stream.obstacle = [&](formation::SceneObstacle, bool) { ++count; };
  stream.rejected = [](const DataError& error) { throw error; };
  read_obstacles(folder_ / "many.gpkg", {}, stream);
  EXPECT_EQ(count, kFeatures);
}

}  // namespace
}  // namespace exactvo::datasets::test
