// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The map of `exactvo route`, and answers in words, as JSON and as a figure. The map is the obstacles of a file, and
/// how points are given on it: metres of the plane that the reader lays the obstacles out on, except on a Moving AI
/// map, where they are cells, as in its .scen files.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/moving_ai.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/route_certificate.h"
#include "figures/figure.h"
#include "support/obstacle_name.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

/// How cells become metres: columns from the left, rows from the top, y upward.
struct CellPlaces {
  datasets::MapSize size;
  double side = 1.0;    ///< m
  double offset = 0.5;  ///< of what is meant from the cell's top left corner, in cells
};

struct AskedMap {
  std::string file;
  std::string format;
  std::vector<formation::SceneObstacle> obstacles;
  std::vector<geometry::Obstacle> shapes;  ///< theirs
  std::optional<CellPlaces> cells;         ///< of a Moving AI map

  /// A point as it was given, in metres. Nothing where it is no number within 2^100 or lies outside of the cells.
  std::optional<geometry::Vec2> in_metres(geometry::Vec2 given) const;
  /// What `in_metres` accepts, in words.
  std::string accepted_points() const;
  /// An obstacle's id; "wall 7" or "polygon 7" where that is a number.
  std::string name_of(std::size_t obstacle) const { return obstacle_name(obstacles[obstacle]); }
};

/// "middle" or "corner" of the cell.
inline constexpr const char* kCellPoints[] = {"middle", "corner"};

/// Reads the obstacles, all of them: one that cannot be used refuses the file. A Moving AI map gets a wall round it,
/// since what lies outside of it is out of bounds; `cell_point` is what numbers of cells mean there. Throws DataError,
/// UsageError.
AskedMap read_asked_map(const std::string& file, const datasets::ReadOptions& reading, const std::string& cell_point);

struct AnsweredRoute {
  std::size_t index = 0;
  geometry::RouteQuestion question;             ///< m; the radius 0 where none was given
  std::optional<geometry::RouteAnswer> answer;  ///< with a radius
  std::optional<double> widest;                 ///< m, with --widest
  bool is_widest_of_map = false;                ///< even the largest radius of the map fits
  bool is_of_radius = true;  ///< false: none was given, and an answer is a point's, since no disc has a route

  /// Whether there is a route: for the radius, or without one for any.
  bool is_route() const;
};

/// Where a chain leaves an obstacle. Rounded.
struct Gap {
  geometry::Vec2 from, to;
  std::size_t from_obstacle = 0, to_obstacle = 0;
  double width = 0.0;  ///< m
};
std::vector<Gap> gaps_of(const geometry::Separated& separated);

/// One line; `in_full` adds one for every gap of a separation, for the points of a route, for the widest radius.
std::string words_of(const AnsweredRoute& answered, const AskedMap& map, bool in_full);

/// One line of JSON. The certificate names the map's obstacles if `with_obstacles`.
std::string json_of(const AnsweredRoute& answered, const AskedMap& map, bool with_obstacles);

/// The map with start, goal, the disc to scale, and the route or the chain with its gaps.
/// REQUIRES: an answer.
Figure route_figure(const AnsweredRoute& answered, const AskedMap& map);

}  // namespace exactvo::tools
