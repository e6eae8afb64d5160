// SPDX-License-Identifier: GPL-3.0-or-later
#include "traps/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace exactvo::formation::detail {
namespace {

std::vector<geometry::Segment> edges_round(const geometry::ConvexShape& shape) {
  if (const geometry::Segment* s = std::get_if<geometry::Segment>(&shape)) return {{s->a, s->b}, {s->b, s->a}};
  std::vector<geometry::Segment> edges;
  if (const geometry::ConvexPolygon* polygon = std::get_if<geometry::ConvexPolygon>(&shape)) {
    const std::vector<Vec2>& v = polygon->vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
      if (v[i] != v[(i + 1) % v.size()]) edges.push_back({v[i], v[(i + 1) % v.size()]});
  }
  return edges;
}

/// rho of an ellipse at the unit normal n: det(L)^2 / |L^T n|^3.
double ellipse_curvature_radius(const geometry::Ellipse& e, Vec2 n) {
  const double det = e.l11 * e.l22;
  const double h = std::hypot(e.l11 * n.x + e.l21 * n.y, e.l22 * n.y);
  return det * det / (h * h * h);
}

}  // namespace

Boundary::Boundary(geometry::ConvexShape shape, double radius)
    : grown_{std::move(shape), {}, radius}, edges_(edges_round(grown_.shape)) {}

double Boundary::radius_of_curvature(Vec2 n) const {
  // rad: a normal this near an edge's is that edge's, beyond the rounding of both.
  constexpr double kOnEdge = 1e-9;
  for (const geometry::Segment& edge : edges_)
    if (norm(outward(edge) - n) < kOnEdge) return std::numeric_limits<double>::infinity();
  if (const geometry::Ellipse* e = std::get_if<geometry::Ellipse>(&grown_.shape))
    return ellipse_curvature_radius(*e, n) + grown_.radius;
  if (const geometry::Disc* d = std::get_if<geometry::Disc>(&grown_.shape)) return d->radius + grown_.radius;
  return grown_.radius;
}

BoundaryPoint Boundary::at(double angle) const {
  const Vec2 n{std::cos(angle), std::sin(angle)};
  return {geometry::support_point(grown_, n), n, radius_of_curvature(n)};
}

/// How far the goal lies to the left of the line through the boundary point along its normal.
double Boundary::lateral(double angle, Vec2 goal) const {
  const BoundaryPoint p = at(angle);
  return dot(geometry::perp(p.normal), goal - p.position);
}

std::vector<double> Boundary::flat_equilibria(Vec2 goal) const {
  std::vector<double> angles;
  for (const geometry::Segment& edge : edges_) {
    if (!(cross(edge.b - edge.a, goal - edge.a) > 0.0) || !is_over(edge, goal)) continue;
    const Vec2 n = outward(edge);
    angles.push_back(std::atan2(n.y, n.x));
  }
  return angles;
}

std::vector<double> Boundary::facing_away(Vec2 goal) const {
  constexpr int kSamples = 1440;   // a quarter of a degree: two roots nearer than that are one
  constexpr int kBisections = 50;  // to the last bit of an angle
  std::vector<double> angles = flat_equilibria(goal);
  for (int i = 0; i < kSamples; ++i) {
    double low = kFullTurn * i / kSamples, high = kFullTurn * (i + 1) / kSamples;
    const bool left = lateral(low, goal) > 0.0;
    if (left == (lateral(high, goal) > 0.0)) continue;
    for (int k = 0; k < kBisections; ++k) {
      const double mid = 0.5 * (low + high);
      ((lateral(mid, goal) > 0.0) == left ? low : high) = mid;
    }
    const BoundaryPoint p = at(low);
    // At an edge's normal the sign jumps without a root: only a foot on the line itself counts.
    const bool jump = std::fabs(lateral(low, goal)) > 1e-6 * (1.0 + norm(goal - p.position));
    if (!jump && dot(p.normal, goal - p.position) < 0.0) angles.push_back(low);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

}  // namespace exactvo::formation::detail
