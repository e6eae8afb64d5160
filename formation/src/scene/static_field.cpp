// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/static_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "scene/moving.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Enclosure;
using geometry::EnclosureGrade;
using vo::BodyKind;
using vo::BodyTable;

/// In real overlap nothing can be certified; the robot is asked to leave within this time, at a share of its speed.
constexpr double kPushOutTime = 0.2;   // s
constexpr double kPushOutShare = 0.3;  // of max_speed

constexpr double kLiteralHorizonAtRest = 1e6;  // s: the printed tau divides by |v| = 0

geometry::EnclosureOptions enclosure_options(const Scenario& scenario) {
  geometry::EnclosureOptions options;
  options.margin = scenario.margins.obstacle;
  options.least_margin = std::min(options.least_margin, options.margin);
  return options;
}

bool meet(const geometry::Box& a, const geometry::Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

/// The farthest velocity of a box bound is sqrt 2 times its side.
bool is_beyond_reach(double clearance, const Viewpoint& from, double tau) {
  return clearance > std::sqrt(2.0) * from.max_speed * tau;
}

}  // namespace

void sort_by_clearance(std::vector<Constraint>& lines) {
  std::sort(lines.begin(), lines.end(), [](const Constraint& a, const Constraint& b) {
    return std::tie(a.clearance, a.index, a.piece) < std::tie(b.clearance, b.index, b.piece);
  });
}

// --- The scene ---

Scene::Scene(const Scenario& scenario, const SimulationOptions& options) {
  if (options.method == Method::orca)
    add_chains(scenario);
  else
    add_pieces(scenario);
  if (options.method == Method::ivo_edge) add_facade_ellipses(scenario, options);
  first_robot_ = bodies_.size();
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const Robot& r = scenario.robots[i];
    bodies_.add({BodyKind::robot, geometry::Disc{r.position, r.radius}, r.velocity, {i}});
  }
  first_moving_ = bodies_.size();
  for (std::size_t k = 0; k < scenario.moving_obstacles.size(); ++k)
    bodies_.add({BodyKind::moving_obstacle, shape_at(scenario.moving_obstacles[k], 0.0), {}, {k}});
}

std::vector<vo::Body> Scene::copied_bodies() const {
  std::vector<vo::Body> all;
  all.reserve(bodies_.size());
  for (BodyTable::Number k = 0; k < bodies_.size(); ++k) all.push_back(bodies_[k]);
  return all;
}

geometry::BoxGrid Scene::by_place(const std::vector<BodyTable::Number>& some) const {
  std::vector<geometry::Box> boxes;
  boxes.reserve(some.size());
  for (const BodyTable::Number body : some) boxes.push_back(bodies_.box(body));
  return geometry::BoxGrid(std::move(boxes));
}

void Scene::add_pieces(const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) {
    first_piece_.push_back(pieces_.size());
    parts_.push_back(geometry::parts_of(scenario.obstacles[i].shape));
    for (const geometry::ConvexShape& piece : parts_.back().pieces)
      pieces_.push_back(bodies_.add({BodyKind::enclosure, piece, {}, {i}}));
  }
  first_piece_.push_back(pieces_.size());
  pieces_by_place_ = by_place(pieces_);
}

void Scene::add_facade_ellipses(const Scenario& scenario, const SimulationOptions& options) {
  const geometry::FacadeEllipseOptions ellipse{options.facade_minor_to_major, options.facade_fixed_minor,
                                               scenario.margins.obstacle};
  for (std::size_t i = 0; i < parts_.size(); ++i)
    for (const geometry::Segment& facade : parts_[i].facades)
      facade_ellipses_.push_back(
          bodies_.add({BodyKind::enclosure, geometry::facade_ellipse(facade, ellipse), {}, {i}}));
  facade_ellipses_by_place_ = by_place(facade_ellipses_);
}

void Scene::add_chains(const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) {
    for (vo::OrcaChain& chain : vo::orca_chains(scenario.obstacles[i].shape)) {
      // A closed chain has an edge a vertex, an open one is walked there and back: an edge begins at every vertex.
      first_edge_.push_back(edges_.size());
      const std::size_t n = chain.vertices.size();
      for (std::size_t k = 0; k < n; ++k) {
        const geometry::Segment edge{chain.vertices[k], chain.vertices[(k + 1) % n]};
        edges_.push_back(bodies_.add({BodyKind::obstacle_edge, edge, {}, {i}}));
        chain_of_.push_back(chains_.size());
      }
      chains_.push_back(std::move(chain));
    }
  }
  edges_by_place_ = by_place(edges_);
}

