// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/decision.h"

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/reciprocal.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

/// The farthest velocity of a box bound, in sides of it.
const double kFastest = std::sqrt(2.0);

/// m: how much nearer two that have these speeds together can come within a step.
double reach_within(double time_step, double speeds) {
  constexpr double kRounding = 1.0 + 1e-6;  // clearances are rounded
  return kRounding * time_step * speeds;
}

Constraint against_robot(const geometry::HalfPlane& h, bool certified, std::size_t other, const Scene& scene,
                         const vo::MovingDisc& self, const vo::MovingDisc& them, double tau) {
  Constraint c;
  c.half_plane = h;
  c.body = scene.robot(other);
  c.priority = lp::Priority::soft;
  c.proof = certified ? vo::Proof::pair : vo::Proof::none;
  const Vec2 apart = self.position - them.position;
  c.clearance = norm(apart) - (self.radius + them.radius);
  c.normal = geometry::normalized(apart);
  c.time_horizon = tau;
  c.index = other;
  return c;
}

/// What binds at that constraint; nothing where it does not.
const lp::ActiveConstraint* active_at(const lp::Solution& solution, std::size_t index) {
  for (std::size_t k = 0; k < solution.active_count; ++k)
    if (solution.active[k].binding == lp::constraint_at(index)) return &solution.active[k];
  return nullptr;
}

/// By the distance of the centres; of robots equally near, by their numbers.
void sort_by_distance(const std::vector<Anchor>& anchors, std::size_t self, std::vector<Constraint>& mine) {
  const auto distance = [&](const Constraint& c) { return norm(anchors[c.index].position - anchors[self].position); };
  std::sort(mine.begin(), mine.end(), [&](const Constraint& x, const Constraint& y) {
    const double dx = distance(x), dy = distance(y);
    return dx != dy ? dx < dy : x.index < y.index;
  });
}

/// Both halves of a pair.
struct PairConstraints {
  Constraint of_a, of_b;
};

PairConstraints against_each_other(const Scene& scene, std::size_t i, const vo::MovingDisc& a, std::size_t j,
                                   const vo::MovingDisc& b, const vo::ReciprocalOptions& options) {
  const vo::ReciprocalHalfPlanes pair = vo::reciprocal_half_planes(a, b, options);
  const double tau = options.time_horizon;
  return {against_robot(pair.a, pair.certified, j, scene, a, b, tau),
          against_robot(pair.b, pair.certified, i, scene, b, a, tau)};
}

Constraint* against(std::size_t robot, const Scene& scene, std::vector<Constraint>& all) {
  for (Constraint& c : all)
    if (scene.bodies()[c.body].kind == vo::BodyKind::robot && c.index == robot) return &c;
  return nullptr;
}

/// The half-planes of two robots that stand still, which keep a skin between them. Where it is used up, neither comes
/// nearer.
PairConstraints at_rest(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene, std::size_t i,
                        std::size_t j, double time_horizon) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = time_horizon;
  const vo::MovingDisc a{anchors[i].position, {}, scenario.robots[i].radius};
  const vo::MovingDisc b{anchors[j].position, {}, scenario.robots[j].radius};
  const bool is_in_contact = norm(a.position - b.position) - (a.radius + b.radius) <= kContactSkin;
  if (!is_in_contact) options.margin = kContactSkin;
  PairConstraints pair = against_each_other(scene, i, a, j, b, options);
  if (is_in_contact)
    for (Constraint* c : {&pair.of_a, &pair.of_b}) c->half_plane.offset = std::max(0.0, c->half_plane.offset);
  return pair;
}

/// Both go by a plan.
PairConstraints with_plans(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene,
                           std::size_t i, Vec2 of_i, std::size_t j, Vec2 of_j) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = scenario.time_step;
  const vo::MovingDisc a{anchors[i].position, of_i, scenario.robots[i].radius};
  const vo::MovingDisc b{anchors[j].position, of_j, scenario.robots[j].radius};
  return against_each_other(scene, i, a, j, b, options);
}

/// One of them goes by a plan: the whole gap is its.
PairConstraints with_a_plan(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene,
                            std::size_t i, std::size_t j, bool it_is_i) {
  PairConstraints pair = at_rest(scenario, anchors, scene, i, j, scenario.time_step);
  const double whole = 2.0 * std::max(pair.of_a.half_plane.offset, pair.of_b.half_plane.offset);
  pair.of_a.half_plane.offset = it_is_i ? whole : 0.0;
  pair.of_b.half_plane.offset = it_is_i ? 0.0 : whole;
  return pair;
}

}  // namespace

