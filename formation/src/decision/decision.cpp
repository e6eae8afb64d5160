// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/decision.h"

#include <algorithm>
#include <cmath>

#include "decision/own_side.h"
#include "motion/differential.h"
#include "scene/braking.h"
#include "scene/near_pairs.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {
namespace {

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
  c.speed = kBoxDiagonal * other.max_speed;
  return c;
}

/// What binds at that constraint; nothing where it does not.
const lp::ActiveConstraint* active_at(const lp::Solution& solution, std::size_t index) {
  for (std::size_t k = 0; k < solution.active_count; ++k)
    if (solution.active[k].binding == lp::constraint_at(index)) return &solution.active[k];
  return nullptr;
}

/// The priority of a half-plane against a body: always hard in the stages of a user's half-planes that hold bodies.
lp::Priority priority_in(OwnStage stage, bool is_hard) {
  return is_hard || holds_bodies(stage) ? lp::Priority::hard : lp::Priority::soft;
}

lp::Priority priority_of_own(OwnStage stage, const OwnConstraint& c) {
  return stage == OwnStage::held && c.hard ? lp::Priority::hard : lp::Priority::soft;
}

Party party(const RobotsAt& now, std::size_t i, Vec2 velocity) {
  const Robot& r = now.robots[i];
  return {i, now.scene.robot(i), {now.anchors[i].position, velocity, r.radius}, r.max_speed, r.cooperates};
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
PairConstraints at_rest(const RobotsAt& now, std::size_t i, std::size_t j, double time_horizon, double gap) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = time_horizon;
  const Party a = party(now, i, {}), b = party(now, j, {});
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

/// The half-planes that braking satisfies.
PairConstraints braking(const RobotsAt& now, std::size_t i, std::size_t j) {
  const double tau = now.rules.braking_time;
  const Party a = party(now, i, now.rules.braked(now.anchors[i].velocity));
  const Party b = party(now, j, now.rules.braked(now.anchors[j].velocity));
  return braking_pair(a, b, tau);
}

/// m/s: of the velocity that both have in common, what a step of braking takes away.
Vec2 taken_by_braking(const DecisionRules& rules, const Anchor& a, const Anchor& b) {
  const Vec2 common = 0.5 * (a.velocity + b.velocity);
  return common - rules.braked(common);
}

/// None yet; the robots' bodies move to their anchors.
void begin_constraints(const RobotsAt& now, std::vector<std::vector<Constraint>>& out) {
  out.resize(now.robots.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].clear();
    now.scene.bodies().move(now.scene.robot(i), geometry::Disc{now.anchors[i].position, now.robots[i].radius},
                            now.anchors[i].velocity);
  }
}

/// Both go by a plan.
PairConstraints with_plans(const RobotsAt& now, std::size_t i, Vec2 of_i, std::size_t j, Vec2 of_j) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = now.rules.time_step;
  return half_each(party(now, i, of_i), party(now, j, of_j), options);
}

/// One of them goes by a plan: the whole gap is its.
PairConstraints with_a_plan(const RobotsAt& now, std::size_t i, std::size_t j, bool it_is_i, double gap) {
  PairConstraints pair = at_rest(now, i, j, now.rules.time_step, gap);
  const double whole = 2.0 * std::max(pair.of_a.half_plane.offset, pair.of_b.half_plane.offset);
  pair.of_a.half_plane.offset = it_is_i ? whole : 0.0;
  pair.of_b.half_plane.offset = it_is_i ? 0.0 : whole;
  return pair;
}

}  // namespace

vo::ReciprocalOptions pair_rule(const DecisionRules& rules) {
  vo::ReciprocalOptions rule;
  const bool baseline = takes_edges(rules.method);
  rule.time_horizon = baseline ? rules.horizons.orca : rules.horizons.robots;
  rule.contact_time = contact_time(rules.time_step, rules.horizons);
  rule.margin = std::max(kContactSkin, baseline ? 0.0 : rules.margins.robot);
  return rule;
}

PairConstraints against_each_other(const Party& a, const Party& b, vo::ReciprocalOptions rule) {
  rule.responsibility_of_a = a.yields == b.yields ? 0.5 : (a.yields ? 1.0 : 0.0);
  const vo::ReciprocalHalfPlanes pair = vo::reciprocal_half_planes(a.disc, b.disc, rule);
  return {against_robot(pair.a, pair.certified, a, b, rule.time_horizon),
          against_robot(pair.b, pair.certified, b, a, rule.time_horizon)};
}

