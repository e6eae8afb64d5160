// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/realise.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"
#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// The path keeps to circles this much larger than the disc, which pays for the rounding of its corners. A vertex that
/// the path cuts by no more than half of it needs no circle of its own: the other half still pays.
constexpr double kRadiusSlack = 1e-11;
constexpr double kCoordinateSlack = 0x1p-50;

/// In (-pi, pi].
double wrapped(double angle) {
  while (angle > kPi) angle -= 2.0 * kPi;
  while (angle <= -kPi) angle += 2.0 * kPi;
  return angle;
}

struct Circle {
  Vec2 centre;
  int sense;  ///< 1: the route turns left round it, which lies to its left; -1: right
  int vertex;
  std::size_t at = 0;  ///< its portal's place in the way
};

/// The shortest curve from one point to another that passes given circles on given sides, as a polyline outside of
/// them.
class TautString {
 public:
  TautString(const ClearancePlan& plan, Vec2 from, Vec2 to, std::vector<Circle> circles)
      : plan_(plan), from_(from), to_(to), circles_(std::move(circles)) {
    const double size = std::max({std::fabs(from.x), std::fabs(from.y), std::fabs(to.x), std::fabs(to.y)});
    radius_ = plan.radius() * (1.0 + kRadiusSlack) + kCoordinateSlack * size;
  }

  /// Drops circles that the string does not touch and takes up those that it cuts, until neither is left. False where
  /// that does not come to an end. A round is linear; a row of vertices that are all cut takes the logarithm of them.
  bool pull() {
    constexpr int kMostRounds = 400;
    for (int round = 0; round < kMostRounds; ++round) {
      drop_loose_circles();
      find_tangents();
      if (!take_up_cut_vertices()) return true;
    }
    return false;
  }

  /// The corners between the ends, arcs in steps of at most `step` rad.
  std::vector<Point> corners(double step) const {
    std::vector<Point> out;
    for (std::size_t i = 0; i < circles_.size(); ++i) {
      const double turn = wrapped(angles_[i + 1] - angles_[i]);
      const int count = std::max(1, static_cast<int>(std::ceil(std::fabs(turn) / step)));
      const double half = 0.5 * turn / count, reach = radius_ / std::cos(half);
      for (int j = 0; j < count; ++j) {
        const double angle = angles_[i] + (2 * j + 1) * half;
        const double out_of_centre = circles_[i].sense * reach;
        out.emplace_back(circles_[i].centre + Vec2{out_of_centre * std::sin(angle), -out_of_centre * std::cos(angle)});
      }
    }
    return out;
  }

 private:
  /// A straight piece of the string: from one circle, or end of the string (null), to the next.
  struct Tangent {
    double angle;  ///< rad
    Segment piece;
  };
  Tangent tangent(const Circle* from, const Circle* to) const {
    const Vec2 a = from ? from->centre : from_, b = to ? to->centre : to_;
    const double ra = from ? from->sense * radius_ : 0.0, rb = to ? to->sense * radius_ : 0.0;
    const double angle = std::atan2(b.y - a.y, b.x - a.x) + std::asin(std::clamp((ra - rb) / norm(b - a), -1.0, 1.0));
    const Vec2 right{std::sin(angle), -std::cos(angle)};
    return {angle, {a + ra * right, b + rb * right}};
  }

  void find_tangents() {
    const std::size_t n = circles_.size();
    angles_.assign(n + 1, 0.0);
    pieces_.assign(n + 1, {});
    for (std::size_t i = 0; i <= n; ++i) {
      const Tangent t = tangent(i > 0 ? &circles_[i - 1] : nullptr, i < n ? &circles_[i] : nullptr);
      angles_[i] = t.angle;
      pieces_[i] = t.piece;
    }
  }

