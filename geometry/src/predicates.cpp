// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/predicates.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "exact_number.h"
#include "exactvo/geometry/require.h"
#include "running_error.h"

namespace exactvo::geometry {
namespace {

using detail::decided;
using detail::Exact;
using detail::sign_of;
using detail::Tracked;

std::atomic<std::uint64_t> g_filter{0};
std::atomic<std::uint64_t> g_exact{0};

void count_filter() {
  g_filter.fetch_add(1, std::memory_order_relaxed);
}
void count_exact() {
  g_exact.fetch_add(1, std::memory_order_relaxed);
}

std::string show(Vec2 v) {
  return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ")";
}

Sign sign_of_double(double x) {
  return x > 0 ? Sign::positive : x < 0 ? Sign::negative : Sign::zero;
}

/// Evaluates `formula(number<T>)` in tracked doubles and, where the sign stays in doubt, exactly. `formula` is generic
/// and uses + - * only.
template <typename Formula>
Sign filtered_sign(const Formula& formula) {
  const Tracked approx = formula(Tracked{});
  if (decided(approx)) {
    count_filter();
    return sign_of_double(approx.value);
  }
  count_exact();
  return sign_of(formula(Exact{}));
}

template <typename T>
struct Vector {
  T x, y;
};
template <typename T>
Vector<T> make(Vec2 v) {
  return {T(v.x), T(v.y)};
}
template <typename T>
Vector<T> difference(Vec2 a, Vec2 b) {
  return {T(a.x) - T(b.x), T(a.y) - T(b.y)};
}
template <typename T>
Vector<T> minus(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <typename T>
T dot_of(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y;
}
template <typename T>
T cross_of(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.y - a.y * b.x;
}
template <typename T>
T squared(const T& a) {
  return a * a;
}

// --- Predicate A ---

/// Sign of k + sqrt(b) + sqrt(d), b, d >= 0, by repeated squaring.
Sign sign_with_two_roots(const Exact& k, const Exact& b, const Exact& d) {
  const Sign sk = sign_of(k);
  if (sk == Sign::positive) return sk;
  if (sk == Sign::zero) return sign_of(b) == Sign::zero && sign_of(d) == Sign::zero ? Sign::zero : Sign::positive;
  const Exact e = k * k - b - d;
  if (sign_of(e) == Sign::negative) return Sign::positive;
  return sign_of(Exact(4) * b * d - e * e);
}

/// h_S(n) - tau c = k + sqrt(b) + sqrt(d).
struct SupportParts {
  Exact k, b, d;
};

Exact exact_offset(Vec2 n, Vec2 x, Vec2 origin) {
  return dot_of(make<Exact>(n), difference<Exact>(x, origin));
}

Exact farthest(const std::vector<Vec2>& vertices, Vec2 n, Vec2 origin) {
  Exact best = exact_offset(n, vertices.front(), origin);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const Exact value = exact_offset(n, vertices[i], origin);
    if (best < value) best = value;
  }
  return best;
}

Exact exact_squared_norm(Vec2 n) {
  return dot_of(make<Exact>(n), make<Exact>(n));
}

struct PartsOf {
  const GrownShape& s;
  Vec2 n;

