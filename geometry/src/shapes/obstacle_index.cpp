// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/obstacle_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactvo/geometry/require.h"
#include "shapes/edge_crossing.h"

namespace exactvo::geometry {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box box_of_edges(const Segment* first, const Segment* last) {
  Box box;
  for (const Segment* s = first; s != last; ++s) {
    box.add(s->a);
    box.add(s->b);
  }
  return box;
}

bool holds(const Box& box, Vec2 x) {
  return box.low.x <= x.x && x.x <= box.high.x && box.low.y <= x.y && x.y <= box.high.y;
}

Box grown(const Box& box, double by) {
  return {box.low - Vec2{by, by}, box.high + Vec2{by, by}};
}

}  // namespace

void ObstacleIndex::add(const Obstacle& obstacle) {
  const std::size_t first = edges_.size();
  std::vector<Segment> edges = edges_of(obstacle);
  if (const auto* wall = std::get_if<Polyline>(&obstacle); wall && wall->points.size() == 1)
    edges = {{wall->points[0], wall->points[0]}};
  edges_.insert(edges_.end(), edges.begin(), edges.end());
  obstacle_of_.resize(edges_.size(), obstacles_++);
  if (has_interior(obstacle)) polygons_.push_back(strips_of(first, edges_.size()));
}

ObstacleIndex::Strips ObstacleIndex::strips_of(std::size_t first_edge, std::size_t last_edge) const {
  Strips s;
  s.first_edge = static_cast<std::uint32_t>(first_edge);
  s.last_edge = static_cast<std::uint32_t>(last_edge);
  s.box = box_of_edges(edges_.data() + first_edge, edges_.data() + last_edge);
  const std::size_t count = last_edge - first_edge;
  s.height = (s.box.high.y - s.box.low.y) / static_cast<double>(count);
  if (!(s.height > 0.0) || !std::isfinite(s.height)) s.height = 1.0;
  const auto strip_at = [&](double y) {
    return static_cast<std::size_t>(std::clamp((y - s.box.low.y) / s.height, 0.0, static_cast<double>(count - 1)));
  };
  const auto for_each_strip = [&](std::size_t e, const auto& visit) {
    const std::size_t last = strip_at(std::max(edges_[e].a.y, edges_[e].b.y));
    for (std::size_t k = strip_at(std::min(edges_[e].a.y, edges_[e].b.y)); k <= last; ++k) visit(k);
  };
  s.start.assign(count + 1, 0);
  for (std::size_t e = first_edge; e < last_edge; ++e) for_each_strip(e, [&](std::size_t k) { ++s.start[k + 1]; });
  for (std::size_t k = 0; k < count; ++k) s.start[k + 1] += s.start[k];
  s.item.resize(s.start.back());
  std::vector<std::uint32_t> next(s.start.begin(), s.start.end() - 1);
  for (std::size_t e = first_edge; e < last_edge; ++e)
    for_each_strip(e, [&](std::size_t k) { s.item[next[k]++] = static_cast<std::uint32_t>(e); });
  return s;
}

void ObstacleIndex::build() {
  std::vector<Box> boxes;
  boxes.reserve(edges_.size());
  for (const Segment& e : edges_) boxes.push_back(box_of_edges(&e, &e + 1));
  edges_by_place_ = BoxGrid(std::move(boxes));
  boxes.clear();
  for (const Strips& p : polygons_) boxes.push_back(p.box);
  polygons_by_place_ = BoxGrid(std::move(boxes));
}

bool ObstacleIndex::is_inside(const Strips& polygon, Vec2 x) const {
  if (!holds(polygon.box, x)) return false;
  const auto count = static_cast<double>(polygon.start.size() - 1);
  const auto strip = static_cast<std::size_t>(std::clamp((x.y - polygon.box.low.y) / polygon.height, 0.0, count - 1.0));
  bool odd = false;
  for (std::uint32_t k = polygon.start[strip]; k < polygon.start[strip + 1]; ++k) {
    const detail::Crossing c = detail::crossing(edges_[polygon.item[k]], x);
    if (c == detail::Crossing::on_edge) return true;
    odd = odd != (c == detail::Crossing::right);
  }
  return odd;
}

/// Looks at the edges within a reach that doubles until it holds the nearest.
template <class Query>
double ObstacleIndex::edge_distance(const Query& query, const Box& round, double enough) const {
  if (edges_.empty()) return kInfinity;
  constexpr double kRounding = 1e-9;  // of a reach: far above that of a distance
  const Vec2 size = round.high - round.low;
  double least = kInfinity;
  for (double reach = std::max({size.x, size.y, 1.0});; reach *= 2.0) {
    edges_by_place_.for_each_meeting(grown(round, reach * (1.0 + kRounding)),
                                     [&](std::size_t e) { least = std::min(least, distance(edges_[e], query)); });
    if (least <= reach || reach >= enough || !std::isfinite(reach)) return least;
  }
}

double ObstacleIndex::swept_distance(const Segment& path, double enough) const {
  EXACTVO_REQUIRE(is_finite(path.a) && is_finite(path.b), to_string(ConvexShape{path}));
  const Box round = box_of_edges(&path, &path + 1);
  double least = kInfinity;
  std::vector<const Strips*> entered;  // no allocation unless a robot is inside an obstacle
  polygons_by_place_.for_each_meeting(round, [&](std::size_t k) {
    const Strips& polygon = polygons_[k];
    const bool starts_inside = is_inside(polygon, path.a), ends_inside = is_inside(polygon, path.b);
    if (!starts_inside && !ends_inside) return;
    entered.push_back(&polygon);
    for (const auto& [x, inside] : {std::pair{path.a, starts_inside}, std::pair{path.b, ends_inside}}) {
      double d = kInfinity;
      for (std::uint32_t e = polygon.first_edge; e < polygon.last_edge; ++e) d = std::min(d, distance(edges_[e], x));
      least = std::min(least, inside ? -d : d);
    }
  });
  if (entered.empty()) return edge_distance(path, round, enough);
  // Of a polygon that was entered only the signed distances above count.
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const bool counts = std::none_of(entered.begin(), entered.end(),
                                     [e](const Strips* p) { return p->first_edge <= e && e < p->last_edge; });
    if (counts) least = std::min(least, distance(edges_[e], path));
  }
  return least;
}

}  // namespace exactvo::geometry
