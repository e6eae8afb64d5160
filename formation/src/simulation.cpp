// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "consensus.h"
#include "decision.h"
#include "exactvo/geometry/require.h"
#include "integrators.h"
#include "leader.h"
#include "static_field.h"
#include "steering.h"

namespace exactvo::formation {
namespace {

using namespace detail;
using geometry::norm;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Calls the caller's progress function about ten times a second of wall time.
class Heartbeat {
 public:
  explicit Heartbeat(const SimulationOptions& options) : options_(&options) {}
  /// False when the caller wants to stop.
  bool beat(double time) {
    constexpr double kInterval = 0.1;  // s of wall time
    if (!options_->progress || seconds_since(last_) < kInterval) return true;
    last_ = Clock::now();
    return options_->progress(time);
  }

 private:
  const SimulationOptions* options_;
  Clock::time_point last_ = Clock::now();
};

/// The last decision before `stop_at` keeps all its half-planes.
bool is_last_wanted(const SimulationOptions& options, double time, double dt) {
  return options.stop_at >= 0.0 && time + dt > options.stop_at;
}

// --- Kinematic robots (Section V.A) ---

struct KinematicRobot {
  Vec2 position;
  Vec2 velocity;
  std::size_t goal = 0;
  std::optional<StaticField> field;
  Follower follower;
};

class KinematicRun {
 public:
  KinematicRun(const Scenario& scenario, const SimulationOptions& options)
      : scenario_(scenario), options_(options), library_(scenario) {
    for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
      robots_.push_back({scenario.robots[i].position, scenario.robots[i].velocity, 0, std::nullopt, {}});
      look_at_goal(i);
    }
  }

  Recording run() {
    Recording recording;
    recording.motion = MotionLaw::straight;
    recording.time_step = scenario_.time_step;
    Heartbeat heartbeat(options_);
    const auto steps = static_cast<std::size_t>(std::ceil(scenario_.time_limit / scenario_.time_step - 1e-9));
    for (std::size_t k = 0;; ++k) {
      const double time = static_cast<double>(k) * scenario_.time_step;
      const bool wanted_stop = options_.stop_at >= 0.0 && time > options_.stop_at;
      if (k == steps || all_arrived() || wanted_stop || !heartbeat.beat(time)) {
        recording.steps.push_back(final_row(time));
        break;
      }
      recording.steps.push_back(decide_all(time));
      move(recording.steps.back());
    }
    recording.outcome = outcome();
    return recording;
  }

 private:
  Vec2 goal_of(std::size_t i) const { return scenario_.robots[i].goals[robots_[i].goal]; }

  void look_at_goal(std::size_t i) {
    const Robot& spec = scenario_.robots[i];
    robots_[i].field.emplace(library_, scenario_, options_, spec.radius, robots_[i].position, goal_of(i),
                             HorizonRule::clamped);
    robots_[i].follower.reset();
  }

  bool at_goal(std::size_t i) const {
    const bool last = robots_[i].goal + 1 == scenario_.robots[i].goals.size();
    return last && norm(goal_of(i) - robots_[i].position) <= scenario_.arrival_tolerance;
  }

  bool all_arrived() const {
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (!at_goal(i)) return false;
    return true;
  }

  /// A goal on the way counts as reached within the robot's own radius.
  void pass_waypoint(std::size_t i) {
    const Robot& spec = scenario_.robots[i];
    const double reach = std::max(scenario_.arrival_tolerance, spec.radius);
    if (robots_[i].goal + 1 >= spec.goals.size() || norm(goal_of(i) - robots_[i].position) > reach) return;
    ++robots_[i].goal;
    look_at_goal(i);
  }

  Step decide_all(double time) {
    std::vector<Vec2> positions, velocities;
    for (const KinematicRobot& r : robots_) {
      positions.push_back(r.position);
      velocities.push_back(r.velocity);
    }
    const auto robot_lines = robot_constraints(scenario_, options_, positions, velocities);
    Step row;
    row.time = time;
    for (std::size_t i = 0; i < robots_.size(); ++i) row.robots.push_back(decide_one(i, time, robot_lines[i]));
    return row;
  }

