// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering.h"

#include <algorithm>
#include <cmath>

namespace exactvo::formation::detail {
namespace {

using geometry::dot;
using geometry::norm;

constexpr double kPi = 3.14159265358979323846;

double angle_of(Vec2 v) {
  return std::atan2(v.y, v.x);
}
Vec2 at_angle(double angle, double length) {
  return {length * std::cos(angle), length * std::sin(angle)};
}

/// In [0, 2 pi).
double wrapped(double angle) {
  const double w = std::fmod(angle, 2.0 * kPi);
  return w < 0.0 ? w + 2.0 * kPi : w;
}

/// rad: a direction is taken just inside the half-plane that stopped the turn, so that it counts as allowed.
constexpr double kInside = 1e-9;

/// The half-angle round a line's normal in which a velocity of `speed` satisfies it; negative where none does.
double allowed_half_angle(const geometry::HalfPlane& h, double speed) {
  const double ratio = h.offset / (speed * norm(h.normal));
  if (ratio >= 1.0) return -1.0;
  return ratio <= -1.0 ? kPi : std::acos(ratio);
}

bool violates(const geometry::HalfPlane& h, Vec2 v) {
  // A velocity that lies on the line up to rounding moves along it.
  constexpr double kOnLine = 1e-12;
  return h.offset - dot(h.normal, v) > kOnLine * (1.0 + norm(v));
}

}  // namespace

bool blocked(const std::vector<StaticConstraint>& lines, Vec2 v) {
  return std::any_of(lines.begin(), lines.end(), [v](const auto& c) { return violates(c.recorded.half_plane, v); });
}

std::optional<Sweep> sweep(const std::vector<StaticConstraint>& lines, Vec2 start, double side, double speed) {
  Sweep out;
  const double first = angle_of(start);
  // Each turn enters one line's allowed arc; after a full circle there is none.
  while (out.rotation < 2.0 * kPi) {
    const double angle = first + side * out.rotation;
    out.velocity = at_angle(angle, speed);
    bool turned = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const geometry::HalfPlane& h = lines[i].recorded.half_plane;
      if (!violates(h, out.velocity)) continue;
      const double half = allowed_half_angle(h, speed);
      if (half < 0.0) return std::nullopt;
      const double entry = angle_of(h.normal) - side * half;
      out.rotation += wrapped(side * (entry - angle)) + kInside;
      out.last = i;
      turned = true;
      break;
    }
    if (!turned) return out;
  }
  return std::nullopt;
}

std::optional<Vec2> boosted(const std::vector<StaticConstraint>& lines, Vec2 v) {
  const StaticConstraint* worst = nullptr;
  double most = 0.0;
  for (const StaticConstraint& c : lines) {
    const double by = geometry::violation(c.recorded.half_plane, v) / norm(c.recorded.half_plane.normal);
    if (!(by > most)) continue;
    most = by;
    worst = &c;
  }
  if (!worst || !worst->trap_free) return std::nullopt;
  const geometry::HalfPlane& h = worst->recorded.half_plane;
  const double speed = norm(v);
  const double half = allowed_half_angle(h, speed);
  if (half < 0.0) return std::nullopt;
  // Left of v is the larger angle; a tie (v straight against the line) goes left.
  const double side = geometry::cross(h.normal, v) <= 0.0 ? 1.0 : -1.0;
  return at_angle(angle_of(h.normal) - side * half, speed);
}

// --- Following
// -------------------------------------------------------------------------------------------------------------

namespace {

/// A robot stalls when for this long its distance to the goal has shrunk by less than the share of what full speed
/// would do.
constexpr double kStallTime = 1.0;      // s
constexpr double kStallProgress = 0.1;  // of max_speed * kStallTime
/// Following ends this much nearer to the goal than it began.
constexpr double kLeaveGain = 0.05;  // m
/// Walked at least this far and back within reach of where it began: a full circle.
constexpr double kCircleReach = 0.5;  // m

}  // namespace

void Follower::reset() {
  *this = Follower{};
}

