// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which robots are stalled, and groups of robots that go by a joint plan (liveness, rules R2 to R4): when a plan is
/// made, for which robots, from where, and what each member wants in a step. Decides nothing about safety: half-planes
/// do.
///
/// Deterministic: budgets of searches are counted.

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/waiting.h"
#include "liveness/plan_search.h"
#include "liveness/plan_tries.h"
#include "scene/decision_rules.h"

namespace exactvo::formation::detail {

/// Whether a sorted list has `x`.
inline bool contains(const std::vector<std::size_t>& sorted, std::size_t x) {
  return std::binary_search(sorted.begin(), sorted.end(), x);
}

/// m/s: gets as far along `way` (m) within a time step as the bound of a robot of that greatest speed (m/s) allows.
Vec2 velocity_along(const DecisionRules& rules, double max_speed, Vec2 way);

/// Where robots were, row by row, as far back as memory allows: they can go back as they came (liveness, rule R3).
class History {
 public:
  /// 2^23 positions are 128 MiB: more than 40 s of 10,000 robots, and a day of three.
  explicit History(std::size_t most_positions = std::size_t{1} << 23) : most_(most_positions) {}

  /// `row`: m, of each robot.
  void add(std::vector<Vec2> row) { rows_.push_back(std::move(row)); }

  std::size_t first() const { return first_; }
  /// REQUIRES: a row was added.
  std::size_t last() const { return first_ + rows_.size() - 1; }
  /// REQUIRES: first() <= row <= last().
  const std::vector<Vec2>& operator[](std::size_t row) const { return rows_[row - first_]; }
  const std::vector<Vec2>& back() const { return rows_.back(); }

  /// Forgets the oldest rows that are too many, but none from `needed` on, nor the last.
  void forget_before(std::size_t needed) {
    while (rows_.size() > 1 && first_ < needed &&
           rows_.size() * std::max<std::size_t>(1, rows_.back().size()) > most_) {
      rows_.pop_front();
      ++first_;
    }
  }

 private:
  std::size_t most_;
  std::size_t first_ = 0;
  std::deque<std::vector<Vec2>> rows_;
};

class Groups {
 public:
  /// `robots`: the scenario's as they are planned for, which may be larger or slower. All of these and `space` must
  /// outlive the groups. Without `plans` stalls are noted and nothing is done about them. `is_stopped` is asked while
  /// plans are made, which can take seconds: true ends that without a plan.
  Groups(const Scenario& scenario, const DecisionRules& rules, const std::vector<Robot>& robots, const FreeSpace& space,
         bool plans, std::function<bool()> is_stopped);

  /// Makes plans where they are due, and what members want. `way_left`: m, of a robot from where it is to its goal.
  void begin_step(double time, std::vector<RobotNow> now, const std::function<double(std::size_t)>& way_left);

  bool any() const { return !groups_.empty(); }
  bool is_member(std::size_t robot) const { return group_of_[robot] != kNone; }
  bool goes_back(std::size_t robot) const { return is_member(robot) && group(robot).back_at > group(robot).back_to; }
  /// m/s. REQUIRES: a member.
  Vec2 wanted(std::size_t robot) const { return wanted_[robot]; }
  /// m: the margin between robots that a member's plan keeps, and that it leaves to others too; 0: none. REQUIRES: a
  /// member.
  double gap(std::size_t robot) const { return group(robot).gap; }
  /// A group goes back in step or not at all. If half-planes kept one of its robots from what it wanted, the whole
  /// group stands still in this step: its members want nothing. Whether there is such a group.
  bool halt_those_held_back(const Step& row);
  /// The robot's note for this row, which is often empty.
  std::string note(std::size_t robot) { return std::exchange(notes_[robot], {}); }

  /// Takes a row with its decisions: which robots are stalled, and which are in a deadlock.
  void end_step(const Step& row);

  const LivenessCourse& course() const { return course_; }
  /// All so far. Rows count from the first step on.
  const std::vector<JointPlan>& plans() const { return made_; }
  /// "no plan was found on the roadmap for R1 and R2", of those of the given robots; empty where none was missing to
  /// the end.
  std::string no_plan_words(const std::vector<std::size_t>& robots) const;
  /// "60 robots were still going by a joint plan, with 1200 of 4205 moves to go": of the plans that are not over, but
  /// for those made again and again without a move.
  std::string still_going_words() const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  using Members = std::vector<std::size_t>;  ///< sorted

