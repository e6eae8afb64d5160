// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/point_route.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "routes/funnel.h"

namespace exactvo::geometry::routing {
namespace {

using Polyline = std::vector<Point>;

Vec2 unit(Vec2 d) {
  const double length = norm(d);
  return length > 0.0 ? d / length : Vec2{0.0, 0.0};
}

/// Rounded.
double length_of(const Polyline& points) {
  double length = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) length += norm(points[k].rounded() - points[k - 1].rounded());
  return length;
}

/// What corners of a route from s to t see of each other: s and t may touch obstacles where they say so. A polyline
/// between two such ends that touches nothing else could lead through the inside of an obstacle: it must not begin so.
class Sight {
 public:
  Sight(const ClearancePlan& plan, const RouteEnd& s, const RouteEnd& t)
      : plan_(plan), first_(s), first_may_(s.inside.has_value()), last_may_(t.inside.has_value()) {}

  bool operator()(const Polyline& corners, std::size_t i, std::size_t j) const {
    const bool i_may = i == 0 && first_may_, j_may = j + 1 == corners.size() && last_may_;
    if (!i_may && !j_may) return plan_.is_clear(corners[i], corners[j]);
    return (!i_may || plan_.map().opens_towards(first_.about, corners[j])) &&
           plan_.is_clear_but_at(corners[i], corners[j], i_may, j_may);
  }

 private:
  const ClearancePlan& plan_;
  const RouteEnd& first_;
  bool first_may_, last_may_;
};

/// Leaves corners out where two others see each other. Nothing where two neighbours do not.
class Shortener {
 public:
  Shortener(const Sight& sight, const Polyline& corners) : sight_(sight), corners_(corners) {}

  std::optional<Polyline> operator()() {
    kept_.assign(1, 0);
    std::vector<std::size_t> ends{corners_.size() - 1};  // what is to be reached, the next one last
    while (!ends.empty()) {
      const std::size_t from = kept_.back(), to = ends.back();
      if (sees(from, to)) {
        ends.pop_back();
        keep(to);
      } else if (to > from + 1) {
        ends.push_back(farthest_between(from, to));
      } else {
        return std::nullopt;
      }
    }
    Polyline out;
    for (const std::size_t k : kept_) out.push_back(corners_[k]);
    return out;
  }

 private:
  bool sees(std::size_t i, std::size_t j) const { return sight_(corners_, i, j); }

  /// In place of the last one, where that is not needed.
  void keep(std::size_t corner) {
    if (kept_.size() > 1 && sees(kept_[kept_.size() - 2], corner)) kept_.pop_back();
    kept_.push_back(corner);
  }

  /// From the straight line; halfway where all lie on it.
  std::size_t farthest_between(std::size_t from, std::size_t to) const {
    const Vec2 a = corners_[from].rounded(), d = corners_[to].rounded() - a;
    std::size_t found = from + (to - from) / 2;
    double farthest = 0.0;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double away = std::fabs(cross(d, corners_[k].rounded() - a));
      if (!(away > farthest)) continue;
      farthest = away;
      found = k;
    }
    return found;
  }

  const Sight& sight_;
  const Polyline& corners_;
  std::vector<std::size_t> kept_;
};

/// The shortest curve through a row of portals, and polylines beside it.
class TautCurve {
 public:
  TautCurve(const ClearancePlan& plan, const PortalRow& row, const RouteEnd& s, const RouteEnd& t)
      : plan_(plan), row_(row), s_(s), t_(t), sight_(plan, s, t), turns_(turns_through(row, s.at, t.at)) {
    points_.push_back(s.at);
    for (const Turn& turn : turns_) points_.push_back(row.end(turn.at, turn.left));
    points_.push_back(t.at);
    for (std::size_t k = 1; k < points_.size(); ++k) length_ += norm(points_[k] - points_[k - 1]);
    for (const Vec2 p : points_) size_ = std::max(size_, largest_coordinate(p));
  }

  double length() const { return length_; }
  /// m, the largest coordinate.
  double size() const { return size_; }

