// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as obstacles, a radius and two places: the map and the plan take them, each answer is accepted by the
// checker, `is_reachable` and `widest_radius` agree with it, and a route is there wherever the verdict says so.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bytes.h"
#include "exactvo/geometry/route_certificate.h"
#include "exactvo/geometry/routes.h"
#include "exactvo/geometry/validity.h"
#include "geometry/route_case.h"

namespace exactvo::fuzz {
namespace {

using test::RouteCase;

[[noreturn]] void fail(const std::string& what, const RouteCase& c) {
  std::fprintf(stderr, "# %s\n%s\n", what.c_str(), test::corpus_line(c).c_str());
  std::abort();
}

/// Coordinates of one map differ by at most some ten digits: those of the small numbers, their eighths, and a few
/// that are moved by less than that.
Vec2 place(Bytes& bytes) {
  const auto coordinate = [&] {
    const int kind = bytes.byte();
    const double whole = static_cast<double>(static_cast<std::int8_t>(bytes.byte()));
    if (kind < 128) return whole;
    if (kind < 192) return whole / 8.0;
    return whole + std::ldexp(static_cast<double>(static_cast<std::int8_t>(bytes.byte())), -10 - kind % 40);
  };
  const double x = coordinate();
  return {x, coordinate()};
}

std::vector<Vec2> places(Bytes& bytes, int least) {
  std::vector<Vec2> out;
  for (int left = least + bytes.byte() % 8; left > 0; --left) out.push_back(place(bytes));
  return out;
}

/// At most twelve obstacles; rings that are no polygons become walls.
std::vector<geometry::Obstacle> obstacles_of(Bytes& bytes) {
  std::vector<geometry::Obstacle> out;
  for (int left = bytes.byte() % 12; left > 0 && !bytes.empty(); --left) {
    const bool solid = bytes.byte() % 2 == 0;
    const std::vector<Vec2> points = places(bytes, solid ? 3 : 2);
    const geometry::NormalizedPolygon polygon = solid ? geometry::normalize({points}) : geometry::NormalizedPolygon{};
    if (solid && polygon.ok())
      out.emplace_back(polygon.polygon);
    else
      out.emplace_back(geometry::Polyline{points});
  }
  return out;
}

void examine(const geometry::RouteMap& map, const RouteCase& c) {
  const Vec2 start = c.field.start, goal = c.field.goal;
  const geometry::RoutePlan plan(map, c.radius);
  const geometry::RouteAnswer answer = plan.query(start, goal);
  const std::string wrong = geometry::check(c.field.obstacles, {c.radius, start, goal}, answer);
  if (!wrong.empty()) fail("refused: " + wrong, c);
  const bool reached = std::holds_alternative<geometry::Route>(answer);
  if (reached != plan.is_reachable(start, goal)) fail("query and is_reachable differ", c);
  const double widest = map.widest_radius(start, goal);
  if (reached != (c.radius > 0.0 ? c.radius <= widest : widest > 0.0)) fail("query and widest_radius differ", c);
}

void examine(Bytes bytes) {
  RouteCase c;
  const int kind = bytes.byte() % 4;
  const double asked = 0.125 * bytes.byte();
  c.field.start = place(bytes);
  c.field.goal = place(bytes);
  c.field.obstacles = obstacles_of(bytes);
  geometry::RouteMapOptions options;
  options.largest_distance = 1024.0;  // m; all coordinates are within 129 m
  const geometry::RouteMap map(c.field.obstacles, options);
  const double widest = map.widest_radius(c.field.start, c.field.goal);
  // The radius that was asked for, or the widest with a route, or the next one.
  c.radius = kind < 2 ? asked : kind == 2 ? widest : std::nextafter(widest, HUGE_VAL);
  c.radius = std::min(c.radius, map.largest_radius());
  if (c.radius != 0.0 && c.radius < 0x1p-100) return;
  try {
    examine(map, c);
  } catch (const std::exception& e) {
    fail(e.what(), c);
  }
}

}  // namespace
}  // namespace exactvo::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  exactvo::fuzz::examine({data, size});
  return 0;
}
