// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings line by line, from a file, a pipe or a text.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/recording_file.h"
#include "files/sha256.h"

namespace exactvo::datasets {

/// Gives the next line without its \n, valid until the next call; false at the end.
using NextLine = std::function<bool(std::string_view& line)>;

/// Of a text that must outlive it.
NextLine lines_of(std::string_view text);

/// `read_recording` of these lines into `run`, which is empty: rows go to `take`. `name` is used in messages.
void read_recording_lines(const NextLine& next_line, const std::string& name, const TakeRow& take, RecordingFile& run);

/// Lines with their digest, which is made while they are read.
class SealedLines {
 public:
  /// Of a file or a pipe; "-" is standard input.
  explicit SealedLines(const std::filesystem::path& path) : lines_(path.string(), kLargestWholeFile) {}

  bool next(std::string_view& line);
  const std::string& file() const { return lines_.file(); }
  /// Whether the last line has the digest of all lines above it. REQUIRES: a recording was read to its end.
  bool are_sealed();

 private:
  TextLines lines_;
  Sha256 hash_;
  std::string last_;  ///< not in the hash yet
};

}  // namespace exactvo::datasets
