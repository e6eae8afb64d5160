// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/decision.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/reciprocal.h"
#include "scene/moment.h"
#include "scene/moving.h"
#include "scene/near_pairs.h"

namespace exactvo::formation::detail {
namespace {

/// The farthest velocity of a box bound, in sides of it.
const double kFastest = std::sqrt(2.0);

/// m: how much nearer two that have these speeds together can come within a step.
double reach_within(double time_step, double speeds) {
  constexpr double kRounding = 1.0 + 1e-6;  // clearances are rounded
  return kRounding * time_step * speeds;
}

Constraint against_robot(const geometry::HalfPlane& h, bool certified, const Party& self, const Party& other,
                         double tau) {
  Constraint c;
  c.half_plane = h;
  c.body = other.body;
  c.priority = lp::Priority::soft;
  c.proof = certified ? vo::Proof::pair : vo::Proof::none;
  const Vec2 apart = self.disc.position - other.disc.position;
  c.clearance = norm(apart) - (self.disc.radius + other.disc.radius);
  c.normal = geometry::normalized(apart);
  c.time_horizon = tau;
  c.index = other.index;
  c.speed = kFastest * other.max_speed;
  return c;
}

/// What binds at that constraint; nothing where it does not.
const lp::ActiveConstraint* active_at(const lp::Solution& solution, std::size_t index) {
  for (std::size_t k = 0; k < solution.active_count; ++k)
    if (solution.active[k].binding == lp::constraint_at(index)) return &solution.active[k];
  return nullptr;
}

Party party(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene, std::size_t i,
            Vec2 velocity) {
  const Robot& r = scenario.robots[i];
  return {i, scene.robot(i), {anchors[i].position, velocity, r.radius}, r.max_speed, r.cooperates};
}

/// Where both yield, or neither does: half each.
PairConstraints half_each(Party a, Party b, const vo::ReciprocalOptions& rule) {
  a.yields = b.yields = true;
  return against_each_other(a, b, rule);
}

Constraint* against(std::size_t robot, const Scene& scene, std::vector<Constraint>& all) {
  for (Constraint& c : all)
    if (is_of_robot(scene, c) && c.index == robot) return &c;
  return nullptr;
}

/// The half-planes of two robots that stand still, which keep a gap between them. Where it is used up, neither comes
/// nearer.
PairConstraints at_rest(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene, std::size_t i,
                        std::size_t j, double time_horizon, double gap) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = time_horizon;
  const Party a = party(scenario, anchors, scene, i, {}), b = party(scenario, anchors, scene, j, {});
  const double centres = norm(a.disc.position - b.disc.position);
  // With some rounding: where a robot is held from all sides, half-planes through 0 leave it 0, and others a region
  // between doubles.
  constexpr double kUsedUp = 1.001;
  const bool is_in_contact = centres - (a.disc.radius + b.disc.radius) <= kUsedUp * gap;
  if (!is_in_contact) options.margin = gap;
  PairConstraints pair = half_each(a, b, options);
  if (is_in_contact)
    for (Constraint* c : {&pair.of_a, &pair.of_b}) c->half_plane.offset = std::max(0.0, c->half_plane.offset);
  return pair;
}

/// Both go by a plan.
PairConstraints with_plans(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene,
                           std::size_t i, Vec2 of_i, std::size_t j, Vec2 of_j) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = scenario.time_step;
  return half_each(party(scenario, anchors, scene, i, of_i), party(scenario, anchors, scene, j, of_j), options);
}

/// One of them goes by a plan: the whole gap is its.
PairConstraints with_a_plan(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene,
                            std::size_t i, std::size_t j, bool it_is_i, double gap) {
  PairConstraints pair = at_rest(scenario, anchors, scene, i, j, scenario.time_step, gap);
  const double whole = 2.0 * std::max(pair.of_a.half_plane.offset, pair.of_b.half_plane.offset);
  pair.of_a.half_plane.offset = it_is_i ? whole : 0.0;
  pair.of_b.half_plane.offset = it_is_i ? 0.0 : whole;
  return pair;
}

}  // namespace

vo::ReciprocalOptions pair_rule(const Scenario& scenario, const SimulationOptions& options) {
  vo::ReciprocalOptions rule;
  const bool baseline = options.method == Method::orca;
  rule.time_horizon = baseline ? scenario.horizons.orca : scenario.horizons.robots;
  rule.contact_time = contact_time(scenario);
  rule.margin = std::max(kContactSkin, baseline ? 0.0 : scenario.margins.robot);
  return rule;
}

