// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How discs get from places of a roadmap to others, one moving at a time (liveness, rule R3).
///
/// LaCAM (Okumura, "LaCAM: Search-Based Algorithm for Quick Multi-Agent Pathfinding", AAAI 2023): depth-first search
/// over joint places, where each node hands out its successors lazily, by constraints on who goes where; so it is
/// complete on the map. Its generator is PIBT (Okumura, Machida, Defago and Tamura, "Priority Inheritance with
/// Backtracking for Iterative Multi-Agent Path Finding", Artificial Intelligence 310, 2022), for discs instead of
/// vertices: the robots that stand in a way, one or several, make room first, and a joint step is a sequence of
/// single moves, each clear of where the others are at that moment.
///
/// Properties (tests quote the numbers):
///  (1) in the sequence of moves each disc keeps (1 + kPlannedGap) times the sum of the radii from every other where it
///      stands then, or, where they began nearer, does not come nearer than at the start of the move;
///  (2) every move goes along a way of the map, from where its robot is;
///  (3) after the last move each robot is at its goal;
///  (4) the same problem and seed give the same answer; budgets are counted, not timed.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "liveness/roadmap.h"

namespace exactvo::formation::detail {

struct JointProblem {
  const Roadmap* map = nullptr;
  std::vector<double> radii;              ///< m, of each robot, as the others keep clear of it
  std::vector<double> bodies = {};        ///< m, what ways leave room for; empty: the radii
  std::vector<PlaceNumber> starts;        ///< whose discs do not overlap
  std::vector<PlaceNumber> goals;         ///< the same
  std::function<bool()> is_stopped = {};  ///< asked now and then: true ends every search out of budget

  double body(std::size_t robot) const { return bodies.empty() ? radii[robot] : bodies[robot]; }
  bool asks_to_stop() const { return is_stopped && is_stopped(); }
};

struct JointMove {
  std::size_t robot = 0;
  PlaceNumber from = 0, to = 0;
};

struct SearchBudget {
  std::size_t calls = 0;  ///< of the generator for a robot
  std::size_t nodes = 0;
};

enum class SearchEnd {
  found,
  none_on_map,  ///< every joint place that can be reached was tried
  out_of_budget
};

struct JointAnswer {
  SearchEnd end = SearchEnd::out_of_budget;
  std::vector<JointMove> moves;
  std::size_t calls = 0, nodes = 0;
};

/// What each robot heads for first.
enum class GuidedBy {
  lengths,  ///< the shortest way to its goal
  lanes     ///< a way on which few come the other way
};

/// One problem, searched as often as wanted: with other seeds, other ways are tried first.
class JointSearch {
 public:
  /// Keeps a reference to the map.
  explicit JointSearch(JointProblem problem);
  ~JointSearch();

  JointAnswer run(std::uint64_t seed, const SearchBudget& budget, GuidedBy guided_by = GuidedBy::lengths);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace exactvo::formation::detail
