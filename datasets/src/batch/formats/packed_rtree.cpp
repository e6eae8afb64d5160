// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/packed_rtree.h"

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "exactvo/geometry/require.h"

namespace exactvo::datasets::batch {
namespace {

/// Boxes of a full node, and a node's bytes: a head of 4 bytes and 51 cells of 24, where pages have 4096 bytes or more.
constexpr std::size_t kBoxesOfNode = 51;
constexpr std::size_t kBytesOfCell = 24;
constexpr std::size_t kBytesOfNode = 4 + kBoxesOfNode * kBytesOfCell;
constexpr std::int64_t kRoot = 1;

/// Sorted together: few enough to hold (3 MB), many enough for leaves that overlap little.
constexpr std::size_t kGathered = std::size_t{1} << 17;

template <class T>
unsigned char* put_big_endian(unsigned char* at, T value) {
  boost::endian::endian_store<T, sizeof(T), boost::endian::order::big>(at, value);
  return at + sizeof(T);
}

Box join(const Box& a, const Box& b) {
  return {std::min(a.min_x, b.min_x), std::max(a.max_x, b.max_x), std::min(a.min_y, b.min_y),
          std::max(a.max_y, b.max_y)};
}

/// In doubles: the sum of two floats may be too large for one.
double middle_x(const Box& box) {
  return 0.5 * (static_cast<double>(box.min_x) + box.max_x);
}
double middle_y(const Box& box) {
  return 0.5 * (static_cast<double>(box.min_y) + box.max_y);
}

/// Slabs of about as many nodes as there are slabs, in order of x; in each the boxes in order of y.
template <class Entries>
void sort_into_tiles(Entries& entries) {
  using Entry = typename Entries::value_type;
  const auto nodes = static_cast<double>((entries.size() + kBoxesOfNode - 1) / kBoxesOfNode);
  const auto nodes_of_slab = static_cast<std::size_t>(std::ceil(std::sqrt(nodes)));
  const std::size_t boxes_of_slab = nodes_of_slab * kBoxesOfNode;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(middle_x(a.box), a.id) < std::pair(middle_x(b.box), b.id);
  });
  for (std::size_t first = 0; first < entries.size(); first += boxes_of_slab) {
    const std::size_t last = std::min(first + boxes_of_slab, entries.size());
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.begin() + static_cast<std::ptrdiff_t>(last),
              [](const Entry& a, const Entry& b) {
                return std::pair(middle_y(a.box), a.id) < std::pair(middle_y(b.box), b.id);
              });
  }
}

}  // namespace

float rounded_down(double x) {
  using Limits = std::numeric_limits<float>;
  if (x > Limits::max()) return Limits::max();
  if (x < Limits::lowest()) return -Limits::infinity();
  const auto nearest = static_cast<float>(x);
  return nearest > x ? std::nextafter(nearest, -Limits::infinity()) : nearest;
}

float rounded_up(double x) {
  return -rounded_down(-x);
}

PackedRtree::PackedRtree(SqliteFile& file, const std::string& table)
    : insert_node_(file, "INSERT OR REPLACE INTO " + sql_name(table + "_node") + " VALUES (?, ?)"),
      insert_row_(file, "INSERT INTO " + sql_name(table + "_rowid") + " VALUES (?, ?)"),
      insert_parent_(file, "INSERT INTO " + sql_name(table + "_parent") + " VALUES (?, ?)") {
  SqliteStatement root(file, "SELECT length(data) FROM " + sql_name(table + "_node") + " WHERE nodeno = 1");
  const std::int64_t bytes = root.step() ? root.integer(0) : 0;
  EXACTVO_REQUIRE(bytes == static_cast<std::int64_t>(kBytesOfNode), std::to_string(bytes) + " bytes a node");
}

void PackedRtree::add(std::int64_t id, const Box& box) {
  gathered_.push_back({id, box});
  if (gathered_.size() == kGathered) write_leaves();
}

void PackedRtree::write_leaves() {
  const Entries leaves = write_level(std::exchange(gathered_, {}), true);
  leaves_.insert(leaves_.end(), leaves.begin(), leaves.end());
}

void PackedRtree::finish() {
  if (leaves_.empty() && gathered_.size() <= kBoxesOfNode) {
    write_root(gathered_, 0, true);
    return;
  }
  write_leaves();
  int depth = 1;
  for (; leaves_.size() > kBoxesOfNode; ++depth) leaves_ = write_level(std::move(leaves_), false);
  write_root(leaves_, depth, false);
}

/// The nodes that hold `entries`.
PackedRtree::Entries PackedRtree::write_level(Entries entries, bool is_leaf) {
  sort_into_tiles(entries);
  Entries nodes;
  std::vector<std::pair<std::int64_t, std::int64_t>> node_of;
  for (std::size_t first = 0; first < entries.size(); first += kBoxesOfNode) {
    const std::size_t last = std::min(first + kBoxesOfNode, entries.size());
    Box box = entries[first].box;
    for (std::size_t k = first; k < last; ++k) {
      box = join(box, entries[k].box);
      node_of.emplace_back(entries[k].id, next_node_);
    }
    write_node(next_node_, entries.data() + first, entries.data() + last, 0);
    nodes.push_back({next_node_++, box});
  }
  write_places(std::move(node_of), is_leaf);
  return nodes;
}

void PackedRtree::write_root(const Entries& entries, int depth, bool is_leaf) {
  std::vector<std::pair<std::int64_t, std::int64_t>> node_of;
  for (const Entry& entry : entries) node_of.emplace_back(entry.id, kRoot);
  write_node(kRoot, entries.data(), entries.data() + entries.size(), depth);
  write_places(std::move(node_of), is_leaf);
}

/// The root alone says how deep the tree is.
void PackedRtree::write_node(std::int64_t number, const Entry* first, const Entry* last, int depth) {
  unsigned char bytes[kBytesOfNode] = {};
  unsigned char* at = put_big_endian(bytes, static_cast<std::uint16_t>(depth));
  at = put_big_endian(at, static_cast<std::uint16_t>(last - first));
  for (const Entry* entry = first; entry != last; ++entry) {
    at = put_big_endian(at, static_cast<std::uint64_t>(entry->id));
    for (const float side : {entry->box.min_x, entry->box.max_x, entry->box.min_y, entry->box.max_y})
      at = put_big_endian(at, side);
  }
  insert_node_.bind(0, number).bind_bytes(1, {reinterpret_cast<const char*>(bytes), sizeof bytes}).run();
}

/// In order of the keys: a B-tree grows quickest at its end.
void PackedRtree::write_places(std::vector<std::pair<std::int64_t, std::int64_t>> node_of, bool is_leaf) {
  std::sort(node_of.begin(), node_of.end());
  SqliteStatement& insert = is_leaf ? insert_row_ : insert_parent_;
  for (const auto& [id, node] : node_of) insert.bind(0, id).bind(1, node).run();
}

}  // namespace exactvo::datasets::batch
