// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Folders that appear whole or not at all.
///
/// See also: datasets/atomic_file.h does the same for one file.

#include <filesystem>
#include <optional>
#include <string>

#include "support/stop.h"

namespace exactvo::tools {

/// Writes `text` to `path`, in place. Throws datasets::DataError (E_FILE_UNWRITABLE), as the others do.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Creates a folder and its parents.
void make_folder(const std::filesystem::path& path);

/// Refuses to scatter files: throws datasets::DataError where `target` is a folder that holds something, but neither
/// metrics.json nor summary.json of a run nor the folder of a campaign, so that it is none of ours. To be asked before
/// the work, not after.
void check_output_folder(const std::filesystem::path& target);

/// The same for a folder for figures alone: throws where it holds a file that is no figure of ours, nor belongs to one.
void check_figure_folder(const std::filesystem::path& target);

/// Takes an earlier output's pictures and page away, which would show another run than the one that is put there
/// without any.
void remove_figures(const std::filesystem::path& target);

/// A folder in the making: a hidden sibling of `target` to write into. `publish` puts it in place; without it the
/// destructor leaves no trace, nor does a signal that ends the program (stop.h), so a run that fails or is interrupted
/// never leaves half an output.
class StagedFolder {
 public:
  /// Creates the hidden folder (and the target's parents). `named` is what the user called the whole, for messages;
  /// the target itself where empty.
  explicit StagedFolder(std::filesystem::path target, const std::filesystem::path& named = {});
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staging_; }

  /// Moves everything into place. A target that does not exist appears in one step. In one that does, each file
  /// replaces its namesake in one step, in order of their names with `last` at the end; other files there stay.
  void publish(const std::string& last = "");

 private:
  void merge_into_target(const std::string& last);

  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::optional<RemoveFolderOnSignal> remove_on_signal_;
};

}  // namespace exactvo::tools