  SupportParts operator()(const Disc& disc) const {
    const Exact grown = Exact(disc.radius) + Exact(s.radius);
    return {exact_offset(n, disc.center, s.origin), Exact(0), squared(grown) * exact_squared_norm(n)};
  }
  SupportParts operator()(const Segment& segment) const { return of_vertices({segment.a, segment.b}); }
  SupportParts operator()(const ConvexPolygon& polygon) const { return of_vertices(polygon.vertices); }
  SupportParts operator()(const Ellipse& e) const {
    const Exact wx = Exact(e.l11) * Exact(n.x) + Exact(e.l21) * Exact(n.y);
    const Exact wy = Exact(e.l22) * Exact(n.y);
    return {exact_offset(n, e.center, s.origin), wx * wx + wy * wy, squared(Exact(s.radius)) * exact_squared_norm(n)};
  }
  SupportParts of_vertices(const std::vector<Vec2>& vertices) const {
    return {farthest(vertices, n, s.origin), Exact(0), squared(Exact(s.radius)) * exact_squared_norm(n)};
  }
};

// --- Distances of points, segments and polygons (rational) ---

/// The sign of |q - nearest point of [a, b]|^2 - r^2, for q given as a vector of T.
template <typename T>
T squared_distance_minus(const Vector<T>& q, const Vector<T>& a, const T& r2) {
  const Vector<T> d{q.x - a.x, q.y - a.y};
  return dot_of(d, d) - r2;
}

/// Exact sign of dist(q, [a, b])^2 - r^2.
Sign compare_to_segment(const Vector<Exact>& q, const Vector<Exact>& a, const Vector<Exact>& b, const Exact& r2) {
  const Vector<Exact> e{b.x - a.x, b.y - a.y};
  const Vector<Exact> d{q.x - a.x, q.y - a.y};
  const Exact along = dot_of(d, e);
  const Exact length2 = dot_of(e, e);
  if (sign_of(along) != Sign::positive) return sign_of(squared_distance_minus(q, a, r2));
  if (!(along < length2)) return sign_of(squared_distance_minus(q, b, r2));
  return sign_of(squared(cross_of(e, d)) - r2 * length2);
}

/// Whether q lies in the convex polygon (boundary: `strict` says whether it counts).
bool in_convex(const std::vector<Vector<Exact>>& v, const Vector<Exact>& q, bool strict) {
  if (v.size() < 3) return false;
  bool any_area = false;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vector<Exact>& a = v[i];
    const Vector<Exact>& b = v[(i + 1) % v.size()];
    const Vector<Exact>& c = v[(i + 2) % v.size()];
    const Sign turn = sign_of(cross_of(minus(b, a), minus(q, a)));
    if (turn == Sign::negative ||
        (strict && turn == Sign::zero && (sign_of(b.x - a.x) != Sign::zero || sign_of(b.y - a.y) != Sign::zero)))
      return false;
    any_area = any_area || sign_of(cross_of(minus(b, a), minus(c, b))) != Sign::zero;
  }
  return any_area;
}

std::vector<Vector<Exact>> seen_from(const std::vector<Vec2>& vertices, Vec2 origin) {
  std::vector<Vector<Exact>> out;
  out.reserve(vertices.size());
  for (Vec2 v : vertices) out.push_back(difference<Exact>(v, origin));
  return out;
}

Place place_of(Sign distance_minus_radius) {
  return static_cast<Place>(static_cast<int>(distance_minus_radius));
}

/// Exact place of q with respect to hull(vertices) (+) D(0, r).
Place locate_grown_polygon(const std::vector<Vector<Exact>>& v, const Vector<Exact>& q, const Exact& r) {
  if (in_convex(v, q, /*strict=*/true)) return Place::inside;
  const Exact r2 = r * r;
  Sign best = Sign::positive;
  for (std::size_t i = 0; i < v.size(); ++i) {
    best = std::min(best, compare_to_segment(q, v[i], v[(i + 1) % v.size()], r2));
  }
  return place_of(best);
}

// --- Predicate B1: a point against ellipse (+) disc ---

/// The coefficients of g(x) = x^3 + b x^2 + c x + d (Wang, Wang and Kim 2001), u = centre - point.
template <typename T>
struct SeparationCubic {
  T b, c, d;
};

template <typename T>
SeparationCubic<T> separation_cubic(const Ellipse& e, const T& radius, const Vector<T>& u) {
  const T l11(e.l11), l21(e.l21), l22(e.l22);
  const T R = radius * radius;
  const T trace = l11 * l11 + l21 * l21 + l22 * l22;
  const T det = squared(T(l11 * l22));
  const T Q = squared(T(l22 * u.x)) + squared(T(l11 * u.y - l21 * u.x));
  return {trace + R - dot_of(u, u), det + R * trace - Q, R * det};
}

template <typename T>
T discriminant(const SeparationCubic<T>& g) {
  return T(18) * g.b * g.c * g.d - T(4) * g.b * g.b * g.b * g.d + g.b * g.b * g.c * g.c - T(4) * g.c * g.c * g.c -
         T(27) * g.d * g.d;
}

bool is_segment(const Ellipse& e) {
  return e.l11 == 0.0 || e.l22 == 0.0;
}

/// The end of a degenerate ellipse's segment, relative to its centre, squared length and direction.
Vector<Exact> half_axis(const Ellipse& e) {
  // l22 = 0: { (l11, l21) w }. l11 = 0: vertical, of half-length sqrt(l21^2 + l22^2), which is irrational in general.
  return {Exact(e.l11), Exact(e.l21)};
}

Place locate_capsule(const Ellipse& e, const Vector<Exact>& u, const Exact& r) {
  const Vector<Exact> h = half_axis(e);
  const std::vector<Vector<Exact>> ends{{u.x - h.x, u.y - h.y}, {u.x + h.x, u.y + h.y}};
  return locate_grown_polygon(ends, {Exact(0), Exact(0)}, r);
}

/// l11 = 0: the vertical segment of squared half-length m = l21^2 + l22^2, grown by r.
Place locate_vertical(const Ellipse& e, const Vector<Exact>& u, const Exact& r) {
  const Exact m = squared(Exact(e.l21)) + squared(Exact(e.l22));
  if (!(m < squared(u.y))) return place_of(sign_of(squared(u.x) - r * r));
  // Beyond an end: ux^2 + (|uy| - sqrt m)^2 - r^2 = k - 2 |uy| sqrt m.
  const Exact k = dot_of(u, u) + m - r * r;
  if (sign_of(k) == Sign::negative) return Place::inside;
  return place_of(sign_of(k * k - Exact(4) * squared(u.y) * m));
}

Place locate_ellipse_exact(const Ellipse& e, const Vector<Exact>& u, const Exact& r) {
  if (e.l11 == 0.0) return locate_vertical(e, u, r);
  if (is_segment(e)) return locate_capsule(e, u, r);
  const SeparationCubic<Exact> g = separation_cubic(e, r, u);
  // r = 0: Q - D = -c.
  if (sign_of(r) == Sign::zero) return place_of(sign_of(Exact(0) - g.c));
  const Sign disc = sign_of(discriminant(g));
  const bool apart = sign_of(g.b) == Sign::negative || sign_of(g.c) == Sign::negative;
  if (disc == Sign::zero) return apart ? Place::boundary : Place::inside;
  return apart && disc == Sign::positive ? Place::outside : Place::inside;
}

/// The filter of `locate_ellipse_exact`; false where a sign is in doubt.
bool locate_ellipse_fast(const Ellipse& e, const Vector<Tracked>& u, double r, Place& place) {
  if (r == 0.0 || is_segment(e)) return false;
  const SeparationCubic<Tracked> g = separation_cubic(e, Tracked(r), u);
  if (!decided(g.b) || !decided(g.c)) return false;
  if (g.b.value > 0.0 && g.c.value > 0.0) {
    place = Place::inside;
    return true;
  }
  const Tracked disc = discriminant(g);
  if (!decided(disc)) return false;
  place = disc.value > 0.0 ? Place::outside : Place::inside;
  return true;
}

/// Places q = t * direction (t and direction exact) with respect to S.
struct Locator {
  const GrownShape& s;
  Vec2 q;
  double t;

