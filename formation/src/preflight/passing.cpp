// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/passing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "liveness/roadmap.h"
#include "liveness/sweeps.h"
#include "preflight/preflight.h"
#include "preflight/square_cover.h"
#include "preflight/strip.h"
#include "reach/reachability.h"
#include "scene/goals.h"

namespace exactvo::formation {
namespace {

using detail::GridSquare;
using detail::kProductRoundedDown;
using detail::SquareCover;

constexpr std::size_t kMostLooks = 200000;            ///< at squares, in all: 0.1 s
constexpr std::size_t kMostPairs = 8000000;           ///< that are gone to, in all: half a second
constexpr std::size_t kMostLooksOfStrips = 20000000;  ///< at walls and squares of strips, in all: 0.2 s
constexpr double kCoarsestSquare = 0.25;              ///< side of a square, of the smaller radius
constexpr double kFinestSquare = 1.0 / 16.0;          ///< the same

/// Whether what is covered comes within reach of the goal: else the walls alone keep the disc from it.
bool holds_goal(const std::vector<char>& is_at) {
  return std::find(is_at.begin(), is_at.end(), char{1}) != is_at.end();
}

/// What a search over pairs of squares comes to.
struct PairSearch {
  enum class End { reaches_goals, proven, out_of_budget } end = End::out_of_budget;
  std::size_t pairs = 0;
};

struct Traveller {
  const SquareCover* cover = nullptr;
  std::uint32_t start = 0;
  std::vector<char> is_goal;
};

PairSearch search(const Traveller& a, const Traveller& b, std::size_t most) {
  const double radii = (a.cover->radius + b.cover->radius) / a.cover->side;
  const double least = radii * radii * kProductRoundedDown;
  // Two points of the squares are at most this far from each other.
  const auto can_be_apart = [&](std::uint32_t i, std::uint32_t j) {
    const GridSquare p = a.cover->squares[i], q = b.cover->squares[j];
    const double x = std::fabs(double(p.x) - double(q.x)) + 1.0, y = std::fabs(double(p.y) - double(q.y)) + 1.0;
    return x * x + y * y >= least;
  };
  const std::size_t width = b.cover->squares.size();
  std::vector<bool> seen(a.cover->squares.size() * width);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  PairSearch found;
  const auto visit = [&](std::uint32_t i, std::uint32_t j) {
    if (seen[i * width + j] || !can_be_apart(i, j)) return;
    seen[i * width + j] = true;
    open.emplace_back(i, j);
    ++found.pairs;
    if (a.is_goal[i] && b.is_goal[j]) found.end = PairSearch::End::reaches_goals;
  };
  visit(a.start, b.start);
  while (!open.empty() && found.end != PairSearch::End::reaches_goals) {
    if (found.pairs > most) return found;
    const auto [i, j] = open.back();
    open.pop_back();
    for (const std::uint32_t next : a.cover->beside[i]) visit(next, j);
    for (const std::uint32_t next : b.cover->beside[j]) visit(i, next);
  }
  if (found.end != PairSearch::End::reaches_goals) found.end = PairSearch::End::proven;
  return found;
}

/// What is asked of two robots.
enum class Asked { for_room, for_room_with_gaps };

class Proofs {
 public:
  Proofs(const Scenario& scenario, Asked asked)
      : scenario_(scenario),
        asked_(asked),
        walls_(scenario.obstacles),
        reach_(detail::terrain_of(scenario), 0.0, false) {}

  /// Where a robot gets to that proofs are looked for about; else null. A robot that starts in a wall is pushed out of
  /// it: nothing holds it in its cover. A robot whose goal is out of reach is left out, as is one with a chain of
  /// discs.
  const SquareCover* little_room(std::size_t i) {
    const Robot& r = scenario_.robots[i];
    if (r.goals.size() != 1 || !(r.radius > 0.0) || obstacle_radius(r) < r.radius ||
        walls_.exclude(r.position, r.radius))
      return nullptr;
    const SquareCover* cover = cover_of(i, coarsest_side(r.radius));
    return cover && holds_goal(squares_at_goal(i, *cover)) ? cover : nullptr;
  }

  bool is_in(const SquareCover& cover, std::size_t robot) const {
    const Vec2 p = scenario_.robots[robot].position;
    return detail::fits_grid(p, cover.side) && cover.has(detail::square_at(p, cover.side));
  }

  /// That the two cannot pass, where each of them could reach its goal if the other were not there. REQUIRES: both have
  /// little room.
  std::optional<NoPassing> of(std::size_t i, std::size_t j) {
    if (overlap_at_start(i, j) ||
        detail::are_too_near(scenario_.robots[i], scenario_.robots[j], scenario_.arrival_tolerance))
      return std::nullopt;
    std::optional<NoPassing> proof = asked_ == Asked::for_room ? by_walls(i, j) : by_gaps(i, j);
    return proof && !is_out_of_reach(i) && !is_out_of_reach(j) ? std::move(proof) : std::nullopt;
  }

