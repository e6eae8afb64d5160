// SPDX-License-Identifier: GPL-3.0-or-later
//
// Robots on wheels in a recording of places. With K = 2 D and m the way of a step, both m, a half-heading (a, b)
// becomes
// ((K + mx) a + my b, (K - mx) b + my a): whole numbers, of which 256 bits are kept. What is unknown of a heading then,
// a small angle, grows by (K^2 - |m|^2) / |K + m conj(e)|^2 in a step at most, and moves wheels by less than 32 times
// itself times |m| (K >= 2 |m|, b <= 16 D).
#include <cmath>

#include "recordings/audit_points.h"

namespace exactvo::datasets {
namespace {

using exact::Interval;
using exact::Rational;
using Whole = mpz_class;

constexpr std::size_t kBits = 256;
/// Radians: what cutting adds; and beyond what the bounds hold no more.
constexpr double kCut = 0x1p-240, kMostDoubt = 0x1p-30;
constexpr double kSecondOrder = 1.0 + 0x1p-20;

/// atan(t) / t for |t| < 0.6, in doubles: the terms of 1 - t^2 / 3 + t^4 / 5 - ..., forty roundings of numbers below 1.
Interval arc_of(double t) {
  constexpr int kTerms = 40;
  constexpr double kError = 0x1p-40;  // also of t: less than an ulp of it
  double sum = 0.0, power = 1.0;
  for (int k = 0; k < kTerms; ++k) {
    sum += (k % 2 == 0 ? power : -power) / (2 * k + 1);
    power *= t * t;
  }
  return {Rational(sum - kError), Rational(sum + kError)};
}

/// One robot, from row to row.
struct Driven {
  Whole a, b;
  double doubt = 0.0;
  Interval left{Rational(0), Rational(0)}, right{Rational(0), Rational(0)};  ///< m, ways of the wheels in the last step
  bool is_followed = false;
};

class WheelsAudit : public RowAudit {
 public:
  WheelsAudit(const AuditedRun& run, const CrowdRecordingHead& head) : run_(run), head_(head) {
    run.tally.report.has_tube = head.tracking > 0.0;
    for (std::size_t k = 0; k < head.kinds.size(); ++k) {
      if (!head.kinds[k].wheels && !run.tally.report.has_tube) continue;
      run.tally.ask(
          AuditPoint::kinematics, holds_its_body(head.kinds[k]),
          "the discs of kind " + std::to_string(k) + " have no room for " +
              (head.kinds[k].wheels ? "body, tracking error and the arc of a step" : "body and tracking error"));
    }
    robots_.resize(head.half_headings.size());
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (!head.kinds[head.kind_of[i]].wheels || !run.is_asked(0, i)) continue;
      Driven& robot = robots_[i];
      const Rational x(head.half_headings[i].x), y(head.half_headings[i].y);
      const Whole scale = lcm(x.get_den(), y.get_den());
      robot.a = Whole(x * scale);
      robot.b = Whole(y * scale);
      robot.is_followed = true;
    }
  }

  void check_step(const RowInRun&) override {}
  void check_states(std::size_t row, const RowStates& from, const RowStates& to) override {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      Driven& robot = robots_[i];
      if (!robot.is_followed) continue;
      if (to.step == from.step + 1)
        follow(row, i, exact::exactly(to.robots[i].position) - exact::exactly(from.robots[i].position), robot);
      else
        lose(row, i, "comes to a row several steps later: its twists are not known", robot);
    }
  }

 private:
  const formation::CrowdWheels& wheels_of(std::size_t i) const { return *head_.kinds[head_.kind_of[i]].wheels; }

  /// The body and the tracking error; on wheels the body is D behind, and strays by (W T)^2 / (4 (2 D - W T)).
  bool holds_its_body(const CrowdKindRecord& kind) const {
    const Rational left = Rational(kind.radius) - Rational(kind.body_radius) - Rational(head_.tracking);
    if (!kind.wheels) return sgn(left) >= 0;
    const Rational way = Rational(kind.max_speed) * run_.duration, ahead(kind.wheels->reference);
    return way <= ahead && way * way <= 4 * (2 * ahead - way) * (left - ahead);
  }

  std::string words(std::size_t row, std::size_t i, const char* what) const {
    return at_row(row, head_.name_of(i) + " " + what);
  }
  void ask(bool holds, std::size_t row, std::size_t i, const char* what) {
    run_.tally.ask(AuditPoint::kinematics, holds, holds ? std::string() : words(row, i, what));
  }
  void lose(std::size_t row, std::size_t i, const char* what, Driven& robot) {
    run_.tally.open(AuditPoint::kinematics, words(row, i, what));
    robot.is_followed = false;
  }