  template <typename T>
  Vector<T> from_point_to(Vec2 x) const {
    const Vector<T> d = difference<T>(x, s.origin);
    return {d.x - T(t) * T(q.x), d.y - T(t) * T(q.y)};
  }

  Place operator()(const Disc& disc) const {
    return place_of(filtered_sign([&](auto number) {
      using T = decltype(number);
      const Vector<T> u = from_point_to<T>(disc.center);
      return T(dot_of(u, u) - squared(T(T(disc.radius) + T(s.radius))));
    }));
  }
  Place operator()(const Segment& segment) const { return polygon({segment.a, segment.b}); }
  Place operator()(const ConvexPolygon& p) const { return polygon(p.vertices); }
  Place operator()(const Ellipse& e) const {
    Place place{};
    if (locate_ellipse_fast(e, from_point_to<Tracked>(e.center), s.radius, place)) {
      count_filter();
      return place;
    }
    count_exact();
    return locate_ellipse_exact(e, from_point_to<Exact>(e.center), Exact(s.radius));
  }
  Place polygon(const std::vector<Vec2>& vertices) const {
    count_exact();
    const Vector<Exact> point{Exact(t) * Exact(q.x), Exact(t) * Exact(q.y)};
    return locate_grown_polygon(seen_from(vertices, s.origin), point, Exact(s.radius));
  }
};

Place locate_on_ray(const GrownShape& s, Vec2 direction, double t) {
  return std::visit(Locator{s, direction, t}, s.shape);
}

// --- Predicate B2: the segment [0, t_max direction] against S ---

/// Sign of A + B sqrt(f), f >= 0.
Sign sign_with_root(const Exact& a, const Exact& b, const Exact& f) {
  const Sign sa = sign_of(a);
  const Sign sb = sign_of(f) == Sign::zero ? Sign::zero : sign_of(b);
  if (sa == sb || sb == Sign::zero) return sa;
  if (sa == Sign::zero) return sb;
  const Sign larger = sign_of(a * a - b * b * f);
  return larger == Sign::positive ? sa : larger == Sign::negative ? sb : Sign::zero;
}

/// Where the line through 0 along v meets ellipse (+) disc: the parameter t of one point of the chord, as
/// t |v|^2 (b + sqrt f) = (p.v)(b + sqrt f) - (N.p)(v.Sigma N), N = perp(v), b = N.Sigma N, f = b r^2 |N|^2.
struct ChordPoint {
  Exact rational, root, scale_rational, scale_root, f;

