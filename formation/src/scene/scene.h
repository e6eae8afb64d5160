// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What stands and moves in a run, as bodies of one table, looked up by place. `static_field.h` shows it to one robot.

#include <cstddef>
#include <vector>

#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/vo/constraint.h"
#include "exactvo/vo/orca_obstacle.h"

namespace exactvo::formation::detail {

/// The bodies of a run: convex pieces or edges of the obstacles, robots, moving obstacles, and the enclosures that
/// fields add for their robots. Shared by all robots of a run, and for one thread.
class Scene {
 public:
  Scene(const Scenario& scenario, const SimulationOptions& options);
  /// `ellipse`: of facades, for Method::ivo_edge alone.
  Scene(Method method, const std::vector<SceneObstacle>& obstacles, const std::vector<Robot>& robots,
        const std::vector<MovingObstacle>& moving, const geometry::FacadeEllipseOptions& ellipse);

  const vo::BodyTable& bodies() const { return bodies_; }
  vo::BodyTable& bodies() { return bodies_; }

  /// The obstacles' facades and pieces; none for Method::orca, which needs neither.
  const std::vector<geometry::ObstacleParts>& parts() const { return parts_; }
  /// Pieces of the whole scene are counted through: those of an obstacle begin here, and end where the next begin.
  std::size_t first_piece(std::size_t obstacle) const { return first_piece_[obstacle]; }
  vo::BodyTable::Number piece(std::size_t number) const { return pieces_[number]; }
  const geometry::BoxGrid& pieces_by_place() const { return pieces_by_place_; }

  /// Method::ivo_edge: the ellipses round the facades, the same for every robot.
  vo::BodyTable::Number facade_ellipse(std::size_t number) const { return facade_ellipses_[number]; }
  const geometry::BoxGrid& facade_ellipses_by_place() const { return facade_ellipses_by_place_; }

  /// Method::orca: chains of edges, which are counted over the scene by their vertices.
  const std::vector<vo::OrcaChain>& chains() const { return chains_; }
  std::size_t first_edge(std::size_t chain) const { return first_edge_[chain]; }
  std::size_t chain_of(std::size_t edge) const { return chain_of_[edge]; }
  vo::BodyTable::Number edge(std::size_t number) const { return edges_[number]; }
  const geometry::BoxGrid& edges_by_place() const { return edges_by_place_; }

  vo::BodyTable::Number robot(std::size_t i) const { return first_robot_ + i; }
  std::size_t moving_obstacles() const { return moving_count_; }
  vo::BodyTable::Number moving_obstacle(std::size_t k) const { return first_moving_ + k; }

 private:
  void add_pieces(const std::vector<SceneObstacle>& obstacles);
  void add_facade_ellipses(const geometry::FacadeEllipseOptions& ellipse);
  void add_chains(const std::vector<SceneObstacle>& obstacles);
  geometry::BoxGrid by_place(const std::vector<vo::BodyTable::Number>& some) const;

  vo::BodyTable bodies_;
  std::vector<geometry::ObstacleParts> parts_;
  std::vector<std::size_t> first_piece_;
  std::vector<vo::BodyTable::Number> pieces_;
  geometry::BoxGrid pieces_by_place_;
  std::vector<vo::BodyTable::Number> facade_ellipses_;
  geometry::BoxGrid facade_ellipses_by_place_;
  std::vector<vo::OrcaChain> chains_;
  std::vector<std::size_t> first_edge_, chain_of_;
  std::vector<vo::BodyTable::Number> edges_;
  geometry::BoxGrid edges_by_place_;
  std::size_t first_robot_ = 0, first_moving_ = 0, moving_count_ = 0;
};

}  // namespace exactvo::formation::detail
