// SPDX-License-Identifier: GPL-3.0-or-later
#include "cone_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/geometry/pi.h"

namespace exactvo::vo::detail {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::GrownShape;
using geometry::kUnitRoundoff;
using geometry::Region;

Vec2 at_angle(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// A regular polygon of so many corners stays within the tolerance of its circle: 1 - cos(pi/k) <= (pi/k)^2 / 2.
int corners_of_circle(const Window& window) {
  const double asked = geometry::kPi / std::sqrt(2.0 * window.tolerance / window.speed);
  constexpr double kFewest = 16.0;
  return static_cast<int>(std::ceil(std::max(asked, kFewest)));
}

// --- The normals at which a cone is touched ---

struct Contact {
  double angle;  ///< of the outward normal
  Vec2 at;       ///< m/s, relative: the point of S / tau there, rounded
};

/// The arc of normals from the left leg's over the cut-off's to the right leg's, counter-clockwise, divided until the
/// triangles between neighbouring contacts are lower than the tolerance.
///
///              . apex               height <= chord/2 tan(theta/2), theta the angle between the normals
///          .       .
///      a ------------- b
class Cutoff {
 public:
  Cutoff(const VelocityObstacle& cone, const Legs& legs, double tolerance)
      : s_(cone.grown()), scale_(1.0 / cone.time_horizon()), tolerance_(tolerance) {
    const double first = std::atan2(legs.left.normal.y, legs.left.normal.x);
    const double turn =
        std::atan2(cross(legs.left.normal, legs.right.normal), dot(legs.left.normal, legs.right.normal));
    const Contact left{first, scale_ * legs.left.touch}, right{first + turn, scale_ * legs.right.touch};
    contacts_.push_back(left);
    std::vector<double> seeds = edge_normals(first, turn);
    Contact from = left;
    for (const double angle : seeds) {
      const Contact to = contact(angle);
      refine(from, to, kMostHalvings);
      from = to;
    }
    refine(from, right, kMostHalvings);
  }

  const std::vector<Contact>& contacts() const { return contacts_; }

 private:
  static constexpr int kMostHalvings = 24;

  Contact contact(double angle) const { return {angle, scale_ * support_point(s_, at_angle(angle))}; }

  void refine(const Contact& a, const Contact& b, int halvings) {
    const double height = 0.5 * norm(b.at - a.at) * std::tan(0.5 * (b.angle - a.angle));
    if (!(height > tolerance_) || halvings == 0) {
      contacts_.push_back(b);
      return;
    }
    const Contact middle = contact(0.5 * (a.angle + b.angle));
    refine(a, middle, halvings - 1);
    refine(middle, b, halvings - 1);
  }

  /// A normal a little to either side of each edge's, so that an edge costs two contacts and no halvings.
  std::vector<double> edge_normals(double first, double turn) const {
    constexpr double kBeside = 0x1p-30;
    std::vector<double> angles;
    std::vector<Vec2> v;
    if (const auto* p = std::get_if<geometry::ConvexPolygon>(&s_.shape)) v = p->vertices;
    if (const auto* g = std::get_if<geometry::Segment>(&s_.shape)) v = {g->a, g->b};
    const Vec2 start = at_angle(first);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec2 outward = -geometry::perp(v[(i + 1) % v.size()] - v[i]);
      const double beyond = std::atan2(cross(start, outward), dot(start, outward));
      if (!(beyond > kBeside && beyond < turn - kBeside)) continue;
      angles.push_back(first + beyond - kBeside);
      angles.push_back(first + beyond + kBeside);
    }
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  const GrownShape& s_;
  double scale_;  ///< 0 for a cone without end: every contact is the apex
  double tolerance_;
  std::vector<Contact> contacts_;
};

// --- From outside: certified half-planes ---

/// n.v <= c + n.apex for all v of the cone, rounded up past the error of its terms; as the half-plane that keeps them.
geometry::HalfPlane keeping(Vec2 n, double c, const ShiftedCone& cone) {
  double value = c, terms = std::fabs(c);
  for (const Vec2 m : cone.minus_apex.terms) {
    value -= dot(n, m);
    terms += std::fabs(n.x * m.x) + std::fabs(n.y * m.y);
  }
  constexpr double kRoundings = 16.0;  // at most 5 u of each term, thrice that for the bound's own rounding
  constexpr double kUnderflow = 0x1p-1060;
  return {-n, -(value + (kRoundings * kUnitRoundoff * terms + kUnderflow))};
}

/// h_S(n) <= h_up <= 0 makes n.w <= h_up / tau on the relative cone.
std::optional<geometry::HalfPlane> keeping_beyond(double angle, const ShiftedCone& cone) {
  const Vec2 n = at_angle(angle);
  const double h_up = support_upper_bound(cone.cone.grown(), n);
  if (!(h_up <= 0.0)) return std::nullopt;
  const double c = h_up / cone.cone.time_horizon();
  return keeping(n, c * (1.0 - 4.0 * kUnitRoundoff), cone);
}

// --- From inside: points that are exactly in the cone ---

/// p, or a point between it and `deep` that is exactly inside: the cone is convex, so what lies between is inside too.
void add_inside(const ShiftedCone& cone, Vec2 p, Vec2 deep, std::vector<Vec2>& points) {
  constexpr double kFirst = 0x1p-50, kLast = 0x1p-4;
  if (cone.contains(p)) {
    points.push_back(p);
    return;
  }
  for (double share = kFirst; share < kLast; share *= 4.0) {
    const Vec2 nudged = p + share * (deep - p);
    if (!cone.contains(nudged)) continue;
    points.push_back(nudged);
    return;
  }
}

/// Directions from `a` to `b`, clockwise, at most a sixth of a turn apart.
std::vector<Vec2> fan(Vec2 a, Vec2 b) {
  constexpr double kStep = 1.0;  // rad
  const double turn = std::atan2(cross(a, b), dot(a, b));
  const int steps = 1 + static_cast<int>(std::fabs(turn) / kStep);
  std::vector<Vec2> directions;
  for (int i = 0; i <= steps; ++i) directions.push_back(geometry::rotated(a, turn * i / steps));
  return directions;
}

std::vector<Contact> contacts_of(const ShiftedCone& cone, const Legs& legs, const Window& window) {
  return Cutoff(cone.cone, legs, window.tolerance).contacts();
}

}  // namespace

geometry::ConvexPolygon square_of(const Window& window) {
  const double r = kReach * window.speed;
  return {{{-r, -r}, {r, -r}, {r, r}, {-r, r}}};
}

Region disc_from_inside(const Window& window) {
  const int count = corners_of_circle(window);
  const GrownShape disc{geometry::Disc{{}, window.speed}, {}, 0.0};
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * geometry::kPi * i / count;
    Vec2 p = window.speed * at_angle(angle);
    while (locate(disc, p) == geometry::Place::outside) p = (1.0 - 4.0 * kUnitRoundoff) * p;
    points.push_back(p);
  }
  return Region::hull_of(points);
}

