// SPDX-License-Identifier: GPL-3.0-or-later
// Convex (+) convex, by merging edges in the order of their directions. The turn from one edge to the next is
// decided in doubles with a static bound, then exactly.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exact/exact_vector.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

/// Products below this may have lost bits to underflow, so that comparing them decides nothing.
constexpr double kSafeProduct = 0x1p-960;
/// The error of (b - a) x (d - c) = p - q, p and q its products: two rounded factors and the rounding of the product
/// make 3 u of each, the subtraction 1 u of their difference. 4 u (|p| + |q|) to first order; 8 u leaves room for more.
constexpr double kTurnError = 8.0 * kUnitRoundoff;

struct Edge {
  Vec2 from;
  Vec2 to;
  Vec2 along;  // fl(to - from)
};

bool is_place(Vec2 p) {
  return std::fabs(p.x) < 0x1p1000 && std::fabs(p.y) < 0x1p1000;
}

bool is_between_places(const Edge& e) {
  return is_place(e.from) && is_place(e.to);
}

[[gnu::noinline, gnu::cold]] Sign turn_exact_stage(const Edge& s, const Edge& t) {
  // Summands are merged before they are checked: any answer will do for what will be refused.
  if (!is_between_places(s) || !is_between_places(t)) return Sign::zero;
  return detail::sign_of(
      cross(detail::difference<detail::Exact>(s.to, s.from), detail::difference<detail::Exact>(t.to, t.from)));
}

// s x t in doubles, and what it may be off by.
struct Cross {
  double value, error;
  Cross(Vec2 s, Vec2 t) {
    const double p = s.x * t.y, q = s.y * t.x;
    value = p - q;
    error = kTurnError * (std::fabs(p) + std::fabs(q)) + kSafeProduct;
  }
};

// The sign of the turn from edge s to edge t. Exact.
inline Sign turn(const Edge& s, const Edge& t) {
  const Cross c(s.along, t.along);
  if (c.value > c.error) return Sign::positive;
  if (c.value < -c.error) return Sign::negative;
  return turn_exact_stage(s, t);
}

