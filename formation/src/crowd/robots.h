// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The state of a crowd: structure of arrays, sorted by (strip, x, id), and windows into it.
///
/// A strip is a band of the plane `strip` lattice steps high. Within it robots stand by x, so that those within reach
/// of one are a stretch of each of a few strips. Buckets of x say where a stretch begins; they do not change the order.
/// The height of a strip follows from the state alone: it decides between neighbours at nearly the same distance.

#include <cstdint>

#include "crowd/layout.h"
#include "crowd/tasks.h"
#include "exactvo/formation/crowd.h"

namespace exactvo::formation::crowd {

/// Lattice coordinates, both ends included.
struct Window {
  std::int64_t x0, x1, y0, y1;
};

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
  Array<std::int32_t> next_mx, next_my;
  Array<std::uint8_t> next_kept;

  static constexpr std::uint16_t kKind = 0x3FFF, kKept = 0x4000, kSettled = 0x8000;

  std::size_t size() const { return size_; }
  double strip() const { return strip_; }
  void set_strip(double strip) { strip_ = strip; }
  Window bounds() const { return bounds_; }

  void reserve(std::size_t robots);
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

  Cells cells_of(const Window& window) const;
  /// The robots of a strip within the window, and maybe some beside it.
  Stretch stretch(const Cells& cells, std::int64_t row) const;
  std::size_t count(const Cells& cells) const;
  /// Where the strip of robot i ends.
  std::size_t strip_end(std::size_t i) const;
  std::size_t bytes() const;

 private:
  template <class Do>
  void for_fields(const Do& what) {
    for (auto* field : {&x, &y, &mx, &my, &id, &hint, &next_mx, &next_my, &order_}) what(*field);
    what(tag), what(tags_scratch_), what(next_kept);
  }
  void resize(std::size_t robots);
  void find_bounds();
  void lay_out_cells();
  void number_cells(Tasks& tasks);
  void scatter(Tasks& tasks);
  void order_within_cells(Tasks& tasks);
  void permute(Array<std::int32_t>& field, Tasks& tasks);
  std::int64_t row_of(std::int64_t at_y) const;
  std::int64_t column_of(std::int64_t at_x) const;

  std::size_t size_ = 0;
  double strip_ = 1.0, bucket_ = 1.0, per_strip_ = 1.0, per_bucket_ = 1.0;
  Window bounds_{0, 0, 0, 0};
  std::int64_t first_row_ = 0, first_column_ = 0, rows_ = 1, columns_ = 1;
  Array<std::int32_t> start_;  ///< where a cell begins, and the end of the last
  Array<std::int32_t> order_;
  Array<std::uint16_t> tags_scratch_;
};

}  // namespace exactvo::formation::crowd
