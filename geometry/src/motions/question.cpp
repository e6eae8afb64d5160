// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions/question.h"

#include <algorithm>
#include <cmath>

#include "exact/stages.h"
#include "exactvo/geometry/require.h"
#include "motions/curved.h"
#include "motions/real_roots.h"

namespace exactvo::geometry::motions {
namespace {

using Rational = mpq_class;
using RationalPoint = Vector<Rational>;

using Sum = Vector<Exact>;

Sum sum_of(const Corner& c) {
  return detail::difference<Exact>(c.plus, c.minus);
}
Known turn(const Corner& a, const Corner& b, const Corner& c) {
  return sign_of(cross(sum_of(b) - sum_of(a), sum_of(c) - sum_of(a)));
}
bool same(const Corner& a, const Corner& b) {
  const Sum d = sum_of(a) - sum_of(b);
  return sign_of(d.x) == Known::zero && sign_of(d.y) == Known::zero;
}

/// One chain of Andrew's hull, from the first point to the last, turning left only.
std::vector<Corner> chain(const std::vector<Corner>& sorted) {
  std::vector<Corner> hull;
  for (const Corner& c : sorted) {
    while (hull.size() >= 2 && turn(hull[hull.size() - 2], hull.back(), c) != Known::positive) hull.pop_back();
    hull.push_back(c);
  }
  return hull;
}

std::vector<Vec2> hull_corners(const std::vector<Vec2>& corners) {
  std::vector<Vec2> hull;
  for (const Corner& c : hull_of_differences(corners, {Vec2{}})) hull.push_back(c.plus);
  return hull;
}

void require_body(const RigidBody& body) {
  EXACTVO_REQUIRE(!body.empty(), "no parts");
  for (const RoundedPolygon& part : body) {
    EXACTVO_REQUIRE(part.radius >= 0.0 && std::isfinite(part.radius), hex_text(part.radius));
    EXACTVO_REQUIRE(!part.corners.empty() && std::all_of(part.corners.begin(), part.corners.end(), is_finite),
                    excerpt(part.corners));
    const bool has_interior = part.radius > 0.0 || part.corners.size() == 1 || hull_corners(part.corners).size() != 2;
    EXACTVO_REQUIRE(has_interior, excerpt(part.corners));
  }
}

Target target_of(const std::vector<Vec2>& corners, double radius, const RoundedPolygon& part) {
  return {hull_of_differences(corners, part.corners), part.radius, radius, false};
}

/// Whether the closed obstacle's inside holds k p, seen from the way's origin, by the even-odd rule; unknown signs
/// make it unknown, a point on an edge lies on either side.
template <class T>
Known inside(const std::vector<Segment>& edges, const Anchor& anchor, const Vector<T>& at, const T& scale,
             Vec2 origin) {
  const T count(static_cast<double>(anchor.corners.size()));
  const auto seen = [&](Vec2 vertex) {
    Vector<T> v{T(0.0), T(0.0)};
    for (const Vec2 c : anchor.corners) v = v + (detail::difference<T>(vertex, origin) - detail::make<T>(c));
    return scale * v - count * at;
  };
  bool is_inside = false;
  for (const Segment& edge : edges) {
    const Vector<T> a = seen(edge.a), b = seen(edge.b);
    const Known above_a = sign_of(a.y), above_b = sign_of(b.y);
    if (above_a == Known::unknown || above_b == Known::unknown) return Known::unknown;
    if ((above_a == Known::positive) == (above_b == Known::positive)) continue;
    const Known side = sign_of(cross(a, b));
    if (side == Known::unknown) return side;
    if (side == (above_b == Known::positive ? Known::positive : Known::negative)) is_inside = !is_inside;
  }
  return is_inside ? Known::negative : Known::positive;
}

Encounter encounter_of(Known gap) {
  return gap == Known::negative ? Encounter::overlap : gap == Known::zero ? Encounter::contact : Encounter::clear;
}

/// From the least gap over targets to the verdict's part: thin targets that touch overlap.
Known with_thin(Known gap, bool counts) {
  return counts && gap == Known::zero ? Known::negative : gap;
}

template <class T>
Path<T> path_from(const Question& q, Window w) {
  Path<T> path = relative_path<T>(q.motion(), q.other(), w);
  if (path.c.size() == 1) path.c.push_back({T(0.0), T(0.0)});
  return path;
}

template <class T>
Known reach_sign(const Anchor& anchor, double more) {
  return sign_of(T(T(anchor.reach) + T(more)));
}

/// Targets and anchors over one ring in which the way is straight.
template <class T>
Known straight_question(const Question& q, const Path<T>& path, double more, bool thin_overlaps) {
  const Vec2 origin = origin_of(q.motion());
  const Vector<T> from = path.c[0], to = path.c[0] + path.c[1];
  Known gap = Known::positive;
  for (const Target& target : q.targets()) {
    const Known here = straight_gap(from, to, hull_over<T>(target, origin, q.other_origin(), path.scale, more));
    gap = least(gap, with_thin(here, thin_overlaps && target.thin));
    if (gap == Known::negative) return gap;
  }
  return gap;
}

/// Whether some anchor is inside the obstacle as the window begins; without those that may be on an edge, points in
/// contact. REQUIRES: no other anchor is on an edge.
template <class T>
Known anchor_question(const Question& q, const Path<T>& path, double more, bool in_contact = false) {
  const Vec2 origin = origin_of(q.motion());
  Known gap = Known::positive;
  for (const Anchor& anchor : q.anchors()) {
    const Known reach = reach_sign<T>(anchor, more);
    if (reach == Known::negative || (reach == Known::zero && in_contact && anchor.corners.size() == 1)) continue;
    const Known here = reach == Known::unknown ? reach : inside<T>(q.edges(), anchor, path.c[0], path.scale, origin);
    gap = least(gap, here);
    if (gap == Known::negative) return gap;
  }
  return gap;
}

bool is_on(const Segment& edge, const Anchor& anchor, const RationalPoint& at, const Rational& scale, Vec2 origin) {
  const auto seen = [&](Vec2 vertex) {
    return scale * (detail::difference<Rational>(vertex, origin) - detail::make<Rational>(anchor.corners[0])) - at;
  };
  const RationalPoint a = seen(edge.a), b = seen(edge.b);
  return sgn(cross(a, b)) == 0 && sgn(dot(a, b)) <= 0;
}

}  // namespace

void require_motion(const Motion& motion) {
  const double start = start_of(motion), end = end_of(motion);
  EXACTVO_REQUIRE(std::isfinite(start) && std::isfinite(end) && start <= end, hex_text(start) + " " + hex_text(end));
  if (const auto* straight = std::get_if<StraightMotion>(&motion)) {
    EXACTVO_REQUIRE(is_finite(straight->from.at) && is_finite(straight->to.at),
                    excerpt({straight->from.at, straight->to.at}));
    return;
  }
  const std::vector<Vec2>& points = std::get<CurvedMotion>(motion).points;
  EXACTVO_REQUIRE(!points.empty() && points.size() <= kMostDegree + 1, std::to_string(points.size()) + " points");
  EXACTVO_REQUIRE(std::all_of(points.begin(), points.end(), is_finite), excerpt(points));
}

std::vector<Corner> hull_of_differences(const std::vector<Vec2>& plus, const std::vector<Vec2>& minus) {
  std::vector<Corner> all;
  for (const Vec2 p : plus)
    for (const Vec2 m : minus) all.push_back({p, m});
  if (all.size() == 1) return all;
  std::sort(all.begin(), all.end(), [](const Corner& a, const Corner& b) {
    const Sum d = sum_of(a) - sum_of(b);
    const Known x = sign_of(d.x);
    return x == Known::negative || (x == Known::zero && sign_of(d.y) == Known::negative);
  });
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  if (all.size() <= 2) return all;
  std::vector<Corner> hull = chain(all);
  std::reverse(all.begin(), all.end());
  const std::vector<Corner> upper = chain(all);
  hull.insert(hull.end(), upper.begin() + 1, upper.end() - 1);
  return hull;
}

Question::Question(const Motion& a, const RigidBody& body_a, const Motion& b, const RigidBody& body_b)
    : a_(&a), b_(&b) {
  require_motion(a);
  require_motion(b);
  require_body(body_a);
  require_body(body_b);
  window_ = common_window(a, &b);
  for (const RoundedPolygon& part : body_a) {
    for (const RoundedPolygon& other : body_b) {
      targets_.push_back(target_of(other.corners, other.radius, part));
      Target& target = targets_.back();
      target.thin = target.reach == 0.0 && target.other_reach == 0.0 && target.corners.size() <= 2;
    }
  }
}

Question::Question(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle) : a_(&a) {
  require_motion(a);
  require_body(body_a);
  window_ = common_window(a, nullptr);
  const std::vector<Segment> edges = geometry::edges_of(obstacle);
  for (const Segment& edge : edges) EXACTVO_REQUIRE(is_finite(edge.a) && is_finite(edge.b), excerpt({edge.a, edge.b}));
  const bool solid = has_interior(obstacle);
  if (solid) edges_ = edges;
  for (const RoundedPolygon& part : body_a) {
    for (const Segment& edge : edges) {
      targets_.push_back(target_of({edge.a, edge.b}, 0.0, part));
      targets_.back().thin = !solid && part.radius == 0.0 && targets_.back().corners.size() <= 2;
    }
    if (!solid) continue;
    const std::vector<Vec2> corners = hull_corners(part.corners);
    if (part.radius > 0.0 || corners.size() < 3)
      anchors_.push_back({{corners.front()}, part.radius});
    else
      anchors_.push_back({{corners[0], corners[1], corners[2]}, part.radius});
  }
}

std::optional<Encounter> Question::by_filter(Window w, double more, Thin thin) const {
  Path<RunningError> path = path_from<RunningError>(*this, w);
  Known gap = Known::positive;
  const bool thin_overlaps = thin == Thin::overlaps;
  if (path.c.size() == 2) {
    gap = straight_question(*this, path, more, thin_overlaps);
  } else {
    const Path<RunningError> in_powers = path;
    to_control_points(path);
    for (const Target& target : targets_) {
      const auto hull = hull_over<RunningError>(target, origin_of(*a_), other_origin(), path.scale, more);
      const std::optional<Encounter> here = curved_by_filter(path.c, hull);
      if (here == Encounter::overlap) return here;
      if (!here) gap = Known::unknown;
    }
    path = in_powers;
  }
  if (gap == Known::negative) return Encounter::overlap;
  // A point that touches an edge may enter: for the exact stage to see.
  if (gap == Known::unknown || (gap == Known::zero && !anchors_.empty())) return std::nullopt;
  gap = least(gap, anchor_question(*this, path, more));
  if (gap == Known::unknown) return std::nullopt;
  return encounter_of(gap);
}

Encounter Question::exactly(Window w, double more, Thin thin) const {
  const bool thin_overlaps = thin == Thin::overlaps;
  const Path<Exact> path = path_from<Exact>(*this, w);
  Known gap = Known::positive;
  if (path.c.size() == 2) {
    gap = straight_question(*this, path, more, thin_overlaps);
  } else {
    const Path<Rational> rational = path_from<Rational>(*this, w);
    for (const Target& target : targets_) {
      const auto hull = hull_over<Rational>(target, origin_of(*a_), other_origin(), rational.scale, more);
      const Encounter here = curved_exactly(rational.c, hull);
      const Known known = here == Encounter::overlap   ? Known::negative
                          : here == Encounter::contact ? Known::zero
                                                       : Known::positive;
      gap = least(gap, with_thin(known, thin_overlaps && target.thin));
      if (gap == Known::negative) break;
    }
  }
  if (gap == Known::negative) return Encounter::overlap;
  // No edge is nearer than the reach, so only an anchor without reach can be on one: a point.
  if (gap == Known::zero && more == 0.0 && point_enters(w)) return Encounter::overlap;
  return encounter_of(least(gap, anchor_question(*this, path, more, gap == Known::zero)));
}

bool Question::point_enters(Window w) const {
  const Path<Rational> path = path_from<Rational>(*this, w);
  const Vec2 origin = origin_of(*a_);
  for (const Anchor& anchor : anchors_) {
    if (anchor.reach > 0.0 || anchor.corners.size() > 1) continue;
    // Between two times at which the point is on the line of an edge it is inside all the time, or never.
    std::vector<Rational> samples{Rational(0), Rational(1)};
    std::vector<RealNumber> events;
    for (const Segment& edge : edges_) {
      const Vector<Rational> e = detail::difference<Rational>(edge.b, edge.a);
      const Vector<Rational> from =
          path.scale * (detail::difference<Rational>(edge.a, origin) - detail::make<Rational>(anchor.corners[0]));
      std::vector<Rational> across;
      for (const Vector<Rational>& c : path.c) across.push_back(cross(e, c));
      across[0] -= cross(e, from);
      for (RealNumber& root : roots_in_unit(primitive(across))) events.push_back(std::move(root));
    }
    std::sort(events.begin(), events.end(), [](RealNumber a, RealNumber b) { return compare(a, b) < 0; });
    for (std::size_t i = 0; i <= events.size(); ++i) {
      RealNumber before = i == 0 ? RealNumber(Rational(0)) : events[i - 1];
      RealNumber after = i == events.size() ? RealNumber(Rational(1)) : events[i];
      if (compare(before, after) >= 0) continue;
      samples.emplace_back((before.high() + after.low()) / 2);
    }
    for (const Rational& s : samples) {
      RationalPoint at{Rational(0), Rational(0)};
      for (std::size_t k = path.c.size(); k-- > 0;) at = s * at + path.c[k];
      const bool on_edge = std::any_of(edges_.begin(), edges_.end(),
                                       [&](const Segment& e) { return is_on(e, anchor, at, path.scale, origin); });
      if (!on_edge && inside<Rational>(edges_, anchor, at, path.scale, origin) == Known::negative) return true;
    }
  }
  return false;
}

Encounter Question::decide(Window w, double more, Thin thin) const {
  if (const std::optional<Encounter> found = by_filter(w, more, thin)) return *found;
  return exactly(w, more, thin);
}

Encounter Question::verdict() const {
  if (const std::optional<Encounter> found = by_filter(window_, 0.0, Thin::overlaps)) {
    detail::count_filter();
    return *found;
  }
  detail::count_exact();
  return exactly(window_, 0.0, Thin::overlaps);
}

}  // namespace exactvo::geometry::motions
