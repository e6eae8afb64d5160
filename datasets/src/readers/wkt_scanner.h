// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Well-known text: a file of it in blocks that end between geometries; its words, numbers and signs with their places.

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets {

class WktScanner {
 public:
  /// `lines_before`: of the file, where the text is a piece of it.
  WktScanner(std::string_view text, const std::string& file, std::size_t lines_before = 0)
      : text_(text), file_(file), lines_before_(lines_before) {}

  /// Past white space and what may stand between geometries (a byte order mark, commas, semicolons).
  void skip_between_geometries() {
    if (at_ == 0 && text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
    while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == ',' || text_[at_] == ';')) ++at_;
  }

  bool at_end() {
    skip_space();
    return at_ >= text_.size();
  }

  /// The next word in upper case, or "" where none stands.
  std::string word() {
    skip_space();
    std::string letters;
    while (at_ < text_.size() && is_letter(text_[at_])) {
      letters += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_++])));
    }
    return letters;
  }

  std::string peek_word() {
    const std::size_t before = at_;
    std::string letters = word();
    at_ = before;
    return letters;
  }

  bool try_sign(char sign) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != sign) return false;
    ++at_;
    return true;
  }

  void need_sign(char sign) {
    if (!try_sign(sign)) refuse(std::string("'") + sign + "'");
  }

  bool number_ahead() {
    skip_space();
    return at_ < text_.size() && text_[at_] != ',' && text_[at_] != ')' && text_[at_] != '(';
  }

  /// Any C number; "nan" and "inf" are let through for the ring to be judged.
  double number() {
    skip_space();
    const std::size_t sign = at_ < text_.size() && text_[at_] == '+' ? 1 : 0;
    const char* first = text_.data() + at_ + sign;
    const char* last = text_.data() + text_.size();
    double value = 0.0;
    const std::from_chars_result result = std::from_chars(first, last, value);
    if (result.ec == std::errc::invalid_argument) refuse("a number", DataCode::number);
    // Beyond any double: from_chars leaves `value` alone, strtod gives an infinity or a rounded near-zero.
    if (result.ec == std::errc::result_out_of_range)
      value = std::strtod(std::string(first, result.ptr).c_str(), nullptr);
    at_ += static_cast<std::size_t>(result.ptr - first) + sign;
    return value;
  }

  /// After an error in the geometry that began at `start`: to the next line that begins with a letter.
  void skip_to_next_geometry(std::size_t start) {
    const auto geometry_may_begin = [&] { return at_ > start && text_[at_ - 1] == '\n' && is_letter(text_[at_]); };
    while (at_ < text_.size() && !geometry_may_begin()) {
      const std::size_t newline = text_.find('\n', at_);
      at_ = newline == std::string_view::npos ? text_.size() : newline + 1;
    }
  }

  std::size_t position() const { return at_; }
  std::string place() const {
    const std::size_t here = std::min(at_, text_.size());
    if (here < counted_to_) counted_to_ = newlines_ = line_start_ = 0;
    for (; counted_to_ < here; ++counted_to_) {
      if (text_[counted_to_] != '\n') continue;
      ++newlines_;
      line_start_ = counted_to_ + 1;
    }
    return "line " + std::to_string(lines_before_ + newlines_ + 1) + ", column " +
           std::to_string(here - line_start_ + 1);
  }

  [[noreturn]] void refuse(const std::string& expected, DataCode code = DataCode::format_syntax) {
    skip_space();
    throw DataError(code, file_, place(), excerpt(text_, at_), expected);
  }

 private:
  static constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  static bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
  static bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t lines_before_;
  // Up to where newlines were counted, so that places along a long text do not count them all again and again.
  mutable std::size_t counted_to_ = 0;
  mutable std::size_t newlines_ = 0;
  mutable std::size_t line_start_ = 0;
};

/// Block after block; together they are the file. A block ends before a line that begins with a letter while no bracket
/// is open: there a geometry begins, and nothing else can. Text that never closes its brackets is cut before such a
/// line as well once kLargestOpenBlock is read: it is no well-known text, and a reader starts anew on just such lines.
class WktBlocks {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;
  static constexpr std::size_t kLargestOpenBlock = std::size_t{64} << 20;

  /// Throws DataError (missing, unreadable, a folder), as `next` does.
  explicit WktBlocks(const std::filesystem::path& path, std::size_t block = kBlock) : path_(path), block_(block) {
    read_beginning(path, 1);  // names what is missing or no file
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) throw cannot_read(path, errno);
    std::error_code unknown;
    size_ = std::filesystem::file_size(path, unknown);
  }

  /// Moves on; false at the end.
  bool next() {
    buffer_.erase(0, length_);
    length_ = cut_ = scanned_ = 0;
    depth_ = 0;
    while (read_more()) {
      length_ = place_to_cut();
      if (length_ > 0) return true;
    }
    length_ = buffer_.size();
    return length_ > 0;
  }

  std::string_view text() const { return std::string_view(buffer_).substr(0, length_); }
  double share_read() const { return size_ > 0 ? static_cast<double>(read_) / static_cast<double>(size_) : 1.0; }

 private:
  bool read_more() {
    const std::size_t before = buffer_.size();
    buffer_.resize(before + block_);
    const std::size_t got = std::fread(buffer_.data() + before, 1, block_, file_.get());
    buffer_.resize(before + got);
    read_ += got;
    if (std::ferror(file_.get()) != 0) throw cannot_read(path_, errno);
    // No text holds one, and a file full of them would be taken for one geometry that does not end.
    const std::size_t zero = buffer_.find('\0', before);
    if (zero != std::string::npos)
      throw DataError(DataCode::format_syntax, path_.string(), "byte " + std::to_string(read_ - got + zero - before),
                      "a zero byte", "text");
    return got > 0;
  }

  /// The last newline that a letter follows outside all brackets.
  std::size_t place_to_cut() {
    const bool give_up = buffer_.size() >= kLargestOpenBlock;
    for (; scanned_ + 1 < buffer_.size(); ++scanned_) {
      const char c = buffer_[scanned_];
      if (c == '(') ++depth_;
      if (c == ')') --depth_;
      const bool line_of_letters = c == '\n' && std::isalpha(static_cast<unsigned char>(buffer_[scanned_ + 1])) != 0;
      if (line_of_letters && (depth_ == 0 || give_up)) cut_ = scanned_ + 1;
    }
    return cut_;
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, &std::fclose};
  std::size_t block_;
  std::uint64_t size_ = 0;
  std::uint64_t read_ = 0;
  std::string buffer_;
  std::size_t length_ = 0;   ///< of the current block
  std::size_t scanned_ = 0;  ///< of the buffer, for brackets
  long depth_ = 0;           ///< brackets open there
  std::size_t cut_ = 0;      ///< the last place between geometries; 0: none yet
};

}  // namespace exactvo::datasets
