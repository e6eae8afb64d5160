// SPDX-License-Identifier: GPL-3.0-or-later
// Steps one crowd for a long time while robots, walls and bodies come and go: `formation_crowd_soak [SECONDS] [ROBOTS]
// [SEED]`. Sampled steps are checked for overlaps in whole numbers, some in rationals; snapshots go on with the same
// bits; memory stays flat. Prints what was looked at; exit status 1 where anything failed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <vector>

#include "crowd/crowd_audit.h"
#include "crowd/overlaps.h"
#include "options/program_options.h"
#include "support/seeded_random.h"

#if defined(__linux__)
#include <unistd.h>
#endif

namespace exactvo::formation {
namespace {

using geometry::Segment;
using test::SeededRandom;
using Clock = std::chrono::steady_clock;

constexpr double kCovered = 0.2;       ///< of the floor, by robots
constexpr double kGap = 0.05;          ///< m: what is new keeps this distance from robots
constexpr int kSampleEvery = 20;       ///< steps
constexpr int kAudits = 4;             ///< in rationals, spread over the time
constexpr double kGrowth = 1.1;        ///< memory at the end over memory after a tenth of the time, at most
constexpr double kGrowthBytes = 16e6;  ///< less is noise

/// Bytes in memory; 0 where the system does not say.
double memory_now() {
#if defined(__linux__)
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    long size = 0, resident = 0;
    const int read = std::fscanf(file, "%ld %ld", &size, &resident);
    std::fclose(file);
    if (read == 2) return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
  }
#endif
  return 0.0;
}

/// A crowd whose robots head for random places, and what has been added to it.
class World {
 public:
  World(std::size_t robots, std::uint64_t seed)
      : random_(seed), half_(0.5 * std::sqrt(3.15 * 0.25 * static_cast<double>(robots) / kCovered)), wanted_(robots) {
    for (const double share : {1.0, 0.6}) {
      CrowdKind kind;
      kind.radius = 0.5 * share;
      kind.max_speed = 1.5 / share;
      crowd.add_kind(kind);
    }
    while (robots_.size() < wanted_)
      if (!add_robot()) break;
  }

  Crowd crowd;
  std::size_t added = 0, removed = 0, obstacles_added = 0, obstacles_removed = 0;

  /// Robots come and go, at most one in 500 a step; every few steps a wall or a body does.
  void change() {
    crowd.positions(at_);
    for (std::size_t k = 0, most = 1 + wanted_ / 500; k < most; ++k) {
      const bool few = robots_.size()<wanted_ * 9 / 10, many = robots_.size()> wanted_;
      if (!few && (many || random_.integer(0, 1) == 0))
        remove_robot();
      else
        add_robot();
    }
    if (random_.integer(0, 9) == 0) change_obstacles();
  }

  /// Every free number gets a robot, as the audit wants it. False where there is no room.
  bool fill() {
    crowd.positions(at_);
    for (int tries = 0; crowd.size() < crowd.id_end(); ++tries)
      if (!add_robot() && tries > 100) return false;
    return true;
  }

  void steer() {
    crowd.positions(at_);
    preferred_.assign(crowd.id_end(), Vec2{});
    for (const RobotId id : robots_) {
      Vec2 way = goal_[id] - at_[id];
      if (norm(way) < 1.0) way = (goal_[id] = random_.in_box(half_)) - at_[id];
      preferred_[id] = crowd.kind(crowd.kind_of(id)).max_speed / std::max(1.0, norm(way)) * way;
    }
    crowd.set_preferred(preferred_);
  }

  std::vector<RobotId> robots() const { return robots_; }
  std::vector<double> radii() const {
    std::vector<double> radii;
    for (const RobotId id : robots_) radii.push_back(crowd.kind(crowd.kind_of(id)).radius);
    return radii;
  }
  std::vector<geometry::Obstacle> walls() const {
    std::vector<geometry::Obstacle> walls;
    for (const Wall& wall : walls_) walls.push_back(geometry::Polyline{{wall.edge.a, wall.edge.b}});
    return walls;
  }
  std::vector<AuditedBody> bodies() const { return bodies_; }

