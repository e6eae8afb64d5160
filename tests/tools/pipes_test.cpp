// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs that are no regular files: pipes are read, and every wait for one ends at a signal; devices, folders and
// sockets are refused, as inputs and as outputs.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "run_program.h"

namespace exactvo::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

namespace fs = std::filesystem;

constexpr const char* kSquare = "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))\n";

void make_pipe(const Workplace& here, const std::string& name) {
  ASSERT_EQ(::mkfifo((here.path() / name).c_str(), 0600), 0) << std::strerror(errno);
}

/// The program in the background, with its stdin at the reading end of a pipe without a writer.
class Running {
 public:
  Running(const Workplace& here, std::vector<std::string> words) {
    words.insert(words.begin(), EXACTVO_PROGRAM);
    int ends[2];
    EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    stdin_ = ends[1];
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[0], STDIN_FILENO);
      const std::string err = (here.path() / "err").string();
      const int messages = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(messages, STDERR_FILENO);
      ::dup2(messages, STDOUT_FILENO);
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      if (::chdir(here.path().c_str()) == 0) ::execv(EXACTVO_PROGRAM, argv.data());
      ::_exit(127);
    }
    ::close(ends[0]);
  }
  ~Running() { ::close(stdin_); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Sleeping and having used no processor for a while: it waits.
  void await_rest() const {
    std::string before;
    for (int equal = 0; equal < 5; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      const std::string now = switches_and_state();
      if (now.empty() || now.front() == 'Z') return;  // it has ended, which its status will say
      equal = now == before && now.front() == 'S' ? equal + 1 : 0;
      before = now;
    }
  }

  /// Until it has used so much processor time, or has ended.
  void await_work(double seconds) const {
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
      std::istringstream now(switches_and_state());
      char state = 'Z';
      double user = 0.0, system = 0.0;
      now >> state >> user >> system;
      if (state == 'Z' || user + system >= seconds * static_cast<double>(::sysconf(_SC_CLK_TCK))) return;
    }
  }

  int status_after(int signal) const {
    await_rest();
    return status_at_once(signal);
  }
  int status_at_once(int signal) const {
    EXPECT_EQ(::kill(pid_, signal), 0);
    return status();
  }
  int status() const {
    int status = 0;
    EXPECT_EQ(::waitpid(pid_, &status, 0), pid_);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  /// State and processor time of /proc/PID/stat, fields 3, 14 and 15.
  std::string switches_and_state() const {
    std::FILE* file = std::fopen(("/proc/" + std::to_string(pid_) + "/stat").c_str(), "r");
    if (file == nullptr) return "S gone";
    char state = '?';
    unsigned long user = 0;
    unsigned long system = 0;
    const int read =
        std::fscanf(file, "%*d %*s %c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &state, &user, &system);
    std::fclose(file);
    return read == 3 ? std::string(1, state) + " " + std::to_string(user) + " " + std::to_string(system) : "";
  }

  pid_t pid_ = -1;
  int stdin_ = -1;
};

TEST(Pipes, AWaitForAWriterEndsAtASignalInEveryVerb) {
  const Workplace here;
  make_pipe(here, "p.wkt");
  make_pipe(here, "p.geojson");
  make_pipe(here, "p.json");
  make_pipe(here, "p.csv");
  here.write("s.wkt", kSquare);
  const std::vector<std::vector<std::string>> commands{
      {"validate", "p.wkt"},
      {"validate", "p.geojson"},
      {"validate", "--format", "gdal", "p.wkt"},
      {"repair", "p.wkt", "--out", "o.wkt"},
      {"convert", "p.wkt", "o.wkt"},
      {"segment", "p.geojson"},
      {"simulate", "p.json", "--out", "out"},
      {"trap", "p.json"},
      {"route", "p.wkt", "--from", "0,0", "--to", "1,1", "--radius", "0.1"},
      {"route", "s.wkt", "--queries", "p.csv", "--radius", "0.1"},
      {"route", "s.wkt", "--queries", "-", "--radius", "0.1"},
      {"check", "p.csv", "--radius", "0.1"},
      {"check", "-", "--radius", "0.1"},
      {"explain", "p.json", "--time", "1", "--robot", "0", "--out", "o.svg"},
      {"lp", "p.json"},
      {"lp", "-"},
      {"vo", "--obstacle", "p.wkt", "--position", "9,9", "--velocity", "1,0", "--radius", "0.5", "--time-horizon", "2"},
      {"audit", "--certificate", "p.json"},
      {"audit", "--certificate", "-"}};
  for (std::size_t k = 0; k < commands.size(); ++k) {
    const int signal = k % 2 == 0 ? SIGTERM : SIGINT;
    const Running program(here, commands[k]);
    EXPECT_EQ(program.status_after(signal), 128 + signal) << testing::PrintToString(commands[k]) << here.read("err");
    EXPECT_THAT(here.read("err"), HasSubstr("interrupted"));
  }
  EXPECT_FALSE(here.has("o.wkt"));
  EXPECT_FALSE(here.has("out"));
}

TEST(Pipes, AWaitForTheRestEndsAtASignal) {
  const Workplace here;
  make_pipe(here, "p.wkt");
  const Running program(here, {"validate", "p.wkt"});
  const int writer = ::open((here.path() / "p.wkt").c_str(), O_WRONLY);
  ASSERT_GE(writer, 0);
  ASSERT_GT(::write(writer, "POLYGON ((", 10), 0);
  EXPECT_EQ(program.status_after(SIGTERM), 143);
  ::close(writer);
}

/// Large features, one of them alone: the signal comes while the module that holds GDAL reads, and is seen within the
/// feature. A program that does not see it is ended ten seconds later, in other words.
TEST(Pipes, ASignalEndsTheReadingOfOneLargeFeature) {
  constexpr double kAmidReading = 0.3;  // s of processor time, of about three
  const Workplace here;
  std::string feature = R"({"type": "Feature", "properties": {"p": [1)";
  while (feature.size() < 60'000'000)
    feature += ",\"some words of a long list that its parser takes little memory for\"";
  feature += R"(]}, "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}})";
  here.write("one.geojsonl", feature + "\n");
  here.write("one.geojson", feature);
  for (const char* file : {"one.geojsonl", "one.geojson"}) {
    const Running program(here, {"validate", file});
    program.await_work(kAmidReading);
    EXPECT_EQ(program.status_at_once(SIGTERM), 143) << here.read("err");
    EXPECT_THAT(here.read("err"), HasSubstr("interrupted; what was not finished is not written")) << file;
  }
}

