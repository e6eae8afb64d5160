// SPDX-License-Identifier: GPL-3.0-or-later
#include "predicates/exact_sweep.h"

#include "predicates/grown_ellipse.h"

namespace exactvo::geometry::detail {
namespace {

using Point = Vector<Exact>;

int turn(const Point& a, const Point& b, const Point& c) {
  return static_cast<int>(sign_of(cross(b - a, c - a)));
}

bool cross_properly(const Point& a, const Point& b, const Point& c, const Point& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/// In the hull of counter-clockwise vertices that have an area.
bool in_hull(const std::vector<Point>& v, const Point& q) {
  bool area = false;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Point& b = v[(i + 1) % v.size()];
    if (turn(v[i], b, q) < 0) return false;
    area = area || turn(v[0], v[i], b) > 0;
  }
  return area;
}

}  // namespace

Sign distance_sign(const Point& q, const Point& a, const Point& b, const Exact& r) {
  const Point e = b - a;
  const Point d = q - a;
  const Exact along = dot(d, e);
  const Exact length2 = dot(e, e);
  const Exact r2 = r * r;
  if (sign_of(along) != Sign::positive) return sign_of(dot(d, d) - r2);
  const Point f = q - b;
  if (!(along < length2)) return sign_of(dot(f, f) - r2);
  return sign_of(squared(cross(e, d)) - r2 * length2);
}

bool hull_meets(const std::vector<Point>& v, const Exact& r, const Point& end) {
  const Point start{Exact(0), Exact(0)};
  if (in_hull(v, start) || in_hull(v, end)) return true;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Point& a = v[i];
    const Point& b = v[(i + 1) % v.size()];
    if (distance_sign(a, start, end, r) != Sign::positive || distance_sign(start, a, b, r) != Sign::positive ||
        distance_sign(end, a, b, r) != Sign::positive || cross_properly(a, b, start, end))
      return true;
  }
  return false;
}

bool segment_meets_exactly(const GrownShape& s, const Vector<Exact>& d, const Exact& t) {
  const Point start{Exact(0), Exact(0)}, end{t * d.x, t * d.y};
  if (const auto* disc = std::get_if<Disc>(&s.shape)) {
    const Exact reach = Exact(disc->radius) + Exact(s.radius);
    return distance_sign(difference<Exact>(disc->center, s.origin), start, end, reach) != Sign::positive;
  }
  if (const auto* e = std::get_if<Ellipse>(&s.shape)) {
    const bool stays = sign_of(end.x) == Sign::zero && sign_of(end.y) == Sign::zero;
    return stays ? locate_exactly(*e, s, end) != Place::outside : segment_meets_exactly(*e, s, d, t);
  }
  std::vector<Point> seen;
  for (const Vec2 v : corners_of(s.shape)) seen.push_back(difference<Exact>(v, s.origin));
  return hull_meets(seen, Exact(s.radius), end);
}

Exact beyond(const Vector<Exact>& d, double extent) {
  Exact t(1);
  const Exact reach = Exact(2) * Exact(extent);  // an extent that was rounded down is less than twice as large
  const auto is_beyond = [&](const Exact& c) { return !(c * t < reach) || !(Exact(0) - c * t < reach); };
  constexpr double kStep = 0x1p32;
  while (!is_beyond(d.x) && !is_beyond(d.y)) t = t * Exact(kStep);
  return t;
}

}  // namespace exactvo::geometry::detail
