// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The lines of a file, a pipe or stdin, one after the other, in memory that does not grow with the input.

#include <cstddef>
#include <string>
#include <string_view>

namespace exactvo::tools {

class LineStream {
 public:
  /// No line may be longer.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 16;

  /// "-" is stdin. Throws datasets::DataError (E_FILE_MISSING, E_FILE_UNREADABLE), as `next` does.
  explicit LineStream(const std::string& file);
  ~LineStream();
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  /// Moves to the next line, its end (\n or \r\n) taken off; false at the end. Throws DataError (E_SIZE) for a line
  /// that is too long, Interrupted where a signal asks for the end while it waits for a pipe.
  bool next();
  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }  ///< from 1
  const std::string& file() const { return name_; }
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  bool fill();
  void wait() const;

  std::string name_;  ///< as messages say it
  int descriptor_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of what is not yet given, in the buffer
  bool at_end_ = false;
  std::string_view line_;
  std::size_t number_ = 0;
};

}  // namespace exactvo::tools
