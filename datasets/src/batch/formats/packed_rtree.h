// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The spatial index of a layer, packed full instead of grown: SQLite's R-tree takes a search and a split for each box
/// that is put in, several times as long as the row itself. Boxes are gathered, sorted into tiles and written as the
/// nodes that the R-tree module keeps in its three tables (its file format is part of SQLite's: sqlite.org/rtree.html,
/// "shadow tables"). Leutenegger, Lopez, Edgington: STR, a simple and efficient algorithm for R-tree packing, 1997.
///
/// The same boxes give the same tree. Memory: kGathered boxes, and one for each full leaf, a 51st of all.

#include <cstdint>
#include <string>
#include <vector>

#include "batch/formats/sqlite_file.h"

namespace exactvo::datasets::batch {

/// In floats, as the R-tree keeps it.
struct Box {
  float min_x = 0.0F;
  float max_x = 0.0F;
  float min_y = 0.0F;
  float max_y = 0.0F;
};

/// The largest float that is not larger, and the least that is not less.
float rounded_down(double x);
float rounded_up(double x);

class PackedRtree {
 public:
  /// `table`: an R-tree of two dimensions that is there and empty.
  PackedRtree(SqliteFile& file, const std::string& table);

  /// REQUIRES: ids one after another.
  void add(std::int64_t id, const Box& box);
  /// Writes what is left, and the levels above the leaves.
  void finish();

 private:
  struct Entry {
    std::int64_t id;  ///< of a row, or in the levels above of a node
    Box box;
  };
  using Entries = std::vector<Entry>;

  void write_leaves();
  Entries write_level(Entries entries, bool is_leaf);
  void write_root(const Entries& entries, int depth, bool is_leaf);
  void write_node(std::int64_t number, const Entry* first, const Entry* last, int depth);
  void write_places(std::vector<std::pair<std::int64_t, std::int64_t>> node_of, bool is_leaf);

  SqliteStatement insert_node_;
  SqliteStatement insert_row_;
  SqliteStatement insert_parent_;
  std::int64_t next_node_ = 2;  ///< 1 is the root
  Entries gathered_;
  Entries leaves_;
};

}  // namespace exactvo::datasets::batch
