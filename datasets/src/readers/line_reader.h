// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A text a line at a time, and the fields of a line as numbers, with the line's number in every refusal.

#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

class LineReader {
 public:
  /// A byte order mark before the text is left out.
  LineReader(std::string text, const std::string& file);
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

/// CSV with a header that names its columns.
class CsvTable : public LineReader {
 public:
  using LineReader::LineReader;
  /// Reads the header. `known`: the columns that there may be; the first `required` of them there must be. Refusals say
  /// that `expected` was.
  void read_header(const std::vector<std::string>& known, std::size_t required, const std::string& expected);
  /// To the next row that holds more than blanks; false at the end.
  bool next_row();

  bool has(const std::string& column) const { return columns_.count(column) > 0; }
  /// REQUIRES: such a column, and a row.
  const std::string& field(const std::string& column) const { return fields_[columns_.at(column)]; }

 private:
  std::vector<std::string> fields_of_line() const;

  std::map<std::string, std::size_t> columns_;
  std::vector<std::string> fields_;
};

/// Whether the whole field is a number, with at most one sign.
template <class T>
bool parse_whole(std::string_view field, T& value) {
  if (field.substr(0, 1) == "+" && field.substr(1, 1) != "-") field.remove_prefix(1);
  const std::from_chars_result result = std::from_chars(field.data(), field.data() + field.size(), value);
  return result.ec == std::errc() && result.ptr == field.data() + field.size();
}

/// Without a byte order mark, as spreadsheets write it.
std::string_view without_mark(std::string_view text);

/// As `words_of` where `separator` is a blank, else as `fields_of`, into memory that is used again.
void split(std::string_view line, char separator, std::vector<std::string_view>& fields);
/// Split at every run of blanks and tabs.
std::vector<std::string_view> words_of(std::string_view line);
/// Split at every `separator`; blanks round a field are taken off.
std::vector<std::string_view> fields_of(std::string_view line, char separator);
/// The same of CSV (RFC 4180): in a field that begins with a quotation mark separators count for nothing, and two
/// quotation marks are one. None where a quotation mark is not closed, or more follows it than blanks.
std::optional<std::vector<std::string>> csv_fields_of(std::string_view line, char separator = ',');
std::string_view trimmed(std::string_view text);

}  // namespace exactvo::datasets
