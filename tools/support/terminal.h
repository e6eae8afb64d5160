// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Words for people, on stderr: messages, and a line that says how far a long run has come. Results go to stdout.

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace exactvo::tools {

/// Silences `message` and `ProgressLine`; errors are still said.
void set_quiet(bool quiet);

/// Prints results on stdout, at once. Throws datasets::DataError (E_FILE_UNWRITABLE) where it takes no more, as a full
/// disc; a reader that has left is no error.
void print(const std::string& text);
/// The same for what was printed by other means.
void check_stdout();
/// Results on stderr, where stdout has something else.
void print_to_stderr(const std::string& text);

/// Prints in chunks: neither a system call a line nor the whole text in memory.
class ChunkedOutput {
 public:
  void add(const std::string& text) {
    text_ += text;
    if (text_.size() > kChunk) flush();
  }
  void flush() {
    print(text_);
    text_.clear();
  }

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 16;
  std::string text_;
};

/// "52 kB", three digits.
inline std::string size_text(double bytes) {
  const char* const units[] = {"B", "kB", "MB", "GB", "TB"};
  std::size_t k = 0;
  for (; bytes >= 1000.0 && k + 1 < std::size(units); ++k) bytes /= 1000.0;
  return fmt::format("{:.3g} {}", bytes, units[k]);
}

/// The reader of stdout has closed it (`| head`): a verb that would print for long ends here, with success.
struct ReaderLeft : std::runtime_error {
  ReaderLeft() : std::runtime_error("the reader of stdout has left") {}
};
void throw_if_reader_left();

/// "exactvo: TEXT" on stderr, unless quiet; control characters are shown, not sent.
void message(const std::string& text);
void error_message(const std::string& text);

/// After this, an interrupt (Ctrl-C) or a request to terminate is noted instead of ending the program at once (while a
/// TerminateOnSignal lives, it still ends at once: stop.h); readers that wait throw `Interrupted` then. What has not
/// ended ten seconds later is ended.
void note_interrupts();
bool interrupted();
/// What the program answers with after an interrupt: 130, or 143 after a request to terminate.
int interrupted_status();

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// How far a long run has come, with its rate and the time left, on one line of a terminal that is written over and
/// over; nothing where stderr is no terminal.
class ProgressLine {
 public:
  /// `unit`: what is counted, "runs" or "s simulated".
  ProgressLine(double total, std::string unit);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double done, const std::string& doing);
  /// For work whose progress is not known.
  void say(const std::string& doing);
  /// Whether it is seen at all.
  bool enabled() const { return enabled_; }
  /// Whether it is time to say again how far the run has come: 0.2 s after the last time, or 30 s where the line is not
  /// seen and messages say it.
  bool is_due();
  /// s, since it was made.
  double elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  /// Takes the line away, to print something else.
  void clear();

 private:
  bool enabled_;
  double total_;
  std::string unit_;
  std::chrono::steady_clock::time_point start_;
  double due_at_ = 0.0;  ///< s
  bool is_shown_ = false;
};

}  // namespace exactvo::tools
