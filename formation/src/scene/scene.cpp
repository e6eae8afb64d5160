// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <utility>

#include "exactvo/formation/speed_profile.h"

namespace exactvo::formation::detail {

using vo::BodyKind;
using vo::BodyTable;

Scene::Scene(const Scenario& scenario, const SimulationOptions& options)
    : Scene(options.method, scenario.obstacles, scenario.robots, scenario.moving_obstacles,
            {options.facade_minor_to_major, options.facade_fixed_minor, scenario.margins.obstacle}) {}

Scene::Scene(Method method, const std::vector<SceneObstacle>& obstacles, const std::vector<Robot>& robots,
             const std::vector<MovingObstacle>& moving, const geometry::FacadeEllipseOptions& ellipse) {
  if (takes_edges(method))
    add_chains(obstacles);
  else
    add_pieces(obstacles);
  if (method == Method::ivo_edge) add_facade_ellipses(ellipse);
  first_robot_ = bodies_.size();
  for (std::size_t i = 0; i < robots.size(); ++i)
    bodies_.add({BodyKind::robot, geometry::Disc{robots[i].position, robots[i].radius}, robots[i].velocity, {i}});
  first_moving_ = bodies_.size();
  moving_count_ = moving.size();
  for (std::size_t k = 0; k < moving.size(); ++k)
    bodies_.add({BodyKind::moving_obstacle, hull_of(moving[k], displacement_at(moving[k], 0.0)), {}, {k}});
}

geometry::BoxGrid Scene::by_place(const std::vector<BodyTable::Number>& some) const {
  std::vector<geometry::Box> boxes;
  boxes.reserve(some.size());
  for (const BodyTable::Number body : some) boxes.push_back(bodies_.box(body));
  return geometry::BoxGrid(std::move(boxes));
}

void Scene::add_pieces(const std::vector<SceneObstacle>& obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    first_piece_.push_back(pieces_.size());
    parts_.push_back(geometry::parts_of(obstacles[i].shape));
    if (obstacles[i].disc) parts_.back().pieces = {*obstacles[i].disc};
    for (const geometry::ConvexShape& piece : parts_.back().pieces)
      pieces_.push_back(bodies_.add({BodyKind::enclosure, piece, {}, {i}}));
  }
  first_piece_.push_back(pieces_.size());
  pieces_by_place_ = by_place(pieces_);
}

void Scene::add_facade_ellipses(const geometry::FacadeEllipseOptions& ellipse) {
  for (std::size_t i = 0; i < parts_.size(); ++i)
    for (const geometry::Segment& facade : parts_[i].facades)
      facade_ellipses_.push_back(
          bodies_.add({BodyKind::enclosure, geometry::facade_ellipse(facade, ellipse), {}, {i}}));
  facade_ellipses_by_place_ = by_place(facade_ellipses_);
}

void Scene::add_chains(const std::vector<SceneObstacle>& obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    for (vo::OrcaChain& chain : vo::orca_chains(obstacles[i].shape)) {
      // A closed chain has one edge per vertex, an open one is walked there and back: an edge begins at every vertex.
      first_edge_.push_back(edges_.size());
      const std::size_t n = chain.vertices.size();
      for (std::size_t k = 0; k < n; ++k) {
        const geometry::Segment edge{chain.vertices[k], chain.vertices[(k + 1) % n]};
        edges_.push_back(bodies_.add({BodyKind::obstacle_edge, edge, {}, {i}}));
        chain_of_.push_back(chains_.size());
      }
      chains_.push_back(std::move(chain));
    }
  }
  edges_by_place_ = by_place(edges_);
}

}  // namespace exactvo::formation::detail
