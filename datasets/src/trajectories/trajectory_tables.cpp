// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectories as tables: CSV with a header, the text of JuPedSim and PedPy, obsmat.txt of ETH and UCY, and four
// columns of numbers (frame, id, x, y).
#include <algorithm>
#include <array>
#include <boost/algorithm/string/join.hpp>
#include <cctype>
#include <cmath>
#include <optional>

#include "exactvo/datasets/input_text.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "readers/line_reader.h"
#include "trajectories/trajectory_readers.h"

namespace exactvo::datasets {
namespace {

/// The first line that is not blank.
std::string_view first_line(std::string_view text) {
  text = without_mark(text);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty()) return line;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return {};
}

bool is_number(std::string_view field) {
  double value = 0.0;
  return parse_whole(field, value);
}

/// How many numbers, and nothing else, a line holds, parted by blanks.
std::size_t numbers_in(std::string_view line) {
  std::vector<std::string_view> fields;
  split(line, ' ', fields);
  return std::all_of(fields.begin(), fields.end(), is_number) ? fields.size() : 0;
}

/// Ids that are whole numbers in the form 1.0000000e+00 get their plain form. Only for tables that hold nothing but
/// numbers: elsewhere ids are texts, and 007 is another one than 7.
std::string_view plain_id(std::string_view field, std::string& memory) {
  double value = 0.0;
  constexpr double kLargestWhole = 0x1p53;
  if (!parse_whole(field, value) || value != std::floor(value) || std::fabs(value) > kLargestWhole) return field;
  memory = std::to_string(static_cast<std::int64_t>(value));
  return memory;
}

// --- Columns ---

enum Column : std::size_t {
  kTimeColumn,
  kFrameColumn,
  kIdColumn,
  kXColumn,
  kYColumn,
  kHeadingColumn,
  kVxColumn,
  kVyColumn,
  kQxColumn,  // of a quaternion, which has the heading
  kQyColumn,
  kQzColumn,
  kQwColumn,
  kColumnKinds
};
constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
using Columns = std::array<std::size_t, kColumnKinds>;

/// The column of times that rostopic writes.
constexpr const char* kNanoseconds = "%time";

/// The names by which columns are known, the best first. A name with a dot is also the end of a longer one, if of one
/// column alone: exports of ROS bags have the topic and the message's parts before it, parted by dots or slashes.
const std::array<std::vector<std::string>, kColumnKinds> kColumnNames{
    {{"t", "time", "time_s", "timestamp", "timestamp_s", "t_s", "time/s", "t/s", "__time", kNanoseconds},
     {"frame", "frame_id", "fr", "f"},
     {"id", "agent", "agent_id", "robot", "robot_id", "track_id", "ped_id", "pedestrian", "vehicle", "name"},
     {"x", "x_m", "x/m", "pos_x", "position_x", "x/cm", "position.x", "translation.x"},
     {"y", "y_m", "y/m", "pos_y", "position_y", "y/cm", "position.y", "translation.y"},
     {"theta", "heading", "yaw", "theta_rad", "heading_rad", "yaw_rad", "psi_rad"},
     {"vx", "v_x", "vx_m_s", "vel_x", "velocity_x"},
     {"vy", "v_y", "vy_m_s", "vel_y", "velocity_y"},
     {"qx", "orientation.x", "rotation.x"},
     {"qy", "orientation.y", "rotation.y"},
     {"qz", "orientation.z", "rotation.z"},
     {"qw", "orientation.w", "rotation.w"}}};

/// In names of columns that are no heading in radians, and may be meant as one.
constexpr std::array<std::string_view, 6> kHeadingWords{"theta", "heading", "yaw", "angle", "orient", "bearing"};

bool ends_in_part(const std::string& name, const std::string& end) {
  if (name.size() <= end.size() || end.find('.') == std::string::npos) return false;
  std::string last = name.substr(name.size() - end.size() - 1);
  std::replace(last.begin(), last.end(), '/', '.');
  return last == "." + end;
}

/// Where each column stands; a name of `kColumnNames` that comes twice counts the first time.
Columns columns_in(const std::vector<std::string_view>& header) {
  Columns columns;
  columns.fill(kNoColumn);
  std::vector<std::string> names;
  for (const std::string_view field : header) names.push_back(lower_case(std::string(field)));
  for (std::size_t c = 0; c < kColumnKinds; ++c)
    for (const std::string& name : kColumnNames[c]) {
      auto at = std::find(names.begin(), names.end(), name);
      const auto is_long = [&](const std::string& one) { return ends_in_part(one, name); };
      if (at == names.end() && std::count_if(names.begin(), names.end(), is_long) == 1)
        at = std::find_if(names.begin(), names.end(), is_long);
      if (at == names.end()) continue;
      columns[c] = static_cast<std::size_t>(at - names.begin());
      break;
    }
  return columns;
}

/// The columns of rows without a header: frames, ids and places alone.
Columns numbered(std::size_t frame, std::size_t id, std::size_t x, std::size_t y) {
  Columns columns;
  columns.fill(kNoColumn);
  columns[kFrameColumn] = frame;
  columns[kIdColumn] = id;
  columns[kXColumn] = x;
  columns[kYColumn] = y;
  return columns;
}

/// A name that may mean a heading, of a table that has none that is known: in another unit, or half a quaternion.
void note_headings_left_out(const std::vector<std::string_view>& header, const Columns& columns, TrajectoryFile& file) {
  const bool has_quaternion = std::count(columns.begin() + kQxColumn, columns.begin() + kColumnKinds, kNoColumn) == 0;
  if (columns[kHeadingColumn] != kNoColumn || has_quaternion) return;
  for (const std::string_view field : header) {
    const std::string name = lower_case(std::string(field));
    const bool is_like_one = std::any_of(kHeadingWords.begin(), kHeadingWords.end(),
                                         [&](std::string_view word) { return name.find(word) != std::string::npos; });
    if (!is_like_one && name != "psi" && name != "qz" && name != "rz") continue;
    std::string known;
    for (const std::string& one : kColumnNames[kHeadingColumn]) known += (known.empty() ? "" : ", ") + one;
    file.notes.push_back("the column \"" + std::string(field) +
                         "\" is not read as headings; those, in radians, are called " + known);
  }
}

bool has_place_and_time(const Columns& c) {
  return c[kXColumn] != kNoColumn && c[kYColumn] != kNoColumn &&
         (c[kTimeColumn] != kNoColumn || c[kFrameColumn] != kNoColumn);
}

char separator_of(std::string_view header) {
  for (const char c : {',', ';', '\t'})
    if (header.find(c) != std::string_view::npos) return c;
  return ' ';
}

enum class Ids { texts, numbers };

/// The rows behind a header.
class TableRows {
 public:
  TableRows(const Columns& columns, std::size_t count, Ids ids, TrajectorySink& out)
      : columns_(columns), count_(count), ids_(ids), out_(out) {
    if (columns_[kIdColumn] == kNoColumn) out.has_no_ids();
  }

