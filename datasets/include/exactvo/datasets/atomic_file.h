// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Files that are there whole or not at all: written beside their place under another name, synced, then renamed. A
/// reader never sees half a file, and a crash leaves the old one.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

/// What survives a crash of the machine. A crash of the program alone loses nothing.
enum class Durability {
  content,  ///< the file is complete, old or new
  name      ///< after `commit` it is the new one
};

/// What happens where the folder is not there.
enum class MissingFolder {
  is_made,    ///< with those above it
  is_refused  ///< DataError: somebody else may have taken it away
};

/// A file in the making. Nothing stands at `path` until `commit`; without it the temporary file goes with the object.
class AtomicFile {
 public:
  /// Throws DataError (E_FILE_UNWRITABLE), as the others do.
  explicit AtomicFile(std::filesystem::path path, MissingFolder missing = MissingFolder::is_made);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered.
  void write(std::string_view bytes);
  /// Flushes, syncs, renames, and syncs the directory as well for Durability::name.
  void commit(Durability durability = Durability::name);

 private:
  void flush();
  void put(std::string_view bytes);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  std::string buffer_;
  std::size_t unsent_ = 0;  ///< written and not on its way to the disk, bytes
};

/// Makes renames in a folder durable; where a file system refuses that, they stand all the same.
void sync_directory(const std::filesystem::path& directory);

/// The whole content at once.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes,
                           Durability durability = Durability::name);

}  // namespace exactvo::datasets