TEST(Pipes, WhatComesThroughOneIsReadWhateverReadsIt) {
  const Workplace here;
  here.write("a.wkt", kSquare);
  here.write("b.geojson", R"({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]})");
  here.write("empty.wkt", "");
  for (const std::string name : {"a.wkt", "b.geojson"}) {
    make_pipe(here, "p-" + name);
    const std::string copy = "cp " + name + " p-" + name + " & ";
    const std::string program = "'" EXACTVO_PROGRAM "' validate p-" + name + " 2>err";
    EXPECT_EQ(std::system(("cd '" + here.path().string() + "'; " + copy + program).c_str()), 0) << here.read("err");
    EXPECT_THAT(here.read("err"), HasSubstr("p-" + name + ": "));
    EXPECT_THAT(here.read("err"), HasSubstr("1 read: 1 valid"));
  }
  const Outcome nameless = here.run("validate /dev/stdin --format wkt", "cat a.wkt | ");
  EXPECT_THAT(nameless.err, AllOf(HasSubstr("/dev/stdin: wkt, 1 read"))) << nameless.out;
  const Outcome nothing = here.run("validate /dev/stdin --format wkt", "cat empty.wkt | ");
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.out, AllOf(HasSubstr("/dev/stdin"), HasSubstr("an empty file")));
}

