// SPDX-License-Identifier: GPL-3.0-or-later
//
// A robot that brakes keeps the share 1 - T / tau of its velocity in each step, so that its way from x on at v is
// [x, x + tau v]; two that brake alike are at the same share of their ways. A row is asked for the velocities that were
// chosen in it. That they could brake in the next row follows: x + T v + [0, tau] (1 - T / tau) v is a part of this
// way.
//
// Where robots measure each other, each keeps to its own side of the line half-way between the ways on which both would
// have braked instead: of a line across some n that parts these ways, since then they are apart whatever the other
// chose. And what was measured is within the bounds of the rows.
#include "recordings/audit_points.h"

#include <deque>

#include "exactvo/geometry/vec2.h"

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
    for (const RobotStep& robot : at.row.robots) ways.push_back(way_of(robot, exactly(robot.chosen), tau_));
    const bool measures = measures_others(run_.scenario);
    if (measures) {
      brake_ways_.clear();
      for (const RobotStep& robot : at.row.robots)
        brake_ways_.push_back(way_of(robot, exactly(robot.velocity), tau_ - run_.duration));
      look_at_measurements(at);
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const RobotStep& robot = at.row.robots[i];
      const Point change = exactly(robot.chosen) - exactly(robot.velocity);
      if (run_.scenario.acceleration && (measures || !run_.scenario.robots[i].drive))
        ask(exact::dot(change, change) <= most_change_ * most_change_, at, i,
            " changes its velocity by more than A dt");
      ask(robot.status == lp::Status::optimal, at, i, " relaxes a half-plane");
      if (meets_movers(run_.scenario)) stands_in_time(i, at);
      brakes_alone(ways[i], i, at);
      turns_alone(ways[i], i, at);
      for (std::size_t j = i + 1; j < ways.size(); ++j) {
        brake_together(ways[i], i, ways[j], j, at);
        if (measures) keep_own_sides(ways[i], i, ways[j], j, at);
      }
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

  /// Lemma 8: it can stand after as many steps as it says, and until then no mover reaches it: across some n it is
  /// clear of each where that is, and its whole way leads clear of all that this may reach by then. The n of its
  /// half-plane, or that from the mover, before or after.
  void stands_in_time(std::size_t i, const RowInRun& at) {
    const RobotStep& robot = at.row.robots[i];
    const Point u = exactly(robot.chosen);
    const Rational steps(robot.stopping_steps), most = steps * most_change_;
    ask(exact::dot(u, u) <= most * most, at, i, " could not stand after the steps that it says");
    if (robot.stopping_steps == 0) return;
    const Point way = (steps + 1) / 2 * run_.duration * u;
    for (std::size_t k = 0; k < run_.scenario.moving_obstacles.size() && k < at.row.moving.size(); ++k) {
      const formation::MovingObstacle& mover = run_.scenario.moving_obstacles[k];
      const Point from = exactly(robot.position) - exactly(mover.disc->center) - exactly(at.row.moving[k].displacement);
      const Rational away = Rational(run_.scenario.robots[i].radius) + Rational(mover.disc->radius);
      const Rational by_then = away + Rational(*mover.max_speed) * steps * run_.duration;
      const auto keeps = [&](const Point& n) {
        const Rational square = exact::dot(n, n), now = exact::dot(n, from), then = exact::dot(n, from + way);
        return sgn(now) > 0 && now * now >= away * away * square && sgn(then) > 0 &&
               then * then >= by_then * by_then * square;
      };
      const auto is_shown_by = [&](const formation::DecisionConstraint& c) {
        return c.source == vo::BodyKind::moving_obstacle && c.index == k && geometry::is_finite(c.half_plane.normal) &&
               keeps(exactly(c.half_plane.normal));
      };
      ask(keeps(from) || keeps(from + way) ||
              std::any_of(robot.constraints.begin(), robot.constraints.end(), is_shown_by),
          at, i, " could meet moving obstacle '" + mover.id + "' before it stands");
    }
  }

  static Way way_of(const RobotStep& robot, const Point& velocity, const Rational& time) {
    const Point from = exactly(robot.position);
    const Straight way{from, from + time * velocity};
    return {way, box_of(exact::Chord{way, Rational(0)})};
  }

  /// From the nearest point of b to that of a, rounded: of some line between them, if they are apart.
  static geometry::Vec2 between(const Straight& a, const Straight& b) {
    const auto rounded = [](const Point& p) { return geometry::Vec2{p.x.get_d(), p.y.get_d()}; };
    const geometry::Vec2 ends[2][2] = {{rounded(a.from), rounded(a.to)}, {rounded(b.from), rounded(b.to)}};
    geometry::Vec2 shortest = ends[0][0] - ends[1][0];
    for (const int side : {0, 1})
      for (const geometry::Vec2 p : ends[side]) {
        const geometry::Vec2 way = p - nearest_on(ends[1 - side][0], ends[1 - side][1], p);
        if (norm(way) < norm(shortest)) shortest = side == 0 ? way : -way;
      }
    return shortest;
  }

  /// Two whose ways of this step could meet. Each is asked whether its way at its choice keeps half of their radii, R /
  /// 2, from the line half-way between its way of braking and the other's.
  void keep_own_sides(const Way& a, std::size_t i, const Way& b, std::size_t j, const RowInRun& at) {
    const Rational radii = Rational(run_.scenario.robots[i].radius) + Rational(run_.scenario.robots[j].radius);
    const Rational reach = radii + tau_ * (fastest(i) + fastest(j));
    const Point apart = a.way.from - b.way.from;
    if (exact::dot(apart, apart) > reach * reach) return run_.tally.proven(AuditPoint::braking);
    const Straight &mine = brake_ways_[i].way, &theirs = brake_ways_[j].way;
    const Point n = exactly(between(mine, theirs));
    const auto least = [&](const Straight& way) { return std::min(exact::dot(n, way.from), exact::dot(n, way.to)); };
    const auto most = [&](const Straight& way) { return std::max(exact::dot(n, way.from), exact::dot(n, way.to)); };
    const Rational line = (least(mine) + most(theirs)) / 2, room = radii / 2, square = exact::dot(n, n);
    const auto keeps = [&](const Rational& off) { return sgn(off) > 0 && off * off >= room * room * square; };
    ask(keeps(least(a.way) - line), at, i, " does not keep to its own side of " + id(j));
    ask(keeps(line - most(b.way)), at, j, " does not keep to its own side of " + id(i));
  }

  Rational fastest(std::size_t robot) const {
    return Rational(formation::fastest(run_.scenario.speed_bound, run_.scenario.robots[robot].max_speed));
  }

  /// Each of another robot, in the row that is its age before this one, and within the bounds of it.
  void look_at_measurements(const RowInRun& at) {
    const formation::Measurements& bounds = *run_.scenario.uncertainty->measurements;
    std::vector<State>& now = rows_.emplace_front();
    for (const RobotStep& robot : at.row.robots) now.push_back({exactly(robot.position), exactly(robot.velocity)});
    constexpr double kRounding = 1.0 + 1e-9;
    while (Rational(static_cast<double>(rows_.size() - 1)) * run_.duration > Rational(kRounding * bounds.age))
      rows_.pop_back();
    const auto is_within = [](const Point& measured, const Point& place, double bound) {
      const Point off = measured - place;
      const Rational most = Rational(bound) + Rational(0x1p-48) * (exact::length_at_most(place) + 1);
      return exact::dot(off, off) <= most * most;
    };
    for (std::size_t i = 0; i < at.row.robots.size(); ++i)
      for (const formation::MeasuredRobot& m : at.row.robots[i].measured) {
        const double rows = m.age / run_.scenario.time_step;
        const bool is_named = m.robot < now.size() && m.robot != i && std::isfinite(rows) && rows >= 0.0 &&
                              std::round(rows) < static_cast<double>(rows_.size()) &&
                              std::fabs(rows - std::round(rows)) < 1e-6;
        const bool has_numbers = geometry::is_finite(m.position) && geometry::is_finite(m.velocity);
        if (!is_named || !has_numbers) {
          ask(false, at, i, " measures no robot, or one of another row");
          continue;
        }
        const State& then = rows_[static_cast<std::size_t>(std::round(rows))][m.robot];
        ask(is_within(exactly(m.position), then.place, bounds.position) &&
                is_within(exactly(m.velocity), then.velocity, bounds.velocity),
            at, i, " measures " + id(m.robot) + " beyond the bounds");
      }
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

  struct State {
    Point place, velocity;
  };
  std::deque<std::vector<State>> rows_;  ///< the newest first, as old as measurements may be
  std::vector<Way> brake_ways_;          ///< of the row, had its robots braked
};

}  // namespace

std::unique_ptr<RowAudit> audit_braking(const AuditedRun& run) {
  return std::make_unique<BrakingAudit>(run);
}

}  // namespace exactvo::datasets
