// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// When the moves of a sequence begin if robots go by it together, and so how long it takes (liveness, rule R3).
/// Heuristic: robots follow each other as closely as `Following` lets them, up to a quarter of an edge.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "liveness/joint_search.h"
#include "scene/cells.h"

namespace exactvo::formation::detail {

using EdgeNumber = std::uint32_t;

/// Squared distances below are in single precision: what is nearer than this many times what is wanted counts as near.
inline constexpr double kSingleRounding = 1.0 + 1e-6;

/// Edges of a roadmap, one for each direction, numbered as they are asked for, with what discs that go there come near.
class RoadmapEdges {
 public:
  struct NearPlace {
    PlaceNumber place;
    float squared;  ///< m2, its squared distance from the edge
  };
  struct NearEdge {
    EdgeNumber edge;
    float squared;  ///< m2
    float lead;     ///< m, that a robot on it needs over one that goes this edge after it
  };

  /// `most_radii`: m, the largest sum of two radii. Keeps a reference to the map.
  RoadmapEdges(const Roadmap& map, double most_radii);

  EdgeNumber number(PlaceNumber from, PlaceNumber to);
  /// Number of the edge that leads from a place to its k-th neighbour.
  EdgeNumber kth_from(PlaceNumber from, std::size_t k);
  std::size_t size() const { return edges_.size(); }
  double length(EdgeNumber w) const { return lengths_[w]; }  ///< m
  /// Places that the edge comes nearer to than its start, and too near for some two robots.
  const std::vector<NearPlace>& near_places(EdgeNumber w) const { return near_places_[w]; }
  /// The edges, among those that this was called for so far, that are too near to w for some two robots.
  const std::vector<NearEdge>& near_edges(EdgeNumber w);

 private:
  void add_near_places(EdgeNumber w);
  void add_near_edges(EdgeNumber w);
  double lead(EdgeNumber first, EdgeNumber second) const;

  const Roadmap& map_;
  double reach_;  ///< m, that the largest keep
  std::vector<Segment> edges_;
  std::vector<double> lengths_;  ///< m
  std::unordered_map<std::uint64_t, EdgeNumber> numbers_;
  std::vector<std::vector<EdgeNumber>> from_;  ///< by place and neighbour
  std::vector<std::vector<NearPlace>> near_places_;
  std::vector<std::vector<NearEdge>> near_edges_;
  std::vector<char> has_near_edges_;
  Cells<EdgeNumber> cells_;
};

inline constexpr std::size_t kNoMove = std::numeric_limits<std::size_t>::max();

struct TimedMove {
  JointMove move;
  EdgeNumber edge = 0;
  double start = 0.0;               ///< as the distance that is driven until then at full speed, m
  std::size_t waits_for = kNoMove;  ///< which move
};

struct Timetable {
  std::vector<TimedMove> moves;     ///< by start; those near to each other are in the order of the sequence
  double last = 0.0;                ///< the same, until all are there
  double mean = 0.0;                ///< the same, until a robot is there
  std::size_t last_move = kNoMove;  ///< that ends then
};

/// The first position in a table whose move starts then or later.
std::size_t position_at(const Timetable& table, double time);

/// The timetable of a sequence of moves. `radii`: m, of the robots.
Timetable timetable_of(const std::vector<JointMove>& moves, const std::vector<double>& radii, RoadmapEdges& edges);

}  // namespace exactvo::formation::detail
