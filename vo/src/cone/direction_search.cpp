// SPDX-License-Identifier: GPL-3.0-or-later
// The normals of S at the points nearest to y, shape by shape. Rounded.
//
// The foot on an ellipse follows Eberly (Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid, 2013),
// with s for his s + 1: in the frame of the axes, with semi-axes a >= b and y folded into the first quadrant as
// (qx, qy), it has r0 = (a/b)^2, n0 = a qx / b^2, z1 = qy / b, and solves
// F(s) = (n0/(s + r0 - 1))^2 + (z1/s)^2 - 1 = 0.
#include "cone/direction_search.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace exactvo::vo::detail {
namespace {

using geometry::Ellipse;
using geometry::normalized;

Vec2 unit_or(Vec2 v, Vec2 fallback) {
  return v == Vec2{} ? fallback : normalized(v);
}

Normals of_segment(Vec2 a, Vec2 b, Vec2 y) {
  Normals out;
  const Vec2 away = y - nearest_on(a, b, y);
  if (away != Vec2{}) out.add(normalized(away));
  const Vec2 side = unit_or(perp(b - a), kAnyDirection);
  out.add(side);
  out.add(-side);
  return out;
}

/// The least of something over the edges, and the normal that attains it.
struct Least {
  double value = std::numeric_limits<double>::infinity();
  Vec2 normal{};
  void offer(double v, Vec2 n) {
    if (v < value) *this = {v, n};
  }
};

/// Outside: away from the nearest edge point. Inside: the normal of the nearest edge's line. Always: the shallowest
/// edge that faces the robot, since a y behind a thin obstacle is nearest to the front.
Normals of_polygon(const std::vector<Vec2>& v, Vec2 origin, double radius, Vec2 y) {
  if (v.size() <= 2) return of_segment(v.front() - origin, v.back() - origin, y);
  Least away, shallowest, facing;
  bool inside = true;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec2 a = v[i] - origin;
    const Vec2 b = v[(i + 1) % v.size()] - origin;
    if (a == b) continue;
    const Vec2 outward = normalized(-perp(b - a));
    const double beyond = dot(outward, y - a);
    inside = inside && beyond <= 0.0;
    shallowest.offer(-beyond, outward);
    if (dot(outward, a) + radius <= 0.0) facing.offer(-beyond, outward);
    const Vec2 from_edge = y - nearest_on(a, b, y);
    away.offer(squared_norm(from_edge), from_edge);
  }
  Normals out;
  out.add(inside || away.normal == Vec2{} ? shallowest.normal : normalized(away.normal));
  if (std::isfinite(facing.value)) out.add(facing.normal);
  return out;
}

// --- Ellipse ---

EllipseFrame frame_of(const Ellipse& e) {
  const double s11 = e.l11 * e.l11;
  const double s12 = e.l11 * e.l21;
  const double s22 = e.l21 * e.l21 + e.l22 * e.l22;
  const double half_gap = 0.5 * (s11 - s22);
  const double root = std::sqrt(half_gap * half_gap + s12 * s12);
  const double a2 = 0.5 * (s11 + s22) + root;
  const double a = std::sqrt(a2);
  const double b = a > 0.0 ? std::fabs(e.l11 * e.l22) / a : 0.0;
  // The eigenvector of a2, from the larger of its two forms.
  const Vec2 v = half_gap >= 0.0 ? Vec2{half_gap + root, s12} : Vec2{s12, root - half_gap};
  const Vec2 major = unit_or(v, kAnyDirection);
  return {a, b, major, perp(major)};
}

/// Robust bisection for the foot of q (first quadrant, axes a >= b > 0): the s with
/// F(s) = (n0 / (s + r0 - 1))^2 + (z1 / s)^2 - 1 = 0 between `low` and `high`.
double bisect_foot(double n0, double z1, double r0, double low, double high, bool decreasing) {
  for (int i = 0; i < 120; ++i) {  // until the bracket is one ulp; at most the bits of two exponents and a mantissa
    const double s = 0.5 * (low + high);
    if (s <= low || s >= high) break;
    const double fx = n0 / (s + r0 - 1.0);
    const double fy = z1 / s;
    const bool above = fx * fx + fy * fy > 1.0;
    (above == decreasing ? low : high) = s;
  }
  return 0.5 * (low + high);
}

