// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/validity.h"
#include "scene/number_text.h"

namespace exactvo::formation {
namespace {

using geometry::CornerView;
using geometry::Displacement;
using geometry::GapToKeep;
using geometry::KeptGap;
using geometry::kInfinity;
using geometry::norm;
using geometry::Pose;
using geometry::Twist;
using geometry::Vec2;

/// m, m/s, rad/s, s: products of two are far inside the range of doubles, and a difference keeps a micrometre.
constexpr double kMostSize = 0x1p30;
/// m/s^2, rad/s^2: with it the time to brake stays as far inside the range.
constexpr double kLeastDeceleration = 0x1p-30;
/// More than the few roundings of a formula of quotients and roots.
constexpr double kDown = 1.0 - 0x1p-48, kUp = 1.0 + 0x1p-48;
/// While the robot brakes, its way is looked at in as many parts: in each, time is bounded by a chord.
constexpr int kBrakingParts = 4;
/// How often the share is halved beside movers.
constexpr int kHalvings = 14;

std::string digits_of(double x) {
  return detail::number_text(x, 17);
}
std::string digits_of(Vec2 v) {
  return digits_of(v.x) + ", " + digits_of(v.y);
}

[[noreturn]] void refuse_argument(MonitorProblem problem, const std::string& field, const std::string& found,
                                  const std::string& expected) {
  throw MonitorError(problem, field + ": found " + found + ", expected " + expected);
}

void require_within(double x, double least, const char* field) {
  if (!std::isfinite(x)) refuse_argument(MonitorProblem::not_finite, field, digits_of(x), "a finite number");
  if (!(x >= least && x < kMostSize))
    refuse_argument(MonitorProblem::out_of_range, field, digits_of(x),
                    "a number of at least " + digits_of(least) + " and less than 2^30");
}

void require_place(Vec2 v, const char* field) {
  if (!geometry::is_finite(v)) refuse_argument(MonitorProblem::not_finite, field, digits_of(v), "two finite numbers");
  if (!(std::max(std::fabs(v.x), std::fabs(v.y)) < kMostSize))
    refuse_argument(MonitorProblem::out_of_range, field, digits_of(v), "less than 2^30");
}

/// The corners of the hull, once round it.
std::vector<Vec2> hull_of_part(const geometry::RoundedPolygon& part, const char* field) {
  if (part.corners.empty()) refuse_argument(MonitorProblem::out_of_range, field, "no corners", "at least one");
  for (const Vec2 v : part.corners) require_place(v, field);
  require_within(part.radius, 0.0, field);
  return geometry::convex_hull(part.corners).vertices;
}

geometry::Obstacle valid_shape(const SceneObstacle& obstacle) {
  for (const Vec2 v : geometry::vertices_of(obstacle.shape)) require_place(v, "obstacle");
  if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape)) {
    if (wall->points.size() < 2)
      refuse_argument(MonitorProblem::out_of_range, "obstacle", "a wall of one point", "at least two");
    return *wall;
  }
  const auto& polygon = std::get<geometry::Polygon>(obstacle.shape);
  std::vector<geometry::Ring> rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  geometry::NormalizedPolygon normalized = geometry::normalize(rings);
  if (!normalized.ok())
    refuse_argument(MonitorProblem::out_of_range, "obstacle", code_name(normalized.problems.front().code),
                    "a valid polygon");
  return std::move(normalized.polygon);
}

}  // namespace

const char* name(MonitorProblem problem) {
  static constexpr const char* kNames[] = {"not-finite", "out-of-range", "no-trajectory"};
  return kNames[static_cast<std::size_t>(problem)];
}

