// SPDX-License-Identifier: GPL-3.0-or-later
// Written out in rationals although others have such lines: who checks shares nothing with what is checked.
#include "exactvo/geometry/route_certificate.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using Rational = mpq_class;

struct Place {
  Rational x, y;
};
bool operator==(const Place& a, const Place& b) {
  return a.x == b.x && a.y == b.y;
}
Place operator-(const Place& a, const Place& b) {
  return {Rational(a.x - b.x), Rational(a.y - b.y)};
}
Rational inner(const Place& a, const Place& b) {
  return a.x * b.x + a.y * b.y;
}
Rational outer(const Place& a, const Place& b) {
  return a.x * b.y - a.y * b.x;
}

struct Stretch {
  Place a, b;
};

Place place_of(Vec2 p) {
  return {Rational(p.x), Rational(p.y)};
}
Stretch stretch_of(const Segment& s) {
  return {place_of(s.a), place_of(s.b)};
}

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

std::optional<Place> place_of(const ExactPoint& p) {
  const std::optional<Rational> x = number_of(p.x, p.rounded.x), y = number_of(p.y, p.rounded.y);
  if (!x || !y) return std::nullopt;
  return Place{*x, *y};
}

/// Rounded, a few units in the last place off.
double length_of(const std::vector<Place>& points) {
  double length = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const Place d = points[k] - points[k - 1];
    length += std::hypot(d.x.get_d(), d.y.get_d());
  }
  return length;
}

Rational squared_distance(const Place& p, const Stretch& s) {
  const Place e = s.b - s.a, d = p - s.a;
  const Rational length = inner(e, e);
  Rational share = sgn(length) > 0 ? Rational(inner(d, e) / length) : Rational(0);
  share = std::min(std::max(share, Rational(0)), Rational(1));
  const Place rest{Rational(d.x - share * e.x), Rational(d.y - share * e.y)};
  return inner(rest, rest);
}

bool cross_inside(const Stretch& s, const Stretch& t) {
  const auto turn = [](const Stretch& u, const Place& p) { return sgn(outer(u.b - u.a, p - u.a)); };
  return turn(s, t.a) * turn(s, t.b) < 0 && turn(t, s.a) * turn(t, s.b) < 0;
}

/// Squared distances. A point, whose radius is 0, must not touch anything.
bool is_too_near(const Rational& distance, const Rational& radius) {
  return distance < radius || (sgn(radius) == 0 && sgn(distance) == 0);
}

bool comes_nearer_than(const Stretch& s, const Stretch& t, const Rational& squared) {
  return cross_inside(s, t) || is_too_near(squared_distance(s.a, t), squared) ||
         is_too_near(squared_distance(s.b, t), squared) || is_too_near(squared_distance(t.a, s), squared) ||
         is_too_near(squared_distance(t.b, s), squared);
}

/// Whether the ray from p to the right crosses ab; of its ends the upper one counts.
bool ray_crosses(const Place& p, const Place& a, const Place& b) {
  if ((a.y > p.y) == (b.y > p.y)) return false;
  const int side = sgn(outer(b - a, p - a));
  return b.y > a.y ? side > 0 : side < 0;
}

class Checker {
 public:
  Checker(const std::vector<Obstacle>& obstacles, const RouteQuestion& question)
      : radius_(question.radius), start_(place_of(question.start)), goal_(place_of(question.goal)) {
    squared_ = radius_ * radius_;
    for (const Obstacle& obstacle : obstacles) {
      solid_.push_back(has_interior(obstacle));
      edges_.push_back(edges_of(obstacle));
    }
  }