  RobotStep decide_one(std::size_t i, double time, const std::vector<RobotConstraint>& robot_lines) {
    pass_waypoint(i);
    const Robot& spec = scenario_.robots[i];
    KinematicRobot& r = robots_[i];
    const std::vector<StaticConstraint> statics =
        r.field->constraints({r.position, r.velocity, spec.radius, spec.max_speed});
    RobotStep step;
    step.position = r.position;
    step.velocity = r.velocity;
    const Vec2 preferred = steer(i, time, statics, step);
    decide(scenario_,
           {preferred, spec.max_speed, &statics, &robot_lines,
            options_.record_all || is_last_wanted(options_, time, scenario_.time_step)},
           step);
    return step;
  }

  Vec2 straight_for_goal(std::size_t i) const {
    const Vec2 to_goal = goal_of(i) - robots_[i].position;
    const double speed = std::min(scenario_.robots[i].max_speed, norm(to_goal) / scenario_.time_step);
    return speed * geometry::normalized(to_goal);
  }

  Vec2 steer(std::size_t i, double time, const std::vector<StaticConstraint>& statics, RobotStep& step) {
    const Vec2 preferred = straight_for_goal(i);
    if (at_goal(i)) {
      step.mode = Mode::arrived;
      return preferred;
    }
    if (!statics.empty() && statics.front().distance < 0.0) step.mode = Mode::pushing_out;
    if (options_.method == Method::orca) return preferred;
    if (options_.method != Method::ivo) return with_tie_broken(statics, preferred);
    const Robot& spec = scenario_.robots[i];
    const Viewpoint here{robots_[i].position, robots_[i].velocity, spec.radius, spec.max_speed};
    const Follower::Answer answer =
        robots_[i].follower.steer({time, scenario_.time_step, here, goal_of(i),
                                   spec.max_speed * scenario_.horizons.least, preferred, &*robots_[i].field},
                                  statics);
    step.mode = answer.mode;
    step.side = answer.side;
    step.note = answer.note;
    if (answer.mode == Mode::following) return answer.preferred;
    const std::optional<Vec2> boost = boosted(statics, preferred);
    if (!boost) return with_tie_broken(statics, preferred);
    step.mode = Mode::boost;
    return *boost;
  }

  void move(const Step& row) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      robots_[i].velocity = row.robots[i].chosen;
      robots_[i].position += scenario_.time_step * row.robots[i].chosen;
    }
  }

  Step final_row(double time) const {
    Step row;
    row.time = time;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      RobotStep step;
      step.position = robots_[i].position;
      step.velocity = robots_[i].velocity;
      if (at_goal(i)) step.mode = Mode::arrived;
      row.robots.push_back(step);
    }
    return row;
  }

  std::string outcome() const {
    std::size_t arrived = 0;
    for (std::size_t i = 0; i < robots_.size(); ++i) arrived += at_goal(i);
    if (arrived == robots_.size()) return "all robots arrived";
    return std::to_string(robots_.size() - arrived) + " of " + std::to_string(robots_.size()) +
           " robots did not arrive within the time limit";
  }

  const Scenario& scenario_;
  const SimulationOptions& options_;
  ObstacleLibrary library_;
  std::vector<KinematicRobot> robots_;
};

// --- Formations (Sections IV and V.B) ---

struct FormationRobot {
  BodyState body;
  Vec2 tracked;  ///< w of the step before
  StaticField field;
  SideCommitment side;
};

