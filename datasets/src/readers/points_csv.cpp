// SPDX-License-Identifier: GPL-3.0-or-later
// Unordered points: "x, y" a line, in metres. A first line of words is a header.
#include <algorithm>
#include <cctype>

#include "readers/hits.h"
#include "readers/line_reader.h"
#include "readers/readers.h"
#include "text_file.h"

namespace exactvo::datasets {
namespace {

bool is_a_pair_of_numbers(std::string_view line) {
  const std::vector<std::string_view> fields = fields_of(line, ',');
  return fields.size() == 2 && std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
           return !field.empty() && field.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
         });
}

bool begins_with_a_letter(std::string_view line) {
  return !line.empty() && std::isalpha(static_cast<unsigned char>(line.front())) != 0;
}

geometry::Vec2 to_point(const LineReader& lines) {
  const std::vector<std::string_view> fields = fields_of(lines.line(), ',');
  if (fields.size() != 2) {
    lines.refuse(DataCode::wrong_count, std::to_string(fields.size()) + " fields", "two: x, y");
  }
  const geometry::Vec2 point{lines.to_number(fields[0]), lines.to_number(fields[1])};
  if (!geometry::is_finite(point)) lines.refuse(DataCode::not_finite, excerpt(lines.line(), 0), "finite coordinates");
  return point;
}

}  // namespace

bool looks_like_points_csv(const Glimpse& glimpse) {
  return glimpse.extension == ".csv" &&
         is_a_pair_of_numbers(glimpse.beginning.substr(0, glimpse.beginning.find_first_of("\r\n")));
}

void read_points_csv(const std::filesystem::path& path, Collector& out) {
  const std::string text = read_text_file(path);
  LineReader lines(text, out.file());
  std::vector<geometry::Vec2> points;
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line());
    if (line.empty() || line.front() == '#' || (lines.number() == 1 && begins_with_a_letter(line))) continue;
    points.push_back(to_point(lines));
  }
  add_hits(points, out);
}

}  // namespace exactvo::datasets
