// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/steering.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "exactvo/geometry/pi.h"

namespace exactvo::formation::detail {
namespace {

using geometry::kPi;

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

/// The same for any lines that say which is the first that a velocity violates.
template <class FirstViolated>
std::optional<Sweep> swept(const FirstViolated& first_violated, Vec2 start, double side, double speed) {
  Sweep out;
  const double first = angle_of(start);
  // Each turn enters one line's allowed arc; after a full circle there is none.
  while (out.rotation < 2.0 * kPi) {
    const double angle = first + side * out.rotation;
    out.velocity = at_angle(angle, speed);
    const Constraint* met = first_violated(out.velocity);
    if (!met) return out;
    const geometry::HalfPlane& h = met->half_plane;
    const double half = allowed_half_angle(h, speed);
    if (half < 0.0) return std::nullopt;
    const double entry = angle_of(h.normal) - side * half;
    out.rotation += wrapped(side * (entry - angle)) + kInside;
    out.last = met->body;
  }
  return std::nullopt;
}

std::optional<Sweep> sweep(NearConstraints& near, Vec2 start, double side, double speed) {
  return swept([&](Vec2 v) { return near.first_violated(v); }, start, side, speed);
}

}  // namespace

bool blocked(const std::vector<Constraint>& lines, Vec2 v) {
  return std::any_of(lines.begin(), lines.end(), [v](const auto& c) { return violates(c.half_plane, v); });
}

std::optional<Sweep> sweep(const std::vector<Constraint>& lines, Vec2 start, double side, double speed) {
  const auto first_violated = [&](Vec2 v) -> const Constraint* {
    const auto met =
        std::find_if(lines.begin(), lines.end(), [&](const Constraint& c) { return violates(c.half_plane, v); });
    return met == lines.end() ? nullptr : &*met;
  };
  return swept(first_violated, start, side, speed);
}

namespace {

const Constraint* most_violated(const std::vector<Constraint>& lines, Vec2 v) {
  const Constraint* worst = nullptr;
  double most = 0.0;
  for (const Constraint& c : lines) {
    const double by = geometry::violation(c.half_plane, v) / norm(c.half_plane.normal);
    if (!(by > most)) continue;
    most = by;
    worst = &c;
  }
  return worst;
}

}  // namespace

std::optional<Vec2> boosted(const std::vector<Constraint>& lines, Vec2 v) {
  const Constraint* worst = most_violated(lines, v);
  if (!worst || !worst->trap_free) return std::nullopt;
  const geometry::HalfPlane& h = worst->half_plane;
  const double speed = norm(v);
  const double half = allowed_half_angle(h, speed);
  if (half < 0.0) return std::nullopt;
  // Left of v is the larger angle; a tie (v straight against the line) goes left.
  const double side = geometry::cross(h.normal, v) <= 0.0 ? 1.0 : -1.0;
  return at_angle(angle_of(h.normal) - side * half, speed);
}

Vec2 with_tie_broken(const std::vector<Constraint>& lines, Vec2 v) {
  const Constraint* worst = most_violated(lines, v);
  return worst ? with_tie_broken(worst->half_plane.normal, v) : v;
}

Vec2 with_tie_broken(Vec2 normal, Vec2 v) {
  const bool is_head_on = std::fabs(geometry::cross(normal, v)) < kTieAngle * norm(normal) * norm(v);
  return is_head_on ? geometry::rotated(v, kTieAngle) : v;
}

// --- Following ---

namespace {

/// A robot stalls when for this long its distance to the goal has shrunk by less than the share of what full speed
/// would do.
constexpr double kStallTime = 1.0;      // moments
constexpr double kStallProgress = 0.1;  // of max_speed * kStallTime
/// Following ends this much nearer to the goal than it began.
constexpr double kLeaveGain = 0.05;  // m
/// Walked at least this far and back within reach of where it began: a full circle.
constexpr double kCircleReach = 0.5;  // m
/// The way is measured in legs of at least this length: the noise of a robot's place adds up to no way.
constexpr double kLeastLeg = 0.25;  // m
/// Where no direction is free at full speed, slower ones are tried, halving, down to this share.
constexpr double kLeastFollowing = 0.05;

}  // namespace

double following_reach(const DecisionRules& rules, double max_speed) {
  return rules.margins.obstacle + kContactSkin + max_speed * rules.horizons.least;
}

void BoundaryFollower::reset() {
  *this = BoundaryFollower{};
}

bool BoundaryFollower::stalled(const Situation& s) {
  const double goal_distance = norm(s.goal - s.robot.position);
  const double stall_time = kStallTime * s.moment, step = kStallProgress * stall_time * s.robot.max_speed;
  if (best_distance_ < 0.0 || goal_distance < best_distance_ - step) {
    best_distance_ = goal_distance;
    best_time_ = s.time;
  }
  return s.time - best_time_ > stall_time;
}

bool BoundaryFollower::may_leave(const Situation& s, NearConstraints& near) const {
  return norm(s.goal - s.robot.position) < hit_distance_ - kLeaveGain && !near.any_violated(s.preferred);
}

BoundaryFollower::Answer BoundaryFollower::steer(const Situation& s, Memory& memory) {
  if (!following_ && !stalled(s)) return {s.preferred};
  NearConstraints& near = memory.near;
  near.forget();
  near.look(*s.field, s.robot, s.reach);
  if (!following_) {
    if (!near.any_violated(s.preferred)) return {s.preferred};
    return begin(s, memory);
  }
  if (!may_leave(s, near)) return follow(s, near);
  reset();
  stalled(s);  // progress counts from here
  return {s.preferred, Mode::direct, 0, {Note::What::left}};
}

void BoundaryFollower::commit(const Situation& s, int side, std::size_t followed) {
  following_ = true;
  side_ = side;
  hit_distance_ = norm(s.goal - s.robot.position);
  hit_ = last_position_ = s.robot.position;
  walked_ = 0.0;
  circled_ = false;
  followed_ = followed;
}

constexpr double kTrialRunHorizon = 60.0;  ///< moments: a boundary longer than that ranks by how far the goal is then

/// One side of a boundary in the static scene alone: the time until it can be left plus the straight way from there.
///
/// Nothing is faster than max_speed. Therefore `time` never falls by more than rounding: while the trial run runs, it
/// is a lower bound of what it will be at the end.
class BoundaryFollower::TrialRun {
 public:
  TrialRun(const BoundaryFollower& actor, const Situation& s, NearConstraints& near)
      : actor_(actor), s_(s), near_(near), start_(s.time) {
    near_.forget();
  }

