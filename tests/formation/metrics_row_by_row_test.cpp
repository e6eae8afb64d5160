// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics that are added up row by row, against formulas over the whole recording at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/infinity.h"
#include "motion/leader.h"

namespace exactvo::formation {
namespace {

using geometry::norm;
using geometry::Vec2;

using geometry::kInfinity;

// --- The oracle ---

void measure_paths(const Recording& recording, Metrics& m) {
  for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k)
    for (std::size_t i = 0; i < m.robots.size(); ++i)
      m.robots[i].path_length +=
          norm(recording.steps[k + 1].robots[i].position - recording.steps[k].robots[i].position);
}

/// The first row from which `error` stays within `tolerance` to the end.
template <typename Error>
std::optional<double> settled_since(const Recording& recording, double tolerance, const Error& error) {
  std::optional<double> since;
  for (std::size_t k = recording.steps.size(); k-- > 0;) {
    if (!(error(k) <= tolerance)) break;
    since = recording.steps[k].time;
  }
  return since;
}

double slot_error(const Recording& recording, std::size_t k, std::size_t i) {
  const Step& row = recording.steps[k];
  return norm(row.robots[i].position - row.leader_position - recording.offsets[i]);
}

/// The row from which a kinematic robot heads for its last goal: the run passes at most one goal on the way a row,
/// within the tolerance or the robot's radius.
std::size_t last_leg_since(const Scenario& scenario, const Recording& recording, std::size_t i) {
  const Robot& spec = scenario.robots[i];
  const double reach = std::max(scenario.arrival_tolerance, spec.radius);
  std::size_t goal = 0;
  std::size_t k = 0;
  for (; k < recording.steps.size() && goal + 1 < spec.goals.size(); ++k)
    if (norm(recording.steps[k].robots[i].position - spec.goals[goal]) <= reach) ++goal;
  return goal + 1 < spec.goals.size() ? recording.steps.size() : k;
}

void measure_arrival(const Scenario& scenario, const Recording& recording, Metrics& m) {
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    const std::size_t last_leg = scenario.formation ? 0 : last_leg_since(scenario, recording, i);
    const auto error = [&](std::size_t k) {
      if (k < last_leg) return kInfinity;
      return scenario.formation ? slot_error(recording, k, i)
                                : norm(recording.steps[k].robots[i].position - scenario.robots[i].goals.back());
    };
    m.robots[i].arrival_time = settled_since(recording, scenario.arrival_tolerance, error);
    if (m.leader_arrival_time && m.robots[i].arrival_time)
      m.robots[i].arrival_time = std::max(*m.robots[i].arrival_time, *m.leader_arrival_time);
    m.robots[i].arrived =
        m.robots[i].arrival_time.has_value() && (!scenario.formation || m.leader_arrival_time.has_value());
    if (!m.robots[i].arrived) m.robots[i].arrival_time.reset();
  }
  m.all_arrived = std::all_of(m.robots.begin(), m.robots.end(), [](const auto& r) { return r.arrived; });
  if (!m.all_arrived) return;
  m.last_arrival_time = 0.0;
  for (const RobotMetrics& r : m.robots) m.last_arrival_time = std::max(*m.last_arrival_time, *r.arrival_time);
}

void measure_formation(const Scenario& scenario, const Recording& recording, Metrics& m) {
  if (!scenario.formation) return;
  const double arrival = detail::leader_arrival(scenario.formation->leader);
  const Step& last = recording.steps.back();
  if (arrival <= last.time) m.leader_arrival_time = arrival;
  double position = 0.0, velocity = 0.0;
  for (std::size_t i = 0; i < last.robots.size(); ++i) {
    position = std::max(position, slot_error(recording, recording.steps.size() - 1, i));
    velocity = std::max(velocity, norm(last.robots[i].velocity - last.leader_velocity));
  }
  m.formation_position_error = position;
  m.formation_velocity_error = velocity;
}

