// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/lp_problems.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include "exactvo/vo/lp/instances.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/line_reader.h"
#include "scenarios/schema_check.h"

namespace exactvo::datasets {
namespace {

using geometry::Vec2;

const Json& lp_schema_tree() {
  static const Json schema = parse_json(lp_schema(), "lp.schema.json");
  return schema;
}

/// A line that fits the schema, and what no schema can say of it.
class Line {
 public:
  Line(const Json& tree, const std::string& file) : tree_(tree), file_(file) {}

  lp::Problem problem() const {
    lp::Problem problem;
    tree_.at("preferred").get_to(problem.preferred);
    if (tree_.contains("bound")) problem.bound = to_bound(tree_.at("bound"));
    if (tree_.value("objective", "nearest") == "farthest") problem.objective = lp::Objective::farthest;
    const Json& constraints = tree_.at("constraints");
    for (std::size_t k = 0; k < constraints.size(); ++k)
      problem.constraints.push_back(to_constraint(constraints[k], "/constraints/" + std::to_string(k)));
    if (problem.objective == lp::Objective::farthest) check_direction(problem);
    return problem;
  }

 private:
  static lp::SpeedBound to_bound(const Json& object) {
    lp::SpeedBound bound;
    if (object.contains("disc")) bound.disc = object.at("disc").get<double>();
    if (!object.contains("box")) return bound;
    const Json& box = object.at("box");
    if (!box[0].is_null()) bound.box_x = box[0].get<double>();
    if (!box[1].is_null()) bound.box_y = box[1].get<double>();
    return bound;
  }

  lp::Constraint to_constraint(const Json& object, const std::string& at) const {
    lp::Constraint c;
    c.half_plane = {object.at("normal").get<Vec2>(), object.at("offset").get<double>()};
    if (c.half_plane.normal == Vec2{})
      refuse(DataCode::out_of_range, at + "/normal", "[0, 0]", "a normal that is not 0");
    if (object.value("priority", "hard") == "soft") c.priority = lp::Priority::soft;
    if (!object.contains("label")) return c;
    const double label = object.at("label").get<double>();
    if (label != std::floor(label))
      refuse(DataCode::wrong_type, at + "/label", object.at("label").dump(), "a whole number");
    c.label = static_cast<int>(label);
    return c;
  }

  void check_direction(const lp::Problem& problem) const {
    const lp::SpeedBound& b = problem.bound;
    if (problem.preferred == Vec2{})
      refuse(DataCode::out_of_range, "/preferred", "[0, 0]", "a direction that is not 0");
    if (std::isfinite(b.disc) || (std::isfinite(b.box_x) && std::isfinite(b.box_y))) return;
    const bool half = std::isfinite(b.box_x) || std::isfinite(b.box_y);
    refuse(DataCode::no_alternative, "/bound", half ? "a box with one side" : "no bound",
           "a disc or a box, for the objective farthest");
  }

  [[noreturn]] void refuse(DataCode code, const std::string& at, const std::string& found,
                           const std::string& expected) const {
    throw DataError(code, file_, at, found, expected);
  }

  const Json& tree_;
  const std::string& file_;
};

lp::Problem parse_line(const std::string& text, std::size_t number, const std::string& file) {
  const Json tree = parse_json_line(text, file, number);
  try {
    check_against_schema(tree, lp_schema_tree(), file);
    return Line(tree, file).problem();
  } catch (const DataError& e) {
    const std::string line = "line " + std::to_string(number);
    throw DataError(e.code(), file, line + (e.place().empty() ? "" : ", " + e.place()), e.found(), e.expected());
  }
}

/// One problem over several lines, as a formatter writes it.
lp::Problem parse_document(const std::string& bytes, const std::string& file) {
  const auto tree = [&] {
    try {
      return parse_json(bytes, file);
    } catch (const DataError& e) {
      throw DataError(e.code(), file, e.place(), e.found(),
                      e.expected() + "; one JSON document per line, or one document over several lines");
    }
  }();
  check_against_schema(tree, lp_schema_tree(), file);
  return Line(tree, file).problem();
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

std::vector<lp::Problem> read_lines(const std::string& bytes, const std::string& file) {
  std::vector<lp::Problem> problems;
  std::size_t number = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string line = bytes.substr(at, end - at);
    at = end + 1;
    ++number;
    if (is_blank(line)) continue;
    const bool is_whole =
        !problems.empty() || at >= bytes.size() || is_blank(std::string_view(bytes).substr(at)) || Json::accept(line);
    if (!is_whole) return {parse_document(bytes, file)};
    problems.push_back(parse_line(line, number, file));
  }
  return problems;
}

/// CSV: a row per half-plane; the rows of a problem follow each other and repeat what belongs to the whole.
class Table {
 public:
  Table(const std::string& bytes, const std::string& file) : rows_(bytes, file) {}