  bool has_ended() const { return has_ended_; }
  /// s; infinite where the boundary leads round to where it was met.
  double time() const { return time_; }

  void step() {
    if (!(s_.time - start_ < kTrialRunHorizon * s_.moment)) return end();
    const Vec2 to_goal = s_.goal - s_.robot.position;
    s_.preferred = s_.robot.max_speed * geometry::normalized(to_goal);
    near_.look(*s_.field, s_.robot, s_.reach);
    if (actor_.may_leave(s_, near_)) return end();
    s_.robot.velocity = actor_.follow(s_, near_).preferred;
    if (actor_.circled_) {
      has_ended_ = true;
      time_ = std::numeric_limits<double>::infinity();
      return;
    }
    s_.robot.position += s_.time_step * s_.robot.velocity;
    s_.time += s_.time_step;
    time_ = time_from_here();
  }

 private:
  void end() {
    has_ended_ = true;
    time_ = time_from_here();
  }
  double time_from_here() const { return s_.time - start_ + norm(s_.goal - s_.robot.position) / s_.robot.max_speed; }

  BoundaryFollower actor_;
  Situation s_;
  NearConstraints& near_;
  double start_, time_ = 0.0;  ///< s
  bool has_ended_ = false;
};

namespace {

/// "12.3 s".
struct Seconds {
  char text[40];
  explicit Seconds(double t) {
    if (std::isfinite(t))
      std::snprintf(text, sizeof text, "%.1f s", t);
    else
      std::snprintf(text, sizeof text, "no end");
  }
};

/// s: by how much the time of a trial run can fall by rounding.
///
/// A step rounds a velocity and its length (8 u of max_speed), a position and the distance to the goal (8 u of the
/// largest coordinate) and a time (4 u). The bound leaves a factor of two, and is never less than a millionth of a
/// moment.
double trial_run_rounding(const BoundaryFollower::Situation& s) {
  constexpr double kUnit = 0x1p-53, kLeast = 1e-6;
  const double fastest = s.robot.max_speed, horizon = kTrialRunHorizon * s.moment;
  const double farthest =
      std::max(largest_coordinate(s.robot.position), largest_coordinate(s.goal)) + fastest * horizon;
  const double steps = horizon / s.time_step + 2.0;
  const double a_step = kUnit * (8.0 * s.time_step + 8.0 * farthest / fastest + 4.0 * (s.time + horizon));
  return std::max(kLeast * s.moment, 2.0 * steps * a_step);
}

/// Whether the left is taken: within a time step of the right or faster. Steps the side that may be faster. Stops when
/// one side has ended and the other is later by more than rounding: the end of the other would not change the answer.
template <class TrialRun>
bool left_is_better(TrialRun& left, TrialRun& right, double time_step, double rounding) {
  for (;;) {
    if (left.has_ended() && right.has_ended()) return left.time() <= right.time() + time_step;
    if (left.has_ended() && right.time() + time_step > left.time() + rounding) return true;
    if (right.has_ended() && left.time() > right.time() + time_step + rounding) return false;
    const bool take_left = right.has_ended() || (!left.has_ended() && left.time() <= right.time());
    (take_left ? left : right).step();
  }
}

}  // namespace

/// "... turning left (12.3 s to go that way, 15.1 s the other)"; of one that was not run to its end "at least
/// 12.4 s".
void BoundaryFollower::Note::add_to(std::string& note) const {
  char text[240];
  switch (what) {
    case What::nothing:
      return;
    case What::left:
      return add_note(note, "left the boundary: nearer to the goal than where it was met, and unblocked");
    case What::circled:
      return add_note(note, "completed a full circuit: no way to the goal along this boundary");
    case What::follows:
      std::snprintf(text, sizeof text, "stalled: follows the boundary, turning %s (%s to go that way, %s%s the other)",
                    is_left ? "left" : "right", Seconds(taken).text, other_is_at_least ? "at least " : "",
                    Seconds(other_is_at_least ? std::floor(10.0 * other) / 10.0 : other).text);
      return add_note(note, text);
  }
}

BoundaryFollower::Answer BoundaryFollower::begin(const Situation& s, Memory& memory) {
  NearConstraints& near = memory.near;
  const std::optional<Sweep> left = sweep(near, s.preferred, 1.0, s.robot.max_speed);
  const std::optional<Sweep> right = sweep(near, s.preferred, -1.0, s.robot.max_speed);
  // At full speed nothing may stand in the way of what a slower preference violates: then there is no boundary.
  const bool met = left && right && left->last != Sweep::kNone && right->last != Sweep::kNone;
  if (!met) return {s.preferred};
  BoundaryFollower to_left, to_right;
  to_left.commit(s, 1, left->last);
  to_right.commit(s, -1, right->last);
  TrialRun on_left(to_left, s, memory.on_left), on_right(to_right, s, memory.on_right);
  const bool go_left = left_is_better(on_left, on_right, s.time_step, trial_run_rounding(s));
  *this = go_left ? to_left : to_right;
  const TrialRun &taken = go_left ? on_left : on_right, &other = go_left ? on_right : on_left;
  return {(go_left ? left : right)->velocity,
          Mode::following,
          side_,
          {Note::What::follows, go_left, taken.time(), other.time(), !other.has_ended()}};
}

BoundaryFollower::Answer BoundaryFollower::follow(const Situation& s, NearConstraints& near) {
  if (const double leg = norm(s.robot.position - last_position_); leg >= kLeastLeg) {
    walked_ += leg;
    last_position_ = s.robot.position;
  }
  Answer answer{s.preferred, Mode::following, side_};
  // Start the turn at the followed shape itself, so that the boundary is hugged round its corners.
  const Constraint* followed = near.of_body(followed_);
  const Vec2 start = followed ? -followed->normal : s.preferred;
  for (double speed = s.robot.max_speed; speed > kLeastFollowing * s.robot.max_speed; speed *= 0.5) {
    const std::optional<Sweep> found = sweep(near, start, side_, speed);
    if (!found) continue;
    answer.preferred = found->velocity;
    if (found->last != Sweep::kNone) followed_ = found->last;
    break;
  }
  if (!circled_ && walked_ > 4.0 * kCircleReach && norm(s.robot.position - hit_) < kCircleReach) {
    circled_ = true;
    answer.note.what = Note::What::circled;
  }
  return answer;
}

// --- Side commitment ---

SideCommitment::Answer SideCommitment::steer(Vec2 preferred, double speed, NeededConstraints& statics) {
  statics.need_at(preferred);
  const std::vector<Constraint>& lines = statics.lines();
  if (!blocked(lines, preferred)) {
    const bool kept_one = side_ != 0;
    side_ = 0;
    return {preferred, 0, kept_one ? "free again: the side is given up" : ""};
  }
  statics.need_all();  // a turn may meet any
  const std::optional<Sweep> left = sweep(lines, preferred, 1.0, speed);
  const std::optional<Sweep> right = sweep(lines, preferred, -1.0, speed);
  std::string note;
  if (side_ == 0) {
    if (!left && !right) return {preferred, 0, ""};
    side_ = left && (!right || left->rotation <= right->rotation) ? 1 : -1;
    const bool tie = left && right && left->rotation == right->rotation;
    note = std::string("blocked: keeps ") + (side_ > 0 ? "left" : "right") + (tie ? ", a tie" : ", the smaller turn");
  }
  const std::optional<Sweep>& kept = side_ > 0 ? left : right;
  return {kept ? kept->velocity : preferred, side_, note};
}

}  // namespace exactvo::formation::detail