inline bool is_lower(Vec2 a, Vec2 b) {
  return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// The directions from angle 0 (included) to pi (excluded).
bool points_up(const Edge& e) {
  return is_lower(e.from, e.to);
}
// The same for `along`: distinct doubles have a difference.
inline bool rises(Vec2 along) {
  return along.y > 0.0 || (along.y == 0.0 && along.x > 0.0);
}

// The leftmost of the lowest vertices.
const Vec2* lowest(const Vec2* begin, const Vec2* end, double least_y) {
  const Vec2* first = begin;
  while (first + 1 != end && first->y != least_y) ++first;
  for (const Vec2* v = first + 1; v != end; ++v) first = is_lower(*v, *first) ? v : first;
  return first;
}

// A convex polygon's edges from its lowest vertex on: their directions grow from 0 to 2 pi. Looks at the vertices,
// which must outlive it; a point has no edges.
class Fan {
 public:
  explicit Fan(const std::vector<Vec2>& v) : begin_(v.data()), end_(v.data() + v.size()) {
    double least_y = begin_->y;
    for (const Vec2* p = begin_; p != end_; ++p) {  // no jumps: which vertex is lowest is anyone's guess
      least_y = std::min(least_y, p->y);
      extent_ = std::max(extent_, std::max(std::fabs(p->x), std::fabs(p->y)));
    }
    next_ = lowest(begin_, end_, least_y);
    edge_.to = *next_;
    left_ = v.size() > 1 ? end_ - begin_ + 1 : 1;
    advance();
  }

  bool at_end() const { return left_ == 0; }
  const Edge& edge() const { return edge_; }
  Vec2 at() const { return edge_.from; }
  double extent() const { return extent_; }  // m; no coordinate is larger

  void advance() {
    --left_;
    if (++next_ == end_) next_ = begin_;
    edge_.from = edge_.to;
    edge_.to = *next_;
    edge_.along = edge_.to - edge_.from;
  }

 private:
  const Vec2* begin_;
  const Vec2* end_;
  const Vec2* next_;         // where the present edge ends
  std::ptrdiff_t left_ = 0;  // edges not yet passed, the present one included
  double extent_ = 0.0;
  Edge edge_{};
};

// Exact. REQUIRES: finite, no vertex twice running.
bool turns_once_to_the_left(const std::vector<Vec2>& v) {
  Fan fan(v);
  while (!fan.at_end()) {
    const Edge before = fan.edge();
    fan.advance();
    if (fan.at_end()) break;
    const bool was_up = points_up(before), is_up = points_up(fan.edge());
    if (is_up == was_up ? turn(before, fan.edge()) == Sign::negative : is_up) return false;
  }
  return true;
}

// Without vertices listed twice running.
std::vector<Vec2> distinct(std::vector<Vec2> v) {
  v.erase(std::unique(v.begin(), v.end()), v.end());
  while (v.size() > 1 && v.back() == v.front()) v.pop_back();
  return v;
}

void require_convex(const ConvexPolygon& polygon) {
  const auto& v = polygon.vertices;
  EXACTVO_REQUIRE(std::all_of(v.begin(), v.end(), is_place), excerpt(v));
  EXACTVO_REQUIRE(turns_once_to_the_left(distinct(v)), excerpt(v));
}

// Watches the edges of a closed ring go by. Proven once each turned left from the one before, the first from the last,
// and rising ones came before falling ones: then the ring is convex, and so is each summand whose edges they are; and
// the margin is so wide that it all still holds for the ring whose vertices were rounded.
//
// With M the largest coordinate of a sum, a rounded vertex is off by u M a coordinate, an edge e by d = 2 u M, and
// e x f by d (|e| + |f|) + 2 d^2, lengths as |x| + |y|. The margin is 4 d (|e| + |f|) = 8 u M (|e| + |f|): no e x f
// passes it unless |e| + |f| > 16 d, and then it is more than three times as wide, which leaves room for its rounding.
// Between the edges and the rounded ones lie only edges that turn left as well, so both rings go round equally often.
// The first of two parallel edges that were merged stands for both: a longer edge only gains. A NaN or an overflow
// proves nothing.
class Order {
 public:
  Order(Vec2 first, double extent) : moved_(8.0 * kUnitRoundoff * extent), first_(first) {
    last_ = -perp(first);  // from which the first turns left
    last_size_ = size_of(first);
  }

  void next(Vec2 along) {
    const bool is_up = rises(along);
    const double size = size_of(along);
    const Cross turned(last_, along);
    proven_ = proven_ && turned.value > turned.error + moved_ * (last_size_ + size) && (was_up_ || !is_up);
    last_ = along;
    last_size_ = size;
    was_up_ = is_up;
  }

  bool is_proven() {
    was_up_ = true;  // once round: rising edges come again
    next(first_);
    return proven_;
  }

 private:
  static double size_of(Vec2 v) { return std::fabs(v.x) + std::fabs(v.y); }

  double moved_;
  Vec2 first_;
  Vec2 last_;
  double last_size_;
  bool was_up_ = true;
  bool proven_ = true;
};

// What rounding took from fl(a + b).
inline double lost(double a, double b, double sum) {
  const double part = sum - a;
  return std::fabs((a - (sum - part)) + (b - part));
}

// Writes the sums of vertices and keeps the most that rounding took from any.
class Sums {
 public:
  explicit Sums(Vec2* next) : next_(next) {}
  void put(Vec2 a, Vec2 b) {
    const Vec2 sum = a + b;
    most_lost_.x = std::max(most_lost_.x, lost(a.x, b.x, sum.x));
    most_lost_.y = std::max(most_lost_.y, lost(a.y, b.y, sum.y));
    *next_++ = sum;
  }
  const Vec2* end() const { return next_; }
  // |ex| + |ey| is at least the length, but is itself rounded.
  double error() const { return (most_lost_.x + most_lost_.y) * (1.0 + 4.0 * kUnitRoundoff); }

 private:
  Vec2* next_;
  Vec2 most_lost_;
};

// Positive if s comes first. Of the next edges of two fans the directions are at most pi apart; opposite ones (a
// segment turning back beside a run of collinear edges) are told from parallel ones by the half they point to.
[[gnu::noinline, gnu::cold]] Sign order_exact_stage(Edge s, Edge t) {
  const Sign sign = turn_exact_stage(s, t);
  if (sign != Sign::zero || points_up(s) == points_up(t)) return sign;
  return points_up(s) ? Sign::positive : Sign::negative;
}

inline Sign order(const Edge& s, const Edge& t) {
  const Cross c(s.along, t.along);
  if (c.value > c.error) return Sign::positive;
  if (c.value < -c.error) return Sign::negative;
  return order_exact_stage(s, t);
}

// Merges the edges of both by their directions. Whether it is proven that both were convex and the sum is.
bool merge(const std::vector<Vec2>& va, const std::vector<Vec2>& vb, ConvexSum& sum) {
  Fan a(va), b(vb);
  std::vector<Vec2>& v = sum.polygon.vertices;
  v.resize(va.size() + vb.size() + 1);
  Sums sums(v.data());
  sums.put(a.at(), b.at());
  const bool a_starts = !a.at_end() && (b.at_end() || order(a.edge(), b.edge()) != Sign::negative);
  Order edges(a_starts ? a.edge().along : b.edge().along, a.extent() + b.extent());
  while (!a.at_end() && !b.at_end()) {
    const Sign next = order(a.edge(), b.edge());
    edges.next(next != Sign::negative ? a.edge().along : b.edge().along);
    if (next != Sign::negative) a.advance();
    if (next != Sign::positive) b.advance();
    sums.put(a.at(), b.at());
  }
  const auto finish = [&](Fan& rest) {
    for (; !rest.at_end(); sums.put(a.at(), b.at())) {
      edges.next(rest.edge().along);
      rest.advance();
    }
  };
  finish(a);
  finish(b);
  const std::ptrdiff_t count = sums.end() - v.data();
  v.resize(static_cast<std::size_t>(count > 1 ? count - 1 : 1));  // the last is the start again
  sum.error = sums.error();
  return edges.is_proven() && is_place(va.front()) && is_place(vb.front());  // a point has no edges that would tell
}

// For what the merge could not prove on its way: collinear or repeated vertices, summands that are flat or not convex,
// turns as slight as the rounding.
[[gnu::noinline, gnu::cold]] void merge_and_check(const ConvexPolygon& a, const ConvexPolygon& b, ConvexSum& sum) {
  require_convex(a);
  require_convex(b);
  merge(distinct(a.vertices), distinct(b.vertices), sum);
  // Rounding can push a vertex across its neighbours' edge; the hull moves no point farther than the vertices moved.
  if (sum.error > 0.0 && !turns_once_to_the_left(distinct(sum.polygon.vertices)))
    sum.polygon = convex_hull(sum.polygon.vertices);
}

}  // namespace

ConvexSum minkowski_sum(const ConvexPolygon& a, const ConvexPolygon& b) {
  EXACTVO_REQUIRE(!a.vertices.empty() && !b.vertices.empty(), "no vertices");
  ConvexSum sum;
  if (!merge(a.vertices, b.vertices, sum)) merge_and_check(a, b, sum);
  return sum;
}

}  // namespace exactvo::geometry
