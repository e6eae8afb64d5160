// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/wkt_blocks.h"

#include <cctype>

#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets {

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
