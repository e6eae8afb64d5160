// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The parts of long work as files in a folder, so that work that was killed goes on: each part appears whole or not at
/// all. Nothing waits for the disk, so that a power cut may take back or cut off the last parts: a reader must
/// check that a part is whole, as `read_sealed` does.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace exactvo::datasets {

/// A folder of parts, by name.
class PartFolder {
 public:
  /// Nothing is made or read yet.
  explicit PartFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Makes the folder, unless it is there. Throws DataError (E_FILE_UNWRITABLE).
  void create() const;
  /// The folder.
  const std::filesystem::path& path() const { return folder_; }
  /// The path of a file in the folder.
  std::filesystem::path path(std::string_view name) const { return folder_ / name; }

  // `file` stands in the folder, or in one below it.

  /// Whether such a file is there.
  bool has(const std::filesystem::path& file) const;
  /// Throws DataError (E_FILE_UNWRITABLE), also where the folder is gone: it is not made anew.
  void write(const std::filesystem::path& file, std::string_view bytes) const;

  /// A text with a digest of itself and of `key`, which is what the text depends on besides its name.
  void write_sealed(const std::filesystem::path& file, std::string_view key, std::string_view text) const;
  /// None where no such text is there, or one of another key, or a damaged one.
  std::optional<std::string> read_sealed(const std::filesystem::path& file, std::string_view key) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace exactvo::datasets