bool Follower::stalled(double time, double goal_distance, double max_speed) {
  const double step = kStallProgress * kStallTime * max_speed;
  if (best_distance_ < 0.0 || goal_distance < best_distance_ - step) {
    best_distance_ = goal_distance;
    best_time_ = time;
  }
  return time - best_time_ > kStallTime;
}

Follower::Answer Follower::steer(double time, Vec2 position, Vec2 goal, double max_speed, Vec2 preferred,
                                 const std::vector<StaticConstraint>& lines) {
  const double goal_distance = norm(goal - position);
  const bool direct_blocked = blocked(lines, preferred);
  if (following_) {
    walked_ += norm(position - last_position_);
    last_position_ = position;
    if (!direct_blocked && goal_distance < hit_distance_ - kLeaveGain) {
      reset();
      stalled(time, goal_distance, max_speed);
      return {preferred, Mode::direct, 0, "left the boundary: nearer to the goal than where it was met, and unblocked"};
    }
    return follow(position, max_speed, preferred, lines);
  }
  if (!stalled(time, goal_distance, max_speed) || !direct_blocked) return {preferred, Mode::direct, 0, ""};
  return begin(time, position, goal_distance, preferred, max_speed, lines);
}

Follower::Answer Follower::begin(double, Vec2 position, double goal_distance, Vec2 preferred, double max_speed,
                                 const std::vector<StaticConstraint>& lines) {
  const std::optional<Sweep> left = sweep(lines, preferred, 1.0, max_speed);
  const std::optional<Sweep> right = sweep(lines, preferred, -1.0, max_speed);
  if (!left && !right) return {preferred, Mode::direct, 0, ""};
  constexpr double kTie = 1e-6;  // rad: symmetric scenes differ by rounding only
  const bool go_left = left && (!right || left->rotation <= right->rotation + kTie);
  const Sweep& chosen = go_left ? *left : *right;
  following_ = true;
  side_ = go_left ? 1 : -1;
  hit_distance_ = goal_distance;
  hit_ = position;
  last_position_ = position;
  walked_ = 0.0;
  circled_ = false;
  followed_ = lines[chosen.last].recorded;
  return {chosen.velocity, Mode::following, side_,
          std::string("stalled: follows the boundary, turning ") + (go_left ? "left" : "right")};
}

Follower::Answer Follower::follow(Vec2 position, double max_speed, Vec2 preferred,
                                  const std::vector<StaticConstraint>& lines) {
  Answer answer{preferred, Mode::following, side_, ""};
  // Start the turn at the followed shape itself, so that the boundary is hugged round its corners.
  Vec2 start = preferred;
  for (const StaticConstraint& c : lines) {
    if (!followed_ || c.recorded.index != followed_->index) continue;
    start = -c.away;
    break;
  }
  for (double speed = max_speed; speed > 0.05 * max_speed; speed *= 0.5) {
    const std::optional<Sweep> found = sweep(lines, start, side_, speed);
    if (!found) continue;
    answer.preferred = found->velocity;
    if (found->last != Sweep::kNone) followed_ = lines[found->last].recorded;
    break;
  }
  if (!circled_ && walked_ > 4.0 * kCircleReach && norm(position - hit_) < kCircleReach) {
    circled_ = true;
    answer.note = "came full circle: no way to the goal along this boundary";
  }
  return answer;
}

// --- Side commitment
// -------------------------------------------------------------------------------------------------------

SideCommitment::Answer SideCommitment::steer(Vec2 preferred, double speed, const std::vector<StaticConstraint>& lines) {
  if (!blocked(lines, preferred)) {
    side_ = 0;
    return {preferred, 0};
  }
  const std::optional<Sweep> left = sweep(lines, preferred, 1.0, speed);
  const std::optional<Sweep> right = sweep(lines, preferred, -1.0, speed);
  if (side_ == 0) {
    if (!left && !right) return {preferred, 0};
    side_ = left && (!right || left->rotation <= right->rotation) ? 1 : -1;
  }
  const std::optional<Sweep>& kept = side_ > 0 ? left : right;
  return {kept ? kept->velocity : preferred, side_};
}

}  // namespace exactvo::formation::detail
