// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The questions of distance that routes ask. Exact: each is the sign (-1, 0 or 1) of a polynomial in the coordinates,
/// so that no square root is taken; `sign_of` of exact_point.h evaluates it with a running error bound first. Lengths r
/// are doubles >= 0.

#include "routes/exact_point.h"

namespace exactvo::geometry::routing {

using detail::squared;

/// The turn a -> b -> c: 1 to the left.
inline int orient(const Point& a, const Point& b, const Point& c) {
  return sign_of([&](auto to) -> NumberOf<decltype(to)> { return cross(to(b) - to(a), to(c) - to(a)); });
}

/// The sign of (p - q).(b - a): whether p lies beyond q along ab.
inline int along(const Point& p, const Point& q, const Point& a, const Point& b) {
  return sign_of([&](auto to) -> NumberOf<decltype(to)> { return dot(to(p) - to(q), to(b) - to(a)); });
}

/// |pq|^2 against k r^2.
inline int compare_distance(const Point& p, const Point& q, double r, double k = 1.0) {
  return sign_of([&](auto to) -> NumberOf<decltype(to)> {
    const auto d = to(p) - to(q);
    return dot(d, d) - to(k) * squared(to(r));
  });
}

/// The squared distance of p to the line ab against k r^2.
inline int compare_line_distance(const Point& p, const Point& a, const Point& b, double r, double k = 1.0) {
  return sign_of([&](auto to) -> NumberOf<decltype(to)> {
    const auto d = to(b) - to(a);
    return squared(cross(d, to(p) - to(a))) - to(k) * squared(to(r)) * dot(d, d);
  });
}

/// The distance of p to the segment ab against r.
inline int compare_segment_distance(const Point& p, const Point& a, const Point& b, double r) {
  if (along(p, a, a, b) <= 0) return compare_distance(p, a, r);
  if (along(p, b, a, b) >= 0) return compare_distance(p, b, r);
  return compare_line_distance(p, a, b, r);
}

/// Whether p is too near to the segment ab for a disc of radius r: nearer than r, or in contact where that is 0.
inline bool is_too_near(const Point& p, const Point& a, const Point& b, double r) {
  const int sign = compare_segment_distance(p, a, b, r);
  return r > 0.0 ? sign < 0 : sign <= 0;
}

/// Whether the segments pq and ab cross in a point that is interior to both.
inline bool cross_properly(const Point& p, const Point& q, const Point& a, const Point& b) {
  return orient(p, q, a) * orient(p, q, b) < 0 && orient(a, b, p) * orient(a, b, q) < 0;
}

/// Whether the segments pq and ab touch, and not only at an end of pq that may (`p_may`, `q_may`).
inline bool touch(const Point& p, const Point& q, const Point& a, const Point& b, bool p_may, bool q_may) {
  const auto is_same = [](const Point& x, const Point& y) { return compare_distance(x, y, 0.0) == 0; };
  const auto lies_on = [](const Point& x, const Point& from, const Point& to) {
    return compare_segment_distance(x, from, to, 0.0) <= 0;
  };
  const bool p_on = lies_on(p, a, b), q_on = lies_on(q, a, b);
  if ((p_on && !p_may) || (q_on && !q_may)) return true;
  if (p_on && q_on && !is_same(p, q)) return true;
  // Where they have more than one point in common, each end of that part is an end of one of them.
  const auto touches_inside = [&](const Point& x) {
    return lies_on(x, p, q) && !(p_may && is_same(x, p)) && !(q_may && is_same(x, q));
  };
  return touches_inside(a) || touches_inside(b) || cross_properly(p, q, a, b);
}

/// Whether the segment pq keeps a distance of at least r from the segment ab; where r is 0, whether they do not touch.
inline bool keeps_clear(const Point& p, const Point& q, const Point& a, const Point& b, double r) {
  // Most pairs that do not touch lie on one side of the line of one of them.
  if (r == 0.0 && (orient(p, q, a) * orient(p, q, b) > 0 || orient(a, b, p) * orient(a, b, q) > 0)) return true;
  return !is_too_near(p, a, b, r) && !is_too_near(q, a, b, r) && !is_too_near(a, p, q, r) && !is_too_near(b, p, q, r) &&
         !cross_properly(p, q, a, b);
}

}  // namespace exactvo::geometry::routing
