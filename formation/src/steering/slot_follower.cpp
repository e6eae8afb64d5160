// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/slot_follower.h"

namespace exactvo::formation::detail {
namespace {

/// A robot stalls when for this long it has come nearer by less than the share of what its pace would do.
constexpr double kSlotStallTime = 2.0;      // s: a pair that passes each other may need one
constexpr double kSlotStallProgress = 0.1;  // of pace * kSlotStallTime
/// Going round ends this much nearer than it began.
constexpr double kSlotLeaveGain = 0.05;  // m
/// Where no direction is free at full speed, slower ones are tried, halving, down to this share.
constexpr double kLeastShare = 0.1;

/// Robots as walls: those that the turn has to respect.
std::vector<Constraint> all_lines(const std::vector<Constraint>& statics, const std::vector<Constraint>& others) {
  std::vector<Constraint> lines = statics;
  lines.insert(lines.end(), others.begin(), others.end());
  return lines;
}

}  // namespace

bool SlotFollower::stalled(const Situation& s) {
  if (best_distance_ < 0.0 || s.distance < best_distance_ - kSlotStallProgress * kSlotStallTime * s.pace) {
    best_distance_ = s.distance;
    best_time_ = s.time;
  }
  return s.time - best_time_ > kSlotStallTime && s.distance > s.tolerance;
}

SlotFollower::Answer SlotFollower::steer(const Situation& s, const std::vector<Constraint>& statics,
                                         const std::vector<Constraint>& others) {
  Answer answer{s.preferred, Mode::direct, 0, ""};
  if (!s.target_rests) {
    *this = SlotFollower{};
    return answer;
  }
  if (!following_ && !stalled(s)) return answer;
  const std::vector<Constraint> lines = all_lines(statics, others);
  const bool free = !blocked(lines, s.preferred);
  if (following_ && free && s.distance < hit_distance_ - kSlotLeaveGain) {
    *this = SlotFollower{};
    stalled(s);  // progress counts from here
    answer.note = "past the robots that stood in the way";
    return answer;
  }
  if (!following_) {
    // A wall in the way is the side commitment's business.
    if (free || blocked(statics, s.preferred)) return answer;
    following_ = true;
    side_ = 1;
    hit_distance_ = s.distance;
    answer.note = "stalled among robots: goes round, turning left";
  }
  for (double speed = norm(s.preferred); speed > kLeastShare * norm(s.preferred); speed *= 0.5) {
    const std::optional<Sweep> found = sweep(lines, s.preferred, side_, speed);
    if (!found) continue;
    answer.preferred = found->velocity;
    break;
  }
  answer.mode = Mode::following;
  answer.side = side_;
  return answer;
}

}  // namespace exactvo::formation::detail
