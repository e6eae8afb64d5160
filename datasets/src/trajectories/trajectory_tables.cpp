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
#include "json/json_text.h"
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

/// A unit that the name of a column may state: how many of it make one m, s, m/s or rad.
struct ColumnUnit {
  const char* word;
  double in_si;
};
using ColumnUnits = std::vector<ColumnUnit>;
const ColumnUnits kLengths{{"m", 1.0}, {"cm", 1e2}, {"mm", 1e3}};
const ColumnUnits kTimes{{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"\u00b5s", 1e6}, {"\u03bcs", 1e6}, {"ns", 1e9}};
const ColumnUnits kSpeeds{{"m/s", 1.0}, {"cm/s", 1e2}, {"mm/s", 1e3}};
const ColumnUnits kAngles{{"rad", 1.0}};
constexpr ColumnUnit kNotStated{"", 1.0};

/// The column of times that rostopic writes, in ns.
constexpr const char* kNanoseconds = "%time";

/// Where each column stands, and the unit that its name states.
struct Columns {
  std::array<std::size_t, kColumnKinds> at;
  std::array<ColumnUnit, kColumnKinds> units;
  std::string twice;  ///< a column that stands twice, in words; empty if none does
  std::string clash;  ///< two columns that differ in their units alone, in words; empty if there are none

  Columns() {
    at.fill(kNoColumn);
    units.fill(kNotStated);
  }
  std::size_t& operator[](std::size_t column) { return at[column]; }
  std::size_t operator[](std::size_t column) const { return at[column]; }
  bool states_unit(Column column) const { return *units[column].word != '\0'; }
};

struct ColumnNames {
  std::vector<std::string> names;  ///< the best first
  ColumnUnits units = {};          ///< that may follow a name: x_mm, x/mm, "x [mm]", "x (mm)"
};

/// The names by which columns are known. A name with a dot is also the end of a longer one, if of one column alone:
/// exports of ROS bags have the topic and the message's parts before it, parted by dots or slashes.
const std::array<ColumnNames, kColumnKinds> kColumnNames{
    {{{"t", "time", "timestamp", "__time", kNanoseconds}, kTimes},
     {{"frame", "frame_id", "fr", "f"}},
     {{"id", "agent", "agent_id", "robot", "robot_id", "track_id", "ped_id", "pedestrian", "vehicle", "name"}},
     {{"x", "pos_x", "position_x", "position.x", "translation.x"}, kLengths},
     {{"y", "pos_y", "position_y", "position.y", "translation.y"}, kLengths},
     {{"theta", "heading", "yaw", "psi_rad"}, kAngles},
     {{"vx", "v_x", "vel_x", "velocity_x"}, kSpeeds},
     {{"vy", "v_y", "vel_y", "velocity_y"}, kSpeeds},
     {{"qx", "orientation.x", "rotation.x"}},
     {{"qy", "orientation.y", "rotation.y"}},
     {{"qz", "orientation.z", "rotation.z"}},
     {{"qw", "orientation.w", "rotation.w"}}}};

/// In names of columns that are no heading in radians, and may be meant as one.
constexpr std::array<std::string_view, 6> kHeadingWords{"theta", "heading", "yaw", "angle", "orient", "bearing"};

bool ends_in_part(const std::string& name, const std::string& end) {
  if (name.size() <= end.size() || end.find('.') == std::string::npos) return false;
  std::string last = name.substr(name.size() - end.size() - 1);
  std::replace(last.begin(), last.end(), '/', '.');
  return last == "." + end;
}

