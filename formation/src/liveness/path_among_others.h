// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A path of one robot to its goal among the moves of all others (liveness, rule R3).
///
/// Safe-interval path planning (Phillips and Likhachev, "SIPP: Safe Interval Path Planning for Dynamic Environments",
/// ICRA 2011), with positions in the sequence of the others' moves instead of times: position k is before their k-th
/// move. What comes out is a sequence of single moves again, in which the robot keeps (1 + kPlannedGap) times the sum
/// of the radii from all others, or gets away from them. Heuristic: it takes the path that seems to be at its goal
/// first.

#include <cstdint>
#include <optional>
#include <vector>

#include "liveness/timetable.h"

namespace exactvo::formation::detail {

/// Who stands where before which move of the others: bits by place and position, for each of up to four radii. Where
/// there are more, some robots count as larger than they are, so that a clear position may be missed, never made up.
/// Where the bits would take too much memory, lists by place say the same, more slowly.
class StandingRobots {
 public:
  /// Words of 64 bits; each has a number of 32 bits beside it, so that all take 48 MiB.
  static constexpr std::size_t kMostWords = std::size_t{1} << 22;

  explicit StandingRobots(const JointProblem& problem, std::size_t most_words = kMostWords);

  /// Forgets all; there are `count` + 1 positions.
  void clear(std::size_t count);
  /// One that stands there from position `first` to `last`.
  void add(std::size_t robot, PlaceNumber place, std::size_t first, std::size_t last);
  /// The first position from `first` to `last` at which a robot of that radius, m, can go along an edge: nobody stands
  /// too near to it. `near`: the places near the edge. More than `last` where there is no such position.
  std::size_t first_clear(double radius, const std::vector<RoadmapEdges::NearPlace>& near, std::size_t first,
                          std::size_t last) const;
  /// How many words of 64 bits there are; none where there are lists.
  std::size_t words() const { return layers_.size() * layers_.front().taken.size(); }

 private:
  /// Positions at which somebody stands on a place.
  struct Stay {
    std::uint32_t first, last;
  };
  /// Robots that count as equally large. Bits are by 64 positions and place, or else stays by place: ascending, with a
  /// position between any two.
  struct Layer {
    double radius;  ///< m, that its robots count as
    std::vector<std::uint64_t> taken = {};
    std::vector<std::uint32_t> until = {};  ///< the position after the last stay that meets them
    std::vector<std::vector<Stay>> stays = {};
  };

  static void add_bits(Layer& layer, std::size_t places, PlaceNumber place, std::size_t first, std::size_t last);
  static void add_stay(std::vector<Stay>& stays, std::size_t first, std::size_t last);
  /// Adds those of the 64 positions that are taken, if not all are. Where to go on if they are.
  std::size_t add_taken(double radius, const std::vector<RoadmapEdges::NearPlace>& near, std::size_t word,
                        std::uint64_t& taken) const;
  /// The position after a stay too near to the edge that holds this one; this one itself if there is none.
  std::size_t after_stays(double radius, const std::vector<RoadmapEdges::NearPlace>& near, std::size_t position) const;

  const JointProblem& problem_;
  std::size_t most_words_;
  bool has_bits_ = true;
  std::vector<Layer> layers_;
  std::vector<std::size_t> layer_of_;  ///< by robot
};

/// Between which moves of the others a robot can stand on a place. Intervals of all places are numbered together.
class SafeIntervals {
 public:
  explicit SafeIntervals(const JointProblem& problem);

  void set(std::size_t robot, const Timetable& others, const RoadmapEdges& edges);

  std::size_t last_position() const { return count_; }
  std::size_t size() const { return size_; }
  /// As of StandingRobots: what it takes to fill them counts as work.
  std::size_t words() const { return standing_.words(); }
  /// The interval of the place that holds a position.
  std::size_t at(PlaceNumber place, std::size_t position) const;
  /// The last position of an interval of the place.
  std::size_t last(PlaceNumber place, std::size_t interval) const;
  /// The first position from `first` to `last` at which the robot can go along an edge, whose near places these are;
  /// more than `last` where there is none.
  std::size_t first_clear(const std::vector<RoadmapEdges::NearPlace>& near, std::size_t first, std::size_t last) const {
    return standing_.first_clear(problem_.radii[robot_], near, first, last);
  }

 private:
  const JointProblem& problem_;
  StandingRobots standing_;
  std::size_t robot_ = 0, count_ = 0, size_ = 0;
  std::vector<std::vector<std::uint32_t>> passed_;  ///< by place: the moves that come near it
  std::vector<std::size_t> first_;                  ///< by place: its first interval
};

class PathAmongOthers {
 public:
  /// Keeps references to both.
  PathAmongOthers(const JointProblem& problem, RoadmapEdges& edges)
      : problem_(problem), edges_(edges), safe_(problem) {}

  /// The moves of all, with those of the robot among them; nothing where it finds no path that is over before `bound`,
  /// m at speed 1. `to_goal`: m, from each place to the robot's goal.
  std::optional<std::vector<JointMove>> moves_with(std::size_t robot, const Timetable& others,
                                                   const std::vector<float>& to_goal, double bound);
  /// Counted, of all so far.
  std::size_t work() const { return work_; }

 private:
  struct Query {
    std::size_t robot;
    const Timetable* others;
    const std::vector<float>* to_goal;
    double bound;
  };
  /// At a place, in one of its intervals.
  struct Arrival {
    PlaceNumber place = 0;
    std::size_t interval = 0;
    std::size_t position = 0;  ///< of the move that led here
    double time = 0.0;         ///< as the distance that is driven in it at full speed, m
    std::size_t parent = 0;    ///< arrival; the start is its own
  };

  void offer(const Query& query, const Arrival& arrival);
  void expand(const Query& query, std::size_t arrival);
  void expand_to(const Query& query, std::size_t arrival, std::size_t now, PlaceNumber to, EdgeNumber edge);
  std::vector<JointMove> moves_to(const Query& query, std::size_t arrival) const;

  const JointProblem& problem_;
  RoadmapEdges& edges_;
  SafeIntervals safe_;
  std::vector<Arrival> arrivals_;
  std::vector<std::pair<double, std::size_t>> open_;  ///< heap of arrivals by when they lead to the goal
  std::vector<double> soonest_;                       ///< by interval
  std::size_t work_ = 0;
};

}  // namespace exactvo::formation::detail
