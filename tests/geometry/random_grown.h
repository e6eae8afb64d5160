// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random and constructed obstacles for the tests of predicates and velocity obstacles.

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "support/seeded_random.h"

namespace exactvo::test {

enum class Kind { disc, segment, polygon, ellipse };
inline constexpr Kind kKinds[] = {Kind::disc, Kind::segment, Kind::polygon, Kind::ellipse};

/// Vertices on an ellipse; tiny ones far away are rounded to a grid, so the hull is taken.
inline geometry::ConvexPolygon random_convex_polygon(SeededRandom& random, geometry::Vec2 centre, double size,
                                                     int count) {
  geometry::ConvexPolygon polygon;
  const double aspect = random.uniform(0.05, 1.0);
  const double turn = random.uniform(0.0, 6.28);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * 3.14159265358979 * (i + random.uniform(0.05, 0.75)) / count;
    polygon.vertices.push_back(centre +
                               geometry::rotated({size * std::cos(angle), aspect * size * std::sin(angle)}, turn));
  }
  return geometry::convex_hull(polygon.vertices);
}

inline geometry::ConvexShape random_shape(SeededRandom& random, Kind kind, geometry::Vec2 centre, double size) {
  switch (kind) {
    case Kind::disc:
      return geometry::Disc{centre, size * random.uniform(0.1, 1.0)};
    case Kind::segment: {
      const geometry::Vec2 half = size * random.direction();
      return geometry::Segment{centre - half, centre + half};
    }
    case Kind::polygon:
      return random_convex_polygon(random, centre, size, random.integer(3, 9));
    case Kind::ellipse:
      break;
  }
  const double flat = std::pow(10.0, random.uniform(-4.0, 0.0));
  return geometry::ellipse_from_axes(centre, {size, flat * size, random.uniform(-1.5, 1.5)});
}

/// S at a distance of about `gap` from the robot; some tiny, some huge, some far from the origin of coordinates.
struct RandomScene {
  geometry::GrownShape s;
  double size;  ///< of the obstacle, m
};
inline RandomScene random_scene(SeededRandom& random, Kind kind) {
  const int scale = random.integer(0, 3);
  const double size = scale == 0 ? 1e-3 : scale == 1 ? 1e3 : 1.0;
  const geometry::Vec2 origin = random.integer(0, 3) == 0 ? random.in_box(1e6) : random.in_box(5.0);
  const double radius = random.integer(0, 4) == 0 ? 0.0 : size * random.uniform(0.05, 0.6);
  const double gap = size * std::pow(10.0, random.uniform(-6.0, 1.0));
  const geometry::Vec2 centre = origin + (size + radius + gap) * random.direction();
  return {{random_shape(random, kind, centre, size), origin, radius}, size};
}

/// A unit vector with rational coordinates: (p, q) / h.
struct Pythagorean {
  double p, q, h;
};
inline Pythagorean random_pythagorean(SeededRandom& random) {
  const int m = random.integer(2, 9);
  const int n = random.integer(1, m - 1);
  const double p = m * m - n * n, q = 2.0 * m * n, h = m * m + n * n;
  return {random.integer(0, 1) != 0 ? p : -p, random.integer(0, 1) != 0 ? q : -q, h};
}

/// An ellipse (+) disc and a point on its boundary with the outward normal there, all small integers times a power of
/// two, so that the contact is exact: with (s, t)/g and (p, q)/h Pythagorean, L^T (p, q) = g p q m h (s, t)/g.
struct TangentCase {
  geometry::GrownShape s;
  geometry::Vec2 touch;   ///< seen from s.origin
  geometry::Vec2 normal;  ///< (p, q), of length h
  double support;         ///< h_S(normal)
};
inline TangentCase random_tangent_ellipse(SeededRandom& random) {
  const Pythagorean n = random_pythagorean(random);
  const Pythagorean w = random_pythagorean(random);
  const double m = random.integer(1, 3), j = random.integer(-5, 5);
  const double l22 = n.p * m * w.q * n.h, l21 = n.p * j, l11 = n.q * m * w.p * n.h - n.q * j;
  const double unit = w.h * n.h * std::ldexp(1.0, random.integer(-24, 4) - 20);
  const double r = random.integer(0, 60) * std::ldexp(1.0, 5);
  const double cx = random.integer(-4000, 4000), cy = random.integer(-4000, 4000);
  const double step = unit / (w.h * n.h);
  // |L^T n| = w.h n.q n.p m before scaling by `unit`; it must be positive for T = L (w.p, w.q) / w.h to attain h.
  const double sign = n.q * n.p > 0 ? 1.0 : -1.0;
  const geometry::Vec2 top{sign * l11 * w.p * n.h, sign * (l21 * w.p + l22 * w.q) * n.h};  // in steps
  TangentCase out;
  out.s.shape = geometry::Ellipse{{cx * unit, cy * unit}, l11 * unit, l21 * unit, l22 * unit};
  out.s.radius = r * unit;
  out.normal = {n.p, n.q};
  out.touch = {cx * unit + (top.x + r * n.p * w.h) * step, cy * unit + (top.y + r * n.q * w.h) * step};
  out.support = geometry::dot(out.normal, out.touch);
  return out;
}

}  // namespace exactvo::test