  /// Goes through the circles once: the string over those kept is taut before the next is looked at, which may let go
  /// of some of the last.
  void drop_loose_circles() {
    std::vector<Circle> kept;
    const auto is_loose = [&](const Circle* next) {
      constexpr double kAgainst = 1e-12;  // rad
      const Circle& last = kept.back();
      if (next && next->centre == last.centre) return true;
      const Circle* before = kept.size() > 1 ? &kept[kept.size() - 2] : nullptr;
      return wrapped(tangent(&last, next).angle - tangent(before, &last).angle) * last.sense < -kAgainst;
    };
    for (const Circle& next : circles_) {
      while (!kept.empty() && is_loose(&next)) kept.pop_back();
      kept.push_back(next);
    }
    while (!kept.empty() && is_loose(nullptr)) kept.pop_back();
    circles_ = std::move(kept);
  }

  /// The vertex that a straight piece cuts deepest becomes a circle of its own; one of each piece.
  bool take_up_cut_vertices() {
    std::vector<Circle> all;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (const std::optional<Circle> cut = deepest_cut(i)) all.push_back(*cut);
      if (i == circles_.size()) break;
      const std::optional<Circle> cut = cut_by_arc(i);
      const Vec2 on{std::cos(angles_[i]), std::sin(angles_[i])};  // of two vertices in a lump, the first along the way
      const bool before = cut && dot(cut->centre - circles_[i].centre, on) < 0.0;
      if (before) all.push_back(*cut);
      all.push_back(circles_[i]);
      if (cut && !before) all.push_back(*cut);
    }
    const bool any = all.size() > circles_.size();
    circles_ = std::move(all);
    return any;
  }

  /// A vertex so near to the circle's own that the search took both for one corner, and that the arc cuts though no
  /// straight piece does: the way out to it from the centre leads through the arc.
  std::optional<Circle> cut_by_arc(std::size_t i) const {
    const Circle& circle = circles_[i];
    const double slack = 0.5 * (radius_ - plan_.radius());
    constexpr double kLump = 1e-3;  // of the radius; more is a corner of its own to the search
    const double turn = wrapped(angles_[i + 1] - angles_[i]);
    const auto is_neighbour = [&](int v) {
      return v == circle.vertex || (i > 0 && circles_[i - 1].vertex == v) ||
             (i + 1 < circles_.size() && circles_[i + 1].vertex == v);
    };
    double deepest = slack;
    std::optional<Circle> found;
    const auto consider = [&](int v) {
      const Vec2 out = plan_.map().vertex(v).rounded() - circle.centre;
      const double depth = norm(out);
      if (!(depth > deepest) || depth > kLump * radius_ || is_neighbour(v)) return;
      // The route's direction where it passes the point of the arc that is farthest out towards the vertex.
      const double direction = std::atan2(circle.sense * out.x, -circle.sense * out.y);
      const double after = wrapped(direction - angles_[i]) * circle.sense;
      if (!(after > 0.0 && after < std::fabs(turn))) return;
      deepest = depth;
      found = Circle{plan_.map().vertex(v).rounded(), circle.sense, v};
    };
    if (!(turn * circle.sense > 0.0)) return found;
    plan_.grid().for_each_near(circle.centre, circle.centre, kLump * radius_, [&](int k) {
      const auto [a, b] = plan_.ends_of(k);
      consider(a);
      if (b != a) consider(b);
      return true;
    });
    return found;
  }

  std::optional<Circle> deepest_cut(std::size_t i) const {
    const CellMap& map = plan_.map();
    const Segment piece = pieces_[i];
    const Vec2 d = piece.b - piece.a;
    const double length = norm(d);
    double deepest = 0.5 * (radius_ - plan_.radius());
    std::optional<Circle> found;
    if (!(length > 0.0)) return found;
    const auto consider = [&](int v) {
      if ((i > 0 && circles_[i - 1].vertex == v) || (i < circles_.size() && circles_[i].vertex == v)) return;
      const Vec2 p = map.vertex(v).rounded() - piece.a;
      const double on = dot(p, d) / length, left = cross(d, p) / length;
      if (on <= 0.0 || on >= length || !(radius_ - std::fabs(left) > deepest)) return;
      deepest = radius_ - std::fabs(left);
      found = Circle{map.vertex(v).rounded(), left > 0.0 ? 1 : -1, v};
    };
    plan_.grid().for_each_near(piece.a, piece.b, radius_, [&](int k) {
      const auto [a, b] = plan_.ends_of(k);
      consider(a);
      if (b != a) consider(b);
      return true;
    });
    return found;
  }

  const ClearancePlan& plan_;
  Vec2 from_, to_;
  std::vector<Circle> circles_;
  double radius_;
  std::vector<double> angles_;  ///< rad, of the straight pieces
  std::vector<Segment> pieces_;
};

