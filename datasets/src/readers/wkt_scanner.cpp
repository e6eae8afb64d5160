// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/wkt_scanner.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdlib>

#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets {
namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool is_space(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

}  // namespace

void WktScanner::skip_space() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
}

void WktScanner::skip_between_geometries() {
  if (at_ == 0 && text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
  while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == ',' || text_[at_] == ';')) ++at_;
}

bool WktScanner::at_end() {
  skip_space();
  return at_ >= text_.size();
}

std::string WktScanner::word() {
  skip_space();
  std::string letters;
  while (at_ < text_.size() && is_letter(text_[at_])) {
    letters += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_++])));
  }
  return letters;
}

std::string WktScanner::peek_word() {
  const std::size_t before = at_;
  std::string letters = word();
  at_ = before;
  return letters;
}

bool WktScanner::try_sign(char sign) {
  skip_space();
  if (at_ >= text_.size() || text_[at_] != sign) return false;
  ++at_;
  return true;
}

void WktScanner::need_sign(char sign) {
  if (!try_sign(sign)) refuse(std::string("'") + sign + "'");
}

bool WktScanner::number_ahead() {
  skip_space();
  return at_ < text_.size() && text_[at_] != ',' && text_[at_] != ')' && text_[at_] != '(';
}

double WktScanner::number() {
  skip_space();
  const std::size_t sign = at_ < text_.size() && text_[at_] == '+' ? 1 : 0;
  const char* first = text_.data() + at_ + sign;
  const char* last = text_.data() + text_.size();
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(first, last, value);
  if (result.ec == std::errc::invalid_argument) refuse("a number", DataCode::number);
  // Beyond any double: from_chars leaves `value` alone, strtod gives an infinity or a rounded near-zero.
  if (result.ec == std::errc::result_out_of_range) value = std::strtod(std::string(first, result.ptr).c_str(), nullptr);
  at_ += static_cast<std::size_t>(result.ptr - first) + sign;
  return value;
}

void WktScanner::skip_to_next_geometry(std::size_t start) {
  const auto geometry_may_begin = [&] { return at_ > start && text_[at_ - 1] == '\n' && is_letter(text_[at_]); };
  while (at_ < text_.size() && !geometry_may_begin()) {
    const std::size_t newline = text_.find('\n', at_);
    at_ = newline == std::string_view::npos ? text_.size() : newline + 1;
  }
}

std::string WktScanner::place() const {
  const std::size_t here = std::min(at_, text_.size());
  if (here < counted_to_) counted_to_ = newlines_ = line_start_ = 0;
  for (; counted_to_ < here; ++counted_to_) {
    if (text_[counted_to_] != '\n') continue;
    ++newlines_;
    line_start_ = counted_to_ + 1;
  }
  return "line " + std::to_string(lines_before_ + newlines_ + 1) + ", column " + std::to_string(here - line_start_ + 1);
}

void WktScanner::refuse(const std::string& expected, DataCode code) {
  skip_space();
  throw DataError(code, file_, place(), excerpt(text_, at_), expected);
}

WktBlocks::WktBlocks(const std::filesystem::path& path, std::size_t block) : path_(path), block_(block) {
  read_beginning(path, 1);  // names what is missing or no file
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_) throw cannot_read(path, errno);
  std::error_code unknown;
  size_ = std::filesystem::file_size(path, unknown);
}

bool WktBlocks::read_more() {
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
std::size_t WktBlocks::place_to_cut() {
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

bool WktBlocks::next() {
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

double WktBlocks::share_read() const {
  return size_ > 0 ? static_cast<double>(read_) / static_cast<double>(size_) : 1.0;
}

}  // namespace exactvo::datasets
