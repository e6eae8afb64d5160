// SPDX-License-Identifier: GPL-3.0-or-later
//
// p = c + D e, n = e turned left. A constant twist that takes p to p + T u turns e by a with tan(a / 2) = t = Y / (2 D
// + X), X = T u.e, Y = T u.n, so that cos a and sin a are rational. The wheels run at ((X + Y t) -+ b t) (atan t / t) /
// T, and atan t / t is enclosed by its series.
#include "recordings/audit_points.h"

#include <algorithm>
#include <cmath>

namespace exactvo::datasets {
namespace {

using exact::exactly;
using exact::Interval;
using exact::Point;
using exact::Rational;
using formation::DifferentialDrive;
using formation::RobotStep;

/// Headings and wheels' speeds are rounded: a few products and a root of numbers below this share of their size.
constexpr double kRounding = 0x1p-45;

/// atan(t) / t for |t| < 1: the terms of 1 - t^2 / 3 + t^4 / 5 - ... fall and take turns. It is asked of a double next
/// to t, whose powers are short; the derivative is less than 1.
Interval arc_of(const Rational& t) {
  constexpr int kTerms = 400;
  constexpr double kSmall = 0x1p-60;
  const Rational near(t.get_d()), square = near * near, off = abs(t - near);
  Rational power(1), sum(0), before(0);
  for (int k = 0; k < kTerms && (k < 2 || power > kSmall); ++k) {
    before = sum;
    sum += Rational((k % 2 == 0 ? 1 : -1) * power / (2 * k + 1));
    power *= square;
  }
  return {std::min(before, sum) - off, std::max(before, sum) + off};
}

class KinematicsAudit : public RowAudit {
 public:
  explicit KinematicsAudit(const AuditedRun& run) : run_(run) {
    for (const formation::Robot& robot : run.scenario.robots) {
      if (!robot.drive) continue;
      ask(holds_its_body(robot), 0, robot, "has a disc about its reference point that does not hold it");
      if (!robot.drive->footprint.empty())
        ask(holds_its_footprint(*robot.drive), 0, robot, "has a chain of discs that does not hold its footprint");
    }
  }

  void check_row(const RowInRun& at) override {
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      const formation::Robot& robot = run_.scenario.robots[i];
      const RobotStep& state = at.row.robots[i];
      if (!robot.drive && state.wheels) ask(false, at.number, robot, "has wheels and no drive");
      if (!robot.drive) continue;
      if (!is_known(state)) {
        ask(false, at.number, robot, "does not say where it heads and how its wheels run");
        continue;
      }
      const Point e = exactly(state.wheels->heading);
      ask(abs(exact::dot(e, e) - 1) <= Rational(kRounding), at.number, robot, "has a heading that is no unit vector");
      if (at.number == 0) starts(state, robot);
    }
  }

  void check_step(const RowInRun& at) override {
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      const formation::Robot& robot = run_.scenario.robots[i];
      const RobotStep &from = at.row.robots[i], &to = at.next->robots[i];
      if (!robot.drive || !is_known(from) || !is_known(to) || !geometry::is_finite(from.chosen)) continue;
      follows(at.number, robot, from, to);
      keeps_limits(at.number, robot, *from.wheels, *to.wheels);
    }
  }

 private:
  static bool is_known(const RobotStep& state) {
    return state.wheels && geometry::is_finite(state.wheels->heading) && std::isfinite(state.wheels->speeds.left) &&
           std::isfinite(state.wheels->speeds.right);
  }

  void ask(bool holds, std::size_t row, const formation::Robot& robot, const std::string& what) {
    run_.tally.ask(AuditPoint::kinematics, holds, at_row(row, robot.id + " " + what));
  }

  /// The body's disc about the axle, which is D away, or its corners; s T |t| / 4 at its greatest, (W T)^2 / (4 (2 D -
  /// W T)); and the tracking error.
  bool holds_its_body(const formation::Robot& robot) const {
    const DifferentialDrive& d = *robot.drive;
    const Rational ahead(d.reference), way = Rational(d.max_wheel_speed) * run_.duration, room = 2 * ahead - way;
    if (sgn(room) <= 0) return false;
    const Rational left = Rational(robot.radius) - way * way / (4 * room) - Rational(tracking_error_of(run_.scenario));
    if (d.footprint.empty()) return left >= Rational(d.body_radius) + ahead;
    return sgn(left) > 0 && std::all_of(d.footprint.begin(), d.footprint.end(), [&](geometry::Vec2 corner) {
             const Point from = exactly(corner) - Point{ahead, Rational(0)};
             return exact::dot(from, from) <= left * left;
           });
  }

