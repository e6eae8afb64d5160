// SPDX-License-Identifier: GPL-3.0-or-later
// Which filter is asked first, and which exact stage decides what the filter leaves open:
//
//   predicate                          filter                                 exact stage
//   sign_of_support (A)                support.h: |error| <= 16 u H           here: k + sqrt(b) + sqrt(d), squared away
//   locate (B1)        disc            here: static bound                     here
//                      hull (+) disc   grown_polygon.cpp, sign by sign        the same file
//                      ellipse         grown_ellipse.cpp, locate_rounded      the same file, locate_exactly
//   segment_meets (B2) disc            segment_disc_filter.h                  exact_sweep.cpp
//                      hull (+) disc   grown_polygon.cpp, sign by sign        the same file
//                      ellipse         grown_ellipse.cpp                      the same file, by way of exact_sweep.cpp
//   contains (E), orientation,         running_error.h: a bound that          here: the same polynomial over Mpzf
//   goal_outside_evolute (F)           is computed with the value
//
// Static bounds are multiples of u = 2^-53 times a sum of absolute terms, derived where they are defined. There is no
// interval arithmetic here. A filter decides nothing with NaN or infinity: these reach the exact stage, which refuses
// them.
//
// Notation: S = (shape - origin) (+) D(0, radius); h_S its support function; H the sum of the absolute terms of h_S(n);
// tau the time horizon; an ellipse is { center + L w : |w| <= 1 }, Sigma = L L^T, with semi-axes a >= b.
#include "exactvo/geometry/predicates.h"

#include <cmath>
#include <string>
#include <vector>

#include "exact/exact_vector.h"
#include "exact/running_error.h"
#include "exact/stages.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/require.h"
#include "predicates/exact_sweep.h"
#include "predicates/grown_ellipse.h"
#include "predicates/grown_polygon.h"
#include "predicates/segment_disc_filter.h"

namespace exactvo::geometry {
namespace {

using detail::count_exact;
using detail::count_filter;
using detail::difference;
using detail::Exact;
using detail::FilterAnswer;
using detail::filtered_sign;
using detail::GrownPolygon;
using detail::make;
using detail::segment_disc_filter;
using detail::sign_of_double;
using detail::squared;
using detail::Vector;

std::string show(Vec2 v) {
  return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ")";
}

/// No filter decides with a NaN or an infinity among its numbers, so the exact stages are where they are caught.
void require_valid(const GrownShape& s) {
  EXACTVO_REQUIRE(is_valid(s.shape) && is_finite(s.origin) && std::isfinite(s.radius), excerpt(s.shape));
}
void require_segment(const GrownShape& s, Vec2 direction, double t_max) {
  EXACTVO_REQUIRE(is_finite(direction) && t_max >= 0.0 && std::isfinite(t_max) && s.radius >= 0.0, show(direction));
}
void require_valid(const Ellipse& e) {
  EXACTVO_REQUIRE(is_valid(ConvexShape{e}), to_string(ConvexShape{e}));
}

/// h_S(n) - tau c = k + sqrt(b) + sqrt(d).
struct SupportParts {
  Exact k, b, d;
};

Exact exact_offset(Vec2 n, Vec2 x, Vec2 origin) {
  return dot(make<Exact>(n), difference<Exact>(x, origin));
}

Exact farthest(const std::vector<Vec2>& vertices, Vec2 n, Vec2 origin) {
  Exact best = exact_offset(n, vertices.front(), origin);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const Exact value = exact_offset(n, vertices[i], origin);
    if (best < value) best = value;
  }
  return best;
}

SupportParts parts_of(const GrownShape& s, Vec2 n) {
  const auto from_radius = [&](const Exact& radius) { return squared(radius) * dot(make<Exact>(n), make<Exact>(n)); };
  if (const auto* disc = std::get_if<Disc>(&s.shape))
    return {exact_offset(n, disc->center, s.origin), Exact(0), from_radius(Exact(disc->radius) + Exact(s.radius))};
  if (const auto* e = std::get_if<Ellipse>(&s.shape)) {
    const Exact wx = Exact(e->l11) * Exact(n.x) + Exact(e->l21) * Exact(n.y);
    const Exact wy = Exact(e->l22) * Exact(n.y);
    return {exact_offset(n, e->center, s.origin), wx * wx + wy * wy, from_radius(Exact(s.radius))};
  }
  return {farthest(corners_of(s.shape), n, s.origin), Exact(0), from_radius(Exact(s.radius))};
}

// --- Predicates B1 and B2 ---

struct Locator {
  const GrownShape& s;
  Vec2 q;