void robot_constraints(const Scenario& scenario, const SimulationOptions& options, const std::vector<Anchor>& anchors,
                       Scene& scene, std::vector<std::vector<Constraint>>& out) {
  const std::size_t n = scenario.robots.size();
  out.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i].clear();
    scene.bodies().move(scene.robot(i), geometry::Disc{anchors[i].position, scenario.robots[i].radius},
                        anchors[i].velocity);
  }
  vo::ReciprocalOptions pair_options;
  const bool baseline = options.method == Method::orca;
  pair_options.time_horizon = baseline ? scenario.horizons.orca : scenario.horizons.robots;
  pair_options.contact_time = contact_time(scenario);
  pair_options.margin = baseline ? 0.0 : scenario.margins.robot;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (norm(anchors[i].position - anchors[j].position) > scenario.neighbour_distance) continue;
      const bool a_yields = scenario.robots[i].cooperates, b_yields = scenario.robots[j].cooperates;
      pair_options.share_of_a = a_yields == b_yields ? 0.5 : (a_yields ? 1.0 : 0.0);
      const vo::MovingDisc a{anchors[i].position, anchors[i].velocity, scenario.robots[i].radius};
      const vo::MovingDisc b{anchors[j].position, anchors[j].velocity, scenario.robots[j].radius};
      const PairConstraints pair = against_each_other(scene, i, a, j, b, pair_options);
      if (a_yields) out[i].push_back(pair.of_a);
      if (b_yields) out[j].push_back(pair.of_b);
    }
  }
  for (std::size_t i = 0; i < n; ++i) sort_by_distance(anchors, i, out[i]);
}

void fall_back(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene, std::size_t i,
               std::size_t j, std::vector<std::vector<Constraint>>& constraints) {
  Constraint* mine = against(j, scene, constraints[i]);
  Constraint* theirs = against(i, scene, constraints[j]);
  if (!mine || !theirs) return;
  const PairConstraints pair = at_rest(scenario, anchors, scene, i, j, contact_time(scenario));
  *mine = pair.of_a;
  *theirs = pair.of_b;
}

void follow_plans(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene,
                  const std::vector<std::optional<Vec2>>& planned, std::vector<std::vector<Constraint>>& constraints) {
  const auto yields = [&](std::size_t i) { return scenario.robots[i].cooperates; };
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    std::vector<Constraint>& mine = constraints[i];
    const auto is_theirs = [&](const Constraint& c) {
      return scene.bodies()[c.body].kind == vo::BodyKind::robot && yields(c.index) && (planned[i] || planned[c.index]);
    };
    const auto is_far = [&](const Constraint& c) {
      const double speeds = scenario.robots[i].max_speed + scenario.robots[c.index].max_speed;
      return is_theirs(c) && c.clearance > reach_within(scenario.time_step, kFastest * speeds);
    };
    mine.erase(std::remove_if(mine.begin(), mine.end(), is_far), mine.end());
    for (Constraint& c : mine) {
      if (!is_theirs(c)) continue;
      const std::size_t j = c.index;
      c = planned[i] && planned[j] ? with_plans(scenario, anchors, scene, i, *planned[i], j, *planned[j]).of_a
                                   : with_a_plan(scenario, anchors, scene, i, j, planned[i].has_value()).of_a;
    }
  }
}

