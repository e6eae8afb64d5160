// SPDX-License-Identifier: GPL-3.0-or-later
#include "route_verdict.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <string>
#include <utility>

namespace exactvo::test {
namespace {

using geometry::Vec2;
using Number = mpq_class;

struct Spot {
  Number x, y;
};

Spot spot(Vec2 p) {
  return {Number(p.x), Number(p.y)};
}
Spot operator-(const Spot& a, const Spot& b) {
  return {Number(a.x - b.x), Number(a.y - b.y)};
}
bool is_same(const Spot& a, const Spot& b) {
  return a.x == b.x && a.y == b.y;
}
Number cross(const Spot& a, const Spot& b) {
  return a.x * b.y - a.y * b.x;
}
Number dot(const Spot& a, const Spot& b) {
  return a.x * b.x + a.y * b.y;
}
Number norm2(const Spot& a) {
  return dot(a, a);
}

/// Whether the double is one of the two next to the number, or the number itself.
bool rounds_to(const Number& exact, double rounded) {
  const double toward_zero = exact.get_d();
  if (Number(toward_zero) == exact) return rounded == toward_zero;
  return rounded == toward_zero || rounded == std::nextafter(toward_zero, sgn(exact) * HUGE_VAL);
}

std::optional<Number> number(const std::string& text, double rounded) {
  if (!std::isfinite(rounded)) return std::nullopt;
  if (text.empty()) return Number(rounded);
  static const std::regex grammar("(-?[0-9]+)(?:/([0-9]+))?");
  std::smatch parts;
  if (!std::regex_match(text, parts, grammar)) return std::nullopt;
  const mpz_class above(parts[1].str(), 10), below(parts[2].matched ? parts[2].str() : "1", 10);
  if (below == 0) return std::nullopt;
  Number value(above, below);
  value.canonicalize();
  return rounds_to(value, rounded) ? std::optional(value) : std::nullopt;
}

std::optional<Spot> spot(const geometry::ExactPoint& p) {
  const std::optional<Number> x = number(p.x, p.rounded.x), y = number(p.y, p.rounded.y);
  return x && y ? std::optional(Spot{*x, *y}) : std::nullopt;
}

struct Edge {
  Spot a, b;
};

/// The share of p + share d, within [low, high], that is nearest to q, and its squared distance.
Number distance2_to(const Spot& p, const Spot& d, const Number& low, const Number& high, const Spot& q) {
  const Number length2 = norm2(d);
  Number share = low;
  if (length2 > 0) share = dot(q - p, d) / length2;
  if (share < low) share = low;
  if (share > high) share = high;
  const Spot at{Number(p.x + share * d.x), Number(p.y + share * d.y)};
  return norm2(at - q);
}

/// Whether that is nearer than the radius, or touches q where the radius is 0.
bool is_near_point(const Spot& p, const Spot& d, const Number& low, const Number& high, const Spot& q,
                   const Number& radius2) {
  const Number distance2 = distance2_to(p, d, low, high, q);
  return distance2 < radius2 || (radius2 == 0 && distance2 == 0);
}

/// Whether the piece meets the open set of what is nearer than the radius to the edge: a disc about each end, and the
/// strip between. For radius 0: whether it touches the edge.
bool meets(const Edge& piece, const Edge& edge, const Number& radius2) {
  const Spot d = piece.b - piece.a;
  for (const Spot* end : {&edge.a, &edge.b})
    if (is_near_point(piece.a, d, 0, 1, *end, radius2)) return true;
  const Spot e = edge.b - edge.a;
  const Number length2 = norm2(e);
  if (length2 == 0) return false;
  // The shares of the piece whose feet lie on the edge: 0 <= start + share * rate <= length2.
  const Number start = dot(piece.a - edge.a, e), rate = dot(d, e);
  Number low = 0, high = 1;
  if (rate == 0) {
    if (start < 0 || start > length2) return false;
  } else {
    Number at_a = -start / rate, at_b = (length2 - start) / rate;
    if (at_a > at_b) std::swap(at_a, at_b);
    if (at_a > low) low = at_a;
    if (at_b < high) high = at_b;
    if (low > high) return false;
  }
  // Heights times the edge's length are linear in the share: the least is at an end, unless the sign changes.
  const Number height = cross(e, piece.a - edge.a), slope = cross(e, d);
  const Number first = height + low * slope, last = height + high * slope;
  if (sgn(first) * sgn(last) <= 0) return true;
  const Number most2 = radius2 * length2;
  return first * first < most2 || last * last < most2;
}

enum class Place { outside, border, inside };

Place place_in(const std::vector<geometry::Segment>& ring_edges, const Spot& p) {
  bool inside = false;
  for (const geometry::Segment& s : ring_edges) {
    Edge e{spot(s.a), spot(s.b)};
    if (is_near_point(e.a, e.b - e.a, 0, 1, p, 0)) return Place::border;
    if (e.a.x > e.b.x) std::swap(e.a, e.b);
    // The ray upward from p; of an edge's ends the right one counts.
    if (e.a.x <= p.x && p.x < e.b.x && cross(e.b - e.a, p - e.a) < 0) inside = !inside;
  }
  return inside ? Place::inside : Place::outside;
}

/// Whether the ray upward from p crosses ab.
bool rises_through(const Spot& p, Spot a, Spot b) {
  if (a.x > b.x) std::swap(a, b);
  return a.x <= p.x && p.x < b.x && cross(b - a, p - a) < 0;
}

class Checker {
 public:
  Checker(const std::vector<geometry::Obstacle>& obstacles, const geometry::RouteQuestion& question)
      : start_(spot(question.start)), goal_(spot(question.goal)), radius2_(question.radius) {
    radius2_ *= radius2_;
    reach_ = question.radius;
    for (const geometry::Obstacle& o : obstacles) {
      solid_.push_back(geometry::has_interior(o));
      edges_.push_back(geometry::edges_of(o));
    }
  }

