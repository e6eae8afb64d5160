// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/lp_lines.h"

#include <sstream>
#include <stdexcept>

#include "exactvo/datasets/data_error.h"
#include "exactvo/vo/lp/instances.h"

namespace exactvo::tools {
namespace {

using datasets::DataCode;
using datasets::DataError;
using nlohmann::json;

/// A field of one line, with what is needed to say where it is wrong.
class Field {
 public:
  Field(const json& value, std::string place, const std::string& file)
      : value_(value), place_(std::move(place)), file_(file) {}

  [[noreturn]] void refuse(DataCode code, const std::string& expected) const {
    throw DataError(code, file_, place_, value_.dump().substr(0, 60), expected);
  }

  bool has(const char* key) const {
    if (!value_.is_object()) refuse(DataCode::wrong_type, "an object");
    return value_.contains(key);
  }

  Field at(const char* key) const {
    if (!has(key)) throw DataError(DataCode::key_missing, file_, place_, "no " + std::string(key), key);
    return {value_.at(key), place_ + "/" + key, file_};
  }

  std::vector<Field> items() const {
    if (!value_.is_array()) refuse(DataCode::wrong_type, "a list");
    std::vector<Field> fields;
    for (std::size_t k = 0; k < value_.size(); ++k)
      fields.emplace_back(value_[k], place_ + "/" + std::to_string(k), file_);
    return fields;
  }

  double number() const {
    if (!value_.is_number()) refuse(DataCode::wrong_type, "a number");
    return value_.get<double>();
  }

  lp::Vec2 vector() const {
    const std::vector<Field> both = items();
    if (both.size() != 2) refuse(DataCode::wrong_count, "two numbers");
    return {both[0].number(), both[1].number()};
  }

  bool is_second_of(const char* first, const char* second) const {
    if (value_ == first) return false;
    if (value_ != second) refuse(DataCode::not_an_option, std::string(first) + " or " + second);
    return true;
  }

 private:
  const json& value_;
  std::string place_;
  const std::string& file_;
};

lp::SpeedBound bound_of(const Field& field) {
  lp::SpeedBound bound;
  if (field.has("disc")) bound.disc = field.at("disc").number();
  if (!field.has("box")) return bound;
  const lp::Vec2 box = field.at("box").vector();
  bound.box_x = box.x;
  bound.box_y = box.y;
  return bound;
}

lp::Constraint constraint_of(const Field& field) {
  lp::Constraint c;
  c.half_plane = {field.at("normal").vector(), field.at("offset").number()};
  if (field.has("priority") && field.at("priority").is_second_of("hard", "soft")) c.priority = lp::Priority::soft;
  if (field.has("label")) c.label = static_cast<int>(field.at("label").number());
  return c;
}

lp::Problem problem_of(const Field& field) {
  lp::Problem problem;
  problem.preferred = field.at("preferred").vector();
  if (field.has("bound")) problem.bound = bound_of(field.at("bound"));
  if (field.has("objective") && field.at("objective").is_second_of("nearest", "farthest"))
    problem.objective = lp::Objective::farthest;
  for (const Field& line : field.at("constraints").items()) problem.constraints.push_back(constraint_of(line));
  return problem;
}

lp::Problem parse_line(const std::string& text, std::size_t number, const std::string& file) {
  const std::string place = "line " + std::to_string(number);
  json value;
  try {
    value = json::parse(text);
  } catch (const json::exception& e) {
    throw DataError(DataCode::json_syntax, file, place, text.substr(0, 60), std::string("JSON; ") + e.what());
  }
  lp::Problem problem = problem_of(Field(value, place + " ", file));
  try {
    require_well_formed(problem);
  } catch (const std::logic_error& e) {
    throw DataError(DataCode::out_of_range, file, place, e.what(), "a well-formed problem");
  }
  return problem;
}

std::vector<lp::Problem> read_lines(const std::string& bytes, const std::string& file) {
  std::vector<lp::Problem> problems;
  std::istringstream in(bytes);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") != std::string::npos) problems.push_back(parse_line(line, number, file));
  }
  return problems;
}

std::vector<lp::Problem> read_binary(const std::string& bytes, const std::string& file) {
  std::istringstream in(bytes);
  try {
    return lp::read_instances(in);
  } catch (const lp::InstanceError& e) {
    throw DataError(DataCode::format_syntax, file, e.place, e.found, e.expected);
  }
}

/// A line of JSON starts with `{` and a quotation mark or a brace; the count of a binary file does not look like that
/// below half a million instances.
bool looks_like_json(const std::string& bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return true;
  if (bytes[first] != '{') return false;
  const std::size_t second = bytes.find_first_not_of(" \t\r\n", first + 1);
  return second == std::string::npos || bytes[second] == '"' || bytes[second] == '}';
}

nlohmann::ordered_json name_of(std::size_t index) {
  switch (index) {
    case lp::kSpeedBound:
      return "disc";
    case lp::kBoxRight:
      return "box-right";
    case lp::kBoxLeft:
      return "box-left";
    case lp::kBoxTop:
      return "box-top";
    case lp::kBoxBottom:
      return "box-bottom";
    default:
      return index;
  }
}

nlohmann::ordered_json terms_json(const std::vector<lp::Term>& terms) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const lp::Term& term : terms)
    list.push_back({{"constraint", name_of(term.constraint)}, {"multiplier", term.multiplier}});
  return list;
}

nlohmann::ordered_json certificate_json(const lp::Certificate& c) {
  nlohmann::ordered_json out = {
      {"bound", terms_json(c.bound)}, {"contradiction", terms_json(c.contradiction)}, {"gap", c.gap}};
  if (c.status != lp::Status::pinched) return out;
  out["vertex"] = nlohmann::ordered_json::array();
  for (const std::size_t index : c.vertex) out["vertex"].push_back(name_of(index));
  return out;
}

}  // namespace

std::vector<lp::Problem> read_problems(const std::string& bytes, const std::string& file) {
  return looks_like_json(bytes) ? read_lines(bytes, file) : read_binary(bytes, file);
}

nlohmann::ordered_json result_line(std::size_t index, const lp::Proven& answer) {
  const lp::Solution& s = answer.solution;
  nlohmann::ordered_json out = {{"index", index},
                                {"status", name(s.status)},
                                {"velocity", {s.velocity.x, s.velocity.y}},
                                {"violation", s.violation},
                                {"active", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < s.active_count; ++k) out["active"].push_back(name_of(s.active[k]));
  out["certificate"] = answer.certificate ? certificate_json(*answer.certificate) : nlohmann::ordered_json();
  return out;
}

}  // namespace exactvo::tools
