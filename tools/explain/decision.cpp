// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain/decision.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::tools {

using formation::RecordedConstraint;
using geometry::GrownShape;

namespace {

using geometry::kPi;
constexpr int kDirections = 4096;  // an arc between two of them strays from its chord by 3e-7 of the radius
/// A chosen velocity this near the speed bound (relative) is on it: the solver keeps a slack of a few ulps, and a
/// recording may have passed through text.
constexpr double kOnBound = 1e-6;

Vec2 direction(int i) {
  const double angle = 2.0 * kPi * i / kDirections;
  return {std::cos(angle), std::sin(angle)};
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

double violation_of(const RecordedConstraint& constraint, Vec2 v) {
  return geometry::violation(constraint.half_plane, v) / norm(constraint.half_plane.normal);
}

GrownShape grown_shape(const RecordedConstraint& constraint) {
  return {constraint.shape, constraint.position, constraint.radius};
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
