// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Reservations: how a crowd gets out of a jam. A robot that has stalled, is pushed, or rests at its goal *reserves* a
/// place near it and drives straight there; the segment from where it is to its place is its *way*. Places are reserved
/// by age, with priority inheritance (PIBT: Okumura, Machida, Defago and Tamura, "Priority Inheritance with
/// Backtracking for iterative multi-agent path finding", Artificial Intelligence 2022), in continuous space: a robot
/// that stands on a way is pushed to a place of its own, before the robot that pushes it sets out.
///
/// Each reservation has a ticket, which says when its robot moves: a robot drives as far along its way as this stays
/// clear of the ways of all earlier tickets. Promises (tests quote the numbers), for robots that stay on their ways,
/// keep off the ways of others where they have no reservation, and do not overlap at the beginning:
///  (1) The place of a robot is clear of all later ways, and a place that is reached is clear of all ways.
///  (2) Robots that wait wait for earlier tickets: waiting never closes a cycle, so every place is reached.
///  (3) A robot with a reservation drives on its way, or stands.
///  (4) Robots that drive as `preferred` says do not overlap, whatever they do within the step.
///  (5) The same calls give the same bits; a state that was put and got again goes on with the same bits.
/// Not promised: that all robots are at their goals at one time. Of robots on a lattice of places with a free place,
/// where each two places next to each other are on a cycle, each comes to its goal (Okumura et al., theorem 1).
///
/// Heuristic, in doubles: half-planes see to safety. Knows no half-planes, routes or threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactvo/geometry/vec2.h"
#include "scene/free_space.h"
#include "snapshot_bytes.h"

namespace exactvo::formation::detail {

/// What reservations look at of a robot before a step.
struct RobotUnderWay {
  static constexpr std::size_t kMostAhead = 4;

  Vec2 position;                       ///< m
  Vec2 velocity;                       ///< m/s
  Vec2 goal;                           ///< m, where its course ends
  std::array<Vec2, kMostAhead> ahead;  ///< m: the next corners of its course, the first in sight; at the end the goal
  std::size_t corners_ahead = 1;       ///< how many, 1 to kMostAhead
  double rest = 0.0;                   ///< m, along the course from the last of them to the goal
  double radius = 0.5;                 ///< m, > 0
  double max_speed = 1.5;              ///< m/s, > 0
  bool is_at_goal = false;             ///< near enough to rest there
  bool yields = false;                 ///< it wants no place of its own: it only makes way where it is pushed
  std::uint32_t leg = 0;               ///< how many goals it has passed

  Vec2 next() const { return ahead.front(); }
};

/// Diameters of the widest robot: a place is reached that is no farther away.
inline constexpr double kPlaceReached = 1e-3;
/// Diameters of the widest robot: what the way of a new reservation keeps from others besides the radii.
inline constexpr double kKeptFromOthers = 4e-3;
/// The same: two robots can be at their places at one time if these are farther apart than the radii and this.
inline constexpr double kRoomBetweenPlaces = kKeptFromOthers + 2.0 * kPlaceReached;

/// Which robots reserve places.
enum class WhoReserves {
  jammed,  ///< those that have stalled, are pushed or rest at their goals; until nothing is ahead of them
  all      ///< all, always: all robots come home without half-planes, if more slowly in the open
};

/// A straight row of places, and the rows beside it: a square lattice in the open, rows that fit the passage in one.
struct PlaceRows {
  Vec2 origin;          ///< m, of column 0 and row 0
  Vec2 along, across;   ///< unit vectors
  double column = 1.0;  ///< m, between places of a row
  double row = 1.0;     ///< m, between rows
  int rows = 0;         ///< of a passage, numbered from 0; 0: no end of them

