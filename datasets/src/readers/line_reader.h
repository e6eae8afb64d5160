// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A text a line at a time, and the fields of a line as numbers, with the line's number in every refusal.

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/counted.h"

namespace exactvo::datasets {

class LineAtHand {
 public:
  explicit LineAtHand(std::string file) : file_(std::move(file)) {}

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }  ///< from 1
  std::string place() const { return "line " + std::to_string(number_); }
  const std::string& file() const { return file_; }

  double to_number(std::string_view field) const;
  std::int64_t to_integer(std::string_view field) const;
  /// As `csv_fields_of`; refuses a quotation mark that is not closed.
  std::vector<std::string> fields() const;
  [[noreturn]] void refuse(DataCode code, const std::string& found, const std::string& expected) const;

 protected:
  std::string file_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// The lines of a text.
class LineReader : public LineAtHand {
 public:
  /// A byte order mark before the text is left out.
  LineReader(std::string text, const std::string& file);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// Moves to the next line, its end (\n or \r\n) taken off; false at the end.
  bool next();
  /// To the next one that holds more than blanks.
  bool next_filled();
  /// Bytes not yet read.
  std::size_t left() const { return rest_.size(); }

 private:
  std::string text_;
  std::string_view rest_;
};

/// The lines of a table that hold something, from a file, a pipe or stdin ("-"), as they come.
class TableLines : public LineAtHand {
 public:
  /// No line may be longer.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 16;

  /// Throws DataError, as `next_filled` does (input_text.h).
  explicit TableLines(const std::string& file) : LineAtHand(name_of_input(file)), lines_(file, kLongestLine) {}

  /// Moves to the next line that is neither blank nor a comment (#), without the blanks round it; false at the end.
  bool next_filled();
  /// Without a comma, the words between blanks.
  std::vector<std::string> fields() const;
  [[noreturn]] void refuse(DataCode code, std::string_view found, const std::string& expected) const;

 private:
  TextLines lines_;
};

/// CSV with a header that names its columns. `Lines`: LineReader or TableLines.
template <class Lines>
class CsvTable : public Lines {
 public:
  using Lines::Lines;
  using Lines::refuse;
  enum class OtherColumns { refused, passed_over };

  /// Reads the header. `known`: the columns that there may be; the first `required` of them there must be. Refusals say
  /// that `expected` was.
  void read_header(const std::vector<std::string>& known, std::size_t required, const std::string& expected) {
    if (!Lines::next_filled()) refuse(DataCode::format_syntax, "an empty file", expected);
    take_header(known, required, expected, OtherColumns::refused);
  }
  /// The same for the line at hand.
  void take_header(const std::vector<std::string>& known, std::size_t required, const std::string& expected,
                   OtherColumns others) {
    fields_ = Lines::fields();
    count_ = fields_.size();
    for (std::size_t k = 0; k < count_; ++k) {
      const bool is_known = std::find(known.begin(), known.end(), fields_[k]) != known.end();
      if (!is_known && others == OtherColumns::passed_over) continue;
      if (!is_known) refuse(DataCode::key_unknown, "an unknown column \"" + fields_[k] + "\"", expected);
      if (!columns_.emplace(fields_[k], k).second)
        refuse(DataCode::json_duplicate_key, "column \"" + fields_[k] + "\" a second time", "each column once");
    }
    for (std::size_t k = 0; k < required; ++k)
      if (!has(known[k])) refuse(DataCode::key_missing, "no column \"" + known[k] + "\"", expected);
  }
  /// To the next row that holds more than blanks; false at the end.
  bool next_row() {
    if (!Lines::next_filled()) return false;
    fields_ = Lines::fields();
    if (fields_.size() != count_)
      refuse(DataCode::wrong_count, geometry::counted(fields_.size(), "field"),
             std::to_string(count_) + ", as many as the header has");
    return true;
  }

  bool has(const std::string& column) const { return columns_.count(column) > 0; }
  /// REQUIRES: such a column, and a row.
  const std::string& field(const std::string& column) const { return fields_[columns_.at(column)]; }

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::string> fields_;
  std::size_t count_ = 0;
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
/// The same for CSV (RFC 4180): in a field that begins with a quotation mark separators count for nothing, and two
/// quotation marks are one. None where a quotation mark is not closed, or more follows it than blanks.
std::optional<std::vector<std::string>> csv_fields_of(std::string_view line, char separator = ',');
std::string_view trimmed(std::string_view text);

}  // namespace exactvo::datasets
