// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/standing.h"

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/round_polygon.h"
#include "scene/moment.h"

namespace exactvo::formation::detail {
namespace {

/// Moments: what has stood for so long counts as standing. A moment at a corner of a path does not.
constexpr double kStands = 1.0;

/// The convex hull, as which robots avoid it; of a disc the polygon round it.
geometry::Obstacle standing_shape(const MovingObstacle& obstacle, Vec2 displacement) {
  const geometry::ConvexShape hull = hull_of(obstacle, displacement);
  if (const auto* disc = std::get_if<geometry::Disc>(&hull)) return geometry::polygon_round(*disc);
  if (const auto* polygon = std::get_if<geometry::ConvexPolygon>(&hull))
    return geometry::Polygon{polygon->vertices, {}};
  const auto& segment = std::get<geometry::Segment>(hull);
  return geometry::Polyline{{segment.a, segment.b}};
}

}  // namespace

StandingObstacles::StandingObstacles(const Scenario& scenario, double most_margin)
    : scenario_(scenario), most_margin_(most_margin) {}

void StandingObstacles::look(double time, const std::vector<MovedObstacle>& moving) {
  Standing standing;
  displacement_.resize(moving.size());
  since_.resize(moving.size(), time);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    if (!(moving[k].displacement == displacement_[k]) || !(moving[k].velocity == Vec2{})) since_[k] = time;
    displacement_[k] = moving[k].displacement;
    if (time - since_[k] >= kStands * moment(scenario_.horizons)) standing.emplace_back(k, displacement_[k]);
  }
  if (standing == now_) return;
  now_ = std::move(standing);
  ++changes_;
  shapes_.clear();
  for (const auto& [k, moved] : now_) shapes_.push_back(standing_shape(scenario_.moving_obstacles[k], moved));
}

std::optional<std::size_t> StandingObstacles::in_the_way(const Course& course, Vec2 here, double radius) const {
  for (std::size_t n = 0; n < now_.size(); ++n) {
    Vec2 from = here;
    for (std::size_t k = course.next; k < course.points.size(); ++k) {
      if (geometry::swept_distance(shapes_[n], {from, course.points[k]}) < radius) return now_[n].first;
      from = course.points[k];
    }
  }
  return std::nullopt;
}

std::shared_ptr<Guide> StandingObstacles::guide() {
  const auto guide_of = [](const std::shared_ptr<World>& world) {
    return std::shared_ptr<Guide>(world, &*world->guide);
  };
  for (const std::shared_ptr<World>& world : worlds_)
    if (world->standing == now_) return guide_of(world);
  constexpr std::size_t kMostKept = 8;  // of obstacles that stop at many places
  if (worlds_.size() == kMostKept) worlds_.pop_front();
  const auto world = std::make_shared<World>();
  world->standing = now_;
  world->obstacles = scenario_.obstacles;
  for (std::size_t n = 0; n < now_.size(); ++n)
    world->obstacles.push_back({scenario_.moving_obstacles[now_[n].first].id, shapes_[n]});
  const Terrain given = terrain_of(scenario_);
  world->guide.emplace(Terrain{world->obstacles, given.places, given.largest_radius}, scenario_.unreachable,
                       most_margin_);
  return guide_of(worlds_.emplace_back(world));
}

}  // namespace exactvo::formation::detail
