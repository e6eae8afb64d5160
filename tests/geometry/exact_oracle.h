// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Oracles for the predicates in GMP rationals, by other ways than the library's: roots are bracketed ever more tightly
/// instead of squared away, distances to an ellipse come from its nearest point instead of a discriminant. Slow.
///
/// Neighbour: rational_oracle.h (rings, segments, containment).

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/support.h"

namespace exactvo::test {

using Q = mpq_class;

struct QPoint {
  Q x, y;
};

inline QPoint exactly(geometry::Vec2 p) {
  return {Q(p.x), Q(p.y)};
}
inline QPoint minus(const QPoint& a, const QPoint& b) {
  return {Q(a.x - b.x), Q(a.y - b.y)};
}
inline Q dot(const QPoint& a, const QPoint& b) {
  return a.x * b.x + a.y * b.y;
}
inline Q cross(const QPoint& a, const QPoint& b) {
  return a.x * b.y - a.y * b.x;
}
inline Q square(const Q& x) {
  return x * x;
}

/// low <= sqrt(x) <= high, `bits` significant bits; low == high where the root is a dyadic number of that many bits.
inline std::pair<Q, Q> root_bracket(const Q& x, unsigned bits) {
  if (sgn(x) == 0) return {Q(0), Q(0)};
  const long size = static_cast<long>(mpz_sizeinbase(x.get_num().get_mpz_t(), 2)) -
                    static_cast<long>(mpz_sizeinbase(x.get_den().get_mpz_t(), 2));
  const long shift = static_cast<long>(bits) + std::labs(size);
  mpz_class scaled = (x.get_num() << static_cast<unsigned long>(2 * shift));
  mpz_class whole, rest, root, left;
  mpz_fdiv_qr(whole.get_mpz_t(), rest.get_mpz_t(), scaled.get_mpz_t(), x.get_den().get_mpz_t());
  mpz_sqrtrem(root.get_mpz_t(), left.get_mpz_t(), whole.get_mpz_t());
  const mpz_class one = mpz_class(1) << static_cast<unsigned long>(shift);
  Q low(root, one);
  low.canonicalize();
  if (sgn(rest) == 0 && sgn(left) == 0) return {low, low};
  Q high(mpz_class(root + 1), one);
  high.canonicalize();
  return {low, high};
}

/// Sign of k + sqrt(b) + sqrt(d). Ends: a sum of two roots is rational only if both roots are.
inline int sign_of_root_sum(const Q& k, const Q& b, const Q& d) {
  for (unsigned bits = 64;; bits *= 2) {
    const auto [b_low, b_high] = root_bracket(b, bits);
    const auto [d_low, d_high] = root_bracket(d, bits);
    const Q low = k + b_low + d_low, high = k + b_high + d_high;
    if (sgn(low) > 0 || sgn(high) < 0 || low == high) return sgn(low);
  }
}

/// Sign of h_S(n) - bound, by the definition of the support function.
inline int sign_of_support_minus(const geometry::GrownShape& s, const QPoint& n, const Q& bound) {
  const QPoint o = exactly(s.origin);
  const Q n2 = dot(n, n), r(s.radius);
  const auto at = [&](geometry::Vec2 x) { return Q(dot(n, minus(exactly(x), o)) - bound); };
  if (const auto* d = std::get_if<geometry::Disc>(&s.shape)) {
    return sign_of_root_sum(at(d->center), Q(0), square(Q(d->radius) + r) * n2);
  }
  if (const auto* e = std::get_if<geometry::Ellipse>(&s.shape)) {
    const Q wx = Q(e->l11) * n.x + Q(e->l21) * n.y, wy = Q(e->l22) * n.y;
    return sign_of_root_sum(at(e->center), square(wx) + square(wy), square(r) * n2);
  }
  std::vector<geometry::Vec2> vertices;
  if (const auto* g = std::get_if<geometry::Segment>(&s.shape)) {
    vertices = {g->a, g->b};
  } else {
    vertices = std::get<geometry::ConvexPolygon>(s.shape).vertices;
  }
  Q best = at(vertices.front());
  for (const geometry::Vec2 v : vertices) best = std::max(best, at(v));
  return sign_of_root_sum(best, Q(0), square(r) * n2);
}

/// Whether { v : normal.v >= offset } is disjoint from the interior of the velocity obstacle with horizon tau.
inline bool is_safe(const geometry::GrownShape& s, double tau, const geometry::HalfPlane& h) {
  const QPoint n = exactly(h.normal);
  if (h.normal == geometry::Vec2{}) return h.offset > 0.0;
  return sign_of_support_minus(s, n, Q(0)) <= 0 && sign_of_support_minus(s, n, Q(tau) * Q(h.offset)) <= 0;
}

inline Q squared_distance_to_segment(const QPoint& p, const QPoint& a, const QPoint& b) {
  const QPoint e = minus(b, a), d = minus(p, a);
  const Q length2 = dot(e, e);
  Q t = sgn(length2) > 0 ? Q(dot(d, e) / length2) : Q(0);
  t = std::min(std::max(t, Q(0)), Q(1));
  return square(d.x - t * e.x) + square(d.y - t * e.y);
}

/// Whether p lies in the closed hull of counter-clockwise vertices that have an area.
inline bool in_hull(const std::vector<QPoint>& v, const QPoint& p) {
  Q area = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const QPoint& a = v[i];
    const QPoint& b = v[(i + 1) % v.size()];
    if (sgn(cross(minus(b, a), minus(p, a))) < 0) return false;
    area += cross(a, b);
  }
  return sgn(area) > 0;
}