Monitor::Monitor(const MonitorSetup& setup) : setup_(setup) {
  require_within(setup.max_deceleration, kLeastDeceleration, "max_deceleration");
  require_within(setup.max_turn_deceleration, kLeastDeceleration, "max_turn_deceleration");
  require_within(setup.latency, 0.0, "latency");
  require_within(setup.period, 0.0, "period");
  require_within(setup.margin, 0.0, "margin");
  if (setup.footprint.empty()) refuse_argument(MonitorProblem::out_of_range, "footprint", "no parts", "at least one");
  for (const geometry::RoundedPolygon& part : setup.footprint) {
    const std::vector<Vec2> hull = hull_of_part(part, "footprint");
    if (part.radius == 0.0 && hull.size() < 3)
      refuse_argument(MonitorProblem::out_of_range, "footprint", "a part without an area",
                      "a radius above 0, or an area");
    parts_.push_back(
        {static_cast<std::uint32_t>(part_corners_.size()), static_cast<std::uint32_t>(hull.size()), part.radius});
    for (const Vec2 v : hull) body_reach_ = std::max(body_reach_, (norm(v) + part.radius) * kUp);
    part_corners_.insert(part_corners_.end(), hull.begin(), hull.end());
  }
  turned_ = part_corners_;
  body_reach_ += setup.margin + kMonitorSlack;
  std::vector<geometry::Box> boxes;
  const auto add = [&](const std::vector<Vec2>& hull, double radius, std::size_t obstacle) {
    pieces_.push_back({static_cast<std::uint32_t>(corners_.size()), static_cast<std::uint32_t>(hull.size()),
                       static_cast<std::uint32_t>(obstacle), radius});
    corners_.insert(corners_.end(), hull.begin(), hull.end());
    geometry::Box box;
    for (const Vec2 v : hull) box.add(v);
    boxes.push_back(box.grown(radius * kUp));
  };
  for (std::size_t k = 0; k < setup.obstacles.size(); ++k) {
    const SceneObstacle& obstacle = setup.obstacles[k];
    if (obstacle.disc) {
      require_place(obstacle.disc->center, "obstacle");
      require_within(obstacle.disc->radius, 0.0, "obstacle");
      add({obstacle.disc->center}, obstacle.disc->radius, k);
      continue;
    }
    for (const geometry::ConvexShape& piece : geometry::convex_cover(valid_shape(obstacle)))
      add(geometry::corners_of(piece), 0.0, k);
  }
  grid_ = geometry::BoxGrid(std::move(boxes));
  setup_.obstacles.clear();
}

double Monitor::Pace::moment(double way) const {
  if (way <= held) return way / pace;
  // way - held = pace (u - u^2 / (2 B)) after u s of braking, which lasts B = 2 braked / pace. Near rest the root makes
  // much of a rounding, so that what is left is rounded down before it.
  const double gone = (way - held) / braked;
  const double left = std::max(0.0, 1.0 - gone - 0x1p-50 * (1.0 + way / braked));
  return (held / pace + 2.0 * braked / pace * (1.0 - std::sqrt(left))) * kUp;
}

Monitor::Pace Monitor::pace_at(double share, bool is_trajectory) const {
  if (is_trajectory) return {1.0, share * held_ + setup_.latency, 0.5 * brake_time_};
  return {share, share * held_, 0.5 * share * share * brake_time_};
}

/// The largest share whose way is no longer than `length`. Rounded.
double Monitor::share_within(double length, bool is_trajectory) const {
  if (is_trajectory) {
    const double left = length - (setup_.latency + 0.5 * brake_time_);
    return held_ > 0.0 ? std::clamp(left / held_, 0.0, 1.0) : 0.0;
  }
  const double root = held_ + std::sqrt(held_ * held_ + 2.0 * brake_time_ * length);
  return root > 0.0 ? std::clamp(2.0 * length / root, 0.0, 1.0) : 1.0;
}

void Monitor::turn_footprint(double heading) {
  const double c = std::cos(heading), s = std::sin(heading);
  for (std::size_t i = 0; i < turned_.size(); ++i)
    turned_[i] = {c * part_corners_[i].x - s * part_corners_[i].y, s * part_corners_[i].x + c * part_corners_[i].y};
}

void Monitor::turn_footprint(const Stretch& stretch, double time) {
  turn_footprint(stretch.start.heading);
  if (time == 0.0) return;
  const Displacement d = geometry::displacement_after(stretch.twist, time);
  for (Vec2& corner : turned_) corner = d.turned(corner);
}

/// A part of the footprint, as it stands turned, that goes on along a stretch from a moment on.
geometry::ConvexOnTwist Monitor::part_on(const Part& part, const Stretch& stretch, double time) const {
  const CornerView corners{turned_.data() + part.first, part.size};
  if (time == 0.0) return {stretch.start.at, stretch.twist, corners};
  const Displacement d = geometry::displacement_after(stretch.twist, time);
  return {stretch.start.at + d.by, {d.turned(stretch.twist.velocity), stretch.twist.turn}, corners};
}

