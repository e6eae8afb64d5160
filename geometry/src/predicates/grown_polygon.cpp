// SPDX-License-Identifier: GPL-3.0-or-later
#include "predicates/grown_polygon.h"

#include <algorithm>
#include <limits>

#include "exact/exact_vector.h"
#include "exactvo/geometry/support.h"
#include "predicates/exact_sweep.h"

namespace exactvo::geometry::detail {
namespace {

/// Coordinates have a relative error u, their differences 2 u of the sums of sizes, a product of two differences 5 u, a
/// dot or cross product 6 u of the product of sizes: 8 u leaves room for the second order.
constexpr double kProduct = 8.0 * kUnitRoundoff;
/// Squares of such products against r^2 times a square: 2 * 6 + 1 + 1 u on one side, 1 + 12 + 1 u on the other.
constexpr double kSquares = 32.0 * kUnitRoundoff;
/// Every product that underflows errs by at most 2^-1075, here multiplied by at most kLargestCoordinate^2.
constexpr double kLargestCoordinate = 0x1p100;  // of a coordinate, m; larger ones are decided exactly
constexpr double kUnderflowRoom = 0x1p-600;
constexpr double kLeastSquare = 0x1p-900;  // of a speed: neither lost to underflow nor short of digits

Vector<Exact> exactly(const Seen& p) {
  const Exact scale(p.scale);
  return {scale * Exact(p.base.x) - Exact(p.origin.x), scale * Exact(p.base.y) - Exact(p.origin.y)};
}

/// Sign of a double known up to `error`; sets `known` to false where it is in doubt (NaN is doubt).
Sign filtered(double value, double error, bool& known) {
  if (value > error) return Sign::positive;
  if (value < -error) return Sign::negative;
  known = false;
  return Sign::zero;
}

Sign rounded_distance(const Seen& q, const Seen& a, const Seen& b, double r, bool& known) {
  const Vec2 e = b.at - a.at;
  const Vec2 d = q.at - a.at;
  const bool is_point = a.base == b.base && a.scale == b.scale;
  const double size_e = a.size + b.size;
  const double size_d = q.size + a.size;
  if (!(size_e + size_d + r <= kLargestCoordinate)) {
    known = false;
    return Sign::zero;
  }
  const double dot_de = dot(d, e);
  const double error_dot = kProduct * size_d * size_e + kUnderflowRoom;
  if (is_point || filtered(dot_de, error_dot, known) != Sign::positive)
    return filtered(squared_norm(d) - r * r, kSquares * (size_d * size_d + r * r) + kUnderflowRoom, known);
  const double length2 = squared_norm(e);
  if (filtered(length2 - dot_de, error_dot + kProduct * size_e * size_e, known) != Sign::positive) {
    const double size_f = q.size + b.size;
    return filtered(squared_norm(q.at - b.at) - r * r, kSquares * (size_f * size_f + r * r) + kUnderflowRoom, known);
  }
  const double c = cross(e, d);
  const double r2 = r * r;
  return filtered(c * c - r2 * length2, kSquares * size_e * size_e * (size_d * size_d + r2) + kUnderflowRoom, known);
}

}  // namespace

Sign GrownPolygon::turn(const Seen& a, const Seen& b, const Seen& c) const {
  const double size_e = a.size + b.size;
  const double size_d = a.size + c.size;
  bool known = size_e + size_d <= kLargestCoordinate;
  const Sign sign = filtered(cross(b.at - a.at, c.at - a.at), kProduct * size_e * size_d + kUnderflowRoom, known);
  if (known) return sign;
  was_exact_ = true;
  const Vector<Exact> p = exactly(a);
  return sign_of(cross(exactly(b) - p, exactly(c) - p));
}

/// The sign of dist(q, [a, b]) - r.
Sign GrownPolygon::distance_to_segment(const Seen& q, const Seen& a, const Seen& b) const {
  bool known = true;
  const Sign sign = rounded_distance(q, a, b, radius_, known);
  if (known) return sign;
  was_exact_ = true;
  return distance_sign(exactly(q), exactly(a), exactly(b), Exact(radius_));
}

/// The nearest point of a convex polygon lies on an edge that q is not strictly left of; where there is none, q is
/// inside. Edges of length 0 count only where there are no others.
Place GrownPolygon::place_of(const Seen& q) const {
  bool any_edge = false;
  bool inside = true;
  Sign best = Sign::positive;
  Seen a = vertex(0);
  for (std::size_t i = 0; i < count_ && best != Sign::negative; ++i) {
    const Seen b = vertex(i + 1);
    if (a.base != b.base) {
      any_edge = true;
      if (turn(a, b, q) != Sign::positive) {
        inside = false;
        best = std::min(best, distance_to_segment(q, a, b));
      }
    }
    a = b;
  }
  if (!any_edge) best = distance_to_segment(q, a, a);
  return any_edge && inside ? Place::inside : static_cast<Place>(static_cast<int>(best));
}

/// The vertices' extents across and along the direction. S misses the segment where it lies to one side of its line,
/// behind the robot or beyond the end. Where all vertices lie ahead and before the end and the line passes between them
/// or within r of one, it is met there.
///
/// A vertex p (in error by u) has products with v along and across it that err by less than 4 u |p| |v| each, and |p|
/// |v| is at most 2^(1/2) times the larger of them: 24 u times the largest of all vertices is more than any errs.
/// `reach` and `beyond` err by less than 4 u of themselves, where |v|^2 has all its digits. The sum has a NaN or an
/// infinity wherever a vertex has; where products overflow, one of the two is infinite.
GrownPolygon::Slab GrownPolygon::slab(Vec2 direction, double t_max) const {
  const double infinity = std::numeric_limits<double>::infinity();
  double left = -infinity, right = infinity, ahead = -infinity, behind = infinity, sum = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec2 p = vertices_[i] - origin_;
    const double across = cross(direction, p);
    const double forward = dot(direction, p);
    left = std::max(left, across);
    right = std::min(right, across);
    ahead = std::max(ahead, forward);
    behind = std::min(behind, forward);
    sum += across;  // extremes lose a NaN
  }
  const double speed2 = squared_norm(direction);
  const double reach = radius_ * std::sqrt(speed2);
  const double beyond = t_max * speed2;
  const double size = std::max(std::max(left, -right), std::max(ahead, -behind));
  if (!(size + t_max + radius_ + std::fabs(sum) <= kLargestCoordinate && speed2 >= kLeastSquare &&
        speed2 <= kLargestCoordinate * kLargestCoordinate))
    return {};
  const double error = kProduct * (3.0 * size + reach + beyond) + kUnderflowRoom;
  const double far = reach + error;
  // Bits, not jumps: which of the four it will be, nobody can guess.
  if ((right > far) | (left < -far) | (ahead < -far) | (behind > beyond + far)) return {Slab::misses};
  const double near = reach - error;
  if ((right < near) & (left > -near) & (behind > error) & (ahead < beyond - error)) return {Slab::meets};
  return {Slab::unknown, behind > far, ahead < beyond - far};
}

bool GrownPolygon::meets(Vec2 direction, double t_max) const {
  const Slab quick = slab(direction, t_max);
  if (quick.verdict != Slab::unknown) return quick.verdict == Slab::meets;
  const Seen start = along(direction, 0.0);
  const Seen end = along(direction, t_max);
  if (!quick.start_is_clear && place_of(start) != Place::outside) return true;
  if (!quick.end_is_clear && place_of(end) != Place::outside) return true;
  if (!(t_max > 0.0)) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    const Seen a = vertex(i);
    if (distance_to_segment(a, start, end) != Sign::positive) return true;
    if (count_ < 2) continue;
    const Seen b = vertex(i + 1);
    if (static_cast<int>(turn(a, b, start)) * static_cast<int>(turn(a, b, end)) < 0 &&
        static_cast<int>(turn(start, end, a)) * static_cast<int>(turn(start, end, b)) < 0)
      return true;
  }
  return false;
}

}  // namespace exactvo::geometry::detail
