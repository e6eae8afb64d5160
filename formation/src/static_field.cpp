// SPDX-License-Identifier: GPL-3.0-or-later
#include "static_field.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/distance.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::formation::detail {
namespace {

using geometry::ConvexShape;
using geometry::Enclosure;
using geometry::EnclosureGrade;
using geometry::GrownShape;
using vo::VelocityObstacle;

/// m. Half-planes are built for a robot this much larger and certified for the robot as it is: a robot that presses
/// against a wall for minutes closes the gap by a constant factor a step, and without a skin it would end within
/// rounding of the wall, where nothing can be proven. Rounding moves it by about 1e-15 of the coordinates a step, so
/// 1e-6 m outlasts 10^7 steps at 100 m.
constexpr double kContactSkin = 1e-6;

/// In real overlap nothing can be certified; the robot is asked to leave within this time, at a share of its speed.
constexpr double kPushOutTime = 0.2;   // s
constexpr double kPushOutShare = 0.3;  // of max_speed

constexpr double kLiteralHorizonAtRest = 1e6;  // s: the printed tau divides by |v| = 0

std::vector<Enclosure> facade_enclosures(const std::vector<geometry::ObstacleParts>& parts,
                                         const SimulationOptions& options, double margin) {
  std::vector<Enclosure> out;
  const geometry::FacadeEllipseOptions ellipse{options.facade_minor_to_major, options.facade_fixed_minor, margin};
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const geometry::Segment& facade : parts[i].facades)
      out.push_back({geometry::facade_ellipse(facade, ellipse), {i}, EnclosureGrade::containing});
  return out;
}

geometry::EnclosureOptions enclosure_options(const Scenario& scenario) {
  geometry::EnclosureOptions options;
  options.margin = scenario.margins.obstacle;
  options.least_margin = std::min(options.least_margin, options.margin);
  return options;
}

}  // namespace

ObstacleLibrary::ObstacleLibrary(const Scenario& scenario) {
  for (const SceneObstacle& obstacle : scenario.obstacles) {
    first_piece_.push_back(parts_.empty() ? 0 : first_piece_.back() + parts_.back().pieces.size());
    parts_.push_back(geometry::parts_of(obstacle.shape));
    for (vo::OrcaChain& chain : vo::orca_chains(obstacle.shape)) {
      // A closed chain has an edge a vertex, an open one an edge less: counting vertices numbers both apart.
      first_edge_.push_back(chains_.empty() ? 0 : first_edge_.back() + chains_.back().vertices.size());
      chains_.push_back(std::move(chain));
    }
  }
}

StaticField::StaticField(const ObstacleLibrary& library, const Scenario& scenario, const SimulationOptions& options,
                         double radius, Vec2 start, Vec2 goal, HorizonRule rule)
    : library_(&library), scenario_(&scenario), method_(options.method), rule_(rule) {
  if (method_ == Method::ivo_edge) enclosures_ = facade_enclosures(library.parts(), options, scenario.margins.obstacle);
  if (method_ == Method::ivo_cluster || method_ == Method::ivo)
    enclosures_ = geometry::enclose(library.parts(), radius, start, goal, enclosure_options(scenario));
}

double StaticField::horizon(double distance, const Viewpoint& from) const {
  const Horizons& h = scenario_->horizons;
  const double speed = norm(from.velocity);
  if (rule_ == HorizonRule::literal)
    return speed > 0.0 && distance > 0.0 ? std::min(distance / speed, kLiteralHorizonAtRest) : kLiteralHorizonAtRest;
  const double tau = distance / std::max(speed, h.speed_floor * from.max_speed);
  return std::clamp(tau, std::max(h.least, 2.0 * scenario_->time_step), h.most);
}

std::vector<StaticConstraint> StaticField::constraints(const Viewpoint& from) const {
  std::vector<StaticConstraint> out;
  if (method_ == Method::orca) add_orca(from, out);
  for (std::size_t i = 0; i < enclosures_.size(); ++i) add_enclosure(enclosures_[i], i, from, out);
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return out;
}

