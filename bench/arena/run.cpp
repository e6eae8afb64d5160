// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <sstream>
#include <stdexcept>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "peer.h"

namespace exactvo::bench {
namespace {

using namespace formation;

SimulationOptions options_of(const std::string& method) {
  SimulationOptions options;
  if (method == "bias") options.liveness = Liveness::bias;
  if (method == "orca") {
    options.method = Method::orca;
    options.liveness = Liveness::off;
  }
  return options;
}

/// The textbook's robots know no margin: where the scene has one they are larger by half of it instead, and measured at
/// their own size.
Scenario with_larger_robots(Scenario s) {
  for (Robot& r : s.robots) r.radius += 0.5 * margin_of_scene(s);
  s.margins.robot = 0.0;
  return s;
}

double straight_way(const Robot& r) {
  double way = 0.0;
  Vec2 at = r.position;
  for (const Vec2 goal : r.goals) {
    way += norm(goal - at);
    at = goal;
  }
  return way;
}

/// As navground has it: slower than 0.02 m/s throughout the last 5 s, and not because it arrived.
bool somebody_stands(const Metrics& m, const Recording& run) {
  constexpr double kLast = 5.0, kStands = 0.02;  // s, m/s
  const double end = run.steps.back().time;
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    bool moved = m.robots[i].arrived;
    for (std::size_t k = run.steps.size() - 1; k > 0 && run.steps[k].time > end - kLast && !moved; --k) {
      const Step &now = run.steps[k], &before = run.steps[k - 1];
      moved = norm(now.robots[i].position - before.robots[i].position) > kStands * (now.time - before.time);
    }
    if (!moved) return true;
  }
  return false;
}

}  // namespace

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<std::string> own_methods() {
  return {"plan", "bias", "orca"};
}

RunResult run_scene(const Scene& scene, const ArenaMethod& method) {
  constexpr double kOfTheBound = 20.0, kMore = 100.0;  // s
  Scenario s = scene.make();
  RunResult r{scene.suite, scene.name, scene.seed, method.name};
  double straight = 0.0;
  for (const Robot& robot : s.robots) {
    r.bound = std::max(r.bound, straight_way(robot) / robot.max_speed);
    straight += straight_way(robot);
  }
  if (scene.success == Success::all_arrive) s.time_limit = kOfTheBound * r.bound + kMore;
  double seconds = 0.0;
  Recording run;
  if (method.program.empty()) {
    const double start = processor_seconds();
    run = simulate(method.name == "orca" ? with_larger_robots(s) : s, options_of(method.name));
    seconds = processor_seconds() - start;
  } else {
    PeerRun peer = run_peer(method.program, s);
    run = std::move(peer.run);
    seconds = peer.processor_seconds;
  }
  const Metrics m = measure(s, run);
  r.robots = s.robots.size();
  double driven = 0.0;
  for (const RobotMetrics& robot : m.robots) {
    r.arrived += robot.arrived ? 1 : 0;
    driven += robot.path_length;
  }
  r.collisions = m.collisions.size();
  r.relaxed = m.relaxed_steps;
  r.makespan = m.all_arrived ? m.last_arrival_time.value_or(0.0) : run.steps.back().time;
  r.path = driven / straight;
  const double robot_steps = static_cast<double>(r.robots) * static_cast<double>(std::max<std::size_t>(1, m.steps));
  r.cpu_per_step = 1e6 * seconds / robot_steps;
  r.plans = m.plans ? m.plans->groups : 0;
  const bool is_live = scene.success == Success::all_arrive ? m.all_arrived : !somebody_stands(m, run);
  r.success = is_live && m.collisions.empty();
  return r;
}

std::string csv_header() {
  return "suite,scene,seed,method,robots,arrived,success,collisions,relaxed,makespan_s,bound_s,path_over_straight,"
         "us_per_robot_step,plans\n";
}

std::string csv_line(const RunResult& r) {
  char text[512];
  std::snprintf(text, sizeof text, "%s,%s,%llu,%s,%zu,%zu,%d,%zu,%zu,%.3f,%.3f,%.4f,%.3f,%zu\n", r.suite.c_str(),
                r.scene.c_str(), static_cast<unsigned long long>(r.seed), r.method.c_str(), r.robots, r.arrived,
                r.success ? 1 : 0, r.collisions, r.relaxed, r.makespan, r.bound, r.path, r.cpu_per_step, r.plans);
  return text;
}

RunResult parsed(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  const auto refuse = [&] {
    return std::runtime_error("found the line '" + line + "', expected one of results of the arena");
  };
  constexpr std::size_t kColumns = 14;
  if (cells.size() != kColumns) throw refuse();
  try {
    RunResult r{cells[0], cells[1], std::stoull(cells[2]), cells[3]};
    r.robots = std::stoull(cells[4]);
    r.arrived = std::stoull(cells[5]);
    r.success = cells[6] == "1";
    r.collisions = std::stoull(cells[7]);
    r.relaxed = std::stoull(cells[8]);
    r.makespan = std::stod(cells[9]);
    r.bound = std::stod(cells[10]);
    r.path = std::stod(cells[11]);
    r.cpu_per_step = std::stod(cells[12]);
    r.plans = std::stoull(cells[13]);
    return r;
  } catch (const std::logic_error&) {
    throw refuse();
  }
}

}  // namespace exactvo::bench
