// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/monitor.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "monitor/arguments.h"
#include "monitor/rounding.h"

namespace exactvo::formation {

using geometry::norm;
using geometry::Pose;
using geometry::Twist;
using monitored::kUp;

namespace {

/// How often the share is halved beside movers.
constexpr int kHalvings = 14;

/// Appends corners, seen from the first.
template <class Set>
void append(const std::vector<Vec2>& hull, std::vector<Vec2>& corners, Set& set) {
  set.at = hull.front();
  set.first = static_cast<std::uint32_t>(corners.size());
  set.size = static_cast<std::uint32_t>(hull.size());
  for (const Vec2 v : hull) corners.push_back(v - hull.front());
}

}  // namespace

const char* name(MonitorProblem problem) {
  static constexpr const char* kNames[] = {"not-finite", "out-of-range", "no-trajectory"};
  return kNames[static_cast<std::size_t>(problem)];
}

Monitor::Monitor(const MonitorSetup& setup) : setup_(setup) {
  monitored::require_setup(setup);
  for (std::size_t k = 0; k < setup.footprint.size(); ++k) {
    const double radius = setup.footprint[k].radius;
    const std::vector<Vec2> hull = monitored::hull_of_part(setup.footprint[k], k);
    parts_.push_back(
        {static_cast<std::uint32_t>(part_corners_.size()), static_cast<std::uint32_t>(hull.size()), radius});
    part_reach_ = std::max(part_reach_, (radius + setup.margin + 2.0 * kMonitorSlack) * kUp);
    for (const Vec2 v : hull) body_reach_ = std::max(body_reach_, (norm(v) + radius) * kUp);
    part_corners_.insert(part_corners_.end(), hull.begin(), hull.end());
  }
  turned_ = part_corners_;
  body_reach_ += setup.margin + kMonitorSlack;
  std::vector<geometry::Box> boxes;
  const auto add = [&](const std::vector<Vec2>& hull, double radius, std::size_t obstacle) {
    Piece piece;
    piece.radius = radius;
    piece.obstacle = static_cast<std::uint32_t>(obstacle);
    append(hull, corners_, piece);
    pieces_.push_back(piece);
    geometry::Box box;
    for (const Vec2 v : hull) box.add(v);
    boxes.push_back(box.grown(radius * kUp));
  };
  for (std::size_t k = 0; k < setup.obstacles.size(); ++k) {
    const SceneObstacle& obstacle = setup.obstacles[k];
    if (obstacle.disc) {
      monitored::require_place(obstacle.disc->center, {"", "obstacles", k});
      monitored::require_within(obstacle.disc->radius, 0.0, {"radius", "obstacles", k});
      add({obstacle.disc->center}, obstacle.disc->radius, k);
      continue;
    }
    for (const std::vector<Vec2>& hull : monitored::convex_pieces(obstacle, k)) add(hull, 0.0, k);
  }
  grid_ = geometry::BoxGrid(std::move(boxes));
  setup_.obstacles.clear();
}

// --- The way ---

double Monitor::Pace::moment(double way) const {
  if (way <= held) return way / pace;
  // way - held = pace (u - u^2 / (2 B)) after u s of braking, which lasts B = 2 braked / pace. Near rest the root makes
  // much of a rounding, so that what is left is rounded down before it.
  const double gone = (way - held) / braked;
  const double left = std::max(0.0, 1.0 - gone - 0x1p-50 * (1.0 + way / braked));
  return (held / pace + 2.0 * braked / pace * (1.0 - std::sqrt(left))) * kUp;
}

Monitor::Pace Monitor::pace_at(double share) const {
  if (is_trajectory_) return {1.0, share * held_ + setup_.latency, 0.5 * brake_time_};
  return {share, share * held_, 0.5 * share * share * brake_time_};
}

/// The largest share whose way is no longer than `length`. Rounded.
double Monitor::share_within(double length) const {
  if (is_trajectory_) {
    const double left = length - (setup_.latency + 0.5 * brake_time_);
    return held_ > 0.0 ? std::clamp(left / held_, 0.0, 1.0) : 0.0;
  }
  const double root = held_ + std::sqrt(held_ * held_ + 2.0 * brake_time_ * length);
  return root > 0.0 ? std::clamp(2.0 * length / root, 0.0, 1.0) : 1.0;
}

double Monitor::braking_time(const Twist& twist) const {
  return std::max(norm(twist.velocity) / setup_.max_deceleration * kUp,
                  std::fabs(twist.turn) / setup_.max_turn_deceleration * kUp);
}

/// Throws before anything changes.
void Monitor::set_way_of(const std::vector<TimedPose>& trajectory) {
  double brake_time = 0.0;
  next_way_.clear();
  Twist last;
  for (std::size_t k = 1; k < trajectory.size(); ++k) {
    const TimedPose &from = trajectory[k - 1], &to = trajectory[k];
    last = geometry::twist_between(from.pose, to.pose, to.time - from.time);
    if (!(std::max(norm(last.velocity), std::fabs(last.turn)) < monitored::kMostSize))
      monitored::refuse(
          MonitorProblem::out_of_range, {"", "trajectory", k},
          monitored::digits_of(norm(last.velocity)) + " m/s, " + monitored::digits_of(last.turn) + " rad/s",
          "a speed and a turn rate of less than 2^30");
    brake_time = std::max(brake_time, braking_time(last));
    next_way_.push_back(
        {from.pose, {geometry::rotated(last.velocity, from.pose.heading), last.turn}, to.time - from.time});
  }
  way_.swap(next_way_);
  brake_time_ = brake_time;
  held_ = trajectory.back().time - trajectory.front().time;
  // Beyond its end, the trajectory goes on as it did at last.
  const Pose& end = trajectory.back().pose;
  way_.push_back({end,
                  {geometry::rotated(last.velocity, end.heading), last.turn},
                  (setup_.latency + 0.5 * brake_time_) * kUp + 0x1p-40 * held_});
  is_trajectory_ = true;
}

std::vector<MonitorArc> Monitor::way(double share) const {
  std::vector<MonitorArc> arcs;
  const double length = way_.empty() ? 0.0 : pace_at(share).length();
  double offset = 0.0;
  for (const Stretch& stretch : way_) {
    const double end = std::min(offset + stretch.duration, length);
    if (!(offset < end || arcs.empty())) break;
    arcs.push_back({{offset, end, stretch.start.at, stretch.twist}, stretch.start.heading});
    offset += stretch.duration;
  }
  return arcs;
}

// --- The verdict ---

MonitorVerdict Monitor::judge(const Pose& pose, const Command& command, const std::vector<Mover>& movers) {
  monitored::require_command(pose, command);
  monitored::require_movers(movers);
  see(movers);
  brake_time_ = braking_time(command.twist);
  held_ = setup_.period + setup_.latency;
  is_trajectory_ = false;
  way_.clear();
  Twist in_world = command.twist;
  if (!command.in_world_axes) in_world.velocity = geometry::rotated(command.twist.velocity, pose.heading);
  way_.push_back({pose, in_world, pace_at(1.0).length()});
  return judged();
}

MonitorVerdict Monitor::judge(const std::vector<TimedPose>& trajectory, const std::vector<Mover>& movers) {
  monitored::require_trajectory(trajectory);
  monitored::require_movers(movers);
  set_way_of(trajectory);
  see(movers);
  return judged();
}

void Monitor::see(const std::vector<Mover>& movers) {
  movers_.clear();
  mover_corners_.clear();
  for (const Mover& mover : movers) {
    SeenMover seen;
    seen.radius = mover.shape.radius;
    seen.max_speed = mover.max_speed;
    seen.position_error = mover.position_error;
    const std::vector<Vec2>& corners = mover.shape.corners;
    if (corners.size() == 1)
      append(corners, mover_corners_, seen);
    else
      append(geometry::convex_hull(corners).vertices, mover_corners_, seen);
    movers_.push_back(seen);
  }
}

MonitorVerdict Monitor::judged() {
  contacts_.clear();
  first_mover_ = 0;
  MonitorVerdict verdict = judged_beside_obstacles();
  if (is_clear_of_movers(verdict.share, verdict)) return verdict;
  if (is_clear_of_movers(0.0, verdict)) return halved(verdict);
  verdict.share = 0.0;
  verdict.proven = false;
  return verdict;
}

/// As far as what stands still is concerned.
MonitorVerdict Monitor::judged_beside_obstacles() {
  MonitorVerdict verdict;
  const Pace full = pace_at(1.0);
  Clear clear = clear_of_obstacles(full.length(), verdict.in_contact);
  if (!clear.witness) {
    verdict.share = 1.0;
    return verdict;
  }
  // A few roundings of lengths that are added up.
  verdict.share = std::max(0.0, share_within(clear.until) * monitored::kDown - 0x1p-48);
  verdict.proven = !is_trajectory_ || clear.until >= pace_at(0.0).length() * kUp;
  if (clear.lost_by < geometry::kInfinity)
    verdict.not_above = std::min(1.0, share_within(clear.lost_by) * kUp + 0x1p-48);
  clear.witness->time = full.moment(clear.until);
  verdict.witness = clear.witness;
  return verdict;
}

/// The mover that is met becomes the witness.
bool Monitor::is_clear_of_movers(double share, MonitorVerdict& verdict) {
  // A robot that stands is promised nothing.
  if (!is_trajectory_ && (share == 0.0 || brake_time_ == 0.0)) return true;
  const Pace pace = pace_at(share);
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    const std::size_t index = (first_mover_ + k) % movers_.size();
    if (is_far_from(movers_[index], pace) || clear_of_mover(index, pace, verdict)) continue;
    first_mover_ = index;
    return false;
  }
  return true;
}

/// A smaller share that is clear of movers, found between 0 and the verdict's by halving.
MonitorVerdict Monitor::halved(MonitorVerdict verdict) {
  double low = 0.0, high = verdict.share;
  MonitorWitness witness = *verdict.witness;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    if (is_clear_of_movers(middle, verdict)) {
      low = middle;
    } else {
      high = middle;
      witness = *verdict.witness;
    }
  }
  verdict.share = low;
  verdict.witness = witness;
  return verdict;
}

}  // namespace exactvo::formation
