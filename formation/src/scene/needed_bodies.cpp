// SPDX-License-Identifier: GPL-3.0-or-later
// Which bodies of a field a decision needs, by lower bounds of the room that their half-planes leave.
//
// With S the body grown by the robot and its room, seen from the robot, VO = { s / t : s in S, 0 < t <= tau }, and the
// half-plane of a v outside VO is that of VO's point nearest to v: n.v - c = |v - VO| for the unit n. Two lower bounds
// of that distance, from a box round the body alone:
//
//     |v - s/t| >= |s|/t - |v| >= |S| / tau - |v|              for a slow robot
//     |v - s/t| = |t v - s| / t >= |path - S| / tau            path = { t v : 0 <= t <= tau }, for a fast one
//
// tau grows with the distance of the body, and so does |S| / tau.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exactvo/geometry/require.h"
#include "scene/static_field.h"

namespace exactvo::formation::detail {

using geometry::EnclosureGrade;

namespace {

/// The largest distance along a few axes by which the path from x to x + u and the box are separated: never more than
/// their distance.
double distance_below(const geometry::Box& box, Vec2 x, Vec2 u) {
  const Vec2 end = x + u;
  const double across_x = std::max(box.low.x - std::max(x.x, end.x), std::min(x.x, end.x) - box.high.x);
  const double across_y = std::max(box.low.y - std::max(x.y, end.y), std::min(x.y, end.y) - box.high.y);
  const double beside = std::max({across_x, across_y, 0.0});
  const double length = std::fabs(u.x) + std::fabs(u.y);  // at least |u|
  if (!(length > 0.0)) return beside;
  const Vec2 half = 0.5 * (box.high - box.low);
  const double off = std::fabs(cross(u, 0.5 * (box.low + box.high) - x));
  return std::max(beside, (off - half.x * std::fabs(u.y) - half.y * std::fabs(u.x)) / length);
}

}  // namespace

template <class Visit>
void StaticField::for_each_shape_meeting(const geometry::Box& window, const Visit& visit) const {
  if (rules_->method == Method::ivo_edge) {
    scene_->facade_ellipses_by_place().for_each_meeting(window, [&](std::size_t k) {
      visit(Shape{scene_->facade_ellipse(k), k, EnclosureGrade::containing});
    });
    return;
  }
  for (const Shape& e : enclosures_)
    if (meet(scene_->bodies().box(e.body), window)) visit(e);
  scene_->pieces_by_place().for_each_meeting(window, [&](std::size_t k) {
    if (tight_index_[k] != kEnclosed) visit(Shape{scene_->piece(k), tight_index_[k], EnclosureGrade::tight});
  });
}

/// m/s: less than n.v - c of the half-plane against whatever the box holds.
double StaticField::room_below(const geometry::Box& box, const Viewpoint& from) const {
  constexpr double kRounding = 1e-12;  // of the coordinates
  const double kept = margin_ + kContactSkin + kRounding * (box.largest_coordinate() + norm(from.position));
  const double nearest = geometry::distance_below(box, from.position) - from.radius;
  const double speed = norm(from.velocity);
  const double slow = (nearest - kept) / horizon(nearest, from) - speed;
  const Vec2 corner = {std::max(box.high.x - from.position.x, from.position.x - box.low.x),
                       std::max(box.high.y - from.position.y, from.position.y - box.low.y)};
  const double tau = horizon(norm(corner), from);
  const double path = distance_below(box, from.position, tau * from.velocity);
  return std::max(slow, (path - from.radius - kept) / tau);
}

// More is known of a segment or an ellipse than of its box. For a unit n, let every point x of the body have
// n.x <= -(kept + g), seen from the robot, where `kept` is its radius and what it keeps away. With g > 0 the velocity
// obstacle lies in { w : n.w <= -g / tau }, from which v has n.v + g / tau. `tau` may be too long, never too short.

namespace {

/// m/s: the room that such a line leaves, or nothing that counts.
double room_beside(double gap, double along_normal, double tau) {
  return gap > 0.0 ? along_normal + gap / tau : -std::numeric_limits<double>::infinity();
}

/// The half-plane against a segment seen from the robot, but for rounding: that of the cut-off's point nearest to u.
/// With q the point of the segment nearest to y = tau u, where y is outside the grown segment and n = (y - q) / |y - q|
/// separates it from the robot, the velocity obstacle, convex, has no nearer one. Nothing where that is in doubt.
/// `kept` is the radius with what is kept away, rounded up by more than all rounding here.
std::optional<geometry::HalfPlane> line_on_cut_off(Vec2 start, Vec2 along, double per_length2, double kept, double tau,
                                                   Vec2 u) {
  const Vec2 w = tau * u - start;
  const Vec2 off = w - std::clamp(dot(w, along) * per_length2, 0.0, 1.0) * along;
  const double length2 = squared_norm(off);
  if (!(length2 > kept * kept)) return std::nullopt;
  const Vec2 n = off / std::sqrt(length2);
  const double at_start = dot(n, start);
  const double h = std::max(at_start, at_start + dot(n, along)) + kept;
  if (!(h < 0.0)) return std::nullopt;
  return geometry::HalfPlane{n, h / tau};
}

double inverse_of_square(Vec2 along) {
  const double length2 = squared_norm(along);
  return length2 > 0.0 && std::isfinite(1.0 / length2) ? 1.0 / length2 : 0.0;
}

/// The room of the cut-off where u is nearest to it, else of the line across the way to the nearest point.
template <class Tau>
double room_of_segment(const geometry::Segment& s, Vec2 x, Vec2 u, double kept, const Tau& tau_of) {
  const Vec2 along = s.b - s.a, start = s.a - x;
  const double per_length2 = inverse_of_square(along);
  const Vec2 away = -(start + std::clamp(-dot(start, along) * per_length2, 0.0, 1.0) * along);
  const double distance = norm(away);
  if (!(distance > kept)) return -std::numeric_limits<double>::infinity();
  const double tau = tau_of(distance);
  if (const std::optional<geometry::HalfPlane> h = line_on_cut_off(start, along, per_length2, kept, tau, u))
    return -violation(*h, u);
  return room_beside(distance - kept, dot(away, u) / distance, tau);
}

/// The largest n.(x - centre) of an ellipse.
double half_width(const geometry::Ellipse& e, Vec2 n) {
  return norm(Vec2{e.l11 * n.x + e.l21 * n.y, e.l22 * n.y});
}

/// n: away from the centre, across the velocity. The ellipse begins no farther than on the way to its centre.
template <class Tau>
double room_of_ellipse(const geometry::Ellipse& e, Vec2 x, Vec2 u, double kept, const Tau& tau_of) {
  const Vec2 to = e.center - x;
  const double distance = norm(to);
  if (!(distance > 0.0)) return -std::numeric_limits<double>::infinity();
  const double tau = tau_of(distance);
  const Vec2 n = to / distance;
  double room = room_beside(distance - half_width(e, n) - kept, -dot(n, u), tau);
  if (const double speed = norm(u); speed > 0.0) {
    const Vec2 across = perp(u) / speed;
    room = std::max(room, room_beside(std::fabs(dot(across, to)) - half_width(e, across) - kept, 0.0, tau));
  }
  return room;
}

}  // namespace

/// m/s: less than n.v - c of the body's half-plane at v = from.velocity. Not looked for any more where it is `enough`.
double StaticField::room_of(vo::BodyTable::Number body, const Viewpoint& from, double enough) const {
  constexpr double kRounding = 1e-12;  // of the coordinates
  const geometry::Box& box = scene_->bodies().box(body);
  const double room = room_below(box, from);
  if (room >= enough) return room;
  const double kept =
      from.radius + margin_ + kContactSkin + kRounding * (box.largest_coordinate() + norm(from.position) + from.radius);
  const auto tau_of = [&](double distance) { return (1.0 + kRounding) * horizon(distance - from.radius, from); };
  const geometry::ConvexShape& shape = scene_->bodies()[body].shape;
  if (const auto* s = std::get_if<geometry::Segment>(&shape))
    return std::max(room, room_of_segment(*s, from.position, from.velocity, kept, tau_of));
  if (const auto* e = std::get_if<geometry::Ellipse>(&shape))
    return std::max(room, room_of_ellipse(*e, from.position, from.velocity, kept, tau_of));
  return room;
}

/// m, from the rim: whatever is farther leaves a robot at rest at least that room.
double StaticField::distance_of_room(const Viewpoint& from, double room) const {
  const Horizons& h = rules_->horizons;
  const double kept = margin_ + kContactSkin;
  const double least = rules_->least_horizon();
  const double pace = std::max(norm(from.velocity), h.speed_floor * from.max_speed);  // tau = distance / pace between
  if (const double d = kept + least * room; d <= pace * least) return d;
  if (const double d = kept * pace / (pace - room); room < pace && d <= pace * h.most) return std::max(d, pace * least);
  return std::max(kept + h.most * room, pace * h.most);
}

/// Meets every box that is needed: boxes that meet each other in pairs have a place in common.
geometry::Box StaticField::window_of(const Viewpoint& from, const Need& need) const {
  constexpr double kRounding = 1.0 + 1e-6;
  const auto grown = [&](Vec2 x, double by) {
    const Vec2 half{kRounding * by, kRounding * by};
    return geometry::Box{x - half, x + half};
  };
  const double kept = from.radius + margin_ + 2.0 * kContactSkin;
  geometry::Box window = grown(from.position, kept + std::max(need.within, 0.0));
  if (!(need.room > 0.0)) return window;
  const double most = rules_->horizons.most;
  const geometry::Box slow = grown(from.position, kept + distance_of_room(from, need.room + norm(from.velocity)));
  geometry::Box fast = grown(from.position, kept + most * need.room);
  fast.add(grown(from.position + most * from.velocity, kept + most * need.room));
  window.add(geometry::Box{{std::max(slow.low.x, fast.low.x), std::max(slow.low.y, fast.low.y)},
                           {std::min(slow.high.x, fast.high.x), std::min(slow.high.y, fast.high.y)}});
  return window;
}

/// `built` says which of those that are met again have their half-plane.
void StaticField::meet_shapes(const Viewpoint& from, const Need& need, const std::vector<Constraint>& built,
                              Meetings& meetings) const {
  std::vector<Met>& met = meetings.met;
  const auto meet_one = [&](const Shape& s, double distance) {
    const bool is_built = std::any_of(built.begin(), built.end(), [&](const Constraint& c) {
      return c.body == s.body && c.index == s.index && c.piece == s.piece;
    });
    met.push_back({s, distance, -kEverywhere, is_built});
  };
  const auto meet_it = [&](const Shape& s) {
    const double distance = distance_to_box(s, from);
    if (!gives_way(s, from, distance)) return meet_one(s, distance);
    for_each_piece_of(s, [&](const Shape& piece) { meet_one(piece, distance_to_box(piece, from)); });
  };
  if (is_small_) {
    if (met.empty()) std::for_each(all_.begin(), all_.end(), meet_it);
    return;
  }
  const geometry::Box window = window_of(from, need);
  if (meetings.window.contains(window.low) && meetings.window.contains(window.high)) return;
  meetings.window = window;
  met.clear();
  for_each_shape_meeting(window, meet_it);
}

void StaticField::add_needed(const Viewpoint& from, const Need& need, Meetings& meetings,
                             std::vector<Constraint>& out) const {
  EXACTVO_REQUIRE(bounds_room(), "bounds of other horizons");
  constexpr double kRounding = 1.0 + 1e-9;
  meet_shapes(from, need, out, meetings);
  const double within = need.within < 0.0 ? -kEverywhere : kRounding * (need.within + from.radius + kContactSkin);
  for (Met& m : meetings.met) {
    if (m.is_built) continue;
    if (!(m.distance <= within)) {
      if (!(need.room > 0.0)) continue;
      if (m.room < need.room) m.room = room_of(m.body, from, need.room);
      if (!(m.room < need.room)) continue;
    }
    m.is_built = true;
    build(m, from, out);
  }
}

StaticField::NearBody StaticField::near_body(const Shape& shape) const {
  NearBody b;
  static_cast<Shape&>(b) = shape;
  b.box = scene_->bodies().box(shape.body);
  b.largest_coordinate = b.box.largest_coordinate();
  if (const auto* s = std::get_if<geometry::Segment>(&scene_->bodies()[shape.body].shape)) {
    b.is_segment = true;
    b.a = s->a;
    b.along = s->b - s->a;
    b.per_length2 = inverse_of_square(b.along);
  }
  return b;
}

void StaticField::bodies_near(const Viewpoint& from, double reach, double room_to_move,
                              std::vector<NearBody>& out) const {
  out.clear();
  for_each_shape_within(from.position, distance_within(from, reach) + room_to_move, [&](const Shape& s) {
    out.push_back(near_body(s));
    out.back().gathered = geometry::distance_below(out.back().box, from.position);
  });
  std::sort(out.begin(), out.end(), [](const NearBody& a, const NearBody& b) { return a.gathered < b.gathered; });
}

/// What all candidates of a look have in common.
struct StaticField::Sight {
  const Viewpoint& from;
  double within;       ///< m, from the centre
  double size;         ///< m, of the coordinates
  double per_pace;     ///< s/m: tau = distance * per_pace between the least and the most
  double least, most;  ///< s
};

/// False where the body is too far; `out` is filled otherwise.
bool StaticField::see(const NearBody& b, const Sight& sight, Candidate& out) const {
  constexpr double kRounding = 1e-12;  // of the coordinates
  const Viewpoint& from = sight.from;
  const Vec2 x = from.position - b.a;
  const Vec2 away = b.is_segment ? x - std::clamp(dot(x, b.along) * b.per_length2, 0.0, 1.0) * b.along
                                 : from.position - Vec2{std::clamp(from.position.x, b.box.low.x, b.box.high.x),
                                                        std::clamp(from.position.y, b.box.low.y, b.box.high.y)};
  const double distance2 = squared_norm(away);
  if (!(distance2 <= sight.within * sight.within)) return false;
  out.distance = std::sqrt(distance2);
  const double rounding = kRounding * (b.largest_coordinate + sight.size + out.distance);
  // In the box nothing is known of the depth; outside, clearances are rounded.
  out.nearest = out.distance > 0.0 ? out.distance - from.radius - rounding : -std::numeric_limits<double>::infinity();
  static_cast<Shape&>(out) = b;
  if (!b.is_segment) {
    out.room = room_of(b.body, from, std::numeric_limits<double>::infinity());
    return true;
  }
  out.is_segment = true;
  out.away = away;
  out.kept = from.radius + margin_ + kContactSkin + rounding;
  out.tau = std::clamp((out.distance - from.radius) * sight.per_pace, sight.least, sight.most);
  if (!(out.distance > out.kept)) return true;
  if (const auto line = line_on_cut_off(-x, b.along, b.per_length2, out.kept, out.tau, from.velocity)) {
    out.has_line = true;
    out.line = *line;
  }
  return true;
}

void StaticField::candidates(const std::vector<NearBody>& near, double moved, const Viewpoint& from, double reach,
                             std::vector<Candidate>& out) const {
  EXACTVO_REQUIRE(bounds_room(), "bounds of other horizons");
  constexpr double kRounding = 1.0 + 1e-9;
  out.clear();
  const Horizons& h = rules_->horizons;
  const Sight sight{from,
                    kRounding * distance_within(from, reach),
                    norm(from.position) + from.radius,
                    1.0 / std::max(norm(from.velocity), h.speed_floor * from.max_speed),
                    rules_->least_horizon(),
                    h.most};
  const auto see_if_near = [&](const NearBody& b) {
    if (!see(b, sight, out.emplace_back())) out.pop_back();
  };
  for (const NearBody& b : near) {
    if (b.gathered > sight.within + kRounding * moved) break;
    if (b.grade == EnclosureGrade::tight || !gives_way(b, from, distance_to_box(b, from))) {
      see_if_near(b);
      continue;
    }
    for_each_piece_of(b, [&](const Shape& piece) { see_if_near(near_body(piece)); });
  }
}

}  // namespace exactvo::formation::detail
