// SPDX-License-Identifier: GPL-3.0-or-later
//
// A robot's step is, whatever the integrator, x1 = x0 + T w + Q (v0 - w), v1 = w + P (v0 - w), w what it tracks:
//     exact           P = e^-kT                                Q = (1 - P) / k
//     explicit Euler  P = 1 - kT                               Q = T
//     rk4             P = 1 - z + z^2/2 - z^3/6 + z^4/24       Q = T (1 - z/2 + z^2/6 - z^3/24), z = kT
// (the adaptive ones solve the law to their tolerance, which is no proof). A robot that drives at what it chooses, with
// a goal or on wheels, goes x + T v, bit for bit.
#include "exactvo/formation/stability.h"
#include "exactvo/geometry/told_apart.h"
#include "recordings/audit_points.h"

namespace exactvo::datasets {
namespace {

using exact::exactly;
using exact::exactly_that;
using exact::ExactWay;
using exact::Interval;
using exact::length_at_most;
using exact::Point;
using exact::Rational;
using formation::RobotStep;
using formation::TimedPath;
using geometry::Vec2;

/// A step's results are sums of terms that passed fewer than this many roundings (rk4, the longest, 40).
constexpr double kRoundings = 64 * 0x1p-53;

/// m/s: a robot that stands for a thousand steps has velocities below the smallest normal number; their rounding is
/// absolute.
constexpr double kSubnormal = 0x1p-1050;

/// A path counts as covered when all but 1e-12 of it is (formation's leader.h): places are known to within a share of
/// the path, and a leader that brakes to rest there is at rest this much earlier (s).
constexpr double kShareOfWay = 0x1p-37;
constexpr double kRestsEarlier = 0x1p-12;
constexpr double kShareOfSpeed = 0x1p-44;

/// A limit of speed times a time, rounded twice, and a length, rounded four times.
constexpr double kRoundingOfSpeed = 8.0 * 0x1p-53;

Rational length_of(const TimedPath& motion) {
  Rational length(0);
  for (std::size_t i = 0; i < motion.path.size(); ++i) {
    length += length_at_most(exactly(motion.path[i]));
    if (i > 0) length += length_at_most(exactly(motion.path[i]) - exactly(motion.path[i - 1]));
  }
  return length;
}

Rational top_speed(const TimedPath& motion) {
  Rational speed(motion.speed);
  for (const formation::SpeedKnot& knot : motion.profile) speed = std::max(speed, Rational(knot.speed));
  return speed;
}

/// What holds a product of x, of any sign, with a number.
Point scaled(const Interval& x, const Point& p) {
  return x.middle() * p;
}

class SequenceAudit : public RowAudit {
 public:
  explicit SequenceAudit(const AuditedRun& run) : run_(run), tracks_(tracks_choices(run.scenario)) {
    if (!run.scenario.formation) return;
    leader_.emplace(run.scenario.formation->leader);
    if (!tracks_) return;
    const std::string integrator = run.file.info.integrator.value_or("exact");
    const Rational k(run.scenario.formation->gains.k3), z = k * run.duration;
    if (run.law) {
      law_ = Law{exactly_that(Rational(1)) - run.law->settled(), run.law->settled() / exactly_that(k), z};
    } else if (integrator == "euler") {
      law_ = Law{exactly_that(1 - z), exactly_that(run.duration), z};
    } else if (integrator == "rk4") {
      const Rational z2 = z * z, z3 = z2 * z;
      law_ = Law{exactly_that(1 - z + z2 / 2 - z3 / 6 + z3 * z / 24),
                 exactly_that(run.duration * (1 - z / 2 + z2 / 6 - z3 / 24)), z};
    }
    if (integrator != "exact" && integrator != "euler" && integrator != "rk4")
      run.tally.refuted(AuditPoint::sequence, "the integrator '" + integrator + "' is unknown");
    if (!tracks_its_choice()) run.tally.report.has_sums = true;
  }

  void check_row(const RowInRun& at) override {
    const formation::Step& step = at.row;
    const std::size_t row = at.number;
    ask(step.time == static_cast<double>(row) * run_.file.recording.time_step, row,
        "its time is not its number of time steps");
    if (leader_) {
      const TimedPath& motion = run_.scenario.formation->leader;
      const Vec2 start = motion.path.front();
      ask(is_on_way(*leader_, motion, step.time, step.leader_position - start, step.leader_velocity), row,
          "the leader is not where its path has it");
    }
    if (at.next && step.moving.size() != run_.scenario.moving_obstacles.size())
      run_.tally.refuted(AuditPoint::sequence, at_row(row, "it does not say where the moving obstacles are"));
    for (std::size_t k = 0; k < step.moving.size(); ++k) {
      const formation::MovingObstacle& o = run_.scenario.moving_obstacles[k];
      ask(is_on_way(run_.ways[k], o.motion, step.time, step.moving[k].displacement, step.moving[k].velocity), row,
          "moving obstacle '" + o.id + "' is not where its path has it");
    }
    for (std::size_t i = 0; i < step.robots.size(); ++i)
      ask(has_its_anchor(at, i), row,
          "half-planes of " + run_.scenario.robots[i].id + " are not built where its controller builds them");
  }

 private:
  struct Law {
    Interval remains;  ///< P
    Interval reach;    ///< Q, s
    Rational z;
  };

  void ask(bool holds, std::size_t row, const std::string& what) {
    holds ? run_.tally.proven(AuditPoint::sequence) : run_.tally.refuted(AuditPoint::sequence, at_row(row, what));
  }