/// The same root for q outside or inside, by Newton's method: F falls and is convex right of its poles, so from the
/// left of the root every step stays left of it and the error is soon squared. Falls back on bisection.
double foot(double n0, double z1, double r0) {
  constexpr int kSteps = 24;
  constexpr double kSettled = 0x1p-50;  // relative step: another one would only round
  double s = std::max(z1, n0 - (r0 - 1.0));
  for (int i = 0; i < kSteps; ++i) {
    const double ix = 1.0 / (s + r0 - 1.0);
    const double iy = 1.0 / s;
    const double fx = n0 * ix;
    const double fy = z1 * iy;
    const double step = (fx * fx + fy * fy - 1.0) / (2.0 * (fx * fx * ix + fy * fy * iy));
    s += step;
    if (!(step > kSettled * s)) return s;
  }
  return bisect_foot(n0, z1, r0, z1, std::max(1.0, std::hypot(n0, z1)), /*decreasing=*/true);
}

}  // namespace

EllipseNormals::EllipseNormals(const Ellipse& e, Vec2 centre, Vec2 y) : frame_(frame_of(e)) {
  const EllipseFrame& f = frame_;
  constexpr double kFlat = 0x1p-40;  // thinner than this share of a, the ellipse is taken as its segment
  if (!(f.b > kFlat * f.a)) {
    first_ = of_segment(centre - f.a * f.major, centre + f.a * f.major, y);
    return;
  }
  const Vec2 q = y - centre;
  const double qx = std::fabs(dot(q, f.major));
  const double qy = std::fabs(dot(q, f.minor));
  sign_x_ = dot(q, f.major) < 0.0 ? -1.0 : 1.0;
  sign_y_ = dot(q, f.minor) < 0.0 ? -1.0 : 1.0;
  r0_ = (f.a / f.b) * (f.a / f.b);
  z1_ = qy / f.b;
  n0_ = f.a * qx / (f.b * f.b);
  if (z1_ > 0.0) {
    first_.add(normal_at(foot(n0_, z1_, r0_)));
    may_have_second_ = true;
  } else if (n0_ < r0_ - 1.0) {
    // On the major axis inside the evolute: the feet lie to both sides, at cos = n0 / (r0 - 1).
    const double cx = n0_ / (r0_ - 1.0);
    const Vec2 n = normalized({cx * f.b, std::sqrt(1.0 - cx * cx) * f.a});
    first_.add(unfolded(n, 1.0));
    first_.add(unfolded(n, -1.0));
  } else {
    first_.add(unfolded({1.0, 0.0}, 1.0));
  }
}

// Foot x = (a n0' , b z1'), with n0' = n0/(s+r0-1), z1' = z1/s on the unit circle; its normal is (n0'/a, z1'/b).
Vec2 EllipseNormals::normal_at(double s) const {
  const double cx = n0_ / (s + r0_ - 1.0);
  const double cy = z1_ / s;
  return unfolded(normalized({cx * frame_.b, cy * frame_.a}), sign_y_);
}

Normals EllipseNormals::all() const {
  Normals out = first_;
  if (!may_have_second_) return out;
  // The second minimum, across the major axis: s in [s_m, -z1), where F has its least value at s_m.
  const double k = std::cbrt((n0_ / z1_) * (n0_ / z1_));
  const double s_m = 1.0 - (r0_ + k) / (1.0 + k);
  const double fx = n0_ / (s_m + r0_ - 1.0);
  const double fy = z1_ / s_m;
  if (s_m < -z1_ && s_m + r0_ - 1.0 > 0.0 && fx * fx + fy * fy < 1.0)
    out.add(normal_at(bisect_foot(n0_, z1_, r0_, s_m, -z1_, /*decreasing=*/false)));
  return out;
}

Normals nearest_normals(const GrownShape& s, Vec2 y) {
  if (const auto* e = std::get_if<Ellipse>(&s.shape)) return EllipseNormals(*e, e->center - s.origin, y).all();
  if (const auto* g = std::get_if<geometry::Segment>(&s.shape)) return of_segment(g->a - s.origin, g->b - s.origin, y);
  if (const auto* p = std::get_if<geometry::ConvexPolygon>(&s.shape))
    return of_polygon(p->vertices, s.origin, s.radius, y);
  Normals out;
  out.add(unit_or(y - (std::get<geometry::Disc>(s.shape).center - s.origin), kAnyDirection));
  return out;
}

}  // namespace exactvo::vo::detail