TEST(Pipes, EveryVerbReadsOneOnce) {
  const Workplace here;
  here.write("s.wkt", kSquare);
  std::filesystem::copy_file(data_file("paper/A1.json"), here.path() / "s.json");
  here.write("s.lp.json", here.run("vo --obstacle s.wkt --position 9,9 --velocity 1,0 --radius 0.5 --time-horizon 2 "
                                   "--json")
                              .out);
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  std::filesystem::copy_file(here.path() / "run/recording.jsonl", here.path() / "s.jsonl");
  // What is read, and how; PIPE stands for its name.
  const std::vector<std::pair<std::string, std::string>> commands{
      {"s.json", "simulate PIPE"},
      {"s.json", "simulate PIPE --out out --no-figures"},
      {"s.json", "trap PIPE"},
      {"s.json", "explain PIPE --time 1 --robot 0 --out e.svg"},
      {"s.json", "audit run --scenario PIPE"},
      {"s.jsonl", "audit PIPE"},
      {"s.lp.json", "audit --certificate PIPE"},
      {"s.wkt", "validate PIPE"},
      {"s.wkt", "repair PIPE --out r.wkt --figure r.svg"},
      {"s.wkt", "convert PIPE c.geojson"},
      {"s.wkt", "segment PIPE"},
      {"run/trajectory.csv", "check PIPE --radius 0.01"},
      {"s.wkt", "route PIPE --from -9,0 --to -9,9 --radius 0.5"},
      {"s.wkt", "vo --obstacle PIPE --position 9,9 --velocity 1,0 --radius 0.5 --time-horizon 2"}};
  for (auto [file, command] : commands) {
    const std::string pipe = "pipe-" + std::filesystem::path(file).filename().string();
    if (!here.has(pipe)) make_pipe(here, pipe);
    command.replace(command.find("PIPE"), 4, pipe);
    // A second reading would wait for ever.
    const std::string whole = "cd '" + here.path().string() + "'; timeout 60 cp " + file + " " + pipe + " & cd '" +
                              here.path().string() + "'; timeout 60 '" EXACTVO_PROGRAM "' " + command + " >log 2>&1";
    EXPECT_EQ(std::system(whole.c_str()), 0) << command << "\n" << here.read("log");
  }
  EXPECT_EQ(without_times(here.read("out/trajectory.csv")), without_times(here.read("run/trajectory.csv")));
  EXPECT_THAT(here.read("out/metrics.json"), HasSubstr("pipe-s.json"));
}