  RouteVerdict operator()(const geometry::Route& route) const {
    std::vector<Spot> points;
    for (const geometry::ExactPoint& p : route.points) {
      const std::optional<Spot> exact = spot(p);
      if (!exact) return RouteVerdict::wrong;
      points.push_back(*exact);
    }
    if (points.empty() || !is_same(points.front(), start_) || !is_same(points.back(), goal_))
      return RouteVerdict::wrong;
    if (points.size() == 1 && free_sides(start_).empty()) return RouteVerdict::wrong;
    if (points.size() > 1 && is_inside_any(middle(points[0], points[1]))) return RouteVerdict::wrong;
    mpf_class length(0, 256);
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (!is_clear({points[k - 1], points[k]}, k == 1, k + 1 == points.size())) return RouteVerdict::wrong;
      length += sqrt(mpf_class(norm2(points[k] - points[k - 1]), 256));
    }
    constexpr double kSame = 0x1p-40, kSearch = 0x1p-30;  // as the checker's header has it
    if (!std::isfinite(route.length) || !std::isfinite(route.lower_bound)) return RouteVerdict::wrong;
    const bool is_length = abs(mpf_class(route.length, 256) - length) <= kSame * length;
    const bool is_bound = route.lower_bound >= 0.0 && route.lower_bound <= length * (1.0 + kSearch);
    return is_length && is_bound ? RouteVerdict::proven : RouteVerdict::wrong;
  }

  RouteVerdict operator()(const geometry::Separated& separated) const {
    const std::size_t n = separated.chain.size();
    if (n < 2) return RouteVerdict::wrong;
    std::vector<Spot> points;
    for (const geometry::ChainPoint& c : separated.chain) {
      const std::optional<Spot> exact = spot(c.point);
      if (!exact || !is_on(*exact, c.on)) return RouteVerdict::wrong;
      points.push_back(*exact);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Spot &p = points[k], &q = points[(k + 1) % n];
      const bool holds = separated.chain[k].gap_follows ? norm2(q - p) < 4 * radius2_ : is_on(q, separated.chain[k].on);
      if (!holds) return RouteVerdict::wrong;
    }
    const auto is_round = [&](const Spot& x) {
      bool round = false;
      for (std::size_t k = 0; k < n; ++k) round ^= rises_through(x, points[k], points[(k + 1) % n]);
      return round;
    };
    const std::vector<Spot> starts = free_sides(start_), goals = free_sides(goal_);
    if (starts.empty() || goals.empty()) return RouteVerdict::wrong;
    for (const Spot& s : starts)
      for (const Spot& g : goals)
        if (is_round(s) == is_round(g)) return RouteVerdict::wrong;
    return RouteVerdict::proven;
  }

