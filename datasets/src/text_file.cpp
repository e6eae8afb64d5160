// SPDX-License-Identifier: GPL-3.0-or-later
#include "text_file.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include "system_error.h"

namespace exactvo::datasets {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

FileHandle open_for_reading(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw DataError(DataCode::file_unreadable, path.string(), "", "a directory", "a file");
  }
  FileHandle file(std::fopen(path.c_str(), "rb"));
  if (!file) throw cannot_read(path, errno);
  return file;
}

}  // namespace

std::string read_beginning(const std::filesystem::path& path, std::size_t count) {
  const FileHandle file = open_for_reading(path);
  std::string text;
  char block[1 << 16];
  while (text.size() < count) {
    const std::size_t wanted = std::min(sizeof block, count - text.size());
    const std::size_t got = std::fread(block, 1, wanted, file.get());
    text.append(block, got);
    if (got < wanted) break;
  }
  if (std::ferror(file.get())) throw cannot_read(path, errno);
  return text;
}

std::string read_text_file(const std::filesystem::path& path) {
  return read_beginning(path, std::numeric_limits<std::size_t>::max());
}

std::string line_and_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? before.size() + 1 : before.size() - newline;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

std::string excerpt(std::string_view text, std::size_t byte, std::size_t length) {
  if (text.empty()) return "nothing";
  if (byte >= text.size()) return "the end of the file";
  std::string shown = "\"";
  for (const char c : text.substr(byte, length)) {
    if (c == '\n' || c == '\r') break;
    shown += c >= 0x20 && c < 0x7f ? c : '?';
  }
  return shown + "\"";
}

}  // namespace exactvo::datasets