  struct Group {
    Members who;  ///< that it was planned for; who has left it is no member (`members_of`)
    Following following;
    std::size_t back_at = 0, back_to = 0;  ///< rows of the history: going back while the first is above the second
    double progress = 0.0;                 ///< s, when something was done last
    int replans = 0;                       ///< of its robots, since they had a plan that went on
    double gap = 0.0;                      ///< m: the margin that its plan keeps between robots; 0: none
    bool is_over = false;
    bool stands_still = false;  ///< in this step
  };
  struct OfRobot {
    std::size_t goal_number = 0;   ///< that the next one is of
    double shortest = 0.0;         ///< m, its way to the goal, since it was made shorter last
    double since = 0.0;            ///< s
    double planned_at = 0.0;       ///< s, when a plan for it was looked for last
    int failures = 0;              ///< of planning, in a row
    std::size_t planned_goal = 0;  ///< number of the goal that it goes to by plan
    bool is_named = false;         ///< its stall was noted
  };
  struct WithoutPlan {
    Members who;
    PlanEnd why;
  };
  Group& group(std::size_t robot) { return groups_[group_of_[robot]]; }
  const Group& group(std::size_t robot) const { return groups_[group_of_[robot]]; }
  double stalled_for(std::size_t robot) const { return time_ - of_robot_[robot].since; }

  void advance();
  void advance(Group& g);
  void let_go_on(const Group& g);
  void watch(const std::function<double(std::size_t)>& way_left);
  void make_due_plans();
  void want();
  Vec2 wanted_by(std::size_t robot) const;
  void restart_watch(std::size_t robot);
  bool is_dead_in(const WaitForGraph& graph, const Step& row, std::size_t robot) const;

  Members everyone() const;
  Members members_of(const Group& g) const;
  std::vector<std::size_t> by_nearness_to(const Members& seeds) const;
  Members as_many_as_fit(std::vector<std::size_t> nearest_first, int replans) const;
  bool fits(const Members& who, const std::vector<Vec2>& from, int replans) const;
  Members with_groups_of(Members who) const;
  /// Whether `robot` stands in the way of a member that goes back as far as that row, or within `beside` of the radii.
  bool is_in_the_way_back(std::size_t robot, const Members& who, std::size_t to, double beside) const;
  Members with_those_in_the_way_back(Members who, std::size_t to) const;
  bool can_go_back(const Members& who, std::size_t to) const;
  /// `seeds`: those who wait. Only their groups end, and only their patience, where no plan is found.
  bool plan_for(Members who, const Members& seeds, int replans);
  PlanEnd plan_from(const Members& who, const Members& seeds, int replans, std::size_t row,
                    Detail detail = Detail::seen);
  /// Ends the groups of these, who are planned for now.
  void dissolve_those_of(const Members& who);
  void forget_without_plan(const Members& who);
  geometry::Box whole_scene(double radius) const;
  bool uses_whole_map(const Members& who) const;
  Roadmap map_for(const Members& who, const std::vector<Vec2>& from, int replans, Detail detail) const;
  geometry::Box region_for(const Members& who, const std::vector<Vec2>& from, int replans) const;
  double radius_of(std::size_t robot, bool with_margin) const;
  bool has_wide_margin(const Members& who) const;
  JointProblem problem_for(const Members& who, const std::vector<Vec2>& from, bool with_margin, Roadmap& map) const;
  void start(const Members& who, Following following, int replans, std::size_t row);
  std::vector<PlaceNumber> targets_for(const Members& who, const std::vector<Vec2>& from, bool with_margin,
                                       Roadmap& map) const;
  bool serves_any(const Members& seeds, const Members& who, const Roadmap& map,
                  const std::vector<PlaceNumber>& targets) const;
  std::size_t most_calls(std::size_t row) const;
  void dissolve(std::size_t group);
  JointPlan recorded(const Group& g) const;
  std::string plan_words(const Group& g) const;

  const Scenario& scenario_;
  const DecisionRules& rules_;
  const std::vector<Robot>& robots_;
  const FreeSpace* space_;
  bool plans_;
  std::function<bool()> is_stopped_;
  geometry::Box scene_;  ///< m, of obstacles, robots and goals
  double patience_;      ///< s
  double margin_;        ///< m, between robots, which plans keep where they can
  double time_ = 0.0;
  std::size_t row_ = 0;
  std::vector<RobotNow> now_;
  History history_;
  std::vector<OfRobot> of_robot_;
  std::vector<std::size_t> group_of_;
  std::vector<Group> groups_;
  std::vector<Vec2> wanted_;
  std::vector<std::string> notes_;
  struct Due {
    std::size_t robot = 0;
    bool is_dead = false;
  };
  std::vector<Due> due_;                                             ///< the robots that were stalled in the last row
  mutable std::map<std::pair<double, Detail>, Roadmap> whole_maps_;  ///< by radius
  std::vector<WithoutPlan> without_plan_;
  PlanTries tries_;
  LivenessCourse course_;
  std::vector<JointPlan> made_;
  PlanSearch search_;
};

}  // namespace exactvo::formation::detail
