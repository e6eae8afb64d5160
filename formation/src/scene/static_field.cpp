// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/static_field.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "scene/braking.h"
#include "scene/moment.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Enclosure;
using geometry::EnclosureGrade;
using vo::BodyTable;

/// In real overlap nothing can be certified; the robot is asked to leave within this time, at a share of its speed.
constexpr double kPushOutTime = 0.2;   // moments
constexpr double kPushOutShare = 0.3;  // of max_speed

constexpr double kLiteralHorizonAtRest = 1e6;  // s: the printed tau divides by |v| = 0

geometry::EnclosureOptions enclosure_options(const Margins& margins) {
  geometry::EnclosureOptions options;
  options.margin = margins.obstacle;
  options.least_margin = std::min(options.least_margin, options.margin);
  return options;
}

/// The farthest velocity of a box bound is sqrt 2 times its side.
bool is_beyond_reach(double clearance, const Viewpoint& from, double tau) {
  return clearance > std::sqrt(2.0) * from.max_speed * tau;
}

}  // namespace

StaticField::StaticField(Scene& scene, const DecisionRules& rules, double radius, Vec2 start, Vec2 goal,
                         HorizonRule rule, SeenAs seen_as)
    : scene_(&scene), rules_(&rules), rule_(rule), margin_(rules.margins.obstacle) {
  const bool has_pieces = rules.method == Method::ivo_cluster || rules.method == Method::ivo;
  if (has_pieces && (seen_as == SeenAs::pieces || rules.guidance == Guidance::route)) {
    tight_index_.resize(scene.pieces_by_place().size());
    std::iota(tight_index_.begin(), tight_index_.end(), 0u);
  } else if (has_pieces) {
    take_enclosures(geometry::enclose(scene.parts(), radius, start, goal, enclosure_options(rules.margins)));
  }
  list_if_small();
}

/// Few shapes are looked at one by one faster than they are looked up by place.
void StaticField::list_if_small() {
  constexpr std::size_t kFew = 16;
  is_small_ = true;
  for_each_shape([this](const Shape& s) {
    is_small_ = is_small_ && all_.size() < kFew;
    if (is_small_) all_.push_back(s);
  });
  if (!is_small_) all_ = {};
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
      enclosures_.push_back({scene_->bodies().add({vo::BodyKind::enclosure, e.shape, {}, e.obstacles}), i, e.grade});
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
  for_each_shape([&](const Shape& s) {
    if (all.size() <= s.index) all.resize(s.index + 1);
    all[s.index] = s.body;
  });
  return all;
}

std::vector<Enclosure> StaticField::enclosures() const {
  const EnclosureGrade usual = rules_->method == Method::ivo_edge ? EnclosureGrade::containing : EnclosureGrade::tight;
  std::vector<Enclosure> all;
  for (const BodyTable::Number body : shapes())
    all.push_back({scene_->bodies()[body].shape, scene_->bodies()[body].owners, usual});
  for (const Shape& e : enclosures_) all[e.index].grade = e.grade;
  return all;
}

double StaticField::horizon(double distance, const Viewpoint& from) const {
  if (from.horizon > 0.0) return from.horizon;
  const Horizons& h = rules_->horizons;
  const double speed = norm(from.velocity);
  if (rule_ == HorizonRule::literal)
    return speed > 0.0 && distance > 0.0 ? std::min(distance / speed, kLiteralHorizonAtRest) : kLiteralHorizonAtRest;
  const double tau = distance / std::max(speed, h.speed_floor * from.max_speed);
  return std::clamp(std::min(tau, from.turns_after), rules_->least_horizon(), h.most);
}

/// m, from the centre: what is farther is beyond reach at the longest horizon, whatever the rounding of its distance.
double StaticField::farthest_that_matters(const Viewpoint& from) const {
  constexpr double kRounding = 1.0 + 1e-9;
  const Horizons& h = rules_->horizons;
  if (!takes_edges(rules_->method) && rule_ == HorizonRule::literal) return kEverywhere;
  const double tau = takes_edges(rules_->method) ? h.orca : h.most;
  return kRounding * (std::sqrt(2.0) * from.max_speed * tau + from.radius + kContactSkin);
}

/// m, from the centre, never too short.
double StaticField::distance_within(const Viewpoint& from, double reach) const {
  constexpr double kRounding = 1.0 + 1e-9;
  return std::min(farthest_that_matters(from), kRounding * (reach + from.radius + kContactSkin));
}

void StaticField::constraints(const Viewpoint& from, std::vector<Constraint>& out, double reach) const {
  out.clear();
  const double within = distance_within(from, reach);
  const bool edges = takes_edges(rules_->method);
  if (edges && !from.brakes) return add_edges(from, within, out);
  if (edges)
    scene_->edges_by_place().for_each_within(from.position, within, [&](std::size_t edge) {
      build({scene_->edge(edge), edge, EnclosureGrade::tight, 0}, from, out);
    });
  for_each_shape_within(from.position, within, [&](const Shape& s) { add_shape(s, from, within, out); });
  std::sort(out.begin(), out.end(), comes_before);
}

