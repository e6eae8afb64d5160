// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/straight_ways.h"

#include <algorithm>
#include <cmath>

#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// Radii that a gate or an end is left straight, if that is clear: the farther the less room rounding takes.
constexpr double kStraight[] = {0.15, 0.05, 0.01, 1e-3, 1e-5};

Point moved(const Point& p, const Vector<Rational>& by) {
  const Vector<Rational> x = p.exact();
  return Point(Rational(x.x + by.x), Rational(x.y + by.y));
}

/// Whether the inside of the segment ab meets the closed disc with the diameter pq, given that its ends do not.
bool meets_disc_inside(const Point& p, const Point& q, const Point& a, const Point& b) {
  const auto middle_beyond = [&](const Point& x) {  // twice (middle - x).(b - a)
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
      const auto e = to(b) - to(a);
      return dot(to(p) - to(x), e) + dot(to(q) - to(x), e);
    });
  };
  if (middle_beyond(a) <= 0 || middle_beyond(b) >= 0) return false;
  return sign_of([&](auto to) -> NumberOf<decltype(to)> {
           using N = NumberOf<decltype(to)>;
           const auto e = to(b) - to(a), d = to(q) - to(p);
           const N twice = cross(e, to(p) - to(a)) + cross(e, to(q) - to(a));
           return squared(twice) - dot(d, d) * dot(e, e);
         }) <= 0;
}

}  // namespace

Stop StraightWays::gate_of(int number, bool from_left) const {
  const Portal& portal = map_.portals[number];
  Point p, q;  // as the portal runs
  if (portal.link >= 0) {
    const Link& link = map_.links[portal.link];
    p = map_.vertex(link.vertex);
    q = map_.foot(link);
    if (!portal.outward) std::swap(p, q);
  } else {
    const Side& side = map_.sides[portal.side];
    const bool forward = portal.from.vertex == side.a;
    p = map_.vertex(forward ? side.a : side.b);
    q = map_.vertex(forward ? side.b : side.a);
  }
  const Vector<Rational> a = p.exact(), b = q.exact(), d = b - a;
  // Across it to the right of p -> q leads from its left cell to its right one.
  const int sense = from_left ? 1 : -1;
  return {Point(Rational((a.x + b.x) / 2), Rational((a.y + b.y) / 2)),
          {{Rational(sense * d.y), Rational(-sense * d.x)}}};
}

bool StraightWays::is_gabriel(int number) const {
  const Portal& portal = map_.portals[number];
  if (portal.link >= 0) return true;
  const int i = map_.sides[portal.side].a, j = map_.sides[portal.side].b;
  const Point &p = map_.vertex(i), &q = map_.vertex(j);
  const Vec2 middle = 0.5 * (p.rounded() + q.rounded());
  constexpr double kMore = 1.0 + 1e-6;  // than rounding makes of the disc
  return plan_.grid().for_each_near(middle, middle, 0.5 * kMore * norm(q.rounded() - p.rounded()), [&](int piece) {
    const auto [a, b] = map_.ends_of(piece);
    for (const int v : {a, b}) {
      const Point& x = map_.vertex(v);
      const auto to_both = [&](auto to) -> NumberOf<decltype(to)> { return dot(to(p) - to(x), to(q) - to(x)); };
      if (v != i && v != j && sign_of(to_both) <= 0) return false;
    }
    if (a == i || b == i) return along(map_.vertex(a == i ? b : a), p, p, q) <= 0;  // else it leads into the disc
    if (a == j || b == j) return along(map_.vertex(a == j ? b : a), q, q, p) <= 0;
    return a == b || !meets_disc_inside(p, q, map_.vertex(a), map_.vertex(b));
  });
}

/// A share of the radius along a way.
Vector<Rational> StraightWays::stretch(const Vector<Rational>& way, double share) const {
  // The length of the exact difference: gates of crossings of walls may lie in one double.
  const Rational k(share * plan_.radius() / std::hypot(way.x.get_d(), way.y.get_d()));
  return {Rational(k * way.x), Rational(k * way.y)};
}

std::vector<Point> StraightWays::near(const Stop& stop) const {
  std::vector<Point> out;
  for (const double share : kStraight) {
    for (const Vector<Rational>& way : stop.ways) {
      const Point p = moved(stop.at, stretch(way, share));
      if (plan_.is_clear(p, stop.at)) out.push_back(p);
    }
  }
  out.push_back(stop.at);
  return out;
}

/// Along the sites that the disc touches at x, or nearly; parallel ones once.
Stop StraightWays::end_at(Vec2 x) const {
  constexpr double kContact = 1.0 + 1e-6;
  Stop stop{x, {}};
  for (const int piece : plan_.pieces_within(x, kContact * plan_.radius())) {
    const auto [i, j] = map_.ends_of(piece);
    const Point &a = map_.vertex(i), &b = map_.vertex(j);
    const bool at_a = along(x, a, a, b) <= 0, at_b = along(x, b, a, b) >= 0;
    const Vector<Rational> away = Point(x).exact() - (at_a ? a : b).exact();
    const Vector<Rational> tangent =
        at_a || at_b ? Vector<Rational>{Rational(away.y), Rational(-away.x)} : b.exact() - a.exact();
    const bool known = std::any_of(stop.ways.begin(), stop.ways.end(), [&](const Vector<Rational>& way) {
      const Rational turn = cross(way, tangent);
      return sgn(turn) == 0;
    });
    if (known) continue;
    stop.ways.push_back(tangent);
    stop.ways.push_back({Rational(-tangent.x), Rational(-tangent.y)});
  }
  return stop;
}

/// Points x + k step, k >= 1, as far as the way there is clear; first the one beside the goal, then one step beyond
/// each corner, where a wall ends in open space, then the farthest.
void StraightWays::add_straight_on(const Point& x, const Vector<Rational>& step, const Point& goal,
                                   const std::vector<Vec2>& corners, std::vector<Point>& out) const {
  constexpr int kDoublings = 24, kHalvings = 8;
  const auto at = [&](double steps) { return moved(x, {Rational(steps * step.x), Rational(steps * step.y)}); };
  std::vector<Point> found;
  double clear = 1.0, far = 2.0;
  for (int k = 0; k < kDoublings && plan_.is_clear(x, at(far)); ++k, far *= 2.0) found.push_back(at(clear = far));
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (clear + far);
    if (plan_.is_clear(x, at(middle)))
      found.push_back(at(clear = middle));
    else
      far = middle;
  }
  const auto add_beside = [&](const Point& place, int more_steps) {
    Rational share = dot(place.exact() - x.exact(), step) / dot(step, step);
    if (share <= 0) return;
    share += more_steps;
    const Point beside = moved(x, {Rational(share * step.x), Rational(share * step.y)});
    if (plan_.is_clear(x, beside)) found.push_back(beside);
  };
  for (const Vec2 corner : corners) add_beside(corner, 1);
  add_beside(goal, 0);
  out.insert(out.end(), found.rbegin(), found.rend());
}

std::vector<Point> StraightWays::far(const Stop& stop, const Point& goal, const std::vector<Vec2>& corners) const {
  std::vector<Point> out;
  for (const Vector<Rational>& way : stop.ways)
    add_straight_on(stop.at, stretch(way, kStraight[0]), goal, corners, out);
  return out;
}

}  // namespace exactvo::geometry::routing