  std::vector<lp::Problem> read(std::vector<std::string>* names) {
    rows_.read_header({"problem", "disc", "preferred_x", "preferred_y", "normal_x", "normal_y", "offset", "priority"},
                      7,
                      "a header with the columns problem, disc, preferred_x, preferred_y, normal_x, normal_y, offset "
                      "and, where wanted, priority");
    std::vector<lp::Problem> problems;
    while (rows_.next_row()) {
      if (problems.empty() || field("problem") != number_) {
        number_ = field("problem");
        problems.push_back(whole());
        if (names) names->push_back(number_);
      } else {
        require_same(problems.back());
      }
      if (!field("normal_x").empty() || !field("normal_y").empty() || !field("offset").empty())
        problems.back().constraints.push_back(constraint());
    }
    return problems;
  }

 private:
  const std::string& field(const char* name) const { return rows_.field(name); }

  double number(const char* name, double least = -kMost) const {
    const double value = rows_.to_number(field(name));
    if (!(value >= least && value <= kMost))
      rows_.refuse(DataCode::out_of_range, std::string(name) + " " + field(name),
                   least < 0.0 ? "-1e90 to 1e90" : "0 to 1e90");
    return value;
  }

  lp::Problem whole() const {
    lp::Problem problem;
    if (!field("disc").empty()) problem.bound.disc = number("disc", 0.0);
    problem.preferred = {number("preferred_x"), number("preferred_y")};
    return problem;
  }

  void require_same(const lp::Problem& before) const {
    const lp::Problem now = whole();
    if (now.preferred != before.preferred || now.bound.disc != before.bound.disc)
      rows_.refuse(DataCode::format_syntax, "another disc or preferred velocity in problem " + number_,
                   "the same in all rows of a problem");
  }

  lp::Constraint constraint() const {
    lp::Constraint c;
    c.half_plane = {{number("normal_x"), number("normal_y")}, number("offset")};
    if (c.half_plane.normal == Vec2{})
      rows_.refuse(DataCode::out_of_range, "the normal 0, 0", "a normal that is not 0");
    if (!rows_.has("priority")) return c;
    const std::string& priority = field("priority");
    if (priority == "soft") c.priority = lp::Priority::soft;
    if (priority != "soft" && priority != "hard" && !priority.empty())
      rows_.refuse(DataCode::not_an_option, priority, "hard or soft");
    return c;
  }

  static constexpr double kMost = 1e90;  // as in the schema

  CsvTable<LineReader> rows_;
  std::string number_;
};

std::vector<lp::Problem> read_binary(const std::string& bytes, const std::string& file) {
  std::istringstream in(bytes);
  try {
    return lp::read_instances(in);
  } catch (const lp::InstanceError& e) {
    throw DataError(DataCode::format_syntax, file, e.place, e.found, e.expected);
  }
}

constexpr const char* kFormats =
    "lines of JSON, an object each, or CSV with a column preferred_x, or binary instances: their count (int32, little "
    "endian), then 20 bytes or more each";

/// How many problems a binary file says it has; none where there are no four bytes.
std::optional<std::int32_t> count_of(const std::string& bytes) {
  if (bytes.size() < 4) return std::nullopt;
  std::uint32_t count = 0;
  for (std::size_t k = 4; k-- > 0;) count = count << 8 | static_cast<unsigned char>(bytes[k]);
  return static_cast<std::int32_t>(count);
}

/// Text has no zero byte; a count below 2^24 has one.
bool begins_as_text(const std::string& bytes) {
  return bytes.substr(0, 4).find('\0') == std::string::npos;
}

bool holds_its_count(const std::string& bytes) {
  constexpr std::uint64_t kLeastInstance = 20;  // m, m_hard, v_max, v_pref
  const std::optional<std::int32_t> count = count_of(bytes);
  return count && *count >= 0 && kLeastInstance * static_cast<std::uint64_t>(*count) <= bytes.size() - 4;
}

DataError neither_format(const std::string& bytes, const std::string& file) {
  if (is_blank(bytes))
    return {DataCode::format_unknown, file, "", bytes.empty() ? "an empty file" : "blank lines alone", kFormats};
  const bool is_text = begins_as_text(bytes) || bytes.size() < 4;
  const std::size_t at = is_text ? std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()) : 0;
  return {DataCode::format_unknown, file, is_text ? line_and_column(bytes, at) : "byte 0",
          is_text ? excerpt(bytes, at)
                  : "a count of " + std::to_string(*count_of(bytes)) + " and " + std::to_string(bytes.size() - 4) +
                        " bytes after it",
          kFormats};
}

}  // namespace

std::vector<lp::Problem> parse_lp_problems(const std::string& bytes, const std::string& file_name,
                                           std::vector<std::string>* names) {
  if (names) names->clear();
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first != std::string::npos && begins_as_text(bytes)) {
    // Objects, lists and texts: what is wrong with them has a line and a column.
    if (std::strchr("{[\"", bytes[first]) != nullptr) return read_lines(bytes, file_name);
    const std::string_view columns = std::string_view(bytes).substr(first, bytes.find('\n', first) - first);
    if (columns.find("preferred_x") != std::string_view::npos) return Table(bytes, file_name).read(names);
  }
  if (holds_its_count(bytes)) return read_binary(bytes, file_name);
  throw neither_format(bytes, file_name);
}

}  // namespace exactvo::datasets