  /// A box round the footprint, cut into slabs between the centres of the discs: each disc, without the stray of a step
  /// and the tracking error, holds the corners of its slab. The first is about the reference point.
  bool holds_its_footprint(const DifferentialDrive& d) const {
    const Rational way = Rational(d.max_wheel_speed) * run_.duration, room = 2 * Rational(d.reference) - way;
    if (sgn(room) <= 0 || d.chain.empty() || d.chain[0].center.x != d.reference) return false;
    const Rational more = way * way / (4 * room) + Rational(tracking_error_of(run_.scenario));
    std::vector<geometry::Disc> chain = d.chain;
    std::sort(chain.begin(), chain.end(), [](const auto& a, const auto& b) { return a.center.x < b.center.x; });
    double front = d.footprint[0].x, rear = front, half_width = 0.0;
    for (const geometry::Vec2 corner : d.footprint) {
      front = std::max(front, corner.x);
      rear = std::min(rear, corner.x);
      half_width = std::max(half_width, std::fabs(corner.y));
    }
    const Rational first(rear), last(front);
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const auto middle = [&](std::size_t n) {
        return Rational((Rational(chain[n].center.x) + Rational(chain[n + 1].center.x)) / 2);
      };
      const Rational left = Rational(chain[k].radius) - more, centre(chain[k].center.x);
      const Rational from = k == 0 ? first : std::max(first, middle(k - 1));
      const Rational to = k + 1 == chain.size() ? last : std::min(last, middle(k));
      const auto holds = [&](const Rational& x) {
        return (x - centre) * (x - centre) + Rational(half_width) * Rational(half_width) <= left * left;
      };
      if (chain[k].center.y != 0.0 || sgn(left) <= 0) return false;
      if (from <= to && !(holds(from) && holds(to))) return false;
    }
    return true;
  }

  void starts(const RobotStep& state, const formation::Robot& robot) {
    const DifferentialDrive& d = *robot.drive;
    const Point at = exactly(d.axle) + Rational(d.reference) * exactly(state.wheels->heading);
    const Rational size = exact::length_at_most(exactly(d.axle)) + Rational(d.reference);
    ask(exact::length_at_most(at - exactly(state.position)) <= Rational(kRounding) * size, 0, robot,
        "does not start about its axle");
    ask(state.wheels->heading == formation::heading_vector(d.heading) && state.wheels->speeds.left == 0.0 &&
            state.wheels->speeds.right == 0.0,
        0, robot, "does not start with its heading and at rest");
  }

  void follows(std::size_t row, const formation::Robot& robot, const RobotStep& from, const RobotStep& to) {
    const DifferentialDrive& d = *robot.drive;
    const Point e = exactly(from.wheels->heading), n{Rational(-e.y), e.x}, u = exactly(from.chosen);
    const Rational x = run_.duration * exact::dot(u, e), y = run_.duration * exact::dot(u, n);
    const Rational ahead = 2 * Rational(d.reference);
    if (x * x + y * y >= ahead * ahead) return ask(false, row, robot, "goes farther in a step than a twist can");
    const Rational t = y / (ahead + x), whole = 1 + t * t;
    if (t * t >= 1) return ask(false, row, robot, "turns by more than a right angle in a step");
    const Point next = Rational((1 - t * t) / whole) * e + Rational(2 * t / whole) * n;
    const Point off = exactly(to.wheels->heading) - next;
    ask(exact::length_at_most(off) <= Rational(kRounding), row, robot, "has another heading than its twist leads to");
    const Interval arc = arc_of(t);
    const Rational middle = x + y * t, across = Rational(d.wheel_separation) * t;
    const auto runs_so = [&](double recorded, const Rational& way) {
      const Rational speed = way / run_.duration, near = Rational(kRounding) * Rational(d.max_wheel_speed);
      const Rational one = speed * arc.low, other = speed * arc.high;
      return Rational(recorded) >= std::min(one, other) - near && Rational(recorded) <= std::max(one, other) + near;
    };
    ask(runs_so(to.wheels->speeds.left, middle - across) && runs_so(to.wheels->speeds.right, middle + across), row,
        robot, "has other speeds of its wheels than its twist");
  }

  void keeps_limits(std::size_t row, const formation::Robot& robot, const formation::OnWheels& from,
                    const formation::OnWheels& to) {
    const DifferentialDrive& d = *robot.drive;
    const Rational most(d.max_wheel_speed), change = Rational(d.max_wheel_acceleration) * run_.duration;
    const Rational left(to.speeds.left), right(to.speeds.right);
    ask(abs(left) <= most && abs(right) <= most, row, robot, "runs a wheel faster than it may");
    ask(abs(left - Rational(from.speeds.left)) <= change && abs(right - Rational(from.speeds.right)) <= change, row,
        robot, "changes the speed of a wheel by more than it may");
    const Rational rounding = 1 + Rational(kRounding);
    if (std::isfinite(d.max_angular_speed))
      ask(abs(right - left) <= rounding * Rational(d.wheel_separation) * Rational(d.max_angular_speed), row, robot,
          "turns faster than it may");
    if (std::isfinite(d.max_backward_speed))
      ask(left + right >= -2 * rounding * Rational(d.max_backward_speed), row, robot, "drives back faster than it may");
  }

  const AuditedRun& run_;
};

}  // namespace

std::unique_ptr<RowAudit> audit_kinematics(const AuditedRun& run) {
  return std::make_unique<KinematicsAudit>(run);
}

}  // namespace exactvo::datasets
