// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmpxx.h>

#include <memory>
#include <utility>
#include <vector>

#include "membership/answers.h"

namespace exactvo::bench {
namespace {

using geometry::Ellipse;
using geometry::GrownShape;
using geometry::Vec2;
using Q = mpq_class;

// Written out here though the auditor of recordings has such lines: an oracle shares nothing with what it judges.
struct P {
  Q x, y;
};
P exactly(Vec2 v) {
  return {Q(v.x), Q(v.y)};
}
P operator-(const P& a, const P& b) {
  return {Q(a.x - b.x), Q(a.y - b.y)};
}
Q dot(const P& a, const P& b) {
  return a.x * b.x + a.y * b.y;
}
Q cross(const P& a, const P& b) {
  return a.x * b.y - a.y * b.x;
}

/// Sign of a + b sqrt(f).
int sign_with_root(const Q& a, const Q& b, const Q& f) {
  const int sa = sgn(a), sb = sgn(f) == 0 ? 0 : sgn(b);
  if (sa == sb || sb == 0) return sa;
  if (sa == 0) return sb;
  const int larger = cmp(Q(a * a), Q(b * b * f));
  return larger > 0 ? sa : larger < 0 ? sb : 0;
}

/// With the coefficients of the separation cubic x^3 + b x^2 + c x + d; d > 0.
bool is_outside(const Q& b, const Q& c, const Q& d) {
  if (sgn(b) >= 0 && sgn(c) >= 0) return false;
  return sgn(Q(18 * b * c * d - 4 * b * b * b * d + b * b * c * c - 4 * c * c * c - 27 * d * d)) > 0;
}

struct Rational {
  const GrownShape& s;
  P v;
  Q t_max;

  bool operator()(const geometry::Disc& d) const {
    const P p = exactly(d.center) - exactly(s.origin);
    const Q reach = Q(d.radius) + Q(s.radius);
    const Q r2 = reach * reach, speed2 = dot(v, v), c = cross(v, p), pv = dot(p, v);
    if (sgn(pv) <= 0) return dot(p, p) <= r2;
    if (pv >= t_max * speed2) {
      const P u{Q(p.x - t_max * v.x), Q(p.y - t_max * v.y)};
      return dot(u, u) <= r2;
    }
    return c * c <= r2 * speed2;
  }

  bool operator()(const Ellipse& e) const {
    const P p = exactly(e.center) - exactly(s.origin);
    const P n{Q(-v.y), v.x};
    const Q l11(e.l11), l21(e.l21), l22(e.l22), r(s.radius);
    const P ln{Q(l11 * n.x + l21 * n.y), Q(l22 * n.y)}, ld{Q(l11 * v.x + l21 * v.y), Q(l22 * v.y)};
    const Q speed2 = dot(v, v), b = dot(ln, ln), d = r * r * speed2, np = dot(n, p);
    // |np| <= sqrt(b) + sqrt(d)
    const Q rest = np * np - b - d;
    if (sgn(rest) > 0 && rest * rest > 4 * b * d) return false;
    const Q tilt = np * dot(ld, ln), f = b * d, pv = dot(p, v);
    if (sign_with_root(pv * b - tilt, pv, f) <= 0) return holds(e, p);
    const Q later = pv - t_max * speed2;
    if (sign_with_root(later * b - tilt, later, f) >= 0) return holds(e, {Q(p.x - t_max * v.x), Q(p.y - t_max * v.y)});
    return true;
  }

  bool operator()(const geometry::Segment& g) const { return polygon({g.a, g.b}); }
  bool operator()(const geometry::ConvexPolygon& p) const { return polygon(p.vertices); }

