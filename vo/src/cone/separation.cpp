// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: S the obstacle grown by the robot and seen from it; h = h_S, with H (`magnitude`) the sum of its absolute
// terms; tau the horizon, v the velocity, y = tau v; n a normal; f(n) = h(n) - n.y, so that -f(n)/tau is how far v lies
// beyond { w : n.w = h(n)/tau }; m a direction with h(m) = -depth < 0; kappa the tilt from n towards m; u = 2^-53.
//
// Rounded: the search for n. Certified: the half-plane, by h(n) + 16 u H <= 0 in doubles (discs: a closed form with
// bounds of its own). Only `contact` asks an exact predicate. What is not certified here is that n is the best normal.
#include "cone/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cone/direction_search.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::vo::detail {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::kSupportError;
using geometry::kSupportUnderflow;
using geometry::kUnitRoundoff;
using geometry::Segment;
using geometry::support;
using geometry::SupportValue;

double error_of(const SupportValue& v) {
  return kSupportError * v.magnitude + kSupportUnderflow;
}

/// At least h_up / tau for h_up <= 0: the division and the product round once each. Where they underflow, 0 is above.
double offset_above(double h_up, double tau) {
  constexpr double kUnderflow = 0x1p-1000;
  const double c = h_up / tau;
  return c > -kUnderflow ? 0.0 : c * (1.0 - 4.0 * kUnitRoundoff);
}

// --- Discs, in closed form ---

/// False where the closed form's bounds do not hold: near contact, or at the ends of the doubles' range.
///
/// With H = |px| + |py| + R. Cut-off: n = w / |w| is of length 1 within 4 u, so h = n.p + R errs by less than 16 u H;
/// the division by tau errs by u H more, unless it underflows; 20 u H stands for both. Leg: with a = sqrt(|p|^2 - R^2),
/// n = (side a perp(p) - R p) / |p|^2 has n.p = -R and length 1. What rounding does to it moves h by at most 40 u H (an
/// error of a moves it by R times its square's, so cancellation in a^2 does no harm), and n - kappa p has h lower by
/// kappa a^2: kappa = 64 u H / a^2.
inline bool disc_half_plane(Vec2 p, double R, double tau, Vec2 y, HalfPlane& out) {
  constexpr double kLeast = 0x1p-400, kMost = 0x1p400;  // of squares: |p|^4 and its inverse are far from either end
  constexpr double kNear = 0x1p-20;                     // a^2 / |p|^2: nearer, kappa is no longer small
  constexpr double kNormal = 0x1p-900;                  // m/s: a quotient that did not underflow
  const double d2 = squared_norm(p);
  const double a2 = d2 - R * R;
  if (!(a2 > kNear * d2 + kLeast && d2 < kMost)) return false;
  const double size = std::fabs(p.x) + std::fabs(p.y) + R;
  const Vec2 w = y - p;
  const double wp = dot(w, p);
  const double w2 = squared_norm(w);
  if (wp < 0.0 && wp * wp > R * R * w2) {
    const Vec2 n = w / std::sqrt(w2);
    const double offset = (dot(n, p) + R + 20.0 * kUnitRoundoff * size) / tau;
    if (offset < -kNormal && w2 > kLeast) {
      out = {n, offset};
      return true;
    }
  }
  const double a = cross(p, w) >= 0.0 ? std::sqrt(a2) : -std::sqrt(a2);
  const double inverse = 1.0 / (a2 * d2);  // one division for both
  const double per_d2 = inverse * a2;
  const double kappa = 64.0 * kUnitRoundoff * size * (inverse * d2);
  const double across = a * per_d2;
  const double back = R * per_d2 + kappa;
  out = {{-across * p.y - back * p.x, across * p.x - back * p.y}, 0.0};
  return true;
}

constexpr double kLongest = 0x1p1000;  // s; an infinite horizon, or one whose products overflow, takes the general way

// --- The search for the best direction ---

struct Best {
  Direction direction{{}, std::numeric_limits<double>::infinity(), 0.0, 0.0, BoundaryPart::cut_off};
  void offer(Vec2 n, double f, const SupportValue& v, BoundaryPart part) {
    if (f < direction.f) direction = {n, f, v.h, v.magnitude, part};
  }
};

// --- Tilting ---

