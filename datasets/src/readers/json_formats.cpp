// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "obstacles/courses.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

// --- One polygon as nested lists, [shell, hole, ...], each a list of [x, y]; often unclosed, either winding ---

geometry::Ring to_ring(const JsonCursor& at) {
  geometry::Ring ring;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const JsonCursor point = at.at(i);
    if (point.size() < 2) point.refuse("[x, y]", DataCode::wrong_count);
    ring.push_back({point.at(std::size_t{0}).number(), point.at(1).number()});
  }
  return ring;
}

// --- The obstacles of a scenario (scenario_file.h), those of the files that it names included ---

RawGeometry to_raw(const formation::SceneObstacle& obstacle) {
  const RawKind kind = geometry::has_interior(obstacle.shape) ? RawKind::polygon : RawKind::polyline;
  RawGeometry raw{kind, obstacle.id, "obstacle " + obstacle.id, courses_of(obstacle.shape)};
  raw.disc = obstacle.disc;
  return raw;
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

bool looks_like_rings_json(const FormatProbe& probe) {
  std::size_t brackets = 0;
  for (const char c : probe.beginning) {
    if (c == '[') ++brackets;
    if (c != '[' && std::isspace(static_cast<unsigned char>(c)) == 0) break;
  }
  return brackets == 3;
}

void read_rings_json(const std::filesystem::path& path, Collector& out) {
  const Json tree = parse_json(read_text_file(path), out.file());
  const JsonCursor rings(tree, out.file(), "");
  RawGeometry raw{RawKind::polygon, "0", "polygon", {}};
  for (std::size_t k = 0; k < rings.size(); ++k) raw.rings.push_back(to_ring(rings.at(k)));
  if (raw.rings.empty()) return out.pass_over(raw.place, "an empty polygon skipped");
  out.add(raw);
}

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
  const auto discs = std::count_if(loaded.scenario.obstacles.begin(), loaded.scenario.obstacles.end(),
                                   [](const formation::SceneObstacle& o) { return o.disc.has_value(); });
  if (discs > 0)
    out.note("", geometry::counted(static_cast<std::size_t>(discs), "disc") +
                     ", for check and monitor exact, for other verbs polygons of 32 corners");
  const std::size_t moving = loaded.scenario.moving_obstacles.size();
  if (moving > 0) out.note("", geometry::counted(moving, "moving obstacle") + " left out, for lack of a fixed place");
}

}  // namespace exactvo::datasets
