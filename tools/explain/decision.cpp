// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain/decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::tools {

using formation::ConstraintSource;
using formation::RecordedConstraint;
using formation::Scenario;
using geometry::GrownShape;

namespace {

using geometry::kPi;
constexpr int kDirections = 4096;  // an arc between two of them strays from its chord by 3e-7 of the radius
/// A chosen velocity this near the speed bound (relative) is on it: the solver keeps a slack of a few ulps, and a
/// recording may have passed through text.
constexpr double kOnBound = 1e-6;
/// m: a point this near a shape lies on it, for naming; far above the sampling's error, far below any gap between
/// obstacles that matters.
constexpr double kSamePlace = 1e-5;
constexpr std::size_t kMostNames = 3;

Vec2 direction(int i) {
  const double angle = 2.0 * kPi * i / kDirections;
  return {std::cos(angle), std::sin(angle)};
}

bool has_vertex_in(const geometry::Obstacle& obstacle, const geometry::Ellipse& ellipse) {
  const auto vertices = vertices_of(obstacle);
  return std::any_of(vertices.begin(), vertices.end(), [&](Vec2 p) { return contains(ellipse, p); });
}

bool has_edge(const geometry::Obstacle& obstacle, const geometry::Segment& edge) {
  const auto edges = edges_of(obstacle);
  return std::any_of(edges.begin(), edges.end(), [&](const geometry::Segment& e) {
    return (e.a == edge.a && e.b == edge.b) || (e.a == edge.b && e.b == edge.a);
  });
}

bool belongs_to(const geometry::ConvexShape& shape, const geometry::Obstacle& obstacle) {
  if (const auto* ellipse = std::get_if<geometry::Ellipse>(&shape)) return has_vertex_in(obstacle, *ellipse);
  if (const auto* segment = std::get_if<geometry::Segment>(&shape)) return has_edge(obstacle, *segment);
  return false;
}

/// Where nothing is exactly the same (a convex piece, a hull, a shortened facade): a vertex in the shape or on it.
bool touches(const geometry::ConvexShape& shape, const geometry::Obstacle& obstacle) {
  const auto vertices = vertices_of(obstacle);
  return std::any_of(vertices.begin(), vertices.end(), [&](Vec2 p) {
    return distance_to({shape, p, 0.0}) <= kSamePlace;
  });
}

std::vector<std::string> ids_where(bool (*holds)(const geometry::ConvexShape&, const geometry::Obstacle&),
                                   const geometry::ConvexShape& shape, const Scenario& scenario) {
  std::vector<std::string> ids;
  for (const auto& obstacle : scenario.obstacles) {
    if (holds(shape, obstacle.shape)) ids.push_back(obstacle.id);
  }
  return ids;
}

/// "a", "a and b", "a, b and c", "a, b, c and 2 more".
std::string listed(std::vector<std::string> ids) {
  if (ids.size() > kMostNames) {
    const std::size_t more = ids.size() - kMostNames;
    ids.resize(kMostNames);
    ids.push_back(fmt::format("{} more", more));
  }
  if (ids.size() < 2) return fmt::format("{}", fmt::join(ids, ""));
  return fmt::format("{} and {}", fmt::join(ids.begin(), ids.end() - 1, ", "), ids.back());
}

/// The ids of the obstacles that the shape stands for: "wall and desk 3".
std::string owners_of(const geometry::ConvexShape& shape, const Scenario& scenario) {
  std::vector<std::string> ids = ids_where(belongs_to, shape, scenario);
  if (ids.empty()) ids = ids_where(touches, shape, scenario);
  return listed(ids);
}

std::string ends_of(const geometry::Segment& s) {
  return fmt::format("({:.3g}, {:.3g})-({:.3g}, {:.3g})", s.a.x, s.a.y, s.b.x, s.b.y);
}

std::string static_name(const RecordedConstraint& constraint, const Scenario& scenario) {
  const std::string owners = owners_of(constraint.shape, scenario);
  const std::string of = owners.empty() ? "" : " of " + owners;
  if (const auto* segment = std::get_if<geometry::Segment>(&constraint.shape)) {
    return "the edge " + ends_of(*segment) + of;
  }
  return constraint.source == ConstraintSource::enclosure ? fmt::format("enclosure {}{}", constraint.index, of)
                                                          : fmt::format("obstacle {}{}", constraint.index, of);
}

using Force = Balance::Force;

void add_disc_force(const Decision& d, std::vector<Force>& forces) {
  const double speed = norm(d.step.chosen);
  if (speed >= d.who().max_speed * (1.0 - kOnBound)) forces.push_back({std::nullopt, -normalized(d.step.chosen), 0.0});
}

void add_box_forces(const Decision& d, std::vector<Force>& forces) {
  const double limit = d.who().max_speed * (1.0 - kOnBound);
  const Vec2 v = d.step.chosen;
  if (std::abs(v.x) >= limit) forces.push_back({std::nullopt, {v.x > 0.0 ? -1.0 : 1.0, 0.0}, 0.0});
  if (std::abs(v.y) >= limit) forces.push_back({std::nullopt, {0.0, v.y > 0.0 ? -1.0 : 1.0}, 0.0});
}

std::vector<Force> candidates(const Decision& d) {
  std::vector<Force> forces;
  for (std::size_t i = 0; i < d.step.constraints.size(); ++i) {
    const RecordedConstraint& c = d.step.constraints[i];
    if (c.active) forces.push_back({i, c.half_plane.normal, 0.0});
  }
  const bool disc = d.scenario.speed_bound == formation::SpeedBoundKind::disc;
  disc ? add_disc_force(d, forces) : add_box_forces(d, forces);
  return forces;
}

struct Fit {
  std::vector<Force> forces;
  double remainder = std::numeric_limits<double>::infinity();
};

void keep_better(Fit& best, Fit fit, Vec2 push) {
  Vec2 rest = push;
  for (const Force& force : fit.forces) {
    if (!(force.factor >= 0.0)) return;
    rest = rest - force.factor * force.normal;
  }
  fit.remainder = norm(rest);
  if (fit.remainder < best.remainder) best = std::move(fit);
}

void try_one(Fit& best, Force a, Vec2 push) {
  a.factor = dot(push, a.normal) / squared_norm(a.normal);
  keep_better(best, {{a}, 0.0}, push);
}

void try_two(Fit& best, Force a, Force b, Vec2 push) {
  const double det = cross(a.normal, b.normal);
  if (det == 0.0) return;
  a.factor = cross(push, b.normal) / det;
  b.factor = cross(a.normal, push) / det;
  keep_better(best, {{a, b}, 0.0}, push);
}

}  // namespace