double Monitor::gap_as_it_begins(const Stretch& stretch, const Part& part, const geometry::ConvexOnTwist& other,
                                 double reach) {
  turn_footprint(stretch, 0.0);
  return keeper_.gap_at({part_on(part, stretch, 0.0), other, 0.0, reach, 0.0, 0.0}, 0.0);
}

/// The gap at the start of the way, if it is less than 0 there and as each stretch begins up to this one; else 0.
double Monitor::contact_until(const Stretch& last, const Part& part, const geometry::ConvexOnTwist& other,
                              double reach) {
  const double at_start = gap_as_it_begins(way_.front(), part, other, reach);
  double latest = at_start;
  for (const Stretch* next = &way_.front(); latest < 0.0 && next != &last;)
    latest = gap_as_it_begins(*++next, part, other, reach);
  turn_footprint(last, 0.0);
  return latest < 0.0 ? at_start : 0.0;
}

Monitor::Clear Monitor::clear_of_obstacles(double length, bool& in_contact) {
  Clear clear;
  clear.until = length;
  clear.lost_by = kInfinity;
  double offset = 0.0;
  for (const Stretch& stretch : way_) {
    const auto left = [&] { return std::min(stretch.duration, clear.until - offset); };
    if (offset > 0.0 && left() <= 0.0) break;
    turn_footprint(stretch, 0.0);
    const double speed = norm(stretch.twist.velocity);
    const auto reach = [&] { return (body_reach_ + speed * left()) * kUp; };
    grid_.for_each_within(stretch.start.at, reach(), [&](std::size_t number) {
      const Piece& piece = pieces_[number];
      // The way that is left may have become shorter.
      if (geometry::distance_below(grid_.box(number), stretch.start.at) > reach()) return;
      const geometry::ConvexOnTwist other{{}, {}, {corners_.data() + piece.first, piece.size}};
      for (const Part& part : parts_) {
        const double both = part.radius + piece.radius + setup_.margin + kMonitorSlack;
        GapToKeep question{part_on(part, stretch, 0.0), other, left(), both, 0.0, -kMonitorSlack};
        KeptGap kept = keeper_.keep(question);
        if (kept.whole) continue;
        if (offset > 0.0 || kept.kept_until == 0.0) {
          const double at_start = contact_until(stretch, part, other, both);
          if (at_start < 0.0) {
            in_contact = true;
            question.required = at_start - kMonitorSlack;
            kept = keeper_.keep(question);
            if (kept.whole) continue;
          }
        }
        clear.until = offset + kept.kept_until;
        clear.lost = question;
        clear.kept = kept;
        clear.offset = offset;
        clear.witness = MonitorWitness{false, piece.obstacle, 0.0, {}};
      }
    });
    if (clear.witness && clear.offset == offset) {
      const geometry::LostGap lost = keeper_.lose(clear.lost, clear.kept);
      clear.lost_by = offset + lost.lost_by;
      clear.witness->place = lost.place;
    }
    offset += stretch.duration;
  }
  return clear;
}

bool Monitor::is_far_from(const SeenMover& mover, const Pace& pace) const {
  const Vec2* corners = mover_corners_.data() + mover.first;
  double extent = 0.0, way = 0.0;
  for (std::size_t i = 0; i < mover.size; ++i) extent = std::max(extent, norm(corners[i] - corners[0]));
  for (const Stretch& stretch : way_) way += norm(stretch.twist.velocity) * stretch.duration;
  const double near =
      body_reach_ + extent + mover.radius + mover.position_error + way + mover.max_speed * pace.moment(pace.length());
  return norm(corners[0] - way_.front().start.at) > near * kUp;
}

