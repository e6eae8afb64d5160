// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/realise.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"
#include "routes/plan.h"
#include "routes/signs.h"
#include "routes/taut_string.h"

namespace exactvo::geometry::routing {
namespace {

// Exact straight ways where the disc has no room for rounding: through the middle of a gate that it just fits through,
// and out of contact with a site. Their points are fractions; each way is proven clear.

/// A point with exact directions in which the disc leaves it straight, and reaches it from the other side.
struct Stop {
  Point at;
  std::vector<Vector<Rational>> ways;
};

class StraightWays {
 public:
  explicit StraightWays(const ClearancePlan& plan) : plan_(plan), map_(plan.map()) {}

  /// The middle of the gate that a portal is a piece of, and the way out of it, at right angles, as it is crossed.
  Stop gate_of(int portal, bool from_left) const;

  /// An end of the route. Where the disc stands in contact with sites, it can leave along their tangents, which are
  /// rational, and perhaps in no other direction that doubles name.
  Stop end_at(Vec2 x) const;

  /// Whether the gate is strict Gabriel. The middle of any other narrow side may be off the way, or not free. Then
  /// the way also crosses a narrower gate next to it.
  bool is_gabriel(int portal) const;

  /// Points from which it is reached straight, farthest first; the last is the point itself.
  std::vector<Point> near(const Stop& stop) const;

  /// The same ways as far as they are clear: to where a passage ends that is a few units in the last place wider than
  /// the disc, too few for a taut string. With the points on the way beside `goal` and just beyond the corners. May be
  /// empty.
  std::vector<Point> far(const Stop& stop, const Point& goal, const std::vector<Vec2>& corners) const;

 private:
  Vector<Rational> stretch(const Vector<Rational>& way, double share) const;
  void add_straight_on(const Point& x, const Vector<Rational>& step, const Point& goal,
                       const std::vector<Vec2>& corners, std::vector<Point>& out) const;

  const ClearancePlan& plan_;
  const CellMap& map_;
};

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

class Realiser {
 public:
  Realiser(const ClearancePlan& plan, const Way& way) : plan_(plan), map_(plan.map()), way_(way), straight_(plan) {}

  std::optional<std::vector<Point>> operator()(Vec2 s, Vec2 t) {
    split(s, t);
    route_.assign(1, Point(s));
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      const Leg& leg = legs_[i];
      const std::vector<Point> from = straight_.near(leg.from), to = straight_.near(leg.to);
      const bool is_between_gates = i > 0 && i + 1 < legs_.size();
      if (is_in_gate(leg)) continue;
      if (!(is_between_gates && plan_.is_clear(leg.from.at, leg.to.at)) && !between(from, to, leg) &&
          !between_far(from, to, leg) && !in_parts(from, to, leg) && !by_the_middles(from, to, leg))
        return std::nullopt;
      append(leg.to.at);
    }
    return std::move(route_);
  }

 private:
  /// What lies between two gates.
  struct Leg {
    std::vector<Circle> circles;
    std::size_t first = 0, last = 0;  ///< its portals
    Stop from{}, to{};
  };

  void split(Vec2 s, Vec2 t) {
    legs_.assign(1, {});
    legs_.back().from = straight_.end_at(s);
    for (const Waypoint& w : way_.waypoints) {
      if (w.portal < 0) {
        legs_.back().circles.push_back(
            {map_.vertex(w.vertex).rounded(), w.on_left ? 1 : -1, w.vertex, static_cast<std::size_t>(w.at)});
        continue;
      }
      if (!straight_.is_gabriel(w.portal)) continue;
      legs_.back().last = static_cast<std::size_t>(w.at);
      legs_.back().to = straight_.gate_of(w.portal, !w.from_left);
      legs_.emplace_back();
      legs_.back().first = static_cast<std::size_t>(w.last.at) + 1;
      legs_.back().from = straight_.gate_of(w.last.portal, w.last.from_left);
    }
    legs_.back().last = way_.portals.size();
    legs_.back().to = straight_.end_at(t);
  }

  /// Whether the route begins or ends in the middle of a gate, and the leg leads from there to there.
  bool is_in_gate(const Leg& leg) const {
    const Point &a = leg.from.at, &b = leg.to.at;
    return legs_.size() > 1 && a.is_double() && b.is_double() && a.rounded() == b.rounded() && plan_.is_clear(a, b);
  }

  void append(const Point& p) {
    if (p.is_double() && route_.back().is_double() && p.rounded() == route_.back().rounded()) return;
    route_.push_back(p);
  }
  void append(const std::vector<Point>& points) {
    for (const Point& p : points) append(p);
  }

