// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whole files as text, where in a text a byte stands, and texts in quotes.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "exactvo/datasets/input_text.h"

namespace exactvo::datasets {

/// Whether `path` is a pipe, named or not. False where that can't be found out.
bool is_pipe(const std::filesystem::path& path);

/// The first `count` bytes of a regular file, or all. Refuses a pipe as well: what was read of it would be lost.
std::string read_beginning(const std::filesystem::path& path, std::size_t count);

/// What comes through a pipe or standard input ("-"), as a file of the same name, gone with the object.
class CopyOfInput {
 public:
  /// In memory of one block. Throws DataError.
  explicit CopyOfInput(const std::string& input);
  ~CopyOfInput();
  CopyOfInput(const CopyOfInput&) = delete;
  CopyOfInput& operator=(const CopyOfInput&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Empty {};
  CopyOfInput(Empty, const std::filesystem::path& name);

  std::filesystem::path path_;  ///< in a folder of its own
};

/// "line 3, column 7", both from 1; columns count bytes.
std::string line_and_column(std::string_view text, std::size_t byte);

/// Throws DataError where a text of XML has entities of its own: what they stand for may be endless, or somebody's
/// files.
void refuse_entities(std::string_view xml, const std::string& file);

/// A field of CSV in quotes, those in it doubled: RFC 4180.
std::string csv_quoted(std::string_view text);

/// At most `length` printable characters from `byte` on, in quotes, for messages; in words if there are none.
std::string excerpt(std::string_view text, std::size_t byte, std::size_t length = 20);

}  // namespace exactvo::datasets
