// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/exact_shapes.h"

#include <variant>

namespace exactvo::datasets::exact {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::Segment;

Rational squared(const Rational& x) {
  return x * x;
}

bool is_on(const Point& a, const Point& b, const Point& p) {
  const Point e = b - a, d = p - a;
  if (sgn(cross(e, d)) != 0) return false;
  const Rational along = dot(e, d);
  return sgn(along) >= 0 && along <= dot(e, e) && (sgn(dot(e, e)) > 0 || sgn(dot(d, d)) == 0);
}

struct Contains {
  const Point& p;

  bool operator()(const Disc& disc) const {
    const Point d = p - exactly(disc.center);
    return dot(d, d) <= squared(Rational(disc.radius));
  }
  bool operator()(const Segment& s) const { return is_on(exactly(s.a), exactly(s.b), p); }
  bool operator()(const ConvexPolygon& polygon) const {
    bool is_flat = true;
    const std::size_t n = polygon.vertices.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Point a = exactly(polygon.vertices[k]), b = exactly(polygon.vertices[(k + 1) % n]);
      if (is_on(a, b, p)) return true;
      const int side = sgn(cross(b - a, p - a));
      if (side < 0) return false;
      is_flat = is_flat && side == 0;
    }
    return !is_flat;
  }
  /// p = centre + L w, |w| <= 1: with L's adjoint, |adj(L) d| <= |det L|.
  bool operator()(const Ellipse& e) const {
    const Point d = p - exactly(e.center);
    const Rational l11(e.l11), l21(e.l21), l22(e.l22);
    if (sgn(l11) != 0 && sgn(l22) != 0) {
      const Rational x = l22 * d.x, y = l11 * d.y - l21 * d.x;
      return x * x + y * y <= squared(l11 * l22);
    }
    // A segment from -(l11, l21) to (l11, l21), or, where l11 = 0, upright of half length sqrt(l21^2 + l22^2).
    if (sgn(l11) == 0) return sgn(d.x) == 0 && squared(d.y) <= squared(l21) + squared(l22);
    return is_on({Rational(-l11), Rational(-l21)}, {l11, l21}, d);
  }
};

/// sign(distance - r) of the boundary's nearest point or, of a disc, its own boundary; inside: negative.
struct CompareDistance {
  const Point& p;
  const Rational& r;

  int operator()(const Disc& disc) const {
    const Point d = p - exactly(disc.center);
    return cmp(dot(d, d), squared(r + Rational(disc.radius)));
  }
  int operator()(const Segment& s) const { return cmp(squared_distance(p, {exactly(s.a), exactly(s.b)}), squared(r)); }
  int operator()(const ConvexPolygon& polygon) const {
    if (Contains{p}(polygon)) return -1;
    const std::size_t n = polygon.vertices.size();
    int least = 1;
    for (std::size_t k = 0; k < n; ++k) {
      const Straight edge{exactly(polygon.vertices[k]), exactly(polygon.vertices[(k + 1) % n])};
      least = std::min(least, cmp(squared_distance(p, edge), squared(r)));
    }
    return least;
  }
  int operator()(const Ellipse&) const { return -1; }  // not asked
};

}  // namespace

bool contains(const geometry::ConvexShape& shape, const Point& p) {
  return std::visit(Contains{p}, shape);
}

bool is_within(const geometry::ConvexShape& shape, const Point& p, const Rational& r) {
  return std::visit(CompareDistance{p, r}, shape) <= 0;
}

bool is_clear(const geometry::ConvexShape& shape, const Point& p, const Rational& r) {
  return std::visit(CompareDistance{p, r}, shape) >= 0;
}

bool excludes_disc(const Point& centre, const Rational& reach, const Point& n, const Rational& offset,
                   const Rational& time) {
  const Rational most = sgn(offset) >= 0 ? Rational(0) : Rational(time * offset);
  const Rational left = most - dot(n, centre);  // reach |n| <= left
  return sgn(left) >= 0 && squared(reach) * dot(n, n) <= squared(left);
}

}  // namespace exactvo::datasets::exact