// --- What one robot sees of it ---

StaticField::StaticField(Scene& scene, const Scenario& scenario, const SimulationOptions& options, double radius,
                         Vec2 start, Vec2 goal, HorizonRule rule)
    : scene_(&scene), scenario_(&scenario), method_(options.method), rule_(rule), margin_(scenario.margins.obstacle) {
  if (method_ != Method::ivo_cluster && method_ != Method::ivo) return;
  if (guidance_of(scenario, options) == Guidance::route) {
    tight_index_.resize(scene.pieces_by_place().size());
    std::iota(tight_index_.begin(), tight_index_.end(), 0u);
    return;
  }
  take_enclosures(geometry::enclose(scene.parts(), radius, start, goal, enclosure_options(scenario)));
}

/// Ellipses become bodies; what stands as its pieces is the scene's already. Of an obstacle either all pieces come, one
/// after the other, or none.
void StaticField::take_enclosures(const std::vector<Enclosure>& enclosures) {
  tight_index_.assign(scene_->pieces_by_place().size(), kEnclosed);
  std::optional<std::size_t> last;  // the obstacle whose pieces are being taken, and its next piece
  std::size_t piece = 0;
  for (std::size_t i = 0; i < enclosures.size(); ++i) {
    const Enclosure& e = enclosures[i];
    if (e.grade != EnclosureGrade::tight) {
      enclosures_.push_back({scene_->bodies().add({BodyKind::enclosure, e.shape, {}, e.obstacles}), i, e.grade});
      continue;
    }
    const std::size_t obstacle = e.obstacles.front();
    if (obstacle != last) piece = scene_->first_piece(obstacle);
    last = obstacle;
    EXACTVO_REQUIRE(piece < scene_->first_piece(obstacle + 1),
                    "more pieces than obstacle " + std::to_string(obstacle) + " has");
    EXACTVO_REQUIRE(tight_index_[piece] == kEnclosed,
                    "pieces of obstacle " + std::to_string(obstacle) + " come in two runs");
    tight_index_[piece++] = static_cast<std::uint32_t>(i);
  }
}

std::vector<BodyTable::Number> StaticField::shapes() const {
  std::vector<BodyTable::Number> all;
  for (std::size_t k = 0; method_ == Method::ivo_edge && k < scene_->facade_ellipses_by_place().size(); ++k)
    all.push_back(scene_->facade_ellipse(k));
  const auto put = [&](std::size_t index, BodyTable::Number body) {
    if (all.size() <= index) all.resize(index + 1);
    all[index] = body;
  };
  for (const Shape& e : enclosures_) put(e.index, e.body);
  for (std::size_t piece = 0; piece < tight_index_.size(); ++piece)
    if (tight_index_[piece] != kEnclosed) put(tight_index_[piece], scene_->piece(piece));
  return all;
}

std::vector<Enclosure> StaticField::enclosures() const {
  const EnclosureGrade usual = method_ == Method::ivo_edge ? EnclosureGrade::containing : EnclosureGrade::tight;
  std::vector<Enclosure> all;
  for (const BodyTable::Number body : shapes())
    all.push_back({scene_->bodies()[body].shape, scene_->bodies()[body].owners, usual});
  for (const Shape& e : enclosures_) all[e.index].grade = e.grade;
  return all;
}

double StaticField::horizon(double distance, const Viewpoint& from) const {
  if (from.horizon > 0.0) return from.horizon;
  const Horizons& h = scenario_->horizons;
  const double speed = norm(from.velocity);
  if (rule_ == HorizonRule::literal)
    return speed > 0.0 && distance > 0.0 ? std::min(distance / speed, kLiteralHorizonAtRest) : kLiteralHorizonAtRest;
  const double tau = distance / std::max(speed, h.speed_floor * from.max_speed);
  return std::clamp(tau, std::max(h.least, 2.0 * scenario_->time_step), h.most);
}

