// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A file of well-known text in blocks that end between geometries.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace exactvo::datasets {

/// Block after block; together they are the file. A block ends before a line that begins with a letter while no bracket
/// is open: there a geometry begins, and nothing else can. Text that never closes its brackets is cut before such a
/// line as well once kLargestOpenBlock is read: it is no well-known text, and a reader starts anew on just such lines.
class WktBlocks {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;
  static constexpr std::size_t kLargestOpenBlock = std::size_t{64} << 20;

  /// Throws DataError (missing, unreadable, a folder), as `next` does.
  explicit WktBlocks(const std::filesystem::path& path, std::size_t block = kBlock);

  /// Moves on; false at the end.
  bool next();
  std::string_view text() const { return std::string_view(buffer_).substr(0, length_); }
  double share_read() const;

 private:
  bool read_more();
  std::size_t place_to_cut();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, &std::fclose};
  std::size_t block_;
  std::uint64_t size_ = 0;
  std::uint64_t read_ = 0;
  std::string buffer_;
  std::size_t length_ = 0;   ///< of the current block
  std::size_t scanned_ = 0;  ///< of the buffer, for brackets
  long depth_ = 0;           ///< brackets open there
  std::size_t cut_ = 0;      ///< the last place between geometries; 0: none yet
};

}  // namespace exactvo::datasets