/// A tight gate: its exact middle and the exact direction at right angles to it.
struct Gate {
  Point middle;
  Vector<Rational> through;  ///< in the sense of the route
  double width;              ///< m, |through|, rounded
};

class Realiser {
 public:
  Realiser(const ClearancePlan& plan, const Way& way) : plan_(plan), map_(plan.map()), way_(way) {}

  std::optional<std::vector<Point>> operator()(Vec2 s, Vec2 t) {
    split();
    std::vector<std::vector<Point>> before, after;  // of each gate: points on the straight way into it and out of it
    for (const Gate& gate : gates_) {
      before.push_back(approach(gate, -1));
      after.push_back(approach(gate, 1));
    }
    const std::size_t n = gates_.size();
    route_.assign(1, Point(s));
    for (std::size_t i = 0; i <= n; ++i) {
      const std::vector<Point> from = i > 0 ? after[i - 1] : departures(s);
      const std::vector<Point> to = i < n ? before[i] : departures(t);
      if (!straight_to_next_gate(i) && !between(from, to, legs_[i]) && !in_parts(from, to, legs_[i]) &&
          !by_the_middles(from, to, legs_[i]))
        return std::nullopt;
      append(i < n ? gates_[i].middle : Point(t));
    }
    return std::move(route_);
  }

 private:
  /// What lies between two gates.
  struct Leg {
    std::vector<Circle> circles;
    std::size_t first = 0, last = 0;  ///< its portals
  };

  void split() {
    legs_.assign(1, {});
    for (const Waypoint& w : way_.waypoints) {
      if (w.portal < 0) {
        legs_.back().circles.push_back(
            {map_.vertex(w.vertex).rounded(), w.on_left ? 1 : -1, w.vertex, static_cast<std::size_t>(w.at)});
        continue;
      }
      const Gate gate = gate_of(w.portal, w.from_left);
      // A narrow side that is no Gabriel link is no gate: its middle is not free.
      if (!plan_.is_clear(gate.middle, gate.middle)) continue;
      gates_.push_back(gate);
      legs_.back().last = static_cast<std::size_t>(w.at);
      legs_.emplace_back();
      legs_.back().first = static_cast<std::size_t>(w.at) + 1;
    }
    legs_.back().last = way_.portals.size();
  }

  Gate gate_of(int number, bool from_left) const {
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
    const Vector<Rational> a = p.exact(), b = q.exact(), d = minus(b, a);
    // Across it to the right of p -> q leads from its left cell to its right one.
    const int sense = from_left ? 1 : -1;
    return {Point(Rational((a.x + b.x) / 2), Rational((a.y + b.y) / 2)),
            {Rational(sense * d.y), Rational(-sense * d.x)},
            norm(q.rounded() - p.rounded())};
  }

