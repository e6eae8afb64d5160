// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Answers of `exactvo route` in words, as JSON and as a figure.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/geometry/route_certificate.h"
#include "figures/figure.h"
#include "verbs/route/map.h"

namespace exactvo::tools {

struct AnsweredRoute {
  std::size_t index = 0;
  geometry::RouteQuestion question;             ///< m; the radius 0 where none was given
  std::optional<geometry::RouteAnswer> answer;  ///< with a radius
  std::optional<double> widest;                 ///< m, with --widest
  bool is_widest_of_map = false;                ///< even the largest radius of the map fits
  bool has_no_obstacle = false;                 ///< any radius fits

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

/// The width of a gap and the width that it would need, with as many digits as tell them apart.
std::pair<std::string, std::string> widths_told_apart(double width, double needed);

/// One line; `in_full` adds one for every gap of a separation, for the points of a route, for the widest radius.
std::string words_of(const AnsweredRoute& answered, const AskedMap& map, bool in_full);

/// One line of JSON. The certificate names the map's obstacles if `with_obstacles`.
std::string json_of(const AnsweredRoute& answered, const AskedMap& map, bool with_obstacles);

/// The map with start, goal, the disc to scale, and the route or the chain with its gaps.
/// REQUIRES: an answer.
Figure route_figure(const AnsweredRoute& answered, const AskedMap& map);

}  // namespace exactvo::tools