/// A point well inside S.
Vec2 middle_of(const GrownShape& s) {
  if (const auto* d = std::get_if<Disc>(&s.shape)) return d->center;
  if (const auto* e = std::get_if<Ellipse>(&s.shape)) return e->center;
  if (const auto* g = std::get_if<Segment>(&s.shape)) return 0.5 * (g->a + g->b);
  const std::vector<Vec2>& v = std::get<ConvexPolygon>(s.shape).vertices;
  const Vec2 a = v[0], b = v[v.size() / 3], c = v[2 * v.size() / 3];
  return a + ((b - a) + (c - a)) / 3.0;
}

const GrownShape& whole_of(const GrownShape& s) {
  return s;
}
const GrownShape& whole_of(const SeenSegment& s) {
  return s.whole;
}

/// Calls visit(normal) until it is true.
template <class Visit>
void for_each_nearest_normal(const GrownShape& s, Vec2 y, const Visit& visit) {
  if (const Ellipse* e = std::get_if<Ellipse>(&s.shape)) {
    const EllipseNormals normals(*e, e->center - s.origin, y);
    for (std::size_t i = 0; i < normals.first().count; ++i)
      if (visit(normals.first().n[i])) return;
    const Normals all = normals.all();
    for (std::size_t i = normals.first().count; i < all.count; ++i)
      if (visit(all.n[i])) return;
    return;
  }
  const Normals all = nearest_normals(s, y);
  for (std::size_t i = 0; i < all.count; ++i)
    if (visit(all.n[i])) return;
}

/// Whether no other normal can be as near as the first one, at `distance`: rounding leaves a doubt of the sides of a
/// segment or polygon, but not of an ellipse's second normal (nx, -ny) if y is well outside. Where there is one, qx <
/// a, so qy >= distance > d = 2^-20 of the size H. Either ny > 2^-25, and then f is larger by 2 ny qy > 2^-44 H, more
/// than its rounding; or f(nx, ny) is within 2^-24 H of f(1, 0) = a + R - qx > 0, and that of the first is below -2^-20
/// H.
bool is_nearest(const GrownShape& s, Vec2 y, double distance) {
  constexpr double kClear = 0x1p-20;
  const Ellipse* e = std::get_if<Ellipse>(&s.shape);
  if (!e || !(distance > 0.0)) return false;
  const Vec2 q = y - (e->center - s.origin);
  return distance > kClear * (std::fabs(q.x) + std::fabs(q.y) + std::fabs(e->center.x - s.origin.x) +
                              std::fabs(e->center.y - s.origin.y) + std::fabs(e->l11) + std::fabs(e->l21) +
                              std::fabs(e->l22) + s.radius);
}
bool is_nearest(const SeenSegment&, Vec2, double) {
  return false;
}

template <class Seen>
VelocityObstacle::Nearest nearest_among(const Seen& s, Vec2 y) {
  VelocityObstacle::Nearest best{{}, 0.0};
  bool is_first = true;
  for_each_nearest_normal(s, y, [&](Vec2 n) {
    const double at = dot(n, y) - support(s, n).h;
    if (is_first || at > best.distance) best = {n, at};
    const bool is_settled = is_first && is_nearest(s, y, at);
    is_first = false;
    return is_settled;
  });
  return best;
}

/// A direction m with h_S(m) = -depth < 0: away from the middle of S where that separates, else from its nearest point.
struct Inward {
  Vec2 m;
  double depth;
};
template <class Seen>
std::optional<Inward> inward(const Seen& s) {
  const Vec2 away = whole_of(s).origin - middle_of(s);
  const double length = std::sqrt(squared_norm(away));
  if (length > 0.0) {
    const Vec2 m = away / length;
    const SupportValue v = support(s, m);
    constexpr double kDeep = 0x1p-10;  // of H: shallower ones are left to the nearest normal, which is the deepest
    if (v.h < -kDeep * v.magnitude) return Inward{m, -v.h};
  }
  const VelocityObstacle::Nearest nearest = nearest_among(s, {});
  if (!(nearest.distance > 0.0)) return std::nullopt;
  return Inward{nearest.normal, nearest.distance};
}

/// Less would not change n; it also keeps an underflow from doubling 0 for ever.
constexpr double kLeastTilt = 0x1p-60;

/// The tilt that outdoes h > 0 and the errors of both supports twice over.
double first_tilt(double h, const SupportValue& v, double depth) {
  return std::max((std::max(h, 0.0) + 4.0 * error_of(v)) / depth, kLeastTilt);
}