/// Runs the line in the workplace; PROGRAM stands for the program.
int status_of(const Workplace& here, std::string line) {
  for (std::size_t at = 0; (at = line.find("PROGRAM", at)) != std::string::npos;)
    line.replace(at, 7, "timeout 60 '" EXACTVO_PROGRAM "'");
  const int status = std::system(("cd '" + here.path().string() + "'; " + line).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Pipes, ARunIsAuditedWhileItIsMade) {
  const Workplace here;
  std::filesystem::copy_file(data_file("paper/A7.json"), here.path() / "s.json");
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  const Outcome of_file = here.run("audit run/recording.jsonl");
  ASSERT_EQ(of_file.status, 0);
  make_pipe(here, "pipe");
  EXPECT_EQ(
      status_of(here, "PROGRAM simulate s.json --record pipe >run.log 2>&1 & PROGRAM audit pipe >log 2>&1 && wait $!"),
      0);
  EXPECT_EQ(here.read("log"), of_file.out);
  EXPECT_THAT(here.read("run.log"), HasSubstr("all robots arrived"));
  EXPECT_TRUE(fs::is_fifo(here.path() / "pipe")) << "no file takes its place";
  EXPECT_EQ(status_of(here, "cat run/recording.jsonl | PROGRAM audit - >log 2>&1"), 0);
  EXPECT_EQ(here.read("log"), of_file.out);
}

TEST(Pipes, ARunIsAuditedFromItsStandardOutput) {
  const Workplace here;
  std::filesystem::copy_file(data_file("paper/A7.json"), here.path() / "s.json");
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  const std::string of_file = here.run("audit run/recording.jsonl").out;
  for (const std::string record : {"--record -", "--record /dev/stdout"}) {
    const std::string pipeline = "PROGRAM simulate s.json " + record;
    EXPECT_EQ(status_of(here, pipeline + " 2>run.log | PROGRAM audit - >log 2>&1"), 0) << here.read("log");
    EXPECT_EQ(here.read("log"), of_file) << record;
    EXPECT_THAT(here.read("run.log"), HasSubstr("all robots arrived")) << record;
  }
  EXPECT_EQ(status_of(here, "PROGRAM simulate s.json --record - --json -q >r.jsonl 2>m.json"), 0);
  EXPECT_THAT(here.read("m.json"), testing::StartsWith("{"));
  EXPECT_THAT(here.read("m.json"), HasSubstr("\"all_arrived\": true"));
  EXPECT_EQ(here.run("audit r.jsonl").out, of_file);
  EXPECT_EQ(status_of(here, "PROGRAM simulate s.json --record - >/dev/full 2>log"), 2);
  EXPECT_THAT(here.read("log"), HasSubstr("standard output: found No space left on device"));
  for (const std::string other : {"--out o", "--decisions none"})
    EXPECT_EQ(here.run("simulate s.json --record - " + other).status, 2) << other;
  EXPECT_THAT(here.run("simulate s.json --record r.jsonl").err,
              HasSubstr("a recording of decisions goes to - or a pipe, or to disk with --out DIR"));
}

/// Whatever keeps a run from beginning, a reader that waits for its recording gets an end.
TEST(Pipes, ARunThatCannotBeginLeavesNoReaderWaiting) {
  const Workplace here;
  here.write("bad.json", "{}");
  make_pipe(here, "pipe");
  for (const std::string run :
       {"simulate nosuch.json --record ", "simulate bad.json --record ", "simulate bad.json --metod orca --record "}) {
    EXPECT_EQ(status_of(here, "PROGRAM " + run + "- 2>run.log | PROGRAM audit - >log 2>&1"), 2) << run;
    EXPECT_THAT(here.read("log"), HasSubstr("standard input: found an empty file, expected a recording"));
    EXPECT_THAT(here.read("log"), HasSubstr("[E_CUT_OFF]"));
    EXPECT_THAT(here.read("run.log"), HasSubstr("error: "));
  }
  for (const std::string run : {"simulate nosuch.json --record ", "simulate bad.json --record "}) {
    EXPECT_EQ(status_of(here, "PROGRAM " + run + "pipe 2>run.log & PROGRAM audit pipe >log 2>&1"), 2) << run;
    EXPECT_THAT(here.read("log"), HasSubstr("pipe: found an empty file, expected a recording"));
  }
}

TEST(Pipes, AWaitForAReaderEndsAtASignal) {
  const Workplace here;
  std::filesystem::copy_file(data_file("paper/A1.json"), here.path() / "s.json");
  make_pipe(here, "pipe");
  const Running program(here, {"simulate", "s.json", "--record", "pipe"});
  EXPECT_EQ(program.status_after(SIGINT), 130);
  EXPECT_THAT(here.read("err"), HasSubstr("exactvo: begins once pipe is read"));
}

TEST(Pipes, ARecordingThatEndsEarlyIsAuditedAsFarAsItGoesAndIsNoWholeOne) {
  const Workplace here;
  std::filesystem::copy_file(data_file("paper/A1.json"), here.path() / "s.json");
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  EXPECT_EQ(status_of(here, "head -n 9 run/recording.jsonl >cut.jsonl; PROGRAM audit - <cut.jsonl >log 2>err"), 2);
  const std::string words = here.read("err");
  EXPECT_THAT(words, HasSubstr("standard input: line 10: found the end of the file after "));
  EXPECT_THAT(words, HasSubstr("expected a last line \"end\": the recording ends early; audited so far: "));
  EXPECT_THAT(words, HasSubstr(" 0 refuted, 0 left open [E_CUT_OFF]"));
  EXPECT_THAT(here.read("log"), HasSubstr("a recording ends early: what follows is of the rows there are"));
  const Outcome of_file = here.run("audit cut.jsonl");
  EXPECT_EQ(of_file.status, 2);
  EXPECT_EQ(of_file.out, here.read("log"));
  EXPECT_EQ(of_file.err, std::string(words).replace(words.find("standard input"), 14, "cut.jsonl"));
  EXPECT_THAT(here.run("audit cut.jsonl --json").out, HasSubstr("\"cut_off\": true"));
  EXPECT_THAT(here.run("view cut.jsonl --out v.html").err, HasSubstr("[E_CUT_OFF]"));
  EXPECT_FALSE(here.has("v.html"));
  // Within a line, as a packed recording ends whose writer was stopped.
  EXPECT_EQ(status_of(here, "gzip -c run/recording.jsonl | head -c 3000 | gzip -dc 2>gz | PROGRAM audit - >log 2>err"),
            2);
  EXPECT_THAT(here.read("err"), HasSubstr(", within a line, expected a last line \"end\": the recording ends early"));
  EXPECT_THAT(here.read("err"), HasSubstr("[E_CUT_OFF]"));
}

/// The signal comes to the writer while it runs.
TEST(Pipes, ASignalLeavesARecordingThatSaysItEndsEarly) {
  const Workplace here;
  here.write("ring.json", R"({"name": "ring", "time_limit": 600, "robots": [
    {"circle": {"count": 60, "radius": 200}, "max_speed": 1.5}]})");
  constexpr const char* kWriter =
      "( '" EXACTVO_PROGRAM "' simulate ring.json --record - 2>run.log & echo $! >pid; wait $! )";
  for (const std::string signal : {"INT", "TERM", "KILL"}) {
    const std::string pipeline = kWriter + std::string(" | tee part.jsonl | PROGRAM audit - >log 2>err & audit=$!; ");
    const std::string grown =
        "until [ $(stat -c %s part.jsonl 2>/dev/null || echo 0) -gt 600000 ]; do sleep 0.05; done; ";
    EXPECT_EQ(
        status_of(here, "rm -f part.jsonl pid; " + pipeline + grown + "kill -" + signal + " $(cat pid); wait $audit"),
        2)
        << here.read("err");
    EXPECT_THAT(here.read("err"), HasSubstr("the recording ends early; audited so far: ")) << signal;
    EXPECT_THAT(here.read("err"), HasSubstr("[E_CUT_OFF]")) << signal;
    EXPECT_THAT(here.run("audit part.jsonl").err, HasSubstr("[E_CUT_OFF]")) << signal;
    if (signal == "KILL") continue;  // which leaves no time for words
    EXPECT_THAT(here.read("run.log"), HasSubstr("interrupted; the recording ends early"));
  }
}

