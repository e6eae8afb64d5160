// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/data_error.h"
#include "explorer/page.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw datasets::DataError(datasets::DataCode::file_unwritable, path.string(), "", why, "a place to write to");
}

/// "out/" and "out" are the same folder; its name and parent are wanted.
fs::path without_trailing_slash(fs::path path) {
  path = fs::absolute(path).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) files.push_back(entry.path().lexically_relative(folder));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Whether a file of a name that other programs use as well is one that `simulate` or `paper` wrote: both begin with
/// the metrics of a run.
bool holds_metrics(const fs::path& path) {
  constexpr std::size_t kBeginning = std::size_t{1} << 16;
  std::string text(kBeginning, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text.find("\"min_obstacle_clearance\":") != std::string::npos;
}

/// NAME.gp that says how it is drawn again, or NAME.dat, .svg, .png or .pdf next to one.
bool is_of_a_figure(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (extension != ".gp" && extension != ".dat" && extension != ".svg" && extension != ".png" && extension != ".pdf")
    return false;
  std::ifstream script(fs::path(file).replace_extension(".gp"));
  std::string first, second;
  return std::getline(script, first) && std::getline(script, second) &&
         second.rfind("# Draw again with: gnuplot", 0) == 0;
}

/// The names of files. What is in recordings and tables was synced as they were written.
void sync_folders(const fs::path& folder) {
  datasets::sync_directory(folder);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory()) sync_folders(entry.path());
}

}  // namespace

void write_text(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) fail(path, std::generic_category().message(errno != 0 ? errno : EIO));
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) fail(path, error.message());
}

void check_output_folder(const fs::path& target) {
  std::error_code error;
  if (!fs::is_directory(target, error) || fs::is_empty(target, error) || error) return;
  if (holds_metrics(target / "metrics.json") || holds_metrics(target / "summary.json")) return;
  // Beside a campaign's folder summary.json is read before anything is written, and judged there.
  for (const char* campaign : {"random", "ablations"}) {
    const bool has_both = fs::is_directory(target / campaign, error) && fs::exists(target / "summary.json", error);
    if (has_both || fs::exists(target / campaign / "parts", error)) return;
  }
  throw datasets::DataError(datasets::DataCode::file_unwritable, target.string(), "",
                            "a folder with other files in it, and no metrics.json or summary.json of a run",
                            "a folder that does not exist, is empty, or holds an earlier output");
}

void check_figure_folder(const fs::path& target) {
  std::error_code error;
  if (!fs::is_directory(target, error)) return;
  for (const auto& entry : fs::directory_iterator(target))
    if (!is_of_a_figure(entry.path()))
      throw datasets::DataError(datasets::DataCode::file_unwritable, target.string(), "",
                                "a folder with other files in it: " + entry.path().filename().string(),
                                "a folder that does not exist, is empty, or holds figures only");
}

void remove_figures(const fs::path& target) {
  std::error_code error;
  fs::remove(target / kPageName, error);
  const fs::path folder = target / "figures";
  if (!fs::is_directory(folder, error)) return;
  std::vector<fs::path> ours, folders{folder};
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
    if (is_of_a_figure(entry.path())) ours.push_back(entry.path());
  }
  for (const fs::path& file : ours)
    if (!fs::remove(file, error)) fail(file, error.message());
  std::sort(folders.rbegin(), folders.rend());                   // what lies within first
  for (const fs::path& each : folders) fs::remove(each, error);  // one that holds anything else stays
}

StagedFolder::StagedFolder(fs::path target, const fs::path& named)
    : target_(without_trailing_slash(std::move(target))) {
  staging_ = target_.parent_path() / ("." + target_.filename().string() + "." + std::to_string(::getpid()));
  std::error_code error;
  if (fs::exists(target_, error) && !fs::is_directory(target_)) fail(target_, "a file of that name");
  remove_on_signal_.emplace(staging_.string());  // before it is there: a signal may come in between
  fs::create_directories(staging_, error);
  if (error) fail(named.empty() ? target_ : named, error.message());
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;  // A destructor must not throw, and no caller is left to report to.
  fs::remove_all(staging_, ignored);
}

void StagedFolder::publish(const std::string& last) {
  try {
    if (fs::exists(target_)) {
      merge_into_target(last);
    } else {
      sync_folders(staging_);
      fs::rename(staging_, target_);
    }
  } catch (const fs::filesystem_error& error) {
    fail(error.path2().empty() ? error.path1() : error.path2(), error.code().message());
  }
}

void StagedFolder::merge_into_target(const std::string& last) {
  std::vector<fs::path> files = files_below(staging_);
  std::stable_partition(files.begin(), files.end(), [&](const fs::path& file) { return file != last; });
  for (const fs::path& file : files) {
    fs::create_directories((target_ / file).parent_path());
    fs::rename(staging_ / file, target_ / file);
  }
  sync_folders(target_);
}

}  // namespace exactvo::tools