  Place operator()(const Disc& disc) const { return static_cast<Place>(static_cast<int>(disc_sign(disc))); }
  Place operator()(const Segment& segment) const {
    const Vec2 ends[2] = {segment.a, segment.b};
    return polygon(ends, 2);
  }
  Place operator()(const ConvexPolygon& p) const { return polygon(p.vertices.data(), p.vertices.size()); }
  Place operator()(const Ellipse& e) const {
    const Vec2 p = e.center - s.origin;
    const Vec2 size{std::fabs(p.x) + std::fabs(q.x), std::fabs(p.y) + std::fabs(q.y)};
    Place place{};
    if (detail::locate_rounded(e, p - q, size, s.radius, place)) {
      count_filter();
      return place;
    }
    return ellipse_exactly(e);
  }

 private:
  [[gnu::noinline, gnu::cold]] Place ellipse_exactly(const Ellipse& e) const {
    count_exact();
    require_valid(s);
    return detail::locate_exactly(e, s, make<Exact>(q));
  }
  [[gnu::noinline, gnu::cold]] Sign disc_exactly(const Disc& disc) const {
    count_exact();
    require_valid(s);
    const Vector<Exact> u = difference<Exact>(disc.center, s.origin) - make<Exact>(q);
    return detail::sign_of(dot(u, u) - squared(Exact(disc.radius) + Exact(s.radius)));
  }
  /// Sign of |centre - origin - q|^2 - (sum of the radii)^2.
  Sign disc_sign(const Disc& disc) const {
    // u errs by 2 u of its size, the squares by 6 u, the radii's by 4 u, the difference by 2 u more; kUnderflow is more
    // than three underflowed squares.
    constexpr double kError = 16.0 * kUnitRoundoff;
    constexpr double kUnderflow = 0x1p-1060;
    const Vec2 p = disc.center - s.origin;
    const Vec2 size{std::fabs(p.x) + std::fabs(q.x), std::fabs(p.y) + std::fabs(q.y)};
    const double reach = disc.radius + s.radius;
    const double value = squared_norm(p - q) - reach * reach;
    if (std::fabs(value) > kError * (squared_norm(size) + reach * reach) + kUnderflow) {
      count_filter();
      return sign_of_double(value);
    }
    return disc_exactly(disc);
  }

  Place polygon(const Vec2* vertices, std::size_t count) const {
    EXACTVO_REQUIRE(count > 0, excerpt(s.shape));
    const GrownPolygon grown(vertices, count, s.origin, s.radius);
    const Place place = grown.place_of(detail::along(q, 1.0));
    if (grown.was_exact()) require_valid(s);
    grown.was_exact() ? count_exact() : count_filter();
    return place;
  }
};

// Kept out of the filters' way: its frame would cost as much as a filter. They decide nothing with a NaN.
[[gnu::noinline, gnu::cold]] bool segment_meets_exact_stage(const GrownShape& s, Vec2 v, double t_max) {
  require_segment(s, v, t_max);
  require_valid(s);
  count_exact();
  return detail::segment_meets_exactly(s, make<Exact>(v), Exact(t_max));
}

inline bool decided_or_exact(FilterAnswer answer, const GrownShape& s, Vec2 v, double t_max) {
  if (answer == FilterAnswer::uncertain) return segment_meets_exact_stage(s, v, t_max);
  return detail::count_filtered(answer == FilterAnswer::intersects);
}

[[gnu::noinline]] bool segment_meets_polygon(const GrownShape& s, const Vec2* vertices, std::size_t count, Vec2 v,
                                             double t_max) {
  require_segment(s, v, t_max);
  EXACTVO_REQUIRE(count > 0, excerpt(s.shape));
  const GrownPolygon grown(vertices, count, s.origin, s.radius);
  const bool meets = grown.meets(v, t_max);
  if (grown.was_exact()) require_valid(s);
  grown.was_exact() ? count_exact() : count_filter();
  return meets;
}

[[gnu::noinline]] bool segment_meets_segment(const GrownShape& s, const Segment& g, Vec2 v, double t_max) {
  const Vec2 ends[2] = {g.a, g.b};
  return segment_meets_polygon(s, ends, 2, v, t_max);
}

// --- Predicate F ---

/// (A + B - C')^3 + 27 A B C' with A = a^2 gx^2, B = b^2 gy^2, C' = factor (a^2 - b^2)^2. Its sign is that of
/// A^(1/3) + B^(1/3) - C'^(1/3), since x + 3 cbrt(y) and x^3 + 27 y agree in sign. In terms of Sigma = L L^T and u =
/// goal - centre: A + B = u.Sigma u, (a^2 - b^2)^2 = tr^2 - 4 det, A B (a^2 - b^2)^2 = det (u x Sigma u)^2: all
/// rational.
template <typename T>
T evolute_polynomial(const Ellipse& e, Vec2 goal, double factor) {
  const T l11(e.l11), l21(e.l21), l22(e.l22);
  const T s11 = l11 * l11, s12 = l11 * l21, s22 = l21 * l21 + l22 * l22;
  const Vector<T> u = difference<T>(goal, e.center);
  const Vector<T> su{s11 * u.x + s12 * u.y, s12 * u.x + s22 * u.y};
  const T det = squared(T(l11 * l22));
  // tr^2 - 4 det as a sum of squares.
  const T spread = squared(T(s11 - s22)) + T(4) * squared(s12);
  const T f = T(factor);
  const T x = dot(u, su) - f * spread;
  return x * x * x + T(27) * f * det * squared(cross(u, su));
}

[[gnu::noinline, gnu::cold]] Sign sign_of_support_exactly(const GrownShape& s, Vec2 n, double tau, double c) {
  count_exact();
  require_valid(s);
  const SupportParts parts = parts_of(s, n);
  return detail::sign_with_two_roots(parts.k - Exact(tau) * Exact(c), parts.b, parts.d);
}

}  // namespace

