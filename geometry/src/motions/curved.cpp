// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions/curved.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motions/real_roots.h"

namespace exactvo::geometry::motions {
namespace {

using Filtered = Vector<RunningError>;
using Rational = mpq_class;
using RationalPoint = Vector<Rational>;

/// How often a piece is halved, and how many pieces are looked at, before the exact stage is asked. A running error
/// chains d additions a halving: 10 * 24 are far from its 2^10.
constexpr int kMostHalvings = 24;
constexpr int kMostPieces = 160;

/// De Casteljau at 1/2: the halves' control points.
void halve(const std::vector<Filtered>& whole, std::vector<Filtered>& first, std::vector<Filtered>& second) {
  const std::size_t n = whole.size();
  second = whole;
  first.resize(n);
  const RunningError half(0.5);
  for (std::size_t k = 0; k < n; ++k) {
    first[k] = second[0];
    for (std::size_t i = 0; i + 1 < n - k; ++i) second[i] = half * (second[i] + second[i + 1]);
  }
  // What is left runs from the curve's middle on: second[i] is the last of row n - 1 - i.
}

/// At least the number that is meant.
double upper(const RunningError& x) {
  constexpr double kSlack = 1.0 + 0x1p-40;
  return (std::fabs(x.value) + x.error * kSlack) * (1.0 + 0x1p-50);
}

/// At least how far the curve strays from its chord.
double stray_of(const std::vector<Filtered>& b) {
  const std::size_t d = b.size() - 1;
  if (d < 2) return 0.0;
  double most = 0.0;
  const RunningError degree(static_cast<double>(d));
  for (std::size_t i = 1; i < d; ++i) {
    const RunningError to(static_cast<double>(i)), from(static_cast<double>(d - i));
    const Filtered off = degree * b[i] - (from * b.front() + to * b.back());
    most = std::max(most, std::hypot(upper(off.x), upper(off.y)));
  }
  return most / static_cast<double>(d) * (1.0 + 0x1p-40);
}

struct CurvePiece {
  std::vector<Filtered> points;
  int halvings;
};

std::optional<Encounter> verdict_of(const std::vector<Filtered>& b, const GrownHull<RunningError>& hull) {
  GrownHull<RunningError> other = hull;
  const double stray = stray_of(b);
  if (!std::isfinite(stray)) return std::nullopt;
  other.reach = hull.reach + RunningError(stray);
  if (straight_gap(b.front(), b.back(), other) == Known::positive) return Encounter::clear;
  if (point_gap(b.front(), hull) == Known::negative || point_gap(b.back(), hull) == Known::negative)
    return Encounter::overlap;
  other.reach = hull.reach - RunningError(stray);
  if (sign_of(other.reach) == Known::positive && straight_gap(b.front(), b.back(), other) == Known::negative)
    return Encounter::overlap;
  return std::nullopt;
}

/// A union of conditions: all polynomials of one are below zero.
using Condition = std::vector<std::vector<Rational>>;

std::vector<Rational> sum(const std::vector<Rational>& a, const std::vector<Rational>& b, int sign = 1) {
  std::vector<Rational> c(std::max(a.size(), b.size()));
  for (std::size_t k = 0; k < a.size(); ++k) c[k] += a[k];
  for (std::size_t k = 0; k < b.size(); ++k) c[k] += sign * b[k];
  return c;
}
std::vector<Rational> product(const std::vector<Rational>& a, const std::vector<Rational>& b) {
  std::vector<Rational> c(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) c[i + k] += a[i] * b[k];
  return c;
}

/// The way's coordinates as polynomials, as seen from a point.
struct SeenWay {
  std::vector<Rational> x, y;
  SeenWay(const std::vector<RationalPoint>& path, const RationalPoint& from) {
    for (const RationalPoint& c : path) {
      x.push_back(c.x);
      y.push_back(c.y);
    }
    x[0] -= from.x;
    y[0] -= from.y;
  }
  /// n.p
  std::vector<Rational> along(const RationalPoint& n) const {
    std::vector<Rational> c;
    for (std::size_t k = 0; k < x.size(); ++k) c.emplace_back(n.x * x[k] + n.y * y[k]);
    return c;
  }
};

Condition near_vertex(const SeenWay& seen, const Rational& reach2) {
  return {sum(sum(product(seen.x, seen.x), product(seen.y, seen.y)), {reach2}, -1)};
}

/// Beside the edge, not beyond its ends: cross^2 < reach^2 L, 0 < along < L.
Condition near_edge(const SeenWay& seen, const RationalPoint& e, const Rational& reach2) {
  const Rational length2 = dot(e, e);
  const std::vector<Rational> across = seen.along({Rational(-e.y), e.x}), along = seen.along(e);
  return {sum(product(across, across), {Rational(reach2 * length2)}, -1), sum({Rational(0)}, along, -1),
          sum(along, {length2}, -1)};
}

std::vector<Condition> conditions_of(const std::vector<RationalPoint>& path, const GrownHull<Rational>& hull) {
  const std::vector<RationalPoint>& v = hull.vertices;
  const Rational reach2 = hull.reach * hull.reach;
  const bool only_inside = v.size() > 2 && sgn(reach2) == 0;
  std::vector<Condition> conditions;
  Condition inside;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const SeenWay seen(path, v[i]);
    if (!only_inside) conditions.push_back(near_vertex(seen, reach2));
    if (v.size() == 1 || (v.size() == 2 && i == 1)) continue;
    const RationalPoint e = v[(i + 1) % v.size()] - v[i];
    if (!only_inside) conditions.push_back(near_edge(seen, e, reach2));
    inside.push_back(seen.along({e.y, Rational(-e.x)}));
  }
  if (v.size() > 2) conditions.push_back(inside);
  return conditions;
}

bool holds_at_some_time(const Condition& condition, Ends ends) {
  TimeSet times = {{Rational(0), Rational(1)}};
  for (const std::vector<Rational>& polynomial : condition) {
    times = common_times(std::move(times), times_below_zero(primitive(polynomial), ends), ends);
    if (times.empty()) return false;
  }
  return true;
}

}  // namespace

