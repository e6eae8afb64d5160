// SPDX-License-Identifier: GPL-3.0-or-later
// In rationals: the check shares nothing with what finds routes.
#include "exactvo/geometry/route_certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exact/rational_plane.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using rational::cross;
using rational::dot;
using rational::east;
using rational::exactly;
using rational::Rational;
using rational::ray_crosses;
using rational::squared_distance;
using ExactPlace = rational::Point;
using Stretch = rational::Straight;

/// Doubles that are not more and not less: GMP rounds towards 0.
double not_above(const Rational& x) {
  return std::nextafter(x.get_d(), -std::numeric_limits<double>::infinity());
}
double not_below(const Rational& x) {
  return std::nextafter(x.get_d(), std::numeric_limits<double>::infinity());
}

/// "numerator/denominator" or "numerator", or the double where the text is empty. Nothing where it is something else,
/// or where the double is none of the two next to it.
std::optional<Rational> number_of(const std::string& text, double rounded) {
  if (!std::isfinite(rounded)) return std::nullopt;
  if (text.empty()) return Rational(rounded);
  const std::string allowed = "-0123456789/";
  if (text.find_first_not_of(allowed) != std::string::npos) return std::nullopt;
  Rational value;
  if (value.set_str(text, 10) != 0 || value.get_den() == 0) return std::nullopt;
  value.canonicalize();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double below = std::nextafter(rounded, -kInfinity), above = std::nextafter(rounded, kInfinity);
  const bool is_next =
      (!std::isfinite(below) || value > Rational(below)) && (!std::isfinite(above) || value < Rational(above));
  return is_next ? std::optional(value) : std::nullopt;
}

std::optional<ExactPlace> place_of(const ExactPoint& p) {
  const std::optional<Rational> x = number_of(p.x, p.rounded.x), y = number_of(p.y, p.rounded.y);
  if (!x || !y) return std::nullopt;
  return ExactPlace{*x, *y};
}

/// Rounded, a few units in the last place off.
double length_of(const std::vector<ExactPlace>& points) {
  double length = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const ExactPlace d = points[k] - points[k - 1];
    length += std::hypot(d.x.get_d(), d.y.get_d());
  }
  return length;
}

bool lies_on(const ExactPlace& p, const Stretch& s) {
  return sgn(squared_distance(p, s)) == 0;
}

/// Whether two stretches have a point in common other than an end of the first that may (`a_may`, `b_may`).
bool touch(const Stretch& s, const Stretch& t, bool a_may, bool b_may) {
  const bool a_on = lies_on(s.from, t), b_on = lies_on(s.to, t);
  if ((a_on && !a_may) || (b_on && !b_may) || (a_on && b_on && !(s.from == s.to))) return true;
  for (const ExactPlace& p : {t.from, t.to})
    if (lies_on(p, s) && !(a_may && p == s.from) && !(b_may && p == s.to)) return true;
  return rational::cross_properly(s, t);
}

/// By their angle from the direction to the right, counter-clockwise.
bool turns_less(const ExactPlace& u, const ExactPlace& v) {
  const auto is_upper = [](const ExactPlace& d) { return sgn(d.y) > 0 || (sgn(d.y) == 0 && sgn(d.x) > 0); };
  if (is_upper(u) != is_upper(v)) return is_upper(u);
  return sgn(cross(u, v)) > 0;
}

/// A direction that is passed on the turn from u to v, counter-clockwise; from u to itself it is a whole turn.
ExactPlace between(const ExactPlace& u, const ExactPlace& v) {
  const int turn = sgn(cross(u, v));
  if (turn == 0 && sgn(dot(u, v)) > 0) return {Rational(-u.x), Rational(-u.y)};
  if (turn == 0) return {Rational(-u.y), u.x};
  const Rational sign(turn);
  return {Rational(sign * (u.x + v.x)), Rational(sign * (u.y + v.y))};
}

class Checker {
 public:
  Checker(const std::vector<Obstacle>& obstacles, const RouteQuestion& question)
      : radius_(question.radius), start_(exactly(question.start)), goal_(exactly(question.goal)) {
    squared_ = radius_ * radius_;
    for (const Obstacle& obstacle : obstacles) {
      solid_.push_back(has_interior(obstacle));
      edges_.push_back(edges_of(obstacle));
      for (const Segment& e : edges_.back()) EXACTVO_REQUIRE(is_finite(e.a) && is_finite(e.b), excerpt({e.a, e.b}));
    }
  }

