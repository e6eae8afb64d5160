// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A straight way against a convex hull that is grown by a reach: the sign of the least distance less the reach, over
/// any ring of numbers. A way of length 0 is a point. Unknown signs are told from known ones as late as possible.
///
///      +--------+
///      |  hull  | <- reach -> |   from ---------> to
///      +--------+
///
/// The least distance of a segment from the hull's boundary is attained at a vertex of one of them, or is 0 where two
/// edges cross. Against a hull with an area and no reach, depth counts: the greatest gap over the directions that can
/// separate a segment from a polygon (the normals of the hull's edges and of the way) has the right sign.

#include <algorithm>
#include <vector>

#include "motions/known_sign.h"

namespace exactvo::geometry::motions {

/// A convex hull: a point, a segment, or a polygon with an area, counter-clockwise without collinear vertices.
template <class T>
struct GrownHull {
  std::vector<Vector<T>> vertices;
  T reach;
};

/// sign(|p - [a, b]|^2 - reach2).
template <class T>
Known beside(const Vector<T>& p, const Vector<T>& a, const Vector<T>& b, const T& reach2) {
  const Vector<T> e = b - a, from_a = p - a;
  const T along = dot(from_a, e), length2 = dot(e, e);
  const Known past_a = sign_of(along), past_b = sign_of(T(along - length2));
  const auto round_a = [&] { return sign_of(T(dot(from_a, from_a) - reach2)); };
  const auto round_b = [&] {
    const Vector<T> from_b = p - b;
    return sign_of(T(dot(from_b, from_b) - reach2));
  };
  const auto round_line = [&] {
    const T across = cross(e, from_a);
    return sign_of(T(across * across - reach2 * length2));
  };
  if (past_a == Known::negative || past_a == Known::zero) return round_a();
  if (past_b == Known::positive || past_b == Known::zero) return round_b();
  const Known line = round_line();
  if (past_a == Known::positive && past_b == Known::negative) return line;
  // The line is never farther than [a, b], an end never nearer, and |p - a - s e|^2 >= |p - a|^2 - 2 s along.
  if (line == Known::positive) return line;
  const Known end_a = round_a();
  if (end_a == Known::negative || round_b() == Known::negative) return Known::negative;
  if (end_a != Known::positive) return Known::unknown;
  const T at_least = dot(from_a, from_a) - reach2 - T(2.0) * along;
  return sign_of(at_least) == Known::positive ? Known::positive : Known::unknown;
}

/// Whether the open segments [a, b] and [c, d] cross; unknown where that is not certain.
template <class T>
Known crossing(const Vector<T>& a, const Vector<T>& b, const Vector<T>& c, const Vector<T>& d) {
  const auto parted = [](Known x, Known y) {
    // Negative: on two sides; positive: not; unknown.
    if (x == Known::zero || y == Known::zero) return Known::positive;
    if (x == Known::unknown || y == Known::unknown) return Known::unknown;
    return x == y ? Known::positive : Known::negative;
  };
  const Vector<T> e = b - a, f = d - c;
  const Known first = parted(sign_of(cross(e, c - a)), sign_of(cross(e, d - a)));
  if (first == Known::positive) return first;
  return greatest(first, parted(sign_of(cross(f, a - c)), sign_of(cross(f, b - c))));
}

/// Whether an upright or a level line certainly keeps the hull farther than its reach from the way: a quick test.
template <class T>
bool parted_by_axis(const Vector<T>& from, const Vector<T>& to, const GrownHull<T>& hull) {
  const auto beyond = [&](const T& start, const T& end, const auto& coordinate, bool above) {
    return std::all_of(hull.vertices.begin(), hull.vertices.end(), [&](const Vector<T>& v) {
      const T& c = coordinate(v);
      return sign_of(T((above ? c - start : start - c) - hull.reach)) == Known::positive &&
             sign_of(T((above ? c - end : end - c) - hull.reach)) == Known::positive;
    });
  };
  const auto x = [](const Vector<T>& v) -> const T& { return v.x; };
  const auto y = [](const Vector<T>& v) -> const T& { return v.y; };
  return beyond(from.x, to.x, x, true) || beyond(from.x, to.x, x, false) || beyond(from.y, to.y, y, true) ||
         beyond(from.y, to.y, y, false);
}

/// The side of the hull's edge i on which p lies: positive is inside.
template <class T>
Known side_of_edge(const GrownHull<T>& hull, std::size_t i, const Vector<T>& p) {
  const Vector<T>& a = hull.vertices[i];
  const Vector<T>& b = hull.vertices[(i + 1) % hull.vertices.size()];
  return sign_of(cross(b - a, p - a));
}

/// Negative: p lies in the open hull; zero: on its boundary; positive: outside. REQUIRES: a hull with an area.
template <class T>
Known place_in(const GrownHull<T>& hull, const Vector<T>& p) {
  Known place = Known::negative;
  for (std::size_t i = 0; i < hull.vertices.size(); ++i) place = greatest(place, opposite(side_of_edge(hull, i, p)));
  return place;
}

/// The sign of the distance of a point from the hull, less the reach; where the reach is 0, inside is negative.
/// REQUIRES: the reach is not below 0.
template <class T>
Known point_gap(const Vector<T>& p, const GrownHull<T>& hull) {
  const T reach2 = hull.reach * hull.reach;
  const std::size_t n = hull.vertices.size();
  if (n == 1) {
    const Vector<T> off = p - hull.vertices[0];
    return sign_of(T(dot(off, off) - reach2));
  }
  if (n == 2) return beside(p, hull.vertices[0], hull.vertices[1], reach2);
  Known gap = place_in(hull, p);
  if (gap == Known::negative || sign_of(hull.reach) == Known::zero) return gap;
  if (gap == Known::zero) return Known::negative;
  for (std::size_t i = 0; i < n && gap != Known::negative; ++i)
    gap = least(gap, beside(p, hull.vertices[i], hull.vertices[(i + 1) % n], reach2));
  return gap;
}

/// The gap between the way and an open hull with an area, by separating directions.
template <class T>
Known gap_to_open_hull(const Vector<T>& from, const Vector<T>& to, const GrownHull<T>& hull) {
  if (place_in(hull, from) == Known::negative || place_in(hull, to) == Known::negative) return Known::negative;
  Known gap = Known::negative;
  for (std::size_t i = 0; i < hull.vertices.size() && gap != Known::positive; ++i) {
    const Known outside = opposite(greatest(side_of_edge(hull, i, from), side_of_edge(hull, i, to)));
    gap = greatest(gap, outside);
  }
  if (gap == Known::positive) return gap;
  const Vector<T> way = to - from;
  const Known moves = sign_of(dot(way, way));
  if (moves == Known::zero) return gap;
  Known left = Known::positive, right = Known::positive;
  for (const Vector<T>& v : hull.vertices) {
    const Known side = sign_of(cross(way, v - from));
    left = least(left, side);
    right = least(right, opposite(side));
  }
  const Known across = greatest(left, right);
  if (moves == Known::unknown && across != Known::positive) return Known::unknown;
  return greatest(gap, across);
}

/// The sign of the least distance of the way from the hull, less the reach. Where the reach is 0: zero for a way that
/// meets a hull without an area or only touches one with an area.
template <class T>
Known straight_gap(const Vector<T>& from, const Vector<T>& to, const GrownHull<T>& hull) {
  const Known reach = sign_of(hull.reach);
  if (reach == Known::negative) return Known::positive;
  if (reach == Known::unknown) return Known::unknown;
  const std::size_t n = hull.vertices.size();
  const T reach2 = hull.reach * hull.reach;
  if (n == 1) return beside(hull.vertices[0], from, to, reach2);
  if (parted_by_axis(from, to, hull)) return Known::positive;
  if (n > 2 && reach == Known::zero) return gap_to_open_hull(from, to, hull);
  Known gap = Known::positive;
  const std::size_t edges = n == 2 ? 1 : n;
  if (n > 2) gap = place_in(hull, from) == Known::negative ? Known::negative : gap;
  for (std::size_t i = 0; i < n && gap != Known::negative; ++i)
    gap = least(gap, beside(hull.vertices[i], from, to, reach2));
  for (std::size_t i = 0; i < edges && gap != Known::negative; ++i) {
    const Vector<T>& a = hull.vertices[i];
    const Vector<T>& b = hull.vertices[(i + 1) % n];
    gap = least(gap, least(beside(from, a, b, reach2), beside(to, a, b, reach2)));
    const Known crosses = crossing(from, to, a, b);
    if (crosses == Known::negative) gap = reach == Known::zero ? least(gap, Known::zero) : Known::negative;
    if (crosses == Known::unknown) gap = least(gap, Known::unknown);
  }
  if (n > 2 && gap == Known::positive && place_in(hull, from) == Known::unknown) gap = Known::unknown;
  return gap;
}

}  // namespace exactvo::geometry::motions
