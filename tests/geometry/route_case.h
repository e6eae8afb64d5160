// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A question of routes.h as a line of the corpus (tests/corpus/geometry/routes.txt), lossless:
///
///   route RADIUS START GOAL OBSTACLES, then for each obstacle RINGS and for each ring  n x1 y1 ... xn yn
///
/// RINGS is 0 for a wall, whose points follow as one ring does; else the outer ring and the holes are counted.

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"
#include "route_fields.h"
#include "support/corpus.h"

namespace exactvo::test {

struct RouteCase {
  RouteField field;
  double radius = 0.0;  ///< m
};

inline std::string corpus_line(const RouteCase& c) {
  const auto number = [](double x) { return " " + geometry::hex_text(x); };
  std::string text = "route" + number(c.radius);
  for (const Vec2 p : {c.field.start, c.field.goal}) text += number(p.x) + number(p.y);
  text += " " + std::to_string(c.field.obstacles.size());
  for (const Obstacle& o : c.field.obstacles) {
    if (const auto* wall = std::get_if<Polyline>(&o)) {
      text += " 0 " + geometry::to_string(wall->points);
      continue;
    }
    const auto& polygon = std::get<Polygon>(o);
    text += " " + std::to_string(1 + polygon.holes.size()) + " " + geometry::to_string(polygon.outer);
    for (const Ring& hole : polygon.holes) text += " " + geometry::to_string(hole);
  }
  return text;
}

/// Throws std::runtime_error for another kind or a wrong count.
inline RouteCase route_case_of(const CorpusCase& c) {
  std::size_t at = 0;
  const auto number = [&] {
    if (at >= c.numbers.size()) throw std::runtime_error("a case \"" + c.kind + "\" ends too early");
    return c.numbers[at++];
  };
  const auto count = [&] {
    const double n = number();
    if (!(n >= 0.0 && n <= 1e6 && n == std::floor(n))) throw std::runtime_error("found a count that is none");
    return static_cast<std::size_t>(n);
  };
  const auto point = [&] {
    const double x = number();
    return Vec2{x, number()};
  };
  const auto points = [&] {
    std::vector<Vec2> out(count());
    for (Vec2& p : out) p = point();
    return out;
  };
  if (c.kind != "route") throw std::runtime_error("found a case \"" + c.kind + "\", expected \"route\"");
  RouteCase out;
  out.radius = number();
  out.field.start = point();
  out.field.goal = point();
  for (std::size_t left = count(); left > 0; --left) {
    const std::size_t rings = count();
    if (rings == 0) {
      out.field.obstacles.push_back(Polyline{points()});
      continue;
    }
    Polygon polygon{points(), {}};
    while (polygon.holes.size() + 1 < rings) polygon.holes.push_back(points());
    out.field.obstacles.push_back(polygon);
  }
  if (at != c.numbers.size()) throw std::runtime_error("a case \"route\" goes on too long");
  return out;
}

}  // namespace exactvo::test
