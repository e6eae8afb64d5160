// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision.h"

#include <algorithm>

#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/reciprocal.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

RobotConstraint record(const geometry::HalfPlane& h, bool certified, std::size_t other, const vo::MovingDisc& self,
                       const vo::MovingDisc& them, double tau) {
  RobotConstraint c;
  c.distance = norm(them.position - self.position);
  c.recorded.half_plane = h;
  c.recorded.source = ConstraintSource::robot;
  c.recorded.index = other;
  c.recorded.certified = certified;
  c.recorded.hard = false;
  c.recorded.shape = geometry::Disc{them.position, them.radius};
  c.recorded.position = self.position;
  c.recorded.radius = self.radius;
  c.recorded.tau = tau;
  c.recorded.shape_velocity = them.velocity;
  return c;
}

bool is_active(const lp::Solution& solution, std::size_t index) {
  for (std::size_t k = 0; k < solution.active_count; ++k)
    if (solution.active[k] == index) return true;
  return false;
}

}  // namespace

std::vector<std::vector<RobotConstraint>> robot_constraints(const Scenario& scenario, const SimulationOptions& options,
                                                            const std::vector<Vec2>& positions,
                                                            const std::vector<Vec2>& velocities) {
  const std::size_t n = scenario.robots.size();
  std::vector<std::vector<RobotConstraint>> out(n);
  vo::ReciprocalOptions pair_options;
  const bool baseline = options.method == Method::orca;
  pair_options.time_horizon = baseline ? scenario.horizons.orca : scenario.horizons.robots;
  pair_options.contact_time = contact_time(scenario);
  pair_options.margin = baseline ? 0.0 : scenario.margins.robot;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (norm(positions[i] - positions[j]) > scenario.neighbour_distance) continue;
      const vo::MovingDisc a{positions[i], velocities[i], scenario.robots[i].radius};
      const vo::MovingDisc b{positions[j], velocities[j], scenario.robots[j].radius};
      const bool a_yields = scenario.robots[i].cooperates, b_yields = scenario.robots[j].cooperates;
      pair_options.share_of_a = a_yields == b_yields ? 0.5 : (a_yields ? 1.0 : 0.0);
      const vo::ReciprocalHalfPlanes pair = vo::reciprocal_half_planes(a, b, pair_options);
      if (a_yields) out[i].push_back(record(pair.a, pair.certified, j, a, b, pair_options.time_horizon));
      if (b_yields) out[j].push_back(record(pair.b, pair.certified, i, b, a, pair_options.time_horizon));
    }
  }
  for (auto& mine : out)
    std::stable_sort(mine.begin(), mine.end(), [](const auto& x, const auto& y) { return x.distance < y.distance; });
  return out;
}

double contact_time(const Scenario& scenario) {
  return std::max(scenario.time_step, vo::ReciprocalOptions{}.contact_time);
}

lp::SpeedBound speed_bound(const Scenario& scenario, double max_speed) {
  lp::SpeedBound bound;
  if (scenario.speed_bound == SpeedBoundKind::disc) {
    bound.disc = max_speed;
  } else {
    bound.box_x = bound.box_y = max_speed;
  }
  return bound;
}

void decide(const Scenario& scenario, const DecisionInput& in, RobotStep& step) {
  lp::Problem problem;
  problem.bound = speed_bound(scenario, in.max_speed);
  problem.preferred = in.preferred;
  std::vector<RecordedConstraint> all;
  for (const StaticConstraint& c : *in.statics) all.push_back(c.recorded);
  for (const RobotConstraint& c : *in.robots) all.push_back(c.recorded);
  for (const RecordedConstraint& c : all)
    problem.constraints.push_back({c.half_plane, c.hard ? lp::Priority::hard : lp::Priority::soft});
  const lp::Solution solution = lp::solve(problem);
  step.preferred = in.preferred;
  step.chosen = solution.velocity;
  step.status = solution.status;
  step.violation = solution.violation;
  step.uncertified = 0;
  step.constraints.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].active = is_active(solution, i);
    if (!all[i].certified) ++step.uncertified;
    if (in.keep_all || all[i].active) step.constraints.push_back(std::move(all[i]));
  }
}

}  // namespace exactvo::formation::detail
