// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The state of a crowd: structure of arrays, sorted by (strip, x, id), and windows into it.
///
/// A strip is a band of the plane `strip` lattice steps high. Within it robots stand by x, so that those within reach
/// of one are a stretch of each of a few strips. Buckets of x say where a stretch begins; they do not change the order.
/// The height of a strip follows from the state alone: it decides between neighbours at nearly the same distance.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "crowd/layout.h"
#include "crowd/order.h"
#include "exactvo/formation/crowd.h"
#include "tasks.h"

namespace exactvo::formation::crowd {

using detail::Tasks;

/// Lattice coordinates, both ends included.
struct Window {
  std::int64_t x0, x1, y0, y1;
};

/// By at least `by` lattice steps on every side.
inline Window grown(const Window& w, double by) {
  const auto g = static_cast<std::int64_t>(by) + 2;
  return {w.x0 - g, w.x1 + g, w.y0 - g, w.y1 + g};
}

/// The cells of a window, and its ends in x.
struct Cells {
  std::int64_t column0, column1, row0, row1, x0, x1;
};

struct Stretch {
  std::size_t from, to;
};

class Robots {
 public:
  Array<std::int32_t> x, y, mx, my;  ///< lattice; motion of the last step
  Array<std::int32_t> id;
  Array<std::int32_t> hint;  ///< lattice steps, distance of the last neighbour in the last step; 0: not known yet
  Array<std::uint16_t> tag;  ///< kind, kKept in the last step, kSettled: has made one
  Array<std::int32_t> wish_mx, wish_my;  ///< of the first level of a step
  Array<std::int32_t> safe_mx, safe_my;  ///< after the first round of the second
  Array<std::int32_t> next_mx, next_my;
  Array<std::uint8_t> next_kept;  ///< kIsKept, kHasMet

  static constexpr std::uint8_t kIsKept = 1, kHasMet = 2;

  static constexpr std::uint16_t kKind = kKindBits, kKept = 0x4000, kSettled = 0x8000;

  std::size_t size() const { return size_; }
  std::size_t kind(std::size_t i) const { return tag[i] & kKind; }
  double strip() const { return strip_; }
  void set_strip(double strip) { strip_ = strip; }
  Window bounds() const { return bounds_; }

  void reserve(std::size_t robots);
  /// Fields of new robots are left to the caller.
  void resize(std::size_t robots);
  /// Gives back what is far more than robots need.
  void shrink();
  void append(std::int32_t at_x, std::int32_t at_y, std::int32_t robot, KindId kind);
  /// The last one takes its place; unsorted from then on.
  void remove(std::size_t at);
  void sort(Tasks& tasks);
  /// Takes the next motions; unsorted from then on.
  void move(Tasks& tasks);
  /// Sets the height of a strip by the mean of the hints.
  void follow_density(double least, double most);

  Cells cells_of(const Window& w) const {
    return {clamped(column_of(w.x0) - first_column_, columns_),
            clamped(column_of(w.x1) - first_column_, columns_),
            clamped(row_of(w.y0) - first_row_, rows_),
            clamped(row_of(w.y1) - first_row_, rows_),
            w.x0,
            w.x1};
  }
  /// The robots of a strip within the window, and maybe some beside it. Where buckets are long (few robots, far apart)
  /// a strip is searched.
  Stretch stretch(const Cells& cells, std::int64_t row) const {
    const std::int32_t from = start_[row * columns_ + cells.column0], to = start_[row * columns_ + cells.column1 + 1];
    if (bucket_ * per_strip_ <= 1.0 || to - from < kFewInCell)
      return {static_cast<std::size_t>(from), static_cast<std::size_t>(to)};
    return searched(cells, from, to);
  }
  /// Where the strip of robot i ends.
  std::size_t strip_end(std::size_t i) const;
  std::size_t bytes() const;

 private:
  template <class Do>
  void for_fields(const Do& what) {
    for (auto* field : {&x, &y, &mx, &my, &id, &hint, &wish_mx, &wish_my, &safe_mx, &safe_my, &next_mx, &next_my})
      what(*field);
    what(tag), what(next_kept);
  }
  void find_bounds(Tasks& tasks);
  void lay_out_cells();
  void scatter(Tasks& tasks);
  void count_in_cells(Tasks& tasks);
  void order_within_cells(Tasks& tasks);
  void put_in_order(std::size_t p, std::int32_t begin, std::int32_t end);
  void permute(Array<std::int32_t>& field, Tasks& tasks);
  void permute_tags(Tasks& tasks);
  Stretch searched(const Cells& cells, std::int32_t from, std::int32_t to) const;
  /// std::floor, which is a call on targets before SSE4.1.
  static std::int64_t whole_below(double value) {
    const auto toward_zero = static_cast<std::int64_t>(value);
    return toward_zero - static_cast<std::int64_t>(static_cast<double>(toward_zero) > value);
  }
  static std::int64_t clamped(std::int64_t v, std::int64_t count) { return std::clamp<std::int64_t>(v, 0, count - 1); }
  std::int64_t row_of(std::int64_t at_y) const { return whole_below(static_cast<double>(at_y) * per_strip_); }
  std::int64_t column_of(std::int64_t at_x) const { return whole_below(static_cast<double>(at_x) * per_bucket_); }

  /// Robots that are sorted by insertion, or looked at without a search.
  static constexpr std::int32_t kFewInCell = 16;

  std::size_t size_ = 0;
  double strip_ = 1.0, bucket_ = 1.0, per_strip_ = 1.0, per_bucket_ = 1.0;
  Window bounds_{0, 0, 0, 0};
  std::int64_t first_row_ = 0, first_column_ = 0, rows_ = 1, columns_ = 1;
  Array<std::int32_t> start_;    ///< where a cell begins, and the end of the last
  std::vector<Extent> extents_;  ///< of a few ranges of robots
};

}  // namespace exactvo::formation::crowd