 private:
  bool holds(const Ellipse& e, const P& u) const {
    const Q l11(e.l11), l21(e.l21), l22(e.l22), R = Q(s.radius) * Q(s.radius);
    const Q trace = l11 * l11 + l21 * l21 + l22 * l22, det = l11 * l22, D = det * det;
    const Q x = l22 * u.x, y = l11 * u.y - l21 * u.x;
    const Q b = trace + R - dot(u, u), c = D + R * trace - (x * x + y * y), d = R * D;
    return !is_outside(b, c, d);
  }
  bool near(const P& q, const P& a, const P& b) const {
    const P e = b - a, d = q - a, f = q - b;
    const Q r2 = Q(s.radius) * Q(s.radius), along = dot(d, e), length2 = dot(e, e), c = cross(e, d);
    if (sgn(along) <= 0) return dot(d, d) <= r2;
    if (along >= length2) return dot(f, f) <= r2;
    return c * c <= r2 * length2;
  }
  bool holds_point(const std::vector<P>& p, const P& q) const {
    bool inside = p.size() > 2;
    for (std::size_t i = 0; i < p.size() && inside; ++i)
      inside = sgn(cross(p[(i + 1) % p.size()] - p[i], q - p[i])) > 0;
    if (inside) return true;
    for (std::size_t i = 0; i < p.size(); ++i)
      if (near(q, p[i], p[(i + 1) % p.size()])) return true;
    return false;
  }
  bool polygon(const std::vector<Vec2>& vertices) const {
    std::vector<P> p;
    for (const Vec2 x : vertices) p.push_back(exactly(x) - exactly(s.origin));
    const P start{0, 0}, end{Q(t_max * v.x), Q(t_max * v.y)};
    if (holds_point(p, start) || holds_point(p, end)) return true;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const P &a = p[i], &b = p[(i + 1) % p.size()];
      if (near(a, start, end)) return true;
      if (sgn(cross(b - a, start - a)) * sgn(cross(b - a, end - a)) < 0 && sgn(cross(end, a)) * sgn(cross(end, b)) < 0)
        return true;
    }
    return false;
  }
};

}  // namespace

namespace {

/// Every sign of predicate B2, then the answer: is the start in S, is the end, does the line meet S between the two?
struct Naive {
  const GrownShape& s;
  P v;
  Q t_max;

  bool operator()(const geometry::Disc& d) const {
    const P p = exactly(d.center) - exactly(s.origin);
    const Q reach = Q(d.radius) + Q(s.radius), r2 = reach * reach, speed2 = dot(v, v), c = cross(v, p), pv = dot(p, v);
    const P u{Q(p.x - t_max * v.x), Q(p.y - t_max * v.y)};
    const bool start = dot(p, p) <= r2, end = dot(u, u) <= r2, line = c * c <= r2 * speed2;
    const bool after = sgn(pv) > 0, before = pv < t_max * speed2;
    return start || end || (line && after && before);
  }
  bool operator()(const Ellipse& e) const {
    const P p = exactly(e.center) - exactly(s.origin), n{Q(-v.y), v.x};
    const Q l11(e.l11), l21(e.l21), l22(e.l22), r(s.radius);
    const P ln{Q(l11 * n.x + l21 * n.y), Q(l22 * n.y)}, ld{Q(l11 * v.x + l21 * v.y), Q(l22 * v.y)};
    const Q speed2 = dot(v, v), b = dot(ln, ln), d = r * r * speed2, np = dot(n, p), rest = np * np - b - d;
    const bool line = sgn(rest) <= 0 || rest * rest <= 4 * b * d;
    const Q tilt = np * dot(ld, ln), f = b * d, pv = dot(p, v), later = pv - t_max * speed2;
    const bool after = sign_with_root(pv * b - tilt, pv, f) > 0;
    const bool before = sign_with_root(later * b - tilt, later, f) < 0;
    const bool start = holds(e, p), end = holds(e, {Q(p.x - t_max * v.x), Q(p.y - t_max * v.y)});
    return start || end || (line && after && before);
  }
  bool operator()(const geometry::Segment& g) const { return Rational{s, v, t_max}(g); }
  bool operator()(const geometry::ConvexPolygon& p) const { return Rational{s, v, t_max}(p); }

 private:
  bool holds(const Ellipse& e, const P& u) const {
    const Q l11(e.l11), l21(e.l21), l22(e.l22), R = Q(s.radius) * Q(s.radius);
    const Q trace = l11 * l11 + l21 * l21 + l22 * l22, det = l11 * l22, D = det * det;
    const Q x = l22 * u.x, y = l11 * u.y - l21 * u.x;
    const Q b = trace + R - dot(u, u), c = D + R * trace - (x * x + y * y), d = R * D;
    const Q discriminant = 18 * b * c * d - 4 * b * b * b * d + b * b * c * c - 4 * c * c * c - 27 * d * d;
    return (sgn(b) >= 0 && sgn(c) >= 0) || sgn(discriminant) <= 0;
  }
};

}  // namespace

bool naive_meets(const GrownShape& s, Vec2 v, double t_max) {
  return std::visit(Naive{s, exactly(v), Q(t_max)}, s.shape);
}

bool rational_meets(const GrownShape& s, Vec2 v, double t_max) {
  return std::visit(Rational{s, exactly(v), Q(t_max)}, s.shape);
}

}  // namespace exactvo::bench
