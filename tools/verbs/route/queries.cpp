// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/route/queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/datasets/data_error.h"

namespace exactvo::tools {

using datasets::DataCode;

namespace {

constexpr const char* kHeader = "a header with the columns start_x,start_y,goal_x,goal_y, or \"version 1\" of a .scen";
constexpr const char* kColumns[] = {"start_x", "start_y", "goal_x", "goal_y"};

/// bucket, map, width, height, start x, start y, goal x, goal y, optimal length.
constexpr std::size_t kTaskFields = 9, kWidthField = 2, kStartField = 4;

/// Fields are parted by tabs, so that a map's name may hold blanks; some files use blanks throughout.
std::vector<std::string_view> task_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t from = 0; from != std::string_view::npos;) {
    const std::size_t tab = line.find('\t', from);
    fields.push_back(trimmed(line.substr(from, tab == std::string_view::npos ? tab : tab - from)));
    from = tab == std::string_view::npos ? tab : tab + 1;
  }
  return fields.size() == kTaskFields ? fields : fields_of(line);
}

}  // namespace

RouteQueries::RouteQueries(const std::string& file, const AskedMap& map) : lines_(file), map_(map) {
  if (!lines_.next()) throw datasets::DataError(DataCode::format_syntax, lines_.file(), "", "an empty file", kHeader);
  take_header();
}

void RouteQueries::take_header() {
  const std::vector<std::string_view> words = fields_of(lines_.line());
  is_scen_ = words.size() == 2 && words[0] == "version" && (words[1] == "1" || words[1] == "1.0");
  if (is_scen_ && !map_.cells)
    lines_.refuse(DataCode::format_syntax, "cells of a Moving AI map",
                  fmt::format("CSV with coordinates, since {} is {}", map_.file, map_.format));
  if (is_scen_) return;
  column_count_ = words.size();
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const auto found = std::find(words.begin(), words.end(), kColumns[k]);
    if (found == words.end()) lines_.refuse(DataCode::format_syntax, lines_.line(), kHeader);
    if (std::find(found + 1, words.end(), kColumns[k]) != words.end())
      lines_.refuse(DataCode::format_syntax, fmt::format("the column {} twice", kColumns[k]), "each column once");
    columns_[k] = static_cast<std::size_t>(found - words.begin());
  }
}

std::optional<RouteQuery> RouteQueries::next() {
  if (!lines_.next()) return std::nullopt;
  RouteQuery query = is_scen_ ? from_task() : from_columns();
  query.index = count_++;
  return query;
}

RouteQuery RouteQueries::from_columns() const {
  const std::vector<std::string_view> fields = fields_of(lines_.line());
  if (fields.size() != column_count_)
    lines_.refuse(DataCode::wrong_count, fmt::format("{} fields", fields.size()),
                  fmt::format("{} fields", column_count_));
  std::array<double, 4> numbers{};
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const std::optional<double> number = number_in(fields[columns_[k]]);
    if (!number || !std::isfinite(*number))
      lines_.refuse(DataCode::number, fields[columns_[k]], fmt::format("a number in the column {}", kColumns[k]));
    numbers[k] = *number;
  }
  return {0, {numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

RouteQuery RouteQueries::from_task() const {
  const std::vector<std::string_view> fields = task_fields(lines_.line());
  if (fields.size() != kTaskFields)
    lines_.refuse(DataCode::wrong_count, fmt::format("{} fields", fields.size()),
                  fmt::format("{} fields", kTaskFields));
  std::array<double, 6> numbers{};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::optional<double> number = number_in(fields[kWidthField + k]);
    if (!number || *number != std::floor(*number))
      lines_.refuse(DataCode::number, fields[kWidthField + k], "a whole number of cells");
    numbers[k] = *number;
  }
  const datasets::MapSize& size = map_.cells->size;
  if (numbers[0] != static_cast<double>(size.columns) || numbers[1] != static_cast<double>(size.rows))
    lines_.refuse(DataCode::out_of_range, fmt::format("a task for a map of {} x {} cells", numbers[0], numbers[1]),
                  fmt::format("{} x {} cells, as {} has", size.columns, size.rows, map_.file));
  static_assert(kStartField == kWidthField + 2);
  return {0, {numbers[2], numbers[3]}, {numbers[4], numbers[5]}};
}

}  // namespace exactvo::tools