  /// Frames a second, where the file says; units of length in m.
  double frame_rate = 0.0, unit = 1.0;
  double time_unit = 1.0;  ///< s
  bool has_names = false;  ///< a row has no more fields than the header; an empty one may follow

  void add(const std::vector<std::string_view>& fields, std::uint64_t line) {
    const bool ends_in_a_comma = fields.size() == count_ + 1 && fields.back().empty();
    if (fields.size() < count_ || (has_names && fields.size() > count_ && !ends_in_a_comma))
      out_.refuse(DataCode::wrong_count, line, std::to_string(fields.size()) + " fields",
                  std::to_string(count_) + " fields, as the header has");
    const auto number = [&](Column c, const char* what) { return out_.number(fields[columns_[c]], what, line); };
    const double time = columns_[kTimeColumn] != kNoColumn
                            ? time_unit * number(kTimeColumn, "a time")
                            : out_.time_of_frame(number(kFrameColumn, "a frame"), frame_rate);
    const auto has = [&](Column c) { return columns_[c] != kNoColumn && !trimmed(fields[columns_[c]]).empty(); };
    double heading = std::numeric_limits<double>::quiet_NaN();
    if (has(kHeadingColumn)) {
      heading = number(kHeadingColumn, "a heading");
    } else if (has(kQxColumn) && has(kQyColumn) && has(kQzColumn) && has(kQwColumn)) {
      const char* what = "a part of a quaternion";
      const double x = number(kQxColumn, what), y = number(kQyColumn, what);
      const double z = number(kQzColumn, what), w = number(kQwColumn, what);
      if (x != 0.0 || y != 0.0 || z != 0.0 || w != 0.0)  // 0 0 0 0 stands in messages without an orientation
        heading = std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
    }
    std::string_view id = columns_[kIdColumn] == kNoColumn ? std::string_view("agent") : fields[columns_[kIdColumn]];
    if (ids_ == Ids::numbers) id = plain_id(id, memory_);
    if (id.empty()) out_.refuse(DataCode::format_syntax, line, "an empty id", "the id of an agent");
    geometry::Vec2 velocity = TrajectoryRow().velocity;
    if (columns_[kVxColumn] != kNoColumn && columns_[kVyColumn] != kNoColumn)
      velocity = {unit * number(kVxColumn, "a velocity"), unit * number(kVyColumn, "a velocity")};
    out_.row(out_.agent(id), time, {unit * number(kXColumn, "x"), unit * number(kYColumn, "y")}, line, heading,
             velocity);
  }

