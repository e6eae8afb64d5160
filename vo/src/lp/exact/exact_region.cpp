// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "lp/exact/exact_search.h"
#include "lp/proof/duality.h"

namespace exactvo::lp {

ExactRegion exact_region(const Problem& problem) {
  ExactRegion region;
  region.lines.reserve(problem.constraints.size() + 4);
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& c = problem.constraints[k];
    region.lines.push_back({c.half_plane, constraint_at(k), c.priority == Priority::soft});
  }
  for (const Binding side : kBoxSides) {
    const HalfPlane h = half_plane_at(problem, side);
    if (std::isfinite(h.offset)) region.lines.push_back({h, side, false});
  }
  region.has_disc = std::isfinite(problem.bound.disc);
  if (region.has_disc) region.disc = Exact(problem.bound.disc);
  return region;
}

ExactRegion hard_part(const ExactRegion& region) {
  ExactRegion hard;
  hard.has_disc = region.has_disc;
  hard.disc = region.disc;
  for (const auto& member : region.lines)
    if (!member.soft) hard.lines.push_back(member);
  return hard;
}

ExactRegion softened(ExactRegion region) {
  for (auto& member : region.lines) member.soft = !is_speed_bound(member.binding);
  return region;
}

Aim aim_of(const Problem& problem) {
  if (problem.objective == Objective::nearest) return {{}, problem.preferred};
  return {{problem.preferred}, {}};
}

}  // namespace exactvo::lp
