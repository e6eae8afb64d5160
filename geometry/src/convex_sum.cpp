// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

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

// Whether b - a is a double (Knuth's two-sum gives what was rounded off).
bool is_exact_difference(double a, double b) {
  const double x = b - a;
  const double a_seen = b - x;
  const double b_seen = x + a_seen;
  return (b - b_seen) + (a_seen - a) == 0.0;
}

struct Edge {
  Vec2 from;
  Vec2 to;
  Vec2 along;  // fl(to - from)
};

bool is_exact(const Edge& e) {
  return is_exact_difference(e.from.x, e.to.x) && is_exact_difference(e.from.y, e.to.y);
}

// Of exact directions: rounding keeps the order of the products p and q, and equal ones are told apart by what was
// rounded off. Nothing where a product may have underflowed.
std::optional<Sign> turn_of_exact(const Edge& s, const Edge& t, double p, double q) {
  const bool p_vanishes = s.along.x == 0.0 || t.along.y == 0.0;
  const bool q_vanishes = s.along.y == 0.0 || t.along.x == 0.0;
  if (p_vanishes && q_vanishes) return Sign::zero;
  if (std::fabs(p) < kSafeProduct || std::fabs(q) < kSafeProduct) return std::nullopt;
  if (p != q) return p > q ? Sign::positive : Sign::negative;
  const double rest_p = std::fma(s.along.x, t.along.y, -p);
  const double rest_q = std::fma(s.along.y, t.along.x, -q);
  return rest_p > rest_q ? Sign::positive : rest_p < rest_q ? Sign::negative : Sign::zero;
}

Sign turn_in_doubt(const Edge& s, const Edge& t, double p, double q) {
  if (is_exact(s) && is_exact(t)) {
    if (const auto sign = turn_of_exact(s, t, p, q)) return *sign;
  }
  return exact_turn(s.from, s.to, t.from, t.to);
}

// The sign of the turn from edge s to edge t. Exact.
inline Sign turn(const Edge& s, const Edge& t) {
  const double p = s.along.x * t.along.y;
  const double q = s.along.y * t.along.x;
  const double difference = p - q;
  const double bound = kTurnError * (std::fabs(p) + std::fabs(q)) + kSafeProduct;
  if (difference > bound) return Sign::positive;
  if (difference < -bound) return Sign::negative;
  return turn_in_doubt(s, t, p, q);
}

bool is_lower(Vec2 a, Vec2 b) {
  return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// The directions from angle 0 (included) to pi (excluded).
bool points_up(const Edge& e) {
  return e.to.y > e.from.y || (e.to.y == e.from.y && e.to.x > e.from.x);
}

// A convex polygon's edges from its lowest vertex on: their directions grow from 0 to 2 pi. Looks at the vertices,
// which must outlive it. Edges of length 0 are passed over.
class Fan {
 public:
  explicit Fan(const std::vector<Vec2>& vertices) : vertices_(vertices) {
    const auto lowest = std::min_element(vertices.begin(), vertices.end(), is_lower);
    first_ = static_cast<std::size_t>(lowest - vertices.begin());
    restart();
  }

  bool turns_once_to_the_left() {
    bool left = true;
    for (Edge before = edge_; left && !at_end(); before = edge_) {
      advance();
      if (at_end()) break;
      const bool was_up = points_up(before);
      const bool is_up = points_up(edge_);
      left = is_up == was_up ? turn(before, edge_) != Sign::negative : was_up;
    }
    restart();
    return left;
  }

  bool at_end() const { return passed_ > vertices_.size(); }
  const Edge& edge() const { return edge_; }
  Vec2 at() const { return edge_.from; }

  void advance() {
    const Vec2 from = edge_.to;
    while (++passed_ <= vertices_.size()) {
      if (++next_ == vertices_.size()) next_ = 0;
      const Vec2 to = vertices_[next_];
      edge_ = {from, to, to - from};
      if (from != to) return;
    }
    edge_ = {from, from, {}};
  }

 private:
  void restart() {
    passed_ = 0;
    next_ = first_;
    edge_.to = vertices_[first_];
    advance();
  }

  const std::vector<Vec2>& vertices_;
  std::size_t first_ = 0;
  std::size_t next_ = 0;    // the vertex that the edge leads to
  std::size_t passed_ = 0;  // steps taken; past the number of vertices there is no edge left
  Edge edge_;
};

bool is_place(Vec2 p) {
  return std::fabs(p.x) < 0x1p1000 && std::fabs(p.y) < 0x1p1000;
}

Fan fan_of(const ConvexPolygon& polygon) {
  const auto& v = polygon.vertices;
  EXACTVO_REQUIRE(!v.empty() && std::all_of(v.begin(), v.end(), is_place), excerpt(v));
  Fan fan(v);
  EXACTVO_REQUIRE(fan.turns_once_to_the_left(), excerpt(v));
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

ConvexSum merged(Fan a, Fan b, std::size_t most) {
  ConvexSum out;
  out.polygon.vertices.reserve(most);
  append_sum(a.at(), b.at(), out);
  while (!a.at_end() || !b.at_end()) {
    const Sign next = a.at_end() ? Sign::negative : b.at_end() ? Sign::positive : order(a.edge(), b.edge());
    if (next != Sign::negative) a.advance();
    if (next != Sign::positive) b.advance();
    append_sum(a.at(), b.at(), out);
  }
  if (out.polygon.vertices.size() > 1) out.polygon.vertices.pop_back();  // the start again
  return out;
}

}  // namespace

ConvexSum minkowski_sum(const ConvexPolygon& a, const ConvexPolygon& b) {
  ConvexSum sum = merged(fan_of(a), fan_of(b), a.vertices.size() + b.vertices.size() + 1);
  if (sum.error == 0.0) return sum;
  sum.error *= 1.0 + 4.0 * kUnitRoundoff;  // |ex| + |ey| is at least the length, but was itself rounded
  // Rounding can push a vertex across its neighbours' edge; the hull moves no point farther than the vertices moved.
  if (!Fan(sum.polygon.vertices).turns_once_to_the_left()) sum.polygon = convex_hull(sum.polygon.vertices);
  return sum;
}

}  // namespace exactvo::geometry
