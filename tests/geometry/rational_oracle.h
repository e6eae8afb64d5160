// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Plane geometry in plain rationals, without any filter: slow, short and independent of the library's own arithmetic.

#include <CGAL/Gmpq.h>

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::test {

using Rational = CGAL::Gmpq;

struct RationalPoint {
  Rational x;
  Rational y;
};

inline RationalPoint rational(geometry::Vec2 p) {
  return {Rational(p.x), Rational(p.y)};
}

inline Rational cross(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

inline int turn(geometry::Vec2 a, geometry::Vec2 b, geometry::Vec2 c) {
  return static_cast<int>(CGAL::sign(cross(rational(a), rational(b), rational(c))));
}

inline bool on_segment(const geometry::Segment& s, geometry::Vec2 x) {
  const auto a = rational(s.a), b = rational(s.b), p = rational(x);
  const Rational along = (p.x - a.x) * (p.x - b.x) + (p.y - a.y) * (p.y - b.y);
  return turn(s.a, s.b, x) == 0 && along <= 0;
}

/// Whether the closed segments meet.
inline bool segments_meet(const geometry::Segment& s, const geometry::Segment& t) {
  if (on_segment(s, t.a) || on_segment(s, t.b) || on_segment(t, s.a) || on_segment(t, s.b)) return true;
  return turn(s.a, s.b, t.a) * turn(s.a, s.b, t.b) < 0 && turn(t.a, t.b, s.a) * turn(t.a, t.b, s.b) < 0;
}

/// Whether they have more than one point in common.
inline bool segments_overlap(const geometry::Segment& s, const geometry::Segment& t) {
  if (turn(s.a, s.b, t.a) != 0 || turn(s.a, s.b, t.b) != 0) return false;
  std::vector<geometry::Vec2> shared;
  const auto collect = [&](const geometry::Segment& u, geometry::Vec2 x) {
    if (!on_segment(u, x)) return;
    for (const auto y : shared) {
      if (x == y) return;
    }
    shared.push_back(x);
  };
  collect(s, t.a);
  collect(s, t.b);
  collect(t, s.a);
  collect(t, s.b);
  return shared.size() > 1;
}

inline Rational squared_distance(const geometry::Segment& s, geometry::Vec2 point) {
  const auto a = rational(s.a), b = rational(s.b), p = rational(point);
  const Rational dx = b.x - a.x, dy = b.y - a.y;
  const Rational length2 = dx * dx + dy * dy;
  Rational t = 0;
  if (length2 > 0) t = ((p.x - a.x) * dx + (p.y - a.y) * dy) / length2;
  if (t < 0) t = 0;
  if (t > 1) t = 1;
  const Rational ex = p.x - a.x - t * dx, ey = p.y - a.y - t * dy;
  return ex * ex + ey * ey;
}

/// Twice the signed area.
inline Rational doubled_area(const std::vector<geometry::Vec2>& ring) {
  Rational sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto a = rational(ring[i]), b = rational(ring[(i + 1) % ring.size()]);
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

/// Whether x lies in the closed ellipse: |adj(L)(x - c)|^2 <= det^2, and within the ellipse's box (for det = 0).
inline bool in_ellipse(const geometry::Ellipse& e, geometry::Vec2 x) {
  const auto c = rational(e.center), p = rational(x);
  const Rational ux = p.x - c.x, uy = p.y - c.y;
  const Rational a(e.l11), b(e.l21), d(e.l22);
  const Rational v = d * ux, w = a * uy - b * ux;
  if (v * v + w * w > a * a * d * d) return false;
  return ux * ux <= a * a && uy * uy <= b * b + d * d;
}

inline bool in_disc(const geometry::Disc& disc, geometry::Vec2 x) {
  const auto c = rational(disc.center), p = rational(x);
  const Rational dx = p.x - c.x, dy = p.y - c.y, r(disc.radius);
  return dx * dx + dy * dy <= r * r;
}

}  // namespace exactvo::test