class FormationRun {
 public:
  FormationRun(const Scenario& scenario, const SimulationOptions& options)
      : scenario_(scenario),
        spec_(*scenario.formation),
        options_(options),
        library_(scenario),
        offsets_(offsets_in_use(spec_, options.controller)) {
    const HorizonRule rule = options.controller == Controller::standard ? HorizonRule::clamped : HorizonRule::literal;
    for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
      const Robot& r = scenario.robots[i];
      const Vec2 slot = spec_.leader.path.back() + offsets_[i];
      robots_.push_back({{r.position, r.velocity},
                         r.velocity,
                         StaticField(library_, scenario, options, r.radius, r.position, slot, rule),
                         {}});
    }
  }

  Recording run() {
    Recording recording;
    recording.motion = motion_of(options_.integrator);
    recording.time_step = scenario_.time_step;
    recording.tracking_gain = spec_.gains.k3;
    recording.offsets = offsets_;
    Heartbeat heartbeat(options_);
    const auto steps = static_cast<std::size_t>(std::ceil(scenario_.time_limit / scenario_.time_step - 1e-9));
    for (std::size_t k = 0;; ++k) {
      const double time = static_cast<double>(k) * scenario_.time_step;
      const bool wanted_stop = options_.stop_at >= 0.0 && time > options_.stop_at;
      if (k == steps || wanted_stop || out_of_bounds() || !heartbeat.beat(time)) {
        recording.steps.push_back(state_row(time));
        break;
      }
      recording.steps.push_back(decide_all(time));
      move(recording.steps.back());
    }
    judge(recording);
    return recording;
  }

 private:
  bool standard() const { return options_.controller == Controller::standard; }

  /// Where half-planes are built: the brake point x + v / k3, whose velocity is exactly w; the paper builds them at x.
  Vec2 anchor(std::size_t i) const {
    const BodyState& b = robots_[i].body;
    return standard() ? b.position + b.velocity / spec_.gains.k3 : b.position;
  }
  Vec2 anchor_velocity(std::size_t i) const { return standard() ? robots_[i].tracked : robots_[i].body.velocity; }

  RelativeState relative_to(const LeaderState& leader) const {
    RelativeState s;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      s.position.push_back(robots_[i].body.position - leader.position - offsets_[i]);
      s.velocity.push_back(robots_[i].body.velocity - leader.velocity);
    }
    return s;
  }

  Step decide_all(double time) {
    Step row = state_row(time);
    const LeaderState leader{row.leader_position, row.leader_velocity};
    const RelativeState relative = relative_to(leader);
    std::vector<Vec2> anchors, velocities;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      anchors.push_back(anchor(i));
      velocities.push_back(anchor_velocity(i));
    }
    const auto robot_lines = robot_constraints(scenario_, options_, anchors, velocities);
    for (std::size_t i = 0; i < robots_.size(); ++i)
      decide_one(i, time, leader, relative, robot_lines[i], row.robots[i]);
    return row;
  }

  void decide_one(std::size_t i, double time, const LeaderState& leader, const RelativeState& relative,
                  const std::vector<RobotConstraint>& robot_lines, RobotStep& step) {
    const double max_speed = scenario_.robots[i].max_speed;
    const std::vector<StaticConstraint> statics =
        robots_[i].field.constraints({anchor(i), anchor_velocity(i), scenario_.robots[i].radius, max_speed});
    const Vec2 preferred = preference(i, leader, relative, statics, step);
    decide(scenario_,
           {preferred, max_speed, &statics, &robot_lines,
            options_.record_all || is_last_wanted(options_, time, scenario_.time_step)},
           step);
  }

  Vec2 preference(std::size_t i, const LeaderState& leader, const RelativeState& relative,
                  const std::vector<StaticConstraint>& statics, RobotStep& step) {
    const double max_speed = scenario_.robots[i].max_speed;
    if (!standard()) {
      const double sign = options_.controller == Controller::paper_literal ? 1.0 : -1.0;
      return sign * printed_preference(relative.position[i], max_speed);
    }
    const Vec2 input = consensus_input(spec_, relative, i, -1.0);
    const Vec2 wanted = saturated_preference(spec_, relative.position[i], leader.velocity) + input / spec_.gains.k3;
    const SideCommitment::Answer answer = robots_[i].side.steer(wanted, std::min(norm(wanted), max_speed), statics);
    step.side = answer.side;
    if (answer.side != 0) step.mode = Mode::following;
    return answer.preferred;
  }

  /// What v follows: the filter's answer itself, or, in the paper's order, the sum in which it is one term.
  Vec2 tracked_velocity(std::size_t i, const Step& row, const RelativeState& relative) const {
    const Vec2 chosen = row.robots[i].chosen;
    if (standard()) return chosen;
    const double sign = options_.controller == Controller::paper_literal ? 1.0 : -1.0;
    const Vec2 input = consensus_input(spec_, relative, i, sign);
    return row.leader_velocity + chosen + input / spec_.gains.k3;
  }

  void move(const Step& row) {
    const RelativeState relative = relative_to({row.leader_position, row.leader_velocity});
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      robots_[i].tracked = tracked_velocity(i, row, relative);
      robots_[i].body =
          step_body(options_.integrator, robots_[i].body, robots_[i].tracked, spec_.gains.k3, scenario_.time_step);
    }
  }

  Step state_row(double time) const {
    Step row;
    row.time = time;
    const LeaderState leader = leader_at(spec_.leader, time);
    row.leader_position = leader.position;
    row.leader_velocity = leader.velocity;
    for (const FormationRobot& r : robots_) {
      RobotStep step;
      step.position = r.body.position;
      step.velocity = r.body.velocity;
      row.robots.push_back(step);
    }
    return row;
  }

  /// m: beyond this nothing is worth computing (an explicit Euler step past its limit gets here in seconds).
  static constexpr double kOutOfBounds = 1e6;

  bool out_of_bounds() const {
    for (const FormationRobot& r : robots_)
      if (!(norm(r.body.position) < kOutOfBounds && norm(r.body.velocity) < kOutOfBounds)) return true;
    return false;
  }

  double error_in(const Step& row) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < row.robots.size(); ++i)
      worst = std::max(worst, norm(row.robots[i].position - row.leader_position - offsets_[i]));
    return worst;
  }

  void judge(Recording& recording) const {
    const double first = error_in(recording.steps.front());
    const double last = error_in(recording.steps.back());
    // Judged by the end alone: a formation that ends farther from its slots than it began has not formed.
    constexpr double kArrivedOnce = 1.0;  // m: an error this small is no divergence even when the start was exact
    recording.diverged = out_of_bounds() || last > std::max(first, kArrivedOnce);
    recording.outcome = recording.diverged ? "diverged: the formation error grew from " + std::to_string(first) +
                                                 " m to " + std::to_string(last) + " m"
                                           : "formation error " + std::to_string(last) + " m at the end";
  }

  const Scenario& scenario_;
  const FormationSpec& spec_;
  const SimulationOptions& options_;
  ObstacleLibrary library_;
  std::vector<Vec2> offsets_;
  std::vector<FormationRobot> robots_;
};

}  // namespace

