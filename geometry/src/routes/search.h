// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The shortest way through the shrunk portals: Polyanya (Cui, Harabor and Grastien, IJCAI 2017) over the cells.
/// Rounded: it says through which portals and round which corners, and how long the shortest curve through the shrunk
/// portals is, which no route undercuts. The route itself is made and proven in realise.h.
///
/// Where rounding shuts what the exact rules leave open, Dijkstra's search over the portals finds a way, and a funnel
/// its turns. That way need not be the shortest; its bound is then no more than what is known of every way.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "routes/corridors.h"
#include "routes/marks.h"
#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// A portal of a gate, and how the route crosses it.
struct GateCrossing {
  int portal = -1;
  bool from_left = false;  ///< from the portal's left cell
  int at = 0;              ///< its place in `Way::portals`
};

/// What the route passes, in order: a tight gate, to be crossed through its middle, or a vertex to go round.
struct Waypoint {
  int portal = -1;         ///< of the gate, the first in a row; -1: a vertex
  bool from_left = false;  ///< the gate is crossed from its portal's left cell
  int vertex = -1;
  bool on_left = false;  ///< the vertex lies to the left of the route
  int at = 0;            ///< its place in `Way::portals`
  /// The last portal of the gate in that row: a route that begins in the gate may cross it back and forth.
  GateCrossing last = {};
};

struct Way {
  std::vector<int> portals;
  std::vector<Waypoint> waypoints;
  double lower_bound = 0.0;  ///< m; no route is shorter, up to rounding
  int start = -1;            ///< the cell that it begins in
};

/// p beyond the line ab.
Vec2 mirrored(Vec2 p, Vec2 a, Vec2 b);

/// Scratch memory of a search, to be used again and again by one thread.
class WaySearch {
 public:
  /// Only a search that rounding sends in circles makes so many: any other takes a few for each cell. 2 GB.
  static constexpr std::size_t kMostNodes = std::size_t{1} << 24;

  /// Gives up after `most` nodes and leaves it to the second search; for tests.
  explicit WaySearch(const ClearancePlan& plan, std::size_t most = kMostNodes);

  /// From s to t, each in the closure of all its cells. Nothing where neither search finds a way: a defect if two of
  /// the cells are in one component.
  std::optional<Way> find(Vec2 s, const std::vector<int>& starts, Vec2 t, const std::vector<int>& goals);

  /// Steps of the last question: portals checked one by one, and boxes of portals in leaps (corridors.h).
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
    bool from_left;  ///< the portal is crossed from its left cell
    std::uint8_t
        straight;  ///< portals that the view has passed without meeting an end, one after the other; at most 255
    double length;
    double root_size;                        ///< m, as `ShrunkPortal::size`
    int first_cell = -1, first_portal = -1;  ///< where it was before it leapt; -1: it did not
    int left_corner() const { return 2 * portal + (from_left ? 1 : 0); }
    int right_corner() const { return 2 * portal + (from_left ? 0 : 1); }
  };

  struct InCorridor {
    int corridor, place;
  };

  bool search(Vec2 s, const std::vector<int>& starts, Vec2 t, Way& way);
  bool search_nearly_open(Vec2 s, const std::vector<int>& starts, Vec2 t, Way& way);
  void open_start(Vec2 s, const std::vector<int>& starts);
  bool is_goal(int cell) const { return std::find(goal_cells_.begin(), goal_cells_.end(), cell) != goal_cells_.end(); }
  void leap(int number);
  bool pass_on(const Node& node, Crossing& at) const;
  bool passes(const Node& node, const Crossing& c) const;
  std::pair<double, double> shares_seen(const Node& node, const Crossing& c) const;
  InCorridor corridor_from(int portal, int cell);
  bool grow(int corridor, int length);
  Crossing crossing_into(int portal, int cell) const;
  void expand(int number);
  void expand_to_point(int number, const Passage& p, double size);
  void add(const Node& node, const Passage& through);
  /// What is seen through a passage from one end of the node's interval.
  struct Sight {
    Vec2 left, right, left_ray, right_ray;
    bool left_turns, right_turns;
  };
  void turn(const Node& node, int parent, bool round_left, const Passage& p, const Sight& seen);
  void queue_fresh(Vec2 t);
  int next_from_queue(double& bound);
  bool is_outdone_at(int corner, double length, double size) const;
  bool may_pass(const Passage& p, int from) const {
    return !p.leads_into_dead_end || allowed_.find(p.to) != nullptr || plan_.way_out(from) == p.to;
  }
  int corner_at(int portal, Vec2 x) const;
  void trace(int number, Vec2 t, Way& way) const;

  void set_waypoints(const std::vector<Waypoint>& turns, const std::vector<bool>& from_left, Way& way) const;
  void pull_through(Vec2 s, Vec2 t, const std::vector<bool>& from_left, Way& way) const;

  const ClearancePlan& plan_;
  const CellMap& map_;
  std::size_t most_;
  double bound_ = 0.0;  ///< m: where the first search gives up, what its queue says of every way
  std::vector<Node> nodes_;
  std::size_t fresh_ = 0;  ///< nodes from here on were made by the expansion under way
  std::vector<std::pair<double, int>> queue_;
  Remembered<double> best_;  ///< of a corner: the least length after which it was reached, m
  struct ReachedInSector {
    double length, at;
  };
  Remembered<ReachedInSector> best_in_sector_;
  Remembered<char> allowed_;
  std::vector<Corridor> corridors_;
  Remembered<InCorridor> in_corridor_;  ///< a portal as it is crossed: 2 portal + (1: from its left)
  std::vector<int> goal_cells_;
  std::size_t steps_ = 0;
  bool was_second_search_ = false;
  /// Corner, portal, cell, interval and rays of a node.
  using Key = std::array<double, 11>;
  std::map<Key, double> beside_root_;  ///< lengths of nodes whose interval ends at their root
};

}  // namespace exactvo::geometry::routing
