// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/inputs.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/provenance.h"
#include "line_reader.h"
#include "text_file.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

/// A map's description is short; a larger .yaml is none.
constexpr std::size_t kMapDescription = 1 << 16;

std::string lower_extension(const fs::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The picture that a ROS map names, if the file names one beside or below it.
std::vector<fs::path> pictures_of(const fs::path& path) {
  try {
    const std::string text = read_beginning(path, kMapDescription);
    LineReader lines(text, path.native());
    while (lines.next()) {
      std::string_view line = trimmed(lines.line());
      constexpr std::string_view kKey = "image:";
      if (line.substr(0, kKey.size()) != kKey) continue;
      line = trimmed(line.substr(kKey.size()));
      if (line.size() > 1 && (line.front() == '"' || line.front() == '\'')) line = line.substr(1, line.size() - 2);
      return {path.parent_path() / std::string(line)};
    }
  } catch (const DataError&) {
    // An unreadable file has no companions; reading it as an input says what is wrong.
  }
  return {};
}

/// What the file cannot be read without.
std::vector<fs::path> companions_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  std::vector<fs::path> found;
  if (extension == ".yaml" || extension == ".yml") found = pictures_of(path);
  if (extension == ".shp") {
    for (const char* other : {".shx", ".dbf", ".prj", ".cpg", ".SHX", ".DBF", ".PRJ", ".CPG"}) {
      found.push_back(fs::path(path).replace_extension(other));
    }
  }
  const auto missing = [](const fs::path& p) {
    std::error_code error;
    return !fs::is_regular_file(p, error);
  };
  found.erase(std::remove_if(found.begin(), found.end(), missing), found.end());
  return found;
}

std::string identity_of(const fs::path& path) {
  try {
    const std::string own = sha256_of_file(path);
    std::string all = own;
    for (const fs::path& companion : companions_of(path)) all += " " + sha256_of_file(companion);
    return all == own ? own : sha256_of(all);
  } catch (const DataError&) {
    return {};
  }
}

class Listing {
 public:
  explicit Listing(const fs::path& out) : out_(fs::weakly_canonical(out)) {}

  void add(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) {
      throw DataError(DataCode::file_missing, path.string(), "", "no such file or folder", "something to read");
    }
    if (fs::is_directory(path, error)) return add_folder(path);
    files_.push_back(path);
  }

  std::vector<Input> take() {
    std::set<fs::path> seen = companions();
    std::vector<Input> inputs;
    for (const fs::path& file : files_) {
      std::error_code error;
      if (!seen.insert(fs::weakly_canonical(file, error)).second) continue;
      const std::uintmax_t size = fs::file_size(file, error);
      inputs.push_back({file.generic_string(), file, identity_of(file), error ? 0 : std::uint64_t{size}});
    }
    return inputs;
  }

 private:
  void add_folder(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    for (auto at = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
         at != fs::recursive_directory_iterator(); at.increment(error)) {
      const bool hidden = at->path().filename().string().rfind('.', 0) == 0;
      if (at->is_directory(error)) {
        if (hidden || fs::weakly_canonical(at->path(), error) == out_) at.disable_recursion_pending();
      } else if (!hidden) {
        found.push_back(at->path());
      }
    }
    std::sort(found.begin(), found.end());
    for (const fs::path& file : found) {
      for (const fs::path& companion : companions_of(file)) companions_.push_back(companion);
    }
    files_.insert(files_.end(), found.begin(), found.end());
  }

  /// Only what was met in a folder: a file that the user names is wanted, whatever else needs it.
  std::set<fs::path> companions() const {
    std::set<fs::path> all;
    std::error_code error;
    for (const fs::path& companion : companions_) all.insert(fs::weakly_canonical(companion, error));
    return all;
  }

  fs::path out_;
  std::vector<fs::path> files_;
  std::vector<fs::path> companions_;
};

}  // namespace

std::vector<Input> list_inputs(const std::vector<fs::path>& paths, const fs::path& out) {
  Listing listing(out);
  for (const fs::path& path : paths) listing.add(path);
  return listing.take();
}

}  // namespace exactvo::datasets::batch
