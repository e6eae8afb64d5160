// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: p the centre of a disc seen from the robot, r its radius, a = sqrt(|p|^2 - r^2) the length of its tangents.
// All is rounded, and nothing here says by how much: separation.cpp certifies what is made of it.
#include "cone/tangents.h"

#include <cmath>

namespace exactvo::vo::detail {
namespace {

using geometry::Disc;
using geometry::Ellipse;

/// To the disc of radius r round p; side +1 is the left tangent. Nothing where the disc holds the origin.
std::optional<Tangent> disc_tangent(Vec2 p, double r, double side) {
  const double d2 = squared_norm(p);
  const double a2 = d2 - r * r;
  if (!(a2 > 0.0 && std::isfinite(d2 * d2))) return std::nullopt;
  const double a = std::sqrt(a2);
  // |a p + r perp(p)| = d2 up to rounding, and a division by d2 would keep the error of a.
  const Vec2 direction = a * p + (side * r) * perp(p);
  const Vec2 unit = direction / std::sqrt(squared_norm(direction));
  return Tangent{side * perp(unit), a * unit};
}

std::optional<Tangents> both(const std::optional<Tangent>& left, const std::optional<Tangent>& right) {
  if (!left || !right) return std::nullopt;
  return Tangents{*left, *right};
}

// --- Polygons ---

std::size_t farthest(const Vec2* v, std::size_t count, Vec2 n) {
  std::size_t best = 0;
  double most = dot(n, v[0]);
  for (std::size_t i = 1; i < count; ++i) {
    const double at = dot(n, v[i]);
    if (at > most) {
      most = at;
      best = i;
    }
  }
  return best;
}

/// The vertex farthest along the normal of a line through the cone is nearer the leg than the last, until it is its
/// own.
std::optional<Tangent> polygon_tangent(const Vec2* v, std::size_t count, Vec2 origin, double r, double side) {
  std::size_t vertex = count;
  Vec2 normal = side * perp(v[0] - origin);
  std::optional<Tangent> found;
  for (std::size_t round = 0; round < count + 1; ++round) {
    const std::size_t next = farthest(v, count, normal);
    if (next == vertex) break;
    vertex = next;
    found = disc_tangent(v[vertex] - origin, r, side);
    if (!found) break;
    normal = found->normal;
  }
  return found;
}

// --- Ellipses ---

/// The point of S farthest along n, for n of any length.
Vec2 farthest_on(const Ellipse& e, Vec2 p, double r, Vec2 n) {
  const Vec2 w{e.l11 * n.x + e.l21 * n.y, e.l22 * n.y};
  const double length = std::sqrt(squared_norm(w));
  const Vec2 on_ellipse = length > 0.0 ? p + Vec2{e.l11 * w.x, e.l21 * w.x + e.l22 * w.y} / length : p;
  return on_ellipse + (r / std::sqrt(squared_norm(n))) * n;
}

/// Newton's method on h_S: the next normal is across the support point of the last, so it approaches the leg from the
/// outside, each step squaring the error.
std::optional<Tangents> ellipse_tangents(const Ellipse& e, Vec2 p, double r) {
  constexpr int kSteps = 60;            // a dozen but for robots within a millionth of contact
  constexpr double kSettled = 0x1p-51;  // |sin| of the last turn: another step would only round
  Vec2 left = p, right = p;             // directions to the support points
  for (int i = 0; i < kSteps; ++i) {
    const Vec2 next_left = farthest_on(e, p, r, perp(left));
    const Vec2 next_right = farthest_on(e, p, r, -perp(right));
    const double turn_left = cross(left, next_left);
    const double turn_right = -cross(right, next_right);
    const bool settled =
        turn_left <= kSettled * (std::fabs(left.x * next_left.y) + std::fabs(left.y * next_left.x)) &&
        turn_right <= kSettled * (std::fabs(right.x * next_right.y) + std::fabs(right.y * next_right.x));
    left = next_left;
    right = next_right;
    if (settled) break;
  }
  const double length_left = std::sqrt(squared_norm(left));
  const double length_right = std::sqrt(squared_norm(right));
  if (!(length_left > 0.0 && length_right > 0.0 && std::isfinite(length_left) && std::isfinite(length_right)))
    return std::nullopt;
  return Tangents{{perp(left) / length_left, left}, {-perp(right) / length_right, right}};
}

}  // namespace

std::optional<Tangents> tangents(const GrownShape& s) {
  const auto to_disc = [&](const Disc& d, double side) {
    return disc_tangent(d.center - s.origin, d.radius + s.radius, side);
  };
  const auto to_polygon = [&](const Vec2* v, std::size_t count) {
    return both(polygon_tangent(v, count, s.origin, s.radius, 1.0),
                polygon_tangent(v, count, s.origin, s.radius, -1.0));
  };
  if (const auto* d = std::get_if<Disc>(&s.shape)) return both(to_disc(*d, 1.0), to_disc(*d, -1.0));
  if (const auto* e = std::get_if<Ellipse>(&s.shape)) return ellipse_tangents(*e, e->center - s.origin, s.radius);
  if (const auto* g = std::get_if<geometry::Segment>(&s.shape)) {
    const Vec2 ends[2] = {g->a, g->b};
    return to_polygon(ends, 2);
  }
  const std::vector<Vec2>& v = std::get<geometry::ConvexPolygon>(s.shape).vertices;
  return to_polygon(v.data(), v.size());
}

}  // namespace exactvo::vo::detail
