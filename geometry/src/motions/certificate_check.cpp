// SPDX-License-Identifier: GPL-3.0-or-later
// The check of motion certificates, in rationals. It shares nothing with what decides motions but the plain types: the
// position at a time comes from the definitions (de Casteljau, de Boor, Horner), and Bernstein coefficients of a
// polynomial from its values.
#include <gmpxx.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/require.h"
#include "motions/certificate_pairs.h"

namespace exactvo::geometry {
namespace motion_check {
namespace {

using Number = mpq_class;

struct Place {
  Number x, y;
};
Place exactly(Vec2 v) {
  return {Number(v.x), Number(v.y)};
}
Place between(const Place& a, const Place& b, const Number& share) {
  return {Number(a.x + share * (b.x - a.x)), Number(a.y + share * (b.y - a.y))};
}

/// The point at u in [0, 1] of a Bezier curve (`spline` false) or of a uniform B-spline with these control points.
Place on_curve(const std::vector<Vec2>& points, bool spline, const Number& u) {
  std::vector<Place> d;
  for (const Vec2 p : points) d.push_back(exactly(p));
  for (std::size_t width = d.size() - 1; width > 0; --width)
    for (std::size_t i = 0; i < width; ++i) {
      // Knots of the spline: a level of `width` blends over that many intervals, i of them after u's own.
      const Number share =
          spline ? Number((u + Number(static_cast<long>(width - 1 - i))) / static_cast<long>(width)) : u;
      d[i] = between(d[i], d[i + 1], share);
    }
  return d[0];
}

Place at(const Motion& motion, const Number& time, const Number& share) {
  const Number start(start_of(motion)), end(end_of(motion));
  const Number u = start == end ? share : Number((time - start) / (end - start));
  if (const auto* straight = std::get_if<StraightMotion>(&motion))
    return between(exactly(straight->from.at), exactly(straight->to.at), u);
  const auto& curve = std::get<CurvedMotion>(motion);
  if (curve.basis != CurveBasis::powers) return on_curve(curve.points, curve.basis == CurveBasis::b_spline, u);
  Place p{Number(0), Number(0)};
  for (std::size_t k = curve.points.size(); k-- > 0;) {
    p.x = p.x * (time - start) + Number(curve.points[k].x);
    p.y = p.y * (time - start) + Number(curve.points[k].y);
  }
  return p;
}

std::size_t degree_of(const Motion& motion) {
  const auto* curve = std::get_if<CurvedMotion>(&motion);
  return curve ? curve->points.size() - 1 : 1;
}

/// The Bernstein coefficients of the polynomial of degree d with these values at 0, 1/d, ..., 1: by elimination.
std::vector<Number> bernstein(std::vector<Number> values) {
  const std::size_t n = values.size();
  if (n == 1) return values;
  std::vector<std::vector<Number>> rows(n, std::vector<Number>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const Number s(static_cast<long>(i), static_cast<long>(n - 1));
    // Row of the basis at s: choose(d, k) s^k (1 - s)^(d - k), by de Casteljau on unit vectors.
    std::vector<Number> basis(n);
    basis[0] = 1;
    for (std::size_t level = 1; level < n; ++level)
      for (std::size_t k = level + 1; k-- > 0;)
        basis[k] = Number((1 - s) * basis[k] + (k > 0 ? Number(s * basis[k - 1]) : Number(0)));
    rows[i] = std::move(basis);
  }
  for (std::size_t pivot = 0; pivot < n; ++pivot) {
    std::size_t best = pivot;
    while (sgn(rows[best][pivot]) == 0) ++best;  // the basis is independent
    std::swap(rows[pivot], rows[best]);
    std::swap(values[pivot], values[best]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == pivot || sgn(rows[i][pivot]) == 0) continue;
      const Number factor = rows[i][pivot] / rows[pivot][pivot];
      for (std::size_t k = pivot; k < n; ++k) rows[i][k] -= factor * rows[pivot][k];
      values[i] -= factor * values[pivot];
    }
  }
  for (std::size_t i = 0; i < n; ++i) values[i] /= rows[i][i];
  return values;
}

bool are_finite(const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), is_finite);
}
void require(const Motion& motion) {
  const double start = start_of(motion), end = end_of(motion);
  EXACTVO_REQUIRE(std::isfinite(start) && std::isfinite(end) && start <= end, hex_text(start) + " " + hex_text(end));
  const auto* straight = std::get_if<StraightMotion>(&motion);
  const std::vector<Vec2> points =
      straight ? std::vector<Vec2>{straight->from.at, straight->to.at} : std::get<CurvedMotion>(motion).points;
  EXACTVO_REQUIRE(!points.empty() && are_finite(points), excerpt(points));
}
void require(const RigidBody& body) {
  for (const RoundedPolygon& part : body)
    EXACTVO_REQUIRE(
        part.radius >= 0.0 && std::isfinite(part.radius) && !part.corners.empty() && are_finite(part.corners),
        hex_text(part.radius) + " " + excerpt(part.corners));
}

