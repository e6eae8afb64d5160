// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What sorting a crowd does to many robots at a time, one per SIMD lane.

#include <cstddef>
#include <cstdint>

namespace exactvo::formation::crowd {

struct Extent {
  std::int32_t low, high;
};

/// The least and the greatest of `count` values, at least one.
Extent extent_of(const std::int32_t* values, std::size_t count);

/// Cells of equal size, row by row: a robot at (x, y) is in column floor(x * per_column) - first_column.
struct CellRule {
  double per_column, per_row, first_column, first_row, columns;
};

/// Writes the numbers of the cells, which must be below 2^31. `x` and `y` are read to the next multiple of kPack.
void number_cells(const CellRule& rule, const std::int32_t* x, const std::int32_t* y, std::size_t count,
                  std::int32_t* cells);

/// Bit k: values[k] is not above values[k - 1], which can be read. Of up to 64 values.
std::uint64_t not_above_the_last(const std::int32_t* values, std::size_t count);

}  // namespace exactvo::formation::crowd
