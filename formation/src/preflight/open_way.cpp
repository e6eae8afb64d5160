// SPDX-License-Identifier: GPL-3.0-or-later
#include "preflight/open_way.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "exactvo/geometry/distance.h"
#include "preflight/square_cover.h"

namespace exactvo::formation::detail {

using geometry::Segment;

enum class OpenWay::Answer {
  open,
  shut,    // nothing is left to look at on this lattice, or the places are too far apart for one
  looking  // there is more to look at
};

/// Best first, in one direction: what is easy from one end may lead into every pocket from the other. A place x with
/// the clearance c(x) has the disc of c(x) - r round it free for the centre; a move of length d is proven where the
/// discs at its ends cover it: (c(x) - r) + (c(y) - r) >= d.
class OpenWay::Search {
 public:
  Search(const OpenWay& map, Vec2 from, Vec2 to, double radius)
      : map_(map), from_(from), to_(to), radius_(radius), step_(radius) {
    constexpr double kRounding = 1e-9;
    const double largest = std::max({std::fabs(from.x), std::fabs(from.y), std::fabs(to.x), std::fabs(to.y)});
    slack_ = kRounding * (radius + 0x1p-20 * largest) + 8.0 * geometry::rounding_of_distance(largest);
    // Beyond this a clearance proves every move from there.
    enough_ = radius_ + kDiagonal * step_ + slack_;
  }

  /// Steps of the lattice between the two.
  double steps_apart() const { return norm(to_ - from_) / step_; }

  /// From disc to disc along the straight way.
  bool goes_straight() const {
    constexpr double kFarthest = 4.0, kLeastShare = 0.1;  // of the radius: a look, and what it has to be worth
    const double length = norm(to_ - from_);
    for (double done = 0.0;;) {
      const Vec2 place = done == 0.0 ? from_ : from_ + (done / length) * (to_ - from_);
      const double free = map_.clearance_below(place, kFarthest * radius_) - radius_ - slack_;
      if (!(free >= kLeastShare * radius_)) return false;
      if (norm(to_ - place) <= free) return true;
      done = std::min(done + free, length);
    }
  }

  void begin() {
    at_goal_ = map_.clearance_below(to_, enough_);
    visit({0, 0});
  }

  /// Looks at so many places more.
  Answer go_on(std::size_t places) {
    for (; !open_.empty() && places > 0; --places) {
      const Node node = open_.top();
      open_.pop();
      const double d = norm(node.place - to_);
      if (d <= kDiagonal * step_ && covers(node.clearance, at_goal_, d)) return Answer::open;
      for (std::int32_t dy = -1; dy <= 1; ++dy)
        for (std::int32_t dx = -1; dx <= 1; ++dx)
          if (dx != 0 || dy != 0) move(node, {node.cell.x + dx, node.cell.y + dy});
    }
    return open_.empty() ? Answer::shut : Answer::looking;
  }

 private:
  static constexpr double kDiagonal = 1.5;  // more than the root of 2

  struct Node {
    double to_go;  ///< m
    GridSquare cell;
    Vec2 place;
    double clearance;  ///< m
    bool operator<(const Node& other) const {
      return std::make_tuple(-to_go, cell.y, cell.x) < std::make_tuple(-other.to_go, other.cell.y, other.cell.x);
    }
  };

  struct Seen {
    double clearance = 0.0;  ///< m
    bool is_reached = false;
  };

  Vec2 place_of(GridSquare c) const { return from_ + step_ * Vec2{static_cast<double>(c.x), static_cast<double>(c.y)}; }

  bool covers(double clearance, double other, double length) const {
    return clearance + other >= 2.0 * radius_ + length + slack_;
  }

  void visit(GridSquare cell) {
    const Vec2 place = place_of(cell);
    const double clearance = map_.clearance_below(place, enough_);
    looked_at_.insert({key_of(cell), {clearance, true}});
    push(cell, place, clearance);
  }
  void push(GridSquare cell, Vec2 place, double clearance) {
    if (clearance >= radius_ + slack_) open_.push({norm(place - to_), cell, place, clearance});
  }

  /// A cell that cannot be moved to from here may be from another side.
  void move(const Node& node, GridSquare cell) {
    const auto [found, is_new] = looked_at_.try_emplace(key_of(cell));
    Seen& seen = found->second;
    if (seen.is_reached) return;
    const Vec2 place = place_of(cell);
    if (is_new) seen.clearance = map_.clearance_below(place, enough_);
    if (!covers(node.clearance, seen.clearance, norm(place - node.place))) return;
    seen.is_reached = true;
    push(cell, place, seen.clearance);
  }

  const OpenWay& map_;
  Vec2 from_, to_;
  double radius_, step_;  ///< m
  double slack_ = 0.0;    ///< m, more than every rounding
  double enough_ = 0.0;   ///< m
  double at_goal_ = 0.0;  ///< m, the clearance there
  std::priority_queue<Node> open_;
  std::unordered_map<std::uint64_t, Seen> looked_at_;
};

double OpenWay::clearance_below(Vec2 x, double enough) const {
  const double rounding = geometry::rounding_of_distance(edges_.largest_with(x));
  double least = enough;
  edges_.grid().for_each_within(x, enough + rounding, [&](std::size_t k) {
    if (distance_below(edges_.grid().box(k), x) - rounding < least)
      least = std::min(least, geometry::distance(edges_[k], x) - rounding);
  });
  return least;
}

bool OpenWay::is_found(Vec2 start, Vec2 goal, double radius) const {
  if (!(radius > 0.0)) return false;
  constexpr double kMostSteps = 1e4;  // between the two: beyond that a look at the walls is cheaper
  constexpr std::size_t kRound = 64;
  Search from_goal(*this, goal, start, radius), from_start(*this, start, goal, radius);
  const double steps = from_goal.steps_apart();
  if (!(steps < kMostSteps)) return false;
  if (from_goal.goes_straight() || from_start.goes_straight()) return true;
  from_goal.begin();
  from_start.begin();
  // In turns: where there is no way, the end that is shut in says so.
  for (std::size_t looked = 0; looked < most_places(steps); looked += kRound) {
    for (Search* search : {&from_goal, &from_start})
      if (const Answer answer = search->go_on(kRound); answer != Answer::looking) return answer == Answer::open;
  }
  return false;
}

/// From each end: no more than the map of all routes would cost, several times over.
std::size_t OpenWay::most_places(double steps) const {
  constexpr double kPlaces = 2000.0, kPlacesAStep = 4.0, kPlacesAnEdge = 0.25;
  return static_cast<std::size_t>(std::min(kPlaces, kPlacesAnEdge * static_cast<double>(edges_.all().size())) +
                                  kPlacesAStep * steps);
}

}  // namespace exactvo::formation::detail
