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
  stand(std::move(standing));
  ++changes_;
}

void StandingObstacles::stand(Standing standing) {
  now_ = std::move(standing);
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

Detour StandingObstacles::detour(const Standing& round) {
  const auto detour_of = [](const std::shared_ptr<World>& world) {
    return Detour{world->standing, std::shared_ptr<Guide>(world, &*world->guide)};
  };
  for (const std::shared_ptr<World>& world : worlds_)
    if (world->standing == round) return detour_of(world);
  constexpr std::size_t kMostKept = 8;  // of obstacles that stop at many places
  if (worlds_.size() == kMostKept) worlds_.pop_front();
  const auto world = std::make_shared<World>();
  world->standing = round;
  world->obstacles = scenario_.obstacles;
  for (const auto& [k, moved] : round) {
    const MovingObstacle& obstacle = scenario_.moving_obstacles[k];
    world->obstacles.push_back({obstacle.id, standing_shape(obstacle, moved)});
  }
  const Terrain given = terrain_of(scenario_);
  world->guide.emplace(Terrain{world->obstacles, given.places, given.largest_radius}, scenario_.unreachable,
                       most_margin_);
  return detour_of(worlds_.emplace_back(world));
}

void StandingObstacles::put(crowd::SnapshotWriter& to) const {
  to.fields(displacement_, since_);
  put_standing(to, now_);
}

void StandingObstacles::get(crowd::SnapshotReader& from) {
  from.fields(displacement_, since_);
  const std::size_t obstacles = scenario_.moving_obstacles.size();
  from.require(displacement_.size() <= obstacles && since_.size() == displacement_.size(), "other bytes");
  stand(get_standing(from, obstacles));
}

void put_standing(crowd::SnapshotWriter& to, const Standing& standing) {
  to.put(standing.size());
  for (const auto& [k, moved] : standing) to.fields(k, moved);
}

Standing get_standing(crowd::SnapshotReader& from, std::size_t obstacles) {
  const auto count = from.get<std::size_t>();
  from.require(count <= obstacles, "other bytes");
  Standing standing(count);
  for (auto& [k, moved] : standing) {
    from.fields(k, moved);
    from.require(k < obstacles, "other bytes");
  }
  return standing;
}

}  // namespace exactvo::formation::detail
