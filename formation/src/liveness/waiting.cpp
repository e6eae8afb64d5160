// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/waiting.h"

#include <algorithm>
#include <array>

#include "motion/leader.h"
#include "scene/goals.h"
#include "scene/near_pairs.h"
#include "scene/number_text.h"
#include "scene/step_limits.h"
#include "steering/last_places.h"

namespace exactvo::formation {
namespace {

using geometry::norm;

// Shares of a robot's own fastest speed.
constexpr double kWantsNothing = 1e-3;  ///< a robot that wants less is not held up
/// A faster robot does not stand: a ring of robots that wait for each other may turn slowly, and get apart.
constexpr double kMoves = 1.0 / 15.0;
/// Robots of a chain that are named one by one.
constexpr std::size_t kNamed = 6;

bool is_held_up(const RobotStep& r, const Robot& robot) {
  const double wanted = geometry::squared_norm(r.preferred), nothing = kWantsNothing * robot.max_speed;
  return r.mode != Mode::arrived && wanted > nothing * nothing && dot(r.chosen, r.preferred) < kHeldBelow * wanted;
}

/// A row may have all half-planes or those that bind and those in reach: only these count, so that both say the same.
bool holds(const DecisionConstraint& c, const RobotStep& r, const Scenario& scenario, std::size_t robot) {
  const double near = std::max(scenario.robots[robot].radius, detail::kNearMargins * scenario.margins.robot);
  return c.source == ConstraintSource::robot && !is_own_limit(c) && c.clearance < near &&
         (c.active || c.clearance <= detail::reach_of_pair(scenario.time_step, scenario.robots[robot].max_speed,
                                                           scenario.robots[c.index].max_speed)) &&
         (c.multiplier > 0.0 || geometry::violation(c.half_plane, r.preferred) > 0.0);
}

std::vector<std::size_t> held_by(const RobotStep& r, const Scenario& scenario, std::size_t robot) {
  std::vector<const DecisionConstraint*> by;
  if (is_held_up(r, scenario.robots[robot]))
    for (const DecisionConstraint& c : r.constraints)
      if (holds(c, r, scenario, robot)) by.push_back(&c);
  std::stable_sort(by.begin(), by.end(), [](const auto* a, const auto* b) { return a->multiplier > b->multiplier; });
  std::vector<std::size_t> robots;
  for (const DecisionConstraint* c : by) robots.push_back(c->index);
  return robots;
}

/// The robots met by going on to the one that holds each most, until one that waits for nobody or was met before.
std::vector<std::size_t> chain_from(const WaitForGraph& graph, std::size_t robot) {
  std::vector<std::size_t> chain{robot};
  std::vector<char> met(graph.size(), 0);
  met[robot] = 1;
  while (!graph[chain.back()].empty()) {
    const std::size_t next = graph[chain.back()].front();
    chain.push_back(next);
    if (met[next]) break;
    met[next] = 1;
  }
  return chain;
}

/// The end of a chain that comes back to where it has been; empty where it does not.
std::vector<std::size_t> cycle_of(const std::vector<std::size_t>& chain) {
  const auto first = std::find(chain.begin(), chain.end() - 1, chain.back());
  return {first, chain.end() - 1};
}

std::string count(std::size_t n) {
  constexpr std::array<const char*, 10> kWords{"none", "one", "two",   "three", "four",
                                               "five", "six", "seven", "eight", "nine"};
  return n < kWords.size() ? kWords[n] : std::to_string(n);
}

/// "R3 waits for R4, which waits for R1".
std::string chained(const Scenario& scenario, const std::vector<std::size_t>& chain) {
  std::string text = scenario.robots[chain.front()].id;
  const std::size_t named = std::min(chain.size(), kNamed);
  for (std::size_t k = 1; k < named; ++k)
    text += (k == 1 ? " waits for " : ", which waits for ") + scenario.robots[chain[k]].id;
  if (named == chain.size()) return text;
  if (named + 1 == chain.size()) return text + ", which waits for " + scenario.robots[chain.back()].id;
  return text + " and so on through " + count(chain.size() - named - 1) + " more to " +
         scenario.robots[chain.back()].id;
}

std::string end_words(const Scenario& scenario, const Step& row, std::size_t robot) {
  const RobotStep& r = row.robots[robot];
  if (r.mode == Mode::arrived) return ", which rests at its goal";
  if (r.mode == Mode::staying) return ", which stays, since " + why_it_stays(scenario, row, robot);
  return stands(scenario.robots[robot], r.chosen) ? ", which is held up by no robot near it" : ", which moves";
}

}  // namespace

WaitForGraph waiting_in(const Scenario& scenario, const Step& row) {
  WaitForGraph graph(row.robots.size());
  // While the leader drives, a formation's robots hold each other up and go on.
  if (scenario.formation && row.time < detail::leader_arrival(scenario.formation->leader)) return graph;
  for (std::size_t i = 0; i < graph.size(); ++i) graph[i] = held_by(row.robots[i], scenario, i);
  return graph;
}

std::vector<std::vector<std::size_t>> deadlocks_in(const WaitForGraph& graph) {
  std::vector<std::vector<std::size_t>> cycles;
  std::vector<char> known(graph.size(), 0);
  for (std::size_t i = 0; i < graph.size(); ++i) {
    std::vector<std::size_t> chain{i};
    while (!known[chain.back()] && !graph[chain.back()].empty()) {
      known[chain.back()] = 1;
      chain.push_back(graph[chain.back()].front());
    }
    known[chain.back()] = 1;
    std::vector<std::size_t> cycle = cycle_of(chain);
    if (cycle.empty()) continue;
    std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
    cycles.push_back(std::move(cycle));
  }
  std::sort(cycles.begin(), cycles.end());
  return cycles;
}

bool stands(const Robot& robot, Vec2 velocity) {
  return norm(velocity) < kMoves * robot.max_speed;
}

bool is_dead(const Scenario& scenario, const WaitForGraph& graph, const Step& row, std::size_t robot) {
  std::vector<std::size_t> open{robot};
  std::vector<char> met(graph.size(), 0);
  met[robot] = 1;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    const RobotStep& r = row.robots[i];
    if (r.mode != Mode::arrived && !stands(scenario.robots[i], r.chosen)) return false;
    for (const std::size_t j : graph[i])
      if (!met[j]) {
        met[j] = 1;
        open.push_back(j);
      }
  }
  return true;
}

