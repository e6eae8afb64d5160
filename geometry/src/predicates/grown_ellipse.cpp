// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: E = { centre + L w : |w| <= 1 }, L = [l11 0; l21 l22]; r the radius of the disc; u the centre seen from the
// point; T = |L|^2 (Frobenius), D = det(L)^2, R = r^2, Q = |adj(L) u|^2, U = |u|^2.
//
// A point is outside E (+) D(0, r) iff the disc of radius r round it and E are separate. By Wang, Wang and Kim (2001)
// they are iff the cubic g(x) = x^3 + b x^2 + c x + d with b = T + R - U, c = D + R T - Q, d = R D has two distinct
// positive roots; they touch from outside iff it has a double positive root. Since d > 0, the product of the roots is
// negative: one root is negative, and the others are positive iff they are real and b < 0 or c < 0 (Descartes). Hence
//
//     outside:  discriminant > 0 and (b < 0 or c < 0)        boundary:  discriminant = 0 and (b < 0 or c < 0)
//
// This does not hold for R D = 0. A point against the bare ellipse (R = 0) is decided by the sign of c; E without width
// (D = 0) by the distance from a segment.
#include "predicates/grown_ellipse.h"

#include <cmath>

#include "exactvo/geometry/support.h"
#include "predicates/exact_sweep.h"

namespace exactvo::geometry::detail {
namespace {

// --- A point against ellipse (+) disc, exactly ---

/// The coefficients of g.
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
  return {trace + R - dot(u, u), det + R * trace - Q, R * det};
}

template <typename T>
T discriminant(const SeparationCubic<T>& g) {
  return T(18) * g.b * g.c * g.d - T(4) * g.b * g.b * g.b * g.d + g.b * g.b * g.c * g.c - T(4) * g.c * g.c * g.c -
         T(27) * g.d * g.d;
}

Place place_of(Sign distance_minus_radius) {
  return static_cast<Place>(static_cast<int>(distance_minus_radius));
}

/// l11 = 0: the vertical segment of squared half-length m = l21^2 + l22^2, grown by r.
Place locate_vertical(const Ellipse& e, const Vector<Exact>& u, const Exact& r) {
  const Exact m = squared(Exact(e.l21)) + squared(Exact(e.l22));
  if (!(m < squared(u.y))) return place_of(sign_of(squared(u.x) - r * r));
  // Beyond an end: ux^2 + (|uy| - sqrt m)^2 - r^2 = k - 2 |uy| sqrt m.
  const Exact k = dot(u, u) + m - r * r;
  if (sign_of(k) == Sign::negative) return Place::inside;
  return place_of(sign_of(k * k - Exact(4) * squared(u.y) * m));
}

Place locate_ellipse_exact(const Ellipse& e, const Vector<Exact>& u, const Exact& r) {
  if (e.l11 == 0.0) return locate_vertical(e, u, r);
  if (e.l22 == 0.0) {  // the segment between the points +-(l11, l21), grown by r
    const Vector<Exact> h{Exact(e.l11), Exact(e.l21)};
    return place_of(distance_sign({Exact(0), Exact(0)}, u - h, u + h, r));
  }
  const SeparationCubic<Exact> g = separation_cubic(e, r, u);
  // r = 0: Q - D = -c.
  if (sign_of(r) == Sign::zero) return place_of(sign_of(Exact(0) - g.c));
  const Sign disc = sign_of(discriminant(g));
  const bool apart = sign_of(g.b) == Sign::negative || sign_of(g.c) == Sign::negative;
  if (disc == Sign::zero) return apart ? Place::boundary : Place::inside;
  return apart && disc == Sign::positive ? Place::outside : Place::inside;
}

// --- The same in doubles ---

/// The cap on squared lengths under which products that underflow stay below the absolute bounds here: an error of at
/// most 2^-1075 each, multiplied by at most the cap once in c and five times in the discriminant.
constexpr double kLargestSquare = 0x1p120;
constexpr double kUnderflowB = 0x1p-1060;
constexpr double kUnderflowC = 0x1p-930;
constexpr double kUnderflowDiscriminant = 0x1p-450;
/// With u known up to 2u of its magnitude: b = T + R - U errs by 8 u of the sum of its absolute terms; c = D + R T - Q
/// by 12 u; d by 5 u. The monomials of the discriminant then err by at most 43 u each, and 4 u more for their sum.
/// Twice that leaves room for the second order and for the rounding of the bound.
constexpr double kErrorB = 16.0 * kUnitRoundoff;
constexpr double kErrorC = 24.0 * kUnitRoundoff;
constexpr double kErrorDiscriminant = 96.0 * kUnitRoundoff;

}  // namespace