std::optional<double> allowed_share(Vec2 velocity, const std::vector<Constraint>& statics,
                                    const std::vector<Constraint>& others) {
  constexpr double kRounding = 1e-9;  // m/s: the linear program sees to the rest
  double least = 0.0, most = 1.0;
  for (const std::vector<Constraint>* some : {&statics, &others})
    for (const Constraint& c : *some) {
      const double along = dot(c.half_plane.normal, velocity), offset = c.half_plane.offset - kRounding;
      if (along < offset && along < 0.0) most = std::min(most, offset / along);
      if (offset > 0.0 && along > 0.0) least = std::max(least, offset / along);
      if (offset > 0.0 && along <= 0.0) return std::nullopt;
    }
  if (!(least <= most) || most < 0.0) return std::nullopt;
  return most;
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

double reach_of_pair(const Scenario& scenario, std::size_t i, std::size_t j) {
  return reach_within(scenario.time_step,
                      kFastest * scenario.robots[i].max_speed + kFastest * scenario.robots[j].max_speed);
}

double reach_of_step(const Scenario& scenario, const Viewpoint& from) {
  return reach_within(scenario.time_step, kFastest * from.max_speed);
}

/// m: how much nearer the robot and the body can come within a step, whatever is decided.
double Decider::reach_of(const Constraint& c, const Viewpoint& from) const {
  const vo::Body& body = (*bodies_)[c.body];
  const double other =
      body.kind == vo::BodyKind::robot ? kFastest * scenario_->robots[c.index].max_speed : norm(body.velocity);
  return reach_within(scenario_->time_step, kFastest * from.max_speed + other);
}

RecordedConstraint Decider::recorded(const Constraint& c, const Viewpoint& from,
                                     const lp::ActiveConstraint* active) const {
  const vo::Body& body = (*bodies_)[c.body];
  RecordedConstraint r;
  r.half_plane = c.half_plane;
  r.source = body.kind;
  r.body = c.body;
  r.index = c.index;
  r.piece = c.piece;
  r.certified = c.proof != vo::Proof::none;
  r.hard = c.priority == lp::Priority::hard;
  r.active = active != nullptr;
  r.multiplier = active ? active->multiplier : 0.0;
  r.shape = body.shape;
  r.position = from.position;
  r.radius = from.radius;
  r.tau = c.time_horizon;
  r.shape_velocity = body.velocity;
  r.clearance = c.clearance;
  return r;
}

void Decider::state_problem(const DecisionInput& in) {
  problem_.bound = speed_bound(*scenario_, in.from.max_speed);
  problem_.preferred = in.preferred;
  problem_.constraints.clear();
  for (const std::vector<Constraint>* some : {in.statics, in.others})
    for (const Constraint& c : *some) problem_.constraints.push_back({c.half_plane, c.priority});
}

lp::Solution Decider::rounded_solution(const DecisionInput& in) {
  for (;;) {
    state_problem(in);
    const lp::Solution solution = lp::solve(problem_, pricing_);
    if (!in.more || !in.more->need_for(solution, pricing_)) return solution;
  }
}

/// What the rounded solution lacks in proof the exact one has, which needs all half-planes.
lp::Proven Decider::proven_solution(const DecisionInput& in) {
  if (in.more && in.keep_all) in.more->need_all();
  const lp::Solution rounded = rounded_solution(in);
  lp::Proven proven = lp::certified(problem_, rounded);
  if (!proven.exact_stage || !in.more || !in.more->need_all()) return proven;
  state_problem(in);
  return lp::solve_certified(problem_);
}

bool Decider::has_fallen_back(const Constraint& c, const DecisionInput& in) const {
  return in.fallen_back && (*bodies_)[c.body].kind == vo::BodyKind::robot &&
         std::find(in.fallen_back->begin(), in.fallen_back->end(), c.index) != in.fallen_back->end();
}

Decider::Proof Decider::proof_of(const lp::Proven& proven) const {
  if (!proven.exact_stage) return Proof::multipliers;
  if (proven.solution.status == lp::Status::no_interior) return Proof::whole_problem;
  if (lp::check(problem_, lp::claim_of(problem_, proven.solution)) == lp::CertificateError::none)
    return Proof::multipliers;
  return proven.certificate && lp::is_tight(problem_, *proven.certificate) ? Proof::exact_multipliers
                                                                           : Proof::whole_problem;
}

void Decider::decide(const DecisionInput& in, RobotStep& step) {
  const lp::Proven proven = proven_solution(in);
  lp::Solution solution = proven.solution;
  const Proof proof = proof_of(proven);
  step.exact_multipliers = proof == Proof::exact_multipliers;
  if (step.exact_multipliers)
    for (lp::ActiveConstraint& active : solution.active) active.multiplier = 0.0;
  const bool keep_all = in.keep_all || proof == Proof::whole_problem;
  step.preferred = in.preferred;
  step.chosen = solution.velocity;
  step.status = solution.status;
  step.violation = solution.violation;
  step.bound.clear();
  for (std::size_t k = 0; k < solution.active_count; ++k)
    if (lp::is_speed_bound(solution.active[k].binding)) step.bound.push_back(solution.active[k]);
  step.uncertified = 0;
  step.constraints.clear();
  kept_.clear();
  std::size_t number = 0;
  for (const std::vector<Constraint>* some : {in.statics, in.others}) {
    for (const Constraint& c : *some) {
      const lp::ActiveConstraint* active = active_at(solution, number++);
      if (c.proof == vo::Proof::none) ++step.uncertified;
      if (keep_all || active || has_fallen_back(c, in) || c.clearance <= reach_of(c, in.from))
        kept_.emplace_back(&c, active);
    }
  }
  step.constraints.reserve(kept_.size());
  for (const auto& [constraint, active] : kept_) step.constraints.push_back(recorded(*constraint, in.from, active));
}

}  // namespace exactvo::formation::detail
