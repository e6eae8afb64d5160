// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/orca_obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "cone/separation.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"
#include "exactvo/geometry/support.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo {
namespace {

/// REQUIRES of an edge that its ends differ: repeated vertices go first.
std::vector<Vec2> without_repeats(std::vector<Vec2> vertices) {
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  while (vertices.size() > 1 && vertices.front() == vertices.back()) vertices.pop_back();
  return vertices;
}

OrcaChain with_turns(std::vector<Vec2> vertices) {
  OrcaChain chain{without_repeats(std::move(vertices)), {}, {}};
  const std::size_t n = chain.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const geometry::Sign turn =
        geometry::orientation(chain.vertices[(i + n - 1) % n], chain.vertices[i], chain.vertices[(i + 1) % n]);
    chain.convex.push_back(turn != geometry::Sign::negative);
    chain.directions.push_back(normalized(chain.vertices[(i + 1) % n] - chain.vertices[i]));
  }
  return chain;
}

/// One edge seen from the robot, with what the rule needs of its neighbours.
struct Edge {
  Vec2 left, right;  ///< ends relative to the robot: from `left` to `right` the free side is on the right
  Vec2 direction;    ///< unit, left to right
  bool left_convex, right_convex;
  Vec2 previous_direction, next_direction;
};

/// The two rays that bound the edge's velocity obstacle. A foreign one runs along the neighbouring edge.
struct Ray {
  Vec2 direction;
  bool foreign = false;
};

/// The unit direction of the tangent from the robot to the disc of `radius` round `c`: side +1 passes it on the left.
Vec2 tangent(Vec2 c, double radius, double side) {
  const double d2 = squared_norm(c);
  const double along = std::sqrt(std::max(d2 - radius * radius, 0.0));
  return (along * c + (side * radius) * perp(c)) / d2;
}

struct EdgeCone {
  Ray left, right;
  Vec2 cut_left, cut_right;  ///< the ends of the cut-off before division by the horizon, beside which the rays start
};

/// The cone of an edge; nothing where the neighbours already stand for it.
std::optional<EdgeCone> cone_of(const Edge& e, double radius) {
  const double s = dot(-e.left, e.direction) / norm(e.right - e.left);
  const double to_line = std::fabs(cross(e.direction, -e.left));
  const bool before_left = s < 0.0 && to_line <= radius;
  const bool beyond_right = s > 1.0 && to_line <= radius;
  if ((before_left && !e.left_convex) || (beyond_right && !e.right_convex)) return std::nullopt;
  EdgeCone cone;
  cone.cut_left = beyond_right ? e.right : e.left;
  cone.cut_right = before_left ? e.left : e.right;
  const bool left_is_vertex = before_left || beyond_right || e.left_convex;
  const bool right_is_vertex = before_left || beyond_right || e.right_convex;
  cone.left.direction = left_is_vertex ? tangent(cone.cut_left, radius, 1.0) : -e.direction;
  cone.right.direction = right_is_vertex ? tangent(cone.cut_right, radius, -1.0) : e.direction;
  return cone;
}

void replace_foreign_legs(const Edge& e, EdgeCone& cone) {
  const bool left_vertex_convex = cone.cut_left == e.left ? e.left_convex : e.right_convex;
  const Vec2 before = cone.cut_left == e.left ? e.previous_direction : e.direction;
  if (left_vertex_convex && cross(cone.left.direction, -before) >= 0.0) cone.left = {-before, true};
  const bool right_vertex_convex = cone.cut_right == e.right ? e.right_convex : e.left_convex;
  const Vec2 after = cone.cut_right == e.right ? e.next_direction : e.direction;
  if (right_vertex_convex && cross(cone.right.direction, after) <= 0.0) cone.right = {after, true};
}

/// The outward normal at the point of the cone's boundary nearest to v; nothing where that lies on a foreign leg.
std::optional<Vec2> nearest_normal(const EdgeCone& cone, Vec2 v, double tau) {
  const Vec2 a = cone.cut_left / tau;
  const Vec2 b = cone.cut_right / tau;
  const Vec2 cut = b - a;
  const bool point_like = cut == Vec2{};
  const double t = point_like ? 0.5 : dot(v - a, cut) / squared_norm(cut);
  const double along_left = dot(v - a, cone.left.direction);
  const double along_right = dot(v - b, cone.right.direction);
  if ((t < 0.0 || point_like) && along_left < 0.0 && (!point_like || along_right < 0.0)) return normalized(v - a);
  if (t > 1.0 && along_right < 0.0) return normalized(v - b);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double to_cut = t < 0.0 || t > 1.0 || point_like ? kNever : squared_norm(v - (a + t * cut));
  const double to_left = along_left < 0.0 ? kNever : squared_norm(v - (a + along_left * cone.left.direction));
  const double to_right = along_right < 0.0 ? kNever : squared_norm(v - (b + along_right * cone.right.direction));
  if (to_cut <= to_left && to_cut <= to_right) return -perp(normalized(cut));
  if (to_left <= to_right) return cone.left.foreign ? std::nullopt : std::optional(perp(cone.left.direction));
  return cone.right.foreign ? std::nullopt : std::optional(-perp(cone.right.direction));
}

