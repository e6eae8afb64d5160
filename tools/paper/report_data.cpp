// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/report_data.h"

#include <algorithm>
#include <fstream>
#include <utility>

namespace exactvo::tools {

namespace fs = std::filesystem;
using Json = ReportData::Json;

namespace {

const Json kNull;

/// Null where the file is not there.
Json read_json(const fs::path& path) {
  std::ifstream file(path);
  return file ? Json::parse(file) : Json();
}

std::string controller_of(const Json& run) {
  return run["controller"].is_null() ? "" : run["controller"].get<std::string>();
}

}  // namespace

ReportData::ReportData(const fs::path& section_five, const fs::path& campaigns, fs::path scenarios)
    : random_(read_json(campaigns / "random" / "random.json")),
      ablations_(read_json(campaigns / "ablations" / "ablations.json")),
      scenarios_(std::move(scenarios)) {
  const Json summary = read_json(section_five / "summary.json");
  if (summary.is_array()) summary_ = summary;
}

const Json& ReportData::run(const std::string& scenario, const std::string& method,
                            const std::string& controller) const {
  for (const Json& r : summary_)
    if (r["scenario"] == scenario && r["method"] == method && controller_of(r) == controller) return r;
  return kNull;
}

const Json& ReportData::random(const std::string& kind, const std::string& variant) const {
  if (random_.is_null()) return kNull;
  for (const Json& row : random_["rows"])
    if (row["kind"] == kind && row["variant"] == variant) return row;
  return kNull;
}

std::optional<double> value_of(const Json& run, const char* key) {
  if (run.is_null() || !run.contains(key) || !run[key].is_number()) return std::nullopt;
  return run[key].get<double>();
}

std::optional<double> least_clearance(const Json& run) {
  const auto obstacles = value_of(run, "min_obstacle_clearance"), robots = value_of(run, "min_robot_clearance");
  if (obstacles && robots) return std::min(*obstacles, *robots);
  return obstacles ? obstacles : robots;
}

}  // namespace exactvo::tools
