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

Vec2 direction(int i) {
  const double angle = 2.0 * kPi * i / kDirections;
  return {std::cos(angle), std::sin(angle)};
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

}  // namespace exactvo::tools