  /// One corner beside each vertex that the curve touches, `inset` m away. Nothing where that cannot be proven.
  std::optional<Polyline> beside_vertices(double inset) const {
    Polyline corners{points_.front()};
    if (s_.inside) corners.emplace_back(moved_inside(s_, inset));
    int last = -1;  // the vertex beside which the last corner lies
    for (std::size_t leg = 0; leg + 1 < points_.size(); ++leg) {
      const Vec2 in = unit(points_[leg + 1] - points_[leg]);
      for (std::size_t k = first_of(leg); k < end_of(leg); ++k) {
        const double share = share_of(k, leg), least = inset_share(k, inset);
        const bool left = share > 0.5, is_at_end = share < least || 1.0 - share < least;
        const int vertex = is_at_end ? row_.vertex(k, left) : -1;
        if (vertex < 0) corners.emplace_back(at(k, inner(k, share, inset)));
        if (vertex >= 0 && vertex != last) corners.emplace_back(beside(row_.end(k, left), left, in, in, inset));
        last = vertex;
      }
      if (leg == turns_.size()) break;
      const Turn& turn = turns_[leg];
      const int vertex = row_.vertex(turn.at, turn.left);
      if (vertex >= 0 && vertex == last) corners.pop_back();
      const Vec2 out = unit(points_[leg + 2] - points_[leg + 1]);
      corners.emplace_back(beside(points_[leg + 1], turn.left, in, out, inset));
      last = vertex;
    }
    if (t_.inside) corners.emplace_back(moved_inside(t_, inset));
    corners.emplace_back(points_.back());
    return Shortener(sight_, corners)();
  }

  /// A corner in each portal, exact where rounded ones cannot be proven.
  Polyline through_portals(double inset) const {
    Polyline corners{points_.front()};
    if (s_.inside) corners.emplace_back(moved_inside(s_, inset));
    const std::size_t first = corners.size();  // of those in portals
    std::vector<OnPortal> shares;
    for (std::size_t leg = 0; leg + 1 < points_.size(); ++leg) {
      const std::size_t end = leg < turns_.size() ? turns_[leg].at + 1 : row_.size();
      for (std::size_t k = first_of(leg); k < end; ++k) {
        shares.push_back(inner(k, share_of(k, leg), inset));
        corners.emplace_back(at(k, shares.back()));
      }
    }
    if (t_.inside) corners.emplace_back(moved_inside(t_, inset));
    corners.emplace_back(points_.back());
    const auto exactly = [&](std::size_t i) {
      if (i < first) return exactly_inside(s_, inset);
      if (i >= first + shares.size()) return exactly_inside(t_, inset);
      return exactly_at(i - first, shares[i - first]);
    };
    std::vector<char> is_exact(corners.size(), 0);
    is_exact.front() = is_exact.back() = 1;
    for (std::size_t k = 0; k + 1 < corners.size();) {
      const bool doubtful = !is_exact[k] || !is_exact[k + 1];
      if (!doubtful || sight_(corners, k, k + 1)) {
        ++k;
        continue;
      }
      for (const std::size_t i : {k, k + 1}) {
        if (is_exact[i]) continue;
        corners[i] = exactly(i);
        is_exact[i] = 1;
      }
      if (k > 0) --k;
    }
    std::optional<Polyline> fewer = Shortener(sight_, corners)();
    return fewer ? std::move(*fewer) : corners;
  }

 private:
  /// A place on a portal, as a share of it from the nearer end: 1 - 2^-60 is no double.
  struct OnPortal {
    double share;
    bool from_left;
  };

  /// Portals that the straight piece crosses, without the one at whose end it turns.
  std::size_t first_of(std::size_t leg) const { return leg > 0 ? turns_[leg - 1].at + 1 : 0; }
  std::size_t end_of(std::size_t leg) const { return leg < turns_.size() ? turns_[leg].at : row_.size(); }