PairConstraints braking_pair(const Party& a, const Party& b, double braking_time) {
  const vo::ReciprocalHalfPlanes pair = braking_half_planes(a.disc, b.disc, braking_time);
  return {against_robot(pair.a, pair.certified, a, b, braking_time),
          against_robot(pair.b, pair.certified, b, a, braking_time)};
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

void robot_constraints(const RobotsAt& now, PairMemory& memory, std::vector<std::vector<Constraint>>& out) {
  const auto& [rules, robots, anchors, scene, eases] = now;
  const std::size_t n = robots.size();
  begin_constraints(now, out);
  const vo::ReciprocalOptions rule = pair_rule(rules);
  std::vector<Vec2>& places = memory.places;
  places.clear();
  for (const Anchor& anchor : anchors) places.push_back(anchor.position);
  double radius = 0.0, speed = 0.0;
  for (const Robot& r : robots) {
    radius = std::max(radius, r.radius);
    speed = std::max(speed, r.max_speed);
  }
  for_each_near_pair(places, sight_of(rules, 2.0 * radius, 2.0 * speed), [&](std::size_t i, std::size_t j) {
    const Robot &r = now.robots[i], &other = now.robots[j];
    if (norm(places[i] - places[j]) > sight_of(now.rules, r.radius + other.radius, r.max_speed + other.max_speed))
      return;
    const Vec2 eased = is_eased(now, i, j) ? taken_by_braking(now.rules, now.anchors[i], now.anchors[j]) : Vec2{};
    const Party a = party(now, i, now.anchors[i].velocity - eased), b = party(now, j, now.anchors[j].velocity - eased);
    const PairConstraints pair = against_each_other(a, b, rule);
    if (a.yields) out[i].push_back(pair.of_a);
    if (b.yields) out[j].push_back(pair.of_b);
  });
  for (std::size_t i = 0; i < n; ++i) memory.nearest_first.sort(scene.bodies(), anchors[i].position, out[i]);
}

void add_own_side_constraints(const DecisionRules& rules, const Party& self, const Party& other,
                              const Measurements& bounds, double age, std::vector<Constraint>& out) {
  const OwnSide lines(rules, self.disc.position, self.disc.velocity,
                      foreseen_way(rules, bounds, other.disc.position, other.disc.velocity, age),
                      self.disc.radius + other.disc.radius);
  for (const geometry::HalfPlane& h : lines) out.push_back(against_robot(h, true, self, other, rules.braking_time));
}

void own_side_constraints(const RobotsAt& now, const std::vector<std::vector<MeasuredRobot>>& measured,
                          std::vector<std::vector<Constraint>>& out) {
  begin_constraints(now, out);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Party self = party(now, i, now.anchors[i].velocity);
    for (const MeasuredRobot& m : measured[i]) {
      Party other = party(now, m.robot, m.velocity);
      other.disc.position = m.position;
      add_own_side_constraints(now.rules, self, other, *now.rules.measurements, m.age, out[i]);
    }
  }
}

bool is_eased(const RobotsAt& now, std::size_t i, std::size_t j) {
  return now.eases && (*now.eases)[i] && (*now.eases)[j];
}

bool is_of_robot(const Scene& scene, const Constraint& c) {
  return scene.bodies()[c.body].kind == vo::BodyKind::robot;
}

void fall_back(const RobotsAt& now, std::size_t i, std::size_t j, std::vector<std::vector<Constraint>>& constraints,
               double gap) {
  Constraint* mine = against(j, now.scene, constraints[i]);
  Constraint* theirs = against(i, now.scene, constraints[j]);
  if (!mine || !theirs) return;
  if (now.rules.separate && mine->clearance < 0.0) return;  // rest satisfies what they have
  const PairConstraints pair = now.rules.has_brakes()
                                   ? braking(now, i, j)
                                   : at_rest(now, i, j, contact_time(now.rules.time_step, now.rules.horizons), gap);
  *mine = pair.of_a;
  *theirs = pair.of_b;
  mine->fell_back = theirs->fell_back = true;
}

void follow_plans(const RobotsAt& now, const std::vector<std::optional<Vec2>>& planned,
                  std::vector<std::vector<Constraint>>& constraints, const std::vector<double>& gaps) {
  const auto gap_of = [&](std::size_t i) { return gaps.empty() ? kContactSkin : gaps[i]; };
  const auto yields = [&](std::size_t i) { return now.robots[i].cooperates; };
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    std::vector<Constraint>& mine = constraints[i];
    // What a large crowd answers at once comes first: most have no plan, and no robot near them has one.
    const auto is_theirs = [&](const Constraint& c) {
      return (planned[i] || planned[c.index]) && is_of_robot(now.scene, c) && yields(c.index);
    };
    const auto is_far = [&](const Constraint& c) {
      const double speeds = now.robots[i].max_speed + now.robots[c.index].max_speed;
      return is_theirs(c) && c.clearance > reach_within(now.rules.time_step, kBoxDiagonal * speeds);
    };
    mine.erase(std::remove_if(mine.begin(), mine.end(), is_far), mine.end());
    for (Constraint& c : mine) {
      if (!is_theirs(c)) continue;
      const std::size_t j = c.index;
      c = planned[i] && planned[j]
              ? with_plans(now, i, *planned[i], j, *planned[j]).of_a
              : with_a_plan(now, i, j, planned[i].has_value(), std::max(gap_of(i), gap_of(j))).of_a;
    }
  }
}