std::optional<Encounter> curved_by_filter(const std::vector<Filtered>& control_points,
                                          const GrownHull<RunningError>& hull) {
  const Known reach = sign_of(hull.reach);
  if (reach == Known::negative) return Encounter::clear;
  if (reach == Known::unknown) return std::nullopt;
  std::vector<CurvePiece> open{{control_points, 0}};
  for (int looked_at = 0; !open.empty(); ++looked_at) {
    const CurvePiece piece = std::move(open.back());
    open.pop_back();
    const std::optional<Encounter> verdict = verdict_of(piece.points, hull);
    if (verdict == Encounter::overlap) return verdict;
    if (verdict == Encounter::clear) continue;
    if (looked_at >= kMostPieces || piece.halvings >= kMostHalvings || piece.points.size() <= 2) return std::nullopt;
    CurvePiece first{{}, piece.halvings + 1}, second{{}, piece.halvings + 1};
    halve(piece.points, first.points, second.points);
    open.push_back(std::move(second));
    open.push_back(std::move(first));
  }
  return Encounter::clear;
}

Encounter curved_exactly(const std::vector<RationalPoint>& path, const GrownHull<Rational>& hull) {
  if (sgn(hull.reach) < 0) return Encounter::clear;
  const std::vector<Condition> conditions = conditions_of(path, hull);
  const auto some = [&](Ends ends) {
    return std::any_of(conditions.begin(), conditions.end(),
                       [&](const Condition& c) { return holds_at_some_time(c, ends); });
  };
  if (some(Ends::open)) return Encounter::overlap;
  return some(Ends::closed) ? Encounter::contact : Encounter::clear;
}

}  // namespace exactvo::geometry::motions