bool ends_in(std::string_view text, std::string_view end) {
  return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

/// A name of a column in lower case, without the unit that it states.
struct BareName {
  std::string name;
  ColumnUnit unit;
};

BareName without_unit(const std::string& name, const ColumnUnits& units) {
  const bool has_brackets = ends_in(name, "]") || ends_in(name, ")");
  const std::size_t open = has_brackets ? name.find_last_of("[(") : std::string::npos;
  for (const ColumnUnit& unit : units) {
    std::string plain = unit.word;
    std::replace(plain.begin(), plain.end(), '/', '_');  // vx_m_s
    if (open != std::string::npos) {
      const std::string_view within = trimmed(std::string_view(name).substr(open + 1, name.size() - open - 2));
      if (within != unit.word && within != plain) continue;
      const std::string_view before = trimmed(std::string_view(name).substr(0, open));
      return {std::string(ends_in(before, "_") ? before.substr(0, before.size() - 1) : before), unit};
    }
    for (const std::string& end : {"_" + plain, "/" + plain, "/" + std::string(unit.word)})
      if (ends_in(name, end)) return {name.substr(0, name.size() - end.size()), unit};
  }
  return {name, name == kNanoseconds ? kTimes.back() : kNotStated};
}

/// Where a column stands that has one of `known.names`.
void find_column(std::size_t column, const std::vector<std::string>& header, Columns& columns) {
  const ColumnNames& known = kColumnNames[column];
  std::vector<BareName> bare;
  for (const std::string& name : header) bare.push_back(without_unit(name, known.units));
  for (const std::string& name : known.names) {
    std::vector<std::size_t> found, longer;
    for (std::size_t k = 0; k < header.size(); ++k) {
      if (header[k] == name || bare[k].name == name) found.push_back(k);
      if (ends_in_part(bare[k].name, name)) longer.push_back(k);
    }
    if (found.empty() && longer.size() == 1) found = longer;
    if (found.empty()) continue;
    columns.at[column] = found.front();
    columns.units[column] =
        header[found.front()] == name && name != kNanoseconds ? kNotStated : bare[found.front()].unit;
    for (const std::size_t k : found)
      if (header[k] != header[found.front()])
        columns.clash = "the columns \"" + header[found.front()] + "\" and \"" + header[k] + "\"";
      else if (k != found.front())
        columns.twice = "the column \"" + header[k] + "\" a second time";
    return;
  }
}

Columns columns_in(const std::vector<std::string_view>& header) {
  Columns columns;
  std::vector<std::string> names;
  for (const std::string_view field : header) names.push_back(lower_case(std::string(field)));
  for (std::size_t c = 0; c < kColumnKinds; ++c) find_column(c, names, columns);
  return columns;
}

/// The columns of rows without a header: frames, ids and places alone.
Columns numbered(std::size_t frame, std::size_t id, std::size_t x, std::size_t y) {
  Columns columns;
  columns[kFrameColumn] = frame;
  columns[kIdColumn] = id;
  columns[kXColumn] = x;
  columns[kYColumn] = y;
  return columns;
}

/// A name that may mean a heading, of a table that has none that is known: in another unit, or half a quaternion.
void note_headings_left_out(const std::vector<std::string_view>& header, const Columns& columns, TrajectoryFile& file) {
  const bool has_quaternion =
      std::count(columns.at.begin() + kQxColumn, columns.at.begin() + kQwColumn + 1, kNoColumn) == 0;
  if (columns[kHeadingColumn] != kNoColumn || has_quaternion) return;
  for (const std::string_view field : header) {
    const std::string name = lower_case(std::string(field));
    const bool is_like_one = std::any_of(kHeadingWords.begin(), kHeadingWords.end(),
                                         [&](std::string_view word) { return name.find(word) != std::string::npos; });
    if (!is_like_one && name != "psi" && name != "qz" && name != "rz") continue;
    file.notes.push_back("the column \"" + std::string(field) +
                         "\" is not read as headings; those, in radians, are called " +
                         boost::join(kColumnNames[kHeadingColumn].names, ", "));
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

  double frame_rate = 0.0;  ///< frames a second, where the file says
  bool has_names = false;   ///< a row has no more fields than the header; an empty one may follow

  void add(const std::vector<std::string_view>& fields, std::uint64_t line) {
    const bool ends_in_a_comma = fields.size() == count_ + 1 && fields.back().empty();
    if (fields.size() < count_ || (has_names && fields.size() > count_ && !ends_in_a_comma))
      out_.refuse(DataCode::wrong_count, line, std::to_string(fields.size()) + " fields",
                  std::to_string(count_) + " fields, as the header has");
    const auto number = [&](Column c, const char* what) {
      return out_.number(fields[columns_[c]], what, line) / columns_.units[c].in_si;
    };
    const double time = columns_[kTimeColumn] != kNoColumn
                            ? number(kTimeColumn, "a time")
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
    const bool has_velocities = columns_[kVxColumn] != kNoColumn && columns_[kVyColumn] != kNoColumn;
    if (has_velocities && (has(kVxColumn) || has(kVyColumn)))
      velocity = {number(kVxColumn, "a velocity"), number(kVyColumn, "a velocity")};
    out_.row(out_.agent(id), time, {number(kXColumn, "x"), number(kYColumn, "y")}, line, heading, velocity);
  }

 private:
  Columns columns_;
  std::size_t count_;
  Ids ids_;
  TrajectorySink& out_;
  std::string memory_;
};

/// Refuses units that are ambiguous, leaves out velocities whose unit nothing tells, and notes what is read in another
/// unit than m, s or rad.
void settle_units(const std::vector<std::string_view>& header, std::uint64_t line, Columns& columns,
                  TrajectorySink& out) {
  const auto named = [&](Column c) { return "\"" + std::string(header[columns[c]]) + "\""; };
  const auto is_other = [&](Column c) { return columns.units[c].in_si != 1.0; };
  const auto refuse = [&](const std::string& found, const char* expected) {
    out.refuse(DataCode::not_an_option, line, found, expected);
  };
  if (!columns.twice.empty()) out.refuse(DataCode::json_duplicate_key, line, columns.twice, "each column once");
  if (!columns.clash.empty()) refuse(columns.clash, "one of them, since their names differ in the unit alone");
  const bool x_states = columns.states_unit(kXColumn), y_states = columns.states_unit(kYColumn);
  if (x_states != y_states && (is_other(kXColumn) || is_other(kYColumn)))
    refuse(named(kXColumn) + " and " + named(kYColumn) + ", of which one states no unit",
           "a unit in both names, or in none");
  if (out.scale() != 1.0 && (x_states || y_states))
    refuse("the scale " + number_text(out.scale()) + " for " + named(x_states ? kXColumn : kYColumn),
           "no scale where the name of a column states the unit");
  const bool has_velocities = columns[kVxColumn] != kNoColumn && columns[kVyColumn] != kNoColumn;
  const bool vx_states = columns.states_unit(kVxColumn);
  if (has_velocities && (vx_states != columns.states_unit(kVyColumn) || (!vx_states && is_other(kXColumn)))) {
    out.file().notes.push_back(named(kVxColumn) + " and " + named(kVyColumn) +
                               " are left out, since their names do not state the unit (vx_mm_s, \"vx [cm/s]\")");
    columns[kVxColumn] = columns[kVyColumn] = kNoColumn;
  }
  std::vector<std::string> others;
  for (const Column c : {kTimeColumn, kXColumn, kYColumn, kVxColumn, kVyColumn})
    if (columns[c] != kNoColumn && is_other(c)) others.push_back(named(c) + " in " + columns.units[c].word);
  if (!others.empty()) out.file().notes.push_back("read by their names: " + boost::join(others, ", "));
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
         boost::join(missing, ", no ") +
         " (also time, frame; units m, cm, mm and s, ms, us, ns as in x_mm, x/mm, \"x [mm]\"; of another length "
         "--scale says the metres)";
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

TrajectoryHeader read_trajectory_header(const std::vector<std::string>& names, double scale) {
  constexpr std::array<const char*, kColumnKinds> kMeanings{"t",  "frame", "id", "x",  "y",  "theta",
                                                            "vx", "vy",    "qx", "qy", "qz", "qw"};
  const std::vector<std::string_view> header(names.begin(), names.end());
  const TrajectoryOptions options{"", 0.0, scale};
  const std::function<void(const TrajectoryRow&)> take;
  TrajectoryFile file;
  file.file = "trajectories";
  file.row_word = "header, line";
  TrajectorySink sink(options, take, file);
  Columns columns = columns_in(header);
  note_headings_left_out(header, columns, file);
  settle_units(header, 1, columns, sink);
  TrajectoryHeader found;
  for (std::size_t c = 0; c < kColumnKinds; ++c)
    if (columns[c] != kNoColumn) found.columns.push_back({kMeanings[c], columns[c], columns.units[c].in_si});
  found.notes = file.notes;
  return found;
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
    settle_units(fields, lines.number(), columns, out);
    rows.emplace(columns, fields.size(), Ids::texts, out);
    rows->has_names = true;
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
  double frame_rate = 0.0;
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
      }
      split(line, ' ', fields);
      rows->add(fields, lines.number());
      continue;
    }
    if (rows) continue;
    line = trimmed(line.substr(1));
    const std::string lower = lower_case(std::string(line));
    if (lower.rfind("framerate", 0) == 0) {
      const std::size_t number = lower.find_first_of("-.0123456789");
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
    std::fill(columns.at.begin() + kVxColumn, columns.at.end(), kNoColumn);
    settle_units(fields, lines.number(), columns, out);
    count = 1 + std::max({named[kIdColumn], named[kXColumn], named[kYColumn],
                          named[kTimeColumn] == kNoColumn ? named[kFrameColumn] : named[kTimeColumn]});
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
