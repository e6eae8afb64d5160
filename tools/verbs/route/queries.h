// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Many questions of `exactvo route` from a file or a pipe, one after the other: CSV with a header that has the columns
/// start_x, start_y, goal_x and goal_y, or the .scen format of the Moving AI benchmarks.

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "support/fields.h"
#include "verbs/route/map.h"

namespace exactvo::tools {

struct RouteQuery {
  std::size_t index = 0;       ///< from 0
  geometry::Vec2 start, goal;  ///< as given
};

class RouteQueries {
 public:
  /// Reads the header. Throws DataError, as `next` does: a file without one, a .scen for another kind of map.
  RouteQueries(const std::string& file, const AskedMap& map);

  /// The next question; nothing at the end.
  std::optional<RouteQuery> next();

  /// Throws DataError for the question that `next` gave last.
  [[noreturn]] void refuse(datasets::DataCode code, const std::string& found, const std::string& expected) const {
    lines_.refuse(code, found, expected);
  }

 private:
  void take_header();
  RouteQuery from_columns() const;
  RouteQuery from_task() const;

  TableLines lines_;
  const AskedMap& map_;
  bool is_scen_ = false;
  std::array<std::size_t, 4> columns_{};  ///< of start x, y, goal x, y
  std::size_t column_count_ = 0;
  std::size_t count_ = 0;
};

}  // namespace exactvo::tools
