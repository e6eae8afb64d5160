// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings line by line, from a file, a pipe or a text.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

/// Gives the next line without its \n, valid until the next call; false at the end.
using NextLine = std::function<bool(std::string_view& line)>;

/// Of a text that must outlive it.
NextLine lines_of(std::string_view text);

/// `read_recording` of these lines: rows go to `take`. `name` is used in messages.
RecordingFile read_recording_lines(const NextLine& next_line, const std::string& name, const TakeRow& take);

/// A recording that is read row by row, more than once, with the digest of its lines. The text of a pipe is kept, since
/// nothing is left of it after the first time; of a file nothing is.
class SealedRecording {
 public:
  explicit SealedRecording(std::filesystem::path path);

  /// Rows go to `take`. Throws DataError where it can't be read, or has changed since it was first read.
  RecordingFile read(const TakeRow& take);
  /// Whether the last line has the digest of all lines above it. REQUIRES: it was read.
  bool is_sealed() const;

 private:
  std::filesystem::path path_;
  std::optional<std::string> text_;  ///< of a pipe
  std::string digest_;               ///< of all lines but the last
  std::string last_line_;
};

}  // namespace exactvo::datasets
