// SPDX-License-Identifier: GPL-3.0-or-later
//
// A robot that brakes keeps the share 1 - T / tau of its velocity in each step, so that its way from x on at v is
// [x, x + tau v]; two that brake alike are at the same share of their ways. A row is asked for the velocities that were
// chosen in it. That they could brake in the next row follows: x + T v + [0, tau] (1 - T / tau) v is a part of this
// way.
#include "recordings/audit_points.h"

namespace exactvo::datasets {
namespace {

using exact::exactly;
using exact::Point;
using exact::Rational;
using exact::Straight;
using formation::RobotStep;

class BrakingAudit : public RowAudit {
 public:
  explicit BrakingAudit(const AuditedRun& run) : run_(run) {
    tau_ = Rational(formation::braking_time_of(run.scenario));
    if (sgn(tau_) == 0) return;
    if (run.scenario.acceleration) most_change_ = Rational(run.scenario.acceleration->max) * run.duration;
    for (const formation::Robot& robot : run.scenario.robots)
      run.tally.ask(AuditPoint::braking, can_stop(robot), "the braking time is too short for " + robot.id + " to stop");
  }

  void check_step(const RowInRun& at) override {
    if (sgn(tau_) == 0) return;
    std::vector<Way> ways;
    for (const RobotStep& robot : at.row.robots) ways.push_back(way_of(robot));
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const RobotStep& robot = at.row.robots[i];
      const Point change = exactly(robot.chosen) - exactly(robot.velocity);
      if (run_.scenario.acceleration && !run_.scenario.robots[i].drive)
        ask(exact::dot(change, change) <= most_change_ * most_change_, at, i,
            " changes its velocity by more than A dt");
      ask(robot.status == lp::Status::optimal, at, i, " relaxes a half-plane");
      brakes_alone(ways[i], i, at);
      turns_alone(ways[i], i, at);
      for (std::size_t j = i + 1; j < ways.size(); ++j) brake_together(ways[i], i, ways[j], j, at);
    }
  }

 private:
  /// The way of a robot that brakes.
  struct Way {
    Straight way;
    geometry::Box box;
  };

  bool can_stop(const formation::Robot& robot) const {
    if (robot.drive)
      return tau_ * Rational(robot.drive->max_wheel_acceleration) >= Rational(robot.drive->max_wheel_speed);
    const double speed = formation::fastest(run_.scenario.speed_bound, robot.max_speed);
    return !run_.scenario.acceleration || tau_ * Rational(run_.scenario.acceleration->max) >= Rational(speed);
  }

  const std::string& id(std::size_t robot) const { return run_.scenario.robots[robot].id; }

  void ask(bool holds, const RowInRun& at, std::size_t robot, const std::string& what) {
    if (holds) return run_.tally.proven(AuditPoint::braking);
    run_.tally.refuted(AuditPoint::braking, at_row(at.number, id(robot) + what));
  }

  Way way_of(const RobotStep& robot) const {
    const Point from = exactly(robot.position);
    const Straight way{from, from + tau_ * exactly(robot.chosen)};
    return {way, box_of(exact::Chord{way, Rational(0)})};
  }

  void brakes_alone(const Way& w, std::size_t i, const RowInRun& at) {
    const double radius = obstacle_radius(run_.scenario.robots[i]);
    const Rational r(radius);
    for (std::size_t k = 0; k < run_.obstacles.size(); ++k) {
      const RationalObstacle& o = run_.obstacles[k];
      if (are_apart(w.box, o.box, radius)) continue;
      ask(is_clear(w, o, radius, r), at, i,
          " could not brake without touching obstacle '" + run_.scenario.obstacles[k].id + "'");
    }
  }

  /// With a footprint, which turns meanwhile: what is clear of an obstacle now stays so in the rows to come, since way
  /// and turn of the rest are parts of this way and this turn.
  void turns_alone(const Way& w, std::size_t i, const RowInRun& at) {
    const formation::Robot& robot = run_.scenario.robots[i];
    if (!robot.drive || robot.drive->chain.empty()) return;
    for (std::size_t k = 0; k < run_.obstacles.size(); ++k) {
      const RationalObstacle& o = run_.obstacles[k];
      if (are_apart(w.box, o.box, obstacle_reach_of(robot))) continue;
      ask(chain_against(robot, at.row.robots[i], tau_, o) == exact::Verdict::clear, at, i,
          " could not brake without its footprint touching obstacle '" + run_.scenario.obstacles[k].id + "'");
    }
  }

  static bool is_clear(const Way& w, const RationalObstacle& o, double radius, const Rational& r) {
    std::vector<NearEdge> edges;
    for (const std::size_t edge : o.near(w.box, radius)) edges.push_back({edge, r});
    return against({w.way, Rational(0)}, o, edges, r) == exact::Verdict::clear;
  }

  void brake_together(const Way& a, std::size_t i, const Way& b, std::size_t j, const RowInRun& at) {
    constexpr double kRounding = 1.0 + 0x1p-50;
    const double radius = run_.scenario.robots[i].radius, other = run_.scenario.robots[j].radius;
    if (are_apart(a.box, b.box, kRounding * (radius + other))) return run_.tally.proven(AuditPoint::braking);
    const Rational reach = Rational(radius) + Rational(other);
    const Straight apart{a.way.from - b.way.from, a.way.to - b.way.to};
    const exact::Verdict verdict = against_point({apart, Rational(0)}, {Rational(0), Rational(0)}, reach);
    ask(verdict == exact::Verdict::clear, at, i, " and " + id(j) + " could not brake without touching each other");
  }

  const AuditedRun& run_;
  Rational tau_;          ///< s
  Rational most_change_;  ///< m/s
};

}  // namespace

std::unique_ptr<RowAudit> audit_braking(const AuditedRun& run) {
  return std::make_unique<BrakingAudit>(run);
}

}  // namespace exactvo::datasets
