// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/robot_bypass.h"

namespace exactvo::formation::detail {
namespace {

/// A robot stalls when for this long it has come nearer by less than the share of what its pace would do.
constexpr double kSlotStallTime = 2.0;      // moments: a pair that passes each other may need one
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

bool RobotBypass::stalled(const Situation& s) {
  const double stall_time = kSlotStallTime * s.moment;
  if (best_distance_ < 0.0 || s.distance < best_distance_ - kSlotStallProgress * stall_time * s.pace) {
    best_distance_ = s.distance;
    best_time_ = s.time;
  }
  return s.time - best_time_ > stall_time && s.distance > s.tolerance;
}

std::optional<Vec2> RobotBypass::steer(const Situation& s, NeededConstraints& statics,
                                       const std::vector<Constraint>& others, std::string& note) {
  if (!s.target_rests) *this = RobotBypass{};
  if (!s.target_rests || (!goes_round_ && !stalled(s))) return std::nullopt;
  statics.need_all();
  const std::vector<Constraint> lines = all_lines(statics.lines(), others);
  const bool free = !blocked(lines, s.preferred);
  if (goes_round_ && free && s.distance < hit_distance_ - kSlotLeaveGain) {
    *this = RobotBypass{};
    stalled(s);  // progress counts from here
    add_note(note, "past the robots that stood in the way");
    return std::nullopt;
  }
  if (!goes_round_) {
    // A wall in the way is the side commitment's business.
    if (free || blocked(statics.lines(), s.preferred)) return std::nullopt;
    goes_round_ = true;
    hit_distance_ = s.distance;
    add_note(note, "stalled among robots: goes round, turning left");
  }
  for (double speed = norm(s.preferred); speed > kLeastShare * norm(s.preferred); speed *= 0.5)
    if (const std::optional<Sweep> found = sweep(lines, s.preferred, kSide, speed)) return found->velocity;
  return s.preferred;
}

}  // namespace exactvo::formation::detail
