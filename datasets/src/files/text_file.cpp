// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/text_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>

#include "files/system_error.h"

namespace exactvo::datasets {
namespace {

std::atomic<void (*)()> wait_hook{nullptr};

/// Between two calls of the hook.
constexpr int kWaitMilliseconds = 50;

void refuse_irregular(const std::filesystem::path& path, mode_t mode) {
  if (S_ISREG(mode) || S_ISFIFO(mode)) return;
  const char* word = S_ISDIR(mode) ? "a directory" : S_ISSOCK(mode) ? "a socket" : "a device";
  throw DataError(DataCode::file_unreadable, path.string(), "", word, "a file or a pipe");
}

/// A regular file, a pipe or standard input, read without ever blocking.
class Input {
 public:
  /// Standard input, whatever it is.
  Input() : path_("standard input"), descriptor_(STDIN_FILENO), is_standard_(true) {}
  explicit Input(const std::filesystem::path& path) : path_(path) {
    struct stat facts {};
    // Asked before it is opened: opening a device may do something.
    if (::stat(path.c_str(), &facts) != 0) throw cannot_read(path, errno);
    refuse_irregular(path, facts.st_mode);
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) throw cannot_read(path, errno);
    try {
      learn();
    } catch (...) {
      ::close(descriptor_);
      throw;
    }
  }
  ~Input() {
    if (!is_standard_) ::close(descriptor_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  bool is_pipe() const { return is_pipe_; }
  std::uint64_t size() const { return size_; }  ///< of a regular file

  /// Appends at most `count` bytes; false at the end.
  bool append(std::string& text, std::size_t count) {
    const std::size_t before = text.size();
    text.resize(before + count);
    ssize_t got = 0;
    while (is_standard_ && !is_ready()) continue;  // reading it may block
    while ((got = read_once(text.data() + before, count)) < 0) is_ready();
    text.resize(before + static_cast<std::size_t>(got));
    has_begun_ = has_begun_ || got > 0;
    return got > 0;
  }

 private:
  void learn() {
    struct stat facts {};
    struct statfs system {};
    if (::fstat(descriptor_, &facts) != 0 || ::fstatfs(descriptor_, &system) != 0) throw cannot_read(path_, errno);
    refuse_irregular(path_, facts.st_mode);
    is_pipe_ = S_ISFIFO(facts.st_mode);
    size_ = is_pipe_ ? 0 : static_cast<std::uint64_t>(facts.st_size);
    // A nameless pipe was made with both ends. One with a name may have had no writer yet: then reading it gives
    // nothing at once, which is not its end.
    has_begun_ = !is_pipe_ || system.f_type == PIPEFS_MAGIC;
  }

  /// Below 0: nothing there yet.
  ssize_t read_once(char* to, std::size_t count) {
    const ssize_t got = ::read(descriptor_, to, count);
    if (got < 0 && errno != EINTR && errno != EAGAIN) throw cannot_read(path_, errno);
    return got == 0 && !has_begun_ ? -1 : got;
  }

  /// Waits a little for it.
  bool is_ready() {
    call_wait_hook();
    pollfd one{descriptor_, POLLIN, 0};
    const bool is_ready = ::poll(&one, 1, kWaitMilliseconds) > 0;
    has_begun_ = has_begun_ || is_ready;  // there was a writer, who may have left
    return is_ready;
  }

  std::filesystem::path path_;
  int descriptor_ = -1;
  bool is_standard_ = false;
  bool is_pipe_ = false;
  bool has_begun_ = true;  ///< from then on, nothing to read is the end
  std::uint64_t size_ = 0;
};

constexpr std::size_t kBlock = std::size_t{1} << 16;

[[noreturn]] void refuse_size(const std::string& file, const std::string& found) {
  throw DataError(DataCode::size, file, "", found,
                  "at most " + std::to_string(kLargestWholeFile) + " bytes: it is read whole");
}

/// To its end.
std::string text_of(Input&& input, const std::string& file) {
  if (input.size() > kLargestWholeFile) refuse_size(file, std::to_string(input.size()) + " bytes");
  std::string text;
  text.reserve(input.size() + kBlock);
  while (input.append(text, kBlock)) {
    if (text.size() > kLargestWholeFile) refuse_size(file, "more than that");
    call_wait_hook();
  }
  return text;
}

}  // namespace

void set_wait_hook(void (*hook)()) {
  wait_hook = hook;
}

void call_wait_hook() {
  if (void (*const hook)() = wait_hook) hook();
}

bool is_pipe(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_fifo(path, error);
}

std::string read_beginning(const std::filesystem::path& path, std::size_t count) {
  Input input(path);
  if (input.is_pipe()) throw DataError(DataCode::file_unreadable, path.string(), "", "a pipe", "a regular file");
  std::string text;
  while (text.size() < count && input.append(text, std::min(kBlock, count - text.size()))) continue;
  return text;
}

CopyOfInput::CopyOfInput(Empty /*none*/, const std::filesystem::path& name) {
  std::string folder = (std::filesystem::temp_directory_path() / "exactvo-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) throw cannot_write(folder, errno);
  path_ = folder / name.filename();
}

// The folder is there from the first constructor on, and goes with what this one throws.
CopyOfInput::CopyOfInput(const std::string& input) : CopyOfInput(Empty(), input) {
  Input in = input == "-" ? Input() : Input(input);
  std::ofstream out(path_, std::ios::binary);
  for (std::string block; in.append(block, kBlock); block.clear()) {
    call_wait_hook();
    if (!out.write(block.data(), static_cast<std::streamsize>(block.size()))) break;
  }
  out.close();
  if (!out) throw cannot_write(path_, errno);
}

CopyOfInput::~CopyOfInput() {
  std::error_code ignored;
  std::filesystem::remove_all(path_.parent_path(), ignored);
}

std::string read_text_file(const std::filesystem::path& path) {
  return text_of(Input(path), path.string());
}

std::string name_of_input(const std::string& file) {
  return file == "-" ? "standard input" : file;
}

std::string read_file_or_input(const std::string& file) {
  return file == "-" ? text_of(Input(), name_of_input(file)) : read_text_file(file);
}

struct TextLines::State {
  explicit State(const std::filesystem::path& path) : name(path.string()), input(path) {}
  State(const std::string& file, std::size_t most)
      : name(name_of_input(file)), input(file == "-" ? Input() : Input(file)), longest(most) {}
  std::string name;
  Input input;
  std::size_t longest = kLargestWholeFile;
  std::string buffer{};
  std::size_t begin = 0;  ///< of what was not given yet
  std::size_t number = 0;
  bool at_end = false;
};

TextLines::TextLines(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}
TextLines::TextLines(const std::string& file, std::size_t longest) : state_(std::make_unique<State>(file, longest)) {}
TextLines::~TextLines() = default;

std::size_t TextLines::number() const {
  return state_->number;
}

const std::string& TextLines::file() const {
  return state_->name;
}

bool TextLines::next(std::string_view& line) {
  State& s = *state_;
  std::size_t searched = s.begin, end = 0;
  while ((end = s.buffer.find('\n', searched)) == std::string::npos && !s.at_end) {
    s.buffer.erase(0, s.begin);
    s.begin = 0;
    searched = s.buffer.size();
    if (searched > s.longest) break;
    s.at_end = !s.input.append(s.buffer, kBlock);
    call_wait_hook();
  }
  if (s.begin == s.buffer.size()) return false;
  ++s.number;
  end = std::min(end, s.buffer.size());
  if (end - s.begin > s.longest)
    throw DataError(DataCode::size, s.name, "line " + std::to_string(s.number),
                    "a line of more than " + std::to_string(s.longest) + " bytes", "shorter lines");
  line = std::string_view(s.buffer).substr(s.begin, end - s.begin);
  s.begin = std::min(end + 1, s.buffer.size());
  return true;
}

std::string line_and_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? before.size() + 1 : before.size() - newline;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

void refuse_entities(std::string_view xml, const std::string& file) {
  const std::size_t at = xml.find("<!ENTITY");
  if (at == std::string_view::npos) return;
  throw DataError(DataCode::format_syntax, file, line_and_column(xml, at), excerpt(xml, at),
                  "XML without entities of its own: they are not expanded");
}

std::string csv_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
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
