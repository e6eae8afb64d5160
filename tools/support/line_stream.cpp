// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/line_stream.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "exactvo/datasets/data_error.h"
#include "support/terminal.h"

namespace exactvo::tools {

using datasets::DataCode;
using datasets::DataError;

namespace {

constexpr std::size_t kChunk = LineStream::kLongestLine;
constexpr int kPatience = 100;  // ms, between two looks whether a signal has come

DataError unreadable(const std::string& file, int error) {
  const bool missing = error == ENOENT || error == ENOTDIR;
  return {missing ? DataCode::file_missing : DataCode::file_unreadable, file, "",
          missing ? "no such file" : std::generic_category().message(error), "a file that can be read"};
}

/// Without waiting for the writer of a pipe: `wait` does, and listens to signals meanwhile.
int opened(const std::string& file) {
  if (file == "-") return STDIN_FILENO;
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw unreadable(file, EISDIR);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw unreadable(file, errno);
  return descriptor;
}

}  // namespace

LineStream::LineStream(const std::string& file)
    : name_(file == "-" ? "standard input" : file), descriptor_(opened(file)) {}

LineStream::~LineStream() {
  if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
}

void LineStream::wait() const {
  pollfd source{descriptor_, POLLIN, 0};
  for (;;) {
    const int ready = ::poll(&source, 1, kPatience);
    if (interrupted()) throw Interrupted();
    if (ready > 0) return;
    if (ready < 0 && errno != EINTR) throw unreadable(name_, errno);
  }
}

bool LineStream::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t held = buffer_.size();
  buffer_.resize(held + kChunk);
  ssize_t got = -1;
  do {
    wait();
    got = ::read(descriptor_, buffer_.data() + held, kChunk);
  } while (got < 0 && (errno == EINTR || errno == EAGAIN));
  const int error = errno;
  buffer_.resize(held + static_cast<std::size_t>(got < 0 ? 0 : got));
  if (got < 0) throw unreadable(name_, error);
  return got > 0;
}

bool LineStream::next() {
  std::size_t searched = begin_;
  std::size_t end = buffer_.find('\n', searched);
  while (end == std::string::npos && !at_end_) {
    searched = buffer_.size() - begin_;
    at_end_ = !fill();
    end = buffer_.find('\n', searched);
    if (end == std::string::npos && buffer_.size() > kLongestLine) break;
  }
  if (end == std::string::npos && begin_ == buffer_.size()) return false;
  ++number_;
  const std::size_t length = (end == std::string::npos ? buffer_.size() : end) - begin_;
  if (length > kLongestLine)
    throw DataError(DataCode::size, name_, place(), "a line of more than " + std::to_string(kLongestLine) + " bytes",
                    "shorter lines");
  line_ = std::string_view(buffer_).substr(begin_, length);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  begin_ = end == std::string::npos ? buffer_.size() : end + 1;
  return true;
}

}  // namespace exactvo::tools