class Check {
 public:
  Check(const Motion& a, const Motion* b) : a_(a), b_(b), from_(start_of(a)), to_(end_of(a)) {
    degree_ = std::max<std::size_t>(1, degree_of(a));
    if (!b) return;
    from_ = std::max(from_, start_of(*b));
    to_ = std::min(to_, end_of(*b));
    degree_ = std::max(degree_, degree_of(*b));
  }

  double from() const { return from_; }
  double to() const { return to_; }

  bool separates(const Separation& s, const RoundedPolygon& part, const std::vector<Vec2>& other, double radius) const {
    const bool finite = is_finite(s.direction) && std::isfinite(s.margin) && s.margin >= 0.0;
    if (!finite || s.direction == Vec2{}) return false;
    const Place n = exactly(s.direction);
    std::vector<Number> values;
    for (std::size_t i = 0; i <= degree_; ++i) {
      const Number share(static_cast<long>(i), static_cast<long>(degree_));
      const Number time = Number(s.from) + share * (Number(s.to) - Number(s.from));
      Place p = at(a_, time, share);
      if (b_) {
        const Place q = at(*b_, time, share);
        p = {Number(p.x - q.x), Number(p.y - q.y)};
      }
      values.emplace_back(n.x * p.x + n.y * p.y);
    }
    const std::vector<Number> coefficients = bernstein(std::move(values));
    Number gap = *std::min_element(coefficients.begin(), coefficients.end());
    bool first = true;
    Number most;
    for (const Vec2 v : other)
      for (const Vec2 w : part.corners) {
        const Number along = n.x * (Number(v.x) - Number(w.x)) + n.y * (Number(v.y) - Number(w.y));
        if (first || along > most) most = along;
        first = false;
      }
    gap -= most;
    const Number reach = Number(part.radius) + Number(radius) + Number(s.margin);
    // More than the reach, or as much with a margin: touching is not clear.
    const Number left = gap * gap, right = reach * reach * (n.x * n.x + n.y * n.y);
    return sgn(gap) > 0 && (s.margin > 0.0 ? left >= right : left > right);
  }

  /// Whether the part's first corner begins inside.
  bool begins_inside(const RoundedPolygon& part, const std::vector<Segment>& edges) const {
    const Place p = at(a_, Number(from_), Number(0));
    return is_inside(Number(p.x + Number(part.corners[0].x)), Number(p.y + Number(part.corners[0].y)), edges);
  }

 private:
  const Motion& a_;
  const Motion* b_;
  double from_, to_;
  std::size_t degree_ = 1;
};

}  // namespace
}  // namespace motion_check

bool proves_clear(const MotionCertificate& certificate, const Motion& a, const RigidBody& body_a, const Motion& b,
                  const RigidBody& body_b) {
  motion_check::require(a);
  motion_check::require(b);
  motion_check::require(body_a);
  motion_check::require(body_b);
  const motion_check::Check check(a, &b);
  return motion_check::all_hold(
      certificate, body_a.size(), body_b.size(), check.from(), check.to(), [&](const Separation& s) {
        return check.separates(s, body_a[s.part], body_b[s.other].corners, body_b[s.other].radius);
      });
}

bool proves_clear(const MotionCertificate& certificate, const Motion& a, const RigidBody& body_a,
                  const Obstacle& obstacle) {
  motion_check::require(a);
  motion_check::require(body_a);
  const motion_check::Check check(a, nullptr);
  const std::vector<Segment> edges = edges_of(obstacle);
  for (const Segment& e : edges) EXACTVO_REQUIRE(is_finite(e.a) && is_finite(e.b), excerpt({e.a, e.b}));
  if (has_interior(obstacle))
    for (const RoundedPolygon& part : body_a)
      if (check.begins_inside(part, edges)) return false;
  return motion_check::all_hold(certificate, body_a.size(), edges.size(), check.from(), check.to(),
                                [&](const Separation& s) {
                                  return check.separates(s, body_a[s.part], {edges[s.other].a, edges[s.other].b}, 0.0);
                                });
}

}  // namespace exactvo::geometry