 private:
  std::optional<NoPassing> by_walls(std::size_t i, std::size_t j) {
    if (std::optional<NoPassing> proof = in_a_strip(i, j, side_by_side(i, j))) return proof;
    const double smaller = std::min(scenario_.robots[i].radius, scenario_.robots[j].radius);
    for (double side = coarsest_side(smaller); side >= kFinestSquare * smaller; side *= 0.5) {
      const SquareCover* of_i = cover_of(i, side);
      const SquareCover* of_j = of_i ? cover_of(j, side) : nullptr;
      if (!of_j || !(is_in(*of_i, j) || is_in(*of_j, i))) return std::nullopt;
      const Traveller first = traveller(i, *of_i), second = traveller(j, *of_j);
      if (!holds_goal(first.is_goal) || !holds_goal(second.is_goal)) return std::nullopt;
      const PairSearch found = search(first, second, pairs_left_);
      pairs_left_ -= std::min(pairs_left_, found.pairs);
      if (found.end == PairSearch::End::out_of_budget) return std::nullopt;
      if (found.end == PairSearch::End::proven) return NoPassing{i, j, side, corners_of(*of_i), found.pairs};
    }
    return std::nullopt;
  }

  std::optional<NoPassing> by_gaps(std::size_t i, std::size_t j) {
    const double smaller = std::min(scenario_.robots[i].radius, scenario_.robots[j].radius);
    const double to_wall = std::min(scenario_.margins.obstacle, 2.0 * detail::kWayGap * smaller);
    const double kept = 2.0 * to_wall + 0.5 * detail::kPlannedGap * side_by_side(i, j);
    std::optional<NoPassing> proof = in_a_strip(i, j, kProductRoundedDown * (side_by_side(i, j) + kept));
    if (!proof || proof->strip < side_by_side(i, j)) return std::nullopt;
    proof->with_gaps = true;
    return proof;
  }

  /// m, that they take between two walls, rounded down.
  double side_by_side(std::size_t i, std::size_t j) const {
    return 2.0 * (scenario_.robots[i].radius + scenario_.robots[j].radius) * kProductRoundedDown;
  }

  /// Squares cover more than what can be reached: a goal behind a gap just too narrow may lie in them.
  bool is_out_of_reach(std::size_t robot) {
    const auto [known, is_new] = is_out_of_reach_.try_emplace(robot, false);
    if (is_new) known->second = is_proven_out_of_reach(robot);
    return known->second;
  }

  bool is_proven_out_of_reach(std::size_t robot) {
    const Robot& r = scenario_.robots[robot];
    const detail::Destination goal{r.goals[0], detail::reach_of(r, 0, scenario_.arrival_tolerance)};
    return !reach_.reachable_place(r.radius, r.position, goal) &&
           reach_.is_proven_out_of_reach(r.radius, r.position, goal);
  }

  static double coarsest_side(double radius) { return std::ldexp(1.0, std::ilogb(kCoarsestSquare * radius)); }

  /// Such robots push each other apart, to any side.
  bool overlap_at_start(std::size_t i, std::size_t j) const {
    const Robot &a = scenario_.robots[i], &b = scenario_.robots[j];
    return norm(a.position - b.position) < a.radius + b.radius;
  }

  /// One narrower than `most`, m.
  std::optional<NoPassing> in_a_strip(std::size_t i, std::size_t j, double most) {
    // Wherever the larger one gets to, the smaller one has room too.
    const auto [smaller, larger] =
        scenario_.robots[i].radius <= scenario_.robots[j].radius ? std::pair(i, j) : std::pair(j, i);
    const SquareCover* cover = cover_of(smaller, coarsest_side(scenario_.robots[smaller].radius));
    if (!cover || !is_in(*cover, larger)) return std::nullopt;
    if (!holds_goal(squares_at_goal(i, *cover)) || !holds_goal(squares_at_goal(j, *cover))) return std::nullopt;
    std::vector<Vec2> squares = corners_of(*cover);
    const std::optional<double> width = detail::strip_that_keeps_order(disc(i), disc(j), most, squares, cover->side,
                                                                       walls_.edges(), looks_left_of_strips_);
    if (!width) return std::nullopt;
    return NoPassing{i, j, cover->side, std::move(squares), 0, *width, most};
  }

  detail::DiscWithGoal disc(std::size_t i) const {
    const Robot& r = scenario_.robots[i];
    return {r.position, r.goals[0], detail::reach_of(r, 0, scenario_.arrival_tolerance)};
  }