 private:
  struct Wall {
    ObstacleId id;
    Segment edge;
  };

  bool is_free(Vec2 at, double radius) {
    for (const RobotId id : robots_)
      if (norm(at_[id] - at) < crowd.kind(crowd.kind_of(id)).radius + radius + kGap) return false;
    for (const Wall& wall : walls_)
      if (distance(at, wall.edge) < radius + kGap) return false;
    for (const AuditedBody& body : bodies_)
      if (norm(std::get<geometry::Disc>(body.shape).center + crowd.body_displacement(body.id) - at) <
          std::get<geometry::Disc>(body.shape).radius + radius + kGap)
        return false;
    return true;
  }

  static double distance(Vec2 p, const Segment& s) {
    const Vec2 along = s.b - s.a;
    const double share = std::clamp(dot(p - s.a, along) / squared_norm(along), 0.0, 1.0);
    return norm(p - s.a - share * along);
  }

  bool add_robot() {
    for (int tries = 0; tries < 100; ++tries) {
      const Vec2 at = random_.in_box(half_);
      const auto kind = static_cast<KindId>(random_.integer(0, 1));
      if (!is_free(at, crowd.kind(kind).radius)) continue;
      const RobotId id = crowd.add_robot(at, kind);
      robots_.push_back(id);
      if (id >= goal_.size()) goal_.resize(id + 1);
      if (id >= at_.size()) at_.resize(id + 1);
      goal_[id] = random_.in_box(half_);
      at_[id] = at;
      ++added;
      return true;
    }
    return false;
  }

  void remove_robot() {
    const auto k = static_cast<std::size_t>(random_.integer(0, static_cast<int>(robots_.size()) - 1));
    crowd.remove_robot(robots_[k]);
    robots_[k] = robots_.back();
    robots_.pop_back();
    ++removed;
  }

  void change_obstacles() {
    if (walls_.size() + bodies_.size() > 40 || (!walls_.empty() && random_.integer(0, 2) == 0)) {
      if (!walls_.empty()) {
        crowd.remove_obstacle(walls_.front().id);
        walls_.erase(walls_.begin());
      }
      if (!bodies_.empty() && random_.integer(0, 1) == 0) {
        crowd.remove_obstacle(bodies_.front().id);
        bodies_.erase(bodies_.begin());
        ++obstacles_removed;
      }
      ++obstacles_removed;
      return;
    }
    const Vec2 at = random_.in_box(half_);
    if (random_.integer(0, 1) == 0) {
      const Segment edge{at, at + random_.uniform(0.5, 4.0) * random_.direction()};
      for (const RobotId id : robots_)
        if (distance(at_[id], edge) < crowd.kind(crowd.kind_of(id)).radius + kGap) return;
      walls_.push_back({crowd.add_obstacle(geometry::Polyline{{edge.a, edge.b}}), edge});
    } else {
      const geometry::Disc disc{at, random_.uniform(0.2, 1.0)};
      if (!is_free(disc.center, disc.radius)) return;
      const bool moves = random_.integer(0, 1) == 0;
      const ObstacleId id =
          moves ? crowd.add_moving_body(disc, random_.uniform(0.1, 1.0) * random_.direction()) : crowd.add_body(disc);
      bodies_.push_back({id, disc, moves});
    }
    ++obstacles_added;
  }

