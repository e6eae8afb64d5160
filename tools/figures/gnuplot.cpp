// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "figures/missing_glyphs.h"
#include "support/files.h"
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

struct Format {
  const char* name;
  const char* terminal;
  const char* listed_characters;
};
constexpr const char* kSvg = "svg";
/// Those of templates/frame.gp.
constexpr Format kFormats[] = {{"svg", kSvg, "SVG (its terminal svg)"},
                               {"png", "pngcairo", "PNG (its terminal pngcairo)"},
                               {"pdf", "pdfcairo", "PDF (its terminal pdfcairo)"}};

/// One format of one script.
struct Picture {
  const fs::path* script;
  const Format* format;
  fs::path loaded;  ///< the script itself, or a copy
};

/// Absolute folders begin with a slash and scripts have plain names: neither is taken for a command. A script draws
/// `formats`, none where this gnuplot was built without the terminal; "reset session" forgets it.
std::string driver_text(const std::vector<Picture>& pictures) {
  std::string text;
  for (const auto& [script, format, loaded] : pictures)
    text += fmt::format(
        "reset session\nformats = strstrt(' ' . GPVAL_TERMINALS . ' ', ' {} ') ? '{}' : ''\ncd {}\nload {}\n",
        format->terminal, format->name, exact_string(fs::absolute(*script).parent_path().string()),
        exact_string(loaded.string()));
  return text;
}

fs::path picture_of(const fs::path& script, const Format& format) {
  return fs::path(script).replace_extension(format.name);
}

void remove_pictures(const std::vector<fs::path>& scripts) {
  for (const fs::path& script : scripts)
    for (const Format& format : kFormats) fs::remove(picture_of(script, format));
}

std::string contents(std::FILE* file) {
  std::string text;
  std::rewind(file);
  for (int c = 0; (c = std::fgetc(file)) != EOF;) text += static_cast<char>(c);
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

/// A gnuplot process with what it reads and says.
struct Process {
  TemporaryFile driver = temporary_file(), messages = temporary_file();
  pid_t pid = 0;
};

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

/// Until all have ended; their numbers stay taken, so that no other process can have them meanwhile.
void await_ends(const std::vector<Process>& processes) {
  for (const Process& process : processes) {
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(process.pid), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR)
      if (interrupted())  // Ctrl-C reaches all, a SIGTERM only this program
        for (const Process& each : processes) ::kill(each.pid, SIGTERM);
  }
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

std::string exact_string(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
  return '"' + text + '"';
}

void draw(const std::vector<fs::path>& scripts, const std::string& what) {
  if (scripts.empty()) return;
  ProgressLine line(0.0, "");
  line.say("drawing figures" + (what.empty() ? "" : " of " + what));
  remove_pictures(scripts);  // those of earlier figures
  const std::set<char32_t> boxed = characters_without_font(scripts);
  std::optional<StagedFolder> copies;
  if (!boxed.empty()) copies.emplace(fs::temp_directory_path() / "exactvo");
  const std::size_t pictures = scripts.size() * std::size(kFormats);
  std::vector<Process> processes(process_count(pictures));
  std::vector<std::vector<Picture>> shares(processes.size());
  for (std::size_t k = 0; k < pictures; ++k) {
    const fs::path& script = scripts[k / std::size(kFormats)];
    const Format& format = kFormats[k % std::size(kFormats)];
    fs::path loaded = script.filename();
    if (copies && format.terminal != kSvg) loaded = copy_with_squares(script, boxed, copies->path(), std::to_string(k));
    shares[k % shares.size()].push_back({&script, &format, std::move(loaded)});
  }
  int error = 0;
  {
    KillChildrenOnSignal until_they_end;
    for (std::size_t k = 0; k < shares.size() && error == 0; ++k) {
      error = start_gnuplot(processes[k], shares[k], until_they_end);
      if (error != 0) processes.resize(k);
    }
    await_ends(processes);
  }
  line.clear();
  std::optional<std::string> failure;
  for (const Process& process : processes)
    if (!succeeded(process.pid) && !failure) failure = contents(process.messages.get());
  if (error == ENOENT)
    return message(
        "gnuplot is not installed (Debian: gnuplot-nox): the figures' data and scripts are written, no pictures");
  if (error != 0) failure = std::generic_category().message(error);
  if (failure) {
    remove_pictures(scripts);                // one of them may be half a picture
    if (interrupted()) throw Interrupted();  // Ctrl-C reaches gnuplot too
    throw std::runtime_error("gnuplot failed: " + *failure);
  }
  std::vector<std::string> missing;
  for (const Format& format : kFormats)
    if (!fs::exists(picture_of(scripts.front(), format))) missing.push_back(format.listed_characters);
  if (!missing.empty())
    message(fmt::format("this gnuplot cannot draw {}, which Debian's gnuplot-nox has: no such pictures are written",
                        fmt::join(missing, " and ")));
  if (!boxed.empty())
    message(
        fmt::format("note: no font on this machine has {}: PNG and PDF figures have squares in their place, SVG "
                    "leaves them to the viewer (Debian: fonts-noto-cjk, fonts-noto-color-emoji, fonts-unifont)",
                    listed_characters(boxed)));
  for (const fs::path& script : scripts) undate(fs::path(script).replace_extension(".pdf"));
}

}  // namespace exactvo::tools
