// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/obstacle_index.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "shapes/edge_crossing.h"

namespace exactvo::geometry {
namespace {

/// Whether every two points of the boxes are farther from each other than that, beyond the rounding of it.
bool are_apart(const Box& a, const Box& b, double distance) {
  constexpr double kRounding = 1.0 + 1e-12;
  const double x = std::max({a.low.x - b.high.x, b.low.x - a.high.x, 0.0});
  const double y = std::max({a.low.y - b.high.y, b.low.y - a.high.y, 0.0});
  return x * x + y * y > kRounding * (distance * distance);
}

}  // namespace

ObstacleIndex::ObstacleIndex(const Obstacle& obstacle)
    : edges_(edges_of(obstacle)), has_interior_(has_interior(obstacle)) {
  if (const auto* wall = std::get_if<Polyline>(&obstacle); wall && wall->points.size() == 1)
    edges_ = {{wall->points[0], wall->points[0]}};
  std::vector<Box> boxes;
  boxes.reserve(edges_.size());
  for (const Segment& e : edges_) {
    boxes.push_back(box_of(e));
    box_.add(boxes.back());
    largest_ = std::max({largest_, largest_coordinate(e.a), largest_coordinate(e.b)});
  }
  edges_by_place_ = BoxGrid(std::move(boxes));
}

/// Decides it by the edges that the ray towards +x may cross.
bool ObstacleIndex::is_inside(Vec2 x) const {
  if (!has_interior_ || !box_.contains(x)) return false;
  return detail::even_odd_place(x, [&](const auto& visit) {
           edges_by_place_.for_each_meeting({x, {box_.high.x, x.y}}, [&](std::size_t e) { visit(edges_[e]); });
         }) != Place::outside;
}

/// Looks at all of few edges, else at those within a reach that doubles until it holds the nearest. An edge beyond a
/// window is farther than its reach, rounding and all.
double ObstacleIndex::edge_distance(const Segment& path, double enough) const {
  constexpr std::size_t kFew = 8;     // a window costs more
  constexpr double kRounding = 1e-9;  // of a reach
  const Box round = box_of(path);
  const Vec2 size = round.high - round.low;
  const double rounding =
      rounding_of_distance(std::max({largest_, largest_coordinate(path.a), largest_coordinate(path.b)}));
  double least = kInfinity;
  const auto look_at = [&](std::size_t e) {
    if (!are_apart(edges_by_place_.box(e), round, std::min(least, enough) + 2.0 * rounding))
      least = std::min(least, distance(edges_[e], path));
  };
  if (edges_.size() <= kFew) {
    for (std::size_t e = 0; e < edges_.size(); ++e) look_at(e);
    return least;
  }
  for (double reach = std::min(std::max({size.x, size.y, 1.0}), std::max(enough, 0.0));; reach *= 2.0) {
    edges_by_place_.for_each_meeting(round.grown(reach * (1.0 + kRounding) + 2.0 * rounding), look_at);
    if (least <= reach || reach >= enough || !std::isfinite(reach)) return least;
  }
}

double ObstacleIndex::signed_distance(Vec2 x, bool inside) const {
  double d = kInfinity;
  for (const Segment& e : edges_) d = std::min(d, distance(e, x));
  return inside ? -d : d;
}

double ObstacleIndex::swept_distance(const Segment& path, double enough) const {
  EXACTVO_REQUIRE(is_finite(path.a) && is_finite(path.b), to_string(ConvexShape{path}));
  const bool starts_inside = is_inside(path.a), ends_inside = is_inside(path.b);
  if (!starts_inside && !ends_inside) return edge_distance(path, enough);
  return std::min(signed_distance(path.a, starts_inside), signed_distance(path.b, ends_inside));
}

}  // namespace exactvo::geometry