  std::string operator()(const Route& route) const {
    std::vector<ExactPlace> points;
    for (std::size_t k = 0; k < route.points.size(); ++k) {
      const std::optional<ExactPlace> p = place_of(route.points[k]);
      if (!p) return at(k) + "no pair of numbers, or not those that are rounded";
      points.push_back(*p);
    }
    if (points.empty()) return "no points";
    if (!(points.front() == start_)) return at(0) + "not the start";
    if (!(points.back() == goal_)) return at(points.size() - 1) + "not the goal";
    if (!leaves_into_the_open(points)) return at(0) + "inside an obstacle";
    const std::size_t pieces = std::max<std::size_t>(points.size(), 2) - 1;
    for (std::size_t k = 0; k < pieces; ++k) {
      const std::string why =
          too_near({points[k], points[std::min(k + 1, points.size() - 1)]}, k == 0, k + 1 == pieces);
      if (!why.empty()) return at(k) + why;
    }
    constexpr double kRounding = 0x1p-40;  // far more than a sum of 2^12 square roots is off by
    const double length = length_of(points);
    if (!(std::fabs(route.length - length) <= kRounding * length)) return "its length is not that of its points";
    constexpr double kOfSearch = 0x1p-30;  // the bound's own rounding
    if (!(route.lower_bound >= 0.0 && route.lower_bound <= length * (1.0 + kOfSearch)))
      return "its lower bound is more than its length";
    return "";
  }