PairConstraints against_each_other(const Party& a, const Party& b, vo::ReciprocalOptions rule) {
  rule.responsibility_of_a = a.yields == b.yields ? 0.5 : (a.yields ? 1.0 : 0.0);
  const vo::ReciprocalHalfPlanes pair = vo::reciprocal_half_planes(a.disc, b.disc, rule);
  return {against_robot(pair.a, pair.certified, a, b, rule.time_horizon),
          against_robot(pair.b, pair.certified, b, a, rule.time_horizon)};
}

void NearestFirst::sort(const vo::BodyTable& bodies, Vec2 from, std::vector<Constraint>& lines) {
  if (lines.size() < 2) return;
  keys_.clear();
  for (const Constraint& c : lines)
    keys_.emplace_back(norm(std::get<geometry::Disc>(bodies[c.body].shape).center - from), c.index, keys_.size());
  std::sort(keys_.begin(), keys_.end());
  // Half-planes are large: each moves once, round the cycles of the permutation.
  const auto came_from = [&](std::size_t k) -> std::size_t& { return std::get<2>(keys_[k]); };
  for (std::size_t first = 0; first < lines.size(); ++first) {
    if (came_from(first) == first) continue;
    const Constraint kept = lines[first];
    std::size_t to = first;
    for (std::size_t next = came_from(to); next != first; next = came_from(to)) {
      lines[to] = lines[next];
      came_from(to) = to;
      to = next;
    }
    lines[to] = kept;
    came_from(to) = to;
  }
}

void robot_constraints(const Scenario& scenario, const SimulationOptions& options, const std::vector<Anchor>& anchors,
                       Scene& scene, PairMemory& memory, std::vector<std::vector<Constraint>>& out) {
  const std::size_t n = scenario.robots.size();
  out.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i].clear();
    scene.bodies().move(scene.robot(i), geometry::Disc{anchors[i].position, scenario.robots[i].radius},
                        anchors[i].velocity);
  }
  const vo::ReciprocalOptions rule = pair_rule(scenario, options);
  std::vector<Vec2>& places = memory.places;
  places.clear();
  for (const Anchor& anchor : anchors) places.push_back(anchor.position);
  double radius = 0.0, speed = 0.0;
  for (const Robot& r : scenario.robots) {
    radius = std::max(radius, r.radius);
    speed = std::max(speed, r.max_speed);
  }
  for_each_near_pair(places, sight_of(scenario, 2.0 * radius, 2.0 * speed), [&](std::size_t i, std::size_t j) {
    const Robot &r = scenario.robots[i], &other = scenario.robots[j];
    if (norm(places[i] - places[j]) > sight_of(scenario, r.radius + other.radius, r.max_speed + other.max_speed))
      return;
    const Party a = party(scenario, anchors, scene, i, anchors[i].velocity);
    const Party b = party(scenario, anchors, scene, j, anchors[j].velocity);
    const PairConstraints pair = against_each_other(a, b, rule);
    if (a.yields) out[i].push_back(pair.of_a);
    if (b.yields) out[j].push_back(pair.of_b);
  });
  for (std::size_t i = 0; i < n; ++i) memory.nearest_first.sort(scene.bodies(), anchors[i].position, out[i]);
}

bool is_of_robot(const Scene& scene, const Constraint& c) {
  return scene.bodies()[c.body].kind == vo::BodyKind::robot;
}

void fall_back(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene, std::size_t i,
               std::size_t j, std::vector<std::vector<Constraint>>& constraints, double gap) {
  Constraint* mine = against(j, scene, constraints[i]);
  Constraint* theirs = against(i, scene, constraints[j]);
  if (!mine || !theirs) return;
  const PairConstraints pair = at_rest(scenario, anchors, scene, i, j, contact_time(scenario), gap);
  *mine = pair.of_a;
  *theirs = pair.of_b;
}

