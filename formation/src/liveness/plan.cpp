// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/plan.h"

#include <algorithm>
#include <utility>

namespace exactvo::formation::detail {
namespace {

using Moves = std::vector<JointMove>;

double wanted_distance(const std::vector<double>& radii, std::size_t i, std::size_t j) {
  return (1.0 + kPlannedGap) * (radii[i] + radii[j]);
}

/// Whether nobody comes near a place between two moves of its robot, of the moves that are left.
bool stays_free(const Roadmap& map, const Moves& moves, const std::vector<char>& dropped, std::size_t first,
                std::size_t last, const std::vector<double>& radii) {
  const Vec2 place = map.place(moves[first].from);
  const std::size_t robot = moves[first].robot;
  for (std::size_t k = first + 1; k < last; ++k) {
    const JointMove& m = moves[k];
    if (dropped[k] || m.robot == robot) continue;
    const double wanted = (1.0 - kSweepRounding) * wanted_distance(radii, robot, m.robot);
    if (squared_distance(place, map.place(m.from), map.place(m.to)) < wanted * wanted) return false;
  }
  return true;
}

/// Whether any loop was dropped. Looks at loops of a few moves: longer ones are rare and cost more to look for.
bool drop_loops_once(const Roadmap& map, Moves& moves, const std::vector<double>& radii) {
  constexpr std::size_t kLongestLoop = 12;
  std::vector<std::vector<std::size_t>> of_robot(radii.size());
  for (std::size_t k = 0; k < moves.size(); ++k) of_robot[moves[k].robot].push_back(k);
  std::vector<char> dropped(moves.size(), 0);
  bool any = false;
  for (const std::vector<std::size_t>& mine : of_robot)
    for (std::size_t x = 0; x < mine.size(); ++x) {
      std::size_t back = x;
      for (std::size_t y = x + 1; y < mine.size() && y < x + kLongestLoop; ++y)
        if (moves[mine[y]].to == moves[mine[x]].from) back = y;
      if (back == x || !stays_free(map, moves, dropped, mine[x], mine[back], radii)) continue;
      for (std::size_t y = x; y <= back; ++y) dropped[mine[y]] = 1;
      any = true;
      x = back;
    }
  Moves left;
  for (std::size_t k = 0; k < moves.size(); ++k)
    if (!dropped[k]) left.push_back(moves[k]);
  moves = std::move(left);
  return any;
}

void order(std::vector<PlannedMove>& moves, const std::vector<double>& radii) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  const double largest = *std::max_element(radii.begin(), radii.end());
  const double farthest = 2.0 * (1.0 + kPlannedGap) * largest;
  Cells<std::size_t> earlier(3.0 * largest);
  std::vector<std::size_t> last(radii.size(), kNone);  // of each other robot
  for (std::size_t k = 0; k < moves.size(); ++k) {
    PlannedMove& m = moves[k];
    const Segment way{m.from, m.to};
    const geometry::Box box = geometry::box_of(way);
    // The newest first: where one of a robot's moves is near, its older ones need no distance.
    earlier.for_each_in_latest_first(box.grown(farthest), [&](std::size_t j) {
      const PlannedMove& o = moves[j];
      if (o.robot == m.robot || (last[o.robot] != kNone && last[o.robot] >= j)) return;
      const double wanted = wanted_distance(radii, m.robot, o.robot);
      if (squared_distance(way, Segment{o.from, o.to}) < wanted * wanted) last[o.robot] = j;
    });
    for (std::size_t& of_robot : last)
      if (of_robot != kNone) m.after.push_back(std::exchange(of_robot, kNone));
    earlier.add(box, k);
  }
}

}  // namespace

Moves without_loops(const Roadmap& map, Moves moves, const std::vector<double>& radii) {
  constexpr int kRounds = 3;  // a dropped loop may be the last that kept another from being one
  for (int round = 0; round < kRounds && drop_loops_once(map, moves, radii);) ++round;
  return moves;
}

std::vector<PlannedMove> plan_of(const Roadmap& map, const Moves& moves, const std::vector<double>& radii) {
  std::vector<PlannedMove> plan;
  for (const JointMove& m : moves) plan.push_back({m.robot, map.place(m.from), map.place(m.to)});
  order(plan, radii);
  return plan;
}

Following::Following(std::vector<PlannedMove> plan, std::vector<double> radii)
    : plan_(std::move(plan)),
      radii_(std::move(radii)),
      of_robot_(radii_.size()),
      next_(radii_.size(), 0),
      rank_(plan_.size(), 0),
      left_(plan_.size()) {
  for (std::size_t k = 0; k < plan_.size(); ++k) {
    rank_[k] = of_robot_[plan_[k].robot].size();
    of_robot_[plan_[k].robot].push_back(k);
  }
}

bool Following::may_finish(std::size_t move) const {
  const std::vector<std::size_t>& after = plan_[move].after;
  return std::all_of(after.begin(), after.end(), [&](std::size_t k) { return is_done(k); });
}

void Following::advance(const std::vector<Vec2>& at) {
  constexpr double kThere = 1e-5;  // radii
  for (std::size_t i = 0; i < of_robot_.size(); ++i) {
    if (is_there(i)) continue;
    const std::size_t move = of_robot_[i][next_[i]];
    if (!(norm(at[i] - plan_[move].to) <= kThere * radii_[i]) || !may_finish(move)) continue;
    ++next_[i];
    --left_;
  }
}

/// The largest share, up to `share`, of the way to the end of the move that stays clear of what the earlier move's
/// robot has still to sweep until it is done.
double Following::clear_share(std::size_t move, std::size_t earlier, double share, const std::vector<Vec2>& at) const {
  constexpr int kHalvings = 12;
  const std::size_t i = plan_[move].robot, j = plan_[earlier].robot;
  const Vec2 here = at[i], way = plan_[move].to - here;
  for (std::size_t x = next_[j]; x <= rank_[earlier]; ++x) {
    const PlannedMove& other = plan_[of_robot_[j][x]];
    const Segment swept{x == next_[j] ? at[j] : other.from, other.to};
    const double keep = squared_keep(radii_[i] + radii_[j], squared_distance(here, swept.a, swept.b));
    const auto is_clear = [&](double part) {
      return squared_distance(Segment{here, here + part * way}, swept) >= keep;
    };
    if (is_clear(share)) continue;
    double clear = 0.0;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (clear + share);
      (is_clear(middle) ? clear : share) = middle;
    }
    share = clear;
  }
  return share;
}

Vec2 Following::within_reach(std::size_t robot, const std::vector<Vec2>& at) const {
  if (is_there(robot)) return at[robot];
  const std::size_t move = of_robot_[robot][next_[robot]];
  double share = 1.0;
  for (const std::size_t earlier : plan_[move].after)
    if (!is_done(earlier)) share = clear_share(move, earlier, share, at);
  return share == 1.0 ? plan_[move].to : at[robot] + share * (plan_[move].to - at[robot]);
}

}  // namespace exactvo::formation::detail
