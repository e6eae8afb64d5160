// SPDX-License-Identifier: GPL-3.0-or-later
// Packed spatial indices: SQLite finds in them what is there, and nothing wrong with them.
#include "batch/formats/packed_rtree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "batch/formats/bytes.h"
#include "batch/formats/features.h"
#include "batch/formats/geopackage.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using batch::Box;
using batch::PackedRtree;
using batch::SqliteFile;
using batch::SqliteStatement;

class PackedIndices : public TemporaryFolder {
 protected:
  /// An index of the boxes with ids from 1.
  std::unique_ptr<SqliteFile> index_of(const std::vector<Box>& boxes, const std::string& name) const {
    auto file = std::make_unique<SqliteFile>(put(name, ""));  // an empty file is an empty database
    file->run("CREATE VIRTUAL TABLE tree USING rtree(id, min_x, max_x, min_y, max_y); BEGIN");
    PackedRtree tree(*file, "tree");
    std::int64_t id = 0;
    for (const Box& box : boxes) tree.add(++id, box);
    tree.finish();
    file->run("COMMIT");
    return file;
  }
};

std::vector<Box> random_boxes(exactvo::test::SeededRandom& random, std::size_t count) {
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    const double x = random.uniform(-1000.0, 1000.0), y = random.uniform(-1000.0, 1000.0);
    boxes.push_back({batch::rounded_down(x), batch::rounded_up(x + random.uniform(0.0, 9.0)), batch::rounded_down(y),
                     batch::rounded_up(y + random.uniform(0.0, 9.0))});
  }
  return boxes;
}

std::vector<std::int64_t> found(SqliteFile& file, const Box& window) {
  SqliteStatement query(
      file, "SELECT id FROM tree WHERE max_x >= ? AND min_x <= ? AND max_y >= ? AND min_y <= ? ORDER BY id");
  query.bind(0, double{window.min_x}).bind(1, double{window.max_x});
  query.bind(2, double{window.min_y}).bind(3, double{window.max_y});
  std::vector<std::int64_t> ids;
  while (query.step()) ids.push_back(query.integer(0));
  return ids;
}

std::vector<std::int64_t> expected(const std::vector<Box>& boxes, const Box& window) {
  std::vector<std::int64_t> ids;
  std::int64_t id = 0;
  for (const Box& b : boxes) {
    ++id;
    if (b.max_x >= window.min_x && b.min_x <= window.max_x && b.max_y >= window.min_y && b.min_y <= window.max_y)
      ids.push_back(id);
  }
  return ids;
}

// A root alone; one level; two; as many as are gathered at once (kGathered), with nothing left for the end, one less
// and one more; more.
TEST_F(PackedIndices, FindWhatIsThere) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(107));
  for (const std::size_t count : {0u, 1u, 51u, 52u, 51u * 51u + 1u, 131071u, 131072u, 131073u, 150000u}) {
    SCOPED_TRACE(count);
    const std::vector<Box> boxes = random_boxes(random, count);
    const auto file = index_of(boxes, std::to_string(count));
    SqliteStatement check(*file, "SELECT rtreecheck('tree')");
    ASSERT_TRUE(check.step());
    EXPECT_EQ(check.text(0), "ok");
    for (const Box& window : random_boxes(random, 20)) EXPECT_EQ(found(*file, window), expected(boxes, window));
    EXPECT_EQ(found(*file, {-2000.0F, 2000.0F, -2000.0F, 2000.0F}).size(), count);
  }
}

TEST_F(PackedIndices, TakeRowsAfterwards) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(109));
  std::vector<Box> boxes = random_boxes(random, 3000);
  const auto file = index_of(boxes, "grown");
  file->run("INSERT INTO tree VALUES (3001, 1, 2, 3, 4); DELETE FROM tree WHERE id = 7");
  SqliteStatement check(*file, "SELECT rtreecheck('tree')");
  ASSERT_TRUE(check.step());
  EXPECT_EQ(check.text(0), "ok");
  EXPECT_EQ(found(*file, {-2000.0F, 2000.0F, -2000.0F, 2000.0F}).size(), 3000u);
}

TEST(PackedIndex, FloatsAreRoundedOutward) {
  for (const double x : {0.1, -0.1, 1.0, 16777217.0, -16777217.0, 1e-46, 1e39, -1e39}) {
    EXPECT_LE(batch::rounded_down(x), x);
    EXPECT_GE(batch::rounded_up(x), x);
  }
  EXPECT_EQ(batch::rounded_down(1e39), std::numeric_limits<float>::max());
  EXPECT_EQ(batch::rounded_down(0.5), 0.5F);
}

/// Floats in their order as integers in theirs, from -infinity to infinity.
std::int64_t place_of(float f) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &f, sizeof bits);
  return bits >= 0 ? bits : std::int64_t{std::numeric_limits<std::int32_t>::min()} - bits;
}

