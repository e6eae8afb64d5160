// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/shortening.h"

#include <algorithm>
#include <optional>

#include "exactvo/geometry/infinity.h"
#include "liveness/distances.h"
#include "liveness/path_among_others.h"
#include "liveness/split_mix.h"
#include "liveness/timetable.h"

namespace exactvo::formation::detail {
namespace {

// Work that is counted: for each move of a timetable, edge that is looked at first, distance from a place.
constexpr std::size_t kForAMove = 20, kForAnEdge = 1000, kForADistance = 16;

/// m: mostly of who is there last.
double cost_of(const Timetable& table) {
  constexpr double kOfTheMean = 0.2;
  return table.last + kOfTheMean * table.mean;
}

class Shortening {
 public:
  Shortening(const JointProblem& problem, std::uint64_t seed)
      : problem_(problem),
        edges_(*problem.map, 2.0 * *std::max_element(problem.radii.begin(), problem.radii.end())),
        among_others_(problem, edges_),
        random_(seed),
        to_goal_(problem.radii.size()) {}

  std::vector<JointMove> run(const std::vector<JointMove>& moves, std::size_t most_work) {
    constexpr std::size_t kStage = 30000000;  // of work; another one follows where it was worth it
    constexpr double kWorthIt = 0.98;
    Timetable best = timetable(moves);
    double before = geometry::kInfinity;
    while (work() < most_work && cost_of(best) < kWorthIt * before) {
      before = cost_of(best);
      improve(best, std::min(most_work, work() + kStage));
    }
    std::vector<JointMove> shorter;
    for (const TimedMove& t : best.moves) shorter.push_back(t.move);
    return shorter;
  }

 private:
  bool is_stopped() const { return problem_.is_stopped && problem_.is_stopped(); }
  std::size_t work() const { return work_ + among_others_.work() + kForAnEdge * edges_.size(); }

  void improve(Timetable& best, std::size_t until_work) {
    while (work() < until_work && best.last_move != kNoMove && !is_stopped()) {
      const std::optional<std::vector<JointMove>> other = with_another_path(best);
      if (!other) continue;
      Timetable found = timetable(*other);
      if (cost_of(found) <= cost_of(best)) best = std::move(found);
    }
  }

  Timetable timetable(const std::vector<JointMove>& moves) {
    work_ += kForAMove * moves.size();
    return timetable_of(moves, problem_.radii, edges_);
  }

  /// Three times of four a robot of the chain of moves that takes longest.
  std::size_t chosen(const Timetable& table) {
    if (random_.below(4) == 0) return random_.below(problem_.radii.size());
    std::vector<std::size_t> chain;
    for (std::size_t k = table.last_move; k != kNoMove; k = table.moves[k].waits_for)
      chain.push_back(table.moves[k].move.robot);
    return chain[random_.below(chain.size())];
  }

  const std::vector<float>& to_goal(std::size_t robot) {
    if (!to_goal_[robot].empty()) return to_goal_[robot];
    work_ += kForADistance * problem_.map->size();
    return to_goal_[robot] =
               distances_to(*problem_.map, problem_.goals[robot], problem_.body(robot),
                            [&](PlaceNumber a, PlaceNumber b) { return length_of_way(*problem_.map, a, b); });
  }

  /// The others keep their times, so that there is the path that it had, if no better one.
  std::optional<std::vector<JointMove>> with_another_path(const Timetable& table) {
    constexpr double kSlack = 1.1;  // times are estimates
    const std::size_t robot = chosen(table);
    Timetable others;
    for (const TimedMove& t : table.moves)
      if (t.move.robot != robot) others.moves.push_back(t);
    return among_others_.moves_with(robot, others, to_goal(robot), kSlack * table.last);
  }

  const JointProblem& problem_;
  RoadmapEdges edges_;
  PathAmongOthers among_others_;
  SplitMix64 random_;
  std::vector<std::vector<float>> to_goal_;  ///< m: from each place, of robots that were chosen
  std::size_t work_ = 0;
};

/// Property (1) of joint_search.h, move by move.
bool are_clear(const JointProblem& problem, const std::vector<JointMove>& moves) {
  std::vector<PlaceNumber> at = problem.starts;
  for (const JointMove& m : moves) {
    const Vec2 from = problem.map->place(m.from), to = problem.map->place(m.to);
    for (std::size_t j = 0; j < at.size(); ++j) {
      const Vec2 other = problem.map->place(at[j]);
      const double keep = squared_keep(problem.radii[m.robot] + problem.radii[j], squared_norm(from - other));
      if (j != m.robot && squared_distance(other, from, to) < keep) return false;
    }
    at[m.robot] = m.to;
  }
  return true;
}

}  // namespace

std::vector<JointMove> shortened(const JointProblem& problem, const std::vector<JointMove>& moves, std::uint64_t seed) {
  constexpr std::size_t kForEachMove = 25000, kMost = 120000000;
  constexpr std::size_t kMostMoves = 20000;
  if (moves.empty() || moves.size() > kMostMoves) return moves;
  std::vector<JointMove> shorter = Shortening(problem, seed).run(moves, std::min(kMost, kForEachMove * moves.size()));
  return are_clear(problem, shorter) ? shorter : moves;
}

}  // namespace exactvo::formation::detail