  std::string operator()(const Separated& separated) const {
    const std::vector<ChainPoint>& chain = separated.chain;
    if (chain.size() < 2) return "fewer than two points";
    std::vector<Stretch> sides;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const ChainPoint &here = chain[k], &next = chain[(k + 1) % chain.size()];
      const std::optional<ExactPlace> p = place_of(here.point), q = place_of(next.point);
      if (!p || !q) return at(k) + "no pair of numbers, or not those that are rounded";
      if (!exists(here.on)) return at(k) + "no such edge";
      if (!lies_on(*p, edge(here.on))) return at(k) + "not on its edge";
      if (here.gap_follows) {
        const ExactPlace gap = *q - *p;
        if (!(dot(gap, gap) < 4 * squared_)) return at(k) + "the gap behind it is not narrower than two radii";
      } else if (!lies_on(*q, edge(here.on))) {
        return at(k) + "the next point is not on its edge";
      }
      sides.push_back({*p, *q});
    }
    // The chain may touch a point's ends, but must pass each of them on one side.
    std::vector<bool> is_round[2];
    for (const ExactPlace* end : {&start_, &goal_}) {
      for (const ExactPlace& d : open_directions(*end)) {
        bool round = false;
        for (const Stretch& side : sides) round ^= ray_crosses(*end, d, side.from, side.to);
        is_round[end == &goal_].push_back(round);
      }
    }
    if (is_round[0].empty() || is_round[1].empty()) return "an end is not free";
    for (const std::vector<bool>& round : is_round)
      if (std::find(round.begin(), round.end(), !round.front()) != round.end()) return "it passes through an end";
    return is_round[0].front() == is_round[1].front() ? "it does not separate the start from the goal" : "";
  }

  std::string operator()(const Blocked& blocked) const {
    const ExactPlace& end = blocked.end == Blocked::End::start ? start_ : goal_;
    if (blocked.inside) {
      if (blocked.by.obstacle >= edges_.size() || !inside(blocked.by.obstacle, end, east()))
        return "not inside that obstacle";
      return is_on_edge(blocked.by.obstacle, end) ? "on the edge of that obstacle" : "";
    }
    if (!exists(blocked.by)) return "no such edge";
    const Rational distance = squared_distance(end, edge(blocked.by));
    if (sgn(radius_) > 0) return distance < squared_ ? "" : "not nearer than the radius to that edge";
    if (sgn(distance) != 0) return "not on that edge";
    return open_directions(end).empty() ? "" : "free on a side of that edge";
  }

 private:
  static std::string at(std::size_t k) { return "point " + std::to_string(k) + ": "; }
  bool exists(const EdgeName& name) const {
    return name.obstacle < edges_.size() && name.edge < edges_[name.obstacle].size();
  }
  Stretch edge(const EdgeName& name) const { return exactly(edges_[name.obstacle][name.edge]); }

  bool is_on_edge(std::size_t obstacle, const ExactPlace& p) const {
    return std::any_of(edges_[obstacle].begin(), edges_[obstacle].end(),
                       [&](const Segment& e) { return lies_on(p, exactly(e)); });
  }
  /// Whether the obstacle holds what follows p along d, which no edge through p does.
  bool inside(std::size_t obstacle, const ExactPlace& p, const ExactPlace& d) const {
    bool in = false;
    if (solid_[obstacle])
      for (const Segment& e : edges_[obstacle]) in ^= ray_crosses(p, d, exactly(e.a), exactly(e.b));
    return in;
  }
  bool inside_any(const ExactPlace& p, const ExactPlace& d) const {
    for (std::size_t i = 0; i < edges_.size(); ++i)
      if (inside(i, p, d)) return true;
    return false;
  }

  /// Where p is free: a direction from it into each part of the free space that it is a point of. For a radius above 0
  /// that is one. A point may lie on edges: then one between each two of them that follow one another round it.
  std::vector<ExactPlace> open_directions(const ExactPlace& p) const {
    std::vector<ExactPlace> along;
    bool is_near = false;
    for_each_edge_near({p, p}, [&](std::size_t, std::size_t, const Stretch& e) {
      is_near = is_near || squared_distance(p, e) < squared_;
      if (sgn(radius_) > 0 || !lies_on(p, e)) return;
      for (const ExactPlace& end : {e.from, e.to})
        if (!(end == p)) along.push_back(end - p);
    });
    if (is_near) return {};
    std::sort(along.begin(), along.end(), turns_less);
    std::vector<ExactPlace> open;
    if (along.empty()) open.push_back(east());
    for (std::size_t k = 0; k < along.size(); ++k) {
      const ExactPlace &u = along[k], &v = along[(k + 1) % along.size()];
      const bool is_last_of_its_kind = k + 1 == along.size() || turns_less(u, v);
      if (is_last_of_its_kind) open.push_back(between(u, v));
    }
    open.erase(std::remove_if(open.begin(), open.end(), [&](const ExactPlace& d) { return inside_any(p, d); }),
               open.end());
    return open;
  }

  /// Whether a route begins outside of all obstacles; what touches no edge on its way stays there.
  bool leaves_into_the_open(const std::vector<ExactPlace>& points) const {
    if (points.size() < 2 || points[0] == points[1]) return !open_directions(start_).empty();
    bool touches = false;
    for_each_edge_near({start_, start_},
                       [&](std::size_t, std::size_t, const Stretch& e) { touches = touches || lies_on(start_, e); });
    return !inside_any(start_, touches ? points[1] - points[0] : east());
  }

  /// Calls f(obstacle, edge, stretch) for every edge that may come within a radius of the piece, and some others.
  template <typename F>
  void for_each_edge_near(const Stretch& piece, const F& f) const {
    const auto [left, right] = std::minmax(piece.from.x, piece.to.x);
    const auto [low, high] = std::minmax(piece.from.y, piece.to.y);
    const double x0 = not_above(left - radius_), x1 = not_below(right + radius_);
    const double y0 = not_above(low - radius_), y1 = not_below(high + radius_);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      for (std::size_t k = 0; k < edges_[i].size(); ++k) {
        const Segment& e = edges_[i][k];
        const bool apart = (e.a.x < x0 && e.b.x < x0) || (e.a.x > x1 && e.b.x > x1) || (e.a.y < y0 && e.b.y < y0) ||
                           (e.a.y > y1 && e.b.y > y1);
        if (!apart) f(i, k, exactly(e));
      }
    }
  }

  /// A point may touch obstacles with the first end of its first piece and with the last end of its last.
  std::string too_near(const Stretch& piece, bool is_first, bool is_last) const {
    std::string why;
    for_each_edge_near(piece, [&](std::size_t i, std::size_t k, const Stretch& e) {
      const bool is_wrong = sgn(radius_) > 0 ? come_nearer_than(piece, e, radius_) : touch(piece, e, is_first, is_last);
      if (why.empty() && is_wrong)
        why = "nearer to edge " + std::to_string(k) + " of obstacle " + std::to_string(i) + " than the radius";
    });
    return why;
  }

  Rational radius_, squared_;
  ExactPlace start_, goal_;
  std::vector<char> solid_;
  std::vector<std::vector<Segment>> edges_;
};

}  // namespace

std::string check(const std::vector<Obstacle>& obstacles, const RouteQuestion& question, const RouteAnswer& answer) {
  EXACTVO_REQUIRE(std::isfinite(question.radius) && question.radius >= 0.0, std::to_string(question.radius));
  EXACTVO_REQUIRE(is_finite(question.start) && is_finite(question.goal), to_string({question.start, question.goal}));
  return std::visit(Checker(obstacles, question), answer);
}

}  // namespace exactvo::geometry
