// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Equation (12)/(13): from half-planes and a preferred velocity to the chosen one, with the record of why.

#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "decision/needed_constraints.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/reciprocal.h"
#include "scene/decision_rules.h"
#include "scene/static_field.h"

namespace exactvo::formation::detail {

/// A robot that half-planes are built for: its brake point in a formation, else itself.
struct Anchor {
  Vec2 position;  ///< m
  Vec2 velocity;  ///< m/s
};

/// A robot of a pair.
struct Party {
  std::size_t index = 0;           ///< `Constraint::index` of what keeps clear of it
  vo::BodyTable::Number body = 0;  ///< a disc, where it is
  vo::MovingDisc disc;
  double max_speed = 0.0;  ///< m/s
  bool yields = true;      ///< false: the other one takes the whole responsibility
};

/// Both halves of a pair.
struct PairConstraints {
  Constraint of_a, of_b;
};

/// The rule for a pair of robots, without their responsibilities.
vo::ReciprocalOptions pair_rule(const DecisionRules& rules);
/// Soft. Each half is the same bits whoever is `a`.
PairConstraints against_each_other(const Party& a, const Party& b, vo::ReciprocalOptions rule);

/// Both halves as braking has them: each party's `disc` has its velocity after a step of braking (braking.h).
PairConstraints braking_pair(const Party& a, const Party& b, double braking_time);

/// Sorts half-planes against robots by the distance of the robots; of robots equally near, by their numbers. Keeps its
/// memory from one time to the next.
class NearestFirst {
 public:
  /// Sorting this many allocates nothing then.
  void reserve(std::size_t lines) { keys_.reserve(lines); }
  /// REQUIRES: half-planes against robots only.
  void sort(const vo::BodyTable& bodies, Vec2 from, std::vector<Constraint>& lines);

 private:
  /// Distance, m; number; where the half-plane stood.
  std::vector<std::tuple<double, std::size_t, std::size_t>> keys_;
};

/// What one call of `robot_constraints` leaves to the next, so that it allocates nothing.
struct PairMemory {
  std::vector<Vec2> places;
  NearestFirst nearest_first;
};

/// All robots of a run, where they are in this step.
struct RobotsAt {
  const DecisionRules& rules;
  const std::vector<Robot>& robots;
  const std::vector<Anchor>& anchors;  ///< of each robot
  Scene& scene;
  const std::vector<char>* eases = nullptr;  ///< of each robot, whether it lets go of others that do; null: none does
};

/// All half-planes of every robot against every other in sight (`sight_of`), nearest first: entry i belongs to
/// robot i. Both halves of a pair share their normal bit for bit. A robot that does not cooperate gets none; a
/// robot that meets it takes the whole responsibility. Moves the robots' bodies to their anchors.
void robot_constraints(const RobotsAt& now, PairMemory& memory, std::vector<std::vector<Constraint>>& out);

/// Whether the two let go of each other (liveness, rule R1): their half-planes are those of the same relative velocity,
/// but of two robots whose common velocity brakes. One alone proves nothing; both together do.
bool is_eased(const RobotsAt& now, std::size_t i, std::size_t j);

/// The same where robots measure each other: of each against those that it has measured, in this order, the half-planes
/// that keep it on its own side (own_side.h).
void own_side_constraints(const RobotsAt& now, const std::vector<std::vector<MeasuredRobot>>& measured,
                          std::vector<std::vector<Constraint>>& out);

/// Appends those of a robot against one that it has measured.
void add_own_side_constraints(const DecisionRules& rules, const Party& self, const Party& other,
                              const Measurements& bounds, double age, std::vector<Constraint>& out);

bool is_of_robot(const Scene& scene, const Constraint& c);

/// The half-planes of two robots that both yield give way to those that they would have at rest, looking ahead as far
/// as `contact_time` and leaving `gap` (m) between their rims: v = 0 satisfies them as long as the robots do not
/// overlap, and they are as certain (liveness, rule R0). With an acceleration to those that they have braking
/// (braking.h), which braking satisfies.
void fall_back(const RobotsAt& now, std::size_t i, std::size_t j, std::vector<std::vector<Constraint>>& constraints,
               double gap = kContactSkin);

/// Replaces the half-planes of all pairs of which one robot or both follow a joint plan and both cooperate (liveness,
/// rule R4). `planned`: m/s, the velocities that plans want. If both follow one: the half-plane nearest to both planned
/// velocities, each robot with half of its slack, so that both satisfy it where the plan is free of collision (lemma
/// 2). If one does: it may use the whole gap, and the other may not come nearer. Pairs that cannot meet within a step
/// have none. `gaps`: m, of each robot, that one that goes by plan and one that does not keep at least; the larger one
/// counts. REQUIRES: half-planes against robots only.
void follow_plans(const RobotsAt& now, const std::vector<std::optional<Vec2>>& planned,
                  std::vector<std::vector<Constraint>>& constraints, const std::vector<double>& gaps = {});

/// Where robots part (`DecisionRules::separate`): the half-planes of two that overlap and both yield give way to those
/// of not coming nearer, n.(v_a - v_b) >= 0 with n from one to the other, half each: rest satisfies all of them. Of two
/// in one place the first goes to the left.
void keep_from_nearing(const RobotsAt& now, std::vector<std::vector<Constraint>>& constraints);

/// Unit, from a robot's half-planes: away from those that it overlaps; nothing where it overlaps none, or is in their
/// middle.
std::optional<Vec2> way_apart(const Scene& scene, const std::vector<Constraint>& mine);

/// The largest share of a velocity, in [0, 1], that all these allow; nothing where none does.
std::optional<double> allowed_share(Vec2 velocity, const std::vector<Constraint>& statics,
                                    const std::vector<Constraint>& others);

lp::SpeedBound speed_bound(SpeedBoundKind kind, double max_speed);

struct DecisionInput {
  Vec2 preferred;  ///< m/s
  Viewpoint from;
  const std::vector<Constraint>* statics = nullptr;
  const std::vector<Constraint>* others = nullptr;  ///< robots and moving obstacles
  bool keep_all = false;
  NeededConstraints* more = nullptr;  ///< grows `statics` by what the decision needs; none: they are all there
  const std::vector<OwnConstraint>* own = nullptr;  ///< what the user asks for; null or empty: nothing
};

/// Makes decisions one after the other in memory of its own.
class Decider {
 public:
  /// Both must outlive it.
  Decider(const DecisionRules& rules, const vo::BodyTable& bodies) : rules_(&rules), bodies_(&bodies) {}

