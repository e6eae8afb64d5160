// SPDX-License-Identifier: GPL-3.0-or-later
// Packed spatial indices: SQLite finds in them what is there, and nothing wrong with them.
#include "batch/packed_rtree.h"

#include <gtest/gtest.h>

#include <limits>

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

// A root alone; one level; two; more than are gathered at once.
TEST_F(PackedIndices, FindWhatIsThere) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(107));
  for (const std::size_t count : {0u, 1u, 51u, 52u, 51u * 51u + 1u, 150000u}) {
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

}  // namespace
}  // namespace exactvo::datasets::test
