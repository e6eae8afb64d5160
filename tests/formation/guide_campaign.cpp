// SPDX-License-Identifier: GPL-3.0-or-later
// Every goal reached, or proven out of reach: robots with default options among generated obstacles, or on maps from
// files, run by hand.     guide_campaign maze 1000 1       guide_campaign files 1 1 --robots 8 MAP...
//
// For a robot that did not arrive a plan made for it alone decides again, and its certificate is checked in
// rationals by code that the planner does not share. The recording of every run is audited.
#include <chrono>
#include <cstdio>
#include <string>
#include <variant>
#include <vector>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/generators.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/planned_routes.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/route_certificate.h"
#include "options/program_options.h"
#include "support/seeded_random.h"

namespace {

using namespace exactvo;
using namespace exactvo::formation;
using geometry::Vec2;

struct Flags {
  std::string kind;
  std::uint64_t count = 1;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::size_t robots = 1;
  std::uint64_t radius_mm = 0;
  bool no_audit = false;
  std::vector<std::string> files;
};

struct Counts {
  std::size_t worlds = 0, empty = 0, robots = 0, arrived = 0, proven = 0, open = 0, failed = 0, touched = 0,
              unaudited = 0;

  bool is_clean() const { return failed + touched + unaudited == 0; }
};

/// The box of the obstacles.
geometry::Box box_of(const Scenario& s) {
  geometry::Box box;
  for (const SceneObstacle& o : s.obstacles)
    for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
  return box;
}

bool is_free(const Scenario& s, Vec2 place, double radius) {
  for (const SceneObstacle& o : s.obstacles)
    if (geometry::signed_distance(o.shape, place) < radius) return false;
  return true;
}

/// Three goals of four are free by themselves: else most of a building's lie in its walls. None where no start is
/// found that is clear.
bool add_robot(Scenario& s, test::SeededRandom& random, double radius) {
  constexpr int kTries = 200;
  const geometry::Box box = box_of(s);
  const auto place = [&] { return Vec2{random.uniform(box.low.x, box.high.x), random.uniform(box.low.y, box.high.y)}; };
  const auto is_apart = [&](Vec2 p, bool of_goals) {
    for (const Robot& other : s.robots) {
      const Vec2 q = of_goals ? other.goals.front() : other.position;
      if (norm(p - q) < 1.25 * (radius + other.radius)) return false;
    }
    return true;
  };
  Robot robot;
  robot.id = "R" + std::to_string(s.robots.size() + 1);
  robot.radius = radius;
  const bool any_goal = random.integer(0, 3) == 0;
  for (int k = 0; k < kTries; ++k) {
    robot.position = place();
    if (!is_free(s, robot.position, radius) || !is_apart(robot.position, false)) continue;
    for (int g = 0; g < kTries; ++g) {
      const Vec2 goal = place();
      if (!is_apart(goal, true) || (!any_goal && !is_free(s, goal, radius))) continue;
      robot.goals = {goal};
      s.robots.push_back(robot);
      return true;
    }
  }
  return false;
}

/// Enough for three times the longest route.
double time_limit_of(const Scenario& s) {
  double longest = 0.0;
  for (const PlannedRoute& route : planned_routes(s, {})) {
    double length = 0.0;
    for (std::size_t k = 1; k < route.points.size(); ++k) length += norm(route.points[k] - route.points[k - 1]);
    longest = std::max(longest, length / s.robots[route.robot].max_speed);
  }
  return 3.0 * longest + 120.0;
}

/// Whether a plan of its own proves that the robot cannot come to its goal, nor within the tolerance of it.
class Verdicts {
 public:
  explicit Verdicts(const Scenario& s) : scenario_(s) {
    for (const SceneObstacle& o : s.obstacles) shapes_.push_back(o.shape);
  }

  enum class Verdict { reachable, proven, refused };
  Verdict operator()(std::size_t robot) {
    if (!map_) map_.emplace(shapes_);
    const Robot& r = scenario_.robots[robot];
    const geometry::RoutePlan plan(*map_, r.radius);
    const geometry::RouteAnswer answer = plan.query(r.position, r.goals.front());
    if (std::holds_alternative<geometry::Route>(answer)) return Verdict::reachable;
    const std::string wrong = geometry::check(shapes_, {r.radius, r.position, r.goals.front()}, answer);
    if (wrong.empty()) return Verdict::proven;
    std::printf("  certificate refused: %s\n", wrong.c_str());
    return Verdict::refused;
  }