void follow_plans(const Scenario& scenario, const std::vector<Anchor>& anchors, const Scene& scene,
                  const std::vector<std::optional<Vec2>>& planned, std::vector<std::vector<Constraint>>& constraints,
                  double gap) {
  const auto yields = [&](std::size_t i) { return scenario.robots[i].cooperates; };
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    std::vector<Constraint>& mine = constraints[i];
    // What a large crowd answers at once comes first: most have no plan, and nobody near them has one.
    const auto is_theirs = [&](const Constraint& c) {
      return (planned[i] || planned[c.index]) && is_of_robot(scene, c) && yields(c.index);
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
                                   : with_a_plan(scenario, anchors, scene, i, j, planned[i].has_value(), gap).of_a;
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
  return std::max(scenario.time_step, vo::ReciprocalOptions{}.contact_time * moment(scenario.horizons));
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
  return reach_within(scenario_->time_step, kFastest * from.max_speed + c.speed);
}

DecisionConstraint Decider::named(const Kept& kept) const {
  const Constraint& c = *kept.first;
  DecisionConstraint r;
  r.half_plane = c.half_plane;
  r.source = (*bodies_)[c.body].kind;
  r.body = c.body;
  r.index = c.index;
  r.piece = c.piece;
  r.certified = c.proof != vo::Proof::none;
  r.hard = c.priority == lp::Priority::hard;
  r.active = kept.second != nullptr;
  r.multiplier = kept.second ? kept.second->multiplier : 0.0;
  r.time_horizon = c.time_horizon;
  r.clearance = c.clearance;
  return r;
}

RecordedConstraint with_shape(const DecisionConstraint& constraint, const vo::BodyTable& bodies,
                              const Viewpoint& from) {
  const vo::Body& body = bodies[constraint.body];
  return {constraint, body.shape, from.position, from.radius, body.velocity};
}

void Decider::reserve(std::size_t constraints) {
  problem_.constraints.reserve(constraints);
  pricing_.at.reserve(constraints);  // a search of more rounds than there are lines was never seen
  memory_.reserve(constraints);
  kept_.reserve(constraints);
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
    const lp::Solution solution = lp::solve(problem_, pricing_, memory_);
    if (!in.more || !in.more->need_for(solution, pricing_)) return solution;
  }
}

/// What the rounded solution lacks in proof the exact one has, which needs all half-planes.
lp::Proven Decider::proven_solution(const DecisionInput& in) {
  if (in.more && in.keep_all) in.more->need_all();
  lp::Proven proven;
  proven.solution = rounded_solution(in);
  if (lp::is_proven_by_multipliers(problem_, proven.solution)) return proven;
  if (!in.more || !in.more->need_all()) return lp::certified(problem_, proven.solution);
  state_problem(in);
  return lp::solve_certified(problem_);
}

Decider::Proof Decider::proof_of(const lp::Proven& proven) const {
  if (!proven.exact_stage) return Proof::multipliers;
  if (proven.solution.status == lp::Status::no_interior) return Proof::whole_problem;
  if (lp::check(problem_, lp::claim_of(problem_, proven.solution)) == lp::CertificateError::none)
    return Proof::multipliers;
  return proven.certificate && lp::is_tight(problem_, *proven.certificate) ? Proof::exact_multipliers
                                                                           : Proof::whole_problem;
}

void Decider::decide(const DecisionInput& in, Decision& decision) {
  const lp::Proven proven = proven_solution(in);
  const Proof proof = proof_of(proven);
  solution_ = proven.solution;
  decision.exact_multipliers = proof == Proof::exact_multipliers;
  if (decision.exact_multipliers)
    for (lp::ActiveConstraint& active : solution_.active) active.multiplier = 0.0;
  const bool keep_all = in.keep_all || proof == Proof::whole_problem;
  decision.preferred = in.preferred;
  decision.chosen = solution_.velocity;
  decision.status = solution_.status;
  decision.violation = solution_.violation;
  decision.bound.clear();
  for (std::size_t k = 0; k < solution_.active_count; ++k)
    if (lp::is_speed_bound(solution_.active[k].binding)) decision.bound.push_back(solution_.active[k]);
  decision.uncertified = 0;
  kept_.clear();
  std::size_t number = 0;
  for (const std::vector<Constraint>* some : {in.statics, in.others}) {
    for (const Constraint& c : *some) {
      const lp::ActiveConstraint* active = active_at(solution_, number++);
      if (c.proof == vo::Proof::none) ++decision.uncertified;
      const bool gave = solution_.status != lp::Status::optimal && violates(c.half_plane, solution_.velocity);
      if (keep_all || active || gave || c.clearance <= reach_of(c, in.from)) kept_.emplace_back(&c, active);
    }
  }
}

void Decider::kept(std::vector<DecisionConstraint>& out) const {
  out.clear();
  for (const Kept& one : kept_) out.push_back(named(one));
}

void Decider::decide(const DecisionInput& in, RobotStep& step) {
  decide(in, static_cast<Decision&>(step));
  step.constraints.clear();
  step.constraints.reserve(kept_.size());
  for (const Kept& one : kept_) step.constraints.push_back(with_shape(named(one), *bodies_, in.from));
}

}  // namespace exactvo::formation::detail
