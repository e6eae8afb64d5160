// SPDX-License-Identifier: GPL-3.0-or-later
#include "peer.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "exactvo/formation/planned_routes.h"

extern char** environ;

namespace exactvo::bench {
namespace {

using namespace formation;

constexpr std::chrono::minutes kLongest{10};

struct Output {
  std::string text;
  double processor_seconds = 0.0;
};

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// A child that is waited for, and ended where it takes too long.
class Child {
 public:
  Child(const std::string& program, int input, int output) : program_(program) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    std::string name = program;
    char* arguments[] = {name.data(), nullptr};
    const int error = posix_spawnp(&id_, program.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("the peer " + program + " cannot be run: " + std::strerror(error));
  }
  ~Child() {
    if (id_ == 0) return;
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// s of processor time.
  double wait() {
    int status = 0;
    rusage usage{};
    while (wait4(id_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    id_ = 0;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
      throw std::runtime_error("the peer " + program_ + " failed" +
                               (WIFEXITED(status) ? " with status " + std::to_string(WEXITSTATUS(status)) : ""));
    return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }

 private:
  std::string program_;
  pid_t id_ = 0;
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close_now(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  void close_now() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

std::string read_all(int from, const std::string& program) {
  const auto end = std::chrono::steady_clock::now() + kLongest;
  std::string text;
  char part[1 << 16];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd ready{from, POLLIN, 0};
    const int count = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw std::runtime_error("the peer " + program + " took longer than ten minutes");
    const ssize_t got = read(from, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part, static_cast<std::size_t>(got));
  }
}

Output output_of(const std::string& program, const std::string& input) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(input.data(), 1, input.size(), file.get()) != input.size())
    throw std::runtime_error("cannot write a temporary file");
  std::rewind(file.get());
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  const Descriptor reads(ends[0]);
  Descriptor writes(ends[1]);
  Child child(program, fileno(file.get()), writes.get());
  writes.close_now();
  Output output;
  output.text = read_all(reads.get(), program);
  output.processor_seconds = child.wait();
  return output;
}

void write_point(std::ostream& out, Vec2 p) {
  out << ' ' << p.x << ' ' << p.y;
}

Step row_of(const std::vector<Vec2>& places, double time) {
  Step row;
  row.time = time;
  for (const Vec2 p : places) {
    RobotStep& r = row.robots.emplace_back();
    r.position = r.anchor = p;
  }
  return row;
}

/// Velocities are those between the rows.
void set_velocities(Step& before, Step& row, double time_step) {
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    RobotStep& r = before.robots[i];
    r.chosen = r.preferred = (row.robots[i].position - r.position) / time_step;
    row.robots[i].velocity = r.chosen;
  }
}

Recording pass_rows(const std::string& text, const Scenario& s, const std::string& program, RunSink& rows) {
  Recording run;
  run.time_step = s.time_step;
  run.outcome = "by " + program;
  rows.begin(run);
  std::optional<Step> last;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::vector<Vec2> places;
    for (Vec2 p; words >> p.x >> p.y && std::isfinite(p.x) && std::isfinite(p.y);) places.push_back(p);
    if (places.size() != s.robots.size() || !(words >> std::ws).eof())
      throw std::runtime_error("the peer " + program + ", line " + std::to_string(number) + ": found '" +
                               line.substr(0, 60) + "', expected the x and y of " + std::to_string(s.robots.size()) +
                               " robots");
    Step row = row_of(places, s.time_step * static_cast<double>(number - 1));
    if (last) {
      set_velocities(*last, row, s.time_step);
      rows.add_row(std::move(*last));
    }
    last = std::move(row);
  }
  if (!last) throw std::runtime_error("the peer " + program + " answered nothing");
  rows.add_row(std::move(*last));
  return run;
}

}  // namespace

double margin_of_scene(const Scenario& s) {
  return s.margins.robot == Margins{}.robot ? 0.0 : s.margins.robot;
}

std::string scene_text(const Scenario& s) {
  std::ostringstream out;
  out.precision(17);
  out << "arena 1\ntime_step " << s.time_step << "\ntime_limit " << s.time_limit << "\narrival_tolerance "
      << s.arrival_tolerance << "\nneighbour_distance " << s.neighbour_distance << "\nmargin " << margin_of_scene(s)
      << '\n';
  for (const Robot& r : s.robots) {
    out << "robot " << r.radius << ' ' << r.max_speed;
    write_point(out, r.position);
    out << ' ' << r.goals.size();
    for (const Vec2 goal : r.goals) write_point(out, goal);
    out << '\n';
  }
  for (const PlannedRoute& route : planned_routes(s, {})) {
    if (route.points.empty()) continue;
    out << "way " << route.robot << ' ' << route.goal << ' ' << route.points.size();
    for (const Vec2 p : route.points) write_point(out, p);
    out << '\n';
  }
  for (const SceneObstacle& o : s.obstacles)
    for (const geometry::Segment& edge : geometry::edges_of(o.shape)) {
      out << "wall";
      write_point(out, edge.a);
      write_point(out, edge.b);
      out << '\n';
    }
  out << "end\n";
  return out.str();
}

PeerRun run_peer(const std::string& program, const Scenario& scenario, RunSink& rows) {
  const Output output = output_of(program, scene_text(scenario));
  return {pass_rows(output.text, scenario, program, rows), output.processor_seconds};
}

}  // namespace exactvo::bench