  bool is_on_way(const ExactWay& way, const TimedPath& motion, double time, Vec2 displacement, Vec2 velocity) const {
    if (!(time >= 0.0) || !geometry::is_finite(displacement) || !geometry::is_finite(velocity)) return false;
    const Rational t(time), speed = top_speed(motion);
    const exact::Chord at = way.within(t, t);
    const Rational near = Rational(kShareOfWay) * (length_of(motion) + speed * t) + 2 * at.stray;
    if (length_at_most(exactly(displacement) - at.way.from) > near) return false;
    const std::vector<Point> all = way.velocities(t, Rational(kRestsEarlier));
    return std::any_of(all.begin(), all.end(), [&](const Point& v) {
      return length_at_most(exactly(velocity) - v) <= Rational(kShareOfSpeed) * (speed + length_at_most(v));
    });
  }

  /// Robots that drive at what they choose and controllers without a brake point build half-planes at the robot. The
  /// brake point is x + v / k3, round what was tracked before.
  bool has_its_anchor(const RowInRun& at, std::size_t i) const {
    const RobotStep& r = at.row.robots[i];
    const std::optional<formation::ControllerOptions>& options = run_.file.recording.controller_options;
    if (tracks_ && !options) return true;  // nothing is known of its controller
    if (!at.next || !tracks_ || !options->brake_point) return r.anchor == r.position && r.anchor_velocity == r.velocity;
    if (r.anchor != r.position + r.velocity / run_.scenario.formation->gains.k3) return false;
    if (!at.before) return r.anchor_velocity == r.velocity;
    return !tracks_its_choice() || r.anchor_velocity == (*at.before)[i].chosen;
  }

  bool tracks_its_choice() const {
    const std::optional<formation::ControllerOptions>& options = run_.file.recording.controller_options;
    return options && options->filter_last && options->absolute_frame && !(options->acceleration_bound > 0.0);
  }

  /// No robot moves farther than its speed allows.
  void check_states(std::size_t row, const RowStates& from, const RowStates& to) override {
    const double time = static_cast<double>(to.step - from.step) * run_.scenario.time_step;
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      if (!run_.is_asked(row, i)) continue;
      const formation::Robot& robot = run_.scenario.robots[i];
      const double way = norm(to.robots[i].position - from.robots[i].position), most = time * robot.max_speed;
      if (way <= most * (1.0 + kRoundingOfSpeed)) {
        run_.tally.proven(AuditPoint::sequence);
        continue;
      }
      const auto [allowed, moved] = geometry::told_apart(most, way);
      ask(false, row, robot.id + " moves " + moved + " m, farther than the " + allowed + " m that its speed allows");
    }
  }

  void check_step(const RowInRun& at) override {
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      ask(follows(at.row.robots[i], at.next->robots[i]), at.number,
          run_.scenario.robots[i].id + " does not get to the next row by its law of motion");
    }
  }

  bool follows(const RobotStep& from, const RobotStep& to) const {
    if (!tracks_) {
      const Vec2 next = from.position + run_.file.recording.time_step * from.chosen;
      return to.velocity == from.chosen && to.position == next;
    }
    if (!law_) return false;  // a gain of 0 or less
    return tracks_its_choice() ? follows_tracking(from, to) : follows_something(from, to);
  }

  /// m: what a step's position may be off, of terms of this size; speeds in m/s are worth a step and what z makes of
  /// it.
  Rational rounding(const Rational& position, const Rational& speeds) const {
    const Rational z = law_->z, growth = 1 + z + z * z + z * z * z + z * z * z * z;
    return Rational(kRoundings) * (position + run_.duration * growth * speeds) + run_.duration * Rational(kSubnormal);
  }

  bool follows_tracking(const RobotStep& from, const RobotStep& to) const {
    if (!geometry::is_finite(from.chosen)) return false;
    const Point w = exactly(from.chosen), gap = exactly(from.velocity) - w, x0 = exactly(from.position);
    const Rational speeds = length_at_most(w) + length_at_most(exactly(from.velocity)) + length_at_most(gap);
    const Rational near = rounding(length_at_most(x0), speeds);
    const Point x = x0 + run_.duration * w + scaled(law_->reach, gap);
    if (length_at_most(exactly(to.position) - x) > near + law_->reach.half_width() * length_at_most(gap)) return false;
    const Point v = w + scaled(law_->remains, gap);
    const Rational off = law_->remains.half_width() * length_at_most(gap);
    return length_at_most(exactly(to.velocity) - v) <= rounding(Rational(0), speeds) / run_.duration + off;
  }

  /// With w eliminated: x1 - x0 = T v0 - (T - Q) / (1 - P) (v0 - v1).
  bool follows_something(const RobotStep& from, const RobotStep& to) const {
    const Interval settled = exactly_that(Rational(1)) - law_->remains;
    if (sgn(settled.low) <= 0) return true;  // rk4 far beyond its limit: the rows do not say what was tracked
    const Interval lag = (exactly_that(run_.duration) - law_->reach) / settled;
    const Point v0 = exactly(from.velocity), change = v0 - exactly(to.velocity);
    const Point x0 = exactly(from.position), x1 = exactly(to.position);
    const Point left = x1 - x0 - run_.duration * v0 + scaled(lag, change);
    const Rational speeds = length_at_most(v0) + length_at_most(change) / settled.low;
    return length_at_most(left) <=
           rounding(length_at_most(x0) + length_at_most(x1), 2 * speeds) + lag.half_width() * speeds;
  }

  const AuditedRun& run_;
  const bool tracks_;  ///< robots track what they choose
  std::optional<exact::ExactWay> leader_;
  std::optional<Law> law_;  ///< of robots that track
};

}  // namespace

std::unique_ptr<RowAudit> audit_sequence(const AuditedRun& run) {
  return std::make_unique<SequenceAudit>(run);
}

}  // namespace exactvo::datasets
