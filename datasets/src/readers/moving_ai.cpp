// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/moving_ai.h"

#include <map>
#include <string_view>

#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "readers/grid.h"
#include "readers/line_reader.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

// --- Maps: "type octile", "height H", "width W", "map", then H rows of W symbols, the top one first ---

/// Out of bounds, trees, water.
constexpr std::string_view kBlocked = "@OTW";
/// Ground and swamp.
constexpr std::string_view kFree = ".GS";
/// Free as well: what games and warehouses put on the ground.
constexpr std::string_view kUnusual = "stgE";

bool is_one_of(std::string_view symbols, char symbol) {
  return symbols.find(symbol) != std::string_view::npos;
}

std::size_t to_size(const LineReader& lines, std::string_view field) {
  const std::int64_t value = lines.to_integer(field);
  if (value < 1 || static_cast<std::uint64_t>(value) > kMostCells) {
    lines.refuse(DataCode::size, std::to_string(value) + " cells", "between 1 and " + std::to_string(kMostCells));
  }
  return static_cast<std::size_t>(value);
}

/// A grid without its cells. The type line may be missing, and the others may come in any order.
Grid read_header(LineReader& lines) {
  Grid header;
  while (lines.next_filled()) {
    const std::vector<std::string_view> words = words_of(lines.line());
    if (words[0] == "map" && words.size() == 1) break;
    if (words.size() != 2)
      lines.refuse(DataCode::format_syntax, excerpt(lines.line(), 0), "type, height, width or map");
    if (words[0] == "height") header.height = to_size(lines, words[1]);
    if (words[0] == "width") header.width = to_size(lines, words[1]);
  }
  if (header.height == 0 || header.width == 0) {
    lines.refuse(DataCode::format_syntax, "no height, no width or no map", "height, width and map lines");
  }
  // The grid must be there before memory is taken for it.
  if (header.height > kMostCells / header.width || header.height * header.width > lines.left()) {
    lines.refuse(DataCode::size, std::to_string(header.height) + " rows of " + std::to_string(header.width),
                 "as many cells as the file holds, at most " + std::to_string(kMostCells));
  }
  return header;
}

void read_row(const LineReader& lines, std::size_t y, Grid& grid, std::map<char, std::size_t>& odd) {
  const std::string_view row = lines.line();
  if (row.size() != grid.width) {
    lines.refuse(DataCode::wrong_count, geometry::counted(row.size(), "cell"), geometry::counted(grid.width, "cell"));
  }
  for (std::size_t x = 0; x < row.size(); ++x) {
    const bool is_blocked = is_one_of(kBlocked, row[x]), is_unusual = is_one_of(kUnusual, row[x]);
    if (!is_blocked && !is_unusual && !is_one_of(kFree, row[x]))
      lines.refuse(DataCode::format_syntax, "the symbol " + excerpt(row, x, 1), "one of . G S @ O T W");
    if (is_blocked) grid.occupied[y * grid.width + x] = 1;
    if (is_unusual) ++odd[row[x]];
  }
}

Grid read_grid(LineReader& lines, Collector& out) {
  Grid grid = read_header(lines);
  grid.occupied.assign(grid.width * grid.height, 0);
  std::map<char, std::size_t> odd;
  for (std::size_t row = 0; row < grid.height; ++row) {
    if (!lines.next()) {
      lines.refuse(DataCode::wrong_count, geometry::counted(row, "row"), geometry::counted(grid.height, "row"));
    }
    read_row(lines, grid.height - 1 - row, grid, odd);
  }
  for (const auto& [symbol, count] : odd) {
    out.note("", geometry::counted(count, "cell") + " of the unusual symbol " + symbol + " taken as free");
  }
  return grid;
}

}  // namespace

MapSize read_map_size(const std::filesystem::path& map) {
  const std::string name = map.string();
  LineReader lines(read_text_file(map), name);
  const Grid header = read_header(lines);
  return {static_cast<std::int64_t>(header.width), static_cast<std::int64_t>(header.height)};
}

bool looks_like_moving_ai_map(const FormatProbe& probe) {
  if (probe.extension != ".map") return false;
  const std::string& text = probe.beginning;
  return text.rfind("type ", 0) == 0 || text.rfind("height ", 0) == 0 || text.rfind("width ", 0) == 0;
}

void read_moving_ai_map(const std::filesystem::path& path, Collector& out) {
  LineReader lines(read_text_file(path), out.file());
  const Grid grid = read_grid(lines, out);
  const double cell = out.options().cell_size > 0.0 ? out.options().cell_size : 1.0;
  add_grid(grid, {{0.0, 0.0}, cell, 0.0, 0, 0}, out);
}

}  // namespace exactvo::datasets
