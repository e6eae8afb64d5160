// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Repair instead of relaxing (liveness, rule R0): where the half-planes of robots contradict each other, their pairs
/// fall back to those that they would have at rest. What is decided then satisfies all of them.

#include <algorithm>
#include <set>
#include <vector>

#include "decision/decision.h"

namespace exactvo::formation::detail {

/// As long as there are robots whose half-planes contradict each other, all pairs of these fall back. In each round
/// some pair does so for good, so that it ends. Half-planes of moving obstacles and of robots that do not yield may
/// still be relaxed. Afterwards entry i of the answer has those with whom robot i fell back.
///
/// `is_contradicted(i)`: whether the half-planes of robot i, as it decided last, contradict each other.
/// `decide_again(i, fallen)`: it decides again, with `constraints[i]` as they are; `fallen` as above.
/// `gap`: m, that pairs which fall back keep.
template <class IsContradicted, class DecideAgain>
std::vector<std::vector<std::size_t>> repair(const Scenario& scenario, const std::vector<Anchor>& anchors,
                                             const Scene& scene, std::vector<std::vector<Constraint>>& constraints,
                                             const IsContradicted& is_contradicted, const DecideAgain& decide_again,
                                             double gap = kContactSkin) {
  const std::size_t n = constraints.size();
  std::set<std::size_t> contradicted;
  for (std::size_t i = 0; i < n; ++i)
    if (is_contradicted(i)) contradicted.insert(i);
  std::vector<std::vector<std::size_t>> fallen(n);
  while (!contradicted.empty()) {
    std::set<std::size_t> changed;
    for (const std::size_t i : contradicted) {
      for (const std::size_t j : robots_met_by(scene, constraints[i])) {
        const bool both_yield = scenario.robots[i].cooperates && scenario.robots[j].cooperates;
        if (!both_yield || std::find(fallen[i].begin(), fallen[i].end(), j) != fallen[i].end()) continue;
        fall_back(scenario, anchors, scene, i, j, constraints, gap);
        fallen[i].push_back(j);
        fallen[j].push_back(i);
        changed.insert(i);
        changed.insert(j);
      }
    }
    contradicted.clear();
    for (const std::size_t i : changed) {
      decide_again(i, fallen[i]);
      if (is_contradicted(i)) contradicted.insert(i);
    }
  }
  return fallen;
}

}  // namespace exactvo::formation::detail