void keep_from_nearing(const RobotsAt& now, std::vector<std::vector<Constraint>>& constraints) {
  if (!now.rules.separate) return;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (!now.robots[i].cooperates) continue;
    for (Constraint& c : constraints[i]) {
      if (!(c.clearance < 0.0) || !is_of_robot(now.scene, c) || !now.robots[c.index].cooperates) continue;
      const Vec2 apart = now.anchors[i].position - now.anchors[c.index].position;
      c.normal = apart == Vec2{} ? Vec2{i < c.index ? -1.0 : 1.0, 0.0} : geometry::normalized(apart);
      c.half_plane = {c.normal, 0.0};
      c.proof = vo::Proof::none;
    }
  }
}

std::optional<Vec2> way_apart(const Scene& scene, const std::vector<Constraint>& mine) {
  Vec2 sum;
  for (const Constraint& c : mine)
    if (c.clearance < 0.0 && is_of_robot(scene, c)) sum += c.normal;
  constexpr double kLeast = 1e-6;  // of unit vectors: less has no direction
  return norm(sum) > kLeast ? std::optional(geometry::normalized(sum)) : std::nullopt;
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

lp::SpeedBound speed_bound(SpeedBoundKind kind, double max_speed) {
  lp::SpeedBound bound;
  if (kind == SpeedBoundKind::disc) {
    bound.disc = max_speed;
  } else {
    bound.box_x = bound.box_y = max_speed;
  }
  return bound;
}

/// m: how much nearer the robot and the body can come within a step, whatever is decided.
double Decider::reach_of(const Constraint& c, const Viewpoint& from) const {
  return reach_within(rules_->time_step, kBoxDiagonal * from.max_speed + c.speed);
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
  r.fell_back = c.fell_back;
  r.multiplier = kept.second ? kept.second->multiplier : 0.0;
  r.time_horizon = c.time_horizon;
  r.clearance = c.clearance;
  return r;
}

void Decider::reserve(std::size_t constraints) {
  if (rules_->has_brakes()) {
    constexpr std::size_t kMost = kSidesOfLimit + kMostHalfPlanesOfWheels;
    constraints += kMost;
    limit_.reserve(kMost);
    limits_.reserve(kMost);
  }
  problem_.constraints.reserve(constraints);
  memory_.reserve(constraints);
  kept_.reserve(constraints);
}

void Decider::limit_change(const Viewpoint& from) {
  limit_.clear();
  if (from.wheels)
    from.wheels->limits->half_planes(from.wheels->state.heading, from.wheels->state.speeds,
                                     rules_->braked(from.velocity), limit_);
  if (!from.wheels || rules_->measurements) add_acceleration_limits(*rules_, from.velocity, limit_);
  limits_.clear();
  for (const geometry::HalfPlane& h : limit_) {
    Constraint& c = limits_.emplace_back();
    c.half_plane = h;
    c.body = from.body;
    c.index = from.robot;
    c.proof = vo::Proof::alone;
    c.time_horizon = rules_->time_step;
  }
}

void Decider::state_problem(const DecisionInput& in) {
  problem_.bound = speed_bound(rules_->speed_bound, in.from.max_speed);
  problem_.bound.disc = std::min(problem_.bound.disc, in.from.most);
  problem_.preferred = in.preferred;
  problem_.constraints.clear();
  for (const std::vector<Constraint>* some : {in.statics, in.others})
    for (const Constraint& c : *some)
      problem_.constraints.push_back({c.half_plane, priority_in(stage_, c.priority == lp::Priority::hard)});
  for (const Constraint& c : limits_) problem_.constraints.push_back({c.half_plane, lp::Priority::hard});
  if (holds_bodies(stage_))
    for (const OwnConstraint& c : own_) problem_.constraints.push_back({c.half_plane, priority_of_own(stage_, c)});
}

/// Whether multipliers prove the solution. An optimum needs the half-planes that it leaves no room to spare; any other
/// answer, and one that only exact numbers find, needs all.
bool Decider::is_solved(const DecisionInput& in, lp::Solution& solution) {
  for (;;) {
    state_problem(in);
    const bool is_proven = lp::solve(problem_, memory_, solution);
    if (!in.more) return is_proven;
    const bool is_optimal = is_proven && solution.status == lp::Status::optimal;
    if (!(is_optimal ? in.more->need_at(solution.velocity) : in.more->need_all())) return is_proven;
  }
}

lp::Proven Decider::proven_solution(const DecisionInput& in) {
  if (in.more && in.keep_all) in.more->need_all();
  lp::Proven proven;
  return is_solved(in, proven.solution) ? proven : lp::solve_exact(problem_);
}

/// The first stage that has an answer. What shows that an earlier one has none is in all half-planes. Where there is
/// room, but less than between doubles, the user's half-planes move outward until a double fits: a nanometre per second
/// mostly does, and the last step is wider than the speed bound, so that only bodies are a reason to leave them out.
lp::Proven Decider::solution_in_stages(DecisionInput& in) {
  stage_ = OwnStage::none;
  if (!in.own || in.own->empty()) return proven_solution(in);
  constexpr double kOutward[] = {0.0, 0x1p-30, 0x1p-20, 0x1p-10, 4.0};  // of the numbers in play
  for (const double outward : kOutward) {
    own_ = *in.own;
    for (OwnConstraint& c : own_) {
      geometry::HalfPlane& h = c.half_plane;
      h.offset -= outward * (in.from.max_speed * norm(h.normal) + std::fabs(h.offset));
    }
    lp::Status status = lp::Status::infeasible;
    for (const OwnStage stage : {OwnStage::held, OwnStage::gave}) {
      if (status != lp::Status::infeasible) break;
      stage_ = stage;
      lp::Proven proven = proven_solution(in);
      status = proven.solution.status;
      if (status == lp::Status::optimal || status == lp::Status::relaxed) return proven;
      in.keep_all = true;
    }
    if (status == lp::Status::infeasible) break;
  }
  stage_ = OwnStage::left_out;
  own_ = *in.own;
  return proven_solution(in);
}

Decider::Proof Decider::proof_of(const lp::Proven& proven) const {
  if (!proven.exact_stage) return Proof::multipliers;
  if (proven.solution.status == lp::Status::no_interior) return Proof::whole_problem;
  if (lp::check(problem_, lp::claim_of(problem_, proven.solution)) == lp::CertificateError::none)
    return Proof::multipliers;
  return proven.certificate && lp::is_tight(problem_, *proven.certificate) ? Proof::exact_multipliers
                                                                           : Proof::whole_problem;
}

void Decider::decide(const DecisionInput& of_user, Decision& decision) {
  DecisionInput in = of_user;
  if (rules_->has_brakes()) limit_change(in.from);
  const lp::Proven proven = solution_in_stages(in);
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
  for (const Constraint& c : limits_) {
    const lp::ActiveConstraint* active = active_at(solution_, number++);
    if (keep_all || active) kept_.emplace_back(&c, active);
  }
  decision.own_stage = stage_;
  decision.own.clear();
  if (stage_ == OwnStage::none) return;
  for (OwnConstraint c : own_) {
    const lp::ActiveConstraint* active = stage_ == OwnStage::left_out ? nullptr : active_at(solution_, number++);
    c.active = active != nullptr;
    c.multiplier = active ? active->multiplier : 0.0;
    decision.own.push_back(c);
  }
}

void Decider::kept(std::vector<DecisionConstraint>& out) const {
  out.clear();
  out.reserve(kept_.size());
  for (const Kept& one : kept_) out.push_back(named(one));
}

void Decider::decide(const DecisionInput& in, RobotStep& step) {
  decide(in, static_cast<Decision&>(step));
  kept(step.constraints);
}

}  // namespace exactvo::formation::detail