  /// A proven polyline, its ends included.
  struct Proven {
    std::vector<Point> points;
    double length = 0.0;  ///< m, rounded
  };

  std::optional<Proven> joined(const Point& a, const Point& b, const Point& first, const Point& last,
                               const Leg& leg) const {
    std::optional<std::vector<Point>> corners = round(a, b, leg.circles);
    if (!corners) return std::nullopt;
    Proven out{{a}, norm(a.rounded() - first.rounded()) + norm(b.rounded() - last.rounded())};
    out.points.insert(out.points.end(), corners->begin(), corners->end());
    out.points.push_back(b);
    for (std::size_t k = 1; k < out.points.size(); ++k)
      out.length += norm(out.points[k].rounded() - out.points[k - 1].rounded());
    return out;
  }

  /// From one of the first points to one of the others round the leg's circles. The first points are the farthest from
  /// the ends, from which a way is proven most easily; then points nearer to the ends, while that is shorter: so many
  /// times from all first points, then to all others.
  bool between(const std::vector<Point>& from, const std::vector<Point>& to, const Leg& leg, int rounds = 1) {
    std::optional<Proven> best;
    std::size_t i = 0, j = 0;
    const auto try_pair = [&](std::size_t k, std::size_t l) {
      std::optional<Proven> other = joined(from[k], to[l], from.back(), to.back(), leg);
      if (!other || (best && !(other->length < best->length))) return;
      best = std::move(other);
      i = k;
      j = l;
    };
    for (std::size_t k = 0; k < from.size() && !best; ++k)
      for (std::size_t l = 0; l < to.size() && !best; ++l) try_pair(k, l);
    if (!best) return false;
    for (int round = 0; round < rounds; ++round) {
      const double length = best->length;
      for (std::size_t k = round == 0 ? i + 1 : 0; k < from.size(); ++k) try_pair(k, j);
      for (std::size_t l = round == 0 ? j + 1 : 0; l < to.size(); ++l) try_pair(i, l);
      if (!(best->length < length)) break;
    }
    append(best->points);
    return true;
  }

  /// The same from points farther out, where there are any.
  bool between_far(const std::vector<Point>& from, const std::vector<Point>& to, const Leg& leg) {
    constexpr std::size_t kCorners = 4;  // those after them are seldom on the way straight on
    std::vector<Vec2> first, last;
    for (std::size_t k = 0; k < std::min(kCorners, leg.circles.size()); ++k) {
      first.push_back(leg.circles[k].centre);
      last.push_back(leg.circles[leg.circles.size() - 1 - k].centre);
    }
    std::vector<Point> far_from = straight_.far(leg.from, leg.to.at, first),
                       far_to = straight_.far(leg.to, leg.from.at, last);
    if (far_from.empty() && far_to.empty()) return false;
    far_from.insert(far_from.end(), from.begin(), from.end());
    far_to.insert(far_to.end(), to.begin(), to.end());
    constexpr int kRounds = 4;
    return between(far_from, far_to, leg, kRounds);
  }

  /// The corners of a proven polyline from a to b: none where the straight way is, else taut round the circles.
  std::optional<std::vector<Point>> round(const Point& a, const Point& b, const std::vector<Circle>& circles) const {
    if (circles.empty() && plan_.is_clear(a, b)) return std::vector<Point>{};
    TautString string(plan_, a.rounded(), b.rounded(), circles);
    if (string.pull()) {
      for (const double step : {kPi / 16.0, kPi / 64.0, kPi / 512.0}) {
        std::vector<Point> corners = string.corners(step);
        if (is_clear(a, corners, b)) return corners;
      }
    }
    if (!circles.empty() && plan_.is_clear(a, b)) return std::vector<Point>{};
    return std::nullopt;
  }

  bool is_clear(const Point& a, const std::vector<Point>& corners, const Point& b) const {
    const Point* last = &a;
    for (const Point& p : corners) {
      if (!plan_.is_clear(*last, p)) return false;
      last = &p;
    }
    return plan_.is_clear(*last, b);
  }

  /// Where the string as a whole cannot be proven it is held at a point of a portal halfway, and either half is proven
  /// by itself, so that only where the proof fails the route strays.
  bool in_parts(const std::vector<Point>& from, const std::vector<Point>& to, const Leg& leg) {
    if (leg.last <= leg.first) return false;
    const std::size_t known = route_.size(), half = leg.first + (leg.last - leg.first) / 2;
    const std::optional<Point> held = point_held(from.front(), to.front(), leg, half);
    if (!held) return false;
    Leg before{{}, leg.first, half}, after{{}, half + 1, leg.last};
    for (const Circle& c : leg.circles) (c.at <= half ? before : after).circles.push_back(c);
    const std::vector<Point> station{*held};
    const auto proven = [&](const std::vector<Point>& a, const std::vector<Point>& b, const Leg& part) {
      return between(a, b, part) || in_parts(a, b, part) || by_the_middles(a, b, part);
    };
    if (proven(from, station, before) && proven(station, to, after)) return true;
    route_.resize(known);
    return false;
  }

