// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/velocity_obstacle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "direction_search.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::vo {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::dot;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::kUnitRoundoff;
using geometry::norm;
using geometry::normalized;
using geometry::perp;
using geometry::Segment;
using geometry::Sign;
using geometry::support;
using geometry::support_point;
using geometry::support_upper_bound;

constexpr double kHalfPi = 1.57079632679489661923;

double f_at(const GrownShape& s, Vec2 n, Vec2 y) {
  return support(s, n).h - dot(n, y);
}

/// The best of the nearest normals, without the constraint h_S <= 0.
VelocityObstacle::Nearest nearest_to(const GrownShape& s, Vec2 y) {
  const detail::Normals candidates = detail::nearest_normals(s, y);
  VelocityObstacle::Nearest best{candidates.n[0], -f_at(s, candidates.n[0], y)};
  for (std::size_t i = 1; i < candidates.count; ++i) {
    const double distance = -f_at(s, candidates.n[i], y);
    if (distance > best.distance) best = {candidates.n[i], distance};
  }
  return best;
}

// --- Legs ---

/// n0 turned by `angle` towards `side` (+1: counter-clockwise).
Vec2 turned(Vec2 n0, double angle, double side) {
  return std::cos(angle) * n0 + (side * std::sin(angle)) * perp(n0);
}

/// The angle in [0, pi/2] from n0 at which h_S changes sign towards `side`: bisection, each step halving the bracket,
/// after Newton steps that are kept only when they stay inside it. h_S(n0) < 0, and h_S >= 0 at pi/2 since S lies
/// beyond n0's line.
double leg_angle(const GrownShape& s, Vec2 n0, double side) {
  double low = 0.0;
  double high = kHalfPi;
  double angle = 0.5 * kHalfPi;
  constexpr int kSteps = 80;
  for (int i = 0; i < kSteps && high - low > 0x1p-52; ++i) {
    const Vec2 n = turned(n0, angle, side);
    const double h = support(s, n).h;
    (h <= 0.0 ? low : high) = angle;
    // dh/dangle = n'.T(n), n' = side * perp(n).
    const double slope = side * dot(perp(n), support_point(s, n));
    const double newton = angle - h / slope;
    const double bisected = 0.5 * (low + high);
    angle = newton > low && newton < high && i % 3 != 2 ? newton : bisected;
  }
  return low;
}

/// The first angle at or below `angle` whose normal is certified h_S <= 0, by stepping towards n0: h_S is sublinear, so
/// h(n + kappa n0) <= h(n) - kappa dist.
std::optional<Vec2> certified_inside(const GrownShape& s, Vec2 n, Vec2 n0, double distance) {
  if (!(distance > 0.0)) return std::nullopt;
  const geometry::SupportValue v = support(s, n);
  double kappa =
      (std::max(v.h, 0.0) + 2.0 * (geometry::kSupportError * v.magnitude + geometry::kSupportUnderflow)) / distance;
  for (; kappa < 1.0; kappa *= 2.0) {
    const Vec2 tilted = n + kappa * n0;
    if (support_upper_bound(s, tilted) <= 0.0) return tilted;
  }
  return std::nullopt;
}

/// The nearest angle above `angle` certified h_S > 0.
Vec2 certified_outside(const GrownShape& s, Vec2 n0, double angle, double side) {
  for (double step = 0x1p-52; angle + step < kHalfPi; step *= 2.0) {
    const Vec2 n = turned(n0, angle + step, side);
    const geometry::SupportValue v = support(s, n);
    if (v.h > geometry::kSupportError * v.magnitude + geometry::kSupportUnderflow) return n;
  }
  return turned(n0, kHalfPi, side);
}

std::optional<Leg> leg_of(const GrownShape& s, const VelocityObstacle::Nearest& nearest, double side) {
  const double angle = leg_angle(s, nearest.normal, side);
  const Vec2 n = turned(nearest.normal, angle, side);
  const std::optional<Vec2> inside = certified_inside(s, n, nearest.normal, nearest.distance);
  if (!inside) return std::nullopt;
  return Leg{*inside, certified_outside(s, nearest.normal, angle, side), normalized(side * perp(n)),
             support_point(s, n)};
}

// --- Half-planes ---

/// Smallest double that is safely above h_up / tau: the division rounds once and is nudged past it.
double offset_above(double h_up, double tau) {
  const double c = h_up / tau;
  return c + 4.0 * kUnitRoundoff * std::fabs(c);
}

