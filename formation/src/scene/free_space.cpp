// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/free_space.h"

#include <algorithm>
#include <utility>

#include "exactvo/geometry/distance.h"

namespace exactvo::formation::detail {

using geometry::Segment;

ObstacleSpace::ObstacleSpace(const std::vector<SceneObstacle>& obstacles) {
  std::vector<geometry::Box> boxes;
  for (const SceneObstacle& o : obstacles) {
    edges_.push_back(geometry::edges_of(o.shape));
    obstacles_.emplace_back(o.shape);
    boxes.push_back(obstacles_.back().box());
  }
  by_place_ = geometry::BoxGrid(std::move(boxes));
}

double ObstacleSpace::clearance(Vec2 place, double enough) const {
  double least = enough;
  by_place_.for_each_within(place, enough, [&](std::size_t o) {
    least = std::min(least, obstacles_[o].swept_distance({place, place}, enough));
  });
  return least;
}

bool ObstacleSpace::is_clear(Vec2 from, Vec2 to, double least) const {
  const Segment way{from, to};
  bool clear = true;
  by_place_.for_each_meeting(geometry::box_of(way).grown(least), [&](std::size_t o) {
    clear = clear && obstacles_[o].swept_distance(way, least) >= least;
  });
  return clear;
}

Vec2 ObstacleSpace::from_nearest_edge(Vec2 place, double reach) const {
  double least = reach;
  Vec2 away;
  by_place_.for_each_within(place, reach, [&](std::size_t o) {
    for (const Segment& edge : edges_[o]) {
      const Vec2 from = place - geometry::nearest_point(edge, place);
      if (!(norm(from) < least)) continue;
      least = norm(from);
      away = from;
    }
  });
  return away;
}

}  // namespace exactvo::formation::detail