namespace exactvo::formation {

std::vector<lp::Constraint> problem_of(const Decision& decision, const std::vector<DecisionConstraint>& constraints) {
  std::vector<lp::Constraint> problem;
  for (const DecisionConstraint& c : constraints)
    problem.push_back({c.half_plane, detail::priority_in(decision.own_stage, c.hard)});
  if (holds_bodies(decision.own_stage))
    for (const OwnConstraint& c : decision.own)
      problem.push_back({c.half_plane, detail::priority_of_own(decision.own_stage, c)});
  return problem;
}

std::vector<geometry::HalfPlane> own_limits(const Scenario& scenario, const RobotStep& step, std::size_t robot) {
  std::vector<geometry::HalfPlane> limits;
  const detail::DecisionRules rules = detail::rules_of(scenario, {});
  const std::optional<DifferentialDrive>& drive = scenario.robots[robot].drive;
  const bool has_wheels = drive && step.wheels;
  if (has_wheels)
    detail::WheelLimits(*drive, rules.time_step, rules.braking_time)
        .half_planes(step.wheels->heading, step.wheels->speeds, rules.braked(step.velocity), limits);
  if (!has_wheels || rules.measurements) detail::add_acceleration_limits(rules, step.velocity, limits);
  return limits;
}

}  // namespace exactvo::formation
