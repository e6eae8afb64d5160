// SPDX-License-Identifier: GPL-3.0-or-later
// Laser logs and loose points. What was hit becomes the cells of a grid that hold it: every hit lies in a cell
// (exactly: cells are compared by their rounded corners), and the cells become polygons (grid.h).
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/grid.h"
#include "readers/line_reader.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

/// m, where the caller names no cell size.
constexpr double kScanCell = 0.05;
/// Beyond this a lattice coordinate is no exact double any more.
constexpr double kFarthestCell = 0x1p52;

/// The cell [k c, (k + 1) c] that holds x, its ends rounded as `lattice_point` rounds them. Never falls as x grows.
std::int64_t cell_of(double x, double cell) {
  auto k = static_cast<std::int64_t>(std::floor(x / cell));
  while (cell * static_cast<double>(k) > x) --k;
  while (cell * static_cast<double>(k + 1) < x) ++k;
  return k;
}

/// The box of hits whose cells have exact coordinates; the others are refused.
geometry::Box box_of_hits(const std::vector<geometry::Vec2>& hits, double cell, const Collector& out) {
  geometry::Box box;
  for (const geometry::Vec2 hit : hits) {
    EXACTVO_REQUIRE(geometry::is_finite(hit), "a hit that is not finite");
    if (std::max(std::abs(hit.x), std::abs(hit.y)) / cell >= kFarthestCell)
      throw DataError(DataCode::size, out.file(), "", "a hit beyond 2^52 cells",
                      "hits nearer to the origin, or larger cells");
    box.add(hit);
  }
  return box;
}

/// A range that means "nothing seen": 0 or less, NaN, or what lasers report beyond their reach (50, 81.83, 81.91 m and
/// more; 32.767 is the largest 16-bit number of millimetres).
bool is_no_return(double range) {
  constexpr double kLeastOfNoReturns = 50.0;
  constexpr double kSixteenBitsOfMillimetres = 32.767;
  return !(range > 0.0) || range >= kLeastOfNoReturns || range == kSixteenBitsOfMillimetres;
}

struct Pose {
  geometry::Vec2 position;  ///< m
  double heading = 0.0;     ///< rad
};

geometry::Vec2 hit_at(const Pose& laser, double bearing, double range) {
  const double angle = laser.heading + bearing;
  return laser.position + range * geometry::Vec2{std::cos(angle), std::sin(angle)};
}

/// REQUIRES: finite hits. Refuses hits so far apart that their grid would not fit (E_SIZE).
void add_hits(const std::vector<geometry::Vec2>& hits, Collector& out) {
  if (hits.empty()) return out.note("", "no hit, no obstacle");
  const double cell = out.options().cell_size > 0.0 ? out.options().cell_size : kScanCell;
  const geometry::Box box = box_of_hits(hits, cell, out);
  const std::int64_t first_column = cell_of(box.low.x, cell), first_row = cell_of(box.low.y, cell);
  const auto column = [&](double x) { return static_cast<std::size_t>(cell_of(x, cell) - first_column); };
  const auto row = [&](double y) { return static_cast<std::size_t>(cell_of(y, cell) - first_row); };
  const std::size_t columns = column(box.high.x) + 1, rows = row(box.high.y) + 1;
  if (columns > kMostCells || rows > kMostCells / columns) {
    throw DataError(DataCode::size, out.file(), "",
                    "hits over " + std::to_string(columns) + " by " + std::to_string(rows) + " cells",
                    "at most " + std::to_string(kMostCells) + " cells: larger ones");
  }
  Grid grid{columns, rows, std::vector<std::uint8_t>(columns * rows, 0)};
  for (const geometry::Vec2 hit : hits) grid.occupied[row(hit.y) * columns + column(hit.x)] = 1;
  out.note("", geometry::counted(hits.size(), "hit"));
  add_grid(grid, {{0.0, 0.0}, cell, 0.0, first_column, first_row}, out);
}

// --- CARMEN logs: "FLASER n r1 .. rn x y theta odom_x odom_y odom_theta ..." among lines of other kinds ---

/// No laser of these logs has more beams.
constexpr std::int64_t kMostBeams = 100000;

/// Beams over half a turn, from the right. An odd number has one at each end (181, 361), an even one leaves the last
/// out (180, 360).
double beam_bearing(std::size_t beam, std::size_t beams) {
  const std::size_t gaps = beams % 2 == 1 && beams > 1 ? beams - 1 : beams;
  return -geometry::kPi / 2 + geometry::kPi * static_cast<double>(beam) / static_cast<double>(gaps);
}