bool Monitor::clear_of_mover(const SeenMover& mover, std::size_t index, const Pace& pace, Clear& clear,
                             bool& in_contact) {
  const geometry::ConvexOnTwist other{{}, {}, {mover_corners_.data() + mover.first, mover.size}};
  for (const Part& part : parts_) {
    const double reach = part.radius + mover.radius + mover.position_error + setup_.margin + kMonitorSlack;
    double speed = mover.max_speed, required = -kMonitorSlack;
    const double at_start = gap_as_it_begins(way_.front(), part, other, reach);
    if (at_start < 0.0) {
      in_contact = true;
      required += at_start;
      speed = 0.0;
    }
    double offset = 0.0;
    for (const Stretch& stretch : way_) {
      if (required < -kMonitorSlack && gap_as_it_begins(stretch, part, other, reach) >= 0.0) required = -kMonitorSlack;
      // Cut where braking begins, and then a few times more.
      for (int cut = -1; cut < kBrakingParts; ++cut) {
        const auto end_of = [&](int k) { return pace.held + pace.braked * (k + 1) / kBrakingParts; };
        const double from = std::max(offset, cut < 0 ? 0.0 : end_of(cut - 1));
        const double to = std::min(offset + stretch.duration, cut + 1 == kBrakingParts ? pace.length() : end_of(cut));
        if (!(from < to)) continue;
        const double then = pace.moment(from) * kUp, later = std::max(then, pace.moment(to) * kUp);
        turn_footprint(stretch, from - offset);
        GapToKeep question{part_on(part, stretch, from - offset),      other,   to - from, reach + speed * then * kUp,
                           speed * (later - then) / (to - from) * kUp, required};
        // In next to no time, all of it counts at once.
        if (!(question.growth < 0x1p100)) {
          question.reach = reach + speed * later * kUp;
          question.growth = 0.0;
        }
        const KeptGap kept = keeper_.keep(question);
        if (kept.whole) continue;
        clear.until = from + kept.kept_until;
        clear.witness = MonitorWitness{true, index, pace.moment(clear.until), keeper_.lose(question, kept).place};
        return false;
      }
      offset += stretch.duration;
    }
  }
  return true;
}

MonitorVerdict Monitor::judged(bool is_trajectory) {
  MonitorVerdict verdict;
  const Pace full = pace_at(1.0, is_trajectory);
  Clear clear = clear_of_obstacles(full.length(), verdict.in_contact);
  if (!clear.witness) {
    verdict.share = 1.0;
  } else {
    const double share = share_within(clear.until, is_trajectory) * kDown;
    // A few roundings of lengths that are added up.
    verdict.share = std::max(0.0, share - 0x1p-48);
    verdict.proven = !is_trajectory || clear.until >= pace_at(0.0, true).length() * kUp;
    if (clear.lost_by < kInfinity)
      verdict.not_above = std::min(1.0, share_within(clear.lost_by, is_trajectory) * kUp + 0x1p-48);
    clear.witness->time = full.moment(clear.until);
    verdict.witness = clear.witness;
  }
  std::size_t first = 0;  // the mover that was met last is asked first
  const auto is_clear = [&](double share) {
    // A robot that stands is promised nothing.
    if (!is_trajectory && (share == 0.0 || brake_time_ == 0.0)) return true;
    const Pace pace = pace_at(share, is_trajectory);
    for (std::size_t k = 0; k < movers_.size(); ++k) {
      const std::size_t index = (first + k) % movers_.size();
      if (is_far_from(movers_[index], pace)) continue;
      Clear met;
      if (clear_of_mover(movers_[index], index, pace, met, verdict.in_contact)) continue;
      verdict.witness = met.witness;
      first = index;
      return false;
    }
    return true;
  };
  if (is_clear(verdict.share)) return verdict;
  double low = 0.0, high = verdict.share;
  if (!is_clear(0.0)) {
    verdict.share = 0.0;
    verdict.proven = false;
    return verdict;
  }
  MonitorWitness witness = *verdict.witness;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    if (is_clear(middle)) {
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

void Monitor::require_movers(const std::vector<Mover>& movers) const {
  for (const Mover& mover : movers) {
    if (mover.shape.corners.empty())
      refuse_argument(MonitorProblem::out_of_range, "mover", "no corners", "at least one");
    for (const Vec2 v : mover.shape.corners) require_place(v, "mover");
    require_within(mover.shape.radius, 0.0, "mover radius");
    require_within(mover.max_speed, 0.0, "mover max_speed");
    require_within(mover.position_error, 0.0, "mover position_error");
  }
}

void Monitor::see(const std::vector<Mover>& movers) {
  movers_.clear();
  mover_corners_.clear();
  for (const Mover& mover : movers) {
    const std::size_t first = mover_corners_.size();
    const std::vector<Vec2>& corners = mover.shape.corners;
    if (corners.size() == 1) {
      mover_corners_.push_back(corners.front());
    } else {
      const std::vector<Vec2> hull = geometry::convex_hull(corners).vertices;
      mover_corners_.insert(mover_corners_.end(), hull.begin(), hull.end());
    }
    movers_.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(mover_corners_.size() - first),
                       mover.shape.radius, mover.max_speed, mover.position_error});
  }
}

