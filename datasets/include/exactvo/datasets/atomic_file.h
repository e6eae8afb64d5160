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
  is_refused  ///< throws DataError: another program may have removed it
};

/// What becomes of a file that was not committed.
enum class Unfinished {
  goes,  ///< the temporary file goes with the object
  stays  ///< it stays as "PATH.unfinished", whatever ends the program; the next one goes on with it
};

/// What happens where a pipe stands at the path, or the path is "-", standard output.
enum class Pipe {
  is_refused,  ///< throws DataError, since the rename would replace the pipe; "-" is an ordinary name
  is_written   ///< bytes go into it as they come; the reader must detect a truncated output itself
};

/// A file in the making. Nothing stands at `path` until `commit`.
class AtomicFile {
 public:
  /// Throws DataError (E_FILE_UNWRITABLE). With `Unfinished::stays` it also throws if another process is writing this
  /// file. The other members throw it too.
  explicit AtomicFile(std::filesystem::path path, MissingFolder missing = MissingFolder::is_made,
                      Unfinished unfinished = Unfinished::goes, Pipe pipe = Pipe::is_refused);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered.
  void write(std::string_view bytes);
  /// Goes on behind the first `size` bytes of what is there. Throws DataError (E_FORMAT_SYNTAX) where there are fewer.
  void continue_behind(std::uint64_t size);
  /// Flushes, and waits for the disk: whatever happens now, this is there.
  void sync();
  /// Flushes, syncs, renames, and syncs the directory as well for Durability::name.
  void commit(Durability durability = Durability::name);

 private:
  void open_pipe();
  void open_standard_output();
  void open_unfinished();
  void flush();
  void put(std::string_view bytes);

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< none for a pipe and for standard output
  Unfinished unfinished_ = Unfinished::goes;
  int descriptor_ = -1;
  std::string buffer_;
  std::size_t unsent_ = 0;  ///< written and not on its way to the disk, bytes
};

/// "PATH.unfinished".
std::filesystem::path unfinished_name(std::filesystem::path path);

/// Makes renames in a folder durable; where a file system refuses that, they stand all the same.
void sync_directory(const std::filesystem::path& directory);

/// The whole content at once.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes,
                           Durability durability = Durability::name);

}  // namespace exactvo::datasets