  /// Sign of (chord parameter - t).
  Sign compare(const Exact& t) const { return sign_with_root(rational - t * scale_rational, root - t * scale_root, f); }
};

ChordPoint chord_point(const Ellipse& e, const GrownShape& s, Vec2 v) {
  const Vector<Exact> p = difference<Exact>(e.center, s.origin);
  const Vector<Exact> d = make<Exact>(v);
  const Vector<Exact> normal{Exact(0) - d.y, d.x};
  const Exact l11(e.l11), l21(e.l21), l22(e.l22);
  const Vector<Exact> ln{l11 * normal.x + l21 * normal.y, l22 * normal.y};
  const Vector<Exact> ld{l11 * d.x + l21 * d.y, l22 * d.y};
  const Exact b = dot_of(ln, ln);
  const Exact length2 = dot_of(d, d);
  const Exact pv = dot_of(p, d);
  const Exact tilt = dot_of(normal, p) * dot_of(ld, ln);
  // b = 0: the ellipse is a segment along v (or a point); the chord holds the foot of its centre.
  if (sign_of(b) == Sign::zero) return {pv, Exact(0), length2, Exact(0), Exact(0)};
  return {pv * b - tilt, pv, length2 * b, length2, b * squared(Exact(s.radius)) * length2};
}

/// Whether the line through the origin along v meets S: |N.p| <= h of the centred shape in direction N.
bool line_meets(const Ellipse& e, const GrownShape& s, Vec2 v) {
  const PartsOf parts{s, perp(v)};
  SupportParts a = parts(e);
  if (sign_of(a.k) == Sign::positive) a.k = Exact(0) - a.k;
  return sign_with_two_roots(a.k, a.b, a.d) != Sign::negative;
}

bool segment_meets_ellipse(const Ellipse& e, const GrownShape& s, Vec2 v, double t_max) {
  count_exact();
  if (!line_meets(e, s, v)) return false;
  const ChordPoint chord = chord_point(e, s, v);
  if (chord.compare(Exact(0)) != Sign::positive) return locate_on_ray(s, v, 0.0) != Place::outside;
  if (chord.compare(Exact(t_max)) != Sign::negative) return locate_on_ray(s, v, t_max) != Place::outside;
  return true;
}

/// Exact: dist([0, q], hull(v)) <= r. A convex polygon and a segment are nearest at a vertex of one of them, or cross.
bool segment_meets_polygon(const std::vector<Vec2>& vertices, const GrownShape& s, Vec2 direction, double t_max) {
  count_exact();
  const std::vector<Vector<Exact>> v = seen_from(vertices, s.origin);
  const Vector<Exact> zero{Exact(0), Exact(0)};
  const Vector<Exact> q{Exact(t_max) * Exact(direction.x), Exact(t_max) * Exact(direction.y)};
  const Exact r(s.radius);
  if (locate_grown_polygon(v, zero, r) != Place::outside || locate_grown_polygon(v, q, r) != Place::outside)
    return true;
  const Exact r2 = r * r;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vector<Exact>& a = v[i];
    const Vector<Exact>& b = v[(i + 1) % v.size()];
    if (compare_to_segment(a, zero, q, r2) != Sign::positive) return true;
    const Vector<Exact> e{b.x - a.x, b.y - a.y};
    const Sign side_0 = sign_of(cross_of(e, minus(zero, a)));
    const Sign side_q = sign_of(cross_of(e, minus(q, a)));
    const Sign side_a = sign_of(cross_of(q, a));
    const Sign side_b = sign_of(cross_of(q, b));
    if (static_cast<int>(side_0) * static_cast<int>(side_q) < 0 &&
        static_cast<int>(side_a) * static_cast<int>(side_b) < 0)
      return true;
  }
  return false;
}

