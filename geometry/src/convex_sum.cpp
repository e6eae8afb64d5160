// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "exact_number.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

/// Products below this may have lost bits to underflow, so that comparing them decides nothing.
constexpr double kSafeProduct = 0x1p-960;
/// First-order bound of the error of (b - a) x (d - c): 1 u a difference, 1 u a product, 1 u the last; 3 u (|p| + |q|)
/// from the products' factors and results and 1 u more; 8 leaves room for the second order.
constexpr double kTurnError = 8.0 * kUnitRoundoff;

Sign exact_turn(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  using detail::Exact;
  const Exact p = (Exact(b.x) - Exact(a.x)) * (Exact(d.y) - Exact(c.y));
  return detail::sign_of(p - (Exact(b.y) - Exact(a.y)) * (Exact(d.x) - Exact(c.x)));
}

// Whether x = fl(b - a) is exactly b - a (Knuth's two-sum gives what was rounded off).
bool is_exact_difference(double a, double b, double x) {
  const double a_seen = b - x;
  const double b_seen = x + a_seen;
  return (b - b_seen) + (a_seen - a) == 0.0;
}

// Of an edge a -> b: its rounded direction and whether rounding did nothing.
struct Edge {
  Vec2 from;
  Vec2 to;
  Vec2 along;
  bool exact = false;
};

Edge edge_of(Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  return {a, b, d, is_exact_difference(a.x, b.x, d.x) && is_exact_difference(a.y, b.y, d.y)};
}

// The sign of the turn from edge s to edge t. Exact.
Sign turn(const Edge& s, const Edge& t) {
  const double p = s.along.x * t.along.y;
  const double q = s.along.y * t.along.x;
  if (std::fabs(p - q) > kTurnError * (std::fabs(p) + std::fabs(q)) + kSafeProduct) {
    return p > q ? Sign::positive : Sign::negative;
  }
  // Exact directions: rounding keeps the order of the products, and equal ones are told apart by what was rounded off.
  if (s.exact && t.exact && std::fabs(p) > kSafeProduct && std::fabs(q) > kSafeProduct) {
    if (p != q) return p > q ? Sign::positive : Sign::negative;
    const double rest_p = std::fma(s.along.x, t.along.y, -p);
    const double rest_q = std::fma(s.along.y, t.along.x, -q);
    return rest_p > rest_q ? Sign::positive : rest_p < rest_q ? Sign::negative : Sign::zero;
  }
  const bool p_vanishes = s.exact && t.exact && (s.along.x == 0.0 || t.along.y == 0.0);
  const bool q_vanishes = s.exact && t.exact && (s.along.y == 0.0 || t.along.x == 0.0);
  if (p_vanishes && q_vanishes) return Sign::zero;
  return exact_turn(s.from, s.to, t.from, t.to);
}

bool is_lower(Vec2 a, Vec2 b) {
  return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// The directions from angle 0 (included) to pi (excluded).
bool points_up(const Edge& e) {
  return e.to.y > e.from.y || (e.to.y == e.from.y && e.to.x > e.from.x);
}

// A convex polygon's edges from its lowest vertex on: their directions grow from 0 to 2 pi.
class Fan {
 public:
  explicit Fan(const std::vector<Vec2>& vertices) {
    const std::size_t n = vertices.size();
    const auto lowest = std::min_element(vertices.begin(), vertices.end(), is_lower);
    const auto first = static_cast<std::size_t>(lowest - vertices.begin());
    start_ = vertices[first];
    edges_.reserve(n);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = first + k < n ? first + k : first + k - n;
      const Vec2 next = vertices[i + 1 < n ? i + 1 : 0];
      if (vertices[i] != next) edges_.push_back(edge_of(vertices[i], next));
    }
  }

  bool turns_once_to_the_left() const {
    for (std::size_t i = 1; i < edges_.size(); ++i) {
      const bool was_up = points_up(edges_[i - 1]);
      const bool is_up = points_up(edges_[i]);
      if (is_up && !was_up) return false;
      if (is_up == was_up && turn(edges_[i - 1], edges_[i]) == Sign::negative) return false;
    }
    return true;
  }

  Vec2 start() const { return start_; }
  std::size_t size() const { return edges_.size(); }
  const Edge& operator[](std::size_t i) const { return edges_[i]; }

 private:
  Vec2 start_;
  std::vector<Edge> edges_;
};

bool is_place(Vec2 p) {
  return std::fabs(p.x) < 0x1p1000 && std::fabs(p.y) < 0x1p1000;
}

Fan fan_of(const ConvexPolygon& polygon) {
  const auto& v = polygon.vertices;
  EXACTVO_REQUIRE(!v.empty() && std::all_of(v.begin(), v.end(), is_place), to_string(v));
  Fan fan(v);
  EXACTVO_REQUIRE(fan.turns_once_to_the_left(), to_string(v));
  return fan;
}

// What rounding took from fl(a + b).
double lost(double a, double b, double sum) {
  const double part = sum - a;
  return std::fabs((a - (sum - part)) + (b - part));
}

void append_sum(Vec2 a, Vec2 b, ConvexSum& out) {
  const Vec2 sum = a + b;
  out.polygon.vertices.push_back(sum);
  out.error = std::max(out.error, lost(a.x, b.x, sum.x) + lost(a.y, b.y, sum.y));
}

// Positive if s comes first. Of the next edges of two fans the directions are at most pi apart; opposite ones (a
// segment turning back beside a run of collinear edges) are told from parallel ones by the half they point to.
Sign order(const Edge& s, const Edge& t) {
  const Sign sign = turn(s, t);
  if (sign != Sign::zero || points_up(s) == points_up(t)) return sign;
  return points_up(s) ? Sign::positive : Sign::negative;
}

ConvexSum merged(const Fan& a, const Fan& b) {
  ConvexSum out;
  out.polygon.vertices.reserve(a.size() + b.size() + 1);
  Vec2 at_a = a.start();
  Vec2 at_b = b.start();
  append_sum(at_a, at_b, out);
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() || j < b.size()) {
    const Sign next = i == a.size() ? Sign::negative : j == b.size() ? Sign::positive : order(a[i], b[j]);
    if (next != Sign::negative) at_a = a[i++].to;
    if (next != Sign::positive) at_b = b[j++].to;
    append_sum(at_a, at_b, out);
  }
  if (out.polygon.vertices.size() > 1) out.polygon.vertices.pop_back();  // the start again
  return out;
}

}  // namespace

ConvexSum minkowski_sum(const ConvexPolygon& a, const ConvexPolygon& b) {
  ConvexSum sum = merged(fan_of(a), fan_of(b));
  if (sum.error == 0.0) return sum;
  sum.error *= 1.0 + 4.0 * kUnitRoundoff;  // |ex| + |ey| is at least the length, but was itself rounded
  // Rounding can push a vertex across its neighbours' edge; the hull moves no point farther than the vertices moved.
  if (!Fan(sum.polygon.vertices).turns_once_to_the_left()) sum.polygon = convex_hull(sum.polygon.vertices);
  return sum;
}

}  // namespace exactvo::geometry
