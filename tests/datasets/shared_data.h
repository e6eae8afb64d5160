// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The public obstacle files that may stand beside the checkout, and what was counted in them.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace exactvo::datasets::test {

inline std::filesystem::path shared_data() {
  return std::filesystem::path(EXACTVO_SOURCE_DIR) / ".." / "shared" / "data";
}

struct ManifestRow {
  std::string path;
  std::string format;
  std::string what;

  /// The number after `key=`, if it stands there as a word.
  std::optional<long> count(const std::string& key) const {
    const std::string mark = " " + key + "=";
    const std::size_t at = (" " + what).find(mark);
    if (at == std::string::npos) return std::nullopt;
    return std::strtol(what.c_str() + at + mark.size() - 1, nullptr, 10);
  }
  std::string folder() const { return path.substr(0, path.find('/')); }
};

inline std::vector<ManifestRow> manifest() {
  std::vector<ManifestRow> rows;
  std::ifstream file(shared_data() / "MANIFEST.tsv");
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    ManifestRow row;
    std::getline(fields, row.path, '\t');
    std::getline(fields, row.format, '\t');
    std::getline(fields, row.what, '\t');
    rows.push_back(row);
  }
  return rows;
}

inline std::vector<ManifestRow> manifest_of(const std::vector<std::string>& folders) {
  std::vector<ManifestRow> rows;
  for (const ManifestRow& row : manifest()) {
    for (const std::string& folder : folders) {
      if (row.folder() == folder) rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace exactvo::datasets::test

#define EXACTVO_NEEDS_SHARED_DATA()                                       \
  if (!std::filesystem::exists(::exactvo::datasets::test::shared_data())) \
  GTEST_SKIP() << "no ../shared/data beside the checkout"
