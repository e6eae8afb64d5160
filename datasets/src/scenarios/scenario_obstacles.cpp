// SPDX-License-Identifier: GPL-3.0-or-later
// The obstacles of a scenario (scenario_file.h), those of the files that it names included.
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/counted.h"
#include "readers/readers.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

RawGeometry to_raw(const formation::SceneObstacle& obstacle) {
  const std::string place = "obstacle " + obstacle.id;
  if (const auto* line = std::get_if<geometry::Polyline>(&obstacle.shape))
    return {RawKind::polyline, obstacle.id, place, {line->points}};
  return {RawKind::polygon, obstacle.id, place, closed_rings_of(std::get<geometry::Polygon>(obstacle.shape))};
}

/// A scenario may name another as an obstacle file; one that names itself, or one that names it, has no end.
constexpr int kDeepestScenario = 8;

class Level {
 public:
  explicit Level(const std::filesystem::path& path) {
    if (depth_ == kDeepestScenario)
      throw DataError(DataCode::nesting, path.string(), "", "a scenario below 8 that name one another",
                      "obstacle files that end after 8 scenarios");
    ++depth_;
  }
  ~Level() { --depth_; }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

 private:
  static thread_local int depth_;
};
thread_local int Level::depth_ = 0;

}  // namespace

bool looks_like_scenario(const FormatProbe& probe) {
  const std::size_t first = probe.beginning.find_first_not_of(" \t\r\n");
  return first != std::string::npos && probe.beginning[first] == '{' &&
         probe.beginning.find("\"robots\"") != std::string::npos &&
         probe.beginning.find("\"FeatureCollection\"") == std::string::npos;
}

void read_scenario_obstacles(const std::filesystem::path& path, Collector& out) {
  const Level level(path);
  const LoadedScenario loaded = load_scenario_with_notes(path);
  for (const formation::SceneObstacle& obstacle : loaded.scenario.obstacles) out.add(to_raw(obstacle));
  for (const std::string& note : loaded.notes) out.note("", note);
  const std::size_t moving = loaded.scenario.moving_obstacles.size();
  if (moving > 0) out.note("", geometry::counted(moving, "moving obstacle") + " left out, for lack of a fixed place");
}

}  // namespace exactvo::datasets