double Monitor::braking_time(const Twist& twist) const {
  return std::max(norm(twist.velocity) / setup_.max_deceleration * kUp,
                  std::fabs(twist.turn) / setup_.max_turn_deceleration * kUp);
}

MonitorVerdict Monitor::judge(const Pose& pose, const Command& command, const std::vector<Mover>& movers) {
  require_place(pose.at, "position");
  require_place({pose.heading, command.twist.turn}, "heading and turn");
  require_place(command.twist.velocity, "velocity");
  if (command.in_world_axes && command.twist.turn != 0.0)
    refuse_argument(MonitorProblem::out_of_range, "turn", digits_of(command.twist.turn),
                    "0, with a velocity in the world's axes");
  require_movers(movers);
  see(movers);
  brake_time_ = braking_time(command.twist);
  held_ = setup_.period + setup_.latency;
  way_.clear();
  Twist in_world = command.twist;
  if (!command.in_world_axes) in_world.velocity = geometry::rotated(command.twist.velocity, pose.heading);
  way_.push_back({pose, in_world, pace_at(1.0, false).length()});
  is_trajectory_ = false;
  return judged(false);
}

MonitorVerdict Monitor::judge(const std::vector<TimedPose>& trajectory, const std::vector<Mover>& movers) {
  if (trajectory.size() < 2)
    refuse_argument(MonitorProblem::no_trajectory, "trajectory", std::to_string(trajectory.size()) + " poses",
                    "at least two");
  for (const TimedPose& p : trajectory) {
    require_place(p.pose.at, "trajectory position");
    require_place({p.time, p.pose.heading}, "trajectory time and heading");
  }
  for (std::size_t k = 1; k < trajectory.size(); ++k)
    if (!(trajectory[k - 1].time < trajectory[k].time))
      refuse_argument(MonitorProblem::no_trajectory, "trajectory time", digits_of(trajectory[k].time),
                      "more than " + digits_of(trajectory[k - 1].time));
  require_movers(movers);
  double brake_time = 0.0;
  next_way_.clear();
  Twist last;
  for (std::size_t k = 1; k < trajectory.size(); ++k) {
    const TimedPose &from = trajectory[k - 1], &to = trajectory[k];
    last = geometry::twist_between(from.pose, to.pose, to.time - from.time);
    if (!(std::max(norm(last.velocity), std::fabs(last.turn)) < kMostSize))
      refuse_argument(MonitorProblem::out_of_range, "trajectory at " + digits_of(to.time) + " s",
                      digits_of(norm(last.velocity)) + " m/s, " + digits_of(last.turn) + " rad/s",
                      "a speed and a turn rate of less than 2^30");
    brake_time = std::max(brake_time, braking_time(last));
    next_way_.push_back(
        {from.pose, {geometry::rotated(last.velocity, from.pose.heading), last.turn}, to.time - from.time});
  }
  see(movers);
  way_.swap(next_way_);
  brake_time_ = brake_time;
  held_ = trajectory.back().time - trajectory.front().time;
  // Beyond its end, the trajectory goes on as it did at last.
  const Pose& end = trajectory.back().pose;
  way_.push_back({end,
                  {geometry::rotated(last.velocity, end.heading), last.turn},
                  (setup_.latency + 0.5 * brake_time_) * kUp + 0x1p-40 * held_});
  is_trajectory_ = true;
  return judged(true);
}

std::vector<MonitorArc> Monitor::way(double share) const {
  std::vector<MonitorArc> arcs;
  const double length = way_.empty() ? 0.0 : pace_at(share, is_trajectory_).length();
  double offset = 0.0;
  for (const Stretch& stretch : way_) {
    const double end = std::min(offset + stretch.duration, length);
    if (!(offset < end || arcs.empty())) break;
    arcs.push_back({{offset, end, stretch.start.at, stretch.twist}, stretch.start.heading});
    offset += stretch.duration;
  }
  return arcs;
}

}  // namespace exactvo::formation
