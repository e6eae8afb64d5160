// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Lines of tables as fields, and fields as numbers.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"

namespace exactvo::tools {

/// Without the blanks round it.
std::string_view trimmed(std::string_view text);

/// Without the byte order mark that may stand before the text of a file.
std::string_view without_mark(std::string_view text);

/// Between commas, or between blanks where there is no comma; blanks round a field are taken off, and the quotation
/// marks of CSV, within which commas part nothing.
std::vector<std::string_view> fields_of(std::string_view line);

/// The whole field as a double, which may be infinite or NaN where it says so; nothing where it is no number.
std::optional<double> number_in(std::string_view field);

/// The lines of a table that hold something, from a file, a pipe or stdin, one after the other.
class TableLines {
 public:
  /// No line may be longer.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 16;

  /// "-" is stdin. Throws datasets::DataError, as `next` does (input_text.h).
  explicit TableLines(const std::string& file) : lines_(file, kLongestLine) {}

  /// Moves to the next line that is neither blank nor a comment (#); false at the end.
  bool next();
  /// Without the blanks round it.
  std::string_view line() const { return line_; }
  std::size_t number() const { return lines_.number(); }  ///< from 1, in the file
  const std::string& file() const { return lines_.file(); }

  /// Throws DataError of that line.
  [[noreturn]] void refuse(datasets::DataCode code, std::string_view found, const std::string& expected) const;

 private:
  datasets::TextLines lines_;
  std::string_view line_;
};

}  // namespace exactvo::tools