 private:
  Columns columns_;
  std::size_t count_;
  Ids ids_;
  TrajectorySink& out_;
  std::string memory_;
};

/// m, of a unit of length of the places, which their names tell.
double unit_in(const std::vector<std::string_view>& header, const Columns& columns) {
  return lower_case(std::string(header[columns[kXColumn]])) == "x/cm" ? 0.01 : 1.0;
}

/// Rows of numbers without a header.
void read_numbers(const std::filesystem::path& path, const Columns& columns, std::size_t count, TrajectorySink& out) {
  TextLines lines(path.string(), kLongestRow);
  TableRows rows(columns, count, Ids::numbers, out);
  std::vector<std::string_view> fields;
  for (std::string_view line; lines.next(line);) {
    split(lines.number() == 1 ? without_mark(line) : line, ' ', fields);
    if (!fields.empty() && fields.front().front() != '#') rows.add(fields, lines.number());
  }
}

/// The fields of a line of CSV; the quoted ones are kept in `quoted`. False where a quotation mark is not closed.
bool split_csv(std::string_view line, char separator, std::vector<std::string_view>& fields,
               std::optional<std::vector<std::string>>& quoted) {
  if (separator == ' ' || line.find('"') == std::string_view::npos) {
    split(line, separator, fields);
    return true;
  }
  quoted = csv_fields_of(line, separator);
  if (quoted) fields.assign(quoted->begin(), quoted->end());
  return quoted.has_value();
}

/// The names of columns that a line has. A comment may have them too: its mark is left out.
std::string_view header_in(std::string_view line) {
  return trimmed(line.substr(line.front() == '#' ? 1 : 0));
}

/// What a header is to have, and this one lacks.
std::string words_of_header(const Columns& columns) {
  std::vector<std::string> missing;
  if (columns[kTimeColumn] == kNoColumn && columns[kFrameColumn] == kNoColumn) missing.emplace_back("t");
  if (columns[kXColumn] == kNoColumn) missing.emplace_back("x");
  if (columns[kYColumn] == kNoColumn) missing.emplace_back("y");
  return "a header with the columns t,id,x,y and, where there is one, theta: it has no " +
         boost::join(missing, ", no ") + " (also time, frame, x_m, x/cm; of another length --scale says the metres)";
}

}  // namespace

bool looks_like_trajectory_csv(std::string_view beginning) {
  std::vector<std::string_view> fields;
  std::optional<std::vector<std::string>> quoted;
  for (std::string_view line = first_line(beginning); !line.empty(); line = first_line(beginning)) {
    const std::string_view header = header_in(line);
    if (split_csv(header, separator_of(header), fields, quoted) && has_place_and_time(columns_in(fields))) return true;
    if (line.front() != '#') return false;
    beginning.remove_prefix(static_cast<std::size_t>(line.data() + line.size() - beginning.data()));
  }
  return false;
}

std::string what_a_header_lacks(std::string_view beginning) {
  const std::string_view line = first_line(beginning);
  std::vector<std::string_view> fields;
  std::optional<std::vector<std::string>> quoted;
  constexpr std::size_t kFewest = 3;
  const auto is_name = [](std::string_view field) {
    return !field.empty() && std::isalpha(static_cast<unsigned char>(field.front())) != 0;
  };
  const bool is_header = split_csv(line, separator_of(line), fields, quoted) && fields.size() >= kFewest &&
                         separator_of(line) != ' ' && std::all_of(fields.begin(), fields.end(), is_name);
  return is_header ? words_of_header(columns_in(fields)) : "";
}

