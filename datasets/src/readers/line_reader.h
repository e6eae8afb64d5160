// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A text a line at a time, and the fields of a line as numbers, with the line's number in every refusal.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

class LineReader {
 public:
  /// A byte order mark before the text, as spreadsheets write it, is left out.
  LineReader(std::string text, const std::string& file) : text_(std::move(text)), rest_(text_), file_(file) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    if (rest_.substr(0, kMark.size()) == kMark) rest_.remove_prefix(kMark.size());
  }
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// Moves to the next line, its end (\n or \r\n) taken off; false at the end.
  bool next();
  /// To the next one that holds more than blanks.
  bool next_filled();
  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }  ///< from 1
  std::string place() const { return "line " + std::to_string(number_); }
  /// Bytes not yet read.
  std::size_t left() const { return rest_.size(); }

  double to_number(std::string_view field) const;
  std::int64_t to_integer(std::string_view field) const;
  [[noreturn]] void refuse(DataCode code, const std::string& found, const std::string& expected) const;

 private:
  std::string text_;
  std::string_view rest_;
  const std::string& file_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// Split at every run of blanks and tabs.
std::vector<std::string_view> words_of(std::string_view line);
/// Split at every `separator`; blanks round a field are taken off.
std::vector<std::string_view> fields_of(std::string_view line, char separator);
/// The same of CSV (RFC 4180): in a field that begins with a quotation mark separators count for nothing, and two
/// quotation marks are one. None where a quotation mark is not closed, or more follows it than blanks.
std::optional<std::vector<std::string>> csv_fields_of(std::string_view line);
std::string_view trimmed(std::string_view text);

}  // namespace exactvo::datasets