/// At most 0, certified.
template <class Seen>
bool is_at_most_0(const Seen& s, Vec2 n) {
  const SupportValue v = support(s, n);
  return v.h + (kSupportError * v.magnitude + kSupportUnderflow) <= 0.0;
}

template <class Seen>
std::optional<Vec2> tilted_until_inside(const Seen& s, Vec2 n, Vec2 m, double first) {
  for (double kappa = std::max(first, kLeastTilt); kappa < 1.0; kappa *= 2.0) {
    const Vec2 tilted = n + kappa * m;
    if (is_at_most_0(s, tilted)) return tilted;
  }
  return std::nullopt;
}

template <class Seen>
std::optional<Vec2> inside(const Seen& s, Vec2 n) {
  const std::optional<Inward> in = inward(s);
  if (!in) return std::nullopt;
  const SupportValue v = support(s, n);
  return tilted_until_inside(s, n, in->m, first_tilt(v.h, v, in->depth));
}

/// At the ends of the doubles' range a normalisation may give 0 or worse.
bool is_about_unit(Vec2 n) {
  const double length2 = squared_norm(n);
  return length2 > 0.5 && length2 < 2.0;
}

/// d times a power of two, of a length between sqrt(1/2) and sqrt(2). Exact: no other digits than those of d. At the
/// ends of the doubles' range nothing that is about unit.
Vec2 of_about_unit_length(Vec2 d) {
  int exponent = 0;
  const double share = std::frexp(norm(d), &exponent);  // in [1/2, 1)
  constexpr double kSquareRootOfHalf = 0.70710678118654757;
  const int up = share < kSquareRootOfHalf ? 1 - exponent : -exponent;
  return {std::ldexp(d.x, up), std::ldexp(d.y, up)};
}

/// The directions that contact may be in without being rounded: from corners to the robot, and square to edges. Calls
/// visit(direction) until it is true.
template <class Visit>
void for_each_direction_of_contact(const GrownShape& s, const Visit& visit) {
  const auto visit_round = [&](const Vec2* first, const Vec2* last) {
    for (const Vec2* v = first; v != last; ++v) {
      const Vec2 along = (v + 1 == last ? *first : v[1]) - *v;
      if (visit(s.origin - *v) || visit(geometry::perp(along)) || visit(-geometry::perp(along))) return;
    }
  };
  if (const auto* disc = std::get_if<Disc>(&s.shape)) {
    visit(s.origin - disc->center);
  } else if (const auto* ellipse = std::get_if<Ellipse>(&s.shape)) {
    visit(s.origin - ellipse->center);  // of one that is a circle
  } else if (const auto* segment = std::get_if<Segment>(&s.shape)) {
    const Vec2 ends[2] = {segment->a, segment->b};
    visit_round(ends, ends + 2);
  } else {
    const std::vector<Vec2>& v = std::get<ConvexPolygon>(s.shape).vertices;
    visit_round(v.data(), v.data() + v.size());
  }
}

/// For a robot so near that nothing else could be certified.
std::optional<HalfPlane> contact(const GrownShape& s) {
  const std::optional<Vec2> n = contact_normal(s);
  return n ? std::optional(HalfPlane{*n, 0.0}) : std::nullopt;
}

}  // namespace

std::optional<Vec2> contact_normal(const GrownShape& s) {
  const Vec2 nearest = nearest_to(s, {}).normal;
  const auto is_proven = [&](Vec2 n) {
    return is_about_unit(n) && sign_of_support(s, n, 1.0, 0.0) != geometry::Sign::positive;
  };
  if (is_proven(nearest)) return nearest;
  // In exact contact one direction alone is safe. Where it has a rational slope, as that of a 3-4-5 triangle, dividing
  // by the length has rounded it away.
  constexpr double kAlmostTheNearest = 1.0 - 0x1p-20;
  std::optional<Vec2> found;
  for_each_direction_of_contact(s, [&](Vec2 d) {
    if (!(dot(nearest, d) >= kAlmostTheNearest * norm(d))) return false;
    const Vec2 n = of_about_unit_length(d);
    if (is_proven(n)) found = n;
    return found.has_value();
  });
  return found;
}

VelocityObstacle::Nearest nearest_to(const GrownShape& s, Vec2 y) {
  return nearest_among(s, y);
}
VelocityObstacle::Nearest nearest_to(const SeenSegment& s, Vec2 y) {
  return nearest_among(s, y);
}

