// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The shortest way through the shrunk portals: Polyanya (Cui, Harabor and Grastien, IJCAI 2017) over the cells.
/// Rounded: it says through which portals and round which corners, and how long the shortest curve through the shrunk
/// portals is, which no route undercuts. The route itself is made and proven in realise.h.
///
/// Where rounding shuts what the exact rules leave open, Dijkstra's search over the portals finds a way, and a funnel
/// its turns. That way need not be the shortest; its bound is then no more than what is known of every way.

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "routes/corridors.h"
#include "routes/marks.h"
#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// What the route passes, in order: a tight gate, to be crossed through its middle, or a vertex to go round.
struct Waypoint {
  int portal = -1;         ///< of the gate; -1: a vertex
  bool from_left = false;  ///< the gate is crossed from its portal's left cell
  int vertex = -1;
  bool on_left = false;  ///< the vertex lies to the left of the route
  int at = 0;            ///< its place in `Way::portals`
};

struct Way {
  std::vector<int> portals;
  std::vector<Waypoint> waypoints;
  double lower_bound = 0.0;  ///< m; no route is shorter, up to rounding
};

/// Scratch memory of a search, to be used again and again by one thread.
class WaySearch {
 public:
  /// Only a search that rounding sends in circles makes so many: any other takes a few for each cell. 2 GB.
  static constexpr std::size_t kMostNodes = std::size_t{1} << 24;

  /// Gives up after `most` nodes and leaves it to the second search; for tests.
  explicit WaySearch(const ClearancePlan& plan, std::size_t most = kMostNodes);

  /// From s in one cell to t in another. Nothing where neither search finds a way: a defect if the cells are in one
  /// component.
  std::optional<Way> find(Vec2 s, int start, Vec2 t, int goal);

  /// Of the last question: portals looked at one by one, and boxes of portals in leaps (corridors.h).
  std::size_t steps() const { return steps_; }
  /// Whether the last question was answered by the second search.
  bool was_second_search() const { return was_second_search_; }

 private:
  /// From `root`, reached after `length`, through the interval between `right` and `left` of a portal, into `cell`. The
  /// rays that bound what is seen are kept as directions from the corners that made them: clipped points are too near
  /// to aim with.
  struct Node {
    int cell, portal, parent;
    int corner;  ///< the portal end at which the root lies: 2 portal + (0: from, 1: to); -1: the start
    Vec2 left, right, root, left_ray, right_ray;
    bool left_turns, right_turns;
    double length;
    int first_cell = -1, first_portal = -1;  ///< where it was before it leapt; -1: it did not
  };
  struct Ends {
    Vec2 right, left;
    bool right_turns, left_turns;
  };

  bool search(Vec2 s, int start, Vec2 t, int goal, Way& way);
  bool search_nearly_open(Vec2 s, int start, Vec2 t, int goal, Way& way);
  void open_start(Vec2 s, int start);
  void leap(int number);
  bool pass_on(const Node& node, Crossing& at) const;
  bool passes(const Node& node, const Crossing& c) const;
  std::pair<double, double> shares_seen(const Node& node, const Crossing& c) const;
  int corridor_from(int portal, int cell, int& place);
  bool grow(int corridor, int length);
  Crossing crossing_into(int portal, int cell) const;
  void expand(int number);
  void expand_to_point(int number, int portal, int to, const Ends& e, double size);
  double size_of_root(const Node& node) const;
  void add(const Node& node);
  void turn(const Node& node, int parent, int corner, Vec2 root, int portal, int to, Vec2 left, Vec2 right,
            Vec2 left_ray, Vec2 right_ray, bool left_turns, bool right_turns);
  void queue_fresh(Vec2 t);
  int next_from_queue(double& bound);
  bool is_outdone(const Node& node) const;
  bool is_outdone_at(int corner, double length) const;
  bool may_enter(int from, int to) const {
    return plan_.way_out(to) < 0 || allowed_.has(to) || plan_.way_out(from) == to;
  }
  Ends ends_seen(const CellMap::CellPortal& portal) const;
  int corner_at(int portal, Vec2 x) const;
  void trace(int number, Vec2 t, Way& way) const;

  void drop_repeated(std::vector<Waypoint>& list) const;
  void pull_through(Vec2 s, Vec2 t, const std::vector<bool>& from_left, Way& way) const;

  const ClearancePlan& plan_;
  const CellMap& map_;
  std::size_t most_;
  double bound_ = 0.0;  ///< m: where the first search gives up, what its queue says of every way
  std::vector<Node> nodes_;
  std::size_t fresh_ = 0;  ///< nodes from here on were made by the expansion under way
  std::vector<std::pair<double, int>> queue_;
  std::vector<double> best_, best_in_sector_;
  Marks seen_, seen_in_sector_, allowed_;
  std::vector<Corridor> corridors_;
  std::vector<int> corridor_of_, place_in_corridor_;  ///< of a portal as it is crossed: 2 portal + (1: from its left)
  Marks in_corridor_;
  int goal_cell_ = -1;
  std::size_t steps_ = 0;
  bool was_second_search_ = false;
  /// Corner, portal, cell, interval and rays of a node.
  using Sight = std::array<double, 11>;
  std::map<Sight, double> beside_root_;  ///< lengths of nodes whose interval ends at their root
};

}  // namespace exactvo::geometry::routing