void read_trajectory_csv(const std::filesystem::path& path, TrajectorySink& out) {
  TextLines lines(path.string(), kLongestRow);
  std::optional<TableRows> rows;
  std::vector<std::string_view> fields;
  std::optional<std::vector<std::string>> quoted;
  char separator = ',';
  for (std::string_view line; lines.next(line);) {
    line = trimmed(lines.number() == 1 ? without_mark(line) : line);
    if (line.empty() || (rows && line.front() == '#')) continue;
    const bool is_comment = line.front() == '#';
    if (!rows) line = header_in(line), separator = separator_of(line);
    if (!split_csv(line, separator, fields, quoted)) {
      if (is_comment) continue;
      out.refuse(DataCode::format_syntax, lines.number(), "a quotation mark that is not closed",
                 "CSV whose fields end on their line");
    }
    if (rows) {
      rows->add(fields, lines.number());
      continue;
    }
    Columns columns = columns_in(fields);
    if (!has_place_and_time(columns)) {
      if (is_comment) continue;
      out.refuse(DataCode::format_syntax, lines.number(), excerpt(line, 0, 60), words_of_header(columns));
    }
    note_headings_left_out(fields, columns, out.file());
    const double unit = unit_in(fields, columns);
    if (unit != 1.0) columns[kVxColumn] = columns[kVyColumn] = kNoColumn;  // whose unit no name tells
    rows.emplace(columns, fields.size(), Ids::texts, out);
    rows->unit = unit;
    rows->has_names = true;
    if (columns[kTimeColumn] != kNoColumn && fields[columns[kTimeColumn]] == kNanoseconds) rows->time_unit = 1e-9;
  }
}

bool looks_like_jupedsim_text(std::string_view beginning) {
  const std::string_view text = without_mark(beginning);
  if (text.substr(0, 1) != "#") return false;
  const std::string lower = lower_case(std::string(text));
  return lower.find("framerate") != std::string::npos || lower.find("#id\t") != std::string::npos ||
         lower.find("# id ") != std::string::npos;
}

void read_jupedsim_text(const std::filesystem::path& path, TrajectorySink& out) {
  Columns columns = numbered(1, 0, 2, 3);
  std::size_t count = 4;
  double frame_rate = 0.0, unit = 1.0;
  TextLines lines(path.string(), kLongestRow);
  std::optional<TableRows> rows;
  std::vector<std::string_view> fields;
  for (std::string_view line; lines.next(line);) {
    line = trimmed(lines.number() == 1 ? without_mark(line) : line);
    if (line.empty()) continue;
    if (line.front() != '#') {
      if (!rows) {
        rows.emplace(columns, count, Ids::texts, out);
        rows->frame_rate = frame_rate;
        rows->unit = unit;
      }
      split(line, ' ', fields);
      rows->add(fields, lines.number());
      continue;
    }
    if (rows) continue;
    line = trimmed(line.substr(1));
    const std::string lower = lower_case(std::string(line));
    if (lower.rfind("framerate", 0) == 0) {
      const std::size_t number = lower.find_first_of("0123456789");
      if (number == std::string::npos)
        out.refuse(DataCode::number, lines.number(), excerpt(line, 0, 40), "frames a second");
      frame_rate = out.number(line.substr(number, line.find_first_of(" \tf", number) - number), "frames a second",
                              lines.number());
      continue;
    }
    split(line, ' ', fields);
    const Columns named = columns_in(fields);
    if (!has_place_and_time(named) || named[kIdColumn] == kNoColumn) continue;
    columns = named;
    columns[kHeadingColumn] = kNoColumn;  // JuPedSim's ANGLE is that of an ellipse of its model
    std::fill(columns.begin() + kVxColumn, columns.end(), kNoColumn);
    count = 1 + std::max({named[kIdColumn], named[kXColumn], named[kYColumn],
                          named[kTimeColumn] == kNoColumn ? named[kFrameColumn] : named[kTimeColumn]});
    unit = unit_in(fields, named);
  }
}

bool looks_like_obsmat(std::string_view beginning) {
  constexpr std::size_t kFields = 8;
  return numbers_in(first_line(beginning)) == kFields;
}

void read_obsmat(const std::filesystem::path& path, TrajectorySink& out) {
  // frame, pedestrian, x, z, y, and three of the velocity
  read_numbers(path, numbered(0, 1, 2, 4), 8, out);
}

bool looks_like_four_columns(std::string_view beginning) {
  return numbers_in(first_line(beginning)) == 4;
}

void read_four_columns(const std::filesystem::path& path, TrajectorySink& out) {
  read_numbers(path, numbered(0, 1, 2, 3), 4, out);
}

}  // namespace exactvo::datasets