void StaticField::add_enclosure(const Enclosure& e, std::size_t index, const Viewpoint& from,
                                std::vector<StaticConstraint>& out) const {
  const VelocityObstacle grown(e.shape, from.position, from.radius, scenario_->horizons.most);
  const bool inside = e.grade != EnclosureGrade::tight && grown.overlaps();
  if (!inside) return add_shape(e.shape, {index, 0, index, e.grade}, from, out);
  // The enclosure gives way to what it encloses.
  std::size_t piece_number = 0;
  for (std::size_t obstacle : e.obstacles) {
    std::size_t shape = enclosures_.size() + library_->first_piece(obstacle);
    for (const ConvexShape& piece : library_->parts()[obstacle].pieces)
      add_shape(piece, {index, ++piece_number, shape++, EnclosureGrade::tight}, from, out);
  }
}

void StaticField::add_shape(const ConvexShape& shape, const Name& name, const Viewpoint& from,
                            std::vector<StaticConstraint>& out) const {
  const VelocityObstacle probe(shape, from.position, from.radius, scenario_->horizons.most);
  const VelocityObstacle::Nearest nearest = probe.nearest();
  const double tau = horizon(nearest.distance, from);
  // The farthest velocity of a box bound is sqrt 2 times its side.
  if (nearest.distance > std::sqrt(2.0) * from.max_speed * tau) return;
  StaticConstraint c;
  c.distance = nearest.distance;
  c.away = nearest.normal;
  c.shape = name.shape;
  c.trap_free = name.grade == EnclosureGrade::trap_free || name.grade == EnclosureGrade::trap_free_thin;
  RecordedConstraint& r = c.recorded;
  r.source = ConstraintSource::enclosure;
  r.index = name.enclosure;
  r.piece = name.piece;
  r.shape = shape;
  r.position = from.position;
  r.radius = from.radius;
  r.tau = tau;
  std::optional<geometry::HalfPlane> h;
  // An ellipse has its margin inside; a bare piece gets it here.
  const double skin = name.grade == EnclosureGrade::tight ? scenario_->margins.obstacle + kContactSkin : kContactSkin;
  const VelocityObstacle with_skin(shape, from.position, from.radius + skin, tau);
  if (!with_skin.overlaps()) h = with_skin.half_plane(from.velocity);
  if (!h && !probe.overlaps()) h = probe.contact_half_plane();
  r.certified = h.has_value();
  const double depth = std::max(-nearest.distance, 0.0);
  r.half_plane =
      h ? *h : geometry::HalfPlane{nearest.normal, std::min(depth / kPushOutTime, kPushOutShare * from.max_speed)};
  out.push_back(std::move(c));
}

void StaticField::add_orca(const Viewpoint& from, std::vector<StaticConstraint>& out) const {
  const double tau = scenario_->horizons.orca;
  for (std::size_t k = 0; k < library_->chains().size(); ++k) {
    const vo::OrcaChain& chain = library_->chains()[k];
    for (const vo::OrcaHalfPlane& found :
         vo::orca_half_planes(chain, from.position, from.velocity, from.radius + kContactSkin, tau)) {
      const geometry::Segment edge{chain.vertices[found.edge],
                                   chain.vertices[(found.edge + 1) % chain.vertices.size()]};
      const double distance = geometry::distance(edge, from.position) - from.radius;
      if (distance > std::sqrt(2.0) * from.max_speed * tau) continue;
      StaticConstraint c;
      c.distance = distance;
      c.away = geometry::normalized(from.position - geometry::nearest_point(edge, from.position));
      RecordedConstraint& r = c.recorded;
      r.half_plane = found.half_plane;
      r.source = ConstraintSource::obstacle_edge;
      r.index = library_->first_edge(k) + found.edge;
      r.certified = found.certified;
      r.shape = edge;
      r.position = from.position;
      r.radius = from.radius;
      r.tau = tau;
      if (!r.certified) {  // within the skin: the robot itself may still be clear
        const VelocityObstacle bare(edge, from.position, from.radius, tau);
        const auto h = bare.overlaps() ? std::nullopt : bare.contact_half_plane();
        if (h) r.half_plane = *h;
        r.certified = h.has_value();
      }
      out.push_back(std::move(c));
    }
  }
}

}  // namespace exactvo::formation::detail
