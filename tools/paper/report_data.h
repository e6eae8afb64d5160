// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the runs left behind, as the report asks for it.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace exactvo::tools {

/// A file that the report is made of, and what made it.
struct SourceFile {
  std::string name;
  std::vector<std::string> inputs;    ///< "A1.json 0123456789ab": of what its runs read, with the head of its digest
  std::vector<std::string> programs;  ///< "1.0.0, commit abc": one, where one program wrote all of it
};

class ReportData {
 public:
  using Json = nlohmann::ordered_json;

  /// Section V's files from one folder, the campaigns' from another (the same, but while the first is in the making).
  /// `scenarios` holds A1.json and so on. Throws datasets::DataError for a file that is there and not one of ours.
  ReportData(const std::filesystem::path& section_five, const std::filesystem::path& campaigns,
             std::filesystem::path scenarios);

  /// Whether Section V was run; without it there is nothing to report on.
  bool has_runs() const { return !summary_.empty(); }
  /// The metrics of one run; `controller` is empty without a formation. Null where it was not run.
  const Json& run(const std::string& scenario, const std::string& method, const std::string& controller = "") const;

  /// All of them, an array.
  const Json& runs() const { return summary_; }

  /// A row of random.json or ablations.json; null where there is none.
  const Json& random(const std::string& kind, const std::string& variant) const;
  const Json& random() const { return random_; }
  const Json& ablations() const { return ablations_; }

  const std::filesystem::path& scenarios() const { return scenarios_; }
  const std::vector<SourceFile>& sources() const { return sources_; }

 private:
  void add_source(const std::string& name, const std::vector<Json>& programs);

  Json summary_ = Json::array();
  Json random_;
  Json ablations_;
  std::filesystem::path scenarios_;
  std::vector<SourceFile> sources_;
};

/// A number of a run, "decisions/relaxed" of an object in it; nothing where it is null or the run is.
std::optional<double> value_of(const ReportData::Json& run, const char* key);
/// "-" where there is none.
std::string shown(const std::optional<double>& x, const char* format);
/// By how much nothing was touched: the lesser of both clearances; nothing where neither applies.
std::optional<double> least_clearance(const ReportData::Json& run);

}  // namespace exactvo::tools
