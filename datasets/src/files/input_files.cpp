// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/input_files.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <set>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "files/file_names.h"
#include "readers/readers.h"

namespace exactvo::datasets {

namespace fs = std::filesystem;

namespace {

/// What `action` lists; nothing if the file cannot be understood.
template <class Action>
std::vector<fs::path> listed(const Action& action) {
  try {
    return action();
  } catch (const std::exception&) {
    return {};
  }
}

std::vector<std::string> extensions_of_tables(const std::string& extension) {
  if (extension == ".shp") return {".shx", ".dbf", ".prj", ".cpg"};
  if (extension == ".tab") return {".dat", ".map", ".id", ".ind"};
  if (extension == ".mif") return {".mid"};
  return {};
}

/// The obstacle files that a scenario names: inputs of their own as well.
std::vector<fs::path> named_by_scenario(const fs::path& path, const std::string& format) {
  return listed([&] {
    const bool is_scenario = format == "scenario" || (format.empty() && format_of(path) == "scenario");
    return is_scenario ? files_of_scenario(path) : std::vector<fs::path>{};
  });
}

void collect(const fs::path& path, const std::string& format, std::vector<fs::path>& files, std::set<fs::path>& seen) {
  if (!seen.insert(name_of_file(path)).second) return;
  files.push_back(path);
  if (!is_regular(path)) return;
  for (const fs::path& other : sidecar_files(path, format)) collect(other, {}, files, seen);
  for (const fs::path& other : named_by_scenario(path, format)) collect(other, {}, files, seen);
}

}  // namespace

std::vector<fs::path> sidecar_files(const fs::path& path, const std::string& format) {
  if (!is_regular(path)) return {};
  const std::string extension = lower_extension(path);
  std::vector<fs::path> found;
  if (extension == ".yaml" || extension == ".yml" || format == "ros-map")
    found = listed([&] { return std::vector<fs::path>{picture_of_ros_map(path)}; });
  for (const std::string& table : extensions_of_tables(extension))
    for (const std::string& spelled : {table, boost::to_upper_copy(table)})
      found.push_back(fs::path(path).replace_extension(spelled));
  found.erase(std::remove_if(found.begin(), found.end(), [](const fs::path& p) { return !is_regular(p); }),
              found.end());
  return found;
}

std::vector<fs::path> files_read_with(const fs::path& path, const std::string& format) {
  std::vector<fs::path> files;
  std::set<fs::path> seen;
  collect(path, format, files, seen);
  return files;
}

}  // namespace exactvo::datasets