  void follow(std::size_t row, std::size_t i, const exact::Point& m, Driven& robot) {
    const formation::CrowdWheels& w = wheels_of(i);
    const Interval left_before = robot.left, right_before = robot.right;
    if (sgn(m.x) == 0 && sgn(m.y) == 0) {
      robot.left = robot.right = {Rational(0), Rational(0)};
    } else if (!drive(m, w, robot)) {
      ask(false, row, i, "goes farther in a step than a twist takes it");
      robot.is_followed = false;
      return;
    }
    if (robot.doubt > kMostDoubt)
      return lose(row, i, "has driven back for so long that its heading is not known", robot);
    const Rational most = Rational(head_.kinds[head_.kind_of[i]].max_speed) * run_.duration;
    ask(within(robot.left, -most, most) && within(robot.right, -most, most), row, i, "runs a wheel faster than it may");
    if (std::isfinite(w.max_wheel_acceleration)) {
      const Rational change = Rational(w.max_wheel_acceleration) * run_.duration * run_.duration;
      ask(within(robot.left - left_before, -change, change) && within(robot.right - right_before, -change, change), row,
          i, "changes the speed of a wheel by more than it may");
    }
    if (std::isfinite(w.max_angular_speed)) {
      const Rational turn = Rational(w.wheel_separation) * Rational(w.max_angular_speed) * run_.duration;
      ask(within(robot.right - robot.left, -turn, turn), row, i, "turns faster than it may");
    }
    if (std::isfinite(w.max_backward_speed))
      ask(robot.left.low + robot.right.low >= -2 * Rational(w.max_backward_speed) * run_.duration, row, i,
          "drives back faster than it may");
  }

  static bool within(const Interval& x, const Rational& low, const Rational& high) {
    return x.low >= low && x.high <= high;
  }

  /// False where no twist is known to lead there.
  static bool drive(const exact::Point& m, const formation::CrowdWheels& w, Driven& robot) {
    const Rational ahead = 2 * Rational(w.reference);
    const Rational a(robot.a), b(robot.b), whole = a * a + b * b, squared = exact::dot(m, m);
    if (4 * squared > ahead * ahead) return false;
    const Rational along = a * a - b * b, across = 2 * a * b;
    const Rational x = (m.x * along + m.y * across) / whole, y = (m.y * along - m.x * across) / whole;
    const Rational t = y / (ahead + x), middle = x + y * t, turns = Rational(w.wheel_separation) * t;
    const Interval arc = arc_of(t.get_d());
    const double far = std::sqrt(squared.get_d());
    const Rational off(32.0 * robot.doubt * far * kSecondOrder);
    robot.left = way_of(middle - turns, arc, off);
    robot.right = way_of(middle + turns, arc, off);
    const double gone = ahead.get_d() + x.get_d(), aside = y.get_d();
    const double growth = (ahead.get_d() * ahead.get_d() - far * far) / (gone * gone + aside * aside);
    robot.doubt = robot.doubt * growth * kSecondOrder + kCut;
    turn(ahead + m.x, ahead - m.x, m.y, robot);
    return true;
  }

  static Interval way_of(const Rational& way, const Interval& arc, const Rational& off) {
    const Rational one = way * arc.low, other = way * arc.high;
    return {std::min(one, other) - off, std::max(one, other) + off};
  }

  static void turn(const Rational& plus, const Rational& minus, const Rational& side, Driven& robot) {
    const Whole scale = lcm(lcm(plus.get_den(), minus.get_den()), side.get_den());
    const Whole p(plus * scale), q(minus * scale), s(side * scale), a = p * robot.a + s * robot.b;
    robot.b = q * robot.b + s * robot.a;
    robot.a = a;
    const std::size_t bits = std::max(mpz_sizeinbase(robot.a.get_mpz_t(), 2), mpz_sizeinbase(robot.b.get_mpz_t(), 2));
    if (bits > kBits) robot.a >>= bits - kBits, robot.b >>= bits - kBits;
  }

  const AuditedRun& run_;
  const CrowdRecordingHead& head_;
  std::vector<Driven> robots_;  ///< by number; empty where none has wheels
};

}  // namespace

std::unique_ptr<RowAudit> audit_wheels(const AuditedRun& run, const CrowdRecordingHead& head) {
  return std::make_unique<WheelsAudit>(run, head);
}

}  // namespace exactvo::datasets
