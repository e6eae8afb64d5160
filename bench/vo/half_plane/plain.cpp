// SPDX-License-Identifier: GPL-3.0-or-later
#include "half_plane/plain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cone/direction_search.h"
#include "exactvo/geometry/require.h"
#include "cone/tangents.h"

namespace exactvo::bench {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::GrownShape;
using geometry::HalfPlane;
using geometry::squared_norm;
using geometry::Vec2;

std::optional<HalfPlane> disc_half_plane(Vec2 p, double R, double tau, Vec2 y) {
  const double d2 = squared_norm(p);
  const double a2 = d2 - R * R;
  if (!(a2 > 0.0)) return std::nullopt;
  const Vec2 w = y - p;
  const double wp = dot(w, p);
  const double w2 = squared_norm(w);
  if (wp < 0.0 && wp * wp > R * R * w2) {
    const Vec2 n = w / std::sqrt(w2);
    return HalfPlane{n, (dot(n, p) + R) / tau};
  }
  const double a = cross(p, w) >= 0.0 ? std::sqrt(a2) : -std::sqrt(a2);
  const double per_d2 = 1.0 / d2;
  const double across = a * per_d2;
  const double back = R * per_d2;
  return HalfPlane{{-across * p.y - back * p.x, across * p.x - back * p.y}, 0.0};
}

struct Support {
  Vec2 origin, n;
  double operator()(const geometry::Disc& d) const { return dot(n, d.center - origin) + d.radius; }
  double operator()(const geometry::Segment& g) const { return std::max(dot(n, g.a - origin), dot(n, g.b - origin)); }
  double operator()(const geometry::ConvexPolygon& p) const {
    double most = dot(n, p.vertices[0] - origin);
    for (std::size_t i = 1; i < p.vertices.size(); ++i) most = std::max(most, dot(n, p.vertices[i] - origin));
    return most;
  }
  double operator()(const geometry::Ellipse& e) const {
    const double wx = e.l11 * n.x + e.l21 * n.y;
    const double wy = e.l22 * n.y;
    return dot(n, e.center - origin) + std::sqrt(wx * wx + wy * wy);
  }
};

/// n is of length 1.
double support_of(const GrownShape& s, Vec2 n) {
  return std::visit(Support{s.origin, n}, s.shape) + s.radius;
}

std::optional<HalfPlane> searched_half_plane(const GrownShape& s, double tau, Vec2 y) {
  double least = std::numeric_limits<double>::infinity();
  HalfPlane best;
  const vo::detail::Normals inner = vo::detail::nearest_normals(s, y);
  for (std::size_t i = 0; i < inner.count; ++i) {
    const double h = support_of(s, inner.n[i]);
    if (h > 0.0) continue;
    const double f = h - dot(inner.n[i], y);
    if (f < least) {
      least = f;
      best = {inner.n[i], h / tau};
    }
    if (i == 0 && least < 0.0) return best;
  }
  if (const auto legs = vo::detail::tangents(s)) {
    for (const Vec2 n : {legs->left.normal, legs->right.normal}) {
      const double f = -dot(n, y);
      if (f < least) {
        least = f;
        best = {n, 0.0};
      }
    }
  }
  if (!std::isfinite(least)) return std::nullopt;
  return best;
}

}  // namespace

std::optional<HalfPlane> plain_half_plane(const GrownShape& s, double time_horizon, Vec2 v) {
  EXACTVO_REQUIRE(geometry::is_finite(v), "a velocity that is not finite");
  EXACTVO_REQUIRE(time_horizon > 0.0 && std::isfinite(time_horizon), std::to_string(time_horizon));
  const Vec2 y = time_horizon * v;
  if (const auto* d = std::get_if<geometry::Disc>(&s.shape))
    return disc_half_plane(d->center - s.origin, d->radius + s.radius, time_horizon, y);
  return searched_half_plane(s, time_horizon, y);
}

}  // namespace exactvo::bench