inline Q squared_distance_of_segments(const QPoint& a, const QPoint& b, const QPoint& c, const QPoint& d) {
  const QPoint e = minus(b, a), f = minus(d, c);
  const Q denominator = cross(e, f);
  if (sgn(denominator) != 0) {
    const Q s = cross(minus(c, a), f) / denominator, t = cross(minus(c, a), e) / denominator;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) return Q(0);
  }
  return std::min({squared_distance_to_segment(a, c, d), squared_distance_to_segment(b, c, d),
                   squared_distance_to_segment(c, a, b), squared_distance_to_segment(d, a, b)});
}

/// Squared distance between the segment [a, b] and the hull of the vertices.
inline Q squared_distance_to_hull(const std::vector<QPoint>& v, const QPoint& a, const QPoint& b) {
  if (in_hull(v, a)) return Q(0);
  Q best = squared_distance_of_segments(a, b, v[0], v[v.size() > 1 ? 1 : 0]);
  for (std::size_t i = 1; i < v.size(); ++i)
    best = std::min(best, squared_distance_of_segments(a, b, v[i], v[(i + 1) % v.size()]));
  return best;
}

/// The nearest point of a non-degenerate ellipse to u (seen from its centre) is x(t) = Sigma (Sigma + t)^-1 u for the t
/// at which x(t) lies on the boundary; |u - x(t)| grows with t, so a bracket of t brackets the distance.
class EllipseDistance {
 public:
  EllipseDistance(const geometry::Ellipse& e, QPoint u)
      : s11_(Q(e.l11) * Q(e.l11)),
        s12_(Q(e.l11) * Q(e.l21)),
        s22_(Q(e.l21) * Q(e.l21) + Q(e.l22) * Q(e.l22)),
        u_(std::move(u)) {}

  bool holds_point() const { return level(Q(0)) <= 1; }
  bool on_boundary() const { return level(Q(0)) == 1; }

  /// Sign of dist - r for a point outside the ellipse; 0 after a bracket of `steps` halvings still holds r.
  int compare(const Q& r, int steps = 300) const {
    const Q r2 = r * r;
    Q low = 0, high = 1;
    while (level(high) > 1) high *= 2;
    for (int i = 0; i < steps; ++i) {
      const Q t = (low + high) / 2;
      const Q at = level(t), d2 = squared_offset(t);
      if (at == 1) return cmp(d2, r2) > 0 ? 1 : cmp(d2, r2) < 0 ? -1 : 0;
      if (at > 1) {
        low = t;
        if (d2 > r2) return 1;
      } else {
        high = t;
        if (d2 < r2) return -1;
      }
    }
    return 0;
  }

 private:
  QPoint solved(const Q& t) const {
    const Q a = s11_ + t, d = s22_ + t, det = a * d - s12_ * s12_;
    return {Q((d * u_.x - s12_ * u_.y) / det), Q((a * u_.y - s12_ * u_.x) / det)};
  }
  /// x(t) Sigma^-1 x(t): over 1 while x(t) is outside.
  Q level(const Q& t) const {
    const QPoint w = solved(t);
    return s11_ * w.x * w.x + 2 * s12_ * w.x * w.y + s22_ * w.y * w.y;
  }
  Q squared_offset(const Q& t) const {
    const QPoint w = solved(t);
    return t * t * dot(w, w);
  }

  Q s11_, s12_, s22_;
  QPoint u_;
};

/// Where a point (seen from the origin of S) lies: -1 inside, 0 boundary, 1 outside. Ellipses must have an area.
inline int place_in(const geometry::GrownShape& s, const QPoint& q) {
  const QPoint o = exactly(s.origin);
  const Q r(s.radius);
  const QPoint at{Q(q.x + o.x), Q(q.y + o.y)};
  if (const auto* d = std::get_if<geometry::Disc>(&s.shape)) {
    const QPoint u = minus(at, exactly(d->center));
    return sgn(Q(dot(u, u) - square(Q(d->radius) + r)));
  }
  if (const auto* e = std::get_if<geometry::Ellipse>(&s.shape)) {
    const EllipseDistance distance(*e, minus(at, exactly(e->center)));
    if (distance.holds_point()) return distance.on_boundary() && sgn(r) == 0 ? 0 : -1;
    return sgn(r) == 0 ? 1 : distance.compare(r);
  }
  std::vector<QPoint> v;
  if (const auto* g = std::get_if<geometry::Segment>(&s.shape)) {
    v = {exactly(g->a), exactly(g->b)};
  } else {
    for (const geometry::Vec2 x : std::get<geometry::ConvexPolygon>(s.shape).vertices) v.push_back(exactly(x));
  }
  const Q d2 = squared_distance_to_hull(v, at, at);
  if (sgn(d2) > 0) return sgn(Q(d2 - r * r));
  if (sgn(r) > 0) return -1;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (sgn(squared_distance_to_segment(at, v[i], v[(i + 1) % v.size()])) == 0) return 0;
  return -1;
}

}  // namespace exactvo::test