  /// A clear point of a portal, where the string round the leg's circles crosses it or near to that.
  std::optional<Point> point_held(const Point& a, const Point& b, const Leg& leg, std::size_t place) const {
    const ShrunkPortal& q = plan_.shrunk(way_.portals[place]);
    const Vec2 middle = 0.5 * (q.from + q.to), d = q.to - q.from;
    Vec2 best = middle;
    TautString string(plan_, a.rounded(), b.rounded(), leg.circles);
    if (string.pull()) {
      std::vector<Point> corners = string.corners(kPi / 16.0);
      corners.push_back(b);
      Vec2 last = a.rounded();
      for (const Point& p : corners) {
        const double one = cross(d, last - q.from), two = cross(d, p.rounded() - q.from);
        if ((one < 0.0) != (two < 0.0)) {
          const Vec2 x = last + one / (one - two) * (p.rounded() - last);
          const double share = dot(x - q.from, d) / squared_norm(d);
          if (share > -0.5 && share < 1.5) best = q.from + std::clamp(share, 0.0, 1.0) * d;
        }
        last = p.rounded();
      }
    }
    for (const double inward : {0.0, 1e-9, 1e-6, 1e-3, 0.1, 1.0}) {
      const Point p = best + inward * (middle - best);
      if (plan_.is_clear(p, p)) return p;
    }
    const Point exact = middle_of(way_.portals[place]);
    if (plan_.is_clear(exact, exact)) return exact;
    return std::nullopt;
  }

  /// Where that does not help either: through the middles of the portals, as far at a time as is clear, and taut
  /// in between where the next is not in sight.
  bool by_the_middles(const std::vector<Point>& from, const std::vector<Point>& to, const Leg& leg) {
    const std::size_t known = route_.size();
    std::vector<Point> stations{from.back()};
    for (std::size_t k = from.size() - 1; k-- > 0;) stations.push_back(from[k]);
    for (std::size_t k = leg.first; k < leg.last; ++k) {
      const Point m = middle_of(way_.portals[k]);
      if (plan_.is_clear(m, m)) stations.push_back(m);
    }
    for (const Point& p : to) stations.push_back(p);
    append(stations.front());
    for (std::size_t k = 0; k + 1 < stations.size();) {
      const std::size_t next = next_station(stations, k);
      if (next == k) {
        route_.resize(known);
        return false;
      }
      k = next;
    }
    return true;
  }

  /// Goes on from one station to a later one, and says to which; to itself where none can be reached.
  std::size_t next_station(const std::vector<Point>& stations, std::size_t k) {
    constexpr std::size_t kSight = 40, kReach = 12;
    for (std::size_t j = std::min(stations.size() - 1, k + kSight); j > k; --j) {
      if (!plan_.is_clear(stations[k], stations[j])) continue;
      append(stations[j]);
      return j;
    }
    for (std::size_t j = k + 1; j < std::min(stations.size(), k + kReach); ++j) {
      const std::optional<std::vector<Point>> corners = round(stations[k], stations[j], {});
      if (!corners) continue;
      append(*corners);
      append(stations[j]);
      return j;
    }
    return k;
  }

  Point middle_of(int number) const {
    const Portal& portal = map_.portals[number];
    const bool whole_side = portal.link < 0 && portal.from.vertex >= 0 && portal.to.vertex >= 0 &&
                            map_.is_site(portal.from.vertex) && map_.is_site(portal.to.vertex);
    const bool short_link = portal.link >= 0 && map_.links[portal.link].length < 4.0 * plan_.radius();
    if (whole_side || short_link) return straight_.gate_of(number, true).at;
    const ShrunkPortal& q = plan_.shrunk(number);
    return Point(0.5 * (q.from + q.to));
  }

  const ClearancePlan& plan_;
  const CellMap& map_;
  const Way& way_;
  StraightWays straight_;
  std::vector<Leg> legs_;
  std::vector<Point> route_;
};

}  // namespace

std::optional<std::vector<Point>> realised(const ClearancePlan& plan, Vec2 s, Vec2 t, const Way& way) {
  return Realiser(plan, way)(s, t);
}

}  // namespace exactvo::geometry::routing