  RouteVerdict operator()(const geometry::Blocked& blocked) const {
    const Spot& end = blocked.end == geometry::Blocked::End::start ? start_ : goal_;
    if (blocked.by.obstacle >= edges_.size()) return RouteVerdict::wrong;
    const std::vector<geometry::Segment>& edges = edges_[blocked.by.obstacle];
    if (blocked.inside) {
      if (!solid_[blocked.by.obstacle]) return RouteVerdict::wrong;
      const Place place = place_in(edges, end);
      return place == Place::inside ? RouteVerdict::proven : RouteVerdict::wrong;
    }
    if (blocked.by.edge >= edges.size()) return RouteVerdict::wrong;
    const geometry::Segment& s = edges[blocked.by.edge];
    const bool is_near = meets({end, end}, {spot(s.a), spot(s.b)}, radius2_);
    return is_near && (radius2_ > 0 || free_sides(end).empty()) ? RouteVerdict::proven : RouteVerdict::wrong;
  }

 private:
  bool is_on(const Spot& p, const geometry::EdgeName& name) const {
    if (name.obstacle >= edges_.size() || name.edge >= edges_[name.obstacle].size()) return false;
    const geometry::Segment& s = edges_[name.obstacle][name.edge];
    const Spot a = spot(s.a), b = spot(s.b);
    return cross(b - a, p - a) == 0 && dot(p - a, p - b) <= 0;
  }

  bool is_inside_any(const Spot& p) const {
    for (std::size_t i = 0; i < edges_.size(); ++i)
      if (solid_[i] && place_in(edges_[i], p) == Place::inside) return true;
    return false;
  }

  static Spot middle(const Spot& p, const Spot& q) { return {Number((p.x + q.x) / 2), Number((p.y + q.y) / 2)}; }

  /// Places beside p in the free space, so near that no edge but those through p is as near: at least one on each side
  /// of these. A disc has p itself, where it is free.
  std::vector<Spot> free_sides(const Spot& p) const {
    Number nearest2 = 1;  // the squared distance of the edges that do not hold p
    std::vector<Spot> along;
    for (const std::vector<geometry::Segment>& edges : edges_) {
      for (const geometry::Segment& s : edges) {
        const Spot a = spot(s.a), b = spot(s.b);
        const Number distance2 = distance2_to(a, b - a, 0, 1, p);
        if (distance2 < radius2_) return {};
        if (distance2 > 0) nearest2 = std::min(nearest2, distance2);
        for (const Spot& end : {a, b})
          if (distance2 == 0 && !is_same(end, p)) along.push_back(end - p);
      }
    }
    std::vector<Spot> found;
    if (along.empty() || radius2_ > 0) {
      if (!is_inside_any(p)) found.push_back(p);
      return found;
    }
    // Halfway between any two directions of equal length (nearly, in doubles), the opposite of that, and square to it:
    // those of neighbours are among them, and any other is some place beside p too.
    for (const Spot& u : along) {
      for (const Spot& v : along) {
        const Spot one = of_length_one(u), other = of_length_one(v);
        const Spot sum{Number(one.x + other.x), Number(one.y + other.y)};
        for (const Spot& d : {sum, Spot{Number(-sum.x), Number(-sum.y)}, Spot{Number(-one.y), one.x},
                              Spot{one.y, Number(-one.x)}, Spot{Number(-one.x), Number(-one.y)}}) {
          if (norm2(d) == 0) continue;
          // Shorter than the distance to the other edges: each coordinate is at most 3, and nearest2 at most 1.
          const Number step = nearest2 / 8;
          const Spot place{Number(p.x + step * d.x), Number(p.y + step * d.y)};
          const bool is_on_edge =
              std::any_of(along.begin(), along.end(), [&](const Spot& e) { return cross(e, d) == 0 && dot(e, d) > 0; });
          if (!is_on_edge && !is_inside_any(place)) found.push_back(place);
        }
      }
    }
    return found;
  }
  /// Nearly.
  static Spot of_length_one(const Spot& d) {
    const Number size = std::max(Number(abs(d.x)), Number(abs(d.y)));
    const double x = Number(d.x / size).get_d(), y = Number(d.y / size).get_d(), length = std::hypot(x, y);
    return {Number(d.x / size / Number(length)), Number(d.y / size / Number(length))};
  }