bool locate_rounded(const Ellipse& e, Vec2 u, Vec2 size, double r, Place& place) {
  const double R = r * r;
  const double trace = e.l11 * e.l11 + e.l21 * e.l21 + e.l22 * e.l22;
  const double det = e.l11 * e.l22;
  const double D = det * det;
  const double vx = e.l22 * u.x;
  const double vy = e.l11 * u.y - e.l21 * u.x;
  const double size_vx = e.l22 * size.x;
  const double size_vy = std::fabs(e.l11) * size.y + std::fabs(e.l21) * size.x;
  const double b = trace + R - squared_norm(u);
  const double size_b = trace + R + squared_norm(size);
  const double c = D + R * trace - (vx * vx + vy * vy);
  const double size_c = D + R * trace + (size_vx * size_vx + size_vy * size_vy);
  if (!(size_b <= kLargestSquare) || det == 0.0) return false;
  const double error_b = kErrorB * size_b + kUnderflowB;
  const double error_c = kErrorC * size_c + kUnderflowC;
  if (r == 0.0) {
    place = c > 0.0 ? Place::inside : Place::outside;
    return std::fabs(c) > error_c;
  }
  if (b > error_b && c > error_c) {
    place = Place::inside;
    return true;
  }
  const double d = R * D;
  const double disc = discriminant(SeparationCubic<double>{b, c, d});
  const double size_disc = size_b * (size_c * (18.0 * d + size_b * size_c) + 4.0 * size_b * size_b * d) +
                           4.0 * size_c * size_c * size_c + 27.0 * d * d;
  const double error = kErrorDiscriminant * size_disc + kUnderflowDiscriminant;
  place = disc > 0.0 ? Place::outside : Place::inside;
  return std::fabs(disc) > error && (disc < 0.0 || b < -error_b || c < -error_c);
}

Place locate_exactly(const Ellipse& e, const GrownShape& s, const Vector<Exact>& q) {
  return locate_ellipse_exact(e, difference<Exact>(e.center, s.origin) - q, Exact(s.radius));
}

namespace {

// --- The segment [0, t_max direction] against ellipse (+) disc, exactly ---

/// Where the line through 0 along v meets ellipse (+) disc: the parameter t of one point of the chord, as
/// t |v|^2 (b + sqrt f) = (p.v)(b + sqrt f) - (N.p)(v.Sigma N), N = perp(v), b = N.Sigma N, f = b r^2 |N|^2.
struct ChordPoint {
  Exact rational, root, scale_rational, scale_root, f;