float float_at(std::int64_t place) {
  const std::int64_t bits = place >= 0 ? place : std::int64_t{std::numeric_limits<std::int32_t>::min()} - place;
  const auto raw = static_cast<std::int32_t>(bits);
  float f = 0.0F;
  std::memcpy(&f, &raw, sizeof f);
  return f;
}

/// The largest float that is not above x: by halving all floats, without rounding anything.
float largest_not_above(double x) {
  const float infinity = std::numeric_limits<float>::infinity();
  std::int64_t low = place_of(-infinity), above = place_of(infinity);
  while (above - low > 1) {
    const std::int64_t middle = low + (above - low) / 2;
    (double{float_at(middle)} <= x ? low : above) = middle;
  }
  return float_at(low);
}

TEST(PackedIndex, RoundedDownIsTheLargestFloatNotAbove) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(113));
  std::vector<double> numbers = {0.0,   1.0,   0.1,   16777217.0, 3.4028234663852886e38, 3.5e38, 1e39,
                                 1e-45, 7e-46, 1e-46, 1e-38};
  for (int k = 0; k < 20000; ++k) numbers.push_back(std::ldexp(random.uniform(1.0, 2.0), k % 290 - 155));
  for (int k = 0; k < 2000; ++k) {
    const double exact = static_cast<float>(random.uniform(0.0, 1000.0));  // and the doubles beside a float
    numbers.insert(numbers.end(), {exact, std::nextafter(exact, 1e9), std::nextafter(exact, -1e9)});
  }
  for (const double x : numbers) {
    EXPECT_EQ(batch::rounded_down(x), largest_not_above(x)) << x;
    EXPECT_EQ(batch::rounded_down(-x), largest_not_above(-x)) << -x;
    EXPECT_EQ(batch::rounded_up(x), -largest_not_above(-x)) << x;
    EXPECT_EQ(batch::rounded_up(-x), -largest_not_above(x)) << -x;
  }
}

// --- What the package holds against its rows ---

class Packages : public TemporaryFolder {
 protected:
  /// Whether the package takes a row of the first layer with this geometry.
  bool takes(std::string_view geometry) const {
    const auto package = batch::make_geopackage(folder_ / "rows.gpkg", "{}");
    try {
      package->add(row_with(geometry));
    } catch (const std::logic_error&) {
      return false;
    }
    return true;
  }

  static std::string with_head(const batch::GeometryHead& head, std::string_view wkb) {
    std::string geometry;
    batch::append_raw(geometry, head);
    return geometry += wkb;
  }

 private:
  /// As `append_row` lays it out: the layer, the geometry's length and bytes, the values.
  static std::string row_with(std::string_view geometry) {
    std::string row(1, '\0');
    batch::append_text<std::uint32_t>(row, geometry);
    for (const batch::Field& field : batch::layers()[0].fields) {
      const bool is_text = std::holds_alternative<std::string>(field.value);
      const std::size_t bytes = is_text ? sizeof(std::uint32_t) : sizeof(double);
      row.append(bytes, '\0');  // an empty text, or a nought
    }
    return row;
  }
};

TEST_F(Packages, HoldGeometriesToTheirForm) {
  // A line of one point at (0, 0): byte order, kind, count, coordinates.
  const std::string line = std::string("\1\2\0\0\0\1\0\0\0", 9) + std::string(16, '\0');
  batch::GeometryHead head;
  EXPECT_FALSE(takes(with_head(head, line))) << "an extent of no point";
  head.add({0.0, 0.0}, {0.0, 0.0});
  const std::string whole = with_head(head, line);
  EXPECT_TRUE(takes(whole));
  std::string other = whole;
  other[3] = 2;
  EXPECT_FALSE(takes(other)) << "the other byte order";
  for (std::size_t length = 0; length < sizeof head; ++length) EXPECT_FALSE(takes(whole.substr(0, length))) << length;
}

TEST_F(Packages, AFeaturesRowSaysItsExtentAndItsGeometry) {
  batch::Feature feature;
  feature.layer = 2;  // pieces
  feature.is_polygon = true;
  feature.rings = {{{0, 1}, {4, -2}, {3, 7}}, {{-100, -100}, {100, 0}, {0, 100}}};  // the second one is a hole
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
  const auto head = batch::take_raw<batch::GeometryHead>(geometry);
  EXPECT_EQ(head.min_x, 0.0);
  EXPECT_EQ(head.max_x, 4.0);
  EXPECT_EQ(head.min_y, -2.0);
  EXPECT_EQ(head.max_y, 7.0);
  EXPECT_EQ(batch::take_raw<char>(geometry), batch::kLittleEndian);
  EXPECT_EQ(batch::take_raw<std::uint32_t>(geometry), 3u) << "a polygon";
  EXPECT_EQ(batch::take_raw<std::uint32_t>(geometry), 2u) << "rings";
  EXPECT_EQ(batch::take_raw<std::uint32_t>(geometry), 4u) << "points of the first, closed";
  EXPECT_EQ(geometry.size(), (4 + 4) * sizeof(geometry::Vec2) + sizeof(std::uint32_t));
}

}  // namespace
}  // namespace exactvo::datasets::test