  /// Whether a piece keeps clear; a point may touch obstacles where its first or last piece begins or ends.
  bool is_clear(const Edge& piece, bool is_first, bool is_last) const {
    for (const std::vector<geometry::Segment>& edges : edges_) {
      for (const geometry::Segment& s : edges) {
        if (is_far(piece, s)) continue;
        const Edge edge{spot(s.a), spot(s.b)};
        if (radius2_ > 0 ? meets(piece, edge, radius2_) : touches(piece, edge, is_first, is_last)) return false;
      }
    }
    return true;
  }

  /// By the shares of the piece that lie on the edge's line and between its ends: none but 0 or 1, where these may.
  static bool touches(const Edge& piece, const Edge& edge, bool first_may, bool last_may) {
    const Spot d = piece.b - piece.a, e = edge.b - edge.a;
    if (norm2(d) == 0) return !(first_may && last_may) && meets(piece, edge, 0);
    const Number slope = cross(e, d), height = cross(e, piece.a - edge.a);
    if (norm2(e) == 0 || (slope == 0 && height == 0)) {  // a point, or on one line
      if (norm2(e) == 0 && cross(d, edge.a - piece.a) != 0) return false;
      Number low = dot(edge.a - piece.a, d) / norm2(d), high = dot(edge.b - piece.a, d) / norm2(d);
      if (low > high) std::swap(low, high);
      if (low > 1 || high < 0) return false;
      return !(high == 0 && first_may) && !(low == 1 && last_may);
    }
    if (slope == 0) return false;
    const Number share = -height / slope;
    if (share < 0 || share > 1) return false;
    const Spot at{Number(piece.a.x + share * d.x), Number(piece.a.y + share * d.y)};
    if (dot(at - edge.a, at - edge.b) > 0) return false;
    return !(share == 0 && first_may) && !(share == 1 && last_may);
  }

  /// By doubles, with more room than any rounding here takes.
  bool is_far(const Edge& piece, const geometry::Segment& s) const {
    const double ax = piece.a.x.get_d(), ay = piece.a.y.get_d(), bx = piece.b.x.get_d(), by = piece.b.y.get_d();
    double size = reach_;
    for (const double x : {ax, ay, bx, by, s.a.x, s.a.y, s.b.x, s.b.y}) size = std::fmax(size, std::fabs(x));
    const double room = reach_ + 0x1p-40 * size;
    const auto apart = [room](double a, double b, double c, double d) {
      return std::fmax(a, b) + room < std::fmin(c, d) || std::fmax(c, d) + room < std::fmin(a, b);
    };
    return apart(ax, bx, s.a.x, s.b.x) || apart(ay, by, s.a.y, s.b.y);
  }

  Spot start_, goal_;
  Number radius2_;
  double reach_ = 0.0;
  std::vector<char> solid_;
  std::vector<std::vector<geometry::Segment>> edges_;
};

}  // namespace

RouteVerdict verdict_on(const std::vector<geometry::Obstacle>& obstacles, const geometry::RouteQuestion& question,
                        const geometry::RouteAnswer& answer) {
  return std::visit(Checker(obstacles, question), answer);
}

}  // namespace exactvo::test
