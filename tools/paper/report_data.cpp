// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <utility>

#include "exactvo/datasets/data_error.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using Json = ReportData::Json;

namespace {

const Json kNull;

/// A value of a file, with its place: what it should be and is not becomes a DataError.
class Place {
 public:
  Place(const Json& value, std::string file, std::string pointer = "")
      : value_(value), file_(std::move(file)), pointer_(std::move(pointer)) {}

  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }
  bool is_null() const { return value_.is_null(); }

  Place at(const std::string& key) const {
    need(value_.is_object(), "an object");
    if (!has(key))
      throw datasets::DataError(datasets::DataCode::key_missing, file_, pointer_, "no '" + key + "'", "'" + key + "'");
    return {value_[key], file_, pointer_ + "/" + key};
  }

  template <typename Check>
  void each(const Check& check) const {
    need(value_.is_array(), "a list");
    for (std::size_t i = 0; i < value_.size(); ++i) check(Place(value_[i], file_, pointer_ + "/" + std::to_string(i)));
  }

  void text() const { need(value_.is_string(), "text"); }
  void text_or_null() const { need(value_.is_string() || value_.is_null(), "text or null"); }
  void truth() const { need(value_.is_boolean(), "true or false"); }
  void count() const { need(value_.is_number_unsigned(), "a count"); }
  /// "nan" and the infinities are texts.
  void number_or_none() const {
    need(value_.is_number() || value_.is_null() || value_ == "nan" || value_ == "inf" || value_ == "-inf",
         "a number or null");
  }
  void word(const std::string& expected) const { need(value_ == expected, "\"" + expected + "\""); }

 private:
  void need(bool holds, const std::string& expected) const {
    constexpr std::size_t kShown = 40;  // characters
    const std::string found = value_.dump();
    if (!holds)
      throw datasets::DataError(datasets::DataCode::wrong_type, file_, pointer_,
                                found.size() > kShown ? found.substr(0, kShown) + "..." : found, expected);
  }

  const Json& value_;
  std::string file_;
  std::string pointer_;
};

void check_numbers(const Place& run) {
  for (const char* key : {"last_arrival_time", "min_obstacle_clearance", "min_robot_clearance",
                          "formation_position_error", "formation_velocity_error", "leader_arrival_time", "jitter"})
    if (run.has(key)) run.at(key).number_or_none();
  if (!run.has("decisions")) return;
  for (const char* key : {"relaxed", "uncertified_half_planes"})
    if (run.at("decisions").has(key)) run.at("decisions").at(key).number_or_none();
}

void check_provenance(const Place& run) {
  if (!run.has("provenance")) return;
  const Place p = run.at("provenance");
  for (const char* key : {"version", "commit"}) p.at(key).text();
  if (p.has("inputs"))
    p.at("inputs").each([](const Place& input) {
      for (const char* key : {"path", "sha256"}) input.at(key).text();
    });
}

void check_run(const Place& run) {
  run.at("scenario").text();
  run.at("method").text();
  run.at("controller").text_or_null();
  run.at("all_arrived").truth();
  check_numbers(run);
  check_provenance(run);
  if (!run.has("lyapunov") || run.at("lyapunov").is_null()) return;
  for (const char* key : {"least", "largest_rise"}) run.at("lyapunov").at("paper").at(key).number_or_none();
}

void check_row(const Place& row) {
  for (const char* key : {"kind", "variant"}) row.at(key).text();
  for (const char* key : {"fields", "reached_and_safe", "reached"}) row.at(key).count();
}

void check_campaign(const Place& all, const char* kind) {
  all.at("kind").word(kind);
  for (const char* key : {"seed", "fields"}) all.at(key).count();
  for (const char* key : {"version", "commit", "compiler"}) all.at("program").at(key).text();
  all.at("rows").each(check_row);
}

void check_ablations(const Place& all) {
  check_campaign(all, "exactvo-ablations");
  all.at("rows").each([](const Place& row) {
    if (row.has("median_jitter")) row.at("median_jitter").number_or_none();
    row.at("scenes").each([](const Place& run) {
      run.at("scenario").text();
      check_numbers(run);
    });
  });
}