/// The robots that the formation lost, and since when it holds.
void measure_course(const Scenario& scenario, const Recording& recording, Metrics& m) {
  if (!scenario.formation) return;
  FormationCourse& course = m.formation_course.emplace();
  const auto worst = [&](std::size_t k) {
    double error = 0.0;
    for (std::size_t i = 0; i < m.robots.size(); ++i) error = std::max(error, slot_error(recording, k, i));
    return error;
  };
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    double& mine = m.robots[i].largest_slot_error.emplace(0.0);
    for (std::size_t k = 1; k < recording.steps.size(); ++k) {
      const double error = slot_error(recording, k, i);
      mine = std::max(mine, error);
      if (!(error > course.largest_error)) continue;
      course.largest_error = error;
      course.largest_error_at = recording.steps[k].time;
      course.largest_error_of = m.robots[i].id;
    }
  }
  for (std::size_t k = 0; k < recording.steps.size() && !course.first_formed; ++k)
    if (worst(k) <= scenario.arrival_tolerance) course.first_formed = recording.steps[k].time;
  course.formed_since = settled_since(recording, scenario.arrival_tolerance, worst);
  const auto rows = static_cast<double>(recording.steps.size() - 1);
  double squares = 0.0;
  for (std::size_t k = 1; k < recording.steps.size(); ++k) {
    course.share_formed += (worst(k) <= scenario.arrival_tolerance) / rows;
    for (std::size_t i = 0; i < m.robots.size(); ++i) squares += std::pow(slot_error(recording, k, i), 2);
  }
  course.rms_error = std::sqrt(squares / (rows * static_cast<double>(m.robots.size())));
}

/// m: from a robot's start to its goals, or to its slot and on with the leader.
double direct_way(const Scenario& scenario, const Recording& recording, std::size_t i) {
  if (scenario.formation) {
    double way = slot_error(recording, 0, i);
    for (std::size_t k = 1; k < recording.steps.size(); ++k)
      way += norm(recording.steps[k].leader_position - recording.steps[k - 1].leader_position);
    return way;
  }
  double way = 0.0;
  Vec2 here = scenario.robots[i].position;
  for (Vec2 goal : scenario.robots[i].goals) {
    way += norm(goal - here);
    here = goal;
  }
  return way;
}

void measure_detours(const Scenario& scenario, const Recording& recording, Metrics& m) {
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    if (!scenario.formation && !m.robots[i].arrived) continue;
    m.robots[i].detour = std::max(0.0, m.robots[i].path_length - direct_way(scenario, recording, i));
  }
}

Vec2 acceleration(const Recording& recording, std::size_t k, std::size_t i) {
  return (recording.steps[k + 1].robots[i].velocity - recording.steps[k].robots[i].velocity) / recording.time_step;
}

/// rad: smaller turns have no sign worth counting.
constexpr double kLeastTurn = 1e-3;

/// `at_rest`: m/s, what is slower has no heading.
std::size_t reversals_of(const Recording& recording, std::size_t i, double at_rest) {
  std::size_t reversals = 0;
  double last_turn = 0.0;
  for (std::size_t k = 1; k < recording.steps.size(); ++k) {
    const Vec2 a = recording.steps[k - 1].robots[i].velocity;
    const Vec2 b = recording.steps[k].robots[i].velocity;
    const double turn = std::atan2(cross(a, b), dot(a, b));
    if (std::fabs(turn) < kLeastTurn || !(norm(a) > at_rest) || !(norm(b) > at_rest)) {
      last_turn = 0.0;
      continue;
    }
    if (turn * last_turn < 0.0) ++reversals;
    last_turn = turn;
  }
  return reversals;
}

/// What binds, whatever the order.
using ActiveSet = std::vector<std::tuple<ConstraintSource, std::size_t, std::size_t>>;
ActiveSet active_set(const RobotStep& step) {
  ActiveSet active;
  for (const DecisionConstraint& c : step.constraints)
    if (c.active) active.emplace_back(c.source, c.index, c.piece);
  std::sort(active.begin(), active.end());
  return active;
}