struct SegmentMeets {
  const GrownShape& s;
  Vec2 v;
  double t_max;

  bool operator()(const Disc& d) const {
    count_exact();
    const Vector<Exact> q{Exact(t_max) * Exact(v.x), Exact(t_max) * Exact(v.y)};
    const Exact r = Exact(d.radius) + Exact(s.radius);
    return compare_to_segment(difference<Exact>(d.center, s.origin), {Exact(0), Exact(0)}, q, r * r) != Sign::positive;
  }
  bool operator()(const Segment& g) const { return segment_meets_polygon({g.a, g.b}, s, v, t_max); }
  bool operator()(const ConvexPolygon& p) const { return segment_meets_polygon(p.vertices, s, v, t_max); }
  bool operator()(const Ellipse& e) const { return segment_meets_ellipse(e, s, v, t_max); }
};

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
  const T x = dot_of(u, su) - f * spread;
  return x * x * x + T(27) * f * det * squared(cross_of(u, su));
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
  count_exact();
  const SupportParts parts = std::visit(PartsOf{s, n}, s.shape);
  return sign_with_two_roots(parts.k - Exact(tau) * Exact(c), parts.b, parts.d);
}

bool half_plane_is_safe(const GrownShape& s, double tau, const HalfPlane& h) {
  EXACTVO_REQUIRE(tau > 0.0, std::to_string(tau));
  return sign_of_support(s, h.normal, tau, 0.0) != Sign::positive &&
         sign_of_support(s, h.normal, tau, h.offset) != Sign::positive;
}

Place locate(const GrownShape& s, Vec2 q) {
  EXACTVO_REQUIRE(is_finite(q), show(q));
  return locate_on_ray(s, q, 1.0);
}

bool segment_meets(const GrownShape& s, Vec2 direction, double t_max) {
  EXACTVO_REQUIRE(is_finite(direction) && t_max >= 0.0 && std::isfinite(t_max), show(direction));
  if (direction == Vec2{}) return locate(s, {}) != Place::outside;
  return std::visit(SegmentMeets{s, direction, t_max}, s.shape);
}

bool contains(const Ellipse& e, Vec2 x) {
  EXACTVO_REQUIRE(is_finite(x), show(x));
  if (is_segment(e)) return locate({e, {}, 0.0}, x) != Place::outside;
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
    return T(cross_of(difference<T>(b, a), difference<T>(c, a)));
  });
}

bool goal_outside_evolute(const Ellipse& ellipse, Vec2 goal, double slack) {
  EXACTVO_REQUIRE(is_finite(goal) && slack >= 0.0 && std::isfinite(slack), show(goal));
  const double factor = (1.0 + slack) * (1.0 + slack) * (1.0 + slack);
  return filtered_sign([&](auto number) { return evolute_polynomial<decltype(number)>(ellipse, goal, factor); }) ==
         Sign::positive;
}

StageCounts stage_counts() {
  return {g_filter.load(std::memory_order_relaxed), g_exact.load(std::memory_order_relaxed)};
}

void reset_stage_counts() {
  g_filter.store(0, std::memory_order_relaxed);
  g_exact.store(0, std::memory_order_relaxed);
}

}  // namespace exactvo::geometry