  std::string operator()(const Route& route) const {
    std::vector<Place> points;
    for (std::size_t k = 0; k < route.points.size(); ++k) {
      const std::optional<Place> p = place_of(route.points[k]);
      if (!p) return at(k) + "no pair of numbers, or not those that are rounded";
      points.push_back(*p);
    }
    if (points.empty()) return "no points";
    if (!(points.front() == start_)) return at(0) + "not the start";
    if (!(points.back() == goal_)) return at(points.size() - 1) + "not the goal";
    if (inside_any(start_)) return at(0) + "inside an obstacle";
    for (std::size_t k = 0; k + 1 < std::max<std::size_t>(points.size(), 2); ++k) {
      const std::string why = too_near({points[k], points[std::min(k + 1, points.size() - 1)]});
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
    bool about_start = false, about_goal = false;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const ChainPoint &here = chain[k], &next = chain[(k + 1) % chain.size()];
      const std::optional<Place> p = place_of(here.point), q = place_of(next.point);
      if (!p || !q) return at(k) + "no pair of numbers, or not those that are rounded";
      if (!exists(here.on)) return at(k) + "no such edge";
      if (!lies_on(*p, edge(here.on))) return at(k) + "not on its edge";
      if (here.gap_follows) {
        const Place gap = *q - *p;
        if (!(inner(gap, gap) < 4 * squared_)) return at(k) + "the gap behind it is not narrower than two radii";
      } else if (!lies_on(*q, edge(here.on))) {
        return at(k) + "the next point is not on its edge";
      }
      about_start ^= ray_crosses(start_, *p, *q);
      about_goal ^= ray_crosses(goal_, *p, *q);
    }
    if (about_start == about_goal) return "it does not separate the start from the goal";
    // What separates must keep off both: else it could pass through one of them.
    for (const Place* end : {&start_, &goal_})
      if (inside_any(*end) || !too_near({*end, *end}).empty()) return "an end is not free";
    return "";
  }

  std::string operator()(const Blocked& blocked) const {
    const Place& end = blocked.end == Blocked::End::start ? start_ : goal_;
    if (blocked.inside)
      return blocked.by.obstacle < edges_.size() && inside(blocked.by.obstacle, end) ? "" : "not inside that obstacle";
    if (!exists(blocked.by)) return "no such edge";
    return is_too_near(squared_distance(end, edge(blocked.by)), squared_) ? ""
                                                                          : "not nearer than the radius to that edge";
  }

 private:
  static std::string at(std::size_t k) { return "point " + std::to_string(k) + ": "; }
  bool exists(const EdgeName& name) const {
    return name.obstacle < edges_.size() && name.edge < edges_[name.obstacle].size();
  }
  Stretch edge(const EdgeName& name) const { return stretch_of(edges_[name.obstacle][name.edge]); }

  static bool lies_on(const Place& p, const Stretch& s) { return sgn(squared_distance(p, s)) == 0; }

  bool inside(std::size_t obstacle, const Place& p) const {
    bool in = false;
    if (solid_[obstacle])
      for (const Segment& e : edges_[obstacle]) in ^= ray_crosses(p, place_of(e.a), place_of(e.b));
    return in;
  }
  bool inside_any(const Place& p) const {
    for (std::size_t i = 0; i < edges_.size(); ++i)
      if (inside(i, p)) return true;
    return false;
  }

  std::string too_near(const Stretch& piece) const {
    const auto [left, right] = std::minmax(piece.a.x, piece.b.x);
    const auto [low, high] = std::minmax(piece.a.y, piece.b.y);
    const double x0 = not_above(left - radius_), x1 = not_below(right + radius_);
    const double y0 = not_above(low - radius_), y1 = not_below(high + radius_);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      for (std::size_t k = 0; k < edges_[i].size(); ++k) {
        const Segment& e = edges_[i][k];
        const bool apart = (e.a.x < x0 && e.b.x < x0) || (e.a.x > x1 && e.b.x > x1) || (e.a.y < y0 && e.b.y < y0) ||
                           (e.a.y > y1 && e.b.y > y1);
        if (!apart && comes_nearer_than(piece, stretch_of(e), squared_))
          return "nearer to edge " + std::to_string(k) + " of obstacle " + std::to_string(i) + " than the radius";
      }
    }
    return "";
  }

  Rational radius_, squared_;
  Place start_, goal_;
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