void measure_jitter(const Scenario& scenario, const Recording& recording, Metrics& m) {
  const std::size_t rows = recording.steps.size();
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    for (std::size_t k = 0; k + 2 < rows; ++k)
      m.jitter += norm(acceleration(recording, k + 1, i) - acceleration(recording, k, i));
    for (std::size_t k = 0; k + 1 < rows; ++k) {
      const double a = norm(acceleration(recording, k, i));
      m.peak_acceleration = std::max(m.peak_acceleration, a);
      m.velocity_variation += a * recording.time_step;
    }
    m.heading_reversals += reversals_of(recording, i, 1e-3 * scenario.robots[i].max_speed);
    for (std::size_t k = 1; k + 1 < rows; ++k)
      if (active_set(recording.steps[k].robots[i]) != active_set(recording.steps[k - 1].robots[i]))
        ++m.active_set_switches;
  }
}

void count_decisions(const Recording& recording, Metrics& m) {
  for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k) {
    for (const RobotStep& r : recording.steps[k].robots) {
      if (r.status != lp::Status::optimal) ++m.relaxed_steps;
      m.uncertified_half_planes += r.uncertified;
    }
  }
  m.steps = recording.steps.size() - 1;
}

Metrics measured_at_once(const Scenario& scenario, const Recording& recording) {
  Metrics m;
  for (const Robot& r : scenario.robots) m.robots.emplace_back().id = r.id;
  measure_formation(scenario, recording, m);
  measure_arrival(scenario, recording, m);
  measure_paths(recording, m);
  measure_course(scenario, recording, m);
  measure_detours(scenario, recording, m);
  measure_jitter(scenario, recording, m);
  count_decisions(recording, m);
  return m;
}

// --- The tests ---

void expect_same(const Scenario& scenario, const Recording& recording, const std::string& what) {
  SCOPED_TRACE(what);
  const Metrics one = measure(scenario, recording), other = measured_at_once(scenario, recording);
  EXPECT_EQ(one.all_arrived, other.all_arrived);
  EXPECT_EQ(one.last_arrival_time, other.last_arrival_time);
  EXPECT_EQ(one.formation_position_error, other.formation_position_error);
  EXPECT_EQ(one.formation_velocity_error, other.formation_velocity_error);
  EXPECT_EQ(one.leader_arrival_time, other.leader_arrival_time);
  // Sums over robots are taken in another order.
  EXPECT_NEAR(one.jitter, other.jitter, 1e-12 * other.jitter);
  EXPECT_NEAR(one.velocity_variation, other.velocity_variation, 1e-12 * other.velocity_variation);
  EXPECT_EQ(one.peak_acceleration, other.peak_acceleration);
  EXPECT_EQ(one.heading_reversals, other.heading_reversals);
  EXPECT_EQ(one.active_set_switches, other.active_set_switches);
  EXPECT_EQ(one.relaxed_steps, other.relaxed_steps);
  EXPECT_EQ(one.uncertified_half_planes, other.uncertified_half_planes);
  EXPECT_EQ(one.steps, other.steps);
  for (std::size_t i = 0; i < one.robots.size(); ++i) {
    const RobotMetrics &a = one.robots[i], &b = other.robots[i];
    EXPECT_EQ(a.arrived, b.arrived);
    EXPECT_EQ(a.arrival_time, b.arrival_time);
    EXPECT_EQ(a.path_length, b.path_length);
    EXPECT_EQ(a.detour, b.detour);
    EXPECT_EQ(a.largest_slot_error, b.largest_slot_error);
  }
  ASSERT_EQ(one.formation_course.has_value(), other.formation_course.has_value());
  if (!one.formation_course) return;
  const FormationCourse &a = *one.formation_course, &b = *other.formation_course;
  EXPECT_EQ(a.largest_error, b.largest_error);
  EXPECT_EQ(a.largest_error_at, b.largest_error_at);
  EXPECT_EQ(a.largest_error_of, b.largest_error_of);
  EXPECT_EQ(a.first_formed, b.first_formed);
  EXPECT_EQ(a.formed_since, b.formed_since);
  EXPECT_NEAR(a.share_formed, b.share_formed, 1e-9);
  EXPECT_NEAR(a.rms_error, b.rms_error, 1e-9 * b.rms_error);
}

