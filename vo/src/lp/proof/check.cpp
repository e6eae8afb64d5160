// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "lp/proof/duality.h"

namespace exactvo::lp {
namespace {

constexpr std::size_t kMostTerms = 3;

Exact violation_at(const HalfPlane& h, Vec2 v) {
  const ExactLine line = exact(h);
  return line.offset - dot(line.normal, exact(v));
}

bool keeps_bound(const SpeedBound& bound, Vec2 v) {
  if (std::abs(v.x) > bound.box_x || std::abs(v.y) > bound.box_y) return false;
  if (std::isinf(bound.disc)) return true;
  const ExactVector e = exact(v);
  return sign_of(dot(e, e) - Exact(bound.disc) * Exact(bound.disc)) <= 0;
}

/// What a velocity must keep: violated by at most 0, by at most the certificate's violation, or left alone.
bool keeps(const Problem& problem, const Certificate& c, Scope scope) {
  if (!keeps_bound(problem.bound, c.velocity)) return false;
  for (const Constraint& constraint : problem.constraints) {
    const bool soft = constraint.priority == Priority::soft;
    if (soft && scope == Scope::hard_may_give) continue;
    const bool gives = scope == Scope::hard_may_give || (scope == Scope::soft_may_give && soft);
    const Exact most = gives ? Exact(c.violation) : Exact(0);
    if (sign_of(violation_at(constraint.half_plane, c.velocity) - most) > 0) return false;
  }
  return true;
}

bool has_finite_numbers(const Certificate& c) {
  return is_finite(c.velocity) && std::isfinite(c.violation) && c.violation >= 0.0 && std::isfinite(c.gap) &&
         c.gap >= 0.0;
}

/// The point nearest 0 on the boundaries named (homogeneous): 0 itself, the foot on one, the crossing of two.
bool vertex_point(const Problem& problem, const std::vector<Binding>& vertex, ExactPoint& point) {
  for (const Binding b : vertex) {
    if (b == kDisc || (!is_speed_bound(b) && b.index >= problem.constraints.size())) return false;
    if (!std::isfinite(half_plane_at(problem, b).offset)) return false;
  }
  if (vertex.empty()) {
    point = {0, 0, 0, 0, 1, 0};
    return true;
  }
  const ExactLine a = exact(half_plane_at(problem, vertex[0]));
  if (vertex.size() == 1) {
    point = {a.normal.x * a.offset, 0, a.normal.y * a.offset, 0, dot(a.normal, a.normal), 0};
    return true;
  }
  const ExactLine b = exact(half_plane_at(problem, vertex[1]));
  const Exact w = cross(a.normal, b.normal);
  const Exact sign(sign_of(w));
  point = {sign * (a.offset * b.normal.y - b.offset * a.normal.y),
           0,
           sign * (a.normal.x * b.offset - b.normal.x * a.offset),
           0,
           sign * w,
           0};
  return sign_of(w) != 0;
}

bool within_bound(const Problem& problem, const ExactPoint& point) {
  for (const Binding side : kBoxSides) {
    const HalfPlane h = half_plane_at(problem, side);
    if (std::isfinite(h.offset) && sign_of_violation(exact(h), point) > 0) return false;
  }
  if (std::isinf(problem.bound.disc)) return true;
  const Exact reach = Exact(problem.bound.disc) * point.w;
  return sign_of(point.x0 * point.x0 + point.y0 * point.y0 - reach * reach) <= 0;
}

CertificateError check_pinched(const Problem& problem, const Certificate& c) {
  ExactPoint point;
  if (c.vertex.size() > 2 || !vertex_point(problem, c.vertex, point)) return CertificateError::malformed;
  const bool hard_only = !c.contradiction.empty();
  if (hard_only) {
    const Combination sum = combine(problem, c.contradiction, Scope::soft_may_give);
    if (!sum.well_formed || c.contradiction.size() > kMostTerms) return CertificateError::malformed;
    if (!contradicts(problem, sum)) return CertificateError::contradiction;
  }
  if (!within_bound(problem, point)) return CertificateError::vertex;
  for (const Constraint& constraint : problem.constraints) {
    if (hard_only && constraint.priority == Priority::soft) continue;
    if (sign_of_violation(exact(constraint.half_plane), point) > 0) return CertificateError::vertex;
  }
  return CertificateError::none;
}

CertificateError check_giving(const Problem& problem, const Certificate& c, Scope scope) {
  if (c.contradiction.size() > kMostTerms || c.bound.size() > kMostTerms) return CertificateError::malformed;
  const Combination against = combine(problem, c.contradiction, scope);
  const Combination least = combine(problem, c.bound, scope);
  if (!against.well_formed || !least.well_formed) return CertificateError::malformed;
  if (!keeps(problem, c, scope)) return CertificateError::velocity;
  if (!contradicts(problem, against)) return CertificateError::contradiction;
  return bounds_violation(problem, least, c.violation, c.gap) ? CertificateError::none : CertificateError::bound;
}

CertificateError check_optimal(const Problem& problem, const Certificate& c) {
  const Combination sum = combine(problem, c.bound, Scope::all_must_hold);
  if (c.bound.size() > kMostTerms || !sum.well_formed) return CertificateError::malformed;
  if (!keeps(problem, c, Scope::all_must_hold)) return CertificateError::velocity;
  return bounds_objective(problem, sum, c.velocity, c.gap) ? CertificateError::none : CertificateError::bound;
}

}  // namespace

const char* name(CertificateError flaw) {
  constexpr const char* kNames[] = {"none", "malformed", "velocity", "contradiction", "bound", "vertex"};
  return kNames[static_cast<int>(flaw)];
}

CertificateError check(const Problem& problem, const Certificate& c) {
  require_well_formed(problem);
  if (!has_finite_numbers(c)) return CertificateError::malformed;
  switch (c.status) {
    case Status::optimal:
      return check_optimal(problem, c);
    case Status::relaxed:
      return check_giving(problem, c, Scope::soft_may_give);
    case Status::infeasible:
      return check_giving(problem, c, Scope::hard_may_give);
    case Status::no_interior:
      return check_pinched(problem, c);
  }
  return CertificateError::malformed;
}

}  // namespace exactvo::lp