  /// Sign of (chord parameter - t).
  Sign compare(const Exact& t) const { return sign_with_root(rational - t * scale_rational, root - t * scale_root, f); }
};

ChordPoint chord_point(const Ellipse& e, const GrownShape& s, const Vector<Exact>& d) {
  const Vector<Exact> p = difference<Exact>(e.center, s.origin);
  const Vector<Exact> normal{Exact(0) - d.y, d.x};
  const Exact l11(e.l11), l21(e.l21), l22(e.l22);
  const Vector<Exact> ln{l11 * normal.x + l21 * normal.y, l22 * normal.y};
  const Vector<Exact> ld{l11 * d.x + l21 * d.y, l22 * d.y};
  const Exact b = dot(ln, ln);
  const Exact length2 = dot(d, d);
  const Exact pv = dot(p, d);
  const Exact tilt = dot(normal, p) * dot(ld, ln);
  // b = 0: the ellipse is a segment along v (or a point); the chord holds the foot of its centre.
  if (sign_of(b) == Sign::zero) return {pv, Exact(0), length2, Exact(0), Exact(0)};
  return {pv * b - tilt, pv, length2 * b, length2, b * squared(Exact(s.radius)) * length2};
}

/// Whether the line through the origin along v meets S: |N.p| <= h of the centred shape in direction N.
bool line_meets(const Ellipse& e, const GrownShape& s, const Vector<Exact>& v) {
  const Vector<Exact> p = difference<Exact>(e.center, s.origin);
  const Vector<Exact> n{Exact(0) - v.y, v.x};
  Exact k = dot(n, p);
  if (sign_of(k) == Sign::positive) k = Exact(0) - k;
  const Exact wx = Exact(e.l11) * n.x + Exact(e.l21) * n.y;
  const Exact wy = Exact(e.l22) * n.y;
  return sign_with_two_roots(k, wx * wx + wy * wy, squared(Exact(s.radius)) * dot(n, n)) != Sign::negative;
}

// --- The same in doubles ---

/// A cap on every size, so that an underflowed root (2^-537 at most) and underflowed products (2^-1075), multiplied by
/// at most five sizes, stay below kUnderflowTime.
constexpr double kLargestSize = 0x1p40;
constexpr double kUnderflowTime = 0x1p-300;
/// N.p errs by 3 u, |L^T N| by 6 u, r |N| by 4 u of their magnitudes: as predicate A.
constexpr double kErrorLine = 16.0 * kUnitRoundoff;
/// (p.v - t |v|^2)(b + sqrt f) errs by (4 + 13) u, (N.p)(v.Sigma N) by 12 u of their magnitudes; twice that and more.
constexpr double kErrorTime = 48.0 * kUnitRoundoff;

FilterAnswer answer_of(bool decided, bool meets) {
  return !decided ? FilterAnswer::uncertain : meets ? FilterAnswer::intersects : FilterAnswer::disjoint;
}

/// By the line first, then by where on it.
FilterAnswer segment_rounded_ellipse_filter(const Ellipse& e, const GrownShape& s, Vec2 p, Vec2 v, double t_max) {
  const double np = cross(v, p);
  const Vec2 ln{e.l21 * v.x - e.l11 * v.y, e.l22 * v.x};
  const double speed2 = squared_norm(v);
  const double root = std::sqrt(squared_norm(ln));
  const double reach = s.radius * std::sqrt(speed2);
  // Sums of absolute values bound every product's terms.
  const double size_p = std::fabs(p.x) + std::fabs(p.y);
  const double size_v = std::fabs(v.x) + std::fabs(v.y);
  const double size_l = std::fabs(e.l11) + std::fabs(e.l21) + std::fabs(e.l22);
  const double error_line = kErrorLine * size_v * (size_p + size_l + s.radius) + kSupportUnderflow;
  const double gap = std::fabs(np) - root - reach;
  if (gap > error_line) return FilterAnswer::disjoint;
  if (!(gap < -error_line)) return FilterAnswer::uncertain;
  // Where on the line: the sign of A (b + sqrt f) - tilt at t = 0 and t = t_max.
  const Vec2 ld{e.l11 * v.x + e.l21 * v.y, e.l22 * v.y};
  const double width = root * (root + reach);
  const double beyond = t_max * speed2;
  const double at_start = dot(p, v) * width - np * dot(ld, ln);
  const double at_end = at_start - beyond * width;
  if (!(size_p + size_v + size_l + s.radius + beyond <= kLargestSize) || e.l11 == 0.0 || e.l22 == 0.0)
    return FilterAnswer::uncertain;
  const double size_root = size_l * size_v;
  const double error =
      kErrorTime * size_root * ((size_p * size_v + beyond) * (size_root + reach) + size_p * size_v * size_root) +
      kUnderflowTime;
  if (at_start > error && at_end < -error) return FilterAnswer::intersects;
  // The chord lies behind or ahead: the nearer end decides.
  Place place{};
  const Vec2 q = t_max * v;
  const bool ahead = at_end > error;
  if (!ahead && !(at_start < -error)) return FilterAnswer::uncertain;
  const Vec2 size{std::fabs(p.x) + (ahead ? std::fabs(q.x) : 0.0), std::fabs(p.y) + (ahead ? std::fabs(q.y) : 0.0)};
  const bool decided = locate_rounded(e, ahead ? p - q : p, size, s.radius, place);
  return answer_of(decided, place != Place::outside);
}

}  // namespace

/// With T = |L|^2 (Frobenius), D = det(L)^2 and R = r^2 the semi-axes are at most sqrt(T) and at least sqrt(D / T), so
/// S lies between the discs of squared radius 2 (T + R) >= (sqrt(T) + r)^2 and D / T + R round its centre. Those,
/// rounded, are off by 5 u and 8 u; 0 / 0 decides nothing.
FilterAnswer segment_ellipse_filter(const Ellipse& e, const GrownShape& s, Vec2 v, double t_max) {
  const Vec2 p = e.center - s.origin;
  const double trace = e.l11 * e.l11 + e.l21 * e.l21 + e.l22 * e.l22;
  const double R = s.radius * s.radius;
  if (segment_disc_filter(p, v, t_max, 2.0 * (trace + R)) == FilterAnswer::disjoint) return FilterAnswer::disjoint;
  const double det = e.l11 * e.l22;
  if (segment_disc_filter(p, v, t_max, det * det / trace + R) == FilterAnswer::intersects)
    return FilterAnswer::intersects;
  return segment_rounded_ellipse_filter(e, s, p, v, t_max);
}

bool segment_meets_exactly(const Ellipse& e, const GrownShape& s, const Vector<Exact>& v, const Exact& t_max) {
  if (!line_meets(e, s, v)) return false;
  const ChordPoint chord = chord_point(e, s, v);
  if (chord.compare(Exact(0)) != Sign::positive) return locate_exactly(e, s, {Exact(0), Exact(0)}) != Place::outside;
  if (chord.compare(t_max) != Sign::negative) return locate_exactly(e, s, {t_max * v.x, t_max * v.y}) != Place::outside;
  return true;
}

}  // namespace exactvo::geometry::detail