 private:
  const Scenario& scenario_;
  std::vector<geometry::Obstacle> shapes_;
  std::optional<geometry::RouteMap> map_;
};

/// What the outcome says of one robot.
std::string said_of(const std::string& outcome, const std::string& id) {
  const std::size_t at = outcome.find("; " + id + " ");
  if (at == std::string::npos) return "";
  return outcome.substr(at + 2, outcome.find("; ", at + 2) - at - 2);
}

void count_robots(const Scenario& s, const Metrics& m, Counts& counts) {
  Verdicts verdict(s);
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    ++counts.robots;
    if (m.robots[i].arrived) {
      ++counts.arrived;
      continue;
    }
    const std::string said = said_of(m.outcome, s.robots[i].id);
    const bool says_so = said.find("cannot reach") != std::string::npos;
    const Verdicts::Verdict is = verdict(i);
    if (says_so && is == Verdicts::Verdict::proven) {
      ++counts.proven;
      continue;
    }
    const bool too_tight = said.find("too little to drive") != std::string::npos;
    ++(says_so && too_tight ? counts.open : counts.failed);
    std::printf("  %s %s of radius %.17g from (%.17g, %.17g) to (%.17g, %.17g): %s\n", too_tight ? "open" : "FAILED",
                s.robots[i].id.c_str(), s.robots[i].radius, s.robots[i].position.x, s.robots[i].position.y,
                s.robots[i].goals[0].x, s.robots[i].goals[0].y, said.empty() ? m.outcome.c_str() : said.c_str());
  }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void run_world(Scenario s, const Flags& flags, std::uint64_t seed, Counts& counts) {
  test::SeededRandom random(seed);
  ++counts.worlds;
  if (s.obstacles.empty()) {
    ++counts.empty;
    std::printf("%s: no obstacles\n", s.name.c_str());
    return;
  }
  for (std::size_t k = 0; k < flags.robots; ++k) {
    const double radius = flags.radius_mm > 0 ? 1e-3 * static_cast<double>(flags.radius_mm) : random.uniform(0.15, 0.3);
    if (!add_robot(s, random, radius)) break;
  }
  if (s.robots.empty()) {
    ++counts.empty;
    std::printf("%s: no room for a robot\n", s.name.c_str());
    return;
  }
  s.time_limit = time_limit_of(s);
  const auto start = std::chrono::steady_clock::now();
  const SimulationOptions options;
  Recording recording = simulate(s, options);
  const Metrics m = measure(s, recording);
  const double simulated = seconds_since(start);
  const Counts before = counts;
  count_robots(s, m, counts);
  counts.touched += !is_safe(m);
  std::string audited = "not audited";
  if (!flags.no_audit) {
    datasets::RunInfo info{s.name,
                           name(options.method),
                           std::nullopt,
                           std::nullopt,
                           {},
                           name(guidance_of(s, options)),
                           name(liveness_of(s, options))};
    const datasets::AuditReport report = datasets::audit({std::move(info), s, std::move(recording)});
    counts.unaudited += !report.clean();
    audited = report.clean() ? "audit clean" : "AUDIT FAILED";
    if (!report.clean())
      for (const std::string& finding : report.findings) std::printf("  %s\n", finding.c_str());
  }
  std::printf(
      "%s, seed %llu: %zu robots, %zu arrived, %zu proven out of reach, %zu open, %zu failed; %s; %s; %zu rows, "
      "%.2f s, with audit %.2f s\n",
      s.name.c_str(), static_cast<unsigned long long>(seed), s.robots.size(), counts.arrived - before.arrived,
      counts.proven - before.proven, counts.open - before.open, counts.failed - before.failed,
      is_safe(m) ? "nothing touched" : "TOUCHED", audited.c_str(), m.steps, simulated, seconds_since(start));
  std::fflush(stdout);
}

int run(const Flags& flags) {
  Counts counts;
  if (flags.kind == "files") {
    for (const std::string& file : flags.files)
      for (std::uint64_t k = 0; k < flags.count; ++k) {
        Scenario s;
        s.name = file.substr(file.rfind('/') + 1);
        datasets::ReadOptions read;
        read.repair = true;
        read.keep_going = true;
        s.obstacles = datasets::read_obstacles(file, read).obstacles;
        run_world(std::move(s), flags, flags.seed + k, counts);
      }
  } else {
    for (std::uint64_t k = flags.first; k < flags.first + flags.count; ++k) {
      Scenario s;
      s.name = flags.kind + "-" + std::to_string(k);
      s.obstacles = datasets::generated_item(flags.kind, k, flags.seed);
      run_world(std::move(s), flags, flags.seed * 1000003 + k, counts);
    }
  }
  std::printf(
      "%zu worlds, %zu without room or obstacles, %zu robots: %zu arrived, %zu proven out of reach, %zu open, %zu "
      "failed; "
      "touched %zu, audits not clean %zu\n",
      counts.worlds, counts.empty, counts.robots, counts.arrived, counts.proven, counts.open, counts.failed,
      counts.touched, counts.unaudited);
  return counts.is_clean() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::run_program("formation_guide_campaign", [&] {
    Flags flags;
    std::vector<std::string> kinds = datasets::generator_kind_names();
    kinds.push_back("files");
    tools::ProgramOptions options(
        "formation_guide_campaign", "Simulates robots to random goals: is each reached, or proven out of reach?",
        "A line per world, before it one per robot that did neither. Exit status 1: there was one, a robot touched "
        "something, or an audit was not clean.");
    options.word("KIND", flags.kind, kinds, "Of generated obstacles, or files", true);
    options.whole_number("COUNT", flags.count, 1, "Worlds, or of each file: draws of robots");
    options.whole_number("SEED", flags.seed, 0, "Of worlds and robots");
    options.texts("FILE", flags.files, "Obstacle files; what cannot be used is repaired or left out");
    options.whole_number("--first", flags.first, 0, "Number of the first world");
    options.whole_number("--robots", flags.robots, 1, "In each world");
    options.whole_number("--radius-mm", flags.radius_mm, 0, "Of robots, mm; 0: drawn from 150 to 300");
    options.flag("--no-audit", flags.no_audit, "Leave the audits out");
    return options.parse(argc, argv) ? run(flags) : 0;
  });
}