  /// Points beside the middle from which the gate is passed straight, farthest first; the last is the middle itself.
  std::vector<Point> approach(const Gate& gate, int sense) const {
    std::vector<Point> out;
    for (const double share : {0.15, 0.05, 0.01, 1e-3, 1e-5}) {
      const Rational k(sense * share * plan_.radius() / gate.width);
      const Vector<Rational> m = gate.middle.exact();
      const Point p(Rational(m.x + k * gate.through.x), Rational(m.y + k * gate.through.y));
      if (plan_.is_clear(p, gate.middle)) out.push_back(p);
    }
    out.push_back(gate.middle);
    return out;
  }

  /// Along the sites that the disc touches at x, or nearly; parallel ones once.
  std::vector<Vector<Rational>> tangents_at(Vec2 x) const {
    constexpr double kContact = 1.0 + 1e-6;
    std::vector<Vector<Rational>> tangents;
    for (const int piece : plan_.pieces_within(x, kContact * plan_.radius())) {
      const auto [i, j] = plan_.ends_of(piece);
      const Point &a = map_.vertex(i), &b = map_.vertex(j);
      const bool at_a = along(x, a, a, b) <= 0, at_b = along(x, b, a, b) >= 0;
      const Vector<Rational> away = minus(Point(x).exact(), (at_a ? a : b).exact());
      const Vector<Rational> tangent =
          at_a || at_b ? Vector<Rational>{Rational(away.y), Rational(-away.x)} : minus(b.exact(), a.exact());
      const bool known = std::any_of(tangents.begin(), tangents.end(), [&](const Vector<Rational>& t) {
        const Rational turn = cross_of(t, tangent);
        return sgn(turn) == 0;
      });
      if (!known) tangents.push_back(tangent);
    }
    return tangents;
  }

  /// An end of the route, behind points from which it is reached straight. Where the disc stands in contact with a
  /// site, it can leave along the tangent, which is rational, and perhaps in no other direction that doubles name.
  std::vector<Point> departures(Vec2 x) const {
    const std::vector<Vector<Rational>> tangents = tangents_at(x);
    std::vector<Point> out;
    for (const double share : {0.15, 0.05, 0.01, 1e-3, 1e-5}) {
      for (const Vector<Rational>& tangent : tangents) {
        const double length = std::hypot(tangent.x.get_d(), tangent.y.get_d());
        for (const double sense : {1.0, -1.0}) {
          const Rational k(sense * share * plan_.radius() / length);
          const Point p(Rational(x.x + k * tangent.x), Rational(x.y + k * tangent.y));
          if (plan_.is_clear(p, x)) out.push_back(p);
        }
      }
    }
    out.emplace_back(x);
    return out;
  }

  void append(const Point& p) {
    if (p.is_double() && route_.back().is_double() && p.rounded() == route_.back().rounded()) return;
    route_.push_back(p);
  }
  void append(const std::vector<Point>& points) {
    for (const Point& p : points) append(p);
  }

  bool straight_to_next_gate(std::size_t i) {
    return i > 0 && i < gates_.size() && plan_.is_clear(gates_[i - 1].middle, gates_[i].middle);
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
  /// the ends, from which a way is proven most easily; then points nearer to the ends, while that is shorter.
  bool between(const std::vector<Point>& from, const std::vector<Point>& to, const Leg& leg) {
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
    for (std::size_t k = i + 1; k < from.size(); ++k) try_pair(k, j);
    for (std::size_t l = j + 1; l < to.size(); ++l) try_pair(i, l);
    append(best->points);
    return true;
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
    if (whole_side || short_link) return gate_of(number, true).middle;
    const ShrunkPortal& q = plan_.shrunk(number);
    return Point(0.5 * (q.from + q.to));
  }

  const ClearancePlan& plan_;
  const CellMap& map_;
  const Way& way_;
  std::vector<Gate> gates_;
  std::vector<Leg> legs_;  ///< one more than gates
  std::vector<Point> route_;
};

}  // namespace

std::optional<std::vector<Point>> realised(const ClearancePlan& plan, Vec2 s, Vec2 t, const Way& way) {
  return Realiser(plan, way)(s, t);
}

}  // namespace exactvo::geometry::routing