Scenario paper_scenario(const std::string& name) {
  return datasets::load_scenario(EXACTVO_SOURCE_DIR "/datasets/data/paper/" + name + ".json");
}

TEST(MetricsRowByRow, AreThoseOfTheWholeRun) {
  for (const char* name : {"A1", "A2", "A7", "A9", "A14", "A15"})
    for (const Method method : {Method::orca, Method::ivo}) {
      const Scenario s = paper_scenario(name);
      SimulationOptions options;
      options.method = method;
      expect_same(s, simulate(s, options), std::string(name) + " " + formation::name(method));
    }
  for (const char* name : {"B0", "B2", "B3"})
    for (const Controller controller : {Controller::paper_literal, Controller::standard}) {
      Scenario s = paper_scenario(name);
      s.time_limit = std::min(s.time_limit, 20.0);
      SimulationOptions options;
      options.controller = controller;
      expect_same(s, simulate(s, options), std::string(name) + " " + formation::name(controller));
    }
}

TEST(MetricsRowByRow, OfShortRunsToo) {
  const Scenario s = paper_scenario("A9");
  const Recording whole = simulate(s);
  for (const std::size_t rows : {1u, 2u, 3u, 10u}) {
    Recording cut = whole;
    cut.steps.resize(rows);
    expect_same(s, cut, std::to_string(rows) + " rows");
  }
}

/// A sink that checks the order in which a run arrives.
class Order : public RunSink {
 public:
  void begin(const Recording& run) override {
    EXPECT_EQ(begun_++, 0);
    EXPECT_GT(run.time_step, 0.0);
    EXPECT_TRUE(run.steps.empty());
  }
  void add_body(const vo::Body&) override { ++bodies_; }
  void add_plan(const JointPlan& plan) override {
    EXPECT_EQ(plan.row, rows_);
    ++plans_;
  }
  void add_goal_bodies(const GoalBodies& of_goal) override {
    EXPECT_EQ(begun_, 1);
    for (const std::size_t body : of_goal.bodies) EXPECT_LT(body, bodies_);
    EXPECT_GE(of_goal.time, time_);
    ++goal_bodies_;
  }
  void add_row(Step row) override {
    EXPECT_GT(row.time, time_);
    time_ = row.time;
    for (const RobotStep& robot : row.robots)
      for (const DecisionConstraint& c : robot.constraints) EXPECT_LT(c.body, bodies_);
    if (++rows_ == throws_at) throw std::runtime_error("full");
  }

  std::size_t throws_at = 0;
  std::size_t rows_ = 0, bodies_ = 0, goal_bodies_ = 0, plans_ = 0;

 private:
  int begun_ = 0;
  double time_ = -1.0;
};

TEST(RunSink, GetsBodiesAndGoalBodiesBeforeTheRowsThatNameThem) {
  for (const char* name : {"A9", "A14", "B3"}) {
    Scenario s = paper_scenario(name);
    s.time_limit = std::min(s.time_limit, 10.0);
    Order order;
    const Recording end = simulate(s, {}, order);
    const Recording whole = simulate(s);
    EXPECT_EQ(order.rows_, whole.steps.size());
    EXPECT_EQ(order.bodies_, whole.bodies.size());
    EXPECT_EQ(order.goal_bodies_, whole.goal_bodies.size());
    EXPECT_TRUE(end.steps.empty());
    EXPECT_EQ(end.outcome, whole.outcome);
    EXPECT_EQ(end.diverged, whole.diverged);
    EXPECT_EQ(has_diverged(whole), whole.diverged);
  }
}

TEST(RunSink, OneThatThrowsEndsTheRun) {
  Order order;
  order.throws_at = 5;
  EXPECT_THROW(simulate(paper_scenario("A9"), {}, order), std::runtime_error);
  EXPECT_EQ(order.rows_, 5u);
}

TEST(RunSink, GetsTheRowsUntilARunIsStopped) {
  Order order;
  SimulationOptions options;
  options.stop_at = 1.0;
  simulate(paper_scenario("A9"), options, order);
  EXPECT_EQ(order.rows_, simulate(paper_scenario("A9"), options).steps.size());
}

}  // namespace
}  // namespace exactvo::formation