void add_scan(const LineReader& lines, const std::vector<std::string_view>& words, std::vector<geometry::Vec2>& hits) {
  if (words.size() < 2) lines.refuse(DataCode::wrong_count, "no number of beams", "FLASER n r1 .. rn x y theta");
  const std::int64_t stated = lines.to_integer(words[1]);
  if (stated < 0 || stated > kMostBeams || words.size() < static_cast<std::size_t>(stated) + 5) {
    lines.refuse(DataCode::wrong_count, geometry::counted(words.size(), "word"),
                 "FLASER, a number n, n ranges and a pose; n is " + std::to_string(stated));
  }
  const auto beams = static_cast<std::size_t>(stated);
  const Pose laser{{lines.to_number(words[beams + 2]), lines.to_number(words[beams + 3])},
                   lines.to_number(words[beams + 4])};
  for (std::size_t k = 0; k < beams; ++k) {
    const double range = lines.to_number(words[k + 2]);
    if (is_no_return(range)) continue;
    const geometry::Vec2 hit = hit_at(laser, beam_bearing(k, beams), range);
    if (!geometry::is_finite(hit)) lines.refuse(DataCode::not_finite, "a pose that is not finite", "a finite pose");
    hits.push_back(hit);
  }
}

// --- CSM logs: JSON objects one after the other, a scan each; null stands for NaN ---

/// The next {...} of the text, found by its braces (those in strings do not count); empty at the end.
std::string_view next_object(std::string_view text, std::size_t& at, const std::string& file) {
  at = text.find_first_not_of(" \t\r\n,", at);
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at;
  JsonNesting nesting;
  do {
    nesting.take(text[at++]);
  } while (nesting.objects() > 0 && at < text.size());
  if (text[begin] == '{' && nesting.objects() == 0) return text.substr(begin, at - begin);
  throw DataError(DataCode::json_syntax, file, line_and_column(text, begin), excerpt(text, begin),
                  "a whole JSON object");
}

double number_or_nan(const JsonCursor& at) {
  return at.is_null() ? std::numeric_limits<double>::quiet_NaN() : at.number();
}

/// The first of these that is given in full: what the scan matcher made of it, what the wheels said, the truth.
Pose pose_of(const JsonCursor& scan) {
  for (const char* key : {"estimate", "odometry", "true_pose"}) {
    if (!scan.has(key) || scan.at(key).is_null() || scan.at(key).size() != 3) continue;
    const JsonCursor pose = scan.at(key);
    const Pose laser{{number_or_nan(pose.at(std::size_t{0})), number_or_nan(pose.at(1))}, number_or_nan(pose.at(2))};
    if (geometry::is_finite(laser.position) && std::isfinite(laser.heading)) return laser;
  }
  return {};
}

bool is_valid(const JsonCursor& scan, std::size_t k) {
  if (!scan.has("valid")) return true;
  const JsonCursor flag = scan.at("valid").at(k);
  return flag.json().is_boolean() ? flag.truth() : flag.number() != 0.0;
}

void add_scan(const JsonCursor& scan, std::vector<geometry::Vec2>& hits) {
  const Pose laser = pose_of(scan);
  const JsonCursor readings = scan.at("readings");
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double range = number_or_nan(readings.at(k));
    if (!is_valid(scan, k) || is_no_return(range)) continue;
    const geometry::Vec2 hit = hit_at(laser, scan.at("theta").at(k).number(), range);
    if (!geometry::is_finite(hit)) readings.at(k).refuse("a finite hit", DataCode::not_finite);
    hits.push_back(hit);
  }
}

// --- Unordered points, in metres: "x, y" in each line, with a comma, a semicolon, a tab or blanks between. A first
// line of words is a header. ---

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

bool looks_like_carmen_log(const FormatProbe& probe) {
  const std::string& text = probe.beginning;
  return text.rfind("FLASER ", 0) == 0 || text.find("\nFLASER ") != std::string::npos ||
         text.rfind("# CARMEN Logfile", 0) == 0;
}

void read_carmen_log(const std::filesystem::path& path, Collector& out) {
  LineReader lines(read_text_file(path), out.file());
  std::vector<geometry::Vec2> hits;
  std::size_t scans = 0;
  while (lines.next()) {
    if (lines.line().substr(0, 7) != "FLASER ") continue;
    add_scan(lines, words_of(lines.line()), hits);
    ++scans;
  }
  out.note("", geometry::counted(scans, "scan"));
  add_hits(hits, out);
}

bool looks_like_csm_log(const FormatProbe& probe) {
  return probe.beginning.find('{') < 8 && probe.beginning.find("\"nrays\"") != std::string::npos;
}

void read_csm_log(const std::filesystem::path& path, Collector& out) {
  const std::string text = read_text_file(path);
  std::vector<geometry::Vec2> hits;
  std::size_t scans = 0;
  for (std::size_t at = 0;;) {
    const std::string_view object = next_object(text, at, out.file());
    if (object.empty()) break;
    const Json tree = parse_json(object, out.file());
    add_scan(JsonCursor(tree, out.file(), "scan " + std::to_string(scans++)), hits);
  }
  out.note("", geometry::counted(scans, "scan"));
  add_hits(hits, out);
}

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
  LineReader lines(read_text_file(path), out.file());
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
