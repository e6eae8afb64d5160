// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions/question.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exact/stages.h"
#include "exactvo/geometry/require.h"
#include "motions/real_roots.h"

namespace exactvo::geometry::motions {
namespace {

using Sum = Vector<Exact>;

// A polynomial way against grown hulls: the filter (Bernstein control points with halving, in doubles with a running
// error) and the exact stage (signs of polynomials, roots isolated).

using Filtered = Vector<RunningError>;
using Rational = mpq_class;
using RationalPoint = Vector<Rational>;

/// How often a piece is halved, and how many pieces are looked at, before the exact stage is asked. A running error
/// chains d additions a halving: 10 * 24 are far from its 2^10.
constexpr int kMostHalvings = 24;
constexpr int kMostPieces = 160;

/// De Casteljau at 1/2: the halves' control points.
void halve(const std::vector<Filtered>& whole, std::vector<Filtered>& first, std::vector<Filtered>& second) {
  const std::size_t n = whole.size();
  second = whole;
  first.resize(n);
  const RunningError half(0.5);
  for (std::size_t k = 0; k < n; ++k) {
    first[k] = second[0];
    for (std::size_t i = 0; i + 1 < n - k; ++i) second[i] = half * (second[i] + second[i + 1]);
  }
  // What is left runs from the curve's middle on: second[i] is the last of row n - 1 - i.
}

/// At least the number that is meant.
double upper(const RunningError& x) {
  constexpr double kSlack = 1.0 + 0x1p-40;
  return (std::fabs(x.value) + x.error * kSlack) * (1.0 + 0x1p-50);
}

/// At least how far the curve strays from its chord.
double stray_of(const std::vector<Filtered>& b) {
  const std::size_t d = b.size() - 1;
  if (d < 2) return 0.0;
  double most = 0.0;
  const RunningError degree(static_cast<double>(d));
  for (std::size_t i = 1; i < d; ++i) {
    const RunningError to(static_cast<double>(i)), from(static_cast<double>(d - i));
    const Filtered off = degree * b[i] - (from * b.front() + to * b.back());
    most = std::max(most, std::hypot(upper(off.x), upper(off.y)));
  }
  return most / static_cast<double>(d) * (1.0 + 0x1p-40);
}

struct CurvePiece {
  std::vector<Filtered> points;
  int halvings;
};

std::optional<Encounter> verdict_of(const std::vector<Filtered>& b, const GrownHull<RunningError>& hull) {
  GrownHull<RunningError> other = hull;
  const double stray = stray_of(b);
  if (!std::isfinite(stray)) return std::nullopt;
  other.reach = hull.reach + RunningError(stray);
  if (straight_gap(b.front(), b.back(), other) == Known::positive) return Encounter::clear;
  if (point_gap(b.front(), hull) == Known::negative || point_gap(b.back(), hull) == Known::negative)
    return Encounter::overlap;
  other.reach = hull.reach - RunningError(stray);
  if (sign_of(other.reach) == Known::positive && straight_gap(b.front(), b.back(), other) == Known::negative)
    return Encounter::overlap;
  return std::nullopt;
}

/// A union of conditions: all polynomials of one are below zero.
using Condition = std::vector<std::vector<Rational>>;

std::vector<Rational> sum(const std::vector<Rational>& a, const std::vector<Rational>& b, int sign = 1) {
  std::vector<Rational> c(std::max(a.size(), b.size()));
  for (std::size_t k = 0; k < a.size(); ++k) c[k] += a[k];
  for (std::size_t k = 0; k < b.size(); ++k) c[k] += sign * b[k];
  return c;
}
std::vector<Rational> product(const std::vector<Rational>& a, const std::vector<Rational>& b) {
  std::vector<Rational> c(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) c[i + k] += a[i] * b[k];
  return c;
}

/// The way's coordinates as polynomials, as seen from a point.
struct SeenWay {
  std::vector<Rational> x, y;
  SeenWay(const std::vector<RationalPoint>& path, const RationalPoint& from) {
    for (const RationalPoint& c : path) {
      x.push_back(c.x);
      y.push_back(c.y);
    }
    x[0] -= from.x;
    y[0] -= from.y;
  }
  /// n.p
  std::vector<Rational> along(const RationalPoint& n) const {
    std::vector<Rational> c;
    for (std::size_t k = 0; k < x.size(); ++k) c.emplace_back(n.x * x[k] + n.y * y[k]);
    return c;
  }
};

/// Beside the edge, not beyond its ends: cross^2 < reach^2 L, 0 < along < L.
Condition near_edge(const SeenWay& seen, const RationalPoint& e, const Rational& reach2) {
  const Rational length2 = dot(e, e);
  const std::vector<Rational> across = seen.along({Rational(-e.y), e.x}), along = seen.along(e);
  return {sum(product(across, across), {Rational(reach2 * length2)}, -1), sum({Rational(0)}, along, -1),
          sum(along, {length2}, -1)};
}

std::vector<Condition> conditions_of(const std::vector<RationalPoint>& path, const GrownHull<Rational>& hull) {
  const std::vector<RationalPoint>& v = hull.vertices;
  const Rational reach2 = hull.reach * hull.reach;
  const bool only_inside = v.size() > 2 && sgn(reach2) == 0;
  std::vector<Condition> conditions;
  Condition inside;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const SeenWay seen(path, v[i]);
    if (!only_inside) conditions.push_back({sum(sum(product(seen.x, seen.x), product(seen.y, seen.y)), {reach2}, -1)});
    if (v.size() == 1 || (v.size() == 2 && i == 1)) continue;
    const RationalPoint e = v[(i + 1) % v.size()] - v[i];
    if (!only_inside) conditions.push_back(near_edge(seen, e, reach2));
    inside.push_back(seen.along({e.y, Rational(-e.x)}));
  }
  if (v.size() > 2) conditions.push_back(inside);
  return conditions;
}

bool holds_at_some_time(const Condition& condition, Ends ends) {
  TimeSet times = {{Rational(0), Rational(1)}};
  for (const std::vector<Rational>& polynomial : condition) {
    times = common_times(std::move(times), times_below_zero(primitive(polynomial), ends), ends);
    if (times.empty()) return false;
  }
  return true;
}

/// Whether the way, given by control points, is clear of the hull or overlaps it; none where that is not certain.
///
/// A Bezier curve of degree d is within the largest |b_i - (b_0 + i/d (b_d - b_0))| of the uniform motion along its
/// chord. So it is clear where the chord is clear of the hull grown by as much, and overlaps where an end does or the
/// chord overlaps the hull shrunk by as much. Halving makes the deviation four times smaller.
std::optional<Encounter> curved_by_filter(const std::vector<Filtered>& control_points,
                                          const GrownHull<RunningError>& hull) {
  const Known reach = sign_of(hull.reach);
  if (reach == Known::negative) return Encounter::clear;
  if (reach == Known::unknown) return std::nullopt;
  std::vector<CurvePiece> open{{control_points, 0}};
  for (int looked_at = 0; !open.empty(); ++looked_at) {
    const CurvePiece piece = std::move(open.back());
    open.pop_back();
    const std::optional<Encounter> verdict = verdict_of(piece.points, hull);
    if (verdict == Encounter::overlap) return verdict;
    if (verdict == Encounter::clear) continue;
    if (looked_at >= kMostPieces || piece.halvings >= kMostHalvings || piece.points.size() <= 2) return std::nullopt;
    CurvePiece first{{}, piece.halvings + 1}, second{{}, piece.halvings + 1};
    halve(piece.points, first.points, second.points);
    open.push_back(std::move(second));
    open.push_back(std::move(first));
  }
  return Encounter::clear;
}

/// The same question decided exactly; `path` in powers of s. `contact` where the closed sets meet and no more.
Encounter curved_exactly(const std::vector<RationalPoint>& path, const GrownHull<Rational>& hull) {
  if (sgn(hull.reach) < 0) return Encounter::clear;
  const std::vector<Condition> conditions = conditions_of(path, hull);
  const auto some = [&](Ends ends) {
    return std::any_of(conditions.begin(), conditions.end(),
                       [&](const Condition& c) { return holds_at_some_time(c, ends); });
  };
  if (some(Ends::open)) return Encounter::overlap;
  return some(Ends::closed) ? Encounter::contact : Encounter::clear;
}

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
    const Known reach = sign_of(T(T(anchor.reach) + T(more)));
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