  /// Room for decisions among this many half-planes: they allocate nothing then, unless doubles do not prove them.
  void reserve(std::size_t constraints);

  /// Fills `preferred`, `chosen`, `status`, `violation`, `exact_multipliers`, `bound`, `uncertified` and `own`; the
  /// other fields are the caller's. With an acceleration the change from `from.velocity` is limited by half-planes that
  /// name the robot itself. Keeps the constraints that bind or are violated, and those against what can be met within
  /// a step: with these alone an audit sees that none is missing. Keeps all where no multipliers prove the choice.
  void decide(const DecisionInput& in, Decision& decision);
  /// What the last decision kept. REQUIRES: what it was made from is still there.
  void kept(std::vector<DecisionConstraint>& out) const;

  /// Both.
  void decide(const DecisionInput& in, RobotStep& step);

  /// A half-plane that does not bind, as `decide` would keep it.
  DecisionConstraint idle(const Constraint& c) const { return named({&c, nullptr}); }

 private:
  using Kept = std::pair<const Constraint*, const lp::ActiveConstraint*>;
  /// What shows that a choice is the best.
  enum class Proof {
    multipliers,        ///< its own
    exact_multipliers,  ///< no doubles, but those of the exact solution
    whole_problem       ///< solving the problem again: there is no room, or only a wide gap can be proven
  };
  Proof proof_of(const lp::Proven& proven) const;
  void limit_change(const Viewpoint& from);
  void state_problem(const DecisionInput& in);
  bool is_solved(const DecisionInput& in, lp::Solution& solution);
  lp::Proven proven_solution(const DecisionInput& in);
  lp::Proven solution_in_stages(DecisionInput& in);
  double reach_of(const Constraint& c, const Viewpoint& from) const;
  DecisionConstraint named(const Kept& kept) const;

  const DecisionRules* rules_;
  const vo::BodyTable* bodies_;
  std::vector<geometry::HalfPlane> limit_;
  std::vector<Constraint> limits_;  ///< of the robot's acceleration, as half-planes of its own
  OwnStage stage_ = OwnStage::none;
  std::vector<OwnConstraint> own_;  ///< what the user asks for, moved outward where no double fits
  lp::Problem problem_;
  lp::SolveMemory memory_;
  lp::Solution solution_;   ///< of one decision, as the next two
  std::vector<Kept> kept_;  ///< with what binds in `solution_`
};

}  // namespace exactvo::formation::detail