/// m, from the centre: what is farther is beyond reach at the longest horizon, whatever the rounding of its distance.
double StaticField::farthest_that_matters(const Viewpoint& from) const {
  constexpr double kRounding = 1.0 + 1e-9;
  const Horizons& h = scenario_->horizons;
  if (method_ != Method::orca && rule_ == HorizonRule::literal) return kEverywhere;
  const double tau = method_ == Method::orca ? h.orca : h.most;
  return kRounding * (std::sqrt(2.0) * from.max_speed * tau + from.radius + kContactSkin);
}

template <class Visit>
void StaticField::for_each_shape_meeting(const geometry::Box& window, const Visit& visit) const {
  if (method_ == Method::ivo_edge) {
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

/// m, from the centre, never too short.
double StaticField::distance_within(const Viewpoint& from, double reach) const {
  constexpr double kRounding = 1.0 + 1e-9;
  return std::min(farthest_that_matters(from), kRounding * (reach + from.radius + kContactSkin));
}

void StaticField::constraints(const Viewpoint& from, std::vector<Constraint>& out, double reach) const {
  out.clear();
  const double within = distance_within(from, reach);
  if (method_ == Method::orca) return add_edges(from, within, out);
  for_each_shape_within(from.position, within, [&](const Shape& s) { add_shape(s, from, within, out); });
  sort_by_clearance(out);
}

template <class Visit>
void StaticField::for_each_shape_within(Vec2 x, double reach, const Visit& visit) const {
  if (method_ == Method::ivo_edge) {
    scene_->facade_ellipses_by_place().for_each_within(x, reach, [&](std::size_t k) {
      visit(Shape{scene_->facade_ellipse(k), k, EnclosureGrade::containing});
    });
    return;
  }
  for (const Shape& e : enclosures_)
    if (distance_below(scene_->bodies().box(e.body), x) <= reach) visit(e);
  scene_->pieces_by_place().for_each_within(x, reach, [&](std::size_t k) {
    if (tight_index_[k] != kEnclosed) visit(Shape{scene_->piece(k), tight_index_[k], EnclosureGrade::tight});
  });
}

/// An enclosure that the robot is in gives way to what it encloses.
bool StaticField::gives_way(const Shape& shape, const Viewpoint& from) const {
  if (shape.grade == EnclosureGrade::tight) return false;
  BodyTable& bodies = scene_->bodies();
  if (distance_below(bodies.box(shape.body), from.position) > from.radius) return false;
  return locate(bodies.seen(shape.body, from.position, from.radius), Vec2{}) != geometry::Place::outside;
}

template <class Visit>
void StaticField::for_each_piece_of(const Shape& shape, const Visit& visit) const {
  std::size_t number = 0;
  for (const std::size_t obstacle : scene_->bodies()[shape.body].owners)
    for (std::size_t k = scene_->first_piece(obstacle); k < scene_->first_piece(obstacle + 1); ++k)
      visit(scene_->piece(k), Name{shape.index, ++number, EnclosureGrade::tight});
}

void StaticField::add_shape(const Shape& shape, const Viewpoint& from, double reach,
                            std::vector<Constraint>& out) const {
  if (!gives_way(shape, from)) return add_body(shape.body, {shape.index, 0, shape.grade}, from, out);
  for_each_piece_of(shape, [&](BodyTable::Number piece, const Name& name) {
    if (distance_below(scene_->bodies().box(piece), from.position) <= reach) add_body(piece, name, from, out);
  });
}

// --- What a decision needs ---
//
// With S the body grown by the robot and its room, seen from the robot, VO = { s / t : s in S, 0 < t <= tau }, and the
// half-plane of a v outside VO is that of VO's point nearest to v: n.v - c = |v - VO| for the unit n. Two lower bounds
// of that distance, from a box round the body alone:
//
//     |v - s/t| >= |s|/t - |v| >= |S| / tau - |v|              for a slow robot
//     |v - s/t| = |t v - s| / t >= |path - S| / tau            path = { t v : 0 <= t <= tau }, for a fast one
//
// tau grows with the distance of the body, and so does |S| / tau.

namespace {

double largest_coordinate(const geometry::Box& b) {
  return std::max({std::fabs(b.low.x), std::fabs(b.low.y), std::fabs(b.high.x), std::fabs(b.high.y)});
}

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

/// m/s: less than n.v - c of the half-plane against whatever the box holds.
double StaticField::room_below(const geometry::Box& box, const Viewpoint& from) const {
  constexpr double kRounding = 1e-12;  // of the coordinates
  const double kept = margin_ + kContactSkin + kRounding * (largest_coordinate(box) + norm(from.position));
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

/// Of the cut-off where u is nearest to it, else of the line across the way to the nearest point.
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
double StaticField::room_of(BodyTable::Number body, const Viewpoint& from, double enough) const {
  constexpr double kRounding = 1e-12;  // of the coordinates
  const geometry::Box& box = scene_->bodies().box(body);
  const double room = room_below(box, from);
  if (room >= enough) return room;
  const double kept =
      from.radius + margin_ + kContactSkin + kRounding * (largest_coordinate(box) + norm(from.position) + from.radius);
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
  const Horizons& h = scenario_->horizons;
  const double kept = margin_ + kContactSkin;
  const double least = std::max(h.least, 2.0 * scenario_->time_step);
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
  const double most = scenario_->horizons.most;
  const geometry::Box slow = grown(from.position, kept + distance_of_room(from, need.room + norm(from.velocity)));
  geometry::Box fast = grown(from.position, kept + most * need.room);
  fast.add(grown(from.position + most * from.velocity, kept + most * need.room));
  window.add(geometry::Box{{std::max(slow.low.x, fast.low.x), std::max(slow.low.y, fast.low.y)},
                           {std::min(slow.high.x, fast.high.x), std::min(slow.high.y, fast.high.y)}});
  return window;
}

void StaticField::add_needed(const Viewpoint& from, const Need& had, const Need& need,
                             std::vector<Constraint>& out) const {
  EXACTVO_REQUIRE(rule_ == HorizonRule::clamped && method_ != Method::orca, "bounds of other horizons");
  constexpr double kRounding = 1.0 + 1e-9;
  const auto is_within = [&](const Need& n, double distance) {
    return n.within >= 0.0 && distance <= kRounding * (n.within + from.radius + kContactSkin);
  };
  const auto is_new = [&](BodyTable::Number body) {
    const double distance = geometry::distance_below(scene_->bodies().box(body), from.position);
    if (is_within(had, distance)) return false;
    const bool is_near = is_within(need, distance);
    if (is_near && !(had.room > 0.0)) return true;
    if (!is_near && !(need.room > 0.0)) return false;
    const double room = room_of(body, from, std::max(need.room, had.room));
    return !(had.room > 0.0 && room < had.room) && (is_near || room < need.room);
  };
  const auto add_if_new = [&](BodyTable::Number body, const Name& name) {
    if (is_new(body)) add_body(body, name, from, out);
  };
  for_each_shape_meeting(window_of(from, need), [&](const Shape& s) {
    if (gives_way(s, from))
      for_each_piece_of(s, add_if_new);
    else
      add_if_new(s.body, {s.index, 0, s.grade});
  });
}

StaticField::NearBody StaticField::near_body(BodyTable::Number body, const Name& name) const {
  NearBody b;
  b.body = body;
  b.index = name.index;
  b.piece = name.piece;
  b.grade = name.grade;
  b.box = scene_->bodies().box(body);
  b.largest_coordinate = largest_coordinate(b.box);
  if (const auto* s = std::get_if<geometry::Segment>(&scene_->bodies()[body].shape)) {
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
    out.push_back(near_body(s.body, {s.index, 0, s.grade}));
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
  out.body = b.body;
  out.index = b.index;
  out.piece = b.piece;
  out.grade = b.grade;
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
  EXACTVO_REQUIRE(rule_ == HorizonRule::clamped && method_ != Method::orca, "bounds of other horizons");
  constexpr double kRounding = 1.0 + 1e-9;
  out.clear();
  const Horizons& h = scenario_->horizons;
  const Sight sight{from,
                    kRounding * distance_within(from, reach),
                    norm(from.position) + from.radius,
                    1.0 / std::max(norm(from.velocity), h.speed_floor * from.max_speed),
                    std::max(h.least, 2.0 * scenario_->time_step),
                    h.most};
  const auto see_if_near = [&](const NearBody& b) {
    if (!see(b, sight, out.emplace_back())) out.pop_back();
  };
  for (const NearBody& b : near) {
    if (b.gathered > sight.within + kRounding * moved) break;
    if (b.grade == EnclosureGrade::tight || !gives_way({b.body, b.index, b.grade}, from)) {
      see_if_near(b);
      continue;
    }
    for_each_piece_of({b.body, b.index, b.grade},
                      [&](BodyTable::Number piece, const Name& name) { see_if_near(near_body(piece, name)); });
  }
}

void StaticField::build(const Candidate& c, const Viewpoint& from, std::vector<Constraint>& out) const {
  add_body(c.body, {c.index, c.piece, c.grade}, from, out);
}

void StaticField::add_body(BodyTable::Number body, const Name& name, const Viewpoint& from,
                           std::vector<Constraint>& out) const {
  geometry::GrownShape& seen = scene_->bodies().seen(body, from.position, from.radius);
  const vo::VelocityObstacle::Nearest nearest = vo::clearance_of(seen);
  vo::ClearancePolicy policy;
  policy.time_horizon = horizon(nearest.distance, from);
  if (is_beyond_reach(nearest.distance, from, policy.time_horizon)) return;
  // An ellipse has its margin inside; a bare piece gets it here.
  policy.room = name.grade == EnclosureGrade::tight ? margin_ + kContactSkin : kContactSkin;
  policy.push_out_time = kPushOutTime;
  policy.push_out_speed = kPushOutShare * from.max_speed;
  const vo::ProvenHalfPlane found = vo::half_plane_against(seen, nearest, from.velocity, policy);
  Constraint& c = out.emplace_back();
  c.half_plane = found.half_plane;
  c.proof = found.proof;
  c.body = body;
  c.clearance = nearest.distance;
  c.normal = nearest.normal;
  c.time_horizon = policy.time_horizon;
  c.index = name.index;
  c.piece = name.piece;
  c.trap_free = name.grade == EnclosureGrade::trap_free || name.grade == EnclosureGrade::trap_free_thin;
}

/// The baseline's rule walks each chain from its nearest edge; edges beyond `reach` take no part in it, since they
/// cover none that is nearer.
void StaticField::add_edges(const Viewpoint& from, double reach, std::vector<Constraint>& out) const {
  std::vector<std::size_t> near, of_chain;
  scene_->edges_by_place().for_each_within(from.position, reach, [&](std::size_t edge) { near.push_back(edge); });
  std::sort(near.begin(), near.end());
  for (std::size_t first = 0; first < near.size();) {
    const std::size_t chain = scene_->chain_of(near[first]);
    of_chain.clear();
    for (; first < near.size() && scene_->chain_of(near[first]) == chain; ++first)
      of_chain.push_back(near[first] - scene_->first_edge(chain));
    for (const vo::OrcaHalfPlane& found :
         vo::orca_half_planes(scene_->chains()[chain], of_chain, from.position, from.velocity,
                              from.radius + kContactSkin, from.horizon > 0.0 ? from.horizon : scenario_->horizons.orca))
      add_edge(chain, found, from, out);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Constraint& a, const Constraint& b) { return a.clearance < b.clearance; });
}

void StaticField::add_edge(std::size_t chain, const vo::OrcaHalfPlane& found, const Viewpoint& from,
                           std::vector<Constraint>& out) const {
  const double tau = from.horizon > 0.0 ? from.horizon : scenario_->horizons.orca;
  const std::size_t number = scene_->first_edge(chain) + found.edge;
  const BodyTable::Number body = scene_->edge(number);
  const auto& edge = std::get<geometry::Segment>(scene_->bodies()[body].shape);
  const Vec2 nearest = geometry::nearest_point(edge, from.position);
  const double clearance = geometry::distance(edge, from.position) - from.radius;
  if (is_beyond_reach(clearance, from, tau)) return;
  Constraint& c = out.emplace_back();
  c.half_plane = found.half_plane;
  c.proof = found.certified ? vo::Proof::alone : vo::Proof::none;
  c.body = body;
  c.clearance = clearance;
  c.normal = geometry::normalized(from.position - nearest);
  c.time_horizon = tau;
  c.index = number;
  if (found.certified) return;
  // Within the skin: the robot itself may still be clear.
  const geometry::GrownShape& seen = scene_->bodies().seen(body, from.position, from.radius);
  const vo::ProvenHalfPlane bare = vo::contact_or_push_out(seen, vo::clearance_of(seen), {tau});
  if (bare.proof == vo::Proof::none) return;
  c.half_plane = bare.half_plane;
  c.proof = bare.proof;
}

}  // namespace exactvo::formation::detail