  Vec2 place(double c, double r) const { return origin + c * column * along + r * row * across; }
  bool has_row(double r) const { return rows == 0 || (r >= 0.0 && r < rows); }
};

/// The rows about a place: those of the passage that it is in, if robots of `radius` cannot stand in more than five
/// rows there. Such a passage has two walls that are parallel, up to some degrees. `pitch`: m, between places.
PlaceRows rows_about(const ObstacleSpace& space, Vec2 place, double radius, double pitch);

class Reservations {
 public:
  /// `space` must outlive it. `time_step`: s. `widest`: m, the largest radius.
  Reservations(const ObstacleSpace& space, std::size_t robots, double time_step, double widest,
               WhoReserves who = WhoReserves::jammed);

  /// Before the decisions of a step; an entry a robot, always of the same. Only robots that have come to their place,
  /// or have none and stall, reserve another. O(robots), and for each that reserves one O(robots near it).
  void look(const std::vector<RobotUnderWay>& robots);

  /// 1: the robot has a reservation. By robot, as the others.
  const std::vector<std::uint8_t>& reserved() const { return reserved_; }
  /// m: where it drives or stands; without a reservation where it is.
  const std::vector<Vec2>& places() const { return places_; }
  /// m/s, of robots with a reservation; 0 of others.
  const std::vector<Vec2>& preferred() const { return preferred_; }
  /// How many have one.
  std::size_t count() const { return count_; }
  /// Whether the last `look` gave or took a reservation, or tried in vain to get one and would try otherwise next time.
  bool has_changed() const { return has_changed_; }
  /// If in as many steps nothing moves and nothing has changed, nothing will.
  std::uint64_t patience() const;
  /// The number of the robot's last reservation; 0: none yet.
  std::uint64_t ticket(std::size_t i) const { return of_[i].ticket; }

  /// All that is remembered from step to step.
  void put(crowd::SnapshotWriter& to) const;
  /// Throws CrowdError (bad_snapshot).
  void get(crowd::SnapshotReader& from);

 private:
  struct OfRobot {
    std::uint64_t ticket = 0;
    std::uint64_t at_goal_last = 0;  ///< step; 0: since the start
    std::uint64_t looked = 0;        ///< step at which `way_then` was measured
    std::uint64_t free_since = 0;    ///< step at which something was ahead last
    double way_then = 0.0;           ///< m
    std::uint32_t in_vain = 0;       ///< reservations that were not to be had since the last one
    std::uint32_t pushed_off = 0;    ///< how many times it was at its goal and is not any more
    std::uint32_t leg = 0;
    std::uint8_t has_way_then = 0;
    std::uint8_t is_at_goal = 0;
  };
  /// A place that no obstacle keeps the robot from.
  struct Prospect {
    Vec2 place;
    double way = 0.0;            ///< m, from there to the goal
    bool leads_on = false;       ///< it is nearer to the goal, and the course goes on in sight
    bool pushes_nobody = false;  ///< taken only where nobody stands in the way
  };
  /// Where a robot could drive from where it stands.
  struct Outlook {
    static constexpr std::size_t kMost = 24;
    // What it follows from.
    std::size_t robot = static_cast<std::size_t>(-1);
    Vec2 position, goal;
    std::array<Vec2, RobotUnderWay::kMostAhead> ahead;
    std::size_t corners_ahead = 0;
    double rest = 0.0;

    double way = 0.0;  ///< m, from where it stands to the goal
    bool stands_on_place = false;
    std::size_t count = 0;
    std::array<Prospect, kMost> places;

    bool is_of(std::size_t i, const RobotUnderWay& r) const;
  };
  struct Option {
    Vec2 place;
    double cost = 0.0;  ///< those that cost less are tried first
    bool leads_on = false, pushes_nobody = false;
  };
  struct Options {
    static constexpr std::size_t kMostAside = 3;
    std::size_t count = 0;
    std::array<Option, Outlook::kMost + kMostAside> all;
  };

  Vec2 at(std::size_t i) const { return (*robots_)[i].position; }
  bool is_moving(std::size_t i) const;
  double way_from(std::size_t i, Vec2 place) const;
  bool leads_on(std::size_t i, Vec2 place) const;
  bool sees(std::size_t i, Vec2 from, Vec2 to) const;
  bool is_open(std::size_t i, Vec2 to) const;
  Vec2 off_walls(std::size_t i, Vec2 place) const;
  std::uint64_t steps_of(double seconds) const;

