// SPDX-License-Identifier: GPL-3.0-or-later
// Shortest paths of a point on public grid maps, against the lengths that the reference implementation of Polyanya
// printed: start and goal are corners of cells, and many of them lie on corners and edges of blocked ones.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "exactvo/datasets/moving_ai.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/route_certificate.h"
#include "exactvo/geometry/routes.h"
#include "shared_data.h"

namespace exactvo::datasets::test {
namespace {

using geometry::Vec2;

std::filesystem::path routes_folder() {
  return shared_data().parent_path() / "routes";
}

struct Problem {
  Vec2 start, goal;     ///< cells from the left, rows from the top
  double length = 0.0;  ///< cells
};

std::vector<Problem> problems_in(const std::filesystem::path& file) {
  std::vector<Problem> problems;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::array<double, 6> numbers{};
    bool all = true;
    for (double& number : numbers) all = all && (fields >> number);
    if (all) problems.push_back({{numbers[0], numbers[1]}, {numbers[2], numbers[3]}, numbers[5]});
  }
  return problems;
}

TEST(SharedRoutes, PointsWithEndsOnCornersAndEdgesHaveTheShortestRoutes) {
  if (!std::filesystem::exists(routes_folder())) GTEST_SKIP() << "no ../shared/routes beside the checkout";
  constexpr std::size_t kMostOfAMap = 250, kChecked = 25;  // certificates are checked edge by edge
  std::size_t touching = 0, free = 0, checked = 0;
  for (const auto& entry : std::filesystem::directory_iterator(routes_folder())) {
    if (entry.path().extension() != ".map") continue;
    SCOPED_TRACE(entry.path().filename().string());
    std::vector<geometry::Obstacle> obstacles;
    for (const formation::SceneObstacle& o : read_obstacles(entry.path(), {}).obstacles) obstacles.push_back(o.shape);
    const MapSize size = read_map_size(entry.path());
    const double columns = static_cast<double>(size.columns), rows = static_cast<double>(size.rows);
    obstacles.emplace_back(geometry::Polyline{{{0, 0}, {columns, 0}, {columns, rows}, {0, rows}, {0, 0}}});
    const geometry::RouteMap map(obstacles);
    const geometry::RoutePlan point(map, 0.0);
    std::filesystem::path lengths = entry.path();
    const std::vector<Problem> problems = problems_in(lengths.replace_extension(".lengths.tsv"));
    ASSERT_FALSE(problems.empty());
    const std::size_t step = 1 + problems.size() / kMostOfAMap;
    for (std::size_t k = 0; k < problems.size(); k += step) {
      const Problem& p = problems[k];
      const Vec2 start{p.start.x, rows - p.start.y}, goal{p.goal.x, rows - p.goal.y};
      const geometry::RouteAnswer answer = point.query(start, goal);
      const auto* route = std::get_if<geometry::Route>(&answer);
      ASSERT_NE(route, nullptr) << geometry::to_string({start, goal});
      EXPECT_NEAR(route->length, p.length, 1e-9 * p.length) << geometry::to_string({start, goal});
      const bool touches = map.widest_radius(start, start) == 0.0 || map.widest_radius(goal, goal) == 0.0;
      ++(touches ? touching : free);
      if (!touches || touching % kChecked != 0) continue;
      EXPECT_EQ(geometry::check(obstacles, {0.0, start, goal}, answer), "") << geometry::to_string({start, goal});
      ++checked;
    }
  }
  EXPECT_GE(touching, 500u);
  EXPECT_GE(free, 500u);
  EXPECT_GE(checked, 20u);
}

}  // namespace
}  // namespace exactvo::datasets::test
