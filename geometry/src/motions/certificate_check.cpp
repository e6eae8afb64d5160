// SPDX-License-Identifier: GPL-3.0-or-later
// The check of motion certificates, in rationals. It shares nothing with what decides motions but the plain types: the
// position at a time comes from the definitions (de Casteljau, de Boor, Horner), and Bernstein coefficients of a
// polynomial from its values.
#include <gmpxx.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/require.h"

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

void require(const Motion& motion) {
  EXACTVO_REQUIRE(start_of(motion) <= end_of(motion), hex_text(start_of(motion)) + " " + hex_text(end_of(motion)));
}
void require(const RigidBody& body) {
  for (const RoundedPolygon& part : body)
    EXACTVO_REQUIRE(part.radius >= 0.0 && !part.corners.empty(), hex_text(part.radius));
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

  /// Whether the part's first corner begins inside, by the even-odd rule.
  bool begins_inside(const RoundedPolygon& part, const std::vector<Segment>& edges) const {
    Place p = at(a_, Number(from_), Number(0));
    p = {Number(p.x + Number(part.corners[0].x)), Number(p.y + Number(part.corners[0].y))};
    bool inside = false;
    for (const Segment& e : edges) {
      const Place u = exactly(e.a), v = exactly(e.b);
      if ((u.y > p.y) == (v.y > p.y)) continue;
      if (p.x < u.x + (p.y - u.y) / (v.y - u.y) * (v.x - u.x)) inside = !inside;
    }
    return inside;
  }

 private:
  const Motion& a_;
  const Motion* b_;
  double from_, to_;
  std::size_t degree_ = 1;
};

/// Whether the separations are those of all pairs in turn, without a gap, and each is true. `others` gives the corners
/// and the radius of the other's part.
template <class Others>
bool all_hold(const Check& check, const MotionCertificate& certificate, const RigidBody& body, std::size_t count,
              const Others& others) {
  if (check.from() > check.to()) return certificate.separations.empty();
  std::size_t next = 0;
  for (std::size_t part = 0; part < body.size(); ++part) {
    for (std::size_t other = 0; other < count; ++other) {
      double reached = check.from();
      bool some = false;
      for (; next < certificate.separations.size() && !(some && reached == check.to()); ++next) {
        const Separation& s = certificate.separations[next];
        if (s.part != part || s.other != other || s.from != reached || !(s.to >= s.from && s.to <= check.to())) break;
        const auto [corners, radius] = others(other);
        if (!check.separates(s, body[part], corners, radius)) return false;
        reached = s.to;
        some = true;
      }
      if (!some || reached != check.to()) return false;
    }
  }
  return next == certificate.separations.size();
}

}  // namespace
}  // namespace motion_check

bool proves_clear(const MotionCertificate& certificate, const Motion& a, const RigidBody& body_a, const Motion& b,
                  const RigidBody& body_b) {
  motion_check::require(a);
  motion_check::require(b);
  motion_check::require(body_a);
  motion_check::require(body_b);
  const motion_check::Check check(a, &b);
  return motion_check::all_hold(check, certificate, body_a, body_b.size(), [&](std::size_t i) {
    return std::pair{body_b[i].corners, body_b[i].radius};
  });
}

bool proves_clear(const MotionCertificate& certificate, const Motion& a, const RigidBody& body_a,
                  const Obstacle& obstacle) {
  motion_check::require(a);
  motion_check::require(body_a);
  const motion_check::Check check(a, nullptr);
  const std::vector<Segment> edges = edges_of(obstacle);
  if (has_interior(obstacle))
    for (const RoundedPolygon& part : body_a)
      if (check.begins_inside(part, edges)) return false;
  return motion_check::all_hold(check, certificate, body_a, edges.size(), [&](std::size_t i) {
    return std::pair{std::vector<Vec2>{edges[i].a, edges[i].b}, 0.0};
  });
}

}  // namespace exactvo::geometry