/// An enclosure that the robot is in gives way to what it encloses. `distance`: m, to its box.
bool StaticField::gives_way(const Shape& shape, const Viewpoint& from, double distance) const {
  if (shape.grade == EnclosureGrade::tight || distance > from.radius) return false;
  return locate(scene_->bodies().seen(shape.body, from.position, from.radius), Vec2{}) != geometry::Place::outside;
}

void StaticField::add_shape(const Shape& shape, const Viewpoint& from, double reach,
                            std::vector<Constraint>& out) const {
  const bool is_piece = shape.grade == EnclosureGrade::tight;
  if (from.brakes ? is_piece : !gives_way(shape, from, distance_to_box(shape, from))) return build(shape, from, out);
  for_each_piece_of(shape, [&](const Shape& piece) {
    if (distance_to_box(piece, from) <= reach) build(piece, from, out);
  });
}

void StaticField::build(const Shape& shape, const Viewpoint& from, std::vector<Constraint>& out) const {
  geometry::GrownShape& seen = scene_->bodies().seen(shape.body, from.position, from.radius);
  const vo::VelocityObstacle::Nearest nearest = vo::clearance_of(seen);
  vo::ClearancePolicy policy;
  policy.time_horizon = horizon(nearest.distance, from);
  if (is_beyond_reach(nearest.distance, from, policy.time_horizon)) return;
  // An ellipse has its margin inside; a bare piece gets it here.
  policy.room = shape.grade == EnclosureGrade::tight ? margin_ + kContactSkin : kContactSkin;
  policy.push_out_time = kPushOutTime * moment(rules_->horizons);
  policy.push_out_speed = kPushOutShare * from.max_speed;
  const vo::ProvenHalfPlane found = from.brakes ? braking_half_plane(seen, nearest, from.velocity, policy.time_horizon)
                                                : vo::half_plane_against(seen, nearest, from.velocity, policy);
  Constraint& c = out.emplace_back();
  c.half_plane = found.half_plane;
  c.proof = found.proof;
  c.body = shape.body;
  c.clearance = nearest.distance;
  c.normal = nearest.normal;
  c.time_horizon = policy.time_horizon;
  c.index = shape.index;
  c.piece = shape.piece;
  c.trap_free = shape.grade == EnclosureGrade::trap_free || shape.grade == EnclosureGrade::trap_free_thin;
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
                              from.radius + kContactSkin, from.horizon > 0.0 ? from.horizon : rules_->horizons.orca))
      add_edge(chain, found, from, out);
  }
  add_unguarded(near, from, out);
  std::stable_sort(out.begin(), out.end(),
                   [](const Constraint& a, const Constraint& b) { return a.clearance < b.clearance; });
}

void StaticField::add_edge(std::size_t chain, const vo::OrcaHalfPlane& found, const Viewpoint& from,
                           std::vector<Constraint>& out) const {
  const double tau = from.horizon > 0.0 ? from.horizon : rules_->horizons.orca;
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

/// The baseline's rule leaves an edge to its neighbours where it is seen along one of them, and nearly collinear
/// neighbours leave it to each other. An edge that can be met within a step, or while braking, gets a half-plane of its
/// own where none of what can be met within that time excludes it. (Of a step rows keep all.)
void StaticField::add_unguarded(const std::vector<std::size_t>& near, const Viewpoint& from,
                                std::vector<Constraint>& out) const {
  const double tau = from.horizon > 0.0 ? from.horizon : rules_->horizons.orca;
  const double least = rules_->least_look();
  const double reach = reach_of_step(least, from.max_speed);
  for (const std::size_t number : near) {
    const BodyTable::Number body = scene_->edge(number);
    const auto& edge = std::get<geometry::Segment>(scene_->bodies()[body].shape);
    if (geometry::distance(edge, from.position) - from.radius > reach) continue;
    if (geometry::orientation(edge.a, edge.b, from.position) == geometry::Sign::positive) continue;  // faces away
    geometry::GrownShape& seen = scene_->bodies().seen(body, from.position, from.radius);
    const auto excludes = [&](const Constraint& c) {
      return c.clearance <= reach && geometry::half_plane_is_safe(seen, least, c.half_plane);
    };
    if (std::any_of(out.begin(), out.end(), excludes)) continue;
    const vo::VelocityObstacle::Nearest nearest = vo::clearance_of(seen);
    vo::ClearancePolicy policy;
    policy.time_horizon = tau;
    policy.room = kContactSkin;
    const vo::ProvenHalfPlane found = vo::half_plane_against(seen, nearest, from.velocity, policy);
    if (found.proof == vo::Proof::none) continue;  // in overlap: the nearest edge pushes it out
    Constraint& c = out.emplace_back();
    c.half_plane = found.half_plane;
    c.proof = found.proof;
    c.body = body;
    c.clearance = nearest.distance;
    c.normal = nearest.normal;
    c.time_horizon = tau;
    c.index = number;
  }
}

}  // namespace exactvo::formation::detail