  /// Where the piece crosses the portal, as a share of it from right to left.
  double share_of(std::size_t portal, std::size_t leg) const {
    constexpr double kRounding = 0x1p-45;
    const Vec2 a = points_[leg], d = points_[leg + 1] - a;
    const Vec2 right = row_.end(portal, false), along = row_.end(portal, true) - right;
    const double squared = squared_norm(along);
    if (!(squared > 0.0)) return 0.5;
    const double begin = dot(a - right, along) / squared, end = dot(points_[leg + 1] - right, along) / squared;
    const double r = cross(d, right - a), l = cross(d, along);
    // A piece that runs along the portal crosses it where it ends. One that almost does so crosses it between its ends,
    // however wrong the quotient is: beyond them the route would have to come back.
    const double share = std::fabs(l) > kRounding * size_ * norm(d) ? -r / l : end;
    return std::clamp(std::clamp(share, std::min(begin, end), std::max(begin, end)), 0.0, 1.0);
  }

  double inset_share(std::size_t portal, double inset) const {
    constexpr double kMost = 0.25;
    const double width = norm(row_.end(portal, true) - row_.end(portal, false));
    return inset < kMost * width ? inset / width : kMost;
  }
  OnPortal inner(std::size_t portal, double share, double inset) const {
    const bool from_left = share > 0.5;
    return {std::max(from_left ? 1.0 - share : share, inset_share(portal, inset)), from_left};
  }

  Vec2 at(std::size_t portal, OnPortal place) const {
    const Vec2 near = row_.end(portal, place.from_left), far = row_.end(portal, !place.from_left);
    return near + place.share * (far - near);
  }
  Point exactly_at(std::size_t portal, OnPortal place) const {
    auto [near, far] = plan_.map().ends_of(plan_.map().portals[row_.portal(portal)]);
    if (row_.is_from_left(portal) == place.from_left) std::swap(near, far);
    const Vector<Rational> x = near.exact(), y = far.exact();
    const Rational share(place.share);
    return {Rational(x.x + share * (y.x - x.x)), Rational(x.y + share * (y.y - x.y))};
  }
  /// From an end in contact into its triangle, `inset` m, but not beyond its middle.
  static double share_inside(const RouteEnd& end, double inset) {
    const double room = norm(end.inside->rounded() - end.at);
    return inset < room ? inset / room : 1.0;
  }
  static Vec2 moved_inside(const RouteEnd& end, double inset) {
    return end.at + share_inside(end, inset) * (end.inside->rounded() - end.at);
  }
  static Point exactly_inside(const RouteEnd& end, double inset) {
    const Vector<Rational> from = Point(end.at).exact(), to = end.inside->exact();
    const Rational share(share_inside(end, inset));
    return {Rational(from.x + share * (to.x - from.x)), Rational(from.y + share * (to.y - from.y))};
  }
  /// Away from a vertex on the left or right of the curve, which comes along `in` and leaves along `out`.
  static Vec2 beside(Vec2 vertex, bool left, Vec2 in, Vec2 out, double inset) {
    const Vec2 on = in + out, right{on.y, -on.x};
    return vertex + inset * unit(left ? right + (in - out) : (in - out) - right);
  }

  const ClearancePlan& plan_;
  const PortalRow& row_;
  const RouteEnd &s_, &t_;
  Sight sight_;
  std::vector<Turn> turns_;
  std::vector<Vec2> points_;  ///< start, turns, goal
  double length_ = 0.0, size_ = 0.0;
};

}  // namespace

std::vector<Point> point_route(const ClearancePlan& plan, const RouteEnd& s, const RouteEnd& t, const Way& way) {
  constexpr double kHardlyLonger = 1.0 + 1e-9;
  const PortalRow row(plan, way.portals, way.start);
  const TautCurve curve(plan, row, s, t);
  Polyline best;
  double length = 0.0;
  const auto is_short = [&](std::optional<Polyline> found) {
    if (!found) return false;
    const double other = length_of(*found);
    if (best.empty() || other < length) {
      length = other;
      best = std::move(*found);
    }
    return length <= kHardlyLonger * curve.length();
  };
  for (const double share : {0x1p-44, 0x1p-48})
    if (is_short(curve.beside_vertices(share * curve.size()))) return best;
  for (const double share : {0x1p-48, 0x1p-68, 0x1p-108})
    if (is_short(curve.through_portals(share * curve.size()))) return best;
  // Ends in contact may lie on one line of walls, and very near to each other.
  constexpr double kOfLength = 0x1p-34;
  if (s.inside || t.inside) is_short(curve.through_portals(kOfLength * curve.length()));
  return best;
}

}  // namespace exactvo::geometry::routing