Recording simulate(const Scenario& scenario, const SimulationOptions& options) {
  const std::vector<ScenarioProblem> problems = validate(scenario);
  EXACTVO_REQUIRE(problems.empty(),
                  problems.front().pointer + ": " + problems.front().found + ", expected " + problems.front().expected);
  const Clock::time_point start = Clock::now();
  Recording recording =
      scenario.formation ? FormationRun(scenario, options).run() : KinematicRun(scenario, options).run();
  recording.wall_time = seconds_since(start);
  return recording;
}

std::vector<geometry::ConvexShape> enclosures_for(const Scenario& scenario, const SimulationOptions& options,
                                                  std::size_t robot) {
  EXACTVO_REQUIRE(robot < scenario.robots.size(), std::to_string(robot));
  const Robot& r = scenario.robots[robot];
  const ObstacleLibrary library(scenario);
  const Vec2 goal = scenario.formation ? scenario.formation->leader.path.back() +
                                             offsets_in_use(*scenario.formation, options.controller)[robot]
                                       : r.goals.front();
  const StaticField field(library, scenario, options, r.radius, r.position, goal, HorizonRule::clamped);
  std::vector<geometry::ConvexShape> shapes;
  for (const geometry::Enclosure& e : field.enclosures()) shapes.push_back(e.shape);
  return shapes;
}

}  // namespace exactvo::formation