/// Null where the file is not there.
Json read_json(const fs::path& path, void (*check)(const Place&)) {
  std::ifstream file(path);
  if (!file) return {};
  try {
    const Json tree = Json::parse(file);
    check(Place(tree, path.string()));
    return tree;
  } catch (const Json::parse_error& error) {
    throw datasets::DataError(datasets::DataCode::json_syntax, path.string(), "byte " + std::to_string(error.byte),
                              "no JSON", "what `exactvo paper` wrote");
  }
}

std::string program_words(const Json& program) {
  const auto word = [&](const char* key) {
    return program.is_object() && program.contains(key) && program[key].is_string() ? program[key].get<std::string>()
                                                                                    : std::string("unknown");
  };
  return word("version") + ", commit " + word("commit");
}

std::string input_words(const Json& input) {
  constexpr std::size_t kHead = 12;  // hexadecimal digits
  return fs::path(input["path"].get<std::string>()).filename().string() + " " +
         input["sha256"].get<std::string>().substr(0, kHead);
}

void add_once(const std::string& word, std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

}  // namespace

ReportData::ReportData(const fs::path& section_five, const fs::path& campaigns, fs::path scenarios)
    : random_(read_json(campaigns / "random" / "random.json",
                        [](const Place& all) { check_campaign(all, "exactvo-random-fields"); })),
      ablations_(read_json(campaigns / "ablations" / "ablations.json", check_ablations)),
      scenarios_(std::move(scenarios)) {
  const Json summary = read_json(section_five / "summary.json", [](const Place& all) { all.each(check_run); });
  if (!summary.is_null()) summary_ = summary;
  std::vector<Json> of_runs;
  for (const Json& run : summary_) of_runs.push_back(run.contains("provenance") ? run["provenance"] : kNull);
  if (has_runs()) add_source("summary.json", of_runs);
  for (const auto& [tree, name] :
       {std::pair{&random_, "random/random.json"}, std::pair{&ablations_, "ablations/ablations.json"}})
    if (!tree->is_null()) add_source(name, std::vector<Json>(1, (*tree)["program"]));
}

void ReportData::add_source(const std::string& name, const std::vector<Json>& programs) {
  SourceFile source{name, {}, {}};
  for (const Json& p : programs) {
    add_once(program_words(p), source.programs);
    if (!p.is_object() || !p.contains("inputs")) continue;
    for (const Json& input : p["inputs"]) add_once(input_words(input), source.inputs);
  }
  sources_.push_back(std::move(source));
}

const Json& ReportData::run(const std::string& scenario, const std::string& method,
                            const std::string& controller) const {
  const Json wanted = controller.empty() ? Json() : Json(controller);
  for (const Json& r : summary_)
    if (r["scenario"] == scenario && r["method"] == method && r["controller"] == wanted) return r;
  return kNull;
}

const Json& ReportData::random(const std::string& kind, const std::string& variant) const {
  if (random_.is_null()) return kNull;
  for (const Json& row : random_["rows"])
    if (row["kind"] == kind && row["variant"] == variant) return row;
  return kNull;
}

std::optional<double> value_of(const Json& run, const char* key) {
  if (const char* below = std::strchr(key, '/')) {
    const auto part = run.is_object() ? run.find(std::string(key, below)) : run.end();
    return part == run.end() ? std::nullopt : value_of(*part, below + 1);
  }
  if (run.is_null() || !run.contains(key) || !run[key].is_number()) return std::nullopt;
  return run[key].get<double>();
}

std::string shown(const std::optional<double>& x, const char* format) {
  return x ? fmt::format(fmt::runtime(format), *x) : "-";
}

std::optional<double> least_clearance(const Json& run) {
  const auto obstacles = value_of(run, "min_obstacle_clearance"), robots = value_of(run, "min_robot_clearance");
  if (obstacles && robots) return std::min(*obstacles, *robots);
  return obstacles ? obstacles : robots;
}

}  // namespace exactvo::tools
