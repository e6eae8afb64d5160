// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether the static obstacles shut a goal off from the start for a robot of some radius, without any planning.
///
/// A robot's centre can cross neither an edge of an obstacle nor a connector: a segment of length below the robot's
/// diameter between two points of obstacles, since from every point of it one end is nearer than the radius. A closed
/// chain of edges and connectors that crosses the straight segment from start to goal an odd number of times has one of
/// them inside and the other outside.
///
///          ____________
///         |            |      start ------x---------- goal:  one crossing with the chain, so it separates them
///         |   goal     .
///         |            .  <- connector: a gap narrower than the robot
///         |____________|
///
/// Sound: what is found separated is; lengths are rounded against it. Complete but for gaps within 1e-9 m of the
/// diameter and for chains that come nearer to the start or the goal than the robot may stay away from it. Moving
/// obstacles and other robots are not considered, nor the margins that a method keeps.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box_grid.h"

namespace exactvo::formation::detail {

/// A disc in which a place counts as reached.
struct Place {
  Vec2 point;          ///< m
  double reach = 0.0;  ///< m, >= 0
};

struct Enclosing {
  std::vector<std::size_t> obstacles;  ///< of the closed chain, ascending
  bool around_goal = false;            ///< the goal lies inside the chain, else the start
  double widest_gap = 0.0;             ///< m, between neighbours in the chain; 0 where they touch
};

/// The walls of a scene for robots of one radius.
class Walls {
 public:
  Walls(const std::vector<SceneObstacle>& obstacles, double robot_radius);

  /// A closed chain with just one of the two places inside; nothing where none was found.
  std::optional<Enclosing> between(const Place& start, const Place& goal) const;

 private:
  struct Edge {
    geometry::Segment segment;
    std::size_t obstacle = 0;
    std::vector<std::size_t> links;  ///< in links_
  };
  /// Two edges that touch, or that no robot fits between.
  struct Link {
    std::size_t from = 0, to = 0;  ///< edges
    std::array<Vec2, 4> path;  ///< m, from the beginning of the one to that of the other: along them and the connector
    double gap = 0.0;          ///< m, the connector's length
  };
  /// What one question makes of a link.
  struct Use {
    bool is_taken = false;  ///< it comes near a place, so that the place is no side of it
    bool is_odd = false;    ///< it crosses the straight way between the places an odd number of times
  };

  void add_links(double robot_radius);
  void number_parts();
  std::vector<Use> uses_for(const Place& start, const Place& goal) const;
  Enclosing enclosing(const std::vector<std::size_t>& chain, Vec2 goal) const;

  std::vector<Edge> edges_;
  std::vector<Link> links_;
  geometry::BoxGrid links_by_place_;
  std::vector<std::size_t> part_;  ///< of the graph, of each edge
  double largest_ = 0.0;           ///< m, coordinate
};

}  // namespace exactvo::formation::detail