/// The certified half-plane with outward normal close to n: its offset from the support function, tilted where h_S
/// would be positive.
OrcaHalfPlane certified_half_plane(const VelocityObstacle& obstacle, Vec2 n, double tau) {
  const geometry::GrownShape& s = obstacle.grown();
  const VelocityObstacle::Nearest n0 = obstacle.nearest();
  const geometry::SupportValue at_n = geometry::support(s, n);
  const double bound = geometry::kSupportError * at_n.magnitude + geometry::kSupportUnderflow;
  std::optional<Vec2> normal = n;
  if (at_n.h + bound > 0.0) {
    // Beyond rounding on the wrong side: the direction does not separate, so the nearest point's normal is mixed in.
    normal.reset();
    if (n0.distance > 0.0)
      normal = detail::tilted_inside(s, n, n0.normal, (std::max(at_n.h, 0.0) + 2.0 * bound) / n0.distance);
  }
  if (normal) {
    const double c = geometry::support_upper_bound(s, *normal) / tau;
    return {{*normal, std::min(0.0, geometry::rounded_up_sum(c, std::fabs(c), 2.0))}, 0, true};
  }
  const auto contact = obstacle.contact_half_plane();
  return contact ? OrcaHalfPlane{*contact, 0, true} : OrcaHalfPlane{{n0.normal, 0.0}, 0, false};
}

/// Whether a half-plane found before already excludes this edge's velocity obstacle. Exact: at a vertex that two edges
/// share, one's half-plane excludes the other or it does not.
bool covered(const std::vector<OrcaHalfPlane>& found, const geometry::GrownShape& edge, double tau) {
  return std::any_of(found.begin(), found.end(),
                     [&](const OrcaHalfPlane& f) { return half_plane_is_safe(edge, tau, f.half_plane); });
}

Edge edge_at(const OrcaChain& chain, std::size_t i, Vec2 position) {
  const std::size_t n = chain.vertices.size();
  const auto vertex = [&](std::size_t k) { return chain.vertices[k % n]; };
  const auto direction = [&](std::size_t k) { return chain.directions[k % n]; };
  return {vertex(i) - position,      vertex(i + 1) - position, direction(i),    chain.convex[i],
          chain.convex[(i + 1) % n], direction(i + n - 1),     direction(i + 1)};
}

/// Each with its distance; of edges equally near the one of the lower number.
std::vector<std::pair<double, std::size_t>> nearest_first(const OrcaChain& chain, const std::vector<std::size_t>& edges,
                                                          Vec2 position) {
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(edges.size());
  for (const std::size_t i : edges) {
    const Vec2 a = chain.vertices[i], b = chain.vertices[(i + 1) % chain.vertices.size()];
    order.emplace_back(norm(position - nearest_on(a, b, position)), i);
  }
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<OrcaChain> orca_chains(const geometry::Obstacle& obstacle) {
  std::vector<OrcaChain> chains;
  if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle)) {
    std::vector<Vec2> there_and_back = wall->points;
    for (std::size_t i = wall->points.size() - 1; i-- > 1;) there_and_back.push_back(wall->points[i]);
    chains.push_back(with_turns(std::move(there_and_back)));
    return chains;
  }
  const auto& polygon = std::get<geometry::Polygon>(obstacle);
  chains.push_back(with_turns(polygon.outer));
  for (const geometry::Ring& hole : polygon.holes) chains.push_back(with_turns(hole));
  return chains;
}

std::vector<OrcaHalfPlane> orca_half_planes(const OrcaChain& chain, const std::vector<std::size_t>& edges,
                                            Vec2 position, Vec2 velocity, double radius, double time_horizon) {
  EXACTVO_REQUIRE(radius >= 0.0 && time_horizon > 0.0, std::to_string(radius) + ", " + std::to_string(time_horizon));
  EXACTVO_REQUIRE(geometry::is_finite(position) && geometry::is_finite(velocity), "a vector that is not finite");
  std::vector<OrcaHalfPlane> found;
  for (const auto& [distance, i] : nearest_first(chain, edges, position)) {
    const Edge edge = edge_at(chain, i, position);
    // The free side is on the right: from the left of an edge another edge is in front of it.
    if (cross(edge.direction, -edge.left) > 0.0) continue;
    const VelocityObstacle obstacle(geometry::Segment{edge.left + position, edge.right + position}, position, radius,
                                    time_horizon);
    if (covered(found, obstacle.grown(), time_horizon)) continue;
    std::optional<Vec2> normal;
    if (obstacle.overlaps()) {
      normal = obstacle.nearest().normal;
    } else if (std::optional<EdgeCone> cone = cone_of(edge, radius)) {
      replace_foreign_legs(edge, *cone);
      normal = nearest_normal(*cone, velocity, time_horizon);
    }
    if (!normal) continue;
    OrcaHalfPlane h = certified_half_plane(obstacle, *normal, time_horizon);
    h.edge = i;
    found.push_back(h);
  }
  return found;
}

}  // namespace exactvo::vo
