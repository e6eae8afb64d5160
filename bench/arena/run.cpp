// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>

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

/// Thrown to end a run in which no robot comes nearer to a goal any more.
struct NoProgress {};

/// Measures a run while it is made. `scenario` must outlive it.
class Measuring : public RunSink {
 public:
  /// `patience`: s; where robots have come no nearer to their last goals for so long, in sum by a radius, NoProgress
  /// is thrown.
  Measuring(const Scenario& scenario, std::optional<double> patience)
      : scenario_(scenario),
        patience_(patience),
        places_(scenario.robots.size()),
        moved_at_(scenario.robots.size(), 0.0) {}

  void begin(const Recording& run) override {
    known_.motion = run.motion;
    known_.time_step = run.time_step;
    evaluator_.emplace(scenario_, run);
  }
  void add_body(const vo::Body&) override {}
  void add_goal_bodies(const GoalBodies&) override {}
  void add_row(Step row) override {
    const double start = processor_seconds();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Vec2 here = row.robots[i].position;
      if (norm(here - places_[i]) > kStands * (row.time - end_)) moved_at_[i] = row.time;
      places_[i] = here;
    }
    end_ = row.time;
    evaluator_->add(std::make_shared<const Step>(std::move(row)));
    seconds_ += processor_seconds() - start;
    if (patience_ && !comes_nearer()) throw NoProgress{};
  }

  Metrics finish(const Recording& run) { return evaluator_->finish(run).metrics; }
  /// The recording so far of a run that was ended.
  const Recording& known() const { return known_; }
  double end() const { return end_; }          ///< s, of the last row
  double seconds() const { return seconds_; }  ///< of processor time that measuring took

  /// As navground has it: slower than 0.02 m/s throughout the last 5 s, and not because it arrived.
  bool somebody_stands(const Metrics& m) const {
    constexpr double kLast = 5.0;  // s
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (!m.robots[i].arrived && !(moved_at_[i] > end_ - kLast)) return true;
    return false;
  }

 private:
  static constexpr double kStands = 0.02;  // m/s

  bool comes_nearer() {
    double left = 0.0;
    for (std::size_t i = 0; i < places_.size(); ++i) left += norm(scenario_.robots[i].goals.back() - places_[i]);
    if (left < least_left_ - scenario_.robots.front().radius) {
      least_left_ = left;
      nearer_at_ = end_;
    }
    return end_ - nearer_at_ < *patience_;
  }

  const Scenario& scenario_;
  std::optional<double> patience_;
  Recording known_;
  std::optional<Evaluator> evaluator_;
  std::vector<Vec2> places_;
  std::vector<double> moved_at_;  ///< s, of each robot: the last row to which it moved
  double end_ = 0.0, seconds_ = 0.0;
  double least_left_ = std::numeric_limits<double>::infinity();  ///< m, of all robots to their last goals
  double nearer_at_ = 0.0;                                       ///< s, when it became less
};

}  // namespace

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<std::string> own_methods() {
  return {"plan", "bias", "orca"};
}

std::optional<RunResult> run_scene(const Scene& scene, const ArenaMethod& method, const std::atomic<bool>& stop) {
  constexpr double kOfTheBound = 20.0, kMore = 100.0;      // s
  constexpr double kPatience = 4.0, kMorePatience = 60.0;  // of the bound; s
  Scenario s = scene.make();
  RunResult r{scene.suite, scene.name, scene.seed, method.name};
  double straight = 0.0;
  for (const Robot& robot : s.robots) {
    r.bound = std::max(r.bound, straight_way(robot) / robot.max_speed);
    straight += straight_way(robot);
  }
  std::optional<double> patience;
  if (scene.success == Success::all_arrive) {
    s.time_limit = kOfTheBound * r.bound + kMore;
    if (method.program.empty()) patience = kPatience * r.bound + kMorePatience;
  }
  double seconds = 0.0;
  Recording run;  // without rows
  Measuring measuring(s, patience);
  if (method.program.empty()) {
    SimulationOptions options = options_of(method.name);
    options.progress = [&](double) { return !stop; };
    const double start = processor_seconds();
    try {
      run = simulate(method.name == "orca" ? with_larger_robots(s) : s, options, measuring);
    } catch (const NoProgress&) {
      run = measuring.known();
    }
    seconds = processor_seconds() - start - measuring.seconds();
  } else {
    PeerRun peer = run_peer(method.program, s, measuring);
    run = std::move(peer.run);
    seconds = peer.processor_seconds;
  }
  if (stop) return std::nullopt;
  const Metrics m = measuring.finish(run);
  r.robots = s.robots.size();
  double driven = 0.0;
  for (const RobotMetrics& robot : m.robots) {
    r.arrived += robot.arrived ? 1 : 0;
    driven += robot.path_length;
  }
  r.collisions = m.collisions.size();
  r.relaxed = m.relaxed_steps;
  r.makespan = m.all_arrived ? m.last_arrival_time.value_or(0.0) : measuring.end();
  r.path = driven / straight;
  const double robot_steps = static_cast<double>(r.robots) * static_cast<double>(std::max<std::size_t>(1, m.steps));
  r.cpu_per_step = 1e6 * seconds / robot_steps;
  r.plans = m.plans ? m.plans->groups : 0;
  const bool is_live = scene.success == Success::all_arrive ? m.all_arrived : !measuring.somebody_stands(m);
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
