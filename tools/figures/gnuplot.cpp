// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>

#include "support/stop.h"
#include "support/terminal.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

using TemporaryFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

TemporaryFile temporary_file() {
  TemporaryFile file(std::tmpfile(), &std::fclose);
  if (!file) throw std::system_error(errno, std::generic_category(), "creating a temporary file");
  return file;
}

/// A gnuplot string of exactly these bytes, each by its octal number: a folder may be called anything, and gnuplot runs
/// what stands between backticks.
std::string exact_string(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
  return '"' + text + '"';
}

struct Format {
  const char* name;
  const char* terminal;
  const char* in_words;
};
/// Those of templates/frame.gp.
constexpr Format kFormats[] = {{"svg", "svg", "SVG (its terminal svg)"},
                               {"png", "pngcairo", "PNG (its terminal pngcairo)"},
                               {"pdf", "pdfcairo", "PDF (its terminal pdfcairo)"}};

/// What the driver prints of a terminal that this gnuplot was built without.
const std::string kMissing = "exactvo: no terminal for ";

std::string has_terminal(const Format& format) {
  return fmt::format("strstrt(' ' . GPVAL_TERMINALS . ' ', ' {} ')", format.terminal);
}

/// Absolute folders begin with a slash and scripts have plain names: neither is taken for a command. Scripts draw
/// `formats`; "reset session" forgets it.
std::string driver_text(const std::vector<fs::path>& scripts) {
  std::string text, formats = "formats = ''\n";
  for (const Format& format : kFormats) {
    text += fmt::format("if (!{}) {{ print '{}{}' }}\n", has_terminal(format), kMissing, format.name);
    formats += fmt::format("if ({}) {{ formats = formats . ' {}' }}\n", has_terminal(format), format.name);
  }
  for (const fs::path& script : scripts) {
    text += "reset session\n" + formats + "cd " + exact_string(fs::absolute(script).parent_path().string()) +
            "\nload " + exact_string(script.filename().string()) + "\n";
  }
  return text;
}

std::vector<std::string> missing_formats(const std::string& messages) {
  std::vector<std::string> missing;
  for (const Format& format : kFormats)
    if (messages.find(kMissing + format.name + "\n") != std::string::npos) missing.push_back(format.in_words);
  return missing;
}

void remove_pictures(const std::vector<fs::path>& scripts) {
  for (fs::path picture : scripts)
    for (const Format& format : kFormats) fs::remove(picture.replace_extension(format.name));
}

std::string contents(std::FILE* file) {
  std::string text;
  std::rewind(file);
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file)) text.append(buffer.data(), count);
  return text;
}

/// This program's, with UTC as the time zone of the date that is in a PDF: one length everywhere (undate).
std::vector<char*> environment_in_utc() {
  static char utc[] = "TZ=UTC";
  std::vector<char*> environment;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (std::string(*variable).rfind("TZ=", 0) != 0) environment.push_back(*variable);
  environment.insert(environment.end(), {utc, nullptr});
  return environment;
}

/// The error code of the attempt to start, 0 where `pid` runs, with the signals of `mask` blocked. Throws nothing.
int spawn_gnuplot(std::FILE* input, std::FILE* messages, const std::vector<char*>& environment, const sigset_t& mask,
                  pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input), 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages), 1);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages), 2);
  char program[] = "gnuplot";
  char defaults[] = "-d";  // the settings of the user's own ~/.gnuplot are left alone
  char* arguments[] = {program, defaults, nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &mask);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int error = posix_spawnp(&pid, program, &actions, &attributes, arguments, environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// Waits until the child has ended, and leaves its number taken, so that no other process can have it meanwhile.
void await_end(pid_t pid) {
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR)
    if (interrupted()) ::kill(pid, SIGTERM);  // Ctrl-C reaches both, a SIGTERM only this program
}

bool succeeded(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return false;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The error code of the attempt to start; else `pid` has run to its end.
int run_gnuplot(std::FILE* input, std::FILE* messages, pid_t& pid) {
  const std::vector<char*> environment = environment_in_utc();
  // Signals whose handlers look at children wait until this one is known.
  sigset_t ours, before;
  ::sigemptyset(&ours);
  for (const int signal : {SIGALRM, SIGINT, SIGTERM}) ::sigaddset(&ours, signal);
  ::pthread_sigmask(SIG_BLOCK, &ours, &before);
  const int error = spawn_gnuplot(input, messages, environment, before, pid);
  const KillChildOnSignal until_it_ends(error == 0 ? pid : 0);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (error == 0) await_end(pid);
  return error;
}

/// Cairo writes the time into a PDF. The same input gives the same bytes: it becomes the beginning of 1970.
void undate(const fs::path& pdf) {
  const std::string key = "/CreationDate (D:", none = "19700101000000Z";
  std::fstream file(pdf, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t at = bytes.rfind(key);
  if (at == std::string::npos || bytes.compare(at + key.size() + none.size(), 1, ")") != 0) return;
  file.clear();
  file.seekp(static_cast<std::streamoff>(at + key.size()));
  file << none;
}

}  // namespace

RenderResult render(const std::vector<fs::path>& scripts) {
  if (scripts.empty()) return {};
  const TemporaryFile driver = temporary_file();
  const TemporaryFile messages = temporary_file();
  const std::string text = driver_text(scripts);
  std::fwrite(text.data(), 1, text.size(), driver.get());
  std::rewind(driver.get());

  pid_t pid = 0;
  const int error = run_gnuplot(driver.get(), messages.get(), pid);
  if (error == ENOENT) return {Rendering::no_gnuplot, "", {}};
  if (error != 0) return {Rendering::failed, std::generic_category().message(error), {}};
  if (!succeeded(pid)) {
    remove_pictures(scripts);  // one of them may be half a picture
    return {Rendering::failed, contents(messages.get()), {}};
  }
  for (const fs::path& script : scripts) undate(fs::path(script).replace_extension(".pdf"));
  return {Rendering::done, "", missing_formats(contents(messages.get()))};
}

}  // namespace exactvo::tools
