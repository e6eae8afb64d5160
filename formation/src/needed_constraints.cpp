// SPDX-License-Identifier: GPL-3.0-or-later
#include "needed_constraints.h"

#include <algorithm>

namespace exactvo::formation::detail {
namespace {

constexpr double kFirstStage = 0.25;  // of the largest speed

/// What the most violated line is violated by, m/s, whichever of the two measures is asked for.
double most_violation(const std::vector<Constraint>& lines, Vec2 v) {
  double most = 0.0;
  for (const Constraint& c : lines)
    most = std::max(most, geometry::violation(c.half_plane, v) / std::max(1.0, norm(c.half_plane.normal)));
  return most;
}

}  // namespace

bool violates(const geometry::HalfPlane& h, Vec2 v) {
  // A velocity that lies on the line up to rounding moves along it.
  constexpr double kOnLine = 1e-12;
  return geometry::violation(h, v) > kOnLine * (1.0 + norm(v));
}

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
  const double away = norm(v - from_.velocity) + kSpareRoom * from_.max_speed;
  bool added = false;
  for (;;) {
    const double room = std::max(away - most_violation(lines_, v), kSpareRoom * from_.max_speed);
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

// --- One after the other ---

void NearConstraints::look(const StaticField& field, const Viewpoint& from, double reach) {
  field_ = &field;
  from_ = from;
  reach_ = reach;
  lines_.clear();
  field.candidates(from, reach, candidates_);
}

/// Builds those that are wanted. True where half-planes were added.
template <class Wanted>
bool NearConstraints::build_where(const Wanted& wanted) {
  const std::size_t before = lines_.size();
  for (StaticField::Candidate& c : candidates_) {
    if (c.is_built || !wanted(c)) continue;
    c.is_built = true;
    field_->build(c, from_, lines_);
    if (!lines_.empty() && !(lines_.back().clearance <= reach_)) lines_.pop_back();
  }
  if (lines_.size() == before) return false;
  sort_by_clearance(lines_);
  return true;
}

const Constraint* NearConstraints::first_violated(Vec2 v) {
  const double room = norm(v - from_.velocity) + kSpareRoom * from_.max_speed;
  for (;;) {
    const auto first =
        std::find_if(lines_.begin(), lines_.end(), [&](const Constraint& c) { return violates(c.half_plane, v); });
    const bool found = first != lines_.end();
    // Of the others, only what may be nearer and violated. The nearest is asked first: it often settles it.
    const double nearer = found ? first->clearance : reach_;
    const StaticField::Candidate* next = nullptr;
    for (const StaticField::Candidate& c : candidates_)
      if (!c.is_built && c.nearest <= nearer && c.room < room && (!next || c.nearest < next->nearest)) next = &c;
    if (!next) return found ? &*first : nullptr;
    build_where([&](const StaticField::Candidate& c) { return &c == next; });
  }
}

const Constraint* NearConstraints::of_body(vo::BodyTable::Number body) {
  build_where([&](const StaticField::Candidate& c) { return c.body == body; });
  const auto found = std::find_if(lines_.begin(), lines_.end(), [&](const Constraint& c) { return c.body == body; });
  return found == lines_.end() ? nullptr : &*found;
}

}  // namespace exactvo::formation::detail
