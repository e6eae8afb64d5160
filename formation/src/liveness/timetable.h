// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// When the moves of a sequence begin if robots go by it together, and so how long it takes (liveness, rule R3).
/// Heuristic: robots follow each other as closely as `Following` lets them, but for what quarters of a way round off.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "liveness/cells.h"
#include "liveness/joint_search.h"

namespace exactvo::formation::detail {

using WayNumber = std::uint32_t;

/// Squared distances below are in single precision: what is nearer than this many times what is wanted counts as near.
inline constexpr double kSingleRounding = 1.0 + 1e-6;

/// Ways of a map in one direction, numbered as they are asked for, with what discs that go there come near.
class Ways {
 public:
  struct NearPlace {
    PlaceNumber place;
    float squared;  ///< m2, its squared distance from the way
  };
  struct NearWay {
    WayNumber way;
    float squared;  ///< m2
    float lead;     ///< m, that a robot on it needs over one that goes this way after it
  };

  /// `most_radii`: m, the largest sum of two radii. Keeps a reference to the map.
  Ways(const Roadmap& map, double most_radii);

  WayNumber number(PlaceNumber from, PlaceNumber to);
  /// Number of the way that leads from a place to its k-th neighbour.
  WayNumber number_of_kth(PlaceNumber from, std::size_t k);
  std::size_t size() const { return ways_.size(); }
  double length(WayNumber w) const { return norm(ways_[w].b - ways_[w].a); }  ///< m
  /// Places that the way comes nearer to than its start, and too near for some two robots.
  const std::vector<NearPlace>& near_places(WayNumber w) const { return near_places_[w]; }
  /// Of the ways that this was asked of so far, those too near to this one for some two robots.
  const std::vector<NearWay>& near_ways(WayNumber w);

 private:
  void add_near_places(WayNumber w);
  void add_near_ways(WayNumber w);
  double lead(WayNumber first, WayNumber second) const;

  const Roadmap& map_;
  double reach_;  ///< m, that the largest keep
  std::vector<Segment> ways_;
  std::unordered_map<std::uint64_t, WayNumber> numbers_;
  std::vector<std::vector<WayNumber>> from_;  ///< by place and neighbour
  std::vector<std::vector<NearPlace>> near_places_;
  std::vector<std::vector<NearWay>> near_ways_;
  std::vector<char> has_near_ways_;
  Cells<WayNumber> cells_;
};

inline constexpr std::size_t kNoMove = std::numeric_limits<std::size_t>::max();

struct TimedMove {
  JointMove move;
  WayNumber way = 0;
  double start = 0.0;               ///< m, that a robot goes until then that never waits
  std::size_t waits_for = kNoMove;  ///< which move
};

struct Timetable {
  std::vector<TimedMove> moves;     ///< by start; those near to each other are in the order of the sequence
  double last = 0.0;                ///< m, until all are there
  double mean = 0.0;                ///< m, until a robot is there
  std::size_t last_move = kNoMove;  ///< that ends then
};

/// Of a sequence of moves of robots with those radii, m.
Timetable timetable_of(const std::vector<JointMove>& moves, const std::vector<double>& radii, Ways& ways);

}  // namespace exactvo::formation::detail
