// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Well-known text: a file of it in blocks that end between geometries; its words, numbers and signs with their places.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

class WktScanner {
 public:
  /// `lines_before`: of the file, where the text is a piece of it.
  WktScanner(std::string_view text, const std::string& file, std::size_t lines_before = 0)
      : text_(text), file_(file), lines_before_(lines_before) {}

  /// Past white space and what may stand between geometries (a byte order mark, commas, semicolons).
  void skip_between_geometries();
  bool at_end();
  /// The next word in upper case, or "" where none stands.
  std::string word();
  std::string peek_word();
  bool try_sign(char sign);
  void need_sign(char sign);
  bool number_ahead();
  /// Any C number; "nan" and "inf" are let through for the ring to be judged.
  double number();
  /// After an error in the geometry that began at `start`: to the next line that begins with a letter.
  void skip_to_next_geometry(std::size_t start);

  std::size_t position() const { return at_; }
  std::string place() const;
  [[noreturn]] void refuse(const std::string& expected, DataCode code = DataCode::format_syntax);

 private:
  void skip_space();

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t lines_before_;
  // Up to where newlines were counted, so that places along a long text do not count them all again and again.
  mutable std::size_t counted_to_ = 0;
  mutable std::size_t newlines_ = 0;
  mutable std::size_t line_start_ = 0;
};

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