  void look_whether_stalled(std::size_t i);
  void look_whether_free(std::size_t i);
  bool is_something_ahead(std::size_t i) const;
  bool is_before(std::size_t a, std::size_t b) const;

  bool reserve(std::size_t i, std::size_t depth, std::size_t pusher);
  const Outlook& outlook_of(std::size_t i);
  void look_about(std::size_t i, Outlook& out) const;
  double cost_of_pushing(std::size_t i, Vec2 place, bool is_pushed, std::size_t near, std::size_t near_end) const;
  static double shaking_of(const OfRobot& of);
  bool find_place(std::size_t i, std::size_t near, std::size_t depth, std::size_t pusher);
  void weigh_way_of_pusher(std::size_t i, std::size_t pusher, Options& options) const;
  void add_steps_aside(std::size_t i, std::size_t pusher, std::size_t near, Options& options) const;
  bool is_there_room(std::size_t i, const Option& to, std::size_t near, std::size_t near_end, std::size_t& pushed);
  bool try_place(std::size_t i, const Option& to, std::size_t near, std::size_t depth);

  void follow_ways();
  void find_earlier(std::size_t i);
  double share_allowed(std::size_t i);
  Vec2 preferred_of(std::size_t i);

  void place_robots();
  template <class Visit>
  void for_each_near(Vec2 here, double reach, const Visit& visit) const;
  std::int64_t cell(double x) const;
  std::size_t bucket(std::int64_t x, std::int64_t y) const;

  const ObstacleSpace& space_;
  double time_step_, diameter_, pitch_, reach_;
  WhoReserves who_;

  // From step to step.
  std::uint64_t step_ = 0, tickets_ = 0;
  std::vector<OfRobot> of_;
  std::vector<std::uint8_t> reserved_;
  std::vector<Vec2> places_;

  // Valid within one step:
  const std::vector<RobotUnderWay>* robots_ = nullptr;
  std::vector<Vec2> preferred_;
  std::size_t count_ = 0;
  bool has_changed_ = false;
  std::vector<double> left_;              ///< m, by robot: of its way
  std::vector<std::uint64_t> clear_;      ///< by robot: ticket with which nothing earlier is in its way
  std::vector<std::uint64_t> decided_;    ///< by robot: step of its last decision
  std::vector<std::uint8_t> is_pushing_;  ///< by robot: waits for a robot that it pushes
  std::vector<std::uint32_t> waiting_;    ///< robots that reserve, the oldest first
  std::vector<std::uint32_t> list_;       ///< robots near the robots that decide now, and those that they push
  std::size_t oldest_pusher_ = 0;

  // Two ways only get shorter, so two that were apart stay so. What follows from that is found again after a restart.
  struct OfWay {
    static constexpr std::uint64_t kNone = ~std::uint64_t{0};
    static constexpr std::uint32_t kMost = 10;
    std::uint64_t ticket = kNone;              ///< of `from`
    std::uint64_t known = kNone;               ///< ticket, of `earlier`
    Vec2 from;                                 ///< m: where the robot set out
    std::uint32_t count = 0;                   ///< of `earlier`; above kMost it says nothing
    std::array<std::uint32_t, kMost> earlier;  ///< robots with earlier tickets, whose ways may meet this one
  };
  std::vector<OfWay> ways_;
  double longest_ = 0.0;           ///< m, of ways from where robots set out
  std::vector<Outlook> outlooks_;  ///< of robots that decided lately, by number

  // Robots by place: cells are spread over buckets by a hash.
  struct Placed {
    Vec2 at;
    std::int64_t cell_x = 0, cell_y = 0;
    std::uint32_t robot = 0, bucket = 0;
  };
  std::vector<std::uint32_t> begin_;
  std::vector<Placed> placed_;  ///< by robot, and where it stood when robots were placed last
  std::vector<Placed> by_bucket_;
};

}  // namespace exactvo::formation::detail
