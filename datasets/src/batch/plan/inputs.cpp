// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/plan/inputs.h"

#include <algorithm>
#include <set>
#include <utility>

#include "batch/plan/journal.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_files.h"
#include "files/file_names.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

/// Empty where it can't be read. Whatever is no regular file, a pipe for instance, is not opened.
std::string hash_of(const fs::path& path) {
  if (!is_regular(path)) return {};
  try {
    return sha256_of_file(path);
  } catch (const DataError&) {
    return {};
  }
}

/// As the input is named: by the folder that its user named, not by its place on this machine.
std::string name_beside(const fs::path& input, const fs::path& other) {
  std::error_code error;
  const fs::path folder = input.parent_path();
  const fs::path relative = fs::relative(other, folder.empty() ? fs::path(".") : folder, error);
  return (error || relative.empty() ? other : (folder / relative).lexically_normal()).generic_string();
}

DataError cannot_walk(const fs::path& folder, const std::error_code& error) {
  return {DataCode::file_unreadable, folder.string(), "", error.message(), "a folder whose files can be listed"};
}

/// An output, or what a killed batch has left of one.
bool is_earlier_output(const fs::path& folder) {
  return is_of_a_batch(folder / "summary.json") || is_of_a_batch(folder / ".parts" / "run.json");
}

/// Those that are not hidden, as far as they can be counted: none of them is read.
std::size_t number_of_files(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  while (!error && at != fs::recursive_directory_iterator()) {
    std::error_code unknown;
    const bool is_folder = at->is_directory(unknown);
    const bool is_hidden = at->path().filename().string().rfind('.', 0) == 0;
    if (is_folder && is_hidden) at.disable_recursion_pending();
    if (!is_folder && !is_hidden) ++count;
    at.increment(error);
  }
  return count;
}

class Listing {
 public:
  Listing(const fs::path& out, const std::string& format) : out_(fs::weakly_canonical(out)), format_(format) {}

  void add(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) {
      throw DataError(DataCode::file_missing, path.string(), "", "no such file or folder",
                      path == "-" ? "files or folders: a batch does not read standard input" : "something to read");
    }
    if (fs::is_directory(path, error)) return add_folder(path);
    files_.push_back(path);
    named_.insert(name_of_file(path));
  }

  /// Throws DataError if there is nothing to read.
  Inputs take() const {
    std::set<fs::path> seen;
    std::vector<Input> inputs;
    for (const fs::path& file : files_) {
      const fs::path name = name_of_file(file);
      const bool belongs = sidecars_.count(name) > 0 && named_.count(name) == 0;
      if (belongs || !seen.insert(name).second) continue;
      std::error_code error;
      const std::uintmax_t size = fs::file_size(file, error);
      inputs.push_back({file.generic_string(), file, hashes_of_input(file, format_), error ? 0 : std::uint64_t{size}});
    }
    if (inputs.empty()) throw nothing_to_read();
    return {std::move(inputs), earlier_};
  }

 private:
  void add_folder(const fs::path& folder) {
    folders_.push_back(folder);
    if (name_of_file(folder) == out_ || is_left_out_as_earlier(folder)) return;
    std::vector<fs::path> found = files_below(folder);
    std::sort(found.begin(), found.end());
    for (const fs::path& file : found) {
      for (const fs::path& other : sidecar_files(file, format_)) sidecars_.insert(name_of_file(other));
    }
    files_.insert(files_.end(), found.begin(), found.end());
  }

  /// Links to folders are listed as they are, to be counted as what can't be read: they might lead round in circles.
  std::vector<fs::path> files_below(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    fs::recursive_directory_iterator at(folder, error);
    if (error) throw cannot_walk(folder, error);
    while (at != fs::recursive_directory_iterator()) {
      const fs::path path = at->path();
      std::error_code unknown;  // what kind of file it is; then it is listed and refused when it is read
      const bool is_link = at->is_symlink(unknown);
      const bool is_folder = at->is_directory(unknown);
      const bool is_left_out = path.filename().string().rfind('.', 0) == 0 ||
                               (is_folder && (name_of_file(path) == out_ || is_left_out_as_earlier(path)));
      if (is_left_out && is_folder) at.disable_recursion_pending();
      if (!is_left_out && (is_link || !is_folder)) found.push_back(path);
      at.increment(error);
      if (error) throw cannot_walk(path, error);
    }
    return found;
  }

  bool is_left_out_as_earlier(const fs::path& folder) {
    if (!is_earlier_output(folder)) return false;
    if (met_.insert(name_of_file(folder)).second)
      earlier_.push_back({folder.generic_string(), number_of_files(folder)});
    return true;
  }

  /// Folders alone were named then.
  DataError nothing_to_read() const {
    std::string words = "no file to read";
    for (const EarlierBatch& earlier : earlier_) words += "; " + earlier.folder + " holds an earlier batch";
    for (const fs::path& folder : folders_) {
      if (name_of_file(folder) == out_) words += "; " + folder.generic_string() + " is where the results go";
    }
    const std::string first = folders_.empty() ? "" : folders_.front().string();
    return {DataCode::file_missing, first, "", words, "a file, or a folder that holds one"};
  }

  fs::path out_;
  std::string format_;
  std::vector<EarlierBatch> earlier_;
  std::set<fs::path> met_;  ///< earlier batches, whatever way leads to them
  std::vector<fs::path> folders_;
  std::vector<fs::path> files_;
  std::set<fs::path> named_;     ///< by the user: wanted, whatever else needs them
  std::set<fs::path> sidecars_;  ///< of files met in a folder
};

}  // namespace

bool InputHashes::operator==(const InputHashes& other) const {
  const auto same = [](const InputFile& a, const InputFile& b) { return a.path == b.path && a.sha256 == b.sha256; };
  return sha256 == other.sha256 &&
         std::equal(read_with.begin(), read_with.end(), other.read_with.begin(), other.read_with.end(), same);
}

InputHashes hashes_of_input(const fs::path& path, const std::string& format) {
  InputHashes hashes{hash_of(path), {}};
  if (hashes.sha256.empty()) return hashes;
  const std::vector<fs::path> files = files_read_with(path, format);
  for (std::size_t k = 1; k < files.size(); ++k)
    hashes.read_with.push_back({name_beside(path, files[k]), hash_of(files[k])});
  return hashes;
}

Inputs list_inputs(const std::vector<fs::path>& paths, const fs::path& out, const std::string& format) {
  Listing listing(out, format);
  for (const fs::path& path : paths) listing.add(path);
  return listing.take();
}

}  // namespace exactvo::datasets::batch