std::string deadlock_words(const Scenario& scenario, const std::vector<std::size_t>& cycle) {
  std::vector<std::size_t> chain = cycle;
  chain.push_back(cycle.front());
  return chained(scenario, chain) + ": a deadlock of " + count(cycle.size());
}

/// A cycle of which some still move may come apart.
std::string waiting_words(const Scenario& scenario, const Step& row, const WaitForGraph& graph, std::size_t robot) {
  if (graph[robot].empty()) return "";
  const std::vector<std::size_t> chain = chain_from(graph, robot), cycle = cycle_of(chain);
  const bool is_deadlock = std::all_of(cycle.begin(), cycle.end(),
                                       [&](std::size_t i) { return stands(scenario.robots[i], row.robots[i].chosen); });
  if (!cycle.empty() && cycle.front() == robot && is_deadlock) return deadlock_words(scenario, cycle);
  if (!cycle.empty()) {
    const auto back = std::find(chain.begin(), chain.end(), chain.back());
    if (cycle.front() == robot || !is_deadlock) return chained(scenario, chain);
    return chained(scenario, {chain.begin(), back + 1}) + ", which is in a deadlock of " + count(cycle.size());
  }
  const std::string queue = chain.size() > 2 ? "queue of " + std::to_string(chain.size()) + ": " : "";
  return queue + chained(scenario, chain) + end_words(scenario, row, chain.back());
}

/// Names, among the robots about their goals that could have taken its own, the one nearest to its goal; where robots
/// end elsewhere, only one that is at its goal.
std::string why_it_stays(const Scenario& scenario, const Step& row, std::size_t robot) {
  if (scenario.formation) return "its slot cannot be filled";
  std::optional<std::size_t> first;
  bool may_be_taken = scenario.unreachable == Unreachable::nearest && row.robots.size() > 1;
  const auto from_goal = [&](std::size_t j) { return norm(scenario.robots[j].goals.back() - row.robots[j].position); };
  for (std::size_t j = 0; j < row.robots.size(); ++j) {
    const double apart = norm(scenario.robots[j].goals.back() - scenario.robots[robot].goals.back());
    const bool is_rival = j != robot && detail::leave_no_room(scenario, robot, j, apart);
    may_be_taken = may_be_taken || is_rival;
    if (!is_rival || row.robots[j].mode == Mode::staying) continue;
    const double pushed =
        scenario.unreachable == Unreachable::nearest ? 0.0 : scenario.robots[robot].radius + scenario.robots[j].radius;
    const double about = scenario.arrival_tolerance + 2.0 * pushed;
    if (from_goal(j) <= about && (!first || from_goal(j) < from_goal(*first))) first = j;
  }
  if (first) return detail::first_at_goal_words(scenario.robots[*first], scenario.robots[robot]);
  return may_be_taken ? "its goal is out of reach or taken" : "its goal is out of reach";
}

}  // namespace exactvo::formation
