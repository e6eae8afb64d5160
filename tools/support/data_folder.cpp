// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/data_folder.h"

#include <system_error>
#include <vector>

#include "support/usage.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

/// PREFIX/bin/exactvo -> PREFIX/share/exactvo/data.
fs::path installed_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path().parent_path() / EXACTVO_INSTALLED_DATA;
}

}  // namespace

fs::path data_folder(const std::string& asked, const std::string& name) {
  const std::vector<fs::path> places =
      asked.empty() ? std::vector<fs::path>{installed_data(), EXACTVO_SOURCE_DATA} : std::vector<fs::path>{asked};
  for (const fs::path& place : places) {
    if (fs::is_directory(place / name)) return place / name;
  }
  throw UsageError("--data", places.back().string(), "a folder that holds a folder '" + name + "'");
}

}  // namespace exactvo::tools
