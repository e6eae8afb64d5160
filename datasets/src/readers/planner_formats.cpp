// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of motion planners and trajectory collections: OMPL's circles and grids, OpenTraj's line segments.
#include <cmath>

#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/pi.h"
#include "files/text_file.h"
#include "readers/grid.h"
#include "readers/line_reader.h"
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

using geometry::kPi;
constexpr int kCorners = 16;
/// The corners' radius is rounded up by this part, far more than the few roundings of each corner (1e-15 or so).
constexpr double kOutward = 1e-12;

bool begins_with(std::string_view line, std::string_view beginning) {
  return line.substr(0, beginning.size()) == beginning;
}

/// "environment:" and then the rows, the first on top.
void find_environment(LineReader& lines) {
  while (lines.next()) {
    if (begins_with(trimmed(lines.line()), "environment")) return;
  }
  lines.refuse(DataCode::format_syntax, "the end of the file", "a line \"environment:\" and the rows of the grid");
}

std::uint8_t cell(const LineReader& lines, std::string_view word) {
  if (word == "0") return 0;
  if (word == "1") return 1;
  lines.refuse(DataCode::format_syntax, excerpt(word, 0), "0 or 1");
}

/// Rows as they stand in the file, all of one width.
std::vector<std::vector<std::uint8_t>> read_rows(LineReader& lines) {
  std::vector<std::vector<std::uint8_t>> rows;
  while (lines.next_filled()) {
    std::vector<std::uint8_t>& row = rows.emplace_back();
    for (const std::string_view word : words_of(lines.line())) row.push_back(cell(lines, word));
    if (row.size() != rows.front().size())
      lines.refuse(DataCode::wrong_count, geometry::counted(row.size(), "cell"),
                   std::to_string(rows.front().size()) + ", as in the first row");
  }
  return rows;
}

}  // namespace

geometry::Ring polygon_round(geometry::Vec2 center, double radius) {
  geometry::Ring ring;
  const double reach = radius / std::cos(kPi / kCorners) * (1.0 + kOutward);
  for (int k = 0; k <= kCorners; ++k) {
    const double angle = 2.0 * kPi * (k % kCorners) / kCorners;
    ring.push_back(center + reach * geometry::Vec2{std::cos(angle), std::sin(angle)});
  }
  return ring;
}

bool looks_like_ompl_circles(const FormatProbe& probe) {
  return begins_with(probe.beginning, "units:") && probe.extension == ".txt";
}

/// "units: meter", a line of names, then "number x y r".
void read_ompl_circles(const std::filesystem::path& path, Collector& out) {
  LineReader lines(read_text_file(path), out.file());
  for (int header = 0; header < 2; ++header) lines.next();
  while (lines.next_filled()) {
    const std::vector<std::string_view> words = words_of(lines.line());
    if (words.size() != 4) lines.refuse(DataCode::wrong_count, excerpt(lines.line(), 0), "number x y r");
    const double radius = lines.to_number(words[3]);
    if (!(radius > 0.0)) lines.refuse(DataCode::out_of_range, std::string(words[3]), "a radius > 0");
    const geometry::Vec2 center{lines.to_number(words[1]), lines.to_number(words[2])};
    out.add({RawKind::polygon, std::string(words[0]), lines.place(), {polygon_round(center, radius)}});
  }
  out.note("", "circles stand as polygons of 16 corners round them, 1.3 % larger in area");
}

bool looks_like_ompl_grid(const FormatProbe& probe) {
  return begins_with(probe.beginning, "discretization(cells):");
}

void read_ompl_grid(const std::filesystem::path& path, Collector& out) {
  LineReader lines(read_text_file(path), out.file());
  find_environment(lines);
  const std::vector<std::vector<std::uint8_t>> rows = read_rows(lines);
  if (rows.empty() || rows.front().empty()) lines.refuse(DataCode::format_syntax, "no cells", "the rows of the grid");
  Grid grid{rows.front().size(), rows.size(), {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    grid.occupied.insert(grid.occupied.end(), row->begin(), row->end());
  const double size = out.options().cell_size > 0.0 ? out.options().cell_size : 1.0;
  add_grid(grid, {{0.0, 0.0}, size, 0.0, 0, 0}, out);
}

/// <Line x1 y1 x2 y2 thickness/> in metres; the thickness is of the drawing.
void read_opentraj_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  std::size_t number = 0;
  for (const pugi::xml_node obstacle : xml.document().child("Trial").child("obstacles").children("obstacle")) {
    for (const pugi::xml_node line : obstacle.child("TrialObstacle").child("Lines").children("Line")) {
      const geometry::Vec2 a{xml.number(line, "x1"), xml.number(line, "y1")};
      const geometry::Vec2 b{xml.number(line, "x2"), xml.number(line, "y2")};
      xml.add(RawKind::polyline, number++, line, {a, b}, out);
    }
  }
}

}  // namespace exactvo::datasets