GrownShape grown_shape(const RecordedConstraint& constraint) {
  return {constraint.shape, constraint.position, constraint.radius};
}

std::string name_of(const RecordedConstraint& constraint, const Scenario& scenario) {
  if (constraint.source == ConstraintSource::moving_obstacle && constraint.index < scenario.moving_obstacles.size()) {
    return "moving obstacle " + scenario.moving_obstacles[constraint.index].id;
  }
  if (constraint.source != ConstraintSource::robot) return static_name(constraint, scenario);
  return "robot " + (constraint.index < scenario.robots.size() ? scenario.robots[constraint.index].id
                                                               : std::to_string(constraint.index));
}

double distance_to(const GrownShape& s) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) least = std::min(least, support(s, direction(i)).h);
  return -least;
}

std::optional<double> time_to_contact(const GrownShape& s, Vec2 v) {
  // t v lies in S iff t n.v <= h_S(n) for every n: each direction bounds t from one side.
  double first = 0.0;
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const Vec2 n = direction(i);
    const double h = support(s, n).h;
    const double speed = dot(n, v);
    if (speed > 0.0) last = std::min(last, h / speed);
    if (speed < 0.0) first = std::max(first, h / speed);
    if (speed == 0.0 && h < 0.0) return std::nullopt;
  }
  if (first > last) return std::nullopt;
  return first;
}

Balance balance(const Decision& decision) {
  const Vec2 push = decision.step.chosen - decision.step.preferred;
  const std::vector<Force> forces = candidates(decision);
  Fit best{{}, norm(push)};
  for (const Force& force : forces) try_one(best, force, push);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    for (std::size_t j = i + 1; j < forces.size(); ++j) try_two(best, forces[i], forces[j], push);
  }
  return {best.forces, best.remainder};
}

}  // namespace exactvo::tools
