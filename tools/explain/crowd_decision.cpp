// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain/crowd_decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "support/terminal.h"

namespace exactvo::tools {

using formation::ConstraintSource;
using formation::Crowd;
using formation::CrowdExplanation;
using formation::RobotStep;
using formation::Scenario;

namespace {

/// m/s: a velocity of the lattice this near to a line counts as on it.
constexpr double kOnLatticeLine = 1e-4;

/// The obstacle that has these ends among its corners, if one has.
std::vector<std::size_t> obstacle_of(const geometry::Segment& edge, const Scenario& scenario) {
  for (std::size_t o = 0; o < scenario.obstacles.size(); ++o) {
    const std::vector<Vec2> corners = geometry::vertices_of(scenario.obstacles[o].shape);
    const auto has = [&](Vec2 p) { return std::find(corners.begin(), corners.end(), p) != corners.end(); };
    if (has(edge.a) && has(edge.b)) return {o};
  }
  return {};
}

/// Takes one decision, right before it is carried out.
class AtStep : public formation::RunSink {
 public:
  AtStep(const Scenario& scenario, std::string method, std::size_t robot, std::size_t step)
      : scenario_(scenario), method_(std::move(method)), robot_(robot), step_(step) {}

  void before_step(const formation::RunState& now) override {
    if (now.steps == step_) take(now);
  }
  CrowdDecision& taken() { return taken_; }

 private:
  void take(const formation::RunState& now) {
    const Crowd& crowd = *now.crowd;
    const CrowdExplanation e = crowd.explain(static_cast<formation::RobotId>(robot_));
    formation::Step row = places(now);
    RobotStep& step = row.robots[robot_];
    step.preferred = e.preferred;
    step.chosen = e.chosen;
    // What does not turn it is not listed: the second level of the step slows it down.
    const std::vector<CrowdExplanation::Neighbour> none;
    if (e.reserved) step.note = "drives straight to a place that it has reserved; half-planes of robots do not turn it";
    Decision& d = taken_.decision.emplace();
    d.scenario = scenario_;
    d.method = method_;
    d.robot = robot_;
    d.time = row.time;
    for (const CrowdExplanation::Neighbour& n : e.reserved ? none : e.neighbours)
      add(d, step, n.half_plane, ConstraintSource::robot, n.robot, geometry::Disc{{}, 0.0}, {n.robot}, n.touching);
    for (const CrowdExplanation::Edge& edge : e.edges)
      add(d, step, edge.half_plane, ConstraintSource::obstacle_edge, step.constraints.size(), edge.edge,
          obstacle_of(edge.edge, scenario_), edge.touching);
    for (const CrowdExplanation::Body& body : e.bodies) {
      const Owner owner = owner_of(crowd, body.body);
      add(d, step, body.half_plane, owner.source, owner.number, owner.shape, {owner.number}, body.touching);
    }
    step.status = e.kept || step.constraints.empty() ? lp::Status::optimal : lp::Status::relaxed;
    for (const formation::DecisionConstraint& c : step.constraints) {
      step.violation = std::max(step.violation, violation_of(c, step.chosen));
      d.seen.push_back(formation::seen_body(scenario_, d.bodies, row, robot_, c));
    }
    d.step = std::move(step);
    add_remarks(e);
  }

  static formation::Step places(const formation::RunState& now) {
    formation::Step row;
    row.time = now.time;
    row.robots.resize(now.positions.size());
    for (std::size_t i = 0; i < now.positions.size(); ++i) {
      row.robots[i].position = row.robots[i].anchor = now.positions[i];
      row.robots[i].velocity = row.robots[i].anchor_velocity = now.velocities[i];
    }
    for (const formation::CrowdBodyState& body : now.crowd->bodies())
      if (body.moves) row.moving.push_back({body.displacement, body.velocity});
    return row;
  }

  /// What a body of the crowd is in the scenario.
  struct Owner {
    ConstraintSource source;
    std::size_t number;  ///< of the obstacle, or of the moving obstacle
    geometry::ConvexShape shape;
  };

  /// Of bodies that move, and of discs at rest, each in the order of the scenario.
  Owner owner_of(const Crowd& crowd, formation::ObstacleId id) const {
    std::size_t moving = 0, obstacle = 0;
    for (const formation::CrowdBodyState& body : crowd.bodies()) {
      while (!body.moves && !scenario_.obstacles.at(obstacle).disc) ++obstacle;  // it has edges instead
      if (body.id == id && body.moves) return {ConstraintSource::moving_obstacle, moving, geometry::Disc{{}, 0.0}};
      if (body.id == id) return {ConstraintSource::enclosure, obstacle, body.shape};
      ++(body.moves ? moving : obstacle);
    }
    throw std::logic_error("a half-plane against no body of the crowd");
  }

  void add(Decision& d, RobotStep& step, const geometry::HalfPlane& half_plane, ConstraintSource source,
           std::size_t index, geometry::ConvexShape shape, std::vector<std::size_t> owners, bool touching) const {
    formation::DecisionConstraint c;
    c.half_plane = half_plane;
    c.source = source;
    c.index = index;
    c.certified = !touching;
    c.hard = source != ConstraintSource::robot;
    c.active = violation_of(c, step.chosen) > -kOnLatticeLine;
    c.time_horizon = scenario_.horizons.orca;
    c.body = d.bodies.size();
    step.constraints.push_back(c);
    d.bodies.push_back({source, std::move(shape), {}, std::move(owners)});
  }

  void add_remarks(const CrowdExplanation& e) {
    if (!(e.wish == e.chosen))
      taken_.remarks.push_back(
          fmt::format("Wished for ({:.3g}, {:.3g}) m/s, and does not get it: another robot would be met within the "
                      "step, which counts more than any half-plane.",
                      e.wish.x, e.wish.y));
    taken_.remarks.push_back(
        "Computed again: decisions of the run are not recorded, and the multipliers of its "
        "half-planes are not known.");
  }

  const Scenario& scenario_;
  std::string method_;
  std::size_t robot_, step_;
  CrowdDecision taken_;
};

}  // namespace

CrowdDecision crowd_decision(const Scenario& scenario, formation::SimulationOptions options, const std::string& method,
                             std::size_t robot, double time) {
  constexpr double kSameRow = 1e-6;  // of a step
  AtStep at(scenario, method, robot, static_cast<std::size_t>(time / scenario.time_step + kSameRow));
  options.progress = [&](double) { return !interrupted() && !at.taken().decision; };
  const formation::RunReport report = run_crowd(scenario, options, &at);
  if (interrupted()) throw Interrupted();
  at.taken().end = report.time;
  return std::move(at.taken());
}

}  // namespace exactvo::tools