  SeededRandom random_;
  double half_;
  std::size_t wanted_;
  std::vector<RobotId> robots_;
  std::vector<Vec2> goal_, at_, preferred_;
  std::vector<Wall> walls_;
  std::vector<AuditedBody> bodies_;
};

/// Whether a crowd that is restored from a snapshot makes the next steps as this one does.
bool goes_on_alike(Crowd& crowd) {
  std::stringstream bytes;
  crowd.snapshot(bytes);
  Crowd other = Crowd::restored(bytes);
  for (int k = 0; k < 3; ++k) {
    crowd.step();
    other.step();
    if (crowd.digest() != other.digest()) return false;
  }
  return true;
}

int run(double minutes, std::size_t robots, std::uint64_t seed) {
  World world(robots, seed);
  MotionOverlaps overlaps;
  CrowdAudit audit;
  std::size_t steps = 0, samples = 0, snapshots = 0, differing = 0;
  int audits = 0, tenths = 0;
  double early = 0.0;
  const auto start = Clock::now();
  const auto share = [&] { return std::chrono::duration<double>(Clock::now() - start).count() / (60.0 * minutes); };
  for (double now = 0.0; now < 1.0; now = share()) {
    world.change();
    world.steer();
    if (now * kAudits >= audits && world.fill()) {
      world.steer();
      CrowdAuditor auditor(world.crowd, world.walls());
      auditor.set_bodies(world.bodies());
      auditor.step(audit);
      differing += goes_on_alike(world.crowd) ? 0 : 1;
      ++snapshots;
      ++audits;
      steps += 4;
      continue;
    }
    const bool sampled = steps % kSampleEvery == 0;
    const std::vector<RobotId> ids = world.robots();
    const auto from = sampled ? lattice_places(world.crowd, ids) : std::vector<LatticePlace>{};
    world.crowd.step();
    ++steps;
    if (sampled) {
      overlaps.look(from, lattice_places(world.crowd, ids), world.radii(), world.crowd.options().position_step, steps);
      ++samples;
    }
    if (now * 10 >= tenths) {
      if (tenths == 1) early = memory_now();
      std::fprintf(stderr, "%d %%: %zu steps, %zu robots, %.0f MB, %zu overlaps\n", 10 * tenths, steps,
                   world.crowd.size(), memory_now() / 1e6, overlaps.overlaps);
      ++tenths;
    }
  }
  const double late = memory_now();
  const bool flat = early == 0.0 || late < kGrowth * early || late - early < kGrowthBytes;
  std::printf(
      "steps %zu\nrobots_added %zu\nrobots_removed %zu\nobstacles_added %zu\nobstacles_removed %zu\nsampled_steps %zu\n"
      "pair_motions %zu\noverlaps %zu\naudited_pairs %zu\naudit_failures %zu\nsnapshots %zu\ndiffering %zu\n"
      "memory_early_mb %.0f\nmemory_late_mb %.0f\n",
      steps, world.added, world.removed, world.obstacles_added, world.obstacles_removed, samples, overlaps.motions,
      overlaps.overlaps, audit.pairs, audit.failures(), snapshots, differing, early / 1e6, late / 1e6);
  if (overlaps.overlaps > 0) std::printf("first overlap: %s\n", overlaps.first.c_str());
  if (audit.failures() > 0) std::printf("first failure: %s\n", audit.first.c_str());
  if (!flat) std::printf("memory grew\n");
  return overlaps.overlaps + audit.failures() + differing == 0 && flat && overlaps.motions > 0 && audit.pairs > 0 ? 0
                                                                                                                  : 1;
}

}  // namespace
}  // namespace exactvo::formation

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("formation_crowd_soak", [&] {
    std::uint64_t seconds = 3600, robots = 10000, seed = 1;
    tools::ProgramOptions options("formation_crowd_soak",
                                  "Steps one crowd for a long time while robots, walls and bodies come and go.");
    options.whole_number("SECONDS", seconds, 1, "How long");
    options.whole_number("ROBOTS", robots, 10, "At most this many at a time");
    options.whole_number("SEED", seed, 0, "Of the random numbers");
    if (!options.parse(argc, argv)) return 0;
    return formation::run(static_cast<double>(seconds) / 60.0, robots, seed);
  });
}