namespace {

/// The best of the two legs, offered for a velocity of any scale.
void offer_legs(const Tangents& legs, Vec2 y, Best& best) {
  best.offer(legs.left.normal, -dot(legs.left.normal, y), {}, BoundaryPart::left_leg);
  best.offer(legs.right.normal, -dot(legs.right.normal, y), {}, BoundaryPart::right_leg);
}

/// The whole cone: the normal nearest in direction to v. Where v itself is one, the apex is nearest.
std::optional<Direction> best_direction_of_cone(const GrownShape& s, Vec2 v) {
  const std::optional<Tangents> legs = tangents(s);
  if (!legs) return std::nullopt;
  Best best;
  offer_legs(*legs, v, best);
  const Vec2 along = geometry::normalized(v);
  if (along != Vec2{} && dot(v, legs->left.touch) <= 0.0 && dot(v, legs->right.touch) <= 0.0)
    best.offer(along, -dot(along, v), {}, BoundaryPart::apex);
  return best.direction;
}

template <class Seen>
std::optional<Direction> best_direction_truncated(const Seen& s, Vec2 y) {
  Best best;
  bool is_first = true, is_settled = false;
  for_each_nearest_normal(s, y, [&](Vec2 n) {
    const SupportValue v = support(s, n);
    if (v.h <= 0.0) best.offer(n, v.h - dot(n, y), v, BoundaryPart::cut_off);
    // y outside S, and its nearest point's normal separates: VO is convex, so that point is the nearest of VO too.
    is_settled = is_first && best.direction.f < 0.0;
    is_first = false;
    return is_settled;
  });
  if (is_settled) return best.direction;
  if (const std::optional<Tangents> legs = tangents(s)) offer_legs(*legs, y, best);
  if (!std::isfinite(best.direction.f)) return std::nullopt;
  return best.direction;
}

/// The certified half-plane in the best direction. Through 0 for the legs and the apex: nudging an offset would not do,
/// since the cone is unbounded.
template <class Seen>
std::optional<HalfPlane> half_plane_along(const Seen& s, double tau, const std::optional<Direction>& best) {
  if (!best || !is_about_unit(best->normal)) return contact(whole_of(s));
  if (best->part == BoundaryPart::cut_off) {
    const double h_up = best->h + error_of({best->h, best->magnitude});
    if (h_up <= 0.0) return HalfPlane{best->normal, offset_above(h_up, tau)};
  }
  if (const std::optional<Vec2> tilted = inside(s, best->normal)) return HalfPlane{*tilted, 0.0};
  return contact(whole_of(s));
}

}  // namespace

std::optional<Direction> best_direction(const GrownShape& s, double tau, Vec2 v) {
  return std::isfinite(tau) ? best_direction_truncated(s, tau * v) : best_direction_of_cone(s, v);
}

std::optional<Vec2> tilted_inside(const GrownShape& s, Vec2 n, Vec2 m, double first) {
  return tilted_until_inside(s, n, m, first);
}

std::optional<Vec2> certified_inside(const GrownShape& s, Vec2 n) {
  return inside(s, n);
}

std::optional<Vec2> certified_outside(const GrownShape& s, Vec2 n) {
  const std::optional<Inward> in = inward(s);
  if (!in) return std::nullopt;
  const SupportValue v = support(s, n);
  for (double kappa = first_tilt(-v.h, v, in->depth); kappa < 1.0; kappa *= 2.0) {
    const Vec2 tilted = n - kappa * in->m;
    const SupportValue at = support(s, tilted);
    if (at.h > error_of(at)) return tilted;
  }
  const SupportValue behind = support(s, -in->m);
  if (behind.h > error_of(behind)) return -in->m;
  return std::nullopt;
}

std::optional<HalfPlane> separating_half_plane(const GrownShape& s, double tau, Vec2 v) {
  if (const Disc* disc = std::get_if<Disc>(&s.shape)) {
    HalfPlane h;
    if (tau <= kLongest && disc_half_plane(disc->center - s.origin, disc->radius + s.radius, tau, tau * v, h)) return h;
  }
  return half_plane_along(s, tau, best_direction(s, tau, v));
}

std::optional<HalfPlane> separating_half_plane(const SeenSegment& s, double tau, Vec2 v) {
  if (!std::isfinite(tau)) return separating_half_plane(s.whole, tau, v);
  return half_plane_along(s, tau, best_direction_truncated(s, tau * v));
}

}  // namespace exactvo::vo::detail
