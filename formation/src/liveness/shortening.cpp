// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/shortening.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "exactvo/geometry/infinity.h"
#include "liveness/distances.h"
#include "liveness/split_mix.h"

namespace exactvo::formation::detail {

SafeIntervals::SafeIntervals(const JointProblem& problem)
    : problem_(problem), passed_(problem.map->size()), stays_(problem.map->size()), first_(problem.map->size()) {}

double SafeIntervals::squared_reach(std::size_t other) const {
  const double wanted = (1.0 + kPlannedGap) * (problem_.radii[robot_] + problem_.radii[other]);
  return kSingleRounding * wanted * wanted;
}

void SafeIntervals::set(std::size_t robot, const Timetable& others, const RoadmapEdges& edges) {
  robot_ = robot;
  count_ = others.moves.size();
  for (auto& list : passed_) list.clear();
  for (auto& list : stays_) list.clear();
  std::vector<PlaceNumber> at = problem_.starts;
  std::vector<std::size_t> since(at.size(), 0);
  for (std::size_t k = 0; k < count_; ++k) {
    const JointMove& m = others.moves[k].move;
    const double reach = squared_reach(m.robot);
    for (const RoadmapEdges::NearPlace& n : edges.near_places(others.moves[k].edge)) {
      if (!(n.squared < reach)) break;
      passed_[n.place].push_back(static_cast<std::uint32_t>(k));
    }
    stays_[m.from].push_back({since[m.robot], k, reach});
    at[m.robot] = m.to;
    since[m.robot] = k + 1;
  }
  for (std::size_t i = 0; i < at.size(); ++i)
    if (i != robot) stays_[at[i]].push_back({since[i], count_, squared_reach(i)});
  size_ = 0;
  for (PlaceNumber p = 0; p < passed_.size(); ++p) {
    first_[p] = size_;
    size_ += passed_[p].size() + 1;
  }
}

std::size_t SafeIntervals::first_clear(const std::vector<RoadmapEdges::NearPlace>& near, std::size_t first,
                                       std::size_t last) const {
  for (std::size_t before = last + 1; first <= last && first != before;) {
    before = first;
    for (const RoadmapEdges::NearPlace& n : near) {
      const std::vector<Stay>& stays = stays_[n.place];
      const auto s = std::partition_point(stays.begin(), stays.end(), [&](const Stay& t) { return t.last < first; });
      if (s != stays.end() && s->first <= first && n.squared < s->reach) first = s->last + 1;
    }
  }
  return first;
}

std::size_t SafeIntervals::at(PlaceNumber place, std::size_t position) const {
  const std::vector<std::uint32_t>& passed = passed_[place];
  return first_[place] +
         static_cast<std::size_t>(std::lower_bound(passed.begin(), passed.end(), position) - passed.begin());
}

std::size_t SafeIntervals::last(PlaceNumber place, std::size_t interval) const {
  const std::size_t k = interval - first_[place];
  return k < passed_[place].size() ? passed_[place][k] : count_;
}

std::optional<std::vector<JointMove>> PathAmongOthers::moves_with(std::size_t robot, const Timetable& others,
                                                                  const std::vector<float>& to_goal, double bound) {
  const Query query{robot, &others, &to_goal, bound};
  safe_.set(robot, others, edges_);
  work_ += safe_.size() + others.moves.size();
  arrivals_.clear();
  open_.clear();
  soonest_.assign(safe_.size(), geometry::kInfinity);
  const PlaceNumber start = problem_.starts[robot], goal = problem_.goals[robot];
  offer(query, {start, safe_.at(start, 0)});
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const std::size_t number = open_.back().second;
    open_.pop_back();
    const Arrival& here = arrivals_[number];
    if (here.time > soonest_[here.interval]) continue;
    if (here.place == goal && safe_.last(goal, here.interval) == safe_.last_position()) return moves_to(query, number);
    expand(query, number);
  }
  return std::nullopt;
}

void PathAmongOthers::offer(const Query& query, const Arrival& arrival) {
  const double until_goal = arrival.time + (*query.to_goal)[arrival.place];
  if (!(arrival.time < soonest_[arrival.interval]) || !(until_goal < query.bound)) return;
  soonest_[arrival.interval] = arrival.time;
  open_.emplace_back(until_goal, arrivals_.size());
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
  arrivals_.push_back(arrival);
}

void PathAmongOthers::expand(const Query& query, std::size_t arrival) {
  const PlaceNumber from = arrivals_[arrival].place;
  const std::size_t now = position_at(*query.others, arrivals_[arrival].time);
  const std::vector<PlaceNumber>& next = problem_.map->ways(from);
  for (std::size_t k = 0; k < next.size(); ++k)
    if (problem_.map->room(next[k]) >= problem_.body(query.robot) && (*query.to_goal)[next[k]] != kFarAway)
      expand_to(query, arrival, now, next[k], edges_.kth_from(from, k));
}

/// In each of the intervals of the next place that can be reached.
void PathAmongOthers::expand_to(const Query& query, std::size_t arrival, std::size_t now, PlaceNumber to,
                                EdgeNumber edge) {
  const Arrival here = arrivals_[arrival];
  const std::size_t until = safe_.last(here.place, here.interval);
  // A robot that waits longer than it has to leaves once the move before its own is under way.
  const auto arrives = [&](std::size_t position) {
    const double free = position > now ? query.others->moves[position - 1].start + problem_.radii[query.robot] : 0.0;
    return std::max(here.time, free) + edges_.length(edge);
  };
  std::size_t interval = safe_.at(to, here.position);
  for (std::size_t first = here.position; first <= until; first = safe_.last(to, interval++) + 1) {
    const std::size_t last = std::min(until, safe_.last(to, interval)), wanted = std::clamp(now, first, last);
    const double soonest = arrives(wanted);
    if (!(soonest + (*query.to_goal)[to] < query.bound)) break;
    if (!(soonest < soonest_[interval])) continue;
    const std::vector<RoadmapEdges::NearPlace>& near = edges_.near_places(edge);
    std::size_t position = safe_.first_clear(near, wanted, last);
    if (position > last && first < wanted) position = safe_.first_clear(near, first, last);
    work_ += near.size();
    if (position <= last) offer(query, {to, interval, position, arrives(position), arrival});
  }
}

std::vector<JointMove> PathAmongOthers::moves_to(const Query& query, std::size_t arrival) const {
  std::vector<const Arrival*> way;
  for (; arrival != 0; arrival = arrivals_[arrival].parent) way.push_back(&arrivals_[arrival]);
  std::reverse(way.begin(), way.end());
  const std::vector<TimedMove>& others = query.others->moves;
  std::vector<JointMove> moves;
  moves.reserve(others.size() + way.size());
  PlaceNumber at = problem_.starts[query.robot];
  std::size_t k = 0;
  for (const Arrival* next : way) {
    for (; k < next->position; ++k) moves.push_back(others[k].move);
    moves.push_back({query.robot, at, next->place});
    at = next->place;
  }
  for (; k < others.size(); ++k) moves.push_back(others[k].move);
  return moves;
}

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
  std::size_t work() const { return work_ + among_others_.work() + kForAnEdge * edges_.size(); }

  void improve(Timetable& best, std::size_t until_work) {
    while (work() < until_work && best.last_move != kNoMove && !problem_.asks_to_stop()) {
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