Region disc_from_outside(const Window& window) {
  const int count = corners_of_circle(window);
  std::vector<geometry::HalfPlane> keep;
  for (int i = 0; i < count; ++i) {
    const Vec2 n = at_angle(2.0 * geometry::kPi * i / count);
    keep.push_back({-n, -window.speed * norm(n) * (1.0 + 8.0 * kUnitRoundoff)});  // a root, two products, a sum
  }
  return Region::cut(square_of(window), keep);
}

Region cone_from_outside(const ShiftedCone& cone, const Window& window) {
  const std::optional<Legs> legs = cone.cone.legs();
  if (!legs) return Region::cut(square_of(window), {});
  std::vector<geometry::HalfPlane> keep{keeping(legs->left.normal, 0.0, cone), keeping(legs->right.normal, 0.0, cone)};
  for (const Contact& contact : contacts_of(cone, *legs, window))
    if (const auto h = keeping_beyond(contact.angle, cone)) keep.push_back(*h);
  return Region::cut(square_of(window), keep);
}

Region cone_from_inside(const ShiftedCone& cone, const Window& window) {
  const std::optional<Legs> legs = cone.cone.legs();
  if (!legs) return {};
  // So far out that chords between directions a radian apart stay outside the square: 1.5 sqrt(2) / cos(1/2) < 3.
  const double far = 3.0 * window.speed + norm(cone.apex);
  const Vec2 middle = geometry::normalized(legs->left.direction + legs->right.direction);
  const Vec2 deep = cone.apex + 2.0 * far * middle;
  std::vector<Vec2> points;
  for (const Contact& c : contacts_of(cone, *legs, window))
    if (norm(c.at) < far) add_inside(cone, cone.apex + c.at, deep, points);
  for (const Vec2 d : fan(legs->left.direction, legs->right.direction)) {
    const Vec2 p = cone.apex + far * d;
    add_inside(cone, p, deep, points);
  }
  return Region::hull_of(points);
}

}  // namespace exactvo::vo::detail
