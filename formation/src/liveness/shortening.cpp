// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/shortening.h"

#include <algorithm>
#include <optional>

#include "liveness/distances.h"
#include "liveness/split_mix.h"
#include "liveness/timetable.h"
#include "liveness/way_among_others.h"

namespace exactvo::formation::detail {
namespace {

// Work that is counted: for each move of a timetable, call of the generator, distance from a place.
constexpr std::size_t kForAMove = 16, kForACall = 30, kForADistance = 16;

/// m: mostly of who is there last.
double cost_of(const Timetable& table) {
  constexpr double kOfTheMean = 0.2;
  return table.last + kOfTheMean * table.mean;
}

class Shortening {
 public:
  Shortening(const JointProblem& problem, std::uint64_t seed)
      : problem_(problem),
        ways_(*problem.map, 2.0 * *std::max_element(problem.radii.begin(), problem.radii.end())),
        among_others_(problem, ways_),
        random_(seed),
        left_(problem.radii.size()) {}

  std::vector<JointMove> run(const std::vector<JointMove>& moves, std::size_t most_work) {
    constexpr int kThenAPart = 10;  // failures in a row
    constexpr std::size_t kParts = 10;
    const bool may_search_parts = kParts * kForADistance * problem_.radii.size() * problem_.map->size() <= most_work;
    Timetable best = timetable(moves);
    for (int failures = 0; work() < most_work && !best.moves.empty() && !is_stopped();) {
      const bool is_part = failures >= kThenAPart && may_search_parts;
      const std::optional<std::vector<JointMove>> other = is_part ? with_a_part_anew(best) : with_another_way(best);
      failures = is_part || other ? 0 : failures + 1;
      if (!other) continue;
      Timetable found = timetable(*other);
      if (cost_of(found) <= cost_of(best)) best = std::move(found);
    }
    return of_range(best, 0, best.moves.size());
  }

 private:
  bool is_stopped() const { return problem_.is_stopped && problem_.is_stopped(); }
  std::size_t work() const { return work_ + among_others_.work(); }

  Timetable timetable(const std::vector<JointMove>& moves) {
    work_ += kForAMove * moves.size();
    return timetable_of(moves, problem_.radii, ways_);
  }

  static std::vector<JointMove> of_range(const Timetable& table, std::size_t first, std::size_t last) {
    std::vector<JointMove> moves;
    for (std::size_t k = first; k < last; ++k) moves.push_back(table.moves[k].move);
    return moves;
  }

  /// Mostly one of the chain of moves that takes longest.
  std::size_t chosen(const Timetable& table) {
    constexpr std::size_t kOfTheChain = 3, kOf = 4;
    if (random_.below(kOf) >= kOfTheChain) return random_.below(problem_.radii.size());
    std::vector<std::size_t> chain;
    for (std::size_t k = table.last_move; k != kNoMove; k = table.moves[k].waits_for)
      chain.push_back(table.moves[k].move.robot);
    return chain[random_.below(chain.size())];
  }

  const std::vector<float>& left(std::size_t robot) {
    if (left_[robot].empty())
      left_[robot] = distances_to(*problem_.map, problem_.goals[robot], problem_.radii[robot],
                                  [&](PlaceNumber a, PlaceNumber b) { return length_of_way(*problem_.map, a, b); });
    return left_[robot];
  }

  /// The others keep their times, so that there is the way that it had, if no better one.
  std::optional<std::vector<JointMove>> with_another_way(const Timetable& table) {
    constexpr double kSlack = 1.1;  // times are estimates
    const std::size_t robot = chosen(table);
    Timetable others;
    for (const TimedMove& t : table.moves)
      if (t.move.robot != robot) others.moves.push_back(t);
    return among_others_.moves_with(robot, others, left(robot), kSlack * table.last);
  }

  std::optional<std::vector<JointMove>> with_a_part_anew(const Timetable& table) {
    constexpr double kLeast = 0.1, kMost = 0.5;  // of the time
    constexpr std::size_t kNodes = 200;
    const double share = kLeast + (kMost - kLeast) * random_.fraction();
    const double begin = (1.0 - share) * random_.fraction() * table.last;
    const auto position_at = [&](double time) {
      const auto starts_before = [&](const TimedMove& m) { return m.start < time; };
      return static_cast<std::size_t>(std::partition_point(table.moves.begin(), table.moves.end(), starts_before) -
                                      table.moves.begin());
    };
    const std::size_t first = position_at(begin), last = position_at(begin + share * table.last);
    JointProblem part = problem_;
    for (const JointMove& m : of_range(table, 0, first)) part.starts[m.robot] = m.to;
    part.goals = part.starts;
    for (const JointMove& m : of_range(table, first, last)) part.goals[m.robot] = m.to;
    const std::size_t robots = problem_.radii.size();
    const JointAnswer answer = JointSearch(part).run(random_.next(), {kNodes * robots, kNodes});
    work_ += kForACall * answer.calls + kForADistance * robots * problem_.map->size();
    if (answer.end != SearchEnd::found) return std::nullopt;
    std::vector<JointMove> moves = of_range(table, 0, first);
    moves.insert(moves.end(), answer.moves.begin(), answer.moves.end());
    const std::vector<JointMove> rest = of_range(table, last, table.moves.size());
    moves.insert(moves.end(), rest.begin(), rest.end());
    return moves;
  }

  const JointProblem& problem_;
  Ways ways_;
  WayAmongOthers among_others_;
  SplitMix64 random_;
  std::vector<std::vector<float>> left_;  ///< m: of robots that were chosen, from each place to the goal
  std::size_t work_ = 0;
};

}  // namespace

std::vector<JointMove> shortened(const JointProblem& problem, const std::vector<JointMove>& moves, std::uint64_t seed) {
  constexpr std::size_t kForEachMove = 40000, kMost = 30000000;
  return Shortening(problem, seed).run(moves, std::min(kMost, kForEachMove * moves.size()));
}

}  // namespace exactvo::formation::detail