Sign sign_of_support(const GrownShape& s, Vec2 n, double tau, double c) {
  EXACTVO_REQUIRE(is_finite(n) && std::isfinite(tau) && std::isfinite(c), show(n));
  const SupportValue v = support(s, n);
  const double shift = tau * c;
  const double value = v.h - shift;
  const double bound = kSupportError * (v.magnitude + std::fabs(shift)) + kSupportUnderflow;
  if (std::fabs(value) > bound) {
    count_filter();
    return sign_of_double(value);
  }
  return sign_of_support_exactly(s, n, tau, c);
}

bool half_plane_is_safe(const GrownShape& s, double tau, const HalfPlane& h) {
  EXACTVO_REQUIRE(tau > 0.0, std::to_string(tau));
  if (h.normal == Vec2{}) return h.offset > 0.0;  // no velocity, or every one
  return sign_of_support(s, h.normal, tau, 0.0) != Sign::positive &&
         sign_of_support(s, h.normal, tau, h.offset) != Sign::positive;
}

Place locate(const GrownShape& s, Vec2 q) {
  EXACTVO_REQUIRE(is_finite(q) && s.radius >= 0.0, show(q));
  return std::visit(Locator{s, q}, s.shape);
}

/// A disc is a point grown by both radii; their sum is not a double, so the exact stage is its own.
bool segment_meets(const GrownShape& s, Vec2 direction, double t_max) {
  if (t_max < 0.0 || s.radius < 0.0) return segment_meets_exact_stage(s, direction, t_max);  // refused there
  if (const auto* d = std::get_if<Disc>(&s.shape)) {
    const double reach = d->radius + s.radius;
    return decided_or_exact(segment_disc_filter(d->center - s.origin, direction, t_max, reach * reach), s, direction,
                            t_max);
  }
  if (const auto* e = std::get_if<Ellipse>(&s.shape))
    return decided_or_exact(detail::segment_ellipse_filter(*e, s, direction, t_max), s, direction, t_max);
  if (const auto* g = std::get_if<Segment>(&s.shape)) return segment_meets_segment(s, *g, direction, t_max);
  const std::vector<Vec2>& v = std::get<ConvexPolygon>(s.shape).vertices;
  return segment_meets_polygon(s, v.data(), v.size(), direction, t_max);
}

bool contains(const Ellipse& e, Vec2 x) {
  EXACTVO_REQUIRE(is_finite(x), show(x));
  require_valid(e);
  if (e.l11 == 0.0 || e.l22 == 0.0) return locate({e, {}, 0.0}, x) != Place::outside;
  return filtered_sign([&](auto number) {
           using T = decltype(number);
           const Vector<T> u = difference<T>(x, e.center);
           const T l11(e.l11), l21(e.l21), l22(e.l22);
           return T(squared(T(l22 * u.x)) + squared(T(l11 * u.y - l21 * u.x)) - squared(T(l11 * l22)));
         }) != Sign::positive;
}

Sign orientation(Vec2 a, Vec2 b, Vec2 c) {
  EXACTVO_REQUIRE(is_finite(a) && is_finite(b) && is_finite(c), show(a));
  return filtered_sign([&](auto number) {
    using T = decltype(number);
    return T(cross(difference<T>(b, a), difference<T>(c, a)));
  });
}

bool goal_outside_evolute(const Ellipse& ellipse, Vec2 goal, double slack) {
  EXACTVO_REQUIRE(is_finite(goal) && slack >= 0.0 && std::isfinite(slack), show(goal));
  require_valid(ellipse);
  const double factor = (1.0 + slack) * (1.0 + slack) * (1.0 + slack);
  return filtered_sign([&](auto number) { return evolute_polynomial<decltype(number)>(ellipse, goal, factor); }) ==
         Sign::positive;
}

}  // namespace exactvo::geometry
