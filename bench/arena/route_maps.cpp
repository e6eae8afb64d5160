// SPDX-License-Identifier: GPL-3.0-or-later
#include "route_maps.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <variant>

#include "exactvo/datasets/moving_ai.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/routes.h"

namespace exactvo::bench {
namespace {

namespace fs = std::filesystem;
using geometry::Vec2;

/// Cells: how far the ends of points are moved into the free cell whose top left corner they are. The corner itself can
/// lie on an edge, where there is no room.
constexpr double kIntoCell = 0x1p-36;

struct Problem {
  Vec2 start, goal;     ///< cells, y upward
  double length = 0.0;  ///< cells, of the shortest path of a point
};

fs::path lengths_of(const fs::path& map) {
  return map.parent_path() / (map.stem().string() + ".lengths.tsv");
}

std::vector<Problem> read_problems(const fs::path& map) {
  const double height = static_cast<double>(datasets::read_map_size(map).rows);
  std::ifstream in(lengths_of(map));
  std::vector<Problem> problems;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0, octile = 0.0;
    Problem p;
    if (!(words >> x0 >> y0 >> x1 >> y1 >> octile >> p.length))
      throw std::runtime_error(lengths_of(map).string() + ", line " + std::to_string(problems.size() + 1) +
                               ": found '" + line.substr(0, 60) + "', expected x y x y octile length");
    p.start = {x0, height - y0};
    p.goal = {x1, height - y1};
    problems.push_back(p);
  }
  return problems;
}

}  // namespace

std::string RouteProblems::scene() const {
  char text[32];
  std::snprintf(text, sizeof text, radius > 0.0 ? " radius %g" : " points", radius);
  return map.stem().string() + text;
}

std::vector<RouteProblems> route_problems_in(const fs::path& folder, Extent extent) {
  std::vector<fs::path> maps;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".map" && fs::exists(lengths_of(entry.path()))) maps.push_back(entry.path());
  if (maps.empty())
    throw std::runtime_error(folder.string() + ": found no NAME.map with NAME.lengths.tsv beside it, expected one");
  std::sort(maps.begin(), maps.end());
  if (extent == Extent::quick) maps.resize(1);
  std::vector<RouteProblems> all;
  for (const fs::path& map : maps)
    for (const double radius : {0.0, 0.25, 0.5, 1.0}) all.push_back({map, radius});
  return all;
}

RunResult run_routes(const RouteProblems& asked) {
  // Lengths are sums of rounded distances; a point's route passes corners by less than 1e-9 of its length, and its ends
  // lie kIntoCell from the corners of cells that they are published for.
  constexpr double kLengthsDiffer = 1e-9;
  datasets::ReadOptions options;
  options.repair = true;
  std::vector<geometry::Obstacle> shapes;
  for (const formation::SceneObstacle& o : datasets::read_obstacles(asked.map, options).obstacles)
    shapes.push_back(o.shape);
  const datasets::MapSize size = datasets::read_map_size(asked.map);
  const double width = static_cast<double>(size.columns), height = static_cast<double>(size.rows);
  shapes.emplace_back(
      geometry::Polyline{{{0, 0}, {width, 0}, {width, height}, {0, height}, {0, 0}}});  // no robot leaves
  const std::vector<Problem> problems = read_problems(asked.map);
  const bool is_point = asked.radius == 0.0;
  const geometry::RouteMap map(shapes);
  const geometry::RoutePlan plan(map, asked.radius);
  RunResult r{kRoutesSuite, asked.scene(), 1, "route"};
  r.robots = problems.size();
  r.success = true;
  double ours = 0.0, theirs = 0.0;
  const double start = processor_seconds();
  for (const Problem& p : problems) {
    const Vec2 into = is_point ? Vec2{kIntoCell, -kIntoCell} : Vec2{};
    const Vec2 from = p.start + into, to = p.goal + into;
    if (!map.covers(from) || !map.covers(to)) continue;
    const geometry::RouteAnswer answer = plan.query(from, to);
    const auto* route = std::get_if<geometry::Route>(&answer);
    if (route == nullptr) continue;
    ++r.arrived;
    ours += route->length;
    theirs += p.length;
    const bool is_too_short = route->length < (1.0 - kLengthsDiffer) * p.length;
    const bool is_bound_too_long = is_point && route->lower_bound > (1.0 + kLengthsDiffer) * p.length;
    if (is_too_short || is_bound_too_long) r.success = false;
  }
  r.cpu_per_step = 1e6 * (processor_seconds() - start) / static_cast<double>(std::max<std::size_t>(1, problems.size()));
  r.path = theirs > 0.0 ? ours / theirs : 0.0;
  return r;
}

}  // namespace exactvo::bench
