// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The words, numbers and signs of well-known text, with their places.

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

}  // namespace exactvo::datasets