TEST(Pipes, ARunWhoseReaderLeavesEnds) {
  const Workplace here;
  std::filesystem::copy_file(data_file("paper/A7.json"), here.path() / "s.json");
  make_pipe(here, "pipe");
  EXPECT_EQ(status_of(here,
                      "PROGRAM simulate s.json --decisions all --record pipe >log 2>&1 & "
                      "head -c 100 pipe >beginning; wait $!"),
            2);
  EXPECT_THAT(here.read("log"), HasSubstr("pipe: found"));
  EXPECT_THAT(here.read("beginning"), HasSubstr("exactvo-recording"));
  EXPECT_EQ(
      status_of(here, "( PROGRAM simulate s.json --decisions all --record - 2>log; echo $? >status ) | head -c 100 >b"),
      0);
  EXPECT_EQ(here.read("status"), "2\n");
  EXPECT_THAT(here.read("log"), HasSubstr("standard output: found Broken pipe"));
}

/// Names in the folder that begin with a dot.
std::vector<std::string> hidden_in(const fs::path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string(); name.front() == '.') found.push_back(name);
  return found;
}

void await(const std::function<bool()>& condition) {
  for (int k = 0; k < 6000 && !condition(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(condition());
}

TEST(Signals, ARunOfAFormationEndsAtOnce) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const Workplace here;
    const Running program(here, {"simulate", data_file("formation/hundred.json"), "--no-figures", "--out", "out"});
    await([&] {
      return here.has("err") && here.read("err").find("formation: ") != std::string::npos;
    });  // said just before the run
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(program.status_at_once(signal), 128 + signal);
    // After the grace of ten seconds the last three words are not said.
    EXPECT_THAT(here.read("err"), HasSubstr("interrupted; nothing was written"));
    EXPECT_FALSE(here.has("out"));
    EXPECT_THAT(hidden_in(here.path()), testing::IsEmpty());
  }
}

TEST(Signals, OneWhileFiguresAreDrawnLeavesNoTemporaryFolder) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const Workplace here;
    // One that never ends, and lets no signal but SIGKILL end it.
    fs::create_directory(here.path() / "bin");
    here.write("bin/gnuplot", "#!/bin/sh\ntrap '' INT TERM\n: > '" + (here.path() / "started").string() +
                                  "'\nwhile :; do sleep 1; done\n");
    fs::permissions(here.path() / "bin/gnuplot", fs::perms::owner_all);
    const std::string path = (here.path() / "bin").string() + ":" + std::getenv("PATH");
    ::setenv("PATH", path.c_str(), 1);
    const Running program(here, {"simulate", data_file("paper/A1.json"), "--out", "out"});
    ::setenv("PATH", path.substr(path.find(':') + 1).c_str(), 1);
    await([&] { return here.has("started"); });
    EXPECT_THAT(hidden_in(here.path()), testing::SizeIs(1));
    EXPECT_EQ(program.status_at_once(signal), 128 + signal);
    EXPECT_THAT(here.read("err"), HasSubstr("interrupted"));
    EXPECT_FALSE(here.has("out"));
    EXPECT_THAT(hidden_in(here.path()), testing::IsEmpty());
  }
}

