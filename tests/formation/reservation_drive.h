// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Drives robots by reservations alone (liveness/reservations.h, WhoReserves::all), without half-planes: every robot
/// goes where its preferred velocity leads, to the nearest place of a lattice of 2^-18 m. Overlaps are found in whole
/// numbers.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "scene/cells.h"
#include "liveness/reservations.h"
#include "steering/guide.h"

namespace exactvo::formation::test_scenes {

/// In lattice steps.
struct LatticePlace {
  std::int64_t x = 0, y = 0;
};

inline constexpr double kLatticeStep = 0x1p-18;

inline LatticePlace on_lattice(Vec2 p) {
  return {std::llrint(p.x / kLatticeStep), std::llrint(p.y / kLatticeStep)};
}
inline Vec2 in_metres(LatticePlace p) {
  return kLatticeStep * Vec2{static_cast<double>(p.x), static_cast<double>(p.y)};
}
inline LatticePlace difference(LatticePlace a, LatticePlace b) {
  return {a.x - b.x, a.y - b.y};
}

/// Exact: whether a point that goes straight from `from` by `motion` comes nearer to the origin than `radii`.
inline bool comes_nearer_than(LatticePlace from, LatticePlace motion, std::int64_t radii) {
  __extension__ using Wide = __int128;
  const Wide start = Wide{from.x} * from.x + Wide{from.y} * from.y;
  const Wide towards = Wide{from.x} * motion.x + Wide{from.y} * motion.y;
  const Wide length2 = Wide{motion.x} * motion.x + Wide{motion.y} * motion.y, keep2 = Wide{radii} * radii;
  if (start < keep2) return true;
  if (towards >= 0) return false;
  if (-towards >= length2) return start + 2 * towards + length2 < keep2;
  const Wide cross = Wide{from.x} * motion.y - Wide{from.y} * motion.x;
  return cross * cross < keep2 * length2;
}

struct DriveReport {
  std::size_t home = 0, once_home = 0, overlaps = 0, at_walls = 0, steps = 0;
  double last = 0.0, bound = 0.0;  ///< s: the last arrival; the longest straight way at full speed
};

class ReservationDrive {
 public:
  explicit ReservationDrive(const Scenario& scenario, double time_step = 0.1,
                            detail::WhoReserves who = detail::WhoReserves::all)
      : scenario_(scenario),
        time_step_(time_step),
        guide_(scenario, 0.0),
        space_(scenario.obstacles),
        reservations_(space_, scenario.robots.size(), time_step, widest(scenario), who) {
    for (const Robot& r : scenario.robots) {
      at_.push_back(on_lattice(r.position));
      detail::RobotUnderWay now;
      now.position = in_metres(at_.back());
      now.goal = r.goals.back();
      now.radius = r.radius;
      now.max_speed = r.max_speed;
      now_.push_back(now);
      courses_.push_back(guide_.course(r.radius, r.position, {now.goal, 0.0}).course);
      report_.bound = std::max(report_.bound, norm(now.goal - r.position) / r.max_speed);
    }
    motions_.resize(at_.size());
    once_.resize(at_.size());
  }

  static double widest(const Scenario& s) {
    double most = 0.0;
    for (const Robot& r : s.robots) most = std::max(most, r.radius);
    return most;
  }

  /// Until all are home at one time, or the time has run out, s.
  DriveReport run(double limit) {
    while (static_cast<double>(report_.steps) * time_step_ < limit && report_.home < at_.size()) step();
    return report_;
  }

  void step() {
    look();
    if (report_.home == at_.size()) return;
    reservations_.look(now_);
    drive();
  }

  /// As `reservations` say.
  void drive() {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const LatticePlace to = on_lattice(in_metres(at_[i]) + time_step_ * reservations_.preferred()[i]);
      motions_[i] = difference(to, at_[i]);
    }
    count_overlaps();
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const Vec2 from = in_metres(at_[i]);
      at_[i] = {at_[i].x + motions_[i].x, at_[i].y + motions_[i].y};
      now_[i].position = in_metres(at_[i]);
      now_[i].velocity = (now_[i].position - from) / time_step_;
      report_.at_walls += !space_.is_clear(from, now_[i].position, now_[i].radius - 4.0 * kLatticeStep);
    }
    ++report_.steps;
  }

  detail::Reservations& reservations() { return reservations_; }
  const DriveReport& report() const { return report_; }
  double time_step() const { return time_step_; }
  const std::vector<detail::RobotUnderWay>& robots() const { return now_; }

  /// Which robots are at their goals, and where the others head.
  void look() {
    report_.home = 0;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      detail::RobotUnderWay& r = now_[i];
      r.is_at_goal = norm(r.goal - r.position) < (r.is_at_goal ? 0.2 : 0.1);
      report_.home += r.is_at_goal;
      if (r.is_at_goal && !once_[i]) {
        once_[i] = true;
        ++report_.once_home;
        report_.last = static_cast<double>(report_.steps) * time_step_;
      }
      set_course(i);
    }
  }

 private:
  void set_course(std::size_t i) {
    detail::RobotUnderWay& r = now_[i];
    r.ahead[0] = r.goal;
    r.corners_ahead = 1;
    r.rest = 0.0;
    if (!courses_[i]) return;
    detail::Course& c = *courses_[i];
    r.ahead[0] = guide_.heading(c, r.radius, r.position).place;
    std::size_t k = c.next;
    while (++k < c.points.size() && r.corners_ahead < r.kMostAhead) r.ahead[r.corners_ahead++] = c.points[k];
    for (; k < c.points.size(); ++k) r.rest += norm(c.points[k] - c.points[k - 1]);
  }

  void count_overlaps() {
    const double reach = 3.0 * widest(scenario_) + 1.5 * time_step_;  // above a diameter and what two drive in a step
    detail::Cells<std::size_t> cells(reach);
    for (std::size_t i = 0; i < at_.size(); ++i) cells.add(now_[i].position, i);
    for (std::size_t i = 0; i < at_.size(); ++i)
      cells.for_each_about(now_[i].position, reach, [&](std::size_t j) {
        if (j <= i) return;
        const auto radii = static_cast<std::int64_t>(std::floor((now_[i].radius + now_[j].radius) / kLatticeStep));
        report_.overlaps += comes_nearer_than(difference(at_[i], at_[j]), difference(motions_[i], motions_[j]), radii);
      });
  }

  const Scenario& scenario_;
  double time_step_;
  detail::Guide guide_;
  detail::ObstacleSpace space_;
  detail::Reservations reservations_;
  std::vector<detail::RobotUnderWay> now_;
  std::vector<std::optional<detail::Course>> courses_;
  std::vector<LatticePlace> at_, motions_;
  std::vector<bool> once_;
  DriveReport report_;
};

}  // namespace exactvo::formation::test_scenes
