// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/plan_search.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "liveness/shortening.h"
#include "liveness/timetable.h"

namespace exactvo::formation::detail {
namespace {

constexpr double kFirstNodes = 200.0;
constexpr double kMoreNodes = 1.15;
constexpr int kPlansToChooseFrom = 12;
constexpr std::size_t kChoosesUpTo = 100;  ///< robots
constexpr std::size_t kCallsForABetter = 150000;

}  // namespace

PlanFound PlanSearch::best_plan(const JointProblem& problem, std::size_t calls, bool lanes) {
  JointSearch joint(problem);
  const int wanted = problem.radii.size() <= kChoosesUpTo ? kPlansToChooseFrom : 1;
  PlanFound best;
  std::vector<JointMove> moves;
  double shortest = std::numeric_limits<double>::infinity(), nodes = kFirstNodes;
  int found = 0;
  for (std::size_t spent = 0, limit = calls; spent < limit && found < wanted && !problem.asks_to_stop();) {
    const std::uint64_t seed = seed_++;
    JointAnswer answer = joint.run(seed + 1, {limit - spent, static_cast<std::size_t>(nodes)},
                                   lanes && seed % 2 == 0 ? GuidedBy::lanes : GuidedBy::lengths);
    spent += answer.calls + 1;
    best.nodes += answer.nodes;
    if (answer.end == SearchEnd::none_on_map) {
      best.end = PlanEnd::none_on_map;
      break;
    }
    if (answer.end == SearchEnd::out_of_budget) {
      if (found == 0) nodes *= kMoreNodes;
      continue;
    }
    if (found++ == 0) limit = spent + kCallsForABetter;
    answer.moves = without_loops(*problem.map, std::move(answer.moves), problem.radii);
    RoadmapEdges edges(*problem.map, 2.0 * *std::max_element(problem.radii.begin(), problem.radii.end()));
    const double length = timetable_of(answer.moves, problem.radii, edges).last;
    if (!(length < shortest)) continue;
    shortest = length;
    moves = std::move(answer.moves);
  }
  if (found > 0) {
    best.end = PlanEnd::planned;
    moves = without_loops(*problem.map, shortened(problem, moves, seed_), problem.radii);
    best.plan = plan_of(*problem.map, moves, problem.radii);
  }
  return best;
}

}  // namespace exactvo::formation::detail