/// What the program says to a terminal that is its stderr. Nothing where the system has no pseudo-terminals, as in a
/// chroot without devpts; errno says why.
std::optional<std::string> said_to_terminal(const Workplace& here, const std::vector<std::string>& words) {
  int terminal = -1;
  const pid_t pid = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (pid < 0) return std::nullopt;
  if (pid == 0) {
    std::vector<std::string> all{EXACTVO_PROGRAM};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& word : all) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (::chdir(here.path().c_str()) == 0) ::execv(EXACTVO_PROGRAM, argv.data());
    ::_exit(127);
  }
  std::string text;
  char block[4096];
  for (ssize_t got = 0; (got = ::read(terminal, block, sizeof block)) > 0;)
    text.append(block, static_cast<std::size_t>(got));
  ::close(terminal);
  ::waitpid(pid, nullptr, 0);
  return text;
}

TEST(Progress, TerminalShowsWhatIsDrawn) {
  const Workplace here;
  fs::create_directory(here.path() / "bin");
  here.write("bin/gnuplot", "#!/bin/sh\nexit 0\n");
  fs::permissions(here.path() / "bin/gnuplot", fs::perms::owner_all);
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", ((here.path() / "bin").string() + ":" + before).c_str(), 1);
  const std::optional<std::string> said =
      said_to_terminal(here, {"simulate", data_file("paper/A1.json"), "--out", "out"});
  const int error = errno;
  ::setenv("PATH", before.c_str(), 1);
  if (!said) GTEST_SKIP() << "this system has no pseudo-terminal: " << std::strerror(error);
  EXPECT_THAT(*said, testing::ContainsRegex("of 120 s simulated: A1"));
  EXPECT_THAT(*said, HasSubstr("drawing figures of A1"));
  EXPECT_TRUE(here.has("out/metrics.json")) << *said;
}

TEST(Pipes, DevicesFoldersAndSocketsAreRefused) {
  const Workplace here;
  fs::create_directory(here.path() / "folder.wkt");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (here.path() / "s.wkt").c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  for (const std::string input : {"/dev/zero", "/dev/full", "folder.wkt", "s.wkt"}) {
    for (const std::string verb : {"validate ", "segment ", "simulate --out out ", "lp ", "audit --certificate "}) {
      const Outcome outcome = here.run(verb + input);
      EXPECT_EQ(outcome.status, 2) << verb << input;
      EXPECT_THAT(outcome.err + outcome.out, HasSubstr("E_FILE_UNREADABLE")) << verb << input;
    }
  }
  ::close(socket);
}

TEST(Pipes, APipeBesideAShapefileIsRefused) {
  const Workplace here;
  here.write("a.shp", std::string("\0\0\x27\x0a no shapes", 14));
  make_pipe(here, "a.dbf");
  const Outcome outcome = here.run("validate a.shp");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("a.dbf"), HasSubstr("E_FILE_UNREADABLE")));
}

TEST(Pipes, APictureThatIsOneIsRefused) {
  const Workplace here;
  here.write("m.yaml", "image: m.png\nresolution: 1\norigin: [0, 0, 0]\n");
  make_pipe(here, "m.png");
  const Outcome outcome = here.run("validate m.yaml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, HasSubstr("m.png"));
}

TEST(Pipes, NoOutputTakesThePlaceOfAPipeOrADevice) {
  const Workplace here;
  here.write("a.wkt", kSquare);
  make_pipe(here, "p.wkt");
  fs::create_symlink("/dev/null", here.path() / "null.wkt");
  for (const std::string arguments :
       {"convert a.wkt p.wkt", "convert a.wkt null.wkt", "repair a.wkt --out p.wkt", "generate star --out p.wkt"}) {
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("E_FILE_UNWRITABLE")) << arguments;
  }
  EXPECT_TRUE(fs::is_fifo(here.path() / "p.wkt"));
  EXPECT_TRUE(fs::is_symlink(here.path() / "null.wkt"));
}

}  // namespace
}  // namespace exactvo::test
