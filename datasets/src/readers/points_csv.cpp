// SPDX-License-Identifier: GPL-3.0-or-later
// Unordered points, in metres: "x, y" in each line, with a comma, a semicolon, a tab or blanks between. A first line of
// words is a header.
#include <algorithm>
#include <cctype>

#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "readers/hits.h"
#include "readers/line_reader.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

/// At the first kind of separator that the line has.
std::vector<std::string_view> columns_of(std::string_view line) {
  for (const char separator : {',', ';', '\t'})
    if (line.find(separator) != std::string_view::npos) return fields_of(line, separator);
  return words_of(line);
}

bool is_a_pair_of_numbers(std::string_view line) {
  const std::vector<std::string_view> fields = columns_of(line);
  return fields.size() == 2 && std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
           return !field.empty() && field.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
         });
}

bool begins_with_a_letter(std::string_view line) {
  return !line.empty() && std::isalpha(static_cast<unsigned char>(line.front())) != 0;
}

geometry::Vec2 to_point(const LineReader& lines) {
  const std::vector<std::string_view> fields = columns_of(lines.line());
  if (fields.size() != 2) {
    lines.refuse(DataCode::wrong_count, geometry::counted(fields.size(), "number") + " in a line",
                 "two, x and y, with a comma, a semicolon, a tab or blanks between them");
  }
  const geometry::Vec2 point{lines.to_number(fields[0]), lines.to_number(fields[1])};
  if (!geometry::is_finite(point)) lines.refuse(DataCode::not_finite, excerpt(lines.line(), 0), "finite coordinates");
  return point;
}

}  // namespace

/// The first line that is no comment, or the second where the first is a header of two words.
bool looks_like_points_csv(const FormatProbe& probe) {
  if (probe.extension != ".csv") return false;
  std::string_view rest = probe.beginning;
  for (bool may_be_header = true; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.empty() || line.front() == '#') continue;
    if (is_a_pair_of_numbers(line)) return true;
    if (!may_be_header || !begins_with_a_letter(line) || columns_of(line).size() != 2) return false;
    may_be_header = false;
  }
  return false;
}

void read_points_csv(const std::filesystem::path& path, Collector& out) {
  const std::string text = read_text_file(path);
  LineReader lines(text, out.file());
  std::vector<geometry::Vec2> points;
  for (bool may_be_header = true; lines.next();) {
    const std::string_view line = trimmed(lines.line());
    if (line.empty() || line.front() == '#') continue;
    const bool is_header = may_be_header && begins_with_a_letter(line);
    may_be_header = false;
    if (!is_header) points.push_back(to_point(lines));
  }
  add_hits(points, out);
}

}  // namespace exactvo::datasets