struct Choice {
  Vec2 normal{};
  double f = std::numeric_limits<double>::infinity();
  BoundaryPart part = BoundaryPart::cut_off;
  void offer(Vec2 n, double value, BoundaryPart which) {
    if (value < f) *this = {n, value, which};
  }
};

/// The minimum of f(n) = h_S(n) - n.y over h_S(n) <= 0: inner minima on the cut-off, ends on the legs.
Choice choose(const GrownShape& s, Vec2 y, const std::optional<Legs>& legs) {
  Choice best;
  const detail::Normals inner = detail::nearest_normals(s, y);
  for (std::size_t i = 0; i < inner.count; ++i) {
    const double h = support(s, inner.n[i]).h;
    if (h <= 0.0) best.offer(inner.n[i], h - dot(inner.n[i], y), BoundaryPart::cut_off);
  }
  if (legs) {
    best.offer(legs->left.normal, f_at(s, legs->left.normal, y), BoundaryPart::left_leg);
    best.offer(legs->right.normal, f_at(s, legs->right.normal, y), BoundaryPart::right_leg);
  }
  return best;
}

}  // namespace

VelocityObstacle::VelocityObstacle(geometry::ConvexShape obstacle, Vec2 robot_position, double robot_radius,
                                   double time_horizon)
    : grown_{std::move(obstacle), robot_position, robot_radius}, tau_(time_horizon) {
  EXACTVO_REQUIRE(geometry::is_valid(grown_.shape), geometry::to_string(grown_.shape));
  EXACTVO_REQUIRE(geometry::is_finite(robot_position), "a robot position that is not finite");
  EXACTVO_REQUIRE(robot_radius >= 0.0 && std::isfinite(robot_radius), std::to_string(robot_radius));
  EXACTVO_REQUIRE(time_horizon > 0.0 && std::isfinite(time_horizon), std::to_string(time_horizon));
}

bool VelocityObstacle::overlaps() const {
  return locate(grown_, Vec2{}) != geometry::Place::outside;
}

bool VelocityObstacle::contains(Vec2 v) const {
  return segment_meets(grown_, v, tau_);
}

VelocityObstacle::Nearest VelocityObstacle::nearest() const {
  return nearest_to(grown_, Vec2{});
}

std::optional<Legs> VelocityObstacle::legs() const {
  const Nearest n0 = nearest();
  if (!(n0.distance > 0.0)) return std::nullopt;
  std::optional<Leg> ccw = leg_of(grown_, n0, 1.0);
  std::optional<Leg> cw = leg_of(grown_, n0, -1.0);
  if (!ccw || !cw) return std::nullopt;
  // n0 faces the robot, so turning it clockwise leads to the side on the robot's left.
  return Legs{*cw, *ccw};
}

NearestBoundary VelocityObstacle::nearest_boundary(Vec2 v) const {
  EXACTVO_REQUIRE(geometry::is_finite(v), "a velocity that is not finite");
  const Choice best = choose(grown_, tau_ * v, legs());
  const double length = norm(best.normal);
  const double f = best.f / (tau_ * length);
  const Vec2 n = best.normal / length;
  return {n, -f, f * n, best.part};
}

std::optional<HalfPlane> VelocityObstacle::half_plane(Vec2 v, double alpha) const {
  EXACTVO_REQUIRE(geometry::is_finite(v), "a velocity that is not finite");
  EXACTVO_REQUIRE(alpha > 0.0 && alpha <= 1.0, std::to_string(alpha));
  const std::optional<Legs> cone = legs();
  if (!cone) return contact_half_plane();
  const Choice best = choose(grown_, tau_ * v, cone);
  const double h_up = support_upper_bound(grown_, best.normal);
  if (h_up > 0.0) return contact_half_plane();  // the cut-off is within rounding of the robot
  // A leg is tilted until h_S <= 0 and then passes through 0: nudging its offset would not do, since the cone is
  // unbounded.
  const double full = best.part == BoundaryPart::cut_off ? offset_above(h_up, tau_) : 0.0;
  if (alpha == 1.0) return HalfPlane{best.normal, full};
  const double at_v = dot(best.normal, v);
  return HalfPlane{best.normal, at_v + alpha * (full - at_v)};
}

std::optional<HalfPlane> VelocityObstacle::contact_half_plane() const {
  const Nearest n0 = nearest();
  if (sign_of_support(grown_, n0.normal, tau_, 0.0) == Sign::positive) return std::nullopt;
  return HalfPlane{n0.normal, 0.0};
}

}  // namespace exactvo::vo
