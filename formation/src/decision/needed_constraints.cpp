// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/needed_constraints.h"

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
  meetings_.clear();
  if (!field.bounds_room() || field.is_empty() || from.brakes)
    need_all();
  else
    need_within(reach);
}

bool NeededConstraints::need(const Need& need) {
  if (has_all_) return false;
  const std::size_t before = lines_.size();
  field_->add_needed(from_, need, meetings_, lines_);
  have_ = need;
  if (lines_.size() == before) return false;
  std::sort(lines_.begin(), lines_.end(), comes_before);
  return true;
}

/// With room r > 0 at the present velocity u, a half-plane is violated at v by |v - u| - r at most. Those without room
/// may be violated by any amount.
bool NeededConstraints::need_at(Vec2 v) {
  if (has_all_) return false;
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

bool NeededConstraints::need_all() {
  if (has_all_) return false;
  const std::size_t before = lines_.size();
  field_->constraints(from_, lines_);
  has_all_ = true;
  return lines_.size() != before;
}

// --- One after the other ---

namespace {

/// m: bodies are gathered for places this far away too, so that a robot on its way gathers them now and then only.
constexpr double kRoomToMove = 0.5;

}  // namespace

void NearConstraints::look(const StaticField& field, const Viewpoint& from, double reach) {
  double moved = norm(from.position - gathered_at_);
  const bool is_near = field_ == &field && reach <= gathered_reach_ && from.radius == from_.radius &&
                       from.max_speed == from_.max_speed && moved < 0.999 * kRoomToMove;
  field_ = &field;
  from_ = from;
  reach_ = reach;
  if (!is_near) {
    field.bodies_near(from, reach, kRoomToMove, bodies_);
    gathered_at_ = from.position;
    gathered_reach_ = reach;
    moved = 0.0;
  }
  lines_.clear();
  field.candidates(bodies_, moved, from, reach, candidates_);
}

/// Whether v may violate a half-plane that is not built: of a segment whose line is known but for rounding, where that
/// leaves v no room s to spare. Otherwise:
///
/// With the present velocity u, and p the point of a velocity obstacle that is nearest to u, the half-plane's unit
/// normal is n = (u - p) / |u - p| and its line goes through p: n.v - c = (u - p).(v - p) / |u - p|. With m = (u + v) /
/// 2 and r = |u - v| / 2 that is (q^2 - r^2) / |u - p| >= q - r for q = |p - m| > r, as |u - p| <= q + r. So v has room
/// s to spare where the disc round m of radius r + s lies beside the velocity obstacle.
///
/// It does where a line separates them. With a the unit vector from the segment's nearest point to the robot, d its
/// distance and g = d - kept > 0, the velocity obstacle lies in { w : a.w <= -g / tau }, and the disc beside it where
/// a.m - (r + s) > -g / tau. The rounding is in `kept`, and in s.
struct NearConstraints::Asked {
  Vec2 v, middle;
  double spare, radius, room;  ///< m/s: s, r + s, and |u - v| + s, that of a bound that knows no direction
  Asked(Vec2 asked, const Viewpoint& from) : v(asked), middle(0.5 * (asked + from.velocity)) {
    const double far = norm(v - from.velocity);
    spare = kSpareRoom * from.max_speed;
    radius = 0.5 * far + spare;
    room = far + spare;
  }
  bool may_be_violated(const StaticField::Candidate& c) const {
    if (c.has_line) return !(geometry::violation(c.line, v) < -spare);
    if (!c.is_segment) return c.room < room;
    return !(c.distance > c.kept &&
             c.tau * (dot(c.away, middle) - radius * c.distance) + (c.distance - c.kept) * c.distance > 0.0);
  }
};

/// Null where there is none within reach.
const Constraint* NearConstraints::build(StaticField::Candidate& c) {
  const std::size_t before = lines_.size();
  c.is_built = true;
  field_->build(c, from_, lines_);
  if (lines_.size() == before) return nullptr;
  if (lines_.back().clearance <= reach_) return &lines_.back();
  lines_.pop_back();
  return nullptr;
}

/// The nearest that is not built, may be violated and may be that near.
StaticField::Candidate* NearConstraints::next_for(const Asked& asked, double nearer) {
  StaticField::Candidate* next = nullptr;
  for (StaticField::Candidate& c : candidates_)
    if (!c.is_built && c.nearest <= nearer && (!next || c.nearest < next->nearest) && asked.may_be_violated(c))
      next = &c;
  return next;
}

const Constraint* NearConstraints::first_violated(Vec2 v) {
  const Asked asked(v, from_);
  constexpr auto none = static_cast<std::size_t>(-1);
  std::size_t first = none;
  const auto offer = [&](std::size_t k) {
    if (violates(lines_[k].half_plane, v) && (first == none || comes_before(lines_[k], lines_[first]))) first = k;
  };
  for (std::size_t k = 0; k < lines_.size(); ++k) offer(k);
  while (StaticField::Candidate* next = next_for(asked, first == none ? reach_ : lines_[first].clearance))
    if (build(*next)) offer(lines_.size() - 1);
  return first == none ? nullptr : &lines_[first];
}

bool NearConstraints::any_violated(Vec2 v) {
  const auto is_violated = [v](const Constraint& c) { return violates(c.half_plane, v); };
  if (std::any_of(lines_.begin(), lines_.end(), is_violated)) return true;
  const Asked asked(v, from_);
  while (StaticField::Candidate* next = next_for(asked, reach_))
    if (const Constraint* built = build(*next); built && is_violated(*built)) return true;
  return false;
}

const Constraint* NearConstraints::of_body(vo::BodyTable::Number body) {
  for (StaticField::Candidate& c : candidates_)
    if (c.body == body && !c.is_built) build(c);
  const auto found = std::find_if(lines_.begin(), lines_.end(), [&](const Constraint& c) { return c.body == body; });
  return found == lines_.end() ? nullptr : &*found;
}

}  // namespace exactvo::formation::detail
