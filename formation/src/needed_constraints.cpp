// SPDX-License-Identifier: GPL-3.0-or-later
#include "needed_constraints.h"

#include <algorithm>

namespace exactvo::formation::detail {
namespace {

/// Of the largest speed: what is left out has this much room to spare, far above any rounding of a half-plane.
constexpr double kSpare = 1e-3;

constexpr double kFirstStage = 0.25;  // of the largest speed

/// What the most violated line is violated by, m/s, whichever of the two measures is asked for.
double most_violation(const std::vector<Constraint>& lines, Vec2 v) {
  double most = 0.0;
  for (const Constraint& c : lines)
    most = std::max(most, geometry::violation(c.half_plane, v) / std::max(1.0, norm(c.half_plane.normal)));
  return most;
}

}  // namespace

void NeededConstraints::look(const StaticField& field, const Viewpoint& from, double reach) {
  field_ = &field;
  from_ = from;
  have_ = {};
  has_all_ = false;
  lines_.clear();
  need_within(reach);
}

bool NeededConstraints::need(const Need& need) {
  if (has_all_) return false;
  const std::size_t before = lines_.size();
  field_->add_needed(from_, have_, need, lines_);
  have_ = need;
  if (lines_.size() == before) return false;
  sort_by_clearance(lines_);
  return true;
}

bool NeededConstraints::need_within(double reach) {
  return reach > have_.within && need({reach, have_.room});
}

/// With room r > 0 at the present velocity u, a half-plane is violated at v by |v - u| - r at most. Those without room
/// may be violated by any amount.
bool NeededConstraints::need_at(Vec2 v) {
  const double away = norm(v - from_.velocity) + kSpare * from_.max_speed;
  bool added = false;
  for (;;) {
    const double room = std::max(away - most_violation(lines_, v), kSpare * from_.max_speed);
    if (has_all_ || room <= have_.room) return added;
    // In stages: a line that is violated more leaves less to ask for.
    const double stage = std::max(2.0 * have_.room, kFirstStage * from_.max_speed);
    added = need({have_.within, std::min(room, stage)}) || added;
  }
}

bool NeededConstraints::need_for(const lp::Solution& solution, const lp::Pricing& pricing) {
  if (solution.status != lp::Status::optimal || !pricing.is_all) return need_all();
  bool added = false;
  for (const Vec2 v : pricing.at) added = need_at(v) || added;
  return added;
}

bool NeededConstraints::need_all() {
  if (has_all_) return false;
  const std::size_t before = lines_.size();
  field_->constraints(from_, lines_);
  has_all_ = true;
  return lines_.size() != before;
}

}  // namespace exactvo::formation::detail
