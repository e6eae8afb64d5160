// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whole files as text, and where in a text a byte stands.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "exactvo/datasets/input_text.h"

namespace exactvo::datasets {

/// Whether `path` is a pipe, named or not. False where that can't be found out.
bool is_pipe(const std::filesystem::path& path);

/// The first `count` bytes of a regular file, or all. Refuses a pipe as well: what was read of it would be lost.
std::string read_beginning(const std::filesystem::path& path, std::size_t count);

/// The lines of a file or a pipe, one after the other: memory does not grow with the file. Throws DataError as
/// `read_text_file` does, and E_SIZE for a line beyond kLargestWholeFile.
class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& path);
  ~TextLines();
  /// The next line without its \n, valid until the next call; false at the end.
  bool next(std::string_view& line);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "line 3, column 7", both from 1; columns count bytes.
std::string line_and_column(std::string_view text, std::size_t byte);

/// At most `length` printable characters from `byte` on, in quotes, for messages; in words if there are none.
std::string excerpt(std::string_view text, std::size_t byte, std::size_t length = 20);

}  // namespace exactvo::datasets
