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

// Work that is counted: for each move of a timetable, edge that is looked at first, call of the generator, distance
// from a place.
constexpr std::size_t kForAMove = 20, kForAnEdge = 1000, kForACall = 30, kForADistance = 16;

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
    constexpr std::size_t kWindowsAtLeast = 10;
    // Of one stage: whether there is another is not known. Paths alone gain more where few windows have room.
    may_plan_windows_ = kWindowsAtLeast * work_of_a_window() <= std::min(kStage, most_work);
    Timetable best = timetable(moves);
    double before = geometry::kInfinity;
    while (work() < most_work && cost_of(best) < kWorthIt * before) {
      before = cost_of(best);
      improve(best, std::min(most_work, work() + kStage));
    }
    return of_range(best, 0, best.moves.size());
  }

 private:
  bool is_stopped() const { return problem_.is_stopped && problem_.is_stopped(); }
  std::size_t work() const { return work_ + among_others_.work() + kForAnEdge * edges_.size(); }
  std::size_t work_of_a_window() const { return kForADistance * problem_.radii.size() * problem_.map->size(); }

  void improve(Timetable& best, std::size_t until_work) {
    constexpr int kPathsInVain = 10;  // then a time window
    while (work() < until_work && best.last_move != kNoMove && !is_stopped()) {
      const bool is_window = in_vain_ >= kPathsInVain && may_plan_windows_;
      const std::optional<std::vector<JointMove>> other =
          is_window ? with_a_window_anew(best) : with_another_path(best);
      in_vain_ = is_window ? 0 : in_vain_ + 1;
      if (!other) continue;
      Timetable found = timetable(*other);
      if (cost_of(found) < cost_of(best)) in_vain_ = 0;
      if (cost_of(found) <= cost_of(best)) best = std::move(found);
    }
  }

  Timetable timetable(const std::vector<JointMove>& moves) {
    work_ += kForAMove * moves.size();
    return timetable_of(moves, problem_.radii, edges_);
  }

  static std::vector<JointMove> of_range(const Timetable& table, std::size_t first, std::size_t last) {
    std::vector<JointMove> moves;
    for (std::size_t k = first; k < last; ++k) moves.push_back(table.moves[k].move);
    return moves;
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

  /// The moves of all robots within a time window are planned again.
  std::optional<std::vector<JointMove>> with_a_window_anew(const Timetable& table) {
    constexpr double kLeast = 0.1, kMost = 0.5;  // of the time
    constexpr std::size_t kNodes = 200;
    const double share = kLeast + (kMost - kLeast) * random_.fraction();
    const double begin = (1.0 - share) * random_.fraction() * table.last;
    const std::size_t first = position_at(table, begin), last = position_at(table, begin + share * table.last);
    JointProblem window = problem_;
    for (const JointMove& m : of_range(table, 0, first)) window.starts[m.robot] = m.to;
    window.goals = window.starts;
    for (const JointMove& m : of_range(table, first, last)) window.goals[m.robot] = m.to;
    const JointAnswer answer = JointSearch(window).run(random_.next(), {kNodes * problem_.radii.size(), kNodes});
    work_ += kForACall * answer.calls + work_of_a_window();
    if (answer.end != SearchEnd::found) return std::nullopt;
    std::vector<JointMove> moves = of_range(table, 0, first);
    moves.insert(moves.end(), answer.moves.begin(), answer.moves.end());
    const std::vector<JointMove> rest = of_range(table, last, table.moves.size());
    moves.insert(moves.end(), rest.begin(), rest.end());
    return moves;
  }

  const JointProblem& problem_;
  RoadmapEdges edges_;
  PathAmongOthers among_others_;
  SplitMix64 random_;
  std::vector<std::vector<float>> to_goal_;  ///< m: from each place, of robots that were chosen
  std::size_t work_ = 0;
  int in_vain_ = 0;
  bool may_plan_windows_ = false;
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
  constexpr std::size_t kForEachMove = 40000, kMost = 120000000;
  constexpr std::size_t kMostMoves = 20000;
  if (moves.empty() || moves.size() > kMostMoves) return moves;
  std::vector<JointMove> shorter = Shortening(problem, seed).run(moves, std::min(kMost, kForEachMove * moves.size()));
  return are_clear(problem, shorter) ? shorter : moves;
}

}  // namespace exactvo::formation::detail
