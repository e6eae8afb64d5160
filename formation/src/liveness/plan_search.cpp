// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/plan_search.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <thread>
#include <utility>

#include "liveness/shortening.h"
#include "liveness/timetable.h"

namespace exactvo::formation::detail {
namespace {

constexpr std::size_t kFirstNodes = 200;
constexpr double kMoreNodes = 1.15;
constexpr int kPlansToChooseFrom = 12;
constexpr std::size_t kChoosesUpTo = 100;  ///< robots
constexpr std::size_t kCallsForABetter = 150000;

/// For all threads: the question is put by the one that made this, and the others hear of the answer.
class StopForAll {
 public:
  explicit StopForAll(std::function<bool()> is_stopped)
      : is_stopped_(std::move(is_stopped)), asks_(std::this_thread::get_id()) {}
  StopForAll(const StopForAll&) = delete;

  bool operator()() {
    if (std::this_thread::get_id() == asks_ && is_stopped_ && asks()) stopped_ = true;
    return stopped_;
  }

 private:
  /// Who answers with an exception stops the others too.
  bool asks() {
    try {
      return is_stopped_();
    } catch (...) {
      stopped_ = true;
      throw;
    }
  }

  std::function<bool()> is_stopped_;
  std::thread::id asks_;
  std::atomic<bool> stopped_{false};
};

}  // namespace

/// One search, within limits that it may turn out to have once those before it are done.
struct PlanSearch::Attempt {
  SearchBudget budget;
  JointAnswer answer = {};  ///< without loops
  double length = 0.0;      ///< m, that its timetable takes, where one was found

  /// Whether the same comes of these limits: they are its own, or it reached neither.
  bool holds_for(const SearchBudget& limits) const {
    return (budget.nodes == limits.nodes || answer.nodes <= std::min(budget.nodes, limits.nodes)) &&
           (budget.calls == limits.calls || answer.calls <= std::min(budget.calls, limits.calls));
  }
  /// No search comes after it within the same budget.
  bool has_spent_all() const { return answer.calls >= budget.calls; }
};

std::vector<PlanSearch::Attempt> PlanSearch::searched(JointSearch& joint, const JointProblem& about,
                                                      SearchBudget budget, double growth, bool lanes) {
  std::vector<Attempt> attempts;
  std::atomic<bool> first_ends_all{false};
  // No more than can count: a node costs about a call for each robot.
  const double most_nodes =
      static_cast<double>(std::max(budget.calls, kCallsForABetter) / std::max<std::size_t>(1, about.radii.size()));
  double nodes = nodes_, sum = 0.0;
  const auto most = static_cast<std::size_t>(tasks_.threads());
  for (; attempts.size() < most && (attempts.empty() || sum < most_nodes); sum += nodes, nodes *= growth) {
    budget.nodes = static_cast<std::size_t>(nodes);
    attempts.emplace_back().budget = budget;
    // As if the first one found a plan.
    if (growth > 1.0) budget.calls = kCallsForABetter;
    budget.cancelled = &first_ends_all;
  }
  tasks_.for_ranges(attempts.size(), 1, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t k = first; k < last; ++k) {
      Attempt& a = attempts[k];
      const std::uint64_t seed = seed_ + k;
      a.answer = joint.run(seed + 1, a.budget, lanes && seed % 2 == 0 ? GuidedBy::lanes : GuidedBy::lengths);
      const bool is_enough = a.answer.end == SearchEnd::found && about.radii.size() > kChoosesUpTo;
      if (k == 0 && (a.has_spent_all() || is_enough)) first_ends_all = true;
      if (a.answer.end != SearchEnd::found) continue;
      a.answer.moves = without_loops(*about.map, std::move(a.answer.moves), about.radii);
      RoadmapEdges edges(*about.map, 2.0 * *std::max_element(about.radii.begin(), about.radii.end()));
      a.length = timetable_of(a.answer.moves, about.radii, edges).last;
    }
  });
  if (first_ends_all) attempts.resize(1);
  return attempts;
}

PlanFound PlanSearch::best_plan(JointProblem problem, std::size_t calls, bool lanes) {
  StopForAll stop(problem.is_stopped);
  problem.is_stopped = [&stop] { return stop(); };
  JointSearch joint(problem, &tasks_);
  const int wanted = problem.radii.size() <= kChoosesUpTo ? kPlansToChooseFrom : 1;
  PlanFound best;
  std::vector<JointMove> moves;
  double shortest = std::numeric_limits<double>::infinity();
  int found = 0;
  std::vector<Attempt> attempts;
  std::size_t next = 0;
  nodes_ = kFirstNodes;
  for (std::size_t spent = 0, limit = calls; spent < limit && found < wanted && !stop();) {
    const SearchBudget budget{limit - spent, static_cast<std::size_t>(nodes_)};
    if (next == attempts.size() || !attempts[next].holds_for(budget)) {
      attempts = searched(joint, problem, budget, found > 0 ? 1.0 : kMoreNodes, lanes);
      next = 0;
    }
    Attempt& a = attempts[next++];
    ++seed_;
    spent += a.answer.calls + 1;
    best.nodes += a.answer.nodes;
    if (a.answer.end == SearchEnd::none_on_map) {
      best.end = PlanEnd::none_on_map;
      break;
    }
    if (a.answer.end == SearchEnd::out_of_budget) {
      if (found == 0) nodes_ *= kMoreNodes;
      continue;
    }
    if (found++ == 0) limit = spent + kCallsForABetter;
    if (!(a.length < shortest)) continue;
    shortest = a.length;
    moves = std::move(a.answer.moves);
  }
  if (found > 0) {
    best.end = PlanEnd::planned;
    moves = without_loops(*problem.map, shortened(problem, moves, seed_), problem.radii);
    best.plan = plan_of(*problem.map, moves, problem.radii);
  }
  return best;
}

}  // namespace exactvo::formation::detail
