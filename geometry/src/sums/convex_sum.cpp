// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include "exact/exact_number.h"
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
  const Vec2* from;
  const Vec2* to;
  Vec2 along;  // fl(to - from)
};

bool is_exact(const Edge& e) {
  return is_exact_difference(e.from->x, e.to->x) && is_exact_difference(e.from->y, e.to->y);
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

bool is_place(Vec2 p) {
  return std::fabs(p.x) < 0x1p1000 && std::fabs(p.y) < 0x1p1000;
}

bool is_between_places(const Edge& e) {
  return is_place(*e.from) && is_place(*e.to);
}

[[gnu::noinline, gnu::cold]] Sign turn_in_doubt(const Edge& s, const Edge& t, double p, double q) {
  // Summands are merged before they are checked: any answer will do for what will be refused.
  if (!is_between_places(s) || !is_between_places(t)) return Sign::zero;
  if (is_exact(s) && is_exact(t)) {
    if (const auto sign = turn_of_exact(s, t, p, q)) return *sign;
  }
  return exact_turn(*s.from, *s.to, *t.from, *t.to);
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

// Without jumps: which vertex is lowest is anyone's guess.
inline bool is_lower(Vec2 a, Vec2 b) {
  return (static_cast<int>(a.y < b.y) | (static_cast<int>(a.y == b.y) & static_cast<int>(a.x < b.x))) != 0;
}

const Vec2* lowest(const Vec2* begin, const Vec2* end) {
  const Vec2* low = begin;
  for (const Vec2* v = begin; v != end; ++v) low = is_lower(*v, *low) ? v : low;
  return low;
}

// The directions from angle 0 (included) to pi (excluded).
bool points_up(const Edge& e) {
  return is_lower(*e.from, *e.to);
}

// A convex polygon's edges from its lowest vertex on: their directions grow from 0 to 2 pi. Looks at the vertices,
// which must outlive it. Edges of length 0 are passed over.
class Fan {
 public:
  explicit Fan(const std::vector<Vec2>& v) : begin_(v.data()), end_(v.data() + v.size()), first_(lowest(begin_, end_)) {
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

  bool at_end() const { return left_ <= 0; }
  const Edge& edge() const { return edge_; }
  Vec2 at() const { return *edge_.from; }

  void advance() {
    const Vec2* const from = edge_.to;
    while (--left_ > 0) {
      const Vec2* const to = edge_.to + 1 == end_ ? begin_ : edge_.to + 1;
      edge_ = {from, to, *to - *from};
      if (edge_.along != Vec2{} || *from != *to) return;
    }
    edge_ = {from, from, {}};
  }

 private:
  void restart() {
    left_ = end_ - begin_ + 1;
    edge_ = {first_, first_, {}};
    advance();
  }

  const Vec2* begin_;
  const Vec2* end_;
  const Vec2* first_;
  std::ptrdiff_t left_ = 0;  // edges not yet passed, the present one included
  Edge edge_{};
};

[[gnu::noinline, gnu::cold]] void require_convex(const ConvexPolygon& polygon) {
  const auto& v = polygon.vertices;
  EXACTVO_REQUIRE(!v.empty() && std::all_of(v.begin(), v.end(), is_place), excerpt(v));
  EXACTVO_REQUIRE(Fan(v).turns_once_to_the_left(), excerpt(v));
}

// Watches directions go by: proven once all rising ones came first and each turned left from the one before, beyond the
// error of their cross product (a NaN or an overflow proves nothing). A closed ring of such edges is convex.
class Order {
 public:
  void next(Vec2 along) {
    const bool rises = along.y > 0.0 || (along.y == 0.0 && along.x > 0.0);
    const double p = last_.x * along.y, q = last_.y * along.x;
    const bool left = p - q > kTurnError * (std::fabs(p) + std::fabs(q)) + kSafeProduct;
    proven_ = proven_ && (rises == rose_ ? left || first_ : rose_);
    first_ = false;
    rose_ = rises;
    last_ = along;
  }
  bool is_proven() const { return proven_ && !rose_; }

 private:
  Vec2 last_;
  bool first_ = true;
  bool rose_ = true;
  bool proven_ = true;
};

// What rounding took from fl(a + b).
double lost(double a, double b, double sum) {
  const double part = sum - a;
  return std::fabs((a - (sum - part)) + (b - part));
}

// Positive if s comes first. Of the next edges of two fans the directions are at most pi apart; opposite ones (a
// segment turning back beside a run of collinear edges) are told from parallel ones by the half they point to.
Sign order(const Edge& s, const Edge& t) {
  const Sign sign = turn(s, t);
  if (sign != Sign::zero || points_up(s) == points_up(t)) return sign;
  return points_up(s) ? Sign::positive : Sign::negative;
}

struct Merged {
  ConvexSum sum;
  bool summands_are_convex;  // proven; else they may still be: the edges of both, merged, were in order
  bool sum_is_convex;        // the same of the rounded sum
};

void append(Vec2 a, Vec2 b, ConvexSum& sum, Order& order) {
  const Vec2 at = a + b;
  sum.error = std::max(sum.error, lost(a.x, b.x, at.x) + lost(a.y, b.y, at.y));
  order.next(at - sum.polygon.vertices.back());
  sum.polygon.vertices.push_back(at);
}

Merged merged(Fan a, Fan b, std::size_t most) {
  ConvexSum sum;
  Order edges, rounded_edges;
  auto& v = sum.polygon.vertices;
  v.reserve(most);
  v.push_back(a.at() + b.at());
  sum.error = lost(a.at().x, b.at().x, v[0].x) + lost(a.at().y, b.at().y, v[0].y);
  while (!a.at_end() || !b.at_end()) {
    const Sign next = a.at_end() ? Sign::negative : b.at_end() ? Sign::positive : order(a.edge(), b.edge());
    edges.next(next != Sign::negative ? a.edge().along : b.edge().along);
    if (next != Sign::negative) a.advance();
    if (next != Sign::positive) b.advance();
    append(a.at(), b.at(), sum, rounded_edges);
  }
  if (v.size() > 1) v.pop_back();  // the start again
  return {std::move(sum), edges.is_proven(), rounded_edges.is_proven()};
}

}  // namespace

ConvexSum minkowski_sum(const ConvexPolygon& a, const ConvexPolygon& b) {
  EXACTVO_REQUIRE(!a.vertices.empty() && !b.vertices.empty(), "no vertices");
  Merged m = merged(Fan(a.vertices), Fan(b.vertices), a.vertices.size() + b.vertices.size() + 1);
  if (!m.summands_are_convex) {
    require_convex(a);
    require_convex(b);
  }
  if (m.sum.error == 0.0) return std::move(m.sum);
  m.sum.error *= 1.0 + 4.0 * kUnitRoundoff;  // |ex| + |ey| is at least the length, but was itself rounded
  // Rounding can push a vertex across its neighbours' edge; the hull moves no point farther than the vertices moved.
  if (!m.sum_is_convex && !Fan(m.sum.polygon.vertices).turns_once_to_the_left())
    m.sum.polygon = convex_hull(m.sum.polygon.vertices);
  return std::move(m.sum);
}

}  // namespace exactvo::geometry
