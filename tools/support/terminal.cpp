// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/terminal.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <system_error>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "support/escape.h"
#include "support/rank_watch.h"
#include "support/stop.h"

namespace exactvo::tools {

namespace {

bool quiet = false;
bool reader_left = false;
int write_error = 0;  ///< errno of the last write to stdout that failed
volatile std::sig_atomic_t interrupt_seen = 0;

/// Seconds that a program has to end by itself.
constexpr unsigned kGrace = 10;

std::atomic<bool> ending{false};
std::atomic<bool> stderr_is_terminal{false};

/// Called by signal handlers.
[[noreturn]] void end_now(const char* words, const char* more = "", const char* end = "") {
  while (ending.exchange(true)) ::pause();  // another thread's handler is at it
  remove_what_is_unfinished();
  if (stderr_is_terminal) write_words("\r\033[K");  // over the progress line
  for (const char* some : {words, more, end}) write_words(some);
  ::_exit(128 + interrupt_seen);
}

extern "C" void on_interrupt(int signal) {
  interrupt_seen = signal;
  if (const char* words = words_of_termination()) end_now("exactvo: error: interrupted; ", words, "\n");
  if (watches_ranks())
    begin_end_of_rank();
  else
    ::alarm(kGrace);
}

/// Something does not look at `interrupted`: a library, or a long computation. No file is half-written under its own
/// name at any time, so that the program may end anywhere; files of one output may then be of two runs.
extern "C" void on_end_of_grace(int) {
  if (watches_ranks()) {
    say_which_rank_is_lost();
    end_now("");
  }
  end_now("exactvo: error: interrupted\n");
}

void throw_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

/// Without SA_RESTART: a call that waits, in whatever library, returns.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  // One handler at a time in a thread.
  for (const int other : {SIGALRM, SIGINT, SIGTERM}) ::sigaddset(&action.sa_mask, other);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void set_quiet(bool value) {
  quiet = value;
}

void print_to_stderr(const std::string& text) {
  std::fflush(stdout);
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

void print(const std::string& text) {
  errno = 0;
  // What is longer than the buffer is written here, not at the flush.
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) {
    if (errno == EPIPE) reader_left = true;
    if (errno == EINTR) throw_if_interrupted();
    write_error = errno;
  }
  check_stdout();
}

void check_stdout() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0 && std::cout.flush().good();
  if (!flushed && errno == EINTR) throw_if_interrupted();
  if (errno == EPIPE) reader_left = true;
  if (reader_left || (flushed && std::ferror(stdout) == 0)) return;
  const int error = errno != 0 ? errno : write_error != 0 ? write_error : EIO;
  std::clearerr(stdout);
  throw datasets::DataError(datasets::DataCode::file_unwritable, "standard output", "",
                            std::generic_category().message(error), "a place to write to");
}

void throw_if_reader_left() {
  if (reader_left) throw ReaderLeft();
}

void message(const std::string& text) {
  if (!quiet) print_to_stderr("exactvo: " + shown_lines(text) + "\n");
}

void error_message(const std::string& text) {
  print_to_stderr("exactvo: error: " + shown_lines(text) + "\n");
}

void note_interrupts() {
  stderr_is_terminal = ::isatty(STDERR_FILENO) == 1;
  handle(SIGALRM, on_end_of_grace);
  handle(SIGINT, on_interrupt);
  handle(SIGTERM, on_interrupt);
  datasets::set_wait_hook(throw_if_interrupted);
}

int interrupted_status() {
  return 128 + (interrupt_seen != 0 ? interrupt_seen : SIGINT);
}

bool interrupted() {
  return interrupt_seen != 0;
}

ProgressLine::ProgressLine(double total, std::string unit)
    : enabled_(!quiet && ::isatty(STDERR_FILENO) != 0),
      total_(total),
      unit_(std::move(unit)),
      start_(std::chrono::steady_clock::now()) {}

bool ProgressLine::is_due() {
  const double now = elapsed(), between = enabled_ ? 0.2 : 30.0;
  if (due_at_ == 0.0) due_at_ = between;
  if (now < due_at_) return false;
  due_at_ = now + between;
  return true;
}

void ProgressLine::show(double done, const std::string& doing) {
  const double seconds = elapsed(), rate = seconds > 0.0 ? done / seconds : 0.0;
  std::string text = fmt::format("{:.4g} of {:.4g} {}: {}", done, total_, unit_, doing);
  if (rate > 0.0) text += fmt::format(", {:.3g} {}/s, at most {:.0f} s left", rate, unit_, (total_ - done) / rate);
  say(text);
}

void ProgressLine::say(const std::string& doing) {
  if (!enabled_) return;
  print_to_stderr("\r\033[K" + shown(doing));
  is_shown_ = true;
}

void ProgressLine::clear() {
  if (std::exchange(is_shown_, false)) print_to_stderr("\r\033[K");
}

}  // namespace exactvo::tools
