// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/support.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

// The error bound. With u = 2^-53 and every operation rounded once:
//   d = fl(c - o)           relative error u;
//   n.d                     two products and a sum on top: 4 u (|nx dx| + |ny dy|) to first order;
//   |L^T n|                 two products, a sum, squares, a sum and a root: 6 u (|l11 nx| + |l21 ny| + |l22 ny|);
//   r |n|                   5 u r |n|;
//   adding the three        2 u of the partial sums.
// Together at most 9 u H; kSupportError = 16 u leaves 7 u for second-order terms and for H being rounded itself.

SupportValue linear_term(Vec2 n, Vec2 d) {
  return {n.x * d.x + n.y * d.y, std::fabs(n.x * d.x) + std::fabs(n.y * d.y)};
}

SupportValue farthest_vertex(const Vec2* first, const Vec2* last, Vec2 origin, Vec2 n) {
  SupportValue best = linear_term(n, *first - origin);
  // The error of the maximum is at most the largest error of a candidate, so the largest magnitude stands for all.
  for (const Vec2* v = first + 1; v != last; ++v) {
    const SupportValue t = linear_term(n, *v - origin);
    best.h = std::max(best.h, t.h);
    best.magnitude = std::max(best.magnitude, t.magnitude);
  }
  return best;
}

SupportValue shape_terms(const Disc& d, Vec2 origin, Vec2 n) {
  const SupportValue t = linear_term(n, d.center - origin);
  const double grown = d.radius * std::sqrt(squared_norm(n));
  return {t.h + grown, t.magnitude + grown};
}

SupportValue shape_terms(const Segment& s, Vec2 origin, Vec2 n) {
  const Vec2 ends[2] = {s.a, s.b};
  return farthest_vertex(ends, ends + 2, origin, n);
}

SupportValue shape_terms(const ConvexPolygon& p, Vec2 origin, Vec2 n) {
  return farthest_vertex(p.vertices.data(), p.vertices.data() + p.vertices.size(), origin, n);
}

SupportValue shape_terms(const Ellipse& e, Vec2 origin, Vec2 n) {
  const SupportValue t = linear_term(n, e.center - origin);
  const double wx = e.l11 * n.x + e.l21 * n.y;
  const double wy = e.l22 * n.y;
  return {t.h + std::sqrt(wx * wx + wy * wy),
          t.magnitude + std::fabs(e.l11 * n.x) + std::fabs(e.l21 * n.y) + std::fabs(wy)};
}

Vec2 farthest_point(const Disc& d, Vec2 n) {
  return d.center + d.radius * normalized(n);
}
Vec2 farthest_point(const Segment& s, Vec2 n) {
  return dot(n, s.a) >= dot(n, s.b) ? s.a : s.b;
}
Vec2 farthest_point(const ConvexPolygon& p, Vec2 n) {
  return *std::max_element(p.vertices.begin(), p.vertices.end(), [n](Vec2 a, Vec2 b) { return dot(n, a) < dot(n, b); });
}
Vec2 farthest_point(const Ellipse& e, Vec2 n) {
  const Vec2 w = normalized({e.l11 * n.x + e.l21 * n.y, e.l22 * n.y});
  return e.center + Vec2{e.l11 * w.x, e.l21 * w.x + e.l22 * w.y};
}

}  // namespace

SupportValue support(const GrownShape& s, Vec2 n) {
  const SupportValue t = std::visit([&](const auto& shape) { return shape_terms(shape, s.origin, n); }, s.shape);
  const double grown = s.radius * std::sqrt(squared_norm(n));
  return {t.h + grown, t.magnitude + grown};
}

Vec2 support_point(const GrownShape& s, Vec2 n) {
  const Vec2 p = std::visit([n](const auto& shape) { return farthest_point(shape, n); }, s.shape);
  return (p - s.origin) + s.radius * normalized(n);
}

double support_upper_bound(const GrownShape& s, Vec2 n) {
  const SupportValue v = support(s, n);
  // One more multiple of u for the additions of the bound itself.
  return v.h + (kSupportError * v.magnitude + kSupportUnderflow);
}

}  // namespace exactvo::geometry