  /// Null where it is not whole. Robots in one another's cover share it.
  const SquareCover* cover_of(std::size_t robot, double side) {
    const Robot& r = scenario_.robots[robot];
    if (!detail::fits_grid(r.position, side) || !detail::fits_grid(r.goals[0], side)) return nullptr;
    for (const SquareCover& c : covers_)
      if (c.radius == r.radius && c.side == side && is_in(c, robot)) return c.is_whole ? &c : nullptr;
    if (detail::leads_outside(r.position, r.radius, side, walls_, looks_left_) || looks_left_ == 0) return nullptr;
    covers_.push_back(detail::cover_from(r.position, r.radius, side, walls_, looks_left_));
    return covers_.back().is_whole ? &covers_.back() : nullptr;
  }

  Traveller traveller(std::size_t robot, const SquareCover& cover) const {
    return {&cover, cover.number.at(detail::key_of(detail::square_at(scenario_.robots[robot].position, cover.side))),
            squares_at_goal(robot, cover)};
  }

  std::vector<char> squares_at_goal(std::size_t robot, const SquareCover& cover) const {
    const Robot& r = scenario_.robots[robot];
    return detail::squares_at(r.goals[0], detail::reach_of(r, 0, scenario_.arrival_tolerance), cover);
  }

  static std::vector<Vec2> corners_of(const SquareCover& cover) {
    std::vector<Vec2> corners;
    for (const GridSquare q : cover.squares) corners.push_back(cover.side * Vec2{double(q.x), double(q.y)});
    return corners;
  }

  const Scenario& scenario_;
  Asked asked_;
  detail::CoverWalls walls_;
  detail::Reachability reach_;                   ///< makes its map where it is asked
  std::map<std::size_t, bool> is_out_of_reach_;  ///< of robots that were asked for
  std::deque<SquareCover> covers_;
  std::size_t looks_left_ = kMostLooks, pairs_left_ = kMostPairs, looks_left_of_strips_ = kMostLooksOfStrips;
};

struct PairsFound {
  std::vector<NoPassing> pairs;
  bool none_have_little_room = true;  ///< no two robots: then no question finds a pair
};

PairsFound pairs_without(const Scenario& scenario, Asked question) {
  if (scenario.formation || scenario.obstacles.empty() || scenario.robots.size() < 2) return {};
  Proofs proofs(scenario, question);
  struct InLittleRoom {
    std::size_t robot;
    const SquareCover* room;
  };
  std::vector<InLittleRoom> asked;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i)
    if (const SquareCover* room = proofs.little_room(i)) asked.push_back({i, room});
  // Finer squares cover less: a robot outside the coarsest ones of both is in none.
  const auto may_meet = [&](const InLittleRoom& a, const InLittleRoom& b) {
    return proofs.is_in(*a.room, b.robot) || proofs.is_in(*b.room, a.robot);
  };
  std::vector<NoPassing> all;
  for (std::size_t k = 0; k < asked.size(); ++k)
    for (std::size_t l = k + 1; l < asked.size(); ++l)
      if (may_meet(asked[k], asked[l]))
        if (std::optional<NoPassing> proof = proofs.of(asked[k].robot, asked[l].robot))
          all.push_back(std::move(*proof));
  return {std::move(all), asked.size() < 2};
}

}  // namespace

std::vector<NoPassing> robots_without_passing(const Scenario& scenario) {
  return pairs_without(scenario, Asked::for_room).pairs;
}

std::vector<NoPassing> robots_without_gaps_to_pass(const Scenario& scenario) {
  return pairs_without(scenario, Asked::for_room_with_gaps).pairs;
}

std::vector<NoPassing> detail::robots_without_passing_by_plan(const Scenario& scenario) {
  PairsFound found = pairs_without(scenario, Asked::for_room);
  if (found.none_have_little_room) return {};
  const std::size_t proven = found.pairs.size();
  for (NoPassing& within_gaps : robots_without_gaps_to_pass(scenario)) {
    const auto is_of_same = [&](const NoPassing& p) {
      return p.first == within_gaps.first && p.second == within_gaps.second;
    };
    const auto end = found.pairs.begin() + static_cast<std::ptrdiff_t>(proven);
    if (std::none_of(found.pairs.begin(), end, is_of_same)) found.pairs.push_back(std::move(within_gaps));
  }
  return std::move(found.pairs);
}

std::string words_of(const Scenario& scenario, const NoPassing& proof) {
  char text[160];
  if (proof.strip > 0.0)
    std::snprintf(text, sizeof text, "they are in a strip %g m wide, and side by side they take %g m)", proof.strip,
                  proof.side_by_side);
  else
    std::snprintf(text, sizeof text, "none of %zu pairs of squares of %g m leads there)", proof.pairs, proof.side);
  return scenario.robots[proof.first].id + " and " + scenario.robots[proof.second].id +
         (proof.with_gaps ? " may have room to pass each other, but not with the gaps of plans ("
                          : " cannot both reach their goals: they have no room to pass each other (proven: ") +
         text;
}

}  // namespace exactvo::formation
