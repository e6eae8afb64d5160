// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

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
constexpr Format kFormats[kPicturesOfScript] = {{"svg", "svg", "SVG (its terminal svg)"},
                                                {"png", "pngcairo", "PNG (its terminal pngcairo)"},
                                                {"pdf", "pdfcairo", "PDF (its terminal pdfcairo)"}};

/// What the driver prints of a terminal that this gnuplot was built without, and after each picture.
const std::string kMissing = "exactvo: no terminal for ", kDrawn = "exactvo: drawn";

std::string has_terminal(const Format& format) {
  return fmt::format("strstrt(' ' . GPVAL_TERMINALS . ' ', ' {} ')", format.terminal);
}

/// One format of one script.
struct Picture {
  const fs::path* script = nullptr;
  const Format* format = nullptr;
};

/// Absolute folders begin with a slash and scripts have plain names: neither is taken for a command. A script draws
/// `formats`; "reset session" forgets it.
std::string driver_text(const std::vector<Picture>& pictures) {
  std::string text;
  for (const Format& format : kFormats)
    text += fmt::format("if (!{}) {{ print '{}{}' }}\n", has_terminal(format), kMissing, format.name);
  for (const Picture& picture : pictures) {
    const fs::path &script = *picture.script, folder = fs::absolute(script).parent_path();
    text += fmt::format("reset session\nformats = ''\nif ({}) {{ formats = '{}' }}\n", has_terminal(*picture.format),
                        picture.format->name);
    text += "cd " + exact_string(folder.string()) + "\nload " + exact_string(script.filename().string()) + "\n";
    text += "print '" + kDrawn + "'\n";
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

/// So far. The place at which a process goes on writing, which is the same for both, stays where it is.
std::string contents(std::FILE* file) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0;
       (count = ::pread(fileno(file), buffer.data(), buffer.size(), static_cast<off_t>(text.size()))) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  return text;
}

std::size_t count_of(const std::string& line, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(line); at != std::string::npos; at = text.find(line, at + 1)) ++count;
  return count;
}

/// What gnuplot said, without what the driver has it print.
std::string without_notes(const std::string& messages) {
  std::string kept;
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);)
    if (line != kDrawn && line.rfind(kMissing, 0) != 0) kept += line + "\n";
  return kept;
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

/// A gnuplot process with what it reads and says.
struct Process {
  TemporaryFile driver = temporary_file(), messages = temporary_file();
  pid_t pid = 0;
  bool has_ended = false;
};

/// Whether it has, whose number stays taken, so that no other process can have it meanwhile.
bool has_ended(pid_t pid) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOWAIT | WNOHANG) == 0 && info.si_pid == pid;
}

bool succeeded(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return false;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The error code of the attempt to start; else it runs, and a signal ends it.
int start_gnuplot(Process& process, const std::vector<Picture>& pictures, KillChildrenOnSignal& until_they_end) {
  const std::string text = driver_text(pictures);
  std::fwrite(text.data(), 1, text.size(), process.driver.get());
  std::rewind(process.driver.get());
  const std::vector<char*> environment = environment_in_utc();
  // Signals whose handlers look at children wait until this one is known.
  sigset_t ours, before;
  ::sigemptyset(&ours);
  for (const int signal : {SIGALRM, SIGINT, SIGTERM}) ::sigaddset(&ours, signal);
  ::pthread_sigmask(SIG_BLOCK, &ours, &before);
  const int error = spawn_gnuplot(process.driver.get(), process.messages.get(), environment, before, process.pid);
  if (error == 0) until_they_end.add(process.pid);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return error;
}

std::size_t drawn_by(const std::vector<Process>& processes) {
  std::size_t count = 0;
  for (const Process& process : processes) count += count_of(kDrawn, contents(process.messages.get()));
  return count;
}

/// Until all have ended.
void await_ends(std::vector<Process>& processes, std::size_t pictures, const RenderProgress& progress) {
  constexpr auto kPause = std::chrono::milliseconds(5), kBetweenLooks = std::chrono::milliseconds(200);
  auto looked_at = std::chrono::steady_clock::now();
  const auto all_have_ended = [&] {
    for (Process& process : processes) process.has_ended = process.has_ended || has_ended(process.pid);
    return std::all_of(processes.begin(), processes.end(), [](const Process& p) { return p.has_ended; });
  };
  while (!all_have_ended()) {
    if (interrupted())  // Ctrl-C reaches all, a SIGTERM only this program
      for (const Process& process : processes) ::kill(process.pid, SIGTERM);
    std::this_thread::sleep_for(kPause);
    const auto now = std::chrono::steady_clock::now();
    if (!progress || now - looked_at < kBetweenLooks) continue;
    progress(drawn_by(processes), pictures);
    looked_at = now;
  }
}

/// The largest first, each to the process that has least to do.
std::vector<std::vector<Picture>> shared_out(const std::vector<Picture>& pictures, std::size_t processes) {
  const auto cost = [](const Picture& picture) {
    std::error_code unknown;
    const std::uintmax_t bytes = fs::file_size(fs::path(*picture.script).replace_extension(".dat"), unknown);
    return unknown ? std::uintmax_t{1} : bytes + 1;
  };
  std::vector<std::pair<std::uintmax_t, Picture>> largest_first;
  for (const Picture& picture : pictures) largest_first.emplace_back(cost(picture), picture);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::vector<Picture>> shares(processes);
  std::vector<std::uintmax_t> load(processes);
  for (const auto& [bytes, picture] : largest_first) {
    const auto least = static_cast<std::size_t>(std::min_element(load.begin(), load.end()) - load.begin());
    shares[least].push_back(picture);
    load[least] += bytes;
  }
  return shares;
}

std::size_t process_count(std::size_t pictures) {
  constexpr std::size_t kMost = 4;  // each takes up to 100 MB
  static_assert(kMost <= kMostChildren);
  const std::size_t processors = std::max(1u, std::thread::hardware_concurrency());
  return std::min({processors, kMost, pictures});
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

RenderResult render(const std::vector<fs::path>& scripts, const RenderProgress& progress) {
  if (scripts.empty()) return {};
  std::vector<Picture> pictures;
  for (const fs::path& script : scripts)
    for (const Format& format : kFormats) pictures.push_back({&script, &format});
  const std::vector<std::vector<Picture>> shares = shared_out(pictures, process_count(pictures.size()));
  std::vector<Process> processes(shares.size());
  int error = 0;
  {
    KillChildrenOnSignal until_they_end;
    for (std::size_t k = 0; k < shares.size() && error == 0; ++k) {
      error = start_gnuplot(processes[k], shares[k], until_they_end);
      if (error != 0) processes.resize(k);
    }
    await_ends(processes, pictures.size(), progress);
  }
  std::string failure, said;
  bool has_failed = false;
  for (const Process& process : processes) {
    const std::string words = contents(process.messages.get());
    said += words;
    if (succeeded(process.pid) || has_failed) continue;
    has_failed = true;
    failure = without_notes(words);
  }
  if (error == ENOENT) return {Rendering::no_gnuplot, "", {}};
  if (error != 0 || has_failed) {
    remove_pictures(scripts);  // one of them may be half a picture
    return {Rendering::failed, error != 0 ? std::generic_category().message(error) : failure, {}};
  }
  for (const fs::path& script : scripts) undate(fs::path(script).replace_extension(".pdf"));
  return {Rendering::done, "", missing_formats(said)};
}

}  // namespace exactvo::tools
